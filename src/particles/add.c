/* Particles are added at the end of a set, from the host's arrays or by a fill. */
#include <math.h>
#include <string.h>

#include "context/radix.h"
#include "particles/add.h"
#include "particles/shared_ids.h"
#include "particles/thermal.h"
#include "particles/values.h"

/* ---- new particles at the end of a set ----------------------------------------------------------------- */
mpm_status mpmi_check_room(const mpm_particles *set, int64_t n) {
  if (n > MPMI_MAX_SLOTS - MPMI_PAD - set->slots)
    return mpmi_fail(set->context, MPM_E_ARG,
                     "%lld more particles are too many: a set has at most %lld slots", (long long)n,
                     (long long)MPMI_MAX_SLOTS);
  return MPM_OK;
}

/* Counts the inert slots at the end of the last group, which new particles may take. */
static int64_t free_tail(const mpm_particles *set) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  int64_t tail = 0;
  while (tail < MPMI_PAD && tail < set->slots && id[set->slots - 1 - tail] < 0) ++tail;
  return tail;
}

/* Makes room for slots, and for some more; `both` keeps what the second copies have. */
static mpm_status grow(mpm_particles *set, int64_t slots, int32_t both) {
  if (slots <= set->ld) return MPM_OK;
  int64_t wanted = slots + slots / 40; /* the padding of sorted blocks takes a per cent or two */
  int64_t geometric = set->ld + set->ld / 2;
  if (wanted < geometric) wanted = geometric;
  if (wanted > MPMI_MAX_SLOTS) wanted = MPMI_MAX_SLOTS;
  return both ? mpmi_particles_reserve_in_step(set, wanted) : mpmi_particles_reserve(set, wanted);
}

/* Particles whose F stays have no stress: they act only by being prescribed, and they are unless the host
 * says otherwise. */
static int32_t is_rigid(const mpm_particles *set) {
  return mpmi_material_kinematics(set->material) == MPMI_F_STAYS;
}

mpm_status mpmi_append_reserve(mpm_particles *set, int64_t n, int32_t with_size, int32_t in_step) {
  mpm_status status = grow(set, (set->slots + n + MPMI_PAD - 1) / MPMI_PAD * MPMI_PAD, in_step);
  if (!status && with_size) status = mpmi_field_make_present(set, MPMI_SIZE);
  if (!status && is_rigid(set)) status = mpmi_field_make_present(set, MPMI_PRESCRIBED);
  return status;
}

static int64_t append_at(mpm_particles *set, int64_t first, int64_t n) {
  const int64_t slots = (first + n + MPMI_PAD - 1) / MPMI_PAD * MPMI_PAD;
  set->slots = slots;
  mpmi_particles_watch(set, slots);
  mpmi_fill_holes(set, 0, first, slots, set->grid->desc.origin);
  return first;
}

int64_t mpmi_append_begin(mpm_particles *set, int64_t n) {
  return append_at(set, set->slots - free_tail(set), n);
}

int64_t mpmi_append_apart(mpm_particles *set, int64_t n) {
  return append_at(set, set->slots, n);
}

void mpmi_append_default(mpm_particles *set, int32_t field, int64_t begin, int64_t end) {
  if (!set->field[field].present) return;
  for (int32_t c = 0; c < set->field[field].components; ++c)
    for (int64_t s = begin; s < end; ++s)
      mpmi_f64(set, field, 0)[c * set->ld + s] = mpmi_absent_value(set, field, c, s);
}

/* Finds the number that is free on all parts, since a host may have unpacked particles on some, and checks
 * the ids where some part is given ids; so many particles of all parts are numbered from there on. */
static mpm_status meet_others(mpm_particles *set, int64_t n, const int64_t *ids, int64_t numbered,
                              int64_t *free_id) {
  int64_t word[2] = {*free_id, INT64_MIN};
  for (int64_t i = 0; i < n && ids; ++i)
    if (-ids[i] > word[1]) word[1] = -ids[i];
  const mpm_status status = mpmi_reduce_parts(set->context, MPM_REDUCE_MAX, 2, word);
  *free_id = word[0];
  if (status || word[1] == INT64_MIN) return status;
  return mpmi_check_shared_ids(set, ids ? n : 0, ids, -word[1], word[0], numbered);
}

/* Adds up how many the parts before this one add, and how many all do. */
static mpm_status count_others(const mpm_particles *set, int64_t n, mpm_status status, int64_t *before,
                               int64_t *total) {
  mpm_context *c = set->context;
  const int32_t parts = c->transport.parts, me = c->transport.part;
  const size_t bytes = mpmi_bytes(parts, sizeof(int64_t));
  int64_t *all = mpmi_alloc(c, bytes);
  if (!all && !status) status = MPM_E_NOMEM;
  status = mpmi_agree(c, status);
  if (!status) status = mpmi_gather_parts(c, n, all);
  *before = *total = 0;
  for (int32_t r = 0; r < parts && !status; ++r) {
    if (r < me) *before += all[r];
    *total += all[r];
  }
  mpmi_free(c, all, bytes);
  return status;
}

mpm_status mpmi_number(mpm_particles *set, int64_t n, const int64_t *ids, mpm_status status,
                       mpmi_numbers *out) {
  int64_t before = 0, total = n;
  out->first = set->next_id;
  if (!mpmi_is_whole(set->context) && ((status = count_others(set, ids ? 0 : n, status, &before, &total)) ||
                                       (status = meet_others(set, n, ids, total, &out->first))))
    return status;
  if (status) return status;
  if (total > INT64_MAX - out->first)
    return mpmi_fail(set->context, MPM_E_ARG, "ids run out: the next is %lld", (long long)out->first);
  out->next = ids ? out->first : out->first + total;
  out->first += before;
  for (int64_t i = 0; i < n && ids; ++i)
    if (ids[i] >= out->next) out->next = ids[i] + 1;
  return mpmi_reduce_parts(set->context, MPM_REDUCE_MAX, 1, &out->next);
}

void mpmi_append_finish(mpm_particles *set, int64_t slot, int64_t n, int32_t with_size, const int64_t *ids,
                        int64_t first_id) {
  int64_t *id = mpmi_i64(set, MPMI_ID, 0) + slot;
  double *mass = mpmi_f64(set, MPMI_MASS, 0) + slot, *volume = mpmi_f64(set, MPMI_VOLUME, 0) + slot;
  const double *initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + slot;
  for (int64_t i = 0; i < n; ++i) {
    id[i] = ids ? ids[i] : first_id + i;
    volume[i] = initial_volume[i];
    mass[i] = set->material->density * volume[i];
    if (mass[i] > set->mass_max) set->mass_max = mass[i];
  }
  for (int64_t s = slot; s < slot + n; ++s) mpmi_wrap_slot(set, MPMI_POSITION, s);
  mpmi_append_default(set, MPMI_REFERENCE, slot, slot + n); /* the size of rings needs it */
  if (!with_size) mpmi_append_default(set, MPMI_SIZE, slot, slot + n);
  mpmi_append_default(set, MPMI_DILATION_RATIO, slot, slot + n);
  mpmi_thermal_start(set, slot, slot + n);
  for (int32_t c = 0; c < set->grid->dim && is_rigid(set); ++c)
    memset((uint8_t *)set->field[MPMI_PRESCRIBED].data[0] + c * set->ld + slot, 1, (size_t)n);
  set->count += n;
  set->dirty |= MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION;
  mpmi_index_drop(set);
}

/* ---- from arrays --------------------------------------------------------------------------------------- */
typedef struct arrays {
  int64_t n;
  const double *position, *velocity, *volume, *size;
  const int64_t *ids;
} arrays;

static mpm_status check_arrays(const mpm_particles *set, const arrays *from) {
  const struct {
    int32_t field;
    const double *value;
  } given[] = {{mpmi_place_field(set->grid), from->position},
               {MPMI_VELOCITY, from->velocity},
               {MPMI_VOLUME, from->volume},
               {MPMI_SIZE, from->size}};
  for (int32_t k = 0; k < 4; ++k)
    for (int64_t i = 0; given[k].value && i < from->n; ++i) {
      mpm_status status =
          mpmi_check_value(set, given[k].field, given[k].value + i, from->n, (mpmi_who){"index", i});
      if (status) return status;
    }
  for (int64_t i = 0; i < from->n; ++i)
    if (!isfinite(set->material->density * from->volume[i]))
      return mpmi_fail(set->context, MPM_E_ARG,
                       "volume of the particle with index %lld is %g: its mass overflows", (long long)i,
                       from->volume[i]);
  return MPM_OK;
}

/* Refuses ids that are given twice, or of new particles those that the set has already. order: the ids,
 * ascending. */
static mpm_status check_known(const mpm_particles *set, int64_t n, const int64_t *ids, int32_t are_new,
                              const uint32_t *order) {
  for (int64_t i = 0; i < n; ++i) {
    int64_t id = ids[order[i]];
    if (i > 0 && id == ids[order[i - 1]])
      return mpmi_fail(set->context, MPM_E_ARG, "id %lld is given twice", (long long)id);
    if (are_new && id < set->next_id && mpmi_index_find(set, id) >= 0)
      return mpmi_fail(set->context, MPM_E_ARG, "id %lld is in use", (long long)id);
  }
  return MPM_OK;
}

mpm_status mpmi_check_unique(mpm_particles *set, int64_t n, const int64_t *ids, int32_t are_new) {
  mpm_context *context = set->context;
  if (n == 0) return MPM_OK;
  size_t key_bytes = mpmi_bytes(n, 2 * sizeof(uint64_t)), order_bytes = mpmi_bytes(n, 2 * sizeof(uint32_t));
  uint64_t *key = mpmi_alloc(context, key_bytes);
  uint32_t *order = key ? mpmi_alloc(context, order_bytes) : NULL;
  mpm_status status = MPM_E_NOMEM;
  if (order) {
    for (int64_t i = 0; i < n; ++i) key[i] = (uint64_t)ids[i];
    mpmi_radix_sort(n, key, order, key + n, order + n);
    /* An id beyond all that were ever used cannot be in the set. */
    status = ids[order[0]] < set->next_id ? mpmi_index_build(set) : MPM_OK;
    if (!status) status = check_known(set, n, ids, are_new, order);
  }
  mpmi_free(context, order, order_bytes);
  mpmi_free(context, key, key_bytes);
  return status;
}

static mpm_status check_ids(mpm_particles *set, int64_t n, const int64_t *ids) {
  for (int64_t i = 0; i < n; ++i)
    if (ids[i] < 0 || ids[i] == INT64_MAX)
      return mpmi_fail(set->context, MPM_E_ARG, "ids[%lld] is %lld, must be >= 0 and below 2^63 - 1",
                       (long long)i, (long long)ids[i]);
  return mpmi_check_unique(set, n, ids, 1);
}

static void copy_rows(mpm_particles *set, int32_t field, int64_t slot, const double *from, int64_t n) {
  for (int32_t c = 0; c < set->field[field].components; ++c)
    memcpy(mpmi_f64(set, field, 0) + c * set->ld + slot, from + c * n, (size_t)n * sizeof *from);
}

static void copy_arrays(mpm_particles *set, int64_t slot, const arrays *from) {
  copy_rows(set, MPMI_POSITION, slot, from->position, from->n);
  copy_rows(set, MPMI_INITIAL_VOLUME, slot, from->volume, from->n);
  if (from->velocity) copy_rows(set, MPMI_VELOCITY, slot, from->velocity, from->n);
  if (from->size) copy_rows(set, MPMI_SIZE, slot, from->size, from->n);
}

/* Does all that may fail. */
static mpm_status prepare_arrays(mpm_particles *set, const arrays *from) {
  mpm_status status;
  if ((status = mpmi_check_room(set, from->n)) || (status = check_arrays(set, from)) ||
      (from->ids && (status = check_ids(set, from->n, from->ids))))
    return status;
  return mpmi_append_reserve(set, from->n, from->size != NULL, 0);
}

mpm_status mpm_particles_add(mpm_particles *particles, int64_t n, const double *position,
                             const double *velocity, const double *volume, const double *size,
                             const int64_t *ids, int64_t *first_id) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status && n < 0)
    status = mpmi_fail(particles->context, MPM_E_ARG, "n is %lld, must be >= 0", (long long)n);
  if (!status && n > 0 && (!position || !volume))
    status = mpmi_fail(particles->context, MPM_E_ARG, "%s is NULL", position ? "volume" : "position");
  mpmi_numbers numbers;
  const arrays from = {n, position, velocity, volume, size, ids};
  if (!status && n > 0) status = prepare_arrays(particles, &from);
  if ((status = mpmi_number(particles, n, ids, status, &numbers))) return status;
  if (n > 0) {
    const int64_t slot = mpmi_append_begin(particles, n);
    copy_arrays(particles, slot, &from);
    mpmi_append_finish(particles, slot, n, size != NULL, ids, numbers.first);
  }
  particles->next_id = numbers.next; /* other parts may have added some */
  if (first_id) *first_id = ids && n > 0 ? ids[0] : numbers.first;
  return MPM_OK;
}
