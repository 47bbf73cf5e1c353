/* What ends a step early. Failures of tasks are collected; the first decides, so that reports repeat. */
#ifndef MPMI_FAILURE_H
#define MPMI_FAILURE_H

#include "context/context.h"

/* The first failure: smallest (set, particle), then node. */
typedef struct mpmi_failure {
  mpm_status cause;
  int32_t callback_status, set;
  int64_t particle, node;
  const char *what;
} mpmi_failure;

void mpmi_failure_clear(mpmi_failure *failure);
/* Takes the other one where it comes before what is there. */
void mpmi_failure_take(mpmi_failure *first, const mpmi_failure *other);
/* What a callback's status makes of the step: > 0 cuts dt, < 0 stops it. */
mpm_status mpmi_callback_cause(mpm_status status);
/* The status of a step from t over dt that fails so, with its sentence. */
mpm_status mpmi_failure_report(mpm_context *context, const mpmi_failure *failure, double t, double dt);

#endif
