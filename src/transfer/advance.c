/* New particle velocity, position, deformation gradient and volume from what was gathered. */
#include "transfer/kernel_common.h"

/*   FLIP/PIC blend  v = a (v_p + sum w dv) + (1 - a) sum w v     MPoint theory eq. 36
 *   affine, PIC     v = sum w v
 *   position        x = x_p + dt sum w v                         Guilkey eq. 10, Steffen et al. 2008 eq. 10
 */
MPMI_INLINE uint32_t move(int32_t dim, const mpmi_move *job, int64_t n) {
  const double dt = job->dt, flip = job->flip, pic = 1.0 - flip;
  mpmi_lanes bad = {{0.0}}, outside = {{0.0}}, left = {{0.0}};
  for (int32_t k = 0; k < dim; ++k) {
    const double low = job->low[k], high = job->high[k], centre = job->centre[k], half = job->half[k];
    const double period = job->period[k], inverse = job->inverse_period[k];
    for (int64_t s = 0; s < mpmi_groups(n); s += MPMI_GROUP) {
      const double *v_bar = job->v_bar + k * job->ld + s, *dv = job->dv + k * job->ld + s;
      const double *x_old = job->x_old[k] + s, *v_old = job->v_old[k] + s;
      double *x_new = job->x_new[k] + s, *v_new = job->v_new[k] + s;
      if (job->form == MPMI_GATHER_8) {
        MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) v_new[i] =
            flip * (v_old[i] + dv[i]) + pic * v_bar[i];
      } else {
        MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) v_new[i] = v_bar[i];
      }
      MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) {
        double x = x_old[i] + dt * v_bar[i];
        bad.at[i] += (v_new[i] - v_new[i]) + (x - x);
        outside.at[i] += x < low || x > high ? 1.0 : 0.0;
        double d = x - centre;
        d -= period * mpmi_round(d * inverse);
        left.at[i] += d > half || d < -half ? 1.0 : 0.0;
        x_new[i] = x;
      }
    }
  }
  return (mpmi_lane_sum(&bad) == 0.0 ? 0u : (uint32_t)MPMI_NONFINITE) |
         (mpmi_lane_sum(&outside) > 0.0 ? (uint32_t)MPMI_OUTSIDE : 0u) |
         (mpmi_lane_sum(&left) > 0.0 ? (uint32_t)MPMI_LEFT_TILE : 0u);
}

/* Full 3x3 entries that may differ from the identity: a plane strain tensor keeps its zz. */
MPMI_INLINE int32_t has_entry(int32_t dim, int32_t row, int32_t column) {
  return (row < dim && column < dim) || (dim == 2 && row == 2 && column == 2);
}

/* F = (I + dt L) F_old: MPoint theory eq. 39, Steffen et al. 2008 eq. 8. */
MPMI_INLINE void deform(int32_t dim, const mpmi_deform *job, int64_t n) {
  const double dt = job->dt;
  const int64_t ld = job->ld;
  int32_t stored = 0, place[9];
  for (int32_t e = 0; e < 9; ++e) place[e] = has_entry(dim, e / 3, e % 3) ? stored++ : -1;
  if (job->F_inc)
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) {
        const double *L = job->L + (3 * r + c) * ld;
        double *F_inc = job->F_inc + (3 * r + c) * ld;
        const double unit = r == c ? 1.0 : 0.0;
        MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) F_inc[p] = unit + dt * L[p];
      }
  for (int32_t r = 0; r < dim; ++r)
    for (int32_t c = 0; c < dim; ++c) {
      const double *L0 = job->L + 3 * r * ld, *L1 = L0 + ld, *L2 = L1 + ld;
      const double *own = job->F_old[place[3 * r + c]];
      const double *F0 = job->F_old[place[c]];
      const double *F1 = dim > 1 ? job->F_old[place[3 + c]] : F0,
                   *F2 = dim > 2 ? job->F_old[place[6 + c]] : F0;
      double *F = job->F + (3 * r + c) * ld, *F_new = job->F_new[place[3 * r + c]];
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
        double s = L0[p] * F0[p];
        if (dim > 1) s += L1[p] * F1[p];
        if (dim > 2) s += L2[p] * F2[p];
        s = own[p] + dt * s;
        F[p] = s;
        F_new[p] = s;
      }
    }
  if (dim == 2) {
    const double *old = job->F_old[4];
    double *F = job->F + 8 * ld, *F_new = job->F_new[4];
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) F[p] = F_new[p] = old[p];
  }
}

/* V = det F V0: MPoint theory eq. 40. */
MPMI_INLINE uint32_t volume(int32_t dim, const double *const *F, const double *initial_volume, double *out,
                            int64_t n) {
  mpmi_lanes bad = {{0.0}}, inverted = {{0.0}};
  for (int64_t s = 0; s < mpmi_groups(n); s += MPMI_GROUP) {
    MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) {
      const int64_t p = s + i;
      double J;
      if (dim == 1)
        J = F[0][p];
      else if (dim == 2)
        J = (F[0][p] * F[3][p] - F[1][p] * F[2][p]) * F[4][p];
      else
        J = F[0][p] * (F[4][p] * F[8][p] - F[5][p] * F[7][p]) -
            F[1][p] * (F[3][p] * F[8][p] - F[5][p] * F[6][p]) +
            F[2][p] * (F[3][p] * F[7][p] - F[4][p] * F[6][p]);
      bad.at[i] += J - J;
      inverted.at[i] += J <= 0.0 ? 1.0 : 0.0;
      out[p] = J * initial_volume[p];
    }
  }
  return (mpmi_lane_sum(&bad) == 0.0 ? 0u : (uint32_t)MPMI_NONFINITE) |
         (mpmi_lane_sum(&inverted) > 0.0 ? (uint32_t)MPMI_NOT_POSITIVE : 0u);
}

#define ADVANCE(dim)                                                                                         \
  uint32_t KERNEL(move_##dim)(const mpmi_move *job, int64_t n);                                              \
  uint32_t KERNEL(move_##dim)(const mpmi_move *job, int64_t n) {                                             \
    return move(dim, job, n);                                                                                \
  }                                                                                                          \
  void KERNEL(deform_##dim)(const mpmi_deform *job, int64_t n);                                              \
  void KERNEL(deform_##dim)(const mpmi_deform *job, int64_t n) {                                             \
    deform(dim, job, n);                                                                                     \
  }                                                                                                          \
  uint32_t KERNEL(volume_##dim)(const double *const *F, const double *initial_volume, double *out,           \
                                int64_t n);                                                                  \
  uint32_t KERNEL(volume_##dim)(const double *const *F, const double *initial_volume, double *out,           \
                                int64_t n) {                                                                 \
    return volume(dim, F, initial_volume, out, n);                                                           \
  }
ADVANCE(1)
ADVANCE(2)
ADVANCE(3)
