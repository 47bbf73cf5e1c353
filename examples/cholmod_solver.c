/* A linear solver of the host: a soft beam, clamped at one end, sinks under its own weight in quasi-static
 * steps, once with the library's solvers and once with CHOLMOD (cholmod_direct.h). Built where
 * <suitesparse/cholmod.h> is found: Debian's libsuitesparse-dev. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "cholmod_direct.h"

static mpm_status clamp(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user, (void)velocity;
  for (int64_t i = 0; i < b->n; ++i)
    for (int c = 0; c < b->dim && b->position[i] < 0.5 + 1e-9; ++c) prescribed[c * b->ld + i] = 1;
  return MPM_OK;
}

typedef struct beam {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *set;
  mpm_stepper *stepper;
} beam;

static mpm_status open_beam(beam *b, int32_t solver, cholmod_direct *own) {
  const mpm_param soft[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1050.0}};
  const double lower[] = {0.0, 2.5}, upper[] = {4.5, 3.5};
  const int32_t per_cell[] = {2, 2};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_status status;
  if ((status = mpm_context_create(NULL, &b->context))) return status;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = 2;
  g.basis = MPM_BSPLINE2;
  g.spacing[0] = g.spacing[1] = 0.125;
  g.cells[0] = g.cells[1] = 40;
  mpm_stepper_desc_init(&s, sizeof s);
  s.scheme = MPM_NEWMARK;
  s.gravity[1] = -10.0;
  s.linear_solver = solver;
  if ((status = mpm_grid_create(b->context, &g, &b->grid)) ||
      (status = mpm_material_create(b->context, "neo_hookean", soft, 3, &b->rubber)) ||
      (status = mpm_particles_create(b->context, b->grid, b->rubber, &b->set)) ||
      (status = mpm_particles_fill_box(b->set, lower, upper, per_cell, NULL, NULL)) ||
      (status = mpm_stepper_create(b->context, b->grid, &s, &b->stepper)) ||
      (status = mpm_stepper_add(b->stepper, b->set)) ||
      (status = mpm_stepper_set_linear_solver(b->stepper, cholmod_direct_solve, own)))
    return status;
  return mpm_stepper_set_velocity_bc(b->stepper, clamp, NULL);
}

static int run(int32_t solver, cholmod_direct *own, double *lowest, mpm_profile *profile) {
  beam b = {NULL, NULL, NULL, NULL, NULL};
  mpm_step_info info = {.struct_size = sizeof info};
  profile->struct_size = sizeof *profile;
  mpm_status status = open_beam(&b, solver, own);
  if (!status) status = mpm_stepper_profile(b.stepper, 1, profile);
  int64_t solves = 0;
  for (int step = 0; step < 25 && !status; ++step) {
    status = mpm_step(b.stepper, 0.02, &info);
    solves += info.newton_iterations;
  }
  mpm_view x = {.struct_size = sizeof x};
  if (!status) status = mpm_particles_map(b.set, "position", MPM_READ, &x);
  if (status) {
    fprintf(stderr, "cholmod_solver: %s\n", b.context ? mpm_last_error(b.context) : "no context");
    return 1;
  }
  const double *y = (const double *)x.data + x.component_stride;
  *lowest = 1e9;
  for (int64_t i = 0; i < x.count; ++i)
    *lowest = fmin(*lowest, y[i * x.item_stride] > 0.0 ? y[i * x.item_stride] : 1e9);
  mpm_view_release(&x);
  mpm_stepper_profile(b.stepper, 0, profile);
  printf("%-8s %3" PRId64 " solves  %6.1f ms assembly  %6.1f ms solver  lowest point %.9f m\n",
         solver == MPM_SOLVER_HOST ? "CHOLMOD" : "built in", solves, 1e3 * profile->assembly,
         1e3 * (profile->factor + profile->solve), *lowest);
  mpm_stepper_destroy(b.stepper);
  mpm_particles_destroy(b.set);
  mpm_material_destroy(b.rubber);
  mpm_grid_destroy(b.grid);
  mpm_context_destroy(b.context);
  return 0;
}

int main(void) {
  cholmod_direct own;
  double lowest[2];
  mpm_profile profile;
  cholmod_direct_open(&own);
  if (run(MPM_SOLVER_AUTO, &own, &lowest[0], &profile) || run(MPM_SOLVER_HOST, &own, &lowest[1], &profile))
    return 1;
  cholmod_direct_close(&own);
  printf("result: beams differ by %.1e m, tip sinks by %.3f m in half a second, %d analyses for %d solves\n",
         fabs(lowest[0] - lowest[1]), 2.5 - lowest[0], (int)own.analyses, (int)own.solves);
  return 0;
}
