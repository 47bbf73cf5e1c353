/* The floating-point environment of a thread: rounding, traps, the treatment of tiny numbers, and flags of
 * what has happened. That of a host may be any. The library computes in the default one, because its numbers
 * must not depend on the host, and because its kernels raise flags for numbers that they then drop. */
#ifndef MPMI_ENVIRONMENT_H
#define MPMI_ENVIRONMENT_H

#include <stdint.h>

#if defined(__x86_64__) || (defined(__i386__) && defined(__SSE__))
#define MPMI_ENVIRONMENT_X86 1
#elif defined(__aarch64__)
#define MPMI_ENVIRONMENT_AARCH64 1
#else
#include <fenv.h>
#endif

typedef struct mpmi_environment {
#if defined(MPMI_ENVIRONMENT_X86)
  uint32_t mxcsr;
  struct {
    uint32_t word[7];
  } x87; /* as the processor stores it; of word 0 the lower half is the control word */
#elif defined(MPMI_ENVIRONMENT_AARCH64)
  uint64_t control, status;
#else
  fenv_t all;
#endif
} mpmi_environment;

/* Notes the environment of the calling thread in `host`, and sets the default one. */
void mpmi_environment_enter(mpmi_environment *host);
/* Puts back what mpmi_environment_enter() noted, with the flags of then. */
void mpmi_environment_leave(const mpmi_environment *host);
/* Sets the default environment where the thread has another one: after the host was called. */
void mpmi_environment_mend(void);

#endif
