#include "tables.h"

#include <stdlib.h>

TCase *wide_case(Suite *suite, const char *name) {
  TCase *wide = tcase_create(name);
  tcase_set_tags(wide, "wide");
  tcase_set_timeout(wide, 300);
  suite_add_tcase(suite, wide);
  return wide;
}

void add_part(TCase *some, TCase *wide, const TTest *test, int32_t first, int32_t end, int32_t every) {
  for (int32_t i = first; i < end; ++i)
    tcase_add_loop_test((i - first) % every ? wide : some, test, i, i + 1);
}

void add_every(TCase *some, TCase *wide, const TTest *test, int32_t count, int32_t every) {
  add_part(some, wide, test, 0, count, every);
}

void add_table(TCase *some, TCase *wide, const TTest *test, int32_t count) {
  add_every(some, wide, test, count, 5);
}

void add_sparse(TCase *tests, const TTest *test, int32_t count, int32_t every) {
  const int32_t step = getenv("MPM_SPARSE") ? every : 1;
  for (int32_t i = step - 1; i < count; i += step) tcase_add_loop_test(tests, test, i, i + 1);
}
