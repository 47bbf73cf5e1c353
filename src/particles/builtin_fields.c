/* This file has the table of built-in fields, and the maps between stored and full components. */
#include <string.h>

#include "particles/builtin_fields.h"

enum { SCALAR, VECTOR, TENSOR, GRADIENT, STRESS, STATE };

typedef struct builtin_field {
  const char *name;
  int32_t type, shape, writable, two_copies, present;
} builtin_field;

/* Law and grid decide whether "stress" is writable and whether "state" and "image" are present. */
static const builtin_field builtin[MPMI_BUILTIN_FIELDS] = {
    [MPMI_ID] = {"id", MPM_I64, SCALAR, 0, 0, 1},
    [MPMI_POSITION] = {"position", MPM_F64, VECTOR, 1, 1, 1},
    [MPMI_VELOCITY] = {"velocity", MPM_F64, VECTOR, 1, 1, 1},
    [MPMI_ACCELERATION] = {"acceleration", MPM_F64, VECTOR, 1, 1, 0},
    [MPMI_MASS] = {"mass", MPM_F64, SCALAR, 1, 0, 1},
    [MPMI_VOLUME] = {"volume", MPM_F64, SCALAR, 0, 0, 1},
    [MPMI_INITIAL_VOLUME] = {"initial_volume", MPM_F64, SCALAR, 1, 0, 1},
    [MPMI_SIZE] = {"size", MPM_F64, VECTOR, 1, 0, 0},
    [MPMI_F] = {"deformation_gradient", MPM_F64, TENSOR, 1, 1, 1},
    [MPMI_L] = {"velocity_gradient", MPM_F64, GRADIENT, 1, 1, 0},
    [MPMI_STRESS] = {"stress", MPM_F64, STRESS, 0, 1, 1},
    [MPMI_STATE] = {"state", MPM_F64, STATE, 1, 1, 0},
    [MPMI_REFERENCE] = {"reference_position", MPM_F64, VECTOR, 1, 0, 0},
    [MPMI_PRESCRIBED] = {"prescribed", MPM_U8, VECTOR, 1, 0, 0},
    [MPMI_APPLIED_FORCE] = {"applied_force", MPM_F64, VECTOR, 1, 0, 0},
    [MPMI_IMAGE] = {"image", MPM_I64, VECTOR, 0, 1, 0},
    [MPMI_DILATION_RATIO] = {"dilation_ratio", MPM_F64, SCALAR, 1, 1, 0},
};

size_t mpmi_type_size(int32_t type) {
  return type == MPM_U8 ? sizeof(uint8_t) : sizeof(double);
}

int32_t mpmi_tensor_components(int32_t dim) {
  return dim == 1 ? 1 : dim == 2 ? 5 : 9;
}

int32_t mpmi_gradient_components(int32_t dim) {
  return dim * dim;
}

/* The map of 1-D is the first entry of the map of 2-D; gradients use the first 1, 4 or 9 entries. */
static const int32_t plane_map[] = {0, 1, 3, 4, 8};
static const int32_t whole_map[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};

const int32_t *mpmi_tensor_map(int32_t dim) {
  return dim == 3 ? whole_map : plane_map;
}

const int32_t *mpmi_gradient_map(int32_t dim) {
  return mpmi_tensor_map(dim);
}

static int32_t shape_components(int32_t shape, int32_t dim, int32_t state_count) {
  switch (shape) {
  case SCALAR:
    return 1;
  case VECTOR:
    return dim;
  case TENSOR:
    return mpmi_tensor_components(dim);
  case GRADIENT:
    return mpmi_gradient_components(dim);
  case STRESS:
    return mpmi_stress_components(dim);
  default:
    return state_count;
  }
}

void mpmi_fields_builtin(mpm_particles *set) {
  int32_t dim = set->grid->dim, state_count = set->material->state_count;
  const int32_t *periodic = set->grid->desc.periodic;
  for (int32_t f = 0; f < MPMI_BUILTIN_FIELDS; ++f) {
    const builtin_field *from = &builtin[f];
    mpmi_field *field = &set->field[f];
    memcpy(field->name, from->name, strlen(from->name) + 1);
    field->type = from->type;
    field->components = shape_components(from->shape, dim, state_count);
    /* Full tensors have three dimensions, full vectors those of the grid. */
    field->full_components = shape_components(from->shape, from->shape == VECTOR ? dim : 3, state_count);
    field->writable = from->writable;
    field->two_copies = from->two_copies;
    field->present = from->present;
    field->extensive =
        f == MPMI_MASS || f == MPMI_VOLUME || f == MPMI_INITIAL_VOLUME || f == MPMI_APPLIED_FORCE;
  }
  set->field[MPMI_STRESS].writable = !mpmi_material_stress_from_F(set->material);
  set->field[MPMI_SIZE].present = mpmi_has_sizes(set->grid);
  set->field[MPMI_STATE].present = state_count > 0;
  /* positions of total Lagrangian grids are not wrapped: their reference stays where it is */
  set->field[MPMI_REFERENCE].present = mpmi_is_total_lagrangian(set->grid);
  set->field[MPMI_IMAGE].present =
      (periodic[0] || periodic[1] || periodic[2]) && !mpmi_is_total_lagrangian(set->grid);
  set->field_count = MPMI_BUILTIN_FIELDS;
}

int32_t mpmi_stored_component(const mpm_particles *set, int32_t field, int32_t c) {
  int32_t stored = set->field[field].components;
  if (field != MPMI_F && field != MPMI_L) return c < stored ? c : -1;
  const int32_t *map = mpmi_tensor_map(set->grid->dim);
  for (int32_t s = 0; s < stored; ++s)
    if (map[s] == c) return s;
  return -1;
}

double mpmi_unstored_value(int32_t field, int32_t c) {
  return field == MPMI_F && c % 4 == 0 ? 1.0 : 0.0;
}

int32_t mpmi_find_field(const mpm_particles *set, const char *name) {
  for (int32_t f = 0; f < set->field_count; ++f)
    if (!strcmp(set->field[f].name, name)) return f;
  return -1;
}

mpm_status mpmi_require_field(const mpm_particles *set, const char *name, int32_t *field) {
  if (!name) return mpmi_fail(set->context, MPM_E_ARG, "field is NULL");
  *field = mpmi_find_field(set, name);
  if (*field >= 0) return MPM_OK;
  const char *names[MPMI_MAX_FIELDS];
  for (int32_t f = 0; f < set->field_count; ++f) names[f] = set->field[f].name;
  return mpmi_refuse_name(set->context, "the set has no field", name, names, set->field_count);
}
