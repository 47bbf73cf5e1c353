/* The doors of the library: a public call opens an entry, which is closed on every way out. */
#include "context/context.h"

static const char in_use[] =
    "another call on the same context is under way: of its objects a callback may use mpm_operator_*, "
    "mpm_batch_field() and mpm_particles_count() only, and the threads of a host take turns";

/* Any thread may be refused at any time, so that the sentence must be there already. */
static mpm_status refuse(mpmi_entry *entry, mpm_context *context) {
  entry->busy = NULL;
  entry->open = 0;
  atomic_store(&context->error, in_use);
  return MPM_E_STATE;
}

mpm_status mpmi_enter_lent(mpmi_entry *entry, mpm_context *context, _Atomic uint32_t *busy) {
  if (atomic_exchange(busy, 1)) return refuse(entry, context);
  entry->busy = busy;
  entry->context = NULL;
  entry->open = 1;
  mpmi_environment_enter(&entry->host);
  return MPM_OK;
}

mpm_status mpmi_enter(mpmi_entry *entry, mpm_context *context) {
  const mpm_status status = mpmi_enter_lent(entry, context, &context->busy);
  if (status) return status;
  entry->context = context;
  context->kept = atomic_load(&context->error);
  context->said = NULL;
  context->pool_runs = 0;
  return MPM_OK;
}

void mpmi_leave(mpmi_entry *entry) {
  /* after its failure a call from one of its callbacks may have been refused */
  if (entry->busy && entry->context && entry->context->said)
    atomic_store(&entry->context->error, entry->context->said);
  if (entry->busy) atomic_store(entry->busy, 0);
  if (entry->open) mpmi_environment_leave(&entry->host);
}

mpm_status mpmi_from_host(mpm_status returned) {
  mpmi_environment_mend();
  return returned;
}
