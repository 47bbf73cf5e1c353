#include "context/reduce.h"

double mpmi_reduce(int32_t operation, double start, const double *part, int64_t stride, const int32_t *list,
                   int64_t count) {
  double result = start;
  for (int64_t k = 0; k < count; ++k) {
    const double one = part[stride * (list ? list[k] : k)];
    if (operation == MPMI_REDUCE_SUM)
      result += one;
    else if (one > result)
      result = one;
  }
  return result;
}
