// What callbacks are shown: structs and systems of the library, for the time of a call.
import { structs } from './layout.mjs';

/** A class whose objects show a struct of the library for the time of a callback. */
function lentStruct(type) {
  const { fields } = structs[type];
  const Batch = class {
    #machine;
    #at;
    #loan;
    #kept = {};
    constructor(machine, at) {
      this.#machine = machine;
      this.#at = at;
      this.#loan = machine.loan;
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
      const of = kind.slice(0, kind.indexOf('*'));
      const filled = kind.endsWith('out');
      if (shape.length === 1) return this.#loan.array(of, at, this.number('n'), filled);
      const components = dim ?? (fields[shape[0]] ? this.number(shape[0]) : Number(shape[0]));
      return this.#loan.components(of, at, components, this.number('n'), this.number('ld'), filled);
    }
    /** Arrays that a callback is given beside the batch, to be filled. */
    beside(kind, at, components = this.number('dim')) {
      return this.#loan.components(kind, at, components, this.number('n'), this.number('ld'), true);
    }
    field(name, components = 1, kind = 'f64') {
      const machine = this.#here;
      return machine.arguments((a) => {
        const data = a.room('pointer');
        const stride = a.room('i64');
        const status = machine.raw.mpm_batch_field(
          machine.read(this.#at + fields.lookup[0], 'pointer'),
          a.text(name),
          data,
          stride,
        );
        if (status) throw machine.error(status, 0);
        return this.#loan.components(
          kind,
          machine.read(data, 'pointer'),
          components,
          this.number('n'),
          machine.read(stride, 'i64'),
        );
      });
    }
    end() {
      this.#machine = null;
    }
  };
  const known = (name) => name in fields || /^\d+$/.test(name) || name === 'ld';
  for (const [name, [, kind, ...shape]] of Object.entries(fields)) {
    if (name === 'struct_size' || name === 'reserved' || kind === 'pointer') continue;
    if (!kind.includes('*')) {
      Object.defineProperty(Batch.prototype, name, {
        get() {
          return this.number(name);
        },
      });
    } else if (!known(shape[0])) {
      Batch.prototype[name] = function (dim) {
        return this.arrays(name, dim);
      };
    } else {
      Object.defineProperty(Batch.prototype, name, {
        get() {
          return this.arrays(name);
        },
      });
    }
  }
  return Batch;
}

export const BATCHES = Object.fromEntries(
  Object.keys(structs)
    .filter((name) => name.endsWith('_batch'))
    .map((name) => [name, lentStruct(name)]),
);

/** The linear system of an implicit step, for the time of the solver's call. Its arrays are copies, because csr() may
 * let memory grow. */
export class System {
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
    return this.#here.array('i64', this.#arrays.node, this.rows).slice();
  }
  get component() {
    return this.#here.array('i32', this.#arrays.component, this.rows).slice();
  }
  get position() {
    const { position, dim } = this.#arrays;
    return Array.from({ length: dim }, (_, c) =>
      this.#here.array('f64', position + 8 * c * this.ld, this.rows).slice(),
    );
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
