/* Clusters: kernels take particles of them together and give what they give one by one; and sorts put them in
 * front of the other particles of a block. */
#include "exact.h"

#include <math.h>
#include <string.h>

#include "particles/clusters.h"
#include "transfer/kernels.h"

/* ---- kernels ------------------------------------------------------------------------------------------ */
static const double spacing = 0.25;
enum { N = 8 * MPMI_CHUNK, MOST = 16 * 16 * 16, ROWS = 3 + 3 + 2 + 6 + 9 + 3 };
enum { WHOLE, MOVED, ELSEWHERE, OF_OTHER_SIZE, KINDS }; /* what has been done to a cluster */

/* Clusters of particles of random stencils, some of which have one particle that does not fit. Sizes are all
 * the same but for those of a particle of another size. */
static void throw_clusters(int32_t dim, int32_t width, dice *d, double (*row)[N]) {
  const int32_t size = 1 << dim;
  for (int32_t r = 0; r < ROWS; ++r)
    for (int32_t p = 0; p < N; ++p) row[r][p] = r < 23 ? throw_between(d, r < 6 ? -1.0 : 0.5, 1.0) : 0.1;
  for (int32_t begin = 0; begin < N; begin += size) {
    const int32_t odd = (int32_t)throw_between(d, 0.0, size), axis = (int32_t)throw_between(d, 0.0, dim);
    for (int32_t k = 0; k < dim; ++k) {
      const double cell = floor(throw_between(d, 1.0, 4.0)) + (width == 3 ? 0.5 : 0.0);
      const double end[2] = {cell + throw_between(d, 0.05, 0.45), cell + throw_between(d, 0.55, 0.95)};
      for (int32_t i = 0; i < size; ++i) row[k][begin + i] = spacing * end[i >> (dim - 1 - k) & 1];
    }
    /* kernels take the clusters that a chunk begins with: each kind is the first of a chunk once, and the
     * last chunks are full of them */
    switch (begin < N - 2 * MPMI_CHUNK ? (begin / MPMI_CHUNK + begin / size) % KINDS : WHOLE) {
    case MOVED:
      row[axis][begin + odd] += 1e-3 * spacing;
      break;
    case ELSEWHERE:
      row[axis][begin + odd] += spacing;
      break;
    case OF_OTHER_SIZE:
      row[23 + axis][begin + odd] = 0.15;
      break;
    default:
      break;
    }
  }
}

/* What a test goes through: instruction sets, dimensions, and stencils of width 2 to 4 and of GIMP. */
enum { ISAS = 4, SETTINGS = ISAS * 3 * 4 };
typedef struct setting {
  const mpmi_kernels *kernels; /* NULL: the processor lacks them */
  int32_t dim, width, gimp;
} setting;

static setting setting_of(int32_t i) {
  const int32_t isa = MPM_ISA_BASELINE + i % ISAS, stencil = i / ISAS / 3;
  return (setting){has_isa(isa) ? mpmi_kernels_of(isa) : NULL, 1 + i / ISAS % 3,
                   stencil < 3 ? 2 + stencil : 3, stencil == 3};
}

/* The particles of throw_clusters() on a grid where they stay, or where they could move. */
static mpmi_scatter scatter_of(const setting *is, int32_t still, const double (*row)[N]) {
  mpmi_scatter job = {.weights = is->kernels->weights[is->gimp ? MPMI_FAMILY_GIMP : is->width - 2][is->dim],
                      .need = MPMI_NEED_GRADIENT | MPMI_NEED_MOMENT,
                      .mass = row[6],
                      .volume = row[7],
                      .fused_dt = 0.01,
                      .streams = {.end = N}};
  for (int32_t k = 0; k < is->dim; ++k) {
    job.axis[k] = (mpmi_axis){.spacing = spacing,
                              .inverse_spacing = 1.0 / spacing,
                              .last_cell = 9.0,
                              .middle = 8.5,
                              .still = still};
    job.points.x[k] = row[k], job.v[k] = row[3 + k], job.gravity[k] = -9.81;
    if (is->gimp) job.points.size[k] = row[23 + k];
  }
  for (int32_t c = 0; c < 6; ++c) job.stress[c] = row[8 + c];
  for (int32_t c = 0; c < 9; ++c) job.affine[c] = row[14 + c];
  return job;
}

START_TEST(clusters_give_what_their_particles_do) {
  static double row[ROWS][N], tile[2][8 * MOST];
  const setting is = setting_of(_i);
  const int32_t dim = is.dim, width = is.width;
  if (!is.kernels) return;
  dice d = {31 + (uint64_t)_i};
  throw_clusters(dim, width, &d, row);
  for (int32_t form = 0; form < MPMI_SCATTER_FORMS; ++form) {
    if (!is.kernels->scatter[dim][width][form]) continue;
    memset(tile, 0, sizeof tile);
    for (int32_t still = 0; still < 2; ++still) {
      mpmi_scatter job = scatter_of(&is, still, (const double(*)[N])row);
      job.tile = tile[still];
      is.kernels->scatter[dim][width][form](&job, 0, N);
    }
    char name[60];
    snprintf(name, sizeof name, "%d-D, width %d, form %d", (int)dim, (int)width, (int)form);
    const double most = largest(8 * MOST, tile[0]);
    ck_assert_double_gt(most, 1.0);
    for (int32_t i = 0; i < 8 * MOST; ++i) ck_within(name, tile[1][i], tile[0][i], 1e-14 * most);
    /* above one axis sums have another order, and digits show that clusters were taken as such */
    ck_assert_int_eq(memcmp(tile[0], tile[1], sizeof tile[0]) != 0, dim > 1);
  }
}
END_TEST

/* What a cluster takes has the same sums in the same order; compilers may fuse other products of them. Some
 * chunks have a hole. */
START_TEST(clusters_take_what_their_particles_do) {
  static double row[ROWS][N], tile[8 * MOST], taken[2][24][N], volume[N];
  const setting is = setting_of(_i);
  const int32_t dim = is.dim, width = is.width;
  if (!is.kernels) return;
  dice d = {67 + (uint64_t)_i};
  throw_clusters(dim, width, &d, row);
  for (int32_t i = 0; i < 8 * MOST; ++i) tile[i] = throw_between(&d, -1.0, 1.0);
  for (int32_t p = 0; p < N; ++p) volume[p] = p % 43 == 42 ? 0.0 : 1.0;
  for (int32_t form = 0; form < MPMI_GATHER_FORMS; ++form) {
    memset(taken, 0, sizeof taken);
    for (int32_t still = 0; still < 2; ++still) {
      const mpmi_scatter of = scatter_of(&is, still, (const double(*)[N])row);
      mpmi_gather job = {.weights = of.weights,
                         .need = of.need,
                         .points = of.points,
                         .initial_volume = volume,
                         .tile = tile,
                         .ld = N,
                         .v = taken[still][0],
                         .dv = taken[still][3],
                         .streams = {.end = N}};
      for (int32_t k = 0; k < dim; ++k) job.axis[k] = of.axis[k];
      for (int32_t e = 0; e < 9; ++e) job.L[e] = taken[still][6 + e], job.C[e] = taken[still][15 + e];
      is.kernels->gather[dim][width][form](&job, 0, N);
    }
    ck_assert_double_gt(largest(24 * N, taken[0][0]), 0.1);
    for (int32_t r = 0; r < 24; ++r)
      for (int32_t p = 0; p < N; ++p) ck_within("taken", taken[1][r][p], taken[0][r][p], 2e-14);
  }
}
END_TEST

/* Within a hair of the middle of a cell the stencil is that of the even node, on whose far side nothing is
 * met; beyond it, that of the nearest one. Off by so many cells from the middle between node 5, or 6, and the
 * next: */
START_TEST(middles_have_the_even_node) {
  static const double off[MPMI_CHUNK / 2] = {0.0, 1e-15, -1e-15, 5e-11, -5e-11, 1e-9, -1e-9, 0.25};
  const int32_t isa = MPM_ISA_BASELINE + _i;
  if (!has_isa(isa)) return;
  _Alignas(64) double x[MPMI_CHUNK];
  const mpmi_axis axis = {.spacing = 1.0, .inverse_spacing = 1.0, .last_cell = 15.0, .still = 1};
  const mpmi_points points = {.x = {x}};
  mpmi_weights W;
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) x[p] = 5.5 + p / (MPMI_CHUNK / 2) + off[p % (MPMI_CHUNK / 2)];
  mpmi_kernels_of(isa)->weights[MPMI_FAMILY_BSPLINE2][1](&axis, MPMI_NEED_GRADIENT, &points, 0, MPMI_CHUNK,
                                                         &W);
  for (int32_t p = 0; p < MPMI_CHUNK; ++p) {
    const double from = fabs(off[p % (MPMI_CHUNK / 2)]);
    const int64_t node = from < 1e-10 ? 6 : llround(x[p]), first = node - 1;
    double sum = 0.0, place = 0.0, slope = 0.0;
    ck_assert_int_eq(W.node[p], first);
    for (int32_t k = 0; k < 3; ++k) {
      sum += W.w[0][k][p], place += W.w[0][k][p] * (double)(first + k);
      slope += W.g[0][k][p] * ((double)(first + k) - x[p]);
    }
    ck_within("sum", sum, 1.0, 2e-10);
    ck_within("place", place, x[p], 2e-10);
    ck_within("slope", slope, 1.0, 2e-10);
    ck_within("first", W.first[0][p], (double)first - x[p], 1e-14);
    if (from < 1e-10) ck_holds(W.w[0][x[p] < 6.0 ? 2 : 0][p] == 0.0 && W.g[0][x[p] < 6.0 ? 2 : 0][p] == 0.0);
  }
}
END_TEST

/* ---- order -------------------------------------------------------------------------------------------- */
/* Returns the node whose stencil a particle has on quadratic splines: of two as near, the even one. */
static int64_t node_of(const mpm_particles *set, double x) {
  const double xi = x / set->grid->desc.spacing[0];
  const int64_t nearest = llround(xi), other = nearest + (xi < (double)nearest ? -1 : 1);
  return fabs(xi - (double)nearest) > 0.5 - 1e-9 && nearest % 2 ? other : nearest;
}

/* Returns whether the particles in some slots are a cluster of cells of the quadratic basis. */
static int32_t is_cluster(const mpm_particles *set, int32_t dim, int64_t slot) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int32_t i = 0; i < 1 << dim; ++i) {
    if (id[slot + i] < 0) return 0;
    for (int32_t k = 0; k < dim; ++k) {
      const double *x = mpmi_places(set, 0) + k * set->ld + slot;
      const int32_t end = i & 1 << (dim - 1 - k);
      if (x[i] != x[end] || node_of(set, x[i]) != node_of(set, x[0]) || (end && !(x[end] > x[0]))) return 0;
    }
  }
  return 1;
}

/* Counts the clusters of a set, in as many slots as a cluster has. */
static int64_t clusters_of(const mpm_particles *set, int32_t dim) {
  int64_t n = 0;
  for (int64_t s = 0; s < set->slots; s += 1 << dim) n += is_cluster(set, dim, s);
  return n;
}

static void shuffle(int64_t n, int64_t *order, dice *d) {
  for (int64_t i = 0; i < n; ++i) order[i] = i;
  for (int64_t i = n - 1; i > 0; --i) {
    const int64_t j = (int64_t)throw_between(d, 0.0, (double)(i + 1)), swap = order[i];
    order[i] = order[j], order[j] = swap;
  }
}

/* Adds a lattice of side^dim particles from cell `begin` on in random order, per_cell along an axis of a
 * cell, and one that stands where the first one of the lattice does. Leaves one of them out, unless `but` is
 * below 0. */
static void add_lattice(world *w, mpm_particles *set, double begin, int64_t side, int32_t per_cell,
                        int64_t but) {
  const int32_t dim = w->dim;
  const double h = w->desc.grid.spacing[0];
  int64_t n = 1, count = 0;
  for (int32_t k = 0; k < dim; ++k) n *= side;
  const int64_t all = n + (but < 0);
  double *x = malloc((size_t)(dim * all) * sizeof *x), *volume = malloc((size_t)all * sizeof *volume);
  int64_t *order = malloc((size_t)n * sizeof *order), *ids = malloc((size_t)all * sizeof *ids);
  dice d = {5 + (uint64_t)dim};
  shuffle(n, order, &d);
  for (int64_t id = 0; id <= n; ++id) {
    if (id == but) continue;
    ids[count] = id;
    volume[count] = pow(h / per_cell, dim);
    int64_t at = id < n ? order[id] : 0;
    for (int32_t k = 0; k < dim; ++k, at /= side)
      x[k * all + count] = h * (begin + ((double)(at % side) + 0.5) / per_cell);
    ++count;
  }
  ck_ok(w, mpm_particles_add(set, all, x, NULL, volume, NULL, ids, NULL));
  free(x), free(volume), free(order), free(ids);
}

static mpm_particles *open_lattice(world *w, int32_t dim, int32_t lagrangian, int64_t side,
                                   int32_t per_cell) {
  world_desc desc = world_default(dim, 24, 1.0);
  desc.grid.total_lagrangian = lagrangian;
  mpm_particles *set = world_open(w, &desc);
  add_lattice(w, set, 4.5, side, per_cell, -1);
  world_step(w, 1e-3);
  return set;
}

/* A lattice that begins in the middle of a cell, where stencils of the quadratic basis do: all of its
 * stencils are full. */
START_TEST(sorts_put_clusters_in_front) {
  const int32_t dim = 1 + _i % 3, per_cell = 2 + 2 * (_i / 3);
  const int64_t cells = 9, side = cells * per_cell, pairs = side / 2;
  world w;
  mpm_particles *set = open_lattice(&w, dim, 1, side, per_cell);
  int64_t expected = 1;
  for (int32_t k = 0; k < dim; ++k) expected *= pairs;
  ck_assert_int_eq(clusters_of(set, dim), expected);
  /* without one of its particles, which has no twin, a cluster is none, unless others of its cell take the
   * place, which four in a row do; so it is in another sort */
  const int64_t left = expected - (dim > 1 || per_cell == 2);
  const int64_t id[] = {mpmi_i64(set, MPMI_ID, 0)[1]};
  ck_ok(&w, mpm_particles_remove(set, 1, id));
  for (int32_t i = 0; i < 2; ++i) {
    world_step(&w, 1e-3);
    ck_assert_int_eq(clusters_of(set, dim), left);
    const double far[3] = {15.3, 15.3, 15.3}, volume[] = {1e-3};
    ck_ok(&w, mpm_particles_add(set, 1, far, NULL, volume, NULL, NULL, NULL));
  }
  world_close(&w);
}
END_TEST

/* Where a particle has been taken out of a cluster, the others have the order that they would have without
 * it, so that bits do not depend on when the next sort comes. */
START_TEST(broken_clusters_are_sorted) {
  const int32_t dim = 1 + _i;
  world w, other;
  world_desc desc = world_default(dim, 24, 1.0);
  desc.grid.total_lagrangian = 1;
  for (int64_t but = 0; but < 18; but += 3) {
    mpm_particles *set = open_lattice(&w, dim, 1, 18, 2);
    ck_ok(&w, mpm_particles_remove(set, 1, &but));
    world_step(&w, 1e-3);
    mpm_particles *without = world_open(&other, &desc);
    add_lattice(&other, without, 4.5, 18, 2, but);
    world_step(&other, 1e-3);
    ck_assert_int_eq(set->slots, without->slots);
    const int64_t *id = mpmi_i64(set, MPMI_ID, 0), *wanted = mpmi_i64(without, MPMI_ID, 0);
    for (int64_t s = 0; s < set->slots; ++s) ck_holds(id[s] == wanted[s] || (id[s] < 0 && wanted[s] < 0));
    world_close(&other);
    world_close(&w);
  }
}
END_TEST

/* Particles that move have no such order, and three along an axis have one cluster in each cell. */
START_TEST(sorts_leave_others_in_order) {
  const int32_t dim = 1 + _i;
  world w;
  mpm_particles *set = open_lattice(&w, dim, 0, 18, 2);
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  int64_t followers = 0;
  for (int64_t s = 1; s < set->slots; ++s) {
    int32_t block[2][3] = {{0}};
    for (int32_t i = 0; i < 2; ++i)
      mpmi_blocks_of_position(set->grid, mpmi_places(set, 0) + s - i, set->ld, MPMI_BLOCK_EDGE(dim),
                              block[i]);
    if (id[s] < 0 || id[s - 1] < 0 || memcmp(block[0], block[1], sizeof *block) != 0) continue;
    ck_holds(id[s] > id[s - 1]);
    ++followers;
  }
  ck_assert_int_gt(followers, set->count / 2);
  world_close(&w);
  set = open_lattice(&w, dim, 1, 27, 3);
  const int64_t cells[] = {9, 81, 729};
  ck_assert_int_ge(clusters_of(set, dim), cells[_i]);
  world_close(&w);
}
END_TEST

/* Three, or one, along an axis of whole cells: those in the middle of cells, and those that are so but for
 * rounding, have the stencil of the even node, with which they are four, or two, there; so over the face of a
 * grid that is periodic, too. No particle is lost. */
static const struct {
  double h, off; /* how far from the middle, in cells */
  int32_t per_cell, is_periodic;
  int64_t cells, pairs; /* of the lattice; along an axis */
} middles[] = {{1.0, 0.0, 3, 0, 6, 9}, {1.0, 1e-12, 3, 0, 6, 9},      {1.0, -1e-12, 3, 0, 6, 9},
               {0.1, 0.0, 3, 0, 6, 9}, {1.0 / 30.0, 0.0, 1, 0, 8, 3}, {0.1, 0.0, 3, 1, 13, 19}};
START_TEST(middles_of_cells_go_along) {
  const int32_t dim = 1 + _i % 3, i = _i / 3;
  const int64_t side = middles[i].cells * middles[i].per_cell;
  world w;
  world_desc desc = world_default(dim, middles[i].is_periodic ? middles[i].cells : 24, middles[i].h);
  desc.grid.total_lagrangian = 1;
  for (int32_t k = 0; k < dim; ++k) desc.grid.periodic[k] = middles[i].is_periodic;
  mpm_particles *set = world_open(&w, &desc);
  add_lattice(&w, set, (middles[i].is_periodic ? 0.0 : 4.0) + middles[i].off, side, middles[i].per_cell, -1);
  world_step(&w, 1e-6);
  int64_t expected = 1, ids = 0;
  for (int32_t k = 0; k < dim; ++k) expected *= middles[i].pairs;
  ck_assert_int_eq(clusters_of(set, dim), expected);
  for (int64_t s = 0; s < set->slots; ++s)
    if (mpmi_i64(set, MPMI_ID, 0)[s] >= 0) ids += mpmi_i64(set, MPMI_ID, 0)[s];
  ck_assert_int_eq(ids, (set->count - 1) * set->count / 2);
  world_close(&w);
}
END_TEST

TCase *clusters_case(void) {
  TCase *tc = tcase_create("clusters");
  tcase_add_loop_test(tc, clusters_give_what_their_particles_do, 0, SETTINGS);
  tcase_add_loop_test(tc, clusters_take_what_their_particles_do, 0, SETTINGS);
  tcase_add_loop_test(tc, middles_have_the_even_node, 0, ISAS);
  tcase_add_loop_test(tc, sorts_put_clusters_in_front, 0, 6);
  tcase_add_loop_test(tc, broken_clusters_are_sorted, 0, 3);
  tcase_add_loop_test(tc, sorts_leave_others_in_order, 0, 3);
  tcase_add_loop_test(tc, middles_of_cells_go_along, 0, 18);
  return tc;
}
