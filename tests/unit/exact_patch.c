/* Patch tests: an affine state gives a constant stress, which is in balance inside the body. */
#include "exact.h"

static const double F_patch[9] = {1.1, 0.05, -0.04, 0.03, 0.95, 0.06, 0.02, -0.05, 1.05};
static const double L_patch[9] = {0.3, -0.5, 0.2, 0.4, -0.2, 0.6, -0.1, 0.7, 0.15};
enum { CELLS = 14 };
static const double h = 0.25, low = 1.0 /* cells of the grid outside the body, times h */;

static double of_dim(int32_t dim, const double *tensor, int32_t c, double diagonal) {
  return c / 3 < dim && c % 3 < dim ? tensor[c] : c % 4 == 0 ? diagonal : 0.0;
}

/* A block of CELLS^dim cells of aligned particles, all with the deformation
 * gradient F_patch and v = L_patch x. */
static mpm_particles *open_patch(world *w, const method *how, int32_t dim, int32_t side, int32_t deformed) {
  const double lower[3] = {low, low, low}, upper[3] = {low + CELLS * h, low + CELLS * h, low + CELLS * h};
  world_desc desc = world_with(how, dim, CELLS + 8, h);
  mpm_particles *set = world_open(w, &desc);
  const int64_t n = world_fill(w, set, lower, upper, side);
  double F[9], C[9], *x = fetch(w, set, "position", dim), *v = calloc((size_t)(n * dim), sizeof *v);
  for (int32_t c = 0; c < 9; ++c) {
    F[c] = of_dim(dim, F_patch, c, 1.0);
    C[c] = of_dim(dim, L_patch, c, 0.0);
  }
  for (int32_t c = 0; c < 9; ++c)
    for (int64_t p = 0; p < n && c / 3 < dim && c % 3 < dim; ++p)
      v[c / 3 * n + p] += L_patch[c] * x[c % 3 * n + p];
  if (deformed) ck_ok(w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  put(w, set, "velocity", dim, v);
  if (how->transfer != MPM_FLIP) ck_ok(w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, C));
  free(x), free(v);
  return set;
}

/* Largest force on a node more than `margin` cells inside the body,
 * over stress times h^(dim - 1); nodes there. */
static double imbalance(world *w, mpm_particles *set, double margin, double length, int64_t *inside) {
  int64_t n;
  ck_ok(w, mpm_step_begin(w->stepper, 1e-6));
  double *f = fetch_nodes(w, "force", &n), *x = fetch_nodes(w, "position", &n), most = 0.0;
  ck_ok(w, mpm_step_abort(w->stepper));
  double *stress = fetch(w, set, "stress", 6);
  *inside = 0;
  for (int64_t i = 0; i < n; ++i) {
    int32_t in = 1;
    for (int32_t k = 0; k < w->dim; ++k) {
      const double from = x[k * n + i] - low;
      in &= from > (margin - 1e-9) * h && from < length - (margin - 1e-9) * h;
    }
    *inside += in;
    for (int32_t k = 0; in && k < w->dim; ++k) most = fmax(most, fabs(f[k * n + i]));
  }
  most /= largest(6 * mpm_particles_count(set), stress) * pow(h, w->dim - 1);
  free(f), free(x), free(stress);
  return most;
}

START_TEST(constant_stress_is_in_balance) {
  const method *how = &methods[_i];
  const int32_t quadratic = how->basis == MPM_BSPLINE2;
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t side = 1; side <= (dim == 3 ? 3 : 4); ++side) {
      world w;
      int64_t inside, expected = 1;
      mpm_particles *set = open_patch(&w, how, dim, side, 1);
      ck_within(how->name, imbalance(&w, set, quadratic ? 2.0 : 1.0, CELLS * h, &inside), 0.0, 1e-12);
      for (int32_t k = 0; k < dim; ++k) expected *= quadratic ? CELLS - 3 : CELLS - 1;
      ck_assert_int_eq(inside, expected);
      world_close(&w);
    }
}
END_TEST

/* A step of the affine velocity field: no acceleration inside, L everywhere, F = (I + dt L) F. */
START_TEST(affine_motion_is_exact) {
  const method *how = &methods[_i];
  const double dt = 1e-3;
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    mpm_particles *set = open_patch(&w, how, dim, 2, 1);
    const int64_t n = mpm_particles_count(set);
    double *x0 = fetch(&w, set, "position", dim), *v0 = fetch(&w, set, "velocity", dim);
    world_step(&w, dt);
    double *x = fetch(&w, set, "position", dim), *v = fetch(&w, set, "velocity", dim);
    double *F = fetch(&w, set, "deformation_gradient", 9);
    int64_t inside = 0;
    for (int64_t p = 0; p < n; ++p) {
      int32_t in = 1;
      for (int32_t k = 0; k < dim; ++k)
        in &= fabs(x0[k * n + p] - low - 0.5 * CELLS * h) < (0.5 * CELLS - 6.0) * h;
      if (!in) continue;
      ++inside;
      for (int32_t k = 0; k < dim; ++k) {
        ck_within(how->name, v[k * n + p], v0[k * n + p], 1e-12);
        ck_within(how->name, x[k * n + p], x0[k * n + p] + dt * v0[k * n + p], 1e-14);
      }
      for (int32_t c = 0; c < 9; ++c) {
        double wanted = of_dim(dim, F_patch, c, 1.0);
        for (int32_t k = 0; k < dim && c / 3 < dim && c % 3 < dim; ++k)
          wanted += dt * L_patch[c / 3 * 3 + k] * F_patch[3 * k + c % 3];
        ck_within(how->name, F[c * n + p], wanted, 1e-14);
      }
    }
    ck_assert_int_eq(inside, dim == 1 ? 4 : dim == 2 ? 16 : 64);
    free(x0), free(v0), free(x), free(v), free(F);
    world_close(&w);
  }
}
END_TEST

/* Affine transfers carry an affine field exactly, wherever the particles are and to the edge of the body. */
START_TEST(affine_transfer_of_a_cloud) {
  enum { CLOUD = 200 };
  const method *how = &methods[_i];
  if (how->transfer == MPM_FLIP) return;
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    world_desc desc = world_with(how, dim, CELLS + 8, h);
    mpm_particles *set = world_open(&w, &desc);
    dice d = {77};
    add_cloud(&w, set, &d, CLOUD, h, 1.0, 3.0, 0.0);
    double F[9], C[9], v[3 * CLOUD] = {0.0}, *x = fetch(&w, set, "position", dim);
    for (int32_t c = 0; c < 9; ++c) {
      F[c] = c % 4 == 0 ? 1.0 : 0.0; /* free of stress */
      C[c] = of_dim(dim, L_patch, c, 0.0);
      for (int64_t p = 0; p < CLOUD && c / 3 < dim && c % 3 < dim; ++p)
        v[c / 3 * CLOUD + p] += C[c] * x[c % 3 * CLOUD + p];
    }
    ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
    ck_ok(&w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, C));
    put(&w, set, "velocity", dim, v);
    world_step(&w, 1e-3);
    double *v1 = fetch(&w, set, "velocity", dim), *C1 = fetch(&w, set, "velocity_gradient", 9);
    double *F1 = fetch(&w, set, "deformation_gradient", 9);
    for (int64_t i = 0; i < CLOUD * dim; ++i) ck_within(how->name, v1[i], v[i], 1e-12);
    for (int64_t i = 0; i < CLOUD * 9; ++i) {
      ck_within(how->name, C1[i], C[i / CLOUD], 1e-12);
      ck_within(how->name, F1[i], F[i / CLOUD] + 1e-3 * C[i / CLOUD], 1e-14);
    }
    free(x), free(v1), free(C1), free(F1);
    world_close(&w);
  }
}
END_TEST

/* Particles that do not line up with the cells: the imbalance is of first order in their spacing with the
 * linear basis and of second order with the quadratic one (Steffen et al. 2008, eqs 40-42). */
START_TEST(unaligned_particles_give_the_order) {
  enum { LEVELS = 5 };
  const method *how = &methods[_i ? 0 : 10]; /* quadratic and linear FLIP by USL */
  const double length = 100.0 * h, F[9] = {1.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  double error[LEVELS], spacing[LEVELS];
  for (int32_t level = 0; level < LEVELS; ++level) {
    world w;
    world_desc desc = world_with(how, 1, 108, h);
    mpm_particles *set = world_open(&w, &desc);
    spacing[level] = h / ((1 << (level + 1)) + 0.37);
    const int64_t n = (int64_t)(length / spacing[level]);
    double *x = malloc((size_t)n * 2 * sizeof *x), *volume = x + n;
    for (int64_t p = 0; p < n; ++p) {
      x[p] = low + ((double)p + 0.5) * spacing[level];
      volume[p] = spacing[level] / F[0];
    }
    ck_ok(&w, mpm_particles_add(set, n, x, NULL, volume, NULL, NULL, NULL));
    ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
    int64_t inside;
    error[level] = imbalance(&w, set, 2.0, length - h, &inside);
    ck_assert_int_gt(inside, 90);
    free(x);
    world_close(&w);
  }
  for (int32_t level = 0; level < LEVELS; ++level)
    show("patch %s ppc %.2f imbalance %.3e order %.2f\n", how->name, h / spacing[level], error[level],
         level ? log(error[level] / error[level - 1]) / log(spacing[level] / spacing[level - 1]) : 0.0);
  const double order = log(error[LEVELS - 1] / error[0]) / log(spacing[LEVELS - 1] / spacing[0]);
  ck_within(how->name, order, _i ? 2.0 : 1.0, 0.15);
}
END_TEST

TCase *patch_case(void) {
  TCase *tc = tcase_create("patch");
  tcase_set_timeout(tc, 30.0);
  tcase_add_loop_test(tc, constant_stress_is_in_balance, 0, METHODS);
  tcase_add_loop_test(tc, affine_motion_is_exact, 0, METHODS);
  tcase_add_loop_test(tc, affine_transfer_of_a_cloud, 0, METHODS);
  tcase_add_loop_test(tc, unaligned_particles_give_the_order, 0, 2);
  return tc;
}
