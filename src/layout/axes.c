#include "layout/axes.h"

mpmi_points mpmi_points_of(const mpm_particles *set, int32_t copy) {
  const mpm_grid *grid = set->grid;
  mpmi_points points = {{NULL}, {NULL}, {NULL}};
  int32_t stored = 0;
  if (!set->ld) return points; /* nothing was ever added */
  for (int32_t k = 0; k < grid->dim; ++k) {
    points.x[k] = mpmi_f64(set, MPMI_POSITION, copy) + k * set->ld;
    if (mpmi_has_domains(grid)) points.size[k] = mpmi_f64(set, MPMI_SIZE, 0) + k * set->ld;
    while (mpmi_tensor_map(grid->dim)[stored] != 4 * k) ++stored;
    if (grid->desc.basis == MPM_CPGIMP) points.stretch[k] = mpmi_f64(set, MPMI_F, copy) + stored * set->ld;
  }
  return points;
}

/* Beyond all knots. */
#define FAR 1e300

void mpmi_block_axes(const mpm_grid *grid, const int32_t *coord, mpmi_axis *axis) {
  const int32_t edge = MPMI_BLOCK_EDGE(grid->dim);
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double cells = (double)grid->desc.cells[k];
    const int32_t periodic = grid->desc.periodic[k] != 0;
    axis[k] = (mpmi_axis){.origin = grid->desc.origin[k],
                          .spacing = grid->desc.spacing[k],
                          .inverse_spacing = grid->inverse_spacing[k],
                          .last_cell = cells - 1.0,
                          .first_knot = mpmi_is_open(grid, k) ? 0.0 : -FAR,
                          .last_knot = mpmi_is_open(grid, k) ? cells : FAR,
                          .domain = grid->desc.smoothing,
                          .period = periodic ? cells : 0.0,
                          .inverse_period = periodic ? 1.0 / cells : 0.0,
                          .tile_base = (double)coord[k] * edge - MPMI_RING - grid->below,
                          .middle = 0.5 * (edge + 2 * MPMI_RING - 1)};
  }
}
