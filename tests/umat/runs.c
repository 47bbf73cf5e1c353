/* Whole runs: UMATs beside laws built in, threads, states that are saved. */
#include "umat_test.h"

static const double E = 70e9, nu = 0.3, density = 2700.0, yield = 300e6, hardening = 1e9, h = 0.1;

enum { MOST = 2000 };
typedef struct run {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *block;
  mpm_stepper *stepper;
  int32_t dim;
  int64_t n;
  double stress[6 * MOST], state[2 * MOST];
} run;

static mpm_material *steel(mpm_context *context, int32_t umat, int32_t differenced) {
  const double props[4] = {E, nu, yield, hardening};
  mpm_umat_desc d = umat_desc(density, 4, props, 1);
  mpm_material *material;
  d.differenced = differenced;
  const mpm_param params[] = {
      {"E", E}, {"nu", nu}, {"density", density}, {"yield_stress", yield}, {"hardening", hardening}};
  if (umat)
    ck_ok(context, mpm_umat_material(context, umat_j2_, &d, &material));
  else
    ck_ok(context, mpm_material_create(context, "j2", params, 5, &material));
  return material;
}

static mpm_stepper_desc explicit_desc(void) {
  mpm_stepper_desc d;
  ck_ok(NULL, mpm_stepper_desc_init(&d, sizeof d));
  d.scheme = MPM_MUSL;
  return d;
}

/* A block of 8 x 8 (x 4) cells upon the lower face; takes the material. */
static run run_of(mpm_context *context, mpm_material *material, int32_t dim, const mpm_stepper_desc *desc) {
  run r = {.context = context, .material = material, .dim = dim};
  mpm_grid_desc g;
  const int32_t per_cell[] = {2, 2, 1};
  const double lower[] = {0.5, 0.0, 0.3}, upper[] = {1.3, 0.8, 0.7};
  ck_ok(context, mpm_grid_desc_init(&g, sizeof g));
  g.dim = dim;
  for (int k = 0; k < dim; ++k) g.spacing[k] = h, g.cells[k] = k == 2 ? 10 : 18;
  ck_ok(context, mpm_grid_create(context, &g, &r.grid));
  ck_ok(context, mpm_particles_create(context, r.grid, material, &r.block));
  ck_ok(context, mpm_particles_fill_box(r.block, lower, upper, per_cell, NULL, &r.n));
  ck_assert_int_le(r.n, MOST);
  ck_ok(context, mpm_stepper_create(context, r.grid, desc, &r.stepper));
  ck_ok(context, mpm_stepper_add(r.stepper, r.block));
  return r;
}

static void look(run *r, int32_t states) {
  ck_ok(r->context, mpm_particles_get(r->block, "stress", MPM_F64, 6, r->n, NULL, r->stress));
  ck_ok(r->context, mpm_particles_get(r->block, "state", MPM_F64, states, r->n, NULL, r->state));
}

static void end(run *r, int with_context) {
  ck_ok(r->context, mpm_stepper_destroy(r->stepper));
  ck_ok(r->context, mpm_particles_destroy(r->block));
  ck_ok(r->context, mpm_material_destroy(r->material));
  ck_ok(r->context, mpm_grid_destroy(r->grid));
  if (with_context) ck_ok(r->context, mpm_context_destroy(r->context));
}

/* Thrown at a wall, and turning. */
static void throw_it(run *r) {
  static double x[3 * MOST], v[3 * MOST];
  ck_ok(r->context, mpm_stepper_set_wall(r->stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  ck_ok(r->context, mpm_particles_get(r->block, "position", MPM_F64, r->dim, r->n, NULL, x));
  for (int64_t i = 0; i < r->n; ++i) {
    v[i] = 80.0 * (x[r->n + i] - 0.4);
    v[r->n + i] = -200.0;
    if (r->dim == 3) v[2 * r->n + i] = 60.0 * (x[r->n + i] - 0.4);
  }
  ck_ok(r->context, mpm_particles_set(r->block, "velocity", MPM_F64, r->dim, r->n, NULL, v));
}

static void fly(run *r, int steps) {
  for (int k = 0; k < steps; ++k) {
    double dt;
    ck_ok(r->context, mpm_stable_dt(r->stepper, &dt));
    ck_ok(r->context, mpm_step(r->stepper, 0.4 * dt, NULL));
  }
}

static void ck_same_stress(const run *a, const run *b, double off) {
  double most = 0.0, apart = 0.0, plastic = 0.0, plastic_apart = 0.0;
  for (int64_t i = 0; i < 6 * a->n; ++i) {
    most = fmax(most, fabs(b->stress[i]));
    apart = fmax(apart, fabs(a->stress[i] - b->stress[i]));
  }
  for (int64_t i = 0; i < a->n; ++i) {
    plastic = fmax(plastic, b->state[i]);
    plastic_apart = fmax(plastic_apart, fabs(a->state[i] - b->state[i]));
  }
  printf("umat: %lld particles in %d-D, plastic strain %.3f: stresses differ by %.1e of the largest, plastic "
         "strains by %.1e\n",
         (long long)a->n, (int)a->dim, plastic, apart / most, plastic_apart);
  ck_near(apart / most, 0.0, off);
  ck_near(plastic_apart, 0.0, off);
}

static void impact(int32_t dim, double plastic) {
  static run own, built_in;
  const mpm_stepper_desc desc = explicit_desc();
  mpm_context *a = context_of(2), *b = context_of(1);
  own = run_of(a, steel(a, 1, 0), dim, &desc);
  built_in = run_of(b, steel(b, 0, 0), dim, &desc);
  run *both[] = {&own, &built_in};
  for (int k = 0; k < 2; ++k) throw_it(both[k]), fly(both[k], 200), look(both[k], k ? 1 : 2);
  double most = 0.0;
  for (int64_t i = 0; i < own.n; ++i) {
    most = fmax(most, own.state[i]);
    ck_near(own.state[own.n + i], 200.0, 0.0); /* the steps of each particle */
  }
  ck_assert(most > plastic);
  ck_same_stress(&own, &built_in, 1e-12);
  end(&own, 1);
  end(&built_in, 1);
}

START_TEST(impact_in_the_plane) {
  impact(2, 0.25);
}
END_TEST

START_TEST(impact_in_space) {
  impact(3, 0.2);
}
END_TEST

/* Pulled and pushed at its upper edge in eight quasi-static steps. */
static int32_t press(run *r) {
  static double x[2 * MOST], f[2 * MOST];
  int32_t newton = 0;
  ck_ok(r->context, mpm_stepper_set_wall(r->stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(r->context, mpm_particles_get(r->block, "position", MPM_F64, 2, r->n, NULL, x));
  for (int k = 1; k <= 8; ++k) {
    mpm_step_info info = {.struct_size = sizeof info};
    for (int64_t i = 0; i < r->n; ++i) {
      const double top = x[r->n + i] > 0.75 ? 1.0 : 0.0;
      f[i] = 0.4e6 * k * top;
      f[r->n + i] = -2.1e6 * k * top;
    }
    ck_ok(r->context, mpm_particles_set(r->block, "applied_force", MPM_F64, 2, r->n, NULL, f));
    ck_ok(r->context, mpm_step(r->stepper, 1.0, &info));
    newton += info.newton_iterations;
  }
  return newton;
}

START_TEST(implicit_steps) {
  static run r[3];
  int32_t newton[3];
  mpm_stepper_desc desc = explicit_desc();
  desc.scheme = MPM_NEWMARK;
  desc.quasi_static = 1;
  desc.newton_tolerance_residual = 1e-12;
  for (int k = 0; k < 3; ++k) { /* built in, with DDSDDE, differenced */
    mpm_context *context = context_of(2);
    r[k] = run_of(context, steel(context, k > 0, k == 2), 2, &desc);
    newton[k] = press(&r[k]);
    look(&r[k], k ? 2 : 1);
  }
  printf("umat: Newton iterations: built in %d, with DDSDDE %d, differenced %d\n", (int)newton[0],
         (int)newton[1], (int)newton[2]);
  ck_same_stress(&r[1], &r[0], 1e-9);
  ck_same_stress(&r[2], &r[0], 1e-9);
  ck_assert_int_le(10 * abs(newton[1] - newton[0]), newton[0]);
  ck_assert_int_le(10 * abs(newton[2] - newton[0]), 2 * newton[0]);
  for (int64_t i = 0; i < r[1].n; ++i) ck_near(r[1].state[r[1].n + i], 8.0, 0.0);
  for (int k = 0; k < 3; ++k) end(&r[k], 1);
}
END_TEST

/* ---- threads ----------------------------------------------------------------------------------------- */
int calls_of_common(int reset);

/* Two materials of one UMAT in a stepper. Returns the state of it all. */
static uint64_t two_sets(int32_t threads, int32_t serial) {
  static run r;
  mpm_context *context = context_of(threads);
  mpm_material *material[2];
  mpm_particles *other;
  const mpm_stepper_desc desc = explicit_desc();
  const int32_t per_cell[] = {2, 2};
  const double lower[] = {0.5, 0.9}, upper[] = {1.3, 1.6};
  double most = 0.0, overtaken[2 * MOST];
  uint64_t hash;
  int64_t n;
  for (int k = 0; k < 2; ++k) {
    const double props[2] = {k ? E : 0.5 * E, nu};
    mpm_umat_desc d = umat_desc(density, 2, props, 1);
    d.serial = serial;
    ck_ok(context, mpm_umat_material(context, umat_common_, &d, &material[k]));
  }
  r = run_of(context, material[0], 2, &desc);
  ck_ok(context, mpm_particles_create(context, r.grid, material[1], &other));
  ck_ok(context, mpm_particles_fill_box(other, lower, upper, per_cell, NULL, &n));
  ck_ok(context, mpm_stepper_add(r.stepper, other));
  throw_it(&r);
  calls_of_common(1);
  fly(&r, 50);
  if (serial) ck_assert_int_eq(calls_of_common(0), 50 * (r.n + n));
  look(&r, 2);
  ck_ok(context, mpm_particles_get(other, "state", MPM_F64, 2, n, NULL, overtaken));
  for (int64_t i = 0; i < r.n; ++i) most = fmax(most, r.state[i]);
  for (int64_t i = 0; i < n; ++i) most = fmax(most, overtaken[i]);
  if (serial) ck_near(most, 0.0, 0.0);
  ck_ok(context, mpm_state_hash(r.stepper, &hash));
  ck_ok(context, mpm_stepper_remove(r.stepper, other));
  ck_ok(context, mpm_particles_destroy(other));
  end(&r, 0);
  ck_ok(context, mpm_material_destroy(material[1]));
  ck_ok(context, mpm_context_destroy(context));
  return hash;
}

START_TEST(common_under_threads) {
  const uint64_t alone = two_sets(1, 1);
  ck_assert(two_sets(4, 1) == alone);
}
END_TEST

/* A UMAT that keeps nothing may run on all of them at once. */
START_TEST(free_under_threads) {
  static run r[2];
  const mpm_stepper_desc desc = explicit_desc();
  uint64_t hash[2];
  for (int k = 0; k < 2; ++k) {
    mpm_context *context = context_of(k ? 4 : 1);
    const double props[4] = {E, nu, yield, hardening};
    mpm_umat_desc d = umat_desc(density, 4, props, 1);
    mpm_material *material;
    d.serial = k == 0;
    d.stran = 1;
    ck_ok(context, mpm_umat_material(context, umat_j2_, &d, &material));
    r[k] = run_of(context, material, 2, &desc);
    throw_it(&r[k]);
    fly(&r[k], 60);
    ck_ok(context, mpm_state_hash(r[k].stepper, &hash[k]));
    end(&r[k], 1);
  }
  ck_assert(hash[0] == hash[1]);
}
END_TEST

/* Steps that follow on a saved state are those that would have followed without. */
START_TEST(saved_states) {
  static run r, again;
  const mpm_stepper_desc desc = explicit_desc();
  mpm_context *context = context_of(1);
  uint64_t bytes, hash[2];
  r = run_of(context, steel(context, 1, 0), 2, &desc);
  throw_it(&r);
  fly(&r, 30);
  int64_t size;
  ck_ok(context, mpm_state_size(r.stepper, &size));
  bytes = (uint64_t)size;
  void *memory = malloc(bytes);
  ck_ok(context, mpm_state_save(r.stepper, memory, size));
  fly(&r, 30);
  ck_ok(context, mpm_state_hash(r.stepper, &hash[0]));
  end(&r, 1);
  context = context_of(1);
  again = run_of(context, steel(context, 1, 0), 2, &desc);
  ck_ok(context, mpm_stepper_set_wall(again.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  ck_ok(context, mpm_state_load(again.stepper, memory, size));
  fly(&again, 30);
  ck_ok(context, mpm_state_hash(again.stepper, &hash[1]));
  ck_assert(hash[0] == hash[1]);
  free(memory);
  end(&again, 1);
}
END_TEST

/* Soil so stiff that its elastic strains, 1e-5, are nothing beside 1: the library's law in Kirchhoff stress
 * and the UMAT in rates of the Cauchy stress part only by these and by the change of volume. */
START_TEST(soil_under_its_weight) {
  static run r[2];
  mpm_stepper_desc desc = explicit_desc();
  desc.gravity[1] = -9.81;
  desc.gravity[0] = 9.0;
  const double radians = acos(-1.0) / 180.0, s = sin(30.0 * radians), c = cos(30.0 * radians);
  const double props[5] = {2e8, 0.3, 6.0 * s / (3.0 - s), 0.0, 1e3 * 6.0 * c / (3.0 - s)};
  const mpm_param params[] = {{"E", 2e8},    {"nu", 0.3},       {"density", 2e3},
                              {"phi", 30.0}, {"cohesion", 1e3}, {"close_gaps", 0}};
  for (int k = 0; k < 2; ++k) {
    mpm_context *context = context_of(2);
    mpm_umat_desc d = umat_desc(2e3, 5, props, 1);
    mpm_material *material;
    if (k)
      ck_ok(context, mpm_material_create(context, "drucker_prager", params, 6, &material));
    else
      ck_ok(context, mpm_umat_material(context, umat_drucker_prager_, &d, &material));
    r[k] = run_of(context, material, 2, &desc);
    ck_ok(context, mpm_stepper_set_wall(r[k].stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
    for (int n = 0; n < 400; ++n) ck_ok(context, mpm_step(r[k].stepper, 5e-5, NULL));
    look(&r[k], 2);
  }
  double yields = 0.0;
  for (int64_t i = 0; i < r[0].n; ++i) yields = fmax(yields, r[0].state[i]);
  ck_assert(yields > 1e-5);
  ck_same_stress(&r[0], &r[1], 5e-3);
  for (int k = 0; k < 2; ++k) end(&r[k], 1);
}
END_TEST

TCase *runs_case(void) {
  TCase *tcase = tcase_create("runs");
  tcase_set_timeout(tcase, 60);
  tcase_add_test(tcase, impact_in_the_plane);
  tcase_add_test(tcase, impact_in_space);
  tcase_add_test(tcase, implicit_steps);
  tcase_add_test(tcase, common_under_threads);
  tcase_add_test(tcase, free_under_threads);
  tcase_add_test(tcase, saved_states);
  tcase_add_test(tcase, soil_under_its_weight);
  return tcase;
}
