/* New particles go to the end of a set. */
#include <string.h>

#include "particles/append.h"

mpm_status mpmi_check_room(const mpm_particles *set, int64_t n, int32_t numbered) {
  if (n > MPMI_MAX_SLOTS - MPMI_PAD - set->slots)
    return mpmi_fail(set->context, MPM_E_ARG,
                     "%lld more particles are too many: a set has at most %lld slots", (long long)n,
                     (long long)MPMI_MAX_SLOTS);
  if (numbered && n > INT64_MAX - set->next_id)
    return mpmi_fail(set->context, MPM_E_ARG, "ids run out: the next is %lld", (long long)set->next_id);
  return MPM_OK;
}

/* Counts the inert slots at the end of the last group, which new particles may take. */
static int64_t free_tail(const mpm_particles *set) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  int64_t tail = 0;
  while (tail < MPMI_PAD && tail < set->slots && id[set->slots - 1 - tail] < 0) ++tail;
  return tail;
}

static mpm_status grow(mpm_particles *set, int64_t slots) {
  if (slots <= set->ld) return MPM_OK;
  int64_t wanted = slots + slots / 40; /* the padding of sorted blocks takes a per cent or two */
  int64_t geometric = set->ld + set->ld / 2;
  if (wanted < geometric) wanted = geometric;
  return mpmi_particles_reserve(set, wanted > MPMI_MAX_SLOTS ? MPMI_MAX_SLOTS : wanted);
}

/* Particles whose F stays have no stress: they act only by being prescribed, and they are unless the host
 * says otherwise. */
static int32_t is_rigid(const mpm_particles *set) {
  return mpmi_material_kinematics(set->material) == MPMI_F_STAYS;
}

mpm_status mpmi_append_begin(mpm_particles *set, int64_t n, int32_t with_size, int64_t *slot) {
  int64_t first = set->slots - free_tail(set);
  int64_t slots = (first + n + MPMI_PAD - 1) / MPMI_PAD * MPMI_PAD;
  mpm_status status = grow(set, slots);
  if (!status && with_size) status = mpmi_field_make_present(set, MPMI_SIZE);
  if (!status && is_rigid(set)) status = mpmi_field_make_present(set, MPMI_PRESCRIBED);
  if (status) return status;
  set->slots = slots;
  mpmi_fill_holes(set, 0, first, slots, set->grid->desc.origin);
  *slot = first;
  return MPM_OK;
}

/* Writes the default of a field that is kept, where the default is not 0 and the caller has not written
 * the field. */
static void write_derived(mpm_particles *set, int32_t field, int64_t begin, int64_t end) {
  if (!set->field[field].present) return;
  for (int32_t c = 0; c < set->field[field].components; ++c)
    for (int64_t s = begin; s < end; ++s)
      mpmi_f64(set, field, 0)[c * set->ld + s] = mpmi_absent_value(set, field, c, s);
}

void mpmi_append_finish(mpm_particles *set, int64_t slot, int64_t n, int32_t with_size, const int64_t *ids) {
  int64_t *id = mpmi_i64(set, MPMI_ID, 0) + slot;
  double *mass = mpmi_f64(set, MPMI_MASS, 0) + slot, *volume = mpmi_f64(set, MPMI_VOLUME, 0) + slot;
  const double *initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + slot;
  int64_t next_id = set->next_id;
  for (int64_t i = 0; i < n; ++i) {
    id[i] = ids ? ids[i] : set->next_id + i;
    if (id[i] >= next_id) next_id = id[i] + 1;
    volume[i] = initial_volume[i];
    mass[i] = set->material->density * volume[i];
    if (mass[i] > set->mass_max) set->mass_max = mass[i];
  }
  for (int64_t s = slot; s < slot + n; ++s) mpmi_wrap_slot(set, s);
  if (!with_size) write_derived(set, MPMI_SIZE, slot, slot + n);
  write_derived(set, MPMI_REFERENCE, slot, slot + n);
  write_derived(set, MPMI_DILATION_RATIO, slot, slot + n);
  for (int32_t c = 0; c < set->grid->dim && is_rigid(set); ++c)
    memset((uint8_t *)set->field[MPMI_PRESCRIBED].data[0] + c * set->ld + slot, 1, (size_t)n);
  set->next_id = next_id;
  set->count += n;
  set->dirty |= MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION;
  mpmi_index_drop(set);
}
