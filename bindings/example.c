/* Two elastic disks that collide under a force of the host: the scene that the example of every language
 * makes, with the same bits. It prints the number of particles, the time and the hash of the state. */
#include <inttypes.h>
#include <mpm/mpm.h>
#include <stdio.h>

/* Bends the way of particles: the force is 0.05 x downwards per mass. */
static mpm_status pull(void *user, const mpm_particle_batch *batch, double *add) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i) add[batch->ld + i] += batch->mass[i] * (-0.05 * batch->position[i]);
  return MPM_OK;
}

static mpm_particles *disk(mpm_context *context, mpm_grid *grid, mpm_material *material, double centre,
                           double velocity) {
  mpm_particles *set;
  if (mpm_particles_create(context, grid, material, &set) ||
      mpm_particles_fill_ball(set, (double[]){centre, centre}, 0.15, (int32_t[]){2, 2}, NULL, NULL) ||
      mpm_particles_set_all(set, "velocity", MPM_F64, 2, (double[]){velocity, velocity}))
    return NULL;
  return set;
}

int main(void) {
  mpm_context *context;
  mpm_grid *grid = NULL;
  mpm_material *material = NULL;
  mpm_particles *left = NULL, *right = NULL;
  mpm_stepper *stepper = NULL;
  mpm_context_desc services;
  mpm_context_desc_init(&services, sizeof services);
  services.isa = MPM_ISA_PORTABLE;
  services.concurrency = 2;
  services.serial_callbacks = 1;
  if (mpm_context_create(&services, &context)) return 1;

  mpm_grid_desc box;
  mpm_grid_desc_init(&box, sizeof box);
  box.dim = 2;
  for (int k = 0; k < 2; ++k) {
    box.cells[k] = 40;
    box.spacing[k] = 0.025;
  }
  const mpm_param jelly[] = {{"E", 1e3}, {"nu", 0.3}, {"density", 1e3}};
  mpm_stepper_desc options;
  mpm_stepper_desc_init(&options, sizeof options);
  options.scheme = MPM_MUSL;
  options.projected_positions = 1;

  int failed = 1;
  if (mpm_grid_create(context, &box, &grid) ||
      mpm_material_create(context, "neo_hookean", jelly, 3, &material) ||
      !(left = disk(context, grid, material, 0.2, 0.5)) ||
      !(right = disk(context, grid, material, 0.8, -0.5)) ||
      mpm_stepper_create(context, grid, &options, &stepper) || mpm_stepper_add(stepper, left) ||
      mpm_stepper_add(stepper, right) || mpm_stepper_set_force(stepper, pull, NULL))
    goto end;
  for (int step = 0; step < 400; ++step)
    if (mpm_step(stepper, 2e-3, NULL)) goto end;

  mpm_step_info info = {.struct_size = sizeof info};
  uint64_t hash;
  if (mpm_stepper_info(stepper, &info) || mpm_state_hash(stepper, &hash)) goto end;
  printf("particles %" PRId64 "\n", mpm_particles_count(left) + mpm_particles_count(right));
  printf("time %.6f\nhash %016" PRIx64 "\n", info.t, hash);
  failed = 0;
end:
  if (failed) fprintf(stderr, "%s\n", mpm_last_error(context));
  mpm_stepper_destroy(stepper);
  mpm_particles_destroy(left);
  mpm_particles_destroy(right);
  mpm_material_destroy(material);
  mpm_grid_destroy(grid);
  mpm_context_destroy(context);
  return failed;
}
