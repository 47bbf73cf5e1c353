/* A soft cantilever of 4 m x 1 m, clamped at x = 0, falls under its own weight, which is switched on at t = 0
 * (Sadeghirad, Brannon and Burghardt, 2011). Prints how far its lower right corner has come, beside a
 * converged Lagrangian finite element solution. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>

static const double length = 4.0, depth = 1.0, h = 0.125;

/* The clamp: the nodes on and behind x = 0 stay where they are. Only over the depth of the beam, so that its
 * tip may swing through below. */
static mpm_status clamp(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    const double x = b->position[i], y = b->position[b->ld + i];
    if (x > 0.01 * h || y < -1.01 * h || y > depth + 1.01 * h) continue;
    for (int c = 0; c < 2; ++c) {
      prescribed[c * b->ld + i] = 1;
      velocity[c * b->ld + i] = 0.0;
    }
  }
  return MPM_OK;
}

int main(void) {
  /* displacement u_y of the corner at t = 0.1, 0.2 ... 1.0, quadrilaterals, 6400 of them */
  static const double fem[] = {-0.0501, -0.1996, -0.5069, -1.0136, -1.5827,
                               -2.1016, -2.5199, -2.8862, -3.1632, -3.2879};
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *beam;
  mpm_stepper *stepper;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_advance_desc go;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s) || mpm_advance_desc_init(&go, sizeof go))
    goto failed;

  g.dim = 2;
  g.basis = MPM_BSPLINE2;
  g.origin[0] = -4.0 * h;
  g.origin[1] = -4.5;
  g.cells[0] = 40;
  g.cells[1] = 48;
  g.spacing[0] = g.spacing[1] = h;
  s.scheme = MPM_MUSL;
  s.projected_positions = 1; /* its upper side is stretched for long */
  s.transfer = MPM_FLIP;
  s.gravity[1] = -10.0;
  go.cfl = 0.4;

  const mpm_param elastic[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1050.0}};
  const double lower[] = {0.0, 0.0}, upper[] = {length, depth};
  const int32_t per_cell[] = {2, 2};
  int64_t first, count;
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &beam) ||
      mpm_particles_fill_box(beam, lower, upper, per_cell, &first, &count) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, beam) ||
      mpm_stepper_set_velocity_bc(stepper, clamp, NULL))
    goto failed;

  /* The particle at the corner is the one a quarter of a cell away from it: its deformation gradient carries
   * its displacement on to the corner. */
  int64_t corner = -1;
  const double to_corner[] = {0.25 * h, -0.25 * h};
  for (int64_t id = first; id < first + count; ++id) {
    double x[2];
    if (mpm_particles_get(beam, "position", MPM_F64, 2, 1, &id, x)) goto failed;
    if (hypot(x[0] + to_corner[0] - length, x[1] + to_corner[1]) < 0.01 * h) corner = id;
  }

  printf("Gravity cantilever, %lld particles, cells of 1/8 m\n\n", (long long)count);
  printf(" t/s    u_y/m    FEM/m   deviation\n");
  mpm_step_info now = {.struct_size = sizeof now};
  double u[10];
  for (int k = 0; k < 10; ++k) {
    double x[2], F[9];
    go.t_end = 0.1 * (k + 1);
    if (mpm_advance(stepper, &go, &now) || mpm_particles_get(beam, "position", MPM_F64, 2, 1, &corner, x) ||
        mpm_particles_get(beam, "deformation_gradient", MPM_F64, 9, 1, &corner, F))
      goto failed;
    u[k] = x[1] + F[3] * to_corner[0] + F[4] * to_corner[1]; /* the corner starts at y = 0 */
    printf("%4.1f %8.4f %8.4f %8.1f %%\n", now.t, u[k], fem[k], 100.0 * (u[k] / fem[k] - 1.0));
  }

  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(beam) || mpm_material_destroy(rubber) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nresult: u_y(0.5) = %.3f (FEM %.4f, deviation %+.1f %%)\n", u[4], fem[4],
         100.0 * (u[4] / fem[4] - 1.0));
  return 0;

failed:
  fprintf(stderr, "cantilever: %s\n", mpm_last_error(ctx));
  return 1;
}
