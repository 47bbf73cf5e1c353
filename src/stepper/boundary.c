/* Boundary conditions on nodal velocities (Steffen et al. 2008, 3.4): velocity callback, prescribed
 * particles, walls, periodic images, and the host's hooks in between.
 *
 * They work on the velocities that all nodes would have if free. Ties are folded into their masters first
 * and unfolded last. */
#include "stepper/boundary.h"

#include <string.h>

/* Impulse of a boundary on a node, and by how much it changed the node's increment. */
static void note(const mpmi_boundary *f, int64_t slot, int32_t c, double impulse, double change) {
  if (!f->books) return;
  f->s->impulse[6 * slot + c] += f->share * impulse;
  f->s->impulse[6 * slot + 3 + c] += f->share * change;
}

static void hold(const mpmi_boundary *f, int64_t slot, int32_t c, double value, double increment) {
  double *node = mpmi_node_at(f, slot);
  node[c] = value;
  if (f->values == 8) node[4 + c] = increment;
}

/* Sets a component that the host prescribes; its increment is that of eq. 30, or 0 by option. */
static void prescribe(const mpmi_boundary *f, int64_t slot, int32_t c, double value) {
  const double *node = mpmi_node_at(f, slot);
  const double increment = f->values == 8 && !f->zero_acceleration ? node[4 + c] + value - node[c] : 0.0;
  hold(f, slot, c, value, increment);
}

/* whole: as if no part of a tie were an image with the opposite sign. */
static double book(const mpmi_boundary *f, int64_t slot, int32_t c, mpmi_component_state before,
                   int32_t whole) {
  const double more = mpmi_given(f, slot, c) - before.given;
  const int32_t tie = f->s->constraints.tie_of[slot];
  if (tie < 0) {
    const double impulse = mpmi_node_at(f, slot)[3] * more;
    note(f, slot, c, impulse, mpmi_increment(f, slot, c) - before.increment);
    return impulse;
  }
  mpmi_tie_state *state = mpmi_tie_state_of(f, tie);
  const double impulse = (whole ? state->mass : state->net[c]) * more;
  state->booked[c] += impulse;
  return impulse;
}

double mpmi_book(const mpmi_boundary *f, int64_t slot, int32_t c, mpmi_component_state before) {
  return book(f, slot, c, before, 0);
}

double mpmi_book_whole(const mpmi_boundary *f, int64_t slot, int32_t c, mpmi_component_state before) {
  return book(f, slot, c, before, 1);
}

/* The master gets the velocity that the whole tie has, before the forces and after them. */
static void fold(const mpmi_boundary *f) {
  const mpmi_constraints *constraints = &f->s->constraints;
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    double *master = mpmi_node_at(f, tie->master);
    mpmi_tie_state *state = mpmi_tie_state_of(f, i);
    double momentum[3], gained[3];
    state->mass = master[3];
    for (int32_t c = 0; c < f->dim; ++c) {
      state->net[c] = master[3];
      state->before[c] = mpmi_given(f, tie->master, c);
      state->increment[c] = mpmi_increment(f, tie->master, c);
      state->booked[c] = 0.0;
      momentum[c] = master[3] * master[c];
      gained[c] = f->values == 8 ? master[3] * master[4 + c] : 0.0;
    }
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &constraints->follower[d];
      const double *node = mpmi_node_at(f, follower->slot);
      state->mass += node[3];
      for (int32_t c = 0; c < f->dim; ++c) {
        const double signed_mass = follower->sign[c] * node[3];
        state->net[c] += signed_mass;
        momentum[c] += signed_mass * node[c];
        if (f->values == 8) gained[c] += signed_mass * node[4 + c];
      }
    }
    const double inverse = state->mass > f->s->mass_cut ? 1.0 / state->mass : 0.0;
    for (int32_t c = 0; tie->count && c < f->dim; ++c) {
      master[c] = momentum[c] * inverse;
      if (f->values == 8) master[4 + c] = gained[c] * inverse;
    }
  }
}

/* A node on the plane is its own mirror image: the projected velocity of the component is 0 as well, so that
 * there is no increment. Only so is half a symmetric body on a slip wall the same as the whole. */
static void hold_walls(const mpmi_boundary *f) {
  const mpmi_constraints *constraints = &f->s->constraints;
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    for (int32_t c = 0; c < f->dim; ++c)
      if (tie->zero[c] && !mpmi_held_by(f, tie->master, c)) hold(f, tie->master, c, 0.0, 0.0);
  }
}

static void unfold(const mpmi_boundary *f) {
  mpm_stepper *s = f->s;
  const mpmi_constraints *constraints = &s->constraints;
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    const mpmi_tie_state *state = mpmi_tie_state_of(f, i);
    const double *master = mpmi_node_at(f, tie->master);
    double total[3] = {0.0, 0.0, 0.0};
    for (int32_t c = 0; c < f->dim; ++c) {
      total[c] = master[3] * (mpmi_given(f, tie->master, c) - state->before[c]);
      note(f, tie->master, c, total[c], mpmi_increment(f, tie->master, c) - state->increment[c]);
    }
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &constraints->follower[d];
      double *node = mpmi_node_at(f, follower->slot);
      for (int32_t c = 0; c < f->dim; ++c) {
        const mpmi_component_state before = mpmi_component_of(f, follower->slot, c);
        node[c] = follower->sign[c] * master[c];
        if (f->values == 8) node[4 + c] = follower->sign[c] * master[4 + c];
        const double impulse = node[3] * (mpmi_given(f, follower->slot, c) - before.given);
        total[c] += impulse;
        note(f, follower->slot, c, impulse, mpmi_increment(f, follower->slot, c) - before.increment);
      }
    }
    for (int32_t c = 0; c < f->dim; ++c)
      if (f->books && tie->face[c] >= 0 && !mpmi_held_by(f, tie->master, c))
        s->impulse_in_step[tie->face[c]][c] += f->share * (total[c] - state->booked[c]);
  }
}

/* Sets held components of a block; the work is the impulse times the velocity that the step has. */
static void hold_block(const mpmi_boundary *f, int64_t block) {
  mpm_stepper *s = f->s;
  double work = 0.0;
  for (int64_t slot = block * s->blocks.nodes; slot < (block + 1) * s->blocks.nodes; ++slot)
    for (int32_t c = 0; c < f->dim; ++c) {
      if (!s->held[3 * slot + c]) continue;
      const double value = s->held_value[3 * slot + c];
      const mpmi_component_state before = mpmi_component_of(f, slot, c);
      prescribe(f, slot, c, value);
      work += mpmi_book(f, slot, c, before) * value;
    }
  if (f->books) s->block_work[block] = work;
}

static void hold_task(void *data, int64_t k) {
  const mpmi_boundary *f = data;
  for (int64_t b = mpmi_first_block(f->s, k); b < mpmi_first_block(f->s, k + 1); ++b) hold_block(f, b);
}

void mpmi_add_block_work(mpm_stepper *s) {
  for (int64_t b = 0; b < s->blocks.count; ++b) s->prescribed_work += s->block_work[b];
}

static mpm_status set_held(const mpmi_boundary *f) {
  mpm_stepper *s = f->s;
  if (!s->holds) return MPM_OK;
  const mpm_status status = mpmi_run_tasks(s, 0, s->tasks, hold_task, (void *)(uintptr_t)f);
  if (!status && f->books) mpmi_add_block_work(s);
  return status;
}

static mpm_status find_held(const mpmi_boundary *f) {
  const mpm_status status = f->s->velocity_bc ? mpmi_ask_velocities(f) : MPM_OK;
  return status || !f->s->prescription.any ? status : mpmi_prescribed_hold(f);
}

static mpm_status hold_nodes(const mpmi_boundary *f) {
  const mpm_status status = find_held(f);
  return status ? status : set_held(f);
}

mpm_status mpmi_boundary_prepare(mpm_stepper *s) {
  mpm_status status = mpmi_prescribed_prepare(s);
  if (status) return status;
  s->holds = s->velocity_bc || s->prescription.any;
  if (!s->holds && !mpmi_has_hooks(s)) return MPM_OK;
  status = mpmi_reserve_roomy(s->context, (void **)&s->block_work, &s->block_work_capacity, s->blocks.count,
                              sizeof *s->block_work);
  return status ? status : mpmi_hooks_prepare(s);
}

void mpmi_boundary_free(mpm_stepper *s) {
  mpmi_free(s->context, s->block_work, mpmi_bytes(s->block_work_capacity, sizeof *s->block_work));
  mpmi_hooks_free(s);
  mpmi_prescribed_free(s);
}

/* Between fold and unfold: what acts on nodes, the host's hooks around it. */
static mpm_status act(const mpmi_boundary *f) {
  mpm_status status;
  if ((status = mpmi_hooks_begin(f->s)) || (status = mpmi_run_hook(f, MPM_AFTER_P2G)) ||
      (status = mpmi_run_hook(f, MPM_AFTER_FORCES)) ||
      (status = mpmi_asks_host(f->s, MPMI_PROJECT_FORCES) ? hold_nodes(f) : set_held(f)))
    return status;
  hold_walls(f);
  mpmi_contacts(f, 0);
  return mpmi_run_hook(f, MPM_AFTER_VELOCITY);
}

/* Other projections have no hooks. That of USF comes first and asks who holds nodes; the second one of MUSL
 * keeps to what was said of the first; the terms of XPIC obey what is linear and the same for all of them.
 *
 * Which contacts are closed is for a projection with forces to say. Without them a body that expands against
 * a wall seems to leave it, and USF would strain it less in the rebound than in the approach, which makes
 * energy. */
static mpm_status act_on_velocities(const mpmi_boundary *f, int32_t projection) {
  mpm_status status = MPM_OK;
  if (projection == MPMI_PROJECT_STRAIN) status = hold_nodes(f);
  if (projection == MPMI_PROJECT_AGAIN) status = set_held(f);
  hold_walls(f);
  if (projection != MPMI_PROJECT_CORRECT) mpmi_contacts(f, projection != MPMI_PROJECT_TOUCH);
  return status;
}

mpm_status mpmi_stage_hold(mpm_stepper *s, double dt) {
  const mpmi_boundary f = {.s = s, .nodes = s->node, .dt = dt, .values = s->values, .dim = s->grid->dim};
  fold(&f);
  return find_held(&f);
}

mpm_status mpmi_stage_boundary(mpm_stepper *s, int32_t projection, double dt, double share) {
  const int32_t forces = projection == MPMI_PROJECT_FORCES, whole = mpmi_projects_forces(projection);
  const mpmi_boundary f = {.s = s,
                           .nodes = whole ? s->node : s->again,
                           .dt = dt,
                           .flip = s->values == 8 ? mpmi_flip_share(s) : 0.0,
                           .values = whole ? s->values : 4,
                           .dim = s->grid->dim,
                           .zero_acceleration = s->desc.boundary_zero_acceleration,
                           .share = share,
                           .books = (forces || projection == MPMI_PROJECT_CORRECT) && s->impulses};
  fold(&f);
  mpm_status status = forces ? act(&f) : act_on_velocities(&f, projection);
  if (status) return status;
  unfold(&f);
  if (!forces) return MPM_OK;
  if (s->prescription.any && (status = mpmi_prescribed_share(&f))) return status;
  return mpmi_hooks_end(&f);
}
