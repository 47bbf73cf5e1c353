/* Loading reads everything into new storage and checks it before anything of the stepper changes. */
#include "io/state.h"

#include <math.h>
#include <string.h>

/* A state that is being loaded. */
typedef struct loading {
  mpmi_archive archive;
  uint32_t format;
  mpm_stepper *stepper;
  mpmi_state_numbers numbers;
  mpmi_state_set *set; /* [sets] */
  mpmi_contact_rules rules;
  mpmi_pair_records pairs;
  mpmi_state_obstacle *obstacle; /* [obstacles] */
  mpmi_state_surface *surface;   /* [surfaces] */
  int64_t slots;                 /* slots of all sets */
} loading;

mpm_status mpmi_state_check_header(mpm_context *context, const mpmi_state_header *header, int64_t bytes) {
  if (bytes < (int64_t)sizeof *header)
    return mpmi_fail(context, MPM_E_FORMAT, "%lld bytes are too few for a state", (long long)bytes);
  if (memcmp(header->magic, MPMI_STATE_MAGIC, sizeof header->magic) != 0)
    return mpmi_fail(context, MPM_E_FORMAT, "this is not a state of libmpm");
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

void mpmi_state_start_set(mpmi_state_set *to, const mpm_particles *set) {
  mpm_particles *fresh = &to->fresh;
  *fresh = *set;
  fresh->count = fresh->slots = fresh->ld = 0;
  fresh->index = NULL;
  fresh->index_capacity = 0;
  for (int32_t f = 0; f < fresh->field_count; ++f) fresh->field[f].data[0] = fresh->field[f].data[1] = NULL;
}

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

static void read_numbers(loading *l) {
  mpmi_archive *a = &l->archive;
  mpmi_state_numbers *n = &l->numbers;
  mpmi_state_archive_numbers(a, l->format, n);
  if (a->status) return;
  if (!isfinite(n->t) || !is_count(n->step) || !is_count(n->resorts) || !is_count(n->removed) ||
      n->blocks < -1 || !is_magnitude(n->previous_dt) || !is_magnitude(n->controller_dt) ||
      !is_magnitude(n->mass_cut) || !heat_makes_sense(&n->heat))
    mpmi_archive_damaged(a, "its numbers make no sense");
  const int64_t unsorted = MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE,
                flags = MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION | (n->blocks < 0 ? unsorted : 0);
  for (int32_t m = 0; m < l->stepper->layout.member_count && !a->status; ++m) {
    mpmi_state_set_numbers *of = &l->set[m].numbers;
    mpmi_state_archive_set_numbers(a, l->format, of);
    if (a->status) return;
    if (of->slots < 0 || of->slots > MPMI_MAX_SLOTS || of->slots % MPMI_PAD || of->count < 0 ||
        of->count > of->slots || of->next_id < 0 || of->body < 0 || of->body >= MPMI_MAX_BODIES ||
        of->dirty & ~flags || !is_magnitude(of->mass_max) || !is_count(of->adaption.splits) ||
        !is_count(of->adaption.added) || !is_count(of->adaption.merges))
      mpmi_archive_damaged(a, "the numbers of a set make no sense");
    else
      l->slots += of->slots;
  }
}

static mpm_status read_blocks(loading *l) {
  /* Each block takes at least one group of slots. */
  if (l->numbers.blocks > l->slots / MPMI_PAD)
    mpmi_archive_damaged(&l->archive, "it has blocks without slots");
  if (l->archive.status) return l->archive.status;
  return mpmi_state_read_blocks(&l->archive, l->stepper, l->format, l->numbers.blocks, l->set);
}

int64_t mpmi_state_bytes_per_slot(const mpm_particles *set) {
  int64_t bytes = 0;
  for (int32_t f = 0; f < set->field_count; ++f)
    if (set->field[f].present)
      bytes += set->field[f].components * (int64_t)mpmi_type_size(set->field[f].type);
  return bytes;
}

static mpm_status read_set(loading *l, int32_t m) {
  mpmi_archive *a = &l->archive;
  mpmi_state_set *from = &l->set[m];
  mpm_particles *fresh = &from->fresh;
  const int64_t slots = from->numbers.slots;
  if (slots > (a->size - a->at) / mpmi_state_bytes_per_slot(fresh))
    mpmi_archive_damaged(a, "it ends too early");
  mpm_status status = a->status ? a->status : mpmi_particles_reserve(fresh, slots);
  if (status) return status;
  for (int32_t i = 0; i < from->field_count && slots > 0; ++i) {
    const mpmi_field *field = &fresh->field[from->field[i]];
    const int64_t size = (int64_t)mpmi_type_size(field->type);
    for (int32_t c = 0; c < field->components && field->present; ++c)
      mpmi_state_archive_row(a, field->type, (char *)field->data[0] + c * fresh->ld * size, slots * size);
  }
  fresh->slots = slots;
  fresh->count = from->numbers.count;
  fresh->next_id = from->numbers.next_id;
  fresh->mass_max = from->numbers.mass_max;
  fresh->dirty = (uint32_t)from->numbers.dirty | (l->numbers.blocks < 0 ? (uint32_t)MPMI_DIRTY_PLACE : 0);
  if (a->status) return a->status;
  const int32_t sorted = l->numbers.blocks >= 0;
  snprintf(a->where, sizeof a->where, "set %d: ", (int)m);
  mpmi_state_check_set(a, fresh, sorted ? &l->stepper->layout.next_blocks : NULL,
                       sorted ? l->stepper->layout.member[m].next.start : NULL);
  a->where[0] = '\0';
  return a->status;
}

static mpm_status read_state(loading *l) {
  mpmi_archive *a = &l->archive;
  mpm_stepper *s = l->stepper;
  mpmi_state_setup(a, s, l->format, l->set);
  read_numbers(l);
  mpm_status status = a->status;
  if (!status && l->format > 2) status = mpmi_state_read_obstacles(a, s, l->obstacle);
  if (!status && l->format > 2) status = mpmi_state_read_contact(a, s, &l->rules, &l->pairs);
  if (!status && l->format > 2) status = mpmi_state_read_surfaces(a, s, l->surface);
  if (!status && l->format <= 2 && s->settings.surfaces.count)
    status = mpmi_fail(s->context, MPM_E_FORMAT,
                       "the state is of an unlike setup: number of surfaces is 0 there, %lld here",
                       (long long)s->settings.surfaces.count);
  if (!status && l->format <= 2 && s->settings.obstacles.count)
    status = mpmi_fail(s->context, MPM_E_FORMAT,
                       "the state is of an unlike setup: number of obstacles is 0 there, %lld here",
                       (long long)s->settings.obstacles.count);
  if (!status && l->numbers.blocks >= 0) status = read_blocks(l);
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m) status = read_set(l, m);
  if (!status && a->at != a->size) {
    mpmi_archive_damaged(a, "it is longer than its contents");
    status = a->status;
  }
  return status;
}

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

/* Refuses bodies of the state that this stepper does not offer, with its rules. */
static mpm_status check_bodies(loading *l) {
  mpm_stepper *s = l->stepper;
  const mpmi_contact_rules rules = s->settings.contact;
  mpm_status status = MPM_OK;
  for (int32_t swap = 0; swap < 2; ++swap) { /* there and back */
    if (l->format > 2) s->settings.contact = swap ? rules : l->rules;
    for (int32_t m = 0; m < s->layout.member_count; ++m) {
      const int32_t body = s->layout.member[m].body;
      s->layout.member[m].body = (int32_t)l->set[m].numbers.body;
      l->set[m].numbers.body = body;
    }
    if (!swap) status = mpmi_check_bodies(s, &s->settings.desc, -1);
  }
  return status;
}

/* Takes the loaded state over, which cannot fail. */
static void take_over(loading *l) {
  mpm_stepper *s = l->stepper;
  const mpmi_state_numbers *n = &l->numbers;
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    exchange_storage(s->layout.member[m].set, &l->set[m].fresh);
    mpmi_member *member = &s->layout.member[m];
    member->body = (int32_t)l->set[m].numbers.body;
    s->adaption[m].sums = l->set[m].numbers.adaption;
    mpmi_reaction *reaction = &s->history.reaction[m];
    memcpy(reaction->impulse, l->set[m].numbers.reaction, sizeof reaction->impulse);
    memcpy(reaction->impulse_total, l->set[m].numbers.impulse_total, sizeof reaction->impulse_total);
  }
  if (n->blocks < 0) mpmi_blocks_clear(&s->layout.blocks);
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
  s->history.has_sums = n->energies_valid && (l->format > 2 || !mpmi_is_affine(&s->settings));
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

mpm_status mpmi_state_load(mpm_stepper *s, const void *buffer, int64_t bytes) {
  mpmi_state_header header;
  memset(&header, 0, sizeof header);
  memcpy(&header, buffer, bytes < (int64_t)sizeof header ? (size_t)bytes : sizeof header);
  header = mpmi_state_turn_header(header);
  mpm_status status = check_idle(s);
  if (!status) status = mpmi_state_is_whole(s);
  if (!status) status = mpmi_state_check_header(s->context, &header, bytes);
  if (status) return status;
  const unsigned char *body = (const unsigned char *)buffer + sizeof header;
  if ((status = mpmi_state_check_sum(s->context, "the state", &header, body))) return status;
  loading l = {.stepper = s, .format = header.format};
  const size_t set_bytes = mpmi_bytes(s->layout.member_count, sizeof *l.set);
  l.set = mpmi_alloc_zeroed(s->context, set_bytes);
  if (!l.set) return MPM_E_NOMEM;
  const int64_t obstacles = s->settings.obstacles.count;
  const int64_t surfaces = s->settings.surfaces.count;
  l.obstacle = mpmi_alloc_zeroed(s->context, mpmi_bytes(obstacles, sizeof *l.obstacle));
  if (l.obstacle) l.surface = mpmi_alloc_zeroed(s->context, mpmi_bytes(surfaces, sizeof *l.surface));
  if (!l.surface) {
    MPMI_FREE_ARRAY(s->context, l.obstacle, obstacles);
    mpmi_free(s->context, l.set, set_bytes);
    return MPM_E_NOMEM;
  }
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    mpmi_state_start_set(&l.set[m], s->layout.member[m].set);
  mpmi_archive_begin(&l.archive, s->context, MPMI_FROM_MEMORY);
  l.archive.from = body;
  l.archive.size = bytes - (int64_t)sizeof header;
  status = read_state(&l);
  if (!status) status = check_bodies(&l);
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m)
    if (s->adaption[m].on) status = mpmi_field_make_present(&l.set[m].fresh, MPMI_SIZE);
  if (!status && l.numbers.blocks >= 0) status = mpmi_layout_adopt(&s->layout, &s->settings);
  if (!status) take_over(&l);
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    for (int32_t f = 0; f < l.set[m].fresh.field_count; ++f) mpmi_field_make_absent(&l.set[m].fresh, f);
  mpmi_contact_rules_free(&l.rules, s->context);
  for (int64_t i = 0; i < surfaces; ++i) mpmi_markers_free(s->context, &l.surface[i].markers);
  MPMI_FREE_ARRAY(s->context, l.surface, surfaces);
  MPMI_FREE_ARRAY(s->context, l.obstacle, obstacles);
  MPMI_FREE_ARRAY(s->context, l.pairs.record, l.pairs.capacity);
  mpmi_free(s->context, l.set, set_bytes);
  return status;
}

mpm_status mpm_state_load(mpm_stepper *stepper, const void *buffer, int64_t bytes) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  if (!buffer) return mpmi_fail(stepper->context, MPM_E_ARG, "buffer is NULL");
  if (bytes < 0)
    return mpmi_fail(stepper->context, MPM_E_ARG, "bytes is %lld, must be >= 0", (long long)bytes);
  return mpmi_state_load(stepper, buffer, bytes);
}
