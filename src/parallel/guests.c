#include "parallel/guests.h"

#include <string.h>

/* What comes before the rows of a block's particles in a message: the number of the block in the sender's
 * list, the set, how many slots. */
typedef struct guests_head {
  int64_t block, member, slots;
} guests_head;

/* Returns 1 for what contact reads of particles. */
static int32_t is_told_of(const mpm_particles *set, int32_t field) {
  switch (field) {
  case MPMI_ID:
  case MPMI_POSITION:
  case MPMI_VOLUME:
  case MPMI_INITIAL_VOLUME:
  case MPMI_F:
    return 1;
  case MPMI_SIZE:
    return set->field[field].present;
  case MPMI_REFERENCE:
    return mpmi_is_total_lagrangian(set->grid);
  default:
    return 0;
  }
}

static int64_t guest_rows(const mpm_particles *set) {
  int64_t rows = 0;
  for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f)
    if (is_told_of(set, f)) rows += set->field[f].components;
  return rows;
}

/* ---- sending ------------------------------------------------------------------------------------------- */
/* Returns the copy of a field that is sent. */
static int32_t copy_of(int32_t field, int32_t copy) {
  return field == MPMI_POSITION || field == MPMI_F ? copy : 0;
}

static mpm_status pack_guests(mpmi_parts *parts, int32_t to, guests_head head, const mpm_particles *set,
                              int64_t begin, int32_t copy) {
  const size_t row = (size_t)head.slots * sizeof(uint64_t);
  char *at = mpmi_buffer_take(parts->context, &parts->out[to],
                              (int64_t)(sizeof head + (size_t)guest_rows(set) * row));
  if (!at) return MPM_E_NOMEM;
  memcpy(at, &head, sizeof head);
  at += sizeof head;
  for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f)
    for (int32_t c = 0; is_told_of(set, f) && c < set->field[f].components; ++c, at += row)
      memcpy(at, (const uint64_t *)set->field[f].data[copy_of(f, copy)] + c * set->ld + begin, row);
  return MPM_OK;
}

static mpm_status pack_guests_for(mpmi_parts *parts, const mpmi_partner *to, const mpmi_host_set *sets,
                                  int32_t count, int32_t copy) {
  for (int64_t i = 0; i < to->sent; ++i) {
    const int64_t block = parts->sent[to->first_sent + i].block;
    for (int32_t m = 0; m < count && parts->given[block]; ++m) {
      const int64_t begin = sets[m].now->start[block], slots = sets[m].now->start[block + 1] - begin;
      if (!slots) continue;
      const mpm_status status =
          pack_guests(parts, to->part, (guests_head){i, m, slots}, sets[m].set, begin, copy);
      if (status) return status;
    }
  }
  return MPM_OK;
}

/* ---- taking -------------------------------------------------------------------------------------------- */
static mpmi_partner *partner_by_part(mpmi_parts *parts, int32_t part) {
  for (int64_t i = 0; i < parts->partner_count; ++i)
    if (parts->partner[i].part == part) return &parts->partner[i];
  return NULL;
}

/* Goes through what has come: counts the slots, or with `fill` takes them. */
static mpm_status each_guest_block(mpmi_parts *parts, const mpm_message *in, const mpmi_host_set *sets,
                                   int32_t count, int32_t fill) {
  const char *at = in->data, *end = at + in->bytes;
  const mpmi_partner *from = partner_by_part(parts, in->part);
  while (end - at >= (ptrdiff_t)sizeof(guests_head)) {
    guests_head head;
    memcpy(&head, at, sizeof head);
    at += sizeof head;
    const int64_t most = (end - at) / (int64_t)sizeof(uint64_t);
    if (!from || head.block < 0 || head.block >= from->ghosts || head.member < 0 || head.member >= count ||
        head.slots < 1 || head.slots > most / guest_rows(sets[head.member].set))
      return mpmi_fail(parts->context, MPM_E_INTERNAL, "guests of part %d do not fit part %d", (int)in->part,
                       (int)parts->context->transport.part);
    mpmi_guest_set *to = &parts->guests[head.member];
    const int64_t ghost = from->first_ghost + head.block, first = to->set.slots;
    to->set.slots += head.slots;
    for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f)
      for (int32_t c = 0; is_told_of(&to->set, f) && c < to->set.field[f].components;
           ++c, at += head.slots * (int64_t)sizeof(uint64_t))
        if (fill)
          memcpy((uint64_t *)to->set.field[f].data[0] + c * to->set.ld + first, at,
                 (size_t)head.slots * sizeof(uint64_t));
    if (!fill) continue;
    to->start[2 * ghost] = first;
    to->start[2 * ghost + 1] = to->set.slots;
    parts->guest_of[parts->ghost[ghost].block] = (int32_t)ghost + 1;
  }
  return MPM_OK;
}

/* Makes a set's guests ready to be counted. */
static mpm_status prepare_guests(mpmi_parts *parts, mpmi_guest_set *of, const mpm_particles *set) {
  const mpm_status status =
      MPMI_RESERVE_MORE(parts->context, of->start, of->start_capacity, 2 * parts->ghost_count);
  if (status) return status;
  if (parts->ghost_count) memset(of->start, 0, (size_t)(2 * parts->ghost_count) * sizeof *of->start);
  of->set.context = set->context;
  of->set.grid = set->grid;
  of->set.material = set->material;
  of->set.slots = 0;
  for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f) {
    of->set.field[f].components = set->field[f].components;
    of->set.field[f].present = set->field[f].present;
  }
  return MPM_OK;
}

/* Gives the counted ones their memory. */
static mpm_status lay_out_guests(mpmi_parts *parts, mpmi_guest_set *of) {
  const int64_t rows = guest_rows(&of->set), ld = of->set.slots;
  const mpm_status status = MPMI_RESERVE_MORE(parts->context, of->memory, of->capacity, rows * ld);
  if (status) return status;
  uint64_t *at = of->memory;
  of->set.ld = ld;
  of->set.slots = 0;
  for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f) {
    of->set.field[f].data[0] = is_told_of(&of->set, f) ? at : NULL;
    of->set.field[f].data[1] = of->set.field[f].data[0]; /* at either time, what was sent last */
    if (is_told_of(&of->set, f) && at) at += of->set.field[f].components * ld;
  }
  return MPM_OK;
}

static mpm_status reserve_guest_sets(mpmi_parts *parts, int32_t count) {
  if (count <= parts->guest_count) return MPM_OK;
  mpmi_guest_set *more = mpmi_alloc_zeroed(parts->context, mpmi_bytes(count, sizeof *more));
  if (!more) return MPM_E_NOMEM;
  if (parts->guest_count) memcpy(more, parts->guests, (size_t)parts->guest_count * sizeof *more);
  MPMI_FREE_ARRAY(parts->context, parts->guests, parts->guest_count);
  parts->guests = more;
  parts->guest_count = count;
  return MPM_OK;
}

static mpm_status take_guests(mpmi_parts *parts, const mpmi_arrivals *in, const mpmi_host_set *sets,
                              int32_t count) {
  mpm_status status = reserve_guest_sets(parts, count);
  for (int32_t m = 0; m < count && !status; ++m)
    status = prepare_guests(parts, &parts->guests[m], sets[m].set);
  for (int32_t i = 0; i < in->count && !status; ++i)
    status = each_guest_block(parts, &in->message[i], sets, count, 0);
  for (int32_t m = 0; m < count && !status; ++m) status = lay_out_guests(parts, &parts->guests[m]);
  for (int32_t i = 0; i < in->count && !status; ++i)
    status = each_guest_block(parts, &in->message[i], sets, count, 1);
  return status;
}

mpm_status mpmi_guests_exchange(mpmi_parts *parts, const mpmi_host_set *sets, int32_t count, int32_t copy) {
  const double started = mpmi_seconds();
  mpmi_arrivals in;
  mpm_status status = MPM_OK;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) parts->out[r].used = 0;
  for (int64_t i = 0; i < parts->partner_count && !status; ++i)
    status = pack_guests_for(parts, &parts->partner[i], sets, count, copy);
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) {
    if (status) parts->out[r].used = 0;
    parts->info.bytes_nodes += parts->out[r].used;
  }
  parts->info.seconds_packing += mpmi_seconds() - started;
  const mpm_status lost = mpmi_parts_exchange(parts, &in);
  if (lost) return lost;
  if (!status) status = take_guests(parts, &in, sets, count);
  status = mpmi_agree(parts->context, status);
  if (status) mpmi_guests_clear(parts);
  return status;
}

void mpmi_guests_clear(mpmi_parts *parts) {
  for (int64_t g = 0; g < parts->ghost_count; ++g) parts->guest_of[parts->ghost[g].block] = 0;
}

void mpmi_guests_free(mpmi_parts *parts) {
  mpm_context *c = parts->context;
  for (int32_t m = 0; m < parts->guest_count; ++m) {
    MPMI_FREE_ARRAY(c, parts->guests[m].start, parts->guests[m].start_capacity);
    MPMI_FREE_ARRAY(c, parts->guests[m].memory, parts->guests[m].capacity);
  }
  MPMI_FREE_ARRAY(c, parts->guests, parts->guest_count);
}
