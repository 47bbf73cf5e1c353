// Writes a program in C that makes scenes of the live page from the same numbers, and prints the hash of each.
//
//   node native.mjs LIVE steps particles scene... > scenes.c       LIVE: the folder of the page
import { pathToFileURL } from 'node:url';

const [live, steps, wanted, ...names] = process.argv.slice(2);
const { FAR, recipeOf } = await import(new URL('scenes.mjs', pathToFileURL(`${live}/`)));

/** A double, exactly. */
function hex(value) {
  if (value === 0) return '0.0';
  const power = Math.floor(Math.log2(Math.abs(value)));
  const whole = BigInt(Math.round(value * 2 ** (52 - power))); // exact: a product by a power of two
  if (Number(whole) * 2 ** (power - 52) !== value) throw new Error(`${value} is not written exactly`);
  return `${whole < 0n ? '-' : ''}0x${(whole < 0n ? -whole : whole).toString(16)}p${power - 52}`;
}
const list = (type, values) => `(${type}[]){${values.map((one) => (type === 'double' ? hex(one) : one)).join(', ')}}`;
/** Assignments of options to a struct. */
const options = (to, values, types = {}) =>
  Object.entries(values).flatMap(([name, value]) => {
    const one = (number) => (types[name] === 'int' ? String(number) : hex(number));
    return Array.isArray(value)
      ? value.map((number, k) => `  ${to}.${name}[${k}] = ${one(number)};`)
      : [`  ${to}.${name} = ${one(value)};`];
  });
const INTEGERS = { dim: 'int', cells: 'int', transfer: 'int', shape: 'int', motion: 'int' };

function scene(name) {
  const { grid, stepper, materials, sets, contact, walls, obstacles, perCell } = recipeOf(name, Number(wanted));
  const out = [
    `static void ${name}(mpm_context *context) {`,
    '  mpm_grid_desc box;',
    '  mpm_stepper_desc how;',
    '  mpm_contact_desc touch;',
    '  mpm_obstacle_desc rigid;',
    '  mpm_advance_desc go;',
    '  mpm_grid *grid;',
    '  mpm_stepper *stepper;',
    `  mpm_material *material[${materials.length}];`,
    `  mpm_particles *set[${sets.length}];`,
    `  mpm_obstacle *obstacle[${obstacles.length + 1}];`,
    '  uint64_t hash;',
    '  check(context, mpm_grid_desc_init(&box, sizeof box));',
    '  check(context, mpm_stepper_desc_init(&how, sizeof how));',
    '  check(context, mpm_advance_desc_init(&go, sizeof go));',
    ...options('box', grid, INTEGERS),
    ...options('how', stepper, INTEGERS),
    '  check(context, mpm_grid_create(context, &box, &grid));',
    '  check(context, mpm_stepper_create(context, grid, &how, &stepper));',
  ];
  const call = (text) => out.push(`  check(context, ${text});`);
  materials.forEach(([model, params], k) => {
    const pairs = Object.entries(params).map(([key, value]) => `{"${key}", ${hex(value)}}`);
    call(
      `mpm_material_create(context, "${model}", (mpm_param[]){${pairs.join(', ')}}, ${pairs.length}, &material[${k}])`,
    );
  });
  sets.forEach(({ box, ball, velocity, body, material = 0 }, k) => {
    call(`mpm_particles_create(context, grid, material[${material}], &set[${k}])`);
    const cells = list('int32_t', perCell);
    if (box)
      call(
        `mpm_particles_fill_box(set[${k}], ${list('double', box[0])}, ${list('double', box[1])}, ${cells}, NULL, NULL)`,
      );
    else call(`mpm_particles_fill_ball(set[${k}], ${list('double', ball[0])}, ${hex(ball[1])}, ${cells}, NULL, NULL)`);
    if (velocity) call(`mpm_particles_set_all(set[${k}], "velocity", MPM_F64, 2, ${list('double', velocity)})`);
    call(`mpm_stepper_add(stepper, set[${k}])`);
    if (body) call(`mpm_stepper_set_body(stepper, set[${k}], ${body})`);
  });
  if (contact) {
    call('mpm_contact_desc_init(&touch, sizeof touch)');
    out.push(...options('touch', contact));
    call('mpm_stepper_set_contact(stepper, MPM_BODY_ANY, MPM_BODY_ANY, &touch)');
  }
  for (const [face, kind, friction] of walls) call(`mpm_stepper_set_wall(stepper, ${face}, ${kind}, ${hex(friction)})`);
  obstacles.forEach(({ contact: rough, ...desc }, k) => {
    call('mpm_obstacle_desc_init(&rigid, sizeof rigid)');
    call('mpm_contact_desc_init(&touch, sizeof touch)');
    out.push(...options('rigid', desc, INTEGERS), ...options('touch', rough), '  rigid.contact = &touch;');
    call(`mpm_obstacle_create(context, &rigid, &obstacle[${k}])`);
    call(`mpm_stepper_add_obstacle(stepper, obstacle[${k}])`);
  });
  out.push(`  go.t_end = ${hex(FAR)};`, `  go.max_steps = ${Number(steps)};`);
  call('mpm_advance(stepper, &go, NULL)');
  call('mpm_state_hash(stepper, &hash)');
  out.push(`  printf("${name} %016" PRIx64 "\\n", hash);`);
  call('mpm_stepper_destroy(stepper)');
  obstacles.forEach((_, k) => call(`mpm_obstacle_destroy(obstacle[${k}])`));
  sets.forEach((_, k) => call(`mpm_particles_destroy(set[${k}])`));
  materials.forEach((_, k) => call(`mpm_material_destroy(material[${k}])`));
  call('mpm_grid_destroy(grid)');
  if (!contact && !obstacles.length) out.push('  (void)touch;');
  if (!obstacles.length) out.push('  (void)rigid, (void)obstacle;');
  return [...out, '}', ''];
}

console.log(
  [
    '#include <inttypes.h>',
    '#include <mpm/mpm.h>',
    '#include <stdio.h>',
    '#include <stdlib.h>',
    '',
    'static void check(mpm_context *context, mpm_status status) {',
    '  if (!status) return;',
    '  fprintf(stderr, "%s\\n", mpm_last_error(context));',
    '  exit(1);',
    '}',
    '',
    ...names.flatMap(scene),
    'int main(void) {',
    '  mpm_context *context;',
    '  mpm_context_desc services;',
    '  if (mpm_context_desc_init(&services, sizeof services)) return 1;',
    '  services.isa = MPM_ISA_PORTABLE;',
    '  services.concurrency = 2;',
    '  if (mpm_context_create(&services, &context)) return 1;',
    ...names.map((name) => `  ${name}(context);`),
    '  return mpm_context_destroy(context) ? 1 : 0;',
    '}',
  ].join('\n'),
);
