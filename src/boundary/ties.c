/* Nodes that are tied together (grid/constraints.h) move as one: folded into their masters while host, walls
 * and contacts act, and unfolded afterwards. */
#include "boundary/bound.h"

#include <float.h>
#include <string.h>

/* ---- the walk ----------------------------------------------------------------------------------------- */
/* Ties share no node, so that they are shared out among tasks; waking these costs as much as some of them. */
enum { FEW_TIES = 128 };

typedef void (*tie_fn)(mpmi_bound *bound, int64_t begin, int64_t end);
typedef struct tie_job {
  mpmi_bound *bound;
  tie_fn fn;
} tie_job;

static void take_share(void *data, int64_t k) {
  const tie_job *job = data;
  const mpmi_share share = mpmi_share_of(job->bound->step->settings, job->bound->tie_count, k);
  job->fn(job->bound, share.begin, share.end);
}

/* Returns the number of the i-th tie that is taken. */
static inline int64_t nth(const mpmi_bound *bound, int64_t i) {
  return bound->met ? bound->met[i] : i;
}

static mpm_status over_ties(mpmi_bound *bound, tie_fn fn) {
  const mpmi_settings *settings = bound->step->settings;
  tie_job job = {bound, fn};
  if (bound->tie_count >= FEW_TIES) return mpmi_run_tasks(settings, 0, settings->tasks, take_share, &job);
  fn(bound, 0, bound->tie_count);
  return MPM_OK;
}

/* ---- what is done to ties ----------------------------------------------------------------------------- */
static void fold(mpmi_bound *bound, int64_t begin, int64_t end) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int32_t both = mpmi_has_increments(bound->values);
  for (int64_t i = begin; i < end; ++i) {
    const int64_t at = nth(bound, i);
    const mpmi_tie *tie = &constraints->tie[at];
    mpmi_tie_state *state = &bound->nodes->tie_state[at];
    double *v = mpmi_velocity(bound->values, tie->master), *dv = mpmi_increment(bound->values, tie->master);
    const double mass = *mpmi_mass(bound->values, tie->master), cut = bound->step->layout->light_cut;
    double momentum[3], gained[3], apart[3] = {0.0, 0.0, 0.0}; /* apart: what light nodes have gained, no part
                                                                 * of their velocities yet */
    int32_t alone = 1;
    state->mass = mass;
    for (int32_t c = 0; c < bound->dim; ++c) {
      state->net[c] = mass;
      state->before[c] = mpmi_given(bound, tie->master, c);
      state->increment[c] = mpmi_increment_of(bound, tie->master, c);
      state->recorded[c] = 0.0;
      momentum[c] = mass * v[c];
      gained[c] = both ? mass * dv[c] : 0.0;
      if (!both || mass > cut) continue;
      apart[c] = gained[c];
      state->before[c] += (1.0 - bound->flip) * dv[c];
    }
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &constraints->follower[d];
      double *of = mpmi_velocity(bound->values, follower->slot);
      const double its_mass = *mpmi_mass(bound->values, follower->slot);
      state->mass += its_mass;
      alone &= its_mass == 0.0;
      for (int32_t c = 0; c < bound->dim; ++c) {
        const double signed_mass = follower->sign[c] * its_mass;
        state->net[c] += signed_mass;
        momentum[c] += signed_mass * of[c];
        if (!both) continue;
        const double its_gain = signed_mass * mpmi_increment(bound->values, follower->slot)[c];
        gained[c] += its_gain;
        if (its_mass > cut) continue;
        apart[c] += its_gain;
        of[c] += mpmi_increment(bound->values, follower->slot)[c];
      }
    }
    /* a node that has all the mass of its tie moves as if it were free, to the last bit: whether images
     * without mass are stored must not count */
    const double inverse = state->mass > DBL_MIN ? 1.0 / state->mass : 0.0;
    for (int32_t c = 0; !alone && c < bound->dim; ++c) {
      if (state->mass > cut) momentum[c] += apart[c];
      v[c] = momentum[c] * inverse;
      if (both) dv[c] = gained[c] * inverse;
    }
  }
}

/* Chooses the ties that are taken, and gives the others states without mass. */
static void choose(mpmi_bound *bound) {
  const mpmi_layout *layout = bound->step->layout;
  const int64_t ties = layout->constraints.tie_count;
  mpmi_nodes *nodes = bound->nodes;
  const int32_t leaves = mpmi_leaves_ties(layout, bound->step->settings);
  bound->met = leaves ? layout->met : NULL;
  bound->tie_count = leaves ? layout->met_count : ties;
  if (leaves && ties && nodes->tie_states_of != layout->covers)
    memset(nodes->tie_state, 0, (size_t)ties * sizeof *nodes->tie_state);
  nodes->tie_states_of = leaves ? layout->covers : -1;
}

mpm_status mpmi_ties_fold(mpmi_bound *bound) {
  choose(bound);
  return over_ties(bound, fold);
}

/* Holds at 0 what walls hold. A node on the plane is its own mirror image: the projected velocity of the
 * component is 0 as well, so that there is no increment. Only so is half a symmetric body on a slip wall the
 * same as the whole. */
static void hold(mpmi_bound *bound, int64_t begin, int64_t end) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  for (int64_t i = begin; i < end; ++i) {
    const mpmi_tie *tie = &constraints->tie[nth(bound, i)];
    for (int32_t c = 0; c < bound->dim; ++c) {
      if (!tie->zero[c] || mpmi_moved_by(bound->nodes, constraints, tie->master, c)) continue;
      mpmi_velocity(bound->values, tie->master)[c] = 0.0;
      if (mpmi_has_increments(bound->values)) mpmi_increment(bound->values, tie->master)[c] = 0.0;
    }
  }
}

mpm_status mpmi_ties_hold_walls(mpmi_bound *bound) {
  return over_ties(bound, hold);
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

/* What a tie's wall gets is left in the tie, to be added up in the order of the ties. */
static void unfold(mpmi_bound *bound, int64_t begin, int64_t end) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  for (int64_t i = begin; i < end; ++i) {
    const int64_t at = nth(bound, i);
    const mpmi_tie *tie = &constraints->tie[at];
    mpmi_tie_state *state = &bound->nodes->tie_state[at];
    for (int32_t c = 0; c < bound->dim; ++c) {
      double total =
          *mpmi_mass(bound->values, tie->master) * (mpmi_given(bound, tie->master, c) - state->before[c]);
      if (bound->loads) total += bound->step->velocity_dt * state->mirrored[c];
      mpmi_note_impulse(bound, tie->master, c, total,
                        mpmi_increment_of(bound, tie->master, c) - state->increment[c]);
      for (int64_t d = tie->first; d < tie->first + tie->count; ++d)
        total += follow(bound, tie->master, &constraints->follower[d], c);
      state->recorded[c] = total - state->recorded[c];
    }
  }
}

static void add_reactions(mpmi_bound *bound) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  for (int64_t i = 0; i < bound->tie_count; ++i) {
    const int64_t at = nth(bound, i);
    const mpmi_tie *tie = &constraints->tie[at];
    if (!mpmi_owns_node(bound->step->layout->parts, tie->master)) continue;
    for (int32_t c = 0; c < bound->dim; ++c)
      if (tie->face[c] >= 0 && !mpmi_held_by(bound->nodes, tie->master, c))
        mpmi_exact_add(&bound->step->work->tally.sum[MPMI_TALLY_FACES + 3 * tie->face[c] + c],
                       bound->share * bound->nodes->tie_state[at].recorded[c]);
  }
}

mpm_status mpmi_ties_unfold(mpmi_bound *bound) {
  const mpm_status status = over_ties(bound, unfold);
  if (!status && bound->records) add_reactions(bound);
  return status;
}
