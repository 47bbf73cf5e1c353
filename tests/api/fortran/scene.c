/* The part of the Fortran host that is easier in C: a scene with a law that divides by zero where the host's
 * own code must not. Every function returns the first status that is not MPM_OK. */
#include <mpm/mpm.h>
#include <stddef.h>

mpm_status scene_open(int32_t dim, int32_t scheme, mpm_particle_fn force, mpm_context **context,
                      mpm_stepper **stepper);
mpm_status scene_open(int32_t dim, int32_t scheme, mpm_particle_fn force, mpm_context **context,
                      mpm_stepper **stepper) {
  static const mpm_param steel[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1e3}, {"yield_stress", 50.0}};
  static const double lower[3] = {0.2, 0.0, 0.2}, upper[3] = {0.4, 0.3, 0.4}, velocity[3] = {0.5, -1.0, 0.25};
  static const int32_t per_cell[3] = {2, 2, 2};
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_status status = mpm_context_create(NULL, context);
  if (!status) status = mpm_grid_desc_init(&g, sizeof g);
  if (!status) status = mpm_stepper_desc_init(&s, sizeof s);
  if (status) return status;
  g.dim = dim;
  s.scheme = scheme;
  s.gravity[dim - 1] = -9.81;
  for (int32_t k = 0; k < dim; ++k) {
    g.cells[k] = 12;
    g.spacing[k] = 0.05;
  }
  if ((status = mpm_grid_create(*context, &g, &grid)) ||
      (status = mpm_material_create(*context, "j2", steel, 4, &material)) ||
      (status = mpm_particles_create(*context, grid, material, &set)) ||
      (status = mpm_particles_fill_box(set, lower, upper, per_cell, NULL, NULL)) ||
      (status = mpm_particles_set_all(set, "velocity", MPM_F64, dim, velocity)) ||
      (status = mpm_stepper_create(*context, grid, &s, stepper)) || (status = mpm_stepper_add(*stepper, set)))
    return status;
  if ((status = mpm_stepper_set_wall(*stepper, 2 * (dim - 1), MPM_WALL_FIXED, 0.0))) return status;
  return mpm_stepper_set_force(*stepper, force, NULL);
}
