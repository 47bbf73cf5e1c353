/* Steffen et al. 2008, fig. 11 and section 3.4: error of the manufactured bar against the number of cells, by
 * the treatment of its ends; prescribed nodes with both rules for their acceleration. */
#include "bar.h"

enum { SIZES = 6, METHODS = 9 };
enum {
  PERIODIC,
  OPEN_KNOTS,
  FOLDED,
  OVERWRITTEN,
  OVERWRITTEN_ZERO,
  OPEN_NODES,
  OPEN_NODES_ZERO,
  CP_NODES,
  CP_ZERO
};

#define QUADRATIC .basis = MPM_BSPLINE2, .per_cell = 6
#define OPEN      QUADRATIC, .boundary_basis = MPM_BOUNDARY_OPEN_KNOT
#define NODES     .ends = BAR_OVERWRITTEN_NODES

static const bar bars[METHODS] = {
    {QUADRATIC, .name = "periodic"},
    {OPEN, .name = "open knots, fixed walls", .ends = BAR_FIXED_WALLS},
    {QUADRATIC, .name = "ghosts folded: fixed walls", .ends = BAR_FIXED_WALLS},
    {QUADRATIC, NODES, .name = "ghosts overwritten"},
    {QUADRATIC, NODES, .name = "ghosts overwritten, zero acceleration", .zero_acceleration = 1},
    {OPEN, NODES, .name = "open knots, end nodes prescribed"},
    {OPEN, NODES, .name = "open knots, end nodes prescribed, zero acceleration", .zero_acceleration = 1},
    {.basis = MPM_CPGIMP, .per_cell = 4, NODES, .name = "cpGIMP, end nodes prescribed"},
    {.basis = MPM_CPGIMP,
     .per_cell = 4,
     NODES,
     .name = "cpGIMP, end nodes prescribed, zero acceleration",
     .zero_acceleration = 1},
};

int main(int argc, char **argv) {
  verify_begin("bar_boundaries", argc, argv);
  const int32_t sizes = verify_quick() ? 4 : SIZES;
  double h[SIZES], error[METHODS][SIZES];
  char what[100];
  FILE *csv = verify_csv("bar_boundaries");
  fputs("cells", csv);
  for (int32_t i = 0; i < METHODS; ++i) fprintf(csv, ",\"%s\"", bars[i].name);
  for (int32_t k = 0; k < sizes; ++k) {
    const int32_t cells = 8 << k;
    h[k] = 1.0 / cells;
    fprintf(csv, "\n%d", (int)cells);
    for (int32_t i = 0; i < METHODS; ++i) {
      error[i][k] = bar_error(&bars[i], cells, 0.05, 4e-6, 0.01);
      fprintf(csv, ",%.6g", error[i][k]);
    }
    verify_progress("%d cells done", (int)cells);
  }
  fputc('\n', csv);
  fclose(csv);

  for (int32_t i = 0; i < METHODS; ++i) {
    const int first = i == OVERWRITTEN || i == OVERWRITTEN_ZERO;
    snprintf(what, sizeof what, "order, %s", bars[i].name);
    verify_gate(what, verify_slope(3, &h[1], &error[i][1]), first ? 0.8 : 1.7, first ? 1.3 : 2.4,
                "Steffen et al. 2008, fig. 11");
  }
  /* u is odd about both ends, so that a mirrored ghost is the periodic continuation. */
  verify_gate("ghosts folded over periodic: largest difference of errors",
              fabs(error[FOLDED][3] / error[PERIODIC][3] - 1.0), 0.0, 1e-6, "symmetry of the solution");
  for (int32_t i = OVERWRITTEN; i <= CP_NODES; i += 2) {
    snprintf(what, sizeof what, "64 cells, zero acceleration over eq. 30, %s", bars[i].name);
    verify_gate(what, error[i + 1][3] / error[i][3], 0.8, 1.25,
                "Steffen et al. 2008, section 3.4.1: neither is superior");
  }
  return verify_end();
}
