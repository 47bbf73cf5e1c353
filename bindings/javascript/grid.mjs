// The background grid.
import { structs } from './layout.mjs';
import { Handle, made } from './handle.mjs';

export class Grid extends Handle {
  constructor(context, desc = {}) {
    const { machine } = context;
    let dim;
    const at = machine.arguments((a) => {
      const to = a.struct('mpm_grid_desc', desc);
      dim = machine.read(to + structs.mpm_grid_desc.fields.dim[0], 'i32');
      return made(machine, context.at, 'mpm_grid_create', [context.at, to]);
    });
    super(machine, context.at, 'grid', at, [context]);
    this.dim = dim;
  }
}
