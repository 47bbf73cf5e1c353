/* Memory from the host's allocator, which is counted. There are no locks, because only the thread that calls
 * the library allocates. */
#include <string.h>

#include "context/context.h"
#include "context/slack.h"

/* A request of 0 bytes takes one line, so that every result is a valid pointer of its own. */
static size_t granted(size_t bytes) {
  return bytes ? bytes : MPMI_ALIGNMENT;
}

void *mpmi_alloc(mpm_context *context, size_t bytes) {
  const mpm_context_desc *host = &context->host;
  size_t size = granted(bytes);
  if (size > PTRDIFF_MAX) {
    mpmi_fail(context, MPM_E_NOMEM, "out of memory: the request does not fit the address space");
    return NULL;
  }
  void *memory = host->alloc(host->alloc_user, size, MPMI_ALIGNMENT);
  mpmi_environment_mend();
  if (!memory) {
    mpmi_fail(context, MPM_E_NOMEM, "out of memory: %llu bytes refused, %lld held", (unsigned long long)size,
              (long long)context->bytes);
    return NULL;
  }
  /* Kernels use aligned loads: a careless allocator would crash there, far from the cause. */
  if ((uintptr_t)memory % MPMI_ALIGNMENT) {
    host->release(host->alloc_user, memory, size, MPMI_ALIGNMENT);
    mpmi_environment_mend();
    mpmi_fail(context, MPM_E_NOMEM, "the host's alloc returned memory that is not aligned to %d bytes",
              MPMI_ALIGNMENT);
    return NULL;
  }
  context->bytes += (int64_t)size;
  if (context->bytes > context->peak_bytes) context->peak_bytes = (int64_t)context->bytes;
  return memory;
}

void *mpmi_alloc_zeroed(mpm_context *context, size_t bytes) {
  void *memory = mpmi_alloc(context, bytes);
  if (memory) memset(memory, 0, bytes);
  return memory;
}

void mpmi_free(mpm_context *context, void *memory, size_t bytes) {
  if (!memory) return;
  const mpm_context_desc *host = &context->host;
  size_t size = granted(bytes);
  context->bytes -= (int64_t)size;
  mpmi_slack(memory, size, size);
  host->release(host->alloc_user, memory, size, MPMI_ALIGNMENT);
  mpmi_environment_mend();
}

size_t mpmi_bytes(int64_t count, size_t size) {
  if (count < 0 || (size && (uint64_t)count > SIZE_MAX / size)) return SIZE_MAX;
  return (size_t)count * size;
}

mpm_status mpmi_reserve(mpm_context *context, void **at, int64_t *capacity, int64_t wanted, size_t size) {
  if (wanted > *capacity) {
    void *memory = mpmi_alloc(context, mpmi_bytes(wanted, size));
    if (!memory) return MPM_E_NOMEM;
    mpmi_free(context, *at, mpmi_bytes(*capacity, size));
    *at = memory;
    *capacity = wanted;
  }
  mpmi_slack(*at, mpmi_bytes(*capacity, size), mpmi_bytes(wanted, size));
  return MPM_OK;
}

mpm_status mpmi_reserve_next(mpm_context *context, void **at, int64_t *capacity, int64_t count, size_t size) {
  if (count < *capacity) {
    mpmi_slack_open(*at, mpmi_bytes(count + 1, size));
    return MPM_OK;
  }
  const int64_t wanted = count ? 2 * count : 4;
  void *memory = mpmi_alloc(context, mpmi_bytes(wanted, size));
  if (!memory) return MPM_E_NOMEM;
  if (count) memcpy(memory, *at, mpmi_bytes(count, size));
  mpmi_free(context, *at, mpmi_bytes(*capacity, size));
  *at = memory;
  *capacity = wanted;
  return MPM_OK;
}

mpm_status mpmi_reserve_more(mpm_context *context, void **at, int64_t *capacity, int64_t wanted,
                             size_t size) {
  const int64_t few = 64; /* short lists double soon */
  const mpm_status status =
      mpmi_reserve(context, at, capacity, wanted > *capacity ? wanted + wanted / 4 + few : wanted, size);
  if (!status) mpmi_slack(*at, mpmi_bytes(*capacity, size), mpmi_bytes(wanted, size));
  return status;
}
