// The time loop.
import { Grid } from './grid.mjs';
import { Handle, made, mapped } from './handle.mjs';
import { Obstacle } from './obstacle.mjs';
import { pieces } from './output.mjs';
import { Particles } from './particles.mjs';
import { Surface } from './surface.mjs';

export class Stepper extends Handle {
  constructor(context, grid, desc = {}) {
    const { machine } = context;
    const at = machine.arguments((a) =>
      made(machine, context.at, 'mpm_stepper_create', [
        context.at,
        Handle.address(Grid, grid, machine, 'the grid'),
        a.struct('mpm_stepper_desc', desc),
      ]),
    );
    super(machine, context.at, 'stepper', at, [context, grid]);
    this.grid = grid;
  }
  #set(set) {
    return Handle.address(Particles, set, this.machine, 'the set');
  }
  #obstacle(obstacle) {
    return Handle.address(Obstacle, obstacle, this.machine, 'the obstacle');
  }
  #surface(surface) {
    return Handle.address(Surface, surface, this.machine, 'the surface');
  }

  // ---- what is in it ----
  add(set) {
    this.call('mpm_stepper_add', [this.#set(set)]);
    this.keep(set);
    return this;
  }
  remove(set) {
    this.call('mpm_stepper_remove', [this.#set(set)]);
    this.functions.set(set, 'mpm_particle_fn', null, () => {});
    for (const what of ['adaption', 'heat'])
      this.functions.set(`${what} ${this.#set(set)}`, `mpm_${what}_fn`, null, () => {});
    this.drop(set);
  }
  addObstacle(obstacle) {
    this.call('mpm_stepper_add_obstacle', [this.#obstacle(obstacle)]);
    this.keep(obstacle);
    return this;
  }
  removeObstacle(obstacle) {
    this.call('mpm_stepper_remove_obstacle', [this.#obstacle(obstacle)]);
    this.drop(obstacle);
  }
  addSurface(surface) {
    this.call('mpm_stepper_add_surface', [this.#surface(surface)]);
    this.keep(surface);
    return this;
  }
  removeSurface(surface) {
    this.call('mpm_stepper_remove_surface', [this.#surface(surface)]);
    this.drop(surface);
  }
  configure(desc = {}) {
    this.arguments((a) => this.call('mpm_stepper_configure', [a.struct('mpm_stepper_desc', desc)]));
  }
  setTime(t, step = 0) {
    this.call('mpm_stepper_set_time', [t, BigInt(step)]);
  }
  setWall(face, kind, friction = 0) {
    this.call('mpm_stepper_set_wall', [face, kind, friction]);
    return this;
  }
  setBody(set, body) {
    this.call('mpm_stepper_set_body', [this.#set(set), body]);
    return this;
  }
  body(set) {
    return this.ask('mpm_stepper_body', [this.#set(set)], ['i32'])[0];
  }
  setContact(bodyA, bodyB, contact) {
    this.arguments((a) =>
      this.call('mpm_stepper_set_contact', [bodyA, bodyB, contact ? a.struct('mpm_contact_desc', contact) : 0]),
    );
    return this;
  }

  // ---- splitting and merging ----
  /** Gives the library a description of a set, with the function that is part of it. */
  #describe(what, set, desc, field, run) {
    this.arguments((a) => {
      const at = this.#set(set);
      const struct = `mpm_${what}_desc`;
      const to = desc ? a.struct(struct, desc) : 0;
      this.functions.set(`${what} ${at}`, `mpm_${what}_fn`, desc ? run : null, (call, user) => {
        if (to) a.put(to, struct, field, call);
        if (to) a.put(to, struct, 'user', user);
        this.call(`mpm_stepper_set_${what}`, [at, to]);
      });
    });
    return this;
  }
  setAdaption(set, desc, accept = null) {
    return this.#describe('adaption', set, desc, 'accept', accept);
  }
  adapt() {
    this.call('mpm_stepper_adapt', []);
  }
  adaptionInfo(set) {
    return this.askStruct('mpm_stepper_adaption_info', [this.#set(set)], 'mpm_adaption_info');
  }

  // ---- heat ----
  setHeat(set, desc, source = null) {
    return this.#describe('heat', set, desc, 'source', source);
  }
  setConduction(conduction, tolerance = 1e-9) {
    this.call('mpm_stepper_set_conduction', [conduction, tolerance]);
    return this;
  }
  setHeatWall(face, kind, temperature = 0) {
    this.call('mpm_stepper_set_heat_wall', [face, kind, temperature]);
    return this;
  }
  heatInfo() {
    return this.askStruct('mpm_stepper_heat_info', [], 'mpm_heat_info');
  }

  // ---- callbacks ----
  #callback(name, type, run, before = [], key = name) {
    this.functions.set(key, type, run, (call, user) => this.call(name, [...before, call, user]));
    return this;
  }
  setAcceleration(run) {
    return this.#callback('mpm_stepper_set_acceleration', 'mpm_particle_fn', run);
  }
  setForce(run) {
    return this.#callback('mpm_stepper_set_force', 'mpm_particle_fn', run);
  }
  setVelocityBc(run) {
    return this.#callback('mpm_stepper_set_velocity_bc', 'mpm_velocity_fn', run);
  }
  setNodeHook(stage, run) {
    return this.#callback('mpm_stepper_set_node_hook', 'mpm_node_fn', run, [stage], `hook ${stage}`);
  }
  setMotion(set, run) {
    return this.#callback('mpm_stepper_set_motion', 'mpm_particle_fn', run, [this.#set(set)], set);
  }
  setFriction(run) {
    return this.#callback('mpm_stepper_set_friction', 'mpm_friction_fn', run);
  }
  setProgress(run) {
    return this.#callback('mpm_stepper_set_progress', 'mpm_progress_fn', run);
  }
  setLinearSolver(run) {
    const solve = run && Object.assign((...values) => run(...values), { dim: this.grid.dim });
    return this.#callback('mpm_stepper_set_linear_solver', 'mpm_solve_fn', solve);
  }

  // ---- steps ----
  stableDt() {
    return this.ask('mpm_stable_dt', [], ['f64'])[0];
  }
  #stepped(name, values) {
    return this.arguments((a) => {
      const info = a.struct('mpm_step_info');
      this.call(name, [...values(a), info], info);
      return this.machine.readStruct('mpm_step_info', info);
    });
  }
  step(dt) {
    return this.#stepped('mpm_step', () => [dt]);
  }
  advance(tEnd, options = {}) {
    return this.#stepped('mpm_advance', (a) => [a.struct('mpm_advance_desc', { ...options, t_end: tEnd })]);
  }
  stepBegin(dt) {
    this.call('mpm_step_begin', [dt]);
  }
  stepGrid() {
    this.call('mpm_step_grid', []);
  }
  stepEnd() {
    return this.#stepped('mpm_step_end', () => []);
  }
  stepAbort() {
    this.call('mpm_step_abort', []);
  }

  // ---- reports ----
  info() {
    return this.askStruct('mpm_stepper_info', [], 'mpm_step_info');
  }
  profile(reset = false) {
    return this.askStruct('mpm_stepper_profile', [reset ? 1 : 0], 'mpm_profile');
  }
  residuals() {
    return this.arguments((a) => {
      const count = a.room('i32');
      this.call('mpm_stepper_residuals', [0, 0, count]);
      const n = this.machine.read(count, 'i32');
      const out = a.room('f64', n);
      this.call('mpm_stepper_residuals', [n, out, count]);
      return Array.from(this.machine.array('f64', out, n));
    });
  }
  contactInfo(bodyA, bodyB) {
    return this.askStruct('mpm_stepper_contact_info', [bodyA, bodyB], 'mpm_contact_info');
  }
  wallReaction(face) {
    return this.askVector('mpm_stepper_wall_reaction', [face], this.grid.dim);
  }
  wallImpulse(face) {
    return this.askVector('mpm_stepper_wall_impulse', [face], this.grid.dim);
  }
  particlesReaction(set) {
    return this.askVector('mpm_stepper_particles_reaction', [this.#set(set)], this.grid.dim);
  }
  particlesImpulse(set) {
    return this.askVector('mpm_stepper_particles_impulse', [this.#set(set)], this.grid.dim);
  }
  surfaceReaction(surface) {
    return this.askVector('mpm_stepper_surface_reaction', [this.#surface(surface)], this.grid.dim);
  }
  surfaceImpulse(surface) {
    return this.askVector('mpm_stepper_surface_impulse', [this.#surface(surface)], this.grid.dim);
  }
  map(field, access, use, body = 0) {
    return this.arguments((a) => mapped(this, 'mpm_grid_map', [body, a.text(field), access], use));
  }

  // ---- states and files ----
  save() {
    return this.arguments((a) => {
      const [bytes] = this.ask('mpm_state_size', [], ['i64']);
      const at = a.bytes(bytes);
      this.call('mpm_state_save', [at, BigInt(bytes)]);
      return this.machine.array('u8', at, bytes).slice();
    });
  }
  load(state) {
    this.arguments((a) =>
      this.call('mpm_state_load', [a.array('u8', state, undefined, 'a state'), BigInt(state.length)]),
    );
  }
  hash() {
    return this.ask('mpm_state_hash', [], ['u64'])[0];
  }
  toVti(fields = [], body = 0) {
    return pieces(this, 'mpm_write_grid_to', [body], fields);
  }
}
