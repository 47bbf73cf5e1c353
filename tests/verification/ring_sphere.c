/* A thick elastic sphere (a = 1, b = 2, E = 1, nu = 0.3) under an inner pressure of E / 1e6 that a surface
 * carries: Lame's displacements, read by markers without area, and the stress of the particles. A quarter of
 * its section, as a body of revolution; and an eighth of it in 3-D. Four quasi-static steps of the law
 * linear_elastic. */
#include "verify.h"

static const double a = 1.0, b = 2.0, E = 1.0, nu = 0.3, p = 1e-6;
enum { READ = 40 };

static double displacement(double r) {
  return p * a * a * a / (E * (b * b * b - a * a * a)) *
         ((1.0 - 2.0 * nu) * r + (1.0 + nu) * b * b * b / (2.0 * r * r));
}

static double hoop_stress(double r) {
  return p * a * a * a / (b * b * b - a * a * a) * (1.0 + 0.5 * b * b * b / (r * r * r));
}

static double radial_stress(double r) {
  return p * a * a * a / (b * b * b - a * a * a) * (1.0 - b * b * b / (r * r * r));
}

/* Shells of particles of exact volume, of one radian. */
static void fill_section(const verify_world *w, mpm_particles *set, int32_t layers) {
  const double width = (b - a) / layers;
  for (int32_t k = 0; k < layers; ++k) {
    const double inner = a + k * width, outer = inner + width, r = 0.5 * (inner + outer);
    const int32_t n = (int32_t)(0.5 * PI * r / width + 0.5);
    for (int32_t i = 0; i < n; ++i) {
      const double low = 0.5 * PI * i / n, high = 0.5 * PI * (i + 1) / n, angle = 0.5 * (low + high);
      const double x[2] = {r * sin(angle), r * cos(angle)};
      const double volume = (pow(outer, 3.0) - pow(inner, 3.0)) / 3.0 * (cos(low) - cos(high));
      verify_ok(w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
    }
  }
}

/* Shells again, of an eighth: rings of equal width in the angle from z, cut into pieces of equal length. */
static void fill_eighth(const verify_world *w, mpm_particles *set, int32_t layers) {
  const double width = (b - a) / layers;
  for (int32_t k = 0; k < layers; ++k) {
    const double inner = a + k * width, outer = inner + width, r = 0.5 * (inner + outer);
    const int32_t rings = (int32_t)(0.5 * PI * r / width + 0.5);
    for (int32_t i = 0; i < rings; ++i) {
      const double low = 0.5 * PI * i / rings, high = 0.5 * PI * (i + 1) / rings, from_z = 0.5 * (low + high);
      const int32_t n = (int32_t)(0.5 * PI * r * sin(from_z) / width + 0.5) + 1;
      const double volume = (pow(outer, 3.0) - pow(inner, 3.0)) / 3.0 * (cos(low) - cos(high)) * 0.5 * PI / n;
      for (int32_t j = 0; j < n; ++j) {
        const double about = 0.5 * PI * (j + 0.5) / n;
        const double x[3] = {r * sin(from_z) * cos(about), r * sin(from_z) * sin(about), r * cos(from_z)};
        verify_ok(w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
      }
    }
  }
}

/* The inner face, with the material on the left of the line; in 3-D by triangles whose normal is inwards. */
static void add_face(const verify_world *w, mpm_surface *s, double spacing) {
  if (w->dim == 2) {
    double at[2 * (READ + 1)];
    for (int32_t i = 0; i <= READ; ++i) {
      at[i] = a * sin(0.5 * PI * i / READ);
      at[READ + 1 + i] = a * cos(0.5 * PI * i / READ);
    }
    verify_ok(w, mpm_surface_add_polyline(s, READ + 1, at, 0, spacing, NULL, NULL));
    return;
  }
  for (int32_t i = 0; i < READ; ++i)
    for (int32_t j = 0; j < READ; ++j) {
      const double from_z[2] = {0.5 * PI * i / READ, 0.5 * PI * (i + 1) / READ},
                   about = 0.5 * PI * (j + 0.5) / READ, middle = 0.5 * (from_z[0] + from_z[1]);
      const double n[3] = {sin(middle) * cos(about), sin(middle) * sin(about), cos(middle)};
      const double size = a * a * (cos(from_z[0]) - cos(from_z[1])) * 0.5 * PI / READ;
      const double x[3] = {a * n[0], a * n[1], a * n[2]},
                   area[3] = {-size * n[0], -size * n[1], -size * n[2]};
      verify_ok(w, mpm_surface_add(s, 1, x, area, NULL));
    }
}

/* Markers without area along a quarter of a circle in the plane of the first and the last axis. */
static void add_readers(const verify_world *w, mpm_surface *s, double r) {
  for (int32_t i = 0; i < READ; ++i) {
    const double angle = 0.5 * PI * (i + 0.5) / READ;
    double x[3] = {r * sin(angle), 0.0, 0.0};
    x[w->dim - 1] = r * cos(angle);
    verify_ok(w, mpm_surface_add(s, 1, x, NULL, NULL));
  }
}

/* Returns the mean of the radial displacement of the markers [first, first + READ) over the exact one. */
static double mean_radial(const verify_world *w, const mpm_surface *s, int64_t first, double r) {
  const int64_t n = mpm_surface_count(s);
  const int32_t up = w->dim - 1;
  double *u = verify_array(w->dim * n), sum = 0.0;
  verify_ok(w, mpm_surface_get(s, "displacement", MPM_F64, w->dim, n, NULL, u));
  for (int32_t i = 0; i < READ; ++i) {
    const double angle = 0.5 * PI * (i + 0.5) / READ;
    sum += (u[first + i] * sin(angle) + u[up * n + first + i] * cos(angle)) / displacement(r) / READ;
  }
  free(u);
  return sum;
}

typedef struct outcome {
  double inner, outer, hoop, radial; /* displacements over the exact ones; rms error of stress over p */
} outcome;

static outcome load(int32_t dim, int32_t total, int32_t per_unit) {
  const double h = 1.0 / per_unit;
  verify_setup setup = verify_defaults(dim, 2 * per_unit + 3, h);
  setup.grid.geometry = dim == 2 ? MPM_AXISYMMETRIC : MPM_PLANE_STRAIN;
  setup.grid.total_lagrangian = total;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "linear_elastic", E, nu, 1.0));
  if (dim == 2)
    fill_section(&w, set, 2 * per_unit);
  else
    fill_eighth(&w, set, 2 * per_unit);
  for (int32_t k = dim == 2; k < dim; ++k)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, 2 * k, MPM_WALL_SLIP, 0.0));
  mpm_surface_desc d;
  mpm_surface *s;
  verify_ok(&w, mpm_surface_desc_init(&d, sizeof d));
  verify_ok(&w, mpm_surface_create(w.context, w.grid, &d, &s));
  add_face(&w, s, 0.5 * h);
  const int64_t loaded = mpm_surface_count(s);
  add_readers(&w, s, a);
  add_readers(&w, s, b);
  verify_ok(&w, mpm_stepper_add_surface(w.stepper, s));
  double *x = verify_get(&w, set, "position", dim);
  for (int32_t k = 1; k <= 4; ++k) {
    d.pressure = 0.25 * k * p;
    verify_ok(&w, mpm_surface_configure(s, &d));
    verify_step(&w, 1.0);
  }
  outcome is = {.inner = mean_radial(&w, s, loaded, a), .outer = mean_radial(&w, s, loaded + READ, b)};
  /* by invariants: the trace, and of the section the hoop itself */
  const int64_t n = mpm_particles_count(set);
  double *stress = verify_get(&w, set, "stress", 6);
  for (int64_t i = 0; i < n; ++i) {
    double r = 0.0, along = 0.0, trace = stress[i] + stress[n + i] + stress[2 * n + i];
    const double X[3] = {x[i], x[n + i], dim == 3 ? x[2 * n + i] : 0.0};
    const double S[3][3] = {{stress[i], stress[3 * n + i], stress[5 * n + i]},
                            {stress[3 * n + i], stress[n + i], stress[4 * n + i]},
                            {stress[5 * n + i], stress[4 * n + i], stress[2 * n + i]}};
    for (int32_t k = 0; k < dim; ++k) r += X[k] * X[k];
    for (int32_t j = 0; j < dim; ++j)
      for (int32_t k = 0; k < dim; ++k) along += X[j] * S[j][k] * X[k] / r;
    r = sqrt(r);
    is.radial += pow((along - radial_stress(r)) / p, 2.0) / (double)n;
    is.hoop += pow((0.5 * (trace - along) - hoop_stress(r)) / p, 2.0) / (double)n;
  }
  is.radial = sqrt(is.radial);
  is.hoop = sqrt(is.hoop);
  verify_progress("%d-D, total %d, h = a/%d: u(a) %.5f, u(b) %.5f, radial %.4f, hoop %.4f", (int)dim,
                  (int)total, (int)per_unit, is.inner, is.outer, is.radial, is.hoop);
  free(x), free(stress);
  verify_ok(&w, mpm_stepper_remove_surface(w.stepper, s));
  verify_ok(&w, mpm_surface_destroy(s));
  verify_close(&w);
  return is;
}

int main(int argc, char **argv) {
  verify_begin("ring_sphere", argc, argv);
  static const struct {
    const char *name;
    int32_t dim, total, coarsest, finest;
  } kinds[] = {
      {"section", 2, 0, 5, 20}, {"section, total Lagrangian", 2, 1, 5, 20}, {"eighth in 3-D", 3, 0, 5, 10}};
  const char *lame = "Lame; set tolerance";
  for (int32_t k = 0; k < 3; ++k)
    for (int32_t n = kinds[k].coarsest; n <= (verify_quick() ? 5 : kinds[k].finest); n *= 2) {
      const outcome is = load(kinds[k].dim, kinds[k].total, n);
      char name[80];
      snprintf(name, sizeof name, "%s, h = a/%d", kinds[k].name, (int)n);
      const double bound = 0.05 / n;
      verify_gate_of(name, "u(a) over the exact .8 a p / E", is.inner, 1.0 - bound, 1.0 + bound, lame);
      verify_gate_of(name, "u(b) over the exact .3 a p / E", is.outer, 1.0 - bound, 1.0 + bound, lame);
      verify_gate_of(name, "hoop stress / p, rms error (largest .714)", is.hoop, 0.0, 0.025, lame);
      verify_gate_of(name, "radial stress / p, rms error", is.radial, 0.0, 0.05, lame);
    }
  return verify_end();
}
