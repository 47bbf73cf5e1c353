/* Four elastic discs in a row, R = 0.5, E = density = 1, nu = 0.3; the first flies at 0.02 into the
 * others, which touch. The last takes most of the momentum. */
#include "discs.h"

enum { DISCS = 4 };

static void fly(int32_t cells, double least_last, FILE *table) {
  const double h = 1.0 / cells, speed = 0.02, end = 60.0;
  verify_setup setup = verify_defaults(2, 1, h);
  setup.grid.cells[0] = 7 * cells;
  setup.grid.cells[1] = 2 * cells;
  setup.grid.origin[0] = setup.grid.origin[1] = -1.0;
  verify_world w;
  verify_open(&w, &setup);
  mpm_contact_desc contact;
  verify_ok(&w, mpm_contact_desc_init(&contact, sizeof contact));
  verify_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &contact));
  for (int32_t m = 0; m < DISCS; ++m) {
    const double centre[2] = {0.5 + m + 0.3 * h, 0.013}, v[2] = {m ? 0.0 : speed, 0.0};
    mpm_particles *disc = verify_set(&w, verify_elastic(&w, "neo_hookean", 1.0, 0.3, 1.0));
    disc_fill(&w, disc, centre, 0.5, v, 0.5 * h);
    verify_ok(&w, mpm_stepper_set_body(w.stepper, disc, m));
  }
  mpm_step_info now = verify_info(&w);
  verify_laws laws = verify_laws_begin(&now);
  double share[DISCS], sideways = 0.0, show = 0.0;
  while (now.t < end) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, end - now.t + 1e-9));
    verify_laws_see(&laws, &now);
    if (now.t < show) continue;
    show += 0.5;
    fprintf(table, "%d,%.3f", cells, now.t);
    for (int32_t m = 0; m < DISCS; ++m) {
      double across;
      disc_spin(&w, w.set[m], (const double[]){1.0, 0.0}, &share[m]);
      disc_spin(&w, w.set[m], (const double[]){0.0, 1.0}, &across);
      share[m] /= speed;
      sideways = fmax(sideways, fabs(across) / speed);
      fprintf(table, ",%.5f", share[m]);
    }
    fprintf(table, "\n");
  }
  char name[40];
  snprintf(name, sizeof name, "h = 1/%d", cells);
  verify_gate_of(name, "speed of the last / first speed of the first", share[3], least_last, 1.0,
                 "a chain of rebounds; set tolerance");
  verify_laws_gates(name, &laws, 1e-11, 1.0005);
  verify_gate_of(name, "largest speed across / first speed", sideways, 0.0, 0.005, "symmetry; set tolerance");
  verify_progress("%s", name);
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("contact_row", argc, argv);
  FILE *table = verify_csv("contact_row");
  fprintf(table, "cells,t,first,second,third,last\n");
  fly(10, 0.86, table);
  if (!verify_quick()) fly(20, 0.92, table);
  fclose(table);
  return verify_end();
}
