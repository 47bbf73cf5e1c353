// The simulation. The page asks for a frame, and gets particles and numbers; meanwhile it draws the one before.
import { load } from './libmpm/libmpm.mjs';
import { advance, build, recipeOf } from './scenes.mjs';

const BUDGET = 13; // milliseconds for the steps of a frame, at least
const SHARE = 0.5; // of the time of a frame for its steps, at least
const REACH = 0.1; // of the hand
const PULL = 3000;
const DRAG = 40;
const HASTE = 2.5; // of the hand at most, so that what it holds can follow

let mpm, scene;
const hand = { x: 0, y: 0, on: false };
const pointer = { x: 0, y: 0 };

/** The hand goes after the pointer. */
function follow(seconds) {
  const dx = pointer.x - hand.x;
  const dy = pointer.y - hand.y;
  const share = Math.min(1, (HASTE * seconds) / Math.hypot(dx, dy));
  if (!(share > 0)) return;
  hand.x += share * dx;
  hand.y += share * dy;
}

/** The hand pulls what is near it, and slows it. */
function pull(batch, [ax, ay]) {
  const [x, y] = batch.position;
  const [vx, vy] = batch.velocity;
  for (let i = 0; i < batch.n; i++) {
    const dx = hand.x - x[i];
    const dy = hand.y - y[i];
    const share = Math.exp(-(dx * dx + dy * dy) / (REACH * REACH));
    ax[i] += share * (PULL * dx - DRAG * vx[i]);
    ay[i] += share * (PULL * dy - DRAG * vy[i]);
  }
}

/** Steps until the scene's clock shows a time, a number of steps is made, or time is up. */
function run({ until = Infinity, steps = Infinity, budget }) {
  const start = performance.now();
  let made = 0;
  scene.spent *= 0.9; // here, so that a pause leaves the rate as it is
  scene.made *= 0.9;
  while (scene.t < until && made < steps && performance.now() - start < budget) {
    const info = advance(scene.stepper, 1);
    scene.t = info.t;
    if (hand.on) {
      follow(info.dt);
      scene.touched = true;
    }
    scene.steps++; // counted here, so that steps before one that fails count
    made++;
  }
  scene.due = Math.min(until, scene.t); // a step too long is made up for; what time was too short for is not
  scene.spent += performance.now() - start;
  scene.made += made;
}

function frame() {
  const parts = scene.sets.map((set) => set.toFloat32(['position', 'velocity']));
  const floats = new Float32Array(4 * scene.count);
  let at = 0;
  for (const part of parts) {
    floats.set(part, at);
    at += part.length;
  }
  const rate = scene.spent ? (scene.count * scene.made) / scene.spent / 1e3 : 0; // million particles a second
  return {
    floats,
    obstacles: scene.obstacles.map((one) => one.pose()),
    t: scene.t,
    steps: scene.steps,
    count: scene.count,
    rate,
    touched: scene.touched,
  };
}

/** The height of each particle in its set at the start, 0 to 1, by ascending id. */
function heights(sets) {
  return sets.map((set) => {
    const y = set.get('position').subarray(set.count);
    const low = y.reduce((a, b) => Math.min(a, b));
    const high = y.reduce((a, b) => Math.max(a, b));
    return Float32Array.from(y, (one) => (one - low) / (high - low || 1));
  });
}

const answers = {
  async open({ source }) {
    mpm = await load(source);
    return { version: mpm.version };
  },
  scene({ name, wanted }) {
    const recipe = recipeOf(name, wanted);
    const made = build(mpm, recipe); // the old one stays if this fails
    scene?.dispose();
    hand.on = false;
    scene = { ...made, pace: recipe.pace, t: 0, due: 0, steps: 0, spent: 0, made: 0, touched: false };
    const { sets, obstacles, grid } = recipe;
    return {
      recipe: {
        name,
        h: grid.spacing[0],
        sets: sets.map(({ tint, layers }) => ({ tint, layers })),
        obstacles: obstacles.map(({ shape, size }) => ({ shape, size })),
      },
      heights: heights(scene.sets),
      ...frame(),
    };
  },
  frame({ seconds }) {
    const budget = Math.max(BUDGET, 1e3 * SHARE * seconds);
    if (seconds > 0) run({ until: scene.due + seconds * scene.pace, budget });
    return frame();
  },
  steps({ count, budget }) {
    run({ steps: count, budget });
    return frame();
  },
  hand({ x, y, on }) {
    if (on !== hand.on) {
      scene.stepper.setAcceleration(on ? pull : null);
      Object.assign(hand, { x, y, on });
    }
    Object.assign(pointer, { x, y });
    return {};
  },
  hash() {
    return { hash: scene.stepper.hash().toString(16).padStart(16, '0'), steps: scene.steps, touched: scene.touched };
  },
};

// one after the other, in the order in which they come; all wait for the library
let loaded;
let last = new Promise((done) => {
  loaded = done;
});
onmessage = ({ data: { id, ask, ...values } }) => {
  const turn = async () => {
    try {
      if (ask !== 'open' && !mpm) throw new Error('the library is not there');
      if (ask !== 'open' && ask !== 'scene' && !scene) throw new Error('there is no scene');
      const answer = await answers[ask](values);
      postMessage({ id, answer }, answer.floats ? [answer.floats.buffer] : []);
    } catch (error) {
      postMessage({ id, error: error.message });
    }
  };
  if (ask === 'open') turn().then(loaded);
  else last = last.then(turn);
};
