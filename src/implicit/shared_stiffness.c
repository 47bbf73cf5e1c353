/* The stiffness of particles at the edge of a part. An entry of the matrix is a sum over particles in the
 * order of blocks and slots, so that parts give each other not sums but the particles' own stiffness
 * (mpmi_push), each with what weights are made of; whoever has a row adds all of it, as one part would.
 *
 * The record of a block has a word for its slots, and then rows of as many numbers: ids, < 0 where there is
 * nothing; how many particles the batch has that begins at a slot, since batches are added one by one;
 * positions, and for GIMP sizes and stretches; the components of the stiffness; with the locking remedy what
 * the particle gives to its cell. */
#include "implicit/balance.h"
#include "context/transport.h"
#include "layout/tile.h"

#include <string.h>

enum { HEAD = 8, CELL_VALUES = 31, HEAD_WORDS = 2 };

typedef struct rows_of_record {
  int32_t points, stiffness, cell, count; /* where each begins, and how many there are */
  int32_t component[81], components;
} rows_of_record;

static rows_of_record find_rows(const mpmi_balance *balance) {
  const mpm_grid *grid = balance->settings->grid;
  const int32_t dim = mpmi_strain_dim(grid);
  rows_of_record rows = {.points = 2};
  for (int32_t e = 0; e < 81; ++e)
    if (e / 27 < dim && e / 9 % 3 < dim && e / 3 % 3 < dim && e % 3 < dim)
      rows.component[rows.components++] = e;
  rows.stiffness = rows.points + (mpmi_has_domains(grid) ? 3 : 1) * grid->dim;
  rows.cell = rows.stiffness + rows.components;
  rows.count = rows.cell + (balance->settings->desc.locking_remedy ? CELL_VALUES : 0);
  return rows;
}

/* Returns the slots of a block in all sets before m. */
static int64_t slots_before(const mpmi_layout *layout, int64_t block, int32_t m) {
  int64_t slots = 0;
  for (int32_t k = 0; k < m; ++k)
    slots += layout->member[k].now.start[block + 1] - layout->member[k].now.start[block];
  return slots;
}

mpm_status mpmi_shared_stiffness_begin(mpmi_balance *balance) {
  const mpmi_layout *layout = balance->layout;
  const mpmi_parts *parts = layout->parts;
  mpmi_shared_stiffness *s = &balance->newton->stiffness_of;
  mpm_context *c = balance->settings->context;
  const rows_of_record rows = find_rows(balance);
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(c, s->start, s->start_capacity, parts->boundary_count + 1)) ||
      (status = MPMI_RESERVE_MORE(c, s->at, s->at_capacity, layout->blocks.count + 1)))
    return status;
  s->start[0] = 0;
  for (int64_t i = 0; i < parts->boundary_count; ++i)
    s->start[i + 1] =
        s->start[i] + HEAD + rows.count * slots_before(layout, parts->boundary[i], layout->member_count);
  if ((status = MPMI_RESERVE_MORE(c, s->record, s->record_capacity, s->start[parts->boundary_count] + 1)))
    return status;
  memset(s->record, 0, (size_t)(s->start[parts->boundary_count] + 1) * sizeof *s->record);
  for (int64_t i = 0; i < layout->blocks.count; ++i) s->at[i] = NULL;
  for (int64_t i = 0; i < parts->boundary_count; ++i) {
    const int64_t slots = slots_before(layout, parts->boundary[i], layout->member_count);
    double *record = s->record + s->start[i];
    s->at[parts->boundary[i]] = record;
    memcpy(record, &slots, sizeof slots);
    memset(record + HEAD, 0xff, (size_t)slots * sizeof *record); /* no ids yet */
  }
  return MPM_OK;
}

static void record_cell(const mpmi_locking_particle *of, double *to, int64_t ld) {
  for (int32_t k = 0; k < 9; ++k) {
    to[k * ld] = of->h[k];
    to[(9 + k) * ld] = of->inverse[k];
    to[(18 + k) * ld] = of->k[k];
  }
  to[27 * ld] = of->volume;
  to[28 * ld] = of->q;
  to[29 * ld] = of->hoop;
  to[30 * ld] = of->paired;
}

static mpmi_locking_particle recorded_cell(const mpmi_stiff_particles *p, const mpmi_balance *balance,
                                           const mpmi_newton_work *work, int64_t q) {
  const double *from = p->record + p->begin + q;
  const int64_t ld = p->record_ld;
  mpmi_locking_particle of = {
      .volume = from[27 * ld], .q = from[28 * ld], .hoop = from[29 * ld], .paired = from[30 * ld] > 0.0};
  (void)balance, (void)work;
  for (int32_t k = 0; k < 9; ++k) {
    of.h[k] = from[k * ld];
    of.inverse[k] = from[(9 + k) * ld];
    of.k[k] = from[(18 + k) * ld];
  }
  return of;
}

void mpmi_shared_stiffness_record(mpmi_balance *balance, mpmi_batch *b) {
  const mpmi_layout *layout = balance->layout;
  const mpmi_newton *newton = balance->newton;
  const mpmi_newton_work *work = &newton->work[b->task];
  const mpm_grid *grid = balance->settings->grid;
  const rows_of_record rows = find_rows(balance);
  double *record =
      newton->stiffness_of.record + newton->stiffness_of.start[layout->parts->mark[b->block] - 1];
  int64_t ld;
  if (!mpmi_find_stiffness(balance, b)) return;
  memcpy(&ld, record, sizeof ld);
  const int64_t from =
      slots_before(layout, b->block, b->m) + b->begin - layout->member[b->m].now.start[b->block];
  double *to = record + HEAD + from;
  const mpmi_points points = mpmi_points_of(b->set, 0);
  const size_t bytes = (size_t)b->n * sizeof *to;
  memcpy(to, mpmi_i64(b->set, MPMI_ID, 0) + b->begin, bytes);
  to[ld] = (double)b->n;
  for (int32_t k = 0; k < grid->dim; ++k) {
    double *x = to + (rows.points + k) * ld;
    memcpy(x, points.x[k] + b->begin, bytes);
    if (points.size[k]) memcpy(x + grid->dim * ld, points.size[k] + b->begin, bytes);
    if (points.stretch[k]) memcpy(x + 2 * grid->dim * ld, points.stretch[k] + b->begin, bytes);
  }
  for (int32_t e = 0; e < rows.components; ++e)
    memcpy(to + (rows.stiffness + e) * ld, work->stiffness + rows.component[e] * b->law.ld, bytes);
  for (int64_t q = 0; q < b->n && balance->settings->desc.locking_remedy; ++q) {
    if (mpmi_i64(b->set, MPMI_ID, 0)[b->begin + q] < 0) continue;
    const mpmi_locking_particle cell = mpmi_locking_particle_of(balance, work, b, q);
    record_cell(&cell, to + rows.cell * ld + q, ld);
  }
}

void mpmi_shared_stiffness_add(mpmi_balance *balance, int32_t task, int64_t block) {
  const mpm_grid *grid = balance->settings->grid;
  const rows_of_record rows = find_rows(balance);
  mpmi_newton_work *work = &balance->newton->work[task];
  const double *record = balance->newton->stiffness_of.at[block];
  mpmi_axis axis[3];
  int64_t ld;
  if (!record) return;
  memcpy(&ld, record, sizeof ld);
  record += HEAD;
  mpmi_block_axes(grid, balance->layout->blocks.coord[block], axis);
  mpmi_tile_of_unknowns(balance, block, work->tile_active);
  mpmi_stiff_particles of = {.axis = axis,
                             .id = (const int64_t *)(const void *)record,
                             .ld = balance->newton->batch_length,
                             .in_cell = recorded_cell,
                             .record = record + rows.cell * ld,
                             .record_ld = ld};
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double *x = record + (rows.points + k) * ld;
    of.points.x[k] = x;
    if (mpmi_has_domains(grid)) of.points.size[k] = x + grid->dim * ld;
    if (grid->domains == MPMI_DOMAINS_STRETCHED && !mpmi_is_total_lagrangian(grid))
      of.points.stretch[k] = x + 2 * grid->dim * ld;
  }
  for (of.begin = 0; of.begin<ld; of.begin += of.n> 0 ? of.n : MPMI_CHUNK) {
    of.n = (int64_t)record[ld + of.begin];
    for (int32_t e = 0; e < rows.components && of.n > 0; ++e)
      memcpy(work->stiffness + rows.component[e] * of.ld, record + (rows.stiffness + e) * ld + of.begin,
             (size_t)of.n * sizeof *record);
    if (of.n > 0) mpmi_add_stencils(balance, work, &of);
  }
}

/* ---- the exchange -------------------------------------------------------------------------------------- */
/* A block in a message: its number in the partner's list of ghosts, and the bytes of its record, which
 * follows. */
typedef struct piece {
  int64_t ghost, bytes;
} piece;
_Static_assert(sizeof(piece) == HEAD_WORDS * sizeof(double), "records are aligned");

static mpm_status pack(mpmi_balance *balance, const mpmi_partner *to) {
  mpmi_parts *parts = balance->layout->parts;
  const mpmi_shared_stiffness *s = &balance->newton->stiffness_of;
  mpmi_buffer *out = &parts->out[to->part];
  for (int64_t i = 0; i < to->sent; ++i) {
    const int64_t mark = parts->mark[parts->sent[to->first_sent + i].block] - 1;
    const piece head = {i, (s->start[mark + 1] - s->start[mark]) * (int64_t)sizeof(double)};
    char *at = mpmi_buffer_take(parts->context, out, (int64_t)sizeof head + head.bytes);
    if (!at) return MPM_E_NOMEM;
    memcpy(at, &head, sizeof head);
    memcpy(at + sizeof head, s->record + s->start[mark], (size_t)head.bytes);
  }
  return MPM_OK;
}

static mpm_status unpack(mpmi_balance *balance, const mpmi_partner *from, const mpm_message *in) {
  mpmi_parts *parts = balance->layout->parts;
  const char *at = in->data, *end = at + in->bytes;
  while (end - at >= (ptrdiff_t)sizeof(piece)) {
    piece head;
    memcpy(&head, at, sizeof head);
    at += sizeof head;
    if (head.ghost < 0 || head.ghost >= from->ghosts || head.bytes > end - at)
      return mpmi_fail(parts->context, MPM_E_INTERNAL, "a message of part %d is not for part %d",
                       (int)in->part, (int)parts->context->transport.part);
    balance->newton->stiffness_of.at[parts->ghost[from->first_ghost + head.ghost].block] =
        (const double *)(const void *)at;
    at += head.bytes;
  }
  return MPM_OK;
}

mpm_status mpmi_shared_stiffness_exchange(mpmi_balance *balance) {
  mpmi_parts *parts = balance->layout->parts;
  mpmi_arrivals in;
  mpm_status status = MPM_OK;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) parts->out[r].used = 0;
  for (int64_t i = 0; i < parts->partner_count && !status; ++i) status = pack(balance, &parts->partner[i]);
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) parts->info.bytes_nodes += parts->out[r].used;
  if ((status = mpmi_vote(balance, status, 0))) return status;
  if ((status = mpmi_parts_exchange(parts, &in))) return status;
  for (int32_t i = 0; i < in.count && !status; ++i)
    for (int64_t k = 0; k < parts->partner_count; ++k)
      if (parts->partner[k].part == in.message[i].part)
        status = unpack(balance, &parts->partner[k], &in.message[i]);
  return status;
}
