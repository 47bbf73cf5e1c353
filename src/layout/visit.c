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
  if (step->settings->context->pool_rests) { /* the memory of one task stays in the caches */
    walk_range(&w, 0, 0, list->count);
    return MPM_OK;
  }
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

typedef struct marked {
  walk walk;
  const uint8_t *mark;
  int64_t count, tasks; /* count: of marked blocks */
} marked;

/* The k-th share of the marked blocks of the list, which may lie close together in it. */
static void marked_task(void *data, int64_t k) {
  const marked *m = data;
  const mpmi_worklist *list = m->walk.list;
  const int64_t begin = k * m->count / m->tasks, end = (k + 1) * m->count / m->tasks;
  mpmi_visit visit = {(int32_t)k, -1, -1};
  int64_t at = 0;
  for (int64_t i = 0; i < list->count && at < end; ++i) {
    if (!m->mark[list->block[i]] || at++ < begin) continue;
    visit.next = list->block[i];
    if (visit.block >= 0) m->walk.visit(m->walk.user, &visit);
    visit.block = visit.next;
  }
  visit.next = -1;
  if (visit.block >= 0) m->walk.visit(m->walk.user, &visit);
}

static mpm_status walk_marked(const mpmi_step *step, const mpmi_worklist *list, const uint8_t *mark,
                              int32_t calls_host, mpmi_visit_fn visit, void *user) {
  marked m = {{list, visit, user}, mark, 0, step->settings->tasks};
  for (int64_t i = 0; i < list->count; ++i) m.count += mark[list->block[i]] != 0;
  return m.count ? mpmi_run_tasks(step->settings, calls_host, m.tasks, marked_task, &m) : MPM_OK;
}

mpm_status mpmi_visit_marked(const mpmi_step *step, const uint8_t *mark, int32_t calls_host,
                             mpmi_visit_fn visit, void *user) {
  return walk_marked(step, &step->layout->worklist[0], mark, calls_host, visit, user);
}

mpm_status mpmi_visit_colour(const mpmi_step *step, const uint8_t *mark, int32_t colour, int32_t calls_host,
                             mpmi_visit_fn visit, void *user) {
  return walk_marked(step, &step->layout->worklist[1 + colour], mark, calls_host, visit, user);
}

typedef struct ghost_visits {
  const mpmi_step *step;
  const uint8_t *mark;
  mpmi_visit_fn visit;
  void *user;
} ghost_visits;

static void ghosts_task(void *data, int64_t k) {
  const ghost_visits *g = data;
  const mpmi_parts *parts = g->step->layout->parts;
  const mpmi_share share = mpmi_share_of(g->step->settings, parts->ghost_count, k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    const mpmi_visit visit = {(int32_t)k, parts->ghost[i].block, -1};
    if (g->mark[visit.block]) g->visit(g->user, &visit);
  }
}

mpm_status mpmi_visit_ghosts(const mpmi_step *step, const uint8_t *mark, int32_t calls_host,
                             mpmi_visit_fn visit, void *user) {
  ghost_visits g = {step, mark, visit, user};
  if (!step->layout->parts) return MPM_OK;
  return mpmi_run_tasks(step->settings, calls_host, step->settings->tasks, ghosts_task, &g);
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
  if (step->settings->context->pool_rests) {
    visit(user, 0, r.list->block, r.list->count);
    return MPM_OK;
  }
  return mpmi_run_tasks(step->settings, calls_host, step->settings->tasks, range_task, &r);
}
