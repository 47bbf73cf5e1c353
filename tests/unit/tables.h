/* Tables of tests: a part of them in the suite, and all others where there is time. */
#ifndef TEST_TABLES_H
#define TEST_TABLES_H

#include <check.h>
#include <stdint.h>

/* A case for what takes long because it is much: it has the tag "wide". */
TCase *wide_case(Suite *suite, const char *name);
/* Adds every so many of a table of tests to a case, and the others to a wide one: of a part of the table, of
 * all of it, and every fifth. */
void add_part(TCase *some, TCase *wide, const TTest *test, int32_t first, int32_t end, int32_t every);
void add_every(TCase *some, TCase *wide, const TTest *test, int32_t count, int32_t every);
void add_table(TCase *some, TCase *wide, const TTest *test, int32_t count);
/* Adds a table of tests; where MPM_SPARSE is set, as the gate does under a sanitizer, the last of every so
 * many. */
void add_sparse(TCase *tests, const TTest *test, int32_t count, int32_t every);

#endif
