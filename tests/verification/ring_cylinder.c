/* The thick elastic cylinder of the case thick_cylinder as a body of revolution: a = 1, b = 2, E = 1,
 * nu = 0.3, without strain along the axis; quasi-static, with two particles per cell and the inner pressure
 * of E / 1e6 on markers. On a grid whose nodes lie on the faces, and on one that is shifted by .37 h. */
#include "verify.h"

static const double a = 1.0, b = 2.0, E = 1.0, nu = 0.3, p = 1e-6;

/* Relative errors of the displacement of the faces; rms of those of stress over p. */
typedef struct outcome {
  double inner, outer, radial, hoop;
  int32_t iterations;
} outcome;

static double displacement(double r) {
  return (1.0 + nu) * p * a * a / (E * (b * b - a * a)) * ((1.0 - 2.0 * nu) * r + b * b / r);
}

typedef struct method {
  const char *name;
  int32_t basis, remedy;
} method;

static mpm_status in_wall(void *user, int32_t dim, int64_t n, int64_t ld, const double *x, uint8_t *inside) {
  (void)user;
  (void)dim;
  (void)ld;
  for (int64_t i = 0; i < n; ++i) inside[i] = x[i] > a && x[i] < b;
  return MPM_OK;
}

/* Places the particles of the wall, whose faces need not lie on nodes. */
static void fill_wall(const verify_world *w, mpm_particles *set, double h, double shift) {
  const double low[] = {0.0, 0.0}, high[] = {b + 2.0 * h, 4.0 * h};
  if (!(shift > 0.0)) {
    verify_ok(w, mpm_particles_fill(set, low, high, (const int32_t[]){2, 2}, in_wall, NULL, NULL, NULL));
    return;
  }
  const int32_t layers = (int32_t)lround(2.0 * (b - a) / h);
  for (int32_t i = 0; i < layers; ++i)
    for (int32_t k = 0; k < 8; ++k) {
      const double x[] = {a + (i + 0.5) * 0.5 * h, (k + 0.5) * 0.5 * h}, volume = 0.25 * h * h * x[0];
      verify_ok(w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
    }
}

static outcome load(const method *how, int32_t per_unit, double shift, FILE *csv) {
  const double h = 1.0 / per_unit;
  verify_setup setup = verify_defaults(2, 3 * per_unit, h);
  setup.grid.geometry = MPM_AXISYMMETRIC;
  setup.grid.basis = how->basis;
  setup.grid.origin[0] = shift * h;
  setup.grid.cells[1] = 4;
  setup.grid.periodic[1] = 1;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  setup.stepper.locking_remedy = how->remedy;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "linear_elastic", E, nu, 1.0));
  fill_wall(&w, set, h, shift);
  mpm_surface_desc d;
  mpm_surface *s, *seen;
  verify_ok(&w, mpm_surface_desc_init(&d, sizeof d));
  d.pressure = p;
  verify_ok(&w, mpm_surface_create(w.context, w.grid, &d, &s));
  d.pressure = 0.0;
  verify_ok(&w, mpm_surface_create(w.context, w.grid, &d, &seen));
  verify_ok(&w, mpm_stepper_add_surface(w.stepper, s));
  verify_ok(&w, mpm_stepper_add_surface(w.stepper, seen));
  /* along the axis the load is even: that of one marker in each half cell, out of the inner face */
  for (int32_t k = 0; k < 8; ++k) {
    const double inner[] = {a, (k + 0.5) * 0.5 * h}, outer[] = {b, inner[1]}, area[] = {-a * 0.5 * h, 0.0};
    verify_ok(&w, mpm_surface_add(s, 1, inner, area, NULL));
    verify_ok(&w, mpm_surface_add(seen, 1, outer, area, NULL));
  }
  const mpm_step_info info = verify_step(&w, 1.0);
  double u[2][16];
  verify_ok(&w, mpm_surface_get(s, "displacement", MPM_F64, 2, 8, NULL, u[0]));
  verify_ok(&w, mpm_surface_get(seen, "displacement", MPM_F64, 2, 8, NULL, u[1]));
  outcome is = {u[0][0] / displacement(a) - 1.0, u[1][0] / displacement(b) - 1.0, 0.0, 0.0,
                info.newton_iterations};
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 2), *stress = verify_get(&w, set, "stress", 6);
  const double q = p * a * a / (b * b - a * a);
  for (int64_t i = 0; i < n; ++i) {
    const double radial = q * (1.0 - b * b / (x[i] * x[i])), hoop = q * (1.0 + b * b / (x[i] * x[i]));
    is.radial += pow((stress[i] - radial) / p, 2.0) / (double)n;
    is.hoop += pow((stress[2 * n + i] - hoop) / p, 2.0) / (double)n;
    if (i % 8 == 0)
      fprintf(csv, "\"%s\",%d,%g,%.6f,%.6e,%.6e,%.6e,%.6e\n", how->name, (int)per_unit, shift, x[i],
              stress[i] / p, radial / p, stress[2 * n + i] / p, hoop / p);
  }
  is.radial = sqrt(is.radial);
  is.hoop = sqrt(is.hoop);
  free(x);
  free(stress);
  verify_ok(&w, mpm_stepper_remove_surface(w.stepper, s));
  verify_ok(&w, mpm_stepper_remove_surface(w.stepper, seen));
  verify_ok(&w, mpm_surface_destroy(s));
  verify_ok(&w, mpm_surface_destroy(seen));
  verify_close(&w);
  return is;
}

int main(int argc, char **argv) {
  verify_begin("ring_cylinder", argc, argv);
  FILE *csv = verify_csv("ring_cylinder");
  fprintf(csv, "method,cells,shift,r,radial,radial_exact,hoop,hoop_exact\n");
  /* the prototype's errors, h = .2, .1, .05, .025: u(a), u(b), radial, hoop */
  static const double known[2][4][4] = {{{2.1e-3, 2.4e-3, 1.5e-2, 6.8e-3},
                                         {5.1e-4, 5.8e-4, 5.6e-3, 2.4e-3},
                                         {1.3e-4, 1.4e-4, 2.0e-3, 8.7e-4},
                                         {3.1e-5, 3.5e-5, 7.2e-4, 3.1e-4}},
                                        {{2.6e-3, 2.6e-3, 2.0e-2, 8.3e-3},
                                         {6.9e-4, 7.9e-4, 1.2e-2, 5.0e-3},
                                         {1.9e-4, 2.6e-4, 7.5e-3, 3.2e-3},
                                         {5.1e-5, 9.7e-5, 5.0e-3, 2.1e-3}}};
  const method methods[] = {{"quadratic", MPM_BSPLINE2, 0},
                            {"quadratic, remedy", MPM_BSPLINE2, 1},
                            {"linear", MPM_LINEAR, 0},
                            {"cubic", MPM_BSPLINE3, 0}};
  const char *source = "1.5 times the errors of a prototype";
  for (int32_t m = 0; m < 4; ++m)
    for (int32_t shifted = 0; shifted < 2; ++shifted) {
      double h[4], inner[4], outer[4];
      char what[96];
      for (int32_t i = 0; i < 4; ++i) {
        const int32_t per_unit = 5 << i;
        const outcome is = load(&methods[m], per_unit, 0.37 * shifted, csv);
        const char *grid = shifted ? "shifted" : "conforming";
        h[i] = 1.0 / per_unit;
        inner[i] = fabs(is.inner);
        outer[i] = fabs(is.outer);
        printf("%-20s %-10s h = 1/%-3d u(a) %.2e u(b) %.2e radial %.2e hoop %.2e, %d iterations\n",
               methods[m].name, grid, (int)per_unit, is.inner, is.outer, is.radial, is.hoop,
               (int)is.iterations);
        if (m) continue;
        const double value[4] = {fabs(is.inner), fabs(is.outer), is.radial, is.hoop};
        static const char *const of[4] = {"u(a)", "u(b)", "radial stress", "hoop stress"};
        for (int32_t k = 0; k < 4; ++k) {
          snprintf(what, sizeof what, "%s grid, h = 1/%d: error of %s", grid, (int)per_unit, of[k]);
          verify_gate(what, value[k], 0.0, 1.5 * known[shifted][i][k], source);
        }
      }
      if (shifted) continue;
      snprintf(what, sizeof what, "%s: order of u(a)", methods[m].name);
      verify_judge(
          what, verify_slope(4, h, inner), 1.9, 4.0, "second order",
          methods[m].basis == MPM_BSPLINE3
              ? "two particles per cell are a poor quadrature of four cubics at a loaded face: with four "
                "the error of h = 1/40 is a ninth"
              : NULL);
      snprintf(what, sizeof what, "%s: order of u(b)", methods[m].name);
      verify_gate(what, verify_slope(4, h, outer), 1.9, 4.0, "second order");
    }
  fclose(csv);
  return verify_end();
}
