#include "sets.h"

mpm_grid_desc sets_grid(int32_t dim) {
  mpm_grid_desc d = grid_desc(dim, 10, 0.5);
  for (int32_t k = 0; k < dim; ++k) d.cells[k] -= k, d.origin[k] = -1.0;
  return d;
}

world_desc sets_desc(const mpm_grid_desc *grid, const char *model) {
  world_desc d = world_default(grid->dim, 1, 1.0);
  d.grid = *grid;
  d.law = (world_law){.model = model, .E = 1e6, .nu = 0.3, .density = 2e3};
  d.memory.filling = 0xa5; /* this is neither a number that spreads nor the id of an inert slot */
  d.bare = 1;
  return d;
}

void sets_open_on(world *w, const mpm_grid_desc *grid, const char *model, int64_t n) {
  const world_desc d = sets_desc(grid, model);
  if (w->context) world_close(w);
  world_open(w, &d);
  if (n) sets_add(w, n, NULL);
}

void sets_open(world *w, int32_t dim, const char *model, int64_t n) {
  const mpm_grid_desc grid = sets_grid(dim);
  sets_open_on(w, &grid, model, n);
}

void sets_close(world *w) {
  sets_check_slots(w);
  world_close(w);
}

void sets_add(world *w, int64_t n, const int64_t *ids) {
  int32_t dim = w->dim;
  double *position = malloc((size_t)(n * (dim + 1) + 1) * sizeof *position), *volume = position + n * dim;
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t k = 0; k < dim; ++k) position[k * n + i] = 0.1 * k + 0.5 * (double)i / (double)n;
    volume[i] = 0.125 * (double)(i + 1);
  }
  ck_ok(w, mpm_particles_add(w->set[0], n, position, NULL, volume, NULL, ids, NULL));
  free(position);
}

double sets_get(const world *w, const char *field, int32_t components, int32_t c, int64_t id) {
  return fetch1(w, w->set[0], field, components, c, id);
}

sets_counts sets_take(const world *w) {
  const mpm_particles *set = w->set[0];
  return (sets_counts){set->count,       set->slots,  set->next_id, w->memory.held,
                       set->field_count, set->mapped, set->dirty};
}

void sets_unchanged(const world *w, sets_counts was) {
  sets_counts is = sets_take(w);
  is.held = was.held; /* capacity may have grown, and the index is a cache */
  ck_assert_int_eq(is.count, was.count);
  ck_assert_int_eq(is.slots, was.slots);
  ck_assert_int_eq(is.next_id, was.next_id);
  ck_assert_int_eq(is.fields, was.fields);
  ck_assert_int_eq(is.mapped, was.mapped);
  ck_assert_uint_eq(is.dirty, was.dirty);
}

void sets_check_slots(const world *w) {
  const mpm_particles *set = w->set[0];
  int32_t dim = w->dim;
  int64_t live = 0;
  ck_assert_int_eq(set->slots % MPMI_PAD, 0);
  ck_assert_int_le(set->slots, set->ld);
  for (int64_t s = 0; s < set->slots; ++s) {
    double x[3];
    for (int32_t k = 0; k < dim; ++k) x[k] = mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + s];
    ck_assert_int_eq(mpmi_grid_place(w->grid, x, 1, NULL, 0), -1);
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
        if (g == MPMI_STATE && w->material[0]->state_initial) wanted = w->material[0]->state_initial[c];
        ck_assert_double_eq(mpmi_f64(set, g, 0)[c * set->ld + s], wanted);
      }
    }
  }
  ck_assert_int_eq(live, set->count);
}
