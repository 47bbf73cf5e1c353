/* What conducts and heats by how much: material that is deformed, on a total Lagrangian grid, and sources. */
#include "heat.h"

/* ---- deformed material --------------------------------------------------------------------------------- */
/* F, of determinant 1, and A = F^-1 F^-T. */
static const double sheared[9] = {1.25, 0.4, 0.0, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0};
static const double metric[3][3] = {{0.8, -0.5, 0.0}, {-0.5, 1.5625, 0.0}, {0.0, 0.0, 1.0}};

enum { WAVE_CELLS = 32, DEEP_CELLS = 4, WAVE_STEPS = 10 };

/* Opens material that fills a periodic grid, at rest under a uniform stress, of unit diffusivity. */
static mpm_particles *open_sheared(world *w, int32_t dim, const basis_option *basis) {
  world_desc desc = world_default(dim, WAVE_CELLS, 1.0 / WAVE_CELLS);
  use_basis(basis, &desc.grid);
  desc.grid.total_lagrangian = 1;
  for (int32_t k = 0; k < dim; ++k) desc.grid.periodic[k] = 1;
  desc.grid.cells[2] = dim > 2 ? DEEP_CELLS : desc.grid.cells[2];
  desc.law.E = 1e-6;
  desc.law.density = 2.0;
  mpm_particles *set = world_open(w, &desc);
  const double low[3] = {0.0, 0.0, 0.0}, high[3] = {1.0, 1.0, (double)DEEP_CELLS / WAVE_CELLS};
  world_fill(w, set, low, high, 2);
  ck_ok(w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, sheared));
  const mpm_heat_desc heat = heat_desc(3.0, 6.0);
  ck_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
  return set;
}

/* Returns a wave along the first two axes, the second with this sign, at each particle; to be freed. */
static double *wave_along(const world *w, mpm_particles *set, double sign) {
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(w, set, "reference_position", w->dim), *wave = malloc((size_t)n * sizeof *wave);
  for (int64_t p = 0; p < n; ++p) wave[p] = cos(2.0 * PI * (x[p] + sign * x[n + p]));
  free(x);
  return wave;
}

/* Waves of the reference positions decay by k . A k, and explicit steps are as long as sum |A_ij| / h^2 lets
 * them. */
START_TEST(waves_in_sheared_material) {
  const basis_option *basis = &basis_options[_i / 4 % BASES];
  const int32_t dim = 2 + _i % 2, implicit = _i / 2 % 2;
  if (basis->boundary != MPM_BOUNDARY_GHOST || is_gimp(basis->basis))
    return; /* not on periodic axes; sizes */
  for (double sign = -1.0; sign < 2.0; sign += 2.0) {
    world w;
    double absolute = 0.0, now = 0.0, all = 0.0;
    mpm_particles *set = open_sheared(&w, dim, basis);
    const int64_t n = mpm_particles_count(set);
    double *wave = wave_along(&w, set, sign);
    put(&w, set, "temperature", 1, wave);
    for (int32_t e = 0; e < 9; ++e)
      if (e / 3 < dim && e % 3 < dim) absolute += fabs(metric[e / 3][e % 3]);
    const double dt = 0.5 / (absolute * WAVE_CELLS * WAVE_CELLS),
                 rate = 4.0 * PI * PI * (metric[0][0] + metric[1][1] + 2.0 * sign * metric[0][1]);
    ck_within(basis->name, world_stable_dt(&w), dt, 1e-9 * dt);
    if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-10));
    for (int32_t i = 0; i < WAVE_STEPS; ++i) world_step(&w, dt);
    double *T = fetch(&w, set, "temperature", 1);
    for (int64_t p = 0; p < n; ++p) now += T[p] * wave[p], all += wave[p] * wave[p];
    const double kept = pow(now / all, 1.0 / WAVE_STEPS);
    const double found = (implicit ? 1.0 / kept - 1.0 : 1.0 - kept) / dt;
    show("%s %d-D, sign %g: %.4f of the rate\n", basis->name, dim, sign, found / rate);
    ck_within(basis->name, found, rate, 0.06 * rate); /* nodes smooth: the more, the wider the basis */
    free(wave), free(T);
    world_close(&w);
  }
}
END_TEST

/* ---- sources ------------------------------------------------------------------------------------------- */
static mpm_status warm_all(void *user, const mpm_particle_batch *b, double *power) {
  for (int64_t i = 0; i < b->n; ++i) power[i] = *(const double *)user;
  return 0;
}

/* A power per volume that is the same everywhere heats everything by power dt / (density specific heat). */
START_TEST(source_heats) {
  const int32_t dim = 1 + _i % 3;
  world w;
  world_desc desc = world_default(dim, 5, 0.25);
  double power = 70.0;
  desc.law.E = 1e-6;
  desc.law.density = 2.0;
  mpm_particles *set = world_open(&w, &desc);
  const double low[3] = {0.3, 0.3, 0.3}, high[3] = {0.9, 0.9, 0.9};
  world_fill(&w, set, low, high, 2);
  mpm_heat_desc heat = heat_desc(3.0, 6.0);
  heat.source = warm_all, heat.user = &power;
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  if (_i / 3) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-12));
  const double dt = 1e-3;
  for (int32_t i = 0; i < 2; ++i) world_step(&w, dt);
  const int64_t n = mpm_particles_count(set);
  double *T = fetch(&w, set, "temperature", 1), worst = 0.0;
  for (int64_t p = 0; p < n; ++p) worst = fmax(worst, fabs(T[p] - 2.0 * dt * power / 6.0));
  ck_within("rise", worst, 0.0, 1e-12);
  free(T);
  world_close(&w);
}
END_TEST

void add_heat_exact(Suite *suite) {
  TCase *exact = tcase_create("exact");
  tcase_add_loop_test(exact, waves_in_sheared_material, 0, 4 * BASES);
  tcase_add_loop_test(exact, source_heats, 0, 6);
  tcase_set_timeout(exact, 120);
  suite_add_tcase(suite, exact);
}
