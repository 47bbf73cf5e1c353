/* How the work of a stage is shared out among tasks. */
#ifndef MPMI_TASKS_H
#define MPMI_TASKS_H

#include "layout/settings.h"

/* Runs task(data, k) for k in [0, count); on the calling thread alone where tasks call a host whose callbacks
 * must stay on it. */
mpm_status mpmi_run_tasks(const mpmi_settings *settings, int32_t calls_host, int64_t count, mpm_task_fn task,
                          void *data);

/* The items [begin, end) of `items` that task k of the stage works on. */
typedef struct mpmi_share {
  int64_t begin, end;
} mpmi_share;
static inline mpmi_share mpmi_share_of(const mpmi_settings *settings, int64_t items, int64_t k) {
  return (mpmi_share){items * k / settings->tasks, items * (k + 1) / settings->tasks};
}
/* Sets task k's share of an array of doubles, `each` per item, to 0. */
void mpmi_clear_share(const mpmi_settings *settings, double *at, int64_t items, int64_t each, int64_t k);

#endif
