/* How far a particle reaches in a direction. */
#ifndef MPMI_CONTACT_HALF_WIDTH_H
#define MPMI_CONTACT_HALF_WIDTH_H

#include "particles/particles.h"

#include <math.h>

/* Half the edge of the cube that a particle of a volume has been. */
double mpmi_half_edge(int32_t dim, double volume);

/* What half-widths of a set's particles come from. */
typedef struct mpmi_widths {
  int32_t dim;
  int64_t ld;
  const double *F, *size; /* size: NULL, or the edges of boxes */
  double most;
  int32_t total; /* the most is that of particles as they were */
} mpmi_widths;

static inline mpmi_widths mpmi_widths_of(const mpm_particles *set, int32_t copy) {
  const mpm_grid *grid = set->grid;
  return (mpmi_widths){.dim = grid->dim,
                       .ld = set->ld,
                       .F = mpmi_f64(set, MPMI_F, copy),
                       .size = mpmi_has_domains(grid) ? mpmi_f64(set, MPMI_SIZE, 0) : NULL,
                       .most = 0.5 * grid->h_min,
                       .total = mpmi_is_total_lagrangian(grid)};
}

/* Inverts F of a particle, the components on axes of the grid alone. */
void mpmi_inverse_at(const mpm_particles *set, int64_t slot, double inverse[3][3]);

/* Half-width of a particle along a unit vector: that of a ball, or with a field "size" of a box, that F
 * has deformed; at most half a cell, which on a total Lagrangian grid deforms with it. n: as the particle
 * itself sees it. Of F, the components on axes of the grid come first, by rows. */
static inline double mpmi_half_width(const mpmi_widths *of, int64_t slot, double edge, const double *n) {
  const int32_t dim = of->dim;
  double width = 0.0;
  if (of->total && edge > of->most) edge = of->most;
  for (int32_t k = 0; k < dim; ++k) {
    double along = 0.0; /* F^T n */
    for (int32_t i = 0; i < dim; ++i) along += of->F[(i * dim + k) * of->ld + slot] * n[i];
    double half = of->size ? 0.5 * of->size[k * of->ld + slot] : 0.0;
    if (of->total && half > of->most) half = of->most;
    width += of->size ? half * fabs(along) : along * along;
  }
  if (!of->size) width = edge * sqrt(width);
  return width < of->most || of->total ? width : of->most;
}

#endif
