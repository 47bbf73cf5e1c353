/* Saves a state, or loads one that another release has saved, and prints what a host sees of it:
 * tests/api/releases.sh compiles it against the headers of 0.1.0.
 * Usage: old_state save FILE, old_state load FILE. */
#include <stdio.h>
#include <string.h>

#include <mpm/mpm.h>

static mpm_context *context;

static int ok(mpm_status status, const char *call) {
  if (status) printf("%s: %s: %s\n", call, mpm_status_name(status), mpm_last_error(context));
  return status == MPM_OK;
}
#define OK(call)                                                                                             \
  do {                                                                                                       \
    if (!ok(call, #call)) return 1;                                                                          \
  } while (0)

static int show(mpm_stepper *stepper, mpm_particles *const *set) {
  mpm_step_info now;
  double force[4];
  uint64_t hash;
  memset(&now, 0, sizeof now);
  now.struct_size = sizeof now;
  OK(mpm_state_hash(stepper, &hash));
  OK(mpm_stepper_info(stepper, &now));
  OK(mpm_stepper_wall_reaction(stepper, MPM_Y_MIN, force));
  OK(mpm_stepper_particles_reaction(stepper, set[1], force + 2));
  printf("hash %016llx t %a step %lld nodes %lld work %a wall %a %a platen %a %a\n", (unsigned long long)hash,
         now.t, (long long)now.step, (long long)now.active_nodes, now.external_work, force[0], force[1],
         force[2], force[3]);
  return 0;
}

int main(int argc, char **argv) {
  if (argc != 3) return 2;
  mpm_context_desc services;
  mpm_grid_desc box;
  mpm_stepper_desc how;
  mpm_grid *grid;
  mpm_material *law;
  mpm_particles *set[2];
  mpm_stepper *stepper;
  OK(mpm_context_desc_init(&services, sizeof services));
  services.isa = MPM_ISA_BASELINE;
  OK(mpm_context_create(&services, &context));
  OK(mpm_grid_desc_init(&box, sizeof box));
  box.dim = 2;
  box.cells[0] = box.cells[1] = 8;
  box.spacing[0] = box.spacing[1] = 0.125;
  OK(mpm_grid_create(context, &box, &grid));
  const mpm_param elastic[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1e3}};
  OK(mpm_material_create(context, "neo_hookean", elastic, 3, &law));
  OK(mpm_stepper_desc_init(&how, sizeof how));
  how.gravity[1] = -10.0;
  OK(mpm_stepper_create(context, grid, &how, &stepper));
  const double lower[] = {0.25, 0.0, 0.25, 0.25}, upper[] = {0.5, 0.25, 0.5, 0.375}, down[] = {0.0, -1.0};
  const int32_t per_cell[] = {2, 2};
  const uint8_t all[] = {1, 1};
  for (int m = 0; m < 2; ++m) {
    OK(mpm_particles_create(context, grid, law, &set[m]));
    if (strcmp(argv[1], "save") == 0)
      OK(mpm_particles_fill_box(set[m], lower + 2 * m, upper + 2 * m, per_cell, NULL, NULL));
    OK(mpm_stepper_add(stepper, set[m]));
  }
  OK(mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  if (strcmp(argv[1], "save") == 0) {
    OK(mpm_particles_set_all(set[1], "prescribed", MPM_U8, 2, all));
    OK(mpm_particles_set_all(set[1], "velocity", MPM_F64, 2, down));
    for (int i = 0; i < 5; ++i) OK(mpm_step(stepper, 1e-3, NULL));
    OK(mpm_state_save_file(stepper, argv[2]));
  } else {
    OK(mpm_state_load_file(stepper, argv[2]));
  }
  if (show(stepper, set)) return 1;
  if (strcmp(argv[1], "load") == 0) {
    OK(mpm_step(stepper, 1e-3, NULL));
    if (show(stepper, set)) return 1;
  }
  OK(mpm_stepper_destroy(stepper));
  for (int m = 0; m < 2; ++m) OK(mpm_particles_destroy(set[m]));
  OK(mpm_material_destroy(law));
  OK(mpm_grid_destroy(grid));
  OK(mpm_context_destroy(context));
  return 0;
}
