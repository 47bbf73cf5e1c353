/* P2G: what the particles of one block give to its tile. */
#ifndef MPMI_SCATTER_H
#define MPMI_SCATTER_H

#include "transfer/streams.h"
#include "transfer/weights.h"

/* Forms of the scatter. With 4 values nodes receive momentum and mass, and the fused MLS force may be part of
 * the momentum; with 8 values they receive the force as well. AFFINE adds the affine part of the velocity;
 * UNEVEN does so for nodes that are not a spacing apart. HALVES takes the eight values of a node as two
 * registers of four, for processors that work on halves of longer ones in turn; it gives the same bits, and
 * is there where registers hold eight values.
 *
 * In 1-D and 2-D momentum and force are four values together: there the FLAT forms take the place of those
 * with 8. A flat tile has [p_x p_y f_x f_y] of all nodes and then their masses, of which one register takes
 * those of a row of the stencil. */
enum {
  MPMI_SCATTER_4,
  MPMI_SCATTER_4_AFFINE,
  MPMI_SCATTER_4_UNEVEN,
  MPMI_SCATTER_8,
  MPMI_SCATTER_8_AFFINE,
  MPMI_SCATTER_8_UNEVEN,
  MPMI_SCATTER_8_HALVES,
  MPMI_SCATTER_8_AFFINE_HALVES,
  MPMI_SCATTER_FLAT,
  MPMI_SCATTER_FLAT_AFFINE,
  MPMI_SCATTER_FLAT_UNEVEN,
  MPMI_SCATTER_FORMS
};

/* A flat tile has room for so many doubles per node: four, the mass, and what rows of masses, which are
 * stored in fours, have beyond the last one. */
enum { MPMI_FLAT_VALUES = 6 };
/* Returns the masses of a flat tile. */
static inline double *mpmi_flat_masses(int32_t dim, int32_t width, double *tile) {
  const int64_t edge = MPMI_TILE_EDGE(dim, width);
  return tile + 4 * (dim == 1 ? edge : dim == 2 ? edge * edge : edge * edge * edge);
}

/* A scatter reads component arrays of a set, each from slot 0 on. */
typedef struct mpmi_scatter {
  mpmi_axis axis[3];
  mpmi_weights_fn weights;
  int32_t need;
  mpmi_points points;
  const double *v[3], *mass, *volume;
  const double *stress[6]; /* by (xx yy zz xy yz xz) */
  const double *affine[9]; /* row * 3 + column; for the affine forms */
  const double *F[9];      /* of total Lagrangian grids, stored components; or NULL */
  const double *force[3];  /* external force on the particle beside gravity, or NULL */
  double gravity[3];
  int32_t hoop;    /* particles are rings (2-D): x[0] is their radius */
  double fused_dt; /* form 4 affine: time that the force acts on the momentum; 0: no force */
  double *tile;
  mpmi_streams streams;
} mpmi_scatter;
typedef void (*mpmi_scatter_fn)(const mpmi_scatter *job, int64_t begin, int64_t end);

#endif
