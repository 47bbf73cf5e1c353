// Options, errors, lifetimes, fields, states.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import * as library from 'libmpm';
import { mpm, scene } from './library.mjs';

const { C, MpmError, load } = library;

const refused = (status, sentence) => (error) =>
  error instanceof MpmError && error.status === C[status] && error.code === status && sentence.test(error.message);

test('errors have the sentence of the library', () => {
  const context = mpm.context();
  assert.throws(() => context.material('neo_hookian', {}), refused('MPM_E_NOT_FOUND', /neo_hookian.*neo_hookean/));
  assert.throws(() => context.material('neo_hookean', { E: -1, nu: 0.3, density: 1 }), refused('MPM_E_ARG', /E/));
  assert.throws(() => context.grid({ dim: 4, cells: [1], spacing: [1] }), refused('MPM_E_ARG', /dim/));
  assert.throws(() => mpm.context({ concurrency: 4 }), refused('MPM_E_UNSUPPORTED', /thread/));
  assert.match(context.lastError(), /dim/);
});

test('options are checked before they reach the library', () => {
  const context = mpm.context();
  assert.throws(() => context.grid({ dim: 2, cels: [4, 4] }), /no option 'cels'/);
  assert.throws(() => context.grid({ struct_size: 8 }), /no option 'struct_size'/);
  assert.throws(() => context.grid({ dim: 2.5 }), /dim is 2.5/);
  assert.throws(() => context.grid({ dim: 2 ** 32 + 2 }), /does not fit/);
  assert.throws(() => context.grid({ dim: 2, cells: [4, 4, 4, 4] }), /up to 3/);
  assert.throws(() => context.grid({ dim: 2, spacing: ['1', 1] }), /has to be a number/);
  assert.throws(() => mpm.context({ alloc: () => 0 }), /no option 'alloc'/);
  const { set, stepper } = scene();
  assert.throws(() => set.fillBox([0, 0, 0], [1, 1, 1], [2, 2, 2]), /lower has 3 entries/);
  assert.throws(() => set.setAll('velocity', [1]), /velocity has 1 entries/);
  assert.throws(() => stepper.add(stepper), /has to be of the class Particles/);
  assert.throws(() => set.set('velocity', new Float64Array(3)), /entries/);
});

test('arguments are checked before WebAssembly makes numbers of them', () => {
  const { context, set, stepper } = scene();
  const before = stepper.hash();
  assert.throws(() => stepper.setWall(undefined, C.MPM_WALL_SLIP), /face is undefined/);
  assert.throws(() => stepper.setWall(2 ** 32, C.MPM_WALL_SLIP), /face is 4294967296, and does not fit/);
  assert.throws(() => stepper.setWall(C.MPM_X_MIN, C.MPM_WALL_FRICTION, '0.5'), /friction is 0.5, and has to be a number/);
  assert.throws(() => stepper.setBody(set, 1.7), /body is 1.7/);
  assert.throws(() => stepper.setTime(0, 2 ** 64), /does not fit/);
  assert.throws(() => context.grid({ dim: 2, cells: [2 ** 64 + 4096, 4], spacing: [1, 1] }), /does not fit/);
  assert.equal(stepper.hash(), before);
  const mask = [true, false, true];
  assert.throws(() => set.get('mass', mask), /has to be an integer/);
  assert.throws(() => set.remove(mask), /has to be an integer/);
  assert.equal(stepper.hash(), before);
  set.set('prescribed', [true, false], [0]); // of bytes, where booleans are numbers
  assert.equal(set.get('prescribed', [0])[0], 1);
});

test('an object of another instance is refused', async () => {
  const other = await load(mpm.module);
  const { grid, material } = scene();
  assert.throws(() => other.context().particles(grid, material), /another instance/);
});

test('objects are freed in any order, and those in use stay', () => {
  const { context, grid, material, set, stepper } = scene();
  for (const one of [context, grid, material, set]) one.dispose();
  assert.equal(stepper.step(1e-3).step, 1);
  assert.throws(() => set.count, refused('MPM_E_ARG', /disposed of/));
  assert.equal(set.disposed, true);
  set.dispose();
  stepper.dispose();
  assert.throws(() => stepper.step(1e-3), /disposed of/);
});

test('all memory comes back', () => {
  const kept = mpm.context();
  const { raw } = mpm;
  const round = () => {
    const { context, grid, material, set, stepper } = scene();
    stepper.setForce(() => {});
    stepper.step(1e-3);
    stepper.save();
    set.map('position', C.MPM_READ, () => {});
    assert.throws(() => set.get('no_such_field'));
    assert.throws(() => stepper.step(-1));
    for (const one of [stepper, set, material, grid, context]) one.dispose();
  };
  for (let k = 0; k < 5; k++) round();
  const before = raw.memory.buffer.byteLength;
  const at = raw.malloc(64);
  raw.free(at);
  for (let k = 0; k < 300; k++) round();
  assert.equal(raw.memory.buffer.byteLength, before);
  kept.dispose();
});

test('dispose() is refused where the library refuses, and may be called again', () => {
  const { set, stepper } = scene();
  const free = mpm.context();
  set.map('position', C.MPM_READ, () => {
    assert.throws(() => stepper.remove(set), refused('MPM_E_STATE', /mapped/));
  });
  let inside;
  stepper.setProgress(() => {
    assert.throws(() => stepper.dispose(), refused('MPM_E_STATE', /./));
    inside = true;
  });
  stepper.step(1e-3);
  assert.equal(inside, true);
  assert.equal(stepper.step(1e-3).step, 2);
  stepper.stepBegin(1e-3);
  stepper.dispose(); // with the step that was begun
  set.dispose();
  free.dispose();
});

test('what nobody holds is collected', async () => {
  assert.equal(typeof globalThis.gc, 'function', 'run with --expose-gc');
  const other = await load(mpm.module);
  const at = (() => {
    const context = other.context();
    const grid = context.grid({ dim: 2, cells: [8, 8], spacing: [1, 1] });
    const set = context.particles(grid, context.material('neo_hookean', { E: 1, nu: 0.3, density: 1 }));
    set.fillBox([2, 2], [5, 5], [2, 2]);
    const stepper = context.stepper(grid).add(set);
    stepper.setForce(() => void stepper); // a circle through the callback
    stepper.step(1e-3);
    return context.at;
  })();
  // the library itself says that the context is gone
  for (let k = 0; k < 50; k++) {
    await new Promise((done) => setTimeout(done, 10));
    globalThis.gc();
    if (other.raw.mpm_context_memory(at, 0, 0) === C.MPM_E_ARG) return;
  }
  assert.fail('the context lives on');
});

test('fields as copies', () => {
  const { set } = scene();
  const n = set.count;
  const ids = set.get('id');
  assert.ok(ids instanceof BigInt64Array && ids.length === n);
  const x = set.get('position');
  assert.equal(x.length, 2 * n);
  assert.deepEqual(Array.from(set.get('position', [3, 0n])), [x[3], x[0], x[n + 3], x[n]]);
  set.set('velocity', [1, 2, 3, 4], [3, 0]);
  assert.deepEqual(Array.from(set.get('velocity', [0, 3])), [2, 1, 4, 3]);
  set.addField('heat', C.MPM_F64);
  set.addField('flag', C.MPM_U8, 2);
  set.addField('label', C.MPM_I64);
  set.setAll('heat', 7);
  set.setAll('flag', [1, 255]);
  set.setAll('label', 2n ** 60n);
  assert.deepEqual(Array.from(set.get('flag', [0])), [1, 255]);
  assert.equal(set.get('label', [5])[0], 2n ** 60n);
  assert.equal(set.get('heat')[n - 1], 7);
  assert.throws(() => set.setAll('flag', [1, 256]), /does not fit/);
  assert.throws(() => set.get('hat'), refused('MPM_E_NOT_FOUND', /hat/));
  assert.deepEqual(
    set.fields().find(({ name }) => name === 'flag'),
    { name: 'flag', type: C.MPM_U8, components: 2, writable: true },
  );
  const first = set.add({ position: [0.5, 0.25], volume: [1e-3], ids: [1000] });
  assert.equal(first, 1000n);
  set.remove([1000]);
  assert.equal(set.count, n);
  assert.throws(() => set.remove([1000]), refused('MPM_E_NOT_FOUND', /1000/));
});

test('fills by a function, and floats for renderers', () => {
  const { context, grid, material } = scene();
  const set = context.particles(grid, material);
  const filled = set.fill([0, 0], [1, 1], [1, 1], ([x, y], inside) => {
    for (let i = 0; i < x.length; i++) inside[i] = x[i] > y[i];
  });
  assert.deepEqual(filled, { first_id: 0n, count: 120 });
  const floats = set.toFloat32(['position', 'mass']);
  const x = set.get('position');
  const mass = set.get('mass');
  assert.equal(floats.length, 360);
  for (let i = 0; i < 120; i++) {
    assert.deepEqual(
      [...floats.subarray(3 * i, 3 * i + 3)],
      [Math.fround(x[i]), Math.fround(x[120 + i]), Math.fround(mass[i])],
    );
  }
  assert.throws(() => set.toFloat32(['position', 'position']), refused('MPM_E_ARG', /./));
  const all = set.pack();
  const some = set.pack([3, 1]);
  assert.throws(() => set.unpack(some), refused('MPM_E_ARG', /is in use/));
  set.remove([1, 3]);
  set.unpack(some);
  assert.deepEqual(set.pack(), all);
  some[some.length - 1] ^= 1;
  assert.throws(() => set.unpack(some), refused('MPM_E_FORMAT', /damaged/));
  const error = new RangeError('mine');
  assert.throws(
    () =>
      set.fill([0, 0], [1, 1], [1, 1], () => {
        throw error;
      }),
    (thrown) => thrown === error,
  );
  assert.equal(set.count, 120);
});

test('files of VTK as bytes, where the library writes them', () => {
  const { set, stepper } = scene();
  stepper.step(1e-3);
  if (!mpm.raw.mpm_write_particles_to) {
    assert.throws(() => set.toVtp(), refused('MPM_E_UNSUPPORTED', /mpm_write_particles_to/));
    return;
  }
  const text = new TextDecoder('latin1').decode(set.toVtp(['velocity']));
  assert.match(text, /^<\?xml.*PolyData.*velocity/s);
  assert.match(text, new RegExp(`NumberOfPoints="${set.count}"`));
  assert.match(new TextDecoder('latin1').decode(stepper.toVti(['mass'])), /^<\?xml.*ImageData.*mass/s);
  assert.throws(() => set.toVtp(['hat']), refused('MPM_E_NOT_FOUND', /hat/));
});

test('what is lent is taken back, whatever the memory does', () => {
  const { set } = scene();
  let kept;
  const sum = set.map('position', C.MPM_READ, (components, count) => {
    kept = components;
    assert.equal(components.length, 2);
    assert.ok(count >= set.count && components[0].length === count);
    return components[0].reduce((a, b) => a + b);
  });
  assert.ok(sum > 0);
  assert.equal(kept[0].length, 0);
  set.map('velocity', C.MPM_READ | C.MPM_WRITE, ([x]) => {
    const [within] = set.map('velocity', C.MPM_READ, ([same]) => {
      x.fill(-1);
      return [same];
    });
    assert.equal(within.length, 0);
    assert.equal(x[0], -1);
  });
  const v = set.get('velocity');
  assert.equal(v[0], -1);
  assert.equal(v[set.count], 0.5);
  assert.throws(() => set.map('velocity', C.MPM_WRITE, ([x]) => x.fill(NaN)), refused('MPM_E_ARG', /finite|NaN/i));
  set.setAll('velocity', [0, 0]);
  assert.throws(() => set.map('mass', C.MPM_READ, async () => {}), /cannot be async/);
  assert.throws(() => set.map('volume', C.MPM_WRITE, () => {}), refused('MPM_E_ARG', /volume/));
  const mine = new Error('mine');
  assert.throws(
    () =>
      set.map('velocity', C.MPM_WRITE, () => {
        throw mine;
      }),
    (error) => error === mine,
  );
  set.setAll('velocity', [0, 0]); // no view is out
});

test('a state goes on with the same bits', () => {
  const one = scene();
  const two = scene();
  for (let k = 0; k < 5; k++) one.stepper.step(2e-3);
  const state = one.stepper.save();
  assert.ok(state instanceof Uint8Array);
  two.stepper.load(state);
  assert.equal(two.stepper.hash(), one.stepper.hash());
  one.stepper.step(2e-3);
  assert.notEqual(two.stepper.hash(), one.stepper.hash());
  two.stepper.step(2e-3);
  assert.equal(two.stepper.hash(), one.stepper.hash());
  assert.equal(typeof two.stepper.hash(), 'bigint');
  state[state.length >> 1] ^= 1;
  assert.throws(() => two.stepper.load(state), refused('MPM_E_FORMAT', /./));
});

test('steps: advance, parts, reports, nodal fields', () => {
  const { grid, set, stepper } = scene({ desc: { gravity: [0, -10] } });
  stepper.setWall(C.MPM_Y_MIN, C.MPM_WALL_FRICTION, 0.4);
  const info = stepper.advance(0.05, { cfl: 0.4 });
  assert.equal(info.t, 0.05);
  assert.equal(typeof info.step, 'number');
  assert.equal(info.particle, -1n);
  assert.equal(info.momentum.length, 3);
  assert.deepEqual(stepper.info().momentum, info.momentum);
  stepper.stepBegin(1e-3);
  stepper.map('force', C.MPM_READ | C.MPM_WRITE, ([x, y], count) => {
    assert.equal(x.length, count);
    y.fill(0);
  });
  stepper.stepGrid();
  assert.equal(stepper.stepEnd().step, info.step + 1);
  stepper.stepBegin(1e-3);
  stepper.stepAbort();
  assert.equal(stepper.step(1e-3).step, info.step + 2);
  assert.ok(stepper.map('mass', C.MPM_READ, ([m]) => m.reduce((a, b) => a + b)) > 0);
  assert.equal(
    stepper.map('index', C.MPM_READ, ([x]) => x.constructor),
    BigInt64Array,
  );
  assert.equal(stepper.wallReaction(C.MPM_Y_MIN).length, grid.dim);
  assert.ok(stepper.profile(true).total > 0);
  assert.throws(() => stepper.map('mass', C.MPM_READ, () => {}, 3), refused('MPM_E_NOT_FOUND', /./));
  set.setAll('velocity', [500, 0]);
  assert.throws(
    () => stepper.step(1e-2),
    (error) =>
      error.status > 0 && error.info.cause === error.status && error.info.particle >= 0n && error.message.length > 0,
  );
  assert.equal(stepper.info().step, info.step + 2);
});

test('bodies, contact and obstacles', () => {
  const { context, grid, material, set, stepper } = scene({ velocity: 0 });
  const other = context.particles(grid, material);
  other.fillBox([0.3, 0.6], [0.6, 0.7], [2, 2]);
  other.setAll('velocity', [0, -1]);
  stepper.add(other).setBody(other, 1).setContact(0, 1, { friction: 0.5 });
  assert.equal(stepper.body(other), 1);
  const floor = context.obstacle({ shape: C.MPM_SHAPE_PLANE, position: [0, 0.3, 0], contact: { friction: 0.3 } });
  stepper.addObstacle(floor);
  for (let k = 0; k < 10; k++) stepper.step(1e-3);
  assert.ok(stepper.contactInfo(0, 1).touching === 1);
  assert.ok(stepper.contactInfo(0, 1).impulse[1] > 0);
  assert.equal(typeof floor.contactInfo().nodes, 'number');
  floor.dispose();
  stepper.step(1e-3);
  assert.throws(() => floor.pose(), /disposed/);
  assert.throws(() => stepper.setContact(0, 1, { frixion: 1 }), /frixion/);
  const disc = context.obstacle({
    shape: C.MPM_SHAPE_SPHERE,
    size: [0.1],
    position: [0.1, 0.1, 0],
    motion: C.MPM_MOTION_PRESCRIBED,
  });
  stepper.addObstacle(disc);
  disc.setMotion((t, dt, velocity, angular) => {
    velocity[0] = 1;
    angular[2] = 2;
  });
  stepper.step(1e-3);
  assert.ok(Math.abs(disc.pose().position[0] - 0.101) < 1e-12);
  assert.deepEqual(disc.pose().angular_velocity, [0, 0, 2]);
  disc.setPose({ position: [0.2, 0.2, 0] });
  disc.setMotion(null);
  stepper.removeObstacle(disc);
  disc.dispose();
});

const sum = (values) => values.reduce((total, one) => total + one, 0);
const near = (found, should) => assert.ok(Math.abs(found - should) < 1e-12, `${found}, not ${should}`);

test('surfaces', () => {
  const { context, grid, stepper } = scene({ velocity: 0 });
  const face = context.surface(grid, { pressure: 40 });
  assert.deepEqual(face.addPolyline([0.6, 0.6, 0.3, 0.6], false, 0.0301), { first_id: 0n, count: 10 });
  assert.equal(face.add({ position: [0.4, 0.5, 0.4, 0.5], area: [0, 0.1, 0.2, 0.3] }), 10n);
  assert.equal(face.add({ position: [0.5, 0.5] }), 12n);
  assert.deepEqual([...face.get('area', [11, 10n, 12])], [0.1, 0, 0, 0.3, 0.2, 0]);
  assert.equal(face.get('id')[12], 12n);
  face.remove([10, 11n, 12]);
  assert.throws(() => face.remove([10]), refused('MPM_E_NOT_FOUND', /10/));
  face.set('pressure', [5, 7], [3, 1]);
  assert.deepEqual([...face.get('pressure').slice(0, 4)], [0, 7, 0, 5]);
  face.set('pressure', new Float64Array(10));
  assert.equal(face.refine(0.0151), 10);
  assert.equal(face.count, 20);
  near(sum(face.get('area').slice(0, 20)), 0.3);
  assert.throws(() => face.add({ position: [0.5] }), /position has 1 entries/);
  assert.throws(() => face.add({}), /position has to be an array/);
  assert.throws(() => face.add({ position: [0.5, 0.5], area: [1] }), /area has 1 entries/);
  assert.throws(() => face.add({ position: [-1, 0.5] }), refused('MPM_E_ARG', /inside the grid/));
  assert.throws(() => face.get('forse'), refused('MPM_E_NOT_FOUND', /force/));
  assert.throws(() => face.set('force', new Float64Array(40)), refused('MPM_E_ARG', /force/));
  assert.throws(() => face.set('traction', new Float64Array(20)), /traction has 20 entries/);
  assert.throws(() => face.refine(-1), refused('MPM_E_ARG', /spacing/));
  assert.throws(() => face.addTriangles(new Float64Array(9), [0, 1, 2], 1), refused('MPM_E_UNSUPPORTED', /./));
  assert.throws(() => face.configure({ pressure: NaN }), refused('MPM_E_ARG', /pressure/));
  assert.throws(() => context.surface(grid, { spacing: 1 }), /no option 'spacing'/);
  assert.throws(() => context.surface(face), /has to be of the class Grid/);

  assert.equal(stepper.addSurface(face), stepper);
  assert.throws(() => stepper.addSurface(face), refused('MPM_E_STATE', /this stepper/));
  assert.throws(() => stepper.addSurface(grid), /has to be of the class Surface/);
  const { momentum } = stepper.step(1e-4);
  near(sum(face.get('force').slice(0, 20)), -12);
  near(sum(face.get('force').slice(20)), 0);
  near(momentum[0], -12e-4);
  face.configure({ dead_traction: [0, 30] });
  stepper.step(1e-4);
  near(sum(face.get('force').slice(0, 20)), 0);
  near(sum(face.get('force').slice(20)), 9);
  stepper.removeSurface(face);
  assert.throws(() => stepper.removeSurface(face), refused('MPM_E_NOT_FOUND', /surface/));
  assert.ok(face.count === 20 && face.get('displacement')[0] < 0);
  stepper.addSurface(face);
  face.dispose();
  stepper.step(1e-4);
  assert.throws(() => face.count, /disposed/);
});

test('surfaces of triangles', () => {
  const { context, grid, stepper } = scene({ dim: 3, velocity: 0 });
  const top = context.surface(grid, { pressure: 8 });
  const position = [0.3, 0.6, 0.6, 0.3, 0.3, 0.3, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6];
  const { count } = top.addTriangles(position, [0, 1, 2, 0, 2, 3], 0.1);
  assert.equal(top.count, count);
  assert.throws(() => top.addTriangles(position, [0, 1, 4], 0.1), refused('MPM_E_ARG', /corner/));
  assert.throws(() => top.addPolyline([0, 1, 0, 1], true, 0.1), refused('MPM_E_UNSUPPORTED', /./));
  stepper.addSurface(top).step(1e-4);
  near(sum(top.get('force').slice(2 * count)), -0.72);
});

test('what the laws are', () => {
  assert.ok(mpm.models().includes('drucker_prager'));
  const E = mpm.parameters('neo_hookean').find(({ name }) => name === 'E');
  assert.equal(E.unit, 'stress');
  assert.ok(Number.isNaN(E.value_default));
  assert.ok(mpm.stateVariables('j2').length > 0);
  assert.deepEqual(mpm.stateVariables('neo_hookean'), []);
  assert.throws(() => mpm.parameters('clay'), /./);
  assert.match(mpm.version, /^\d+\.\d+\.\d+$/);
});

test('a material by itself', () => {
  const context = mpm.context();
  const { E, nu } = { E: 1000, nu: 0.25 };
  const material = context.material('neo_hookean', { E, nu, density: 1 });
  const e = 1e-6;
  const F = [1 + e, 0, 0, 0, 1, 0, 0, 0, 1];
  const out = material.update({ n: 1, dt: 1, F, F_inc: F, stress: new Float64Array(6), tangent: true });
  const along = (E * (1 - nu)) / (1 + nu) / (1 - 2 * nu);
  assert.ok(Math.abs(out.stress_new[0] / (along * e) - 1) < 1e-5);
  assert.ok(Math.abs(out.tangent[0] / along - 1) < 1e-5);
  assert.equal(out.symmetric, true);
  assert.throws(() => material.update({ n: 2, dt: 1, F, F_inc: F, stress: new Float64Array(12) }), /F has 9 entries/);
});

test('a binary that is none is refused', async () => {
  await assert.rejects(load(new Uint8Array([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0])), /no mpm_version/);
  await assert.rejects(load(new Uint8Array(4)), WebAssembly.CompileError);
  await assert.rejects(load('no such file.wasm'), /ENOENT/);
});

test('classes have what is declared, and nothing else', () => {
  const text = readFileSync(
    createRequire(import.meta.url)
      .resolve('libmpm')
      .replace(/mjs$/, 'd.ts'),
    'utf8',
  );
  const shared = ['dispose', 'disposed'];
  const classes = [...text.matchAll(/^export class (\w+) implements Handle \{\n(.*?)^\}/gms)];
  assert.equal(classes.length, 7);
  const { context, grid, material, set, stepper } = scene();
  const objects = [context, grid, material, set, stepper, context.surface(grid)];
  objects.push(context.obstacle({ shape: C.MPM_SHAPE_PLANE }));
  for (const [, name, body] of classes) {
    const Class = library[name];
    const one = objects.find((object) => object instanceof Class);
    const declared = new Set([...body.matchAll(/^ {2}(?:readonly )?(\w+)[<(:]/gm)].map(([, member]) => member));
    for (const member of declared) assert.ok(member === 'constructor' || member in one, `${name} has no ${member}`);
    for (const member of Object.getOwnPropertyNames(Class.prototype)) {
      assert.ok(member === 'constructor' || declared.has(member), `${name}.${member} is not declared`);
    }
    for (const member of shared) assert.ok(declared.has(member));
  }
});
