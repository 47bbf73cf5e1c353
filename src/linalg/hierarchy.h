/* The levels of the multigrid, from the matrix of the system to the coarsest one, which is factored. */
#ifndef MPMI_HIERARCHY_H
#define MPMI_HIERARCHY_H

#include "linalg/factor.h"
#include "linalg/level.h"

enum { MPMI_MOST_LEVELS = 24 };

typedef struct mpmi_hierarchy {
  int32_t levels; /* 0: there is none */
  mpmi_level level[MPMI_MOST_LEVELS];
  mpmi_factor coarsest;
  double *rhs, *x; /* right-hand side and solution of the coarsest level */
  int64_t coarsest_capacity;
} mpmi_hierarchy;

/* alternating: the second level has functions that change their sign from node to node of the first one,
 * which is left without a smoother. */
void mpmi_hierarchy_init(mpmi_hierarchy *h, mpm_context *context, int32_t alternating);
void mpmi_hierarchy_free(mpmi_hierarchy *h, mpm_context *context);
/* Makes the levels for the pattern of A. */
mpm_status mpmi_hierarchy_analyse(mpmi_hierarchy *h, mpmi_level_memory *w, const mpmi_matrix *A);
/* Makes their numbers; for failures see mpmi_multigrid_prepare(). */
mpm_status mpmi_hierarchy_prepare(mpmi_hierarchy *h, mpmi_level_memory *w, const mpmi_matrix *A,
                                  int64_t *row);

#endif
