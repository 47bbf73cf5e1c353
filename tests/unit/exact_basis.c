/* Weights along one axis, for every basis and instruction set: exact at nodes,
 * faces, half nodes and anywhere. */
#include "exact.h"

#include "transfer/kernels.h"

static const double origin = -0.3, spacing = 0.25;
enum { CELLS = 10, GLOBAL = CELLS + 3 /* nodes -1 ... CELLS + 1 */ };

/* As the stepper makes it for a block whose first node is `corner`. */
static mpmi_axis axis_of(double corner, int32_t periodic) {
  return (mpmi_axis){.origin = origin,
                     .spacing = spacing,
                     .inverse_spacing = 1.0 / spacing,
                     .last_cell = CELLS - 1.0,
                     .period = periodic ? CELLS : 0.0,
                     .inverse_period = periodic ? 1.0 / CELLS : 0.0,
                     .tile_base = corner,
                     .middle = 0.5 * (16 + 2 * MPMI_RING - 1)};
}

static void run(mpmi_weights_fn fn, const mpmi_axis *axis, int32_t need, const double *x, mpmi_weights *out) {
  const mpmi_points points = {.x = {x}};
  fn(axis, need, &points, 0, MPMI_CHUNK, out);
}

/* Nodes, half nodes, faces and their neighbourhoods in the first round, then anywhere. */
static void fill_positions(dice *d, int32_t round, double *x) {
  static const double special[16] = {0.0,  0.5,  1.0, 1.5,         5.0,        4.5,        9.5,        9.0,
                                     10.0, 1e-9, 0.1, 10.0 - 1e-9, 5.0 - 1e-9, 5.5 + 1e-9, 0.5 - 1e-9, 7.25};
  for (int32_t p = 0; p < MPMI_CHUNK; ++p)
    x[p] = origin + spacing * (round == 0 ? special[p % 16] : throw_between(d, 0.0, CELLS));
}

static void check_sums(const char *name, int32_t order, const double *x, const mpmi_weights *W,
                       double corner) {
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
    double w = 0.0, wx = 0.0, g = 0.0, gx = 0.0;
    for (int32_t k = 0; k <= order; ++k) {
      const double node = origin + spacing * (corner + W->node[p] + k);
      ck_between(name, W->w[0][k][p], 0.0, 1.0);
      ck_within(name, (W->first[0][p] + k) * spacing, node - x[p], 1e-14);
      w += W->w[0][k][p];
      wx += W->w[0][k][p] * node;
      g += W->g[0][k][p];
      gx += W->g[0][k][p] * node;
    }
    ck_within(name, w, 1.0, 1e-14);
    ck_within(name, wx, x[p], 1e-14);
    ck_within(name, g, 0.0, 1e-14 / spacing);
    ck_within(name, gx, 1.0, 1e-13);
  }
}

/* Weights of one particle by node of the grid. */
static void by_node(const mpmi_weights *W, int32_t p, int32_t order, double corner, double *w, double *g) {
  for (int32_t i = 0; i < GLOBAL; ++i) w[i] = g[i] = 0.0;
  for (int32_t k = 0; k <= order; ++k) {
    const int32_t node = (int32_t)(corner + W->node[p]) + k + 1;
    ck_assert(node >= 0 && node < GLOBAL);
    w[node] += W->w[0][k][p];
    g[node] += W->g[0][k][p];
  }
}

/* One-sided differences of second order within a half cell,
 * where weights are quadratic: exact but for rounding. */
static void check_gradient(const char *name, mpmi_weights_fn fn, const mpmi_axis *axis, int32_t order,
                           const double *x, const mpmi_weights *W) {
  double x_near[2][MPMI_CHUNK], eps[MPMI_CHUNK];
  mpmi_weights near[2];
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
    const double xi = (x[p] - origin) / spacing, next = floor(2.0 * (xi + 2e-4));
    eps[p] = spacing * (next > floor(2.0 * xi) || xi + 2e-4 > CELLS ? -1e-4 : 1e-4);
    for (int32_t i = 0; i < 2; ++i) x_near[i][p] = x[p] + (i + 1) * eps[p];
  }
  for (int32_t i = 0; i < 2; ++i) run(fn, axis, MPMI_NEED_GRADIENT, x_near[i], &near[i]);
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
    double w[3][GLOBAL], g[GLOBAL], unused[GLOBAL];
    by_node(W, p, order, axis->tile_base, w[0], g);
    for (int32_t i = 0; i < 2; ++i) by_node(&near[i], p, order, axis->tile_base, w[i + 1], unused);
    for (int32_t i = 0; i < GLOBAL; ++i)
      ck_within(name, (4.0 * w[1][i] - 3.0 * w[0][i] - w[2][i]) / (2.0 * eps[p]), g[i], 1e-9 / spacing);
  }
}

START_TEST(weights_are_exact) {
  static const char *const names[] = {"baseline", "avx2", "avx512", "neon"};
  const int32_t isa = MPM_ISA_BASELINE + _i;
  if (!has_isa(isa)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(isa);
  dice d = {1};
  for (int32_t order = 1; order <= 2; ++order)
    for (int32_t round = 0; round < 90; ++round) {
      const double corner = (double)(round % 3) - 2.0;
      const mpmi_axis axis = axis_of(corner, 0);
      double x[MPMI_CHUNK];
      mpmi_weights W;
      fill_positions(&d, round, x);
      run(kernels->weights[order - 1][1], &axis, MPMI_NEED_GRADIENT, x, &W);
      check_sums(names[_i], order, x, &W, corner);
      check_gradient(names[_i], kernels->weights[order - 1][1], &axis, order, x, &W);
    }
}
END_TEST

/* u = w (x_i - x_p), D = sum u (x_i - x_p); moving least squares: the second weight is u / D. A linear basis
 * has no D at a node, a quadratic one h^2 / 4 everywhere. */
START_TEST(moments_are_exact) {
  if (!has_isa(MPM_ISA_BASELINE + _i)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(MPM_ISA_BASELINE + _i);
  dice d = {2};
  for (int32_t trial = 0; trial < 8; ++trial) {
    const int32_t order = 1 + trial % 2;
    const mpmi_axis axis = axis_of(-2.0, 0);
    double x[MPMI_CHUNK];
    mpmi_weights W;
    fill_positions(&d, trial / 2, x);
    run(kernels->weights[order - 1][1], &axis, MPMI_NEED_MLS, x, &W);
    for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
      double D = 0.0;
      for (int32_t k = 0; k <= order; ++k) {
        const double away = origin + spacing * (W.node[p] - 2 + k) - x[p];
        ck_within("u", W.u[0][k][p], W.w[0][k][p] * away, 1e-15);
        ck_within("g", W.g[0][k][p], W.u[0][k][p] * W.inverse_moment[0][p], 1e-15 * W.inverse_moment[0][p]);
        D += W.w[0][k][p] * away * away;
      }
      if (order == 2) ck_within("D", D, 0.25 * spacing * spacing, 1e-16);
      if (D > 1e-7 * spacing * spacing)
        ck_within("1/D", W.inverse_moment[0][p] * D, 1.0, 1e-7);
      else if (D < 1e-9 * spacing * spacing)
        ck_assert(W.inverse_moment[0][p] == 0.0);
    }
  }
}
END_TEST

/* On a periodic axis the weights are the same, and the stencil lies in the tile whatever image the particle
 * is in. */
START_TEST(periodic_images_reach_the_tile) {
  if (!has_isa(MPM_ISA_BASELINE + _i)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(MPM_ISA_BASELINE + _i);
  dice d = {3};
  for (int32_t order = 1; order <= 2; ++order) {
    /* a block of 16 nodes from node 8 on, of a grid of 10 cells: its ring lies behind the seam */
    const mpmi_axis periodic = axis_of(8.0 - MPMI_RING - (order == 2), 1), plain = axis_of(0.0, 0);
    double x[MPMI_CHUNK];
    mpmi_weights W, P;
    for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
      const double xi = throw_between(&d, 8.5, 11.5);
      x[p] = origin + spacing * (xi > CELLS ? xi - CELLS : xi);
    }
    run(kernels->weights[order - 1][1], &periodic, MPMI_NEED_GRADIENT, x, &P);
    run(kernels->weights[order - 1][1], &plain, MPMI_NEED_GRADIENT, x, &W);
    for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
      for (int32_t k = 0; k <= order; ++k) {
        ck_assert(P.w[0][k][p] == W.w[0][k][p]);
        ck_assert(P.g[0][k][p] == W.g[0][k][p]);
      }
      ck_between("tile", P.node[p], 0.0, 16 + 2 * MPMI_RING - 1);
      const double turns = (P.node[p] + periodic.tile_base - W.node[p]) / CELLS;
      ck_assert(turns == floor(turns));
    }
  }
}
END_TEST

TCase *basis_case(void) {
  TCase *tc = tcase_create("basis");
  tcase_add_loop_test(tc, weights_are_exact, 0, 4);
  tcase_add_loop_test(tc, moments_are_exact, 0, 4);
  tcase_add_loop_test(tc, periodic_images_reach_the_tile, 0, 4);
  return tc;
}
