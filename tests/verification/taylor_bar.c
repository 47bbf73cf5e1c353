/* Taylor's bar: a copper cylinder, 32.4 x 3.2 mm, hits a rigid wall at 227 m/s; a quarter of it between
 * symmetry planes. The face is held to the wall both ways, without friction. E = 117 GPa, nu = 0.35, density
 * 8930, yield stress 400 MPa, hardening 100 MPa; 80 us. The reference is an axisymmetric finite element
 * solution with the same wall. */
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
} outcome;

typedef struct method {
  const char *name;
  int transfer, locking_remedy;
} method;

static outcome hit(int per_radius, const method *how, FILE *cloud) {
  const double h = radius / per_radius;
  verify_setup setup = verify_defaults(3, 3 * per_radius, h);
  setup.grid.cells[2] = (int64_t)(length / h) + 4;
  setup.stepper.scheme = MPM_MUSL;
  setup.stepper.transfer = how->transfer;
  setup.stepper.locking_remedy = how->locking_remedy;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param copper[] = {
      {"E", 117e9}, {"nu", 0.35}, {"density", 8930.0}, {"yield_stress", 400e6}, {"hardening", 100e6}};
  mpm_particles *bar = verify_set(&w, verify_material(&w, "j2", copper, 5));
  verify_ok(&w,
            mpm_particles_fill(bar, (const double[]){0.0, 0.0, 0.0}, (const double[]){radius, radius, length},
                               (const int32_t[]){2, 2, 2}, in_bar, NULL, NULL, NULL));
  verify_ok(&w, mpm_particles_set_all(bar, "velocity", MPM_F64, 3, (const double[]){0.0, 0.0, -227.0}));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Z_MIN, MPM_WALL_SLIP, 0.0));
  for (int k = 1; k <= 8; ++k) {
    verify_advance(&w, 0.4, 1e-5 * k);
    verify_progress("%s, R / %d, %d of 80 us", how->name, per_radius, 10 * k);
  }
  const int64_t n = mpm_particles_count(bar);
  double *x = verify_get(&w, bar, "position", 3), *F = verify_get(&w, bar, "deformation_gradient", 9),
         *plastic = verify_get(&w, bar, "state", 1);
  outcome out = {0.0, 0.0, 0.0};
  for (int64_t i = 0; i < n; ++i) {
    /* To the edge of the particle: a quarter of a cell of the undeformed body, stretched. */
    const double r = hypot(x[i], x[n + i]), c = x[i] / r, s = x[n + i] / r,
                 stretch = c * hypot(F[i], F[n + i]) + s * hypot(F[3 * n + i], F[4 * n + i]);
    out.radius = fmax(out.radius, 1e3 * (r + 0.25 * h * stretch));
    out.length = fmax(out.length, 1e3 * (x[2 * n + i] + 0.25 * h * F[8 * n + i]));
    out.strain = fmax(out.strain, plastic[i]);
    if (cloud && fabs(x[n + i]) < 0.5 * h * F[4 * n + i])
      fprintf(cloud, "%.5f,%.5f,%.5f\n", 1e3 * x[i], 1e3 * x[2 * n + i], plastic[i]);
  }
  free(x);
  free(F);
  free(plastic);
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("taylor_bar", argc, argv);
  FILE *cloud = verify_csv("taylor_bar_cloud"), *table = verify_csv("taylor_bar");
  fprintf(cloud, "r,z,plastic_strain\n");
  fprintf(table, "method,cells_in_radius,length,radius,plastic_strain\n");
  const method methods[2] = {{"FLIP", MPM_FLIP, MPM_LOCKING_NONE},
                             {"APIC, cell average", MPM_APIC, MPM_LOCKING_CELL_AVERAGE}};
  const char *source = "own axisymmetric FEM, 16 elements in R: 21.58, 7.206; set tolerance";
  for (int per_radius = 4; per_radius <= (verify_quick() ? 4 : 8); per_radius *= 2)
    for (int m = 0; m < 2; ++m) {
      const outcome o = hit(per_radius, &methods[m], per_radius == 8 && m == 1 ? cloud : NULL);
      fprintf(table, "\"%s\",%d,%.5f,%.5f,%.4f\n", methods[m].name, per_radius, o.length, o.radius, o.strain);
      char what[2][80];
      snprintf(what[0], 80, "%s, R / %d: final length in mm", methods[m].name, per_radius);
      snprintf(what[1], 80, "%s, R / %d: final radius in mm", methods[m].name, per_radius);
      verify_gate(what[0], o.length, 21.2, 22.0, source);
      verify_gate(what[1], o.radius, 6.85, 7.55, source);
    }
  fclose(cloud);
  fclose(table);
  return verify_end();
}
