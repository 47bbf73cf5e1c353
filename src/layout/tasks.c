#include "layout/tasks.h"

#include <string.h>

mpm_status mpmi_run_tasks(const mpmi_settings *settings, int32_t calls_host, int64_t count, mpm_task_fn task,
                          void *data) {
  mpm_context *c = settings->context;
  if (count > 1 && !(calls_host && (c->host.serial_callbacks || c->concurrency == 1)))
    return mpmi_parallel_for(c, count, task, data);
  for (int64_t k = 0; k < count; ++k) task(data, k);
  return MPM_OK;
}

void mpmi_clear_share(const mpmi_settings *settings, double *at, int64_t items, int64_t each, int64_t k) {
  const mpmi_share share = mpmi_share_of(settings, items, k);
  if (share.end > share.begin) /* an empty array may be NULL */
    memset(at + each * share.begin, 0, (size_t)(each * (share.end - share.begin)) * sizeof *at);
}
