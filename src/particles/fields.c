/* Fields have their storage here: capacity, optional fields, inert slots. */
#include <math.h>
#include <string.h>

#include "context/slack.h"
#include "particles/builtin_fields.h"
#include "simd/elementary.h"

enum { COPIES = 2 };

int64_t mpmi_leading_dimension(int64_t slots) {
  int64_t groups = (slots + MPMI_PAD - 1) / MPMI_PAD;
  /* A group is 128 bytes of doubles. Neighbouring components should meet neither the same cache sets nor
   * the same address modulo a page (32 groups). So the number of groups is odd and not next to a multiple
   * of 32. */
  groups |= 1;
  while (groups > 1 && (groups % 32 < 3 || groups % 32 > 29)) groups += 2;
  return groups * MPMI_PAD;
}

static size_t copy_bytes(const mpmi_field *field, int64_t ld) {
  return mpmi_bytes(ld, (size_t)field->components * mpmi_type_size(field->type));
}

static void free_copies(mpm_particles *set, const mpmi_field *field, void *data[COPIES], int64_t ld) {
  for (int32_t k = 0; k < COPIES; ++k) {
    mpmi_free(set->context, data[k], copy_bytes(field, ld));
    data[k] = NULL;
  }
}

/* Allocates both copies or none; an empty set has no arrays. */
static mpm_status alloc_copies(mpm_particles *set, const mpmi_field *field, void *data[COPIES], int64_t ld) {
  data[0] = data[1] = NULL;
  if (ld == 0) return MPM_OK;
  for (int32_t k = 0; k < 1 + field->two_copies; ++k) {
    data[k] = mpmi_alloc(set->context, copy_bytes(field, ld));
    if (data[k]) continue;
    free_copies(set, field, data, ld);
    return MPM_E_NOMEM;
  }
  return MPM_OK;
}

static void move_rows(const mpmi_field *field, const char *from, int64_t from_ld, char *to, int64_t to_ld,
                      int64_t slots) {
  size_t size = mpmi_type_size(field->type);
  for (int64_t c = 0; c < field->components && slots > 0; ++c)
    memcpy(to + (size_t)(c * to_ld) * size, from + (size_t)(c * from_ld) * size, (size_t)slots * size);
}

static void watch_field(const mpmi_field *field, int64_t ld, int64_t slots) {
  for (int32_t k = 0; k < COPIES && field->present; ++k)
    mpmi_slack_rows(field->data[k], (size_t)field->components, (size_t)ld, (size_t)slots,
                    mpmi_type_size(field->type));
}

void mpmi_particles_watch(const mpm_particles *set, int64_t slots) {
  for (int32_t f = 0; f < set->field_count; ++f) watch_field(&set->field[f], set->ld, slots);
}

static mpm_status reserve_copies(mpm_particles *set, int64_t slots, int32_t copies) {
  if (slots <= set->ld) return MPM_OK;
  if (slots > MPMI_MAX_SLOTS)
    return mpmi_fail(set->context, MPM_E_ARG, "a set has room for %lld slots: %lld are too many",
                     (long long)MPMI_MAX_SLOTS, (long long)slots);
  int64_t ld = mpmi_leading_dimension(slots);
  void *fresh[MPMI_MAX_FIELDS][COPIES];
  for (int32_t f = 0; f < set->field_count; ++f) {
    mpmi_field *field = &set->field[f];
    if (!field->present || alloc_copies(set, field, fresh[f], ld) == MPM_OK) continue;
    while (--f >= 0)
      if (set->field[f].present) free_copies(set, &set->field[f], fresh[f], ld);
    return MPM_E_NOMEM;
  }
  for (int32_t f = 0; f < set->field_count; ++f) {
    mpmi_field *field = &set->field[f];
    if (!field->present) continue;
    for (int32_t k = 0; k < copies && k < 1 + field->two_copies; ++k)
      move_rows(field, field->data[k], set->ld, fresh[f][k], ld, set->slots);
    free_copies(set, field, field->data, set->ld);
    memcpy(field->data, fresh[f], sizeof field->data);
  }
  set->ld = ld;
  return MPM_OK;
}

/* The second copy is scratch between steps, and holds the results of one under way. */
static mpm_status reserve(mpm_particles *set, int64_t slots, int32_t copies) {
  const mpm_status status = reserve_copies(set, slots, copies);
  if (!status) mpmi_particles_watch(set, slots > set->slots ? slots : set->slots);
  return status;
}

mpm_status mpmi_particles_reserve(mpm_particles *set, int64_t slots) {
  return reserve(set, slots, 1);
}

mpm_status mpmi_particles_reserve_in_step(mpm_particles *set, int64_t slots) {
  return reserve(set, slots, COPIES);
}

double mpmi_absent_value(const mpm_particles *set, int32_t field, int32_t c, int64_t slot) {
  const mpm_grid *grid = set->grid;
  if (field == MPMI_SIZE) {
    const double radius = mpmi_is_axisymmetric(grid) ? mpmi_places(set, 0)[slot] : 1.0;
    const double volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0)[slot] / (radius > 0.0 ? radius : 1.0);
    return grid->dim == 1 ? volume : grid->dim == 2 ? sqrt(volume) : mpmi_cbrt(volume);
  }
  if (field == MPMI_REFERENCE) {
    double x = mpmi_f64(set, MPMI_POSITION, 0)[c * set->ld + slot];
    if (!set->field[MPMI_IMAGE].present) return x;
    double period = grid->upper[c] - grid->desc.origin[c];
    return x + period * (double)mpmi_i64(set, MPMI_IMAGE, 0)[c * set->ld + slot];
  }
  return field == MPMI_DILATION_RATIO ? 1.0 : 0.0;
}

static double hole_value(const mpm_particles *set, int32_t field, int32_t c, const double *position) {
  switch (field) {
  case MPMI_ID:
    return -1.0;
  case MPMI_DILATION_RATIO:
    return 1.0;
  case MPMI_POSITION:
    return position[c];
  case MPMI_REFERENCE:
    return mpmi_is_total_lagrangian(set->grid) ? position[c] : 0.0;
  case MPMI_F:
    return mpmi_unstored_value(field, mpmi_tensor_map(set->grid->dim)[c]);
  case MPMI_STATE:
    return set->material->state_initial ? set->material->state_initial[c] : 0.0;
  default:
    return 0.0;
  }
}

static void write_holes(mpm_particles *set, int32_t field, int32_t copy, int64_t begin, int64_t end,
                        const double *position) {
  const mpmi_field *at = &set->field[field];
  if (!at->present || !at->data[copy]) return;
  for (int32_t c = 0; c < at->components; ++c) {
    double value = hole_value(set, field, c, position);
    int64_t first = c * set->ld + begin, last = c * set->ld + end;
    if (at->type == MPM_F64)
      for (int64_t i = first; i < last; ++i) ((double *)at->data[copy])[i] = value;
    else if (at->type == MPM_I64)
      for (int64_t i = first; i < last; ++i) ((int64_t *)at->data[copy])[i] = (int64_t)value;
    else
      memset((uint8_t *)at->data[copy] + first, 0, (size_t)(last - first));
  }
}

void mpmi_fill_holes(mpm_particles *set, int32_t copy, int64_t begin, int64_t end, const double *position) {
  for (int32_t f = 0; f < set->field_count; ++f) write_holes(set, f, copy, begin, end, position);
}

void mpmi_make_holes(mpm_particles *set, int64_t begin, int64_t end) {
  for (int32_t f = 0; f < set->field_count; ++f)
    if (f != MPMI_POSITION && f != mpmi_place_field(set->grid)) write_holes(set, f, 0, begin, end, NULL);
}

void mpmi_wrap_slot(mpm_particles *set, int32_t field, int64_t slot) {
  int64_t *image = set->field[MPMI_IMAGE].present ? mpmi_i64(set, MPMI_IMAGE, 0) + slot : NULL;
  mpmi_grid_place(set->grid, mpmi_f64(set, field, 0) + slot, set->ld, image, set->ld);
}

void mpmi_restore_holes(mpm_particles *set, int32_t field) {
  /* Any position inside the grid will do, because the sort after a change of positions places holes anew. */
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int64_t s = 0; s < set->slots; ++s)
    if (id[s] < 0) write_holes(set, field, 0, s, s + 1, set->grid->desc.origin);
}

void mpmi_field_write_absent(mpm_particles *set, int32_t field, int64_t begin, int64_t end) {
  const mpmi_field *at = &set->field[field];
  write_holes(set, field, 0, begin, end, set->grid->desc.origin);
  if (at->type != MPM_F64) return;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int32_t c = 0; c < at->components; ++c)
    for (int64_t s = begin; s < end; ++s)
      if (id[s] >= 0) mpmi_f64(set, field, 0)[c * set->ld + s] = mpmi_absent_value(set, field, c, s);
}

mpm_status mpmi_field_make_present(mpm_particles *set, int32_t field) {
  mpmi_field *at = &set->field[field];
  if (at->present || at->components == 0) return MPM_OK;
  mpm_status status = alloc_copies(set, at, at->data, set->ld);
  if (status) return status;
  at->present = 1;
  watch_field(at, set->ld, set->slots);
  mpmi_field_write_absent(set, field, 0, set->slots);
  return MPM_OK;
}

void mpmi_field_make_absent(mpm_particles *set, int32_t field) {
  mpmi_field *at = &set->field[field];
  if (at->present) free_copies(set, at, at->data, set->ld);
  at->present = 0;
}
