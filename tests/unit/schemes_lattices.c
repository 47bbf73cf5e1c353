/* Fills put particles where they reach just to nodes: rounding, which instruction sets and origins change,
 * decides nothing. */
#include "schemes.h"

typedef struct lattice {
  const char *name;
  int32_t basis;
  int32_t per_cell; /* and axis */
} lattice;
static const lattice lattices[] = {
    {"GIMP", MPM_GIMP, 2},          {"GIMP", MPM_GIMP, 1},          {"uGIMP", MPM_UGIMP, 2},
    {"cpGIMP", MPM_CPGIMP, 2},      {"quadratic", MPM_BSPLINE2, 1}, {"quadratic", MPM_BSPLINE2, 3},
    {"quadratic", MPM_BSPLINE2, 2}, {"cubic", MPM_BSPLINE3, 1},     {"cubic", MPM_BSPLINE3, 2}};
enum { LATTICES = sizeof lattices / sizeof *lattices };
static const double origins[] = {0.0, 0.7, -1.0 / 3.0, 2.3};
enum { ORIGINS = sizeof origins / sizeof *origins };

/* Fills what, of two cantilevers that reach towards each other and bend, with the strain energy and the
 * largest component of stress. One ends where the last node is above its particles, the other where it is
 * below. */
static void bend(const lattice *on, int32_t scheme, int32_t lagrangian, int32_t isa, double origin,
                 double what[2]) {
  world w;
  world_desc d = world_default(2, 24, 0.1);
  d.context.isa = isa;
  d.grid.basis = on->basis;
  d.grid.total_lagrangian = lagrangian;
  for (int32_t k = 0; k < 2; ++k) d.grid.origin[k] = origin;
  d.stepper.scheme = scheme;
  d.stepper.gravity[1] = -5.0;
  mpm_particles *set = world_open(&w, &d);
  for (int32_t i = 0; i < 2; ++i) {
    const double low[2] = {origin + 1.4 * i, origin + 1.0}, high[2] = {origin + 1.0 + 1.4 * i, origin + 1.4};
    world_fill(&w, set, low, high, on->per_cell);
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, i ? MPM_X_MAX : MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  }
  const int64_t n = mpm_particles_count(set);
  for (int32_t i = 0; i < 60; ++i) world_step(&w, 1e-3);
  double *stress = fetch(&w, set, "stress", 6);
  what[0] = w.info.strain_energy;
  what[1] = 0.0;
  for (int64_t i = 0; i < 6 * n; ++i) what[1] = fmax(what[1], fabs(stress[i]));
  free(stress);
  world_close(&w);
}

START_TEST(rounding_decides_nothing) {
  const lattice *on = &lattices[_i % LATTICES];
  const int32_t scheme = scheme_options[_i / LATTICES % SCHEMES].scheme, lagrangian = _i / LATTICES / SCHEMES;
  char name[80];
  double first[2];
  bend(on, scheme, lagrangian, MPM_ISA_BASELINE, 0.0, first);
  ck_assert_double_gt(first[0], 0.0);
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa)
    for (int32_t o = 0; o < ORIGINS && has_isa(isa); ++o) {
      double what[2];
      snprintf(name, sizeof name, "%s, %d a cell, scheme %d%s, isa %d, origin %g", on->name,
               (int)on->per_cell, (int)scheme, lagrangian ? ", total Lagrangian" : "", (int)isa, origins[o]);
      bend(on, scheme, lagrangian, isa, origins[o], what);
      for (int32_t k = 0; k < 2; ++k) ck_within(name, what[k], first[k], 1e-9 * first[k]);
    }
}
END_TEST

TCase *schemes_lattices_case(void) {
  TCase *tc = tcase_create("lattices");
  tcase_set_timeout(tc, 30.0);
  tcase_add_loop_test(tc, rounding_decides_nothing, 0, 2 * SCHEMES * LATTICES);
  return tc;
}
