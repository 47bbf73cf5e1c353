/* A thick cylinder of von Mises' perfect plasticity (a = 100, b = 200 mm, E = 210 GPa, nu = 0.3, yield stress
 * 240 MPa, plane strain) under inner pressure, in quasi-static steps. It yields first where Lame's stresses
 * say so, and no pressure above (2 / sqrt 3) yield ln (b / a) = 192.09 MPa finds equilibrium. */
#include "ring.h"

static const double a = 100.0, b = 200.0, E = 210e3, nu = 0.3, yield = 240.0; /* mm, MPa */

enum { FRONTS = 3, MOST_STEPS = 200 };

typedef struct outcome {
  double first, front[FRONTS], limit,
      outer; /* all over the exact ones; outer: displacement, front at 140 mm */
} outcome;

/* Pressure at which Lame's stresses at a radius are von Mises' yield stress. */
static double first_yield(double r) {
  const double q = a * a / (b * b - a * a), radial = q * (1.0 - b * b / (r * r)),
               hoop = q * (1.0 + b * b / (r * r));
  const double along = nu * (radial + hoop), x = radial - hoop, y = hoop - along, z = along - radial;
  return yield / sqrt(0.5 * (x * x + y * y + z * z));
}

/* Pressure at which the plastic zone ends at a radius; at b no more can be borne. */
static double front_pressure(double r) {
  return yield / sqrt(3.0) * (2.0 * log(r / a) + 1.0 - r * r / (b * b));
}

/* Where half of the particles of a layer have yielded. */
static int has_yielded(const verify_world *w, const ring *r, int32_t layer) {
  double *state = verify_get(w, r->set, "state", 1);
  int32_t count = 0;
  for (int64_t i = (int64_t)layer * r->along; i < (int64_t)(layer + 1) * r->along; ++i)
    count += state[i] > 0.0;
  free(state);
  return 2 * count >= r->along;
}

static outcome load(int32_t basis, int32_t per_a, int32_t remedy, FILE *csv) {
  verify_setup setup = verify_defaults(2, 9 * per_a / 4, a / per_a);
  setup.grid.basis = basis;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  setup.stepper.locking_remedy = remedy;
  verify_world w;
  verify_open(&w, &setup);
  ring r = {a, b, 3 * per_a, 7 * per_a, NULL, 1.0};
  const mpm_param params[] = {
      {"E", E}, {"nu", nu}, {"density", 1.0}, {"yield_stress", yield}, {"hardening", 0.0}};
  r.set = verify_set(&w, verify_material(&w, "j2", params, 5));
  ring_open(&w, &r);
  outcome is = {0.0, {0.0, 0.0, 0.0}, 0.0, 0.0};
  const double at140 = front_pressure(140.0);
  double dp = 2.0, p = 0.0, u = 0.0;
  while (dp > 0.2 && p < 1.3 * front_pressure(b)) {
    mpm_step_info info = {.struct_size = sizeof info};
    if (mpm_step(w.stepper, dp, &info)) {
      dp *= 0.5;
      continue;
    }
    const double before = p, u_before = u;
    p = info.t;
    u = ring_displacement(&w, &r, r.layers - 1);
    if (is.first == 0.0 && has_yielded(&w, &r, 0)) is.first = p / first_yield(ring_radius(&r, 0));
    for (int32_t k = 0; k < FRONTS; ++k) {
      const int32_t layer = (k + 1) * r.layers / 5;
      if (is.front[k] == 0.0 && has_yielded(&w, &r, layer))
        is.front[k] = p / front_pressure(ring_radius(&r, layer));
    }
    if (p >= at140 && before < at140)
      is.outer = (u_before + (u - u_before) * (at140 - before) / (p - before)) / 0.1177;
    fprintf(csv, "%d,%d,%d,%.4f,%.6e,%d\n", (int)basis, (int)per_a, (int)remedy, p, u,
            (int)info.newton_iterations);
  }
  is.limit = p / front_pressure(b);
  verify_close(&w);
  return is;
}

static void gates(const char *name, int32_t basis, int32_t per_a, int32_t remedy, FILE *csv) {
  const outcome is = load(basis, per_a, remedy, csv);
  const char *source = "closed form; set tolerance";
  char what[96];
  const int plain = basis == MPM_LINEAR && !remedy, coarse = basis == MPM_BSPLINE2 && remedy && per_a < 16;
  snprintf(what, sizeof what, "%s, h = a/%d: limit pressure over exact", name, (int)per_a);
  if (per_a == 4 && plain)
    verify_expected_failure(what, is.limit, 0.97, 1.03, source,
                            "volumetric locking of plastic flow; it goes with h");
  else
    verify_gate(what, is.limit, 0.97, 1.03, source);
  if (plain || (coarse && per_a == 4)) return;
  for (int32_t k = 0; k < FRONTS; ++k) {
    snprintf(what, sizeof what, "%s, h = a/%d: pressure with the front near %d mm over exact", name,
             (int)per_a, (int)a + 20 * (k + 1));
    verify_gate(what, is.front[k], 0.97, 1.03, source);
  }
  snprintf(what, sizeof what, "%s, h = a/%d: u(b) with the front at 140 mm over exact", name, (int)per_a);
  source = "the same, incompressible where plastic: hence 5 %";
  verify_gate(what, is.outer, 0.95, 1.05, source);
  if (per_a < 16) return;
  snprintf(what, sizeof what, "%s, h = a/%d: pressure at first yield over exact", name, (int)per_a);
  verify_expected_failure(
      what, is.first, 0.97, 1.03, "Lame and von Mises; set tolerance",
      "the inner layers of particles bear the load, and stress is not smooth within a cell of it");
}

int main(int argc, char **argv) {
  verify_begin("plastic_cylinder", argc, argv);
  FILE *csv = verify_csv("plastic_cylinder");
  fprintf(csv, "basis,cells,remedy,p,u,iterations\n");
  gates("linear, plain", MPM_LINEAR, 4, 0, csv);
  gates("linear, remedy", MPM_LINEAR, 4, 1, csv);
  if (!verify_quick()) {
    gates("linear, plain", MPM_LINEAR, 16, 0, csv);
    for (int32_t per_a = 4; per_a <= 16; per_a *= 2) gates("quadratic, remedy", MPM_BSPLINE2, per_a, 1, csv);
    for (int32_t per_a = 8; per_a <= 16; per_a *= 2) {
      gates("linear, remedy", MPM_LINEAR, per_a, 1, csv);
      gates("quadratic, plain", MPM_BSPLINE2, per_a, 0, csv);
    }
  }
  fclose(csv);
  return verify_end();
}
