/* Sums of a step that reports are made of: of the particles by block, of the nodes by node. They are exact
 * sums (context/exact_sum.h), so that no bit depends on who adds what, and when. */
#ifndef MPMI_TALLY_H
#define MPMI_TALLY_H

#include "context/context.h"
#include "context/exact_sum.h"
#include "transfer/sums.h"

/* Where the sums stand: those of mpmi_sums, whose rates have none; impulses on walls by face and axis; the
 * work of the host on nodes; what damping took; impulses of prescribed particles by set and axis. */
enum {
  MPMI_TALLY_ENERGIES,
  MPMI_TALLY_FACES = MPMI_TALLY_ENERGIES + sizeof(mpmi_sums) / sizeof(double),
  MPMI_TALLY_WORK = MPMI_TALLY_FACES + 18,
  MPMI_TALLY_DAMPING,
  MPMI_TALLY_REACTIONS
};

typedef struct mpmi_tally {
  mpmi_whole_sum *sum;
  double *total; /* what each has come to, once the step is made */
  int64_t count, sum_capacity, total_capacity;
} mpmi_tally;

/* Empties the sums of a step with so many sets. */
mpm_status mpmi_tally_prepare(mpmi_tally *tally, mpm_context *context, int32_t sets);
void mpmi_tally_free(mpmi_tally *tally, mpm_context *context);

/* Adds what a block has in mpmi_sums: its sums to the first of `sum`, its rates to the largest in `rates`. */
void mpmi_tally_block(mpmi_whole_sum *sum, const mpmi_sums *block, mpmi_sums *rates);
/* Makes energies and momenta of their totals, beside the rates. */
void mpmi_tally_read(const double *total, mpmi_sums *sums);

#endif
