// Functions of the host: what they see, what they change, and what becomes of what they throw.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { C, MpmError, load } from 'libmpm';
import { mpm, scene } from './library.mjs';

test('forces, accelerations and gravity agree', () => {
  const g = [0, -2];
  const bits = [
    (s) =>
      s.stepper.setAcceleration((batch, [x, y]) => {
        assert.equal(x.length, batch.n);
        for (let i = 0; i < batch.n; i++) y[i] += g[1];
      }),
    (s) =>
      s.stepper.setForce((batch, add) => {
        const { mass } = batch;
        for (let i = 0; i < batch.n; i++) add[1][i] += mass[i] * g[1];
      }),
  ].map((set) => {
    const s = scene();
    set(s);
    for (let k = 0; k < 5; k++) s.stepper.step(1e-3);
    return s.stepper.info().momentum[1];
  });
  const s = scene({ desc: { gravity: g } });
  for (let k = 0; k < 5; k++) s.stepper.step(1e-3);
  const wanted = s.stepper.info().momentum[1];
  for (const one of bits) assert.ok(Math.abs(one / wanted - 1) < 1e-12);
  const still = scene();
  for (let k = 0; k < 5; k++) still.stepper.step(1e-3);
  assert.ok(Math.abs(still.stepper.info().momentum[1] - wanted) > 1e-3 * Math.abs(wanted));
});

test('what a callback throws comes out, and nothing has changed', () => {
  const { set, stepper } = scene();
  const before = stepper.hash();
  const mine = new RangeError('mine');
  const throwing = () => {
    throw mine;
  };
  const all = {
    setForce: [throwing],
    setAcceleration: [throwing],
    setVelocityBc: [throwing],
    setProgress: [throwing],
    setNodeHook: [C.MPM_AFTER_FORCES, throwing],
  };
  for (const [name, values] of Object.entries(all)) {
    stepper[name](...values);
    assert.throws(
      () => stepper.step(1e-3),
      (error) => error === mine,
      name,
    );
    assert.throws(
      () => stepper.advance(0.1),
      (error) => error === mine,
      name,
    );
    assert.equal(stepper.hash(), before);
    stepper[name](...values.slice(0, -1), null);
  }
  set.setAll('prescribed', [1, 0]);
  stepper.setMotion(set, throwing);
  assert.throws(
    () => stepper.step(1e-3),
    (error) => error === mine,
  );
  stepper.setMotion(set, null);
  stepper.step(1e-3);
});

test('of several exceptions that of the failure comes out', () => {
  const { context, grid, material, set, stepper } = scene();
  const other = context.particles(grid, material);
  other.fillBox([0.7, 0.7], [0.8, 0.8], [2, 2]);
  stepper.add(other);
  const seen = [];
  stepper.setForce((batch) => {
    seen.push(batch.n);
    throw new Error(`batch ${seen.length}`);
  });
  assert.throws(() => stepper.step(1e-3), /batch 1/);
  assert.ok(set.count > 0);
});

test('answers are passed on', () => {
  const { stepper } = scene();
  stepper.setForce(() => C.MPM_CUT_DT);
  assert.throws(
    () => stepper.step(1e-3),
    (error) =>
      error instanceof MpmError && error.status === C.MPM_CUT_DT && error.retryable && error.info.callback_status === 1,
  );
  stepper.setForce(() => -7);
  assert.throws(
    () => stepper.step(1e-3),
    (error) => error.status === C.MPM_E_CALLBACK && error.info.callback_status === -7,
  );
  stepper.setForce(null);
  let steps = 0;
  stepper.setProgress((info) => {
    assert.equal(typeof info.t, 'number');
    steps++;
    return C.MPM_CANCELLED;
  });
  assert.throws(
    () => stepper.step(1e-3),
    (error) => error.status === C.MPM_CANCELLED && !error.retryable,
  );
  assert.equal(steps, 1);
  stepper.setProgress(async () => {});
  assert.throws(() => stepper.step(1e-3), /a promise|async/);
  stepper.setProgress(() => 'go on');
  assert.throws(() => stepper.step(1e-3), /returned go on/);
  assert.throws(() => stepper.setProgress(7), /has to be a function/);
});

test('batches end with the call', () => {
  const { set, stepper } = scene();
  let batch, x;
  set.addField('heat', C.MPM_F64);
  set.setAll('heat', 3);
  stepper.setForce((given) => {
    batch = given;
    [x] = given.position;
    const [heat] = given.field('heat');
    let ids = 0;
    for (let i = 0; i < given.n; i++)
      if (given.id[i] >= 0n) {
        ids++;
        assert.equal(heat[i], 3);
      }
    assert.ok(ids > 0);
    assert.equal(given.reference_position, undefined);
    assert.throws(() => given.field('hat'), /./);
    assert.throws(
      () => set.get('mass'),
      (error) => error.status === C.MPM_E_STATE,
    );
    assert.ok(x.length === given.n, 'arrays stay while the callback runs');
  });
  stepper.step(1e-3);
  assert.equal(x.length, 0);
  assert.throws(() => batch.n + batch.mass.length, /for the time of the callback/);
});

/** Takes so much memory that WebAssembly's grows, as calls on other contexts may. */
function grow({ raw }) {
  raw.free(raw.malloc(raw.memory.buffer.byteLength));
}

test('a callback that grows the memory by another context goes on', () => {
  const { stepper } = scene();
  const plain = scene();
  const push = (batch, [fx, fy], x) => {
    for (let i = 0; i < batch.n; i++) {
      fx[i] += x[i];
      fy[i] -= batch.mass[i];
    }
  };
  let done = false;
  stepper.setForce((batch, add) => {
    const [x] = batch.position;
    if (!done) grow(mpm);
    done = true;
    assert.equal(batch.mass.length, batch.n);
    push(batch, add, x);
  });
  plain.stepper.setForce((batch, add) => push(batch, add, batch.position[0]));
  for (let k = 0; k < 3; k++) {
    stepper.step(1e-3);
    plain.stepper.step(1e-3);
  }
  assert.equal(stepper.hash(), plain.stepper.hash());
});

test('what is lent within a callback ends with the inner one, and the outer one goes on', () => {
  const law = {
    density: 1e3,
    stress(batch) {
      batch.stress_new.forEach((one, c) => one.fill(c === 0 ? -10 : 0));
      batch.wave_speed.fill(1);
    },
  };
  const [outer, inner, plain, other] = [scene(), scene({ law }), scene({ law }), scene()];
  let kept;
  let mapped;
  const push = (batch, [, fy]) => fy.forEach((_, i) => (fy[i] += batch.mass[i]));
  inner.stepper.setForce((batch, add) => {
    push(batch, add);
    kept ??= [batch.id, ...batch.position, ...add, ...batch.field('stress', 4)];
  });
  plain.stepper.setForce(push);
  let steps = 0;
  outer.stepper.setForce((batch, add) => {
    const lent = [batch.id, batch.mass, ...batch.position, ...add, ...batch.field('velocity', 2)];
    const values = lent.map((one) => Array.from(one));
    if (!steps++) inner.stepper.step(1e-3);
    inner.set.map('velocity', C.MPM_READ | C.MPM_WRITE, ([vx]) => {
      mapped = vx;
      vx.fill(0.25);
    });
    assert.deepEqual([kept, mapped].flat().map(({ length }) => length), Array(kept.length + 1).fill(0));
    assert.deepEqual(lent.map((one) => Array.from(one)), values);
    push(batch, add);
  });
  other.stepper.setForce(push);
  outer.stepper.step(1e-3);
  other.stepper.step(1e-3);
  assert.equal(outer.stepper.hash(), other.stepper.hash());
  plain.stepper.step(1e-3);
  plain.set.map('velocity', C.MPM_READ | C.MPM_WRITE, ([vx]) => vx.fill(0.25));
  assert.equal(inner.stepper.hash(), plain.stepper.hash());
});

test('arrays that end early are an error', async () => {
  const library = await load(mpm.module);
  const { set, stepper } = scene({ library });
  assert.throws(() => set.map('velocity', C.MPM_WRITE, () => grow(library)), /memory has grown/);
  const mine = new Error('mine');
  assert.throws(
    () =>
      set.map('velocity', C.MPM_READ, () => {
        grow(library);
        throw mine;
      }),
    (error) => error === mine,
  );
  const before = stepper.hash();
  stepper.setForce(() => grow(library));
  assert.throws(() => stepper.step(1e-3), /memory has grown/);
  assert.equal(stepper.hash(), before);
  stepper.setForce(null);
  stepper.setProgress(() => grow(library)); // to which no arrays are lent
  stepper.step(1e-3);
});

test('prescribed velocities and hooks', () => {
  const { stepper } = scene({ velocity: 0 });
  stepper.setVelocityBc((batch, prescribed, velocity) => {
    const [x] = batch.position;
    for (let i = 0; i < batch.n; i++)
      if (x[i] > 0.5) {
        prescribed[0][i] = 1;
        velocity[0][i] = 0.25;
      }
  });
  for (let k = 0; k < 3; k++) stepper.step(1e-3);
  const [fastest, reaction] = stepper.map('velocity', C.MPM_READ, ([x]) => [Math.max(...x), x.length]);
  assert.equal(fastest, 0.25);
  assert.ok(reaction > 0);
  stepper.setVelocityBc(null);
  let hooked = 0;
  stepper.setNodeHook(C.MPM_AFTER_VELOCITY, (batch, [vx, vy]) => {
    hooked += batch.n;
    vx.fill(0);
    vy.fill(0.125);
  });
  stepper.step(1e-3);
  assert.ok(hooked > 0);
  assert.equal(
    stepper.map('velocity', C.MPM_READ, ([, y]) => Math.max(...y)),
    0.125,
  );
});

// A neo-Hookean law is replaced by one of the host, which is linear: sigma = K (J - 1) I.
const stiff = {
  density: 1e3,
  state_initial: [1, 5],
  stress(batch) {
    const [xx, xy, , yx, yy, , , , zz] = batch.F;
    const { stress_new: s, state, state_new, wave_speed, n } = batch;
    for (let i = 0; i < n; i++) {
      const p = 1e3 * ((xx[i] * yy[i] - xy[i] * yx[i]) * zz[i] - 1);
      for (let c = 0; c < 6; c++) s[c][i] = c < 3 ? p : 0;
      state_new[0][i] = state[0][i] + batch.dt;
      state_new[1][i] = state[1][i];
      wave_speed[i] = 1;
    }
  },
};

test('laws of the host', () => {
  const { set, stepper, material } = scene({ law: stiff });
  assert.equal(material.stateCount, 2);
  for (let k = 0; k < 4; k++) stepper.step(1e-3);
  const state = set.get('state');
  assert.ok(Math.abs(state[0] - 1.004) < 1e-12 && state[set.count] === 5);
  const mine = new Error('mine');
  const failing = scene({
    law: {
      ...stiff,
      stress(batch) {
        if (batch.dt > 0) throw mine;
        stiff.stress(batch);
      },
    },
  });
  assert.throws(
    () => failing.stepper.step(1e-3),
    (error) => error === mine,
  );
  const position = scene({
    law: {
      ...stiff,
      stress(batch) {
        assert.equal(batch.position(2).length, 2);
        stiff.stress(batch);
      },
    },
  });
  position.stepper.step(1e-3);
  assert.throws(() => mpm.context().law({ density: 1 }), /stress/);
});

test('implicit steps by a tangent and a solver of the host', () => {
  const K = 1e3;
  const run = (extra, desc, solver) => {
    const law = { ...stiff, state_initial: [1, 5], ...extra };
    const { set, stepper } = scene({ law, velocity: 0, desc: { scheme: C.MPM_NEWMARK, gravity: [0, -1], ...desc } });
    stepper.setWall(C.MPM_X_MIN, C.MPM_WALL_SLIP);
    if (solver) stepper.setLinearSolver(solver);
    const info = stepper.step(1e-2);
    return { v: set.get('velocity'), info, residuals: stepper.residuals() };
  };
  const differenced = run({}, {});
  let asked = 0;
  const tangent = (batch, c) => {
    asked++;
    const [xx, xy, , yx, yy, , , , zz] = batch.F;
    for (let i = 0; i < batch.n; i++) {
      const J = (xx[i] * yy[i] - xy[i] * yx[i]) * zz[i];
      const p = K * (J - 1);
      // tau = J p I: d tau = J (p + K J) tr(L) I, less L tau + tau L^T
      for (let a = 0; a < 6; a++)
        for (let b = 0; b < 6; b++) {
          let value = a < 3 && b < 3 ? J * (p + K * J) : 0;
          if (a === b) value -= J * p * (a < 3 ? 2 : 1);
          c[6 * a + b][i] = value;
        }
    }
    return true;
  };
  const given = run({ tangent }, {});
  assert.ok(asked > 0);
  assert.ok(given.residuals.length > 1);
  given.v.forEach((v, i) => assert.ok(Math.abs(v - differenced.v[i]) < 1e-7, `${v} ${differenced.v[i]}`));

  let solved = 0;
  const solver = (matrix, rhs, solution, tolerance) => {
    // conjugate gradients
    solved++;
    assert.ok(matrix.rows === rhs.length && matrix.symmetric === 1 && matrix.position.length === 2);
    const { row_start, column, value } = matrix.csr();
    assert.equal(Number(row_start[matrix.rows]), value.length);
    assert.equal(column.length, matrix.nonzeros);
    const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
    const r = rhs.map((b, i) => b - matrix.apply(solution)[i]);
    const p = r.slice();
    let rr = dot(r, r);
    const goal = Math.max(tolerance, 1e-12) ** 2 * dot(rhs, rhs);
    let k = 0;
    for (; k < 1000 && rr > goal; k++) {
      const Ap = matrix.apply(p);
      const alpha = rr / dot(p, Ap);
      for (let i = 0; i < p.length; i++) {
        solution[i] += alpha * p[i];
        r[i] -= alpha * Ap[i];
      }
      const next = dot(r, r);
      for (let i = 0; i < p.length; i++) p[i] = r[i] + (next / rr) * p[i];
      rr = next;
    }
    return k;
  };
  const hosted = run({ tangent }, { linear_solver: C.MPM_SOLVER_HOST }, solver);
  assert.ok(solved > 0);
  assert.equal(hosted.info.linear_solver, C.MPM_SOLVER_HOST);
  assert.ok(hosted.info.linear_iterations > 0);
  hosted.v.forEach((v, i) => assert.ok(Math.abs(v - given.v[i]) < 1e-7));
  assert.throws(
    () => run({ tangent }, { linear_solver: C.MPM_SOLVER_HOST }, () => false),
    (error) => error.status === C.MPM_CUT_DT,
  );
  const mine = new Error('mine');
  assert.throws(
    () =>
      run(
        {
          tangent: () => {
            throw mine;
          },
        },
        {},
      ),
    (error) => error === mine,
  );
});

test('tractions of surfaces', () => {
  const { context, grid, stepper } = scene({ velocity: 0 });
  const face = context.surface(grid);
  face.add({ position: [0.6, 0.6, 0.4, 0.5], area: [0.1, 0.2, 0, 0] });
  let batches = 0;
  let kept;
  face.setTraction((batch, [x]) => {
    batches++;
    assert.deepEqual([batch.n, batch.dim, batch.t, batch.dt], [2, 2, 0, 1e-3]);
    assert.deepEqual([[...batch.id], [...batch.reference_area]], [[0n, 1n], [0.1, 0.2]]);
    assert.ok(batch.area[0][1] === 0.2 && batch.position[1][0] === 0.4 && batch.displacement[0][0] === 0);
    assert.equal(batch.velocity.length, 2);
    x[1] += 50;
    kept = batch;
  });
  stepper.addSurface(face).step(1e-3);
  assert.equal(batches, 1);
  assert.throws(() => kept.n + kept.t + kept.position, /lent/);
  const [first, second] = face.get('force');
  assert.ok(first === 0 && Math.abs(second - 10) < 1e-12);
  const before = stepper.hash();
  const mine = new Error('mine');
  face.setTraction(() => {
    throw mine;
  });
  assert.throws(
    () => stepper.step(1e-3),
    (error) => error === mine,
  );
  assert.equal(stepper.hash(), before);
  face.setTraction(() => C.MPM_CUT_DT);
  assert.throws(
    () => stepper.step(1e-3),
    (error) => error.retryable,
  );
  assert.throws(() => face.setTraction(7), /has to be a function/);
  face.setTraction(() => {});
  face.dispose();
  globalThis.gc?.();
  stepper.step(1e-3);
});

test('obstacles and friction by functions', () => {
  const { context, stepper } = scene();
  const wall = context.obstacle({
    shape: C.MPM_SHAPE_DISTANCE,
    distance(batch) {
      // the half-space x > 0.65
      const [x] = batch.position;
      for (let i = 0; i < batch.n; i++) {
        batch.distance[i] = 0.65 - x[i];
        batch.normal[0][i] = -1;
        batch.normal[1][i] = 0;
      }
    },
  });
  stepper.addObstacle(wall);
  for (let k = 0; k < 80; k++) stepper.step(2e-3);
  assert.ok(wall.contactInfo().impulse[0] < 0);
  const mine = new Error('mine');
  const other = scene();
  const bad = other.context.obstacle({
    shape: C.MPM_SHAPE_DISTANCE,
    distance() {
      throw mine;
    },
  });
  assert.throws(
    () => other.stepper.addObstacle(bad).step(1e-3),
    (error) => error === mine,
  );

  const pair = scene({ velocity: 0 });
  const top = pair.context.particles(pair.grid, pair.material);
  top.fillBox([0.3, 0.6], [0.6, 0.7], [2, 2]);
  top.setAll('velocity', [1, -1]);
  let nodes = 0;
  pair.stepper
    .add(top)
    .setBody(top, 1)
    .setFriction((batch, friction) => {
      nodes += batch.n;
      assert.equal(batch.normal.length, 2);
      friction.fill(0.5);
    });
  for (let k = 0; k < 10; k++) pair.stepper.step(1e-3);
  assert.ok(nodes > 0 && pair.stepper.contactInfo(0, 1).friction_work > 0);
});

test('splitting and merging', () => {
  const { set, stepper } = scene({ velocity: 0 });
  const first = set.count;
  const halves = { every: 0, split_edge: 0.4 };
  stepper.setAdaption(set, halves).adapt();
  const info = stepper.adaptionInfo(set);
  assert.deepEqual([set.count, info.splits, info.added], [4 * first, first, 3 * first]);
  const merging = { every: 0, max_per_cell: 1, merge_distance: 0.3 };
  let pairs = 0;
  let kept;
  stepper.setAdaption(set, merging, (batch, accept) => {
    assert.equal(batch.what, C.MPM_ADAPT_MERGE);
    assert.ok(batch.position[1][0] > 0 && accept.every((one) => one === 1));
    pairs = batch.n;
    kept = batch.other[0];
    accept[0] = 0;
  });
  stepper.adapt();
  assert.ok(pairs > 10 && stepper.adaptionInfo(set).merges === pairs - 1 && set.get('id').includes(kept));
  const before = stepper.hash();
  const mine = new RangeError('as they are');
  stepper.setAdaption(set, merging, () => {
    throw mine;
  });
  const isMine = (error) => error === mine;
  assert.throws(() => stepper.adapt(), isMine);
  assert.throws(() => stepper.setAdaption(set, { ...halves, split_edge: 0.2 }), /split_edge/);
  assert.throws(() => stepper.setAdaption(set, { split_edges: 1 }), /split_edges/);
  assert.throws(() => stepper.adapt(), isMine);
  stepper.setAdaption(set, null).adapt();
  assert.equal(stepper.hash(), before);
  stepper.remove(set);
  assert.throws(() => stepper.adaptionInfo(set), MpmError);
});

test('heat', () => {
  const { context, grid, set, stepper } = scene({ velocity: 0 });
  const n = set.count;
  const mass = set.get('mass').reduce((sum, one) => sum + one, 0);
  assert.throws(() => stepper.heatInfo(), MpmError);
  assert.throws(() => stepper.setHeat(set, { specific_heats: 1 }), /specific_heats/);
  assert.throws(() => stepper.setHeat(set, {}), /specific_heat/);
  assert.throws(() => stepper.setHeat(set, { specific_heat: 1, source() {} }), /source/);
  stepper.setHeat(set, { specific_heat: 2, reference_temperature: 10 }, (batch, power) => {
    assert.equal(batch.mass.length, power.length);
    assert.ok(batch.field('temperature')[0].some((one) => one === 10) && power.every((one) => one === 0));
    power.fill(3);
  });
  assert.deepEqual([...set.get('temperature')], Array(n).fill(10));
  stepper.step(1e-3);
  const volume = set.get('initial_volume').reduce((sum, one) => sum + one, 0);
  const { gained, sources, heat, walls } = stepper.heatInfo();
  assert.ok(Math.abs(sources / (3e-3 * volume) - 1) < 1e-6 && Math.abs(gained / sources - 1) < 1e-10);
  assert.ok(Math.abs(heat / (2 * mass * 10 + gained) - 1) < 1e-12);
  assert.deepEqual([...walls], Array(6).fill(0));

  // a flux through a surface, and then a film towards what it has around it
  stepper.setHeat(set, { specific_heat: 2, conductivity: 1 });
  const face = context.surface(grid);
  const [x, y] = [set.get('position').slice(0, n), set.get('position').slice(n)];
  const floor = Math.min(...y);
  face.addPolyline([Math.max(...x), floor, Math.min(...x), floor], false, 0.1);
  face.setHeat(5);
  assert.throws(() => stepper.setConduction(C.MPM_CONDUCTION_IMPLICIT, 1), /tolerance/);
  stepper.addSurface(face).setConduction(C.MPM_CONDUCTION_IMPLICIT);
  stepper.step(1e-3);
  const width = Math.max(...x) - Math.min(...x);
  const through = stepper.heatInfo();
  assert.ok(Math.abs(through.surfaces / (5e-3 * width) - 1) < 1e-3 && through.iterations > 0);
  face.setHeat(0, 1, 5);
  stepper.step(1e-3);
  assert.ok(stepper.heatInfo().surfaces < 0);
  assert.throws(() => face.setHeat(0, -1), /film/);

  // what a source throws leaves all as it was
  const before = stepper.hash();
  const mine = new RangeError('too hot');
  stepper.setHeat(set, { specific_heat: 2 }, () => {
    throw mine;
  });
  assert.throws(
    () => stepper.step(1e-3),
    (error) => error === mine,
  );
  assert.equal(stepper.hash(), before);

  // a source is kept as long as it is described
  const { used } = stepper.functions;
  assert.equal(used.size, 1);
  let calls = 0;
  stepper.setHeat(set, { specific_heat: 2 }, () => void calls++);
  assert.equal(used.size, 1);
  stepper.setHeat(set, null).step(1e-3);
  assert.deepEqual([used.size, calls], [0, 0]);
  stepper.setHeat(set, { specific_heat: 2, expansion: 1e-3 }, () => void calls++).step(1e-3);
  const seen = calls;
  assert.ok(seen > 0 && set.get('stress_temperature').some((one) => one !== 0));
  stepper.remove(set);
  assert.equal(used.size, 0);
  stepper.add(set).step(1e-3);
  assert.equal(calls, seen);
});

test('a face at a temperature heats what lies at it', () => {
  const { context, grid, material } = scene();
  const set = context.particles(grid, material);
  set.fillBox([0.25, 0], [0.5, 0.25], [2, 2]);
  const stepper = context.stepper(grid).add(set).setHeat(set, { specific_heat: 1, conductivity: 1 });
  assert.throws(() => stepper.setHeatWall(C.MPM_Y_MIN, 7, 1), MpmError);
  stepper.setHeatWall(C.MPM_Y_MIN, C.MPM_HEAT_WALL_TEMPERATURE, 4);
  stepper.setConduction(C.MPM_CONDUCTION_EXPLICIT).step(1e-4);
  const { gained, walls } = stepper.heatInfo();
  assert.ok(gained > 0 && Math.abs(gained - walls[C.MPM_Y_MIN]) <= 1e-12 * gained);
  stepper.setHeatWall(C.MPM_Y_MIN, C.MPM_HEAT_WALL_INSULATED).step(1e-4);
  assert.equal(stepper.heatInfo().walls[C.MPM_Y_MIN], 0);
});

test('what a log throws comes out of the call that it is told of', () => {
  const failing = () => {
    throw new Error('full');
  };
  assert.throws(() => mpm.context({ log: failing }), /full/);
  const context = mpm.context();
  assert.equal(context.grid({ dim: 2, cells: [4, 4], spacing: [1, 1] }).dim, 2);
});

test('the log', () => {
  const lines = [];
  assert.throws(() => mpm.context({ concurrency: 7, log: (level, text) => lines.push([level, text]) }), MpmError);
  assert.equal(lines.length, 1);
  assert.equal(lines[0][0], C.MPM_LOG_WARNING);
  assert.match(lines[0][1], /thread/);
  assert.throws(
    () =>
      mpm.context({
        concurrency: 7,
        log() {
          throw new Error('dropped');
        },
      }),
    /thread/,
  );
  assert.equal(mpm.context().lastError(), ''); // what it threw is gone
});
