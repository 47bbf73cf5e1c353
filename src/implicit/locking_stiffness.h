/* What the locking remedy adds to the stiffness. With j' the mean of det F_inc - 1 over a cell, weighted by
 * the old volumes V, and theta = div du of a particle, the law sees L' = L + (theta' - theta) / d I, where
 *
 *   theta' = sum V (1 + j) theta / sum V (1 + j)                          over the cell,
 *
 * and force is divided by a ratio that grows by theta' - theta. With h_ik = c_ikll / d + (2 / d - 1) tau_ik
 * that gives h_ik g_a,k (theta' - theta): the part of theta goes into the tangent of the particle, that of
 * theta' couples all particles of the cell and is one outer product for it. It is not symmetric. */
#ifndef MPMI_LOCKING_STIFFNESS_H
#define MPMI_LOCKING_STIFFNESS_H

#include "implicit/balance.h"

/* First all cells are cleared; */
mpm_status mpmi_locking_stiffness_begin(mpmi_balance *s);
/* then of each batch the part of theta goes into the tangent, in place, with h [9][ld] for what couples the
 * particles of a cell; */
void mpmi_locking_stiffness_local(int32_t dim, const mpmi_law_batch *law, const double *weight,
                                  const double *volume, double *tangent, double *h);
/* each particle adds weight h F_inc^-T, F_inc^-1 and its new volume to its cell, with the
 * components 3 * row + column; */
typedef struct mpmi_locking_particle {
  double h[9], inverse[9], volume;
} mpmi_locking_particle;
void mpmi_locking_stiffness_add(mpmi_balance *s, const mpmi_newton_work *work, const mpmi_weights *W,
                                int64_t p, int32_t cell_place, const mpmi_locking_particle *of);
/* and at last the cells go into the matrix. */
void mpmi_locking_stiffness_end(mpmi_balance *s);

#endif
