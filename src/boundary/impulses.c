/* What boundary conditions give to the particles, recorded as impulses on nodes and ties. */
#include "boundary/bound.h"

/* Records the impulse of a component that has changed. With whole, it counts on all mass of the tie, also on
 * images that move the other way. */
static double record(mpmi_bound *bound, int64_t slot, int32_t c, mpmi_component before, int32_t whole) {
  const double more = mpmi_given(bound, slot, c) - before.given;
  const int32_t tie = mpmi_constraints_of(bound)->tie_of[slot];
  if (tie < 0) {
    const double impulse = *mpmi_mass(bound->values, slot) * more;
    mpmi_note_impulse(bound, slot, c, impulse, mpmi_increment_of(bound, slot, c) - before.increment);
    return impulse;
  }
  mpmi_tie_state *state = &bound->nodes->tie_state[tie];
  const double impulse = (whole ? state->mass : state->net[c]) * more;
  state->recorded[c] += impulse;
  return impulse;
}

double mpmi_record(mpmi_bound *bound, int64_t slot, int32_t c, mpmi_component before) {
  return record(bound, slot, c, before, 0);
}

double mpmi_work_done(const mpmi_bound *bound, int64_t slot, int32_t c, mpmi_component before,
                      double velocity) {
  return mpmi_moving_mass(bound, slot) * (mpmi_given(bound, slot, c) - before.given) * velocity;
}

double mpmi_press_node(mpmi_bound *bound, int64_t slot, int32_t c, double by) {
  const mpmi_component before = mpmi_component_of(bound, slot, c);
  mpmi_velocity(bound->values, slot)[c] += by;
  if (mpmi_has_increments(bound->values)) mpmi_increment(bound->values, slot)[c] += by;
  return record(bound, slot, c, before, 1);
}

static void change(mpmi_bound *bound, int64_t slot, int32_t c, double velocity, double increment) {
  mpmi_velocity(bound->values, slot)[c] += velocity;
  if (mpmi_has_increments(bound->values)) mpmi_increment(bound->values, slot)[c] += increment;
}

double mpmi_shift_node(mpmi_bound *bound, int64_t slot, int32_t c, double velocity, double increment) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int32_t at = constraints->tie_of[slot];
  const double given = bound->flip * increment + (1.0 - bound->flip) * velocity;
  change(bound, slot, c, velocity, increment);
  if (at < 0) return given;
  mpmi_tie_state *state = &bound->nodes->tie_state[at];
  state->before[c] += given;
  state->increment[c] += increment;
  for (int64_t d = 0; d < constraints->tie[at].count; ++d) {
    const mpmi_follower *follower = &constraints->follower[constraints->tie[at].first + d];
    change(bound, follower->slot, c, follower->sign[c] * velocity, follower->sign[c] * increment);
  }
  return given;
}

/* What walls take of it the other way round, through mirrored ghosts, is theirs. Of nodes that are not tied
 * the party remembers the change. */
void mpmi_push_node(mpmi_bound *bound, int64_t slot, int32_t c, double by) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int32_t tie = constraints->tie_of[slot];
  mpmi_velocity(bound->values, slot)[c] += by;
  if (mpmi_has_increments(bound->values)) mpmi_increment(bound->values, slot)[c] += by;
  if (tie < 0) return;
  /* unfolding counts all changes of tied nodes as reactions, this one too */
  bound->nodes->tie_state[tie].recorded[c] += bound->nodes->tie_state[tie].mass * by;
  mpmi_note_impulse(bound, slot, c, -*mpmi_mass(bound->values, slot) * by, 0.0);
  for (int64_t i = 0; i < constraints->tie[tie].count; ++i) {
    const mpmi_follower *follower = &constraints->follower[constraints->tie[tie].first + i];
    const double mass = *mpmi_mass(bound->values, follower->slot);
    mpmi_note_impulse(bound, follower->slot, c, -mass * follower->sign[c] * by, 0.0);
  }
}
