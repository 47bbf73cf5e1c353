/* One level of the multigrid, and the two steps that make the next one from it. */
#ifndef MPMI_LEVEL_H
#define MPMI_LEVEL_H

#include "linalg/sweep.h"
#include "linalg/vectors.h"

/* How the nodes of a level and those of the next coarser one belong together. */
typedef struct mpmi_coarsening {
  int32_t alternating;   /* what is interpolated changes its sign from each fine node to the next */
  int64_t *parent_start; /* [rows + 1] */
  int32_t *parent;       /* the coarse nodes that a node lies between */
  int64_t *child_start;  /* [coarse rows + 1] */
  int32_t *child;        /* the nodes that have a coarse node as parent */
  int64_t most_nodes;    /* the most nodes that couple with the children of one coarse node */
  char *slab;
  int64_t slab_capacity;
} mpmi_coarsening;

typedef struct mpmi_level {
  const mpmi_matrix *A; /* the matrix of the system, or own */
  mpmi_matrix own;
  mpmi_coarsening next; /* not used on the coarsest level */
  mpmi_smoother smoother;
} mpmi_level;

/* Returns the weight of each parent of a node. */
static inline double mpmi_parent_weight(const mpmi_coarsening *P, const mpmi_matrix *A, int64_t i) {
  const double weight = 1.0 / (double)(P->parent_start[i + 1] - P->parent_start[i]);
  return P->alternating && (A->index[i][0] + A->index[i][1] + A->index[i][2]) % 2 ? -weight : weight;
}

/* Memory that serves one step after the other. */
typedef struct mpmi_level_memory {
  mpm_context *context;
  char *memory;
  int64_t capacity;
} mpmi_level_memory;

/* Makes room for so many bytes; what was there is lost. */
mpm_status mpmi_level_memory_reserve(mpmi_level_memory *w, size_t bytes);
/* Tasks with scratch of their own: as many as run at once, or one where threads are not worth waking. */
mpmi_ranges mpmi_level_memory_tasks(const mpmi_level_memory *w, const mpmi_matrix *A);

/* Makes the next coarser level of l: its nodes, and the pattern and held unknowns of its matrix
 * (coarsen.c). */
mpm_status mpmi_coarsen(mpmi_level_memory *w, const mpmi_level *l, mpmi_level *next, mpmi_coarsening *to);
/* Makes the numbers of the matrix of the coarse level (galerkin.c). */
mpm_status mpmi_galerkin(mpmi_level_memory *w, const mpmi_matrix *A, const mpmi_coarsening *P,
                         mpmi_matrix *coarse);

#endif
