#include "hosts.h"

#include <stddef.h>
#include <string.h>

#ifdef BENCH_CHOLMOD
extern const bench_host bench_cholmod;
#endif
#ifdef BENCH_PETSC
extern const bench_host bench_petsc;
#endif

const bench_host *bench_find_host(const char *name) {
  const bench_host *const hosts[] = {
#ifdef BENCH_CHOLMOD
      &bench_cholmod,
#endif
#ifdef BENCH_PETSC
      &bench_petsc,
#endif
      NULL};
  int i = 0;
  while (hosts[i] && strcmp(hosts[i]->name, name)) ++i;
  return hosts[i];
}
