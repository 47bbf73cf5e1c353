/* A host program in C99: a block of rubber falls freely. Checks what must hold whatever the scheme. Takes the
 * version that the installation claims. */
#include <mpm/mpm.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int failed(const mpm_context *ctx, const char *what) {
  fprintf(stderr, "%s: %s\n", what, mpm_last_error(ctx));
  return 1;
}

int main(int argc, char **argv) {
  const double mass = 1e3 * 0.5 * 0.5, height = 2.0, gravity = -9.81;
  char version[32];
  snprintf(version, sizeof version, "%u.%u.%u", (unsigned)(mpm_version() >> 16),
           (unsigned)(mpm_version() >> 8 & 255), (unsigned)(mpm_version() & 255));
  if (mpm_version() != MPM_VERSION || (argc > 1 && strcmp(argv[1], version))) {
    fprintf(stderr, "version %s\n", version);
    return 1;
  }
  mpm_context *ctx;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *block;
  mpm_stepper *stepper;
  if (mpm_context_create(NULL, &ctx)) return failed(NULL, "context");

  mpm_grid_desc g;
  if (mpm_grid_desc_init(&g, sizeof g)) return failed(ctx, "grid desc");
  g.dim = 2;
  g.basis = MPM_BSPLINE2;
  g.spacing[0] = g.spacing[1] = 0.125;
  g.cells[0] = 16;
  g.cells[1] = 32;
  const mpm_param elastic[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}};
  const double lower[] = {0.75, height}, upper[] = {1.25, height + 0.5};
  const int32_t per_cell[] = {2, 2};
  int64_t count = 0;
  mpm_stepper_desc s;
  if (mpm_stepper_desc_init(&s, sizeof s)) return failed(ctx, "stepper desc");
  s.scheme = MPM_USL;
  s.gravity[1] = gravity;
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &block) ||
      mpm_particles_fill_box(block, lower, upper, per_cell, NULL, &count) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, block))
    return failed(ctx, "setup");
  if (count != 64 || mpm_particles_count(block) != 64) return failed(ctx, "count");

  mpm_step_info now;
  memset(&now, 0, sizeof now);
  now.struct_size = sizeof now;
  for (int step = 0; step < 20; ++step) {
    double dt;
    if (mpm_stable_dt(stepper, &dt) || mpm_step(stepper, 0.4 * dt, &now)) return failed(ctx, "step");
  }
  /* Free fall: momentum m g t, no strain; the kinetic energy is that of the momentum. */
  double momentum = mass * gravity * now.t, kinetic = 0.5 * momentum * momentum / mass;
  if (!(now.t > 0.0) || !(fabs(now.momentum[0]) <= 1e-9 * fabs(momentum)) ||
      !(fabs(now.momentum[1] - momentum) <= 1e-9 * fabs(momentum)) ||
      !(fabs(now.kinetic_energy - kinetic) <= 1e-9 * kinetic) ||
      !(fabs(now.strain_energy) <= 1e-9 * kinetic)) {
    fprintf(stderr, "t %g momentum %g %g (expected %g) kinetic %g (expected %g) strain %g\n", now.t,
            now.momentum[0], now.momentum[1], momentum, now.kinetic_energy, kinetic, now.strain_energy);
    return 1;
  }
  if (mpm_context_destroy(ctx) != MPM_E_STATE) return failed(ctx, "a context with children was destroyed");
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(block) || mpm_material_destroy(rubber) ||
      mpm_grid_destroy(grid))
    return failed(ctx, "destroy");
  if (mpm_context_destroy(ctx)) return 1;
  puts("ok");
  return 0;
}
