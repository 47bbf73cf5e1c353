/* An independent evaluation of the method, written for reading and not for speed: weights from the recursion
 * and from the integrals that define them, and whole steps with every sum over every node. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "world.h"

/* ---- weights ---- */
typedef struct reference_axis {
  int32_t basis, boundary;
  int64_t cells;
  double origin, spacing;
} reference_axis;

reference_axis reference_axis_of(const mpm_grid_desc *grid, int32_t axis);
/* Indices of the functions of an axis. */
int64_t reference_first(const reference_axis *a);
int64_t reference_last(const reference_axis *a);
/* Where a function sits: node, or Greville point of open knots. */
double reference_node(const reference_axis *a, int64_t index);
/* Value and slope of a function at x; edge: of the particle's domain, for the GIMP family. */
void reference_function(const reference_axis *a, int64_t index, double x, double edge, double *w, double *g);
/* Edge of a particle's domain on an axis: size and diagonal entry of F. */
double reference_edge(const mpm_grid_desc *grid, int32_t axis, double size, double F_ii);
/* Half the width of the functions inside the grid, in cells. */
double reference_reach(const basis_option *basis);

/* ---- steps ---- */
/* All arrays [components][n] by ascending id, tensors full. */
typedef struct reference_cloud {
  int64_t n;
  double *x, *v, *a, *C, *F, *stress, *m, *V0, *size, *J_bar;
} reference_cloud;
reference_cloud reference_take(const world *w, const mpm_particles *set);
void reference_drop(reference_cloud *cloud);

typedef struct reference {
  mpm_grid_desc grid; /* without periodic axes */
  mpm_stepper_desc stepper;
  double E, nu;   /* neo-Hookean */
  double last_dt; /* 0: none yet */
  int64_t steps;  /* that were made */
} reference;
void reference_step(reference *r, reference_cloud *cloud, double dt);
void reference_stress(double E, double nu, const double *F, double *stress);
/* The same as a host's law; user is a reference_law. */
typedef struct reference_law {
  double E, nu, wave_speed;
} reference_law;
mpm_status reference_law_stress(void *user, const mpm_material_batch *b);

#endif
