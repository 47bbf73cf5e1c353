/* Particle sets: making and freeing them, what fields they have, when they may be changed. */
#include <string.h>

#include "particles/layout.h"
#include "stepper/stepper_state.h"

mpm_status mpmi_between_steps(const mpm_particles *set) {
  if (!set->stepper || !mpmi_stepper_in_step(set->stepper)) return MPM_OK;
  return mpmi_fail(set->context, MPM_E_STATE, "a staged step is under way: end or abort it first");
}

static mpm_status check_unmapped(const mpm_particles *set) {
  if (!set->mapped) return MPM_OK;
  return mpmi_fail(set->context, MPM_E_STATE, "%d views of the set are out: release them first",
                   (int)set->mapped);
}

mpm_status mpmi_particles_changeable(mpm_particles *set) {
  mpm_status status = check_unmapped(set);
  return status ? status : mpmi_between_steps(set);
}

static mpm_status check_parts(mpm_context *context, const mpm_grid *grid, const mpm_material *material) {
  if (!grid || grid->magic != MPMI_GRID) return mpmi_fail(context, MPM_E_ARG, "grid is not a live grid");
  if (!material || material->magic != MPMI_MATERIAL)
    return mpmi_fail(context, MPM_E_ARG, "material is not a live material");
  if (grid->context != context) return mpmi_fail(context, MPM_E_ARG, "grid belongs to another context");
  if (material->context != context)
    return mpmi_fail(context, MPM_E_ARG, "material belongs to another context");
  if (grid->desc.basis == MPM_CPGIMP && mpmi_material_kinematics(material) == MPMI_F_DILATES)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "%s keeps the volume of F only, of which MPM_CPGIMP cannot make particle domains: use "
                     "MPM_UGIMP or a B-spline basis",
                     material->law->name);
  return MPM_OK;
}

mpm_status mpm_particles_create(mpm_context *context, mpm_grid *grid, mpm_material *material,
                                mpm_particles **out) {
  if (!context || context->magic != MPMI_CONTEXT) return MPM_E_ARG;
  context->error[0] = '\0';
  if (!out) return mpmi_fail(context, MPM_E_ARG, "mpm_particles_create: out is NULL");
  *out = NULL;
  mpm_status status = check_parts(context, grid, material);
  if (status) return status;
  mpm_particles *set = mpmi_alloc_zeroed(context, sizeof *set);
  if (!set) return MPM_E_NOMEM;
  set->magic = MPMI_PARTICLES;
  set->context = context;
  set->grid = grid;
  set->material = material;
  mpmi_layout_builtin(set);
  grid->children++;
  material->users++;
  context->children++;
  *out = set;
  return MPM_OK;
}

mpm_status mpm_particles_destroy(mpm_particles *particles) {
  if (!particles) return MPM_OK;
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_context *context = particles->context;
  mpm_status status = check_unmapped(particles);
  if (status) return status;
  if (particles->stepper)
    return mpmi_fail(context, MPM_E_STATE, "a stepper holds the set: call mpm_stepper_remove() first");
  for (int32_t f = 0; f < particles->field_count; ++f) mpmi_field_make_absent(particles, f);
  mpmi_index_drop(particles);
  particles->magic = 0;
  particles->grid->children--;
  particles->material->users--;
  context->children--;
  mpmi_free(context, particles, sizeof *particles);
  return MPM_OK;
}

int64_t mpm_particles_count(const mpm_particles *particles) {
  return particles && particles->magic == MPMI_PARTICLES ? particles->count : 0;
}

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
    return mpmi_fail(set->context, MPM_E_ARG, "field has a name of %zu characters, must be at most %d",
                     length, (int)MPMI_NAME - 1);
  if (mpmi_find_field(set, name) >= 0)
    return mpmi_fail(set->context, MPM_E_ARG, "the set has a field \"%s\" already", name);
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
