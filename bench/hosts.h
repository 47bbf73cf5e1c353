/* Linear solvers of the host, by name, where the benchmark was built with them: those of the examples. */
#ifndef BENCH_HOSTS_H
#define BENCH_HOSTS_H

#include <mpm/mpm.h>

typedef struct bench_host {
  const char *name;
  void *(*open)(void); /* NULL: it does not start */
  mpm_solve_fn solve;
  void (*close)(void *opened);
} bench_host;

/* NULL: the benchmark was built without. */
const bench_host *bench_find_host(const char *name);

#endif
