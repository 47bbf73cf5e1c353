/* Particle sets are made and freed here, and refuse changes while they are mapped or in a step. */
#include "context/transport.h"
#include "particles/builtin_fields.h"

mpm_status mpmi_between_steps(const mpm_particles *set) {
  if (!set->stepper || !set->owner->in_step(set->stepper)) return MPM_OK;
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
  if (grid->domains == MPMI_DOMAINS_STRETCHED && mpmi_material_kinematics(material) == MPMI_F_DILATES)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "%s keeps the volume of F only, of which MPM_CPGIMP cannot make particle domains: use "
                     "MPM_UGIMP or a B-spline basis",
                     material->law->name);
  if (mpmi_is_total_lagrangian(grid) && mpmi_material_kinematics(material) == MPMI_F_DILATES)
    return mpmi_fail(
        context, MPM_E_UNSUPPORTED,
        "%s keeps the volume of F only, and forces on a grid with total_lagrangian = 1 need all of "
        "it: use total_lagrangian = 0, which lets it flow",
        material->law->name);
  if (mpmi_is_plane_stress(grid) && material->law && material->law->no_sheets)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "%s is no solid sheet, and the grid is MPM_PLANE_STRESS: use MPM_PLANE_STRAIN",
                     material->law->name);
  return MPM_OK;
}

mpm_status mpm_particles_create(mpm_context *context, mpm_grid *grid, mpm_material *material,
                                mpm_particles **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  if (!out) return mpmi_fail(context, MPM_E_ARG, "mpm_particles_create: out is NULL");
  mpm_status status = check_parts(context, grid, material);
  if (status) return status;
  mpm_particles *set = mpmi_alloc_zeroed(context, sizeof *set);
  if (!set) return MPM_E_NOMEM;
  set->magic = MPMI_PARTICLES;
  set->context = context;
  set->grid = grid;
  set->material = material;
  mpmi_fields_builtin(set);
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

mpm_status mpm_particles_total(const mpm_particles *particles, int64_t *n) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  int64_t total = particles->count;
  mpm_status status = n ? MPM_OK : mpmi_fail(particles->context, MPM_E_ARG, "n is NULL");
  if ((status = mpmi_agree(particles->context, status)) ||
      (status = mpmi_reduce_parts(particles->context, MPM_REDUCE_SUM, 1, &total)))
    return status;
  *n = total;
  return MPM_OK;
}

int64_t mpm_particles_count(const mpm_particles *particles) {
  return particles && particles->magic == MPMI_PARTICLES ? particles->count : 0;
}
