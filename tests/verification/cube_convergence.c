/* Steffen et al. 2008, fig. 12: the axis-aligned manufactured solution in a unit cube (eqs 51-53),
 * u_k = A sin(2 pi X_k) sin(2 pi k / 3 + C pi t), by basis and treatment of the faces. */
#include "verify.h"

enum { PERIODIC, SYMMETRY_WALLS, OVERWRITTEN_NODES };
enum { SIZES = 3, METHODS = 6, PER_CELL = 4 };

static const double A = 0.05, E = 1e4, nu = 0.3, C = 100.0, t_end = 0.01; /* density 1 */

static double angle(int32_t k, double t) {
  return 2.0 * PI * k / 3.0 + C * PI * t;
}

/* Eq. 53. */
static mpm_status body_force(void *user, const mpm_particle_batch *batch, double *add) {
  (void)user;
  const double mu = 0.5 * E / (1.0 + nu), lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  for (int64_t i = 0; i < batch->n; ++i) {
    double u[3], F[3];
    for (int32_t k = 0; k < 3; ++k) {
      const double phase = 2.0 * PI * batch->reference_position[k * batch->ld + i],
                   s = sin(angle(k, batch->t));
      u[k] = A * sin(phase) * s;
      F[k] = 1.0 + 2.0 * A * PI * cos(phase) * s;
    }
    const double K = log(F[0] * F[1] * F[2]);
    for (int32_t k = 0; k < 3; ++k)
      add[k * batch->ld + i] +=
          PI * PI * u[k] * (4.0 * mu - C * C - 4.0 * (lambda * (K - 1.0) - mu) / (F[k] * F[k]));
  }
  return MPM_OK;
}

/* No normal velocity on the faces and beyond. */
static mpm_status hold_nodes(void *user, const mpm_node_batch *batch, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < 3 * batch->ld; ++i)
    if (batch->position[i] < 1e-9 || batch->position[i] > 1.0 - 1e-9) prescribed[i] = 1, velocity[i] = 0.0;
  return MPM_OK;
}

/* The exact state, the velocity at -dt / 2. */
static void start(const verify_world *w, mpm_particles *set, double dt) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 3), *v = verify_array(3 * n), *F = verify_array(9 * n);
  for (int32_t k = 0; k < 3; ++k)
    for (int64_t p = 0; p < n; ++p) {
      const double X = x[k * n + p];
      x[k * n + p] += A * sin(2.0 * PI * X) * sin(angle(k, 0.0));
      v[k * n + p] = A * sin(2.0 * PI * X) * C * PI * cos(angle(k, -0.5 * dt));
      F[4 * k * n + p] = 1.0 + 2.0 * A * PI * cos(2.0 * PI * X) * sin(angle(k, 0.0));
    }
  verify_put(w, set, "position", 3, x);
  verify_put(w, set, "velocity", 3, v);
  verify_put(w, set, "deformation_gradient", 9, F);
  free(x), free(v), free(F);
}

/* Largest error of a particle's position. */
static double run(int32_t basis, int32_t faces, int32_t total, int32_t cells) {
  const double lower[3] = {0.0, 0.0, 0.0}, upper[3] = {1.0, 1.0, 1.0};
  const int32_t per_cell[3] = {PER_CELL, PER_CELL, PER_CELL}, margin = faces == OVERWRITTEN_NODES ? 4 : 0;
  const int32_t steps = (int32_t)ceil(t_end * C * cells / 0.4 - 1e-9);
  const double dt = t_end / steps;
  verify_setup setup = verify_defaults(3, cells + 2 * margin, 1.0 / cells);
  setup.grid.basis = basis;
  setup.grid.total_lagrangian = total;
  setup.stepper.staggered = setup.stepper.reference_positions = 1;
  for (int32_t k = 0; k < 3; ++k) {
    setup.grid.periodic[k] = faces == PERIODIC;
    setup.grid.origin[k] = -(double)margin / cells;
  }
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, nu, 1.0));
  verify_ok(&w, mpm_particles_fill_box(set, lower, upper, per_cell, NULL, NULL));
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, body_force, NULL));
  if (faces == OVERWRITTEN_NODES) verify_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, hold_nodes, NULL));
  for (int32_t face = MPM_X_MIN; face <= MPM_Z_MAX && faces == SYMMETRY_WALLS; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  double *X = verify_get(&w, set, "position", 3);
  start(&w, set, dt);
  for (int32_t i = 0; i < steps; ++i) verify_ok(&w, mpm_step(w.stepper, dt, NULL));

  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 3), largest = 0.0;
  for (int64_t p = 0; p < n; ++p) {
    double square = 0.0;
    for (int32_t k = 0; k < 3; ++k) {
      const double at = X[k * n + p], d = x[k * n + p] - at - A * sin(2.0 * PI * at) * sin(angle(k, t_end));
      square += (d - rint(d)) * (d - rint(d)); /* positions are wrapped */
    }
    largest = fmax(largest, square);
  }
  free(X), free(x);
  verify_close(&w);
  return sqrt(largest);
}

int main(int argc, char **argv) {
  verify_begin("cube_convergence", argc, argv);
  static const struct {
    const char *name;
    int32_t basis, faces, total;
    double low, high;
    int32_t not_in_small;
  } methods[METHODS] = {{"quadratic, periodic", MPM_BSPLINE2, PERIODIC, 0, 1.7, 2.4, 0},
                        {"cpGIMP, periodic", MPM_CPGIMP, PERIODIC, 0, 1.7, 2.4, 1},
                        {"quadratic, slip walls", MPM_BSPLINE2, SYMMETRY_WALLS, 0, 1.7, 2.4, 1},
                        {"quadratic, ghosts overwritten", MPM_BSPLINE2, OVERWRITTEN_NODES, 0, 0.7, 1.4, 1},
                        {"quadratic, periodic, total Lagrangian", MPM_BSPLINE2, PERIODIC, 1, 1.8, 2.4, 0},
                        {"linear, slip walls, total Lagrangian", MPM_LINEAR, SYMMETRY_WALLS, 1, 1.8, 2.4, 0}};
  const int32_t sizes = verify_quick() ? 2 : SIZES, coarsest = 8;
  double h[SIZES], error[METHODS][SIZES];
  char what[80];
  FILE *csv = verify_csv("cube_convergence");
  fputs("cells", csv);
  for (int32_t i = 0; i < METHODS; ++i) fprintf(csv, ",\"%s\"", methods[i].name);
  for (int32_t k = 0; k < sizes; ++k) {
    const int32_t cells = coarsest << k;
    h[k] = 1.0 / cells;
    fprintf(csv, "\n%d", (int)cells);
    for (int32_t i = 0; i < METHODS; ++i) {
      if (verify_quick() && methods[i].not_in_small) continue;
      error[i][k] = run(methods[i].basis, methods[i].faces, methods[i].total, cells);
      fprintf(csv, ",%.6g", error[i][k]);
      verify_progress("%d^3 cells: %s: %.3g", (int)cells, methods[i].name, error[i][k]);
    }
  }
  fputc('\n', csv);
  fclose(csv);
  for (int32_t i = 0; i < METHODS; ++i) {
    if (verify_quick() && methods[i].not_in_small) continue;
    snprintf(what, sizeof what, "order, %s, to %d^3 cells", methods[i].name, (int)(coarsest << (sizes - 1)));
    verify_gate(what, verify_slope(sizes, h, error[i]), methods[i].low, methods[i].high,
                "Steffen et al. 2008, fig. 12");
  }
  return verify_end();
}
