/* Rows of an implicit step over several parts: who owns them, and which are to be complete.
 *
 * A part knows all that is given to the nodes of its own tiles and to those within the margin around them
 * (parallel/pattern.c), so that it finds the same active nodes, rows, holders and extension there as one part
 * would. It owns the rows of nodes that it books (mpmi_owns_node()). These are to be complete, and the outer
 * rows that add to them; of all others it keeps the diagonal alone. */
#include "implicit/extension.h"
#include "context/transport.h"

#include <string.h>

mpm_status mpmi_shared_rows_find(mpmi_balance *balance, int64_t rows) {
  mpmi_newton *newton = balance->newton;
  mpmi_shared_rows *s = &newton->rows_of;
  const mpmi_parts *parts = balance->layout->parts;
  const mpmi_blocks *blocks = &balance->layout->blocks;
  mpm_context *c = balance->settings->context;
  mpm_status status;
  if (!parts) return MPM_OK;
  if ((status = MPMI_RESERVE_MORE(c, s->key, s->key_capacity, rows + 1)) ||
      (status = MPMI_RESERVE_MORE(c, s->place, s->place_capacity, rows + 1)) ||
      (status = MPMI_RESERVE_MORE(c, s->owner, s->owner_capacity, rows + 1)) ||
      (status = MPMI_RESERVE_MORE(c, s->home, s->home_capacity, rows + 1)) ||
      (status = MPMI_RESERVE_MORE(c, s->wanted, s->wanted_capacity, rows + 1)) ||
      (status = MPMI_RESERVE_MORE(c, s->kept, s->kept_capacity, rows + 1)))
    return status;
  for (int64_t r = 0; r < rows; ++r) {
    const int64_t slot = newton->master[r], block = slot / blocks->nodes;
    s->key[r] = blocks->key[block];
    s->place[r] = blocks->body[block] * blocks->nodes + (int32_t)(slot % blocks->nodes);
    s->owner[r] = mpmi_owner_of_node(parts, slot);
    s->home[r] = mpmi_cut_owner(parts, blocks->key[block]);
    s->kept[r] = s->owner[r] == c->transport.part;
    s->wanted[r] = mpmi_meets_node(parts, slot) != 0;
  }
  return MPM_OK;
}

/* Returns 1 where an outer row moves with an own one. */
static int32_t moves_with_own(const mpmi_newton *newton, int64_t outer, int32_t me) {
  for (int64_t t = mpmi_first_term(newton, outer); t < newton->outer[outer].end; ++t)
    if (newton->rows_of.owner[newton->term[t].row] == me) return 1;
  return 0;
}

/* Returns 1 where an outer row moves with an own one, couples with one, or couples with another outer row
 * that moves with one: then it is among the columns that an own row gets from that. */
static int32_t adds_to_own(const mpmi_newton *newton, int64_t outer, int32_t me) {
  const int64_t row = newton->outer[outer].row;
  if (moves_with_own(newton, outer, me)) return 1;
  for (int64_t m = newton->members_start[row]; m < newton->members_start[row + 1]; ++m)
    for (int32_t o = 0; o < newton->offsets; ++o) {
      const int32_t other = newton->place[newton->members[m] * newton->offsets + o];
      if (other < 0) continue;
      if (newton->rows_of.owner[other] == me) return 1;
      if (newton->outer_of[other] >= 0 && moves_with_own(newton, newton->outer_of[other], me)) return 1;
    }
  return 0;
}

/* Markers of surfaces beside nodes of own particles load these by how the nodes around them move. */
static void want_around_markers(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  for (int64_t i = 0; i < newton->active_count; ++i) {
    if (!mpmi_meets_node(balance->layout->parts, newton->active[i].slot)) continue;
    for (int32_t o = 0; o < newton->offsets; ++o) {
      const int32_t row = newton->place[i * newton->offsets + o];
      if (row >= 0) newton->rows_of.wanted[row] = 1;
    }
  }
}

void mpmi_shared_rows_keep(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  if (balance->layout->parts && balance->settings->surfaces.count) want_around_markers(balance);
  for (int64_t i = 0; i < newton->outer_count && balance->layout->parts; ++i)
    newton->rows_of.kept[newton->outer[i].row] |=
        (uint8_t)adds_to_own(newton, i, balance->settings->context->transport.part);
}

mpm_status mpmi_shared_rows_agree(mpmi_balance *balance, int32_t changed, mpm_status status) {
  mpmi_newton *newton = balance->newton;
  mpmi_shared_rows *s = &newton->rows_of;
  const mpmi_matrix *A = &newton->matrix;
  mpm_context *c = balance->settings->context;
  if (!balance->layout->parts || (status = mpmi_vote(balance, status, 0))) return status;
  int64_t any = changed || !s->is_shared;
  if ((status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 1, &any)) || !any) return status;
  s->is_shared = 0;
  for (int64_t r = 0; r < A->rows; ++r)
    for (int64_t e = A->row_start[r]; e < A->row_start[r + 1] && s->kept[r]; ++e) s->wanted[A->column[e]] = 1;
  const mpmi_rows_desc desc = {A->rows, s->key, s->place, s->owner, s->home, s->wanted};
  for (int64_t r = 0; r < A->rows; ++r) /* nobody owns what lies beyond the margin */
    s->wanted[r] &= s->owner[r] >= 0 && s->owner[r] < c->transport.parts;
  status = mpmi_rows_share(newton->shared, &desc, MPM_OK);
  s->is_shared = !status;
  return status;
}
