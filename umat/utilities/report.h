/* Messages of subroutines. */
#ifndef MPMU_REPORT_H
#define MPMU_REPORT_H

#include <stddef.h>

/* The text with %I, %R and %S replaced by the next of the integers, reals and words of 8 characters, for the
 * message callback of the host. lop: 1 information, -1 a warning, -2 an error, -3 an error after which the
 * subroutine does not go on. */
void mpmu_report(int lop, const char *text, size_t length, const int *integers, const double *reals,
                 const char *words);

#endif
