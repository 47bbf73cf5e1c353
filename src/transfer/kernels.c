/* The table of this instruction set's kernels. */
#include "transfer/kernels.h"

#define AXIS(name)                                                                                           \
  void KERNEL(name)(const mpmi_axis *, int64_t, const double *, int32_t, double(*)[MPMI_CHUNK],              \
                    double(*)[MPMI_CHUNK], double(*)[MPMI_CHUNK], double *, double *);
AXIS(bspline1)
AXIS(bspline2)
#define SCATTER(dim, width, form, name) void KERNEL(name)(const mpmi_scatter *, int64_t, int64_t);
#define GATHER(dim, width, form, name)  void KERNEL(name)(const mpmi_gather *, int64_t, int64_t);
#include "transfer/instances.h"
#define PER_DIM(dim)                                                                                         \
  uint32_t KERNEL(move_##dim)(const mpmi_move *, int64_t);                                                   \
  void KERNEL(deform_##dim)(const mpmi_deform *, int64_t);                                                   \
  uint32_t KERNEL(volume_##dim)(const double *const *, const double *, double *, int64_t);                   \
  uint32_t KERNEL(survey_##dim)(const mpmi_survey *, int64_t, mpmi_sums *);
PER_DIM(1)
PER_DIM(2)
PER_DIM(3)

extern const mpmi_kernels KERNEL(kernels);
const mpmi_kernels KERNEL(kernels) = {
    .axis_weights = {NULL, KERNEL(bspline1), KERNEL(bspline2), NULL},
#define SCATTER(dim, width, form, name) .scatter[dim][width][form] = KERNEL(name),
#define GATHER(dim, width, form, name)  .gather[dim][width][form] = KERNEL(name),
#include "transfer/instances.h"
    .move = {NULL, KERNEL(move_1), KERNEL(move_2), KERNEL(move_3)},
    .deform = {NULL, KERNEL(deform_1), KERNEL(deform_2), KERNEL(deform_3)},
    .volume = {NULL, KERNEL(volume_1), KERNEL(volume_2), KERNEL(volume_3)},
    .survey = {NULL, KERNEL(survey_1), KERNEL(survey_2), KERNEL(survey_3)},
};
