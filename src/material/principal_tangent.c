#include "material/principal_tangent.h"

/* Returns g_AB, or its limit for equal principal values where they are so close that the quotient loses its
 * digits. What counts as close goes with the size of the strain: at small strains all values are close, and
 * the law still tells them from each other. */
MPMI_INLINE double mixed(const mpmi_principal *o, int p, int one, int two) {
  double apart = o->b[one][p] - o->b[two][p];
  double size = fabs(o->b[0][p]) + fabs(o->b[1][p]) + fabs(o->b[2][p]);
  double t = o->tau[one][p] * (1.0 + o->b[two][p]) - o->tau[two][p] * (1.0 + o->b[one][p]);
  double limit = 0.5 * (o->slope[one][one][p] - o->slope[one][two][p]) - o->tau[one][p];
  int near = fabs(apart) < 1e-7 * size + 1e-300;
  return near ? limit : t / (near ? 1.0 : apart);
}

MPMI_INLINE double entry(int dim, const mpmi_principal *o, const double (*g)[MPMI_CHUNK], int p, int i, int j,
                         int k, int l) {
  double c = 0.0;
  for (int one = 0; one < dim; ++one) {
    double ij = o->vector[one][i][p] * o->vector[one][j][p];
    for (int two = 0; two < dim; ++two) {
      double a = o->slope[one][two][p] - (one == two ? 2.0 * o->tau[one][p] : 0.0);
      c += a * ij * (o->vector[two][k][p] * o->vector[two][l][p]);
    }
  }
  for (int one = 0; one < dim; ++one)
    for (int two = one + 1; two < dim; ++two) {
      const double(*u)[MPMI_CHUNK] = o->vector[one], (*v)[MPMI_CHUNK] = o->vector[two];
      double ij = u[i][p] * v[j][p] + v[i][p] * u[j][p], kl = u[k][p] * v[l][p] + v[k][p] * u[l][p];
      c += g[one + two - 1][p] * ij * kl;
    }
  return c;
}

/* c has both minor symmetries: each entry is made once and goes to the rows that are equal to it. */
static void write_entry(int dim, int ij, int kl, const double *c, double *tangent, int64_t ld) {
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          if (mpmi_sym_index(i, j) == ij && mpmi_sym_index(k, l) == kl)
            memcpy(tangent + (27 * i + 9 * j + 3 * k + l) * ld, c, MPMI_CHUNK * sizeof *c);
}

MPMI_INLINE void rows(int dim, const mpmi_principal *o, double *tangent, int64_t ld) {
  _Alignas(64) double g[3][MPMI_CHUNK] = {{0.0}}, c[MPMI_CHUNK];
  for (int one = 0; one < dim; ++one)
    for (int two = one + 1; two < dim; ++two)
      for (int p = 0; p < MPMI_CHUNK; ++p) g[one + two - 1][p] = mixed(o, p, one, two);
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = k; l < dim; ++l) {
          MPMI_IVDEP
          for (int p = 0; p < MPMI_CHUNK; ++p)
            c[p] = entry(dim, o, (const double(*)[MPMI_CHUNK])g, p, i, j, k, l);
          write_entry(dim, mpmi_sym_index(i, j), mpmi_sym_index(k, l), c, tangent, ld);
        }
}

void KERNEL(principal_rows)(int32_t dim, const mpmi_principal *o, double *tangent, int64_t ld) {
  if (dim == 3)
    rows(3, o, tangent, ld);
  else if (dim == 2)
    rows(2, o, tangent, ld);
  else
    rows(1, o, tangent, ld);
}
