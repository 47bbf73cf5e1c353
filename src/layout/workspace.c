#include "layout/workspace.h"
#include "context/arena.h"
#include "layout/tile.h"
#include "particles/law_batch.h"

mpm_status mpmi_workspace_create(mpmi_workspace *work, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  work->scratch = mpmi_alloc_zeroed(c, mpmi_bytes(settings->tasks, sizeof *work->scratch));
  if (!work->scratch) return MPM_E_NOMEM;
  work->report = mpmi_alloc_zeroed(c, mpmi_bytes(settings->tasks, sizeof *work->report));
  return work->report ? MPM_OK : MPM_E_NOMEM;
}

void mpmi_workspace_free(mpmi_workspace *work, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  mpmi_free(c, work->scratch_memory, work->scratch_bytes);
  mpmi_free(c, work->scratch, mpmi_bytes(settings->tasks, sizeof *work->scratch));
  mpmi_free(c, work->report, mpmi_bytes(settings->tasks, sizeof *work->report));
  mpmi_free(c, work->block_sums, mpmi_bytes(work->block_sums_capacity, sizeof *work->block_sums));
  mpmi_free(c, work->block_work, mpmi_bytes(work->block_work_capacity, sizeof *work->block_work));
}

/* Rows of v, dv and C of a batch. */
enum { GATHERED_ROWS = 3 + 3 + 9 };

/* The longest batch and the most memory that the laws of the sets take. */
static void lay_out(mpmi_arena *from, const mpmi_settings *settings, const mpmi_layout *layout,
                    mpmi_scratch *to) {
  const int64_t tile = 8 * (int64_t)mpmi_tile_nodes(settings->grid);
  int64_t batch = 0, length = 0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_material *material = layout->member[m].set->material;
    const int64_t bytes = (int64_t)mpmi_law_batch_bytes(material), rows = mpmi_law_batch_length(material);
    batch = bytes > batch ? bytes : batch;
    length = rows > length ? rows : length;
  }
  to->cells = settings->desc.locking_remedy ? mpmi_arena_take(from, tile / 2, sizeof(double)) : NULL;
  to->tile = mpmi_arena_take(from, tile, sizeof(double));
  to->sum_tile = mpmi_is_implicit(settings) ? mpmi_arena_take(from, tile / 2, sizeof(double)) : NULL;
  to->gathered = mpmi_arena_take(from, GATHERED_ROWS * length, sizeof(double));
  to->batch_memory = mpmi_arena_take(from, batch, 1);
}

mpm_status mpmi_workspace_prepare(mpmi_workspace *work, const mpmi_settings *settings,
                                  const mpmi_layout *layout) {
  mpm_context *c = settings->context;
  const int64_t blocks = layout->blocks.count;
  mpm_status status;
  if ((status = mpmi_reserve_more(c, (void **)&work->block_sums, &work->block_sums_capacity, blocks,
                                  sizeof *work->block_sums)) ||
      (status = mpmi_reserve_more(c, (void **)&work->block_work, &work->block_work_capacity, blocks,
                                  sizeof *work->block_work)))
    return status;
  mpmi_arena counter = {NULL, 0};
  mpmi_scratch one;
  lay_out(&counter, settings, layout, &one);
  const size_t bytes = counter.used * (size_t)settings->tasks;
  if (bytes > work->scratch_bytes) {
    void *memory = mpmi_alloc(c, bytes);
    if (!memory) return MPM_E_NOMEM;
    mpmi_free(c, work->scratch_memory, work->scratch_bytes);
    work->scratch_memory = memory;
    work->scratch_bytes = bytes;
  }
  for (int32_t k = 0; k < settings->tasks; ++k) {
    mpmi_arena from = {(char *)work->scratch_memory + (size_t)k * counter.used, 0};
    lay_out(&from, settings, layout, &work->scratch[k]);
  }
  return MPM_OK;
}

void mpmi_reports_clear(mpmi_workspace *work, int32_t tasks) {
  for (int32_t k = 0; k < tasks; ++k) {
    work->report[k] = (mpmi_task_report){.left_tile = 0};
    mpmi_failure_clear(&work->report[k].failure);
  }
}
