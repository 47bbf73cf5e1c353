/* Memory of implicit steps: what stays with the stepper, and what the tasks of one step assemble with. */
#include "implicit/balance.h"
#include "context/arena.h"
#include "context/transport.h"
#include "layout/tile.h"

#include <string.h>

static double *take_rows(mpmi_arena *from, int64_t rows, int64_t length) {
  return mpmi_arena_take(from, rows * length, sizeof(double));
}

static void lay_out(const mpmi_balance *balance, mpmi_arena *from, mpmi_newton_work *to) {
  const mpm_grid *grid = balance->settings->grid;
  const int64_t row = grid->dim * MPMI_STENCIL_NODES(grid->dim, grid->width);
  const int64_t tile = mpmi_tile_nodes(grid);
  int64_t length = 0;
  size_t tangent = 0;
  for (int32_t m = 0; m < balance->layout->member_count; ++m) {
    const mpm_material *material = balance->layout->member[m].set->material;
    const int64_t ld = mpmi_law_batch_length(material);
    const size_t bytes = mpmi_material_tangent_scratch(material, ld);
    length = ld > length ? ld : length;
    tangent = bytes > tangent ? bytes : tangent;
  }
  balance->newton->batch_length = length;
  to->F_inc = take_rows(from, 9, length);
  to->nominal = take_rows(from, 9, length);
  to->stiffness = take_rows(from, 81, length);
  to->tangent = take_rows(from, 81, length);
  to->weight = take_rows(from, 1, length);
  to->h = take_rows(from, 9, length);
  to->k = take_rows(from, 9, length);
  to->q = take_rows(from, 1, length);
  to->inverse = take_rows(from, 9, length);
  to->tangent_scratch = mpmi_arena_take(from, (int64_t)tangent, 1);
  to->K = take_rows(from, row, row);
  if (to->K) memset(to->K, 0, (size_t)(row * row) * sizeof *to->K);
  to->tile_active = mpmi_arena_take(from, tile, sizeof *to->tile_active);
}

static mpm_status prepare_work(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  mpmi_arena counter = {NULL, 0};
  mpmi_newton_work one;
  lay_out(balance, &counter, &one);
  const size_t bytes = counter.used * (size_t)balance->settings->tasks;
  if (bytes > newton->work_bytes) {
    char *memory = mpmi_alloc_zeroed(balance->settings->context, bytes);
    if (!memory) return MPM_E_NOMEM;
    mpmi_free(balance->settings->context, newton->work_memory, newton->work_bytes);
    newton->work_memory = memory;
    newton->work_bytes = bytes;
  }
  for (int32_t k = 0; k < balance->settings->tasks; ++k) {
    mpmi_arena from = {(char *)newton->work_memory + (size_t)k * counter.used, 0};
    lay_out(balance, &from, &newton->work[k]);
  }
  return MPM_OK;
}

mpm_status mpmi_newton_create(const mpmi_settings *settings, mpmi_newton **out) {
  mpm_context *c = settings->context;
  mpmi_newton *newton = mpmi_alloc_zeroed(c, sizeof *newton);
  if (!newton) return MPM_E_NOMEM;
  newton->version = -1;
  newton->work = mpmi_alloc_zeroed(c, mpmi_bytes(settings->tasks, sizeof *newton->work));
  if (!newton->work || mpmi_solver_create(c, &newton->solver)) {
    MPMI_FREE_ARRAY(c, newton->work, settings->tasks);
    mpmi_free(c, newton, sizeof *newton);
    return MPM_E_NOMEM;
  }
  mpmi_matrix_init(&newton->matrix, c);
  if (!mpmi_is_whole(c) && mpmi_rows_create(c, settings->grid->dim, &newton->shared)) {
    mpmi_newton_free(newton, settings);
    return MPM_E_NOMEM;
  }
  newton->matrix.shared = newton->shared;
  *out = newton;
  return MPM_OK;
}

static mpm_status prepare_history(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const int32_t wanted = balance->settings->desc.newton_max_iterations + 1;
  if (wanted <= newton->history_capacity) return MPM_OK;
  double *history = mpmi_alloc(balance->settings->context, mpmi_bytes(wanted, sizeof *history));
  if (!history) return MPM_E_NOMEM;
  mpmi_free(balance->settings->context, newton->history,
            mpmi_bytes(newton->history_capacity, sizeof *history));
  newton->history = history;
  newton->history_capacity = wanted;
  return MPM_OK;
}

static void find_stencil(const mpmi_settings *settings, mpmi_stencil *to) {
  const int32_t dim = settings->grid->dim, width = settings->grid->width;
  to->count = mpmi_cube_places(dim, width, MPMI_TILE_EDGE(dim, width), to->in_tile);
  mpmi_cube_places(dim, width, 2 * mpmi_coupling_span(settings) - 1, to->offset);
}

mpm_status mpmi_balance_prepare(mpmi_balance *balance) {
  mpm_context *c = balance->settings->context;
  const int64_t slots = mpmi_slots(balance->layout);
  mpmi_newton *newton = balance->newton;
  mpm_status status;
  find_stencil(balance->settings, &newton->stencil);
  if ((status = prepare_history(balance)) || (status = prepare_work(balance)) ||
      (status = mpmi_nodal_reserve(c, &newton->force, slots, 4)))
    return status;
  return mpmi_nodal_reserve(c, &newton->external, slots, 4);
}

/* Frees what one of several parts keeps. */
static void free_shared(mpmi_newton *newton, mpm_context *c) {
  mpmi_shared_rows *rows = &newton->rows_of;
  mpmi_shared_stiffness *stiffness = &newton->stiffness_of;
  mpmi_rows_destroy(newton->shared);
  MPMI_FREE_ARRAY(c, rows->key, rows->key_capacity);
  MPMI_FREE_ARRAY(c, rows->place, rows->place_capacity);
  MPMI_FREE_ARRAY(c, rows->owner, rows->owner_capacity);
  MPMI_FREE_ARRAY(c, rows->home, rows->home_capacity);
  MPMI_FREE_ARRAY(c, rows->wanted, rows->wanted_capacity);
  MPMI_FREE_ARRAY(c, rows->kept, rows->kept_capacity);
  MPMI_FREE_ARRAY(c, stiffness->record, stiffness->record_capacity);
  MPMI_FREE_ARRAY(c, stiffness->start, stiffness->start_capacity);
  MPMI_FREE_ARRAY(c, stiffness->at, stiffness->at_capacity);
}

void mpmi_newton_free(mpmi_newton *newton, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  if (!newton) return;
  mpmi_matrix_free(&newton->matrix);
  free_shared(newton, c);
  mpmi_solver_destroy(newton->solver);
  MPMI_FREE_ARRAY(c, newton->active, newton->active_capacity);
  MPMI_FREE_ARRAY(c, newton->active_of, newton->map_capacity);
  MPMI_FREE_ARRAY(c, newton->place, newton->place_capacity);
  MPMI_FREE_ARRAY(c, newton->members, newton->members_capacity);
  MPMI_FREE_ARRAY(c, newton->members_start, newton->members_start_capacity);
  MPMI_FREE_ARRAY(c, newton->outer, newton->outer_capacity);
  MPMI_FREE_ARRAY(c, newton->term, newton->term_capacity);
  MPMI_FREE_ARRAY(c, newton->outer_of, newton->outer_of_capacity);
  MPMI_FREE_ARRAY(c, newton->led_start, newton->led_start_capacity);
  MPMI_FREE_ARRAY(c, newton->led, newton->led_capacity);
  MPMI_FREE_ARRAY(c, newton->master, newton->master_capacity);
  MPMI_FREE_ARRAY(c, newton->copies, newton->copies_capacity);
  MPMI_FREE_ARRAY(c, newton->columns, newton->columns_capacity);
  MPMI_FREE_ARRAY(c, newton->diagonal, newton->diagonal_capacity);
  MPMI_FREE_ARRAY(c, newton->mass, newton->mass_capacity);
  MPMI_FREE_ARRAY(c, newton->vector_memory, newton->vector_capacity);
  mpmi_nodal_free(c, &newton->force);
  mpmi_nodal_free(c, &newton->external);
  MPMI_FREE_ARRAY(c, newton->cell, newton->cell_capacity);
  MPMI_FREE_ARRAY(c, newton->cell_node, newton->cell_node_capacity);
  mpmi_free(c, newton->work_memory, newton->work_bytes);
  MPMI_FREE_ARRAY(c, newton->work, settings->tasks);
  MPMI_FREE_ARRAY(c, newton->constraint, newton->constraint_capacity);
  MPMI_FREE_ARRAY(c, newton->history, newton->history_capacity);
  mpmi_free(c, newton, sizeof *newton);
}
