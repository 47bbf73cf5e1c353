#include "layout/visit.h"
#include "layout/tasks.h"

/* Blocks of one colour are two apart: their tiles must not meet. */
#define TILE_FITS(dim, width) (2 * MPMI_BLOCK_EDGE(dim) >= MPMI_TILE_EDGE(dim, width))
_Static_assert(TILE_FITS(1, 4) && TILE_FITS(2, 4) && TILE_FITS(3, 4), "tiles of one colour overlap");

typedef struct walk {
  const mpmi_worklist *list;
  mpmi_visit_fn visit;
  void *user;
} walk;

static void walk_range(const walk *w, int32_t task, int64_t begin, int64_t end) {
  for (int64_t i = begin; i < end; ++i) {
    const mpmi_visit visit = {task, w->list->block[i], i + 1 < end ? w->list->block[i + 1] : -1};
    w->visit(w->user, &visit);
  }
}

static void walk_task(void *data, int64_t k) {
  const walk *w = data;
  walk_range(w, (int32_t)k, w->list->bound[k], w->list->bound[k + 1]);
}

static mpm_status walk_list(const mpmi_step *step, const mpmi_worklist *list, int32_t calls_host,
                            mpmi_visit_fn visit, void *user) {
  walk w = {list, visit, user};
  if (!list->count) return MPM_OK;
  return mpmi_run_tasks(step->settings, calls_host, step->settings->tasks, walk_task, &w);
}

mpm_status mpmi_visit_blocks(const mpmi_step *step, int32_t calls_host, mpmi_visit_fn visit, void *user) {
  return walk_list(step, &step->layout->worklist[0], calls_host, visit, user);
}

mpm_status mpmi_visit_colours(const mpmi_step *step, int32_t calls_host, mpmi_visit_fn visit, void *user) {
  mpm_status status = MPM_OK;
  for (int32_t c = 0; c < MPMI_COLOURS && !status; ++c)
    status = walk_list(step, &step->layout->worklist[1 + c], calls_host, visit, user);
  return status;
}

void mpmi_visit_in_turn(const mpmi_step *step, mpmi_visit_fn visit, void *user) {
  const walk w = {&step->layout->worklist[0], visit, user};
  walk_range(&w, 0, 0, w.list->count);
}

typedef struct ranges {
  const mpmi_worklist *list;
  mpmi_range_fn visit;
  void *user;
} ranges;

static void range_task(void *data, int64_t k) {
  const ranges *r = data;
  const int64_t *bound = r->list->bound;
  r->visit(r->user, (int32_t)k, r->list->block + bound[k], bound[k + 1] - bound[k]);
}

mpm_status mpmi_visit_ranges(const mpmi_step *step, int32_t calls_host, mpmi_range_fn visit, void *user) {
  ranges r = {&step->layout->worklist[0], visit, user};
  if (!r.list->count) return MPM_OK;
  return mpmi_run_tasks(step->settings, calls_host, step->settings->tasks, range_task, &r);
}
