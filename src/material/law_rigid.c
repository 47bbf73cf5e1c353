/* The particles have no stress, no energy and no waves: the host prescribes where they go. */
#include "material/law_file.h"
#include "material/tangent_rows.h"

static const mpmi_law_param params[] = {PARAM_DENSITY};

MPMI_INLINE void rigid(int dim, const void *constants, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  double *stress = batch->stress_new, *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  (void)constants;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    mpmi_sym none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    mpmi_store_sym(dim, stress, ld, i, none);
    wave_speed_squared[i] = 0.0;
    energy[i] = 0.0;
  }
}

MPMI_INLINE void rigid_tangent(int dim, const void *constants, const mpm_material_batch *batch,
                               double *tangent) {
  const double none[MPMI_CHUNK] = {0.0};
  (void)constants;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK)
    KERNEL(isotropic_rows)(dim, none, none, tangent + i, batch->ld);
}

MPMI_LAW_KERNELS(void, rigid, rigid_tangent)

const mpmi_law KERNEL(law_rigid) = {
    .name = "rigid",
    MPMI_PARAMS(params),
    .stress_from_F = 1,
    .kinematics = MPMI_F_STAYS,
    .rest = MPMI_REST_NONE,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_symmetric,
};
