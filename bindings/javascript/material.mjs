// Materials: the laws of the library, and those of the host.
import { constants as C, structs } from './layout.mjs';
import { Functions } from './callbacks.mjs';
import { Handle, made } from './handle.mjs';

export class Material extends Handle {
  static model(context, model, params = {}) {
    const { machine } = context;
    const at = machine.arguments((a) => {
      const { size, fields } = structs.mpm_param;
      const list = Object.entries(params);
      const to = a.bytes(size * list.length);
      list.forEach(([name, value], k) => {
        machine.write(to + k * size + fields.name[0], 'pointer', a.text(name));
        machine.write(to + k * size + fields.value[0], 'f64', value, name);
      });
      return made(machine, context.at, 'mpm_material_create', [context.at, a.text(model), to, list.length]);
    });
    const states = machine.arguments((a) => machine.raw.mpm_material_state_count(a.text(model)));
    return new Material(context, at, states);
  }
  static law(context, desc = {}) {
    const { machine } = context;
    const { stress, tangent, state_initial, ...rest } = desc;
    const functions = new Functions(machine);
    const states = rest.state_count ?? state_initial?.length ?? 0;
    const at = machine.arguments((a) => {
      const to = a.struct('mpm_material_desc', { ...rest, state_count: states });
      const form = machine.read(to + structs.mpm_material_desc.fields.tangent_form[0], 'i32');
      const ask = tangent && Object.assign((batch, out) => tangent(batch, out), { components: form });
      // two functions with one argument `user` between them: its number stands for both
      const both = stress && Object.assign((batch) => stress(batch), { tangent: ask });
      functions.set('stress', 'mpm_stress_fn', both, (call, user) => {
        a.put(to, 'mpm_material_desc', 'stress', call);
        a.put(to, 'mpm_material_desc', 'user', user);
      });
      if (ask) a.put(to, 'mpm_material_desc', 'tangent', functions.address('mpm_tangent_fn'));
      a.put(to, 'mpm_material_desc', 'state_initial', a.optional('f64', state_initial, states, 'state_initial'));
      return made(machine, context.at, 'mpm_material_create_custom', [context.at, to]);
    });
    return new Material(context, at, states, functions);
  }
  constructor(context, at, states, functions) {
    super(context.machine, context.at, 'material', at, [context], functions);
    this.stateCount = states;
  }
  /** What a step does to items without a grid: arrays are [components][n]. */
  update(batch) {
    const { machine, stateCount: states } = this;
    const { n, t = 0, dt, tangent = false } = batch;
    if (!Number.isInteger(n) || n < 0) throw new TypeError('n has to be the number of items');
    return this.arguments((a) => {
      const to = a.struct('mpm_material_batch', { state_count: states, n, ld: n, t, dt });
      const inputs = {
        id: ['i64', 1],
        F: ['f64', 9],
        F_inc: ['f64', 9],
        L: ['f64', 9],
        stress: ['f64', 6],
        state: ['f64', states],
        position: ['f64', 3],
      };
      for (const [name, [kind, components]] of Object.entries(inputs)) {
        a.put(to, 'mpm_material_batch', name, a.optional(kind, batch[name], components * n, name));
      }
      const outputs = { stress_new: 6, state_new: states, wave_speed: 1, kinematic_viscosity: 1, energy: 1 };
      for (const name of Object.keys(outputs)) {
        outputs[name] = [a.room('f64', outputs[name] * n), outputs[name] * n];
        a.put(to, 'mpm_material_batch', name, outputs[name][0]);
      }
      const matrix = tangent ? a.room('f64', C.MPM_TANGENT_GENERAL * n) : 0;
      const symmetric = a.room('i32');
      machine.call(this.owner, 'mpm_material_update', [this.at, to, matrix, symmetric]);
      const out = {};
      for (const [name, [at, count]] of Object.entries(outputs)) out[name] = machine.array('f64', at, count).slice();
      if (!tangent) return out;
      out.tangent = machine.array('f64', matrix, C.MPM_TANGENT_GENERAL * n).slice();
      out.symmetric = machine.read(symmetric, 'i32') === 1;
      return out;
    });
  }
}
