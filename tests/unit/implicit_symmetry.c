/* Half of a body on a slip wall, or a quarter between two, moves in implicit steps as the whole body does,
 * with rows at its rim that move with others, and light ones in contact. */
#include "implicit.h"

static const double plane = 0.8, edge = 0.1;
enum { ROW = 8, SHAPES = 6 }; /* particles along an axis of a quarter */

/* How many slip walls there are, whether the body is whole instead, and its shape. */
typedef struct part {
  int32_t walls, whole, shape;
} part;

typedef struct outcome {
  int64_t n;
  double *x, *F;
} outcome;

/* Pushes to the plane, and away from the other one or down. */
static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  const part *of = user;
  for (int64_t p = 0; p < b->n; ++p) {
    add[p] -= 3.0 * (b->position[p] - plane);
    add[b->ld + p] += of->walls == 2 ? 2.0 * (b->position[b->ld + p] - plane) : -0.4;
  }
  return MPM_OK;
}

/* Holds what a whole body without inertia could turn and fall by. */
static mpm_status hold(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    const double across = fabs(b->position[i] - plane), along = fabs(b->position[b->ld + i] - plane);
    if (across > 1.01 * edge || along > 0.01 * edge) continue;
    prescribed[b->ld + i] = 1;
    velocity[b->ld + i] = 0.0;
    if (across > 0.01 * edge) continue;
    prescribed[i] = 1;
    velocity[i] = 0.0;
  }
  return MPM_OK;
}

/* Bends the lattice, into an arrow along the first plane in most shapes, so that its rims cross rows of nodes
 * here and there. */
static void bend(world *w, mpm_particles *set, const part *of, int64_t n) {
  static const double slope[SHAPES] = {0.0, 0.9, -0.9, 0.5, -0.5, 1.2};
  double *x = fetch(w, set, "position", 2);
  for (int64_t p = 0; p < n; ++p) {
    const double u = x[p] - plane, v = x[n + p] - plane, arrow = slope[of->shape] * fabs(u);
    x[p] = plane + u * (1.037 + 0.1 * cos(5.0 * v));
    x[n + p] = plane + (of->walls == 2 ? v * (1.023 + 0.08 * cos(6.0 * u) + 2.0 * arrow)
                                       : v + 0.137 * of->shape * edge + 0.6 * edge * cos(7.0 * u) + arrow);
  }
  put(w, set, "position", 2, x);
  free(x);
}

/* Opens a world with the body; returns how many particles it has. */
static int64_t open_part(world *w, const basis_option *basis, int32_t quasi_static, double gamma,
                         const part *of) {
  world_desc d = implicit_default(2, 16, edge, basis);
  double lower[2] = {plane - 0.4, plane - 0.2}, upper[2] = {plane + 0.4, plane + 0.2};
  if (of->walls == 2) lower[1] = plane - 0.4, upper[1] = plane + 0.4;
  for (int32_t k = 0; k < of->walls && !of->whole; ++k)
    lower[k] = d.grid.origin[k] = plane, d.grid.cells[k] = 8;
  d.stepper.quasi_static = quasi_static;
  d.stepper.newmark_gamma = gamma;
  d.stepper.newmark_beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
  mpm_particles *set = world_open(w, &d);
  for (int32_t k = 0; k < of->walls && !of->whole; ++k)
    ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MIN + 2 * k, MPM_WALL_SLIP, 0.0));
  const int64_t n = world_fill(w, set, lower, upper, 2);
  bend(w, set, of, n);
  return n;
}

enum { DYNAMIC, QUASI_STATIC, IN_CONTACT, LOADS };
static const char *const load_name[LOADS] = {"Newmark", "quasi-static", "Newmark in contact"};

/* Lets the body fall on a plane right below it, which is returned. */
static mpm_obstacle *drop(world *w, int64_t n) {
  double *x = fetch(w, w->set[0], "position", 2), lowest = INFINITE, down[2] = {0.0, -1.0};
  for (int64_t p = 0; p < n; ++p) lowest = fmin(lowest, x[n + p]);
  free(x);
  mpm_obstacle_desc d;
  mpm_obstacle *floor = NULL;
  ck_assert_int_eq(mpm_obstacle_desc_init(&d, sizeof d), MPM_OK);
  d.shape = MPM_SHAPE_PLANE;
  d.position[1] = lowest - 0.4 * edge;
  ck_ok(w, mpm_obstacle_create(w->context, &d, &floor));
  ck_ok(w, mpm_stepper_add_obstacle(w->stepper, floor));
  ck_ok(w, mpm_particles_set_all(w->set[0], "velocity", MPM_F64, 2, down));
  return floor;
}

static outcome run(const basis_option *basis, int32_t load, part of, int32_t steps) {
  world w;
  const int64_t n = open_part(&w, basis, load == QUASI_STATIC, load == IN_CONTACT ? 0.6 : 0.5, &of);
  ck_ok(&w, mpm_stepper_set_acceleration(w.stepper, push, &of));
  if (load == QUASI_STATIC) ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, hold, NULL));
  mpm_obstacle *floor = load == IN_CONTACT ? drop(&w, n) : NULL;
  for (int32_t k = 0; k < steps; ++k) world_step(&w, 0.02);
  const outcome end = {n, fetch(&w, w.set[0], "position", 2), fetch(&w, w.set[0], "deformation_gradient", 9)};
  if (floor) ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, floor));
  ck_ok(&w, mpm_obstacle_destroy(floor));
  world_close(&w);
  return end;
}

/* Ids run along x slowest. */
static int64_t image_of(const outcome *part_of, int32_t walls, int64_t p) {
  return walls == 1 ? part_of->n + p : (ROW + p / ROW) * 2 * ROW + ROW + p % ROW;
}

static double difference(const outcome *a, const outcome *b, int32_t walls, int32_t components,
                         const double *of_a, const double *of_b) {
  double worst = 0.0;
  for (int32_t c = 0; c < components; ++c)
    for (int64_t p = 0; p < a->n; ++p) {
      const double off = fabs(of_b[c * b->n + image_of(a, walls, p)] - of_a[c * a->n + p]);
      if (!(off <= worst)) worst = off;
    }
  return worst;
}

static void check(const basis_option *basis, int32_t load, int32_t walls, int32_t shape) {
  const int32_t steps = load == IN_CONTACT ? 6 : 4;
  outcome some = run(basis, load, (part){walls, 0, shape}, steps),
          all = run(basis, load, (part){walls, 1, shape}, steps);
  ck_assert_int_eq(all.n, (walls == 1 ? 2 : 4) * some.n);
  double bent = 0.0;
  for (int64_t p = 0; p < some.n; ++p) bent = fmax(bent, fabs(some.F[p] - 1.0));
  const double x = difference(&some, &all, walls, 2, some.x, all.x),
               F = difference(&some, &all, walls, 9, some.F, all.F);
  show("%s, %s, %d walls, shape %d: x %.1e, F %.1e of %.1e\n", basis->name, load_name[load], (int)walls,
       (int)shape, x, F, bent);
  ck_assert_double_gt(bent, 1e-3);
  const double bound = load == IN_CONTACT ? 1e-8 : 1e-12;
  ck_between(basis->name, x, 0.0, bound);
  ck_between(basis->name, F, 0.0, bound);
  free(some.x), free(some.F), free(all.x), free(all.F);
}

/* Functions of open knots differ at a wall from those inside, and there is no such whole body. */
START_TEST(part_on_slip_walls_is_the_whole) {
  const basis_option *basis = implicit_basis(_i / SHAPES);
  if (basis->boundary == MPM_BOUNDARY_OPEN_KNOT) return;
  for (int32_t walls = 1; walls <= 2; ++walls)
    for (int32_t load = 0; load < (walls == 1 ? LOADS : IN_CONTACT); ++load)
      check(basis, load, walls, _i % SHAPES);
}
END_TEST

/* What rows at the rim hand on to nodes on the plane is felt by the wall: nothing else takes momentum. With
 * gamma = 1 a step changes it by the force at its end, which walls report. */
START_TEST(walls_take_the_momentum) {
  const basis_option *basis = implicit_basis(_i / SHAPES);
  const part half = {1, 0, _i % SHAPES};
  world w;
  const int64_t n = open_part(&w, basis, 0, 1.0, &half);
  double *x = fetch(&w, w.set[0], "position", 2), *v = malloc((size_t)(2 * n) * sizeof *v), impulse[3];
  for (int64_t p = 0; p < n; ++p) v[p] = -2.0 * (x[p] - plane), v[n + p] = 1.0 + 0.5 * x[n + p];
  put(&w, w.set[0], "velocity", 2, v);
  free(x), free(v);
  const mpm_step_info first = world_info(&w);
  for (int32_t k = 0; k < 4; ++k) {
    const mpm_step_info now = world_step(&w, 0.02);
    ck_ok(&w, mpm_stepper_wall_impulse(w.stepper, MPM_X_MIN, impulse));
    for (int32_t c = 0; c < 2; ++c)
      ck_within(basis->name, now.momentum[c] - first.momentum[c], impulse[c],
                1e-10 * fabs(first.momentum[0]));
  }
  ck_assert_double_gt(fabs(impulse[0]), 0.01 * fabs(first.momentum[0]));
  world_close(&w);
}
END_TEST

TCase *implicit_symmetry_case(void) {
  TCase *tests = tcase_create("symmetry");
  tcase_set_timeout(tests, 60.0);
  tcase_set_tags(tests, "long");
  tcase_add_loop_test(tests, part_on_slip_walls_is_the_whole, 0, IMPLICIT_BASES * SHAPES);
  return tests;
}

TCase *implicit_mirrors_case(void) {
  TCase *tests = tcase_create("mirrors");
  tcase_set_timeout(tests, 60.0);
  tcase_add_loop_test(tests, walls_take_the_momentum, 0, IMPLICIT_BASES * SHAPES);
  return tests;
}
