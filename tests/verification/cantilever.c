/* A neo-Hookean cantilever, 4 x 1 m, bends under gravity that acts at once (the case of the CPDI paper): E =
 * 1e6, nu = 0.3, density 1050, g = 10, plane strain. Gate: the path of the lower corner of the tip until it
 * nears the plane of the clamp, against a finite element solution. */
#include "verify.h"

enum { TIMES = 10 };
/* Own FEM, 6400 elements: lower right corner at t = 0.1, 0.2 ... 1.0. */
static const double reference[TIMES] = {-0.0501, -0.1996, -0.5069, -1.0136, -1.5827,
                                        -2.1016, -2.5199, -2.8862, -3.1632, -3.2879};

typedef struct outcome {
  double displacement[TIMES], worst; /* relative error, largest for t <= 0.9 */
} outcome;

static outcome bend(int per_metre, int per_cell, FILE *csv, FILE *cloud) {
  const double h = 1.0 / per_metre, bottom = 5.0;
  verify_setup setup = verify_defaults(2, 0, h);
  setup.grid.cells[0] = 5 * per_metre;
  setup.grid.cells[1] = 8 * per_metre;
  setup.stepper.scheme = MPM_MUSL;
  setup.stepper.gravity[1] = -10.0;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *beam = verify_set(&w, verify_elastic(&w, "neo_hookean", 1e6, 0.3, 1050.0));
  verify_fill_box(&w, beam, (const double[]){0.0, bottom}, (const double[]){4.0, bottom + 1.0}, per_cell);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  const int64_t n = mpm_particles_count(beam);
  double *x = verify_get(&w, beam, "position", 2);
  int64_t tip = 0; /* the particle in the corner */
  for (int64_t i = 0; i < n; ++i)
    if (x[i] - x[n + i] > x[tip] - x[n + tip]) tip = i;
  const double offset[2] = {4.0 - x[tip], bottom - x[n + tip]};
  free(x);
  outcome out = {.worst = 0.0};
  for (int k = 0; k < TIMES; ++k) {
    verify_advance(&w, 0.4, 0.1 * (k + 1));
    x = verify_get(&w, beam, "position", 2);
    double *F = verify_get(&w, beam, "deformation_gradient", 9);
    out.displacement[k] = x[n + tip] + F[3 * n + tip] * offset[0] + F[4 * n + tip] * offset[1] - bottom;
    const double error = out.displacement[k] / reference[k] - 1.0;
    if (k < 9) out.worst = fmax(out.worst, fabs(error));
    fprintf(csv, "%d,%d,%.1f,%.6f,%.4f\n", per_metre, per_cell, 0.1 * (k + 1), out.displacement[k],
            reference[k]);
    if (cloud && (k == 2 || k == 4 || k == 9)) {
      double *v = verify_get(&w, beam, "velocity", 2);
      for (int64_t i = 0; i < n; ++i)
        fprintf(cloud, "%.1f,%.5f,%.5f,%.4f\n", 0.1 * (k + 1), x[i], x[n + i] - bottom,
                hypot(v[i], v[n + i]));
      free(v);
    }
    free(x);
    free(F);
  }
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("cantilever", argc, argv);
  FILE *csv = verify_csv("cantilever"), *cloud = verify_csv("cantilever_cloud");
  fprintf(csv, "cells_per_metre,per_cell,t,displacement,fem\n");
  fprintf(cloud, "t,x,y,speed\n");
  const outcome coarse = bend(4, 2, csv, NULL), middle = bend(8, 2, csv, cloud);
  const char *source = "own FEM, 6400 elements; set tolerance";
  verify_gate("h = 1/4: corner at t = 0.5 over FEM", coarse.displacement[4] / reference[4], 0.96, 1.04,
              source);
  verify_gate("h = 1/8: corner, largest relative error, t <= 0.9", middle.worst, 0.0, 0.04, source);
  if (!verify_quick()) {
    const outcome fine = bend(16, 4, csv, NULL), sparse = bend(16, 2, csv, NULL);
    verify_gate("h = 1/16, 4 x 4 per cell: corner, largest relative error, t <= 0.9", fine.worst, 0.0, 0.04,
                source);
    verify_gate("h = 1/16, 4 x 4 per cell: corner at t = 1 over FEM", fine.displacement[9] / reference[9],
                0.98, 1.02, source);
    verify_expected_failure("h = 1/16, 2 x 2 per cell: corner at t = 1 over FEM",
                            sparse.displacement[9] / reference[9], 0.98, 1.02, source,
                            "stretch of 2 at the corner of the clamp, where 2 x 2 particles are too few");
  }
  fclose(csv);
  fclose(cloud);
  return verify_end();
}
