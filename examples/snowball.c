/* A snowball flies against a wall: what hits it is compacted and sticks to itself, the rest breaks off.
 *
 *   snowball [directory [cells]]
 *
 * prints how much of the ball is compacted and how much of its momentum the wall has taken, and draws a
 * film strip (snowball.svg) into the directory (default: here). cells: those across the ball (default 48). */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film.h"

enum { FRAMES = 6 };
static const double radius = 0.1, speed = 15.0, gravity = 9.81, wide = 0.5, high = 0.6, density = 400.0;

/* How much a particle has been compacted for good: 1 - J_P with J_P = J / J_E, from the state b_E - I. */
static void compaction_of(int64_t n, const double *F, const double *state, double *out) {
  for (int64_t p = 0; p < n; ++p) {
    const double J = (F[p] * F[4 * n + p] - F[n + p] * F[3 * n + p]) * F[8 * n + p];
    const double xx = 1.0 + state[p], yy = 1.0 + state[n + p], zz = 1.0 + state[2 * n + p],
                 xy = state[3 * n + p];
    out[p] = fmax(0.0, 1.0 - J / sqrt((xx * yy - xy * xy) * zz));
  }
}

static mpm_status take(film *f, const mpm_particles *snow, double t) {
  const int64_t n = f->n;
  const int k = film_frame(f, t);
  double *F = malloc((9 + 6) * (size_t)n * sizeof *F);
  mpm_status status = k < 0 || !F ? MPM_E_NOMEM : MPM_OK;
  if (!status) status = mpm_particles_get(snow, "position", MPM_F64, 2, n, NULL, f->x[k]);
  if (!status) status = mpm_particles_get(snow, "deformation_gradient", MPM_F64, 9, n, NULL, F);
  if (!status) status = mpm_particles_get(snow, "state", MPM_F64, 6, n, NULL, F + 9 * n);
  if (!status) compaction_of(n, F, F + 9 * n, f->value[k]);
  free(F);
  return status;
}

static void draw_wall(FILE *out, const svg_frame *f, const void *user) {
  (void)user;
  if (out)
    fprintf(out, "<path d=\"M%.2f %.2fL%.2f %.2f\" stroke=\"" SVG_INK "\" stroke-width=\"3\"/>\n",
            svg_x(f, wide), svg_y(f, 0.0), svg_x(f, wide), svg_y(f, high));
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const double h = 2.0 * radius / (argc > 2 ? atoi(argv[2]) : 48), t_end = 0.02;
  if (!(h > 0.0) || h > radius) {
    fprintf(stderr, "snowball: cells must be a number above 2\n");
    return 1;
  }
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *snow;
  mpm_particles *ball;
  mpm_stepper *stepper;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_advance_desc go;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_advance_desc_init(&go, sizeof go))
    goto failed;
  gd.dim = 2;
  gd.basis = MPM_BSPLINE2;
  gd.spacing[0] = gd.spacing[1] = h;
  gd.cells[0] = (int64_t)ceil(wide / h);
  gd.cells[1] = (int64_t)ceil(high / h);
  gd.origin[0] = wide - (double)gd.cells[0] * h; /* the wall is the upper face of x */
  sd.transfer = MPM_APIC;
  sd.gravity[1] = -gravity;

  const mpm_param of_snow[] = {{"E", 1.4e5}, {"nu", 0.2}, {"density", density}};
  const double centre[2] = {wide - 1.2 * radius, 0.35}, velocity[2] = {speed, 2.0};
  const int32_t per_cell[2] = {2, 2};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "snow", of_snow, 3, &snow) ||
      mpm_particles_create(ctx, grid, snow, &ball) ||
      mpm_particles_fill_ball(ball, centre, radius, per_cell, NULL, NULL) ||
      mpm_particles_set_all(ball, "velocity", MPM_F64, 2, velocity) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, ball) ||
      mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_FRICTION, 0.5) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0))
    goto failed;

  const int64_t n = mpm_particles_count(ball);
  film strip = film_of(n, 0.5 * h);
  mpm_step_info now = {.struct_size = sizeof now};
  printf("   t/ms   compacted by 5 %% and more   momentum along x/that of the ball\n");
  double first = 0.0, compacted = 0.0;
  for (int k = 0; k < FRAMES; ++k) {
    go.t_end = t_end * k / (FRAMES - 1);
    if (k && mpm_advance(stepper, &go, &now)) goto failed;
    if (!k && mpm_stepper_info(stepper, &now)) goto failed;
    if (take(&strip, ball, now.t)) goto failed;
    if (!k) first = now.momentum[0];
    compacted = 0.0;
    for (int64_t p = 0; p < n; ++p) compacted += strip.value[k][p] > 0.05 ? 1.0 / (double)n : 0.0;
    printf("%7.1f %26.3f %33.3f\n", 1e3 * now.t, compacted, now.momentum[0] / first);
  }
  char path[1024];
  snprintf(path, sizeof path, "%s/snowball.svg", directory);
  const film_view view = {.x_min = 0.0,
                          .x_max = wide,
                          .y_min = 0.0,
                          .y_max = high,
                          .columns = 3,
                          .panel = 280.0,
                          .value_max = 0.4,
                          .title = "compacted for good",
                          .scenery = draw_wall};
  if (film_draw(&strip, &view, path)) {
    fprintf(stderr, "snowball: cannot write into %s\n", directory);
    return 1;
  }
  film_close(&strip);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(ball) || mpm_material_destroy(snow) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: snowball.svg\n", directory);
  printf("result: %.1f %% of the ball compacted by 5 %% and more, momentum %.3f of the first\n",
         100.0 * compacted, now.momentum[0] / first);
  return 0;

failed:
  fprintf(stderr, "snowball: %s\n", mpm_last_error(ctx));
  return 1;
}
