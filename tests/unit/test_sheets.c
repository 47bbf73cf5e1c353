/* Sheets in plane stress: what stretches them along the plane, and thins them. */
#include "geometry.h"
#include "reference.h"
#include "surfaces.h"

static const double stiff = 1e6, poisson = 0.3;

static world_desc sheets(const method *how, const char *model) {
  static reference_law host_law;
  world_desc d = world_with(how, 2, CELLS, spacing);
  host_law = (reference_law){stiff, poisson, sqrt(2.0 * stiff / 1e3)};
  d.grid.geometry = MPM_PLANE_STRESS;
  d.law = (world_law){.model = model,
                      .E = stiff,
                      .nu = poisson,
                      .density = 1e3,
                      .yield_stress = 1e4,
                      .hardening = 1e5,
                      .stress = reference_law_stress,
                      .user = &host_law};
  return d;
}

/* ---- the thickness ------------------------------------------------------------------------------------- */
/* Exact values, by Newton's method on ln F33 to 1e-12. */
START_TEST(neo_hookean_table) {
  static const struct {
    double F[4], F33, stress[3]; /* xx, yy, xy */
  } known[] = {{{1.3, 0.0, 0.0, 1.0}, 0.886870147091, {301392.775442, 71210.248153, 0.0}},
               {{1.5, 0.0, 0.0, 0.81649658092772603}, 0.912671730904, {487579.641736, -57222.465241, 0.0}},
               {{1.0, 0.4, 0.0, 1.0}, 1.0, {61538.461538, 0.0, 153846.153846}},
               {{0.7, 0.0, 0.0, 1.1}, 1.110953915343, {-334611.146611, -10889.023961, 0.0}}};
  world w;
  const world_desc desc = sheets(&methods[0], "neo_hookean");
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {1.0, 1.0}, high[] = {1.25, 1.25};
  const int64_t n = world_fill(&w, set, low, high, 2);
  for (int32_t k = 0; k < 4; ++k) {
    double *F = calloc((size_t)(9 * n), sizeof *F);
    for (int64_t p = 0; p < n; ++p) {
      for (int32_t e = 0; e < 4; ++e) F[(3 * (e / 2) + e % 2) * n + p] = known[k].F[e];
      F[8 * n + p] = 1.0;
    }
    put(&w, set, "deformation_gradient", 9, F);
    free(F);
    double *stress = fetch(&w, set, "stress", 6), *found = fetch(&w, set, "deformation_gradient", 9),
           *volume = fetch(&w, set, "volume", 1);
    const double plane = known[k].F[0] * known[k].F[3], initial = 0.125 * 0.125;
    for (int64_t p = 0; p < n; ++p) {
      ck_within("F33", found[8 * n + p], known[k].F33, 1e-11);
      ck_within("xx", stress[p], known[k].stress[0], 1e-10 * stiff);
      ck_within("yy", stress[n + p], known[k].stress[1], 1e-10 * stiff);
      ck_within("xy", stress[3 * n + p], known[k].stress[2], 1e-10 * stiff);
      ck_within("zz", stress[2 * n + p], 0.0, 1e-11 * stiff);
      ck_within("volume", volume[p], plane * found[8 * n + p] * initial, 1e-15);
    }
    free(stress);
    free(found);
    free(volume);
  }
  world_close(&w);
}
END_TEST

static const double *velocity_of; /* xx xy yx yy of the gradient */

static void by_gradient(const double *x, double *v) {
  v[0] = velocity_of[0] * (x[0] - 1.5) + velocity_of[1] * (x[1] - 1.5);
  v[1] = velocity_of[2] * (x[0] - 1.5) + velocity_of[3] * (x[1] - 1.5);
}

static const char *const solids[] = {
    "neo_hookean", "neo_hookean_decoupled", "linear_elastic", "j2", "drucker_prager", "mohr_coulomb", NULL};
enum { SOLIDS = sizeof solids / sizeof *solids };

/* Describes sheets of a law that yields, if it can, at some 1e4. */
static world_desc solid(const method *how, const char *model) {
  static const mpm_param soil[] = {
      {"E", 1e6}, {"nu", 0.3}, {"density", 1e3}, {"phi", 30.0}, {"cohesion", 1e4}};
  world_desc desc = sheets(how, model);
  if (model && (!strcmp(model, "drucker_prager") || !strcmp(model, "mohr_coulomb"))) {
    desc.law.params = soil;
    desc.law.param_count = 5;
  }
  return desc;
}

static void open_solid(world *w, const method *how, const char *model) {
  const world_desc desc = solid(how, model);
  open_block_with(w, &desc);
}

/* Of every law the stress across the plane vanishes, step by step, along a path that yields and turns
 * back. */
START_TEST(no_stress_across) {
  static const double path[3][4] = {{1.0, 0.3, 0.0, -0.2}, {0.2, -0.8, 0.4, 0.5}, {-1.0, 0.0, 0.2, -0.4}};
  const char *model = solids[_i];
  world w;
  open_solid(&w, &methods[0], model);
  mpm_particles *set = w.set[0];
  const int64_t n = mpm_particles_count(set);
  double thinnest = 1.0;
  for (int32_t k = 0; k < 12; ++k) {
    velocity_of = path[k / 4];
    step_with(&w, 5e-3, by_gradient);
    double *stress = fetch(&w, set, "stress", 6), *F = fetch(&w, set, "deformation_gradient", 9);
    const double scale = largest(6 * n, stress);
    ck_holds(scale > 1e2);
    for (int64_t p = 0; p < n; ++p) {
      ck_within(model ? model : "host", stress[2 * n + p], 0.0, 1e-11 * stiff);
      thinnest = fmin(thinnest, F[8 * n + p]);
    }
    free(stress);
    free(F);
  }
  ck_between("F33", thinnest, 0.9, 0.9999);
  world_close(&w);
}
END_TEST

/* A sheet that cannot move along y is as stiff as E / (1 - nu^2), and yields in uniaxial tension at the yield
 * stress itself. */
START_TEST(stiffness_and_yield) {
  static const double wide[4] = {1e-3, 0.0, 0.0, 0.0};
  world w;
  open_solid(&w, &methods[0], "linear_elastic");
  mpm_particles *set = w.set[0];
  const int64_t n = mpm_particles_count(set);
  velocity_of = wide;
  step_with(&w, 1e-3, by_gradient); /* a strain of 1e-6 */
  double *stress = fetch(&w, set, "stress", 6), *x = fetch(&w, set, "position", 2);
  for (int64_t p = 0; p < n; ++p)
    if (fabs(x[p] - 1.5) < 0.3 && fabs(x[n + p] - 1.5) < 0.3)
      ck_within("stiffness", stress[p], 1e-6 * stiff / (1.0 - poisson * poisson), 1e-5);
  free(stress);
  free(x);
  world_close(&w);
  /* by steps whose sidewards strain leaves no stress along y */
  open_solid(&w, &methods[0], "j2");
  set = w.set[0];
  const double plastic[4] = {1.0, 0.0, 0.0, -0.3};
  velocity_of = plastic;
  for (int32_t k = 0; k < 9; ++k) step_with(&w, 1e-3, by_gradient);
  stress = fetch(&w, set, "stress", 6);
  double *state = fetch(&w, set, "state", 1);
  x = fetch(&w, set, "position", 2);
  for (int64_t p = 0; p < n; ++p) {
    if (fabs(x[p] - 1.5) > 0.3 || fabs(x[n + p] - 1.5) > 0.3) continue;
    ck_holds(!(state[p] > 0.0));
    ck_within("elastic", stress[p], 9e-3 * stiff, 0.02 * 9e-3 * stiff);
  }
  free(state);
  step_with(&w, 2e-3, by_gradient);
  state = fetch(&w, set, "state", 1);
  for (int64_t p = 0; p < n; ++p)
    if (fabs(x[p] - 1.5) < 0.3 && fabs(x[n + p] - 1.5) < 0.3) ck_holds(state[p] > 0.0);
  free(stress);
  free(state);
  free(x);
  world_close(&w);
}
END_TEST

/* ---- what hosts do ------------------------------------------------------------------------------------- */
/* A linear law that says of itself what it is told to. */
typedef struct frank_law {
  double wave_speed;
  int32_t boasts; /* of a viscosity and an energy, while F33 is that of the start */
} frank_law;

static mpm_status frank_stress(void *user, const mpm_material_batch *b) {
  const frank_law *of = user;
  for (int64_t p = 0; p < b->n; ++p) {
    const int64_t across = 8 * b->ld + p;
    double trace = 0.0, e[3];
    ck_holds(fabs(b->F_inc[across] - 1.0 - b->dt * b->L[across]) < 1e-14); /* both are of this trial */
    if (b->t <= b->dt) ck_holds(fabs(b->F_inc[across] - b->F[across]) < 1e-14);
    for (int32_t k = 0; k < 3; ++k) trace += e[k] = b->F[4 * k * b->ld + p] - 1.0;
    for (int32_t c = 0; c < 6; ++c)
      b->stress_new[c * b->ld + p] = c < 3 ? 4e5 * trace + 8e5 * e[c] : 4e5 * b->F[b->ld + p];
    b->wave_speed[p] = of->wave_speed;
    if (of->boasts && fabs(e[2]) <= 0.0) b->kinematic_viscosity[p] = 1e3, b->energy[p] = 1e12;
  }
  return MPM_OK;
}

/* The wave speed of a law may be anything; and of what it says only the last answer counts. */
START_TEST(frank_laws) {
  static const double speeds[] = {0.0, 1.0, 35.0, 1000.0};
  static const double path[4] = {0.5, 0.0, 0.0, 0.1};
  frank_law law = {speeds[_i % 4], _i / 4};
  world w;
  world_desc desc = sheets(&methods[0], NULL);
  desc.law.stress = frank_stress;
  desc.law.user = &law;
  open_block_with(&w, &desc);
  velocity_of = path;
  const mpm_step_info first = step_with(&w, 1e-3, by_gradient);
  ck_holds(!(first.strain_energy > 1e6));
  if (law.wave_speed > 0.0) ck_holds(world_stable_dt(&w) > 1e-4);
  for (int32_t k = 0; k < 4; ++k) step_with(&w, 1e-3, by_gradient);
  const int64_t n = mpm_particles_count(w.set[0]);
  double *stress = fetch(&w, w.set[0], "stress", 6);
  for (int64_t p = 0; p < n; ++p) ck_within("across", stress[2 * n + p], 0.0, 1e-11 * 1e6);
  free(stress);
  world_close(&w);
}
END_TEST

/* F of the host may be far from what F33 becomes, but not turned inside out; what begins anew stays as
 * thin. */
START_TEST(thickness_of_hosts) {
  world w;
  world_desc desc = sheets(&methods[0], "neo_hookean");
  mpm_particles *set = world_open(&w, &desc);
  const double x[2] = {1.1, 1.1}, volume = 0.01;
  const double wide[9] = {4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 1.0},
               turned[9] = {-1.2, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0};
  ck_ok(&w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
  put(&w, set, "deformation_gradient", 9, wide);
  double *stress = fetch(&w, set, "stress", 6), *F = fetch(&w, set, "deformation_gradient", 9);
  ck_within("F33", F[8], 0.1206, 1e-4);
  ck_within("across", stress[2], 0.0, 1e-11 * stiff);
  free(F);
  put(&w, set, "deformation_gradient", 9, turned);
  ck_refused(&w, mpm_particles_get(set, "stress", MPM_F64, 6, 1, NULL, stress), MPM_E_ARG,
             "has no thickness");
  free(stress);
  world_close(&w);
  static const double path[4] = {1.0, 0.0, 0.0, 1.0};
  open_solid(&w, &methods[0], "j2");
  velocity_of = path;
  for (int32_t k = 0; k < 10; ++k) step_with(&w, 5e-3, by_gradient);
  const int64_t n = mpm_particles_count(w.set[0]);
  F = fetch(&w, w.set[0], "deformation_gradient", 9);
  double *before = fetch(&w, w.set[0], "volume", 1);
  ck_ok(&w, mpm_particles_reset_reference(w.set[0]));
  double *after = fetch(&w, w.set[0], "deformation_gradient", 9),
         *initial = fetch(&w, w.set[0], "initial_volume", 1);
  for (int64_t p = 0; p < n; ++p) {
    ck_within("as thin", after[8 * n + p], F[8 * n + p], 0.0);
    ck_within("of unit thickness", initial[p] * F[8 * n + p], before[p], 1e-15);
  }
  free(F);
  free(before);
  free(after);
  free(initial);
  world_close(&w);
}
END_TEST

/* ---- every combination, implicit steps ---------------------------------------------------------------- */
static combination *list;
static int32_t listed;

START_TEST(combination_works) {
  check_geometry(&list[_i], MPM_PLANE_STRESS, 0);
}
END_TEST

/* A sheet is drawn by a dead load, the yielding ones beyond their limit: Newton's iteration has the tangent
 * of its forces. */
START_TEST(tangents_of_sheets) {
  const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  const char *model = solids[_i];
  world w;
  world_desc desc = solid(&how, model);
  desc.stepper.quasi_static = 1;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 1.0}, high[] = {1.0, 2.0};
  const int64_t n = world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  mpm_surface_desc d = load_desc();
  d.dead_traction[0] = _i == 3 ? 1.1e4 : _i < 3 ? 1e5 : 1e4;
  mpm_surface *s = put_surface(&w, &d);
  for (int32_t k = 0; k < 8; ++k) {
    const double at[] = {1.0, 1.0625 + 0.125 * k}, area[] = {0.125, 0.0};
    ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
  }
  const mpm_step_info info = world_step(&w, 1.0);
  show("%s: %d iterations\n", model ? model : "host", (int)info.newton_iterations);
  ck_assert_int_le(info.newton_iterations, 8);
  double *stress = fetch(&w, set, "stress", 6);
  for (int64_t p = 0; p < n; ++p) ck_within("across", stress[2 * n + p], 0.0, 1e-11 * stiff);
  free(stress);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* ---- refusals ------------------------------------------------------------------------------------------ */
START_TEST(refusals) {
  static const char *const fluids[] = {"newtonian_fluid", "herschel_bulkley", "mu_i", "snow", "cam_clay"};
  mpm_context *c = context_with(1, 0, NULL);
  mpm_grid *grid;
  mpm_stepper *s;
  mpm_grid_desc d = grid_desc(3, 8, 0.25);
  d.geometry = MPM_PLANE_STRESS;
  ck_refused(c, mpm_grid_create(c, &d, &grid), MPM_E_UNSUPPORTED, "MPM_PLANE_STRESS is for dim 2");
  d.dim = 2;
  ck_ok(c, mpm_grid_create(c, &d, &grid));
  mpm_stepper_desc of = stepper_desc();
  of.locking_remedy = 1;
  ck_refused(c, mpm_stepper_create(c, grid, &of, &s), MPM_E_UNSUPPORTED, "sheets do not lock");
  for (int32_t i = 0; i < 5; ++i) {
    const world_law law = {.model = fluids[i], .E = 1e6, .nu = 0.3, .density = 1e3, .yield_stress = 1e4};
    mpm_material *material;
    mpm_particles *set;
    ck_ok(c, law_create(c, &law, &material));
    ck_refused(c, mpm_particles_create(c, grid, material, &set), MPM_E_UNSUPPORTED, "is no solid sheet");
    ck_ok(c, mpm_material_destroy(material));
  }
  ck_ok(c, mpm_grid_destroy(grid));
  ck_ok(c, mpm_context_destroy(c));
}
END_TEST

Suite *sheets_suite(void);
Suite *sheets_suite(void) {
  Suite *suite = suite_create("sheets");
  TCase *parts = tcase_create("parts");
  if (!list) list = list_combinations(&listed);
  tcase_add_test(parts, neo_hookean_table);
  tcase_add_loop_test(parts, no_stress_across, 0, SOLIDS);
  tcase_add_test(parts, stiffness_and_yield);
  tcase_add_loop_test(parts, tangents_of_sheets, 0, SOLIDS);
  tcase_add_loop_test(parts, frank_laws, 0, 8);
  tcase_add_test(parts, thickness_of_hosts);
  tcase_add_test(parts, refusals);
  suite_add_tcase(suite, parts);
  TCase *all = tcase_create("combinations");
  tcase_add_loop_test(all, combination_works, 0, listed);
  tcase_set_timeout(all, 60);
  suite_add_tcase(suite, all);
  return suite;
}
