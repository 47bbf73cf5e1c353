/* Fields are copied by id here, in the full layout. */
#include <string.h>

#include "particles/values.h"

int64_t mpmi_selected_slots(const mpm_particles *set, const mpmi_selection *of, int64_t begin,
                            int64_t *slot) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  int64_t end = of->n - begin < MPMI_SELECTED ? of->n : begin + MPMI_SELECTED, found = 0;
  for (int64_t i = begin; i < end; ++i) {
    if (of->uniform && id[i] < 0) continue;
    slot[found++] = of->uniform ? i : of->ids ? mpmi_index_find(set, of->ids[i]) : set->index[i].slot;
  }
  return found;
}

static mpm_status check_layout(const mpm_particles *set, int32_t field, int32_t type, int32_t components) {
  static const char *const type_name[] = {"?", "F64", "I64", "U8"};
  const mpmi_field *at = &set->field[field];
  if (type == at->type && components == at->full_components) return MPM_OK;
  return mpmi_fail(set->context, MPM_E_ARG, "%s is %s with %d components, not %s with %d", at->name,
                   type_name[at->type], (int)at->full_components,
                   type_name[type >= MPM_F64 && type <= MPM_U8 ? type : 0], (int)components);
}

/* The index is a cache, which const sets have too. */
mpm_status mpmi_check_selection(const mpm_particles *set, const mpmi_selection *of) {
  mpm_context *context = set->context;
  if (!of->ids && of->n != set->count)
    return mpmi_fail(context, MPM_E_ARG, "n is %lld, but the set has %lld particles and ids is NULL",
                     (long long)of->n, (long long)set->count);
  if (of->n < 0) return mpmi_fail(context, MPM_E_ARG, "n is %lld, must be >= 0", (long long)of->n);
  mpm_status status = mpmi_index_build((mpm_particles *)set);
  for (int64_t i = 0; i < of->n && of->ids && !status; ++i)
    if (mpmi_index_find(set, of->ids[i]) < 0)
      status =
          mpmi_fail(context, MPM_E_NOT_FOUND, "the set has no particle with id %lld", (long long)of->ids[i]);
  return status;
}

static void copy_element(void *to, const void *from, size_t size) {
  if (size == 1)
    memcpy(to, from, 1);
  else
    memcpy(to, from, sizeof(double));
}

/* Copies one component of a portion to out[], from the storage of the field or from its default. */
static void copy_out(const mpm_particles *set, int32_t field, int32_t c, int64_t n, const int64_t *slot,
                     char *out) {
  const mpmi_field *at = &set->field[field];
  size_t size = mpmi_type_size(at->type);
  int32_t stored = mpmi_stored_component(set, field, c);
  if (stored >= 0 && at->present) {
    const char *row = (const char *)at->data[0] + (size_t)(stored * set->ld) * size;
    for (int64_t i = 0; i < n; ++i) copy_element(out + (size_t)i * size, row + (size_t)slot[i] * size, size);
  } else if (at->type == MPM_F64) {
    for (int64_t i = 0; i < n; ++i)
      ((double *)(void *)out)[i] =
          stored < 0 ? mpmi_unstored_value(field, c) : mpmi_absent_value(set, field, c, slot[i]);
  } else {
    memset(out, 0, (size_t)n * size);
  }
}

mpm_status mpm_particles_get(const mpm_particles *particles, const char *field, int32_t type,
                             int32_t components, int64_t n, const int64_t *ids, void *out) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  int32_t f;
  mpm_status status = mpmi_require_field(particles, field, &f);
  if (!status) status = check_layout(particles, f, type, components);
  if (!status) status = mpmi_check_exists(particles, f);
  if (status) return status;
  mpmi_selection of = {n, ids, 0};
  status = mpmi_check_selection(particles, &of);
  if (!status && !out && n > 0 && components > 0)
    status = mpmi_fail(particles->context, MPM_E_ARG, "out is NULL");
  /* Volume and stress follow from F and may be out of date. The host must not see that, const or not. */
  if (!status) status = mpmi_settle((mpm_particles *)particles, f);
  int64_t slot[MPMI_SELECTED];
  for (int64_t begin = 0; begin < n && !status; begin += MPMI_SELECTED) {
    int64_t found = mpmi_selected_slots(particles, &of, begin, slot);
    for (int32_t c = 0; c < components; ++c)
      copy_out(particles, f, c, found, slot, (char *)out + (size_t)(c * n + begin) * mpmi_type_size(type));
  }
  return status;
}

/* A source is the host's array: component c of item i is at i * item_stride + c * component_stride. */
typedef struct source {
  const char *values;
  int64_t item_stride, component_stride;
} source;

static mpm_status check_given(const mpm_particles *set, int32_t field, const mpmi_selection *of,
                              const source *from) {
  const double *values = (const double *)(const void *)from->values;
  const uint8_t *flags = (const uint8_t *)from->values;
  if (set->field[field].type != MPM_F64 && field != MPMI_PRESCRIBED) return MPM_OK;
  for (int64_t i = 0; i < (of->uniform ? 1 : of->n); ++i) {
    mpmi_who who = {"id", of->ids ? of->ids[i] : i};
    if (!of->ids && !of->uniform) who.number = set->index[i].id;
    if (of->uniform) who.kind = NULL;
    const int64_t item = i * from->item_stride;
    const mpm_status status = field == MPMI_PRESCRIBED
                                  ? mpmi_check_flags(set, field, flags + item, from->component_stride, who)
                                  : mpmi_check_value(set, field, values + item, from->component_stride, who);
    if (status) return status;
  }
  return MPM_OK;
}

/* Copies one item after the other, so that of two values for one particle the later stands, and both are
 * wrapped. */
static void copy_in(mpm_particles *set, int32_t field, const mpmi_selection *of, const source *from) {
  const mpmi_field *at = &set->field[field];
  size_t size = mpmi_type_size(at->type);
  int64_t slot[MPMI_SELECTED];
  for (int64_t begin = 0; begin < of->n; begin += MPMI_SELECTED) {
    int64_t found = mpmi_selected_slots(set, of, begin, slot);
    for (int64_t i = 0; i < found; ++i) {
      const char *item = from->values + (size_t)((begin + i) * from->item_stride) * size;
      for (int32_t c = 0; c < at->full_components; ++c) {
        int32_t stored = mpmi_stored_component(set, field, c);
        if (stored >= 0)
          copy_element((char *)at->data[0] + (size_t)(stored * set->ld + slot[i]) * size,
                       item + (size_t)(c * from->component_stride) * size, size);
      }
      if (field == mpmi_place_field(set->grid)) mpmi_wrap_slot(set, field, slot[i]);
    }
  }
}

static mpm_status write_field(mpm_particles *set, int32_t field, const mpmi_selection *of,
                              const source *from) {
  const mpmi_field *at = &set->field[field];
  int64_t given = (of->uniform ? 1 : of->n) * at->full_components;
  if (!from->values && given > 0) return mpmi_fail(set->context, MPM_E_ARG, "the values are NULL");
  if (field == MPMI_PRESCRIBED && !at->present) {
    int64_t i = 0;
    while (i < given && from->values[i] == 0) ++i;
    if (i == given) return MPM_OK; /* an absent field reads as 0 anyway */
  }
  mpm_status status = mpmi_check_exists(set, field);
  if (!status) status = mpmi_check_writable(set, field);
  if (!status) status = check_given(set, field, of, from);
  if (!status) status = mpmi_field_make_present(set, field);
  if (status) return status;
  copy_in(set, field, of, from);
  mpmi_field_written(set, field);
  return MPM_OK;
}

mpm_status mpm_particles_set(mpm_particles *particles, const char *field, int32_t type, int32_t components,
                             int64_t n, const int64_t *ids, const void *values) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  int32_t f;
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status) status = mpmi_require_field(particles, field, &f);
  if (!status) status = check_layout(particles, f, type, components);
  mpmi_selection of = {n, ids, 0};
  if (!status) status = mpmi_check_selection(particles, &of);
  source from = {values, 1, n};
  return status ? status : write_field(particles, f, &of, &from);
}

mpm_status mpm_particles_set_all(mpm_particles *particles, const char *field, int32_t type,
                                 int32_t components, const void *value) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  int32_t f;
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status) status = mpmi_require_field(particles, field, &f);
  if (!status) status = check_layout(particles, f, type, components);
  mpmi_selection of = {particles->slots, NULL, 1};
  source from = {value, 0, 1};
  return status ? status : write_field(particles, f, &of, &from);
}
