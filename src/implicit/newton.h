/* Newton's method for the displacements of one implicit step: Guilkey & Weiss 2003, eqs 11-13, for any beta
 * and gamma.
 *
 * The first increment carries the prescribed displacements on its right-hand side (tangent predictor): nodes
 * that are moved at once, with the rest at rest, turn cells inside out. Increments that do so all the same,
 * or that take the residual up, are halved. */
#ifndef MPMI_NEWTON_H
#define MPMI_NEWTON_H

#include "implicit/balance.h"

/* The displacements of the step in vector[MPMI_U], forces and stress in place. */
mpm_status mpmi_newton_solve(mpmi_balance *s);

#endif
