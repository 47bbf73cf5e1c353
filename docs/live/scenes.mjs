// The scenes of the page, as plain numbers: node, the page and a program in C make the same states from them.
import { C } from './libmpm/libmpm.mjs';

export const WIDTH = 1.6;
export const HEIGHT = 1;
const TWO = [2, 2];
const GRAVITY = [0, -9.81];

const area = ({ box, ball }) => (box ? (box[1][0] - box[0][0]) * (box[1][1] - box[0][1]) : Math.PI * ball[1] * ball[1]);
const closed = (friction) =>
  [C.MPM_X_MIN, C.MPM_X_MAX, C.MPM_Y_MIN, C.MPM_Y_MAX].map((face) => [face, C.MPM_WALL_FRICTION, friction]);
const box = (x0, y0, x1, y1) => ({
  box: [
    [x0, y0],
    [x1, y1],
  ],
});
const ball = (x, y, radius) => ({ ball: [[x, y], radius] });

// Each says what there is but for the cells, which follow from the number of particles. `tint` is the colour of a set, and
// `layers` how many bands of it are darker; `pace` is seconds of the scene in a second of the clock, at most.
const SCENES = {
  jelly: {
    title: 'Jelly',
    pace: 1,
    materials: [['neo_hookean', { E: 2e4, nu: 0.3, density: 1000 }]],
    sets: [
      { ...box(0.15, 0.3, 0.55, 0.7), velocity: [1.5, 1], tint: 'green', layers: 4 },
      { ...ball(1.15, 0.5, 0.19), velocity: [-1.5, 0.5], body: 1, tint: 'red', layers: 4 },
    ],
    contact: { friction: 0.2 },
    walls: closed(0.3),
  },
  water: {
    title: 'Water',
    pace: 0.7,
    materials: [['newtonian_fluid', { density: 1000, bulk_modulus: 2e4, gamma: 7, viscosity: 1e-3 }]],
    sets: [{ ...box(0, 0, 0.5, 0.7), tint: 'blue', layers: 0 }],
    walls: closed(0),
  },
  sand: {
    title: 'Sand',
    pace: 0.5,
    materials: [['drucker_prager', { E: 2e5, nu: 0.3, density: 1600, phi: 35 }]],
    sets: [{ ...box(0.6, 0, 1, 0.8), tint: 'ochre', layers: 5 }],
    walls: closed(0.6),
  },
  snow: {
    title: 'Snow',
    pace: 0.25,
    materials: [['snow', { E: 1.4e5, nu: 0.2, density: 400 }]],
    sets: [
      { ...ball(0.3, 0.55, 0.16), velocity: [6, 1], tint: 'white', layers: 3 },
      { ...box(1, 0, 1.3, 0.55), tint: 'white', layers: 0 },
    ],
    walls: closed(0.5),
  },
  stacking: {
    title: 'Stacking',
    pace: 0.7,
    materials: [['neo_hookean', { E: 1e5, nu: 0.3, density: 1000 }]],
    sets: [
      { ...box(0.7, 0, 0.9, 0.15), body: 0, tint: 'ochre', layers: 2 },
      { ...box(0.95, 0, 1.15, 0.15), body: 1, tint: 'green', layers: 2 },
      { ...box(1.2, 0, 1.4, 0.15), body: 2, tint: 'ochre', layers: 2 },
      { ...box(0.825, 0.16, 1.025, 0.31), body: 3, tint: 'green', layers: 2 },
      { ...box(1.075, 0.16, 1.275, 0.31), body: 4, tint: 'ochre', layers: 2 },
      { ...box(0.95, 0.32, 1.15, 0.47), body: 5, tint: 'green', layers: 2 },
      { ...ball(0.2, 0.5, 0.11), body: 6, velocity: [3, 1], tint: 'red', layers: 2 },
    ],
    contact: { friction: 0.5 },
    walls: closed(0.5),
  },
  stirrer: {
    title: 'Stirrer',
    pace: 0.7,
    materials: [['newtonian_fluid', { density: 1000, bulk_modulus: 2e4, gamma: 7, viscosity: 0.5 }]],
    sets: [{ ...box(0, 0, 1.6, 0.42), tint: 'blue', layers: 5 }],
    walls: closed(0),
    obstacles: [
      {
        shape: C.MPM_SHAPE_BOX,
        motion: C.MPM_MOTION_PRESCRIBED,
        size: [0.22, 0.035],
        position: [0.8, 0.3, 0],
        angular_velocity: [0, 0, 5],
        contact: { friction: 0.2 },
      },
    ],
  },
};
export const NAMES = Object.keys(SCENES);
export const titleOf = (name) => SCENES[name].title;
export const LIMITS = { least: 1000, most: 40000, first: 5000 };

/** All that makes a scene, as numbers; `wanted` is about how many particles it shall have. */
export function recipeOf(name, wanted) {
  const scene = SCENES[name];
  const h = Math.sqrt((4 * scene.sets.reduce((sum, set) => sum + area(set), 0)) / wanted);
  return {
    ...scene,
    name,
    obstacles: scene.obstacles ?? [],
    grid: { dim: 2, cells: [Math.ceil(WIDTH / h), Math.ceil(HEIGHT / h)], spacing: [h, h] },
    stepper: { transfer: C.MPM_APIC_MLS, gravity: GRAVITY },
    perCell: TWO,
  };
}

/** Makes the state of a recipe. Disposing of the context's things is the caller's. */
export function build(mpm, recipe) {
  const context = mpm.context({ isa: C.MPM_ISA_PORTABLE });
  const grid = context.grid(recipe.grid);
  const materials = recipe.materials.map(([model, params]) => context.material(model, params));
  const stepper = context.stepper(grid, recipe.stepper);
  const sets = recipe.sets.map((of) => {
    const set = context.particles(grid, materials[of.material ?? 0]);
    if (of.box) set.fillBox(...of.box, recipe.perCell);
    else set.fillBall(...of.ball, recipe.perCell);
    if (of.velocity) set.setAll('velocity', of.velocity);
    stepper.add(set);
    if (of.body) stepper.setBody(set, of.body);
    return set;
  });
  if (recipe.contact) stepper.setContact(C.MPM_BODY_ANY, C.MPM_BODY_ANY, recipe.contact);
  for (const wall of recipe.walls) stepper.setWall(...wall);
  const obstacles = recipe.obstacles.map((desc) => context.obstacle(desc));
  for (const one of obstacles) stepper.addObstacle(one);
  const all = [stepper, ...obstacles, ...sets, ...materials, grid, context];
  return {
    stepper,
    sets,
    obstacles,
    count: sets.reduce((sum, set) => sum + set.count, 0),
    dispose: () => all.forEach((one) => one.dispose()),
  };
}

/** Makes steps of the library's choice. How they are shared out among calls changes no bit. */
export function advance(stepper, steps) {
  return stepper.advance(FAR, { max_steps: steps });
}
export const FAR = 1e6; // a time that no scene reaches
