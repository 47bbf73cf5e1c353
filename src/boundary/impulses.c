#include "boundary/impulses.h"
#include "context/reduce.h"

void mpmi_note_impulse(const mpmi_bound *f, int64_t slot, int32_t c, double impulse, double change) {
  if (!f->records) return;
  f->nodes->impulse[slot].given[c] += f->share * impulse;
  f->nodes->impulse[slot].change[c] += f->share * change;
}

/* whole: as if no part of a tie were an image with the opposite sign. */
static double record(const mpmi_bound *f, int64_t slot, int32_t c, mpmi_component before, int32_t whole) {
  const double more = mpmi_given(f, slot, c) - before.given;
  const int32_t tie = mpmi_constraints_of(f)->tie_of[slot];
  if (tie < 0) {
    const double impulse = *mpmi_mass(f->values, slot) * more;
    mpmi_note_impulse(f, slot, c, impulse, mpmi_increment_of(f, slot, c) - before.increment);
    return impulse;
  }
  mpmi_tie_state *state = &f->nodes->tie_state[tie];
  const double impulse = (whole ? state->mass : state->net[c]) * more;
  state->recorded[c] += impulse;
  return impulse;
}

double mpmi_record(const mpmi_bound *f, int64_t slot, int32_t c, mpmi_component before) {
  return record(f, slot, c, before, 0);
}

double mpmi_record_whole(const mpmi_bound *f, int64_t slot, int32_t c, mpmi_component before) {
  return record(f, slot, c, before, 1);
}

void mpmi_add_block_work(mpmi_step *step) {
  step->host_work = mpmi_reduce(MPMI_REDUCE_SUM, step->host_work, step->work->block_work, 1, NULL,
                                step->layout->blocks.count);
}
