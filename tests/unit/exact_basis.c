/* Weights along one axis, for every basis and instruction set: exact at nodes, faces, half nodes and
 * anywhere. */
#include "exact.h"

#include "transfer/kernels.h"

static const double origin = -0.3, spacing = 0.25;
enum { CELLS = 10, GLOBAL = CELLS + 3 /* nodes -1 ... CELLS + 1 */ };

typedef struct weights {
  double w[MPMI_MAX_WIDTH][MPMI_CHUNK], g[MPMI_MAX_WIDTH][MPMI_CHUNK];
  double first[MPMI_CHUNK], place[MPMI_CHUNK];
} weights;

/* As the stepper makes it for a block whose first node is `corner`. */
static mpmi_axis axis_of(int32_t order, double corner, int32_t periodic) {
  return (mpmi_axis){.origin = origin,
                     .spacing = spacing,
                     .inverse_spacing = 1.0 / spacing,
                     .base_low = order == 2 ? -1.0 : 0.0,
                     .base_high = CELLS - 1.0,
                     .period = periodic ? CELLS : 0.0,
                     .inverse_period = periodic ? 1.0 / CELLS : 0.0,
                     .tile_base = corner,
                     .middle = 0.5 * (16 + 2 * MPMI_RING - 1)};
}

static int32_t available(int32_t isa) {
  mpm_context *context;
  mpm_context_desc desc;
  ck_assert_int_eq(mpm_context_desc_init(&desc, sizeof desc), MPM_OK);
  desc.isa = isa;
  if (mpm_context_create(&desc, &context)) return 0;
  ck_assert_int_eq(mpm_context_destroy(context), MPM_OK);
  return 1;
}

/* Nodes, half nodes, faces and their neighbourhoods in the first half of a chunk, then anywhere. */
static void fill_positions(dice *d, double *x) {
  static const double special[16] = {0.0,  0.5,  1.0, 1.5,         5.0,        4.5,        9.5,        9.0,
                                     10.0, 1e-9, 0.1, 10.0 - 1e-9, 5.0 - 1e-9, 5.5 + 1e-9, 0.5 - 1e-9, 7.25};
  for (int32_t p = 0; p < MPMI_CHUNK; ++p)
    x[p] = origin + spacing * (p < 16 ? special[p] : throw_between(d, 0.0, CELLS));
}

static void check_sums(const char *name, int32_t order, const double *x, const weights *W, double corner) {
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
    double w = 0.0, wx = 0.0, g = 0.0, gx = 0.0;
    for (int32_t k = 0; k <= order; ++k) {
      const double node = origin + spacing * (corner + W->place[p] + k);
      ck_between(name, W->w[k][p], 0.0, 1.0);
      ck_within(name, (W->first[p] + k) * spacing, node - x[p], 1e-14);
      w += W->w[k][p];
      wx += W->w[k][p] * node;
      g += W->g[k][p];
      gx += W->g[k][p] * node;
    }
    ck_within(name, w, 1.0, 1e-14);
    ck_within(name, wx, x[p], 1e-14);
    ck_within(name, g, 0.0, 1e-14 / spacing);
    ck_within(name, gx, 1.0, 1e-13);
  }
}

/* Weights of one particle by node of the grid. */
static void by_node(const weights *W, int32_t p, int32_t order, double corner, double *w, double *g) {
  for (int32_t i = 0; i < GLOBAL; ++i) w[i] = g[i] = 0.0;
  for (int32_t k = 0; k <= order; ++k) {
    const int32_t node = (int32_t)(corner + W->place[p]) + k + 1;
    ck_assert(node >= 0 && node < GLOBAL);
    w[node] += W->w[k][p];
    g[node] += W->g[k][p];
  }
}

/* One-sided differences of second order within a half cell, where weights are quadratic: exact but for
 * rounding. */
static void check_gradient(const char *name, mpmi_axis_weights_fn fn, const mpmi_axis *axis, int32_t order,
                           const double *x, const weights *W) {
  double x_near[2][MPMI_CHUNK], eps[MPMI_CHUNK];
  weights near[2];
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
    const double xi = (x[p] - origin) / spacing, next = floor(2.0 * (xi + 2e-4));
    eps[p] = spacing * (next > floor(2.0 * xi) || xi + 2e-4 > CELLS ? -1e-4 : 1e-4);
    for (int32_t i = 0; i < 2; ++i) x_near[i][p] = x[p] + (i + 1) * eps[p];
  }
  for (int32_t i = 0; i < 2; ++i)
    fn(axis, MPMI_CHUNK, x_near[i], 1, near[i].w, near[i].g, near[i].first, near[i].place);
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
    double w[3][GLOBAL], g[GLOBAL], unused[GLOBAL];
    by_node(W, p, order, axis->tile_base, w[0], g);
    for (int32_t i = 0; i < 2; ++i) by_node(&near[i], p, order, axis->tile_base, w[i + 1], unused);
    for (int32_t i = 0; i < GLOBAL; ++i)
      ck_within(name, (4.0 * w[1][i] - 3.0 * w[0][i] - w[2][i]) / (2.0 * eps[p]), g[i], 1e-9 / spacing);
  }
}

START_TEST(weights_are_exact) {
  static const char *const names[] = {"baseline", "avx2", "avx512"};
  const int32_t isa = MPM_ISA_BASELINE + _i;
  if (!available(isa)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(isa);
  dice d = {1};
  for (int32_t order = 1; order <= 2; ++order)
    for (int32_t round = 0; round < 50; ++round) {
      const double corner = (double)(round % 3) - 2.0;
      const mpmi_axis axis = axis_of(order, corner, 0);
      double x[MPMI_CHUNK];
      weights W;
      fill_positions(&d, x);
      kernels->axis_weights[order](&axis, MPMI_CHUNK, x, 1, W.w, W.g, W.first, W.place);
      check_sums(names[_i], order, x, &W, corner);
      check_gradient(names[_i], kernels->axis_weights[order], &axis, order, x, &W);
    }
}
END_TEST

/* u = w (x_i - x_p), D = sum u (x_i - x_p); moving least squares: the second weight is u / D. A linear basis
 * has no D at a node, a quadratic one h^2 / 4 everywhere. */
START_TEST(moments_are_exact) {
  if (!available(MPM_ISA_BASELINE + _i)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(MPM_ISA_BASELINE + _i);
  dice d = {2};
  for (int32_t order = 1; order <= 2; ++order) {
    const mpmi_axis axis = axis_of(order, -2.0, 0);
    double x[MPMI_CHUNK];
    const double *const axes[1] = {x};
    mpmi_weights W;
    fill_positions(&d, x);
    kernels->weights[1][order + 1](&axis, kernels->axis_weights[order], MPMI_NEED_MLS, MPMI_CHUNK, axes, &W);
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
  if (!available(MPM_ISA_BASELINE + _i)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(MPM_ISA_BASELINE + _i);
  dice d = {3};
  for (int32_t order = 1; order <= 2; ++order) {
    /* a block of 16 nodes from node 8 on, of a grid of 10 cells: its ring lies behind the seam */
    const mpmi_axis periodic = axis_of(order, 8.0 - MPMI_RING - (order == 2), 1),
                    plain = axis_of(order, 0.0, 0);
    double x[MPMI_CHUNK];
    weights W, P;
    for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
      const double xi = throw_between(&d, 8.5, 11.5);
      x[p] = origin + spacing * (xi > CELLS ? xi - CELLS : xi);
    }
    kernels->axis_weights[order](&periodic, MPMI_CHUNK, x, 1, P.w, P.g, P.first, P.place);
    kernels->axis_weights[order](&plain, MPMI_CHUNK, x, 1, W.w, W.g, W.first, W.place);
    for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
      for (int32_t k = 0; k <= order; ++k) {
        ck_assert(P.w[k][p] == W.w[k][p]);
        ck_assert(P.g[k][p] == W.g[k][p]);
      }
      ck_between("tile", P.place[p], 0.0, 16 + 2 * MPMI_RING - 1);
      const double turns = (P.place[p] + periodic.tile_base - W.place[p]) / CELLS;
      ck_assert(turns == floor(turns));
    }
  }
}
END_TEST

TCase *basis_case(void) {
  TCase *tc = tcase_create("basis");
  tcase_add_loop_test(tc, weights_are_exact, 0, 3);
  tcase_add_loop_test(tc, moments_are_exact, 0, 3);
  tcase_add_loop_test(tc, periodic_images_reach_the_tile, 0, 3);
  return tc;
}
