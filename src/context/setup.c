/* Creation of contexts: this checks the host's wishes, chooses the instruction set and starts the pool. */
#include <stdlib.h>
#include <string.h>

#include "context/structs.h"
#include "context/context.h"
#include "platform/platform.h"

enum { MOST_THREADS = 1024 };

static void *default_alloc(void *user, size_t bytes, size_t alignment) {
  (void)user;
  return mpmi_system_alloc(bytes, alignment);
}

static void default_release(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)user, (void)bytes, (void)alignment;
  mpmi_system_release(memory);
}

static mpm_context_desc default_desc(void) {
  mpm_context_desc desc;
  memset(&desc, 0, sizeof desc);
  desc.struct_size = sizeof desc;
  desc.concurrency = 1;
  return desc;
}

mpm_status mpm_context_desc_init(mpm_context_desc *desc, uint32_t struct_size) {
  mpm_context_desc defaults = default_desc();
  return mpmi_init_struct("mpm_context_desc", &defaults, sizeof defaults, desc, struct_size);
}

static int processor_has(int32_t isa) {
#if defined(__x86_64__) && !defined(MPM_BASELINE_ONLY)
  int avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  int avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq");
#else
  int avx2 = 0, avx512 = 0;
#endif
  if (isa == MPM_ISA_AVX512) return avx512;
  if (isa == MPM_ISA_AVX2) return avx2;
  return 1;
}

/* The environment steers only hosts that left the choice to the library. */
static mpm_status wanted_isa(int32_t *isa) {
  const char *text = *isa == MPM_ISA_BEST ? getenv("MPM_ISA") : NULL;
  if (!text || !*text) return MPM_OK;
  if (!strcmp(text, "baseline"))
    *isa = MPM_ISA_BASELINE;
  else if (!strcmp(text, "avx2"))
    *isa = MPM_ISA_AVX2;
  else if (!strcmp(text, "avx512"))
    *isa = MPM_ISA_AVX512;
  else
    return MPM_E_ARG;
  return MPM_OK;
}

static mpm_status resolve_isa(int32_t *isa) {
  if (*isa < MPM_ISA_BEST || *isa > MPM_ISA_AVX512) return MPM_E_ARG;
  mpm_status status = wanted_isa(isa);
  if (status) return status;
  if (*isa == MPM_ISA_BEST) {
    *isa = MPM_ISA_AVX512;
    while (!processor_has(*isa)) --*isa;
  }
  return processor_has(*isa) ? MPM_OK : MPM_E_UNSUPPORTED;
}

static mpm_status resolve_concurrency(int32_t *concurrency) {
  if (*concurrency < 0 || *concurrency > MOST_THREADS) return MPM_E_ARG;
  if (*concurrency) return MPM_OK;
  const int32_t processors = mpmi_processors();
  *concurrency = processors > MOST_THREADS ? MOST_THREADS : processors;
  return MPM_OK;
}

/* Reads the descriptor into `host` and settles what it leaves open. */
static mpm_status resolve(const mpm_context_desc *desc, mpm_context_desc *host) {
  *host = default_desc();
  if (desc) {
    mpm_status status = mpmi_read_struct(NULL, "mpm_context_desc", desc, sizeof *host, host);
    if (status) return status;
  }
  if (!host->alloc != !host->release) return MPM_E_ARG;
  if (host->serial_callbacks != 0 && host->serial_callbacks != 1) return MPM_E_ARG;
  if (!host->alloc) {
    host->alloc = default_alloc;
    host->release = default_release;
  }
  mpm_status status = resolve_concurrency(&host->concurrency);
  return status ? status : resolve_isa(&host->isa);
}

static void free_context(mpm_context *context) {
  mpm_context_desc host = context->host;
  mpmi_pool_destroy(context, context->pool);
  context->magic = 0; /* a handle used after this is refused as long as the memory is not reused */
  host.release(host.alloc_user, context, sizeof *context, MPMI_ALIGNMENT);
}

mpm_status mpm_context_create(const mpm_context_desc *desc, mpm_context **out) {
  if (!out) return MPM_E_ARG;
  *out = NULL;
  /* The context is its own first allocation, so a stand-in counts these bytes and checks their alignment. */
  mpm_context first;
  memset(&first, 0, sizeof first);
  first.magic = MPMI_CONTEXT;
  mpm_status status = resolve(desc, &first.host);
  if (status) return status;
  first.isa = first.host.isa;
  first.concurrency = first.host.concurrency;
  mpm_context *context = mpmi_alloc(&first, sizeof *context);
  if (!context) return MPM_E_NOMEM;
  memcpy(context, &first, sizeof first);
  if (context->concurrency > 1 && !context->host.parallel_for) {
    status = mpmi_pool_create(context, context->concurrency, &context->pool);
    if (status) {
      free_context(context);
      return status;
    }
  }
  static const char *const isa_name[] = {"best", "baseline", "avx2", "avx512"};
  mpmi_log(context, MPM_LOG_INFO, "context: instruction set %s, concurrency %d, %s", isa_name[context->isa],
           (int)context->concurrency,
           context->host.parallel_for ? "the host's executor"
           : context->pool            ? "own threads"
                                      : "no threads");
  *out = context;
  return MPM_OK;
}

mpm_status mpm_context_memory(const mpm_context *context, int64_t *bytes, int64_t *peak_bytes) {
  if (!context || context->magic != MPMI_CONTEXT) return MPM_E_ARG;
  if (bytes) *bytes = context->bytes;
  if (peak_bytes) *peak_bytes = context->peak_bytes;
  return MPM_OK;
}

mpm_status mpm_context_destroy(mpm_context *context) {
  if (!context) return MPM_OK;
  if (context->magic != MPMI_CONTEXT) return MPM_E_ARG;
  if (context->children)
    return mpmi_fail(context, MPM_E_STATE, "%d objects of the context still live: destroy them first",
                     (int)context->children);
  free_context(context);
  return MPM_OK;
}
