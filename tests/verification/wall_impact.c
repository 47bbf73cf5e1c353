/* A bar flies against a rigid wall (St Venant): L = 1, E = density = 1, speed 0.01. The wall feels density c
 * v for 2 L / c, then the bar leaves with its speed. */
#include "verify.h"

static const double L = 1.0, speed = 0.01;

typedef struct outcome {
  double stress, duration, rebound; /* over the exact ones */
} outcome;

static outcome impact(int cells, FILE *csv) {
  const double h = L / cells, dt = 0.4 * h, zero = 0.0, v = -speed;
  verify_setup setup = verify_defaults(1, cells + 4, h);
  setup.stepper.scheme = MPM_MUSL;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *bar = verify_set(&w, verify_elastic(&w, "neo_hookean", 1.0, 0.0, 1.0));
  verify_fill_box(&w, bar, &zero, &L, 2);
  verify_ok(&w, mpm_particles_set_all(bar, "velocity", MPM_F64, 1, &v));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FRICTION, 0.0));
  mpm_step_info now = verify_info(&w);
  double mean = 0.0, on = -1.0, off = 0.0;
  int64_t samples = 0;
  while (now.t < 3.0) {
    now = verify_step(&w, dt);
    const double t = now.t;
    double force;
    verify_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, &force));
    if (t > 0.2 && t < 1.8) mean += force, ++samples;
    if (force > 0.5 * speed) {
      off = t;
      if (on < 0.0) on = t - dt;
    }
    if (csv) fprintf(csv, "%.5f,%.6e,%.6e\n", t, force, now.momentum[0] / L);
  }
  const outcome out = {mean / (double)samples / speed, (off - on) / (2.0 * L), now.momentum[0] / (L * speed)};
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("wall_impact", argc, argv);
  FILE *csv = verify_csv("wall_impact"), *table = verify_csv("wall_impact_refinement");
  fprintf(csv, "t,force,v_mean\n");
  fprintf(table, "cells,stress,duration,rebound\n");
  outcome at[4];
  for (int k = 0; k < 4; ++k) {
    at[k] = impact(50 << k, k == 2 ? csv : NULL);
    fprintf(table, "%d,%.6f,%.6f,%.6f\n", 50 << k, at[k].stress, at[k].duration, at[k].rebound);
  }
  fclose(csv);
  fclose(table);
  verify_gate("200 cells: mean wall stress / (density c v)", at[2].stress, 0.98, 1.02,
              "St Venant; set tolerance");
  verify_gate("200 cells: duration / (2 L / c)", at[2].duration, 0.98, 1.02, "St Venant; set tolerance");
  verify_expected_failure("50 cells: rebound / speed", at[0].rebound, 0.98, 1.02, "St Venant; set tolerance",
                          "the front spreads over some cells, whose energy stays as vibration");
  verify_gate("200 cells: rebound / speed", at[2].rebound, 0.98, 1.02, "St Venant; set tolerance");
  return verify_end();
}
