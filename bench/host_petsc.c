#include "hosts.h"

#ifdef BENCH_PETSC
#include <mpm/mpm_petsc.h>
#include <petscsys.h>

static void *start(void) {
  mpm_petsc *own = NULL;
  if (!PetscInitialize(NULL, NULL, NULL, NULL)) (void)!mpm_petsc_open(PETSC_COMM_SELF, "", &own);
  return own;
}

/* What PETSc says in its end is of no use here. */
static void end(void *own) {
  if (!mpm_petsc_close(own)) (void)!PetscFinalize();
}

extern const bench_host bench_petsc;
const bench_host bench_petsc = {"PETSc GAMG", start, mpm_petsc_solve, end};
#endif
