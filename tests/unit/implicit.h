/* What the files of the suite share: bodies under implicit steps. */
#ifndef IMPLICIT_H
#define IMPLICIT_H

#include "support.h"

typedef struct implicit_basis {
  int32_t basis, boundary;
  const char *name;
} implicit_basis;
enum { IMPLICIT_BASES = 7, IMPLICIT_HISTORY = 64 };
extern const implicit_basis implicit_bases[IMPLICIT_BASES];

/* MPM_NEWMARK on a grid of `cells` cells of edge h. */
world_desc implicit_default(int32_t dim, int64_t cells, double h, const implicit_basis *basis);
/* A block of 2 particles per cell along each axis; velocity may be NULL. */
void implicit_block(world *w, mpm_particles *set, double low, double high, const double *velocity);
/* Residuals of the last step. */
int32_t implicit_history(const world *w, double *residual);
void implicit_quadratic(const char *name, const world *w, double C);

TCase *implicit_failures_case(void);

#endif
