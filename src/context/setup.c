/* Creation of contexts: this checks the host's wishes, chooses the instruction set and starts the pool. */
#include <stdlib.h>
#include <string.h>

#include "context/structs.h"
#include "context/context.h"
#include "context/transport.h"
#include "platform/platform.h"

enum { MOST_THREADS = 1024 };

static const char *const isa_name[] = {"best", "baseline", "avx2", "avx512", "neon"}; /* by MPM_ISA_... */

static void *default_alloc(void *user, size_t bytes, size_t alignment) {
  (void)user;
  return mpmi_system_alloc(bytes, alignment);
}

static void default_release(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)user;
  mpmi_system_release(memory, bytes, alignment);
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
#if defined(__aarch64__) && !defined(MPM_BASELINE_ONLY)
  const int neon = 1; /* all of them have it */
#else
  const int neon = 0;
#endif
  if (isa == MPM_ISA_AVX512) return avx512;
  if (isa == MPM_ISA_AVX2) return avx2;
  if (isa == MPM_ISA_NEON) return neon;
  return 1;
}

/* The environment steers only hosts that left the choice to the library. */
static mpm_status wanted_isa(mpm_context *context, int32_t *isa) {
  const char *text = *isa == MPM_ISA_BEST ? getenv("MPM_ISA") : NULL;
  if (!text || !*text) return MPM_OK;
  if (!strcmp(text, "portable")) text = isa_name[MPM_ISA_PORTABLE];
  for (int32_t k = MPM_ISA_BASELINE; k <= MPM_ISA_NEON; ++k)
    if (!strcmp(text, isa_name[k])) {
      *isa = k;
      return MPM_OK;
    }
  return mpmi_fail(context, MPM_E_ARG,
                   "the variable MPM_ISA is \"%.80s\", must be portable, baseline, avx2, avx512 or neon",
                   text);
}

static mpm_status resolve_isa(mpm_context *context, int32_t *isa) {
  if (*isa < MPM_ISA_BEST || *isa > MPM_ISA_NEON)
    return mpmi_fail(context, MPM_E_ARG, "mpm_context_desc: isa is %d, which is none of the constants",
                     (int)*isa);
  mpm_status status = wanted_isa(context, isa);
  if (status) return status;
  if (*isa == MPM_ISA_BEST) {
    *isa = MPM_ISA_NEON;
    while (!processor_has(*isa)) --*isa;
  }
  if (processor_has(*isa)) return MPM_OK;
  return mpmi_fail(context, MPM_E_UNSUPPORTED,
                   "processor or library lack the instruction set %s: use MPM_ISA_BEST or MPM_ISA_BASELINE",
                   isa_name[*isa]);
}

static mpm_status resolve_concurrency(mpm_context *context, int32_t *concurrency) {
  if (*concurrency < 0 || *concurrency > MOST_THREADS)
    return mpmi_fail(context, MPM_E_ARG, "mpm_context_desc: concurrency is %d, must be 0 to %d",
                     (int)*concurrency, (int)MOST_THREADS);
  if (*concurrency) return MPM_OK;
  const int32_t processors = mpmi_processors();
  *concurrency = processors > MOST_THREADS ? MOST_THREADS : processors;
  return MPM_OK;
}

/* Checks the descriptor and settles what it leaves open. */
static mpm_status resolve(mpm_context *context, mpm_context_desc *host) {
  if (!host->alloc != !host->release)
    return mpmi_fail(context, MPM_E_ARG, "mpm_context_desc: %s is set without %s",
                     host->alloc ? "alloc" : "release", host->alloc ? "release" : "alloc");
  if (host->serial_callbacks != 0 && host->serial_callbacks != 1)
    return mpmi_fail(context, MPM_E_ARG, "mpm_context_desc: serial_callbacks is %d, must be 0 or 1",
                     (int)host->serial_callbacks);
  if (!host->error_text != !host->error_bytes)
    return mpmi_fail(context, MPM_E_ARG, "mpm_context_desc: error_text is %s, but error_bytes is %llu",
                     host->error_text ? "set" : "NULL", (unsigned long long)host->error_bytes);
  if (!host->alloc) {
    host->alloc = default_alloc;
    host->release = default_release;
  }
  mpm_status status = resolve_concurrency(context, &host->concurrency);
  return status ? status : resolve_isa(context, &host->isa);
}

/* Copies the transport; without one there is one part. */
static mpm_status resolve_transport(mpm_context *context, const mpm_transport *from) {
  mpm_transport *to = &context->transport;
  to->parts = 1;
  if (!from) return MPM_OK;
  mpm_transport is = {.struct_size = sizeof is};
  const mpm_status status = mpmi_read_struct(context, "mpm_transport", from, sizeof is, &is);
  if (status) return status;
  if (is.parts < 1 || is.part < 0 || is.part >= is.parts)
    return mpmi_fail(context, MPM_E_ARG, "mpm_transport: part is %d of %d, must be 0 to parts - 1",
                     (int)is.part, (int)is.parts);
  if (!is.send || !is.receive || !is.reduce || !is.gather)
    return mpmi_fail(context, MPM_E_ARG, "mpm_transport: %s is NULL",
                     !is.send      ? "send"
                     : !is.receive ? "receive"
                     : !is.reduce  ? "reduce"
                                   : "gather");
  *to = is;
  return MPM_OK;
}

/* Lets the parts find out that they are alike. One that has failed joins in, so that nobody waits for it. */
static mpm_status meet(mpm_context *context, mpm_status status) {
  if (mpmi_is_whole(context)) return status;
  if ((status = mpmi_agree(context, status))) return status;
  const int64_t mine[] = {mpm_version(), context->isa, context->transport.parts};
  int64_t is[6];
  for (int32_t i = 0; i < 3; ++i) is[2 * i] = mine[i], is[2 * i + 1] = -mine[i];
  if ((status = mpmi_reduce_parts(context, MPM_REDUCE_MAX, 6, is))) return status;
  static const char *const what[] = {"versions of the library", "instruction sets", "numbers of parts"};
  for (int32_t i = 0; i < 3; ++i)
    if (is[2 * i] != -is[2 * i + 1])
      return mpmi_fail(context, MPM_E_UNSUPPORTED,
                       "the parts have unlike %s, here %lld and up to %lld elsewhere: make them alike%s",
                       what[i], (long long)mine[i], (long long)is[2 * i],
                       i == 1 ? ", for instance with MPM_ISA_AVX2" : "");
  return MPM_OK;
}

static void free_context(mpm_context *context) {
  mpm_context_desc host = context->host;
  mpmi_pool_destroy(context, context->pool);
  context->magic = 0; /* a handle used after this is refused as long as the memory is not reused */
  host.release(host.alloc_user, context, sizeof *context, MPMI_ALIGNMENT);
  mpmi_environment_mend();
}

/* A copy of the context that keeps its text; `from` may be on the stack. */
static void move_context(mpm_context *to, const mpm_context *from) {
  memcpy(to, from, sizeof *to);
  to->error = to->kept = to->text[0];
}

/* The context is its own first allocation: until then a stand-in counts its bytes and keeps its text. */
static mpm_status make(mpm_context *first, const mpm_context_desc *desc, mpm_context **out) {
  mpm_context_desc *host = &first->host;
  mpm_status status = desc ? mpmi_read_struct(first, "mpm_context_desc", desc, sizeof *host, host) : MPM_OK;
  /* it says where to complain, too */
  if (status == MPM_E_UNSUPPORTED) mpmi_read_known("mpm_context_desc", desc, sizeof *host, host);
  const mpm_status reached = resolve_transport(first, host->transport);
  if (!status) status = reached;
  host->transport = NULL; /* it is the host's, and was copied */
  if (!status && !out) status = mpmi_fail(first, MPM_E_ARG, "mpm_context_create: out is NULL");
  if (!status) status = resolve(first, host);
  first->isa = host->isa;
  first->works_by_halves = host->isa == MPM_ISA_AVX512 && mpmi_works_by_halves();
  first->concurrency = host->concurrency;
  if ((status = meet(first, status))) return status;
  mpm_context *context = mpmi_alloc(first, sizeof *context);
  if (!context) return MPM_E_NOMEM;
  move_context(context, first);
  context->host.error_text = NULL; /* that is the host's, and was lent for this call */
  context->host.error_bytes = 0;
  if (context->concurrency > 1 && !context->host.parallel_for)
    status = mpmi_pool_create(context, context->concurrency, &context->pool);
  if (status) {
    mpmi_fail(first, status, "%s", mpm_last_error(context));
    free_context(context);
    return status;
  }
  *out = context;
  return MPM_OK;
}

/* Without a context the host learns from its own text, and from its log, why there is none. */
static void tell_failure(mpm_context *first) {
  const mpm_context_desc *host = &first->host;
  const char *text = mpm_last_error(first);
  mpmi_log(first, MPM_LOG_WARNING, "no context: %s", text);
  if (!host->error_text || !host->error_bytes) return;
  size_t length = strlen(text);
  if (length >= host->error_bytes) length = (size_t)host->error_bytes - 1;
  memcpy(host->error_text, text, length);
  host->error_text[length] = '\0';
}

mpm_status mpm_context_create(const mpm_context_desc *desc, mpm_context **out) {
  if (out) *out = NULL;
  mpmi_environment environment; /* threads of a pool begin with that of the thread that starts them */
  mpmi_environment_enter(&environment);
  mpm_context first;
  memset(&first, 0, sizeof first);
  first.magic = MPMI_CONTEXT;
  first.host = default_desc();
  first.error = first.kept = first.text[0];
  const mpm_status status = make(&first, desc, out);
  if (status)
    tell_failure(&first);
  else
    mpmi_log(*out, MPM_LOG_INFO, "context: instruction set %s, concurrency %d, %s", isa_name[first.isa],
             (int)first.concurrency,
             first.host.parallel_for ? "the host's executor"
             : (*out)->pool          ? "own threads"
                                     : "no threads");
  mpmi_environment_leave(&environment);
  return status;
}

mpm_status mpm_context_memory(const mpm_context *context, int64_t *bytes, int64_t *peak_bytes) {
  if (!context || context->magic != MPMI_CONTEXT) return MPM_E_ARG;
  if (bytes) *bytes = context->bytes;
  if (peak_bytes) *peak_bytes = context->peak_bytes;
  return MPM_OK;
}

mpm_status mpm_context_destroy(mpm_context *context) {
  if (!context) return MPM_OK;
  MPMI_ENTER_CONTEXT(context);
  if (context->children)
    return mpmi_fail(context, MPM_E_STATE, "%d objects of the context still live: destroy them first",
                     (int)context->children);
  entry_.busy = NULL; /* it goes with the context, which stays busy until then */
  free_context(context);
  return MPM_OK;
}
