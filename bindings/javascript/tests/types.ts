// What the declarations let through and what they refuse; compiled only.
import { C, load, MpmError, type Mpm, type StepInfo, type ParticleFunction } from 'libmpm';

const pull: ParticleFunction = (batch, [, down]) => {
  const [x] = batch.position;
  const [heat] = batch.field('heat');
  for (let i = 0; i < batch.n; i++) down[i] += batch.mass[i] * x[i] * heat[i];
};

export async function main(): Promise<bigint> {
  const mpm: Mpm = await load(new Uint8Array(8));
  using context = mpm.context({ isa: C.MPM_ISA_PORTABLE, log: (level, text) => console.log(level + 1, text.length) });
  const grid = context.grid({ dim: 2, cells: [4, 4], spacing: [1, 1], periodic: [1, 0] });
  const set = context.particles(grid, context.material('j2', { E: 1, nu: 0.3, density: 1, yield_stress: 1 }));
  const { first_id, count } = set.fillBox([0, 0], [1, 1], [2, 2]);
  const far: number = set.map('position', C.MPM_READ, ([x]) => Math.max(...x)) + count;
  const ids: BigInt64Array = set.get('id', [first_id, 1]);
  set.set('velocity', new Float64Array(2 * ids.length));
  const stepper = context.stepper(grid, { scheme: C.MPM_MUSL, reference_positions: true }).add(set).setForce(pull);
  let info: StepInfo = stepper.step(0.1);
  info = stepper.advance(far, { cfl: 0.4, max_steps: 10 });
  try {
    stepper.step(info.dt_suggested);
  } catch (error) {
    if (!(error instanceof MpmError) || !error.retryable) throw error;
    info = error.info ?? info;
  }
  stepper.setProgress(({ newton_iterations }) => (newton_iterations > 9 ? C.MPM_CANCELLED : undefined));
  const disc = context.obstacle({ shape: C.MPM_SHAPE_SPHERE, size: [1], contact: { friction: 0.3 } });
  disc.setMotion((t, dt, velocity) => {
    velocity[0] = t + dt;
  });
  const face = context.surface(grid, { pressure: 1, dead_traction: [0, 1] });
  const line = face.addPolyline([1, 1, 0, 1], false, 0.5);
  face.setTraction((batch, [along]) => {
    for (let i = 0; i < batch.n; i++) along[i] += batch.area[0][i] + batch.reference_area[i];
  });
  face.set('pressure', face.get('reference_area', face.get('id')), [line.first_id]);
  stepper.setAdaption(set, { split_edge: 0.52 }, (batch, accept) => {
    if (batch.other) accept.fill(0);
  });
  info.t += stepper.adaptionInfo(set).splits;
  stepper.setHeat(set, { specific_heat: 1 }, (batch, power) => {
    power.fill(batch.t);
  });
  stepper.setConduction(C.MPM_CONDUCTION_IMPLICIT, 1e-9).setHeatWall(C.MPM_X_MIN, C.MPM_HEAT_WALL_TEMPERATURE, 1);
  face.setHeat(1, 0.5);
  info.t += stepper.heatInfo().walls[C.MPM_X_MIN];
  stepper.addSurface(face).removeSurface(face);
  const id: bigint = info.particle;

  // @ts-expect-error: a source is an argument of its own
  stepper.setHeat(set, { specific_heat: 1, source: pull });
  // @ts-expect-error: there is no such option
  context.grid({ dim: 2, cels: [4, 4] });
  // @ts-expect-error: ids are BigInts
  const wrong: number = info.particle;
  // @ts-expect-error: a grid is no set
  stepper.add(grid);
  // @ts-expect-error: tractions are no forces of particles
  face.setTraction(pull);
  // @ts-expect-error: handles are made by the context
  new context.constructor();
  return id + stepper.hash() + BigInt(wrong);
}
