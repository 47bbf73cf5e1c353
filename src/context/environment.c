/* Sets and restores the floating-point environment: by the registers of x86 and aarch64, which also say what
 * becomes of tiny numbers, and else by what ISO C knows of it. */
#include "context/environment.h"

/* Compilers know nothing of what arithmetic owes to the environment. They keep it on its side of these
 * functions as long as they cannot see into them, and must read memory anew behind them. */
#define OPAQUE    __attribute__((noinline))
#define BARRIER() __asm__ volatile("" ::: "memory")

#if defined(MPMI_ENVIRONMENT_X86)

enum {
  SSE_DEFAULT = 0x1f80, /* to nearest, all exceptions masked, tiny numbers kept */
  SSE_CONTROL = 0xffc0, /* all but the flags */
  X87_ROUNDING = 0x0c00,
  X87_MASKS = 0x003f
};

/* Only the precision, which the system chooses, stays the host's. */
static void mend_x87(uint16_t control) {
  const uint16_t wanted = (uint16_t)((control & ~X87_ROUNDING) | X87_MASKS);
  if (control != wanted) __asm__ volatile("fldcw %0" ::"m"(wanted));
}

OPAQUE void mpmi_environment_enter(mpmi_environment *host) {
  BARRIER();
  host->mxcsr = __builtin_ia32_stmxcsr();
  __builtin_ia32_ldmxcsr(SSE_DEFAULT);
  __asm__ volatile("fnstenv %0" : "=m"(host->x87)); /* masks the exceptions, too */
  if (host->x87.word[0] & X87_ROUNDING) mend_x87((uint16_t)host->x87.word[0]);
  BARRIER();
}

OPAQUE void mpmi_environment_leave(const mpmi_environment *host) {
  BARRIER();
  __asm__ volatile("fldenv %0" ::"m"(host->x87));
  __builtin_ia32_ldmxcsr(host->mxcsr);
  BARRIER();
}

OPAQUE void mpmi_environment_mend(void) {
  BARRIER();
  uint16_t control;
  if ((__builtin_ia32_stmxcsr() & SSE_CONTROL) != SSE_DEFAULT) __builtin_ia32_ldmxcsr(SSE_DEFAULT);
  __asm__ volatile("fnstcw %0" : "=m"(control));
  mend_x87(control);
  BARRIER();
}

#elif defined(MPMI_ENVIRONMENT_AARCH64)
static uint64_t control_register(void) {
  uint64_t value;
  __asm__ volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}

static void set_control_register(uint64_t value) {
  __asm__ volatile("msr fpcr, %0" ::"r"(value));
}

OPAQUE void mpmi_environment_enter(mpmi_environment *host) {
  BARRIER();
  host->control = control_register();
  __asm__ volatile("mrs %0, fpsr" : "=r"(host->status));
  if (host->control) set_control_register(0);
  BARRIER();
}

OPAQUE void mpmi_environment_leave(const mpmi_environment *host) {
  BARRIER();
  __asm__ volatile("msr fpsr, %0" ::"r"(host->status));
  if (host->control) set_control_register(host->control);
  BARRIER();
}

OPAQUE void mpmi_environment_mend(void) {
  BARRIER();
  if (control_register()) set_control_register(0);
  BARRIER();
}

#else
OPAQUE void mpmi_environment_enter(mpmi_environment *host) {
  BARRIER();
  fegetenv(&host->all);
  fesetenv(FE_DFL_ENV);
  BARRIER();
}

OPAQUE void mpmi_environment_leave(const mpmi_environment *host) {
  BARRIER();
  fesetenv(&host->all);
  BARRIER();
}

OPAQUE void mpmi_environment_mend(void) {
  BARRIER();
  fesetenv(FE_DFL_ENV);
  BARRIER();
}
#endif
