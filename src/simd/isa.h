/* Kernels are compiled once for each instruction set, with MPMI_ISA naming it; KERNEL(f) is f_baseline,
 * f_avx2 ... */
#ifndef MPMI_ISA_H
#define MPMI_ISA_H

#include <float.h>

/* Kernels round by adding large numbers, and index memory by what comes out: a register that holds more
 * digits than a double, as the x87 has, gives other cells. */
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1
#error "doubles are not evaluated as doubles: on 32-bit x86 compile with -msse2 -mfpmath=sse"
#endif

#ifndef MPMI_ISA
#define MPMI_ISA baseline
#endif
#define MPMI_GLUE2(a, b) a##_##b
#define MPMI_GLUE(a, b)  MPMI_GLUE2(a, b)
#define KERNEL(name)     MPMI_GLUE(mpmi_##name, MPMI_ISA)

/* Doubles in a register of the set. Sums over lanes depend on it, so that it follows from the name alone:
 * flags for a better processor, as -march=native, must not change what the baseline gives. */
#define MPMI_WIDTH_baseline 2
#define MPMI_WIDTH_neon     2
#define MPMI_WIDTH_avx2     4
#define MPMI_WIDTH_avx512   8
#define MPMI_WIDTH          MPMI_GLUE(MPMI_WIDTH, MPMI_ISA)

/* Tables of kernels NAME_baseline, NAME_avx2 ... of the instruction sets that this build has: their
 * declarations, and the address of the one for an MPM_ISA_.... */
#if defined(__x86_64__) && !defined(MPM_BASELINE_ONLY)
#define MPMI_HAS_X86                    1
#define MPMI_HAS_NEON                   0
#define MPMI_DECLARE_TABLES(type, name) extern const type name##_baseline, name##_avx2, name##_avx512
#define MPMI_TABLE_OF(isa, name)                                                                             \
  ((isa) == MPM_ISA_AVX512 ? &name##_avx512 : (isa) == MPM_ISA_AVX2 ? &name##_avx2 : &name##_baseline)
#elif defined(__aarch64__) && !defined(MPM_BASELINE_ONLY)
#define MPMI_HAS_X86                    0
#define MPMI_HAS_NEON                   1
#define MPMI_DECLARE_TABLES(type, name) extern const type name##_baseline, name##_neon
#define MPMI_TABLE_OF(isa, name)        ((isa) == MPM_ISA_NEON ? &name##_neon : &name##_baseline)
#else
#define MPMI_HAS_X86                    0
#define MPMI_HAS_NEON                   0
#define MPMI_DECLARE_TABLES(type, name) extern const type name##_baseline
#define MPMI_TABLE_OF(isa, name)        ((void)(isa), &name##_baseline)
#endif

#define MPMI_INLINE static inline __attribute__((always_inline))
#if defined(__clang__)
#define MPMI_IVDEP  _Pragma("clang loop vectorize(assume_safety)")
#define MPMI_UNROLL _Pragma("clang loop unroll(full)")
#else
#define MPMI_IVDEP  _Pragma("GCC ivdep")
#define MPMI_UNROLL _Pragma("GCC unroll 4")
#endif

#endif
