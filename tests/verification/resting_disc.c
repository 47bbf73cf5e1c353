/* A soft disc, neo-Hookean, R = 1 of 12 cells, E = 1000, nu = 0.3, that comes to rest on a frictionless floor
 * under its weight in quasi-static steps, in plane strain: half of it, beside a plane of symmetry. Contact
 * alone holds it up. Its top falls by a third of the radius. While the contact is narrow there is a solution
 * of linear elasticity. */
#include "discs.h"
#include "loading.h"

static const double R = 1.0, E = 1000.0, nu = 0.3;
static const double widest = 0.67; /* half the width of contact that Hertz has for the whole weight, over R */
enum { EARLY = 5 }; /* the first of so many parts of the weight is compared with that solution */

typedef struct setting {
  const char *name;
  int32_t basis, remedy;
} setting;

typedef struct outcome {
  double carried, fall, early; /* share of the weight; way of the top, and of the first part over theory */
  double iterations, tail, balance;
} outcome;

/* How far a point above the centre, at y from it, comes down. Three fields: Flamant's of the reaction P at
 * the lowest point, which leaves a traction of P / (2 pi R) (n + e_y) on the circle, n its normal; a tension
 * of P / (2 pi R) all over; and stresses of P / (2 pi R^2) (-y, y, x) in xx, yy, xy, which carry the weight.
 * Near the contact, Hertz: Johnson, Contact Mechanics, 1985, 5.55. */
static double fall_of(double P, double y) {
  const double stiff = E / (1.0 - nu * nu), ratio = nu / (1.0 - nu), half = sqrt(4.0 * P * R / (PI * stiff));
  return P / (PI * stiff) *
         (2.0 * log(2.0 * (y + R) / half) - ratio - (1.0 - ratio) * (y + R) / (2.0 * R) +
          (1.0 + ratio) * (1.0 - y * y / (R * R)) / 4.0);
}

static outcome rest(const setting *by, int32_t on, int32_t per_cell, int32_t steps, FILE *csv, FILE *cloud) {
  enum { CELLS = 12 };
  const double h = R / CELLS, floor = on == ON_WALL ? 0.0 : 0.37 * h;
  verify_setup setup = verify_defaults(2, CELLS + 6, h);
  setup.grid.basis = by->basis;
  setup.grid.cells[1] = 2 * CELLS + 8;
  setup.grid.origin[1] = on == ON_WALL ? 0.0 : -4.0 * h;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  setup.stepper.locking_remedy = by->remedy;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *disc = verify_set(&w, verify_elastic(&w, "neo_hookean", E, nu, 1.0));
  const double centre[2] = {0.0, floor + R}, rest[2] = {0.0, 0.0};
  disc_fill_shells(&w, disc, centre, R, rest, 1, h / per_cell);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  if (on == ON_BODY) {
    mpm_particles *ground = verify_set(&w, w.material[0]);
    verify_fill_box(&w, ground, (const double[]){0.0, -3.0 * h}, (const double[]){(CELLS + 5) * h, 0.0}, 2);
    verify_place(&w, ground, 0.0, (const double[]){0.0, floor});
    verify_ok(&w, mpm_particles_set_all(ground, "prescribed", MPM_U8, 2, (const uint8_t[]){1, 1}));
    verify_ok(&w, mpm_stepper_set_body(w.stepper, ground, 1));
  }
  support under = {.kind = on};
  support_lay(&w, &under, 0.0, 0.0, (const double[]){0.0, floor});
  const int64_t n = mpm_particles_count(disc);
  double *X = verify_get(&w, disc, "position", 2), *m = verify_get(&w, disc, "mass", 1), mass = 0.0;
  int64_t top = 0;
  for (int64_t p = 0; p < n; ++p) {
    mass += m[p];
    if (X[n + p] - X[p] > X[n + top] - X[top]) top = p;
  }
  const double P = widest * widest * PI * R * E / (4.0 * (1.0 - nu * nu));
  load weight = {0.5 * P / mass, 1.0};
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, loading_weigh, &weight));
  outcome out = {.carried = 0.0};
  for (int32_t k = 1; k <= steps; ++k) {
    mpm_step_info info = {.struct_size = sizeof info};
    const mpm_status status = mpm_step(w.stepper, 1.0 / steps, &info);
    if (status) {
      verify_progress("%s, %d steps: %s in step %d", by->name, (int)steps, mpm_status_name(status), (int)k);
      break;
    }
    double *x = verify_get(&w, disc, "position", 2);
    out.carried = (double)k / steps;
    out.fall = X[n + top] - x[n + top];
    if (EARLY * k == steps) out.early = out.fall / fall_of(P / EARLY, X[n + top] - floor - R);
    out.balance = fmax(out.balance, fabs(support_info(&w, &under).force[1] / (0.5 * P * out.carried) - 1.0));
    /* touches still open and close above that */
    out.tail = fmax(out.tail, loading_tail(&w, 1e-5));
    if (k > steps - 3) out.iterations = fmax(out.iterations, info.newton_iterations);
    fprintf(csv, "%d,\"%s\",%d,%d,%.4f,%.6f,%.6f,%d\n", (int)on, by->name, (int)per_cell, (int)steps,
            out.carried, out.fall, fall_of(P * out.carried, X[n + top] - floor - R),
            (int)info.newton_iterations);
    free(x);
  }
  double *x = verify_get(&w, disc, "position", 2), *s = verify_get(&w, disc, "stress", 6);
  for (int64_t p = 0; cloud && p < n; ++p)
    fprintf(cloud, "%d,%.4f,%.4f,%.4f\n", (int)on, x[p], x[n + p] - floor, -s[n + p] / E);
  free(x), free(s), free(X), free(m);
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("resting_disc", argc, argv);
  static const setting list[] = {{"quadratic", MPM_BSPLINE2, 0},
                                 {"linear, remedy", MPM_LINEAR, 1},
                                 {"cubic", MPM_BSPLINE3, 0},
                                 {"GIMP", MPM_GIMP, 0}};
  static const char *const floors[3] = {"on a body", "on a plane", "on a friction wall"};
  FILE *csv = verify_csv("resting_disc"), *cloud = verify_csv("resting_disc_cloud");
  fprintf(csv, "floor,setting,per_cell,steps,share,fall,theory,iterations\n");
  fprintf(cloud, "floor,x,y,pressure\n");
  double low = HUGE_VAL, high = 0.0;
  for (int32_t on = ON_BODY; on <= ON_WALL; ++on)
    for (int32_t i = 0; i < (verify_quick() ? 1 : 4); ++i) {
      outcome worst = {.carried = HUGE_VAL};
      double spread = 0.0, early[2] = {HUGE_VAL, 0.0};
      char name[60], what[120];
      snprintf(name, sizeof name, "%s, %s", floors[on], list[i].name);
      verify_progress("%s", name);
      for (int32_t per_cell = 2; per_cell <= (verify_quick() ? 2 : 3); ++per_cell) {
        double fall[2];
        for (int32_t k = 0; k < 2; ++k) {
          const outcome is =
              rest(&list[i], on, per_cell, k ? 40 : 10, csv, !i && k && per_cell == 2 ? cloud : NULL);
          fall[k] = is.fall;
          worst.carried = fmin(worst.carried, is.carried);
          worst.iterations = fmax(worst.iterations, is.iterations);
          worst.tail = fmax(worst.tail, is.tail);
          worst.balance = fmax(worst.balance, is.balance);
          early[0] = fmin(early[0], is.early), early[1] = fmax(early[1], is.early);
          if (list[i].basis != MPM_LINEAR) low = fmin(low, is.fall), high = fmax(high, is.fall);
        }
        spread = fmax(spread, fabs(fall[1] / fall[0] - 1.0));
      }
      const char *within = "set tolerance", *theory = "linear elasticity and Hertz; set tolerance";
      verify_gate_of(name, "least share of the weight that is carried", worst.carried, 1.0, 1.0, within);
      verify_gate_of(name, "most iterations of the last three steps", worst.iterations, 1.0, 8.0, within);
      verify_gate_of(name, "residual two iterations after 1e-5", worst.tail, 0.0, 1e-10,
                     "quadratic convergence");
      verify_gate_of(name, "force of the floor / weight, less 1", worst.balance, 0.0, 1e-8, "equilibrium");
      verify_gate_of(name, "least way of the top at a fifth of the weight / theory", early[0], 0.92, 1.08,
                     theory);
      verify_gate_of(name, "largest of these", early[1], 0.92, 1.08, theory);
      snprintf(what, sizeof what, "%s: way of the top, 40 steps over 10, less 1", name);
      if (list[i].basis == MPM_LINEAR)
        verify_expected_failure(what, spread, 0.0, 0.01, within,
                                "each step forgets the stress that the linear basis cannot hold");
      else
        verify_gate(what, spread, 0.0, 0.01, within);
    }
  verify_gate("way of the top, but for the linear basis, largest over least, less 1", high / low - 1.0, 0.0,
              0.06, "set tolerance");
  fclose(csv);
  fclose(cloud);
  return verify_end();
}
