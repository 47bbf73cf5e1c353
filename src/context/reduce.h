/* One number from the parts that different tasks made: energies, the stable dt, norms, dot products. Parts
 * are taken in the order of their numbers, so that no bit depends on who made them. */
#ifndef MPMI_REDUCE_H
#define MPMI_REDUCE_H

#include <stdint.h>

enum { MPMI_REDUCE_SUM, MPMI_REDUCE_MAX };

/* Returns start, with the parts added to it or the largest of it and the parts: part[stride * i] for i in [0,
 * count), or with a list for i in list[0 ... count - 1]. A part that is not a number is never the largest. */
double mpmi_reduce(int32_t operation, double start, const double *part, int64_t stride, const int32_t *list,
                   int64_t count);

#endif
