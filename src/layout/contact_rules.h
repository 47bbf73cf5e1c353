/* How bodies meet: the rules that the host has set, for pairs, for one body with all others, and for all. */
#ifndef MPMI_CONTACT_RULES_H
#define MPMI_CONTACT_RULES_H

#include "grid/blocks.h"

/* The lower body comes first, and direction is that from it; MPM_BODY_ANY, which is lower than all, stands
 * for any other. */
typedef struct mpmi_contact_rule {
  int32_t a, b;
  mpm_contact_desc desc;
} mpmi_contact_rule;

typedef struct mpmi_contact_rules {
  int64_t count, capacity;
  mpmi_contact_rule *rule; /* ordered by (a, b) */
} mpmi_contact_rules;

/* Returns the rule of two bodies, a < b: the closest one, or the defaults. *sign becomes -1 where its
 * direction is that from b to a, else 1. */
const mpm_contact_desc *mpmi_contact_rule_of(const mpmi_contact_rules *rules, int32_t a, int32_t b,
                                             double *sign);
/* Returns the place of a pair in a list that is ordered by pairs, or where it would have to be inserted. Each
 * item begins with the numbers of its two bodies. */
int64_t mpmi_pair_place(const void *list, size_t each, int64_t count, int32_t a, int32_t b);
/* Returns the rule that was set for just this pair, a <= b, or NULL. */
const mpm_contact_desc *mpmi_contact_rule_at(const mpmi_contact_rules *rules, int32_t a, int32_t b);
/* Sets the rule of a pair, a <= b, or takes it back where desc is NULL. */
mpm_status mpmi_contact_rules_set(mpmi_contact_rules *rules, mpm_context *context, int32_t a, int32_t b,
                                  const mpm_contact_desc *desc);
void mpmi_contact_rules_free(mpmi_contact_rules *rules, mpm_context *context);
/* Returns 1 when contact is to be found by velocity alone. */
int32_t mpmi_detects_by_velocity(const mpm_contact_desc *desc);

#endif
