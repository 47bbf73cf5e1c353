// The page: controls, the pointer, and a frame from the worker for each of the screen.
import { C } from './libmpm/libmpm.mjs';
import { painter } from './draw.mjs';
import { HEIGHT, LIMITS, NAMES, WIDTH, titleOf } from './scenes.mjs';

const find = (id) => document.getElementById(id);
const canvas = find('picture');
const dark = matchMedia('(prefers-color-scheme: dark)');
const LONGEST = 0.1; // seconds; a scene does not make up for more, as of a tab that was hidden
const SHARED_AT_ONCE = 1000; // milliseconds of steps between two pictures on the way to a shared state

// ---- the worker: questions have numbers, and answers come in the same order ----
const worker = new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });
const waiting = new Map();
let asked = 0;
worker.onmessage = ({ data: { id, answer, error } }) => {
  const { done, failed } = waiting.get(id);
  waiting.delete(id);
  if (error === undefined) done(answer);
  else failed(new Error(error));
};
worker.onerror = (event) => tell(`The simulation has ended: ${event.message ?? 'its worker could not be loaded'}`);
const ask = (question, values = {}) =>
  new Promise((done, failed) => {
    waiting.set(++asked, { done, failed });
    worker.postMessage({ id: asked, ask: question, ...values });
  });

// ---- what is shown ----
export const now = { name: NAMES[0], wanted: LIMITS.first, running: true, frame: null, opened: 0 };
const seen = { frames: 0, rate: 0, since: performance.now(), at: 0 };
const tell = (text) => {
  find('message').textContent = text;
};

function write() {
  const { frame } = now;
  if (!frame) return;
  const state = now.running ? '' : ' · paused';
  find('numbers').textContent =
    `t = ${frame.t.toFixed(3)} s · step ${frame.steps} · ${frame.count} particles · ` +
    `${frame.rate.toFixed(1)} Mp/s · ${seen.rate.toFixed(0)} frames/s${state}`;
  find('pause').textContent = now.running ? 'Pause' : 'Run';
}
const draw = () => now.frame && paint.draw(now.frame, dark.matches);

function run(on) {
  now.running = on;
  write();
}

/** Ends the way to a shared state: the visitor goes on from here. */
function leave() {
  if (!now.walking) return;
  now.walking = false;
  tell('');
}

/** Begins a scene anew; for a link that names a number of steps, at the state after these. */
async function open(name, wanted, link = {}) {
  // here, so that what the visitor does while the scene is made counts
  Object.assign(now, { name, wanted, walking: Boolean(link.steps), running: !link.steps });
  const mine = ++now.opened;
  const left = () => mine !== now.opened || !now.walking;
  for (const button of find('scenes').children) button.setAttribute('aria-pressed', button.value === name);
  find('wanted').value = Math.log(wanted);
  find('count').textContent = wanted;
  const { recipe, heights, ...frame } = await ask('scene', { name, wanted });
  if (mine !== now.opened) return;
  paint.open(recipe, heights);
  now.frame = frame;
  write();
  if (left()) return;
  while (now.frame.steps < link.steps) {
    tell(`On the way to step ${link.steps} …`);
    const next = await ask('steps', { count: link.steps - now.frame.steps, budget: SHARED_AT_ONCE });
    if (left()) return;
    now.frame = next;
    write();
  }
  const { hash } = await ask('hash');
  if (left()) return;
  now.walking = false;
  if (!link.hash) tell(`State ${hash} after ${link.steps} steps.`);
  else if (hash === link.hash)
    tell(`State ${hash} after ${link.steps} steps: the same bits as on the machine where the link was made.`);
  else
    tell(
      `State ${hash} after ${link.steps} steps, but ${link.hash} where the link was made: another version of the library, perhaps.`,
    );
}
const begin = (...values) => {
  history.replaceState(null, '', location.pathname + location.search);
  tell('');
  return open(...values).catch((error) => tell(error.message));
};

async function share() {
  run(false);
  const mine = now.opened;
  const { hash, steps, touched } = await ask('hash');
  if (mine !== now.opened) return; // another scene has been begun meanwhile
  const link = new URLSearchParams({ scene: now.name, n: now.wanted });
  if (!touched) {
    link.set('steps', steps);
    link.set('hash', hash);
  }
  history.replaceState(null, '', `#${link}`);
  const copied = await navigator.clipboard?.writeText(location.href).then(
    () => 'copied',
    () => null,
  );
  tell(
    `The link is in the address bar${copied ? ' and copied' : ''}. ` +
      (touched
        ? `State ${hash} has been in your hands: the link begins the scene anew.`
        : `State ${hash} after ${steps} steps: whoever opens it sees the same bits, as does a program in C.`),
  );
}

function readLink() {
  const link = new URLSearchParams(location.hash.slice(1));
  const number = (name, low, high) => {
    const value = Number(link.get(name));
    return Number.isInteger(value) && value >= low && value <= high ? value : undefined;
  };
  const hash = link.get('hash');
  return {
    name: NAMES.includes(link.get('scene')) ? link.get('scene') : NAMES[0],
    wanted: number('n', LIMITS.least, LIMITS.most) ?? LIMITS.first,
    steps: number('steps', 1, 1e7),
    hash: /^[0-9a-f]{16}$/.test(hash) ? hash : null,
  };
}
const follow = () => {
  const { name, wanted, ...link } = readLink();
  tell('');
  return open(name, wanted, link);
};

// ---- controls ----
for (const name of NAMES) {
  const button = Object.assign(document.createElement('button'), {
    type: 'button',
    value: name,
    textContent: titleOf(name),
  });
  button.onclick = () => begin(name, now.wanted);
  find('scenes').append(button);
}
Object.assign(find('wanted'), { min: Math.log(LIMITS.least), max: Math.log(LIMITS.most), step: 'any' });
const slid = () => Math.round(Math.exp(find('wanted').value) / 100) * 100;
find('wanted').oninput = () => {
  find('count').textContent = slid();
};
find('wanted').onchange = () => begin(now.name, slid());
find('again').onclick = () => begin(now.name, now.wanted);
find('pause').onclick = () => {
  leave();
  run(!now.running);
};
async function step() {
  leave();
  run(false);
  now.frame = await ask('steps', { count: 1, budget: Infinity });
  write();
}
find('step').onclick = () => step().catch((error) => tell(`Stopped: ${error.message}`));
find('share').onclick = () => share().catch((error) => tell(error.message));
addEventListener('hashchange', () => follow().catch((error) => tell(error.message)));

let holding = false;
function hand(event, on) {
  const { left, top, width, height } = canvas.getBoundingClientRect();
  holding = on;
  ask('hand', {
    x: ((event.clientX - left) / width) * WIDTH,
    y: (1 - (event.clientY - top) / height) * HEIGHT,
    on,
  }).catch((error) => tell(error.message));
}
canvas.onpointerdown = (event) => {
  if (!now.frame || event.button) return;
  leave();
  canvas.setPointerCapture(event.pointerId);
  hand(event, true);
};
canvas.onpointermove = (event) => {
  if (holding) hand(event, true);
};
canvas.onpointerup = canvas.onpointercancel = (event) => {
  if (holding) hand(event, false);
};

// ---- frames ----
let busy = false;
let last; // when a frame was asked for
async function next(time) {
  const seconds = Math.min((time - (last ?? time)) / 1000, LONGEST);
  last = time;
  busy = true;
  const mine = now.opened;
  try {
    const frame = await ask('frame', { seconds: now.running ? seconds : 0 });
    if (mine === now.opened && frame.steps >= now.frame.steps) now.frame = frame;
    seen.frames++;
  } catch (error) {
    run(false);
    tell(`Stopped: ${error.message}`);
  }
  busy = false;
}
function tick(time) {
  draw();
  if (!busy && now.frame) next(time);
  if (time - seen.since > 500) {
    seen.rate = (1000 * (seen.frames - seen.at)) / (time - seen.since);
    seen.since = time;
    seen.at = seen.frames;
    write();
  }
  requestAnimationFrame(tick);
}

let paint;
try {
  paint = painter(canvas, C.MPM_SHAPE_BOX);
  const binary = new URLSearchParams(location.search).get('binary'); // of the package; by default what the browser can do
  const source = binary ? new URL(`./libmpm/${binary}`, import.meta.url).href : undefined;
  requestAnimationFrame(tick);
  // the scene at once, so that what the visitor asks for while the binary comes is asked after it
  await Promise.all([ask('open', { source }), follow()]);
} catch (error) {
  tell(error.message);
}
