// libmpm in WebAssembly, for node and browsers.
import { VERSION, constants } from './layout.mjs';
import { Context } from './context.mjs';
import { Grid } from './grid.mjs';
import { Machine, MpmError } from './machine.mjs';
import { Material } from './material.mjs';
import { Obstacle } from './obstacle.mjs';
import { Particles } from './particles.mjs';
import { Stepper } from './stepper.mjs';
import { Surface } from './surface.mjs';

export { constants as C, Context, Grid, Material, MpmError, Obstacle, Particles, Stepper, Surface };

// A function that adds two vectors, (v128, v128) -> v128.
const SIMD = new Uint8Array([
  0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, 1, 7, 1, 0x60, 2, 0x7b, 0x7b, 1, 0x7b, 3, 2, 1, 0, 10, 11, 1, 9, 0, 0x20, 0, 0x20, 1,
  0xfd, 0xf0, 1, 0x0b,
]);

/** What the library finds of a system: a clock, and an environment without variables. Files do not exist here. */
function system(module, memory) {
  const MISSING = 52;
  const known = {
    clock_time_get: (clock, precision, at) => {
      const now = clock === 0 ? Date.now() : performance.now();
      new DataView(memory().buffer).setBigUint64(at, BigInt(Math.round(1e6 * now)), true);
      return 0;
    },
    environ_sizes_get: (count, bytes) => {
      const data = new DataView(memory().buffer);
      data.setUint32(count, 0, true);
      data.setUint32(bytes, 0, true);
      return 0;
    },
    environ_get: () => 0,
    proc_exit: (code) => {
      throw new Error(`libmpm ended with ${code}`);
    },
  };
  const out = {};
  for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
    if (kind !== 'function') throw new TypeError(`this is not the library: it imports ${from}.${name}`);
    (out[from] ??= {})[name] = known[name] ?? (() => MISSING);
  }
  return out;
}

async function bytesOf(source) {
  const url = source instanceof URL ? source : /^[a-z][a-z+.-]+:/i.test(source) ? new URL(source) : null;
  const isNode = typeof process === 'object' && process.versions?.node;
  if (isNode && (!url || url.protocol === 'file:')) {
    const { readFile } = await import('node:fs/promises');
    return readFile(url ?? source);
  }
  const answer = await fetch(source);
  if (!answer.ok) throw new Error(`${source}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}

/** Makes an instance of the library. `source` is a URL, a path, the bytes or a compiled module; without it the
 * binary of the package that suits the machine. */
export async function load(source) {
  const from =
    source ??
    (load.simd() ? new URL('./libmpm.simd.wasm', import.meta.url) : new URL('./libmpm.wasm', import.meta.url));
  const module =
    from instanceof WebAssembly.Module
      ? from
      : await WebAssembly.compile(typeof from === 'string' || from instanceof URL ? await bytesOf(from) : from);
  let exports;
  ({ exports } = await WebAssembly.instantiate(
    module,
    system(module, () => exports.memory),
  ));
  if (!exports.mpm_version) throw new TypeError('this is not the library: it exports no mpm_version()');
  exports._initialize?.();
  const version = exports.mpm_version();
  if (version >> 8 !== VERSION >> 8) {
    throw new Error(
      `the binary is of version 0x${version.toString(16)} of the library, the package of 0x${VERSION.toString(16)}`,
    );
  }
  return new Mpm(new Machine(exports), module);
}

/** Whether libmpm.simd.wasm runs here. */
load.simd = () => WebAssembly.validate(SIMD);

class Mpm {
  #machine;
  constructor(machine, module) {
    this.#machine = machine;
    this.module = module;
    this.raw = machine.raw;
    this.C = constants;
  }
  get version() {
    const number = this.raw.mpm_version();
    return `${number >> 16}.${(number >> 8) & 0xff}.${number & 0xff}`;
  }
  context(desc) {
    return new Context(this.#machine, desc);
  }
  models() {
    const { raw } = this;
    return Array.from({ length: raw.mpm_material_model_count() }, (_, k) =>
      this.#machine.text(raw.mpm_material_model_name(k)),
    );
  }
  /** Texts and numbers about a model, one object for each index at which there is something. */
  #described(name, model, texts, numbers) {
    const machine = this.#machine;
    return machine.arguments((a) => {
      const at = [...texts.map(() => a.room('pointer')), ...numbers.map(() => a.room('f64'))];
      const of = a.text(model);
      const out = [];
      for (;;) {
        const status = machine.raw[name](of, out.length, ...at);
        if (status === constants.MPM_E_NOT_FOUND && (out.length || this.models().includes(model))) return out;
        if (status) throw machine.error(status, 0);
        const one = {};
        texts.forEach((key, k) => (one[key] = machine.text(machine.read(at[k], 'pointer'))));
        numbers.forEach((key, k) => (one[key] = machine.read(at[texts.length + k], 'f64')));
        out.push(one);
      }
    });
  }
  parameters(model) {
    return this.#described(
      'mpm_material_model_param',
      model,
      ['name', 'unit', 'text'],
      ['value_default', 'low', 'high'],
    );
  }
  stateVariables(model) {
    return this.#described('mpm_material_state_name', model, ['name', 'unit', 'text'], []);
  }
}
