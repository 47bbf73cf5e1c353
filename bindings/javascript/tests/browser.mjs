// The live page in chromium, without a screen: bits, controls, pointer, sizes and pictures.
//
//   node browser.mjs LIVE EXPECTED PICTURES        EXPECTED: hashes of a native program; STEPS and WANTED as in scenes.test.mjs
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { load } from 'libmpm';

const [live, expected, pictures] = process.argv.slice(2);
const { STEPS, WANTED, CHROMIUM, PICTURE = 'scene=stacking&n=1500&steps=100' } = process.env; // PICTURE: what page.png shows
const { HEIGHT, NAMES, WIDTH, advance, build, recipeOf } = await import(
  new URL('scenes.mjs', pathToFileURL(`${live}/`))
);
const hashes = new Map(
  readFileSync(expected, 'utf8')
    .trim()
    .split('\n')
    .map((line) => line.split(' ')),
);
mkdirSync(pictures, { recursive: true });

// the server that the documents name
const server = spawn('python3', ['-u', '-m', 'http.server', '--bind', '127.0.0.1', '-d', live, '0'], {
  stdio: ['ignore', 'pipe', 'ignore'],
});
const port = await new Promise((done, failed) => {
  let said = '';
  server.stdout.on('data', (text) => {
    said += text;
    const found = said.match(/port (\d+) /);
    if (found) done(found[1]);
  });
  server.on('exit', () => failed(new Error('there is no server')));
});
const site = `http://127.0.0.1:${port}/`;

const browser = await chromium.launch({
  executablePath: CHROMIUM,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const errors = [];
async function fresh(viewport) {
  const page = await browser.newPage({ viewport, colorScheme: 'dark' });
  page.setDefaultTimeout(60000);
  page.on('pageerror', (error) => errors.push(error.message));
  page.on('console', (line) => {
    if (line.type() === 'error') errors.push(line.text());
  });
  return page;
}
/** Opens a link, which may differ from the present one in its fragment alone. */
async function visit(page, link) {
  await page.goto('about:blank');
  await page.goto(site + link);
  await page.evaluate(() => import('./page.mjs').then(() => null));
}
/** The same without another page. */
async function visitWithin(page, fragment) {
  await page.evaluate((to) => {
    document.getElementById('message').textContent = '';
    location.hash = to;
  }, fragment);
}
const state = (page) =>
  page.evaluate(async () => {
    const { now } = await import('./page.mjs');
    const { floats = [], ...rest } = now.frame ?? {}; // null before the first scene
    return {
      ...rest,
      running: now.running,
      floats: Array.from(floats),
      text: document.getElementById('numbers').textContent,
      message: document.getElementById('message').textContent,
      hash: location.hash,
    };
  });
/** Waits until a function of the state holds. */
async function until(page, what, holds) {
  const end = Date.now() + 60000;
  for (;;) {
    const is = await state(page);
    if (holds(is)) return is;
    if (Date.now() > end)
      throw new Error(`${what}: not within a minute: ${JSON.stringify({ ...is, floats: is.floats.length })}`);
    await page.waitForTimeout(50);
  }
}
/** The share of pixels of the picture that are not ground. */
async function painted(page, name) {
  const png = await page.locator('#picture').screenshot({ path: `${pictures}/${name}.png` });
  return page.evaluate(async (data) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const context = Object.assign(document.createElement('canvas'), {
      width: image.width,
      height: image.height,
    }).getContext('2d');
    context.drawImage(image, 0, 0);
    const pixels = new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
    const ground = pixels[40 * image.width + image.width - 40]; // near the upper right corner, where no scene begins
    return pixels.reduce((sum, one) => sum + (one !== ground), 0) / pixels.length;
  }, png.toString('base64'));
}

const mean = (floats, axis) => floats.filter((_, k) => k % 4 === axis).reduce((a, b) => a + b, 0) / (floats.length / 4);

try {
  const page = await fresh({ width: 1000, height: 800 });
  for (const name of NAMES) {
    await visit(page, `#scene=${name}&n=${WANTED}&steps=${STEPS}&hash=${hashes.get(name)}`);
    const is = await until(page, name, ({ message }) => message.startsWith('State'));
    assert.equal(is.steps, Number(STEPS));
    assert.match(is.message, new RegExp(`${hashes.get(name)}.*the same bits`), name);
    assert.equal(is.running, false);
    await page.waitForTimeout(200);
    const share = await painted(page, name);
    const filled = (is.count * recipeOf(name, Number(WANTED)).grid.spacing[0] ** 2) / 4 / (WIDTH * HEIGHT);
    assert.ok(
      share > 0.5 * filled && share < 2.5 * filled,
      `${name}: ${share} of the picture is painted, ${filled} is filled`,
    );
    await page.click('#pause');
    const later = await until(page, `${name} goes on`, ({ steps }) => steps > Number(STEPS) + 20);
    assert.ok(later.t > is.t && later.floats.every(Number.isFinite));
    console.log(`browser: ${name} ${hashes.get(name)}, ${later.text}`);
  }

  // the other binary
  await visit(page, `?binary=libmpm.wasm#scene=jelly&n=${WANTED}&steps=${STEPS}&hash=${hashes.get('jelly')}`);
  await until(page, 'scalar', ({ message }) => /the same bits/.test(message));

  // a wrong hash is told
  await visit(page, `#scene=jelly&n=${WANTED}&steps=5&hash=0123456789abcdef`);
  await until(page, 'wrong hash', ({ message }) => /but 0123456789abcdef/.test(message));

  // controls
  await page.click('#step');
  await until(page, 'one step', ({ steps, running }) => steps === 6 && !running);
  await page.click('#share');
  const shared = await until(page, 'share', ({ message }) => /a program in C/.test(message));
  assert.match(shared.hash, new RegExp(`^#scene=jelly&n=${WANTED}&steps=6&hash=[0-9a-f]{16}$`));
  await visit(page, shared.hash);
  await until(page, 'the shared link', ({ message }) => /after 6 steps: the same bits/.test(message));
  await page.click('button[value=sand]');
  await until(page, 'another scene', ({ steps, running }) => steps > 3 && running);
  await page.locator('#wanted').evaluate((slider) => {
    slider.value = Math.log(3000);
    slider.dispatchEvent(new Event('input'));
    slider.dispatchEvent(new Event('change'));
  });
  await until(page, 'more particles', ({ count }) => count > 2500 && count < 3500);
  const before = await state(page);
  await page.click('#again');
  await until(page, 'again', ({ t }) => t < before.t || t < 0.02);

  // the pointer
  await visit(page, `#scene=jelly&n=${WANTED}&steps=1`);
  const { floats } = await until(page, 'one step', ({ message }) => message.startsWith('State'));
  const box = await page.locator('#picture').boundingBox();
  const at = (x, y) => [box.x + (x / WIDTH) * box.width, box.y + (1 - y / HEIGHT) * box.height];
  await page.mouse.move(...at(0.35, 0.5));
  await page.mouse.down();
  await page.mouse.move(...at(0.35, 0.95), { steps: 4 });
  await page.evaluate(() => document.getElementById('pause').click());
  await until(page, 'dragged', ({ steps, touched }) => steps > 150 && touched);
  await page.evaluate(() => document.getElementById('pause').click());
  await page.mouse.up();
  const dragged = await until(page, 'paused', ({ running }) => !running);
  const library = await load();
  const free = build(library, recipeOf('jelly', Number(WANTED)));
  advance(free.stepper, dragged.steps);
  const heights = free.sets.flatMap((set) => Array.from(set.get('position').subarray(set.count)));
  const moved = mean(dragged.floats, 1) - heights.reduce((a, b) => a + b, 0) / heights.length;
  assert.ok(moved > 0.02, `the pointer has lifted the jelly by ${moved}`);
  assert.equal(dragged.floats.length, floats.length);
  await page.click('#share');
  await until(
    page,
    'share of what was dragged',
    ({ message, hash }) => /begins the scene anew/.test(message) && !/steps/.test(hash),
  );
  console.log(`browser: the pointer has lifted the jelly by ${moved.toFixed(3)}`);

  // a picture whose context is lost comes back, with a scene that was begun meanwhile
  await visit(page, `#scene=sand&n=${WANTED}&steps=1`);
  await until(page, 'sand', ({ message }) => message.startsWith('State'));
  await page.waitForTimeout(300);
  const picture = () => page.locator('#picture').screenshot();
  const whole = await picture();
  await page.evaluate(() => {
    const gl = document.getElementById('picture').getContext('webgl2');
    window.loss = gl.getExtension('WEBGL_lose_context');
    window.loss.loseContext();
  });
  await visitWithin(page, `#scene=jelly&n=${WANTED}&steps=1`);
  const jelly = floats.length / 4;
  await until(page, 'jelly', ({ count, message }) => count === jelly && message.startsWith('State'));
  await visitWithin(page, `#scene=sand&n=${WANTED}&steps=1`);
  await until(page, 'sand again', ({ count, message }) => count !== jelly && message.startsWith('State'));
  await page.evaluate(() => window.loss.restoreContext());
  await page.waitForTimeout(1000);
  assert.ok((await painted(page, 'back')) > 0.1, 'the picture has not come back');
  assert.ok((await picture()).equals(whole), 'the picture is another one since it came back');
  console.log('browser: the picture has come back');

  // the pace is that of the clock, whatever the screen has
  for (const period of [4, 50]) {
    const screen = await fresh({ width: 200, height: 200 });
    await screen.addInitScript((each) => {
      const ask = (draw) => setTimeout(() => (window.hidden ? ask(draw) : draw(performance.now())), each);
      window.requestAnimationFrame = ask;
      window.asked = 0; // seconds for which frames were wanted
      const { postMessage } = Worker.prototype;
      Worker.prototype.postMessage = function (data) {
        if (data.ask === 'frame') window.asked += data.seconds;
        return postMessage.call(this, data);
      };
    }, period);
    await visit(screen, `#scene=jelly&n=${WANTED}`);
    await until(screen, 'a screen', ({ steps }) => steps > 20);
    const clocks = () =>
      screen.evaluate(async () => {
        const { now } = await import('./page.mjs');
        return [now.frame.t, window.asked, performance.now() / 1000];
      });
    const passed = async (what) => {
      const before = await clocks();
      await what();
      return (await clocks()).map((one, k) => one - before[k]);
    };
    const [went, asked, clock] = await passed(() => screen.waitForTimeout(2000));
    const [made, wanted, all] = [went, asked, clock].map((one) => one.toFixed(2));
    const said = `${made} s of the scene, of ${wanted} s asked for, in ${all} s`;
    assert.ok(went < 1.1 * clock, said); // less where the machine is slow
    assert.ok(asked < 1.1 * clock && asked > 0.5 * clock, said);
    console.log(`browser: a picture each ${period} ms: ${said}`);
    const [, hidden, away] = await passed(async () => {
      await screen.evaluate(() => (window.hidden = true));
      await screen.waitForTimeout(2000);
      await screen.evaluate(() => (window.hidden = false));
      await screen.waitForTimeout(300);
    });
    assert.ok(hidden < away - 1, `${hidden} s of the scene were wanted in ${away} s, of which 2 were hidden`);
    await screen.close();
  }

  // what the visitor asks for while the binary comes
  const early = await fresh({ width: 1000, height: 800 });
  let come;
  const wait = new Promise((done) => (come = done));
  await early.route('**/*.wasm', (route) => wait.then(() => route.continue()));
  const opening = visit(early, `#scene=jelly&n=${WANTED}`);
  await early.waitForSelector('button[value=water]');
  await early.waitForTimeout(500);
  await early.click('button[value=water]');
  await early.click('#step');
  await early.waitForTimeout(200);
  come();
  await opening;
  const kept = await until(early, 'an early choice', ({ count, steps }) => count > 0 && steps > 0);
  assert.equal(await early.getAttribute('button[value=water]', 'aria-pressed'), 'true');
  assert.equal(kept.message, '');
  assert.deepEqual([kept.steps, kept.running], [1, false]);

  // the worker by itself: early questions wait for the library; steps that are longer than a frame add up
  const answers = await early.evaluate((frames) => {
    const worker = new Worker('./worker.mjs', { type: 'module' });
    const said = [];
    const all = new Promise((done) => {
      worker.onmessage = ({ data }) => said.push(data) === frames + 3 && done(said);
    });
    worker.postMessage({ id: 1, ask: 'scene', name: 'jelly', wanted: 1000 });
    worker.postMessage({ id: 2, ask: 'hash' });
    worker.postMessage({ id: 3, ask: 'open' });
    for (let k = 0; k < frames; k++) worker.postMessage({ id: 4 + k, ask: 'frame', seconds: 0.5 / frames });
    return all.then((list) => list.map(({ id, answer, error }) => [id, answer?.steps, answer?.t, error]));
  }, 500);
  const first = answers.slice(0, 3).map(([id, , , error]) => [id, error]);
  assert.deepEqual(first, [3, 1, 2].map((id) => [id, undefined]));
  const [, made, t] = answers.at(-1);
  assert.ok(t > 0.48 && t < 0.5 + t / made, `${t} s of the scene in half a second, by ${made} steps`);
  await early.close();

  // light, and a phone
  const dark = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await page.emulateMedia({ colorScheme: 'light' });
  assert.notEqual(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), dark);
  const phone = await fresh({ width: 360, height: 740 });
  await visit(phone, `#scene=stirrer&n=2000&steps=100`);
  await until(phone, 'phone', ({ message }) => message.startsWith('State'));
  assert.ok(await phone.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'wider than a phone');
  await phone.emulateMedia({ colorScheme: 'light' });
  await phone.waitForTimeout(300);
  await phone.screenshot({ path: `${pictures}/phone.png` });
  await page.setViewportSize({ width: 1000, height: 800 });
  await page.emulateMedia({ colorScheme: 'dark' });
  await visit(page, `#${PICTURE}`);
  await until(page, 'the picture', ({ message }) => message.startsWith('State'));
  await page.waitForTimeout(300);
  await page.screenshot({ path: `${pictures}/page.png` });
  assert.deepEqual(errors, []);
  console.log('browser: no errors');
} finally {
  await browser.close();
  server.kill();
}
