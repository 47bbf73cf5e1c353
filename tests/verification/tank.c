#include "tank.h"

const double tank_measured[TANK_POINTS][2] = {{0.41, 1.11}, {0.84, 1.22}, {1.19, 1.44}, {1.43, 1.67},
                                              {1.63, 1.89}, {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56},
                                              {2.32, 2.78}, {2.51, 3.00}, {2.65, 3.22}, {2.83, 3.44},
                                              {2.98, 3.67}, {3.11, 3.89}, {3.33, 4.11}};

void tank_open(tank *it, double width, double depth, double length, int cells) {
  const double h = depth / cells, bulk = TANK_DENSITY * 400.0 * TANK_G * depth;
  verify_setup setup = verify_defaults(2, cells + cells / 2, h);
  setup.grid.cells[0] = (int64_t)(length / h);
  setup.stepper.transfer = MPM_APIC;
  setup.stepper.gravity[1] = -TANK_G;
  verify_open(&it->w, &setup);
  const mpm_param params[] = {
      {"density", TANK_DENSITY}, {"bulk_modulus", bulk}, {"viscosity", 1e-3}, {"tension", 0.0}};
  it->water = verify_set(&it->w, verify_material(&it->w, "newtonian_fluid", params, 4));
  verify_fill_box(&it->w, it->water, (const double[]){0.0, 0.0}, (const double[]){width, depth}, 2);
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; ++face)
    verify_ok(&it->w, mpm_stepper_set_wall(it->w.stepper, face, MPM_WALL_FRICTION_NODES, 0.0));
  const int64_t n = mpm_particles_count(it->water);
  double *x = verify_get(&it->w, it->water, "position", 2), *F = verify_array(9 * n);
  for (int64_t i = 0; i < n; ++i) {
    F[i] = F[8 * n + i] = 1.0;
    F[4 * n + i] = pow(1.0 + 7.0 * TANK_DENSITY * TANK_G * (depth - x[n + i]) / bulk, -1.0 / 7.0);
  }
  verify_put(&it->w, it->water, "deformation_gradient", 9, F);
  free(x);
  free(F);
}
