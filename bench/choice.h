/* Which cases of a table are run, and what is printed for against.py, which runs them with two libraries. */
#ifndef BENCH_CHOICE_H
#define BENCH_CHOICE_H

#include <stdint.h>

typedef struct bench_choice {
  const char *only, *exactly; /* part of a name, a name; or NULL */
  int32_t list;               /* only the names */
  int32_t bare; /* lines of fields between tabs: the library once, then name, threads, figure, hash; the
                   figure is the best of the repeats, by time of the processor */
} bench_choice;

int32_t bench_chosen(const bench_choice *choice, const char *name);
/* The file from which the library was loaded; 0 if that is not to be found out. */
int32_t bench_print_library(void);
void bench_print_bare(const char *name, int32_t threads, double figure, uint64_t hash);

#endif
