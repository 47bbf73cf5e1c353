/* A strip of two metals, clamped at one end, is heated through its faces and bends: a film brings heat from
 * the air, the strip conducts it, and the metals expand by different amounts. Quasi-static steps with
 * implicit conduction on a total Lagrangian grid.
 *
 *   bimetal [directory]
 *
 * prints temperature and deflection, and writes into the directory (default: here) a picture, bimetal.svg. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "body.h"

enum { METALS = 2, ACROSS = 6, STEPS = 24 };
static const double length = 0.05, height = 0.002, air = 120.0, start = 20.0, E = 120e9, nu = 0.3;
static const double expansion[METALS] = {24e-6, 12e-6};

/* Timoshenko's curvature of two layers alike in height and stiffness, in plane strain. */
static double exact_deflection(double warmer) {
  return 0.5 * length * length * 1.5 * (1.0 + nu) * (expansion[0] - expansion[1]) * warmer / height;
}

static double mean_temperature(mpm_particles *set, int64_t n, double *T) {
  double sum = 0.0;
  if (mpm_particles_get(set, "temperature", MPM_F64, 1, n, NULL, T)) return (double)NAN;
  for (int64_t i = 0; i < n; ++i) sum += T[i];
  return sum / (double)n;
}

/* Where the end of a strip stands, over where it was: by the line through the last two columns of
 * particles. */
static double deflection(const body *b, const double *first) {
  double most = 0.0, second = 0.0, up[2] = {0.0, 0.0};
  for (int64_t i = 0; i < b->n; ++i) most = fmax(most, first[i]);
  for (int64_t i = 0; i < b->n; ++i)
    if (first[i] < most * (1.0 - 1e-9)) second = fmax(second, first[i]);
  for (int64_t i = 0; i < b->n; ++i) {
    const double rise = b->x[b->n + i] - first[b->n + i];
    if (first[i] > most * (1.0 - 1e-9)) up[0] = rise;
    if (fabs(first[i] - second) < 1e-9 * most) up[1] = rise;
  }
  return up[0] + (up[0] - up[1]) * (length - most) / (most - second);
}

int main(int argc, char **argv) {
  const double h = height / ACROSS;
  char path[1024];
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *metal;
  mpm_particles *set[METALS];
  mpm_surface *faces;
  mpm_stepper *stepper;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_surface_desc f;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s) || mpm_surface_desc_init(&f, sizeof f))
    goto failed;
  g.dim = 2;
  g.total_lagrangian = 1;
  g.cells[0] = (int64_t)lround(length / h) + 2;
  g.cells[1] = 3 * ACROSS;
  g.spacing[0] = g.spacing[1] = h;
  s.scheme = MPM_NEWMARK;
  s.quasi_static = 1;
  const mpm_param law[] = {{"E", E}, {"nu", nu}, {"density", 8e3}};
  const int32_t per_cell[] = {2, 2};
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", law, 3, &metal) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_surface_create(ctx, grid, &f, &faces) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0) ||
      mpm_stepper_set_conduction(stepper, MPM_CONDUCTION_IMPLICIT, 1e-10))
    goto failed;

  const double bottom = ACROSS * h;
  body part[METALS];
  for (int m = 0; m < METALS; ++m) {
    const double lower[] = {0.0, bottom + 0.5 * height * m}, upper[] = {length, lower[1] + 0.5 * height};
    mpm_heat_desc heat;
    if (mpm_particles_create(ctx, grid, metal, &set[m]) ||
        mpm_particles_fill_box(set[m], lower, upper, per_cell, NULL, NULL) ||
        mpm_stepper_add(stepper, set[m]) || mpm_heat_desc_init(&heat, sizeof heat))
      goto failed;
    heat.specific_heat = 400.0;
    heat.conductivity = m ? 50.0 : 110.0;
    heat.expansion = expansion[m];
    heat.reference_temperature = start;
    if (mpm_stepper_set_heat(stepper, set[m], &heat) || body_open(&part[m], set[m]) || body_read(&part[m]))
      goto failed;
  }
  /* both faces; a film of 100 W/(m^2 K) */
  const double top[] = {0.0, length, bottom + height, bottom + height},
               below[] = {length, 0.0, bottom, bottom};
  if (mpm_surface_add_polyline(faces, 2, top, 0, h, NULL, NULL) ||
      mpm_surface_add_polyline(faces, 2, below, 0, h, NULL, NULL) ||
      mpm_surface_set_heat(faces, 0.0, 100.0, air) || mpm_stepper_add_surface(stepper, faces))
    goto failed;

  const int64_t n = part[1].n;
  double *first = malloc((size_t)(2 * n) * sizeof *first), *T = malloc((size_t)n * sizeof *T), up = 0.0,
         mean = 0.0;
  if (!first || !T) return 1;
  for (int64_t i = 0; i < 2 * n; ++i) first[i] = part[1].x[i];
  printf("A strip of %.0f by %.0f mm, %lld particles, in air of %.0f degrees\n\n", 1e3 * length, 1e3 * height,
         (long long)(2 * n), air);
  printf(" time/s   temperature   deflection/mm   Timoshenko/mm\n");
  snprintf(path, sizeof path, "%s/bimetal.svg", argc > 1 ? argv[1] : ".");
  FILE *out = svg_open(path, 940, 330);
  for (int k = 0; k <= STEPS; ++k) {
    if (k && mpm_step(stepper, 5.0, NULL)) goto failed;
    if (body_read(&part[0]) || body_read(&part[1])) goto failed;
    mean = mean_temperature(set[1], n, T);
    up = deflection(&part[1], first);
    if (k % 6 == 0)
      printf("%7.0f %13.2f %15.4f %15.4f\n", 5.0 * k, mean, 1e3 * up, 1e3 * exact_deflection(mean - start));
    for (int m = 0; m < METALS && k == STEPS; ++m) {
      const svg_frame panel = {20.0, 40.0, 900.0, 200.0, 0.0, 1.05 * length, bottom - 0.003, bottom + 0.0087};
      double *value = malloc(5 * (size_t)n * sizeof *value);
      if (!value) return 1;
      for (int64_t i = 0; i < n; ++i) {
        value[i] = fabs(part[m].stress[i]) * 1e-6;
        for (int c = 0; c < 2; ++c) {
          value[n + c * n + i] = 0.25 * h * part[m].F[3 * c * n + i];
          value[3 * n + c * n + i] = 0.25 * h * part[m].F[(3 * c + 1) * n + i];
        }
      }
      svg_tiles(out, &panel, n, part[m].x, value + n, value + 3 * n, value, 80.0);
      free(value);
    }
  }
  svg_colour_bar(out, 310.0, 280.0, 320.0, 80.0, "|stress along the strip| / MPa");
  if (svg_close(out)) {
    fprintf(stderr, "bimetal: cannot write %s\n", path);
    return 1;
  }
  mpm_heat_info heat = {.struct_size = sizeof heat};
  if (mpm_stepper_heat_info(stepper, &heat)) goto failed;
  const double missing = fabs(heat.gained_total - heat.surfaces_total) / heat.gained_total;
  for (int m = 0; m < METALS; ++m) body_close(&part[m]);
  free(first);
  free(T);
  if (mpm_stepper_remove_surface(stepper, faces) || mpm_surface_destroy(faces) ||
      mpm_stepper_destroy(stepper) || mpm_particles_destroy(set[0]) || mpm_particles_destroy(set[1]) ||
      mpm_material_destroy(metal) || mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten: %s\nresult: %.2f degrees, of Timoshenko's %.4f, missing in the balance %.1e\n", path,
         mean, up / exact_deflection(mean - start), missing);
  return 0;

failed:
  fprintf(stderr, "bimetal: %s\n", mpm_last_error(ctx));
  return 1;
}
