/* What laws see of temperature, and what heat they give: expansion, free and held, and the work that becomes
 * heat. */
#include "heat.h"

static const double E = 200e9, nu = 0.3, expansion = 1.2e-5;

static mpm_heat_desc expanding(double reference) {
  mpm_heat_desc desc = heat_desc(450.0, 0.0);
  desc.expansion = expansion;
  desc.reference_temperature = reference;
  return desc;
}

static world_desc steel(const method *how, int32_t dim, int32_t geometry, const char *model) {
  world_desc desc = world_with(how, dim, 8, 0.25);
  desc.grid.geometry = geometry;
  desc.law = (world_law){.model = model, .E = E, .nu = nu, .density = 7800.0, .yield_stress = 1e12};
  return desc;
}

/* ---- expansion ----------------------------------------------------------------------------------------- */
/* Where stress follows from F, material that has stretched by exp(a (T - T0)) has none. */
START_TEST(free_expansion) {
  const char *const models[] = {"neo_hookean", "neo_hookean_decoupled", "newtonian_fluid"};
  const char *model = models[_i % 3];
  const int32_t dim = 2 + _i / 3 % 2, rings = _i / 6;
  if (rings && dim == 3) return;
  world w;
  const world_desc desc = steel(broad_methods[0], dim, rings ? MPM_AXISYMMETRIC : MPM_PLANE_STRAIN, model);
  mpm_particles *set = world_open(&w, &desc);
  world_fill_cube(&w, set, 0.75, 1.25);
  const mpm_heat_desc heat = expanding(300.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  const double T = 800.0, f = exp(expansion * 500.0), F[] = {f, 0, 0, 0, f, 0, 0, 0, f};
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &T));
  ck_ok(&w, mpm_particles_set_all(set, "stress_temperature", MPM_F64, 1, &T));
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  const int64_t n = mpm_particles_count(set);
  double *stress = fetch(&w, set, "stress", 6);
  ck_within(model, largest(6 * n, stress), 0.0, 1e-14 * E);
  free(stress);
  world_step(&w, 1e-9);
  stress = fetch(&w, set, "stress", 6);
  ck_within(model, largest(6 * n, stress), 0.0, 1e-14 * E);
  ck_within(model, world_info(&w).strain_energy, 0.0, 1e-10);
  free(stress);
  world_close(&w);
}
END_TEST

/* Returns the stress of neo-Hookean steel that is held in place and 100 K warmer. */
static double neo_hookean_held(void) {
  const double f = exp(-100.0 * expansion), J = f * f * f, mu = 0.5 * E / (1.0 + nu),
               lambda = E * nu / (1.0 + nu) / (1.0 - 2.0 * nu);
  return (mu * (f * f - 1.0) + lambda * log(J)) / J;
}

/* The stress that follows from F follows the temperature that belongs to it, whoever writes that. */
START_TEST(stress_follows_its_temperature) {
  world w;
  const world_desc desc = steel(broad_methods[0], 2, MPM_PLANE_STRAIN, "neo_hookean");
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.75, 1.25);
  const mpm_heat_desc heat = expanding(20.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  const double before = world_info(&w).strain_energy, T = 120.0;
  double *stress = fetch(&w, set, "stress", 6);
  ck_within("cold", largest(6 * n, stress), 0.0, 1e-14 * E);
  free(stress);
  if (_i) {
    mpm_view view = {.struct_size = sizeof view};
    ck_ok(&w, mpm_particles_map(set, "stress_temperature", MPM_READ | MPM_WRITE, &view));
    for (int64_t p = 0; p < view.count; ++p) ((double *)view.data)[p] = T;
    ck_ok(&w, mpm_view_release(&view));
  } else {
    ck_ok(&w, mpm_particles_set_all(set, "stress_temperature", MPM_F64, 1, &T));
  }
  stress = fetch(&w, set, "stress", 6);
  for (int64_t p = 0; p < 3 * n; ++p) ck_within("warm", stress[p], neo_hookean_held(), 1e-9 * 600e6);
  ck_holds(world_info(&w).strain_energy > before);
  free(stress);
  world_close(&w);
}
END_TEST

/* Held in place it has the pressure 3 K a (T - T0), -600 MPa of steel by 100 K: in every dimension and
 * scheme, by steps of the temperature that the host sets. Of neo-Hookean material the law at F / exp says
 * how much. */
START_TEST(held_expansion) {
  const char *const models[] = {"linear_elastic", "j2", "neo_hookean"};
  const char *model = models[_i % 3];
  const int32_t dim = 1 + _i / 3 % 3, scheme = _i / 9 % 4, rings = _i / 36;
  if (rings && dim != 2) return;
  world w;
  world_desc desc = steel(broad_methods[0], dim, rings ? MPM_AXISYMMETRIC : MPM_PLANE_STRAIN, model);
  desc.stepper.scheme = scheme < 3 ? scheme_options[scheme].scheme : MPM_NEWMARK;
  desc.stepper.flip = 1.0;
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.75, 1.25);
  const mpm_heat_desc heat = expanding(20.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  for (int32_t i = 1; i <= 100; ++i) {
    const double T = 20.0 + i;
    ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &T));
    world_step(&w, 1e-11);
  }
  double *stress = fetch(&w, set, "stress", 6);
  const double wanted = _i % 3 == 2 ? neo_hookean_held() : -600e6;
  for (int64_t p = 0; p < 3 * n; ++p)
    ck_within(model, stress[p], wanted, (_i % 3 == 2 ? 1e-9 : 1e-5) * 600e6);
  ck_within(model, largest(3 * n, stress + 3 * n), 0.0, 1e-9 * 600e6);
  free(stress);
  world_close(&w);
}
END_TEST

/* A bar between two walls, free at its sides, has -E a dT = -240 MPa: a quasi-static step finds that. */
START_TEST(bar_between_walls) {
  const char *const models[] = {"linear_elastic", "neo_hookean"};
  world w;
  world_desc desc = steel(broad_methods[0], 3, MPM_PLANE_STRAIN, models[_i]);
  desc.stepper.scheme = MPM_NEWMARK;
  desc.stepper.quasi_static = 1;
  desc.stepper.flip = 1.0;
  desc.grid.cells[0] = 4;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 0.75, 0.75}, high[] = {1.0, 1.25, 1.25};
  const int64_t n = world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0));
  const mpm_heat_desc heat = expanding(0.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  const double T = 100.0;
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &T));
  ck_ok(&w, mpm_step(w.stepper, 1.0, &w.info));
  double *stress = fetch(&w, set, "stress", 6);
  for (int64_t p = 0; p < n; ++p) {
    ck_within(models[_i], stress[p], -240e6, 2e-3 * 240e6);
    ck_within(models[_i], stress[n + p], 0.0, 1e-3 * 240e6);
  }
  ck_holds(w.info.newton_iterations <= 6);
  free(stress);
  world_close(&w);
}
END_TEST

/* ---- dissipation --------------------------------------------------------------------------------------- */
/* Opens a block whose velocities stretch and shear it. */
static mpm_particles *open_sheared(world *w, const method *how, int32_t dim, const world_law *law,
                                   double rate) {
  world_desc desc = world_with(how, dim, 10, 0.25);
  desc.law = *law;
  mpm_particles *set = world_open(w, &desc);
  const int64_t n = world_fill_cube(w, set, 0.75, 1.75);
  mpm_heat_desc heat = heat_desc(2.0, 0.0);
  heat.dissipated_share = 1.0;
  ck_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
  double *x = fetch(w, set, "position", dim), *v = calloc((size_t)(dim * n), sizeof *v);
  for (int64_t p = 0; p < n; ++p)
    for (int32_t k = 0; k < dim; ++k)
      v[k * n + p] =
          rate * ((k ? -0.5 : 1.0) * (x[k * n + p] - 1.25) + 0.3 * (x[(k + 1) % dim * n + p] - 1.25));
  put(w, set, "velocity", dim, v);
  free(x), free(v);
  return set;
}

/* Without hardening a particle gets its yield stress times the plastic strain. */
START_TEST(plastic_work_is_heat) {
  const method *how = broad_methods[_i % BROAD];
  const int32_t dim = 1 + _i / BROAD;
  if (dim == 1 && how->remedy) return;
  const double yield = 50.0;
  const world_law law = {.model = "j2", .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = yield};
  world w;
  mpm_particles *set = open_sheared(&w, how, dim, &law, 1.0);
  const double dt = 0.05 * world_stable_dt(&w);
  for (int32_t i = 0; i < 40; ++i) world_step(&w, dt);
  const int64_t n = mpm_particles_count(set);
  double *T = fetch(&w, set, "temperature", 1), *m = fetch(&w, set, "mass", 1),
         *V = fetch(&w, set, "volume", 1), *state = fetch(&w, set, "state", 1), heat = 0.0, work = 0.0;
  for (int64_t p = 0; p < n; ++p) heat += 2.0 * m[p] * T[p], work += yield * state[p] * V[p];
  show("%s %d-D: heat %.6g of %.6g\n", how->name, dim, heat, work);
  ck_holds(work > 0.0);
  ck_within(how->name, heat, work, 0.03 * work);
  const mpm_heat_info info = heat_told(&w);
  ck_within(how->name, info.dissipated_total, heat, 1e-12 * heat);
  ck_within(how->name, heat_missing(&info), 0.0, 1e-13 * heat);
  free(T), free(m), free(V), free(state);
  world_close(&w);
}
END_TEST

static void put_pressure(const world *w, mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  double *stress = calloc((size_t)(6 * n), sizeof *stress);
  for (int64_t p = 0; p < 3 * n; ++p) stress[p] = -1e3;
  put(w, set, "stress", 6, stress);
  free(stress);
}

/* Elastic material gives its work back, and viscous material does not. */
START_TEST(elastic_work_is_not) {
  const law_option *option = &law_options[_i];
  world_law law = {
      .model = option->model, .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e6, .hardening = 1e4};
  const mpm_param stiff[] = {{"density", 1e3},
                             {"shear_modulus", 4e4},
                             {"bulk_modulus", 8e4},
                             {"yield_shear", 1e6},
                             {"consistency", 1.0}};
  if (!option->model || !strcmp(option->model, "rigid")) return;
  if (!strcmp(option->model, "herschel_bulkley")) law.params = stiff, law.param_count = 5;
  if (!strcmp(option->model, "cam_clay")) law.yield_stress = 1e3;
  const int32_t flows = !strcmp(option->model, "mu_i") || !strcmp(option->model, "newtonian_fluid") ||
                        !strcmp(option->model, "snow") || !strcmp(option->model, "cam_clay");
  world w;
  mpm_particles *set = open_sheared(&w, broad_methods[0], 2, &law, 0.2);
  if (!strcmp(option->model, "cam_clay")) put_pressure(&w, set); /* it has no state without */
  const double dt = 0.1 * world_stable_dt(&w);
  double stored = 0.0;
  for (int32_t i = 0; i < 60; ++i) {
    world_step(&w, dt);
    stored = fmax(stored, world_info(&w).strain_energy);
  }
  const double share = heat_told(&w).dissipated_total / stored;
  show("%s: %.3g of what is stored\n", option->name, share);
  if (flows)
    ck_holds(share > -1e-3 && isfinite(share));
  else
    ck_within(option->name, share, 0.0, 1e-3);
  world_close(&w);
}
END_TEST

void add_heat_laws(Suite *suite) {
  TCase *laws = tcase_create("laws");
  tcase_add_loop_test(laws, free_expansion, 0, 12);
  tcase_add_loop_test(laws, stress_follows_its_temperature, 0, 2);
  tcase_add_loop_test(laws, held_expansion, 0, 72);
  tcase_add_loop_test(laws, bar_between_walls, 0, 2);
  tcase_add_loop_test(laws, plastic_work_is_heat, 0, 3 * BROAD);
  tcase_add_loop_test(laws, elastic_work_is_not, 0, LAWS);
  tcase_set_timeout(laws, 120);
  suite_add_tcase(suite, laws);
}
