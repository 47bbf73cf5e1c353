/* Water enters a dry channel at the left, runs over a frictionless floor and leaves at the right: particles
 * are emitted and removed while the program runs.
 *
 *   outflow [directory]
 *
 * prints the mass that was emitted, is in the channel and has left, whose balance is exact, and at the end
 * surface and speed along the channel and the flux at the outlet. The stream is faster than its waves (Froude
 * number 1.7), so that nothing runs back from the outlet: behind the front it keeps the depth and the speed
 * of the inlet to 0.2 %, up to the fall over the edge. Writes into the directory (default: here) the water
 * and the grid for ParaView (outflow.pvd, outflow_grid.pvd) and a picture (outflow.svg).
 *
 * Inlet: a column of new particles whenever the last has moved on by its width. They are prescribed: until
 * they have passed two cells they move with the speed of the inlet, and so do the nodes that they touch.
 * Outlet: a face of kind MPM_WALL_OPEN, through which particles leave for good. */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "svg.h"

enum {
  ROWS = 8,      /* particles in the depth: 4 cells */
  GUIDED = 4,    /* columns that are prescribed: 2 cells */
  COLUMNS = 400, /* emitted in all: the channel is filled four times */
  CELLS = 50,    /* along the channel */
  ROW_EVERY = 40,
  FILE_EVERY = 20,
  BINS = 10
};
static const double speed = 1.5, depth = 0.08, g = 9.81, density = 1000.0;
static const double size = 0.08 / ROWS, h = 2.0 * 0.08 / ROWS; /* of a particle, of a cell */

static const char *in_directory(const char *directory, const char *name) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  return path;
}

/* Emits column `number`, with ids that tell column and row, under the pressure of the depth. */
static mpm_status emit(mpm_particles *water, int number, double bulk_modulus) {
  double x[2][ROWS], v[2][ROWS], volume[ROWS], F[9][ROWS] = {{0.0}};
  int64_t id[ROWS];
  uint8_t guided[2][ROWS];
  for (int i = 0; i < ROWS; ++i) {
    id[i] = (int64_t)number * ROWS + i;
    x[0][i] = 0.5 * size;
    x[1][i] = (i + 0.5) * size;
    v[0][i] = speed;
    v[1][i] = 0.0;
    volume[i] = size * size;
    guided[0][i] = guided[1][i] = 1;
    F[0][i] = F[8][i] = 1.0;
    F[4][i] = pow(1.0 + 7.0 * density * g * (depth - x[1][i]) / bulk_modulus, -1.0 / 7.0);
  }
  mpm_status status = mpm_particles_add(water, ROWS, x[0], v[0], volume, NULL, id, NULL);
  if (!status) status = mpm_particles_set(water, "deformation_gradient", MPM_F64, 9, ROWS, id, F);
  if (!status) status = mpm_particles_set(water, "prescribed", MPM_U8, 2, ROWS, id, guided);
  if (status || number < GUIDED) return status;
  for (int i = 0; i < ROWS; ++i) { /* the column that has passed is free from now on */
    id[i] -= GUIDED * ROWS;
    guided[0][i] = guided[1][i] = 0;
  }
  return mpm_particles_set(water, "prescribed", MPM_U8, 2, ROWS, id, guided);
}

/* What is in the channel now; arrays are [components][n]. */
typedef struct channel {
  int64_t n;
  double mass, top[BINS], speed[BINS]; /* in all; surface and mean speed along the channel */
  int64_t *id;
  double *x, *v;
} channel;

static mpm_status look(channel *c, const mpm_particles *water) {
  const int64_t n = c->n = mpm_particles_count(water);
  double *mass = c->v; /* not both at once */
  mpm_status status = mpm_particles_get(water, "mass", MPM_F64, 1, n, NULL, mass);
  if (!status) status = mpm_particles_get(water, "position", MPM_F64, 2, n, NULL, c->x);
  if (!status) status = mpm_particles_get(water, "id", MPM_I64, 1, n, NULL, c->id);
  c->mass = 0.0;
  for (int64_t i = 0; !status && i < n; ++i) c->mass += mass[i];
  if (!status) status = mpm_particles_get(water, "velocity", MPM_F64, 2, n, NULL, c->v);
  int64_t count[BINS] = {0};
  for (int k = 0; k < BINS; ++k) c->top[k] = c->speed[k] = 0.0;
  for (int64_t i = 0; !status && i < n; ++i) {
    const int k = (int)fmin(c->x[i] / (CELLS * h) * BINS, BINS - 1.0);
    c->top[k] = fmax(c->top[k], c->x[n + i] + 0.5 * size);
    c->speed[k] += (c->v[i] - c->speed[k]) / (double)++count[k];
  }
  return status;
}

/* A fluid keeps no shape, but ids tell who started beside whom: a tile is as long as the particle's distance
 * from the columns before and behind it in its row, and keeps its area. */
static int draw_channel(FILE *out, int panel, double t, const channel *c, double value_max) {
  const svg_frame f = {20.0, 40.0 + 164.0 * panel, 920.0, 128.8, 0.0, CELLS * h, 0.0, 7.0 * h};
  const int64_t n = c->n, last = c->id[n - 1];
  double *value = malloc(5 * (size_t)n * sizeof *value);
  int64_t *at = calloc((size_t)last + 1, sizeof *at); /* place + 1 of an id; 0: it has left */
  if (!value || !at) {
    free(value);
    free(at);
    return -1;
  }
  double *a = value + n, *b = a + 2 * n;
  for (int64_t i = 0; i < n; ++i) at[c->id[i]] = i + 1;
  for (int64_t i = 0; i < n; ++i) {
    const int64_t id = c->id[i];
    const int64_t ahead = id >= ROWS && at[id - ROWS] ? at[id - ROWS] - 1 : i;
    const int64_t behind = id + ROWS <= last && at[id + ROWS] ? at[id + ROWS] - 1 : i;
    const double columns = (double)((ahead != i) + (behind != i));
    for (int k = 0; k < 2; ++k)
      a[k * n + i] = columns > 0.0 ? 0.5 * (c->x[k * n + ahead] - c->x[k * n + behind]) / columns : 0.0;
    a[i] = fmax(a[i], 0.25 * size);
    b[i] = 0.0;
    b[n + i] = 0.25 * size * size / a[i];
    value[i] = hypot(c->v[i], c->v[n + i]) - speed;
  }
  char text[64];
  snprintf(text, sizeof text, "<tspan font-weight=\"bold\">t = %.2f s</tspan>", t);
  svg_text(out, f.left + 0.5 * f.width, f.top - 10.0, "middle", "", text);
  svg_panel(out, &f);
  svg_clip(out, &f);
  svg_tiles(out, &f, n, c->x, a, b, value, value_max);
  svg_end_clip(out);
  free(value);
  free(at);
  return 0;
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const double front_speed = speed + 2.0 * sqrt(g * depth); /* of a stream on a dry floor: the fastest */
  const double sound = 10.0 * front_speed, bulk_modulus = density * sound * sound;
  const double column_mass = ROWS * density * size * size;
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *water;
  mpm_stepper *stepper;
  mpm_series *series, *grid_series;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_advance_desc go;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_advance_desc_init(&go, sizeof go))
    goto failed;
  gd.dim = 2;
  gd.cells[0] = CELLS;
  gd.cells[1] = 16;
  gd.spacing[0] = gd.spacing[1] = h;
  sd.transfer = MPM_APIC;
  sd.gravity[1] = -g;
  go.cfl = 0.5;

  const mpm_param params[] = {
      {"density", density}, {"bulk_modulus", bulk_modulus}, {"viscosity", 1e-3}, {"tension", 0.0}};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "newtonian_fluid", params, 4, &material) ||
      mpm_particles_create(ctx, grid, material, &water) || mpm_stepper_create(ctx, grid, &sd, &stepper) ||
      mpm_stepper_add(stepper, water) || mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0) ||
      mpm_series_open(ctx, in_directory(directory, "outflow.pvd"), &series) ||
      mpm_series_open(ctx, in_directory(directory, "outflow_grid.pvd"), &grid_series))
    goto failed;

  channel now_is;
  const int64_t most = (int64_t)(COLUMNS + 1) * ROWS;
  now_is.x = malloc((2 + 2) * (size_t)most * sizeof *now_is.x);
  now_is.id = malloc((size_t)most * sizeof *now_is.id);
  if (!now_is.x || !now_is.id) {
    fprintf(stderr, "outflow: out of memory\n");
    return 1;
  }
  now_is.v = now_is.x + 2 * most;

  printf("A stream of %.2f m and %.1f m/s in a channel of %.1f m; masses in kg per metre of width\n\n", depth,
         speed, CELLS * h);
  printf("   t/s   emitted   in the channel   removed   balance\n");
  FILE *out = svg_open(in_directory(directory, "outflow.svg"), 960, 590);
  const double value_max = 1.0;
  double worst = 0.0, removed_before = 0.0, top[BINS] = {0.0}, mean[BINS] = {0.0};
  int not_drawn = 0;
  mpm_step_info now = {.struct_size = sizeof now};
  if (emit(water, 0, bulk_modulus)) goto failed;
  for (int k = 1; k <= COLUMNS; ++k) {
    go.t_end = k * size / speed;
    if (mpm_advance(stepper, &go, &now) || emit(water, k, bulk_modulus) || look(&now_is, water)) goto failed;
    const double emitted = (k + 1) * column_mass, removed = (double)now.removed * density * size * size;
    const double balance = emitted - now_is.mass - removed;
    worst = fmax(worst, fabs(balance));
    if (k == COLUMNS / 2) removed_before = removed;
    for (int j = 0; k > COLUMNS / 2 && j < BINS; ++j) {
      top[j] += now_is.top[j] / (COLUMNS - COLUMNS / 2);
      mean[j] += now_is.speed[j] / (COLUMNS - COLUMNS / 2);
    }
    if (k % ROW_EVERY == 0)
      printf("%6.2f %9.3f %16.3f %9.3f %9.0e\n", now.t, emitted, now_is.mass, removed, balance);
    if (k == 25 || k == 70 || k == COLUMNS)
      not_drawn |= draw_channel(out, (k > 25) + (k > 70), now.t, &now_is, value_max);
    if (k % FILE_EVERY == 0) {
      static const char *const fields[] = {"velocity", "stress", "prescribed"};
      static const char *const nodal[] = {"mass", "velocity"};
      char name[32], grid_name[32];
      snprintf(name, sizeof name, "water_%04d.vtp", k / FILE_EVERY);
      snprintf(grid_name, sizeof grid_name, "grid_%04d.vti", k / FILE_EVERY);
      if (mpm_write_particles(water, in_directory(directory, name), 3, fields) ||
          mpm_series_append(series, now.t, name) ||
          mpm_write_grid(stepper, in_directory(directory, grid_name), 2, nodal) ||
          mpm_series_append(grid_series, now.t, grid_name))
        goto failed;
    }
  }
  svg_colour_bar(out, 320.0, 546.0, 320.0, value_max, "speed beyond that of the inlet / (m/s)");
  not_drawn |= svg_close(out);
  if (not_drawn) {
    fprintf(stderr, "outflow: cannot write into %s\n", directory);
    return 1;
  }
  printf("\nmeans of the second half, the highest in each piece of the channel\n   x/m   surface/m   "
         "speed/(m/s)\n");
  double deep = 0.0, fast = 0.0; /* but for the last two tenths, where the stream falls over the edge */
  for (int j = 0; j < BINS; ++j) {
    printf("%6.2f %11.4f %13.4f\n", (j + 0.5) * CELLS * h / BINS, top[j], mean[j]);
    if (j < BINS - 2) deep = fmax(deep, 100.0 * fabs(top[j] / depth - 1.0));
    if (j < BINS - 2) fast = fmax(fast, 100.0 * fabs(mean[j] / speed - 1.0));
  }
  const double removed = (double)now.removed * density * size * size;
  const double flux = (removed - removed_before) / (column_mass * (COLUMNS - COLUMNS / 2));
  free(now_is.x);
  free(now_is.id);
  if (mpm_series_close(series) || mpm_series_close(grid_series) || mpm_stepper_destroy(stepper) ||
      mpm_particles_destroy(water) || mpm_material_destroy(material) || mpm_grid_destroy(grid) ||
      mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: outflow.pvd with water_*.vtp and outflow_grid.pvd with grid_*.vti (open in\n"
         "ParaView), outflow.svg\n",
         directory);
  printf("result: %" PRId64
         " particles left, mass balance to %.0e kg, flux at the outlet %.3f of the inlet's, "
         "depth within %.1f %%, speed within %.1f %%\n",
         now.removed, worst, flux, deep, fast);
  return 0;

failed:
  fprintf(stderr, "\noutflow: %s\n", mpm_last_error(ctx));
  return 1;
}
