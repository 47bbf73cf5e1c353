/* Materials as handles: a built-in law with checked parameters, or the host's callbacks. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "context/structs.h"
#include "material/laws.h"
#include "material/material.h"

enum { MAX_STATE_COUNT = 64 };

/* ---- the built-in laws ------------------------------------------------------------------------------- */
const mpmi_law *mpmi_law_of(int32_t isa, int32_t place) {
#define ENTRY(name) MPMI_TABLE_OF(isa, mpmi_law_##name),
  const mpmi_law *const laws[MPMI_LAW_COUNT] = {MPMI_LAWS(ENTRY)};
  return place >= 0 && place < MPMI_LAW_COUNT ? laws[place] : NULL;
}

static const mpmi_law *law_by_name(int32_t isa, const char *name) {
  for (int32_t i = 0; i < MPMI_LAW_COUNT; ++i)
    if (!strcmp(mpmi_law_of(isa, i)->name, name)) return mpmi_law_of(isa, i);
  return NULL;
}

int32_t mpm_material_model_count(void) {
  return MPMI_LAW_COUNT;
}

/* Descriptions do not depend on the instruction set. */
const char *mpm_material_model_name(int32_t index) {
  const mpmi_law *law = mpmi_law_of(MPM_ISA_BASELINE, index);
  return law ? law->name : NULL;
}

mpm_status mpm_material_model_param(const char *model, int32_t index, const char **name, const char **unit,
                                    const char **text, double *value_default, double *low, double *high) {
  if (!model || index < 0) return MPM_E_ARG;
  const mpmi_law *law = law_by_name(MPM_ISA_BASELINE, model);
  if (!law) return MPM_E_NOT_FOUND;
  if (index >= law->param_count) return MPM_E_NOT_FOUND;
  const mpmi_law_param *param = &law->param[index];
  if (name) *name = param->name;
  if (unit) *unit = param->unit;
  if (text) *text = param->text;
  if (value_default) *value_default = param->value;
  if (low) *low = param->low;
  if (high) *high = param->high;
  return MPM_OK;
}

int32_t mpm_material_state_count(const char *model) {
  const mpmi_law *law = model ? law_by_name(MPM_ISA_BASELINE, model) : NULL;
  return law ? law->state_count : -1;
}

mpm_status mpm_material_state_name(const char *model, int32_t index, const char **name, const char **unit,
                                   const char **text) {
  if (!model || index < 0) return MPM_E_ARG;
  const mpmi_law *law = law_by_name(MPM_ISA_BASELINE, model);
  if (!law || index >= law->state_count) return MPM_E_NOT_FOUND;
  if (name) *name = law->state[index].name;
  if (unit) *unit = law->state[index].unit;
  if (text) *text = law->state[index].text;
  return MPM_OK;
}

/* ---- handles ----------------------------------------------------------------------------------------- */
static mpm_status refuse_model(mpm_context *context, const char *model) {
  const char *names[MPMI_LAW_COUNT];
  for (int32_t i = 0; i < MPMI_LAW_COUNT; ++i) names[i] = mpm_material_model_name(i);
  return mpmi_refuse_name(context, "no model", model, names, MPMI_LAW_COUNT);
}

static mpm_status refuse_param(mpm_context *context, const mpmi_law *law, const char *name) {
  const size_t bytes = mpmi_bytes(law->param_count, sizeof(char *));
  const char **names = mpmi_alloc(context, bytes);
  if (!names) return MPM_E_NOMEM;
  for (int32_t k = 0; k < law->param_count; ++k) names[k] = law->param[k].name;
  char refusal[96];
  snprintf(refusal, sizeof refusal, "%s has no parameter", law->name);
  const mpm_status status = mpmi_refuse_name(context, refusal, name, names, law->param_count);
  mpmi_free(context, names, bytes);
  return status;
}

static mpm_status read_param(mpm_context *context, const mpmi_law *law, const mpm_param *params, int32_t i,
                             double *value) {
  const char *name = params[i].name;
  if (!name) return mpmi_fail(context, MPM_E_ARG, "%s: params[%d].name is NULL", law->name, i);
  int32_t k = 0;
  while (k < law->param_count && strcmp(law->param[k].name, name) != 0) ++k;
  if (k == law->param_count) return refuse_param(context, law, name);
  for (int32_t before = 0; before < i; ++before)
    if (!strcmp(params[before].name, name))
      return mpmi_fail(context, MPM_E_ARG, "%s: parameter \"%s\" is given twice", law->name, name);
  value[k] = params[i].value;
  const mpmi_law_param *param = &law->param[k];
  if (!(value[k] >= param->low && value[k] <= param->high) || (param->whole && value[k] != floor(value[k])))
    return mpmi_fail(context, MPM_E_ARG, "%s: %s = %.17g, but it %s", law->name, name, value[k],
                     param->range);
  return MPM_OK;
}

static mpm_status read_params(mpm_context *context, const mpmi_law *law, const mpm_param *params,
                              int32_t count, double *value) {
  for (int32_t k = 0; k < law->param_count; ++k) value[k] = law->param[k].value;
  for (int32_t i = 0; i < count; ++i) {
    const mpm_status status = read_param(context, law, params, i, value);
    if (status) return status;
  }
  for (int32_t k = 0; k < law->param_count; ++k)
    if (isnan(value[k]))
      return mpmi_fail(context, MPM_E_ARG, "%s: parameter \"%s\" (%s) must be given", law->name,
                       law->param[k].name, law->param[k].text);
  return MPM_OK;
}

/* Parameters may be fine one by one and still overflow together, such as 1e300 / 1e-300. */
static mpm_status prepare_constants(mpm_context *context, const mpmi_law *law, const double *value,
                                    double *constants) {
  if (law->prepare) law->prepare(value, constants);
  for (size_t i = 0; i < law->constants_size / sizeof *constants; ++i)
    if (!isfinite(constants[i]))
      return mpmi_fail(context, MPM_E_ARG,
                       "%s: the parameters together are beyond the range of double precision", law->name);
  const char *wrong = law->check ? law->check(value) : NULL;
  if (wrong) return mpmi_fail(context, MPM_E_ARG, "%s: %s", law->name, wrong);
  return MPM_OK;
}

/* Allocates a material with room for further bytes in its `memory`. */
static mpm_material *make(mpm_context *context, size_t further) {
  const size_t size = sizeof(mpm_material) + further;
  mpm_material *material = mpmi_alloc(context, size);
  if (material) *material = (mpm_material){.magic = MPMI_MATERIAL, .context = context, .size = size};
  return material;
}

/* Fills a material with the values and constants of a built-in law. */
static mpm_status set_law(mpm_material *material, const mpmi_law *law, const mpm_param *params,
                          int32_t count) {
  double *value = material->memory, *constants = value + law->param_count;
  mpm_status status = read_params(material->context, law, params, count, value);
  if (!status) status = prepare_constants(material->context, law, value, constants);
  if (status) return status;
  material->law = law;
  material->value = value;
  material->constants = constants;
  material->state_count = law->state_count;
  if (law->start) {
    double *initial = constants + law->constants_size / sizeof *constants;
    law->start(value, initial);
    material->state_initial = initial;
  }
  for (int32_t k = 0; k < law->param_count; ++k)
    if (!strcmp(law->param[k].name, "density")) material->density = value[k];
  return MPM_OK;
}

mpm_status mpm_material_create(mpm_context *context, const char *model, const mpm_param *params,
                               int32_t count, mpm_material **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  if (!out) return mpmi_fail(context, MPM_E_ARG, "mpm_material_create: out is NULL");
  if (!model) return mpmi_fail(context, MPM_E_ARG, "mpm_material_create: model is NULL");
  const mpmi_law *law = law_by_name(context->isa, model);
  if (!law) return refuse_model(context, model);
  if (count < 0) return mpmi_fail(context, MPM_E_ARG, "%s: count = %d is negative", model, count);
  if (count > 0 && !params)
    return mpmi_fail(context, MPM_E_ARG, "%s: params is NULL, but count is %d", model, count);

  const int64_t kept = law->param_count + (law->start ? law->state_count : 0);
  mpm_material *material = make(context, mpmi_bytes(kept, sizeof(double)) + law->constants_size);
  if (!material) return MPM_E_NOMEM;
  const mpm_status status = set_law(material, law, params, count);
  if (status) {
    mpmi_free(context, material, material->size);
    return status;
  }
  context->children++;
  *out = material;
  return MPM_OK;
}

mpm_status mpm_material_desc_init(mpm_material_desc *desc, uint32_t struct_size) {
  const mpm_material_desc defaults = {.struct_size = sizeof defaults,
                                      .tangent_form = MPM_TANGENT_MINOR_SYMMETRIC};
  return mpmi_init_struct("mpm_material_desc", &defaults, sizeof defaults, desc, struct_size);
}

static mpm_status check_desc(mpm_context *context, const mpm_material_desc *d) {
  if (!(d->density > 0.0 && isfinite(d->density)))
    return mpmi_fail(context, MPM_E_ARG, "mpm_material_desc: density = %.17g must be finite and > 0",
                     d->density);
  if (!d->stress) return mpmi_fail(context, MPM_E_ARG, "mpm_material_desc: stress is NULL");
  if (d->state_count < 0 || d->state_count > MAX_STATE_COUNT)
    return mpmi_fail(context, MPM_E_ARG, "mpm_material_desc: state_count = %d must be 0 to %d",
                     d->state_count, MAX_STATE_COUNT);
  int32_t form = d->tangent_form;
  if (form != MPM_TANGENT_MINOR_SYMMETRIC && form != MPM_TANGENT_GENERAL && (form != 0 || d->tangent))
    return mpmi_fail(context, MPM_E_ARG, "mpm_material_desc: tangent_form = %d must be %d or %d", form,
                     MPM_TANGENT_MINOR_SYMMETRIC, MPM_TANGENT_GENERAL);
  for (int32_t k = 0; d->state_initial && k < d->state_count; ++k)
    if (!isfinite(d->state_initial[k]))
      return mpmi_fail(context, MPM_E_ARG, "mpm_material_desc: state_initial[%d] = %g must be finite", k,
                       d->state_initial[k]);
  return MPM_OK;
}

mpm_status mpm_material_create_custom(mpm_context *context, const mpm_material_desc *desc,
                                      mpm_material **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  if (!out) return mpmi_fail(context, MPM_E_ARG, "mpm_material_create_custom: out is NULL");
  mpm_material_desc custom;
  mpm_status status = mpmi_read_struct(context, "mpm_material_desc", desc, sizeof custom, &custom);
  if (!status) status = check_desc(context, &custom);
  if (status) return status;

  /* The initial state is copied, because the caller's array may be gone tomorrow. */
  const int32_t kept = custom.state_initial ? custom.state_count : 0;
  const size_t bytes = mpmi_bytes(kept, sizeof(double));
  mpm_material *material = make(context, bytes);
  if (!material) return MPM_E_NOMEM;
  material->density = custom.density;
  material->state_count = custom.state_count;
  material->custom = custom;
  if (kept > 0) material->state_initial = memcpy(material->memory, custom.state_initial, bytes);
  material->custom.state_initial = material->state_initial;
  context->children++;
  *out = material;
  return MPM_OK;
}

mpm_status mpm_material_destroy(mpm_material *material) {
  if (!material) return MPM_OK;
  MPMI_ENTER(material, MPMI_MATERIAL);
  mpm_context *context = material->context;
  if (material->users > 0)
    return mpmi_fail(context, MPM_E_STATE, "the material is still used by %d set(s) of particles",
                     material->users);
  if (material->custom.release_user) {
    material->custom.release_user(material->custom.user);
    mpmi_environment_mend();
  }
  material->magic = 0;
  mpmi_free(context, material, material->size);
  context->children--;
  return MPM_OK;
}

mpm_status mpmi_material_evaluate(const mpm_material *material, int32_t dim,
                                  const mpm_material_batch *batch) {
  if (!material->law) return mpmi_from_host(material->custom.stress(material->custom.user, batch));
  material->law->stress(material->constants, dim, batch);
  return MPM_OK;
}

void mpmi_material_evaluate_stored(const mpm_material *material, const mpm_material_batch *batch) {
  material->law->plane_stored(material->constants, 2, batch);
}

int32_t mpmi_may_be_viscous(const mpm_material *material) {
  return material->law ? material->law->viscous : 1;
}

int32_t mpmi_material_stress_from_F(const mpm_material *material) {
  return material->law ? material->law->stress_from_F : 0;
}

int32_t mpmi_material_mean_from_F(const mpm_material *material) {
  return material->law ? material->law->mean_from_F : 0;
}

int32_t mpmi_material_kinematics(const mpm_material *material) {
  return material->law ? material->law->kinematics : MPMI_F_DEFORMS;
}

int32_t mpmi_material_pressure_from_shear(const mpm_material *material) {
  return material->law ? material->law->pressure_from_shear : 0;
}
