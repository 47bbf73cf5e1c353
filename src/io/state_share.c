/* A sorted state is shared out by whole blocks: these go to the parts that are to have them, with the slots
 * that they have, holes among them. Particles may have left their blocks since the last sort, and stay with
 * them until the next one, so that a step adds things up as if nothing had happened.
 *
 * What a part gives to another is in order, and all of it comes before or behind what that one has itself.
 * A message has the number of blocks, their places, for each set where their slots begin and how many there
 * are, and then for each set its fields, component by component. */
#include "io/state.h"

#include <string.h>

/* A range of blocks: in a message, or that which this part keeps. */
typedef struct portion {
  int64_t blocks;
  const char *place, *start, *rows;
} portion;

static int64_t slot_bytes(const mpm_particles *set) {
  int64_t bytes = 0;
  for (int32_t f = 0; f < set->field_count; ++f)
    if (set->field[f].present)
      bytes += set->field[f].components * (int64_t)mpmi_type_size(set->field[f].type);
  return bytes;
}

static int64_t start_of(const portion *p, int32_t m, int64_t block) {
  int64_t start;
  memcpy(&start, p->start + (m * (p->blocks + 1) + block) * (int64_t)sizeof start, sizeof start);
  return start;
}

/* ---- packing ------------------------------------------------------------------------------------------- */
static mpm_status pack(const mpmi_state_loading *l, int64_t first, int64_t end, mpmi_buffer *buffer) {
  mpm_context *c = l->stepper->context;
  const int32_t sets = l->stepper->layout.member_count;
  const int64_t count = end - first, word = (int64_t)sizeof(int64_t);
  int64_t bytes = word + count * 4 * word + sets * (count + 1) * word;
  for (int32_t m = 0; m < sets; ++m) {
    const int64_t *start = mpmi_state_starts(&l->blocks, m);
    bytes += (start[end] - start[first]) * slot_bytes(&l->fresh[m]);
  }
  buffer->used = 0;
  char *at = mpmi_buffer_take(c, buffer, bytes);
  if (!at) return MPM_E_NOMEM;
  memcpy(at, &count, sizeof count);
  memcpy(at += word, l->blocks.place[first], (size_t)(count * 4 * word));
  at += count * 4 * word;
  for (int32_t m = 0; m < sets; ++m)
    for (int64_t i = first; i <= end; ++i, at += word) {
      const int64_t start = mpmi_state_starts(&l->blocks, m)[i] - mpmi_state_starts(&l->blocks, m)[first];
      memcpy(at, &start, sizeof start);
    }
  for (int32_t m = 0; m < sets; ++m) {
    const mpm_particles *set = &l->fresh[m];
    const int64_t *start = mpmi_state_starts(&l->blocks, m), slots = start[end] - start[first];
    for (int32_t f = 0; f < set->field_count; ++f) {
      const mpmi_field *field = &set->field[f];
      const int64_t size = (int64_t)mpmi_type_size(field->type);
      for (int32_t k = 0; k < field->components && field->present && slots; ++k, at += slots * size)
        memcpy(at, (const char *)field->data[0] + (k * set->ld + start[first]) * size,
               (size_t)(slots * size));
    }
  }
  return MPM_OK;
}

/* Finds the blocks that a part is to have among those that this one has: [first, end). */
static int64_t find_range(const mpmi_state_loading *l, int32_t part, int64_t first) {
  const mpmi_blocks *blocks = &l->stepper->layout.next_blocks;
  while (first < blocks->count && mpmi_cut_owner(l->parts, blocks->key[first]) <= part) ++first;
  return first;
}

/* ---- what has come ------------------------------------------------------------------------------------- */
static mpm_status open_portion(const mpmi_state_loading *l, const char *at, int64_t bytes, portion *p) {
  const int32_t sets = l->stepper->layout.member_count;
  const int64_t word = (int64_t)sizeof(int64_t);
  int64_t left = bytes - word;
  *p = (portion){0};
  if (left >= 0) memcpy(&p->blocks, at, sizeof p->blocks);
  int32_t fits = left >= 0 && p->blocks > 0 && p->blocks <= left / (4 * word);
  if (fits) left -= p->blocks * 4 * word + sets * (p->blocks + 1) * word;
  fits = fits && left >= 0;
  p->place = at + word;
  p->start = p->place + (fits ? p->blocks * 4 * word : 0);
  p->rows = p->start + (fits ? sets * (p->blocks + 1) * word : 0);
  for (int32_t m = 0; m < sets && fits; ++m) {
    const int64_t slots = start_of(p, m, p->blocks), each = slot_bytes(&l->fresh[m]);
    fits = slots >= 0 && slots <= left / each;
    left -= fits ? slots * each : 0;
  }
  return fits && !left ? MPM_OK
                       : mpmi_fail(l->stepper->context, MPM_E_INTERNAL,
                                   "blocks of another part do not fit the sets of part %d",
                                   (int)l->stepper->context->transport.part);
}

/* Opens the portions in the order of their blocks: of the parts before this one, its own, of those after. */
static mpm_status open_all(const mpmi_state_loading *l, const mpmi_arrivals *in, portion *list,
                           int32_t *count) {
  const int32_t me = l->stepper->context->transport.part;
  const mpmi_buffer *own = &l->parts->gone;
  mpm_status status = MPM_OK;
  int32_t i = 0;
  *count = 0;
  for (; i < in->count && in->message[i].part < me && !status; ++i)
    status = open_portion(l, in->message[i].data, in->message[i].bytes, &list[(*count)++]);
  if (own->used && !status) status = open_portion(l, own->at, own->used, &list[(*count)++]);
  for (; i < in->count && !status; ++i)
    status = open_portion(l, in->message[i].data, in->message[i].bytes, &list[(*count)++]);
  return status;
}

static mpm_status join_blocks(mpmi_state_loading *l, const portion *list, int32_t count) {
  mpm_context *c = l->stepper->context;
  const int32_t sets = l->stepper->layout.member_count;
  int64_t blocks = 0;
  for (int32_t i = 0; i < count; ++i) blocks += list[i].blocks;
  mpmi_state_blocks_free(c, sets, &l->blocks);
  const mpm_status status = mpmi_state_blocks_make(c, sets, blocks, &l->blocks);
  if (status) return status;
  int64_t first = 0;
  for (int32_t i = 0; i < count; first += list[i++].blocks) {
    memcpy(l->blocks.place[first], list[i].place, (size_t)list[i].blocks * sizeof *l->blocks.place);
    for (int32_t m = 0; m < sets; ++m) {
      int64_t *start = mpmi_state_starts(&l->blocks, m) + first;
      const int64_t before = *start; /* how many slots there are so far */
      for (int64_t b = 0; b <= list[i].blocks; ++b) start[b] = before + start_of(&list[i], m, b);
    }
  }
  return MPM_OK;
}

static void join_slots(mpmi_state_loading *l, const portion *p) {
  const char *at = p->rows;
  for (int32_t m = 0; m < l->stepper->layout.member_count; ++m) {
    mpm_particles *set = &l->fresh[m];
    const int64_t slots = start_of(p, m, p->blocks);
    for (int32_t f = 0; f < set->field_count; ++f) {
      const mpmi_field *field = &set->field[f];
      const int64_t size = (int64_t)mpmi_type_size(field->type);
      for (int32_t k = 0; k < field->components && field->present && slots; ++k, at += slots * size)
        memcpy((char *)field->data[0] + (k * set->ld + set->slots) * size, at, (size_t)(slots * size));
    }
    for (int64_t s = set->slots; s < set->slots + slots; ++s) set->count += mpmi_i64(set, MPMI_ID, 0)[s] >= 0;
    set->slots += slots;
  }
}

static mpm_status join(mpmi_state_loading *l, const mpmi_arrivals *in, portion *list) {
  int32_t count;
  mpm_status status = open_all(l, in, list, &count);
  if (!status) status = join_blocks(l, list, count);
  for (int32_t m = 0; m < l->stepper->layout.member_count && !status; ++m) {
    mpmi_state_drop_storage(&l->fresh[m]);
    status = mpmi_particles_reserve(&l->fresh[m], mpmi_state_starts(&l->blocks, m)[l->blocks.count]);
  }
  for (int32_t i = 0; i < count && !status; ++i) join_slots(l, &list[i]);
  return status;
}

/* ---- both ways ----------------------------------------------------------------------------------------- */
static mpm_status pack_all(mpmi_state_loading *l, int64_t *first, int64_t *end) {
  mpmi_parts *parts = l->parts;
  const int32_t me = l->stepper->context->transport.part;
  int64_t at = 0;
  mpm_status status = MPM_OK;
  *first = *end = 0;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) {
    const int64_t to = find_range(l, r, at);
    if (r == me)
      *first = at, *end = to;
    else if (to > at && !status)
      status = pack(l, at, to, &parts->out[r]);
    at = to;
  }
  for (int32_t r = 0; r < mpmi_part_count(parts) && status; ++r) parts->out[r].used = 0;
  return status;
}

static mpm_status exchange(mpmi_state_loading *l) {
  mpm_context *c = l->stepper->context;
  mpmi_arrivals in;
  int64_t first, end;
  mpm_status status = pack_all(l, &first, &end);
  const mpm_status lost = mpmi_parts_exchange(l->parts, &in);
  if (lost || status) return lost ? lost : status;
  if (!in.count && end - first == l->blocks.count) return MPM_OK;
  l->parts->gone.used = 0;
  if (end > first && (status = pack(l, first, end, &l->parts->gone))) return status;
  portion *list = mpmi_alloc(c, mpmi_bytes(in.count + 1, sizeof *list));
  if (!list) return MPM_E_NOMEM;
  status = join(l, &in, list);
  MPMI_FREE_ARRAY(c, list, in.count + 1);
  return status;
}

mpm_status mpmi_state_share(mpmi_state_loading *l) {
  mpm_stepper *s = l->stepper;
  mpm_context *c = s->context;
  const int64_t count = l->blocks.count;
  int64_t *weight = mpmi_alloc(c, mpmi_bytes(count + 1, sizeof *weight));
  mpm_status status = weight ? mpmi_state_insert_blocks(s, &l->blocks) : (mpm_status)MPM_E_NOMEM;
  for (int64_t b = 0; b < count && weight; ++b) {
    weight[b] = mpmi_block_weight(l->parts);
    for (int32_t m = 0; m < s->layout.member_count; ++m)
      weight[b] += MPMI_PARTICLE_WEIGHT *
                   (mpmi_state_starts(&l->blocks, m)[b + 1] - mpmi_state_starts(&l->blocks, m)[b]);
  }
  status = mpmi_agree(c, status);
  if (!status) status = mpmi_cut_blocks(l->parts, &s->layout.next_blocks, weight);
  MPMI_FREE_ARRAY(c, weight, count + 1);
  return status ? status : exchange(l);
}
