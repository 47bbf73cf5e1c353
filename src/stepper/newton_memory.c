/* Memory of implicit steps that does not depend on the unknowns. */
#include "context/arena.h"
#include "stepper/newton.h"

#include <string.h>

static double *take_rows(mpmi_arena *from, int64_t rows, int64_t length) {
  return mpmi_arena_take(from, rows * length, sizeof(double));
}

static void lay_out(const mpm_stepper *s, mpmi_arena *from, mpmi_newton_work *to) {
  const mpm_grid *grid = s->grid;
  const int64_t row = grid->dim * MPMI_STENCIL_NODES(grid->dim, grid->width);
  const int64_t tile = mpmi_tile_nodes(grid);
  int64_t length = 0;
  size_t tangent = 0;
  for (int32_t m = 0; m < s->member_count; ++m) {
    const mpm_material *material = s->member[m].set->material;
    const int64_t ld = mpmi_law_batch_length(material);
    const size_t bytes = mpmi_material_tangent_scratch(material, ld);
    length = ld > length ? ld : length;
    tangent = bytes > tangent ? bytes : tangent;
  }
  to->tile = take_rows(from, 4, tile);
  to->F_inc = take_rows(from, 9, length);
  to->nominal = take_rows(from, 9, length);
  to->stiffness = take_rows(from, 81, length);
  to->tangent = take_rows(from, 81, length);
  to->weight = take_rows(from, 1, length);
  to->h = take_rows(from, 9, length);
  to->inverse = take_rows(from, 9, length);
  to->tangent_scratch = mpmi_arena_take(from, (int64_t)tangent, 1);
  to->K = take_rows(from, row, row);
  to->tile_active = mpmi_arena_take(from, tile, sizeof *to->tile_active);
}

static mpm_status prepare_work(mpm_stepper *s) {
  mpmi_newton *w = s->newton;
  mpmi_arena counter = {NULL, 0};
  mpmi_newton_work one;
  lay_out(s, &counter, &one);
  const size_t bytes = counter.used * (size_t)s->tasks;
  if (bytes > w->work_bytes) {
    char *memory = mpmi_alloc_zeroed(s->context, bytes);
    if (!memory) return MPM_E_NOMEM;
    mpmi_free(s->context, w->work_memory, w->work_bytes);
    w->work_memory = memory;
    w->work_bytes = bytes;
  }
  for (int32_t k = 0; k < s->tasks; ++k) {
    mpmi_arena from = {(char *)w->work_memory + (size_t)k * counter.used, 0};
    lay_out(s, &from, &w->work[k]);
    memset(w->work[k].K, 0, (size_t)((char *)w->work[k].tile_active - (char *)w->work[k].K));
  }
  return MPM_OK;
}

static mpm_status make(mpm_stepper *s) {
  mpmi_newton *w = mpmi_alloc_zeroed(s->context, sizeof *w);
  if (!w) return MPM_E_NOMEM;
  w->topology = -1;
  w->work = mpmi_alloc_zeroed(s->context, mpmi_bytes(s->tasks, sizeof *w->work));
  if (!w->work || mpmi_solver_create(s->context, &w->solver)) {
    mpmi_free(s->context, w->work, mpmi_bytes(s->tasks, sizeof *w->work));
    mpmi_free(s->context, w, sizeof *w);
    return MPM_E_NOMEM;
  }
  mpmi_matrix_init(&w->matrix, s->context);
  s->newton = w;
  return MPM_OK;
}

static mpm_status prepare_history(mpm_stepper *s) {
  mpmi_newton *w = s->newton;
  const int32_t wanted = s->desc.newton_max_iterations + 1;
  if (wanted <= w->history_capacity) return MPM_OK;
  double *history = mpmi_alloc(s->context, mpmi_bytes(wanted, sizeof *history));
  if (!history) return MPM_E_NOMEM;
  mpmi_free(s->context, w->history, mpmi_bytes(w->history_capacity, sizeof *history));
  w->history = history;
  w->history_capacity = wanted;
  return MPM_OK;
}

mpm_status mpmi_newton_prepare(mpm_stepper *s) {
  const int64_t values = 4 * s->blocks.count * s->blocks.nodes;
  mpm_status status = s->newton ? MPM_OK : make(s);
  if (status) return status;
  mpmi_newton *w = s->newton;
  mpmi_stencil_find(s, &w->stencil);
  w->history_count = 0;
  w->iterations = w->solver_used = 0;
  w->linear_iterations = 0;
  w->factor_seconds = w->solve_seconds = 0.0;
  if ((status = prepare_history(s)) || (status = prepare_work(s)) ||
      (status =
           mpmi_reserve_roomy(s->context, (void **)&w->force, &w->force_capacity, values, sizeof *w->force)))
    return status;
  return mpmi_reserve_roomy(s->context, (void **)&w->external, &w->external_capacity, values,
                            sizeof *w->external);
}

void mpmi_newton_free(mpm_stepper *s) {
  mpmi_newton *w = s->newton;
  mpm_context *c = s->context;
  if (!w) return;
  mpmi_matrix_free(&w->matrix);
  mpmi_solver_destroy(w->solver);
  mpmi_free(c, w->active, mpmi_bytes(w->active_capacity, sizeof *w->active));
  mpmi_free(c, w->active_of, mpmi_bytes(w->map_capacity, sizeof *w->active_of));
  mpmi_free(c, w->place, mpmi_bytes(w->place_capacity, sizeof *w->place));
  mpmi_free(c, w->members, mpmi_bytes(w->members_capacity, sizeof *w->members));
  mpmi_free(c, w->members_start, mpmi_bytes(w->members_start_capacity, sizeof *w->members_start));
  mpmi_free(c, w->diagonal, mpmi_bytes(w->diagonal_capacity, sizeof *w->diagonal));
  mpmi_free(c, w->mass, mpmi_bytes(w->mass_capacity, sizeof *w->mass));
  mpmi_free(c, w->vector_memory, mpmi_bytes(w->vector_capacity, sizeof *w->vector_memory));
  mpmi_free(c, w->force, mpmi_bytes(w->force_capacity, sizeof *w->force));
  mpmi_free(c, w->external, mpmi_bytes(w->external_capacity, sizeof *w->external));
  mpmi_free(c, w->cell, mpmi_bytes(w->cell_capacity, sizeof *w->cell));
  mpmi_free(c, w->cell_node, mpmi_bytes(w->cell_node_capacity, sizeof *w->cell_node));
  mpmi_free(c, w->work_memory, w->work_bytes);
  mpmi_free(c, w->work, mpmi_bytes(s->tasks, sizeof *w->work));
  mpmi_free(c, w->history, mpmi_bytes(w->history_capacity, sizeof *w->history));
  mpmi_free(c, w, sizeof *w);
  s->newton = NULL;
}
