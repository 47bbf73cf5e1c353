/* What the library asks of the processor beyond what compilers ask for it. */
#include "platform/platform.h"

#if defined(__x86_64__) && !defined(MPM_BASELINE_ONLY)
#include <cpuid.h>

/* AMD tells how wide the data paths are in bits 2 (256 bits) and 3 (512 bits) of this leaf. */
enum { LEAF_OF_WIDTHS = 0x1a, WIDTHS = 1 << 2 | 1 << 3, ONLY_256 = 1 << 2 };

int32_t mpmi_works_by_halves(void) {
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid(0x80000000u + LEAF_OF_WIDTHS, &a, &b, &c, &d) && (a & WIDTHS) == ONLY_256;
}

#else
int32_t mpmi_works_by_halves(void) {
  return 0;
}
#endif
