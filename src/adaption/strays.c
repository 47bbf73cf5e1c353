/* Adaption of a set that several parts have. Between two sorts the particles of a cell may lie on several
 * parts. The part whose blocks have the cell is its home: it gets copies of the particles there that others
 * have, its strays, chooses as one part would, and tells the others what becomes of theirs. A pair becomes
 * one where the particle is that stays; if the other one is elsewhere, a copy of it comes along.
 *
 * Copies stand behind the slots of the set, where no step sees them, in the state that adapts. */
#include <math.h>

#include "adaption/adaption.h"
#include "heat/heat.h"
#include "particles/add.h"
#include "particles/thermal.h"

/* ---- particles as bytes -------------------------------------------------------------------------------- */
static int64_t row_bytes(const mpmi_field *field) {
  return (int64_t)mpmi_type_size(field->type);
}

static int64_t particle_bytes(const mpm_particles *set) {
  int64_t bytes = 0;
  for (int32_t f = 0; f < set->field_count; ++f)
    if (set->field[f].present) bytes += set->field[f].components * row_bytes(&set->field[f]);
  return (bytes + 7) / 8 * 8;
}

static char *value_at(const mpmi_adapting *of, const mpmi_field *field, int32_t c, int64_t slot) {
  char *data = field->data[field->two_copies ? of->copy : 0];
  return data + (c * of->set->ld + slot) * row_bytes(field);
}

/* The temperatures that the step has found are in its rows. */
static void pack_temperatures(const mpmi_adapting *of, int32_t f, int64_t slot, char *at) {
  const mpmi_heat_rule *rule = &of->settings->heat.set[of->m];
  if (!of->step || !rule->on || slot >= of->a->own || f < MPMI_BUILTIN_FIELDS) return;
  const mpmi_member_rows *rows = &of->step->work->rows.of[of->m];
  double T;
  if (f == of->set->thermal.temperature)
    T = mpmi_heat_new_temperature(rule, rows, of->set, slot);
  else if (f == of->set->thermal.stress_temperature && mpmi_expands(of->set))
    T = rows->heat[slot];
  else
    return;
  memcpy(at, &T, sizeof T);
}

static void pack_particle(const mpmi_adapting *of, int64_t slot, char *at) {
  for (int32_t f = 0; f < of->set->field_count; ++f) {
    const mpmi_field *field = &of->set->field[f];
    const int64_t size = row_bytes(field);
    for (int32_t c = 0; c < field->components && field->present; ++c, at += size) {
      memcpy(at, value_at(of, field, c, slot), (size_t)size);
      pack_temperatures(of, f, slot, at);
    }
  }
}

static void unpack_particle(const mpmi_adapting *of, int64_t slot, const char *at) {
  for (int32_t f = 0; f < of->set->field_count; ++f) {
    const mpmi_field *field = &of->set->field[f];
    const int64_t size = row_bytes(field);
    for (int32_t c = 0; c < field->components && field->present; ++c, at += size)
      memcpy(value_at(of, field, c, slot), at, (size_t)size);
  }
}

/* Makes room behind all slots for n copies; *first: the first of them. The caller sees to it that the set has
 * its own slots again in the end. */
static mpm_status make_room(const mpmi_adapting *of, int64_t n, int64_t *first) {
  mpm_particles *set = of->set;
  *first = set->slots;
  if (!n) return MPM_OK;
  mpm_status status = mpmi_check_room(set, n);
  if (!status) status = mpmi_append_reserve(set, n, 0, of->copy);
  if (status) return status;
  set->slots = (set->slots + n + MPMI_PAD - 1) / MPMI_PAD * MPMI_PAD;
  mpmi_particles_watch(set, set->slots);
  for (int32_t copy = 0; copy < 2; ++copy)
    mpmi_fill_holes(set, copy, *first, set->slots, set->grid->desc.origin);
  return MPM_OK;
}

/* ---- strays -------------------------------------------------------------------------------------------- */
static int32_t home_of(const mpmi_adapting *of, int64_t slot) {
  const mpm_grid *grid = of->set->grid;
  int32_t coord[3] = {0, 0, 0};
  for (int32_t k = 0; k < grid->dim; ++k)
    coord[k] = (int32_t)(mpmi_cell_along(grid, k, mpmi_row_of(of->set, MPMI_POSITION, of->copy, k)[slot]) /
                         MPMI_BLOCK_EDGE(grid->dim));
  if (of->parts->is_cut) return mpmi_cut_owner(of->parts, mpmi_block_key(grid, coord));
  /* nothing has been sorted yet */
  return (int32_t)((int64_t)coord[0] * mpmi_part_count(of->parts) /
                   (grid->desc.cells[0] / MPMI_BLOCK_EDGE(grid->dim) + 1));
}

/* Marks the particles that others choose for, and sends copies of them. */
static mpm_status send_strays(const mpmi_adapting *of) {
  mpm_context *c = of->set->context;
  mpmi_adaption *a = of->a;
  const int64_t bytes = particle_bytes(of->set);
  mpmi_messages_clear(of->parts);
  mpm_status status = MPMI_RESERVE_MORE(c, a->away, a->away_capacity, a->own + 1);
  for (int64_t slot = 0; slot < a->own && !status; ++slot) {
    a->away[slot] = 0;
    if (!mpmi_adapts_slot(of->set, of->copy, slot)) continue;
    const int32_t home = home_of(of, slot);
    if (home == c->transport.part) continue;
    a->away[slot] = 1;
    char *at = mpmi_buffer_take(c, &of->parts->out[home], (int64_t)sizeof slot + bytes);
    if (!at) return MPM_E_NOMEM;
    memcpy(at, &slot, sizeof slot);
    pack_particle(of, slot, at + sizeof slot);
  }
  return status;
}

static mpm_status take_strays(const mpmi_adapting *of, const mpmi_arrivals *in) {
  mpmi_adaption *a = of->a;
  const int64_t each = (int64_t)sizeof(int64_t) + particle_bytes(of->set);
  int64_t n = 0, first;
  for (int32_t i = 0; i < in->count; ++i) n += in->message[i].bytes / each;
  mpm_status status = MPMI_RESERVE_MORE(of->set->context, a->stray, a->stray_capacity, n);
  if (!status) status = make_room(of, n, &first);
  for (int32_t i = 0; i < in->count && !status; ++i)
    for (int64_t at = 0; at + each <= in->message[i].bytes; at += each) {
      const char *data = (const char *)in->message[i].data + at;
      mpmi_stray *stray = &a->stray[a->strays];
      stray->part = in->message[i].part;
      memcpy(&stray->slot, data, sizeof stray->slot);
      unpack_particle(of, first + a->strays++, data + sizeof stray->slot);
    }
  return status;
}

/* ---- what becomes of them ------------------------------------------------------------------------------ */
enum { IS_SPLIT, IS_MERGED, IS_GONE };
/* Of a particle in a slot of the part that is told. With a pair comes what it becomes, and a copy of the
 * other particle unless that is there, in slot `goes`. */
typedef struct verdict {
  int64_t kind, slot, id, edges, before, other, goes;
  double strain_loss;
} verdict;

static const mpmi_stray *stray_at(const mpmi_adaption *a, int64_t slot) {
  return slot < a->own ? NULL : &a->stray[slot - a->own];
}

static int64_t merged_bytes(const mpm_particles *set) {
  return mpmi_merged_rows(set) * (int64_t)sizeof(double);
}

static char *tell(const mpmi_adapting *of, int32_t part, const verdict *v, int64_t more) {
  char *at = mpmi_buffer_take(of->set->context, &of->parts->out[part], (int64_t)sizeof *v + more);
  if (!at) return NULL;
  memcpy(at, v, sizeof *v);
  return at + sizeof *v;
}

static mpm_status note_gone(const mpmi_adapting *of, int64_t slot) {
  mpmi_adaption *a = of->a;
  const mpm_status status = MPMI_RESERVE_NEXT(of->set->context, a->gone, a->gone_capacity, a->gone_count);
  if (!status) a->gone[a->gone_count++] = slot;
  return status;
}

/* The particle goes, and the one that stays is on another part than this, `with`. */
static mpm_status tell_gone(const mpmi_adapting *of, int64_t slot, int32_t with) {
  const mpmi_stray *stray = stray_at(of->a, slot);
  if (!stray) return note_gone(of, slot);
  const verdict v = {.kind = IS_GONE, .slot = stray->slot};
  return stray->part == with || tell(of, stray->part, &v, 0) ? MPM_OK : MPM_E_NOMEM;
}

/* Tells of the i-th pair, whose staying particle is a stray. */
static mpm_status tell_pair(const mpmi_adapting *of, int64_t i) {
  const mpmi_adaption *a = of->a;
  const mpmi_merging *pair = &a->pair[i];
  const mpmi_stray *stays = stray_at(a, pair->stays), *goes = stray_at(a, pair->goes);
  const int32_t both = goes && goes->part == stays->part;
  const verdict v = {.kind = IS_MERGED,
                     .slot = stays->slot,
                     .id = pair->id,
                     .other = pair->other,
                     .goes = both ? goes->slot : -1,
                     .strain_loss = pair->strain_loss};
  char *at = tell(of, stays->part, &v, merged_bytes(of->set) + (both ? 0 : particle_bytes(of->set)));
  if (!at) return MPM_E_NOMEM;
  memcpy(at, a->merged + i * mpmi_merged_rows(of->set), (size_t)merged_bytes(of->set));
  if (!both) pack_particle(of, pair->goes, at + merged_bytes(of->set));
  return tell_gone(of, pair->goes, stays->part);
}

/* Tells other parts of their particles, which leave the lists. */
static mpm_status send_verdicts(const mpmi_adapting *of) {
  mpmi_adaption *a = of->a;
  int64_t splits = 0, pairs = 0;
  mpm_status status = MPM_OK;
  mpmi_messages_clear(of->parts);
  for (int64_t i = 0; i < a->splits && !status; ++i) {
    const mpmi_splitting *split = &a->split[i];
    const mpmi_stray *stray = stray_at(a, split->slot);
    const verdict v = {.kind = IS_SPLIT,
                       .slot = stray ? stray->slot : 0,
                       .id = split->id,
                       .edges = split->edges,
                       .before = split->before};
    if (!stray)
      a->split[splits++] = *split;
    else if (!tell(of, stray->part, &v, 0))
      status = MPM_E_NOMEM;
  }
  for (int64_t i = 0; i < a->pairs && !status; ++i) {
    if (stray_at(a, a->pair[i].stays)) {
      status = tell_pair(of, i);
    } else {
      if (stray_at(a, a->pair[i].goes)) status = tell_gone(of, a->pair[i].goes, -1);
      mpmi_keep_merging(a, of->set, i, pairs++);
    }
  }
  a->splits = splits;
  a->pairs = pairs;
  return status;
}

static mpm_status take_split(const mpmi_adapting *of, const verdict *v) {
  mpmi_adaption *a = of->a;
  const mpm_status status = MPMI_RESERVE_NEXT(of->set->context, a->split, a->split_capacity, a->splits);
  if (!status) a->split[a->splits++] = (mpmi_splitting){v->id, v->slot, (int32_t)v->edges, v->before};
  return status;
}

/* Takes a pair; the copy of the particle that goes has a slot that *next counts on. */
static mpm_status take_pair_in(const mpmi_adapting *of, const verdict *v, const char *at, int64_t *next) {
  mpmi_adaption *a = of->a;
  const int64_t rows = mpmi_merged_rows(of->set);
  const mpm_status status = MPMI_RESERVE_NEXT(of->set->context, a->pair, a->pair_capacity, a->pairs);
  if (status) return status;
  memcpy(a->merged + a->pairs * rows, at, (size_t)merged_bytes(of->set));
  if (v->goes < 0) unpack_particle(of, *next, at + merged_bytes(of->set));
  a->pair[a->pairs++] = (mpmi_merging){.id = v->id,
                                       .other = v->other,
                                       .stays = v->slot,
                                       .goes = v->goes < 0 ? (*next)++ : v->goes,
                                       .strain_loss = v->strain_loss};
  return MPM_OK;
}

/* What others have said: pairs, and copies that come with them. */
typedef struct said {
  int64_t pairs, copies;
} said;

/* Goes through it: with `takes` for good, copies from slot *next on; else only to count. */
static mpm_status read_verdicts(const mpmi_adapting *of, const mpmi_arrivals *in, int32_t takes,
                                int64_t *next, said *count) {
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < in->count && !status; ++i) {
    const char *at = in->message[i].data, *end = at + in->message[i].bytes;
    while (end - at >= (ptrdiff_t)sizeof(verdict) && !status) {
      verdict v;
      memcpy(&v, at, sizeof v);
      at += sizeof v;
      if (takes && v.kind == IS_SPLIT) status = take_split(of, &v);
      if (takes && v.kind == IS_GONE) status = note_gone(of, v.slot);
      if (takes && v.kind == IS_MERGED) status = take_pair_in(of, &v, at, next);
      if (v.kind != IS_MERGED) continue;
      ++count->pairs;
      count->copies += v.goes < 0;
      at += merged_bytes(of->set) + (v.goes < 0 ? particle_bytes(of->set) : 0);
    }
  }
  return status;
}

/* Makes room for what so many pairs become, beside those that there are. */
static mpm_status make_room_for_pairs(const mpmi_adapting *of, int64_t more) {
  mpmi_adaption *a = of->a;
  mpm_context *c = of->set->context;
  const int64_t rows = mpmi_merged_rows(of->set), wanted = (a->pairs + more) * rows;
  if (wanted <= a->merged_capacity) return MPM_OK;
  double *merged = mpmi_alloc(c, mpmi_bytes(wanted, sizeof *merged));
  if (!merged) return MPM_E_NOMEM;
  if (a->pairs) memcpy(merged, a->merged, (size_t)(a->pairs * rows) * sizeof *merged);
  MPMI_FREE_ARRAY(c, a->merged, a->merged_capacity);
  a->merged = merged;
  a->merged_capacity = wanted;
  return MPM_OK;
}

static mpm_status take_verdicts(const mpmi_adapting *of, const mpmi_arrivals *in) {
  said count = {0, 0};
  int64_t next = 0;
  read_verdicts(of, in, 0, &next, &count);
  mpm_status status = make_room(of, count.copies, &next);
  if (!status) status = make_room_for_pairs(of, count.pairs);
  return status ? status : read_verdicts(of, in, 1, &next, &count);
}

/* ---- in order ------------------------------------------------------------------------------------------ */
/* All parts have this status, or that of the first that has another; then they exchange messages. */
static mpm_status exchange(const mpmi_adapting *of, mpm_status status, mpmi_arrivals *in) {
  status = mpmi_agree(of->set->context, status);
  return status ? status : mpmi_parts_exchange(of->parts, in);
}

/* What is to be done, as the homes of the cells choose. */
static mpm_status choose_together(const mpmi_adapting *of, int64_t particles) {
  mpmi_adaption *a = of->a;
  mpm_context *c = of->set->context;
  int64_t added;
  mpm_status status = mpmi_agree(c, mpmi_adaption_choose(a, of->set, of->copy));
  if (!status && a->desc.most_particles > 0) status = mpmi_adaption_rank(of, &added);
  if (status) return status;
  if (a->desc.most_particles > 0) mpmi_adaption_limit(of, particles);
  status = mpmi_adaption_merge_states(a, of->set, of->copy, of->t);
  if (!status) status = mpmi_adaption_ask(a, of->set, of->copy);
  return mpmi_agree(c, status);
}

static mpm_status plan_in_turn(const mpmi_adapting *of) {
  mpmi_adaption *a = of->a;
  mpm_context *c = of->set->context;
  mpmi_arrivals in;
  mpm_status status = MPM_OK;
  int64_t count[2] = {of->set->count, 0};
  a->skips = a->desc.min_per_cell > 0 || a->desc.max_per_cell > 0;
  if (a->skips && !(status = exchange(of, send_strays(of), &in)))
    status = mpmi_agree(c, take_strays(of, &in));
  if (!status) status = mpmi_reduce_parts(c, MPM_REDUCE_SUM, 1, count);
  if (!status) status = choose_together(of, count[0]);
  if (!status) status = mpmi_adaption_rank(of, &a->added);
  if (status) return status;
  if (a->skips && !(status = exchange(of, send_verdicts(of), &in))) status = take_verdicts(of, &in);
  if (!status) status = mpmi_adaption_reserve(a, of->set, of->copy);
  if ((status = mpmi_agree(c, status))) return status;
  count[0] = a->splits;
  count[1] = a->pairs;
  status = mpmi_reduce_parts(c, MPM_REDUCE_SUM, 2, count);
  a->split_total = count[0];
  a->pair_total = count[1];
  return status;
}

mpm_status mpmi_adaption_plan_together(const mpmi_adapting *of) {
  const mpm_status status = plan_in_turn(of);
  mpmi_particles_watch(of->set, of->set->slots);
  of->set->slots = of->a->own; /* copies stay where they are until it is done */
  return status;
}
