/* AMPLE's beam (Coombs & Augarde 2020): 10 x 1 m, E = 12e6, nu = 0.2, plane strain, under a dead shear force
 * of 100 kN/m at its tip, in 50 steps. The root is held along the beam, and across it on the neutral axis
 * only. Gate: the middle of the tip, in quasi-static steps and in slow and strongly damped motion
 * (gamma = 1). */
#include "verify.h"

static const double length = 10.0, h = 0.25, E = 12e6, nu = 0.2, force = 1e5;
static const double density = 1000.0, duration = 50.0; /* nine periods of the straight beam */
static const double fem[2] = {-5.519, -8.244};         /* order 4, the continuum */
static const double middle = 10.0;                     /* height of the neutral axis */

typedef struct beam {
  int32_t columns, rows; /* of particles */
} beam;

typedef struct outcome {
  double u[2], share; /* of the tip; of the load that was reached */
} outcome;

/* Particles are numbered column by column. The two columns before the place of the force share it as on a
 * straight line through them. */
static mpm_status pull(void *user, const mpm_particle_batch *b, double *add) {
  const beam *is = user;
  const double share = fmin(1.0, b->t / duration);
  for (int64_t i = 0; i < b->n; ++i) {
    const int64_t from_end = is->columns - 1 - b->id[i] / is->rows;
    if (b->id[i] >= 0 && (from_end == 0 || from_end == 1))
      add[b->ld + i] -= (from_end ? -0.5 : 1.5) * share * force / is->rows;
  }
  return MPM_OK;
}

/* The node at the root of the neutral axis does not move across. */
static mpm_status pin(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    if (fabs(b->position[i]) < 1e-9 && fabs(b->position[b->ld + i] - middle) < 1e-9)
      prescribed[b->ld + i] = 1, velocity[b->ld + i] = 0.0;
  return MPM_OK;
}

static void fill(const verify_world *w, const beam *is, mpm_particles *set) {
  const int64_t n = (int64_t)is->columns * is->rows;
  const double size = 1.0 / is->rows;
  double *x = verify_array(2 * n), *volume = verify_array(n);
  for (int64_t i = 0; i < n; ++i) {
    x[i] = ((double)(i / is->rows) + 0.5) * size;
    x[n + i] = middle - 0.5 + ((double)(i % is->rows) + 0.5) * size;
    volume[i] = size * size;
  }
  verify_ok(w, mpm_particles_add(set, n, x, NULL, volume, NULL, NULL, NULL));
  free(x), free(volume);
}

static outcome bend(int32_t basis, int32_t per_cell, int steps, int quasi_static, FILE *csv) {
  verify_setup setup = verify_defaults(2, 48, h);
  setup.grid.basis = basis;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = quasi_static;
  setup.stepper.newmark_gamma = 1.0;
  setup.stepper.newmark_beta = 0.5625;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, nu, density));
  beam is = {(int32_t)lround(length / h) * per_cell, (int32_t)lround(1.0 / h) * per_cell};
  fill(&w, &is, set);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_force(w.stepper, pull, &is));
  verify_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, pin, NULL));
  const int64_t n = mpm_particles_count(set), end = (int64_t)is.columns * is.rows;
  outcome out = {{0.0, 0.0}, 0.0};
  for (int k = 1; k <= steps + (quasi_static ? 0 : steps / 5); ++k) {
    verify_step(&w, duration / steps);
    out.share = fmin(1.0, (double)k / steps);
    double *x = verify_get(&w, set, "position", 2), at[2] = {0.0, 0.0};
    for (int c = 0; c < 2; ++c)
      for (int64_t i = end - is.rows / 2 - 1; i <= end - is.rows / 2; ++i)
        at[c] += 0.75 * x[c * n + i] - 0.25 * x[c * n + i - is.rows];
    out.u[0] = at[0] - length, out.u[1] = at[1] - middle;
    fprintf(csv, "%d,%d,%d,%.4f,%.6f,%.6f\n", (int)basis, (int)per_cell, quasi_static, out.share, out.u[0],
            out.u[1]);
    free(x);
  }
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("beam", argc, argv);
  FILE *csv = verify_csv("beam");
  fprintf(csv, "basis,per_cell,quasi_static,share,x,y\n");
  const int steps = verify_quick() ? 25 : 50;
  const char *source = "own finite elements of order 4; set tolerance";
  static const struct {
    const char *name;
    int32_t basis, per_cell;
  } list[] = {{"quadratic, 4 x 4 per cell", MPM_BSPLINE2, 4}, {"quadratic, 2 x 2 per cell", MPM_BSPLINE2, 2},
              {"quadratic, 3 x 3 per cell", MPM_BSPLINE2, 3}, {"GIMP, 4 x 4 per cell", MPM_GIMP, 4},
              {"cubic, 3 x 3 per cell", MPM_BSPLINE3, 3},     {"quadratic, 6 x 6 per cell", MPM_BSPLINE2, 6}};
  for (int quasi_static = 0; quasi_static < 2; ++quasi_static)
    for (int i = 0; i < (verify_quick() ? 1 : 6); ++i) {
      const outcome is = bend(list[i].basis, list[i].per_cell, steps, quasi_static, csv);
      char name[80];
      snprintf(name, sizeof name, "%s%s", quasi_static ? "quasi-static, " : "", list[i].name);
      verify_gate_of(name, "u_x of the tip over FEM", is.u[0] / fem[0], 0.97, 1.03, source);
      verify_gate_of(name, "u_y of the tip over FEM", is.u[1] / fem[1], 0.97, 1.03, source);
    }
  fclose(csv);
  return verify_end();
}
