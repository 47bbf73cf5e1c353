/* Three elastic blocks on each other on a rigid floor: E = 1e6, nu = 0.3, density 1000, g = 10, 0.4 high,
 * 0.6, 0.5 and 0.4 wide, friction 0.3. They settle under damping and then rest for 20 000 steps. */
#include "support.h"

enum { BLOCKS = 3 };
static const double h = 0.05, gravity = 10.0, height = 0.4, density = 1000.0, half[BLOCKS] = {0.3, 0.25, 0.2};

static void centres(const verify_world *w, double *x) {
  for (int32_t m = 0; m < BLOCKS; ++m) {
    const int64_t n = mpm_particles_count(w->set[m]);
    double *at = verify_get(w, w->set[m], "position", 2);
    x[2 * m] = x[2 * m + 1] = 0.0;
    for (int64_t i = 0; i < n; ++i)
      for (int32_t c = 0; c < 2; ++c) x[2 * m + c] += at[c * n + i] / (double)n;
    free(at);
  }
}

static void damp(const verify_world *w, double by) {
  for (int32_t m = 0; m < BLOCKS; ++m) {
    const int64_t n = mpm_particles_count(w->set[m]);
    double *v = verify_get(w, w->set[m], "velocity", 2);
    for (int64_t i = 0; i < 2 * n; ++i) v[i] *= by;
    verify_put(w, w->set[m], "velocity", 2, v);
    free(v);
  }
}

static double advance(const verify_world *w) {
  double dt;
  verify_ok(w, mpm_stable_dt(w->stepper, &dt));
  return verify_step(w, 0.4 * dt).kinetic_energy;
}

static void rest(int32_t kind, FILE *table) {
  const int64_t settling = 2000, resting = verify_quick() ? 2000 : 20000;
  const double lift[2] = {0.0, 0.3 * h};
  verify_setup setup = verify_defaults(2, 40, h);
  setup.grid.origin[0] = -20.0 * h;
  setup.grid.origin[1] = -8.0 * h;
  setup.stepper.gravity[1] = -gravity;
  verify_world w;
  verify_open(&w, &setup);
  double weight = 0.0, potential = 0.0;
  for (int32_t m = 0; m < BLOCKS; ++m) {
    mpm_particles *block = verify_set(&w, verify_elastic(&w, "neo_hookean", 1e6, 0.3, density));
    verify_fill_box(&w, block, (const double[]){-half[m], height * m},
                    (const double[]){half[m], height * (m + 1)}, 2);
    verify_place(&w, block, 0.0, lift);
    verify_ok(&w, mpm_stepper_set_body(w.stepper, block, m ? m + 1 : 0)); /* body 1 is the floor */
    weight += 2.0 * half[m] * height * density * gravity;
    potential += 2.0 * half[m] * height * density * gravity * height * (m + 0.5);
  }
  mpm_contact_desc contact;
  verify_ok(&w, mpm_contact_desc_init(&contact, sizeof contact));
  contact.friction = 0.3;
  verify_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &contact));
  if (kind == ON_BODY) {
    mpm_particles *ground = verify_set(&w, w.material[0]);
    verify_fill_box(&w, ground, (const double[]){-0.5, -4.0 * h}, (const double[]){0.5, 0.0}, 2);
    verify_place(&w, ground, 0.0, lift);
    verify_ok(&w, mpm_particles_set_all(ground, "prescribed", MPM_U8, 2, (const uint8_t[]){1, 1}));
    verify_ok(&w, mpm_stepper_set_body(w.stepper, ground, 1));
  }
  support on = {.kind = kind};
  support_lay(&w, &on, contact.friction, 0.0, lift);
  for (int64_t i = 0; i < settling; ++i) {
    advance(&w);
    damp(&w, i < settling * 4 / 5 ? 0.99 : 0.95);
  }
  verify_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));
  const char *name = kind == ON_BODY ? "on a body" : "on a plane";
  double before[2 * BLOCKS], after[2 * BLOCKS], kinetic = 0.0, drift = 0.0, least = 0.0;
  centres(&w, before);
  for (int64_t i = 1; i <= resting; ++i) {
    const double energy = advance(&w);
    kinetic = fmax(kinetic, energy);
    const mpm_step_info now = verify_info(&w);
    least = fmin(least, now.contact_dissipation);
    if (i % (resting / 100)) continue;
    centres(&w, after);
    drift = 0.0;
    for (int32_t c = 0; c < 2 * BLOCKS; ++c) drift = fmax(drift, fabs(after[c] - before[c]));
    fprintf(table, "%s,%.4f,%.3e,%.3e\n", name, now.t, energy / potential, drift / (BLOCKS * height));
  }
  const mpm_contact_info info = support_info(&w, &on);
  const double force = info.impulse[1] / (weight * verify_info(&w).t);
  const char *source = "rest; set tolerance";
  verify_gate_of(name, "largest kinetic energy / that of gravity", kinetic / potential, 0.0, 1e-6, source);
  verify_gate_of(name, "drift of a block / height of the stack", drift / (BLOCKS * height), 0.0, 1e-4,
                 source);
  verify_gate_of(name, "mean force of the floor / weight", force, 0.999, 1.001, "the weight; set tolerance");
  verify_gate_of(name, "least dissipation of a step / energy", least / potential, -1e-12, 0.0,
                 "contact takes energy and never gives any");
  verify_progress("%s", name);
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("contact_stack", argc, argv);
  FILE *table = verify_csv("contact_stack");
  fprintf(table, "floor,t,kinetic,drift\n");
  rest(ON_BODY, table);
  rest(ON_PLANE, table);
  fclose(table);
  return verify_end();
}
