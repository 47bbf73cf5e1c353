// Sets of particles.
import { constants as C } from './layout.mjs';
import { Grid } from './grid.mjs';
import { Handle, copied, made, mapped, overwritten } from './handle.mjs';
import { MpmError, TYPES } from './machine.mjs';
import { Material } from './material.mjs';
import { pieces } from './output.mjs';

export class Particles extends Handle {
  constructor(context, grid, material) {
    const { machine } = context;
    const needs = [context, grid, material];
    const values = [
      context.at,
      Handle.address(Grid, grid, machine, 'the grid'),
      Handle.address(Material, material, machine, 'the material'),
    ];
    super(machine, context.at, 'particles', made(machine, context.at, 'mpm_particles_create', values), needs);
    this.grid = grid;
    this.material = material;
  }
  get count() {
    return Number(this.machine.raw.mpm_particles_count(this.at));
  }

  // ---- filling ----
  #filled(a, name, values) {
    const first = a.room('i64');
    const count = a.room('i64');
    this.call(name, [...values, first, count]);
    return { first_id: this.machine.read(first, 'id'), count: this.machine.read(count, 'i64') };
  }
  fillBox(lower, upper, perCell) {
    const { dim } = this.grid;
    return this.arguments((a) =>
      this.#filled(a, 'mpm_particles_fill_box', [
        a.array('f64', lower, dim, 'lower'),
        a.array('f64', upper, dim, 'upper'),
        a.array('i32', perCell, dim, 'perCell'),
      ]),
    );
  }
  fillBall(centre, radius, perCell) {
    const { dim } = this.grid;
    return this.arguments((a) =>
      this.#filled(a, 'mpm_particles_fill_ball', [
        a.array('f64', centre, dim, 'centre'),
        radius,
        a.array('i32', perCell, dim, 'perCell'),
      ]),
    );
  }
  fillMesh(position, corner, perCell) {
    const { dim } = this.grid;
    return this.arguments((a) => {
      const points = Math.floor(position.length / dim);
      const elements = Math.floor(corner.length / dim);
      return this.#filled(a, 'mpm_particles_fill_mesh', [
        BigInt(points),
        a.array('f64', position, points * dim, 'position'),
        BigInt(elements),
        a.array('i64', corner, elements * dim, 'corner'),
        a.array('i32', perCell, dim, 'perCell'),
      ]);
    });
  }
  fill(lower, upper, perCell, inside) {
    const { dim } = this.grid;
    return this.arguments((a) => {
      let range;
      const box = [
        a.array('f64', lower, dim, 'lower'),
        a.array('f64', upper, dim, 'upper'),
        a.array('i32', perCell, dim, 'perCell'),
      ];
      if (typeof inside !== 'function') throw new TypeError('inside has to be a function');
      try {
        this.functions.set('inside', 'mpm_inside_fn', inside, (call, user) => {
          range = this.#filled(a, 'mpm_particles_fill', [...box, call, user]);
        });
      } finally {
        this.functions.set('inside', 'mpm_inside_fn', null, () => {});
      }
      return range;
    });
  }
  add({ position, velocity, volume, size, ids }) {
    const { dim } = this.grid;
    return this.arguments((a) => {
      const n = volume?.length;
      if (n === undefined) throw new TypeError('volume has to be an array: it says how many particles there are');
      const first = a.room('i64');
      this.call('mpm_particles_add', [
        BigInt(n),
        a.array('f64', position, dim * n, 'position'),
        a.optional('f64', velocity, dim * n, 'velocity'),
        a.array('f64', volume, n, 'volume'),
        a.optional('f64', size, dim * n, 'size'),
        a.optional('i64', ids, n, 'ids'),
        first,
      ]);
      return this.machine.read(first, 'id');
    });
  }
  remove(ids) {
    this.arguments((a) =>
      this.call('mpm_particles_remove', [BigInt(ids.length), a.array('i64', ids, undefined, 'ids')]),
    );
  }
  pack(ids) {
    return this.arguments((a) => {
      const n = ids ? ids.length : this.count;
      const [bytes] = this.ask('mpm_particles_packed_size', [BigInt(n)], ['i64']);
      const at = a.bytes(bytes);
      const chosen = ids ? a.array('i64', ids, undefined, 'ids') : 0;
      this.call('mpm_particles_pack', [BigInt(n), chosen, at, BigInt(bytes)]);
      return this.machine.array('u8', at, bytes).slice();
    });
  }
  unpack(packed) {
    this.arguments((a) =>
      this.call('mpm_particles_unpack', [a.array('u8', packed, undefined, 'packed'), BigInt(packed.length)]),
    );
  }

  // ---- fields ----
  #field(a, index) {
    const [name, type, components, writable] = [a.room('pointer'), a.room('i32'), a.room('i32'), a.room('i32')];
    const { machine } = this;
    const status = machine.raw.mpm_particles_field_info(this.at, index, name, type, components, writable);
    if (status === C.MPM_E_NOT_FOUND) return null;
    if (status) throw machine.error(status, this.owner);
    return {
      name: machine.text(machine.read(name, 'pointer')),
      type: machine.read(type, 'i32'),
      components: machine.read(components, 'i32'),
      writable: machine.read(writable, 'i32') === 1,
    };
  }
  fields() {
    return this.arguments((a) => {
      const out = [];
      for (let one; (one = this.#field(a, out.length));) out.push(one);
      return out;
    });
  }
  #known = new Map();
  /** Type and components of a field; where there is no such field the library says so in the call. */
  #look(name) {
    if (!this.#known.has(name)) for (const one of this.fields()) this.#known.set(one.name, one);
    return this.#known.get(name) ?? { type: C.MPM_F64, components: 1 };
  }
  addField(name, type, components = 1) {
    this.arguments((a) => this.call('mpm_particles_add_field', [a.text(name), type, components]));
  }
  map(field, access, use) {
    return this.arguments((a) => mapped(this, 'mpm_particles_map', [a.text(field), access], use));
  }
  get(field, ids) {
    return copied(this, 'mpm_particles_get', this.#look(field), field, ids);
  }
  set(field, values, ids) {
    overwritten(this, 'mpm_particles_set', this.#look(field), field, values, ids);
  }
  setAll(field, value) {
    this.arguments((a) => {
      const { type, components } = this.#look(field);
      const one = typeof value === 'number' || typeof value === 'bigint' ? [value] : value;
      this.call('mpm_particles_set_all', [
        a.text(field),
        type,
        components,
        a.array(TYPES[type], one, components, field),
      ]);
    });
  }
  setGeostatic(axis, gravity, surface, K0, surcharge = 0) {
    this.call('mpm_particles_set_geostatic', [axis, gravity, surface, K0, surcharge]);
  }
  resetReference() {
    this.call('mpm_particles_reset_reference', []);
  }

  // ---- for renderers and files ----
  toFloat32(fields = ['position'], order = C.MPM_BY_ID ?? 1) {
    const { machine } = this;
    const n = this.count;
    const width = fields.reduce((sum, name) => sum + this.#look(name).components, 0);
    if (machine.raw.mpm_particles_get_f32) {
      return this.arguments((a) => {
        const out = a.bytes(4 * width * n);
        this.call('mpm_particles_get_f32', [fields.length, a.texts(fields), order, BigInt(n), out]);
        return new Float32Array(machine.memory.buffer, out, width * n).slice();
      });
    }
    if (new Set(fields).size !== fields.length || !fields.length) {
      throw new MpmError(C.MPM_E_ARG, 'MPM_E_ARG', 'toFloat32 takes one field or more, each once');
    }
    const out = new Float32Array(width * n);
    let column = 0;
    for (const name of fields) {
      const values = this.get(name);
      for (let at = 0; at < values.length; at += n, column++) {
        for (let i = 0; i < n; i++) out[i * width + column] = Number(values[at + i]);
      }
    }
    return out;
  }
  toVtp(fields = []) {
    return pieces(this, 'mpm_write_particles_to', [], fields);
  }
}
