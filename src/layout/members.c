#include "layout/members.h"
#include "context/slack.h"
#include "particles/values.h"

#include <string.h>

/* ---- fields that exist as long as a stepper keeps them ------------------------------------------------ */
static mpm_status make_fields(mpm_particles *set, const mpm_stepper_desc *d) {
  mpm_status status = MPM_OK;
  if (d->reference_positions) status = mpmi_field_make_present(set, MPMI_REFERENCE);
  if (!status && d->scheme == MPM_NEWMARK) status = mpmi_field_make_present(set, MPMI_ACCELERATION);
  if (!status && d->locking_remedy) status = mpmi_field_make_present(set, MPMI_DILATION_RATIO);
  if (status && !set->stepper && !mpmi_is_total_lagrangian(set->grid))
    mpmi_field_make_absent(set, MPMI_REFERENCE);
  return status;
}

/* Drops the fields that d does not ask for, all of them when it is NULL. */
static void drop_fields(mpm_particles *set, const mpm_stepper_desc *d) {
  if ((!d || !d->reference_positions) && !mpmi_is_total_lagrangian(set->grid))
    mpmi_field_make_absent(set, MPMI_REFERENCE);
  if ((d && d->locking_remedy) || !set->field[MPMI_DILATION_RATIO].present) return;
  mpmi_field_make_absent(set, MPMI_DILATION_RATIO);
  mpmi_field_written(set, MPMI_F); /* the law sees F as it is again */
}

mpm_status mpmi_members_keep_fields(mpmi_layout *layout, const mpmi_settings *settings,
                                    const mpm_stepper_desc *desc) {
  mpm_status status = MPM_OK;
  for (int32_t m = 0; m < layout->member_count && !status; ++m)
    status = make_fields(layout->member[m].set, desc);
  /* drops what is not wanted, or what could not be made for all sets */
  for (int32_t m = 0; m < layout->member_count; ++m)
    drop_fields(layout->member[m].set, status ? &settings->desc : desc);
  return status;
}

/* ---- coming and going --------------------------------------------------------------------------------- */
/* The first `count` members may be touched. */
static void watch(mpmi_layout *layout, int32_t count) {
  const size_t size = sizeof *layout->member;
  mpmi_slack(layout->member, (size_t)layout->member_capacity * size, (size_t)count * size);
}

static mpm_status grow(mpmi_layout *layout, mpm_context *c) {
  if (layout->member_count < layout->member_capacity) return MPM_OK;
  const int32_t capacity = layout->member_capacity ? 2 * layout->member_capacity : 4;
  mpmi_member *member = mpmi_alloc_zeroed(c, mpmi_bytes(capacity, sizeof *member));
  if (!member) return MPM_E_NOMEM;
  if (layout->member_count) memcpy(member, layout->member, (size_t)layout->member_count * sizeof *member);
  MPMI_FREE_ARRAY(c, layout->member, layout->member_capacity);
  layout->member = member;
  layout->member_capacity = capacity;
  return MPM_OK;
}

mpm_status mpmi_members_add(mpmi_layout *layout, const mpmi_settings *settings, mpm_particles *set) {
  mpm_context *c = settings->context;
  mpm_status status;
  if ((status = grow(layout, c)) || (status = make_fields(set, &settings->desc))) return status;
  watch(layout, layout->member_count + 1);
  mpmi_member *member = &layout->member[layout->member_count++];
  memset(member, 0, sizeof *member);
  member->set = set;
  mpmi_arrangement_init(&member->now, c);
  mpmi_arrangement_init(&member->next, c);
  set->dirty |= MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS;
  if (layout->parts) layout->parts->is_stale = 1; /* its sums are made by blocks of this stepper */
  return MPM_OK;
}

void mpmi_members_remove(mpmi_layout *layout, const mpmi_settings *settings, int32_t m) {
  mpm_context *c = settings->context;
  mpmi_member *member = &layout->member[m];
  mpmi_arrangement_free(&member->now);
  mpmi_arrangement_free(&member->next);
  mpmi_sorting_free(&member->sorting, c);
  drop_fields(member->set, NULL);
  member->set->stepper = NULL;
  member->set->dirty |= MPMI_DIRTY_PLACE;
  if (layout->parts) layout->parts->is_stale = 1;
  for (int32_t i = m + 1; i < layout->member_count; ++i) layout->member[i - 1] = layout->member[i];
  watch(layout, --layout->member_count);
  mpmi_blocks_clear(&layout->blocks); /* the worklists counted its slots: the next step sorts anew */
}

mpm_status mpmi_members_find(const mpmi_layout *layout, const mpmi_settings *settings,
                             const mpm_particles *set, int32_t *m) {
  if (!set) return mpmi_fail(settings->context, MPM_E_ARG, "particles is NULL");
  for (*m = 0; *m < layout->member_count; ++*m)
    if (layout->member[*m].set == set) return MPM_OK;
  return mpmi_fail(settings->context, MPM_E_NOT_FOUND, "the set is not in this stepper");
}

mpm_status mpmi_members_unmapped(const mpmi_layout *layout, const mpmi_settings *settings,
                                 const char *before) {
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (layout->member[m].set->mapped)
      return mpmi_fail(settings->context, MPM_E_STATE, "set %d is mapped: release its views %s", (int)m,
                       before);
  return MPM_OK;
}

/* ---- what a step needs of them ------------------------------------------------------------------------ */
mpm_status mpmi_members_refresh(mpmi_layout *layout, const mpmi_settings *settings) {
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpm_particles *set = layout->member[m].set;
    mpm_status status;
    if (set->mapped)
      return mpmi_fail(settings->context, MPM_E_STATE,
                       "set %d has %d mapped views: release them before stepping", (int)m, (int)set->mapped);
    if ((status = mpmi_particles_check_suspects(set)) || (status = mpmi_particles_refresh(set)))
      return status;
    if (mpmi_is_affine(settings) && !set->field[MPMI_L].present &&
        (status = mpmi_field_make_present(set, MPMI_L)))
      return status;
  }
  return MPM_OK;
}
