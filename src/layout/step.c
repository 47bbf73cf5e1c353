#include "layout/step.h"

void mpmi_failures_clear(mpmi_step *step) {
  mpmi_failure_clear(&step->failure);
  for (int32_t k = 0; k < step->settings->tasks; ++k) mpmi_failure_clear(&step->work->report[k].failure);
}

mpm_status mpmi_step_failure(mpmi_step *step) {
  for (int32_t k = 0; k < step->settings->tasks; ++k)
    mpmi_failure_take(&step->failure, &step->work->report[k].failure);
  return mpmi_failure_report(step->settings->context, &step->failure, step->t, step->dt);
}
