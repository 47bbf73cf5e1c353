/* Loading reads everything into new storage and checks it before anything of the stepper changes. What a part
 * has of a state may be several pieces, which are read twice: their heads, which say what there is, and then
 * all of them. */
#include "io/state.h"

#include <math.h>
#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */
void mpmi_state_start_set(mpm_particles *fresh, const mpm_particles *set) {
  *fresh = *set;
  fresh->count = fresh->slots = fresh->ld = fresh->next_id = 0;
  fresh->dirty = 0;
  fresh->mass_max = 0.0;
  fresh->index = NULL;
  fresh->index_capacity = 0;
  for (int32_t f = 0; f < fresh->field_count; ++f) {
    fresh->field[f].data[0] = fresh->field[f].data[1] = NULL;
    fresh->field[f].present = 0;
  }
}

mpm_status mpmi_state_load_begin(mpmi_state_loading *l) {
  const mpm_stepper *s = l->stepper;
  mpm_context *c = s->context;
  const int64_t sets = s->layout.member_count;
  l->here.set = mpmi_alloc_zeroed(c, mpmi_bytes(sets, sizeof *l->here.set));
  if (l->here.set) l->all.set = mpmi_alloc_zeroed(c, mpmi_bytes(sets, sizeof *l->all.set));
  if (l->all.set)
    l->obstacle = mpmi_alloc_zeroed(c, mpmi_bytes(s->settings.obstacles.count, sizeof *l->obstacle));
  if (l->obstacle)
    l->surface = mpmi_alloc_zeroed(c, mpmi_bytes(s->settings.surfaces.count, sizeof *l->surface));
  if (l->surface) l->slots = mpmi_alloc_zeroed(c, mpmi_bytes(sets, sizeof *l->slots));
  if (l->slots) l->fresh = mpmi_alloc_zeroed(c, mpmi_bytes(sets, sizeof *l->fresh));
  if (!l->fresh) return MPM_E_NOMEM;
  for (int32_t m = 0; m < sets; ++m) mpmi_state_start_set(&l->fresh[m], s->layout.member[m].set);
  return MPM_OK;
}

/* Forgets what a head has given. */
static void drop_common(mpmi_state_loading *l) {
  mpm_context *c = l->stepper->context;
  mpmi_contact_rules_free(&l->rules, c);
  MPMI_FREE_ARRAY(c, l->pairs.record, l->pairs.capacity);
  l->pairs = (mpmi_pair_records){0};
  for (int64_t i = 0; i < l->stepper->settings.surfaces.count && l->surface; ++i) {
    mpmi_markers_free(c, &l->surface[i].markers);
    l->surface[i] = (mpmi_state_surface){0};
  }
}

void mpmi_state_drop_storage(mpm_particles *fresh) {
  for (int32_t f = 0; f < fresh->field_count; ++f) {
    if (!fresh->field[f].present) continue;
    mpmi_field_make_absent(fresh, f);
    fresh->field[f].present = 1;
  }
  fresh->ld = fresh->slots = fresh->count = 0;
}

void mpmi_state_load_end(mpmi_state_loading *l) {
  const mpm_stepper *s = l->stepper;
  mpm_context *c = s->context;
  const int32_t sets = s->layout.member_count;
  drop_common(l);
  for (int32_t m = 0; m < sets && l->fresh; ++m) mpmi_state_drop_storage(&l->fresh[m]);
  mpmi_state_blocks_free(c, sets, &l->blocks);
  mpmi_parts_destroy(l->parts);
  MPMI_FREE_ARRAY(c, l->fresh, sets);
  MPMI_FREE_ARRAY(c, l->slots, sets);
  MPMI_FREE_ARRAY(c, l->surface, s->settings.surfaces.count);
  MPMI_FREE_ARRAY(c, l->obstacle, s->settings.obstacles.count);
  MPMI_FREE_ARRAY(c, l->all.set, sets);
  MPMI_FREE_ARRAY(c, l->here.set, sets);
}

/* ---- heads --------------------------------------------------------------------------------------------- */
static int32_t is_magnitude(double x) {
  return isfinite(x) && x >= 0.0;
}

/* Counts go on from here, and must start far from where they would overflow. */
static int32_t is_count(int64_t n) {
  return n >= 0 && n <= INT64_MAX / 2;
}

/* A step counts from what faces prescribed in the one before. */
static int32_t heat_makes_sense(const mpmi_heat_history *heat) {
  int32_t sense = is_count(heat->iterations);
  for (int32_t face = 0; face < 6; ++face)
    sense &= isfinite(heat->prescribed[face]) && (heat->acted[face] == 0.0 || heat->acted[face] == 1.0);
  return sense;
}

static void read_numbers(mpmi_archive *a, uint32_t format, int32_t sets, mpmi_state_head *head) {
  mpmi_state_numbers *n = &head->numbers;
  mpmi_state_archive_numbers(a, format, n);
  if (a->status) return;
  if (!isfinite(n->t) || !is_count(n->step) || !is_count(n->resorts) || !is_count(n->removed) ||
      n->blocks < -1 || !is_magnitude(n->previous_dt) || !is_magnitude(n->controller_dt) ||
      !is_magnitude(n->mass_cut) || !heat_makes_sense(&n->heat))
    mpmi_archive_damaged(a, "its numbers make no sense");
  const int64_t unsorted = MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_IDS,
                flags = MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION | (n->blocks < 0 ? unsorted : 0);
  for (int32_t m = 0; m < sets && !a->status; ++m) {
    mpmi_state_set_numbers *of = &head->set[m].numbers;
    mpmi_state_archive_set_numbers(a, format, of);
    if (a->status) return;
    if (of->slots < 0 || of->slots > MPMI_MAX_SLOTS || of->slots % MPMI_PAD || of->count < 0 ||
        of->count > of->slots || of->next_id < 0 || of->body < 0 || of->body >= MPMI_MAX_BODIES ||
        of->dirty & ~flags || of->has_motion & ~1 || !is_magnitude(of->mass_max) ||
        !is_count(of->adaption.splits) || !is_count(of->adaption.added) || !is_count(of->adaption.merges))
      mpmi_archive_damaged(a, "the numbers of a set make no sense");
  }
}

static mpm_status refuse_old(const mpm_stepper *s, const char *what, int64_t here) {
  return mpmi_fail(s->context, MPM_E_FORMAT,
                   "the state is of an unlike setup: number of %s is 0 there, %lld here", what,
                   (long long)here);
}

/* Reads what stands before the blocks. */
static mpm_status read_head(mpmi_state_loading *l, const mpmi_state_piece *piece, mpmi_archive *a,
                            mpmi_state_head *head) {
  const mpm_stepper *s = l->stepper;
  drop_common(l);
  memset(&head->numbers, 0, sizeof head->numbers);
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    memset(&head->set[m].numbers, 0, sizeof head->set[m].numbers);
  mpmi_archive_begin(a, s->context, MPMI_FROM_MEMORY);
  a->from = piece->body;
  a->size = piece->bytes;
  mpmi_state_setup(a, s, piece->format, head->set);
  if (!a->status) read_numbers(a, piece->format, s->layout.member_count, head);
  mpm_status status = a->status;
  if (piece->format > 2) {
    if (!status) status = mpmi_state_read_obstacles(a, s, l->obstacle);
    if (!status) status = mpmi_state_read_contact(a, s, &l->rules, &l->pairs);
    if (!status) status = mpmi_state_read_surfaces(a, s, l->surface);
  } else if (!status && s->settings.surfaces.count) {
    status = refuse_old(s, "surfaces", s->settings.surfaces.count);
  } else if (!status && s->settings.obstacles.count) {
    status = refuse_old(s, "obstacles", s->settings.obstacles.count);
  }
  return status;
}

static int64_t bytes_per_slot(const mpm_particles *set, const mpmi_state_set *of) {
  int64_t bytes = 0;
  for (int32_t f = 0; f < set->field_count; ++f)
    if (mpmi_state_has_field(of, f))
      bytes += set->field[f].components * (int64_t)mpmi_type_size(set->field[f].type);
  return bytes;
}

/* Puts the numbers of a set in a piece to those of the others. */
static void join_set(mpm_particles *fresh, const mpmi_state_set *of) {
  const mpmi_state_set_numbers *n = &of->numbers;
  for (int32_t f = 0; f < fresh->field_count; ++f) fresh->field[f].present |= mpmi_state_has_field(of, f);
  if (n->next_id > fresh->next_id) fresh->next_id = n->next_id;
  fresh->mass_max = fmax(fresh->mass_max, n->mass_max);
  fresh->dirty |= (uint32_t)n->dirty;
}

/* Looks whether what follows the head may be there, and adds it up. */
static mpm_status measure_piece(mpmi_state_loading *l, mpmi_archive *a) {
  const mpm_stepper *s = l->stepper;
  int64_t slots = 0, left = a->size - a->at;
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    const mpmi_state_set *of = &l->here.set[m];
    const int64_t each = bytes_per_slot(&l->fresh[m], of);
    if (of->numbers.slots > left / each) return mpmi_archive_damaged(a, "it ends too early");
    left -= of->numbers.slots * each;
    slots += of->numbers.slots;
    l->fresh[m].count += of->numbers.count;
    l->slots[m] += of->numbers.slots;
    join_set(&l->fresh[m], of);
  }
  /* each block takes at least one group of slots */
  if (l->here.numbers.blocks > slots / MPMI_PAD)
    return mpmi_archive_damaged(a, "it has blocks without slots");
  l->lacks_sums |= !l->here.numbers.energies_valid;
  if (l->here.numbers.blocks < 0)
    l->is_unsorted = 1;
  else
    l->block_count += l->here.numbers.blocks;
  return MPM_OK;
}

/* The text says which of several pieces a part means. */
static mpm_status of_piece(const mpmi_state_loading *l, int32_t i, mpm_status status) {
  mpm_context *c = l->stepper->context;
  return status && l->tells ? mpmi_fail(c, status, "piece[%d]: %s", (int)i, mpm_last_error(c)) : status;
}

mpm_status mpmi_state_measure(mpmi_state_loading *l) {
  for (int32_t i = 0; i < l->count; ++i) {
    mpmi_archive a;
    mpm_status status = read_head(l, &l->piece[i], &a, &l->here);
    if (!status && l->piece[i].end.number == 0) l->head_bytes = a.at;
    if (!status) status = measure_piece(l, &a);
    if (status) return of_piece(l, i, status);
  }
  return MPM_OK;
}

mpm_status mpmi_state_read_all(mpmi_state_loading *l, const mpmi_state_piece *first) {
  mpmi_archive a;
  const mpm_status status = read_head(l, first, &a, &l->all);
  if (status) return status;
  l->format = first->format;
  for (int32_t m = 0; m < l->stepper->layout.member_count; ++m) join_set(&l->fresh[m], &l->all.set[m]);
  return MPM_OK;
}

/* ---- what follows them --------------------------------------------------------------------------------- */
void mpmi_state_read_rows(mpmi_archive *a, const mpmi_state_set *of, mpm_particles *fresh, int64_t first,
                          int64_t slots) {
  for (int32_t i = 0; i < of->field_count && slots > 0; ++i) {
    const mpmi_field *field = &fresh->field[of->field[i]];
    const int64_t size = (int64_t)mpmi_type_size(field->type);
    for (int32_t c = 0; c < field->components && mpmi_state_has_field(of, of->field[i]); ++c)
      mpmi_state_archive_row(a, field->type, (char *)field->data[0] + (c * fresh->ld + first) * size,
                             slots * size);
  }
}

/* Reads what a piece has of a set, behind what there is. */
static void read_set(mpmi_state_loading *l, int32_t m, mpmi_archive *a) {
  const mpmi_state_set *from = &l->here.set[m];
  mpm_particles *fresh = &l->fresh[m];
  const int64_t first = fresh->slots, slots = from->numbers.slots;
  mpmi_state_read_rows(a, from, fresh, first, slots);
  if (a->status) return;
  for (int32_t f = 0; f < fresh->field_count && slots > 0; ++f)
    if (fresh->field[f].present && !mpmi_state_has_field(from, f))
      mpmi_field_write_absent(fresh, f, first, first + slots);
  fresh->slots += slots;
}

static mpm_status read_piece(mpmi_state_loading *l, const mpmi_state_piece *piece, int64_t *blocks) {
  const mpm_stepper *s = l->stepper;
  mpmi_archive a;
  mpm_status status = read_head(l, piece, &a, &l->here);
  for (int32_t m = 0; m < s->layout.member_count; ++m) l->slots[m] = l->fresh[m].slots;
  if (!status && l->here.numbers.blocks >= 0) {
    status = mpmi_state_read_blocks(&a, s, piece->format, &l->here, l->is_unsorted ? NULL : &l->blocks,
                                    *blocks, l->slots);
    *blocks += l->here.numbers.blocks;
  }
  if (status) return status;
  for (int32_t m = 0; m < s->layout.member_count && !a.status; ++m) read_set(l, m, &a);
  if (!a.status && a.at != a.size) mpmi_archive_damaged(&a, "it is longer than its contents");
  return a.status;
}

static mpm_status check_sets(mpmi_state_loading *l) {
  mpmi_archive a;
  mpmi_archive_begin(&a, l->stepper->context, MPMI_FROM_MEMORY);
  for (int32_t m = 0; m < l->stepper->layout.member_count && !a.status; ++m) {
    snprintf(a.where, sizeof a.where, "set %d: ", (int)m);
    mpmi_state_check_set(&a, &l->fresh[m], l->is_unsorted ? NULL : &l->blocks,
                         l->is_unsorted ? NULL : mpmi_state_starts(&l->blocks, m));
  }
  return a.status;
}

mpm_status mpmi_state_read_pieces(mpmi_state_loading *l) {
  const int32_t sets = l->stepper->layout.member_count;
  mpm_status status = MPM_OK;
  int64_t blocks = 0;
  for (int32_t m = 0; m < sets && !status; ++m) status = mpmi_particles_reserve(&l->fresh[m], l->slots[m]);
  if (!status && !l->is_unsorted)
    status = mpmi_state_blocks_make(l->stepper->context, sets, l->block_count, &l->blocks);
  for (int32_t i = 0; i < l->count && !status; ++i)
    status = of_piece(l, i, read_piece(l, &l->piece[i], &blocks));
  if (status) return status;
  for (int32_t m = 0; m < sets; ++m)
    if (l->is_unsorted) l->fresh[m].dirty |= MPMI_DIRTY_PLACE;
  return check_sets(l);
}

/* ---- taking over --------------------------------------------------------------------------------------- */
/* Exchanges the storage, so that the old one is freed where the new one came from. */
static void exchange_storage(mpm_particles *set, mpm_particles *fresh) {
  for (int32_t f = 0; f < set->field_count; ++f) {
    const mpmi_field field = set->field[f];
    set->field[f] = fresh->field[f];
    fresh->field[f] = field;
  }
  const int64_t ld = set->ld;
  set->ld = fresh->ld;
  fresh->ld = ld;
  set->count = fresh->count;
  set->slots = fresh->slots;
  set->next_id = fresh->next_id;
  set->dirty = fresh->dirty;
  set->mass_max = fresh->mass_max;
  mpmi_particles_watch(set, set->slots);
  set->suspect = 0;
  mpmi_index_drop(set);
}

mpm_status mpmi_state_check_bodies(mpmi_state_loading *l) {
  mpm_stepper *s = l->stepper;
  const mpmi_contact_rules rules = s->settings.contact;
  mpm_status status = MPM_OK;
  for (int32_t swap = 0; swap < 2; ++swap) { /* there and back */
    if (l->format > 2) s->settings.contact = swap ? rules : l->rules;
    for (int32_t m = 0; m < s->layout.member_count; ++m) {
      const int32_t body = s->layout.member[m].body;
      s->layout.member[m].body = (int32_t)l->all.set[m].numbers.body;
      l->all.set[m].numbers.body = body;
    }
    if (!swap) status = mpmi_check_bodies(s, &s->settings.desc, -1);
  }
  return status;
}

static void take_sets(mpmi_state_loading *l) {
  mpm_stepper *s = l->stepper;
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    const mpmi_state_set_numbers *n = &l->all.set[m].numbers;
    exchange_storage(s->layout.member[m].set, &l->fresh[m]);
    s->layout.member[m].body = (int32_t)n->body;
    s->adaption[m].sums = n->adaption;
    s->settings.motion[m].is_awaited = n->has_motion && !s->settings.motion[m].fn;
    mpmi_reaction *reaction = &s->history.reaction[m];
    memcpy(reaction->impulse, n->reaction, sizeof reaction->impulse);
    memcpy(reaction->impulse_total, n->impulse_total, sizeof reaction->impulse_total);
  }
}

uint32_t mpmi_state_wide_for(const mpmi_state_loading *l) {
  const mpm_stepper *s = l->stepper;
  uint32_t wide_for = s->layout.wide_for;
  for (int32_t m = 1; m < s->layout.member_count; ++m)
    if (l->all.set[m].numbers.body != l->all.set[0].numbers.body) wide_for |= MPMI_WIDE_FOR_TOUCHES;
  return wide_for;
}

/* The layout, and how it is shared out. */
static void take_layout(mpmi_state_loading *l) {
  mpm_stepper *s = l->stepper;
  if (l->is_unsorted)
    mpmi_blocks_clear(&s->layout.blocks);
  else
    mpmi_layout_adopt(&s->layout, &s->settings);
  s->layout.wide_for = mpmi_state_wide_for(l);
  if (!s->layout.parts) return;
  if (l->parts) mpmi_parts_replace(&s->layout.parts, &l->parts);
  mpmi_layout_set_margins(s->layout.parts, s->layout.wide_for);
  s->layout.parts->is_stale = l->is_unsorted;
}

void mpmi_state_take_over(mpmi_state_loading *l) {
  mpm_stepper *s = l->stepper;
  const mpmi_state_numbers *n = &l->all.numbers;
  take_layout(l);
  take_sets(l);
  s->nodes.shown = -1;
  s->history.t = n->t;
  s->history.previous_dt = n->previous_dt;
  s->history.controller_dt = n->controller_dt;
  s->layout.mass_cut = n->mass_cut;
  s->history.reaction_dt = n->reaction_dt;
  s->history.step = n->step;
  s->layout.sorts = n->resorts;
  s->history.removed = n->removed;
  /* of format 2 the energy of the affine part is not known */
  s->history.has_sums =
      n->energies_valid && !l->lacks_sums && (l->format > 2 || !mpmi_is_affine(&s->settings));
  s->history.sums = n->sums;
  s->history.has_reactions = n->has_reactions != 0;
  memcpy(s->history.impulse_by_face, n->impulse_by_face, sizeof n->impulse_by_face);
  s->history.last = n->last;
  s->history.totals = n->totals;
  s->history.heat = n->heat;
  const mpmi_contact_rules rules = s->settings.contact;
  const mpmi_pair_records pairs = s->history.pairs;
  if (l->format > 2) {
    s->settings.contact = l->rules;
    l->rules = rules;
    mpmi_state_take_obstacles(s, l->obstacle);
    mpmi_state_take_surfaces(s, l->surface);
  }
  s->history.pairs = l->pairs;
  l->pairs = pairs;
}
