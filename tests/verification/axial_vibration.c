/* Axial vibration of a bar held at one end (Bardenhagen 2002): L = 25, E = 100, density 1, initial velocity
 * 0.1 sin(beta x), beta = (2 n - 1) pi / (2 L). With quadratic B-splines, lumped masses and FLIP the
 * frequency is low by (beta h)^2 / 4 in the limit of small h, one half from lumping and one from the way
 * of the increments through particles (derived: each is a factor sin(beta h / 2)^3 / (beta h / 2)^3 on
 * the acceleration). */
#include "verify.h"

static const double L = 25.0, E = 100.0, amplitude = 0.1;

typedef struct outcome {
  double period_error; /* relative */
  double drift;        /* of the energy, mean of the last period against that of the first, relative */
} outcome;

static outcome vibrate(int mode, int cells, int scheme, int periods, FILE *csv) {
  const double h = L / cells, beta = (2 * mode - 1) * PI / (2.0 * L), omega = beta * sqrt(E),
               period = 2.0 * PI / omega, dt = 0.2 * h / sqrt(E);
  const double zero = 0.0;
  verify_setup setup = verify_defaults(1, cells + 3, h);
  setup.stepper.scheme = scheme;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *bar = verify_set(&w, verify_elastic(&w, "neo_hookean", E, 0.0, 1.0));
  verify_fill_box(&w, bar, &zero, &L, 2);
  double *x = verify_get(&w, bar, "position", 1);
  for (int64_t i = 0; i < mpm_particles_count(bar); ++i) x[i] = amplitude * sin(beta * x[i]);
  verify_put(&w, bar, "velocity", 1, x);
  free(x);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));

  mpm_step_info now = verify_info(&w);
  const double start = now.kinetic_energy + now.strain_energy;
  double before = now.momentum[0] / L, first = 0.0, last = 0.0, mean[2] = {0.0, 0.0};
  int64_t samples[2] = {0, 0};
  int crossings = 0;
  while (now.t < periods * period) {
    const double t = now.t;
    now = verify_step(&w, dt);
    const double velocity = now.momentum[0] / L;
    if (before * velocity < 0.0) {
      last = t + dt * before / (before - velocity);
      if (crossings++ == 0) first = last;
    }
    const double energy = now.kinetic_energy + now.strain_energy;
    if (now.t < period) mean[0] += energy, ++samples[0];
    if (now.t > (periods - 1) * period) mean[1] += energy, ++samples[1];
    if (csv && now.t < 3.0 * period)
      fprintf(csv, "%.6f,%.8e,%.8e,%.8e\n", now.t, velocity, amplitude / (beta * L) * cos(omega * now.t),
              energy / start);
    before = velocity;
  }
  verify_close(&w);
  return (outcome){2.0 * (last - first) / (crossings - 1) / period - 1.0,
                   mean[1] / (double)samples[1] / (mean[0] / (double)samples[0]) - 1.0};
}

int main(int argc, char **argv) {
  verify_begin("axial_vibration", argc, argv);
  FILE *csv = verify_csv("axial_vibration");
  fprintf(csv, "t,v_mean,v_exact,energy_ratio\n");
  static const int order[] = {VERIFY_MUSL, VERIFY_USF, VERIFY_USL};
  char what[96];
  for (int k = 0; k < 3; ++k) {
    const verify_scheme *by = &verify_schemes[order[k]];
    const outcome o = vibrate(1, 13, by->scheme, 10, k == 0 ? csv : NULL);
    snprintf(what, sizeof what, "mode 1, 13 cells, %s: period error", by->name);
    verify_gate(what, o.period_error, -0.005, 0.005, "Bardenhagen 2002, T = 10; set tolerance");
    snprintf(what, sizeof what, "mode 1, 13 cells, %s: energy drift in 10 periods", by->name);
    verify_gate(what, o.drift, -0.01, 0.01, "set tolerance");
  }
  fclose(csv);

  csv = verify_csv("axial_vibration_refinement");
  fprintf(csv, "cells,period_error,energy_drift\n");
  const int finest = verify_quick() ? 200 : 800;
  double error[8] = {0.0};
  int count = 0;
  for (int cells = 50; cells <= finest; cells *= 2) {
    const outcome o = vibrate(10, cells, MPM_MUSL, 20, NULL);
    error[count++] = o.period_error;
    fprintf(csv, "%d,%.6e,%.6e\n", cells, o.period_error, o.drift);
  }
  fclose(csv);
  verify_expected_failure("mode 10, 50 cells: period error", error[0], -0.005, 0.005, "set tolerance",
                          "10 cells per wave: (beta h)^2 / 4 = 0.089");
  const double kh = 19.0 * PI / (2.0 * 200.0);
  verify_gate("mode 10, 200 cells: period error / ((beta h)^2 / 4)", error[2] / (0.25 * kh * kh), 0.95, 1.05,
              "dispersion of the method, derived");
  if (!verify_quick())
    verify_gate("mode 10, 400 cells: period error", error[3], -0.005, 0.005, "set tolerance");
  verify_gate("mode 10: order of the period, 50 to 200 cells", log2(error[0] / error[2]) / 2.0, 1.7, 2.4,
              "second order of the spatial discretisation");
  return verify_end();
}
