#include "hosts.h"

#ifdef BENCH_PETSC
#include "../examples/petsc_multigrid.h"

#include <stdlib.h>

static void *start(void) {
  multigrid *own = malloc(sizeof *own);
  if (own) *own = (multigrid){.pattern_id = -1};
  if (own && !multigrid_defaults() && !PetscInitialize(NULL, NULL, NULL, NULL)) return own;
  free(own);
  return NULL;
}

/* What PETSc says in its end is of no use here. */
static void end(void *own) {
  if (!multigrid_forget(own)) (void)!PetscFinalize();
  free(own);
}

extern const bench_host bench_petsc;
const bench_host bench_petsc = {"PETSc GAMG", start, multigrid_solve, end};
#endif
