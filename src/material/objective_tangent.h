/* Tangents of laws in objective increments (objective_increment.h), for a chunk of particles: the derivative
 * of mean(J) I + keep (dev(R stress R^T) + 2 shear dev(ln V)) to dF_inc = D F_inc, with keep the radial
 * return of j2. */
#ifndef MPMI_OBJECTIVE_TANGENT_H
#define MPMI_OBJECTIVE_TANGENT_H

#include "material/objective_increment.h"
#include "material/spin.h"
#include "material/tangent_rows.h"

/* bulk: d mean / tr D. The return changes by -(bend : d) bend when the deviator before it changes by d. */
typedef struct mpmi_objective {
  _Alignas(64) double jacobian[MPMI_CHUNK], bulk[MPMI_CHUNK], shear[MPMI_CHUNK], keep[MPMI_CHUNK];
  double stress[6][MPMI_CHUNK], bend[6][MPMI_CHUNK];
  mpmi_increment_rows of;
  double stretching[6][MPMI_CHUNK], turning[6][MPMI_CHUNK];
  double slope[6][6][MPMI_CHUNK]; /* of the stress: by D, then by component */
} mpmi_objective;

/* Loads what all of these laws need of the chunk from particle `begin` on. */
MPMI_INLINE void mpmi_objective_load(int dim, mpmi_objective *o, const mpm_material_batch *batch,
                                     mpmi_increments in, int64_t begin) {
  mpmi_find_increments(dim, in, begin, &o->of);
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_spins spins = mpmi_spins_of(dim, mpmi_load_sym(dim, o->of.log_v[0], MPMI_CHUNK, p));
    o->jacobian[p] = 1.0 + mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, batch->F, batch->ld, begin + p));
    o->keep[p] = 1.0;
    mpmi_store_sym(dim, o->stretching[0], MPMI_CHUNK, p, spins.stretching);
    mpmi_store_sym(dim, o->turning[0], MPMI_CHUNK, p, spins.turning);
  }
}

/* Loads the chunk from particle `begin` on for an elastic law. */
MPMI_INLINE void mpmi_elastic_chunk(int dim, const mpmi_elastic *c, const mpm_material_batch *batch,
                                    int64_t begin, mpmi_objective *o) {
  const double mu = c->mu, bulk = c->lambda + (2.0 / 3.0) * mu;
  mpmi_objective_load(dim, o, batch, mpmi_increments_of(batch), begin);
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_store_sym(dim, o->stress[0], MPMI_CHUNK, p,
                   mpmi_load_sym(dim, batch->stress_new, batch->ld, begin + p));
    o->bulk[p] = bulk;
    o->shear[p] = mu;
  }
}

/* Writes the tangent of a chunk of which everything but the slopes is known, or adds it where add is 1. */
void KERNEL(objective_rows)(int32_t dim, int32_t add, mpmi_objective *o, double *tangent, int64_t ld);

#endif
