#ifndef BENCH_IMPLICIT_H
#define BENCH_IMPLICIT_H

#include "choice.h"

#include <stdint.h>
#include <stdio.h>

/* One Newton iteration of quasi-static steps, for each of so many numbers of threads; csv: a table, or NULL.
 * Not 0 where something is wrong. */
int32_t bench_implicit(const bench_choice *choice, int32_t repeats, const int64_t *threads, int32_t count,
                       FILE *csv);

#endif
