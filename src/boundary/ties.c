/* Nodes that are tied together (grid/constraints.h) move as one: folded into their masters while host, walls
 * and contacts act, and unfolded afterwards. */
#include "boundary/bound.h"

void mpmi_ties_fold(mpmi_bound *bound) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int32_t both = mpmi_has_increments(bound->values);
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    mpmi_tie_state *state = &bound->nodes->tie_state[i];
    double *v = mpmi_velocity(bound->values, tie->master), *dv = mpmi_increment(bound->values, tie->master);
    const double mass = *mpmi_mass(bound->values, tie->master);
    double momentum[3], gained[3];
    state->mass = mass;
    for (int32_t c = 0; c < bound->dim; ++c) {
      state->net[c] = mass;
      state->before[c] = mpmi_given(bound, tie->master, c);
      state->increment[c] = mpmi_increment_of(bound, tie->master, c);
      state->recorded[c] = 0.0;
      momentum[c] = mass * v[c];
      gained[c] = both ? mass * dv[c] : 0.0;
    }
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &constraints->follower[d];
      const double *of = mpmi_velocity(bound->values, follower->slot);
      const double its_mass = *mpmi_mass(bound->values, follower->slot);
      state->mass += its_mass;
      for (int32_t c = 0; c < bound->dim; ++c) {
        const double signed_mass = follower->sign[c] * its_mass;
        state->net[c] += signed_mass;
        momentum[c] += signed_mass * of[c];
        if (both) gained[c] += signed_mass * mpmi_increment(bound->values, follower->slot)[c];
      }
    }
    const double inverse = state->mass > bound->step->layout->mass_cut ? 1.0 / state->mass : 0.0;
    for (int32_t c = 0; tie->count && c < bound->dim; ++c) {
      v[c] = momentum[c] * inverse;
      if (both) dv[c] = gained[c] * inverse;
    }
  }
}

/* Holds at 0 what walls hold. A node on the plane is its own mirror image: the projected velocity of the
 * component is 0 as well, so that there is no increment. Only so is half a symmetric body on a slip wall the
 * same as the whole. */
void mpmi_ties_hold_walls(mpmi_bound *bound) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    for (int32_t c = 0; c < bound->dim; ++c) {
      if (!tie->zero[c] || mpmi_held_by(bound->nodes, tie->master, c)) continue;
      mpmi_velocity(bound->values, tie->master)[c] = 0.0;
      if (mpmi_has_increments(bound->values)) mpmi_increment(bound->values, tie->master)[c] = 0.0;
    }
  }
}

/* Gives a follower one component of its master's velocity; returns the impulse. */
static double follow(mpmi_bound *bound, int64_t master, const mpmi_follower *follower, int32_t c) {
  const int64_t slot = follower->slot;
  const mpmi_component before = mpmi_component_of(bound, slot, c);
  mpmi_velocity(bound->values, slot)[c] = follower->sign[c] * mpmi_velocity(bound->values, master)[c];
  if (mpmi_has_increments(bound->values))
    mpmi_increment(bound->values, slot)[c] = follower->sign[c] * mpmi_increment(bound->values, master)[c];
  const double impulse = *mpmi_mass(bound->values, slot) * (mpmi_given(bound, slot, c) - before.given);
  mpmi_note_impulse(bound, slot, c, impulse, mpmi_increment_of(bound, slot, c) - before.increment);
  return impulse;
}

void mpmi_ties_unfold(mpmi_bound *bound) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    const mpmi_tie_state *state = &bound->nodes->tie_state[i];
    for (int32_t c = 0; c < bound->dim; ++c) {
      double total =
          *mpmi_mass(bound->values, tie->master) * (mpmi_given(bound, tie->master, c) - state->before[c]);
      mpmi_note_impulse(bound, tie->master, c, total,
                        mpmi_increment_of(bound, tie->master, c) - state->increment[c]);
      for (int64_t d = tie->first; d < tie->first + tie->count; ++d)
        total += follow(bound, tie->master, &constraints->follower[d], c);
      if (bound->records && tie->face[c] >= 0 && !mpmi_held_by(bound->nodes, tie->master, c))
        bound->step->impulse_by_face[tie->face[c]][c] += bound->share * (total - state->recorded[c]);
    }
  }
}
