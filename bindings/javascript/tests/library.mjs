// What the tests share: the binary that is tested, and a small scene.
import { C, load } from 'libmpm';

export const mpm = await load(process.env.LIBMPM_WASM || undefined);

export function scene({
  library = mpm,
  dim = 2,
  desc = {},
  law = ['neo_hookean', { E: 1e3, nu: 0.3, density: 1e3 }],
  velocity = 0.5,
} = {}) {
  const context = library.context({ isa: C.MPM_ISA_PORTABLE });
  const grid = context.grid({ dim, cells: Array(dim).fill(16), spacing: Array(dim).fill(1 / 16) });
  const material = typeof law === 'object' && !Array.isArray(law) ? context.law(law) : context.material(...law);
  const set = context.particles(grid, material);
  set.fillBox(Array(dim).fill(0.3), Array(dim).fill(0.6), Array(dim).fill(2));
  set.setAll('velocity', Array(dim).fill(velocity));
  const stepper = context.stepper(grid, desc).add(set);
  return { context, grid, material, set, stepper };
}
