/* Finds built-in laws, and describes them to the host. */
#include <string.h>

#include "material/laws.h"

const mpmi_law *mpmi_law_of(int32_t isa, int32_t place) {
#define ENTRY(name) MPMI_TABLE_OF(isa, mpmi_law_##name),
  const mpmi_law *const laws[MPMI_LAW_COUNT] = {MPMI_LAWS(ENTRY)};
  return place >= 0 && place < MPMI_LAW_COUNT ? laws[place] : NULL;
}

const mpmi_law *mpmi_law_by_name(int32_t isa, const char *name) {
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
  const mpmi_law *law = mpmi_law_by_name(MPM_ISA_BASELINE, model);
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
