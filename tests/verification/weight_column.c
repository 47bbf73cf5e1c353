/* A column of 50 m (E = 1e6, nu = 0, density 80) under its weight (g = 10), put on in 20 quasi-static steps:
 * AMPLE (Coombs & Augarde 2020). In uniaxial strain without lateral stress the nominal stress is the true
 * one, so that stress = -density g (L - Y) exactly, with Y where the particle was at first. */
#include "verify.h"

enum { BASES = 5, SIZES = 9, PER_CELL = 2 };
static const double E = 1e6, density = 80.0, g = 10.0, L = 50.0;

/* t: share of the weight. */
static mpm_status weigh(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[i] -= g * b->t;
  return MPM_OK;
}

/* Stresses by id, and AMPLE's measure of their error, sum |stress - exact| V0 / (density g L V). */
static double *load(int32_t basis, int32_t cells, int steps, double *error, FILE *profile) {
  verify_setup setup = verify_defaults(1, cells, L / cells);
  setup.grid.basis = basis;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *column = verify_set(&w, verify_elastic(&w, "neo_hookean", E, 0.0, density));
  verify_fill_box(&w, column, (const double[]){0.0}, (const double[]){L}, PER_CELL);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, weigh, NULL));
  double *Y = verify_get(&w, column, "position", 1);
  for (int k = 0; k < steps; ++k) verify_step(&w, 1.0 / steps);
  const int64_t n = mpm_particles_count(column);
  double *stress = verify_get(&w, column, "stress", 6);
  *error = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    const double exact = -density * g * (L - Y[i]);
    *error += fabs(stress[i] - exact) / ((double)n * density * g * L);
    if (profile) fprintf(profile, "%d,%.4f,%.4f,%.4f\n", (int)basis, Y[i], stress[i], exact);
  }
  free(Y);
  verify_close(&w);
  return stress;
}

static double load_error(int32_t basis, int32_t cells, FILE *profile) {
  double error;
  free(load(basis, cells, 20, &error, profile));
  return error;
}

/* Mean change of the stress, over density g L, from 20 steps to 80. */
static double drift(int32_t basis) {
  double error, sum = 0.0, *coarse = load(basis, 64, 20, &error, NULL),
                *fine = load(basis, 64, 80, &error, NULL);
  for (int32_t i = 0; i < 64 * PER_CELL; ++i)
    sum += fabs(fine[i] - coarse[i]) / (64 * PER_CELL * density * g * L);
  free(coarse), free(fine);
  return sum;
}

int main(int argc, char **argv) {
  verify_begin("weight_column", argc, argv);
  static const struct {
    const char *name;
    int32_t basis, last; /* of the sizes up to which the order is taken */
  } list[BASES] = {{"linear", MPM_LINEAR, 8},
                   {"GIMP", MPM_GIMP, 4},
                   {"cpGIMP", MPM_CPGIMP, 7},
                   {"quadratic", MPM_BSPLINE2, 3},
                   {"cubic", MPM_BSPLINE3, 7}};
  FILE *csv = verify_csv("weight_column"), *profile = verify_csv("weight_column_profile");
  double h[SIZES], error[BASES][SIZES];
  char what[80];
  fprintf(profile, "basis,Y,stress,exact\n");
  fputs("cells", csv);
  for (int i = 0; i < BASES; ++i) fprintf(csv, ",%s", list[i].name);
  for (int k = 0; k < SIZES; ++k) {
    h[k] = L / (4 << k);
    fprintf(csv, "\n%d", 4 << k);
    for (int i = 0; i < BASES; ++i) {
      error[i][k] = load_error(list[i].basis, 4 << k, k == 4 ? profile : NULL);
      fprintf(csv, ",%.6g", error[i][k]);
    }
  }
  fputc('\n', csv);
  const char *source = "Coombs & Augarde 2020 have first order with GIMP; set tolerance";
  const char *smooth = "smooth bases drift by 1 % at most";
  for (int i = 0; i < BASES; ++i) {
    snprintf(what, sizeof what, "order, %s, 4 to %d cells", list[i].name, 4 << list[i].last);
    const double order = verify_slope(list[i].last + 1, h, error[i]);
    if (list[i].basis == MPM_LINEAR)
      verify_expected_failure(
          what, order, 0.9, 2.6, source,
          "particles cross cells, and each crossing leaves an error of the size of the stress");
    else
      verify_gate(what, order, 0.9, 2.6, source);
  }
  verify_gate("linear does not converge: error at 1024 over 16 cells", error[0][8] / error[0][2], 0.5,
              HUGE_VAL, "set tolerance");
  verify_gate("plateau, GIMP: error at 1024 over 128 cells", error[1][8] / error[1][5], 0.5, HUGE_VAL,
              "domains keep their first size, which the strain of 4 % does not");
  verify_gate("error, cpGIMP, 64 cells", error[2][4], 0.0, 1e-3, "judgement: 0.1 % of the largest stress");
  verify_gate("error, quadratic, 64 cells", error[3][4], 0.0, 1e-3, "judgement: 0.1 % of the largest stress");
  verify_gate("error, cubic, 64 cells", error[4][4], 0.0, 1e-3, "judgement: 0.1 % of the largest stress");
  for (int i = 0; i < BASES; ++i) {
    snprintf(what, sizeof what, "%s, 64 cells: mean change of stress from 20 to 80 steps", list[i].name);
    if (list[i].basis == MPM_LINEAR)
      verify_expected_failure(what, drift(list[i].basis), 0.0, 0.01, smooth,
                              "each step forgets the stress that the basis cannot hold");
    else
      verify_gate(what, drift(list[i].basis), 0.0, 0.01, smooth);
  }
  fclose(csv);
  fclose(profile);
  return verify_end();
}
