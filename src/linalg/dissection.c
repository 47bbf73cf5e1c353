/* Nested dissection cuts a piece at the median plane across its longest axis. The separator is those nodes
 * of one side that couple to the other side; so it is as wide as the stencil, also around a periodic axis. */
#include "linalg/dissection.h"

enum {
  LEAF_UNKNOWNS = 24, /* pieces of about this size are not cut any more */
  DEEPEST = 64
};

/* Counts the nodes of [begin, end) that lie at or below the plane. */
static int32_t count_below(const mpmi_dissection *d, int32_t begin, int32_t end, int32_t axis,
                           int64_t plane) {
  int32_t count = 0;
  for (int32_t at = begin; at < end; ++at) count += d->A->index[d->order[at]][axis] <= plane;
  return count;
}

typedef struct extent {
  int64_t low[3], high[3];
} extent;

static extent extent_of(const mpmi_dissection *d, int32_t begin, int32_t end) {
  extent box;
  for (int32_t k = 0; k < 3; ++k) box.low[k] = box.high[k] = d->A->index[d->order[begin]][k];
  for (int32_t at = begin + 1; at < end; ++at) {
    const int64_t *index = d->A->index[d->order[at]];
    for (int32_t k = 0; k < 3; ++k) {
      if (index[k] < box.low[k]) box.low[k] = index[k];
      if (index[k] > box.high[k]) box.high[k] = index[k];
    }
  }
  return box;
}

/* Finds the plane with half of the nodes at or below it. */
static int64_t median(const mpmi_dissection *d, int32_t begin, int32_t end, int32_t axis, int64_t low,
                      int64_t high) {
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (2 * (int64_t)count_below(d, begin, end, axis, middle) < end - begin)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static int32_t touches(const mpmi_dissection *d, int32_t node, int32_t label) {
  const mpmi_matrix *A = d->A;
  for (int64_t e = A->row_start[node]; e < A->row_start[node + 1]; ++e)
    if (d->label[A->column[e]] == label) return 1;
  return 0;
}

/* Counts the nodes of a piece that couple to another piece. */
static int32_t count_border(const mpmi_dissection *d, int32_t begin, int32_t end, int32_t label,
                            int32_t other) {
  int32_t count = 0;
  for (int32_t at = begin; at < end; ++at)
    count += d->label[d->order[at]] == label && touches(d, d->order[at], other);
  return count;
}

/* Brings [begin, end) into the order of its labels: lower, upper, separator. */
static void arrange(mpmi_dissection *d, int32_t begin, int32_t end, int32_t lower, int32_t upper,
                    int32_t *middle, int32_t *last) {
  int32_t low = begin, high = 0, separator = end - begin;
  for (int32_t at = begin; at < end; ++at) {
    const int32_t node = d->order[at];
    if (d->label[node] == lower)
      d->order[low++] = node;
    else if (d->label[node] == upper)
      d->spare[high++] = node;
    else
      d->spare[--separator] = node;
  }
  *middle = low;
  *last = low + high;
  for (int32_t i = 0; i < high; ++i) d->order[low + i] = d->spare[i];
  for (int32_t at = *last, i = end - begin; at < end; ++at) d->order[at] = d->spare[--i];
}

/* Cuts across the axis. Returns 0 where the separator would leave nothing on one side. */
static int32_t cut(mpmi_dissection *d, int32_t begin, int32_t end, int32_t axis, int64_t plane,
                   int32_t *middle, int32_t *last) {
  const int32_t lower = ++d->labels, upper = ++d->labels;
  int32_t below = 0;
  for (int32_t at = begin; at < end; ++at) {
    const int32_t node = d->order[at], is_below = d->A->index[node][axis] <= plane;
    d->label[node] = is_below ? lower : upper;
    below += is_below;
  }
  const int32_t above = end - begin - below;
  const int32_t below_border = count_border(d, begin, end, lower, upper);
  const int32_t above_border = count_border(d, begin, end, upper, lower);
  const int32_t from_below = above_border == above || (below_border < below && below_border <= above_border);
  if (from_below ? below_border == below : above_border == above) return 0;
  const int32_t side = from_below ? lower : upper, other = from_below ? upper : lower;
  for (int32_t at = begin; at < end; ++at) /* nobody asks for the label 0, which the separator gets */
    if (d->label[d->order[at]] == side && touches(d, d->order[at], other)) d->label[d->order[at]] = 0;
  arrange(d, begin, end, lower, upper, middle, last);
  return 1;
}

static int32_t cut_somewhere(mpmi_dissection *d, int32_t begin, int32_t end, int32_t *middle, int32_t *last) {
  extent box = extent_of(d, begin, end);
  for (int32_t tries = 0; tries < 3; ++tries) {
    int32_t axis = 0;
    for (int32_t k = 1; k < 3; ++k)
      if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
    if (box.high[axis] <= box.low[axis]) return 0;
    const int64_t plane = median(d, begin, end, axis, box.low[axis], box.high[axis] - 1);
    if (cut(d, begin, end, axis, plane, middle, last)) return 1;
    box.high[axis] = box.low[axis];
  }
  return 0;
}

static void dissect(mpmi_dissection *d, int32_t begin, int32_t end, int32_t depth) {
  int32_t own = begin, middle, last;
  if ((int64_t)(end - begin) * d->A->block > LEAF_UNKNOWNS && depth < DEEPEST &&
      cut_somewhere(d, begin, end, &middle, &last)) {
    dissect(d, begin, middle, depth + 1);
    dissect(d, middle, last, depth + 1);
    own = last;
  }
  if (own < end) d->part[d->parts++] = (mpmi_part){own, end, begin};
}

void mpmi_dissect(mpmi_dissection *d) {
  d->parts = d->labels = 0;
  if (d->nodes) dissect(d, 0, d->nodes, 0);
}
