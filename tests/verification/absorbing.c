/* Plane waves leave an elastic block through dashpots on its faces: markers with the traction
 * -rho (c_p n n + c_s (1 - n n)) v (Lysmer & Kuhlemeyer 1969), by the traction callback of a surface. Nothing
 * should be reflected: what is left of the energy tells. Beside it the same block with free faces. */
#include "verify.h"

static const double E = 1.0, nu = 0.25, length = 4.0, width = 0.2;

typedef struct dashpots {
  double along, across; /* rho c_p, rho c_s */
} dashpots;

static mpm_status damp(void *user, const mpm_marker_batch *b, double *add) {
  const dashpots *of = user;
  for (int64_t i = 0; i < b->n; ++i) {
    add[i] -= of->along * b->velocity[i]; /* the faces are across x */
    add[b->ld + i] -= of->across * b->velocity[b->ld + i];
  }
  return MPM_OK;
}

/* Returns the energy that is left after the pulses have had time to leave, over the first. axis: that of the
 * motion. */
static double left_over(int32_t cells, int32_t scheme, int32_t axis, int32_t absorbs, FILE *csv) {
  const double h = 1.0 / cells, first = 10.0 * h, amplitude = 1e-4, middle = first + 0.5 * length;
  verify_setup setup = verify_defaults(2, (int64_t)(length * cells) + 20, h);
  setup.grid.spacing[1] = width;
  setup.grid.cells[1] = 3;
  setup.grid.periodic[1] = 1;
  setup.stepper.scheme = scheme;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "linear_elastic", E, nu, 1.0));
  verify_fill_box(&w, set, (const double[]){first, 0.0}, (const double[]){first + length, 3.0 * width}, 2);
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 2), *v = verify_array(2 * n);
  for (int64_t p = 0; p < n; ++p) v[axis * n + p] = amplitude * exp(-pow((x[p] - middle) / 0.2, 2.0));
  verify_put(&w, set, "velocity", 2, v);
  const double c_p = verify_speed_of_sound(E, nu, 1.0), c_s = sqrt(E / (2.0 * (1.0 + nu)));
  dashpots of = {c_p, c_s};
  mpm_surface *s;
  verify_ok(&w, mpm_surface_create(w.context, w.grid, NULL, &s));
  verify_ok(&w, mpm_surface_set_traction(s, damp, &of));
  verify_ok(&w, mpm_stepper_add_surface(w.stepper, s));
  for (int32_t end = 0; end < 2 && absorbs; ++end)
    for (int32_t k = 0; k < 6; ++k) {
      const double at[] = {first + end * length, (0.25 + 0.5 * k) * width},
                   area[] = {(end ? 0.5 : -0.5) * width, 0.0};
      verify_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
    }
  const double dt = 0.4 * h / c_p, begun = verify_info(&w).kinetic_energy, speed = axis ? c_s : c_p;
  double left = 1.0;
  for (int32_t k = 0; (double)k * dt * speed < 1.2 * length; ++k) {
    const mpm_step_info now = verify_step(&w, dt);
    left = (now.kinetic_energy + now.strain_energy) / begun;
    if (csv && k % 20 == 0)
      fprintf(csv, "%d,%d,%d,%.5f,%.6e\n", (int)axis, (int)absorbs, (int)cells, k * dt * speed / length,
              left);
  }
  free(x);
  free(v);
  verify_ok(&w, mpm_stepper_remove_surface(w.stepper, s));
  verify_ok(&w, mpm_surface_destroy(s));
  verify_close(&w);
  return left;
}

int main(int argc, char **argv) {
  verify_begin("absorbing", argc, argv);
  FILE *csv = verify_csv("absorbing");
  fprintf(csv, "axis,absorbs,cells,t,energy\n");
  static const char *const of[] = {"pressure", "shear"};
  char what[96];
  for (int32_t cells = 20; cells <= (verify_quick() ? 20 : 40); cells *= 2)
    for (int32_t axis = 0; axis < 2; ++axis) {
      snprintf(what, sizeof what, "%s wave, h = 1/%d: energy left over the first", of[axis], (int)cells);
      verify_gate(what, left_over(cells, MPM_USL, axis, 1, csv), 0.0, 1e-3, "exact: 0; set tolerance");
      snprintf(what, sizeof what, "%s wave, h = 1/%d, free faces: energy left", of[axis], (int)cells);
      verify_gate(what, left_over(cells, MPM_USL, axis, 0, csv), 0.9, 1.001, "exact: 1; set tolerance");
    }
  for (int32_t axis = 0; axis < 2; ++axis) {
    const double coarse = left_over(20, MPM_NEWMARK, axis, 1, NULL);
    snprintf(what, sizeof what, "%s wave, implicit, h = 1/20: energy left over the first", of[axis]);
    verify_gate(what, coarse, 0.0, 1e-2, "exact: 0; set tolerance");
    if (verify_quick()) continue;
    snprintf(what, sizeof what, "%s wave, implicit: that of h = 1/40 over that of 1/20", of[axis]);
    verify_gate(what, left_over(40, MPM_NEWMARK, axis, 1, NULL) / coarse, 0.0, 1.0 / 3.0, "second order");
  }
  fclose(csv);
  return verify_end();
}
