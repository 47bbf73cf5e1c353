/* A view lends the library's own memory until it is given back. */
#include <string.h>

#include "context/structs.h"
#include "particles/values.h"

mpm_status mpmi_view_check(mpm_context *context, const mpm_view *view) {
  if (!view) return mpmi_fail(context, MPM_E_ARG, "view is NULL");
  if (view->struct_size < mpmi_first_size("mpm_view"))
    return mpmi_fail(context, MPM_E_ARG, "mpm_view: struct_size is %u, must be sizeof(mpm_view)",
                     view->struct_size);
  return MPM_OK;
}

void mpmi_view_fill(mpm_view *view, int32_t type, int32_t components, int32_t access, int64_t count,
                    int64_t ld, void *data, mpmi_view_record *record) {
  const mpm_view filled = {.struct_size = view->struct_size,
                           .type = type,
                           .components = components,
                           .access = access,
                           .count = count,
                           .item_stride = 1,
                           .component_stride = ld,
                           .data = data,
                           .owner = record};
  /* The host's struct may be that of another release: longer or shorter than this one. */
  memcpy(view, &filled, view->struct_size < sizeof filled ? view->struct_size : sizeof filled);
}

static mpmi_view_record *free_record(mpm_particles *set) {
  for (int32_t i = 0; i < MPMI_MAX_VIEWS; ++i)
    if (!set->view[i].live) return &set->view[i];
  return NULL;
}

static mpm_status check_request(const mpm_particles *set, const char *field, int32_t access,
                                const mpm_view *view, int32_t *f) {
  mpm_status status = mpmi_view_check(set->context, view);
  if (status) return status;
  if (access < MPM_READ || access > (MPM_READ | MPM_WRITE))
    return mpmi_fail(set->context, MPM_E_ARG, "access is %d, must be MPM_READ, MPM_WRITE or both",
                     (int)access);
  status = mpmi_require_field(set, field, f);
  if (!status) status = mpmi_check_exists(set, *f);
  if (!status && access & MPM_WRITE) status = mpmi_check_writable(set, *f);
  if (status) return status;
  if (set->field[*f].components == 0)
    return mpmi_fail(set->context, MPM_E_NOT_FOUND, "the law of this set has no state to map");
  return access & MPM_WRITE || !set->field[*f].present ? mpmi_between_steps(set) : MPM_OK;
}

/* ---- views for reading, with MPM_DEBUG ----------------------------------------------------------------- */
#if defined(MPM_DEBUG)
/* FNV over the slots of a field. */
static uint64_t print_of(const mpm_particles *set, int32_t field) {
  const mpmi_field *at = &set->field[field];
  const size_t size = mpmi_type_size(at->type);
  uint64_t print = 0xcbf29ce484222325u;
  for (int32_t c = 0; c < at->components; ++c) {
    const uint8_t *row = (const uint8_t *)at->data[0] + (size_t)(c * set->ld) * size;
    for (size_t i = 0; i < (size_t)set->slots * size; ++i) print = (print ^ row[i]) * 0x100000001b3u;
  }
  return print;
}

/* What is lent for writing may change whatever else is lent: its records hold for as long as nothing is. */
static void take_print(mpm_particles *set, mpmi_view_record *record) {
  int32_t writes = 0;
  for (int32_t i = 0; i < MPMI_MAX_VIEWS; ++i) writes |= set->view[i].live && set->view[i].access & MPM_WRITE;
  for (int32_t i = 0; i < MPMI_MAX_VIEWS && writes; ++i) set->view[i].has_print = 0;
  record->has_print = !writes;
  if (!writes) record->print = print_of(set, record->field);
}

static mpm_status check_print(mpm_particles *set, const mpmi_view_record *record) {
  if (!record->has_print || print_of(set, record->field) == record->print) return MPM_OK;
  return mpmi_fail(set->context, MPM_E_STATE, "%s was lent for reading, and its memory has changed",
                   set->field[record->field].name);
}
#else
static void take_print(mpm_particles *set, mpmi_view_record *record) {
  (void)set, (void)record;
}
static mpm_status check_print(mpm_particles *set, const mpmi_view_record *record) {
  (void)set, (void)record;
  return MPM_OK;
}
#endif

/* Lets writing take effect: what follows from the field is out of date, and bad values bar the set from
 * steps. */
static mpm_status accept_written(mpm_particles *set, int32_t field) {
  mpmi_restore_holes(set, field);
  mpm_status status = mpmi_check_stored(set, field);
  if (field < MPMI_BUILTIN_FIELDS) {
    uint32_t bit = 1u << field;
    set->suspect = status ? set->suspect | bit : set->suspect & ~bit;
  }
  mpmi_field_written(set, field);
  return status;
}

static mpm_status release_field(mpmi_view_record *record, mpm_view *view) {
  mpm_particles *set = record->lender;
  int32_t field = record->field, access = record->access;
  const mpm_status status = check_print(set, record);
  set->mapped--;
  record->live = 0;
  view->data = view->owner = NULL;
  return access & MPM_WRITE ? accept_written(set, field) : status;
}

mpm_status mpm_particles_map(mpm_particles *particles, const char *field, int32_t access, mpm_view *view) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  int32_t f;
  mpm_status status = check_request(particles, field, access, view, &f);
  if (status) return status;
  mpmi_view_record *record = free_record(particles);
  if (!record)
    return mpmi_fail(particles->context, MPM_E_STATE, "%d views of the set are out: release one first",
                     (int)MPMI_MAX_VIEWS);
  status = mpmi_settle(particles, f);
  if (!status) status = mpmi_field_make_present(particles, f);
  if (status) return status;
  const mpmi_field *at = &particles->field[f];
  *record = (mpmi_view_record){.live = 1,
                               .field = f,
                               .access = access,
                               .context = particles->context,
                               .data = at->data[0],
                               .lender = particles,
                               .release = release_field};
  take_print(particles, record);
  particles->mapped++;
  if (f == mpmi_place_field(particles->grid)) particles->lent = 1;
  mpmi_view_fill(view, at->type, at->components, access, particles->slots, particles->ld, at->data[0],
                 record);
  return MPM_OK;
}

mpm_status mpm_view_release(mpm_view *view) {
  if (!view) return MPM_E_ARG;
  mpmi_view_record *record = view->owner;
  if (!record) return MPM_E_STATE;
  MPMI_ENTER_CONTEXT(record->context);
  if (!record->live || record->data != view->data)
    return mpmi_fail(record->context, MPM_E_STATE, "the view is not lent, or was given back already");
  return record->release(record, view);
}
