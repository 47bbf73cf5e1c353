/* Two elastic disks collide and rebound (Sulsky, Chen and Schreyer 1994): E = 1000, nu = 0.3, density 1000,
 * radius 0.2, speed 0.1 along each axis. By symmetry the contact is that with a frictionless wall; the
 * reference is a finite element solution of that. */
#include "verify.h"

typedef struct outcome {
  double least, when;    /* kinetic energy */
  double rebound, drift; /* speed of a disk at the end; energy, largest relative change */
  double momentum;       /* largest, over that of a disk */
} outcome;

static void write_cloud(const verify_world *w, const mpm_particles *disks, FILE *csv) {
  const int64_t n = mpm_particles_count(disks);
  double *x = verify_get(w, disks, "position", 2), *s = verify_get(w, disks, "stress", 6);
  for (int64_t i = 0; i < n; ++i) {
    const double xx = s[i], yy = s[n + i], zz = s[2 * n + i], xy = s[3 * n + i];
    const double mises =
        sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) + 3.0 * xy * xy);
    fprintf(csv, "%.3f,%.6f,%.6f,%.4f\n", verify_info(w).t, x[i], x[n + i], mises);
  }
  free(x);
  free(s);
}

static outcome collide(int cells, FILE *history, FILE *cloud) {
  const double h = 1.0 / cells, speed = 0.1, mass = 1000.0 * PI * 0.04;
  verify_setup setup = verify_defaults(2, cells + 4, h);
  setup.grid.origin[0] = setup.grid.origin[1] = -2.0 * h;
  setup.stepper.scheme = MPM_MUSL;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *disks = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, 1000.0));
  int64_t half;
  const int32_t two[2] = {2, 2};
  verify_ok(&w, mpm_particles_fill_ball(disks, (const double[]){0.2, 0.2}, 0.2, two, NULL, &half));
  verify_ok(&w, mpm_particles_fill_ball(disks, (const double[]){0.8, 0.8}, 0.2, two, NULL, NULL));
  const int64_t n = mpm_particles_count(disks);
  double *v = verify_array(2 * n);
  for (int64_t i = 0; i < n; ++i) v[i] = v[n + i] = i < half ? speed : -speed;
  verify_put(&w, disks, "velocity", 2, v);
  free(v);

  mpm_step_info now = verify_info(&w);
  const double start = now.kinetic_energy;
  const double due[3] = {0.0, 2.1, 3.6};
  outcome out = {HUGE_VAL, 0.0, 0.0, 0.0, 0.0};
  int drawn = 0;
  double sample = 0.0;
  for (;;) {
    const double energy = now.kinetic_energy + now.strain_energy;
    if (now.kinetic_energy < out.least) out.least = now.kinetic_energy, out.when = now.t;
    out.drift = fmax(out.drift, fabs(energy / start - 1.0));
    out.momentum = fmax(out.momentum, hypot(now.momentum[0], now.momentum[1]) / (mass * speed * sqrt(2.0)));
    if (history && now.t >= sample) {
      fprintf(history, "%.5f,%.6e,%.6e,%.6e\n", now.t, now.kinetic_energy, now.strain_energy, energy);
      sample += 0.02;
    }
    if (cloud && drawn < 3 && now.t >= due[drawn] - 1e-12) write_cloud(&w, disks, cloud), ++drawn;
    if (now.t >= 3.6 - 1e-12) break;
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, 3.6 - now.t));
  }
  v = verify_get(&w, disks, "velocity", 2);
  double mean[2] = {0.0, 0.0};
  for (int c = 0; c < 2; ++c)
    for (int64_t i = 0; i < half; ++i) mean[c] += v[c * n + i] / (double)half;
  out.rebound = hypot(mean[0], mean[1]);
  free(v);
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("two_disks", argc, argv);
  FILE *history = verify_csv("two_disks"), *cloud = verify_csv("two_disks_cloud"),
       *table = verify_csv("two_disks_refinement");
  fprintf(history, "t,kinetic,strain,total\n");
  fprintf(cloud, "t,x,y,mises\n");
  fprintf(table, "cells,kinetic_least,when,rebound,energy_drift,momentum\n");
  const int levels = verify_quick() ? 2 : 3;
  outcome at[3];
  for (int k = 0; k < levels; ++k) {
    at[k] = collide(20 << k, k == 1 ? history : NULL, k == 1 ? cloud : NULL);
    fprintf(table, "%d,%.6f,%.5f,%.6f,%.3e,%.3e\n", 20 << k, at[k].least, at[k].when, at[k].rebound,
            at[k].drift, at[k].momentum);
    verify_progress("h = 1/%d done", 20 << k);
  }
  fclose(history);
  fclose(cloud);
  fclose(table);
  const char *source = "own FEM, 23040 elements; set tolerance";
  for (int k = 0; k < levels; ++k) {
    char what[80];
    snprintf(what, sizeof what, "h = 1/%d: momentum / that of a disk", 20 << k);
    verify_gate(what, at[k].momentum, 0.0, 1e-12, "conservation; set tolerance");
  }
  for (int k = 1; k < levels; ++k) {
    char what[4][80];
    const char *const name[4] = {"energy, largest change", "least kinetic energy (FEM 0.136)",
                                 "time of it (FEM 2.104)", "rebound speed (FEM 0.1286)"};
    for (int i = 0; i < 4; ++i) snprintf(what[i], sizeof what[i], "h = 1/%d: %s", 20 << k, name[i]);
    verify_gate(what[0], at[k].drift, 0.0, 0.02, source);
    verify_gate(what[1], at[k].least, 0.05, 0.2, source);
    verify_gate(what[2], at[k].when, 1.98, 2.13, source);
    verify_gate(what[3], at[k].rebound, 0.1286 * 0.96, 0.1286 * 1.04, source);
  }
  return verify_end();
}
