/* Each body has nodes of its own: bodies at one place pass through each other as if each were alone. */
#include "tables.h"
#include "world.h"

#include "stepper/stepper.h"

/* ---- blocks ---- */
/* Blocks of three bodies, in no order. At the seam of a periodic axis they need those on its other side,
 * where one of the bodies has no particles. */
START_TEST(blocks_of_bodies) {
  const int32_t dim = _i + 1, bodies[6] = {4095, 0, 2, 0, 4095, 2}, at[6] = {0, 3, 0, 0, 1, 3};
  world_desc desc = world_default(dim, 4 * MPMI_BLOCK_EDGE(dim), 0.5);
  desc.grid.periodic[0] = 1;
  desc.bare = 1;
  world w;
  world_open(&w, &desc);
  mpmi_blocks blocks;
  mpmi_blocks_init(&blocks, w.grid);
  int32_t provisional[6];
  for (int32_t i = 0; i < 6; ++i) {
    const int32_t coord[3] = {at[i], dim > 1, dim > 2};
    int32_t again;
    ck_ok(&w, mpmi_blocks_insert(&blocks, bodies[i], coord, &provisional[i]));
    ck_ok(&w, mpmi_blocks_insert(&blocks, bodies[i], coord, &again));
    ck_assert_int_eq(again, provisional[i]);
  }
  ck_assert_int_eq(blocks.count, 6);
  ck_ok(&w, mpmi_blocks_order(&blocks));

  for (int64_t b = 0; b < blocks.count; ++b) {
    if (b) {
      ck_holds(blocks.key[b - 1] <= blocks.key[b]);
      ck_holds(blocks.key[b - 1] < blocks.key[b] || blocks.body[b - 1] < blocks.body[b]);
    }
    for (int32_t n = 0; n < blocks.neighbours; ++n) {
      const int32_t other = blocks.neighbour[b][n];
      ck_holds(other == MPMI_NO_BLOCK || blocks.body[other] == blocks.body[b]);
    }
    for (int32_t n = 0; n < blocks.nodes; ++n) {
      int64_t index[3];
      mpmi_blocks_index(&blocks, b * blocks.nodes + n, index);
      ck_holds(mpmi_blocks_node(&blocks, blocks.body[b], index) == b * blocks.nodes + n);
      ck_holds(mpmi_blocks_node(&blocks, 1, index) < 0);
    }
  }
  for (int32_t i = 0; i < 6; ++i) {
    const uint32_t b = blocks.order[provisional[i]];
    ck_assert_int_eq(blocks.body[b], bodies[i]);
    ck_assert_int_eq(blocks.coord[b][0], at[i]);
    for (int32_t n = 0; n < blocks.neighbours; ++n) ck_holds(blocks.neighbour[b][n] >= 0);
    /* the node on the seam has its image at the other end */
    if (at[i] != 0) continue;
    const int64_t seam[3] = {4 * blocks.edge - 1, (dim > 1) * blocks.edge, (dim > 2) * blocks.edge};
    ck_holds(mpmi_blocks_node(&blocks, bodies[i], seam) >= 0);
  }
  mpmi_blocks_free(&blocks);
  world_close(&w);
}
END_TEST

/* So many bodies at one place that their entries meet in the hash table. */
START_TEST(many_bodies) {
  enum { MANY = 1000 };
  const int32_t coord[3] = {1, 1, 1};
  world_desc desc = world_default(2, 4 * MPMI_BLOCK_EDGE(2), 0.5);
  desc.bare = 1;
  world w;
  world_open(&w, &desc);
  mpmi_blocks blocks;
  mpmi_blocks_init(&blocks, w.grid);
  for (int32_t round = 0; round < 2; ++round)
    for (int32_t i = 0; i < MANY; ++i) {
      int32_t block;
      ck_ok(&w, mpmi_blocks_insert(&blocks, MANY - 1 - i, coord, &block));
      ck_holds(block == i);
    }
  ck_ok(&w, mpmi_blocks_order(&blocks));
  ck_assert_int_eq(blocks.count, 9 * MANY);
  const int64_t index[3] = {MPMI_BLOCK_EDGE(2), MPMI_BLOCK_EDGE(2), 0};
  for (int32_t body = 0; body < MANY; ++body) {
    const int64_t slot = mpmi_blocks_node(&blocks, body, index);
    ck_holds(slot >= 0 && blocks.body[slot / blocks.nodes] == body);
    ck_holds(slot / blocks.nodes == blocks.order[MANY - 1 - body]);
  }
  mpmi_blocks_free(&blocks);
  world_close(&w);
}
END_TEST

/* ---- steps ---- */
enum { FIRST = 1, SECOND = 2 };

/* Two cubes that overlap by half and move through each other and against walls of every kind, or on a
 * periodic axis; or one of them alone. */
static void open_cubes(world *w, const method *how, int32_t dim, int32_t periodic, int32_t which) {
  const double h = 0.25, size = h * (double)(2 * MPMI_BLOCK_EDGE(dim));
  const double low[2] = {0.0, 0.15 * size}, high[2] = {0.3 * size, 0.45 * size};
  const int32_t kind[6] = {MPM_WALL_SLIP, MPM_WALL_OPEN,  MPM_WALL_FRICTION,
                           MPM_WALL_NONE, MPM_WALL_FIXED, MPM_WALL_OPEN};
  world_desc desc = world_with(how, dim, 2 * MPMI_BLOCK_EDGE(dim), h);
  desc.grid.periodic[0] = periodic;
  desc.sets = 1;
  world_open(w, &desc);
  if (which == (FIRST | SECOND)) {
    world_add_set(w, NULL);
    mpm_contact_desc none;
    ck_ok(w, mpm_contact_desc_init(&none, sizeof none));
    none.kind = MPM_CONTACT_NONE;
    ck_ok(w, mpm_stepper_set_contact(w->stepper, 2, MPM_BODY_ANY, &none));
    ck_ok(w, mpm_stepper_set_body(w->stepper, w->set[0], 2));
    ck_ok(w, mpm_stepper_set_body(w->stepper, w->set[1], 1));
  }
  for (int32_t i = 0, m = 0; i < 2; ++i) {
    if (!(which & (i ? SECOND : FIRST))) continue;
    mpm_particles *set = w->set[m++];
    const int64_t n = world_fill_cube(w, set, low[i], high[i]);
    double *v = calloc((size_t)(dim * n), sizeof *v);
    for (int64_t p = 0; p < dim * n; ++p)
      v[p] = (p < n && i == 0 ? 3.0 : -3.0) + noise_at((uint64_t)(p + i * dim * n));
    put(w, set, "velocity", dim, v);
    free(v);
  }
  for (int32_t face = 2 * periodic; face < 2 * dim; ++face)
    ck_ok(w, mpm_stepper_set_wall(w->stepper, face, kind[face], kind[face] == MPM_WALL_FRICTION ? 0.3 : 0.0));
}

static void same_fields(const world *both, int32_t m, const world *alone, const char *name) {
  size_t size, size_alone;
  char *fields = world_fields(both, m, &size), *fields_alone = world_fields(alone, 0, &size_alone);
  ck_assert_uint_eq(size, size_alone);
  if (memcmp(fields, fields_alone, size) != 0) ck_abort_msg("%s: set %d is not as it is alone", name, (int)m);
  free(fields);
  free(fields_alone);
}

START_TEST(bodies_as_if_alone) {
  const method *how = broad_methods[_i];
  if (how->scheme == MPM_NEWMARK) return; /* one linear system for all bodies: its solution is not exact */
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t periodic = 0; periodic < 2; ++periodic) {
      if (dim == 1 && how->remedy) continue;
      world both, alone[2];
      open_cubes(&both, how, dim, periodic, FIRST | SECOND);
      open_cubes(&alone[0], how, dim, periodic, FIRST);
      open_cubes(&alone[1], how, dim, periodic, SECOND);
      for (int32_t i = 0; i < 8; ++i) {
        world_step(&both, 2e-3);
        for (int32_t m = 0; m < 2; ++m) world_step(&alone[m], 2e-3);
      }
      for (int32_t m = 0; m < 2; ++m) {
        same_fields(&both, m, &alone[m], how->name);
        world_close(&alone[m]);
      }
      world_close(&both);
    }
}
END_TEST

Suite *bodies_suite(void);
Suite *bodies_suite(void) {
  Suite *suite = suite_create("bodies");
  TCase *blocks = tcase_create("blocks"), *steps = tcase_create("steps");
  tcase_add_loop_test(blocks, blocks_of_bodies, 0, 3);
  tcase_add_test(blocks, many_bodies);
  add_sparse(steps, bodies_as_if_alone, BROAD, 5);
  tcase_set_timeout(steps, 60);
  suite_add_tcase(suite, blocks);
  suite_add_tcase(suite, steps);
  return suite;
}
