/* An embankment of cohesive soil fails as its weight grows, as in a centrifuge: shear bands form, soften,
 * and a block slides out. In plane strain.
 *
 *   slope_failure [directory [cells in the height]]
 *
 * `mohr_coulomb` with a cohesion that falls from 10 to 2 kPa with plastic strain. Prints the share of
 * gravity, the way of the crest and the largest plastic strain against time, and in the end the share of
 * gravity at which the crest has sunk twice as far as it would elastically, beside Taylor's stability
 * number for a slope of 45 degrees with a friction of 20 degrees (height times weight = 16.1 cohesions).
 * Writes a film strip (slope_failure.svg), coloured by plastic strain, into the directory (default: here).
 *
 * What to expect: 32 cells in the height, the default, take half a minute; 16 take seconds. With 16, 24, 32
 * and 40 cells it fails at 0.89, 0.85, 0.82 and 0.81 of gravity (Taylor: 0.82). Soil that softens has no
 * width of its bands: they are as thin as cells let them be, and strain in them grows as cells get smaller
 * (8.1, 12.1, 14.4 and 16.4 in the end). How far the block slides depends less on it (9.1, 8.9, 10.1 and
 * 9.7 m). */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film.h"

static const double height = 10.0, crest = 12.0, base = 4.0, length = 40.0; /* base: below the toe */
static const double density = 2000.0, E = 1e7, nu = 0.35, phi = 20.0, cohesion = 1e4, residual = 2e3,
                    hardening = -4e4, g = 9.81, grow = 10.0,
                    t_end = 15.0; /* grow: time until gravity is full */
static const double taylor = 16.1;
enum { ROWS = 150 };

static mpm_status in_slope(void *user, int32_t dim, int64_t n, int64_t ld, const double *x, uint8_t *inside) {
  (void)user, (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = x[ld + i] < base || x[ld + i] - base < crest + height - x[i];
  return MPM_OK;
}

static mpm_status weigh(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= g * fmin(b->t / grow, 1.0);
  return MPM_OK;
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const int cells = argc > 2 ? atoi(argv[2]) : 32;
  if (cells < 10 || cells > 200) {
    fprintf(stderr, "slope_failure: cells in the height must be 10 to 200\n");
    return 1;
  }
  const double h = height / cells;
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *soil;
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
  gd.dim = 2;
  gd.spacing[0] = gd.spacing[1] = h;
  gd.cells[0] = (int64_t)ceil(length / h);
  gd.cells[1] = (int64_t)ceil((base + height) / h) + 4;
  sd.scheme = MPM_MUSL;
  sd.pic_damping = 2.0;

  const mpm_param params[] = {{"E", E},
                              {"nu", nu},
                              {"density", density},
                              {"phi", phi},
                              {"cohesion", cohesion},
                              {"cohesion_residual", residual},
                              {"hardening", hardening}};
  const double lower[] = {0.0, 0.0}, upper[] = {length, base + height};
  const int32_t per_cell[] = {2, 2};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "mohr_coulomb", params, 7, &material) ||
      mpm_particles_create(ctx, grid, material, &soil) ||
      mpm_particles_fill(soil, lower, upper, per_cell, in_slope, NULL, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, soil) ||
      mpm_stepper_set_acceleration(stepper, weigh, NULL) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0))
    goto failed;

  const int64_t n = mpm_particles_count(soil);
  film strip = film_of(n, 0.5 * h);
  double *x = malloc(6 * (size_t)n * sizeof *x);
  if (!x) {
    fprintf(stderr, "slope_failure: out of memory\n");
    return 1;
  }
  double *start = x + 2 * n, *state = start + 2 * n;
  if (mpm_particles_get(soil, "position", MPM_F64, 2, n, NULL, start)) goto failed;
  int64_t edge = 0; /* of the crest */
  for (int64_t i = 0; i < n; ++i)
    if (start[i] + 4.0 * start[n + i] > start[edge] + 4.0 * start[n + edge]) edge = i;
  printf("An embankment %g m high, %" PRId64 " particles, cells of %g m\n\n"
         "  t/s   gravity   crest/m   plastic   toe/m   kinetic/kJ\n",
         height, n, h);
  mpm_step_info now = {.struct_size = sizeof now};
  double fails = 0.0, elastic = 0.0, way = 0.0, sunk = 0.0, plastic = 0.0;
  int bad = 0;
  go.cfl = 0.4;
  for (int k = 1; k <= ROWS && !bad; ++k) {
    go.t_end = t_end * k / ROWS;
    if (mpm_advance(stepper, &go, &now) || mpm_particles_get(soil, "position", MPM_F64, 2, n, NULL, x) ||
        mpm_particles_get(soil, "state", MPM_F64, 2, n, NULL, state))
      goto failed;
    way = plastic = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      plastic = fmax(plastic, state[i]);
      if (x[n + i] > base) way = fmax(way, x[i] - crest - height);
    }
    sunk = start[n + edge] - x[n + edge];
    const double share = fmin(now.t / grow, 1.0);
    if (fails == 0.0 && share <= 0.5) elastic = sunk / share;
    if (fails == 0.0 && sunk > 2.0 * elastic * share) fails = share;
    if (k % 10 == 0)
      printf("%5.1f %9.3f %9.3f %9.3f %7.2f %11.2f\n", now.t, share, sunk, plastic, way,
             1e-3 * now.kinetic_energy);
    fprintf(stderr, "\rt = %.1f of %.1f s, step %" PRId64 " ", now.t, t_end, now.step);
    if (k == 88 || k == 98 || k == 108 || k == ROWS) {
      const int at = film_frame(&strip, now.t);
      bad = at < 0;
      for (int64_t i = 0; !bad && i < n; ++i) {
        strip.x[at][i] = x[i];
        strip.x[at][n + i] = x[n + i];
        strip.value[at][i] = state[i];
      }
    }
  }
  fprintf(stderr, "\n");
  const film_view view = {.x_max = length,
                          .y_max = base + height + 0.5,
                          .columns = 2,
                          .panel = 460.0,
                          .value_max = 1.0,
                          .title = "plastic strain (1 and more)"};
  char path[1024];
  snprintf(path, sizeof path, "%s/slope_failure.svg", directory);
  if (bad || film_draw(&strip, &view, path)) {
    fprintf(stderr, "slope_failure: cannot write into %s\n", directory);
    return 1;
  }
  film_close(&strip);
  free(x);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(soil) || mpm_material_destroy(material) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: slope_failure.svg\n", directory);
  printf("result: fails at %.3f of gravity, Taylor %.3f; crest sinks by %.2f m, toe goes %.2f m; plastic "
         "strain %.2f\n",
         fails, taylor * cohesion / (density * g * height), sunk, way, plastic);
  return 0;

failed:
  fprintf(stderr, "\nslope_failure: %s\n", mpm_last_error(ctx));
  return 1;
}
