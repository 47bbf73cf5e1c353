/* The longest step that explicit conduction is stable with. */
#include "heat/heat.h"
#include "context/transport.h"
#include "material/pull_back.h"
#include "stages/batch.h"

/* Return sum |A_ij| / (h_i h_j) of particles, with A as in transfer/scalars.h. */
static double inverse_squares(const mpm_grid *grid) {
  double sum = 0.0;
  for (int32_t k = 0; k < grid->dim; ++k) sum += grid->inverse_spacing[k] * grid->inverse_spacing[k];
  return sum;
}
MPMI_INLINE mpmi_lanes reference_squares(int32_t dim, const mpm_grid *grid, const double *const *F,
                                         int64_t slot) {
  mpmi_lanes inverse[3][3], sum = {0.0};
  mpmi_inverse_load(dim, F, slot, inverse);
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      mpmi_lanes A = inverse[i][0] * inverse[j][0];
      for (int32_t k = 1; k < dim; ++k) A += inverse[i][k] * inverse[j][k];
      sum += mpmi_lanes_abs(A) * grid->inverse_spacing[i] * grid->inverse_spacing[j];
    }
  return sum;
}

/* Returns the largest sum V / m of the particles of a set; of holes that is no number. */
MPMI_INLINE double largest_of(int32_t dim, const mpm_particles *set, const double *const *F) {
  const double *volume = mpmi_f64(set, MPMI_VOLUME, 0), *mass = mpmi_f64(set, MPMI_MASS, 0);
  const mpmi_lanes zero = {0.0}, squares = zero + inverse_squares(set->grid);
  mpmi_lanes largest = zero;
  for (int64_t slot = 0; slot < mpmi_whole_chunks(set->slots); slot += MPMI_LANES) {
    const mpmi_lanes m = mpmi_lanes_load(mass + slot);
    const mpmi_lanes of =
        (dim ? reference_squares(dim, set->grid, F, slot) : squares) * mpmi_lanes_load(volume + slot) / m;
    largest = mpmi_lanes_max(largest, mpmi_lanes_where(m > 0.0, of));
  }
  return mpmi_lanes_largest(largest);
}

static double largest_in(const mpm_particles *set) {
  const int32_t dim = set->grid->dim;
  const double *F[9] = {NULL};
  if (!mpmi_is_total_lagrangian(set->grid)) return largest_of(0, set, F);
  for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c) F[c] = mpmi_component_row(set, MPMI_F, 0, c);
  return dim == 1 ? largest_of(1, set, F) : dim == 2 ? largest_of(2, set, F) : largest_of(3, set, F);
}

mpm_status mpmi_heat_rate(const mpmi_settings *settings, const mpmi_layout *layout, double *out) {
  double rate = 0.0;
  *out = 0.0;
  if (!settings->heat.any || settings->heat.conduction != MPM_CONDUCTION_EXPLICIT) return MPM_OK;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_heat_desc *desc = &settings->heat.set[m].desc;
    const mpm_particles *set = layout->member[m].set;
    if (!settings->heat.set[m].on || !(desc->conductivity > 0.0) || !set->slots) continue;
    const double of = 2.0 * desc->conductivity / desc->specific_heat * largest_in(set);
    rate = of > rate ? of : rate;
  }
  int64_t largest = mpmi_ordered_bits(rate);
  const mpm_status status = mpmi_reduce_parts(settings->context, MPM_REDUCE_MAX, 1, &largest);
  *out = mpmi_of_ordered_bits(largest);
  return status;
}
