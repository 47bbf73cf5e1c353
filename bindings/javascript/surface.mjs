// Surfaces: markers without mass that carry loads on the boundary of the material, or prescribe how it moves.
import { constants as C } from './layout.mjs';
import { Grid } from './grid.mjs';
import { Handle, copied, made, overwritten } from './handle.mjs';

const SCALARS = ['id', 'reference_area', 'pressure'];

export class Surface extends Handle {
  constructor(context, grid, desc = {}) {
    const { machine } = context;
    const at = machine.arguments((a) =>
      made(machine, context.at, 'mpm_surface_create', [
        context.at,
        Handle.address(Grid, grid, machine, 'the grid'),
        a.struct('mpm_surface_desc', desc),
      ]),
    );
    super(machine, context.at, 'surface', at, [context, grid]);
    this.grid = grid;
  }
  configure(desc = {}) {
    this.arguments((a) => this.call('mpm_surface_configure', [a.struct('mpm_surface_desc', desc)]));
  }
  setTraction(run) {
    this.functions.set('traction', 'mpm_traction_fn', run, (call, user) =>
      this.call('mpm_surface_set_traction', [call, user]),
    );
  }
  setVelocity(run) {
    this.functions.set('velocity', 'mpm_marker_velocity_fn', run, (call, user) =>
      this.call('mpm_surface_set_velocity', [call, user]),
    );
  }
  setHeat(flux, film = 0, ambient = 0) {
    this.call('mpm_surface_set_heat', [flux, film, ambient]);
  }

  // ---- markers ----
  get count() {
    return Number(this.machine.raw.mpm_surface_count(this.at));
  }
  add({ position, area }) {
    const { dim } = this.grid;
    return this.arguments((a) => {
      const n = Math.floor((position?.length ?? 0) / dim);
      const first = a.room('i64');
      this.call('mpm_surface_add', [
        BigInt(n),
        a.array('f64', position, dim * n, 'position'),
        a.optional('f64', area, dim * n, 'area'),
        first,
      ]);
      return this.machine.read(first, 'id');
    });
  }
  #added(a, name, values) {
    const first = a.room('i64');
    const count = a.room('i64');
    this.call(name, [...values, first, count]);
    return { first_id: this.machine.read(first, 'id'), count: this.machine.read(count, 'i64') };
  }
  addPolyline(position, closed, spacing) {
    return this.arguments((a) => {
      const n = Math.floor((position?.length ?? 0) / 2);
      const points = a.array('f64', position, 2 * n, 'position');
      return this.#added(a, 'mpm_surface_add_polyline', [BigInt(n), points, closed ? 1 : 0, spacing]);
    });
  }
  addTriangles(position, corner, spacing) {
    return this.arguments((a) => {
      const n = Math.floor((position?.length ?? 0) / 3);
      const triangles = Math.floor((corner?.length ?? 0) / 3);
      return this.#added(a, 'mpm_surface_add_triangles', [
        BigInt(n),
        a.array('f64', position, 3 * n, 'position'),
        BigInt(triangles),
        a.array('i64', corner, 3 * triangles, 'corner'),
        spacing,
      ]);
    });
  }
  remove(ids) {
    this.arguments((a) => this.call('mpm_surface_remove', [BigInt(ids.length), a.array('i64', ids, undefined, 'ids')]));
  }
  refine(spacing) {
    return this.ask('mpm_surface_refine', [spacing], ['i64'])[0];
  }

  // ---- fields ----
  /** Type and components of a field; where there is no such field the library says so in the call. */
  #look(field) {
    return {
      type: field === 'id' ? C.MPM_I64 : C.MPM_F64,
      components: SCALARS.includes(field) ? 1 : this.grid.dim,
    };
  }
  get(field, ids) {
    return copied(this, 'mpm_surface_get', this.#look(field), field, ids);
  }
  set(field, values, ids) {
    overwritten(this, 'mpm_surface_set', this.#look(field), field, values, ids);
  }
}
