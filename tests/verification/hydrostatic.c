/* A column of fluid at rest: H = 1, density 1000, g = 9.81, speed of sound 20 sqrt(g H). It starts without
 * pressure and settles under a drag of particles. Exact: p = density g (H - y), less what the compression of
 * the column adds (1 / 800). */
#include "verify.h"

static const double H = 1.0, density = 1000.0, g = 9.81, drag = 100.0;

static mpm_status resist(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int c = 0; c < 2; ++c)
    for (int64_t i = 0; i < b->n; ++i) add[c * b->ld + i] -= drag * b->velocity[c * b->ld + i];
  return MPM_OK;
}

typedef struct outcome {
  double middle, whole; /* mean pressure of the cells about H / 2 over the exact one; relative L2 error */
} outcome;

static outcome settle(int cells, FILE *csv) {
  const double h = H / cells, bulk = density * 400.0 * g * H;
  verify_setup setup = verify_defaults(2, 4, h);
  setup.grid.cells[1] = cells + 2;
  setup.stepper.gravity[1] = -g;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param water[] = {{"density", density}, {"bulk_modulus", bulk}};
  mpm_particles *column = verify_set(&w, verify_material(&w, "newtonian_fluid", water, 2));
  verify_fill_box(&w, column, (const double[]){0.0, 0.0}, (const double[]){4.0 * h, H}, 2);
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, resist, NULL));
  verify_advance(&w, 0.4, 0.5);
  const int64_t n = mpm_particles_count(column);
  double *y = verify_get(&w, column, "position", 2) + n, *s = verify_get(&w, column, "stress", 6);
  double sum = 0.0, exact = 0.0, error = 0.0, square = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    const double p = -s[n + i], due = density * g * (H - y[i]);
    error += (p - due) * (p - due), square += due * due;
    if (fabs(y[i] - 0.5 * H) < h) sum += p, exact += due;
    if (csv) fprintf(csv, "%.6f,%.4f,%.4f\n", y[i], p, due);
  }
  free(y - n);
  free(s);
  verify_close(&w);
  return (outcome){sum / exact, sqrt(error / square)};
}

int main(int argc, char **argv) {
  verify_begin("hydrostatic", argc, argv);
  FILE *csv = verify_csv("hydrostatic"), *table = verify_csv("hydrostatic_refinement");
  fprintf(csv, "y,p,p_exact\n");
  fprintf(table, "cells,middle,error\n");
  const int levels = verify_quick() ? 2 : 3;
  outcome at[3];
  for (int k = 0; k < levels; ++k) {
    at[k] = settle(10 << k, k == 1 ? csv : NULL);
    fprintf(table, "%d,%.6f,%.5e\n", 10 << k, at[k].middle, at[k].whole);
  }
  fclose(csv);
  fclose(table);
  verify_gate("20 cells: pressure at half depth over exact", at[1].middle, 0.98, 1.02, "set tolerance");
  verify_gate("20 cells: pressure, relative L2 error over the column", at[1].whole, 0.0, 0.02,
              "set tolerance");
  return verify_end();
}
