/* A thick elastic cylinder (a = 1, b = 2, E = 1, nu = 0.3, plane strain) under an inner pressure of E / 1e5
 * that a surface carries, wherever it lies on the grid: Lame's displacements, read by markers without area.
 * The whole ring floats freely; one step of Newmark's rule so long that inertia is 1e-5 of the stiffness. */
#include "verify.h"

static const double a = 1.0, b = 2.0, E = 1.0, nu = 0.3, p = 1e-5;
enum { AROUND = 96 };

static double displacement(double r) {
  return (1.0 + nu) * p * a * a / (E * (b * b - a * a)) * ((1.0 - 2.0 * nu) * r + b * b / r);
}

/* Makes a line of markers round a circle; the material is outside of it. */
static void add_circle(const verify_world *w, mpm_surface *s, const double *centre, double r, double spacing,
                       int32_t loaded) {
  double at[2 * 4 * AROUND];
  const int32_t n = 4 * AROUND;
  for (int32_t i = 0; i < n; ++i) {
    at[i] = centre[0] + r * cos(2.0 * PI * i / n);
    at[n + i] = centre[1] - r * sin(2.0 * PI * i / n);
  }
  if (loaded)
    verify_ok(w, mpm_surface_add_polyline(s, n, at, 1, spacing, NULL, NULL));
  else
    verify_ok(w, mpm_surface_add(s, n, at, NULL, NULL));
}

/* Returns the mean of the radial displacement of the markers [first, end), and writes it by angle. */
static double mean_radial(const verify_world *w, const mpm_surface *s, const double *centre, int64_t first,
                          int64_t end, FILE *csv, const char *name) {
  const int64_t n = mpm_surface_count(s);
  double *x = verify_array(2 * n), *u = verify_array(2 * n), sum = 0.0;
  verify_ok(w, mpm_surface_get(s, "position", MPM_F64, 2, n, NULL, x));
  verify_ok(w, mpm_surface_get(s, "displacement", MPM_F64, 2, n, NULL, u));
  for (int64_t i = first; i < end; ++i) {
    const double arm[2] = {x[i] - u[i] - centre[0], x[n + i] - u[n + i] - centre[1]};
    const double r = sqrt(arm[0] * arm[0] + arm[1] * arm[1]),
                 radial = (arm[0] * u[i] + arm[1] * u[n + i]) / r;
    fprintf(csv, "%s,%.6f,%.6f,%.6e,%.6e\n", name, r, atan2(arm[1], arm[0]), radial, displacement(r));
    sum += radial / displacement(r) / (double)(end - first);
  }
  free(x);
  free(u);
  return sum;
}

typedef struct outcome {
  double inner, outer; /* displacements over the exact ones */
} outcome;

static outcome load(int32_t basis, int32_t per_unit, int32_t shifted, FILE *csv) {
  const double h = 1.0 / per_unit;
  verify_setup setup = verify_defaults(2, 5 * per_unit, h);
  setup.grid.basis = basis;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.newmark_beta = 0.5; /* the acceleration at the start does not count */
  setup.stepper.newmark_gamma = 1.0;
  verify_world w;
  verify_open(&w, &setup);
  const double centre[2] = {2.5 + (shifted ? 0.37 * h : 0.0), 2.5 + (shifted ? 0.21 * h : 0.0)};
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, nu, 1.0));
  verify_fill_rings(&w, set, centre, a, b, 2 * per_unit);
  mpm_surface_desc d;
  mpm_surface *s;
  verify_ok(&w, mpm_surface_desc_init(&d, sizeof d));
  d.pressure = p;
  verify_ok(&w, mpm_surface_create(w.context, w.grid, &d, &s));
  add_circle(&w, s, centre, a, 0.5 * h, 1);
  const int64_t loaded = mpm_surface_count(s);
  add_circle(&w, s, centre, a, h, 0);
  add_circle(&w, s, centre, b, h, 0);
  verify_ok(&w, mpm_stepper_add_surface(w.stepper, s));
  verify_step(&w, 600.0);
  char name[64];
  snprintf(name, sizeof name, "%s %d %s", basis == MPM_LINEAR ? "linear" : "quadratic", (int)per_unit,
           shifted ? "shifted" : "aligned");
  const int64_t n = 4 * AROUND;
  const outcome is = {mean_radial(&w, s, centre, loaded, loaded + n, csv, name),
                      mean_radial(&w, s, centre, loaded + n, loaded + 2 * n, csv, name)};
  verify_ok(&w, mpm_stepper_remove_surface(w.stepper, s));
  verify_ok(&w, mpm_surface_destroy(s));
  verify_close(&w);
  return is;
}

int main(int argc, char **argv) {
  verify_begin("surface_cylinder", argc, argv);
  FILE *csv = verify_csv("surface_cylinder");
  fprintf(csv, "variant,r,angle,u,u_exact\n");
  char what[96];
  for (int32_t basis = MPM_LINEAR; basis <= MPM_BSPLINE2; ++basis)
    for (int32_t n = 5; n <= (verify_quick() ? 10 : 20); n *= 2)
      for (int32_t shifted = 0; shifted < 2; ++shifted) {
        const outcome is = load(basis, n, shifted, csv);
        const double most = basis == MPM_LINEAR ? 0.02 : 0.005;
        const char *kind = basis == MPM_LINEAR ? "linear" : "quadratic",
                   *place = shifted ? "shifted" : "aligned";
        snprintf(what, sizeof what, "%s, h = a/%d, %s: u(a) over exact", kind, (int)n, place);
        verify_gate(what, is.inner, 1.0 - most, 1.0 + most, "Lame; set tolerance");
        snprintf(what, sizeof what, "%s, h = a/%d, %s: u(b) over exact", kind, (int)n, place);
        verify_gate(what, is.outer, 1.0 - most, 1.0 + most, "Lame; set tolerance");
      }
  fclose(csv);
  return verify_end();
}
