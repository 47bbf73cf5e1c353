/* Sums of a step that reports are made of: of the particles by block, of the nodes by node. They are exact
 * sums (context/exact_sum.h), so that no bit depends on who adds what, and when. */
#ifndef MPMI_TALLY_H
#define MPMI_TALLY_H

#include "context/context.h"
#include "context/exact_sum.h"
#include "transfer/sums.h"

/* Where the sums stand: those of mpmi_sums, whose rates have none; impulses on walls by face and axis; the
 * work of the host on nodes; what damping and contact took; impulses of prescribed particles by set and axis;
 * then, by pair of bodies, what they do to each other: impulse and moment by axis, and the rest. */
enum {
  MPMI_TALLY_ENERGIES,
  MPMI_TALLY_FACES = MPMI_TALLY_ENERGIES + sizeof(mpmi_sums) / sizeof(double),
  MPMI_TALLY_WORK = MPMI_TALLY_FACES + 18,
  MPMI_TALLY_DAMPING,
  MPMI_TALLY_CONTACT,
  MPMI_TALLY_REACTIONS
};
enum {
  MPMI_PAIR_IMPULSE,
  MPMI_PAIR_MOMENT = 3,
  MPMI_PAIR_NORMAL = 6,
  MPMI_PAIR_AREA,
  MPMI_PAIR_DISSIPATION,
  MPMI_PAIR_FRICTION_WORK,
  MPMI_PAIR_SUMS
};

typedef struct mpmi_tally {
  mpmi_whole_sum *sum;
  double *total;                                      /* what each has come to, once the step is made */
  int64_t count, pairs, sum_capacity, total_capacity; /* pairs: where those of pairs begin */
} mpmi_tally;

/* Empties the sums of a step with so many sets and pairs of bodies. */
mpm_status mpmi_tally_prepare(mpmi_tally *tally, mpm_context *context, int32_t sets, int64_t pairs);
void mpmi_tally_free(mpmi_tally *tally, mpm_context *context);

/* Adds what a block has in mpmi_sums: its sums to the first of `sum`, its rates to the largest in `rates`. */
void mpmi_tally_block(mpmi_whole_sum *sum, const mpmi_sums *block, mpmi_sums *rates);
/* Makes energies and momenta of their totals, beside the rates. */
void mpmi_tally_read(const double *total, mpmi_sums *sums);

/* Finds the sums of a pair. */
static inline mpmi_whole_sum *mpmi_tally_pair(const mpmi_tally *tally, int64_t pair) {
  return tally->sum + tally->pairs + MPMI_PAIR_SUMS * pair;
}

#endif
