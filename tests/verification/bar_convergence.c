/* Steffen et al. 2008, fig. 10: error of the manufactured bar against the number of cells, by basis. */
#include "bar.h"

enum { SIZES = 7, METHODS = 10 };
enum { LINEAR, QUADRATIC, QUADRATIC_6, CUBIC, UGIMP, CPGIMP, MUSL, TOTAL_LINEAR, TOTAL, TOTAL_CUBIC };

static double h[SIZES], error[METHODS][SIZES]; /* by number of cells: 8, 16, ... */

static const char figure[] = "Steffen et al. 2008, fig. 10";

static void gates(void) {
  const char *calibrated = "an independent implementation, with a margin of 30 %";
  const double *at_16[METHODS];
  for (int32_t i = 0; i < METHODS; ++i) at_16[i] = &error[i][1];
  verify_expected_failure("order, quadratic, 16 to 64 cells", verify_slope(3, &h[1], at_16[QUADRATIC]), 1.7,
                          2.4, figure,
                          "the plateau of the quadrature error begins at 64 cells; 6 per cell is above it");
  verify_gate("order, quadratic, 6 per cell, 16 to 64 cells", verify_slope(3, &h[1], at_16[QUADRATIC_6]), 1.7,
              2.4, figure);
  verify_gate("order, cubic, 16 to 64 cells", verify_slope(3, &h[1], at_16[CUBIC]), 1.7, 2.4, figure);
  verify_gate("order, cpGIMP, 16 to 64 cells", verify_slope(3, &h[1], at_16[CPGIMP]), 1.7, 2.4, figure);
  verify_gate("error, quadratic, 64 cells", error[QUADRATIC][3], 0.0, 3.5e-4, calibrated);
  verify_gate("error, cubic, 64 cells", error[CUBIC][3], 0.0, 2.5e-4, calibrated);
  verify_gate("error, cpGIMP, 64 cells", error[CPGIMP][3], 0.0, 1.4e-4, calibrated);
  verify_gate("error, uGIMP, 64 cells", error[UGIMP][3], 0.0, 4.5e-4, calibrated);
  verify_gate("error, MUSL, 64 cells", error[MUSL][3], 0.0, 3.9e-4, calibrated);
  verify_gate("linear does not converge: error at 64 over 16 cells", error[LINEAR][3] / error[LINEAR][1], 0.5,
              HUGE_VAL, figure);
}

static void fine_gates(void) {
  verify_gate("order, cpGIMP, 64 to 512 cells", verify_slope(4, &h[3], &error[CPGIMP][3]), 1.7, 2.4, figure);
  verify_gate("plateau, quadratic: error at 512 over 128 cells", error[QUADRATIC][6] / error[QUADRATIC][4],
              0.4, HUGE_VAL, figure);
  const char *exact = "second order; a total Lagrangian grid has no noise of crossing and no plateau";
  const double *total[] = {error[TOTAL_LINEAR], error[TOTAL], error[TOTAL_CUBIC]};
  const char *names[] = {"linear", "quadratic", "cubic"};
  for (int32_t i = 0; i < 3; ++i) {
    char name[80];
    snprintf(name, sizeof name, "total Lagrangian, %s", names[i]);
    verify_gate_of(name, "order, 16 to 512 cells", verify_slope(6, &h[1], &total[i][1]), 1.9, 2.4, exact);
    verify_gate_of(name, "order, 256 to 512 cells", log2(total[i][5] / total[i][6]), 1.9, 2.4, exact);
  }
  verify_gate("plateau is lower with 6 per cell: 512 cells", error[QUADRATIC_6][6] / error[QUADRATIC][6], 0.0,
              0.5, figure);
}

int main(int argc, char **argv) {
  verify_begin("bar_convergence", argc, argv);
  static const bar bars[METHODS] = {
      {.name = "linear", .basis = MPM_LINEAR, .per_cell = 4},
      {.name = "quadratic", .basis = MPM_BSPLINE2, .per_cell = 4},
      {.name = "quadratic, 6 per cell", .basis = MPM_BSPLINE2, .per_cell = 6},
      {.name = "cubic", .basis = MPM_BSPLINE3, .per_cell = 4},
      {.name = "uGIMP", .basis = MPM_UGIMP, .smoothing = 0.25, .per_cell = 4},
      {.name = "cpGIMP", .basis = MPM_CPGIMP, .per_cell = 4},
      {.name = "quadratic, MUSL", .basis = MPM_BSPLINE2, .scheme = MPM_MUSL, .per_cell = 4},
      {.name = "linear, total Lagrangian", .basis = MPM_LINEAR, .per_cell = 4, .total = 1},
      {.name = "quadratic, total Lagrangian", .basis = MPM_BSPLINE2, .per_cell = 4, .total = 1},
      {.name = "cubic, total Lagrangian", .basis = MPM_BSPLINE3, .per_cell = 4, .total = 1},
  };
  const int32_t sizes = verify_quick() ? 4 : SIZES;
  FILE *csv = verify_csv("bar_convergence");
  fputs("cells", csv);
  for (int32_t i = 0; i < METHODS; ++i) fprintf(csv, ",\"%s\"", bars[i].name);
  fputc('\n', csv);
  for (int32_t k = 0; k < sizes; ++k) {
    const int32_t cells = 8 << k;
    h[k] = 1.0 / cells;
    fprintf(csv, "%d", (int)cells);
    for (int32_t i = 0; i < METHODS; ++i) {
      error[i][k] = bar_error(&bars[i], cells, 0.05, 4e-6, 0.01);
      fprintf(csv, ",%.6g", error[i][k]);
    }
    fputc('\n', csv);
    verify_progress("%d cells done", (int)cells);
  }
  fclose(csv);
  gates();
  if (!verify_quick()) fine_gates();
  return verify_end();
}
