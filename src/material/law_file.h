/* What the file of a law needs to describe it: ranges of parameters, kernels by dimension, symmetry.
 *
 * The file is compiled once for each instruction set, and so is its `prepare`: a product there that something
 * is added to goes through mpmi_rounded(), or the constants would depend on the instruction set. */
#ifndef MPMI_LAW_FILE_H
#define MPMI_LAW_FILE_H

#include <float.h>
#include <math.h>

#include "material/laws.h"
#include "simd/chunk.h"
#include "simd/rounding.h"

/* Entries of a parameter: its range, its default. Open ranges are written with their outermost members, so
 * that low and high themselves are accepted. */
#define POSITIVE      DBL_MIN, DBL_MAX, "must be finite and > 0", 0
#define NOT_NEGATIVE  0.0, DBL_MAX, "must be finite and >= 0", 0
#define AT_LEAST_ONE  1.0, DBL_MAX, "must be finite and >= 1", 0
#define ZERO_OR_ONE   0.0, 1.0, "must be 0 or 1", 1
#define MUST_BE_GIVEN ((double)NAN)
#define PARAM_DENSITY                                                                                        \
  { "density", "mass/length^3", "mass per initial volume", MUST_BE_GIVEN, POSITIVE }

/* Sets param and param_count to an array of parameters. */
#define MPMI_PARAMS(array) .param = (array), .param_count = (int32_t)(sizeof(array) / sizeof *(array))

/* Sets state and state_count to an array of state variables. */
#define MPMI_STATES(array) .state = (array), .state_count = (int32_t)(sizeof(array) / sizeof *(array))

/* Sets refusal and refusal_count to an array of refusals. */
#define MPMI_REFUSALS(array) .refusal = (array), .refusal_count = (int32_t)(sizeof(array) / sizeof *(array))

/* Particles of a batch. */
MPMI_INLINE int64_t mpmi_batch_items(const mpm_material_batch *batch) {
  return mpmi_whole_chunks(batch->n);
}

/* Makes stress_kernel and tangent_kernel from stress_of(dim, constants, batch) and tangent_of(dim, constants,
 * batch, tangent), specialised for each dim. type: of the constants. */
#define MPMI_LAW_KERNELS(type, stress_of, tangent_of)                                                        \
  static void stress_kernel(const void *constants, int32_t dim, const mpm_material_batch *batch) {           \
    const type *c = constants;                                                                               \
    if (dim == 3)                                                                                            \
      stress_of(3, c, batch);                                                                                \
    else if (dim == 2)                                                                                       \
      stress_of(2, c, batch);                                                                                \
    else                                                                                                     \
      stress_of(1, c, batch);                                                                                \
  }                                                                                                          \
  static void tangent_kernel(const void *constants, int32_t dim, const mpm_material_batch *batch,            \
                             double *rows) {                                                                 \
    const type *c = constants;                                                                               \
    if (dim == 3)                                                                                            \
      tangent_of(3, c, batch, rows);                                                                         \
    else if (dim == 2)                                                                                       \
      tangent_of(2, c, batch, rows);                                                                         \
    else                                                                                                     \
      tangent_of(1, c, batch, rows);                                                                         \
  }

/* Does so from stress_of(dim, stored, constants, batch) of a law that looks at F alone, and makes a
 * plane_kernel for batches in 2-D whose F has the rows that a set stores. */
#define MPMI_LAW_KERNELS_OF_F(type, stress_of, tangent_of)                                                   \
  MPMI_INLINE void stress_of##_of_rows(int dim, const type *c, const mpm_material_batch *batch) {            \
    stress_of(dim, 0, c, batch);                                                                             \
  }                                                                                                          \
  static void plane_kernel(const void *constants, int32_t dim, const mpm_material_batch *batch) {            \
    (void)dim;                                                                                               \
    stress_of(2, 1, constants, batch);                                                                       \
  }                                                                                                          \
  MPMI_LAW_KERNELS(type, stress_of##_of_rows, tangent_of)

/* For is_symmetric: the tangent is symmetric where the stress is a function of F alone, and is not where the
 * stress depends on the step. */
static inline int32_t mpmi_symmetric(const void *constants) {
  (void)constants;
  return 1;
}
static inline int32_t mpmi_unsymmetric(const void *constants) {
  (void)constants;
  return 0;
}

#endif
