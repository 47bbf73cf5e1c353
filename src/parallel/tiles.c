/* The exchange of what particles give to nodes that parts share. A message says first whether its part has
 * failed; then come blocks, each with its number in the partner's list of ghosts, a box of nodes of its tile,
 * and their values. Both sides know beforehand who sends to whom, so that every exchange takes place on all
 * parts, also where one of them has nothing to give or has failed. */
#include "parallel/parts.h"
#include "transfer/weights.h"

#include <string.h>

typedef struct piece_head {
  int32_t ghost;
  mpmi_node_box box;
  uint8_t unused[6];
} piece_head;
_Static_assert(sizeof(piece_head) == 16, "values are aligned");

static int64_t nodes_in(const mpmi_parts *parts, const mpmi_node_box *box) {
  int64_t nodes = 1;
  for (int32_t k = 0; k < parts->grid->dim; ++k) {
    if (box->low[k] >= box->high[k]) return 0;
    nodes *= box->high[k] - box->low[k];
  }
  return nodes;
}

static mpmi_node_box meet_boxes(const mpmi_parts *parts, const mpmi_node_box *a, const mpmi_node_box *b) {
  mpmi_node_box both = *a;
  for (int32_t k = 0; k < parts->grid->dim; ++k) {
    if (b->low[k] > both.low[k]) both.low[k] = b->low[k];
    if (b->high[k] < both.high[k]) both.high[k] = b->high[k];
  }
  return both;
}

/* Copies a box of a tile to a row of values, or back. */
static void copy_box(const mpmi_parts *parts, const mpmi_node_box *box, int32_t values, double *tile,
                     double *row, int32_t into_tile) {
  const int32_t dim = parts->grid->dim, edge = MPMI_TILE_EDGE(dim, parts->grid->width);
  const int32_t last = dim - 1;
  const int32_t low[2] = {dim > 2 ? box->low[0] : 0, dim > 1 ? box->low[last - 1] : 0};
  const int32_t high[2] = {dim > 2 ? box->high[0] : 1, dim > 1 ? box->high[last - 1] : 1};
  const int64_t run = (int64_t)values * (box->high[last] - box->low[last]);
  for (int32_t x = low[0]; x < high[0]; ++x)
    for (int32_t y = low[1]; y < high[1]; ++y, row += run) {
      double *at = tile + (((int64_t)x * edge + y) * edge + box->low[last]) * values;
      memcpy(into_tile ? at : row, into_tile ? row : at, (size_t)run * sizeof *at);
    }
}

static int64_t tile_doubles(const mpmi_parts *parts, int32_t values) {
  int64_t nodes = values;
  for (int32_t k = 0; k < parts->grid->dim; ++k)
    nodes *= MPMI_TILE_EDGE(parts->grid->dim, parts->grid->width);
  return nodes;
}

mpm_status mpmi_tiles_reserve(mpmi_parts *parts) {
  const int64_t doubles = tile_doubles(parts, 8);
  const mpm_status status =
      MPMI_RESERVE_MORE(parts->context, parts->tile, parts->tile_capacity, doubles * parts->boundary_count);
  if (!status && parts->boundary_count)
    memset(parts->tile, 0, (size_t)(doubles * parts->boundary_count) * sizeof *parts->tile);
  return status;
}

double *mpmi_tiles_of(const mpmi_parts *parts, int64_t block, int32_t values) {
  return parts->tile + (parts->mark[block] - 1) * tile_doubles(parts, values);
}

void mpmi_tiles_clear(const mpmi_parts *parts, int32_t values) {
  if (parts->boundary_count)
    memset(parts->tile, 0,
           (size_t)(tile_doubles(parts, values) * parts->boundary_count) * sizeof *parts->tile);
}

/* Returns the box of a sent block that has anything. */
static mpmi_node_box sent_box(const mpmi_parts *parts, const mpmi_shared_block *block,
                              const mpmi_cover *cover) {
  return meet_boxes(parts, &block->box, &cover[block->block].nodes);
}

/* Gives each block that a partner gets its place in the message, with a head before it. */
static mpm_status lay_out(mpmi_parts *parts, const mpmi_partner *to, int32_t values,
                          const mpmi_cover *cover) {
  const int64_t value = values * (int64_t)sizeof(double);
  mpmi_shared_block *block = parts->sent + to->first_sent;
  int64_t bytes = 0;
  for (int64_t i = 0; i < to->sent; ++i) {
    const mpmi_node_box box = sent_box(parts, &block[i], cover);
    const int64_t nodes = nodes_in(parts, &box);
    if (nodes) bytes += (int64_t)sizeof(piece_head) + nodes * value;
  }
  char *at = mpmi_buffer_take(parts->context, &parts->out[to->part], bytes);
  if (!at) return MPM_E_NOMEM;
  for (int64_t i = 0; i < to->sent; ++i) {
    const piece_head head = {(int32_t)i, sent_box(parts, &block[i], cover), {0}};
    const int64_t nodes = nodes_in(parts, &head.box);
    block[i].place = NULL;
    if (!nodes) continue;
    memcpy(at, &head, sizeof head);
    block[i].place = (double *)(void *)(at + sizeof head);
    at += (int64_t)sizeof head + nodes * value;
  }
  return MPM_OK;
}

typedef struct packing {
  const mpmi_parts *parts;
  const mpmi_cover *cover;
  int64_t tasks;
  int32_t values;
} packing;

/* Task k copies its share of the sent blocks to their places. */
static void pack_task(void *data, int64_t k) {
  const packing *p = data;
  const mpmi_parts *parts = p->parts;
  const int64_t end = parts->sent_count * (k + 1) / p->tasks;
  for (int64_t i = parts->sent_count * k / p->tasks; i < end; ++i) {
    const mpmi_shared_block *block = &parts->sent[i];
    const mpmi_node_box box = sent_box(parts, block, p->cover);
    if (block->place)
      copy_box(parts, &box, p->values, mpmi_tiles_of(parts, block->block, p->values), block->place, 0);
  }
}

/* Puts the status at the beginning, which is there in any case. */
static mpm_status begin_message(mpmi_parts *parts, int32_t part, mpm_status status) {
  const int64_t word[2] = {status, 0};
  parts->out[part].used = 0;
  void *at = mpmi_buffer_take(parts->context, &parts->out[part], sizeof word);
  if (!at) return MPM_E_NOMEM;
  memcpy(at, word, sizeof word);
  return MPM_OK;
}

static mpm_status pack(mpmi_parts *parts, int32_t values, const mpmi_cover *cover) {
  packing p = {parts, cover, 1, values};
  int64_t bytes = 0;
  for (int64_t i = 0; i < parts->partner_count; ++i) {
    const mpm_status status = lay_out(parts, &parts->partner[i], values, cover);
    if (status) return status;
    bytes += parts->out[parts->partner[i].part].used;
  }
  p.tasks = mpmi_copy_tasks(parts->context, bytes);
  return mpmi_parallel_for(parts->context, p.tasks, pack_task, &p);
}

static mpm_status begin_messages(mpmi_parts *parts, mpm_status status) {
  mpm_status bad = MPM_OK;
  for (int64_t i = 0; i < parts->partner_count; ++i) {
    const mpm_status now = begin_message(parts, parts->partner[i].part, status);
    bad = bad ? bad : now;
  }
  return bad;
}

mpm_status mpmi_tiles_send(mpmi_parts *parts, int32_t values, const mpmi_cover *cover, mpm_status status) {
  const double started = mpmi_seconds();
  const mpm_status before = status;
  const mpm_status bad = begin_messages(parts, status);
  if (!status) status = bad;
  if (!status) status = pack(parts, values, cover);
  if (status && !before) begin_messages(parts, status);
  for (int64_t i = 0; i < parts->partner_count; ++i) {
    const mpmi_partner *p = &parts->partner[i];
    const mpmi_buffer *out = &parts->out[p->part];
    /* without memory for a word nothing is sent, which says the same as a status */
    parts->message[i] = (mpm_message){.part = p->part, .bytes = out->used, .data = out->at};
    parts->most[i] =
        16 + p->ghosts * (int64_t)(sizeof(piece_head) + sizeof(double) * (size_t)tile_doubles(parts, values));
    parts->info.bytes_nodes += out->used;
  }
  ++parts->exchanges;
  parts->info.seconds_packing += mpmi_seconds() - started;
  const mpm_status lost = mpmi_send(parts->context, MPM_EXCHANGE_KNOWN, (int32_t)parts->partner_count,
                                    parts->message, parts->most);
  return lost ? lost : status;
}

/* Finds what has come for each ghost of a partner. */
static mpm_status read_message(mpmi_parts *parts, const mpmi_partner *from, int32_t values,
                               const mpm_message *in) {
  if (in->part != from->part)
    return mpmi_fail(parts->context, MPM_E_CALLBACK,
                     "the transport has brought a message of part %d, and not of part %d", (int)in->part,
                     (int)from->part);
  const char *at = in->data, *end = at + in->bytes;
  int64_t word[2] = {MPM_E_NOMEM, 0};
  if (in->bytes >= (int64_t)sizeof word) memcpy(word, at, sizeof word);
  if (word[0]) {
    parts->is_echo = 1;
    return MPM_E_STATE;
  }
  for (at += sizeof word; end - at >= (ptrdiff_t)sizeof(piece_head);) {
    piece_head head;
    memcpy(&head, at, sizeof head);
    at += sizeof head;
    const int64_t bytes = nodes_in(parts, &head.box) * values * (int64_t)sizeof(double);
    if (head.ghost < 0 || head.ghost >= from->ghosts || bytes > end - at)
      return mpmi_fail(parts->context, MPM_E_INTERNAL, "a message of part %d is not for part %d",
                       (int)from->part, (int)parts->context->transport.part);
    mpmi_shared_block *ghost = &parts->ghost[from->first_ghost + head.ghost];
    ghost->box = head.box;
    ghost->values = (const double *)(const void *)at;
    at += bytes;
  }
  return MPM_OK;
}

mpm_status mpmi_tiles_receive(mpmi_parts *parts, int32_t values, mpm_status status) {
  mpmi_arrivals in = {0, NULL};
  const mpm_status lost = mpmi_parts_receive(parts, &in);
  if (lost) return lost;
  for (int64_t i = 0; i < parts->ghost_count; ++i) parts->ghost[i].values = NULL;
  if (in.count != parts->partner_count && !status)
    status = mpmi_fail(parts->context, MPM_E_CALLBACK,
                       "the transport has brought %d messages, and there are %lld partners", (int)in.count,
                       (long long)parts->partner_count);
  for (int32_t i = 0; i < in.count && !status; ++i)
    status = read_message(parts, &parts->partner[i], values, &in.message[i]);
  return status;
}

int32_t mpmi_tiles_unpack(const mpmi_parts *parts, const mpmi_shared_block *ghost, int32_t values,
                          double *tile, mpmi_cover *cover) {
  if (!ghost->values) return 0;
  cover->nodes = ghost->box;
  copy_box(parts, &ghost->box, values, tile, (double *)(uintptr_t)ghost->values, 1);
  return 1;
}
