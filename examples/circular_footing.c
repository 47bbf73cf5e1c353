/* A rough circular footing is pressed into clay that shears at constant volume: a body of revolution, in
 * implicit steps.
 *
 *   circular_footing [directory [cells in the radius]]
 *
 * Prints the mean pressure over the strength s_u against the settlement, in steps of a quasi-static run. The
 * collapse load of a rough circular footing on Tresca's material is 6.05 s_u (Eason & Shield 1960). Writes a
 * film strip of the section, coloured by plastic strain, into the directory (circular_footing.svg; default:
 * here).
 *
 * What to expect: 24 cells in the radius, the default, are 20 700 particles and take ten seconds; 12 take
 * one. The pressure at the end is 1.12 and 1.07 of the exact one with 12 and 24 cells: the cell beyond the
 * edge bears a part. */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film.h"

enum { STEPS = 40 };
static const double R = 1.0, s_u = 1.0, E = 500.0, nu = 0.45, exact = 6.05, settlement = 0.06;

/* The footing goes down by equal steps. */
static mpm_status press(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= settlement / STEPS;
  return MPM_OK;
}

/* Takes a frame of where the clay is, and how far it has sheared: the first of its two state variables. */
static int shoot(film *strip, const mpm_particles *clay, double t) {
  const int64_t n = strip->n;
  const int k = film_frame(strip, t);
  double *state = malloc(2 * (size_t)n * sizeof *state);
  int bad = k < 0 || !state || mpm_particles_get(clay, "position", MPM_F64, 2, n, NULL, strip->x[k]) ||
            mpm_particles_get(clay, "state", MPM_F64, 2, n, NULL, state);
  for (int64_t i = 0; i < n && !bad; ++i) strip->value[k][i] = state[i];
  free(state);
  return bad;
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const int cells = argc > 2 ? atoi(argv[2]) : 24;
  if (cells < 4 || cells > 100) {
    fprintf(stderr, "circular_footing: cells in the radius must be 4 to 100\n");
    return 1;
  }
  const double h = R / cells;
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *soil, *steel;
  mpm_particles *clay, *footing;
  mpm_stepper *stepper;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_advance_desc go;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_advance_desc_init(&go, sizeof go))
    goto failed;
  gd.dim = 2;
  gd.geometry = MPM_AXISYMMETRIC;
  gd.basis = MPM_LINEAR;
  for (int k = 0; k < 2; ++k) gd.cells[k] = 3 * cells + 3 * k, gd.spacing[k] = h;
  sd.scheme = MPM_NEWMARK;
  sd.quasi_static = 1;
  sd.locking_remedy = MPM_LOCKING_CELL_AVERAGE; /* clay keeps its volume */

  const mpm_param tresca[] = {{"E", E}, {"nu", nu}, {"density", 1.0}, {"phi", 0.0}, {"cohesion", s_u}};
  const mpm_param rigid[] = {{"density", 1.0}};
  const double low[] = {0.0, 0.0}, high[] = {3.0 * R, 3.0 * R}, under[] = {0.0, 3.0 * R},
               over[] = {R, 3.0 * R + h};
  const int32_t per_cell[] = {2, 2};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "mohr_coulomb", tresca, 5, &soil) ||
      mpm_material_create(ctx, "rigid", rigid, 1, &steel) || mpm_particles_create(ctx, grid, soil, &clay) ||
      mpm_particles_create(ctx, grid, steel, &footing) ||
      mpm_particles_fill_box(clay, low, high, per_cell, NULL, NULL) ||
      mpm_particles_fill_box(footing, under, over, per_cell, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, clay) ||
      mpm_stepper_add(stepper, footing) || mpm_stepper_set_motion(stepper, footing, press, NULL) ||
      mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0))
    goto failed;

  film strip = film_of(mpm_particles_count(clay), 0.5 * h);
  int bad = 0;
  printf("A circular footing on clay, %" PRId64 " particles, %d cells in the radius\n\n"
         " settlement/R   pressure/s_u   over the exact one   iterations\n",
         strip.n, cells);
  mpm_step_info now = {.struct_size = sizeof now};
  double pressure = 0.0;
  for (int k = 1; k <= STEPS && !bad; ++k) {
    double force[2]; /* on the footing, of one radian */
    go.t_end = k;
    if (mpm_advance(stepper, &go, &now) || mpm_stepper_particles_reaction(stepper, footing, force))
      goto failed;
    pressure = 2.0 * -force[1] / (R * R * s_u);
    if (k % 4 == 0)
      printf("%13.4f %14.3f %20.3f %12d\n", k * settlement / STEPS, pressure, pressure / exact,
             (int)now.newton_iterations);
    if (k % (STEPS / 2) == 0) bad = shoot(&strip, clay, now.t);
  }
  char path[1024];
  const film_view view = {
      .x_max = 3.0 * R, .y_max = 3.1 * R, .columns = 2, .panel = 400.0, .value_max = 8.0 * settlement};
  snprintf(path, sizeof path, "%s/circular_footing.svg", directory);
  if (bad || film_draw(&strip, &view, path)) {
    fprintf(stderr, "circular_footing: cannot write into %s\n", directory);
    return 1;
  }
  film_close(&strip);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(clay) || mpm_particles_destroy(footing) ||
      mpm_material_destroy(soil) || mpm_material_destroy(steel) || mpm_grid_destroy(grid) ||
      mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: circular_footing.svg\n", directory);
  printf("result: pressure %.3f s_u, %.3f of the exact one\n", pressure, pressure / exact);
  return 0;

failed:
  fprintf(stderr, "\ncircular_footing: %s\n", mpm_last_error(ctx));
  return 1;
}
