/* What tests of grids and sets share: a host whose memory is counted and can be made to fail, a grid, a law,
 * a set. */
#ifndef SET_FIXTURE_H
#define SET_FIXTURE_H

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "particles/layout.h"

/* The macros of <math.h> are floats. */
#define NOT_A_NUMBER ((double)NAN)
#define INFINITE     ((double)INFINITY)

typedef struct fixture {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  int64_t held, calls, fail_at; /* bytes held; allocations so far; the one that fails, or 0 */
} fixture;

/* The call is refused with this status, and the text names what is at fault. */
#define ck_refused(context_, call, status_, text)                                                            \
  do {                                                                                                       \
    ck_assert_int_eq(call, status_);                                                                         \
    if (!strstr(mpm_last_error(context_), text))                                                             \
      ck_abort_msg("\"%s\" is not in: %s", text, mpm_last_error(context_));                                  \
  } while (0)
#define ck_ok(call) ck_assert_int_eq(call, MPM_OK)

static inline void *fixture_alloc(void *user, size_t bytes, size_t alignment) {
  fixture *f = user;
  if (++f->calls == f->fail_at) return NULL;
  void *memory = aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory) memset(memory, 0xa5, bytes);
  f->held += (int64_t)bytes;
  return memory;
}

static inline void fixture_release(void *user, void *memory, size_t bytes, size_t alignment) {
  fixture *f = user;
  (void)alignment;
  f->held -= (int64_t)bytes;
  free(memory);
}

static inline mpm_grid_desc fixture_grid(int32_t dim) {
  mpm_grid_desc desc;
  ck_ok(mpm_grid_desc_init(&desc, sizeof desc));
  desc.dim = dim;
  for (int32_t k = 0; k < dim; ++k) {
    desc.cells[k] = 10 - k;
    desc.spacing[k] = 0.5;
    desc.origin[k] = -1.0;
  }
  return desc;
}

static inline mpm_material *fixture_material(mpm_context *context, const char *model) {
  const mpm_param params[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 2e3}};
  mpm_material *material;
  ck_ok(mpm_material_create(context, model, params, 3, &material));
  return material;
}

static inline void fixture_context(fixture *f) {
  mpm_context_desc desc;
  memset(f, 0, sizeof *f);
  ck_ok(mpm_context_desc_init(&desc, sizeof desc));
  desc.alloc = fixture_alloc;
  desc.release = fixture_release;
  desc.alloc_user = f;
  ck_ok(mpm_context_create(&desc, &f->context));
}

static inline void fixture_open_on(fixture *f, const mpm_grid_desc *grid, const char *model) {
  fixture_context(f);
  ck_ok(mpm_grid_create(f->context, grid, &f->grid));
  f->material = fixture_material(f->context, model);
  ck_ok(mpm_particles_create(f->context, f->grid, f->material, &f->set));
}

static inline void fixture_open(fixture *f, int32_t dim, const char *model) {
  mpm_grid_desc grid = fixture_grid(dim);
  fixture_open_on(f, &grid, model);
}

/* Everything goes in order, and no byte is left. */
static inline void fixture_close(fixture *f) {
  ck_ok(mpm_particles_destroy(f->set));
  ck_ok(mpm_material_destroy(f->material));
  ck_ok(mpm_grid_destroy(f->grid));
  ck_ok(mpm_context_destroy(f->context));
  ck_assert_int_eq(f->held, 0);
}

/* n particles on a line inside the grid of fixture_grid(), with the given ids or their own. */
static inline void fixture_add(fixture *f, int64_t n, const int64_t *ids) {
  int32_t dim = f->grid->dim;
  double *position = malloc((size_t)(n * (dim + 1) + 1) * sizeof *position), *volume = position + n * dim;
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t k = 0; k < dim; ++k) position[k * n + i] = 0.1 * k + 0.5 * (double)i / (double)n;
    volume[i] = 0.125 * (double)(i + 1);
  }
  ck_ok(mpm_particles_add(f->set, n, position, NULL, volume, NULL, ids, NULL));
  free(position);
}

static inline double fixture_get1(const fixture *f, const char *field, int32_t components, int32_t c,
                                  int64_t id) {
  double value[81];
  ck_ok(mpm_particles_get(f->set, field, MPM_F64, components, 1, &id, value));
  return value[c];
}

/* What must not change when a call is refused. */
typedef struct fixture_counts {
  int64_t count, slots, next_id, held;
  int32_t fields, mapped;
  uint32_t dirty;
} fixture_counts;

static inline fixture_counts fixture_take(const fixture *f) {
  return (fixture_counts){f->set->count,       f->set->slots,  f->set->next_id, f->held,
                          f->set->field_count, f->set->mapped, f->set->dirty};
}

static inline void fixture_unchanged(const fixture *f, fixture_counts was) {
  fixture_counts is = fixture_take(f);
  is.held = was.held; /* capacity may have grown, and the index is a cache */
  ck_assert_int_eq(is.count, was.count);
  ck_assert_int_eq(is.slots, was.slots);
  ck_assert_int_eq(is.next_id, was.next_id);
  ck_assert_int_eq(is.fields, was.fields);
  ck_assert_int_eq(is.mapped, was.mapped);
  ck_assert_uint_eq(is.dirty, was.dirty);
}

/* Every slot is a particle or inert, in whole groups. */
static inline void fixture_check_slots(const fixture *f) {
  const mpm_particles *set = f->set;
  int32_t dim = f->grid->dim;
  int64_t live = 0;
  ck_assert_int_eq(set->slots % MPMI_PAD, 0);
  ck_assert_int_le(set->slots, set->ld);
  for (int64_t s = 0; s < set->slots; ++s) {
    double x[3];
    for (int32_t k = 0; k < dim; ++k) x[k] = mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + s];
    ck_assert_int_eq(mpmi_grid_place(f->grid, x, 1, NULL, 0), -1);
    if (mpmi_i64(set, MPMI_ID, 0)[s] >= 0) {
      ++live;
      continue;
    }
    ck_assert_int_eq(mpmi_i64(set, MPMI_ID, 0)[s], -1);
    for (int32_t g = MPMI_VELOCITY; g < set->field_count; ++g) {
      const mpmi_field *field = &set->field[g];
      if (!field->present || field->type != MPM_F64) continue;
      for (int32_t c = 0; c < field->components; ++c) {
        double wanted = g == MPMI_F && mpmi_tensor_map(dim)[c] % 4 == 0 ? 1.0 : 0.0;
        if (g == MPMI_STATE && f->material->state_initial) wanted = f->material->state_initial[c];
        ck_assert_double_eq(mpmi_f64(set, g, 0)[c * set->ld + s], wanted);
      }
    }
  }
  ck_assert_int_eq(live, set->count);
}

#endif
