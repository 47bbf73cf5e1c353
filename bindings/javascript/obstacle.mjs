// Obstacles: rigid bodies without particles.
import { constants as C } from './layout.mjs';
import { Functions } from './callbacks.mjs';
import { Handle, made } from './handle.mjs';

export class Obstacle extends Handle {
  constructor(context, desc = {}) {
    const { machine } = context;
    const { contact, distance, ...rest } = desc;
    const functions = new Functions(machine);
    const at = machine.arguments((a) => {
      const to = a.struct('mpm_obstacle_desc', rest);
      if (contact) a.put(to, 'mpm_obstacle_desc', 'contact', a.struct('mpm_contact_desc', contact));
      functions.set('distance', 'mpm_distance_fn', distance, (call, user) => {
        a.put(to, 'mpm_obstacle_desc', 'distance', call);
        a.put(to, 'mpm_obstacle_desc', 'user', user);
      });
      return made(machine, context.at, 'mpm_obstacle_create', [context.at, to]);
    });
    super(machine, context.at, 'obstacle', at, [context], functions);
  }
  setMotion(motion) {
    this.functions.set('motion', 'mpm_motion_fn', motion, (call, user) =>
      this.call('mpm_obstacle_set_motion', [call, user]),
    );
  }
  setContact(contact) {
    this.arguments((a) => this.call('mpm_obstacle_set_contact', [contact ? a.struct('mpm_contact_desc', contact) : 0]));
  }
  setPose({ position, orientation, velocity, angular_velocity } = {}) {
    this.arguments((a) =>
      this.call('mpm_obstacle_set_pose', [
        a.optional('f64', position, 3, 'position'),
        a.optional('f64', orientation, 4, 'orientation'),
        a.optional('f64', velocity, 3, 'velocity'),
        a.optional('f64', angular_velocity, 3, 'angular_velocity'),
      ]),
    );
  }
  pose() {
    return this.arguments((a) => {
      const at = [3, 4, 3, 3].map((count) => a.room('f64', count));
      this.call('mpm_obstacle_get_pose', at);
      const [position, orientation, velocity, angular_velocity] = at.map((one, k) =>
        Array.from(this.machine.array('f64', one, k === 1 ? 4 : 3)),
      );
      return { position, orientation, velocity, angular_velocity };
    });
  }
  setLoad({ force, torque } = {}) {
    this.arguments((a) =>
      this.call('mpm_obstacle_set_load', [
        a.optional('f64', force, 3, 'force'),
        a.optional('f64', torque, 3, 'torque'),
      ]),
    );
  }
  contactInfo(body = C.MPM_BODY_ANY) {
    return this.askStruct('mpm_obstacle_contact_info', [body], 'mpm_contact_info');
  }
}
