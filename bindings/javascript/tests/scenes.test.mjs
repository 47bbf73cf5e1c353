// The scenes of the live page have the bits of a native program. LIVE is the page's folder, EXPECTED what that printed.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { load } from 'libmpm';

const { LIVE, EXPECTED, STEPS, WANTED, LIBMPM_WASM } = process.env;
const { NAMES, advance, build, recipeOf } = await import(new URL('scenes.mjs', pathToFileURL(`${LIVE}/`)));
const expected = new Map(
  readFileSync(EXPECTED, 'utf8')
    .trim()
    .split('\n')
    .map((line) => line.split(' ')),
);
const mpm = await load(LIBMPM_WASM || undefined);

test('every scene is compared', () => assert.deepEqual([...expected.keys()].sort(), [...NAMES].sort()));

for (const name of NAMES) {
  test(`${name}: the hash of a native program`, () => {
    const scene = build(mpm, recipeOf(name, Number(WANTED)));
    const start = scene.sets.map((set) => set.get('position'));
    const parts = [1, 2, 50]; // however the steps are shared out
    for (let made = 0, k = 0, now; made < Number(STEPS); made += now, k++) {
      now = Math.min(parts[k % 3], Number(STEPS) - made);
      advance(scene.stepper, now);
    }
    assert.equal(scene.stepper.info().step, Number(STEPS));
    assert.equal(scene.stepper.hash().toString(16).padStart(16, '0'), expected.get(name));
    assert.ok(
      scene.sets.some((set, k) => set.get('position').some((x, i) => Math.abs(x - start[k][i]) > 0.005)),
      'nothing has moved',
    );
    scene.dispose();
  });
}
