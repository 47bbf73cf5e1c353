/* Energies, momenta and the stable rate of a batch, and a look at what the law returned. */
#include "material/deformation.h"
#include "simd/chunk.h"
#include "simd/pack.h"
#include "simd/rounding.h"
#include "transfer/sums.h"

/* What has been added up; the least of what stands for wave speeds; and the largest rate so far, with what is
 * surely below rate h_k. */
typedef struct mpmi_tally {
  mpmi_lanes kinetic, affine, strain, work, viscosity, bad, least, momentum[3], angular[3], below[3];
  double rate;
} mpmi_tally;

/* Returns the second moment D of the basis at a particle, for the affine part of energy and angular
 * momentum. */
MPMI_INLINE mpmi_lanes second_moment(const mpmi_sums_job *job, int32_t axis, int64_t s) {
  if (job->moment[axis]) return mpmi_lanes_load(job->moment[axis] + s);
  const mpmi_lanes zero = {0.0};
  return zero + job->constant_moment[axis];
}

/* Adds component r of the angular momentum, m (x x v + sum_k D_k e_k x C e_k), with a, b the two other
 * axes. */
MPMI_INLINE void add_angular(int32_t dim, const mpmi_sums_job *job, int64_t s, int32_t r, mpmi_lanes m,
                             const mpmi_lanes *x, const mpmi_lanes *v, mpmi_tally *t) {
  const int32_t a = (r + 1) % 3, b = (r + 2) % 3;
  if (a >= dim || b >= dim) return;
  t->angular[r] += m * (x[a] * v[b] - x[b] * v[a]);
  if (!job->affine[0] || job->F[0]) return;
  t->angular[r] += m * (second_moment(job, a, s) * mpmi_lanes_load(job->affine[3 * b + a] + s) -
                        second_moment(job, b, s) * mpmi_lanes_load(job->affine[3 * a + b] + s));
}

/* Adds what the matrices have of it where they are over reference positions, m sum_k D_k F e_k x C e_k. */
MPMI_INLINE void add_reference_angular(int32_t dim, const mpmi_sums_job *job, int64_t s, mpmi_tally *t) {
  const mpmi_lanes m = mpmi_lanes_load(job->mass + s);
  mpmi_lanes moment[3][3], F[3][3];
  for (int32_t k = 0; k < dim; ++k) {
    const mpmi_lanes of_axis = m * second_moment(job, k, s);
    for (int32_t r = 0; r < dim; ++r) {
      moment[r][k] = of_axis * mpmi_lanes_load(job->affine[3 * r + k] + s);
      F[r][k] = mpmi_lanes_load(job->F[mpmi_stored_entry(dim, r, k)] + s);
    }
  }
  for (int32_t r = 0; r < 3; ++r) {
    const int32_t a = (r + 1) % 3, b = (r + 2) % 3;
    for (int32_t k = 0; k < dim && a < dim && b < dim; ++k)
      t->angular[r] += F[a][k] * moment[b][k] - F[b][k] * moment[a][k];
  }
}

/* Adds twice the energy of the affine part, m sum_k D_k |C e_k|^2. */
MPMI_INLINE void add_affine(int32_t dim, const mpmi_sums_job *job, int64_t s, mpmi_lanes m, mpmi_tally *t) {
  for (int32_t k = 0; job->affine[0] && k < dim; ++k) {
    mpmi_lanes square = {0.0};
    for (int32_t r = 0; r < dim; ++r) {
      const mpmi_lanes c = mpmi_lanes_load(job->affine[3 * r + k] + s);
      square += c * c;
    }
    t->affine += m * second_moment(job, k, s) * square;
  }
}

/* Adds the work of gravity and of the other external forces along axis k. */
MPMI_INLINE void add_work(const mpmi_sums_job *job, int64_t s, int32_t k, mpmi_lanes m, mpmi_lanes x,
                          mpmi_tally *t) {
  if (!job->x_old[0] || (job->gravity[k] == 0.0 && !job->force[0])) return;
  mpmi_lanes path = x - mpmi_lanes_load(job->x_old[k] + s), force = m * job->gravity[k];
  path -= job->period[k] * mpmi_lanes_round(path * job->inverse_period[k]);
  if (job->force[0]) force += mpmi_lanes_load(job->force[k] + s);
  t->work += force * path;
}

MPMI_INLINE void set_rate(int32_t dim, const mpmi_sums_job *job, double rate, mpmi_tally *t) {
  const double margin = 1.0 - 1e-14; /* what rounding adds to a rate is less by an order */
  const mpmi_lanes zero = {0.0};
  t->rate = rate;
  for (int32_t k = 0; k < dim; ++k) t->below[k] = zero + margin * rate * job->spacing[k];
}

/* Tells of the squares of wave speeds c whether a rate may be the largest so far: others are less than
 * rate h_k - |v_k| for each axis. */
MPMI_INLINE int32_t may_be_largest(int32_t dim, const mpmi_sums_job *job, mpmi_lanes square,
                                   const mpmi_lanes *v, const mpmi_tally *t) {
  const mpmi_lanes zero = {0.0};
  mpmi_lanes room = t->below[0] - job->carried * mpmi_lanes_abs(v[0]);
  for (int32_t k = 1; k < dim; ++k)
    room = mpmi_lanes_min(room, t->below[k] - job->carried * mpmi_lanes_abs(v[k]));
  room = mpmi_lanes_max(zero, room);
  return mpmi_lanes_any(~(square < room * room), 1) != 0;
}

/* Takes the largest (|v_k| + c) / h_k. Few are the largest so far, and the roots of other squares are not
 * taken. */
MPMI_INLINE void add_rate(int32_t dim, const mpmi_sums_job *job, mpmi_lanes c_or_square, const mpmi_lanes *v,
                          mpmi_tally *t) {
  if (job->squared && !may_be_largest(dim, job, c_or_square, v, t)) return;
  const mpmi_lanes c = job->squared ? mpmi_lanes_sqrt(c_or_square) : c_or_square;
  mpmi_lanes rate = {0.0};
  for (int32_t k = 0; k < dim; ++k)
    rate = mpmi_lanes_max(rate, (job->carried * mpmi_lanes_abs(v[k]) + c) * job->inverse_spacing[k]);
  const double largest = mpmi_lanes_largest(rate);
  if (largest > t->rate) set_rate(dim, job, largest, t);
}

MPMI_INLINE void add_group(int32_t dim, const mpmi_sums_job *job, int64_t s, mpmi_tally *t) {
  const mpmi_lanes m = mpmi_lanes_load(job->mass + s), v0 = mpmi_lanes_load(job->initial_volume + s);
  const mpmi_mask live = v0 > 0.0; /* holes have no volume, and what the law says of them is of no interest */
  const mpmi_lanes c_or_square = mpmi_lanes_where(live, mpmi_lanes_load(job->wave_speed + s));
  if (job->what & MPMI_SUMS_LAW) {
    t->strain += v0 * mpmi_lanes_where(live, mpmi_lanes_load(job->energy + s));
    t->bad += c_or_square * 0.0; /* not 0 where a value is not finite */
    t->least = mpmi_lanes_min(t->least, c_or_square);
    if (job->kinematic_viscosity) {
      const mpmi_lanes nu = mpmi_lanes_where(live, mpmi_lanes_load(job->kinematic_viscosity + s));
      t->viscosity = mpmi_lanes_max(t->viscosity, nu);
      t->bad += nu * 0.0;
    }
    for (int32_t a = 0; a < 2; ++a)
      for (int32_t r = 0; r < job->checked_rows[a]; ++r)
        t->bad += mpmi_lanes_load(job->checked[a] + r * job->ld + s) * 0.0;
  }
  if (!(job->what & MPMI_SUMS_MOTION)) return;
  mpmi_lanes x[3], v[3];
  for (int32_t k = 0; k < dim; ++k) {
    x[k] = mpmi_lanes_load(job->x[k] + s);
    v[k] = mpmi_lanes_load(job->v[k] + s);
    const mpmi_lanes p = m * v[k];
    t->momentum[k] += p;
    t->kinetic += p * v[k];
    add_work(job, s, k, m, x[k], t);
  }
  add_rate(dim, job, c_or_square, v, t);
  for (int32_t r = 0; r < 3; ++r) add_angular(dim, job, s, r, m, x, v, t);
  add_affine(dim, job, s, m, t);
}

/* The places of what is summed over lanes, eight at a time; in 3-D alone there are more than eight. */
enum {
  SUM_KINETIC,
  SUM_AFFINE,
  SUM_STRAIN,
  SUM_WORK,
  SUM_BAD,
  SUM_MOMENTUM_X,
  SUM_MOMENTUM_Y,
  SUM_ANGULAR_Z,
  SUM_MOMENTUM_Z,
  SUM_ANGULAR_X,
  SUM_ANGULAR_Y,
  SUMMED = 16
};

/* Sums each of eight registers over its lanes, the first lane first. */
MPMI_INLINE void sum_lanes(const mpmi_lanes *of, double *sum) {
  _Alignas(64) double lane[8 * MPMI_LANES];
  mpmi_interleave8(of, lane);
  for (int32_t i = 0; i < 8; i += MPMI_LANES) {
    mpmi_lanes total = mpmi_lanes_load(lane + i);
    for (int32_t l = 1; l < MPMI_LANES; ++l) total += mpmi_lanes_load(lane + 8 * l + i);
    mpmi_lanes_store(sum + i, total);
  }
}

MPMI_INLINE uint32_t sum_batch(int32_t dim, const mpmi_sums_job *job, int64_t n, mpmi_sums *sums) {
  const mpmi_lanes zero = {0.0};
  mpmi_tally t;
  t.kinetic = t.affine = t.strain = t.work = t.viscosity = t.bad = t.least = zero;
  for (int32_t k = 0; k < 3; ++k) t.momentum[k] = t.angular[k] = zero;
  set_rate(dim, job, sums->rate, &t);
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) add_group(dim, job, s, &t);
  /* apart from the others, which are compiled to the same without it */
  if (job->what & MPMI_SUMS_MOTION && job->F[0] && job->affine[0])
    for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) add_reference_angular(dim, job, s, &t);
  double sum[SUMMED] = {0.0};
  const mpmi_lanes of[SUMMED] = {[SUM_KINETIC] = t.kinetic,
                                 [SUM_AFFINE] = t.affine,
                                 [SUM_STRAIN] = t.strain,
                                 [SUM_WORK] = t.work,
                                 [SUM_BAD] = t.bad,
                                 [SUM_MOMENTUM_X] = t.momentum[0],
                                 [SUM_MOMENTUM_Y] = t.momentum[1],
                                 [SUM_MOMENTUM_Z] = t.momentum[2],
                                 [SUM_ANGULAR_X] = t.angular[0],
                                 [SUM_ANGULAR_Y] = t.angular[1],
                                 [SUM_ANGULAR_Z] = t.angular[2]};
  sum_lanes(of, sum);
  if (dim == 3) sum_lanes(of + 8, sum + 8);
  sums->kinetic += 0.5 * sum[SUM_KINETIC];
  sums->affine += 0.5 * sum[SUM_AFFINE];
  sums->strain += sum[SUM_STRAIN];
  sums->work += sum[SUM_WORK];
  sums->momentum[0] += sum[SUM_MOMENTUM_X];
  sums->momentum[1] += sum[SUM_MOMENTUM_Y];
  sums->momentum[2] += sum[SUM_MOMENTUM_Z];
  sums->angular[0] += sum[SUM_ANGULAR_X];
  sums->angular[1] += sum[SUM_ANGULAR_Y];
  sums->angular[2] += sum[SUM_ANGULAR_Z];
  const double viscous_rate = mpmi_lanes_largest(t.viscosity) * job->viscous_factor;
  sums->rate = t.rate;
  if (viscous_rate > sums->viscous_rate) sums->viscous_rate = viscous_rate;
  const int32_t good = sum[SUM_BAD] == 0.0 && mpmi_lanes_smallest(t.least) >= 0.0;
  return good ? 0u : (uint32_t)MPMI_NONFINITE;
}

#define SUMS(dim)                                                                                            \
  uint32_t KERNEL(sums_##dim)(const mpmi_sums_job *job, int64_t n, mpmi_sums *sums);                         \
  uint32_t KERNEL(sums_##dim)(const mpmi_sums_job *job, int64_t n, mpmi_sums *sums) {                        \
    return sum_batch(dim, job, n, sums);                                                                     \
  }
SUMS(1)
SUMS(2)
SUMS(3)
