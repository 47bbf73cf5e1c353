/* A rigid disc, a free obstacle, falls on a soft elastic bed and is thrown back.
 *
 *   dropped_ball [directory]
 *
 * prints where the disc is and what the bed does to it, and draws three moments (dropped_ball.svg) into the
 * directory (default: here). */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "svg.h"

enum { SAMPLES = 60, SHOTS = 3 };
static const double t_end = 0.6, h = 0.02, radius = 0.12, mass = 90.0, width = 1.0, depth = 0.4, g = 10.0;

/* What a picture needs; arrays are [components][n]. */
typedef struct snapshot {
  double t, centre[3], turn;
  int64_t n;
  double *x, *F, *stress;
} snapshot;

static mpm_status take(snapshot *s, const mpm_particles *bed, const mpm_obstacle *ball, double t) {
  double q[4];
  s->t = t;
  mpm_status status = mpm_obstacle_get_pose(ball, s->centre, q, NULL, NULL);
  s->turn = 2.0 * atan2(q[3], q[0]);
  if (!status) status = mpm_particles_get(bed, "position", MPM_F64, 2, s->n, NULL, s->x);
  if (!status) status = mpm_particles_get(bed, "deformation_gradient", MPM_F64, 9, s->n, NULL, s->F);
  if (!status) status = mpm_particles_get(bed, "stress", MPM_F64, 6, s->n, NULL, s->stress);
  return status;
}

static int draw(const char *path, const snapshot shot[SHOTS]) {
  static const char *const caption[SHOTS] = {"it touches", "deepest", "thrown back"};
  const double pressure_shown = 2e4;
  const int64_t n = shot[0].n;
  double *value = malloc(5 * (size_t)n * sizeof *value);
  if (!value) return -1;
  double *a = value + n, *b = a + 2 * n;
  FILE *out = svg_open(path, 960, 400);
  for (int k = 0; k < SHOTS; ++k) {
    const snapshot *s = &shot[k];
    const svg_frame f = {20.0 + 310.0 * k, 44.0, 300.0, 270.0, 0.0, width, 0.0, 0.9 * width};
    for (int64_t i = 0; i < n; ++i)
      value[i] = fmax(0.0, -(s->stress[i] + s->stress[n + i] + s->stress[2 * n + i]) / 3.0);
    svg_edges(n, 0.5 * h, s->F, 0, a);
    svg_edges(n, 0.5 * h, s->F, 1, b);
    char text[128];
    snprintf(text, sizeof text, "<tspan font-weight=\"bold\">t = %.2f s</tspan> &#160;%s", s->t, caption[k]);
    svg_text(out, f.left + 150.0, 30.0, "middle", "", text);
    svg_panel(out, &f);
    svg_tiles(out, &f, n, s->x, a, b, value, pressure_shown);
    svg_disc(out, &f, s->centre[0], s->centre[1], radius);
    if (out)
      fprintf(out, "<path d=\"M%.2f %.2fL%.2f %.2f\" stroke=\"" SVG_INK "\"/>\n", svg_x(&f, s->centre[0]),
              svg_y(&f, s->centre[1]), svg_x(&f, s->centre[0] + radius * cos(s->turn)),
              svg_y(&f, s->centre[1] + radius * sin(s->turn)));
  }
  svg_colour_bar(out, 320.0, 358.0, 320.0, pressure_shown, "pressure / Pa (20 000 and more)");
  free(value);
  return svg_close(out);
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *bed;
  mpm_stepper *stepper;
  mpm_obstacle *ball;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_obstacle_desc od;
  mpm_contact_desc rough;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_obstacle_desc_init(&od, sizeof od) ||
      mpm_contact_desc_init(&rough, sizeof rough))
    goto failed;
  gd.dim = 2;
  gd.basis = MPM_BSPLINE2;
  for (int c = 0; c < 2; ++c) {
    gd.cells[c] = 50;
    gd.spacing[c] = h;
  }
  sd.scheme = MPM_MUSL;
  sd.gravity[1] = -g;
  rough.friction = 0.5;
  od.shape = MPM_SHAPE_SPHERE; /* in 2-D a disc */
  od.motion = MPM_MOTION_FREE;
  od.size[0] = radius;
  od.mass = mass;
  od.inertia[8] = 0.5 * mass * radius * radius;
  od.position[0] = 0.45 * width;
  od.position[1] = depth + radius + 0.2;
  od.velocity[0] = 0.6; /* it comes from the left, and friction makes it turn */
  od.contact = &rough;

  const mpm_param elastic[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1000.0}};
  const double lower[2] = {0.0, 0.0}, upper[2] = {width, depth};
  const int32_t per_cell[2] = {2, 2};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &bed) ||
      mpm_particles_fill_box(bed, lower, upper, per_cell, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, bed) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0) || mpm_obstacle_create(ctx, &od, &ball) ||
      mpm_stepper_add_obstacle(stepper, ball))
    goto failed;

  snapshot shot[SHOTS];
  for (int k = 0; k < SHOTS; ++k) {
    shot[k].n = mpm_particles_count(bed);
    if (!(shot[k].x = malloc((2 + 9 + 6) * (size_t)shot[k].n * sizeof *shot[k].x))) {
      fprintf(stderr, "dropped_ball: out of memory\n");
      return 1;
    }
    shot[k].F = shot[k].x + 2 * shot[k].n;
    shot[k].stress = shot[k].F + 9 * shot[k].n;
  }
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_advance_desc go;
  if (mpm_advance_desc_init(&go, sizeof go)) goto failed;
  double lowest = HUGE_VAL, largest = 0.0, off = 0.0;
  int touched = 0;
  printf("   t/s   height/m   velocity/(m/s)   spin/(1/s)   force of the bed/N\n");
  for (int k = 1; k <= SAMPLES; ++k) {
    double x[3], v[3], w[3];
    mpm_contact_info on = {.struct_size = sizeof on};
    go.t_end = t_end * k / SAMPLES;
    if (mpm_advance(stepper, &go, &now) || mpm_obstacle_get_pose(ball, x, NULL, v, w) ||
        mpm_obstacle_contact_info(ball, MPM_BODY_ANY, &on))
      goto failed;
    /* force and impulse are those on the bed; the disc has the opposite, and its weight */
    const double gained = mass * v[1], given = -on.impulse[1] - mass * g * now.t;
    off = fmax(off, fabs(gained - given) / (mass * g * now.t));
    largest = fmax(largest, -on.force[1]);
    if (on.touching && !touched && take(&shot[0], bed, ball, now.t)) goto failed;
    touched |= on.touching;
    if (x[1] < lowest && take(&shot[1], bed, ball, now.t)) goto failed;
    lowest = fmin(lowest, x[1]);
    if (k % 3 == 0) printf("%6.2f %10.4f %16.4f %12.3f %20.1f\n", now.t, x[1], v[1], w[2], -on.force[1]);
  }
  if (take(&shot[2], bed, ball, now.t)) goto failed;
  char path[1024];
  snprintf(path, sizeof path, "%s/dropped_ball.svg", directory);
  if (draw(path, shot)) {
    fprintf(stderr, "dropped_ball: cannot write into %s\n", directory);
    return 1;
  }
  for (int k = 0; k < SHOTS; ++k) free(shot[k].x);
  double w[3];
  if (mpm_obstacle_get_pose(ball, NULL, NULL, NULL, w) || mpm_stepper_remove_obstacle(stepper, ball) ||
      mpm_obstacle_destroy(ball) || mpm_stepper_destroy(stepper) || mpm_particles_destroy(bed) ||
      mpm_material_destroy(rubber) || mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: dropped_ball.svg\n", directory);
  printf("result: deepest %.4f m, largest force %.2f of the weight, spin %.3f 1/s, momentum off by %.0e\n",
         depth + radius - lowest, largest / (mass * g), w[2], off);
  return 0;

failed:
  fprintf(stderr, "dropped_ball: %s\n", mpm_last_error(ctx));
  return 1;
}
