#include "contact/half_width.h"
#include "simd/elementary.h"

double mpmi_half_edge(int32_t dim, double volume) {
  switch (dim) {
  case 1:
    return 0.5 * volume;
  case 2:
    return 0.5 * sqrt(volume);
  default:
    return 0.5 * mpmi_cbrt(volume);
  }
}
