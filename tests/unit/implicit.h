/* What the files of the suite share: bodies under implicit steps. */
#ifndef IMPLICIT_H
#define IMPLICIT_H

#include "world.h"

enum { IMPLICIT_BASES = 7, IMPLICIT_HISTORY = 64 };
/* These are all bases but uGIMP. */
const basis_option *implicit_basis(int32_t i);

/* MPM_NEWMARK on a grid of `cells` cells of edge h. */
world_desc implicit_default(int32_t dim, int64_t cells, double h, const basis_option *basis);
/* Fills a block with 2 particles per cell along each axis and returns how many; velocity may be NULL. */
int64_t implicit_block(world *w, mpm_particles *set, double low, double high, const double *velocity);
/* Residuals of the last step. */
int32_t implicit_history(const world *w, double *residual);
void implicit_quadratic(const char *name, const world *w, double C);

TCase *implicit_extension_case(void);
TCase *implicit_symmetry_case(void);
TCase *implicit_mirrors_case(void);
TCase *implicit_failures_case(void);
TCase *implicit_large_case(TCase *wide); /* the same of large bodies */

#endif
