/* It is settled beforehand which fronts are eliminated side by side, and where panels, updates and scratch
 * lie. So results do not depend on which thread does what, and when. */
#include "linalg/factor.h"
#include "linalg/vectors.h"

enum { SHARE = 16, LINE = 8 }; /* a task has at most a SHAREth of the work; a cache line has LINE doubles */

static int64_t whole_lines(int64_t doubles) {
  return (doubles + LINE - 1) / LINE * LINE;
}

/* Places panels one after the other, and adds up the work of each front and of those that it encloses.
 * Returns the work of all. */
static double place_panels(mpmi_factor *f) {
  double all = 0.0;
  f->panels = f->largest = 0;
  for (int32_t i = 0; i < f->fronts; ++i) {
    mpmi_front *front = &f->front[i];
    const int64_t m = (int64_t)front->pivots + front->rows;
    front->panel = f->panels;
    f->panels += whole_lines(m * front->pivots);
    if (m > f->largest) f->largest = m;
    front->work = (double)front->pivots * (double)m * (double)m;
    all += front->work;
    for (int32_t child = front->child; child >= 0; child = f->front[child].sibling)
      front->work += f->front[child].work;
  }
  return all;
}

static void choose_tasks(mpmi_factor *f, double most) {
  f->tasks = 0;
  for (int32_t i = 0; i < f->fronts; ++i) f->front[i].top = f->front[i].work > most;
  for (int32_t i = 0; i < f->fronts; ++i) {
    const mpmi_front *front = &f->front[i];
    if (!front->top && (front->parent < 0 || f->front[front->parent].top))
      f->task[f->tasks++] = (mpmi_front_task){.begin = front->lowest, .end = i + 1};
  }
}

/* Places the scratch of the largest of these fronts, and above it a stack of updates. An update is made
 * above those that go into it, and moves to their place once they have been used. Updates of tasks stay
 * where they are until the end. */
static int64_t place_updates(mpmi_factor *f, int32_t begin, int32_t end, int32_t top, int64_t base) {
  int64_t scratch = 0;
  for (int32_t i = begin; i < end; ++i) {
    const mpmi_front *front = &f->front[i];
    const int64_t need = mpmi_dense_scratch(f->kernels, front->pivots, front->rows, f->symmetric);
    if (front->top == top && need > scratch) scratch = need;
  }
  int64_t next = base + whole_lines(scratch), peak = next;
  for (int32_t i = begin; i < end; ++i) {
    mpmi_front *front = &f->front[i];
    if (front->top != top) continue;
    const int64_t n = front->rows, size = n * n, kept_size = f->symmetric ? n * (n + 1) / 2 : size;
    front->built = front->kept = next;
    for (int32_t child = front->child; child >= 0; child = f->front[child].sibling)
      if (f->front[child].top == top && f->front[child].kept < front->kept)
        front->kept = f->front[child].kept;
    if (front->built + size > peak) peak = front->built + size;
    next = front->kept + kept_size;
  }
  return whole_lines(peak);
}

void mpmi_factor_lay_out(mpmi_factor *f) {
  const double all = place_panels(f);
  choose_tasks(f, f->unknowns < MPMI_ALONE_UNKNOWNS ? all : all / (double)SHARE);
  int64_t at = 0;
  for (int32_t t = 0; t < f->tasks; ++t) {
    f->task[t].scratch = at;
    at = place_updates(f, f->task[t].begin, f->task[t].end, 0, at);
  }
  f->top_scratch = at;
  f->arena_size = place_updates(f, 0, f->fronts, 1, at);
}
