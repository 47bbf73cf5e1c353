/* The table of this instruction set's kernels. */
#include "transfer/kernels.h"

#define WEIGHTS(name)                                                                                        \
  void KERNEL(name)(const mpmi_axis *, int32_t, const mpmi_points *, int64_t, int64_t, mpmi_weights *);
#define BASIS(name)                                                                                          \
  WEIGHTS(name##_1)                                                                                          \
  WEIGHTS(name##_2)                                                                                          \
  WEIGHTS(name##_3)
BASIS(bspline1)
BASIS(bspline2)
BASIS(bspline3)
BASIS(gimp)
BASIS(open_bspline2)
BASIS(open_bspline3)
#define BY_DIM(name)                                                                                         \
  { NULL, KERNEL(name##_1), KERNEL(name##_2), KERNEL(name##_3) }
#define SCATTER(dim, width, form, name) void KERNEL(name)(const mpmi_scatter *, int64_t, int64_t);
#define GATHER(dim, width, form, name)  mpmi_taken KERNEL(name)(const mpmi_gather *, int64_t, int64_t);
#include "transfer/instances.h"
#define SCALARS(dim, width)                                                                                  \
  void KERNEL(give_values_##dim##_##width)(const mpmi_scalars *, int64_t, int64_t, const double *const *,    \
                                           double *);                                                        \
  void KERNEL(take_values_##dim##_##width)(const mpmi_scalars *, int64_t, int64_t, const double *,           \
                                           double *);                                                        \
  void KERNEL(conduct_##dim##_##width)(const mpmi_conduction *, int64_t, int64_t);
#define PER_DIM(dim)                                                                                         \
  SCALARS(dim, 2)                                                                                            \
  SCALARS(dim, 3)                                                                                            \
  SCALARS(dim, 4)                                                                                            \
  uint32_t KERNEL(move_##dim)(const mpmi_move *, int64_t);                                                   \
  uint32_t KERNEL(look_##dim)(const mpmi_move *, int64_t);                                                   \
  uint32_t KERNEL(sums_##dim)(const mpmi_sums_job *, int64_t, mpmi_sums *);                                  \
  void KERNEL(push_##dim)(const mpmi_push *, int64_t);                                                       \
  void KERNEL(force_scatter_##dim##_2)(const mpmi_force_scatter *, int64_t, int64_t);                        \
  void KERNEL(force_scatter_##dim##_3)(const mpmi_force_scatter *, int64_t, int64_t);                        \
  void KERNEL(force_scatter_##dim##_4)(const mpmi_force_scatter *, int64_t, int64_t);                        \
  void KERNEL(stiffness_##dim)(int32_t, const mpmi_weights *, int64_t, const double *, int64_t, double,      \
                               double *);                                                                    \
  int32_t KERNEL(discriminate_##dim)(mpmi_separation *);                                                     \
  int32_t KERNEL(fit_##dim)(mpmi_separation *);                                                              \
  void KERNEL(project_##dim)(const mpmi_separation *, const double *, const double *, double, double *,      \
                             double *);
PER_DIM(1)
PER_DIM(2)
PER_DIM(3)

void KERNEL(add_box)(int32_t, const mpmi_box *);
void KERNEL(add_flat_box)(const mpmi_box *);
void KERNEL(fetch_box)(int32_t, const mpmi_box *);
void KERNEL(load_box)(int32_t, int32_t, const mpmi_box *);
mpmi_updated KERNEL(update)(int32_t, double *, int64_t, const double *, double);

const mpmi_kernels KERNEL(kernels) = {
    .weights = {[MPMI_FAMILY_BSPLINE1] = BY_DIM(bspline1),
                [MPMI_FAMILY_BSPLINE2] = BY_DIM(bspline2),
                [MPMI_FAMILY_BSPLINE3] = BY_DIM(bspline3),
                [MPMI_FAMILY_GIMP] = BY_DIM(gimp),
                [MPMI_FAMILY_OPEN_BSPLINE2] = BY_DIM(open_bspline2),
                [MPMI_FAMILY_OPEN_BSPLINE3] = BY_DIM(open_bspline3)},
#define SCATTER(dim, width, form, name) .scatter[dim][width][form] = KERNEL(name),
#define GATHER(dim, width, form, name)  .gather[dim][width][form] = KERNEL(name),
#include "transfer/instances.h"
    .add_box = KERNEL(add_box),
    .add_flat_box = KERNEL(add_flat_box),
    .fetch_box = KERNEL(fetch_box),
    .load_box = KERNEL(load_box),
    .update = KERNEL(update),
    .move = BY_DIM(move),
    .look = BY_DIM(look),
    .sums = BY_DIM(sums),
    .push = BY_DIM(push),
    .discriminate = BY_DIM(discriminate),
    .fit = BY_DIM(fit),
    .project = BY_DIM(project),
#define BY_WIDTH(name)                                                                                       \
  { NULL, NULL, KERNEL(name##_2), KERNEL(name##_3), KERNEL(name##_4) }
#define BY_DIM_AND_WIDTH(name)                                                                               \
  { {NULL}, BY_WIDTH(name##_1), BY_WIDTH(name##_2), BY_WIDTH(name##_3) }
    .force_scatter = BY_DIM_AND_WIDTH(force_scatter),
    .give_values = BY_DIM_AND_WIDTH(give_values),
    .take_values = BY_DIM_AND_WIDTH(take_values),
    .conduct = BY_DIM_AND_WIDTH(conduct),
    .stiffness = BY_DIM(stiffness),
};
