/* Prescribed particles: which they are, their mean velocities, their motion, what they report. */
#include "stepper/prescribed.h"

#include <math.h>
#include <string.h>

static int32_t any_in(const mpm_particles *set, int64_t begin, int64_t end) {
  const uint8_t *flags = set->field[MPMI_PRESCRIBED].data[0];
  uint8_t any = 0;
  for (int32_t c = 0; c < set->grid->dim; ++c)
    for (int64_t p = begin; p < end; ++p) any |= flags[c * set->ld + p];
  return any != 0;
}

static void touch_around(mpm_stepper *s, int64_t block) {
  const mpmi_blocks *b = &s->blocks;
  s->prescription.block[block] |= MPMI_WITH_PRESCRIBED;
  for (int32_t n = 0; n < b->neighbours; ++n)
    if (b->neighbour[block][n] != MPMI_NO_BLOCK)
      s->prescription.block[b->neighbour[block][n]] |= MPMI_TOUCHED;
}

/* A master takes what its followers are given, wherever it lies. */
static void touch_masters(mpm_stepper *s) {
  const mpmi_constraints *constraints = &s->constraints;
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    int32_t touched = 0;
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d)
      touched |= s->prescription.block[constraints->follower[d].slot / s->blocks.nodes];
    if (touched & MPMI_TOUCHED) s->prescription.block[tie->master / s->blocks.nodes] |= MPMI_TOUCHED;
  }
}

static void find_blocks(mpm_stepper *s) {
  memset(s->prescription.block, 0, (size_t)s->blocks.count);
  for (int32_t m = 0; m < s->member_count; ++m) {
    const mpmi_member *member = &s->member[m];
    for (int64_t b = 0; b < s->blocks.count && member->prescribed; ++b)
      if (any_in(member->set, member->now.start[b], member->now.start[b + 1])) touch_around(s, b);
  }
  touch_masters(s);
}

static mpm_status prepare_mean(mpm_stepper *s, mpmi_member *member) {
  const int32_t wanted = member->prescribed && member->motion;
  if (wanted ? member->mean && member->mean_ld == member->set->ld : !member->mean) return MPM_OK;
  double *mean = NULL;
  if (wanted && !(mean = mpmi_alloc(s->context, mpmi_bytes(member->set->ld * s->grid->dim, sizeof *mean))))
    return MPM_E_NOMEM;
  mpmi_prescribed_forget(s, member);
  member->mean = mean;
  member->mean_ld = wanted ? member->set->ld : 0;
  return MPM_OK;
}

void mpmi_prescribed_forget(mpm_stepper *s, mpmi_member *member) {
  mpmi_free(s->context, member->mean, mpmi_bytes(member->mean_ld * s->grid->dim, sizeof *member->mean));
  member->mean = NULL;
  member->mean_ld = 0;
}

mpm_status mpmi_prescribed_prepare(mpm_stepper *s) {
  mpmi_prescription *p = &s->prescription;
  mpm_status status;
  p->any = 0;
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpmi_member *member = &s->member[m];
    member->prescribed =
        member->set->field[MPMI_PRESCRIBED].present && any_in(member->set, 0, member->set->slots);
    p->any |= member->prescribed;
    if ((status = prepare_mean(s, member))) return status;
  }
  if (!p->any) return MPM_OK;
  const int64_t blocks = s->blocks.count;
  if ((status = mpmi_reserve_roomy(s->context, (void **)&p->sums, &p->sums_capacity,
                                   8 * blocks * s->blocks.nodes, sizeof *p->sums)) ||
      (status = mpmi_reserve_roomy(s->context, (void **)&p->part, &p->part_capacity, blocks * s->member_count,
                                   sizeof *p->part)) ||
      (status =
           mpmi_reserve_roomy(s->context, (void **)&p->block, &p->block_capacity, blocks, sizeof *p->block)))
    return status;
  find_blocks(s);
  return MPM_OK;
}

void mpmi_prescribed_free(mpm_stepper *s) {
  mpmi_prescription *p = &s->prescription;
  mpmi_free(s->context, p->sums, mpmi_bytes(p->sums_capacity, sizeof *p->sums));
  mpmi_free(s->context, p->part, mpmi_bytes(p->part_capacity, sizeof *p->part));
  mpmi_free(s->context, p->block, mpmi_bytes(p->block_capacity, sizeof *p->block));
}

/* ---- mean velocities of the coming step ------------------------------------------------------------------
 */
typedef struct motion_job {
  mpm_stepper *s;
  int32_t m;
  double dt;
} motion_job;

static void ask_batch(const motion_job *job, int64_t begin, int64_t n, mpmi_failure *failure) {
  mpmi_member *member = &job->s->member[job->m];
  mpm_particles *set = member->set;
  const mpmi_lookup lookup = {set, begin};
  const mpm_particle_batch batch = mpmi_particle_batch(job->s, set, begin, n, job->s->t, job->dt, &lookup);
  double *mean = member->mean + begin;
  for (int32_t c = 0; c < batch.dim; ++c) memset(mean + c * set->ld, 0, (size_t)n * sizeof *mean);
  const mpm_status status = member->motion(member->motion_user, &batch, mean);
  if (status)
    mpmi_failure_take(
        failure, &(mpmi_failure){mpmi_callback_cause(status), status, job->m, -1, -1, "the motion callback"});
  for (int32_t c = 0; c < batch.dim && !status; ++c)
    for (int64_t p = 0; p < n; ++p)
      if (mpmi_is_prescribed(set, begin + p, c) && !isfinite(mean[c * set->ld + p]))
        mpmi_failure_take(failure, &(mpmi_failure){MPM_NONFINITE, 0, job->m, batch.id[p], -1,
                                                   "prescribed velocity not finite"});
}

static void motion_task(void *data, int64_t k) {
  const motion_job *job = data;
  const int64_t slots = job->s->member[job->m].set->slots, tasks = job->s->tasks;
  const int64_t batches = (slots + MPMI_PARTICLE_BATCH - 1) / MPMI_PARTICLE_BATCH;
  for (int64_t b = batches * k / tasks; b < batches * (k + 1) / tasks; ++b) {
    const int64_t begin = b * MPMI_PARTICLE_BATCH, left = slots - begin;
    ask_batch(job, begin, left < MPMI_PARTICLE_BATCH ? left : MPMI_PARTICLE_BATCH,
              &job->s->scratch[k].failure);
  }
}

mpm_status mpmi_stage_motion(mpm_stepper *s, double dt) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    if (!s->member[m].prescribed || !s->member[m].motion) continue;
    motion_job job = {s, m, dt};
    const mpm_status status = mpmi_run_tasks(s, 1, s->tasks, motion_task, &job);
    if (status) return status;
  }
  return mpmi_stepper_failure(s);
}

/* ---- motion ----------------------------------------------------------------------------------------------
 */
static uint32_t flags_of(const mpmi_move *move, int32_t c, double x) {
  double away = x - move->centre[c];
  away -= move->period[c] * nearbyint(away * move->inverse_period[c]);
  return (x < move->low[c] || x > move->high[c] ? (uint32_t)MPMI_OUTSIDE : 0u) |
         (fabs(away) > move->half[c] ? (uint32_t)MPMI_LEFT_TILE : 0u);
}

uint32_t mpmi_prescribed_move(mpm_stepper *s, int32_t m, int64_t block, const mpmi_move *move, int64_t begin,
                              int64_t n) {
  const mpm_particles *set = s->member[m].set;
  const double *mean = mpmi_mean_velocity(&s->member[m]), *mass = mpmi_f64(set, MPMI_MASS, 0);
  mpmi_prescribed_part *part = mpmi_part_of(s, block, m);
  uint32_t flags = 0;
  if (!mpmi_block_is(s, block, MPMI_WITH_PRESCRIBED)) return 0;
  for (int32_t c = 0; c < s->grid->dim; ++c)
    for (int64_t p = 0; p < n; ++p) {
      if (!mpmi_is_prescribed(set, begin + p, c)) continue;
      const double u = mean[c * set->ld + begin + p], moved = move->v_new[c][p];
      if (!s->desc.quasi_static) {
        /* of an implicit step the nodes' balance is that at its end */
        const double gained = mpmi_is_implicit(s)
                                  ? move->dt * (mpmi_f64(set, MPMI_ACCELERATION, 1) + c * set->ld)[begin + p]
                                  : moved - move->v_old[c][p];
        part->impulse[c] -= mass[begin + p] * gained;
        part->work += mass[begin + p] * (u - move->v_old[c][p] - gained) * u;
      }
      move->v_new[c][p] = u;
      move->x_new[c][p] = move->x_old[c][p] + move->dt * u;
      flags |= flags_of(move, c, move->x_new[c][p]);
    }
  return flags;
}

/* ---- reports ---------------------------------------------------------------------------------------------
 */
void mpmi_prescribed_commit(mpm_stepper *s) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpmi_member *member = &s->member[m];
    for (int32_t c = 0; c < 3; ++c) member->reaction[c] = 0.0;
    for (int64_t b = 0; b < s->blocks.count && member->prescribed; ++b) {
      if (!mpmi_block_is(s, b, MPMI_WITH_PRESCRIBED)) continue;
      const mpmi_prescribed_part *part = mpmi_part_of(s, b, m);
      for (int32_t c = 0; c < s->grid->dim; ++c) member->reaction[c] += part->impulse[c];
      s->prescribed_work += part->work;
    }
  }
}

static mpm_status find_member(const mpm_stepper *s, const mpm_particles *set, int32_t *m) {
  if (!set) return mpmi_fail(s->context, MPM_E_ARG, "particles is NULL");
  for (*m = 0; *m < s->member_count; ++*m)
    if (s->member[*m].set == set) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_NOT_FOUND, "the set is not in this stepper");
}

mpm_status mpm_stepper_set_motion(mpm_stepper *s, mpm_particles *particles, mpm_particle_fn mean_velocity,
                                  void *user) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = find_member(s, particles, &m);
  if (status) return status;
  s->member[m].motion = mean_velocity;
  s->member[m].motion_user = user;
  return MPM_OK;
}

mpm_status mpm_stepper_particles_reaction(const mpm_stepper *s, const mpm_particles *prescribed,
                                          double *force) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  if (!force) return mpmi_fail(s->context, MPM_E_ARG, "force is NULL");
  const mpm_status status = find_member(s, prescribed, &m);
  if (status) return status;
  if (!s->has_reactions) return mpmi_fail(s->context, MPM_E_STATE, "no step has been made yet");
  for (int32_t c = 0; c < s->grid->dim; ++c) force[c] = s->member[m].reaction[c] / s->reaction_dt;
  return MPM_OK;
}
