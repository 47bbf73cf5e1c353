/* Vectors of space, by three components. */
#ifndef MPMI_VECTOR3_H
#define MPMI_VECTOR3_H

static inline double mpmi_inner(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void mpmi_cross(const double *a, const double *b, double *out) {
  for (int c = 0; c < 3; ++c) out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

#endif
