/* A column of water collapses on a dry floor (Martin and Moyce, 1952: a column twice as high as wide, of
 * water, held by a membrane that is let go).
 *
 *   dam_break [directory]
 *
 * prints the front beside that of the experiment and writes into the directory (default: here): particles for
 * ParaView (dam_break.pvd), the history (front.csv), and pictures of the water (dam_break.svg) and of the
 * front (dam_break_front.svg). */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "svg.h"

/* Column a wide and 2 a high, a = 2.25 inches. */
static const double a = 0.05715, g = 9.81, density = 1000.0;
enum { CELLS = 20, SHOTS = 4 }; /* cells in the width; panels of the picture */

/* Martin and Moyce, table 2 (n^2 = 2): t sqrt(2 g / a) and front / a. */
enum { POINTS = 15 };
static const double measured[POINTS][2] = {{0.41, 1.11}, {0.84, 1.22}, {1.19, 1.44}, {1.43, 1.67},
                                           {1.63, 1.89}, {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56},
                                           {2.32, 2.78}, {2.51, 3.00}, {2.65, 3.22}, {2.83, 3.44},
                                           {2.98, 3.67}, {3.11, 3.89}, {3.33, 4.11}};

static const char *in_directory(const char *directory, const char *name) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  return path;
}

/* Arrays are [components][n]. */
typedef struct snapshot {
  double t;
  int64_t n;
  double *x, *F, *stress;
} snapshot;

static int snapshot_create(snapshot *s, int64_t n) {
  s->n = n;
  s->x = malloc((2 + 9 + 6) * (size_t)n * sizeof *s->x);
  if (!s->x) return -1;
  s->F = s->x + 2 * n;
  s->stress = s->F + 9 * n;
  return 0;
}

static mpm_status snapshot_take(snapshot *s, const mpm_particles *water, double t) {
  s->t = t;
  mpm_status status = mpm_particles_get(water, "position", MPM_F64, 2, s->n, NULL, s->x);
  if (!status) status = mpm_particles_get(water, "deformation_gradient", MPM_F64, 9, s->n, NULL, s->F);
  if (!status) status = mpm_particles_get(water, "stress", MPM_F64, 6, s->n, NULL, s->stress);
  return status;
}

/* Farthest particle and its half. */
static double front_of(const snapshot *s, double half) {
  double most = 0.0;
  for (int64_t i = 0; i < s->n; ++i) most = fmax(most, s->x[i]);
  return most + half;
}

/* The pressure that a column at rest has: any F with the right determinant will do. */
static mpm_status fill_pressure(mpm_particles *water, snapshot *s, double bulk_modulus) {
  for (int64_t i = 0; i < 9 * s->n; ++i) s->F[i] = 0.0;
  for (int64_t i = 0; i < s->n; ++i) {
    const double pressure = density * g * (2.0 * a - s->x[s->n + i]);
    s->F[i] = s->F[8 * s->n + i] = 1.0;
    s->F[4 * s->n + i] = pow(1.0 + 7.0 * pressure / bulk_modulus, -1.0 / 7.0);
  }
  return mpm_particles_set(water, "deformation_gradient", MPM_F64, 9, s->n, NULL, s->F);
}

static int draw_water(const char *path, const snapshot shot[SHOTS], double half) {
  const int64_t n = shot[0].n;
  double *value = malloc(5 * (size_t)n * sizeof *value);
  if (!value) return -1;
  double *edge_a = value + n, *edge_b = edge_a + 2 * n;
  const double value_max = 1000.0;
  FILE *out = svg_open(path, 960, 590);
  for (int k = 0; k < SHOTS; ++k) {
    const snapshot *s = &shot[k];
    const svg_frame f = {
        20.0 + 470.0 * (k % 2), 44.0 + 255.0 * (k / 2), 450.0, 202.5, 0.0, 5.0 * a, 0.0, 2.25 * a};
    for (int64_t i = 0; i < n; ++i) {
      value[i] = fmax(0.0, -(s->stress[i] + s->stress[n + i] + s->stress[2 * n + i]) / 3.0);
      edge_a[i] = edge_b[n + i] = half;
      edge_a[n + i] = edge_b[i] = 0.0;
    }
    char text[64];
    snprintf(text, sizeof text, "<tspan font-weight=\"bold\">t = %.3f s</tspan>", s->t);
    svg_text(out, f.left + 225.0, f.top - 12.0, "middle", "", text);
    svg_panel(out, &f);
    svg_tiles(out, &f, n, s->x, edge_a, edge_b, value, value_max);
  }
  svg_colour_bar(out, 320.0, 546.0, 320.0, value_max, "pressure / Pa (1000 and more)");
  free(value);
  return svg_close(out);
}

enum { SAMPLES = 110 };
static int draw_front(const char *path, const double *time, const double *front) {
  const svg_frame f = {78.0, 20.0, 862.0, 286.0, 0.0, 3.5, 1.0, 5.0};
  FILE *out = svg_open(path, 960, 370);
  svg_axes(out, &f, "t sqrt(2 g / a)", "front / a");
  svg_curve(out, &f, SAMPLES + 1, time, front, "#1f6feb");
  svg_circles(out, &f, POINTS, measured, "#d1480c");
  svg_text(out, svg_x(&f, 2.1), svg_y(&f, 3.7), "end", "fill=\"#1f6feb\" font-weight=\"bold\"", "particles");
  svg_text(out, svg_x(&f, 2.75), svg_y(&f, 2.7), "start", "fill=\"#d1480c\" font-weight=\"bold\"",
           "Martin and Moyce, 1952");
  return svg_close(out);
}

/* Linear between two samples. */
static double at_time(double t, const double *time, const double *value) {
  int k = 1;
  while (k < SAMPLES && time[k] < t) ++k;
  return value[k - 1] + (value[k] - value[k - 1]) * (t - time[k - 1]) / (time[k] - time[k - 1]);
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const double h = a / CELLS, half = 0.25 * h, unit = sqrt(a / (2.0 * g));
  /* sound ten times as fast as the water gets: densities within a per cent */
  const double sound = 10.0 * 2.0 * sqrt(2.0 * g * a), bulk_modulus = density * sound * sound;
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *water;
  mpm_stepper *stepper;
  mpm_series *series;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd))
    goto failed;
  gd.dim = 2;
  gd.cells[0] = 6 * CELLS;
  gd.cells[1] = 3 * CELLS;
  gd.spacing[0] = gd.spacing[1] = h;
  sd.transfer = MPM_APIC;
  sd.gravity[1] = -g;

  /* without tension, so that the sheet at the front and drops come off */
  const mpm_param params[] = {
      {"density", density}, {"bulk_modulus", bulk_modulus}, {"viscosity", 1e-3}, {"tension", 0.0}};
  const double lower[] = {0.0, 0.0}, upper[] = {a, 2.0 * a};
  const int32_t per_cell[] = {2, 2};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "newtonian_fluid", params, 4, &material) ||
      mpm_particles_create(ctx, grid, material, &water) ||
      mpm_particles_fill_box(water, lower, upper, per_cell, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, water) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_FRICTION_NODES, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_FRICTION_NODES, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FRICTION_NODES, 0.0))
    goto failed;

  snapshot shot[SHOTS], now_is;
  const int64_t n = mpm_particles_count(water);
  int no_memory = snapshot_create(&now_is, n);
  for (int k = 0; k < SHOTS; ++k) no_memory |= snapshot_create(&shot[k], n);
  if (no_memory) {
    fprintf(stderr, "dam_break: out of memory\n");
    return 1;
  }
  if (snapshot_take(&now_is, water, 0.0) || fill_pressure(water, &now_is, bulk_modulus) ||
      mpm_series_open(ctx, in_directory(directory, "dam_break.pvd"), &series))
    goto failed;
  FILE *csv = fopen(in_directory(directory, "front.csv"), "w");
  if (!csv) {
    fprintf(stderr, "dam_break: cannot write into %s\n", directory);
    return 1;
  }

  printf("A column of water, %" PRId64 " particles, cells of a / %d\n\n", n, CELLS);
  fprintf(csv, "t,T,front,kinetic,strain\n");
  static double time[SAMPLES + 1], front[SAMPLES + 1];
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_advance_desc go;
  if (mpm_advance_desc_init(&go, sizeof go) || mpm_stepper_info(stepper, &now)) goto failed;
  go.cfl = 0.4;
  const double t_end = 3.4 * unit;
  for (int k = 0; k <= SAMPLES; ++k) {
    go.t_end = t_end * k / SAMPLES;
    if (k > 0 && mpm_advance(stepper, &go, &now)) goto failed;
    if (snapshot_take(&now_is, water, now.t)) goto failed;
    time[k] = now.t / unit;
    front[k] = front_of(&now_is, half) / a;
    fprintf(csv, "%.6f,%.4f,%.5f,%.9e,%.9e\n", now.t, time[k], front[k], now.kinetic_energy,
            now.strain_energy);
    for (int p = 0; p < SHOTS; ++p)
      if (k == SAMPLES * p / (SHOTS - 1) && snapshot_take(&shot[p], water, now.t)) goto failed;
    if (k % 10 == 0) {
      static const char *const fields[] = {"velocity", "stress"};
      char name[32];
      snprintf(name, sizeof name, "water_%04d.vtp", k / 10);
      if (mpm_write_particles(water, in_directory(directory, name), 2, fields) ||
          mpm_series_append(series, now.t, name))
        goto failed;
      fprintf(stderr, "\rt = %.3f of %.3f s, step %" PRId64 " ", now.t, t_end, now.step);
    }
  }
  fprintf(stderr, "\n");

  printf("t sqrt(2g/a)   front/a   measured   ahead\n");
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (int i = 0; i < POINTS; ++i) {
    const double is = at_time(measured[i][0], time, front), ahead = 100.0 * (is / measured[i][1] - 1.0);
    printf("%8.2f %13.3f %9.2f %+8.1f %%\n", measured[i][0], is, measured[i][1], ahead);
    least = fmin(least, ahead);
    most = fmax(most, ahead);
  }
  const int csv_failed = ferror(csv);
  if (mpm_series_close(series)) goto failed;
  if (fclose(csv) || csv_failed || draw_water(in_directory(directory, "dam_break.svg"), shot, half) ||
      draw_front(in_directory(directory, "dam_break_front.svg"), time, front)) {
    fprintf(stderr, "dam_break: cannot write into %s\n", directory);
    return 1;
  }
  for (int k = 0; k < SHOTS; ++k) free(shot[k].x);
  free(now_is.x);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(water) || mpm_material_destroy(material) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: dam_break.pvd with water_*.vtp (open in ParaView), front.csv,\n"
         "dam_break.svg, dam_break_front.svg\n",
         directory);
  printf("result: front ahead of the experiment by at least %+.1f %% and at most %+.1f %%\n", least, most);
  return 0;

failed:
  fprintf(stderr, "\ndam_break: %s\n", mpm_last_error(ctx));
  return 1;
}
