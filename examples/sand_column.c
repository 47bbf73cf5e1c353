/* A round column of dry sand, as high as its radius, is let go on a rough floor and spreads, in three
 * dimensions.
 *
 *   sand_column [directory [cells in the radius]]
 *
 * A quarter of it, between two symmetry planes. Prints run-out, height and volume against time, and at the
 * end the run-out beside the experiments of Lube et al. 2004, who found (r - r_0) / r_0 = 1.24 h_0 / r_0
 * for low columns of any sand. Writes into the directory (default: here) a film strip of the section
 * (sand_column.svg), coloured by where particles were at first, and the deposit for ParaView
 * (sand_column.vtp).
 *
 * What to expect: 25 cells in the radius, the default, are 98 000 particles and take minutes; 8 take
 * seconds. The run-out is 1.10 and 1.32 of the radius with 8 and 25 cells, 0.89 and 1.06 of that of the
 * experiments. */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film.h"

static const double radius = 0.1, height = 0.1, density = 2000.0, E = 5e5, nu = 0.3, phi = 30.0, g = 9.81;
static const double measured = 1.24; /* run-out over the radius */
enum { ROWS = 20, LAYERS = 5 };

static mpm_status in_cylinder(void *user, int32_t dim, int64_t n, int64_t ld, const double *x,
                              uint8_t *inside) {
  (void)user, (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = x[i] * x[i] + x[ld + i] * x[ld + i] < radius * radius;
  return MPM_OK;
}

/* Arrays are [components][n], by ascending id. */
typedef struct sand {
  int64_t n, in_section;
  int64_t *section; /* particles beside the plane y = 0 */
  double *x, *start, *volume, *stress, *reach;
} sand;

static int sand_open(sand *s, int64_t n) {
  s->n = n;
  s->in_section = 0;
  s->x = malloc((3 + 3 + 1 + 6 + 1) * (size_t)n * sizeof *s->x);
  s->section = malloc((size_t)n * sizeof *s->section);
  if (!s->x || !s->section) return -1;
  s->start = s->x + 3 * n;
  s->volume = s->start + 3 * n;
  s->stress = s->volume + n;
  s->reach = s->stress + 6 * n;
  return 0;
}

/* A column at rest that has grown without moving sideways. */
static mpm_status settle(sand *s, mpm_particles *set, double edge) {
  mpm_status status = mpm_particles_get(set, "position", MPM_F64, 3, s->n, NULL, s->start);
  const int64_t n = s->n;
  for (int64_t i = 0; i < n; ++i) {
    const double down = -density * g * (height - s->start[2 * n + i]);
    for (int c = 0; c < 6; ++c) s->stress[c * n + i] = c < 2 ? nu / (1.0 - nu) * down : c == 2 ? down : 0.0;
    if (s->start[n + i] < edge) s->section[s->in_section++] = i;
  }
  return status ? status : mpm_particles_set(set, "stress", MPM_F64, 6, n, NULL, s->stress);
}

static int compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

typedef struct measures {
  double run_out, top, volume; /* run-out of 99 % of the mass; the last two over the first ones */
} measures;

static mpm_status look(sand *s, const mpm_particles *set, double edge, measures *m) {
  const int64_t n = s->n;
  mpm_status status = mpm_particles_get(set, "position", MPM_F64, 3, n, NULL, s->x);
  if (!status) status = mpm_particles_get(set, "volume", MPM_F64, 1, n, NULL, s->volume);
  m->top = m->volume = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    s->reach[i] = hypot(s->x[i], s->x[n + i]);
    m->volume += s->volume[i] / ((double)n * edge * edge * edge);
    if (s->reach[i] < 0.2 * radius) m->top = fmax(m->top, (s->x[2 * n + i] + 0.5 * edge) / height);
  }
  qsort(s->reach, (size_t)n, sizeof *s->reach, compare);
  m->run_out = s->reach[(int64_t)(0.99 * (double)n)] / radius - 1.0;
  return status;
}

static int shoot(film *strip, const sand *s, double t) {
  const int k = film_frame(strip, t);
  for (int64_t i = 0; k >= 0 && i < s->in_section; ++i) {
    const int64_t p = s->section[i];
    strip->x[k][i] = s->x[p];
    strip->x[k][strip->n + i] = s->x[2 * s->n + p];
    strip->value[k][i] = floor(LAYERS * s->start[2 * s->n + p] / height) + 0.5;
  }
  return k < 0 ? -1 : 0;
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const int cells = argc > 2 ? atoi(argv[2]) : 25;
  if (cells < 5 || cells > 200) {
    fprintf(stderr, "sand_column: cells in the radius must be 5 to 200\n");
    return 1;
  }
  const double h = radius / cells, edge = 0.5 * h, t_end = 4.0 * sqrt(height / g);
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
  mpm_context_desc cd;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_advance_desc go;
  if (mpm_context_desc_init(&cd, sizeof cd)) return 1;
  cd.concurrency = 0;
  if (mpm_context_create(&cd, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_advance_desc_init(&go, sizeof go))
    goto failed;
  gd.dim = 3;
  for (int c = 0; c < 3; ++c) gd.spacing[c] = h, gd.cells[c] = c < 2 ? 4 * cells : 5 * cells / 4 + 3;
  sd.scheme = MPM_MUSL;
  sd.pic_damping = 5.0;
  sd.gravity[2] = -g;

  const mpm_param params[] = {{"E", E}, {"nu", nu}, {"density", density}, {"phi", phi}};
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {radius, radius, height};
  const int32_t per_cell[] = {2, 2, 2};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "mohr_coulomb", params, 4, &material) ||
      mpm_particles_create(ctx, grid, material, &set) ||
      mpm_particles_fill(set, lower, upper, per_cell, in_cylinder, NULL, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, set) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Z_MIN, MPM_WALL_FIXED, 0.0))
    goto failed;

  sand s;
  measures is;
  if (sand_open(&s, mpm_particles_count(set))) {
    fprintf(stderr, "sand_column: out of memory\n");
    return 1;
  }
  if (settle(&s, set, edge) || look(&s, set, edge, &is)) goto failed;
  film strip = film_of(s.in_section, edge);
  int bad = shoot(&strip, &s, 0.0);
  printf("A quarter of a column of sand, %" PRId64 " particles, %d cells in the radius\n\n"
         "   t/s   run-out   height   volume   kinetic/J\n",
         s.n, cells);
  mpm_step_info now = {.struct_size = sizeof now};
  go.cfl = 0.4;
  for (int k = 1; k <= ROWS && !bad; ++k) {
    go.t_end = t_end * k / ROWS;
    if (mpm_advance(stepper, &go, &now) || look(&s, set, edge, &is)) goto failed;
    printf("%6.3f %9.3f %8.3f %8.3f %11.2e\n", now.t, is.run_out, is.top, is.volume, now.kinetic_energy);
    fprintf(stderr, "\rt = %.3f of %.3f s, step %" PRId64 " ", now.t, t_end, now.step);
    if (k == 5 || k == 8 || k == ROWS) bad = shoot(&strip, &s, now.t);
  }
  fprintf(stderr, "\n");
  static const char *const fields[] = {"velocity", "stress", "state"};
  char path[1024];
  snprintf(path, sizeof path, "%s/sand_column.vtp", directory);
  if (mpm_write_particles(set, path, 3, fields)) goto failed;
  const film_view view = {
      .x_max = 2.8 * radius, .y_max = 1.1 * height, .columns = 2, .panel = 460.0, .value_max = LAYERS};
  snprintf(path, sizeof path, "%s/sand_column.svg", directory);
  if (bad || film_draw(&strip, &view, path)) {
    fprintf(stderr, "sand_column: cannot write into %s\n", directory);
    return 1;
  }
  film_close(&strip);
  free(s.x), free(s.section);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(set) || mpm_material_destroy(material) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: sand_column.svg, sand_column.vtp\n", directory);
  printf("result: run-out %.3f of the radius, %.3f of the experiments; height %.3f, volume %.3f\n",
         is.run_out, is.run_out / measured, is.top, is.volume);
  return 0;

failed:
  fprintf(stderr, "\nsand_column: %s\n", mpm_last_error(ctx));
  return 1;
}
