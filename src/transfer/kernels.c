/* The table of this instruction set's kernels. */
#include "transfer/kernels.h"

#define WEIGHTS(name)                                                                                        \
  void KERNEL(name)(const mpmi_axis *, int32_t, int64_t, const double *const *, mpmi_weights *);
#define BASIS(name)                                                                                          \
  WEIGHTS(name##_1)                                                                                          \
  WEIGHTS(name##_2)                                                                                          \
  WEIGHTS(name##_3)
BASIS(bspline1)
BASIS(bspline2)
#define SCATTER(dim, width, form, name) void KERNEL(name)(const mpmi_scatter *, int64_t, int64_t);
#define GATHER(dim, width, form, name)  void KERNEL(name)(const mpmi_gather *, int64_t, int64_t);
#include "transfer/instances.h"
#define PER_DIM(dim)                                                                                         \
  uint32_t KERNEL(move_##dim)(const mpmi_move *, int64_t);                                                   \
  void KERNEL(deform_##dim)(const mpmi_deform *, int64_t);                                                   \
  void KERNEL(dilate_##dim)(const mpmi_deform *, int64_t);                                                   \
  void KERNEL(stay_##dim)(const mpmi_deform *, int64_t);                                                     \
  uint32_t KERNEL(volume_##dim)(const double *const *, const double *, double *, int64_t);                   \
  uint32_t KERNEL(survey_##dim)(const mpmi_survey *, int64_t, mpmi_sums *);
PER_DIM(1)
PER_DIM(2)
PER_DIM(3)

void KERNEL(add_box)(int32_t, const mpmi_box *);
void KERNEL(fetch_box)(int32_t, const mpmi_box *);
void KERNEL(load_box)(int32_t, int32_t, const mpmi_box *);
int64_t KERNEL(update)(int32_t, double *, int64_t, double, double);

extern const mpmi_kernels KERNEL(kernels);
const mpmi_kernels KERNEL(kernels) = {
    .weights = {{NULL},
                {NULL, KERNEL(bspline1_1), KERNEL(bspline1_2), KERNEL(bspline1_3)},
                {NULL, KERNEL(bspline2_1), KERNEL(bspline2_2), KERNEL(bspline2_3)}},
#define SCATTER(dim, width, form, name) .scatter[dim][width][form] = KERNEL(name),
#define GATHER(dim, width, form, name)  .gather[dim][width][form] = KERNEL(name),
#include "transfer/instances.h"
    .add_box = KERNEL(add_box),
    .fetch_box = KERNEL(fetch_box),
    .load_box = KERNEL(load_box),
    .update = KERNEL(update),
    .move = {NULL, KERNEL(move_1), KERNEL(move_2), KERNEL(move_3)},
    .deform = {[MPMI_F_DEFORMS] = {NULL, KERNEL(deform_1), KERNEL(deform_2), KERNEL(deform_3)},
               [MPMI_F_DILATES] = {NULL, KERNEL(dilate_1), KERNEL(dilate_2), KERNEL(dilate_3)},
               [MPMI_F_STAYS] = {NULL, KERNEL(stay_1), KERNEL(stay_2), KERNEL(stay_3)}},
    .volume = {NULL, KERNEL(volume_1), KERNEL(volume_2), KERNEL(volume_3)},
    .survey = {NULL, KERNEL(survey_1), KERNEL(survey_2), KERNEL(survey_3)},
};
