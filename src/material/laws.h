/* The built-in laws: their kernels, one per instruction set, and the order of their constants. */
#ifndef MPMI_LAWS_H
#define MPMI_LAWS_H

#include "material/material.h"
#include "simd/chunk.h"

/* Each law has those that it needs; the others are 0. */
enum {
  MPMI_C_LAMBDA,
  MPMI_C_MU,
  MPMI_C_DENSITY_INVERSE,
  MPMI_C_P_WAVE_SQUARED, /* (lambda + 2 mu) / density */
  MPMI_C_MEAN_ENERGY,    /* 1 / (2 K): energy of the mean stress */
  MPMI_C_SHEAR_ENERGY,   /* 1 / (4 mu): energy of the deviator */
  MPMI_C_YIELD,          /* j2: initial yield stress */
  MPMI_C_HARDENING,      /* j2: slope of the yield stress over the equivalent plastic strain */
  MPMI_C_RETURN,         /* j2: 1 / (3 mu + hardening) */
  MPMI_C_BULK,           /* neo_hookean_decoupled: kappa; newtonian_fluid: K */
  MPMI_C_BULK_BY_GAMMA,
  MPMI_C_GAMMA_MINUS_1, /* newtonian_fluid: never 0 */
  MPMI_C_VISCOSITY,
  MPMI_C_LARGEST_J_MINUS_1, /* newtonian_fluid: 0 without tension */
  MPMI_C_COUNT
};
_Static_assert((int)MPMI_C_COUNT <= (int)MPMI_MAX_CONSTANTS, "constants of a law");

/* Particles of a batch. */
MPMI_INLINE int64_t mpmi_batch_items(const mpm_material_batch *batch) {
  return mpmi_whole_chunks(batch->n);
}

/* A built-in law by name, or NULL. */
const mpmi_law *mpmi_law_by_name(const char *name);

#define MPMI_DECLARE_LAW(law, isa)                                                                           \
  void mpmi_law_##law##_##isa(const double *constants, int32_t dim, const mpm_material_batch *batch);        \
  void mpmi_tangent_##law##_##isa(const double *constants, int32_t dim, const mpm_material_batch *batch,     \
                                  double *tangent);
#define MPMI_DECLARE_LAWS(isa)                                                                               \
  MPMI_DECLARE_LAW(neo_hookean, isa)                                                                         \
  MPMI_DECLARE_LAW(neo_hookean_decoupled, isa)                                                               \
  MPMI_DECLARE_LAW(newtonian_fluid, isa)                                                                     \
  MPMI_DECLARE_LAW(rigid, isa)                                                                               \
  MPMI_DECLARE_LAW(linear_elastic, isa)                                                                      \
  MPMI_DECLARE_LAW(j2, isa)

MPMI_DECLARE_LAWS(baseline)
#if MPMI_HAS_X86
MPMI_DECLARE_LAWS(avx2)
MPMI_DECLARE_LAWS(avx512)
#endif

/* Makes f(constants, dim, batch) from f_dim(constants, dim, batch), specialised for each dim. */
#define MPMI_LAW_BY_DIM(law, body)                                                                           \
  void KERNEL(law)(const double *constants, int32_t dim, const mpm_material_batch *batch) {                  \
    if (dim == 3)                                                                                            \
      body(3, constants, batch);                                                                             \
    else if (dim == 2)                                                                                       \
      body(2, constants, batch);                                                                             \
    else                                                                                                     \
      body(1, constants, batch);                                                                             \
  }

/* The same of a tangent, f(constants, dim, batch, tangent). */
#define MPMI_TANGENT_BY_DIM(kernel, body)                                                                    \
  void KERNEL(kernel)(const double *constants, int32_t dim, const mpm_material_batch *batch,                 \
                      double *tangent) {                                                                     \
    if (dim == 3)                                                                                            \
      body(3, constants, batch, tangent);                                                                    \
    else if (dim == 2)                                                                                       \
      body(2, constants, batch, tangent);                                                                    \
    else                                                                                                     \
      body(1, constants, batch, tangent);                                                                    \
  }

#endif
