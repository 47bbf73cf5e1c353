/* Kernels that take another way to the same bits, or to the same but for rounding: nodes as two halves, nodes
 * with masses of their own, matrices by the distances of nodes from the middle one, wave speeds as squares;
 * and which contexts work by halves. */
#include "exact.h"

#include <math.h>
#include <string.h>

#include "context/context.h"
#include "transfer/kernels.h"

static const double spacing = 0.25;
enum { N = 3 * MPMI_CHUNK, MOST = 16 * 16 * 16, ROWS = 3 + 3 + 2 + 6 + 9 };

static mpmi_axis axis_of_block(void) {
  return (mpmi_axis){.spacing = spacing, .inverse_spacing = 1.0 / spacing, .last_cell = 9.0, .middle = 8.5};
}

/* Particles at random places of some cells, with random velocities, matrices, masses, volumes and
 * stresses. */
static mpmi_scatter scatter_of(const mpmi_kernels *kernels, int32_t dim, int32_t width, uint64_t seed,
                               double (*row)[N]) {
  dice d = {seed};
  mpmi_scatter job = {.weights = kernels->weights[width - 2][dim], .need = MPMI_NEED_GRADIENT};
  for (int32_t r = 0; r < ROWS; ++r)
    for (int32_t p = 0; p < N; ++p) row[r][p] = throw_between(&d, r < 6 ? -1.0 : 0.5, 1.0);
  for (int32_t k = 0; k < dim; ++k) {
    job.axis[k] = axis_of_block();
    for (int32_t p = 0; p < N; ++p) row[k][p] = spacing * throw_between(&d, 1.5, 4.5);
    job.points.x[k] = row[k], job.v[k] = row[3 + k], job.gravity[k] = -9.81;
  }
  job.mass = row[6], job.volume = row[7], job.streams.end = N;
  for (int32_t c = 0; c < 6; ++c) job.stress[c] = row[8 + c];
  for (int32_t c = 0; c < 9; ++c) job.affine[c] = row[14 + c];
  return job;
}

/* The scatter of a node in one register and that in two halves, with the same particles. */
START_TEST(halves_give_the_same_bits) {
  static double row[ROWS][N], tile[2][8 * MOST];
  if (!has_isa(MPM_ISA_AVX512)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(MPM_ISA_AVX512);
  const int32_t width = 2 + _i / 2, affine = _i % 2;
  const int32_t form[2][2] = {{MPMI_SCATTER_8, MPMI_SCATTER_8_HALVES},
                              {MPMI_SCATTER_8_AFFINE, MPMI_SCATTER_8_AFFINE_HALVES}};
  mpmi_scatter job = scatter_of(kernels, 3, width, 4 + (uint64_t)_i, row);
  memset(tile, 0, sizeof tile);
  for (int32_t halves = 0; halves < 2; ++halves) {
    job.tile = tile[halves];
    kernels->scatter[3][width][form[affine][halves]](&job, 0, N);
  }
  ck_assert(memcmp(tile[0], tile[1], sizeof tile[0]) == 0);
  double force = 0.0;
  for (int32_t i = 4; i < 8 * MOST; i += 8) force += fabs(tile[0][i]);
  ck_assert(force > 1.0);
}
END_TEST

/* Adds what a particle gives to nodes of eight values, node by node. */
static void give(int32_t dim, int32_t width, const mpmi_scatter *job, const mpmi_weights *W, int32_t p,
                 int64_t s, double *tile) {
  static const int32_t entry[2][2] = {{0, 3}, {3, 1}};
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  for (int32_t i = 0; i < (dim == 2 ? width : 1); ++i)
    for (int32_t k = 0; k < width; ++k) {
      double *node = tile + 8 * (W->node[p] + i * edge + k);
      const double outer = dim == 2 ? W->w[0][i][p] : 1.0, w = outer * W->w[last][k][p];
      const double g[2] = {dim == 2 ? W->g[0][i][p] * W->w[1][k][p] : W->g[0][k][p],
                           outer * W->g[last][k][p]};
      node[3] += w * job->mass[s];
      for (int32_t r = 0; r < dim; ++r) {
        node[r] += w * job->mass[s] * job->v[r][s];
        node[4 + r] += w * job->mass[s] * job->gravity[r];
        for (int32_t c = 0; c < dim; ++c) node[4 + r] -= g[c] * job->volume[s] * job->stress[entry[r][c]][s];
      }
    }
}

/* A flat tile has what nodes of eight values would have, and all of it is added to them. */
START_TEST(flat_tiles_have_every_value) {
  static double row[ROWS][N], flat[8 * MOST], nodes[8 * MOST], exact[8 * MOST];
  const int32_t isa = MPM_ISA_BASELINE + _i % 4, dim = 1 + _i / 4 % 2, width = 2 + _i / 8;
  if (!has_isa(isa)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(isa);
  const int32_t edge = MPMI_TILE_EDGE(dim, width), count = dim == 1 ? edge : edge * edge;
  mpmi_scatter job = scatter_of(kernels, dim, width, 14 + (uint64_t)_i, row);
  memset(flat, 0, sizeof flat), memset(nodes, 0, sizeof nodes), memset(exact, 0, sizeof exact);
  job.tile = flat;
  kernels->scatter[dim][width][MPMI_SCATTER_FLAT](&job, 0, N);
  for (int64_t s = 0; s < N; s += MPMI_CHUNK) {
    mpmi_weights W;
    job.weights(job.axis, job.need, &job.points, s, MPMI_CHUNK, &W);
    for (int32_t p = 0; p < MPMI_CHUNK; ++p) give(dim, width, &job, &W, p, s + p, exact);
  }
  for (int32_t i = 5 * count; i < 8 * MOST; ++i) ck_assert(flat[i] == 0.0);
  const mpmi_box box = {.tile = flat,
                        .masses = mpmi_flat_masses(dim, width, flat),
                        .nodes = nodes,
                        .count = {1, dim == 1 ? 1 : edge, edge},
                        .tile_stride = {count, edge},
                        .node_stride = {count, edge}};
  kernels->add_flat_box(&box);
  for (int32_t i = 0; i < 8 * count; ++i) ck_within("a node", nodes[i], exact[i], 1e-12);
  for (int32_t i = 0; i < 8 * MOST; ++i) ck_assert(flat[i] == 0.0);
  double mass = 0.0;
  for (int32_t i = 3; i < 8 * count; i += 8) mass += nodes[i];
  ck_assert(mass > 0.5 * N);
}
END_TEST

/* Compares so many values, of which some are not small. */
static void same_values(const double *a, const double *b, int32_t count) {
  double most = 0.0;
  for (int32_t i = 0; i < count; ++i) {
    ck_within("a value", a[i], b[i], 2e-14);
    most = fmax(most, fabs(b[i]));
  }
  ck_assert(most > 0.1);
}

/* Where nodes are a spacing apart, momentum grows from one to the next as weights of its own would have
 * it. */
START_TEST(even_nodes_take_what_all_do) {
  static double row[ROWS][N], tile[2][8 * MOST];
  const int32_t isa = MPM_ISA_BASELINE + _i % 4, dim = 1 + _i / 4 % 3, width = 2 + _i / 12;
  if (!has_isa(isa)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(isa);
  mpmi_scatter job = scatter_of(kernels, dim, width, 70 + (uint64_t)_i, row);
  job.need = MPMI_NEED_GRADIENT | MPMI_NEED_MOMENT;
  memset(tile, 0, sizeof tile);
  for (int32_t uneven = 0; uneven < 2; ++uneven) {
    job.tile = tile[uneven];
    const int32_t eight = uneven ? MPMI_SCATTER_8_UNEVEN : MPMI_SCATTER_8_AFFINE;
    const int32_t flat = uneven ? MPMI_SCATTER_FLAT_UNEVEN : MPMI_SCATTER_FLAT_AFFINE;
    kernels->scatter[dim][width][dim == 3 ? eight : flat](&job, 0, N);
  }
  same_values(tile[0], tile[1], 8 * MOST);
}
END_TEST

/* Gathers from a tile what the particles of a scatter take: v, dv, L and C in rows of `taken`. */
static void gather_into(const mpmi_scatter *of, const mpmi_kernels *kernels, int32_t dim, int32_t width,
                        int32_t form, int32_t need, const double *volume, const double *tile,
                        double (*taken)[N]) {
  mpmi_gather job = {.weights = of->weights,
                     .need = need,
                     .points = of->points,
                     .initial_volume = volume,
                     .tile = tile,
                     .ld = N,
                     .v = taken[0],
                     .dv = taken[3],
                     .streams = {.end = N}};
  for (int32_t k = 0; k < dim; ++k) job.axis[k] = of->axis[k];
  for (int32_t e = 0; e < 9; ++e) job.L[e] = taken[6 + e], job.C[e] = taken[15 + e];
  kernels->gather[dim][width][form](&job, 0, N);
}

/* Values of nodes, and volumes of particles, of which some are holes. */
static void throw_nodes(uint64_t seed, double *tile, double *volume) {
  dice d = {seed};
  for (int32_t i = 0; i < 8 * MOST; ++i) tile[i] = throw_between(&d, -1.0, 1.0);
  for (int32_t p = 0; p < N; ++p) volume[p] = p % 11 ? 1.0 : 0.0;
}

/* What particles take back of it is the same as well, where all have the same second moments. */
START_TEST(even_nodes_give_what_all_do) {
  static double row[ROWS][N], tile[8 * MOST], taken[2][24][N], volume[N];
  static const int32_t form[2][2] = {{MPMI_GATHER_AFFINE, MPMI_GATHER_AFFINE_VARIED},
                                     {MPMI_GATHER_BOTH_AFFINE, MPMI_GATHER_BOTH_AFFINE_VARIED}};
  const int32_t isa = MPM_ISA_BASELINE + _i % 4, dim = 1 + _i / 4 % 3, width = 3 + _i / 12;
  if (!has_isa(isa)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(isa);
  const mpmi_scatter of = scatter_of(kernels, dim, width, 90 + (uint64_t)_i, row);
  throw_nodes(7 + (uint64_t)_i, tile, volume);
  for (int32_t both = 0; both < 2; ++both) {
    memset(taken, 0, sizeof taken);
    for (int32_t varied = 0; varied < 2; ++varied)
      gather_into(&of, kernels, dim, width, form[both][varied],
                  MPMI_NEED_GRADIENT | (varied ? MPMI_NEED_MOMENT : 0), volume, tile, taken[varied]);
    same_values(taken[0][0], taken[1][0], 24 * N);
    for (int32_t e = 0; e < 24; ++e) ck_assert(taken[0][e][0] == 0.0); /* holes take nothing */
  }
}
END_TEST

/* Without the gradient velocities and their changes have the bits that they have beside it. */
START_TEST(velocities_alone_are_the_same) {
  static double row[ROWS][N], tile[8 * MOST], taken[2][24][N], volume[N];
  static const int32_t form[2][2] = {{MPMI_GATHER_MEAN, MPMI_GATHER_PLAIN},
                                     {MPMI_GATHER_CHANGE, MPMI_GATHER_BOTH}};
  const int32_t isa = MPM_ISA_BASELINE + _i % 4, dim = 1 + _i / 4 % 3, width = 2 + _i / 12;
  if (!has_isa(isa)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(isa);
  const mpmi_scatter of = scatter_of(kernels, dim, width, 110 + (uint64_t)_i, row);
  throw_nodes(9 + (uint64_t)_i, tile, volume);
  for (int32_t both = 0; both < 2; ++both) {
    memset(taken, 0, sizeof taken);
    for (int32_t gradient = 0; gradient < 2; ++gradient)
      gather_into(&of, kernels, dim, width, form[both][gradient],
                  gradient ? MPMI_NEED_GRADIENT | MPMI_NO_FIRST : 0, volume, tile, taken[gradient]);
    ck_assert_mem_eq(taken[0], taken[1], 6 * N * sizeof(double));
    for (int32_t e = 0; e < 6; ++e) ck_assert(taken[0][e][0] == 0.0);
    for (int32_t e = 6; e < 15; ++e) ck_assert(taken[0][e][1] == 0.0);
  }
}
END_TEST

/* Whatever the squares of wave speeds let be passed over: the largest rate is the same in every bit, also
 * where it is far above all others, comes last, or is that of a particle at rest. */
START_TEST(squares_lead_to_the_same_rate) {
  static double x[3][N], v[3][N], mass[N], volume[N], speed[N], square[N], energy[N];
  const int32_t isa = MPM_ISA_BASELINE + _i % 4, dim = 1 + _i / 4;
  if (!has_isa(isa)) return;
  const mpmi_kernels *kernels = mpmi_kernels_of(isa);
  dice d = {40 + (uint64_t)_i};
  mpmi_sums_job job = {.what = MPMI_SUMS_LAW | MPMI_SUMS_MOTION,
                       .ld = N,
                       .mass = mass,
                       .initial_volume = volume,
                       .energy = energy,
                       .carried = 1.0};
  for (int32_t k = 0; k < dim; ++k) {
    job.x[k] = x[k], job.v[k] = v[k];
    job.spacing[k] = spacing * (k + 1.0), job.inverse_spacing[k] = 1.0 / job.spacing[k];
  }
  for (int32_t round = 0; round < 200; ++round) {
    mpmi_sums sums[2] = {{.rate = 0.0}, {.rate = 0.0}};
    const double spread = pow(10.0, throw_between(&d, -16.0, 2.0));
    for (int32_t p = 0; p < N; ++p) {
      for (int32_t k = 0; k < dim; ++k) v[k][p] = round % 3 ? throw_between(&d, -1.0, 1.0) : 0.0;
      mass[p] = volume[p] = p % 7 ? 1.0 : 0.0; /* holes have neither */
      square[p] = 1.0 + spread * throw_between(&d, 0.0, 1.0) + (round % 2 ? spread * p : 0.0);
      square[p] *= round % 4 ? 1.0 : 1e-8; /* slower than most particles move */
      if (round % 5 == 4 && p == 1 + round % (N - 1)) square[p] *= 1.0 + 4e-16;
      speed[p] = sqrt(square[p]);
    }
    for (job.squared = 0; job.squared < 2; ++job.squared) {
      job.wave_speed = job.squared ? square : speed;
      for (int64_t s = 0; s < 2; ++s) ck_assert(!kernels->sums[dim](&job, N, &sums[job.squared]));
    }
    ck_assert(sums[0].rate > 0.0 && sums[0].rate == sums[1].rate);
  }
  mpmi_sums sums = {.rate = 1e300};
  job.squared = 1, job.wave_speed = square;
  square[N - 2] = -1.0, volume[N - 2] = 0.0; /* no speed has this square, which is of no interest in a hole */
  ck_assert(!kernels->sums[dim](&job, N, &sums));
  volume[N - 2] = 1.0;
  ck_assert(kernels->sums[dim](&job, N, &sums) & MPMI_NONFINITE);
  job.what = MPMI_SUMS_LAW; /* where the law runs before particles move */
  ck_assert(kernels->sums[dim](&job, N, &sums) & MPMI_NONFINITE);
}
END_TEST

/* Processors are asked once; other instruction sets have no such registers. */
START_TEST(only_wide_registers_are_halved) {
  if (!has_isa(MPM_ISA_BASELINE + _i)) return;
  mpm_context_desc desc;
  mpm_context *context;
  ck_assert(mpm_context_desc_init(&desc, sizeof desc) == MPM_OK);
  desc.isa = MPM_ISA_BASELINE + _i;
  ck_assert(mpm_context_create(&desc, &context) == MPM_OK);
  ck_assert(desc.isa == MPM_ISA_AVX512 || !context->works_by_halves);
  ck_assert(mpm_context_destroy(context) == MPM_OK);
}
END_TEST

TCase *kernels_case(void) {
  TCase *tc = tcase_create("kernels");
  tcase_add_loop_test(tc, halves_give_the_same_bits, 0, 6);
  tcase_add_loop_test(tc, even_nodes_take_what_all_do, 0, 36);
  tcase_add_loop_test(tc, velocities_alone_are_the_same, 0, 36);
  tcase_add_loop_test(tc, even_nodes_give_what_all_do, 0, 24);
  tcase_add_loop_test(tc, flat_tiles_have_every_value, 0, 24);
  tcase_add_loop_test(tc, squares_lead_to_the_same_rate, 0, 12);
  tcase_add_loop_test(tc, only_wide_registers_are_halved, 0, 4);
  return tc;
}
