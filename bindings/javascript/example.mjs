// Two elastic disks that collide under a force of the host: the scene of bindings/example.c, with the same bits.
//
//   node example.mjs [libmpm.wasm]
import { C, load } from 'libmpm';

const mpm = await load(process.argv[2]);
const context = mpm.context({ isa: C.MPM_ISA_PORTABLE });
const grid = context.grid({ dim: 2, cells: [40, 40], spacing: [0.025, 0.025] });
const jelly = context.material('neo_hookean', { E: 1e3, nu: 0.3, density: 1e3 });

function disk(centre, velocity) {
  const set = context.particles(grid, jelly);
  set.fillBall([centre, centre], 0.15, [2, 2]);
  set.setAll('velocity', [velocity, velocity]);
  return set;
}
const disks = [disk(0.2, 0.5), disk(0.8, -0.5)];
const stepper = context.stepper(grid, { scheme: C.MPM_MUSL, projected_positions: 1 });
for (const set of disks) stepper.add(set);

// Bends the way of particles: the force is 0.05 x downwards per mass.
stepper.setForce((batch, [, down]) => {
  const { n, mass } = batch;
  const [x] = batch.position;
  for (let i = 0; i < n; i++) down[i] += mass[i] * (-0.05 * x[i]);
});
for (let step = 0; step < 400; step++) stepper.step(2e-3);

console.log(`particles ${disks[0].count + disks[1].count}`);
console.log(`time ${stepper.info().t.toFixed(6)}`);
console.log(`hash ${stepper.hash().toString(16).padStart(16, '0')}`);
