/* This file says which values fields may hold, and what follows when the host has written them. */
#include <math.h>
#include <stdio.h>

#include "particles/thermal.h"
#include "particles/values.h"

typedef char whom_text[48];

static const char *name_of(mpmi_who who, whom_text text) {
  if (who.kind)
    snprintf(text, sizeof(whom_text), "the particle with %s %lld", who.kind, (long long)who.number);
  else
    snprintf(text, sizeof(whom_text), "all particles");
  return text;
}

static mpm_status refuse(const mpm_particles *set, int32_t field, int32_t c, double value, mpmi_who who,
                         const char *must) {
  whom_text text;
  char component[32] = "";
  if (set->field[field].full_components > 1) snprintf(component, sizeof component, ", component %d,", (int)c);
  return mpmi_fail(set->context, MPM_E_ARG, "%s of %s%s is %.12g, must be %s", set->field[field].name,
                   name_of(who, text), component, value, must);
}

static mpm_status check_place(const mpm_particles *set, int32_t field, const double *value, int64_t stride,
                              mpmi_who who) {
  double x[3];
  for (int32_t k = 0; k < set->grid->dim; ++k) x[k] = value[k * stride];
  int32_t axis = mpmi_grid_place(set->grid, x, 1, NULL, 0);
  if (axis < 0) return MPM_OK;
  char must[MPMI_GRID_TEXT];
  return refuse(set, field, axis, x[axis], who, mpmi_grid_demand(set->grid, axis, must));
}

static mpm_status check_determinant(const mpm_particles *set, const double *value, int64_t stride,
                                    mpmi_who who) {
  double F[9];
  for (int32_t c = 0; c < 9; ++c) F[c] = value[c * stride];
  double J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
             F[2] * (F[3] * F[7] - F[4] * F[6]);
  if (J > 0 && isfinite(J)) return MPM_OK;
  whom_text text;
  return mpmi_fail(set->context, MPM_E_ARG, "deformation_gradient of %s has determinant %g, must be > 0",
                   name_of(who, text), J);
}

mpm_status mpmi_check_value(const mpm_particles *set, int32_t field, const double *value, int64_t stride,
                            mpmi_who who) {
  if (field == mpmi_place_field(set->grid)) return check_place(set, field, value, stride, who);
  int32_t positive = field == MPMI_VOLUME || field == MPMI_INITIAL_VOLUME || field == MPMI_SIZE ||
                     field == MPMI_DILATION_RATIO;
  for (int32_t c = 0; c < set->field[field].full_components; ++c) {
    double v = value[c * stride];
    if (!isfinite(v)) return refuse(set, field, c, v, who, "finite");
    if (positive && !(v > 0)) return refuse(set, field, c, v, who, "> 0");
    if (field == MPMI_MASS && v <= 0) return refuse(set, field, c, v, who, "> 0");
    if (mpmi_stored_component(set, field, c) >= 0) continue;
    double is = mpmi_unstored_value(field, c); /* the value that every state of this dimension has */
    if (v < is || v > is)
      return refuse(set, field, c, v, who, is > 0 ? "1 in this dimension" : "0 in this dimension");
  }
  return field == MPMI_F ? check_determinant(set, value, stride, who) : MPM_OK;
}

mpm_status mpmi_check_flags(const mpm_particles *set, int32_t field, const uint8_t *value, int64_t stride,
                            mpmi_who who) {
  for (int32_t c = 0; field == MPMI_PRESCRIBED && c < set->field[field].full_components; ++c)
    if (value[c * stride] > 1) return refuse(set, field, c, value[c * stride], who, "0 or 1");
  return MPM_OK;
}

/* Writes out the tensor of a slot with all its components; other fields are stored as they are copied. */
static void expand(const mpm_particles *set, int32_t field, int64_t slot, double *full) {
  for (int32_t c = 0; c < set->field[field].full_components; ++c) {
    int32_t stored = mpmi_stored_component(set, field, c);
    full[c] = stored < 0 ? mpmi_unstored_value(field, c) : mpmi_f64(set, field, 0)[stored * set->ld + slot];
  }
}

mpm_status mpmi_check_stored(mpm_particles *set, int32_t field) {
  const mpmi_field *at = &set->field[field];
  if (!at->present || (at->type != MPM_F64 && field != MPMI_PRESCRIBED)) return MPM_OK;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int64_t s = 0; s < set->slots; ++s) {
    if (id[s] < 0) continue;
    const mpmi_who who = {"id", id[s]};
    mpm_status status = MPM_OK;
    if (at->type == MPM_U8) {
      if ((status = mpmi_check_flags(set, field, (const uint8_t *)at->data[0] + s, set->ld, who)))
        return status;
      continue;
    }
    double *value = mpmi_f64(set, field, 0) + s, full[9];
    int64_t stride = set->ld;
    if (at->components != at->full_components) {
      expand(set, field, s, full);
      value = full;
      stride = 1;
    }
    if ((status = mpmi_check_value(set, field, value, stride, who))) return status;
    if (field == mpmi_place_field(set->grid)) mpmi_wrap_slot(set, field, s);
  }
  return MPM_OK;
}

mpm_status mpmi_particles_check_suspects(mpm_particles *set) {
  for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f) {
    if (!(set->suspect & 1u << f)) continue;
    mpm_status status = mpmi_check_stored(set, f);
    if (status) return status;
  }
  set->suspect = 0;
  return MPM_OK;
}

mpm_status mpmi_check_exists(const mpm_particles *set, int32_t field) {
  if (set->field[field].present) return MPM_OK;
  if (field == MPMI_REFERENCE)
    return mpmi_fail(set->context, MPM_E_STATE,
                     "there is no reference_position: a stepper with reference_positions = 1 keeps it");
  if (field == MPMI_DILATION_RATIO)
    return mpmi_fail(set->context, MPM_E_STATE,
                     "there is no dilation_ratio: a stepper with locking_remedy = 1 keeps it");
  return MPM_OK;
}

mpm_status mpmi_check_writable(const mpm_particles *set, int32_t field) {
  const mpmi_field *at = &set->field[field];
  if (field == MPMI_STRESS && mpmi_material_kinematics(set->material) == MPMI_F_STAYS)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED, "a rigid material has no stress: it cannot be set");
  if (field == MPMI_STRESS && !at->writable && set->material->state_count)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                     "the stress of this law follows from deformation_gradient and state: set those");
  if (field == MPMI_STRESS && !at->writable)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                     "the stress of this law follows from deformation_gradient: set that");
  if (!at->writable) return mpmi_fail(set->context, MPM_E_ARG, "%s is not for the host to write", at->name);
  return MPM_OK;
}

void mpmi_find_masses(mpm_particles *set) {
  const double *mass = mpmi_f64(set, MPMI_MASS, 0);
  set->mass_max = 0.0;
  for (int64_t s = 0; s < set->slots; ++s) { /* holes have no mass */
    if (mass[s] > set->mass_max) set->mass_max = mass[s];
  }
}

void mpmi_field_written(mpm_particles *set, int32_t field) {
  set->dirty |= MPMI_DIRTY_SUMS;
  if (field == MPMI_ACCELERATION) set->dirty &= ~(uint32_t)MPMI_DIRTY_ACCELERATION;
  if (field == mpmi_place_field(set->grid)) set->dirty |= MPMI_DIRTY_PLACE;
  if (field == MPMI_F || field == MPMI_INITIAL_VOLUME || field == MPMI_DILATION_RATIO)
    set->dirty |= MPMI_DIRTY_STRESS;
  if (mpmi_expands(set) && field == set->thermal.stress_temperature) set->dirty |= MPMI_DIRTY_STRESS;
  if (field == MPMI_STRESS && mpmi_material_mean_from_F(set->material)) set->dirty |= MPMI_DIRTY_STRESS;
  if (field == MPMI_STATE && mpmi_material_stress_from_F(set->material)) set->dirty |= MPMI_DIRTY_STRESS;
  if (field == MPMI_MASS) mpmi_find_masses(set);
}

int32_t mpmi_is_beyond(const mpm_particles *set, int32_t copy, int64_t slot) {
  const mpm_grid *grid = set->grid;
  int32_t beyond = 0;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double x = mpmi_f64(set, MPMI_POSITION, copy)[k * set->ld + slot];
    beyond |= x < grid->desc.origin[k] || x > grid->upper[k];
  }
  return beyond;
}

mpm_status mpmi_settle(mpm_particles *set, int32_t field) {
  if (!(set->dirty & MPMI_DIRTY_STRESS) || (field != MPMI_VOLUME && field != MPMI_STRESS)) return MPM_OK;
  mpm_status status = mpmi_particles_check_suspects(set);
  return status ? status : mpmi_particles_refresh(set);
}
