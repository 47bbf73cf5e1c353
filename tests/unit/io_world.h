/* What tests of states share: two bodies of different laws in a stepper, with fields of the host, that move
 * fast enough to be sorted anew every few steps. */
#ifndef IO_WORLD_H
#define IO_WORLD_H

#include <stdio.h>

#include "io/state.h"
#include "set_fixture.h"

enum { WORLD_SETS = 2 };

typedef struct io_setup {
  int32_t dim, transfer, scheme, periodic, concurrency, references, empty;
} io_setup;

typedef struct io_world {
  fixture f; /* context and grid; its set is the first */
  mpm_material *material[WORLD_SETS];
  mpm_particles *set[WORLD_SETS];
  mpm_stepper *stepper;
} io_world;

static inline io_setup io_plain(int32_t dim) {
  return (io_setup){.dim = dim, .transfer = MPM_FLIP, .scheme = MPM_USL, .concurrency = 1};
}

static inline void io_open_context(io_world *w, int32_t concurrency) {
  mpm_context_desc desc;
  memset(w, 0, sizeof *w);
  ck_ok(mpm_context_desc_init(&desc, sizeof desc));
  desc.alloc = fixture_alloc;
  desc.release = fixture_release;
  desc.alloc_user = &w->f;
  desc.concurrency = concurrency;
  ck_ok(mpm_context_create(&desc, &w->f.context));
}

static inline void io_open_sets(io_world *w) {
  const mpm_param hard[] = {
      {"E", 2e6}, {"nu", 0.2}, {"density", 1e3}, {"yield_stress", 1e4}, {"hardening", 1e4}};
  mpm_context *context = w->f.context;
  w->material[0] = fixture_material(context, "neo_hookean");
  ck_ok(mpm_material_create(context, "j2", hard, 5, &w->material[1]));
  for (int32_t m = 0; m < WORLD_SETS; ++m)
    ck_ok(mpm_particles_create(context, w->f.grid, w->material[m], &w->set[m]));
  w->f.set = w->set[0];
}

static inline void io_add_fields(io_world *w) {
  ck_ok(mpm_particles_add_field(w->set[0], "colour", MPM_U8, 3));
  ck_ok(mpm_particles_add_field(w->set[0], "temperature", MPM_F64, 1));
  ck_ok(mpm_particles_add_field(w->set[1], "grain", MPM_I64, 2));
}

static inline mpm_stepper_desc io_stepper_desc(const io_setup *setup) {
  mpm_stepper_desc desc;
  ck_ok(mpm_stepper_desc_init(&desc, sizeof desc));
  desc.scheme = setup->scheme;
  desc.transfer = setup->transfer;
  desc.reference_positions = setup->references;
  desc.gravity[0] = -3.0;
  return desc;
}

static inline void io_open_stepper(io_world *w, const io_setup *setup) {
  const mpm_stepper_desc desc = io_stepper_desc(setup);
  ck_ok(mpm_stepper_create(w->f.context, w->f.grid, &desc, &w->stepper));
  for (int32_t m = 0; m < WORLD_SETS; ++m) ck_ok(mpm_stepper_add(w->stepper, w->set[m]));
  for (int32_t face = 0; face < 2 * setup->dim; ++face)
    if (!setup->periodic || face / 2) ck_ok(mpm_stepper_set_wall(w->stepper, face, MPM_WALL_SLIP, 0.0));
}

/* Bodies on a collision course, and values in the host's fields that tell the particles apart. */
static inline void io_fill(io_world *w, int32_t dim) {
  const double lower[WORLD_SETS][3] = {{-0.5, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  const double upper[WORLD_SETS][3] = {{1.0, 1.0, 1.0}, {3.0, 1.5, 1.0}};
  const double speed[WORLD_SETS][3] = {{12.0, 5.0, 3.0}, {-9.0, 2.0, 4.0}};
  const int32_t per_cell[] = {3, 2, 2};
  for (int32_t m = 0; m < WORLD_SETS; ++m) {
    ck_ok(mpm_particles_fill_box(w->set[m], lower[m], upper[m], per_cell, NULL, NULL));
    ck_ok(mpm_particles_set_all(w->set[m], "velocity", MPM_F64, dim, speed[m]));
  }
  for (int64_t id = 0; id < w->set[0]->count; ++id) {
    const uint8_t colour[] = {(uint8_t)id, (uint8_t)(id / 3), 255};
    const double temperature = 0.1 * (double)id;
    ck_ok(mpm_particles_set(w->set[0], "colour", MPM_U8, 3, 1, &id, colour));
    ck_ok(mpm_particles_set(w->set[0], "temperature", MPM_F64, 1, 1, &id, &temperature));
  }
  for (int64_t id = 0; id < w->set[1]->count; ++id) {
    const int64_t grain[] = {id * id, -id};
    ck_ok(mpm_particles_set(w->set[1], "grain", MPM_I64, 2, 1, &id, grain));
  }
}

static inline mpm_grid_desc io_grid(const io_setup *setup) {
  mpm_grid_desc desc = fixture_grid(setup->dim);
  desc.cells[0] = 140; /* several blocks */
  desc.origin[0] = -35.0;
  desc.periodic[0] = setup->periodic;
  return desc;
}

static inline void io_open(io_world *w, const io_setup *setup) {
  const mpm_grid_desc grid = io_grid(setup);
  io_open_context(w, setup->concurrency);
  ck_ok(mpm_grid_create(w->f.context, &grid, &w->f.grid));
  io_open_sets(w);
  io_add_fields(w);
  io_open_stepper(w, setup);
  if (!setup->empty) io_fill(w, setup->dim);
}

static inline void io_close(io_world *w) {
  ck_ok(mpm_stepper_destroy(w->stepper));
  for (int32_t m = 0; m < WORLD_SETS; ++m) ck_ok(mpm_particles_destroy(w->set[m]));
  for (int32_t m = 0; m < WORLD_SETS; ++m) ck_ok(mpm_material_destroy(w->material[m]));
  ck_ok(mpm_grid_destroy(w->f.grid));
  ck_ok(mpm_context_destroy(w->f.context));
  ck_assert_int_eq(w->f.held, 0);
}

static inline void io_steps(io_world *w, int32_t n) {
  for (int32_t i = 0; i < n; ++i)
    if (mpm_step(w->stepper, 0.004, NULL)) ck_abort_msg("%s", mpm_last_error(w->f.context));
}

static inline uint64_t io_hash(const io_world *w) {
  uint64_t hash = 0;
  ck_ok(mpm_state_hash(w->stepper, &hash));
  return hash;
}

typedef struct io_buffer {
  unsigned char *data;
  int64_t bytes;
} io_buffer;

static inline io_buffer io_save(const io_world *w) {
  io_buffer b;
  ck_ok(mpm_state_size(w->stepper, &b.bytes));
  b.data = malloc((size_t)b.bytes);
  ck_ok(mpm_state_save(w->stepper, b.data, b.bytes));
  return b;
}

static inline void io_load(io_world *w, const io_buffer *b) {
  if (mpm_state_load(w->stepper, b->data, b->bytes)) ck_abort_msg("%s", mpm_last_error(w->f.context));
}

/* A file in the directory for scratch files. */
static inline const char *io_path(const char *name, char *path, size_t capacity) {
  const char *scratch = getenv("MPM_SCRATCH");
  snprintf(path, capacity, "%s/%s", scratch ? scratch : ".", name);
  return path;
}

TCase *io_state_case(void);
TCase *io_unlike_case(void);
TCase *io_damage_case(void);
TCase *io_hash_case(void);
TCase *io_file_case(void);
TCase *io_output_case(void);
TCase *io_grid_case(void);

#endif
