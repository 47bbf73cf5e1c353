/* The pattern of the matrix: which rows couple. Nodes couple when a stencil holds both, or with the locking
 * remedy a cell; what a row's images and ghosts couple with, the row couples with too, and an inner row with
 * what the outer ones that move with it couple with. So do nodes of bodies that may touch, at one index. */
#include "implicit/extension.h"
#include "layout/tasks.h"

#include <stdlib.h>
#include <string.h>

/* Lists active nodes by row, each row's in the order of their slots. */
static void group(mpmi_newton *newton, int64_t rows) {
  memset(newton->members_start, 0, (size_t)(rows + 1) * sizeof *newton->members_start);
  for (int64_t i = 0; i < newton->active_count; ++i) ++newton->members_start[newton->active[i].row];
  for (int64_t r = 0; r < rows; ++r) newton->members_start[r + 1] += newton->members_start[r];
  for (int64_t i = newton->active_count - 1; i >= 0; --i)
    newton->members[--newton->members_start[newton->active[i].row]] = i;
}

typedef struct pattern_job {
  mpmi_balance *balance;
  int64_t rows;
  int64_t most; /* columns of a row before they are distinct, with MPMI_MAX_BODIES to spare */
} pattern_job;

/* Finds the rows of the nodes around each active node, for now in the place of the entries. */
static void neighbours_task(void *data, int64_t k) {
  const pattern_job *job = data;
  mpmi_balance *balance = job->balance;
  mpmi_newton *newton = balance->newton;
  const mpmi_share share = mpmi_share_of(balance->settings, newton->active_count, k);
  for (int32_t o = 0; o < newton->offsets; ++o) {
    int32_t offset[3];
    mpmi_offset_of(balance, o, offset);
    for (int64_t i = share.begin; i < share.end; ++i) {
      const int64_t slot = mpmi_blocks_beside(&balance->layout->blocks, newton->active[i].slot, offset);
      const int32_t other = slot < 0 ? -1 : newton->active_of[slot];
      newton->place[i * newton->offsets + o] = other < 0 ? -1 : newton->active[other].row;
    }
  }
}

static int by_value(const void *a, const void *b) {
  const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

static int32_t sort_distinct(int32_t count, int32_t *list) {
  int32_t kept = 0;
  qsort(list, (size_t)count, sizeof *list, by_value);
  for (int32_t i = 0; i < count; ++i)
    if (!kept || list[kept - 1] != list[i]) list[kept++] = list[i];
  return kept;
}

static int32_t may_touch(const mpmi_balance *balance, int64_t block, int64_t other) {
  const int32_t *body = balance->layout->blocks.body;
  const int32_t low = body[block] < body[other] ? body[block] : body[other];
  double sign;
  return mpmi_contact_rule_of(&balance->settings->contact, low, body[block] + body[other] - low, &sign)
             ->kind != MPM_CONTACT_NONE;
}

/* Adds the rows of other bodies at the index of a node; their blocks are neighbours in the list. Masters meet
 * masters. */
static int32_t add_partners(const mpmi_balance *balance, int64_t slot, int32_t *out, int32_t count) {
  const mpmi_newton *newton = balance->newton;
  const mpmi_blocks *b = &balance->layout->blocks;
  const int64_t block = slot / b->nodes, node = slot % b->nodes;
  int64_t first = block, end = block + 1;
  if (!mpmi_constraints_is_free(&balance->layout->constraints, slot)) return count;
  while (first > 0 && b->key[first - 1] == b->key[block]) --first;
  while (end < b->count && b->key[end] == b->key[block]) ++end;
  for (int64_t other = first; other < end; ++other) {
    const int32_t active = newton->active_of[other * b->nodes + node];
    if (other != block && active >= 0 && may_touch(balance, block, other))
      out[count++] = newton->active[active].row;
  }
  return count;
}

/* Adds what the nodes of a row couple with; a tie of many images gives it member by member. */
static int32_t add_columns(const mpmi_balance *balance, int64_t row, int32_t *out, int32_t count) {
  const mpmi_newton *newton = balance->newton;
  for (int64_t m = newton->members_start[row]; m < newton->members_start[row + 1]; ++m) {
    const int32_t *rows = newton->place + newton->members[m] * newton->offsets;
    for (int32_t o = 0; o < newton->offsets; ++o)
      if (rows[o] >= 0) out[count++] = rows[o];
    if (newton->couples_bodies)
      count = add_partners(balance, newton->active[newton->members[m]].slot, out, count);
    count = sort_distinct(count, out);
  }
  return count;
}

/* Lists the distinct columns of a row, ascending, and returns how many. */
static int32_t columns_of(const mpmi_balance *balance, int64_t row, int32_t *out) {
  const mpmi_newton *newton = balance->newton;
  if (!mpmi_is_kept(newton, row)) {
    out[0] = (int32_t)row;
    return 1;
  }
  int32_t count = add_columns(balance, row, out, 0);
  for (int64_t i = newton->led_start[row]; i < newton->led_start[row + 1]; ++i)
    count = add_columns(balance, newton->led[i], out, count);
  const int32_t own = count;
  for (int32_t i = 0; i < own && newton->outer_count; ++i) {
    const int32_t outer = newton->outer_of[out[i]];
    if (outer < 0) continue;
    for (int64_t t = mpmi_first_term(newton, outer); t < newton->outer[outer].end; ++t)
      out[count++] = newton->term[t].row;
  }
  return count > own ? sort_distinct(count, out) : count;
}

/* Returns a bound for the columns of any row while they are listed. */
static int64_t most_columns(const mpmi_newton *newton, int64_t rows) {
  int64_t most = 0, terms = 0;
  for (int64_t i = 0; i < newton->outer_count; ++i)
    if (newton->outer[i].end - mpmi_first_term(newton, i) > terms)
      terms = newton->outer[i].end - mpmi_first_term(newton, i);
  for (int64_t r = 0; r < rows; ++r) {
    int64_t members = newton->members_start[r + 1] - newton->members_start[r];
    for (int64_t i = newton->led_start[r]; i < newton->led_start[r + 1]; ++i)
      members += newton->members_start[newton->led[i] + 1] - newton->members_start[newton->led[i]];
    const int64_t columns = members * (newton->offsets + MPMI_MAX_BODIES);
    if (columns > most) most = columns;
  }
  return most * (1 + terms);
}

/* Of several parts one that meets the node of a body has all touches there (contact/meetings.c), and wants
 * the values of all bodies, which may have other owners. */
static void want_together(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const mpmi_parts *parts = balance->layout->parts;
  const mpmi_block_groups *groups = &balance->layout->groups;
  const int64_t nodes = balance->layout->blocks.nodes;
  for (int64_t g = 0; g < groups->count && parts; ++g) {
    const int64_t first = groups->group[g].first, end = first + groups->group[g].count;
    for (int64_t n = 0; n < nodes; ++n) {
      int32_t meets = 0;
      for (int64_t i = first; i < end; ++i) meets |= mpmi_meets_node(parts, i * nodes + n);
      for (int64_t i = first; i < end && meets; ++i) {
        const int32_t active = newton->active_of[i * nodes + n];
        if (active >= 0) newton->rows_of.wanted[newton->active[active].row] = 1;
      }
    }
  }
}

static void count_task(void *data, int64_t k) {
  const pattern_job *job = data;
  mpmi_newton *newton = job->balance->newton;
  int32_t *columns = newton->columns + k * job->most;
  const mpmi_share share = mpmi_share_of(job->balance->settings, job->rows, k);
  for (int64_t r = share.begin; r < share.end; ++r)
    newton->diagonal[r] = columns_of(job->balance, r, columns);
}

static void fill_task(void *data, int64_t k) {
  const pattern_job *job = data;
  mpmi_newton *newton = job->balance->newton;
  mpmi_matrix *A = &newton->matrix;
  int32_t *columns = newton->columns + k * job->most;
  const mpmi_share share = mpmi_share_of(job->balance->settings, job->rows, k);
  for (int64_t r = share.begin; r < share.end; ++r) {
    const int32_t count = columns_of(job->balance, r, columns);
    memcpy(A->column + A->row_start[r], columns, (size_t)count * sizeof *columns);
    newton->diagonal[r] = mpmi_matrix_entry(A, r, r);
  }
}

/* Replaces the rows around each active node by the entries that couple it with them. */
static void entries_task(void *data, int64_t k) {
  const pattern_job *job = data;
  mpmi_newton *newton = job->balance->newton;
  const mpmi_share share = mpmi_share_of(job->balance->settings, newton->active_count, k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    int32_t *place = newton->place + i * newton->offsets;
    for (int32_t o = 0; o < newton->offsets; ++o)
      if (place[o] >= 0)
        place[o] = (int32_t)mpmi_matrix_entry(&newton->matrix, newton->active[i].row, place[o]);
  }
}

/* Returns 1 when there are places with bodies that may touch. */
static int32_t couples_bodies(const mpmi_balance *balance) {
  const mpmi_block_groups *groups = &balance->layout->groups;
  for (int64_t g = 0; g < groups->count; ++g) {
    const int64_t first = groups->group[g].first, end = first + groups->group[g].count;
    for (int64_t i = first; i < end; ++i)
      for (int64_t j = i + 1; j < end; ++j)
        if (may_touch(balance, i, j)) return 1;
  }
  return 0;
}

mpm_status mpmi_make_pattern(mpmi_balance *balance, int64_t rows) {
  mpmi_newton *newton = balance->newton;
  mpmi_matrix *A = &newton->matrix;
  group(newton, rows);
  newton->couples_bodies = couples_bodies(balance);
  pattern_job job = {balance, rows, most_columns(newton, rows)};
  mpm_status status = MPMI_RESERVE_MORE(balance->settings->context, newton->columns, newton->columns_capacity,
                                        job.most * balance->settings->tasks);
  if (status) return status;
  status = mpmi_run_tasks(balance->settings, 0, balance->settings->tasks, neighbours_task, &job);
  if (!status) want_together(balance);
  if (!status) mpmi_shared_rows_keep(balance);
  if (!status) status = mpmi_run_tasks(balance->settings, 0, balance->settings->tasks, count_task, &job);
  if (status) return status;
  int64_t entries = 0;
  for (int64_t r = 0; r < rows; ++r) entries += newton->diagonal[r];
  if (entries > INT32_MAX)
    return mpmi_fail(balance->settings->context, MPM_E_UNSUPPORTED,
                     "the matrix would have %lld blocks, more than 2147483647: use an explicit scheme",
                     (long long)entries);
  if ((status = mpmi_matrix_reserve(A, rows, entries, balance->settings->grid->dim))) return status;
  A->row_start[0] = 0;
  for (int64_t r = 0; r < rows; ++r) A->row_start[r + 1] = A->row_start[r] + newton->diagonal[r];
  if ((status = mpmi_run_tasks(balance->settings, 0, balance->settings->tasks, fill_task, &job)) ||
      (status = mpmi_run_tasks(balance->settings, 0, balance->settings->tasks, entries_task, &job)))
    return status;
  ++A->pattern_id;
  return MPM_OK;
}
