/* The corner of a square hits the face of another, both free: edge 0.6, E = 1000, nu = 0.3, density 1000,
 * speed 0.1, gap 0.02. They touch at 0.2, and nothing pushes them sideways. A thousand times as stiff, nearly
 * rigid, they rub against each other: what contact reports is what each of them feels. */
#include "verify.h"

static void momentum_of(const verify_world *w, int32_t m, double *p) {
  const int64_t n = mpm_particles_count(w->set[m]);
  double *mass = verify_get(w, w->set[m], "mass", 1), *v = verify_get(w, w->set[m], "velocity", 2);
  p[0] = p[1] = 0.0;
  for (int64_t i = 0; i < 2 * n; ++i) p[i / n] += mass[i % n] * v[i];
  free(mass);
  free(v);
}

static void hit(int32_t cells, double shift, int32_t stiff, FILE *table) {
  const double h = 1.0 / cells, half = 0.3, speed = 0.1, gap = 0.02, end = stiff ? 0.5 : 3.0;
  const double E = stiff ? 1e6 : 1e3, aside = stiff ? 0.05 : 0.0; /* aside: speed along the face */
  verify_setup setup = verify_defaults(2, 1, h);
  for (int32_t k = 0; k < 2; ++k) {
    setup.grid.cells[k] = k ? (int64_t)(2.4 * cells) : 2 * cells;
    setup.grid.origin[k] = k ? -1.2 : -1.0;
  }
  verify_world w;
  verify_open(&w, &setup);
  mpm_contact_desc contact;
  verify_ok(&w, mpm_contact_desc_init(&contact, sizeof contact));
  contact.friction = contact.friction_static = stiff ? 0.3 : 0.0;
  verify_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &contact));
  for (int32_t m = 0; m < 2; ++m) {
    const double lower[2] = {-half, -half}, upper[2] = {half, half};
    const double to[2] = {m ? 0.0 : shift * h, m ? -half : half * sqrt(2.0) + gap};
    mpm_particles *square = verify_set(&w, verify_elastic(&w, "neo_hookean", E, 0.3, 1000.0));
    verify_fill_box(&w, square, lower, upper, 2);
    verify_place(&w, square, m ? 0.0 : 0.25 * PI, to);
    verify_ok(&w, mpm_particles_set_all(square, "velocity", MPM_F64, 2,
                                        (const double[]){m ? 0.0 : aside, m ? 0.0 : -speed}));
    verify_ok(&w, mpm_stepper_set_body(w.stepper, square, m));
  }
  mpm_step_info now = verify_info(&w);
  verify_laws laws = verify_laws_begin(&now);
  double touch = -1.0, first[2][2], apart = 0.0;
  for (int32_t m = 0; m < 2; ++m) momentum_of(&w, m, first[m]);
  while (now.t < end) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, end - now.t + 1e-9));
    mpm_contact_info info = {.struct_size = sizeof info};
    verify_ok(&w, mpm_stepper_contact_info(w.stepper, 0, 1, &info));
    if (touch < 0.0 && info.touching) touch = now.t - now.dt;
    verify_laws_see(&laws, &now);
    for (int32_t m = 0; m < 2; ++m) {
      double last[2];
      momentum_of(&w, m, last);
      for (int32_t c = 0; c < 2; ++c)
        apart = fmax(apart, fabs(last[c] - first[m][c] - (m ? 1.0 : -1.0) * info.impulse[c]));
    }
  }
  const int64_t n = mpm_particles_count(w.set[0]);
  double *v = verify_get(&w, w.set[0], "velocity", 2), mean[2] = {0.0, 0.0};
  for (int64_t i = 0; i < 2 * n; ++i) mean[i / n] += v[i] / (speed * (double)n);
  free(v);
  fprintf(table, "%d,%g,%.5f,%.5f,%.5f,%.5f\n", cells, shift, touch, mean[0], mean[1], laws.energy);
  char name[80];
  snprintf(name, sizeof name, "%sh = 1/%d, at %g h", stiff ? "stiff squares that rub, " : "", cells, shift);
  verify_gate_of(name, "they touch (0.2)", touch, 0.2 - 0.1 * h / speed, 0.2 + 0.1 * h / speed,
                 "kinematics; a tenth of h");
  if (!stiff)
    verify_gate_of(name, "speed sideways / speed", fabs(mean[0]), 0.0, 0.01, "symmetry; set tolerance");
  const double all = 1000.0 * 4.0 * half * half * speed;
  verify_gate_of(name, "impulse less change of momentum of each / first", apart / all, 0.0, 1e-11,
                 "action and reaction");
  verify_laws_gates(name, &laws, 1e-11, 1.0005);
  verify_progress("%s", name);
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("contact_corner", argc, argv);
  FILE *table = verify_csv("contact_corner");
  fprintf(table, "cells,shift,touch,sideways,speed,energy\n");
  for (int32_t cells = 20; cells <= (verify_quick() ? 20 : 80); cells *= 2) {
    hit(cells, 0.0, 0, table);
    hit(cells, 0.37, 0, table);
  }
  hit(20, 0.37, 1, table);
  fclose(table);
  return verify_end();
}
