// Functions of the host that the library calls. WebAssembly calls a JavaScript function through a trampoline, of which
// there is one for each type of callback; `user`, the first argument in C, is the number of the function.
import { callbacks, constants as C, structs } from './layout.mjs';

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
  const bytes = [0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, 1, type.length + 1, 1, ...type, // types
    2, 7, 1, 1, 0x65, 1, 0x66, 0, 0, // import e.f
    7, 5, 1, 1, 0x66, 0, 0]; // export f
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
        return machine.lend(() => ADAPTERS[type](machine, slot.run, ...values));
      } catch (error) {
        return machine.keep(error);
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

// ---- what callbacks are shown ----
/** A class whose objects show a struct of the library for the time of a callback. */
function lentStruct(type) {
  const { fields } = structs[type];
  const Batch = class {
    #machine;
    #at;
    #kept = {};
    constructor(machine, at) {
      this.#machine = machine;
      this.#at = at;
    }
    get #here() {
      if (!this.#machine) throw new Error('a batch is lent for the time of the callback alone');
      return this.#machine;
    }
    number(name) {
      return (this.#kept[name] ??= this.#here.read(this.#at + fields[name][0], fields[name][1]));
    }
    /** Arrays of a field: one, or one for each component. */
    arrays(name, dim) {
      const machine = this.#here;
      const [offset, kind, ...shape] = fields[name];
      const at = machine.read(this.#at + offset, 'pointer');
      if (!at) return undefined;
      const of = kind.slice(0, -1);
      if (shape.length === 1) return machine.array(of, at, this.number('n'));
      const components = dim ?? (fields[shape[0]] ? this.number(shape[0]) : Number(shape[0]));
      return machine.components(of, at, components, this.number('n'), this.number('ld'));
    }
    /** Arrays of what a callback is given beside the batch. */
    beside(kind, at, components = this.number('dim')) {
      return this.#here.components(kind, at, components, this.number('n'), this.number('ld'));
    }
    field(name, components = 1, kind = 'f64') {
      const machine = this.#here;
      return machine.arguments((a) => {
        const data = a.room('pointer');
        const stride = a.room('i64');
        const status = machine.raw.mpm_batch_field(machine.read(this.#at + fields.lookup[0], 'pointer'), a.text(name), data, stride);
        if (status) throw machine.error(status, 0);
        return machine.components(kind, machine.read(data, 'pointer'), components, this.number('n'), machine.read(stride, 'i64'));
      });
    }
    end() {
      this.#machine = null;
    }
  };
  const known = (name) => name in fields || /^\d+$/.test(name) || name === 'ld';
  for (const [name, [, kind, ...shape]] of Object.entries(fields)) {
    if (name === 'struct_size' || name === 'reserved' || kind === 'pointer') continue;
    if (!kind.endsWith('*')) {
      Object.defineProperty(Batch.prototype, name, { get() { return this.number(name); } });
    } else if (!known(shape[0])) {
      Batch.prototype[name] = function (dim) { return this.arrays(name, dim); };
    } else {
      Object.defineProperty(Batch.prototype, name, { get() { return this.arrays(name); } });
    }
  }
  return Batch;
}

const BATCHES = Object.fromEntries(Object.keys(structs).filter((name) => name.endsWith('_batch')).map((name) => [name, lentStruct(name)]));

/** What a callback returns, as a status: nothing for "go on". */
function status(result) {
  if (result === undefined || result === null) return C.MPM_OK;
  if (!Number.isInteger(result)) throw new TypeError(`a callback returned ${typeof result?.then === 'function' ? 'a promise' : String(result)}; it returns nothing, or a status`);
  return result;
}

const withBatch = (type, use) => (machine, run, at, ...values) => {
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
    run(batch, batch.beside('u8', prescribed), batch.beside('f64', velocity))),
  mpm_node_fn: withBatch('mpm_node_batch', (m, run, batch, velocity, force) =>
    run(batch, batch.beside('f64', velocity), batch.beside('f64', force))),
  mpm_friction_fn: withBatch('mpm_contact_batch', (m, run, batch, friction) => run(batch, batch.beside('f64', friction, 1)[0])),
  mpm_distance_fn: withBatch('mpm_distance_batch', (m, run, batch) => run(batch)),
  mpm_stress_fn: withBatch('mpm_material_batch', (m, run, batch) => run(batch)),
  mpm_tangent_fn: withBatch('mpm_material_batch', (m, run, batch, tangent, symmetric) => {
    const result = run.tangent(batch, batch.beside('f64', tangent, run.tangent.components));
    m.write(symmetric, 'i32', result === true);
    return typeof result === 'boolean' ? undefined : result;
  }),
  mpm_progress_fn: (m, run, info) => status(run(m.readStruct('mpm_step_info', info))),
  mpm_motion_fn: (m, run, t, dt, velocity, angular) => status(run(t, dt, m.array('f64', velocity, 3), m.array('f64', angular, 3))),
  mpm_inside_fn: (m, run, dim, n, ld, position, inside) =>
    status(run(m.components('f64', position, dim, Number(n), Number(ld)), m.array('u8', inside, Number(n)))),
  mpm_context_desc_log_fn: (m, run, level, text) => void run(level, m.text(text)),
  mpm_write_fn: (m, run, data, bytes) => status(run(m.array('u8', data, Number(bytes)))),
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

/** The linear system of an implicit step, for the time of the solver's call. */
class System {
  #machine;
  #at;
  #info;
  #arrays;
  constructor(machine, at, dim) {
    this.#machine = machine;
    this.#at = at;
    machine.arguments((a) => {
      const info = a.struct('mpm_operator_info');
      const status = machine.raw.mpm_operator_get_info(at, info);
      if (status) throw machine.error(status, 0);
      this.#info = machine.readStruct('mpm_operator_info', info);
      const { fields } = structs.mpm_operator_info;
      const address = (name) => machine.read(info + fields[name][0], 'pointer');
      this.#arrays = { node: address('node'), component: address('component'), position: address('position'), dim };
    });
    Object.assign(this, this.#info);
  }
  get #here() {
    if (!this.#machine) throw new Error('a system is lent for the time of the solver alone');
    return this.#machine;
  }
  get node() {
    return this.#here.array('i64', this.#arrays.node, this.rows);
  }
  get component() {
    return this.#here.array('i32', this.#arrays.component, this.rows);
  }
  get position() {
    return this.#here.components('f64', this.#arrays.position, this.#arrays.dim, this.rows, this.ld);
  }
  apply(x) {
    const machine = this.#here;
    return machine.arguments((a) => {
      const from = a.array('f64', x, this.rows, 'x');
      const to = a.room('f64', this.rows);
      const status = machine.raw.mpm_operator_apply(this.#at, from, to);
      if (status) throw machine.error(status, 0);
      return machine.array('f64', to, this.rows).slice();
    });
  }
  csr() {
    const machine = this.#here;
    return machine.arguments((a) => {
      const out = a.room('pointer', 3);
      const status = machine.raw.mpm_operator_csr(this.#at, out, out + 4, out + 8);
      if (status) throw machine.error(status, 0);
      const [start, column, value] = [0, 4, 8].map((k) => machine.read(out + k, 'pointer'));
      return {
        row_start: machine.array('i64', start, this.rows + 1).slice(),
        column: machine.array('i32', column, this.nonzeros).slice(),
        value: machine.array('f64', value, this.nonzeros).slice(),
      };
    });
  }
  end() {
    this.#machine = null;
  }
}
