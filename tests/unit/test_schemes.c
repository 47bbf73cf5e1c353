/* Whole steps against the independent evaluation of reference_step.c: every basis, scheme and transfer, with
 * second-order positions, staggered velocities and the remedy against locking, on random clouds that reach
 * from face to face. */
#include "reference.h"
#include "schemes.h"

enum { VARIANTS = 6, STEPS = 4 };
static const struct {
  int32_t position_order, staggered, locking, projected;
  const char *name;
} variants[VARIANTS] = {
    {1, 0, 0, 0, ""},         {2, 0, 0, 0, ", order 2"},   {1, 1, 0, 0, ", staggered"},
    {1, 0, 1, 0, ", remedy"}, {1, 0, 0, 1, ", projected"}, {2, 0, 0, 1, ", order 2, projected"}};

typedef struct comparison {
  const basis_option *basis;
  const scheme_option *scheme;
  const transfer_option *transfer;
  int32_t dim, variant;
  char name[96];
} comparison;

static world_desc describe(comparison *c, int64_t cells) {
  static const double spacing[3] = {0.25, 0.3, 0.2}, origin[3] = {-0.7, 0.1, 2.0};
  method how = method_of(c->basis, c->scheme, c->transfer);
  world_desc d = world_default(c->dim, cells, 1.0);
  snprintf(c->name, sizeof c->name, "%d-D %s%s", (int)c->dim, how.name, variants[c->variant].name);
  how.position_order = variants[c->variant].position_order;
  how.staggered = variants[c->variant].staggered;
  how.remedy = variants[c->variant].locking;
  how.projected = variants[c->variant].projected;
  world_use(&d, &how);
  d.law.E = 1e3;
  for (int32_t k = 0; k < c->dim; ++k) d.grid.spacing[k] = spacing[k], d.grid.origin[k] = origin[k];
  d.stepper.gravity[0] = 3.0, d.stepper.gravity[1] = -9.81, d.stepper.gravity[2] = 1.0;
  return d;
}

/* Random places at odd multiples of h / 32 of the whole grid, velocities, domains, deformations and, where
 * they are carried, matrices. On the linear basis each cell has a particle near its centre, with more
 * volume at the faces: no node is light, and the step is that of the book. */
static void scatter_cloud(world *w, mpm_particles *set, const world_desc *d, dice *random, int64_t n) {
  double *x = malloc((size_t)n * 28 * sizeof *x), *v = x + 3 * n, *size = v + 3 * n, *F = size + 3 * n,
         *C = F + 9 * n, *volume = C + 9 * n;
  const int32_t even = d->grid.basis == MPM_LINEAR;
  for (int64_t p = 0; p < n; ++p) {
    int64_t rest = p;
    volume[p] = 1.0;
    for (int32_t k = 0; k < w->dim; ++k) {
      const double h = d->grid.spacing[k], cells = (double)d->grid.cells[k];
      const int64_t cell = rest % (int64_t)cells, last = (int64_t)cells - 1;
      const double at =
          even ? (double)cell + throw_between(random, 0.4, 0.6) : throw_between(random, 0.0, cells);
      if (even) volume[p] *= cell == 0 || cell == last ? 1.5 : 1.0;
      rest /= (int64_t)cells;
      x[k * n + p] = d->grid.origin[k] + h * (floor(at * 16.0) + 0.5) / 16.0;
      v[k * n + p] = throw_between(random, -0.5, 0.5);
      size[k * n + p] = h * throw_between(random, 0.2, 0.9);
      volume[p] *= h * throw_between(random, even ? 0.75 : 0.3, 0.8);
    }
    for (int32_t c = 0; c < 9; ++c) {
      const int32_t inner = c / 3 < w->dim && c % 3 < w->dim;
      F[c * n + p] = (c % 4 == 0) + (inner ? throw_between(random, -0.1, 0.1) : 0.0);
      C[c * n + p] = inner ? throw_between(random, -2.0, 2.0) : 0.0;
    }
  }
  ck_ok(w, mpm_particles_add(set, n, x, v, volume, size, NULL, NULL));
  if (!d->stepper.locking_remedy) put(w, set, "deformation_gradient", 9, F);
  if (carries_matrix(d->stepper.transfer)) put(w, set, "velocity_gradient", 9, C);
  free(x);
}

static void agree(const world *w, const mpm_particles *set, const char *name, const char *field,
                  int32_t components, const double *wanted, double tolerance) {
  const int64_t n = mpm_particles_count(set) * components;
  double *is = fetch(w, set, field, components);
  for (int64_t i = 0; i < n; ++i)
    if (!(fabs(is[i] - wanted[i]) <= tolerance))
      ck_abort_msg("%s: %s[%d] of particle %d is %.17g, wanted %.17g within %g", name, field,
                   (int)(i / mpm_particles_count(set)), (int)(i % mpm_particles_count(set)), is[i], wanted[i],
                   tolerance);
  free(is);
}

static void compare(comparison *c, int64_t cells, int64_t n, int32_t steps) {
  world_desc d = describe(c, cells);
  if (c->transfer->transfer == MPM_APIC_MLS && !fits_mls(c->basis)) return;
  if (variants[c->variant].locking && c->dim == 1) return;
  if (variants[c->variant].projected && c->scheme->scheme != MPM_MUSL) return;
  world w;
  mpm_particles *set = world_open(&w, &d);
  dice random = {(uint64_t)(1000 * c->dim + c->variant)};
  scatter_cloud(&w, set, &d, &random, n);
  const double zero[3] = {0.0, 0.0, 0.0};
  ck_ok(&w, mpm_particles_set_all(set, "acceleration", MPM_F64, c->dim, zero)); /* from now on it is kept */
  reference_cloud cloud = reference_take(&w, set);
  reference r = {d.grid, d.stepper, d.law.E, d.law.nu, 0.0, 0};
  for (int32_t i = 0; i < steps; ++i) {
    const double dt = 1e-3 * (1.0 + 0.3 * (i % 3)); /* it changes: staggered velocities must notice */
    world_step(&w, dt);
    reference_step(&r, &cloud, dt);
    /* light nodes magnify rounding: velocities are of order 1, their gradients of order 10, E is 1e3 */
    agree(&w, set, c->name, "velocity", c->dim, cloud.v, 1e-11);
    agree(&w, set, c->name, "position", c->dim, cloud.x, 1e-13);
    agree(&w, set, c->name, "acceleration", c->dim, cloud.a, 1e-8);
    agree(&w, set, c->name, "deformation_gradient", 9, cloud.F, 1e-12);
    agree(&w, set, c->name, "stress", 6, cloud.stress, 1e-9);
    if (carries_matrix(d.stepper.transfer)) agree(&w, set, c->name, "velocity_gradient", 9, cloud.C, 1e-9);
  }
  reference_drop(&cloud);
  world_close(&w);
}

/* One basis in one dimension: all schemes and transfers, in all variants. */
START_TEST(steps_are_those_of_the_book) {
  comparison c = {.basis = &basis_options[_i % BASES], .dim = 1 + _i / BASES};
  for (int32_t scheme = 0; scheme < SCHEMES; ++scheme)
    for (int32_t transfer = 0; transfer < TRANSFERS; ++transfer)
      for (c.variant = 0; c.variant < VARIANTS; ++c.variant) {
        c.scheme = &scheme_options[scheme];
        c.transfer = &transfer_options[transfer];
        compare(&c, c.dim == 3 ? 4 : 6, c.dim == 1 ? 12 : c.dim == 2 ? 40 : 64, STEPS);
      }
}
END_TEST

/* A bar of a dozen particles through 20 steps. */
START_TEST(a_bar_through_many_steps) {
  comparison c = {.basis = &basis_options[_i], .dim = 1};
  for (int32_t scheme = 0; scheme < SCHEMES; ++scheme)
    for (int32_t transfer = 0; transfer < TRANSFERS; ++transfer) {
      c.scheme = &scheme_options[scheme];
      c.transfer = &transfer_options[transfer];
      compare(&c, 6, 12, 20);
    }
}
END_TEST

/* A velocity gradient that only the set keeps is that of the step: F from the unit tensor is 1 + dt L. */
START_TEST(kept_gradient) {
  static const char *const law[2] = {"neo_hookean", "j2"};
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t l = 0; l < 2; ++l) {
      world_desc d = world_with(&methods[0], dim, 8, 0.25);
      d.stepper.scheme = scheme_options[_i].scheme;
      d.law = (world_law){.model = law[l], .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e9};
      world w;
      mpm_particles *set = world_open(&w, &d);
      const int64_t n = world_fill_cube(&w, set, 0.5, 1.25);
      const double zeros[9] = {0.0}, dt = 1e-3;
      double *v = calloc((size_t)(9 * n), sizeof *v);
      for (int64_t p = 0; p < dim * n; ++p) v[p] = noise_at((uint64_t)p);
      put(&w, set, "velocity", dim, v);
      ck_ok(&w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, zeros));
      world_step(&w, dt);
      double *L = fetch(&w, set, "velocity_gradient", 9), *F = fetch(&w, set, "deformation_gradient", 9);
      ck_assert_double_gt(largest(9 * n, L), 0.1);
      for (int64_t c = 0; c < 9; ++c)
        for (int64_t p = 0; p < n; ++p)
          ck_within(law[l], dt * L[c * n + p], F[c * n + p] - (c % 4 == 0 ? 1.0 : 0.0), 1e-14);
      free(v), free(L), free(F);
      world_close(&w);
    }
}
END_TEST

/* Steps in parts of MPM_APIC_MLS have more values for each node than whole ones. In turn both leave nodes
 * that no stencil meets at 0: the nodes have the mass of the particles and no more. */
START_TEST(steps_in_turn) {
  world_desc d = world_with(&methods[8], 2, 40, 0.25);
  ck_assert_int_eq(methods[8].transfer, MPM_APIC_MLS);
  world w;
  mpm_particles *set = world_open(&w, &d);
  world_fill_cube(&w, set, 4.0, 5.0);
  const double v[2] = {30.0, 20.0}, mass = mass_of(&w, set);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  for (int32_t i = 0; i < 24; ++i) {
    if (i % 4 < 2)
      world_staged_step(&w, 2e-3);
    else
      world_step(&w, 2e-3);
    int64_t n;
    double *nodal = fetch_nodes(&w, "mass", &n);
    ck_within("mass", sum_of(n, nodal), mass, 1e-12 * mass);
    ck_assert_int_eq(n, w.info.active_nodes);
    free(nodal);
  }
  world_close(&w);
}
END_TEST

Suite *schemes_suite(void) {
  Suite *suite = suite_create("schemes");
  TCase *tc = tcase_create("reference");
  tcase_set_timeout(tc, 120.0);
  tcase_add_loop_test(tc, steps_are_those_of_the_book, 0, 3 * BASES);
  tcase_add_loop_test(tc, a_bar_through_many_steps, 0, BASES);
  tcase_add_loop_test(tc, kept_gradient, 0, SCHEMES);
  tcase_add_test(tc, steps_in_turn);
  suite_add_tcase(suite, tc);
  suite_add_tcase(suite, schemes_options_case());
  suite_add_tcase(suite, schemes_flight_case());
  suite_add_tcase(suite, schemes_lattices_case());
  return suite;
}
