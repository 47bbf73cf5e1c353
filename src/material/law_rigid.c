/* No stress, no energy, no waves: where such particles go, others say. */
#include "material/laws.h"
#include "material/tensor.h"

MPMI_INLINE void rigid(int dim, const double *constants, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  double *stress = batch->stress_new, *wave_speed = batch->wave_speed, *energy = batch->energy;
  (void)constants;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    mpmi_sym none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    mpmi_store_sym(dim, stress, ld, i, none);
    wave_speed[i] = 0.0;
    energy[i] = 0.0;
  }
}

MPMI_LAW_BY_DIM(law_rigid, rigid)
