/* The end of a step: the second copies become the state, or are dropped. */
#include "stepper/together.h"
#include "particles/values.h"
#include "boundary/prescribed.h"
#include "stages/batch.h"

#include <string.h>

static int32_t written_by_step(int32_t field) {
  switch (field) {
  case MPMI_POSITION:
  case MPMI_VELOCITY:
  case MPMI_ACCELERATION:
  case MPMI_F:
  case MPMI_L:
  case MPMI_STRESS:
  case MPMI_STATE:
  case MPMI_DILATION_RATIO:
  case MPMI_IMAGE:
    return 1;
  default:
    return 0;
  }
}

/* Makes holes of particles that went through an open wall. The hole stays where the particle was before the
 * step, inside the cover of its block. */
static void remove_outside(mpm_stepper *s, mpm_particles *set) {
  const mpm_grid *grid = s->grid;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int64_t slot = 0; slot < set->slots; ++slot) {
    if (id[slot] < 0 || !mpmi_is_beyond(set, 0, slot)) continue;
    for (int32_t k = 0; k < grid->dim; ++k)
      mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + slot] =
          mpmi_f64(set, MPMI_POSITION, 1)[k * set->ld + slot];
    mpmi_make_holes(set, slot, slot + 1);
    --set->count;
    ++s->history.removed;
    s->history.has_sums = 0;
    mpmi_index_drop(set);
  }
}

/* Makes the new copies the state. */
static void swap_copies(const mpm_stepper *s, mpm_particles *set, int32_t left_tile) {
  for (int32_t f = 0; f < set->field_count; ++f) {
    mpmi_field *field = &set->field[f];
    if (!field->present || !written_by_step(f)) continue;
    void *swap = field->data[0];
    field->data[0] = field->data[1];
    field->data[1] = swap;
  }
  if (!set->mapped) set->lent = 0;
  if (left_tile) set->dirty |= MPMI_DIRTY_PLACE;
  set->dirty &= ~(uint32_t)(MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION);
  /* with contact they are means over the step, and the next step needs those at its start */
  if (!mpmi_is_implicit(&s->settings) || s->settings.desc.quasi_static || s->step.whole_increments)
    set->dirty |= MPMI_DIRTY_ACCELERATION;
}

static void add_to_totals(mpm_stepper *s, double work) {
  mpmi_totals *totals = &s->history.totals;
  totals->external_work += work;
  totals->damping_dissipation += s->step.info.damping_dissipation;
  for (int32_t face = 0; face < 6; ++face)
    for (int32_t c = 0; c < 3; ++c) totals->impulse_by_face[face][c] += s->step.impulse_by_face[face][c];
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    mpmi_reaction *reaction = &s->history.reaction[m];
    for (int32_t c = 0; c < 3; ++c) {
      reaction->impulse[c] = s->work.tally.total[MPMI_TALLY_REACTIONS + 3 * m + c];
      reaction->impulse_total[c] += reaction->impulse[c];
    }
  }
}

mpm_status mpmi_add_up(mpm_stepper *s, mpmi_sums *sums) {
  mpmi_step *step = &s->step;
  mpmi_tally *tally = &s->work.tally;
  const mpmi_worklist *blocks = &s->layout.worklist[0];
  mpm_status status;
  *sums = (mpmi_sums){0};
  for (int64_t i = 0; i < blocks->count; ++i)
    mpmi_tally_block(tally->sum, &s->work.block_sums[blocks->block[i]], sums);
  for (int32_t k = 0; k < s->settings.tasks; ++k) {
    mpmi_exact_join(&tally->sum[MPMI_TALLY_WORK], &s->work.report[k].host_work);
    mpmi_exact_join(&tally->sum[MPMI_TALLY_DAMPING], &s->work.report[k].damping);
  }
  for (int32_t m = 0; m < s->layout.member_count; ++m) mpmi_prescribed_report(step, &s->nodes, m);
  if ((status = mpmi_together_total(s, sums)) || (status = mpmi_together_touched(s)) ||
      (status = s->settings.heat.any ? mpmi_heat_add_up(step, s->heat) : MPM_OK))
    return status;
  mpmi_tally_read(tally->total, sums);
  mpmi_pairs_total(&s->history.pairs, tally);
  for (int32_t i = 0; i < 18; ++i) step->impulse_by_face[i / 3][i % 3] += tally->total[MPMI_TALLY_FACES + i];
  step->host_work += tally->total[MPMI_TALLY_WORK];
  step->info.damping_dissipation += tally->total[MPMI_TALLY_DAMPING];
  step->info.contact_dissipation += tally->total[MPMI_TALLY_CONTACT];
  return MPM_OK;
}

static void commit_history(mpm_stepper *s, const mpmi_sums *sums) {
  mpmi_step *step = &s->step;
  mpmi_history *history = &s->history;
  const mpmi_sums before = history->sums;
  history->sums = *sums;
  history->has_sums = 1;
  history->t += step->dt;
  ++history->step;
  const mpmi_sums *after = &history->sums;
  const double work = after->work + step->host_work;
  step->info.external_work = work;
  step->info.dissipation = before.kinetic + before.strain + work - after->kinetic - after->strain;
  memcpy(history->impulse_by_face, step->impulse_by_face, sizeof history->impulse_by_face);
  add_to_totals(s, work);
  mpmi_pairs_commit(&history->pairs);
  mpmi_obstacles_commit(&s->settings.obstacles);
  mpmi_surfaces_commit(&s->settings.surfaces);
  history->reaction_dt = step->velocity_dt;
  history->previous_dt = s->settings.desc.staggered ? step->dt : 0.0;
  history->has_reactions = 1;
}

void mpmi_commit(mpm_stepper *s, const mpmi_sums *sums) {
  int32_t left = 0, removes = 0, restored = 0, old = 0;
  for (int32_t k = 0; k < s->settings.tasks; ++k) {
    left |= s->work.report[k].left_tile;
    old |= s->work.report[k].left_cover;
    removes |= s->work.report[k].removes;
    restored |= s->work.report[k].holes_restored;
  }
  commit_history(s, sums);
  mpmi_heat_commit(&s->step, s->heat, &s->history.heat);
  for (int32_t m = 0; m < s->layout.member_count; ++m) swap_copies(s, s->layout.member[m].set, left);
  if (old) s->layout.cover_is_old = 1;
  if (restored) s->history.has_sums = 0;
  for (int32_t m = 0; m < s->layout.member_count && removes; ++m) remove_outside(s, s->layout.member[m].set);
  if (!mpmi_is_shared(s) || !s->layout.parts->leave_elsewhere) return;
  s->history.removed += s->layout.parts->leave_elsewhere;
  s->history.has_sums = 0;
}

void mpmi_roll_back(mpm_stepper *s) {
  mpmi_heat_forget(&s->layout);
  mpmi_make_volumes(&s->layout, 0);
}
