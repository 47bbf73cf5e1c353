// Functions of the host that the library calls. WebAssembly calls a JavaScript function through a trampoline, of which
// there is one for each type of callback; `user`, the first argument in C, is the number of the function.
import { callbacks, constants as C } from './layout.mjs';
import { BATCHES, System } from './batches.mjs';

const CODES = { i32: 0x7f, i64: 0x7e, f64: 0x7c };
const numbers = new WeakMap(); // machine -> { next, functions, trampolines }

const of = (machine) => {
  let known = numbers.get(machine);
  if (!known) numbers.set(machine, (known = { next: 1, functions: new Map(), trampolines: new Map() }));
  return known;
};

/** A module with one function, which calls the one that it imports. */
function trampoline(parameters, results, call) {
  const type = [0x60, parameters.length, ...parameters.map((one) => CODES[one]), results, ...(results ? [0x7f] : [])];
  const bytes = [
    0,
    0x61,
    0x73,
    0x6d,
    1,
    0,
    0,
    0,
    1,
    type.length + 1,
    1,
    ...type, // types
    2,
    7,
    1,
    1,
    0x65,
    1,
    0x66,
    0,
    0, // import e.f
    7,
    5,
    1,
    1,
    0x66,
    0,
    0,
  ]; // export f
  return new WebAssembly.Instance(new WebAssembly.Module(new Uint8Array(bytes)), { e: { f: call } }).exports.f;
}

function addressOf(machine, type) {
  const { functions, trampolines } = of(machine);
  if (!trampolines.has(type)) {
    const [parameters, results] = callbacks[type];
    const call = (user, ...values) => {
      try {
        const slot = functions.get(user)?.deref();
        if (!slot) throw new Error('a callback was called after its owner was disposed of');
        // calls of a callback on its own context are refused; those on another may let memory grow
        return machine.lend(() => ADAPTERS[type](machine, slot.run, ...values), machine.contexts > 1);
      } catch (error) {
        if (results) return machine.keep(error);
        machine.keepLogged(error);
      }
    };
    const table = machine.raw.__indirect_function_table;
    const index = table.grow(1);
    table.set(index, trampoline(parameters, results, results ? call : (...values) => void call(...values)));
    trampolines.set(type, index);
  }
  return trampolines.get(type);
}

/** The functions that one object has given to the library. Who keeps this object keeps them. */
export class Functions {
  #machine;
  #slots = new Map();
  /** The numbers in use, for who takes them away when this object is gone. */
  used = new Set();
  constructor(machine) {
    this.#machine = machine;
  }
  /** Hands a function (or null) to `use(address, number)`, and forgets the one before under that key. */
  set(key, type, run, use) {
    if (run === null || run === undefined) {
      use(0, 0);
      this.#forget(key);
      return;
    }
    if (typeof run !== 'function') throw new TypeError('a callback has to be a function, or null for none');
    const known = of(this.#machine);
    const number = known.next++;
    const slot = { run, number };
    known.functions.set(number, new WeakRef(slot));
    this.used.add(number);
    try {
      use(addressOf(this.#machine, type), number);
    } catch (error) {
      known.functions.delete(number);
      this.used.delete(number);
      throw error;
    }
    this.#forget(key);
    this.#slots.set(key, slot);
  }
  /** The address of a type of callback, for a struct in which several share one `user`. */
  address(type) {
    return addressOf(this.#machine, type);
  }
  #forget(key) {
    const slot = this.#slots.get(key);
    if (!slot) return;
    this.#slots.delete(key);
    this.used.delete(slot.number);
    of(this.#machine).functions.delete(slot.number);
  }
}

export function forget(machine, used) {
  for (const number of used) of(machine).functions.delete(number);
}

/** What a callback returns, as a status: nothing for "go on". */
function status(result) {
  if (result === undefined || result === null) return C.MPM_OK;
  if (!Number.isInteger(result))
    throw new TypeError(
      `a callback returned ${typeof result?.then === 'function' ? 'a promise' : String(result)}; it returns nothing, or a status`,
    );
  if (result !== (result | 0)) throw new RangeError(`a callback returned ${result}, which is no status`);
  return result;
}

const withBatch =
  (type, use) =>
  (machine, run, at, ...values) => {
    const batch = new BATCHES[type](machine, at);
    try {
      return status(use(machine, run, batch, ...values));
    } finally {
      batch.end();
    }
  };

const ADAPTERS = {
  mpm_particle_fn: withBatch('mpm_particle_batch', (m, run, batch, add) => run(batch, batch.beside('f64', add))),
  mpm_velocity_fn: withBatch('mpm_node_batch', (m, run, batch, prescribed, velocity) =>
    run(batch, batch.beside('u8', prescribed), batch.beside('f64', velocity)),
  ),
  mpm_node_fn: withBatch('mpm_node_batch', (m, run, batch, velocity, force) =>
    run(batch, batch.beside('f64', velocity), batch.beside('f64', force)),
  ),
  mpm_friction_fn: withBatch('mpm_contact_batch', (m, run, batch, friction) =>
    run(batch, batch.beside('f64', friction, 1)[0]),
  ),
  mpm_adaption_fn: withBatch('mpm_adaption_batch', (m, run, batch, accept) =>
    run(batch, batch.beside('u8', accept, 1)[0]),
  ),
  mpm_heat_fn: withBatch('mpm_particle_batch', (m, run, batch, power) => run(batch, batch.beside('f64', power, 1)[0])),
  mpm_distance_fn: withBatch('mpm_distance_batch', (m, run, batch) => run(batch)),
  mpm_traction_fn: withBatch('mpm_marker_batch', (m, run, batch, add) => run(batch, batch.beside('f64', add))),
  mpm_marker_velocity_fn: withBatch('mpm_marker_batch', (m, run, batch, add) => run(batch, batch.beside('f64', add))),
  mpm_stress_fn: withBatch('mpm_material_batch', (m, run, batch) => run(batch)),
  mpm_tangent_fn: withBatch('mpm_material_batch', (m, run, batch, tangent, symmetric) => {
    const result = run.tangent(batch, batch.beside('f64', tangent, run.tangent.components));
    m.write(symmetric, 'i32', result === true);
    return typeof result === 'boolean' ? undefined : result;
  }),
  mpm_progress_fn: (m, run, info) => status(run(m.readStruct('mpm_step_info', info))),
  mpm_motion_fn: (m, run, t, dt, velocity, angular) =>
    status(run(t, dt, m.loan.array('f64', velocity, 3, true), m.loan.array('f64', angular, 3, true))),
  mpm_inside_fn: (m, run, dim, n, ld, position, inside) =>
    status(
      run(
        m.loan.components('f64', position, dim, Number(n), Number(ld)),
        m.loan.array('u8', inside, Number(n), true),
      ),
    ),
  mpm_context_desc_log_fn: (m, run, level, text) => void run(level, m.text(text)),
  mpm_write_fn: (m, run, data, bytes) => status(run(m.loan.array('u8', data, Number(bytes)))),
  mpm_solve_fn: (m, run, matrix, rhs, solution, tolerance, iterations) => {
    const system = new System(m, matrix, run.dim);
    try {
      // copies, because what the solver asks of the system may let memory grow
      const found = m.array('f64', solution, system.rows).slice();
      const result = run(system, m.array('f64', rhs, system.rows).slice(), found, tolerance);
      if (result === false) return C.MPM_CUT_DT;
      m.array('f64', solution, system.rows).set(found);
      m.write(iterations, 'i64', result ?? 0, 'the number of iterations');
      return C.MPM_OK;
    } finally {
      system.end();
    }
  },
};
