// What calls and callbacks cost from JavaScript: the scene of costs.c.
//
//   node costs.mjs PACKAGE [libmpm.wasm]
import { pathToFileURL } from 'node:url';
const { C, load } = await import(pathToFileURL(`${process.argv[2]}/libmpm.mjs`));

function pull(batch, [, down]) {
  const { n, mass } = batch;
  const [x] = batch.position;
  for (let i = 0; i < n; i++) down[i] += mass[i] * (-0.05 * x[i]);
}

const MU = 1e3 / 2.6;
const LAMBDA = 300 / (1.3 * 0.4);
const PAIRS = [
  [0, 0],
  [1, 1],
  [2, 2],
  [0, 1],
  [1, 2],
  [0, 2],
];
const law = {
  density: 1e3,
  stress(batch) {
    const { n, F, stress_new, wave_speed } = batch;
    for (let c = 0; c < 6; c++) {
      const [i, j] = PAIRS[c];
      const [a, b, d] = F.slice(3 * i, 3 * i + 3);
      const [e, f, g] = F.slice(3 * j, 3 * j + 3);
      const s = stress_new[c];
      for (let p = 0; p < n; p++) s[p] = MU * (a[p] * e[p] + b[p] * f[p] + d[p] * g[p]);
    }
    const [xx, xy, , yx, yy, , , , zz] = F;
    for (let p = 0; p < n; p++) {
      const J = (xx[p] * yy[p] - xy[p] * yx[p]) * zz[p];
      const pressure = LAMBDA * Math.log(J) - MU;
      for (let c = 0; c < 6; c++) stress_new[c][p] = (stress_new[c][p] + (c < 3 ? pressure : 0)) / J;
      wave_speed[p] = 1.16;
    }
  },
};

/** Each has an instance of its own: where one has several contexts, callbacks get copies. */
async function make(force, own) {
  const mpm = await load(process.argv[3]);
  const context = mpm.context();
  const grid = context.grid({ dim: 2, cells: [200, 200], spacing: [1 / 200, 1 / 200] });
  const material = own
    ? context.law(own)
    : context.material('neo_hookean', { E: 1e3, nu: 0.3, density: 1e3 });
  const set = context.particles(grid, material);
  set.fillBox([0.1, 0.1], [0.45, 0.45], [2, 2]);
  const stepper = context.stepper(grid, { transfer: C.MPM_APIC_MLS }).add(set);
  if (force) stepper.setForce(force);
  for (let k = 0; k < 20; k++) stepper.step(1e-4);
  return { set, stepper };
}

function best(work, inner, tries = 200) {
  let least = Infinity;
  for (let k = 0; k < tries; k++) {
    const start = performance.now();
    for (let i = 0; i < inner; i++) work();
    least = Math.min(least, (performance.now() - start) / inner);
  }
  return least;
}

const kinds = [await make(), await make(pull), await make(null, law)];
const { set } = kinds[0];
let sum = 0;
const count = best(() => (sum += set.count), 1000);
const view = best(() => set.map('position', C.MPM_READ, ([x]) => (sum += x[0])), 100);
const times = [Infinity, Infinity, Infinity];
for (let round = 0; round < 200; round++)
  kinds.forEach(({ stepper }, k) => (times[k] = Math.min(times[k], best(() => stepper.step(1e-4), 1, 5))));
const [step, force, own] = times.map((t) => 1e3 * t);
console.log(
  `${set.count} particles: count ${(1e6 * count).toFixed(0)} ns, view ${(1e6 * view).toFixed(0)} ns, step ${step.toFixed(0)} us, ` +
    `force +${(force - step).toFixed(0)} us, law +${(own - step).toFixed(0)} us`,
);
