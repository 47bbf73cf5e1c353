/* Chooses the kernels of an instruction set. */
#include "transfer/kernels.h"

extern const mpmi_kernels mpmi_kernels_baseline;
#if MPMI_HAS_X86
extern const mpmi_kernels mpmi_kernels_avx2, mpmi_kernels_avx512;
#endif

const mpmi_kernels *mpmi_kernels_of(int32_t isa) {
#if MPMI_HAS_X86
  if (isa == MPM_ISA_AVX512) return &mpmi_kernels_avx512;
  if (isa == MPM_ISA_AVX2) return &mpmi_kernels_avx2;
#else
  (void)isa;
#endif
  return &mpmi_kernels_baseline;
}
