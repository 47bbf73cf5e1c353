/* Start-up of plane Couette flow: fluid between a plate at rest and one that starts with speed U, H = U = 1,
 * kinematic viscosity 1. Open knots: the velocity of the moving plate is that of the node on its face. */
#include "verify.h"

static const double H = 1.0, U = 1.0, nu = 1.0;

static double exact(double y, double t) {
  double u = y / H, sign = -1.0;
  for (int n = 1; n < 400; ++n, sign = -sign) {
    const double k = n * PI / H;
    u += 2.0 * sign / (n * PI) * sin(k * y) * exp(-nu * k * k * t);
  }
  return U * u;
}

static mpm_status move_plate(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    if (b->position[b->ld + i] > H - 1e-9) {
      prescribed[i] = prescribed[b->ld + i] = 1;
      velocity[i] = U;
      velocity[b->ld + i] = 0.0;
    }
  return MPM_OK;
}

enum { TIMES = 4 };
static const double when[TIMES] = {0.02, 0.05, 0.1, 0.5};

static void flow(int cells, int transfer, double error[TIMES], FILE *csv) {
  const double h = H / cells, density = 1.0;
  verify_setup setup = verify_defaults(2, cells, h);
  setup.grid.cells[0] = 8;
  setup.grid.periodic[0] = 1;
  setup.grid.boundary_basis = MPM_BOUNDARY_OPEN_KNOT;
  setup.stepper.transfer = transfer;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param fluid[] = {
      {"density", density}, {"bulk_modulus", 400.0 * density}, {"viscosity", nu * density}};
  mpm_particles *set = verify_set(&w, verify_material(&w, "newtonian_fluid", fluid, 3));
  verify_fill_box(&w, set, (const double[]){0.0, 0.0}, (const double[]){8.0 * h, H}, 2);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MAX, MPM_WALL_FIXED, 0.0));
  verify_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, move_plate, NULL));
  const int64_t n = mpm_particles_count(set);
  for (int k = 0; k < TIMES; ++k) {
    verify_advance(&w, 0.4, when[k]);
    double *x = verify_get(&w, set, "position", 2), *v = verify_get(&w, set, "velocity", 2), sum = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      const double u = exact(x[n + i], when[k]);
      sum += (v[i] - u) * (v[i] - u);
      if (csv) fprintf(csv, "%.2f,%.6f,%.6f,%.6f\n", when[k], x[n + i], v[i], u);
    }
    error[k] = sqrt(sum / (double)n) / U;
    free(x);
    free(v);
  }
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("couette", argc, argv);
  FILE *csv = verify_csv("couette"), *table = verify_csv("couette_refinement");
  fprintf(csv, "t,y,u,u_exact\n");
  fprintf(table, "transfer,cells,t0.02,t0.05,t0.1,t0.5\n");
  static const struct {
    int transfer, cells;
    const char *name;
  } runs[] = {{MPM_FLIP, 10, "FLIP"}, {MPM_FLIP, 20, "FLIP"}, {MPM_APIC, 20, "APIC"}, {MPM_FLIP, 40, "FLIP"}};
  const int count = verify_quick() ? 3 : 4;
  for (int r = 0; r < count; ++r) {
    double e[TIMES];
    flow(runs[r].cells, runs[r].transfer, e, r == 1 ? csv : NULL);
    fprintf(table, "%s,%d,%.5e,%.5e,%.5e,%.5e\n", runs[r].name, runs[r].cells, e[0], e[1], e[2], e[3]);
    for (int k = 0; k < TIMES && r > 0; ++k) {
      char what[96];
      snprintf(what, sizeof what, "%s, H / %d, nu t / H^2 = %g: velocity / U, L2", runs[r].name,
               runs[r].cells, when[k]);
      verify_gate(what, e[k], 0.0, 0.02, "series solution; set tolerance");
    }
  }
  fclose(csv);
  fclose(table);
  return verify_end();
}
