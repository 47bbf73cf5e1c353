/* Taylor's bar: a copper cylinder, 32.4 x 3.2 mm, hits a rigid wall at 227 m/s; a quarter of it between
 * symmetry planes. The face is held to the wall both ways, without friction. E = 117 GPa, nu = 0.35, density
 * 8930, yield stress 400 MPa, hardening 100 MPa; 80 us. The reference is an axisymmetric finite element
 * solution with the same wall. The same bar goes as a body of revolution, with 2592 particles at R = 8 h
 * where the quarter has 33 000. */
#include "verify.h"

static const double length = 32.4e-3, radius = 3.2e-3;

static mpm_status in_bar(void *user, int32_t dim, int64_t n, int64_t ld, const double *x, uint8_t *inside) {
  (void)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = hypot(x[i], x[ld + i]) < radius;
  return MPM_OK;
}

typedef struct outcome {
  double length, radius, strain; /* mm, mm, largest plastic strain */
  double foot;                   /* by how much the lowest two layers have grown */
} outcome;

typedef struct method {
  const char *name;
  int32_t transfer, locking_remedy, rings;
} method;

/* Opens the bar, which flies along the last axis; of rings the two others are one. */
static mpm_particles *open_bar(verify_world *w, int32_t per_radius, const method *how) {
  const double h = radius / per_radius, low[3] = {0.0, 0.0, 0.0};
  const int32_t dim = how->rings ? 2 : 3, per_cell[3] = {2, 2, 2};
  double high[3] = {radius, radius, radius}, v[3] = {0.0, 0.0, 0.0};
  verify_setup setup = verify_defaults(dim, 3 * per_radius, h);
  setup.grid.geometry = how->rings ? MPM_AXISYMMETRIC : MPM_PLANE_STRAIN;
  setup.grid.cells[dim - 1] = (int64_t)(length / h) + 4;
  setup.stepper.scheme = MPM_MUSL;
  setup.stepper.transfer = how->transfer;
  setup.stepper.locking_remedy = how->locking_remedy;
  verify_open(w, &setup);
  const mpm_param copper[] = {
      {"E", 117e9}, {"nu", 0.35}, {"density", 8930.0}, {"yield_stress", 400e6}, {"hardening", 100e6}};
  mpm_particles *bar = verify_set(w, verify_material(w, "j2", copper, 5));
  high[dim - 1] = length;
  v[dim - 1] = -227.0;
  if (how->rings)
    verify_fill_box(w, bar, low, high, 2);
  else
    verify_ok(w, mpm_particles_fill(bar, low, high, per_cell, in_bar, NULL, NULL, NULL));
  verify_ok(w, mpm_particles_set_all(bar, "velocity", MPM_F64, dim, v));
  for (int32_t k = 0; k < dim; ++k) verify_ok(w, mpm_stepper_set_wall(w->stepper, 2 * k, MPM_WALL_SLIP, 0.0));
  return bar;
}

/* Returns the radius of the cylinder that has the polar moment of the particles that are picked. */
static double foot_of(const verify_world *w, mpm_particles *bar, const uint8_t *picked) {
  const int64_t n = mpm_particles_count(bar);
  double *x = verify_get(w, bar, "position", w->dim), *m = verify_get(w, bar, "mass", 1), moment = 0.0,
         mass = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    if (!picked[i]) continue;
    const double y = w->dim == 2 ? 0.0 : x[n + i];
    moment += m[i] * (x[i] * x[i] + y * y);
    mass += m[i];
  }
  free(x);
  free(m);
  return sqrt(2.0 * moment / mass);
}

static uint8_t *pick_foot(const verify_world *w, mpm_particles *bar, double h) {
  const int64_t n = mpm_particles_count(bar);
  double *x = verify_get(w, bar, "position", w->dim);
  uint8_t *picked = malloc((size_t)n);
  for (int64_t i = 0; i < n; ++i) picked[i] = x[(w->dim - 1) * n + i] < h;
  free(x);
  return picked;
}

static outcome hit(int32_t per_radius, const method *how, FILE *cloud) {
  const double h = radius / per_radius;
  verify_world w;
  mpm_particles *bar = open_bar(&w, per_radius, how);
  uint8_t *picked = pick_foot(&w, bar, h);
  const double was = foot_of(&w, bar, picked);
  for (int32_t k = 1; k <= 8; ++k) {
    verify_advance(&w, 0.4, 1e-5 * k);
    verify_progress("%s, R / %d, %d of 80 us", how->name, (int)per_radius, 10 * (int)k);
  }
  const int64_t n = mpm_particles_count(bar);
  const int32_t up = w.dim - 1;
  double *x = verify_get(&w, bar, "position", w.dim), *F = verify_get(&w, bar, "deformation_gradient", 9),
         *plastic = verify_get(&w, bar, "state", 1);
  outcome out = {.foot = foot_of(&w, bar, picked) / was};
  for (int64_t i = 0; i < n; ++i) {
    /* To the edge of the particle: a quarter of a cell of the undeformed body, stretched. */
    const double y = how->rings ? 0.0 : x[n + i], z = x[up * n + i];
    const double r = hypot(x[i], y), c = x[i] / r, s = y / r;
    const double across = hypot(F[i], how->rings ? 0.0 : F[n + i]);
    const double stretch = c * across + s * hypot(F[3 * n + i], F[4 * n + i]);
    out.radius = fmax(out.radius, 1e3 * (r + 0.25 * h * stretch));
    out.length = fmax(out.length, 1e3 * (z + 0.25 * h * F[4 * up * n + i]));
    out.strain = fmax(out.strain, plastic[i]);
    if (cloud && fabs(y) < 0.5 * h * F[4 * n + i])
      fprintf(cloud, "%.5f,%.5f,%.5f\n", 1e3 * x[i], 1e3 * z, plastic[i]);
  }
  free(x);
  free(F);
  free(plastic);
  free(picked);
  verify_close(&w);
  return out;
}

static void check(const char *name, int32_t per_radius, const char *what, double value, double low,
                  double high, const char *source) {
  char text[96];
  snprintf(text, sizeof text, "%s, R / %d: %s", name, (int)per_radius, what);
  verify_gate(text, value, low, high, source);
}

int main(int argc, char **argv) {
  verify_begin("taylor_bar", argc, argv);
  FILE *cloud = verify_csv("taylor_bar_cloud"), *table = verify_csv("taylor_bar");
  fprintf(cloud, "r,z,plastic_strain\n");
  fprintf(table, "method,cells_in_radius,length,radius,plastic_strain\n");
  const method methods[2][2] = {{{"FLIP", MPM_FLIP, MPM_LOCKING_NONE, 0},
                                 {"APIC, cell average", MPM_APIC, MPM_LOCKING_CELL_AVERAGE, 0}},
                                {{"rings, FLIP", MPM_FLIP, MPM_LOCKING_NONE, 1},
                                 {"rings, APIC, cell average", MPM_APIC, MPM_LOCKING_CELL_AVERAGE, 1}}};
  const char *source = "own axisymmetric FEM, 16 elements in R: 21.58, 7.206; set tolerance";
  const char *alike = "the quarter in 3-D; set tolerance";
  outcome quarter = {0.0, 0.0, 0.0, 0.0};
  for (int32_t per_radius = 4; per_radius <= (verify_quick() ? 4 : 16); per_radius *= 2)
    for (int32_t k = 0; k < 4; ++k) {
      const int32_t rings = k % 2;
      const method *how = &methods[rings][k / 2];
      if (per_radius > 8 && !rings) continue; /* rings alone are quick enough */
      const outcome o = hit(per_radius, how, per_radius == 8 && k == 2 ? cloud : NULL);
      fprintf(table, "\"%s\",%d,%.5f,%.5f,%.4f\n", how->name, (int)per_radius, o.length, o.radius, o.strain);
      const double off = rings ? 0.3 : 0.4, off_radius = rings ? 0.25 : 0.35;
      if (!rings || per_radius > 4 || !how->locking_remedy) {
        check(how->name, per_radius, "final length in mm", o.length, 21.6 - off, 21.6 + off, source);
        check(how->name, per_radius, "final radius in mm", o.radius, 7.2 - off_radius, 7.2 + off_radius,
              source);
      }
      if (rings && per_radius <= 8) {
        check(how->name, per_radius, "length over that in 3-D", o.length / quarter.length, 0.98, 1.02, alike);
        check(how->name, per_radius, "growth of the foot over that in 3-D", o.foot / quarter.foot, 0.98, 1.02,
              alike);
      }
      quarter = o;
    }
  fclose(cloud);
  fclose(table);
  return verify_end();
}
