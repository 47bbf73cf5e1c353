/* A state is loaded from its pieces, which several parts may have: these read what they have, compare it, get
 * the head of the first piece from the part that has it, and share out the blocks. Nothing of a stepper
 * changes before all parts know that all have come so far. */
#include "context/transport.h"
#include "io/state.h"
#include "parallel/migration.h"

#include <string.h>

/* ---- one piece ----------------------------------------------------------------------------------------- */
mpm_status mpmi_state_check_header(mpm_context *context, const mpmi_state_header *header, int64_t bytes,
                                   int32_t of_piece) {
  if (bytes < (int64_t)sizeof *header)
    return mpmi_fail(context, MPM_E_FORMAT, "%lld bytes are too few for a state", (long long)bytes);
  const int32_t is_piece = !memcmp(header->magic, MPMI_PIECE_MAGIC, sizeof header->magic);
  if (!is_piece && memcmp(header->magic, MPMI_STATE_MAGIC, sizeof header->magic) != 0)
    return mpmi_fail(context, MPM_E_FORMAT, "this is not a state of libmpm");
  if (is_piece && !of_piece)
    return mpmi_fail(context, MPM_E_FORMAT,
                     "this is a piece of a state that several parts saved: give all of them to "
                     "mpm_state_load_pieces()");
  if (header->byte_order != MPMI_STATE_BYTE_ORDER)
    return mpmi_fail(context, MPM_E_FORMAT,
                     "the state has the byte order of a machine on which 0.1.0 saved it, or is damaged");
  if (header->format < MPMI_STATE_FIRST_FORMAT || header->format > MPMI_STATE_FORMAT)
    return mpmi_fail(context, MPM_E_FORMAT, "the state has format %u: this library knows formats %d to %d",
                     (unsigned)header->format, (int)MPMI_STATE_FIRST_FORMAT, (int)MPMI_STATE_FORMAT);
  if (header->bytes != bytes)
    return mpmi_fail(context, MPM_E_FORMAT, "the state has %lld bytes, of which there are %lld",
                     (long long)header->bytes, (long long)bytes);
  return MPM_OK;
}

mpm_status mpmi_state_check_sum(mpm_context *context, const char *name, const mpmi_state_header *header,
                                const void *body) {
  const int64_t bytes = header->bytes - (int64_t)sizeof *header;
  mpmi_checksum sum;
  mpmi_checksum_begin(&sum);
  if (bytes % 8 == 0) mpmi_checksum_add(&sum, body, bytes);
  if (bytes % 8 == 0 && mpmi_checksum_end(&sum) == header->checksum) return MPM_OK;
  return mpmi_fail(context, MPM_E_FORMAT, "%s is damaged: its checksum is wrong", name);
}

/* Reads the end of a piece; a state of one part is all there is. */
static mpm_status read_end(mpm_context *context, const mpmi_state_header *header, mpmi_state_piece *piece) {
  mpmi_archive a;
  piece->end = (mpmi_state_end){0, 1, header->checksum};
  if (!memcmp(header->magic, MPMI_STATE_MAGIC, sizeof header->magic)) return MPM_OK;
  mpmi_archive_begin(&a, context, MPMI_FROM_MEMORY);
  a.from = piece->body;
  a.size = piece->bytes;
  piece->bytes -= (int64_t)sizeof piece->end;
  if (piece->bytes < 0) return mpmi_archive_damaged(&a, "it ends too early");
  a.at = piece->bytes;
  mpmi_archive_words(&a, &piece->end, sizeof piece->end);
  if (piece->end.number < 0 || piece->end.number >= piece->end.of || piece->end.of > INT32_MAX)
    mpmi_archive_damaged(&a, "its number makes no sense");
  return a.status;
}

static mpm_status open_piece(mpm_context *context, const void *data, int64_t bytes, int32_t of_piece,
                             mpmi_state_piece *piece) {
  mpmi_state_header header;
  memset(&header, 0, sizeof header);
  memcpy(&header, data, bytes < (int64_t)sizeof header ? (size_t)bytes : sizeof header);
  header = mpmi_state_turn_header(header);
  mpm_status status = mpmi_state_check_header(context, &header, bytes, of_piece);
  if (status) return status;
  *piece = (mpmi_state_piece){.body = (const unsigned char *)data + sizeof header,
                              .bytes = bytes - (int64_t)sizeof header,
                              .format = header.format};
  status = mpmi_state_check_sum(context, "the state", &header, piece->body);
  return status ? status : read_end(context, &header, piece);
}

/* ---- all of them --------------------------------------------------------------------------------------- */
static int32_t is_given(const mpmi_state_end *end, int64_t count, int64_t number) {
  for (int64_t i = 0; i < count; ++i)
    if (end[i].number == number) return 1;
  return 0;
}

/* Refuses what is no state, in the words of any part: the pieces are those of all parts. */
static mpm_status check_pieces(mpm_context *c, const mpmi_state_end *end, int64_t count) {
  if (!count) return mpmi_fail(c, MPM_E_ARG, "no part gives a piece of a state");
  for (int64_t i = 1; i < count; ++i)
    if (end[i].mark != end[0].mark || end[i].of != end[0].of)
      return mpmi_fail(c, MPM_E_ARG, "the pieces are of different states: the first and number %lld of %lld",
                       (long long)i + 1, (long long)count);
  for (int64_t i = 0; i < count; ++i) {
    const int64_t number = end[i].number;
    if (number == i) continue;
    if (is_given(end, i, number))
      return mpmi_fail(c, MPM_E_ARG, "piece %lld of the state is given twice", (long long)number);
    if (is_given(end, count, i))
      return mpmi_fail(c, MPM_E_ARG, "piece %lld of the state comes before piece %lld: give them in order",
                       (long long)number, (long long)i);
    return mpmi_fail(c, MPM_E_ARG, "piece %lld of the state is missing: it has %lld", (long long)i,
                     (long long)end[0].of);
  }
  if (count < end[0].of)
    return mpmi_fail(c, MPM_E_ARG, "piece %lld of the state is missing: it has %lld", (long long)count,
                     (long long)end[0].of);
  return MPM_OK;
}

/* How many pieces all parts have, and how many those before this one (collective). */
static mpm_status count_pieces(mpm_context *c, int32_t count, int64_t *before, int64_t *all) {
  const int64_t parts = c->transport.parts;
  int64_t *of = mpmi_alloc(c, mpmi_bytes(parts, sizeof *of));
  mpm_status status = mpmi_agree(c, of ? MPM_OK : MPM_E_NOMEM);
  if (!status) status = mpmi_gather_parts(c, count, of);
  *before = *all = 0;
  for (int64_t r = 0; r < parts && !status; ++r) {
    if (r < c->transport.part) *before += of[r];
    *all += of[r];
  }
  MPMI_FREE_ARRAY(c, of, parts);
  return status;
}

/* Whether the pieces of all parts are a state (collective). */
static mpm_status compare(mpm_context *c, int32_t count, const mpmi_state_piece *piece) {
  enum { WORDS = sizeof(mpmi_state_end) / sizeof(int64_t) };
  int64_t before, all;
  mpm_status status = count_pieces(c, count, &before, &all);
  if (status) return status;
  int64_t *word = mpmi_alloc_zeroed(c, mpmi_bytes(all, sizeof(mpmi_state_end)));
  status = mpmi_agree(c, word ? MPM_OK : MPM_E_NOMEM);
  for (int32_t i = 0; i < count && !status; ++i)
    memcpy(word + WORDS * (before + i), &piece[i].end, sizeof piece[i].end);
  if (!status) status = mpmi_reduce_parts(c, MPM_REDUCE_SUM, WORDS * all, word);
  if (!status) status = check_pieces(c, (const mpmi_state_end *)(const void *)word, all);
  mpmi_free(c, word, mpmi_bytes(all, sizeof(mpmi_state_end)));
  return status;
}

/* ---- the head of the first ----------------------------------------------------------------------------- */
static int32_t has_first(const mpmi_state_loading *l) {
  return l->count && l->piece[0].end.number == 0;
}

/* Packs it, with the number of its format before it. */
static mpm_status pack_head(const mpmi_state_loading *l, mpmi_buffer *buffer) {
  const int64_t format = l->piece[0].format;
  buffer->used = 0;
  char *at = mpmi_buffer_take(l->stepper->context, buffer, (int64_t)sizeof format + l->head_bytes);
  if (!at) return MPM_E_NOMEM;
  memcpy(at, &format, sizeof format);
  memcpy(at + sizeof format, l->piece[0].body, (size_t)l->head_bytes);
  return MPM_OK;
}

static mpm_status send_head(const mpmi_state_loading *l, const mpmi_buffer *buffer, mpmi_arrivals *in) {
  mpm_context *c = l->stepper->context;
  mpm_message *message = l->stepper->layout.parts->message;
  int32_t count = 0;
  for (int32_t r = 0; r < c->transport.parts && has_first(l); ++r)
    if (r != c->transport.part)
      message[count++] = (mpm_message){.part = r, .bytes = buffer->used, .data = buffer->at};
  const mpm_status status = mpmi_send(c, MPM_EXCHANGE_SPARSE, count, message, NULL);
  return status ? status : mpmi_parts_receive(l->stepper->layout.parts, in);
}

/* All parts read it (collective). */
static mpm_status share_head(mpmi_state_loading *l) {
  mpm_context *c = l->stepper->context;
  if (mpmi_is_whole(c)) return mpmi_state_read_all(l, &l->piece[0]);
  mpmi_buffer *buffer = &l->stepper->layout.parts->gone;
  mpmi_arrivals in;
  mpm_status status = mpmi_agree(c, has_first(l) ? pack_head(l, buffer) : MPM_OK);
  if (status || (status = send_head(l, buffer, &in))) return status;
  if (has_first(l)) return mpmi_agree(c, mpmi_state_read_all(l, &l->piece[0]));
  int64_t format = 0;
  if (in.count != 1 || in.message->bytes < (int64_t)sizeof format)
    return mpmi_agree(c, mpmi_fail(c, MPM_E_INTERNAL, "%d parts gave the head of a state", (int)in.count));
  const unsigned char *data = in.message->data;
  memcpy(&format, data, sizeof format);
  const mpmi_state_piece first = {.body = data + sizeof format,
                                  .bytes = in.message->bytes - (int64_t)sizeof format,
                                  .format = (uint32_t)format};
  return mpmi_agree(c, mpmi_state_read_all(l, &first));
}

/* ---- loading ------------------------------------------------------------------------------------------- */
/* Makes alike what pieces say of a set, and finds whether all of them are sorted (collective). */
static mpm_status unite(mpmi_state_loading *l) {
  mpm_stepper *s = l->stepper;
  mpm_context *c = s->context;
  const int32_t sets = s->layout.member_count;
  int64_t flag[] = {l->is_unsorted, l->lacks_sums}, blocks = l->block_count;
  mpm_status status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 2, flag);
  if (!status) status = mpmi_reduce_parts(c, MPM_REDUCE_SUM, 1, &blocks);
  l->is_unsorted = flag[0] || !blocks;
  l->lacks_sums = flag[1] != 0;
  if (status || mpmi_is_whole(c)) return status;
  for (int32_t m = 0; m < sets && !status; ++m) {
    int64_t most[] = {l->fresh[m].next_id, mpmi_ordered_bits(l->fresh[m].mass_max)};
    status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 2, most);
    l->fresh[m].next_id = most[0];
    l->fresh[m].mass_max = mpmi_of_ordered_bits(most[1]);
  }
  if (status) return status;
  mpmi_moving_set *moving = mpmi_alloc_zeroed(c, mpmi_bytes(sets, sizeof *moving));
  status = mpmi_agree(c, moving ? MPM_OK : MPM_E_NOMEM);
  for (int32_t m = 0; m < sets && !status; ++m) moving[m].set = &l->fresh[m];
  if (!status) status = mpmi_move_align_fields(s->layout.parts, moving, sets);
  MPMI_FREE_ARRAY(c, moving, sets);
  return status;
}

static mpm_status read_all(mpmi_state_loading *l) {
  const mpm_stepper *s = l->stepper;
  mpm_status status = mpmi_state_read_pieces(l);
  if (!status) status = mpmi_state_check_bodies(l);
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m)
    if (s->adaption[m].on) status = mpmi_field_make_present(&l->fresh[m], MPMI_SIZE);
  return mpmi_agree(s->context, status);
}

/* Makes the layout of a sorted state, as the last part of a sort does (collective). */
static mpm_status lay_out(mpmi_state_loading *l) {
  mpm_stepper *s = l->stepper;
  mpm_context *c = s->context;
  const mpmi_parts *present = s->layout.parts;
  mpm_status status = MPM_OK;
  if (present) {
    status = mpmi_agree(c, mpmi_parts_create(c, s->grid, &l->parts));
    if (status) return status;
    mpmi_layout_set_margins(l->parts, mpmi_state_wide_for(l));
    l->parts->balance = present->balance;
    status = mpmi_state_share(l);
    for (int32_t m = 0; m < s->layout.member_count && !status; ++m)
      status = mpmi_parts_note_body(l->parts, (int32_t)l->all.set[m].numbers.body);
  }
  if (!status) status = mpmi_state_insert_blocks(s, &l->blocks);
  if (present) status = mpmi_pattern_find(l->parts, &s->layout.next_blocks, status);
  if (!status) status = mpmi_blocks_order(&s->layout.next_blocks);
  if (!status) status = mpmi_state_arrange(s, &l->blocks, l->all.set);
  if (!status) status = mpmi_layout_plan(&s->layout, &s->settings);
  if (!status && present) status = mpmi_pattern_adopt(l->parts, &s->layout.next_blocks);
  return mpmi_agree(c, status);
}

/* Loads pieces that are a state (collective). */
static mpm_status load(mpm_stepper *s, int32_t count, const mpmi_state_piece *piece, int32_t tells) {
  mpmi_state_loading l = {.stepper = s, .count = count, .piece = piece, .tells = tells};
  mpm_status status = mpmi_state_load_begin(&l);
  if (!status) status = mpmi_state_measure(&l);
  status = mpmi_agree(s->context, status);
  if (!status) status = share_head(&l);
  if (!status) status = unite(&l);
  if (!status) status = read_all(&l);
  if (!status && !l.is_unsorted) status = lay_out(&l);
  if (!status) mpmi_state_take_over(&l);
  mpmi_state_load_end(&l);
  return status;
}

static mpm_status check_idle(const mpm_stepper *s) {
  if (s->step.phase != MPMI_IDLE)
    return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it before loading");
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE, "%d views of nodal fields are out: release them before loading",
                     (int)s->mapped);
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    if (s->layout.member[m].set->mapped)
      return mpmi_fail(s->context, MPM_E_STATE, "%d views of set %d are out: release them before loading",
                       (int)s->layout.member[m].set->mapped, (int)m);
  return MPM_OK;
}

mpm_status mpmi_state_load(mpm_stepper *s, const void *buffer, int64_t bytes) {
  mpmi_state_piece piece;
  mpm_status status = check_idle(s);
  if (!status && !mpmi_is_whole(s->context))
    status = mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                       "a problem in several parts loads its state by mpm_state_load_pieces()");
  if (!status) status = open_piece(s->context, buffer, bytes, 0, &piece);
  return status ? status : load(s, 1, &piece, 0);
}

mpm_status mpm_state_load(mpm_stepper *stepper, const void *buffer, int64_t bytes) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  if (!buffer) return mpmi_fail(stepper->context, MPM_E_ARG, "buffer is NULL");
  if (bytes < 0)
    return mpmi_fail(stepper->context, MPM_E_ARG, "bytes is %lld, must be >= 0", (long long)bytes);
  return mpmi_state_load(stepper, buffer, bytes);
}

/* Opens what the host gives. */
static mpm_status open_pieces(const mpm_stepper *s, int32_t count, const void *const *data,
                              const int64_t *bytes, mpmi_state_piece **piece) {
  mpm_context *c = s->context;
  if (count < 0) return mpmi_fail(c, MPM_E_ARG, "count is %d, must be >= 0", (int)count);
  if (count && (!data || !bytes)) return mpmi_fail(c, MPM_E_ARG, "%s is NULL", data ? "bytes" : "piece");
  for (int32_t i = 0; i < count; ++i) {
    if (!data[i]) return mpmi_fail(c, MPM_E_ARG, "piece[%d] is NULL", (int)i);
    if (bytes[i] < 0)
      return mpmi_fail(c, MPM_E_ARG, "bytes[%d] is %lld, must be >= 0", (int)i, (long long)bytes[i]);
  }
  mpm_status status = check_idle(s);
  if (status) return status;
  if (!(*piece = mpmi_alloc_zeroed(c, mpmi_bytes(count, sizeof **piece)))) return MPM_E_NOMEM;
  for (int32_t i = 0; i < count; ++i)
    if ((status = open_piece(c, data[i], bytes[i], 1, &(*piece)[i])))
      return mpmi_fail(c, status, "piece[%d]: %s", (int)i, mpm_last_error(c));
  return MPM_OK;
}

mpm_status mpm_state_load_pieces(mpm_stepper *stepper, int32_t count, const void *const *piece,
                                 const int64_t *bytes) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  mpm_context *context = stepper->context;
  mpmi_state_piece *opened = NULL;
  mpm_status status = mpmi_agree(context, open_pieces(stepper, count, piece, bytes, &opened));
  if (!status) status = compare(context, count, opened);
  if (!status) status = load(stepper, count, opened, 1);
  if (opened) MPMI_FREE_ARRAY(context, opened, count);
  return status;
}
