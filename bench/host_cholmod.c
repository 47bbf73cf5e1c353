#include "hosts.h"

#ifdef BENCH_CHOLMOD
#include "../examples/cholmod_direct.h"

static void *start(void) {
  cholmod_direct *own = malloc(sizeof *own);
  if (own) cholmod_direct_open(own);
  return own;
}

static void end(void *own) {
  cholmod_direct_close(own);
  free(own);
}

extern const bench_host bench_cholmod;
const bench_host bench_cholmod = {"CHOLMOD", start, cholmod_direct_solve, end};
#endif
