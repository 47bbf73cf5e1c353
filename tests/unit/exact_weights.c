/* Weights as a host sees them: the mass that one particle gives to each node is its weight, the force of a
 * unit stress its gradient. Sums that any basis must have, and the functions of reference_basis.c. */
#include "exact.h"
#include "reference.h"

/* One particle of mass and volume 1 whose stress is the identity, and a veil of particles without stress so
 * light that it only makes every node an active one. */
enum { MOST_NODES = 700 };
static const double veil_mass = 1e-6;

typedef struct view {
  world w;
  world_desc desc;
  const basis_option *basis;
  mpm_particles *veil, *one;
  int64_t n;
  double size[3], F[9]; /* of the particle */
  /* of the last look */
  int64_t index[3][MOST_NODES];
  double position[3][MOST_NODES], weight[MOST_NODES], gradient[3][MOST_NODES];
} view;

static const double spacing[3] = {0.25, 0.3, 0.2}, origin[3] = {-0.3, 0.7, 1.1};

/* Along an axis: the faces, and the middles of the cells. */
static double veil_place(const view *v, int32_t k, int64_t i) {
  const double cells = (double)v->desc.grid.cells[k];
  return origin[k] + spacing[k] * fmin(fmax((double)i - 0.5, 0.0), cells);
}

static void add_veil(view *v) {
  const int32_t dim = v->w.dim;
  int64_t n = 1, at = 0;
  for (int32_t k = 0; k < dim; ++k) n *= v->desc.grid.cells[k] + 2;
  double *x = malloc((size_t)(7 * n) * sizeof *x), *size = x + 3 * n, *volume = size + 3 * n;
  for (; at < n; ++at) {
    int64_t rest = at;
    volume[at] = 1.0;
    for (int32_t k = 0; k < dim; ++k) {
      x[k * n + at] = veil_place(v, k, rest % (v->desc.grid.cells[k] + 2));
      size[k * n + at] = 0.5 * spacing[k];
      rest /= v->desc.grid.cells[k] + 2;
    }
  }
  ck_ok(&v->w, mpm_particles_add(v->veil, n, x, NULL, volume, size, NULL, NULL));
  ck_ok(&v->w, mpm_particles_set_all(v->veil, "mass", MPM_F64, 1, &veil_mass));
  free(x);
}

static void open_view(view *v, const basis_option *basis, int32_t dim, int64_t cells, double smoothing,
                      int32_t periodic) {
  memset(v, 0, sizeof *v);
  const double stress[6] = {1.0, 1.0, 1.0, 0.0, 0.0, 0.0}, one = 1.0;
  v->basis = basis;
  v->desc = world_default(dim, cells, 1.0);
  v->desc.law.model = "linear_elastic";
  use_basis(basis, &v->desc.grid);
  v->desc.grid.smoothing = smoothing;
  for (int32_t k = 0; k < dim; ++k) {
    v->desc.grid.spacing[k] = spacing[k];
    v->desc.grid.origin[k] = origin[k];
    v->desc.grid.periodic[k] = periodic;
  }
  v->desc.sets = 2;
  world_open(&v->w, &v->desc);
  v->veil = v->w.set[0];
  v->one = v->w.set[1];
  if (!periodic) add_veil(v);
  double middle[3];
  for (int32_t k = 0; k < 3; ++k) {
    middle[k] = origin[k] + 0.5 * spacing[k] * (double)cells;
    v->size[k] = 0.5 * spacing[k];
  }
  for (int32_t c = 0; c < 9; ++c) v->F[c] = c % 4 == 0;
  ck_ok(&v->w, mpm_particles_add(v->one, 1, middle, NULL, &one, v->size, NULL, NULL));
  ck_ok(&v->w, mpm_particles_set_all(v->one, "mass", MPM_F64, 1, &one));
  ck_ok(&v->w, mpm_particles_set_all(v->one, "stress", MPM_F64, 6, stress));
}

static void set_domain(view *v, const double *size, const double *F) {
  memcpy(v->size, size, sizeof v->size);
  memcpy(v->F, F, sizeof v->F);
  ck_ok(&v->w, mpm_particles_set_all(v->one, "size", MPM_F64, v->w.dim, size));
  ck_ok(&v->w, mpm_particles_set_all(v->one, "deformation_gradient", MPM_F64, 9, F));
}

/* What the veil gives to a node. */
static double veil_on(const view *v, int64_t node) {
  double weight = veil_mass;
  for (int32_t k = 0; k < v->w.dim; ++k) {
    const reference_axis axis = reference_axis_of(&v->desc.grid, k);
    const double edge = reference_edge(&v->desc.grid, k, 0.5 * spacing[k], 1.0);
    double sum = 0.0, w, g;
    for (int64_t i = 0; i < axis.cells + 2; ++i) {
      reference_function(&axis, v->index[k][node], veil_place(v, k, i), edge, &w, &g);
      sum += w;
    }
    weight *= sum;
  }
  return weight;
}

static void look(view *v, const double *x) {
  const int32_t dim = v->w.dim;
  double volume;
  ck_ok(&v->w, mpm_particles_set_all(v->one, "position", MPM_F64, dim, x));
  ck_ok(&v->w, mpm_particles_get(v->one, "volume", MPM_F64, 1, 1, NULL, &volume));
  ck_ok(&v->w, mpm_step_begin(v->w.stepper, 1e-9));
  int64_t *index = fetch_node_indices(&v->w, &v->n);
  double *mass = fetch_nodes(&v->w, "mass", &v->n), *force = fetch_nodes(&v->w, "force", &v->n);
  double *position = fetch_nodes(&v->w, "position", &v->n);
  ck_ok(&v->w, mpm_step_abort(v->w.stepper));
  ck_assert_int_le(v->n, MOST_NODES);
  for (int64_t i = 0; i < v->n; ++i)
    for (int32_t k = 0; k < dim; ++k) {
      v->index[k][i] = index[k * v->n + i];
      v->position[k][i] = position[k * v->n + i];
      v->gradient[k][i] = -force[k * v->n + i] / volume;
    }
  for (int64_t i = 0; i < v->n; ++i)
    v->weight[i] = mass[i] - (v->desc.grid.periodic[0] ? 0.0 : veil_on(v, i));
  free(index), free(mass), free(force), free(position);
}

static void close_view(view *v) {
  world_close(&v->w);
}

/* Rounding of a place, seen through functions that bend within the edge of a domain. */
static double slack(const view *v) {
  double thin = 1.0;
  for (int32_t k = 0; k < v->w.dim && is_gimp(v->basis->basis); ++k)
    thin = fmin(thin, reference_edge(&v->desc.grid, k, v->size[k], v->F[4 * k]) / spacing[k]);
  return fmin(1e-12 + 2e-14 / thin, 1e-4);
}

/* sum w = 1, sum w x_i = x, sum grad w = 0, sum x_i grad w = I */
static void check_sums(const view *v, const double *x) {
  const int32_t dim = v->w.dim;
  const char *name = v->basis->name;
  double w = 0.0, wx[3] = {0.0, 0.0, 0.0}, g[3] = {0.0, 0.0, 0.0}, gx[9] = {0.0};
  for (int64_t i = 0; i < v->n; ++i) {
    ck_between(name, v->weight[i], -1e-15, 1.0 + 1e-15);
    w += v->weight[i];
    for (int32_t k = 0; k < dim; ++k) {
      wx[k] += v->weight[i] * (v->position[k][i] - x[k]);
      g[k] += v->gradient[k][i];
      for (int32_t j = 0; j < dim; ++j) gx[3 * k + j] += v->position[k][i] * v->gradient[j][i];
    }
  }
  ck_within(name, w, 1.0, 1e-13);
  for (int32_t k = 0; k < dim; ++k) {
    ck_within(name, wx[k], 0.0, 1e-13);
    ck_within(name, g[k], 0.0, slack(v) / spacing[k]);
    for (int32_t j = 0; j < dim; ++j) ck_within(name, gx[3 * k + j], k == j, 10.0 * slack(v));
  }
}

/* Every function that is seen is one of the grid, in its place, with its value; none is missing, or the sums
 * would show it. */
static void check_functions(const view *v, const double *x) {
  const int32_t dim = v->w.dim;
  for (int64_t i = 0; i < v->n; ++i) {
    double w[3] = {1.0, 1.0, 1.0}, g[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim; ++k) {
      const reference_axis axis = reference_axis_of(&v->desc.grid, k);
      ck_assert(v->index[k][i] >= reference_first(&axis) && v->index[k][i] <= reference_last(&axis));
      ck_within(v->basis->name, v->position[k][i], reference_node(&axis, v->index[k][i]), 1e-14);
      reference_function(&axis, v->index[k][i], x[k],
                         reference_edge(&v->desc.grid, k, v->size[k], v->F[4 * k]), &w[k], &g[k]);
    }
    ck_within(v->basis->name, v->weight[i], w[0] * w[1] * w[2], 1e-13);
    for (int32_t k = 0; k < dim; ++k)
      ck_within(v->basis->name, v->gradient[k][i], g[k] * w[(k + 1) % 3] * w[(k + 2) % 3],
                slack(v) / spacing[k]);
  }
}

/* Faces, nodes, half nodes, thirds, and their neighbourhoods first, then anywhere; in cells. */
static double place(dice *random, int32_t round, int64_t cells) {
  static const double special[] = {0.0,  0.5,    1.0,    1.5,    2.0,    1.0 / 3.0,
                                   1e-4, 0.0625, 0.9999, 1.0001, 0.4999, 2.25};
  enum { SPECIAL = sizeof special / sizeof *special };
  const double all = (double)cells;
  if (round >= 2 * SPECIAL) return throw_between(random, 0.0, all);
  const double at = fmin(special[round / 2], all);
  return round % 2 ? all - at : at;
}

static void random_domain(view *v, dice *random) {
  double size[3], F[9];
  for (int32_t k = 0; k < 3; ++k) size[k] = spacing[k % 3] * throw_between(random, 0.1, 1.0);
  for (int32_t c = 0; c < 9; ++c)
    F[c] = c / 3 < v->w.dim && c % 3 < v->w.dim && c % 4 != 0 ? throw_between(random, -0.2, 0.2) : c % 4 == 0;
  /* from far below a cell to beyond it, where cpGIMP stops */
  for (int32_t k = 0; k < v->w.dim; ++k) F[4 * k] = throw_between(random, 0.4, 3.0);
  set_domain(v, size, F);
}

START_TEST(functions_are_exact) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t dim = 1 + _i / BASES, rounds = dim == 1 ? 200 : dim == 2 ? 60 : 30;
  dice random = {(uint64_t)_i};
  view *v = malloc(sizeof *v);
  for (int32_t trial = 0; trial < 3; ++trial) {
    open_view(v, basis, dim, dim == 3 ? 4 : 7,
              trial == 0 ? basis->smoothing : throw_between(&random, 0.05, 1.0), 0);
    for (int32_t round = 0; round < rounds; ++round) {
      double x[3];
      /* in 1-D the special places in turn; else in the corners, and mixed */
      for (int32_t k = 0; k < dim; ++k) {
        const int32_t special = dim == 1 ? round : round < 8 ? (round >> k) % 2 : round + 7 * k;
        x[k] = origin[k] + spacing[k] * place(&random, special, v->desc.grid.cells[k]);
        x[k] = fmin(x[k], origin[k] + spacing[k] * (double)v->desc.grid.cells[k]);
      }
      if (is_gimp(basis->basis) && round % 3 == 2) random_domain(v, &random);
      look(v, x);
      check_sums(v, x);
      check_functions(v, x);
    }
    close_view(v);
  }
  free(v);
}
END_TEST

/* Grids of few cells, where functions of both faces meet. */
START_TEST(few_cells_are_exact) {
  const basis_option *basis = &basis_options[_i];
  dice random = {(uint64_t)_i};
  view *v = malloc(sizeof *v);
  for (int64_t cells = 1; cells <= 5; ++cells) {
    open_view(v, basis, 1, cells, basis->smoothing, 0);
    for (int32_t round = 0; round < 60; ++round) {
      const double x =
          fmin(origin[0] + spacing[0] * place(&random, round, cells), origin[0] + spacing[0] * (double)cells);
      look(v, &x);
      check_sums(v, &x);
      check_functions(v, &x);
    }
    close_view(v);
  }
  free(v);
}
END_TEST

/* The slope of what is seen: at random places, and in the cells next to the faces. */
START_TEST(gradient_is_the_slope) {
  const basis_option *basis = &basis_options[_i];
  const int64_t cells = 7;
  const double eps = 1e-5;
  dice random = {(uint64_t)_i};
  view *v = malloc(3 * sizeof *v);
  for (int32_t i = 0; i < 3; ++i) open_view(&v[i], basis, 1, cells, basis->smoothing, 0);
  for (int32_t round = 0; round < 150; ++round) {
    const double from = round % 3 == 1 ? (double)cells - 1.0 : 0.0, to = round % 3 == 0 ? 1.0 : (double)cells;
    const double xi = throw_between(&random, from + 2.0 * eps, to - 2.0 * eps);
    int32_t kink = 0; /* of slopes of the linear basis */
    kink = basis->basis == MPM_LINEAR && fabs(xi - floor(xi + 0.5)) < 2.0 * eps;
    if (kink) continue;
    for (int32_t i = 0; i < 3; ++i) {
      const double x = origin[0] + spacing[0] * (xi + eps * (i - 1));
      look(&v[i], &x);
    }
    for (int64_t i = 0; i < v[1].n; ++i) {
      double w[3] = {0.0, 0.0, 0.0};
      for (int32_t k = 0; k < 3; ++k)
        for (int64_t j = 0; j < v[k].n; ++j)
          if (v[k].index[0][j] == v[1].index[0][i]) w[k] = v[k].weight[j];
      /* second derivatives may jump: by 1 / (l h) of GIMP, which is the most */
      ck_within(basis->name, (w[2] - w[0]) / (2.0 * eps * spacing[0]), v[1].gradient[0][i],
                2.0 * eps / spacing[0]);
    }
  }
  for (int32_t i = 0; i < 3; ++i) close_view(&v[i]);
  free(v);
}
END_TEST

/* On periodic axes: the same sums, with nodes in the image next to the particle. */
START_TEST(periodic_sums_are_exact) {
  const basis_option *basis = &basis_options[_i];
  const int64_t cells = 7;
  dice random = {(uint64_t)_i};
  view *v = malloc(sizeof *v);
  for (int32_t dim = 1; dim <= 2; ++dim) {
    open_view(v, basis, dim, cells, basis->smoothing, 1);
    for (int32_t round = 24; round < 120; ++round) { /* a node of weight zero is not shown: not on nodes */
      double x[3], w = 0.0, wx = 0.0, g = 0.0, gx = 0.0;
      for (int32_t k = 0; k < dim; ++k)
        x[k] = origin[k] + spacing[k] * fmin(place(&random, round + k, cells), (double)cells * (1.0 - 1e-15));
      look(v, x);
      for (int64_t i = 0; i < v->n; ++i) {
        const double period = spacing[0] * (double)cells;
        double away = v->position[0][i] - x[0];
        away -= period * floor(away / period + 0.5);
        w += v->weight[i];
        wx += v->weight[i] * away;
        g += v->gradient[0][i];
        gx += v->gradient[0][i] * away;
      }
      /* without a veil, nodes of a weight below 1e-12 are not shown */
      ck_within(basis->name, w, 1.0, 1e-11);
      ck_within(basis->name, wx, 0.0, 1e-11);
      ck_within(basis->name, g, 0.0, 2e-6 / spacing[0]);
      ck_within(basis->name, gx, 1.0, 2e-6);
    }
    close_view(v);
  }
  free(v);
}
END_TEST

/* uGIMP is the linear basis when its domains vanish and the quadratic one when they fill a cell. */
START_TEST(ugimp_has_both_limits) {
  const basis_option *basis = &basis_options[6];
  const int64_t cells = 7;
  ck_assert_int_eq(basis->basis, MPM_UGIMP);
  dice random = {7};
  view *v = malloc(sizeof *v);
  for (int32_t wide = 0; wide < 2; ++wide) {
    open_view(v, basis, 1, cells, wide ? 1.0 : 1e-9, 0);
    reference_axis limit = reference_axis_of(&v->desc.grid, 0);
    limit.basis = wide ? MPM_BSPLINE2 : MPM_LINEAR;
    for (int32_t round = 0; round < 300; ++round) {
      const double xi = place(&random, round, cells);
      const double x = fmin(origin[0] + spacing[0] * xi, origin[0] + spacing[0] * (double)cells);
      /* the slope of the linear basis jumps at a node, that of GIMP within l of it */
      const int32_t near_node = !wide && fabs(xi - floor(xi + 0.5)) < 1e-6;
      look(v, &x);
      for (int64_t i = 0; i < v->n; ++i) {
        double w = 0.0, g = 0.0;
        if (v->index[0][i] >= reference_first(&limit) && v->index[0][i] <= reference_last(&limit))
          reference_function(&limit, v->index[0][i], x, 0.0, &w, &g);
        ck_within(basis->name, v->weight[i], w, wide ? 1e-13 : 2.5e-10 + 1e-13);
        if (!near_node) ck_within(basis->name, v->gradient[0][i], g, (wide ? 1e-12 : 1e-6) / spacing[0]);
      }
    }
    close_view(v);
  }
  free(v);
}
END_TEST

/* The domain of cpGIMP at a quarter turn is a point, at half a turn what it was; it is never wider than a
 * cell. That of GIMP does not look at F. */
START_TEST(domains_follow_the_deformation) {
  static const double turned[3][9] = {{0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0},
                                      {-0.8, 0.0, 0.0, 0.0, -1.1, 0.0, 0.0, 0.0, 1.0},
                                      {5.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 1.0}};
  const basis_option *basis = &basis_options[_i ? 7 : 5];
  const int64_t cells = 5;
  ck_assert_int_eq(basis->basis, _i ? MPM_CPGIMP : MPM_GIMP);
  const double size[3] = {0.5 * spacing[0], 0.4 * spacing[1], 0.3 * spacing[2]};
  view *v = malloc(sizeof *v);
  open_view(v, basis, 2, cells, 0.5, 0);
  for (int32_t turn = 0; turn < 3; ++turn) {
    set_domain(v, size, turned[turn]);
    for (int32_t i = 0; i < 100; ++i) {
      /* not within a vanishing domain of a node, where it matters how small it is */
      const double x[2] = {origin[0] + spacing[0] * 0.5 * (i % 10 + 0.07),
                           origin[1] + spacing[1] * 0.5 * ((double)(i / 10) + 0.43)};
      look(v, x);
      check_sums(v, x);
      check_functions(v, x);
    }
    look(v, origin); /* on a node a point as a domain has the mean of two slopes */
    check_sums(v, origin);
    for (int64_t i = 0; i < v->n; ++i)
      if (v->index[0][i] == 0) ck_within(basis->name, v->gradient[0][i], 0.0, 1e-9 / spacing[0]);
  }
  close_view(v);
  free(v);
}
END_TEST

/* The measure itself: the same sums, for every basis whether the library has it or not. */
START_TEST(reference_is_sound) {
  const basis_option *basis = &basis_options[_i];
  dice random = {(uint64_t)_i};
  for (int32_t round = 0; round < 1000; ++round) {
    const int64_t cells = 1 + round % 7;
    const reference_axis axis = {basis->basis, basis->boundary, cells, origin[0], spacing[0]};
    const double edge = spacing[0] * throw_between(&random, 0.01, 1.0);
    const double x =
        fmin(origin[0] + spacing[0] * place(&random, round, cells), origin[0] + spacing[0] * (double)cells);
    double sum[4] = {0.0, 0.0, 0.0, 0.0}, w, g;
    for (int64_t i = reference_first(&axis); i <= reference_last(&axis); ++i) {
      reference_function(&axis, i, x, edge, &w, &g);
      ck_between(basis->name, w, 0.0, 1.0 + 1e-15);
      sum[0] += w;
      sum[1] += w * reference_node(&axis, i);
      sum[2] += g;
      sum[3] += g * reference_node(&axis, i);
    }
    ck_within(basis->name, sum[0], 1.0, 1e-14);
    ck_within(basis->name, sum[1], x, 1e-14);
    ck_within(basis->name, sum[2], 0.0, 1e-13 / spacing[0]);
    ck_within(basis->name, sum[3], 1.0, 1e-12);
  }
}
END_TEST

TCase *weights_case(void) {
  TCase *tc = tcase_create("weights");
  tcase_set_timeout(tc, 60.0);
  tcase_add_loop_test(tc, reference_is_sound, 0, BASES);
  tcase_add_loop_test(tc, functions_are_exact, 0, 3 * BASES);
  tcase_add_loop_test(tc, few_cells_are_exact, 0, BASES);
  tcase_add_loop_test(tc, gradient_is_the_slope, 0, BASES);
  tcase_add_loop_test(tc, periodic_sums_are_exact, 0, BASES);
  tcase_add_test(tc, ugimp_has_both_limits);
  tcase_add_loop_test(tc, domains_follow_the_deformation, 0, 2);
  return tc;
}
