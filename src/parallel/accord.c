/* What parts settle together in the conditions on the nodes of a projection. A part that has failed takes
 * part as well, and ends it for all: how often they meet is not known beforehand. */
#include "parallel/parts.h"

static const mpmi_accord *under_way(const mpmi_parts *parts) {
  return &parts->accord[parts->accords];
}

void mpmi_accord_end(mpmi_parts *parts) {
  ++parts->accords;
  parts->has_gathered = 0;
}

void mpmi_accord_gathered(mpmi_parts *parts) {
  parts->has_gathered = 1;
  if (!under_way(parts)->sweeps) mpmi_accord_end(parts);
}

mpm_status mpmi_accord_settle(mpmi_parts *parts, int64_t *word) {
  const mpm_status lost = mpmi_reduce_parts(parts->context, MPM_REDUCE_MAX, MPMI_ACCORD_WORDS, word);
  if (lost || !word[0]) return lost;
  mpmi_accord_end(parts);
  parts->is_echo = 1;
  return MPM_E_STATE;
}

void mpmi_accord_break(mpmi_parts *parts) {
  int64_t word[MPMI_ACCORD_WORDS] = {1};
  mpmi_arrivals in;
  if (!under_way(parts)->gathers || parts->has_gathered) {
    mpmi_reduce_parts(parts->context, MPM_REDUCE_MAX, MPMI_ACCORD_WORDS, word);
    mpmi_accord_end(parts);
    return;
  }
  mpmi_messages_clear(parts);
  mpmi_parts_exchange(parts, &in);
  mpmi_accord_gathered(parts);
}
