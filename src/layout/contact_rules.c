#include "layout/contact_rules.h"
#include "obstacle/contact_desc.h"

#include <string.h>

int64_t mpmi_pair_place(const void *list, size_t each, int64_t count, int32_t a, int32_t b) {
  int64_t low = 0, high = count;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    int32_t pair[2];
    memcpy(pair, (const char *)list + (size_t)middle * each, sizeof pair);
    if (pair[0] < a || (pair[0] == a && pair[1] < b))
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

const mpm_contact_desc *mpmi_contact_rule_at(const mpmi_contact_rules *rules, int32_t a, int32_t b) {
  const int64_t at = mpmi_pair_place(rules->rule, sizeof *rules->rule, rules->count, a, b);
  return at < rules->count && rules->rule[at].a == a && rules->rule[at].b == b ? &rules->rule[at].desc : NULL;
}

const mpm_contact_desc *mpmi_contact_rule_of(const mpmi_contact_rules *rules, int32_t a, int32_t b,
                                             double *sign) {
  const mpm_contact_desc *desc = mpmi_contact_rule_at(rules, a, b);
  *sign = 1.0;
  if (!desc && (desc = mpmi_contact_rule_at(rules, MPM_BODY_ANY, a)))
    *sign = -1.0; /* it is from any other to a */
  if (!desc) desc = mpmi_contact_rule_at(rules, MPM_BODY_ANY, b);
  if (!desc) desc = mpmi_contact_rule_at(rules, MPM_BODY_ANY, MPM_BODY_ANY);
  return desc ? desc : &mpmi_contact_defaults;
}

mpm_status mpmi_contact_rules_set(mpmi_contact_rules *rules, mpm_context *context, int32_t a, int32_t b,
                                  const mpm_contact_desc *desc) {
  const int64_t at = mpmi_pair_place(rules->rule, sizeof *rules->rule, rules->count, a, b);
  const int32_t there = mpmi_contact_rule_at(rules, a, b) != NULL;
  if (!desc) {
    if (!there) return MPM_OK;
    --rules->count;
    memmove(rules->rule + at, rules->rule + at + 1, (size_t)(rules->count - at) * sizeof *rules->rule);
    return MPM_OK;
  }
  if (!there && MPMI_RESERVE_NEXT(context, rules->rule, rules->capacity, rules->count)) return MPM_E_NOMEM;
  if (!there) {
    memmove(rules->rule + at + 1, rules->rule + at, (size_t)(rules->count - at) * sizeof *rules->rule);
    ++rules->count;
  }
  rules->rule[at] = (mpmi_contact_rule){a, b, *desc};
  return MPM_OK;
}

void mpmi_contact_rules_free(mpmi_contact_rules *rules, mpm_context *context) {
  MPMI_FREE_ARRAY(context, rules->rule, rules->capacity);
  *rules = (mpmi_contact_rules){0, 0, NULL};
}

int32_t mpmi_detects_by_velocity(const mpm_contact_desc *desc) {
  return desc->detection == MPM_DETECT_VELOCITY ||
         (desc->detection == MPM_DETECT_DEFAULT && desc->normal == MPM_NORMAL_GRADIENT);
}
