/* Extension: outer rows, of nodes at the rim of a body that hardly any particle sees, move with inner ones,
 * u = sum of share * u_inner, by linear extrapolation along a line of nodes (Hoellig, Reif & Wipper 2001;
 * Badia, Verdugo & Martin 2018). Fields that are linear in space stay what they are, and so do sum and moment
 * of all forces. Alone such rows have motions that strain no particle: one particle that comes into reach of
 * a row of nodes has four numbers in 2-D, and the nodes six. */
#include "implicit/extension.h"
#include "implicit/beside.h"

#include <math.h>
#include <string.h>

/* A row is outer with less than this share of the largest sum of V0 |grad w|^2 of the nodes around. On the
 * linear basis a particle that enters a cell has its full gradient there at once. */
static const double outer_share = 1e-2, outer_share_linear = 5e-2;
/* Inner rows are looked for so many nodes away; lines as good as the best but for this share count alike. */
enum { MOST_STEPS = 3 };
static const double alike = 1e-9;

/* ---- finding outer rows -------------------------------------------------------------------------------- */
typedef struct search {
  const mpmi_balance *balance;
  mpmi_newton *newton;
  double *stiffness; /* [rows] sum of V0 |grad w|^2 */
  int64_t *slot;     /* [rows] of the master */
  int64_t outer_before, terms_before;
  int32_t changed;
} search;

/* Two inner nodes on a line with the outer one. */
typedef struct line {
  int32_t row[2];
  int32_t face[2][3]; /* by which each is mirrored along an axis, or -1 */
  double share[2], quality;
} line;

/* Returns the slot some steps away, or -1. */
static int64_t beside(const search *s, int64_t slot, const int32_t *direction, int32_t steps,
                      int32_t *mirror) {
  int32_t offset[3] = {0, 0, 0};
  for (int32_t k = 0; k < s->balance->settings->grid->dim; ++k) offset[k] = steps * direction[k];
  return mpmi_node_beside(s->balance, slot, offset, mirror);
}

static void sum_stiffness(search *s, int64_t rows) {
  const mpmi_newton *newton = s->newton;
  memset(s->stiffness, 0, (size_t)rows * sizeof *s->stiffness);
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    const double copies = mpmi_copies_of(s->balance, node->slot);
    s->stiffness[node->row] += *mpmi_mass(&newton->external, node->slot) * copies;
    if (mpmi_master_of(s->balance, node->slot) != node->slot) continue;
    s->slot[node->row] = node->slot;
    newton->copies[node->row] = copies;
  }
}

/* Returns 1 when a row has little stiffness beside those in reach of its node, and nothing prescribes it. */
static int32_t is_weak(const search *s, int64_t row, double largest) {
  const mpmi_newton *newton = s->newton;
  const int32_t dim = s->balance->settings->grid->dim, reach = s->balance->settings->grid->width - 1;
  const double share =
      s->balance->settings->grid->family == MPMI_FAMILY_BSPLINE1 ? outer_share_linear : outer_share;
  if (s->stiffness[row] >= share * largest) return 0;
  for (int32_t c = 0; c < dim; ++c)
    if (mpmi_held_by(s->balance->nodes, s->slot[row], c)) return 0;
  double most = 0.0;
  int32_t at[3] = {-reach, dim > 1 ? -reach : 0, dim > 2 ? -reach : 0};
  for (;;) {
    const int64_t slot = mpmi_blocks_around(&s->balance->layout->blocks, s->slot[row], at);
    if (slot >= 0 && newton->active_of[slot] >= 0)
      most = fmax(most, s->stiffness[newton->active[newton->active_of[slot]].row]);
    int32_t k = 0;
    while (k < dim && ++at[k] > reach) at[k++] = -reach;
    if (k == dim) return s->stiffness[row] < share * most;
  }
}

/* Returns the row of an inner node in a slot that is free where `row` is, or -1. Images with other signs are
 * left out. */
static int32_t inner_row(const search *s, int64_t slot, int64_t row) {
  const mpmi_newton *newton = s->newton;
  if (slot < 0 || newton->active_of[slot] < 0) return -1;
  const mpmi_active_node *node = &newton->active[newton->active_of[slot]];
  if (!node->plain || node->row == row || newton->outer_of[node->row] >= 0) return -1;
  for (int32_t c = 0; c < s->balance->settings->grid->dim; ++c)
    if (mpmi_holder_of(s->balance, s->slot[row], c) == MPMI_ROW_FREE &&
        mpmi_holder_of(s->balance, s->slot[node->row], c) != MPMI_ROW_FREE &&
        !mpmi_is_zero(s->balance, s->slot[node->row], c))
      return -1;
  return node->row;
}

static int32_t is_outer_node(const search *s, int64_t slot) {
  const int32_t active = slot < 0 ? -1 : s->newton->active_of[slot];
  return active >= 0 && s->newton->outer_of[s->newton->active[active].row] >= 0;
}

/* Weighs two nodes for the extrapolation; 0 where the three are not on one line, as at open knots. */
static int32_t find_shares(const search *s, int64_t row, const int32_t *direction, int32_t steps, line *to) {
  const mpm_grid *grid = s->balance->settings->grid;
  int64_t index[3] = {0};
  double share = 0.0;
  int32_t found = 0;
  mpmi_blocks_index(&s->balance->layout->blocks, s->slot[row], index);
  for (int32_t k = 0; k < grid->dim; ++k) {
    double x[3];
    for (int32_t i = 0; i < 3; ++i)
      x[i] = mpmi_node_position(grid, k, index[k] + (i ? steps + i - 1 : 0) * direction[k]);
    if (!direction[k]) continue;
    const double here = (x[0] - x[1]) / (x[1] - x[2]);
    if (found && !(fabs(here - share) <= alike)) return 0;
    share = here;
    found = 1;
  }
  to->share[0] = 1.0 + share;
  to->share[1] = -share;
  return 1;
}

/* Finds the two inner nodes that are next in a direction, if there are. */
static int32_t find_line(const search *s, int64_t row, const int32_t *direction, line *to) {
  int32_t length = 0, steps = 1;
  for (int32_t k = 0; k < s->balance->settings->grid->dim; ++k) length += direction[k] * direction[k];
  int64_t slot[2] = {beside(s, s->slot[row], direction, 1, to->face[0]), -1};
  for (; steps < MOST_STEPS && is_outer_node(s, slot[0]); ++steps)
    slot[0] = beside(s, s->slot[row], direction, steps + 1, to->face[0]);
  slot[1] = beside(s, s->slot[row], direction, steps + 1, to->face[1]);
  for (int32_t i = 0; i < 2; ++i)
    if ((to->row[i] = inner_row(s, slot[i], row)) < 0) return 0;
  if (to->row[0] == to->row[1] || !find_shares(s, row, direction, steps, to)) return 0;
  to->quality = fmin(s->stiffness[to->row[0]], s->stiffness[to->row[1]]) / (double)(length * steps * steps);
  return 1;
}

/* Writes a value over that of the step before, if there was one, and tells whether it is another. */
static void keep(search *s, int32_t was_there, int32_t *place, int32_t value) {
  s->changed |= !was_there || *place != value;
  *place = value;
}

/* Adds an outer row with the mean of the lines of best quality; without one it stays by itself. */
static mpm_status add_outer(search *s, int64_t row) {
  mpmi_newton *newton = s->newton;
  const int32_t dim = s->balance->settings->grid->dim, directions = dim == 1 ? 3 : dim == 2 ? 9 : 27;
  line found[27];
  int32_t lines = 0, good = 0;
  double best = 0.0;
  for (int32_t n = 0; n < directions; ++n) {
    const int32_t direction[3] = {n % 3 - 1, n / 3 % 3 - (dim > 1), n / 9 - (dim > 2)};
    if (!find_line(s, row, direction, &found[lines])) continue;
    best = fmax(best, found[lines++].quality);
  }
  for (int32_t n = 0; n < lines; ++n) good += found[n].quality >= best * (1.0 - alike);
  if (!good) return MPM_OK;
  mpm_status status = MPMI_RESERVE_NEXT(s->balance->settings->context, newton->outer, newton->outer_capacity,
                                        newton->outer_count);
  for (int32_t n = 0; n < lines && !status; ++n)
    for (int32_t i = 0; i < 2 && found[n].quality >= best * (1.0 - alike) && !status; ++i) {
      status = MPMI_RESERVE_NEXT(s->balance->settings->context, newton->term, newton->term_capacity,
                                 newton->term_count);
      if (status) break;
      mpmi_outer_term *term = &newton->term[newton->term_count++];
      keep(s, newton->term_count <= s->terms_before, &term->row, found[n].row[i]);
      for (int32_t c = 0; c < dim; ++c) { /* follows from the rows */
        term->face[c] = found[n].face[i][c];
        term->share[c] = (term->face[c] < 0 ? 1.0 : -1.0) * found[n].share[i] / good;
      }
    }
  if (status) return status;
  mpmi_outer *outer = &newton->outer[newton->outer_count++];
  keep(s, newton->outer_count <= s->outer_before, &outer->row, (int32_t)row);
  keep(s, newton->outer_count <= s->outer_before, &outer->end, (int32_t)newton->term_count);
  outer->in_contact = 0;
  return MPM_OK;
}

/* Lists by inner row the outer ones that move with it. */
static mpm_status list_led(const mpmi_balance *balance, int64_t rows) {
  mpmi_newton *newton = balance->newton;
  mpm_context *c = balance->settings->context;
  mpm_status status = MPMI_RESERVE_MORE(c, newton->led_start, newton->led_start_capacity, rows + 1);
  if (!status) status = MPMI_RESERVE_MORE(c, newton->led, newton->led_capacity, newton->term_count + 1);
  if (status) return status;
  memset(newton->led_start, 0, (size_t)(rows + 1) * sizeof *newton->led_start);
  for (int64_t t = 0; t < newton->term_count; ++t) ++newton->led_start[newton->term[t].row];
  for (int64_t r = 0; r < rows; ++r) newton->led_start[r + 1] += newton->led_start[r];
  for (int64_t i = newton->outer_count - 1; i >= 0; --i)
    for (int64_t t = mpmi_first_term(newton, i); t < newton->outer[i].end; ++t)
      newton->led[--newton->led_start[newton->term[t].row]] = newton->outer[i].row;
  return MPM_OK;
}

mpm_status mpmi_extension_find(mpmi_balance *balance, int64_t rows, int32_t *changed) {
  mpmi_newton *newton = balance->newton;
  mpm_context *c = balance->settings->context;
  search s = {.balance = balance,
              .newton = newton,
              .stiffness = newton->vector[MPMI_TERMS],
              .outer_before = newton->outer_count,
              .terms_before = newton->term_count};
  mpm_status status = MPMI_RESERVE_MORE(c, newton->outer_of, newton->outer_of_capacity, rows + 1);
  if (!status) status = MPMI_RESERVE_MORE(c, newton->master, newton->master_capacity, rows + 1);
  if (!status) status = MPMI_RESERVE_MORE(c, newton->copies, newton->copies_capacity, rows + 1);
  if (status) return status;
  s.slot = newton->master;
  sum_stiffness(&s, rows);
  double largest = 0.0;
  for (int64_t r = 0; r < rows; ++r) largest = fmax(largest, s.stiffness[r]);
  for (int64_t r = 0; r < rows; ++r) newton->outer_of[r] = is_weak(&s, r, largest) ? 0 : -1;
  newton->outer_count = newton->term_count = 0;
  for (int64_t r = 0; r < rows && !status; ++r)
    if (newton->outer_of[r] >= 0) status = add_outer(&s, r);
  if (status) return status;
  for (int64_t r = 0; r < rows; ++r) newton->outer_of[r] = -1;
  for (int64_t i = 0; i < newton->outer_count; ++i) newton->outer_of[newton->outer[i].row] = (int32_t)i;
  *changed = s.changed || s.outer_before != newton->outer_count || s.terms_before != newton->term_count;
  return list_led(balance, rows);
}
