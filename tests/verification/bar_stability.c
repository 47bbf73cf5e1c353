/* Steffen et al. 2008, figs 8 and 9: how the smoothing length of uGIMP governs the stability of the
 * manufactured bar. */
#include "bar.h"

enum { CELLS = 64, DENSITIES = 5, LENGTHS = 4 };

static const char *const source_8 = "Steffen et al. 2008, fig. 8", *const source_9 =
                                                                       "Steffen et al. 2008, fig. 9";

/* After one period, at about the given CFL number. */
static double run(int32_t per_cell, double length, double cfl) {
  const bar how = {.basis = MPM_UGIMP, .smoothing = length, .per_cell = per_cell};
  const double t_end = 2.0 / bar_speed, steps = ceil(t_end * bar_speed * CELLS / cfl - 1e-9);
  return bar_error(&how, CELLS, 0.02, t_end / steps, t_end);
}

/* Unstable: ten times the error of the widest domains and more, "close to, or less than" the width of
 * particles. At l = h/8 the CFL number is near its limit too. */
static void smoothing_lengths(void) {
  static const int32_t per_cell[DENSITIES] = {2, 3, 4, 6, 8};
  const int32_t count = verify_quick() ? 16 : 64;
  FILE *csv = verify_csv("bar_smoothing");
  fputs("length", csv);
  for (int32_t i = 0; i < DENSITIES; ++i) fprintf(csv, ",%d per cell", (int)per_cell[i]);
  for (int32_t k = 1; k <= count; ++k) {
    const double length = (double)k / count;
    fprintf(csv, "\n%g", length);
    for (int32_t i = 0; i < DENSITIES; ++i) fprintf(csv, ",%.4g", run(per_cell[i], length, 0.8));
  }
  fputc('\n', csv);
  fclose(csv);
  for (int32_t i = 0; i < DENSITIES; ++i) {
    char what[80];
    const double width = 1.0 / per_cell[i], widest = run(per_cell[i], 1.0, 0.8);
    snprintf(what, sizeof what, "%d per cell, l = 1.5 h/PPC is stable: error over l = h", (int)per_cell[i]);
    verify_gate(what, run(per_cell[i], 1.5 * width, 0.8) / widest, 0.0, 10.0, source_8);
    snprintf(what, sizeof what, "%d per cell, l = 0.75 h/PPC is unstable: error over l = h",
             (int)per_cell[i]);
    verify_gate(what, run(per_cell[i], 0.75 * width, 0.8) / widest, 10.0, HUGE_VAL, source_8);
  }
}

static void time_steps(int32_t per_cell) {
  static const double length[LENGTHS] = {0.125, 0.25, 0.5, 1.0};
  double limit[LENGTHS], error[LENGTHS];
  char name[32], what[80];
  snprintf(name, sizeof name, "bar_cfl_%d", (int)per_cell);
  FILE *csv = verify_csv(name);
  fputs("cfl,l = h/8,l = h/4,l = h/2,l = h", csv);
  for (int32_t i = 0; i < LENGTHS; ++i) limit[i] = 0.0, error[i] = run(per_cell, length[i], 0.1);
  for (double cfl = 0.1; cfl < 1.525; cfl += 0.05) {
    fprintf(csv, "\n%.2f", cfl);
    for (int32_t i = 0; i < LENGTHS; ++i) {
      const double now = run(per_cell, length[i], cfl);
      if (now < 10.0 * error[i] && cfl < limit[i] + 0.125) limit[i] = cfl; /* without a gap */
      fprintf(csv, ",%.4g", now);
    }
  }
  fputc('\n', csv);
  fclose(csv);
  snprintf(what, sizeof what, "%d per cell, largest stable CFL number, l = h/8", (int)per_cell);
  verify_gate(what, limit[0], 0.65, 0.85, source_9);
  snprintf(what, sizeof what, "%d per cell, largest stable CFL number, l = h", (int)per_cell);
  verify_gate(what, limit[3], 1.1, 1.3, source_9);
  for (int32_t i = 1; i < LENGTHS; ++i) {
    snprintf(what, sizeof what, "%d per cell, gain of that from l = %g h to %g h", (int)per_cell,
             length[i - 1], length[i]);
    verify_gate(what, limit[i] - limit[i - 1], 0.0, 0.5, source_9);
  }
}

int main(int argc, char **argv) {
  verify_begin("bar_stability", argc, argv);
  smoothing_lengths();
  verify_progress("smoothing lengths done");
  time_steps(4);
  time_steps(8);
  return verify_end();
}
