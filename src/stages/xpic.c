/* Corrections of nodal velocities by projecting them from the particles again and again. With S the
 * interpolation to particles and S+ the mass-weighted projection to nodes:
 *
 * XPIC(m) (Hammerquist & Nairn 2017): the new velocity is (I - (I - S S+)^m) v_p + dt S a. Expanded, its
 * first part is S v^ with
 *
 *   v^ = m sum_r (-1)^(r+1) v_r,   v_1 = v_i,   v_r = (m - r + 1) / r S+ S v_r-1
 *
 * PIC has S v_i in its place (m = 1). What is gathered at the end of a step is S (v_i + dt a), so that S (v^
 * - v_i) remains: it is made here. The terms obey the boundary conditions that are linear: walls and images.
 *
 * FMPM(k) (Nairn & Hammerquist 2021): the new velocity is S v(k), where v(k) are the first k terms of a
 * series for the inverse of the full mass matrix on the updated momentum. S+ S is that matrix over the lumped
 * one, and so the series is the iteration
 *
 *   v(1) = v~,   v(r) = v(r-1) + v~ - S+ S v(r-1)
 *
 * What walls, images and prescribed velocities hold in v~ they hold in S+ S v too, and thus in each v(r).
 * What contact gave is left out of v~ here.
 * Particles have gathered S v~, and S (v(k) - v~) is made here.
 */
#include "stages/stages.h"
#include "boundary/boundary.h"
#include "layout/tasks.h"

typedef struct xpic_job {
  const mpmi_step *step;
  const mpmi_nodes *nodes;
  double scale, share; /* XPIC: scale of the term; its share of the sum */
} xpic_job;

/* One way to sum up corrections. `projected` holds what particles gather next, `sums` the corrections. */
typedef struct correction {
  mpm_task_fn begin, next; /* before the first projection; after each, with what came of it in `projected` */
  int32_t projection;
} correction;

/* ---- XPIC --------------------------------------------------------------------------------------------- */
/* Makes the first term, the velocities before the forces, and what the sum has of it. */
static void first_term(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    const double mass = *mpmi_mass(&nodes->solved, i);
    *mpmi_mass(&nodes->projected, i) = mass;
    *mpmi_mass(&nodes->sums, i) = job->share * mass;
    for (int32_t c = 0; c < 3; ++c) {
      const double v = mpmi_velocity(&nodes->solved, i)[c] - mpmi_increment(&nodes->solved, i)[c];
      mpmi_velocity(&nodes->projected, i)[c] = v;
      mpmi_velocity(&nodes->sums, i)[c] = job->share * v;
    }
  }
}

/* Scales the term that was projected, and adds what the sum has of it. */
static void next_term(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    double *term = mpmi_velocity(&nodes->projected, i), *sum = mpmi_velocity(&nodes->sums, i);
    for (int32_t c = 0; c < 3; ++c) {
      term[c] *= job->scale;
      sum[c] += job->share * term[c];
    }
  }
}

/* Returns the weight with which a velocity added to v_r enters v^: directly, and through the later terms that
 * are made from v_r. */
static double share_of(int32_t m, int32_t r) {
  double share = 0.0;
  for (int32_t k = m; k >= r; --k) share = (k % 2 ? m : -m) + (m - k) / (k + 1.0) * share;
  return share;
}

/* ---- FMPM --------------------------------------------------------------------------------------------- */
/* Begins with the updated velocities and no correction. */
static void first_velocity(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    *mpmi_mass(&nodes->projected, i) = *mpmi_mass(&nodes->sums, i) = *mpmi_mass(&nodes->solved, i);
    for (int32_t c = 0; c < 3; ++c) {
      mpmi_velocity(&nodes->projected, i)[c] = mpmi_velocity(&nodes->solved, i)[c];
      mpmi_velocity(&nodes->sums, i)[c] = 0.0;
    }
  }
}

/* Adds what the projection lacks of the updated velocities. */
static void next_velocity(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    double *projected = mpmi_velocity(&nodes->projected, i), *sum = mpmi_velocity(&nodes->sums, i);
    for (int32_t c = 0; c < 3; ++c) {
      const double updated = mpmi_velocity(&nodes->solved, i)[c];
      sum[c] += updated - projected[c];
      projected[c] = updated + sum[c];
    }
  }
}

/* ---- both --------------------------------------------------------------------------------------------- */
static const correction xpic = {first_term, next_term, MPMI_PROJECT_CORRECTION},
                        full = {first_velocity, next_velocity, MPMI_PROJECT_FULL};

/* Each projection of FMPM has the whole momentum of the velocities before it. So what the boundary gives in
 * the last one, which is subtracted, is what v(k) lacks of it. */
static double boundary_share(const correction *by, const xpic_job *job, int32_t order, int32_t r) {
  if (by == &full) return r == order ? -1.0 : 0.0;
  return job->scale * share_of(order, r);
}

/* What contact and friction walls gave to nodes is no part of the series, and particles take it as it is: the
 * full mass matrix would make more of an impulse on a few nodes than stops a body there. */
static void add_contact(const mpmi_step *step, mpmi_nodes *nodes, double times) {
  const mpmi_constraints *constraints = &step->layout->constraints;
  const int32_t dim = step->settings->grid->dim;
  for (int64_t i = 0; i < nodes->contact.party_count; ++i) {
    const mpmi_party *party = &nodes->contact.party[i];
    if (party->surface >= 0) continue;
    const int32_t t = constraints->tie_of[party->slot];
    const mpmi_tie *tie = t < 0 ? NULL : &constraints->tie[t];
    for (int32_t c = 0; c < dim; ++c) {
      const double gave = times * (party->given[c] + party->pressed[c]);
      mpmi_velocity(&nodes->solved, party->slot)[c] += gave;
      for (int64_t d = tie ? tie->first : 0; tie && d < tie->first + tie->count; ++d)
        mpmi_velocity(&nodes->solved, constraints->follower[d].slot)[c] +=
            constraints->follower[d].sign[c] * gave;
    }
  }
}

mpm_status mpmi_xpic_stage(mpmi_step *step, mpmi_nodes *nodes) {
  const mpmi_settings *settings = step->settings;
  const correction *by = step->takes == MPMI_TAKES_FULL ? &full : &xpic;
  const mpmi_projection *projection = &mpmi_projections[by->projection];
  const int32_t m = settings->desc.xpic_order;
  xpic_job job = {step, nodes, 1.0, m - 1.0};
  if (by == &full) add_contact(step, nodes, -1.0);
  mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, by->begin, &job);
  for (int32_t r = 2; r <= m && !status; ++r) {
    job = (xpic_job){step, nodes, (m - r + 1.0) / r, r % 2 ? m : -m};
    status = mpmi_g2p_velocities(step, nodes, &nodes->projected);
    if (!status) status = mpmi_p2g_stage(step, projection, nodes);
    if (!status) status = mpmi_node_update_stage(step, projection, nodes);
    if (!status) status = mpmi_boundary_stage(step, projection, nodes, boundary_share(by, &job, m, r));
    if (!status) status = mpmi_run_tasks(settings, 0, settings->tasks, by->next, &job);
  }
  if (by == &full) add_contact(step, nodes, 1.0);
  return status ? status : mpmi_g2p_velocities(step, nodes, &nodes->sums);
}
