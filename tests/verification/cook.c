/* Cook's membrane, (0,0) (48,44) (48,60) (0,44), plane strain, clamped on the left, under a shear force of 1
 * on the right side, in one quasi-static step; compressible and nearly incompressible, with and without the
 * remedy against locking. Gate: the middle of the right side. */
#include "verify.h"

/* Along each axis. */
enum { PER_CELL = 4 };

typedef struct variant {
  const char *name, *model;
  double E, nu;
  double fem; /* own finite elements of order 4: upward displacement of the middle of the right side */
  int32_t basis, remedy;
} variant;

typedef struct panel {
  int32_t columns, rows;
} panel;

static double height(double share) {
  return 44.0 - 28.0 * share;
}

static void fill(const verify_world *w, const panel *p, mpm_particles *set) {
  const int64_t n = (int64_t)p->columns * p->rows;
  double *x = verify_array(2 * n), *volume = verify_array(n);
  for (int64_t i = 0; i < n; ++i) {
    const double across = ((double)(i / p->rows) + 0.5) / p->columns,
                 up = ((double)(i % p->rows) + 0.5) / p->rows;
    x[i] = 48.0 * across;
    x[n + i] = 44.0 * across + height(across) * up;
    volume[i] = 48.0 * height(across) / (double)n;
  }
  verify_ok(w, mpm_particles_add(set, n, x, NULL, volume, NULL, NULL, NULL));
  free(x), free(volume);
}

/* Dead and even along the side, to which the two last columns are extended as on a straight line. */
static mpm_status shear(void *user, const mpm_particle_batch *b, double *add) {
  const panel *p = user;
  for (int64_t i = 0; i < b->n; ++i) {
    const int64_t from_end = p->columns - 1 - b->id[i] / p->rows;
    if (b->id[i] >= 0 && from_end < 2) add[b->ld + i] += (from_end ? -0.5 : 1.5) / p->rows;
  }
  return MPM_OK;
}

static double load(const variant *v, double h, FILE *cloud) {
  verify_setup setup = verify_defaults(2, 0, h);
  setup.grid.cells[0] = (int64_t)ceil(56.0 / h);
  setup.grid.cells[1] = (int64_t)ceil(72.0 / h);
  setup.grid.origin[1] = -4.0;
  setup.grid.basis = v->basis;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  setup.stepper.locking_remedy = v->remedy;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, v->model, v->E, v->nu, 1.0));
  panel p = {(int32_t)lround(48.0 * PER_CELL / h), (int32_t)lround(44.0 * PER_CELL / h)};
  fill(&w, &p, set);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  verify_ok(&w, mpm_stepper_set_force(w.stepper, shear, &p));
  double *before = verify_get(&w, set, "position", 2);
  verify_step(&w, 1.0);
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 2), *s = verify_get(&w, set, "stress", 6);
  double end[2] = {0.0, 0.0}; /* means of the two middle rows in the last columns */
  for (int32_t k = 0; k < 2; ++k)
    for (int64_t i = n - (k + 1) * p.rows + p.rows / 2 - 1; i <= n - (k + 1) * p.rows + p.rows / 2; ++i)
      end[k] += 0.5 * (x[n + i] - before[n + i]);
  for (int64_t i = 0; cloud && i < n; ++i)
    fprintf(cloud, "%d,%.4f,%.4f,%.6e\n", (int)v->remedy, x[i], x[n + i],
            -(s[i] + s[n + i] + s[2 * n + i]) / 3.0);
  free(x), free(before), free(s);
  verify_close(&w);
  return 1.5 * end[0] - 0.5 * end[1];
}

int main(int argc, char **argv) {
  verify_begin("cook", argc, argv);
  const variant list[] = {
      {"nu = 1/3, linear", "neo_hookean", 70.0, 1.0 / 3.0, 0.30614, MPM_LINEAR, 0},
      {"nu = 1/3, quadratic", "neo_hookean", 70.0, 1.0 / 3.0, 0.30614, MPM_BSPLINE2, 0},
      {"nu = 1/3, quadratic, hypoelastic", "linear_elastic", 70.0, 1.0 / 3.0, 0.30749, MPM_BSPLINE2, 0},
      {"nu = 0.499, linear, plain", "neo_hookean", 70.0, 0.499, 0.26386, MPM_LINEAR, 0},
      {"nu = 0.499, quadratic, plain", "neo_hookean", 70.0, 0.499, 0.26386, MPM_BSPLINE2, 0},
      {"nu = 0.499, linear, remedy", "neo_hookean", 70.0, 0.499, 0.26386, MPM_LINEAR, 1},
      {"nu = 0.499, quadratic, remedy", "neo_hookean", 70.0, 0.499, 0.26386, MPM_BSPLINE2, 1},
      {"nu = 0.4999, quadratic, remedy, hypoelastic", "linear_elastic", 70.0, 0.4999, 18.508 / 70.0,
       MPM_BSPLINE2, 1}};
  enum { SIZES = 3 };
  const char *source = "own finite elements of order 4; set tolerance";
  FILE *csv = verify_csv("cook"), *cloud = verify_csv("cook_cloud");
  fprintf(csv, "variant,h,displacement,fem\n");
  fprintf(cloud, "remedy,x,y,pressure\n");
  for (size_t i = 0; i < sizeof list / sizeof *list; ++i) {
    const variant *v = &list[i];
    const int locks = v->nu > 0.4 && v->basis == MPM_LINEAR && !v->remedy;
    double h = 4.0, of[SIZES];
    for (int k = 0; k < SIZES; ++k, h /= 2.0) {
      of[k] = load(v, h, v->nu > 0.4 && v->basis == MPM_LINEAR && k == 0 ? cloud : NULL);
      fprintf(csv, "\"%s\",%g,%.6f,%.6f\n", v->name, h, of[k], v->fem);
    }
    char what[80];
    snprintf(what, sizeof what, "%s: over FEM, h = %g", v->name, 2.0 * h);
    if (locks)
      verify_expected_failure(what, of[SIZES - 1] / v->fem, 0.97, 1.03, source,
                              "volumetric locking; 0.70, 0.84, 0.93 at h = 4, 2, 1");
    else
      verify_gate(what, of[SIZES - 1] / v->fem, 0.97, 1.03, source);
    if (!locks) continue;
    verify_gate("nu = 0.499, linear, plain: gap to FEM at h = 2 over h = 4",
                (1.0 - of[1] / v->fem) / (1.0 - of[0] / v->fem), 0.0, 0.8, "locking goes with h");
  }
  fclose(csv);
  fclose(cloud);
  return verify_end();
}
