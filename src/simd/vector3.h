/* Vectors of space, by three components, and matrices of them. */
#ifndef MPMI_VECTOR3_H
#define MPMI_VECTOR3_H

#include <stdint.h>

static inline double mpmi_inner(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void mpmi_cross(const double *a, const double *b, double *out) {
  for (int c = 0; c < 3; ++c) out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

/* Inverts a matrix, and returns its determinant. */
static inline double mpmi_invert3(double M[3][3], double inverse[3][3]) {
  double det = 0.0;
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) {
      const int32_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      inverse[i][j] = M[a][c] * M[b][d] - M[a][d] * M[b][c];
    }
  for (int32_t i = 0; i < 3; ++i) det += M[0][i] * inverse[i][0];
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) inverse[i][j] /= det;
  return det;
}

#endif
