/* Steffen et al. 2008, fig. 6 and eqs 40-42: what the sum over particles leaves of the
 * internal force under a constant stress of 1, which is 0 in exact integration, against the
 * spacing of particles; h = 1, l = h/10. */
#include "verify.h"

enum { SPACINGS = 14, BASES = 4, CELLS = 32, FILLS = 32 };

/* In [0.5, 1.5], repeatable. */
static double jitter(uint64_t *seed) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return 0.5 + (double)(*seed >> 11) * 0x1p-53;
}

/* Particles of uniform density side by side from 4 to at least CELLS - 4;
 * their widths vary about the spacing. */
static void fill(verify_world *w, mpm_particles *set, double spacing, uint64_t seed) {
  const int64_t most = (int64_t)(2 * CELLS / spacing);
  double *x = verify_array(most), *width = verify_array(most), edge = 4.0;
  int64_t n = 0;
  for (; edge < CELLS - 4.0; edge += width[n++]) {
    width[n] = spacing * jitter(&seed);
    x[n] = edge + 0.5 * width[n];
  }
  verify_ok(w, mpm_particles_add(set, n, x, NULL, width, NULL, NULL, NULL));
  const double stress[6] = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  verify_ok(w, mpm_particles_set_all(set, "stress", MPM_F64, 6, stress));
  free(x), free(width);
}

/* Sum of squares of the force over the nodes in the middle. */
static double force_error(int32_t basis, double smoothing, double spacing, uint64_t seed) {
  verify_setup setup = verify_defaults(1, CELLS, 1.0);
  setup.grid.basis = basis;
  setup.grid.smoothing = smoothing;
  verify_world w;
  verify_open(&w, &setup);
  fill(&w, verify_set(&w, verify_elastic(&w, "linear_elastic", 1.0, 0.0, 1.0)), spacing, seed);
  mpm_view force = {.struct_size = sizeof force}, index = force;
  verify_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  verify_ok(&w, mpm_grid_map(w.stepper, 0, "force", MPM_READ, &force));
  verify_ok(&w, mpm_grid_map(w.stepper, 0, "index", MPM_READ, &index));
  double sum = 0.0;
  for (int64_t i = 0; i < force.count; ++i) {
    const int64_t node = ((const int64_t *)index.data)[i * index.item_stride];
    const double f = ((const double *)force.data)[i * force.item_stride];
    if (node >= 8 && node <= CELLS - 8) sum += f * f;
  }
  verify_ok(&w, mpm_view_release(&force));
  verify_ok(&w, mpm_view_release(&index));
  verify_ok(&w, mpm_step_abort(w.stepper));
  verify_close(&w);
  return sum;
}

int main(int argc, char **argv) {
  verify_begin("force_quadrature", argc, argv);
  static const int32_t basis[BASES] = {MPM_LINEAR, MPM_UGIMP, MPM_UGIMP, MPM_BSPLINE2};
  static const double smoothing[BASES] = {0.1, 0.1, 0.01, 0.1};
  double spacing[SPACINGS], error[BASES][SPACINGS]; /* root mean square over nodes and fills */
  FILE *csv = verify_csv("force_quadrature");
  fputs("spacing,linear,\"uGIMP, l = h/10\",\"uGIMP, l = h/100\",quadratic", csv);
  for (int32_t k = 0; k < SPACINGS; ++k) {
    spacing[k] = 0.4 * pow(2.0, -0.5 * k);
    fprintf(csv, "\n%.6g", spacing[k]);
    for (int32_t i = 0; i < BASES; ++i) {
      double sum = 0.0;
      for (uint64_t seed = 1; seed <= FILLS; ++seed)
        sum += force_error(basis[i], smoothing[i], spacing[k], seed);
      error[i][k] = sqrt(sum / (FILLS * (CELLS - 15)));
      fprintf(csv, ",%.6g", error[i][k]);
    }
  }
  fputc('\n', csv);
  fclose(csv);
  const char *figure = "Steffen et al. 2008, fig. 6";
  verify_gate("order, uGIMP, l = h/10, spacing below l/2", verify_slope(8, &spacing[6], &error[1][6]), 1.8,
              2.2, figure);
  verify_gate("order, uGIMP, l = h/10, spacing above 2 l", verify_slope(3, spacing, error[1]), 0.7, 1.5,
              figure);
  verify_gate("order, uGIMP, l = h/100, spacing 4 l to 40 l", verify_slope(7, spacing, error[2]), 0.8, 1.2,
              figure);
  verify_gate("order, linear", verify_slope(SPACINGS, spacing, error[0]), 0.8, 1.2,
              "Steffen et al. 2008, section 4.2: a jump costs order 1");
  verify_gate("order, quadratic", verify_slope(SPACINGS, spacing, error[3]), 1.8, 2.2,
              "Steffen et al. 2008, section 4.2: continuous integrands keep order 2");
  return verify_end();
}
