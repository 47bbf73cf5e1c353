/* A rubber saddle swings in a pipe without friction: the wall of the pipe is a surface of markers across the
 * grid, along which the material slides. Explicit steps; the saddle is a sector of a ring, and swings about
 * the axis of the pipe as a pendulum.
 *
 *   swinging_saddle [directory]
 *
 * prints angle and energy beside those of the rigid pendulum, phi'' = -(g rc / k^2) sin phi with the radius
 * rc of the centre of mass and k of gyration, and writes into the directory (default: here) a picture,
 * swinging_saddle.svg. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "body.h"

enum { FRAMES = 60, CORNERS = 90 };
static const double pipe_radius = 1.0, inner = 0.75, half_width = 0.35, start = 0.9, h = 0.05, gravity = 9.81;
static const double centre[2] = {1.25, 1.3}, end = 4.0;

static mpm_status in_saddle(void *user, int32_t dim, int64_t n, int64_t ld, const double *x,
                            uint8_t *inside) {
  (void)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) {
    const double arm[2] = {x[i] - centre[0], centre[1] - x[ld + i]};
    const double r = hypot(arm[0], arm[1]), angle = atan2(arm[0], arm[1]);
    inside[i] = r > inner && r < pipe_radius && fabs(angle - start) < half_width;
  }
  return MPM_OK;
}

/* The wall from left to right, counter-clockwise about the axis: the material is on the left. */
static mpm_status add_wall(mpm_surface *wall) {
  double at[2 * (CORNERS + 1)];
  for (int k = 0; k <= CORNERS; ++k) {
    const double angle = 1.55 * (2.0 * k / CORNERS - 1.0);
    at[k] = centre[0] + pipe_radius * sin(angle);
    at[CORNERS + 1 + k] = centre[1] - pipe_radius * cos(angle);
  }
  return mpm_surface_add_polyline(wall, CORNERS + 1, at, 0, 0.5 * h, NULL, NULL);
}

/* The angle of the centre of mass. */
static double angle_of(const body *saddle) {
  double sum[2] = {0.0, 0.0};
  for (int64_t i = 0; i < saddle->n; ++i) {
    sum[0] += saddle->x[i] - centre[0];
    sum[1] += centre[1] - saddle->x[saddle->n + i];
  }
  return atan2(sum[0], sum[1]);
}

/* The rigid pendulum at the end of each frame, by a fine leapfrog. */
static void swing(const body *saddle, double *angle) {
  double arm[2] = {0.0, 0.0}, square = 0.0, rate = 0.0;
  for (int64_t i = 0; i < saddle->n; ++i) {
    const double x = saddle->x[i] - centre[0], y = saddle->x[saddle->n + i] - centre[1];
    arm[0] += x / (double)saddle->n;
    arm[1] += y / (double)saddle->n;
    square += (x * x + y * y) / (double)saddle->n;
  }
  const double pull = gravity * hypot(arm[0], arm[1]) / square;
  enum { FINE = 2000 };
  const double dt = end / FRAMES / FINE;
  angle[0] = angle_of(saddle);
  for (int k = 1; k <= FRAMES; ++k) {
    angle[k] = angle[k - 1];
    for (int i = 0; i < FINE; ++i) {
      rate -= 0.5 * dt * pull * sin(angle[k]);
      angle[k] += dt * rate;
      rate -= 0.5 * dt * pull * sin(angle[k]);
    }
  }
}

static void draw(FILE *out, int panel, const body *saddle, double t) {
  const svg_frame f = {20.0 + 300.0 * panel, 40.0, 280.0, 196.0, 0.0, 2.5, 0.0, 1.75};
  double *value = malloc(5 * (size_t)saddle->n * sizeof *value), x[CORNERS + 1], y[CORNERS + 1];
  if (!value) return;
  double *a = value + saddle->n, *b = a + 2 * saddle->n;
  for (int64_t i = 0; i < saddle->n; ++i) {
    value[i] = hypot(saddle->x[i] - centre[0], saddle->x[saddle->n + i] - centre[1]);
    for (int c = 0; c < 2; ++c) {
      a[c * saddle->n + i] = 0.25 * h * saddle->F[3 * c * saddle->n + i];
      b[c * saddle->n + i] = 0.25 * h * saddle->F[(3 * c + 1) * saddle->n + i];
    }
  }
  for (int k = 0; k <= CORNERS; ++k) {
    const double angle = 1.55 * (2.0 * k / CORNERS - 1.0);
    x[k] = centre[0] + pipe_radius * sin(angle);
    y[k] = centre[1] - pipe_radius * cos(angle);
  }
  char text[64];
  snprintf(text, sizeof text, "<tspan font-weight=\"bold\">%.2f s</tspan>", t);
  svg_text(out, f.left + 0.5 * f.width, f.top - 10.0, "middle", "", text);
  svg_panel(out, &f);
  svg_clip(out, &f);
  svg_tiles(out, &f, saddle->n, saddle->x, a, b, value, 1.0);
  svg_curve(out, &f, CORNERS + 1, x, y, "#24292f");
  svg_end_clip(out);
  free(value);
}

int main(int argc, char **argv) {
  char path[1024];
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *set;
  mpm_stepper *stepper;
  mpm_surface *wall;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_surface_desc slides;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s) || mpm_surface_desc_init(&slides, sizeof slides))
    goto failed;
  g.dim = 2;
  g.cells[0] = 50;
  g.cells[1] = 35;
  g.spacing[0] = g.spacing[1] = h;
  s.transfer = MPM_FLIP;
  s.gravity[1] = -gravity;
  slides.prescribes = MPM_PRESCRIBES_NORMAL;

  const mpm_param law[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}};
  const double lower[] = {0.0, 0.0}, upper[] = {2.5, 1.75};
  const int32_t per_cell[] = {2, 2};
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", law, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &set) ||
      mpm_particles_fill(set, lower, upper, per_cell, in_saddle, NULL, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, set) ||
      mpm_surface_create(ctx, grid, &slides, &wall) || add_wall(wall) ||
      mpm_stepper_add_surface(stepper, wall))
    goto failed;
  body saddle;
  if (body_open(&saddle, set) || body_read(&saddle)) return 1;
  printf("A saddle of %lld particles in a pipe of %lld markers\n\n", (long long)saddle.n,
         (long long)mpm_surface_count(wall));
  printf(" t/s   angle   of the pendulum   energy over that at the start\n");
  snprintf(path, sizeof path, "%s/swinging_saddle.svg", argc > 1 ? argv[1] : ".");
  FILE *out = svg_open(path, 920, 560);
  double t[FRAMES + 1], angle[FRAMES + 1], exact[FRAMES + 1], worst = 0.0;
  t[0] = 0.0;
  angle[0] = angle_of(&saddle);
  swing(&saddle, exact);
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_advance_desc to;
  if (mpm_advance_desc_init(&to, sizeof to)) goto failed;
  draw(out, 0, &saddle, 0.0);
  double weight = 0.0, lost = 0.0, falls = 0.0;
  for (int k = 1; k <= FRAMES; ++k) {
    to.t_end = t[k] = end * k / FRAMES;
    if (mpm_advance(stepper, &to, &now) || body_read(&saddle)) goto failed;
    angle[k] = angle_of(&saddle);
    worst = fmax(worst, fabs(angle[k] - exact[k]));
    falls = fmax(falls, now.external_work_total);
    lost = now.external_work_total - now.kinetic_energy - now.strain_energy;
    if (k % 10 == 0)
      printf("%4.2f %7.3f %17.3f %20.1f J of %.1f\n", t[k], angle[k], exact[k],
             now.kinetic_energy + now.strain_energy, now.external_work_total);
    if (k == 12 || k == 24) draw(out, k / 12, &saddle, t[k]);
  }
  double force[2];
  if (mpm_stepper_surface_impulse(stepper, wall, force)) goto failed;
  weight = force[1] / end;
  const svg_frame curve = {80.0, 290.0, 780.0, 210.0, 0.0, end, -1.2, 1.2};
  svg_axes(out, &curve, "t / s", "angle");
  svg_curve(out, &curve, FRAMES + 1, t, exact, "#8c959f");
  svg_curve(out, &curve, FRAMES + 1, t, angle, "#0969da");
  if (svg_close(out)) {
    fprintf(stderr, "swinging_saddle: cannot write %s\n", path);
    return 1;
  }
  body_close(&saddle);
  if (mpm_stepper_destroy(stepper) || mpm_surface_destroy(wall) || mpm_particles_destroy(set) ||
      mpm_material_destroy(rubber) || mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten: %s\nresult: angle within %.3f of the pendulum, %.1f %% of the energy lost, mean force "
         "%.0f\n",
         path, worst, 100.0 * lost / falls, weight);
  return 0;

failed:
  fprintf(stderr, "swinging_saddle: %s\n", mpm_last_error(ctx));
  return 1;
}
