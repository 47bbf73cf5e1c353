#include "geometry.h"

#include "reference.h"

static int32_t is_solid(const char *model) {
  static const char *const others[] = {"newtonian_fluid", "herschel_bulkley", "mu_i", "snow", "cam_clay"};
  for (int32_t i = 0; model && i < 5; ++i)
    if (!strcmp(model, others[i])) return 0;
  return 1;
}

static const char *model_of(const combination *c) {
  return law_options[c->choice[CHOOSE_LAW]].model;
}

static int32_t is_refused(const combination *c, int32_t geometry, int32_t total_lagrangian) {
  if (total_lagrangian && keeps_volume_alone(model_of(c))) return 1;
  if (geometry == MPM_PLANE_STRAIN) return 0;
  if (geometry == MPM_PLANE_STRESS) return c->choice[CHOOSE_REMEDY] || !is_solid(model_of(c));
  return transfer_options[c->choice[CHOOSE_TRANSFER]].transfer == MPM_APIC_MLS;
}

static void start(world *w, mpm_particles *set) {
  const double low[] = {0.1, 0.4, 0.6}, high[] = {1.3, 1.5, 1.4};
  const int64_t n = world_fill(w, set, low, high, 2);
  double *v = malloc((size_t)(w->dim * n + 1) * sizeof *v);
  for (int64_t i = 0; i < w->dim * n; ++i) v[i] = 0.3 * noise_at((uint64_t)i);
  put(w, set, "velocity", w->dim, v);
  free(v);
  if (!w->desc.law.model || strcmp(w->desc.law.model, "cam_clay")) return;
  double *stress = calloc((size_t)(6 * n), sizeof *stress); /* clay has none without a pressure */
  for (int64_t i = 0; i < 3 * n; ++i) stress[i] = -1e3;
  put(w, set, "stress", 6, stress);
  free(stress);
}

/* Every combination has heat, with what its law and geometry have of it. */
static void warm_up(world *w, mpm_particles *set, const combination *c) {
  const char *model = model_of(c);
  const int32_t rigid = model && !strcmp(model, "rigid");
  mpm_heat_desc heat;
  ck_ok(w, mpm_heat_desc_init(&heat, sizeof heat));
  heat.specific_heat = 2.0;
  heat.conductivity = 50.0;
  heat.reference_temperature = 300.0;
  heat.expansion = rigid || w->desc.grid.geometry == MPM_PLANE_STRESS ? 0.0 : 1e-4;
  heat.dissipated_share = rigid || !model ? 0.0 : 0.5;
  ck_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
  const int64_t n = mpm_particles_count(set);
  double *T = malloc((size_t)(n + 1) * sizeof *T);
  for (int64_t p = 0; p < n; ++p) T[p] = 300.0 + 10.0 * noise_at((uint64_t)p);
  put(w, set, "temperature", 1, T);
  free(T);
  const int32_t face = w->desc.grid.periodic[1] ? MPM_X_MAX : w->dim > 1 ? MPM_Y_MAX : MPM_X_MAX;
  if (!w->desc.grid.periodic[face / 2])
    ck_ok(w, mpm_stepper_set_heat_wall(w->stepper, face, MPM_HEAT_WALL_TEMPERATURE, 320.0));
  ck_ok(w, mpm_stepper_set_conduction(w->stepper, c->choice[CHOOSE_TRANSFER] % 2, 1e-9));
}

static uint64_t hash_of(const combination *c, int32_t geometry, int32_t total_lagrangian,
                        int32_t concurrency) {
  static reference_law host_law = {1e5, 0.3, 15.0};
  world w;
  world_desc desc = describe_combination(c);
  desc.grid.geometry = geometry;
  desc.grid.total_lagrangian = total_lagrangian;
  if (geometry == MPM_AXISYMMETRIC) {
    desc.grid.periodic[1] = desc.grid.periodic[0];
    desc.grid.periodic[0] = 0;
  }
  desc.context.concurrency = concurrency;
  desc.law = (world_law){.model = model_of(c),
                         .E = host_law.E,
                         .nu = host_law.nu,
                         .density = 1e3,
                         .yield_stress = 1e3,
                         .hardening = 1e4,
                         .stress = reference_law_stress,
                         .user = &host_law};
  mpm_particles *set = world_open(&w, &desc);
  start(&w, set);
  warm_up(&w, set, c);
  const double dt = fmin(0.2 * world_stable_dt(&w), 1e-2);
  for (int32_t step = 0; step < 5; ++step) w.info = world_step(&w, dt);
  if (geometry == MPM_AXISYMMETRIC) ck_holds(w.info.momentum[0] == 0.0 && w.info.angular_momentum[2] == 0.0);
  const uint64_t hash = world_step_again(&w, dt);
  world_close(&w);
  return hash;
}

void check_geometry(const combination *c, int32_t geometry, int32_t total_lagrangian) {
  char name[256];
  if (geometry != MPM_PLANE_STRAIN && c->choice[CHOOSE_DIM] != 2) return;
  if (is_refused(c, geometry, total_lagrangian)) return;
  if (hash_of(c, geometry, total_lagrangian, 1) != hash_of(c, geometry, total_lagrangian, 3))
    ck_abort_msg("%s: the threads matter", name_of(c, name, sizeof name));
}
