/* Lines of unknowns: each component of the nodes that follow each other along its axis. They are found from
 * the pattern of the matrix, component by component, and coloured. */
#include <string.h>

#include "context/arena.h"
#include "linalg/sweep.h"

/* Lines in the order in which they are met, and what finding them takes. */
typedef struct search {
  const mpmi_matrix *A;
  int32_t component, lines;
  int32_t *next, *before; /* [rows] the nodes after and before on a line, or -1 */
  int32_t *place;         /* [rows] on its line */
  int32_t *line_of;       /* [rows * block], or -1 */
  int32_t *unknown;       /* [unknowns] */
  int32_t *start;         /* [lines + 1] */
  int32_t *band, *colour; /* [lines] */
  int32_t *taken; /* [colours] the last line that saw a colour beside it; then [lines] in their order */
} search;

static int32_t is_free(const search *of, int64_t row) {
  return !of->A->held[row * of->A->block + of->component];
}

/* Returns by how much a node lies farther along the axis, or 0 where it is not on the same grid line. */
static int64_t farther(const search *of, int64_t row, int64_t other) {
  const int64_t *a = of->A->index[row], *b = of->A->index[other];
  for (int32_t k = 0; k < 3; ++k)
    if (k != of->component && a[k] != b[k]) return 0;
  return b[of->component] - a[of->component];
}

/* Links each node with the next one along the axis that it couples with. Where bodies share a place, two
 * nodes may want the same one: the first one gets it. */
static void link_nodes(search *of) {
  const mpmi_matrix *A = of->A;
  memset(of->before, 0xff, (size_t)A->rows * sizeof *of->before);
  for (int64_t i = 0; i < A->rows; ++i) {
    int64_t least = INT64_MAX;
    of->next[i] = -1;
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1] && is_free(of, i); ++e) {
      const int32_t j = A->column[e];
      const int64_t by = farther(of, i, j);
      if (by <= 0 || by >= least || of->before[j] >= 0 || !is_free(of, j)) continue;
      least = by;
      of->next[i] = j;
    }
    if (of->next[i] >= 0) of->before[of->next[i]] = (int32_t)i;
  }
}

/* Returns over how many places a node couples with those that are on a line already. */
static int32_t reach_back(const search *of, int64_t row, int32_t line, int32_t place) {
  const mpmi_matrix *A = of->A;
  int32_t most = 0;
  for (int64_t e = A->row_start[row]; e < A->row_start[row + 1]; ++e) {
    const int64_t j = A->column[e];
    if (of->line_of[j * A->block + of->component] != line) continue;
    if (place - of->place[j] > most) most = place - of->place[j];
  }
  return most;
}

static void begin_line(search *of, int32_t at) {
  of->start[of->lines] = at;
  of->band[of->lines++] = 0;
}

/* Follows the links. A line ends where a node couples too far back, as the last ones of a periodic axis. */
static void walk(search *of) {
  const mpmi_matrix *A = of->A;
  int32_t at = of->start[of->lines];
  for (int64_t i = 0; i < A->rows; ++i) {
    if (of->before[i] >= 0 || !is_free(of, i)) continue;
    begin_line(of, at);
    for (int64_t j = i; j >= 0; j = of->next[j], ++at) {
      int32_t back = reach_back(of, j, of->lines - 1, at - of->start[of->lines - 1]);
      if (back > MPMI_MOST_BAND) begin_line(of, at), back = 0;
      const int32_t line = of->lines - 1;
      if (back > of->band[line]) of->band[line] = back;
      of->place[j] = at - of->start[line];
      of->unknown[at] = (int32_t)j * A->block + of->component;
      of->line_of[of->unknown[at]] = line;
    }
  }
  of->start[of->lines] = at;
}

/* Gives each line of the component the first colour that none beside it has. Components have colours of
 * their own, for their lines cross. */
static int32_t colour_lines(search *of, int32_t first, int32_t first_colour) {
  const mpmi_matrix *A = of->A;
  int32_t colours = first_colour;
  for (int32_t line = first; line < of->lines; ++line) {
    for (int32_t q = of->start[line]; q < of->start[line + 1]; ++q) {
      const int64_t row = of->unknown[q] / A->block;
      for (int64_t e = A->row_start[row]; e < A->row_start[row + 1]; ++e) {
        const int32_t other = of->line_of[(int64_t)A->column[e] * A->block + of->component];
        if (other >= 0 && other < line) of->taken[of->colour[other]] = line;
      }
    }
    int32_t c = first_colour;
    while (c < colours && of->taken[c] == line) ++c;
    of->colour[line] = c;
    if (c == colours) of->taken[colours++] = -1;
  }
  return colours;
}

/* The search borrows the room of the numbers, which are made after it. */
static mpm_status reserve_search(mpmi_smoother *s, search *of) {
  const mpmi_matrix *A = of->A;
  const int64_t rows = A->rows, all = rows * A->block;
  mpmi_arena from = {NULL, 0};
  for (;;) {
    of->next = mpmi_arena_take(&from, rows, sizeof *of->next);
    of->before = mpmi_arena_take(&from, rows, sizeof *of->before);
    of->place = mpmi_arena_take(&from, rows, sizeof *of->place);
    of->line_of = mpmi_arena_take(&from, all, sizeof *of->line_of);
    of->unknown = mpmi_arena_take(&from, all, sizeof *of->unknown);
    of->start = mpmi_arena_take(&from, all + 1, sizeof *of->start);
    of->band = mpmi_arena_take(&from, all, sizeof *of->band);
    of->colour = mpmi_arena_take(&from, all, sizeof *of->colour);
    of->taken = mpmi_arena_take(&from, all, sizeof *of->taken);
    if (from.memory) return MPM_OK;
    const mpm_status status =
        mpmi_reserve(A->context, (void **)&s->slab, &s->slab_capacity, (int64_t)from.used, 1);
    if (status) return status;
    from = (mpmi_arena){s->slab, 0};
  }
}

static mpm_status reserve_lines(mpmi_smoother *s, const mpmi_matrix *A) {
  mpmi_lines *l = &s->lines;
  mpmi_arena from = {NULL, 0};
  for (;;) {
    l->colour_start = mpmi_arena_take(&from, l->colours + 1, sizeof *l->colour_start);
    l->start = mpmi_arena_take(&from, l->count + 1, sizeof *l->start);
    l->unknown = mpmi_arena_take(&from, l->unknowns, sizeof *l->unknown);
    l->place = mpmi_arena_take(&from, A->rows * A->block, sizeof *l->place);
    l->band = mpmi_arena_take(&from, l->count, sizeof *l->band);
    if (from.memory) return MPM_OK;
    const mpm_status status =
        mpmi_reserve(A->context, (void **)&s->lines_slab, &s->lines_capacity, (int64_t)from.used, 1);
    if (status) return status;
    from = (mpmi_arena){s->lines_slab, 0};
  }
}

/* Puts the lines in the order of their colours, and within a colour in that in which they were met. */
static void order_lines(mpmi_lines *l, const search *of) {
  int64_t place = 0, count = 0;
  memset(l->place, 0xff, (size_t)(of->A->rows * of->A->block) * sizeof *l->place);
  memset(l->colour_start, 0, (size_t)(l->colours + 1) * sizeof *l->colour_start);
  for (int32_t line = 0; line < of->lines; ++line) ++l->colour_start[of->colour[line]];
  for (int32_t c = 0; c < l->colours; ++c) l->colour_start[c + 1] += l->colour_start[c];
  for (int32_t line = of->lines - 1; line >= 0; --line) of->taken[--l->colour_start[of->colour[line]]] = line;
  for (; count < l->count; ++count) {
    const int32_t line = of->taken[count];
    l->start[count] = place;
    l->band[count] = of->band[line];
    for (int32_t q = of->start[line]; q < of->start[line + 1]; ++q) {
      l->unknown[place] = of->unknown[q];
      l->place[of->unknown[q]] = (int32_t)place++;
    }
  }
  l->start[count] = place;
}

mpm_status mpmi_lines_find(mpmi_smoother *s, const mpmi_matrix *A) {
  search of = {.A = A};
  mpm_status status = reserve_search(s, &of);
  if (status) return status;
  mpmi_lines *l = &s->lines;
  memset(of.line_of, 0xff, (size_t)(A->rows * A->block) * sizeof *of.line_of);
  of.start[0] = 0;
  l->colours = 0;
  for (; of.component < A->block; ++of.component) {
    const int32_t first = of.lines;
    link_nodes(&of);
    walk(&of);
    l->colours = colour_lines(&of, first, l->colours);
  }
  l->count = of.lines;
  l->unknowns = of.start[of.lines];
  if ((status = reserve_lines(s, A))) return status;
  order_lines(l, &of);
  return MPM_OK;
}
