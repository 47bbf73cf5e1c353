#include "parallel/migration.h"
#include "particles/add.h"

#include <string.h>

/* ---- fields -------------------------------------------------------------------------------------------- */
static uint64_t mix_name(uint64_t h, const mpmi_field *field) {
  for (const char *at = field->name; *at; ++at) h = (h ^ (unsigned char)*at) * 0x100000001b3u;
  return (h ^ (uint64_t)(field->type * 4096 + field->components)) * 0x100000001b3u;
}

mpm_status mpmi_move_align_fields(mpmi_parts *parts, mpmi_moving_set *sets, int32_t count) {
  enum { WORDS = MPMI_BUILTIN_FIELDS + 4 };
  mpm_context *c = parts->context;
  mpm_status status = MPM_OK;
  for (int32_t m = 0; m < count; ++m) {
    mpm_particles *set = sets[m].set;
    uint64_t names = 0xcbf29ce484222325u;
    int64_t word[WORDS];
    for (int32_t f = 0; f < set->field_count; ++f) names = mix_name(names, &set->field[f]);
    for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f) word[f] = set->field[f].present;
    const int64_t half[2] = {(int64_t)(names >> 33), (int64_t)(names & 0x7fffffff)};
    for (int32_t i = 0; i < 2; ++i)
      word[MPMI_BUILTIN_FIELDS + i] = half[i], word[MPMI_BUILTIN_FIELDS + 2 + i] = -half[i];
    mpm_status failed = mpmi_reduce_parts(c, MPM_REDUCE_MAX, WORDS, word);
    if (failed) return failed;
    for (int32_t i = 0; i < 2 && !status; ++i)
      if (word[MPMI_BUILTIN_FIELDS + i] != -word[MPMI_BUILTIN_FIELDS + 2 + i])
        status = mpmi_fail(c, MPM_E_STATE,
                           "set %d has other fields than on another part: make the same ones on all", (int)m);
    for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS && !status; ++f)
      if (word[f] && !set->field[f].present) status = mpmi_field_make_present(set, f);
  }
  return mpmi_agree(c, status);
}

/* ---- messages: how many of each set, then its fields component by component ---------------------------- */
static int64_t padded_bytes(const mpmi_field *field, int64_t n) {
  return ((int64_t)mpmi_type_size(field->type) * n + 7) / 8 * 8;
}

static int64_t bytes_of(const mpm_particles *set, int64_t n) {
  int64_t bytes = 0;
  for (int32_t f = 0; f < set->field_count; ++f)
    if (set->field[f].present) bytes += set->field[f].components * padded_bytes(&set->field[f], n);
  return bytes;
}

/* The part to which a particle goes, -1 for a hole. The blocks of the slots are where mpmi_sort_blocks() has
 * put them. */
static int32_t goes_to(const int32_t *owner, const mpm_particles *set, int64_t slot) {
  return mpmi_i64(set, MPMI_ID, 0)[slot] < 0 ? -1 : owner[mpmi_sort_blocks_of_slots(set)[slot]];
}

/* Slots one after the other of particles that leave for the same part: sorts put those of a block side by
 * side. */
typedef struct leaving {
  int64_t slot, n;
} leaving;

/* The columns of a piece of a message: n particles of a set, component after component of its fields. */
typedef struct piece {
  const mpm_particles *set;
  int64_t n, slot; /* slot: where those that have come go */
  const leaving *run, *end;
  char *to; /* of what leaves */
  const char *from;
  int64_t tasks;
} piece;
/* Copies n values of a column, which lie `offset` behind the beginning of the piece. */
typedef void (*column_fn)(const piece *p, char *column, size_t size, int64_t offset);

/* Goes through task k's share of them. */
static void each_column(const piece *p, int64_t k, column_fn fn) {
  int64_t columns = 0, column = 0, offset = 0;
  for (int32_t f = 0; f < p->set->field_count; ++f)
    if (p->set->field[f].present) columns += p->set->field[f].components;
  const int64_t begin = columns * k / p->tasks, end = columns * (k + 1) / p->tasks;
  for (int32_t f = 0; f < p->set->field_count; ++f) {
    const mpmi_field *field = &p->set->field[f];
    const size_t size = mpmi_type_size(field->type);
    for (int32_t c = 0; field->present && c < field->components; ++c, ++column) {
      char *at = (char *)field->data[0] + (size_t)(c * p->set->ld) * size;
      if (column >= begin && column < end) fn(p, at, size, offset);
      offset += padded_bytes(field, p->n);
    }
  }
}

static void pack_column(const piece *p, char *column, size_t size, int64_t offset) {
  char *at = p->to + offset;
  for (const leaving *i = p->run; i < p->end; at += (size_t)i++->n * size)
    memcpy(at, column + (size_t)i->slot * size, (size_t)i->n * size);
}

static void pack_task(void *data, int64_t k) {
  each_column(data, k, pack_column);
}

/* Adds particles of set number m to the message of a part. */
static mpm_status pack_set(mpmi_parts *parts, int32_t to, int32_t m, const mpm_particles *set,
                           const leaving *run, const leaving *end) {
  int64_t n = 0;
  for (const leaving *i = run; i < end; ++i) n += i->n;
  const int64_t head[2] = {m, n};
  char *at = mpmi_buffer_take(parts->context, &parts->out[to], (int64_t)sizeof head + bytes_of(set, n));
  if (!at) return MPM_E_NOMEM;
  memcpy(at, head, sizeof head);
  piece p = {.set = set, .n = n, .run = run, .end = end, .to = at + sizeof head};
  p.tasks = mpmi_copy_tasks(parts->context, bytes_of(set, n));
  return mpmi_parallel_for(parts->context, p.tasks, pack_task, &p);
}

/* Lists what leaves, part by part: end[r] is behind what goes to part r. The list is kept, because the memory
 * in which the blocks of slots stand is needed for others later. */
static mpm_status list_leaving(mpmi_parts *parts, const int32_t *owner, mpmi_moving_set *of, int64_t *end,
                               const leaving **list) {
  const int32_t all = mpmi_part_count(parts), me = parts->context->transport.part;
  int32_t before = me;
  memset(end, 0, (size_t)all * sizeof *end);
  of->leave = of->runs = 0;
  for (int64_t s = 0; s < of->set->slots; ++s) {
    const int32_t to = goes_to(owner, of->set, s);
    if (to >= 0 && to != me) {
      ++of->leave;
      end[to] += to != before;
    }
    before = to;
  }
  for (int32_t r = 0; r < all; ++r) {
    const int64_t n = end[r];
    end[r] = of->runs;
    of->runs += n;
  }
  leaving *run = mpmi_buffer_take(parts->context, &parts->gone, of->runs * (int64_t)sizeof *run);
  if (!run) return MPM_E_NOMEM;
  before = me;
  for (int64_t s = 0; s < of->set->slots && of->leave; ++s) {
    const int32_t to = goes_to(owner, of->set, s);
    if (to >= 0 && to != me) {
      if (to != before) run[end[to]++] = (leaving){s, 0};
      ++run[end[to] - 1].n;
    }
    before = to;
  }
  *list = run;
  return MPM_OK;
}

/* Packs what goes elsewhere. */
static mpm_status pack(mpmi_parts *parts, const int32_t *owner, mpmi_moving_set *sets, int32_t count) {
  const int32_t all = mpmi_part_count(parts);
  int64_t *end = parts->owner_count;
  const leaving *run = NULL;
  parts->gone.used = 0;
  for (int32_t r = 0; r < all; ++r) parts->out[r].used = 0;
  for (int32_t m = 0; m < count; ++m) {
    mpm_status status = list_leaving(parts, owner, &sets[m], end, &run);
    int64_t begin = 0;
    for (int32_t r = 0; r < all && !status; begin = end[r++])
      if (end[r] > begin) status = pack_set(parts, r, m, sets[m].set, run + begin, run + end[r]);
    if (status) return status;
  }
  return MPM_OK;
}

/* ---- what has come ------------------------------------------------------------------------------------- */
/* Goes through the pieces of all messages. low: they come from a part before this one. */
typedef void (*piece_fn)(mpmi_moving_set *to, int32_t low, int64_t n, const char *values);
static mpm_status each_piece(mpmi_parts *parts, const mpmi_arrivals *in, mpmi_moving_set *sets, int32_t count,
                             piece_fn fn) {
  for (int32_t i = 0; i < in->count; ++i) {
    const char *at = in->message[i].data, *end = at + in->message[i].bytes;
    while (end - at >= (ptrdiff_t)(2 * sizeof(int64_t))) {
      int64_t head[2];
      memcpy(head, at, sizeof head);
      at += sizeof head;
      const int64_t room = end - at;
      if (head[0] < 0 || head[0] >= count || head[1] < 1 || head[1] > room ||
          bytes_of(sets[head[0]].set, head[1]) > room)
        return mpmi_fail(parts->context, MPM_E_INTERNAL,
                         "particles of part %d do not fit the sets of part %d", (int)in->message[i].part,
                         (int)parts->context->transport.part);
      fn(&sets[head[0]], in->message[i].part < parts->context->transport.part, head[1], at);
      at += bytes_of(sets[head[0]].set, head[1]);
    }
  }
  return MPM_OK;
}

static void count_piece(mpmi_moving_set *to, int32_t low, int64_t n, const char *values) {
  (void)values;
  to->arrive += n;
  if (low) to->arrive_low += n;
}

static void take_column(const piece *p, char *column, size_t size, int64_t offset) {
  memcpy(column + (size_t)p->slot * size, p->from + offset, (size_t)p->n * size);
}

static void take_task(void *data, int64_t k) {
  each_column(data, k, take_column);
}

/* Where the next piece of each set goes is kept in its sorting. */
static void take_piece(mpmi_moving_set *to, int32_t low, int64_t n, const char *values) {
  mpm_context *c = to->set->context;
  piece p = {.set = to->set, .n = n, .slot = to->sorting->tail + to->sorting->tail_count, .from = values};
  p.tasks = mpmi_copy_tasks(c, bytes_of(to->set, n));
  (void)low;
  mpmi_parallel_for_sure(c, p.tasks, take_task, &p);
  to->sorting->tail_count += n;
}

/* ---- both ways ----------------------------------------------------------------------------------------- */
static mpm_status make_room(mpmi_parts *parts, const mpmi_arrivals *in, mpmi_moving_set *sets,
                            int32_t count) {
  for (int32_t m = 0; m < count; ++m) sets[m].arrive = sets[m].arrive_low = 0;
  mpm_status status = each_piece(parts, in, sets, count, count_piece);
  for (int32_t m = 0; m < count && !status; ++m) {
    status = mpmi_check_room(sets[m].set, sets[m].arrive);
    if (!status && sets[m].arrive) status = mpmi_append_reserve(sets[m].set, sets[m].arrive, 0, 0);
  }
  return status;
}

/* Makes holes of the particles that have gone, and the arrivals particles. There is room. */
static void carry_out(mpmi_parts *parts, const mpmi_arrivals *in, mpmi_moving_set *sets, int32_t count) {
  const leaving *gone = (const void *)parts->gone.at;
  for (int32_t m = 0; m < count; ++m) {
    mpm_particles *set = sets[m].set;
    for (int64_t i = 0; i < sets[m].runs; ++i, ++gone) mpmi_make_holes(set, gone->slot, gone->slot + gone->n);
    sets[m].sorting->tail = sets[m].arrive ? mpmi_append_begin(set, sets[m].arrive) : set->slots;
    sets[m].sorting->tail_count = 0;
    sets[m].sorting->tail_low = sets[m].arrive_low;
    set->count += sets[m].arrive - sets[m].leave;
    set->dirty |= MPMI_DIRTY_PLACE;
    mpmi_index_drop(set);
  }
  each_piece(parts, in, sets, count, take_piece);
}

static mpm_status move_owned(mpmi_parts *parts, const mpmi_blocks *blocks, int32_t *owner,
                             mpmi_moving_set *sets, int32_t count, int64_t *moved) {
  mpmi_arrivals in;
  double started = mpmi_seconds();
  for (int64_t i = 0; i < blocks->count; ++i) owner[i] = mpmi_cut_owner(parts, blocks->key[i]);
  mpm_status status = pack(parts, owner, sets, count);
  for (int32_t r = 0; r < mpmi_part_count(parts) && status; ++r) parts->out[r].used = 0;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) parts->info.bytes_moved += parts->out[r].used;
  parts->info.seconds_packing += mpmi_seconds() - started;
  const mpm_status lost = mpmi_parts_exchange(parts, &in);
  if (lost) return lost;
  if (!status) status = make_room(parts, &in, sets, count);
  if ((status = mpmi_agree(parts->context, status))) return status;
  for (int32_t m = 0; m < count; ++m) {
    parts->info.moved += sets[m].leave;
    *moved += sets[m].leave + sets[m].arrive;
  }
  started = mpmi_seconds();
  if (*moved) carry_out(parts, &in, sets, count);
  parts->info.seconds_packing += mpmi_seconds() - started;
  return MPM_OK;
}

mpm_status mpmi_move_particles(mpmi_parts *parts, const mpmi_blocks *blocks, mpmi_moving_set *sets,
                               int32_t count, int64_t *moved) {
  mpm_context *c = parts->context;
  const size_t bytes = mpmi_bytes(blocks->count + 1, sizeof(int32_t));
  int32_t *owner = mpmi_alloc(c, bytes);
  mpm_status status = mpmi_agree(c, owner ? MPM_OK : MPM_E_NOMEM);
  *moved = 0;
  if (!status) status = move_owned(parts, blocks, owner, sets, count, moved);
  mpmi_free(c, owner, bytes);
  return status;
}
