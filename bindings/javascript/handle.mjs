// Objects of the library as objects of JavaScript: who keeps whom, and when each is freed.
import { constants as C, structs } from './layout.mjs';
import { Functions, forget } from './callbacks.mjs';
import { MpmError, TYPES } from './machine.mjs';

export const dispose = Symbol.dispose ?? Symbol('Symbol.dispose');

/** An object of the library, freed when the last that needs it is gone. It knows nothing of the JavaScript objects. */
class Resource {
  uses = 1;
  constructor(machine, at, needs) {
    Object.assign(this, { machine, at, needs });
    for (const one of needs) one.uses++;
  }
  /** Ends one use. Where the library refuses to free the object, nothing has changed. */
  release(destroy) {
    if (this.uses > 1) {
      this.uses--;
      return;
    }
    const { machine, at } = this;
    const status = destroy(machine, at);
    if (status) throw machine.error(status, this.context ?? at);
    this.uses = 0;
    this.at = 0;
    forget(machine, this.used);
    for (const one of this.needs) one.release(one.destroy);
  }
}

// The net for handles that nobody disposes of. No call is under way when it runs.
const lost = new FinalizationRegistry((resource) => {
  try {
    resource.release(resource.destroy);
  } catch {
    // a view of it is out for good: it stays
  }
});

export class Handle {
  #resource;
  #keeps;
  #open = true;
  /** `needs` are the handles without which the object cannot be. */
  constructor(machine, context, name, at, needs, functions = new Functions(machine)) {
    const resource = new Resource(
      machine,
      at,
      needs.map((one) => Handle.#of(one)),
    );
    resource.context = context;
    resource.used = functions.used;
    resource.destroy = DESTROY[name];
    this.functions = functions;
    this.#resource = resource;
    this.#keeps = new Set(needs);
    lost.register(this, resource, this);
  }
  static #of(handle) {
    return handle.#resource;
  }
  /** The address of a handle of a class, which has to be of the same instance of WebAssembly. */
  static address(Class, handle, machine, what) {
    if (!(handle instanceof Class)) throw new TypeError(`${what} has to be of the class ${Class.name}`);
    if (handle.machine !== machine) throw new TypeError(`${what} is of another instance of the library`);
    return handle.at;
  }
  /** The address of the context, which has the texts of errors. */
  get owner() {
    return this.#resource.context ?? this.#resource.at;
  }
  get machine() {
    return this.#resource.machine;
  }
  get at() {
    if (!this.#open)
      throw new MpmError(C.MPM_E_ARG, 'MPM_E_ARG', `this object of the class ${this.constructor.name} was disposed of`);
    return this.#resource.at;
  }
  /** Whether dispose() has been called. */
  get disposed() {
    return !this.#open;
  }
  /** Another handle is needed from now on, or no longer. */
  keep(handle) {
    if (this.#keeps.has(handle)) return;
    this.#keeps.add(handle);
    handle.#resource.uses++;
    this.#resource.needs.push(handle.#resource);
  }
  drop(handle) {
    if (!this.#keeps.delete(handle)) return;
    const { needs } = this.#resource;
    needs.splice(needs.indexOf(handle.#resource), 1);
    handle.#resource.release(handle.#resource.destroy);
  }
  call(name, values, info = 0) {
    this.machine.call(this.owner, name, [this.at, ...values], info);
  }
  arguments(use) {
    return this.machine.arguments(use);
  }
  /** What a function of C writes through its last arguments. */
  ask(name, values, kinds) {
    return this.arguments((a) => {
      const out = kinds.map((kind) => a.room(kind));
      this.call(name, [...values, ...out]);
      return out.map((at, k) => this.machine.read(at, kinds[k]));
    });
  }
  askVector(name, values, length) {
    return this.arguments((a) => {
      const out = a.room('f64', length);
      this.call(name, [...values, out]);
      return Array.from(this.machine.array('f64', out, length));
    });
  }
  askStruct(name, values, type) {
    return this.arguments((a) => {
      const out = a.struct(type);
      this.call(name, [...values, out]);
      return this.machine.readStruct(type, out);
    });
  }
  dispose() {
    if (!this.#open) return;
    this.#resource.release(this.#resource.destroy);
    this.#open = false;
    lost.unregister(this);
  }
  [dispose]() {
    this.dispose();
  }
}

const destroy = (name) => (machine, at) => machine.raw[name](at);
const DESTROY = {
  context(machine, at) {
    const status = machine.raw.mpm_context_destroy(at);
    if (!status) machine.contexts--;
    return status;
  },
  grid: destroy('mpm_grid_destroy'),
  material: destroy('mpm_material_destroy'),
  particles: destroy('mpm_particles_destroy'),
  obstacle: destroy('mpm_obstacle_destroy'),
  surface: destroy('mpm_surface_destroy'),
  // a step that was begun goes with the stepper
  stepper(machine, at) {
    const status = machine.raw.mpm_stepper_destroy(at);
    return status === C.MPM_E_STATE && machine.raw.mpm_step_abort(at) === C.MPM_OK
      ? machine.raw.mpm_stepper_destroy(at)
      : status;
  },
};

/** Makes an object and gives its address: the library writes it through the last argument. */
export function made(machine, context, name, values) {
  return machine.arguments((a) => {
    const out = a.room('pointer');
    machine.call(context, name, [...values, out]);
    return machine.read(out, 'pointer');
  });
}

/** Copies a field of all items, or of those with the given ids; `of` is its type and components. */
export function copied(handle, name, of, field, ids) {
  const { machine } = handle;
  return machine.arguments((a) => {
    const n = ids === undefined ? handle.count : ids.length;
    const out = a.room(TYPES[of.type], of.components * n);
    const given = a.optional('i64', ids, n, 'ids');
    handle.call(name, [a.text(field), of.type, of.components, BigInt(n), given, out]);
    return machine.array(TYPES[of.type], out, of.components * n).slice();
  });
}

/** Sets a field in the same way. */
export function overwritten(handle, name, of, field, values, ids) {
  handle.machine.arguments((a) => {
    const n = ids === undefined ? handle.count : ids.length;
    const given = a.optional('i64', ids, n, 'ids');
    const array = a.array(TYPES[of.type], values, of.components * n, field);
    handle.call(name, [a.text(field), of.type, of.components, BigInt(n), given, array]);
  });
}

/** Calls `use` with arrays of a view that `name` fills, and gives the view back. */
export function mapped(handle, name, values, use) {
  const { machine } = handle;
  return machine.arguments((a) => {
    const view = a.struct('mpm_view');
    handle.call(name, [...values, view]);
    let failed = true;
    try {
      const result = machine.lend(() => {
        const {
          type,
          components,
          count,
          item_stride: stride,
          component_stride: apart,
        } = machine.readStruct('mpm_view', view);
        if (stride !== 1) throw new Error('the layout of the view is not known');
        const data = machine.read(view + structs.mpm_view.fields.data[0], 'pointer');
        const filled = (machine.read(view + structs.mpm_view.fields.access[0], 'i32') & C.MPM_WRITE) !== 0;
        return use(machine.loan.components(TYPES[type], data, components, count, apart, filled), count);
      });
      failed = false;
      return result;
    } finally {
      const status = machine.raw.mpm_view_release(view);
      if (status && !failed) throw machine.error(status, handle.owner);
    }
  });
}
