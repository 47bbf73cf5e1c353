/* A velocity pulse in a bar splits in two (d'Alembert); one half returns from the fixed end x = 0, the other
 * from the free end x = L. c = 1. In 3-D the bar has nu = 0.3 and rollers on its sides: uniaxial strain. The
 * law is linear in F - I, for which d'Alembert's solution is exact. */
#include "verify.h"

#include <string.h>

static const double L = 1.0, height = 0.01, width = 0.05, centre = 0.3;

/* Initial velocity, continued beyond the ends: odd about the fixed one, even about the free one. */
static double initial(double x) {
  x = fmod(x, 4.0 * L);
  if (x < 0.0) x += 4.0 * L;
  double sign = 1.0;
  if (x > 2.0 * L) x -= 2.0 * L, sign = -1.0;
  if (x > L) x = 2.0 * L - x;
  const double s = (x - centre) / width;
  const double mirrored = (x + centre) / width;
  return sign * height * (exp(-s * s) - exp(-mirrored * mirrored));
}

/* Hooke's law of small strains, exact for uniaxial strain of any size: the section does not change. */
typedef struct hooke {
  double lambda, mu;
} hooke;

static mpm_status linear_stress(void *user, const mpm_material_batch *b) {
  const hooke *law = user;
  memset(b->stress_new, 0, 6 * (size_t)b->ld * sizeof *b->stress_new);
  for (int64_t i = 0; i < b->n; ++i) {
    double trace = 0.0;
    for (int k = 0; k < 3; ++k) trace += b->F[4 * k * b->ld + i] - 1.0;
    for (int k = 0; k < 3; ++k)
      b->stress_new[k * b->ld + i] = law->lambda * trace + 2.0 * law->mu * (b->F[4 * k * b->ld + i] - 1.0);
    b->wave_speed[i] = 1.0;
  }
  return MPM_OK;
}

typedef struct errors {
  double velocity[3], stress[3];
} errors;
static const double sample[3] = {0.3, 0.4, 1.2}; /* at the fixed end; between the ends; after both returned */

static errors propagate(int dim, int cells, FILE *csv) {
  const double nu = dim == 1 ? 0.0 : 0.3;
  hooke law = {nu / (1.0 - nu), 0.0}; /* lambda + 2 mu = 1 */
  law.mu = 0.5 * (1.0 - law.lambda);
  const double h = L / cells;
  verify_setup setup = verify_defaults(dim, 1, h);
  setup.grid.cells[0] = cells + 3;
  setup.stepper.scheme = MPM_MUSL;
  verify_world w;
  verify_open(&w, &setup);
  mpm_material_desc desc;
  verify_ok(&w, mpm_material_desc_init(&desc, sizeof desc));
  desc.density = 1.0;
  desc.stress = linear_stress;
  desc.user = &law;
  verify_ok(&w, mpm_material_create_custom(w.context, &desc, &w.material[w.materials++]));
  mpm_particles *bar = verify_set(&w, w.material[0]);
  verify_fill_box(&w, bar, (const double[]){0.0, 0.0, 0.0}, (const double[]){L, h, h}, 2);
  const int64_t n = mpm_particles_count(bar);
  double *x = verify_get(&w, bar, "position", dim), *v = verify_get(&w, bar, "velocity", dim);
  for (int64_t i = 0; i < n; ++i) v[i] = initial(x[i]);
  verify_put(&w, bar, "velocity", dim, v);
  free(v);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  for (int32_t face = MPM_Y_MIN; face < 2 * dim; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));

  errors out;
  for (int k = 0; k < 3; ++k) {
    const double t = sample[k];
    verify_advance(&w, 0.4, t);
    v = verify_get(&w, bar, "velocity", dim);
    double *stress = verify_get(&w, bar, "stress", 6), dv = 0.0, vv = 0.0, ds = 0.0, ss = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      const double left = initial(x[i] + t), right = initial(x[i] - t), v_exact = 0.5 * (left + right),
                   s_exact = 0.5 * (left - right);
      dv += (v[i] - v_exact) * (v[i] - v_exact), vv += v_exact * v_exact;
      ds += (stress[i] - s_exact) * (stress[i] - s_exact), ss += s_exact * s_exact;
      if (csv) fprintf(csv, "%.2f,%.6f,%.6e,%.6e,%.6e,%.6e\n", t, x[i], v[i], v_exact, stress[i], s_exact);
    }
    out.velocity[k] = sqrt(dv / vv);
    out.stress[k] = sqrt(ds / ss);
    free(v);
    free(stress);
  }
  free(x);
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("pulse", argc, argv);
  FILE *csv = verify_csv("pulse");
  fprintf(csv, "t,x,v,v_exact,stress,stress_exact\n");
  const errors coarse = propagate(1, 200, csv);
  fclose(csv);
  const char *reason = "ten cells in the half width: dispersion of the lumped mass, see the refinement";
  const errors fine = propagate(1, 400, NULL), finest = propagate(1, 800, NULL);
  csv = verify_csv("pulse_refinement");
  fprintf(csv, "cells,v_0.4,v_1.2,stress_0.3,stress_0.4,stress_1.2\n");
  const errors *const all[3] = {&coarse, &fine, &finest};
  for (int k = 0; k < 3; ++k)
    fprintf(csv, "%d,%.5e,%.5e,%.5e,%.5e,%.5e\n", 200 << k, all[k]->velocity[1], all[k]->velocity[2],
            all[k]->stress[0], all[k]->stress[1], all[k]->stress[2]);
  fclose(csv);
  verify_expected_failure("h = 1/200, t = 0.4: velocity, L2", coarse.velocity[1], 0.0, 0.05,
                          "d'Alembert; set tolerance", reason);
  verify_expected_failure("h = 1/200, t = 1.2: velocity, L2", coarse.velocity[2], 0.0, 0.05,
                          "d'Alembert; set tolerance", reason);
  verify_gate("h = 1/400, t = 0.4: velocity, L2", fine.velocity[1], 0.0, 0.05, "d'Alembert; set tolerance");
  verify_gate("h = 1/800, t = 1.2: velocity, L2", finest.velocity[2], 0.0, 0.05, "d'Alembert; set tolerance");
  verify_gate("h = 1/400, t = 0.3: stress at the fixed end, L2", fine.stress[0], 0.0, 0.05,
              "doubled stress; set tolerance");
  verify_gate("order of the stress, t = 0.4", log2(coarse.stress[1] / finest.stress[1]) / 2.0, 1.7, 2.4,
              "second order of the spatial discretisation");
  if (!verify_quick()) {
    const errors solid = propagate(3, 400, NULL);
    verify_gate("3-D on rollers, nu = 0.3, h = 1/400, t = 0.4: velocity, L2", solid.velocity[1], 0.0, 0.05,
                "speed sqrt(E (1 - nu) / ((1 + nu) (1 - 2 nu) density)); set tolerance");
  }
  return verify_end();
}
