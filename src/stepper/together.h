/* What the parts of a problem do together in a step, beside the exchange of sums on nodes: they agree before
 * it, and once it has been computed they learn whether it is so on all of them, and what it comes to. With
 * one part nothing is done. */
#ifndef MPMI_TOGETHER_H
#define MPMI_TOGETHER_H

#include "stepper/stepper.h"

static inline int32_t mpmi_is_shared(const mpm_stepper *s) {
  return s->layout.parts != NULL;
}
/* All parts learn whether all have MPM_OK: mpmi_agree() where there are several. */
mpm_status mpmi_together(const mpm_stepper *s, mpm_status status);
/* The same within a step: all parts also have the numbers of the first part's failure. */
mpm_status mpmi_together_ready(mpm_stepper *s, mpm_status status);
/* Numbers that must be alike on all parts: each takes two words, of which the largest of all parts are
 * wanted; then those that are not are refused on all: MPM_E_ARG. */
void mpmi_put_number(int64_t *word, double number);
mpm_status mpmi_check_alike(const mpm_stepper *s, int32_t count, const char *const *name,
                            const double *number, const int64_t *word);
/* Begins a call: all parts have a status, and numbers that must be alike; what has been changed on one of
 * them counts as changed on all. names: of the numbers. */
mpm_status mpmi_together_begin(mpm_stepper *s, mpm_status status, int32_t count, const char *const *name,
                               const double *number);
/* Refuses what several parts cannot do. */
mpm_status mpmi_together_offers(mpm_stepper *s);
/* A step has brought its sets up to date: where it will sort, all parts must have. */
mpm_status mpmi_together_refreshed(mpm_stepper *s, mpm_status status);
/* All parts are ready for a step: they get to know the pairs of bodies that may touch, and the particles
 * around nodes at which these meet (contact_together.c). */
mpm_status mpmi_together_touching(mpm_stepper *s);
/* Adds up what pairs of bodies have done to each other. */
mpm_status mpmi_together_touched(mpm_stepper *s);
/* A step, or a part of one, has been computed with so many exchanges, or has failed. Where it has failed on
 * any part, all have the status, the text and the numbers of the first failure. */
mpm_status mpmi_together_end(mpm_stepper *s, mpm_status status, int64_t exchanges);
/* The same within a step that goes on, even where it has failed; exchanges are counted from here on. */
mpm_status mpmi_together_vote(mpm_stepper *s, mpm_status status, int64_t exchanges);
/* Makes the active nodes of a step that has failed those of all parts. */
mpm_status mpmi_together_active(mpm_stepper *s);
/* Makes the rates the largest of all parts. */
mpm_status mpmi_together_rates(mpm_stepper *s, mpmi_sums *rates);
/* Makes the totals of what is to be reported, and of how many particles leave. */
mpm_status mpmi_together_total(mpm_stepper *s, mpmi_sums *rates);

#endif
