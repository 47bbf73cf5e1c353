// One instance of the library in WebAssembly: its memory, how arguments get there, and how calls fail.
import { constants as C, functions, structs } from './layout.mjs';

/** What a call of the library says when it was not done. */
export class MpmError extends Error {
  constructor(status, name, text) {
    super(text);
    this.name = 'MpmError';
    this.status = status;
    this.code = name;
  }
  /** Whether a smaller step may do. */
  get retryable() {
    return this.status >= C.MPM_CUT_DT && this.status <= C.MPM_SINGULAR;
  }
}

const WIDTHS = { u8: 1, i32: 4, u32: 4, pointer: 4, i64: 8, u64: 8, id: 8, f64: 8 };
const ARRAYS = { u8: Uint8Array, i32: Int32Array, i64: BigInt64Array, f64: Float64Array };
export const TYPES = { [C.MPM_F64]: 'f64', [C.MPM_I64]: 'i64', [C.MPM_U8]: 'u8' };

const SCRATCH = 16384;
const FIRST_THROWN = -1000000000; // what a callback that throws returns, and below it what the next one does

const encoder = new TextEncoder();
const decoder = new TextDecoder();

const LIMITS = { i32: [-(2 ** 31), 2 ** 31 - 1], u32: [0, 2 ** 32 - 1], i64: [-(2 ** 63), 2 ** 63 - 1024], u8: [0, 255] };

/** An integer of a host, of a kind of C where that is given. */
function integer(value, what, kind) {
  if (!Number.isInteger(value)) throw new TypeError(`${what} is ${String(value)}, and has to be an integer`);
  if (kind && !(value >= LIMITS[kind][0] && value <= LIMITS[kind][1]))
    throw new RangeError(`${what} is ${value}, and does not fit`);
  return value;
}

/** The same for an option or an argument, in which booleans count as 0 and 1. */
function flag(value, what, kind) {
  return integer(typeof value === 'boolean' ? Number(value) : value, what, kind);
}

function real(value, what) {
  if (typeof value !== 'number') throw new TypeError(`${what} is ${String(value)}, and has to be a number`);
  return value;
}

/** The values of an array of a host as an array of the kind that the library reads. */
function converted(values, kind, what) {
  if (values instanceof ARRAYS[kind]) return values;
  if (values === null || typeof values !== 'object' || !(values.length >= 0))
    throw new TypeError(`${what} has to be an array`);
  const out = new ARRAYS[kind](values.length);
  for (let i = 0; i < out.length; i++) {
    if (kind === 'f64') out[i] = real(values[i], `${what}[${i}]`);
    else if (kind === 'i64')
      out[i] = typeof values[i] === 'bigint' ? values[i] : BigInt(integer(values[i], `${what}[${i}]`));
    else out[i] = (kind === 'u8' ? flag : integer)(values[i], `${what}[${i}]`);
    if (kind !== 'f64' && BigInt(out[i]) !== BigInt(values[i]))
      throw new RangeError(`${what}[${i}] is ${values[i]}, and does not fit`);
  }
  return out;
}

/** Arrays that are lent to a function, and have no entries when it has returned. They are memory itself where they can,
 * which ends all its arrays at once when it grows. Where a call within the function may let it grow, or lends arrays and
 * ends them, they are copies. */
class Loan {
  #machine;
  #copies;
  #buffer = null;
  constructor(machine, copies) {
    this.#machine = machine;
    this.#copies = copies ? new Map() : null;
  }
  /** Arrays of the components of what lies at an address, `stride` entries from each other. What is written to
   * them counts where they are to be filled. */
  components(kind, at, components, count, stride, filled = false) {
    if (this.#copies) return this.#copied(kind, at, components, count, stride, filled);
    this.#buffer ??= this.#machine.memory.buffer;
    return Array.from({ length: components }, (_, c) =>
      this.#machine.array(kind, at + c * stride * WIDTHS[kind], count),
    );
  }
  array(kind, at, count, filled) {
    return this.components(kind, at, 1, count, 0, filled)[0];
  }
  #copied(kind, at, components, count, stride, filled) {
    const key = [kind, at, components, count, stride].join();
    let copy = this.#copies.get(key);
    if (!copy) {
      const all = new ARRAYS[kind](components * count);
      const arrays = Array.from({ length: components }, (_, c) => all.subarray(c * count, (c + 1) * count));
      const apart = stride * WIDTHS[kind];
      const there = () => arrays.map((_, c) => this.#machine.array(kind, at + c * apart, count));
      there().forEach((one, c) => arrays[c].set(one));
      this.#copies.set(key, (copy = { arrays, there, filled, buffer: all.buffer }));
    }
    return copy.arrays;
  }
  /** Sees that no array has ended early: what is written to one without entries is lost without a word. */
  check() {
    if (this.#buffer && this.#buffer !== this.#machine.memory.buffer)
      throw new Error(
        'memory has grown in a function to which arrays were lent, and they have no entries since then: ' +
          'make calls that need memory before',
      );
  }
  end() {
    if (this.#buffer) this.#machine.memory.grow(0); // a new buffer, which takes the old one's arrays away
    if (!this.#copies?.size) return;
    const copies = [...this.#copies.values()];
    for (const { arrays, there } of copies.filter(({ filled }) => filled))
      there().forEach((one, c) => one.set(arrays[c]));
    structuredClone(null, { transfer: copies.map(({ buffer }) => buffer) });
  }
}

/** Memory for the arguments of one call. Little ones lie in memory that is there already: a call that a callback makes
 * for a name and two numbers must not let memory grow, which would end the arrays that it was lent. */
class Arguments {
  #machine;
  #owned = [];
  #mark;
  constructor(machine) {
    this.#machine = machine;
    this.#mark = machine.scratch.used;
  }
  bytes(count) {
    const scratch = this.#machine.scratch;
    if (count <= scratch.size - scratch.used) {
      scratch.used += (count + 15) & ~15;
      return scratch.at + scratch.used - ((count + 15) & ~15);
    }
    const at = count < 2 ** 32 ? this.#machine.raw.malloc(Math.max(count, 1)) >>> 0 : 0;
    if (!at) throw new MpmError(C.MPM_E_NOMEM, 'MPM_E_NOMEM', `WebAssembly has no memory for ${count} bytes`);
    this.#owned.push(at);
    return at;
  }
  /** Room for numbers that the library writes. */
  room(kind, count = 1) {
    return this.bytes(WIDTHS[kind] * count);
  }
  text(string) {
    if (typeof string !== 'string' || string.includes('\0')) throw new TypeError(`${String(string)} is no text`);
    const bytes = encoder.encode(string);
    const at = this.bytes(bytes.length + 1);
    const to = this.#machine.array('u8', at, bytes.length + 1);
    to.set(bytes);
    to[bytes.length] = 0;
    return at;
  }
  /** An array; of `length` entries where that is given. */
  array(kind, values, length, what) {
    const from = converted(values, kind, what);
    if (length !== undefined && from.length !== length) {
      throw new RangeError(`${what} has ${from.length} entries, and has to have ${length}`);
    }
    const at = this.room(kind, from.length);
    this.#machine.array(kind, at, from.length).set(from);
    return at;
  }
  /** The same, or a null pointer for what is not given. */
  optional(kind, values, length, what) {
    return values === undefined || values === null ? 0 : this.array(kind, values, length, what);
  }
  texts(list) {
    const at = this.room('pointer', list.length);
    list.forEach((one, k) => this.#machine.write(at + 4 * k, 'pointer', this.text(one)));
    return at;
  }
  /** A struct with its defaults, over which go the values that an object names as C does. */
  struct(type, values = {}) {
    const machine = this.#machine;
    const { size, fields } = structs[type];
    const at = this.bytes(size);
    machine.array('u8', at, size).fill(0);
    machine.write(at, 'u32', size);
    machine.raw[`${type}_init`]?.(at, size);
    for (const [name, value] of Object.entries(values)) {
      const field =
        Object.hasOwn(fields, name) && !['struct_size', 'reserved'].includes(name) ? fields[name] : undefined;
      if (!field || field[1] === 'pointer') throw new TypeError(`${type} has no option '${name}'`);
      if (value === undefined) continue;
      const [offset, kind, count] = field;
      if (count === undefined) {
        machine.write(at + offset, kind, value, name);
      } else {
        if (!(value?.length <= count)) throw new RangeError(`${name} has to be an array of up to ${count} numbers`);
        for (let k = 0; k < value.length; k++)
          machine.write(at + offset + k * WIDTHS[kind], kind, value[k], `${name}[${k}]`);
      }
    }
    return at;
  }
  /** Sets a field that no option names, such as a pointer. */
  put(at, type, name, value) {
    const [offset, kind] = structs[type].fields[name];
    this.#machine.write(at + offset, kind, value, name);
  }
  close() {
    this.#machine.scratch.used = this.#mark;
    for (const at of this.#owned) this.#machine.raw.free(at);
  }
}

export class Machine {
  #view = new DataView(new ArrayBuffer(0));
  #thrown = [];
  #logged;
  /** What is lent to the function that runs. */
  loan = null;
  /** How many contexts there are. */
  contexts = 0;
  constructor(exports) {
    this.raw = exports;
    this.memory = exports.memory;
    this.scratch = { at: exports.malloc(SCRATCH) >>> 0, size: SCRATCH, used: 0 };
  }

  // ---- memory: its arrays are dead once it has grown, so that none is kept ----
  get #data() {
    if (this.#view.buffer !== this.memory.buffer) this.#view = new DataView(this.memory.buffer);
    return this.#view;
  }
  array(kind, at, count) {
    return new ARRAYS[kind](this.memory.buffer, at >>> 0, count);
  }
  write(at, kind, value, what = kind) {
    if (kind === 'f64') this.#data.setFloat64(at, real(value, what), true);
    else if (kind === 'i64') this.#data.setBigInt64(at, BigInt(flag(value, what, 'i64')), true);
    else this.#data.setInt32(at, flag(value, what, kind === 'i32' ? 'i32' : 'u32'), true);
  }
  read(at, kind) {
    const data = this.#data;
    switch (kind) {
      case 'f64':
        return data.getFloat64(at, true);
      case 'i64':
        return Number(data.getBigInt64(at, true));
      case 'id':
        return data.getBigInt64(at, true);
      case 'u64':
        return data.getBigUint64(at, true);
      case 'i32':
        return data.getInt32(at, true);
      default:
        return data.getUint32(at, true);
    }
  }
  /** The numbers of a struct as an object. */
  readStruct(type, at) {
    const out = {};
    for (const [name, [offset, kind, count]] of Object.entries(structs[type].fields)) {
      if (kind === 'pointer' || kind.includes('*') || name === 'struct_size' || name === 'reserved') continue;
      out[name] =
        count === undefined
          ? this.read(at + offset, kind)
          : Array.from({ length: count }, (_, k) => this.read(at + offset + k * WIDTHS[kind], kind));
    }
    return out;
  }
  text(at) {
    if (!at) return null;
    const bytes = new Uint8Array(this.memory.buffer, at >>> 0);
    return decoder.decode(bytes.subarray(0, bytes.indexOf(0)));
  }
  /** Lends arrays for the time of a function; as copies within another such function, or where that is said. */
  lend(use, copies = false) {
    const outer = this.loan;
    const loan = new Loan(this, copies || outer !== null);
    this.loan = loan;
    try {
      const result = use();
      if (typeof result?.then === 'function')
        throw new TypeError('arrays are lent to a function that ends before it returns: it cannot be async');
      loan.check();
      return result;
    } finally {
      this.loan = outer;
      loan.end();
    }
  }
  arguments(use) {
    const made = new Arguments(this);
    try {
      return use(made);
    } finally {
      made.close();
    }
  }

  // ---- calls ----
  /** Keeps what a callback has thrown, and gives the status that stands for it. */
  keep(error) {
    this.#thrown.push(error);
    return FIRST_THROWN - (this.#thrown.length - 1);
  }
  /** Keeps what a log has thrown, which stops no call. */
  keepLogged(error) {
    this.#logged ??= { error };
  }
  /** Throws what a log has thrown. */
  tellLogged() {
    const logged = this.#logged;
    this.#logged = undefined;
    if (logged) throw logged.error;
  }
  dropLogged() {
    this.#logged = undefined;
  }
  /** Sees that the arguments of a function are what its parameters are: WebAssembly makes 0 of what is no number. */
  #check(name, values) {
    functions[name]?.forEach(([place, parameter, kind]) => {
      const value = values[place], what = `${name}: ${parameter}`;
      if (kind === 'f64') real(value, what);
      else if (typeof value !== 'bigint') flag(value, what, kind);
      else if (BigInt.asIntN(64, value) !== value) throw new RangeError(`${what} is ${value}, and does not fit`);
    });
  }
  /** Makes a call that returns a status; `info` is the address of the mpm_step_info that it fills. */
  call(context, name, values, info = 0) {
    this.#check(name, values);
    const outer = this.#thrown;
    const thrown = (this.#thrown = []);
    let status;
    try {
      status = this.raw[name](...values);
    } finally {
      this.#thrown = outer;
    }
    if (status === C.MPM_OK) return this.tellLogged();
    this.dropLogged(); // the error says more
    if (status === C.MPM_E_CALLBACK && thrown.length) {
      const said = info ? this.read(info + structs.mpm_step_info.fields.callback_status[0], 'i32') : 0;
      throw thrown[FIRST_THROWN - said] ?? thrown[0];
    }
    const error = this.error(status, context);
    if (info) error.info = this.readStruct('mpm_step_info', info);
    throw error;
  }
  error(status, context) {
    const text = context ? this.text(this.raw.mpm_last_error(context)) : '';
    return new MpmError(
      status,
      this.text(this.raw.mpm_status_name(status)),
      text || this.text(this.raw.mpm_status_text(status)),
    );
  }
}
