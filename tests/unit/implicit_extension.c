/* Rows at the rim that few particles see: bodies that bend far go through, by any number of steps, and the
 * extension adds nothing to forces and to momentum. */
#include "implicit.h"
#include "obstacle.h"

static mpm_status weigh(void *user, const mpm_particle_batch *b, double *add) {
  const double g = *(const double *)user;
  const int32_t down = b->dim - 1;
  for (int64_t p = 0; p < b->n; ++p) add[down * b->ld + p] -= g * fmin(1.0, b->t);
  return MPM_OK;
}

/* A cantilever along x that bends down by its depth and more; it lies at a place that is not a node. */
typedef struct cantilever {
  world w;
  int64_t n;
  double weight, g;
} cantilever;

enum { DEPTH = 3, LENGTH = 15 };

static void cantilever_open(cantilever *c, const basis_option *basis, int32_t dim, int32_t threads) {
  const double h = 0.1, low[3] = {0.0, 1.0, dim == 3 ? 1.0 : 0.0},
               high[3] = {LENGTH * h, 1.0 + DEPTH * h, 1.0 + DEPTH * h};
  world_desc d = implicit_default(dim, 20, h, basis);
  d.context.concurrency = threads;
  d.stepper.quasi_static = 1;
  *c = (cantilever){.g = 1.1};
  mpm_particles *set = world_open(&c->w, &d);
  c->n = world_fill(&c->w, set, low, high, 2);
  double *x = fetch(&c->w, set, "position", dim), *m = fetch(&c->w, set, "mass", 1);
  for (int64_t i = c->n; i < dim * c->n; ++i) x[i] += 0.037 * h;
  put(&c->w, set, "position", dim, x);
  c->weight = sum_of(c->n, m) * c->g;
  free(x), free(m);
  ck_ok(&c->w, mpm_stepper_set_wall(c->w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(&c->w, mpm_stepper_set_acceleration(c->w.stepper, weigh, &c->g));
}

/* Puts the weight on in equal steps, from `first` of `steps` to `last`. */
static void cantilever_load(cantilever *c, int32_t first, int32_t last, int32_t steps) {
  for (int32_t k = first; k < last; ++k) {
    const mpm_step_info info = world_step(&c->w, 1.0 / steps);
    ck_assert_int_le(info.newton_iterations, 10);
  }
}

/* How low the lowest particle is. */
static double cantilever_tip(const cantilever *c) {
  double *x = fetch(&c->w, c->w.set[0], "position", c->w.dim), lowest = INFINITE;
  for (int64_t i = 0; i < c->n; ++i) lowest = fmin(lowest, x[(c->w.dim - 1) * c->n + i]);
  free(x);
  return lowest;
}

/* Ten and forty steps give the same shape, and the wall carries the weight. */
START_TEST(cantilevers) {
  const int32_t dim = _i < IMPLICIT_BASES ? 2 : 3;
  const basis_option *basis = implicit_basis(dim == 2 ? _i : 1 + _i - IMPLICIT_BASES);
  double tip[2];
  for (int32_t k = 0; k < 2; ++k) {
    const int32_t steps = dim == 3 ? 5 + k : 10 + 30 * k;
    cantilever c;
    cantilever_open(&c, basis, dim, 1);
    cantilever_load(&c, 0, steps, steps);
    double force[3];
    ck_ok(&c.w, mpm_stepper_wall_reaction(c.w.stepper, MPM_X_MIN, force));
    ck_within(basis->name, force[dim - 1], c.weight, 1e-7 * c.weight);
    ck_within(basis->name, force[0], 0.0, 1e-7 * c.weight);
    tip[k] = cantilever_tip(&c) - 1.0;
    show("%s, %d-D, %d steps: lowest %.5f\n", basis->name, (int)dim, (int)steps, tip[k]);
    world_close(&c.w);
  }
  ck_between(basis->name, -tip[0], 0.25, 0.75);
  ck_within(basis->name, tip[1], tip[0], (basis->basis == MPM_LINEAR ? 0.05 : 0.01) * -tip[0]);
}
END_TEST

/* Threads, and a state saved on the way, change no bit. */
START_TEST(cantilevers_again) {
  cantilever one, three, loaded;
  const basis_option *basis = implicit_basis(1 + _i);
  cantilever_open(&one, basis, 2, 1);
  cantilever_open(&three, basis, 2, 3);
  cantilever_open(&loaded, basis, 2, 1);
  cantilever_load(&one, 0, 6, 8);
  cantilever_load(&three, 0, 8, 8);
  world_copy(&one.w, &loaded.w);
  cantilever_load(&one, 6, 8, 8);
  cantilever_load(&loaded, 6, 8, 8);
  ck_holds(world_hash(&one.w) == world_hash(&three.w));
  ck_holds(world_hash(&one.w) == world_hash(&loaded.w));
  world_close(&one.w);
  world_close(&three.w);
  world_close(&loaded.w);
}
END_TEST

/* A free block of noise that moves over the nodes keeps its momentum and its energy, and turns on. */
START_TEST(free_momentum) {
  const basis_option *basis = implicit_basis(_i % IMPLICIT_BASES);
  const int32_t dim = 2 + _i / IMPLICIT_BASES;
  world w;
  world_desc d = implicit_default(dim, 12, 0.1, basis);
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = implicit_block(&w, set, 0.4, 0.7, NULL);
  double *x = fetch(&w, set, "position", dim), *v = fetch(&w, set, "velocity", dim);
  for (int32_t c = 0; c < dim; ++c)
    for (int64_t i = 0; i < n; ++i) {
      x[c * n + i] += 0.0021;
      v[c * n + i] = 0.2 * noise_at((uint64_t)(c * n + i)) + (c == 0 ? 1.0 : 0.3) +
                     2.0 * (c == 0   ? x[n + i] - 0.55
                            : c == 1 ? 0.55 - x[i]
                                     : 0.0);
    }
  put(&w, set, "position", dim, x);
  put(&w, set, "velocity", dim, v);
  free(x), free(v);
  const mpm_step_info first = world_info(&w);
  for (int32_t k = 0; k < 12; ++k) {
    const mpm_step_info now = world_step(&w, 0.01);
    for (int32_t c = 0; c < dim; ++c)
      ck_within(basis->name, now.momentum[c], first.momentum[c], 1e-11 * fabs(first.momentum[0]));
    ck_within(basis->name, now.angular_momentum[2], first.angular_momentum[2],
              0.02 * fabs(first.angular_momentum[2])); /* FLIP does not keep that of noise */
    ck_between(basis->name, now.kinetic_energy + now.strain_energy, 0.0,
               1.02 * (first.kinetic_energy + first.strain_energy));
  }
  world_close(&w);
}
END_TEST

/* A block of noise over the seam of a periodic axis, on more cells than a block of nodes has, strains as
 * everywhere else. */
START_TEST(over_the_seam) {
  enum { CELLS = 40, STEPS = 3 };
  const basis_option *basis = implicit_basis(_i);
  const double h = 0.1;
  double energy[STEPS];
  for (int32_t at = 10; at < CELLS; at += at < 30 ? 10 : 1) {
    world w;
    world_desc d = implicit_default(2, CELLS, h, basis);
    d.grid.periodic[0] = 1;
    mpm_particles *set = world_open(&w, &d);
    const int64_t n = implicit_block(&w, set, 10.0 * h, 14.0 * h, NULL);
    double *x = fetch(&w, set, "position", 2), *v = fetch(&w, set, "velocity", 2);
    for (int64_t i = 0; i < 2 * n; ++i) v[i] = 0.3 * noise_at((uint64_t)i);
    for (int64_t i = 0; i < n; ++i) x[i] += (at - 9.989) * h, x[n + i] += 0.0113;
    put(&w, set, "position", 2, x);
    put(&w, set, "velocity", 2, v);
    free(x), free(v);
    for (int32_t k = 0; k < STEPS; ++k) {
      const double now = world_step(&w, 0.01).strain_energy;
      if (at == 10) energy[k] = now;
      ck_within(basis->name, now, energy[k], 1e-9 * energy[k]);
    }
    world_close(&w);
  }
}
END_TEST

/* A block on a plane, which its weight shortens by 1.5 %, goes on from rest with inertia. One step without it
 * balances forces on the weights from before that step, and leaves velocities; what further steps leave on
 * quadratic splines comes of first accelerations by row. */
START_TEST(goes_on_from_rest) {
  static const int32_t bases[] = {MPM_LINEAR, MPM_BSPLINE2, MPM_BSPLINE3}, steps[] = {1, 2, 4};
  static const double most[3][3] = {{4e-3, 2e-5, 1e-7}, {4e-3, 2e-4, 2e-4}, {4e-3, 1e-5, 1e-7}};
  const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  const double h = 0.1, g = 100.0, dt = 0.01, low[] = {0.5, 0.5}, high[] = {0.8, 0.8};
  world_desc d = world_with(&how, 2, 14, h);
  d.grid.basis = bases[_i / 3];
  d.law.density = 1.0, d.law.E = 1e3, d.law.nu = 0.3;
  d.stepper.gravity[1] = -g;
  d.stepper.newton_tolerance_residual = 1e-12;
  d.stepper.quasi_static = 1;
  world w;
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = world_fill(&w, set, low, high, 2);
  mpm_obstacle_desc plane = obstacle_desc(MPM_SHAPE_PLANE);
  plane.position[1] = 0.5;
  mpm_obstacle *o = put_obstacle(&w, &plane);
  const mpm_contact_desc rule = rule_with(0.5);
  ck_ok(&w, mpm_obstacle_set_contact(o, &rule));
  for (int32_t k = 0; k < steps[_i % 3]; ++k) world_step(&w, dt);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, (double[]){0.0, 0.0}));
  d.stepper.quasi_static = 0;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &d.stepper));
  double fastest = 0.0;
  for (int32_t k = 0; k < 50; ++k) {
    world_step(&w, dt);
    double *v = fetch(&w, set, "velocity", 2);
    fastest = fmax(fastest, largest(2 * n, v));
    free(v);
  }
  show("basis %d after %d steps: %.1e of g dt\n", (int)bases[_i / 3], (int)steps[_i % 3], fastest / (g * dt));
  ck_within("velocity", fastest, 0.0, most[_i / 3][_i % 3] * g * dt);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

TCase *implicit_extension_case(void) {
  TCase *tests = tcase_create("extension");
  tcase_set_timeout(tests, 60.0);
  tcase_add_loop_test(tests, cantilevers, 0, IMPLICIT_BASES + 1);
  tcase_add_loop_test(tests, cantilevers_again, 0, 2);
  tcase_add_loop_test(tests, free_momentum, 0, 2 * IMPLICIT_BASES);
  tcase_add_loop_test(tests, over_the_seam, 0, IMPLICIT_BASES);
  tcase_add_loop_test(tests, goes_on_from_rest, 0, 9);
  return tests;
}
