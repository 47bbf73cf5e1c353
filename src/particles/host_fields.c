/* The host lists the fields of a set and adds fields of its own. */
#include <string.h>

#include "particles/builtin_fields.h"

mpm_status mpm_particles_field_info(const mpm_particles *particles, int32_t index, const char **field,
                                    int32_t *type, int32_t *components, int32_t *writable) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  if (index < 0 || index >= particles->field_count)
    return mpmi_fail(particles->context, MPM_E_NOT_FOUND, "the set has %d fields, none with index %d",
                     (int)particles->field_count, (int)index);
  const mpmi_field *at = &particles->field[index];
  if (field) *field = at->name;
  if (type) *type = at->type;
  if (components) *components = at->full_components;
  if (writable) *writable = at->writable;
  return MPM_OK;
}

static mpm_status check_name(const mpm_particles *set, const char *name) {
  if (!name) return mpmi_fail(set->context, MPM_E_ARG, "field is NULL");
  size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_");
  if (length == 0 || name[length])
    return mpmi_fail(set->context, MPM_E_ARG, "field is \"%s\": names are made of a-z, 0-9 and _", name);
  if (length >= MPMI_NAME)
    return mpmi_fail(set->context, MPM_E_ARG, "field has a name of %d characters, must be at most %d",
                     length > INT32_MAX ? INT32_MAX : (int)length, (int)MPMI_NAME - 1);
  if (mpmi_find_field(set, name) >= 0)
    return mpmi_fail(set->context, MPM_E_ARG, "the set has a field \"%s\" already", name);
  return MPM_OK;
}

mpm_status mpm_particles_set_extensive(mpm_particles *particles, const char *field, int32_t extensive) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  int32_t f = -1;
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status) status = mpmi_require_field(particles, field, &f);
  if (status) return status;
  if (extensive < 0 || extensive > 1)
    return mpmi_fail(particles->context, MPM_E_ARG, "extensive is %d, must be 0 or 1", (int)extensive);
  if (f < MPMI_BUILTIN_FIELDS || particles->field[f].type != MPM_F64)
    return mpmi_fail(particles->context, MPM_E_ARG,
                     "%s is %s: only fields of the host of type MPM_F64 can be extensive", field,
                     f < MPMI_BUILTIN_FIELDS ? "a field of the library" : "of another type");
  const mpmi_thermal *thermal = &particles->thermal;
  if (extensive && (f == thermal->temperature || f == thermal->stress_temperature))
    return mpmi_fail(particles->context, MPM_E_ARG, "%s is the temperature of the set, which is no amount",
                     field);
  particles->field[f].extensive = extensive;
  return MPM_OK;
}

mpm_status mpm_particles_add_field(mpm_particles *particles, const char *field, int32_t type,
                                   int32_t components) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status) status = check_name(particles, field);
  if (status) return status;
  if (type < MPM_F64 || type > MPM_U8)
    return mpmi_fail(particles->context, MPM_E_ARG, "type is %d, must be MPM_F64, MPM_I64 or MPM_U8",
                     (int)type);
  if (components < 1 || components > MPMI_MAX_COMPONENTS)
    return mpmi_fail(particles->context, MPM_E_ARG, "components is %d, must be 1 to %d", (int)components,
                     (int)MPMI_MAX_COMPONENTS);
  if (particles->field_count == MPMI_MAX_FIELDS)
    return mpmi_fail(particles->context, MPM_E_STATE, "the set has %d fields: there is room for no more",
                     (int)MPMI_MAX_FIELDS);
  mpmi_field *at = &particles->field[particles->field_count];
  memset(at, 0, sizeof *at);
  memcpy(at->name, field, strlen(field) + 1);
  at->type = type;
  at->components = at->full_components = components;
  at->writable = 1;
  status = mpmi_field_make_present(particles, particles->field_count);
  if (!status) particles->field_count++;
  return status;
}
