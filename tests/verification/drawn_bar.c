/* A bar is drawn to four times its length: half of a sheet 4 by 1 in plane strain, E = 1000, nu = 0.3,
 * density 1, whose end nodes are pulled with the velocities of a uniform stretch. It thins freely and has one
 * F, that of uniaxial tension of the neo-Hookean law. On a total Lagrangian grid it keeps it; on others
 * particles part, and the bar breaks where there is no crack. */
#include "drawn.h"

static const double h = 0.125, length = DRAWN_LENGTH, last = DRAWN_LAST;

typedef struct method {
  const char *name;
  int32_t total, basis, scheme, transfer, steps;
} method;

typedef struct outcome {
  double stretch, force, across, gap; /* force and F22 over the exact ones - 1; largest gap over the mean */
} outcome;

/* Finds the largest distance along x between particles that were neighbours, over the mean. */
static double gap_of(int64_t n, const double *x, const double *X) {
  double most = 0.0, least = HUGE_VAL, far = -HUGE_VAL;
  for (int64_t i = 0; i < n; ++i) {
    double next = HUGE_VAL;
    least = fmin(least, x[i]), far = fmax(far, x[i]);
    for (int64_t j = 0; j < n; ++j)
      if (fabs(X[n + j] - X[n + i]) < 0.1 * h && fabs(X[j] - X[i] - 0.5 * h) < 0.1 * h) next = x[j] - x[i];
    if (next < HUGE_VAL) most = fmax(most, next);
  }
  return most / ((far - least) / (2.0 * length / h - 1.0));
}

static outcome draw(const method *how, FILE *table) {
  const int32_t implicit = how->scheme == MPM_NEWMARK;
  verify_setup setup = verify_defaults(2, (int64_t)lround((how->total ? length : 4.5 * length) / h) + 2, h);
  setup.grid.cells[1] = 8;
  setup.grid.basis = how->basis;
  setup.grid.total_lagrangian = how->total;
  setup.stepper.scheme = how->scheme;
  setup.stepper.transfer = how->transfer;
  setup.stepper.reference_positions = 1;
  setup.stepper.quasi_static = implicit;
  const double speed = implicit ? 1.0 : 0.02 * verify_speed_of_sound(DRAWN_E, DRAWN_NU, 1.0);
  const double rate = speed / length;
  drawn_pull by = {rate, h, how->total};
  verify_world w;
  mpm_particles *set = drawn_open(&w, &setup, &by, implicit);
  const int64_t n = mpm_particles_count(set);
  double *X = verify_get(&w, set, "position", 2);
  const double t_end = (last - 1.0) / rate;
  mpm_step_info now = verify_info(&w);
  mpm_status status = MPM_OK;
  while (now.t < t_end * (1.0 - 1e-12) && !status) {
    double dt = t_end / how->steps;
    if (!implicit) verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    status = mpm_step(w.stepper, fmin((implicit ? 1.0 : 0.4) * dt, t_end - now.t), &now);
  }
  outcome out = {.stretch = 1.0 + rate * now.t};
  double exact;
  const double across = drawn_thinning(out.stretch, &exact);
  out.force = status ? HUGE_VAL : drawn_force(&w) / exact - 1.0;
  double *F = verify_get(&w, set, "deformation_gradient", 9), *x = verify_get(&w, set, "position", 2);
  for (int64_t i = 0; i < n; ++i) {
    const double off = F[4 * n + i] / across - 1.0;
    if (fabs(off) > fabs(out.across)) out.across = off;
  }
  out.gap = gap_of(n, x, X);
  for (int64_t i = 0; i < n; ++i) fprintf(table, "%s,%.6f,%.6f,%.6f\n", how->name, x[i], x[n + i], F[i]);
  verify_progress("%s: stretch %.3f, force %.2e, F22 %.2e, gap %.3f", how->name, out.stretch, out.force,
                  out.across, out.gap);
  free(X), free(F), free(x);
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("drawn_bar", argc, argv);
  static const method methods[] = {
      {"total; quadratic; quasi-static", 1, MPM_BSPLINE2, MPM_NEWMARK, MPM_FLIP, 40},
      {"total; linear; quasi-static", 1, MPM_LINEAR, MPM_NEWMARK, MPM_FLIP, 40},
      {"total; cubic; quasi-static", 1, MPM_BSPLINE3, MPM_NEWMARK, MPM_FLIP, 40},
      {"total; quadratic; USL FLIP", 1, MPM_BSPLINE2, MPM_USL, MPM_FLIP, 0},
      {"total; quadratic; MUSL APIC", 1, MPM_BSPLINE2, MPM_MUSL, MPM_APIC, 0},
      {"updated; quadratic; quasi-static", 0, MPM_BSPLINE2, MPM_NEWMARK, MPM_FLIP, 400},
      {"updated; quadratic; USL FLIP", 0, MPM_BSPLINE2, MPM_USL, MPM_FLIP, 0}};
  FILE *table = verify_csv("drawn_bar_particles");
  fprintf(table, "method,x,y,F11\n");
  for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
    const method *is = &methods[k];
    const outcome o = draw(is, table);
    const char *exact = "uniaxial tension of the law";
    const double bound = is->scheme == MPM_NEWMARK ? 1e-7 : 0.02;
    if (!is->total) {
      verify_gate_of(is->name, "largest gap / mean, or it does not come so far",
                     o.stretch < 0.999 * last ? HUGE_VAL : o.gap, 1.5, HUGE_VAL,
                     "why total Lagrangian grids are there");
      continue;
    }
    verify_gate_of(is->name, "stretch", o.stretch, last * (1.0 - 1e-9), last * (1.0 + 1e-9), "it gets there");
    verify_gate_of(is->name, "force / exact - 1", fabs(o.force), 0.0, bound, exact);
    verify_gate_of(is->name, "F22 / exact - 1, largest", fabs(o.across), 0.0, bound, exact);
    verify_gate_of(is->name, "largest gap / mean", o.gap, 0.99, 1.0 + bound, "there is none");
  }
  fclose(table);
  return verify_end();
}
