#include "material/objective_tangent.h"

MPMI_INLINE double contracted(mpmi_sym a, mpmi_sym b) {
  return 2.0 * (a.xy * b.xy + a.yz * b.yz + a.xz * b.xz) + a.xx * b.xx + a.yy * b.yy + a.zz * b.zz;
}

/* Change of the stress with D. */
MPMI_INLINE mpmi_sym stress_slope(int dim, const mpmi_objective *o, int p, mpmi_sym d) {
  mpmi_sym log_v = mpmi_load_sym(dim, o->of.log_v[0], MPMI_CHUNK, p);
  mpmi_sym turned = mpmi_load_sym(dim, o->of.turned[0], MPMI_CHUNK, p);
  mpmi_sym bend = mpmi_load_sym(dim, o->bend[0], MPMI_CHUNK, p);
  mpmi_vector u = mpmi_commutator(dim, log_v, d);
  mpmi_vector of_v = mpmi_transformed(dim, mpmi_load_sym(dim, o->stretching[0], MPMI_CHUNK, p), u);
  mpmi_vector of_r = mpmi_transformed(dim, mpmi_load_sym(dim, o->turning[0], MPMI_CHUNK, p), u);

  double trace = d.xx + d.yy + d.zz, shear2 = 2.0 * o->shear[p], keep = o->keep[p];
  mpmi_sym change = mpmi_add_turning(dim, mpmi_shifted(1.0, d, (-1.0 / 3.0) * trace), log_v, of_v);
  change = mpmi_add_turning(dim, mpmi_shifted(shear2, change, 0.0), turned, of_r);
  double back = contracted(bend, change), mean = o->bulk[p] * trace;
  mpmi_sym s = {mean + keep * change.xx - back * bend.xx, mean + keep * change.yy - back * bend.yy,
                mean + keep * change.zz - back * bend.zz, keep * change.xy - back * bend.xy,
                keep * change.yz - back * bend.yz,        keep * change.xz - back * bend.xz};
  return s;
}

MPMI_INLINE void slopes(int dim, mpmi_objective *o) {
  for (int k = 0; k < dim; ++k)
    for (int l = k; l < dim; ++l) {
      const int kl = mpmi_sym_index(k, l);
      mpmi_sym d = {k == 0 && l == 0,    k == 1 && l == 1,    k == 2 && l == 2,
                    kl == 3 ? 0.5 : 0.0, kl == 4 ? 0.5 : 0.0, kl == 5 ? 0.5 : 0.0};
      MPMI_IVDEP
      for (int p = 0; p < MPMI_CHUNK; ++p)
        mpmi_store_sym(dim, o->slope[kl][0], MPMI_CHUNK, p, stress_slope(dim, o, p, d));
    }
}

/* J (A_ijkl + s_ij d_kl - 1/2 (d_ik s_jl + d_il s_jk + d_jk s_il + d_jl s_ik)): the tangent of tau = J s, for
 * a law whose stress s changes by A_ijkl D_kl with a symmetric D, and turns with a superposed rotation.
 * slope: A by kl, then ij. Added to what is there where add is 1. */
static void stress_rows(int32_t dim, int32_t add, const double *jacobian, const double (*s)[MPMI_CHUNK],
                        const double (*slope)[6][MPMI_CHUNK], double *tangent, int64_t ld) {
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) {
          double *row = tangent + (27 * i + 9 * j + 3 * k + l) * ld;
          const double *a = slope[mpmi_sym_index(k, l)][mpmi_sym_index(i, j)];
          const double *ij = s[mpmi_sym_index(i, j)], *jl = s[mpmi_sym_index(j, l)];
          const double *jk = s[mpmi_sym_index(j, k)], *il = s[mpmi_sym_index(i, l)];
          const double *ik = s[mpmi_sym_index(i, k)];
          const double volume = k == l, of_jl = i == k ? 0.5 : 0.0, of_jk = i == l ? 0.5 : 0.0;
          const double of_il = j == k ? 0.5 : 0.0, of_ik = j == l ? 0.5 : 0.0;
          MPMI_IVDEP
          for (int p = 0; p < MPMI_CHUNK; ++p) {
            double turned = (of_jl * jl[p] + of_ik * ik[p]) + (of_jk * jk[p] + of_il * il[p]);
            double c = jacobian[p] * (a[p] + volume * ij[p] - turned);
            row[p] = add ? row[p] + c : c;
          }
        }
}

void KERNEL(objective_rows)(int32_t dim, int32_t add, mpmi_objective *o, double *tangent, int64_t ld) {
  if (dim == 3)
    slopes(3, o);
  else if (dim == 2)
    slopes(2, o);
  else
    slopes(1, o);
  stress_rows(dim, add, o->jacobian, (const double(*)[MPMI_CHUNK])o->stress,
              (const double(*)[6][MPMI_CHUNK])o->slope, tangent, ld);
}
