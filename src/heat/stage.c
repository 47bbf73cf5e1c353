/* The heat of a step comes first: all that follows has the new temperatures. */
#include "heat/heat.h"
#include "context/transport.h"
#include "layout/particle_batch.h"
#include "layout/tasks.h"
#include "layout/tile.h"
#include "particles/thermal.h"
#include "stages/stages.h"

#include <math.h>
#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */
static mpm_status prepare(const mpmi_heat_job *job) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_layout *layout = job->step->layout;
  mpmi_heat *heat = job->heat;
  mpm_context *c = settings->context;
  const int64_t slots = mpmi_slots(layout), blocks = layout->blocks.count;
  mpm_status status;
  heat->tile_size = mpmi_heat_tile_size(settings);
  for (int32_t i = 0; i < MPMI_HEAT_SUMS; ++i) mpmi_exact_clear(&heat->sum[i]);
  heat->iterations = 0;
  heat->checks_films = 0;
  heat->ties.context = c;
  if ((status = mpmi_nodal_reserve(c, &heat->nodes, slots, 4)) ||
      (status = mpmi_nodal_reserve(c, &heat->flow, slots, 4)) ||
      (status = MPMI_RESERVE_MORE(c, heat->tile, heat->tile_capacity, settings->tasks * heat->tile_size)) ||
      (status = MPMI_RESERVE_MORE(c, heat->part, heat->part_capacity, blocks)))
    return status;
  if (blocks) memset(heat->part, 0, (size_t)blocks * sizeof *heat->part);
  if ((status = mpmi_heat_tie(job))) return status;
  /* nodes that are tied for heat alone have values of the last step where no stencil is */
  if (heat->ties.tie_count) heat->nodes.zero_elsewhere = heat->flow.zero_elsewhere = -1;
  return MPM_OK;
}

void mpmi_heat_free(mpmi_heat *heat, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  if (!heat) return;
  mpmi_nodal_free(c, &heat->nodes);
  mpmi_nodal_free(c, &heat->flow);
  heat->ties.context = c;
  mpmi_constraints_free(&heat->ties);
  MPMI_FREE_ARRAY(c, heat->met, heat->tie_capacity);
  MPMI_FREE_ARRAY(c, heat->tile, heat->tile_capacity);
  MPMI_FREE_ARRAY(c, heat->part, heat->part_capacity);
  MPMI_FREE_ARRAY(c, heat->row, heat->row_capacity);
  MPMI_FREE_ARRAY(c, heat->vector, heat->vector_capacity);
  MPMI_FREE_ARRAY(c, heat->start, heat->start_capacity);
  MPMI_FREE_ARRAY(c, heat->product, heat->product_capacity);
  mpmi_free(c, heat, sizeof *heat);
}

/* ---- what there is before ------------------------------------------------------------------------------ */
mpm_status mpmi_heat_check_dt(const mpmi_step *step) {
  double rate;
  const mpm_status status = mpmi_heat_rate(step->settings, step->layout, &rate);
  if (status || !(step->dt * rate > 1.0 + 1e-9)) return status;
  return mpmi_fail(step->settings->context, MPM_CUT_DT,
                   "dt is %g, and explicit conduction is stable up to %g: take a shorter step, or "
                   "MPM_CONDUCTION_IMPLICIT",
                   step->dt, 1.0 / rate);
}

static void sources_of_batch(void *user, int32_t m, const mpm_particle_batch *batch, int64_t begin,
                             mpmi_failure *failure) {
  const mpmi_step *step = user;
  const mpm_heat_desc *desc = &step->settings->heat.set[m].desc;
  const mpmi_member_rows *rows = &step->work->rows.of[m];
  double *power = rows->heat + MPMI_ROW_POWER * rows->heat_ld + begin;
  memset(power, 0, (size_t)batch->n * sizeof *power);
  if (mpmi_call_particle_fn(desc->source, desc->user, "the heat source", m, batch, power, failure)) return;
  for (int64_t p = 0; p < batch->n; ++p)
    if (batch->id[p] >= 0 && !isfinite(power[p]))
      mpmi_failure_take(failure, mpmi_particle_failure(MPM_NONFINITE, m, batch->id[p],
                                                       "power of the heat source not finite"));
}

/* Explicit conduction takes the sources at the start of the step, implicit those at its end. */
static mpm_status ask_sources(mpmi_step *step) {
  const double t = step->t + (step->settings->heat.conduction == MPM_CONDUCTION_IMPLICIT ? step->dt : 0.0);
  for (int32_t m = 0; m < step->layout->member_count; ++m) {
    if (!mpmi_has_heat(step, m) || !step->settings->heat.set[m].desc.source) continue;
    const mpm_status status = mpmi_particle_batches(step, m, t, 1, sources_of_batch, step);
    if (status) return status;
  }
  return mpmi_step_failure(step);
}

/* ---- the stage ----------------------------------------------------------------------------------------- */
static int32_t is_implicit(const mpmi_step *step) {
  return step->settings->heat.conduction == MPM_CONDUCTION_IMPLICIT;
}

/* Returns 1 where no particles are there to conduct; a part has sums to exchange also where it has none. */
static int32_t is_void(const mpmi_step *step) {
  return !step->layout->blocks.count && !step->layout->parts;
}

int64_t mpmi_heat_exchanges(const mpmi_step *step, const mpmi_heat_history *history) {
  return 2 + mpmi_heat_begins(step, history);
}

mpm_status mpmi_heat_begin(mpmi_step *step, mpmi_heat *heat, const mpmi_heat_history *history) {
  const mpmi_heat_job job = {step, heat, history};
  double clock = mpmi_seconds();
  mpm_status status = prepare(&job);
  if (status || is_void(step)) return status;
  if ((status = ask_sources(step))) return status;
  mpmi_lap(step, MPMI_TIME_CALLBACKS, &clock);
  status = mpmi_heat_project(&job);
  mpmi_lap(step, MPMI_TIME_P2G, &clock);
  if (!status) status = mpmi_heat_meet(&job);
  if (!status) status = mpmi_heat_temperatures(&job);
  if (!status) status = mpmi_heat_surfaces(&job);
  if (!status) status = mpmi_heat_conduct(&job, is_implicit(step));
  mpmi_lap(step, MPMI_TIME_GRID, &clock);
  return status;
}

/* Finds the increments of the nodes, and what has come through surfaces and faces. */
static mpm_status conduct(const mpmi_heat_job *job) {
  const int32_t implicit = is_implicit(job->step);
  const mpmi_parts *parts = job->step->layout->parts;
  job->heat->checks_films = mpmi_heat_has_films(job->step->settings) && !implicit;
  mpm_status status = mpmi_heat_surfaces_check(job);
  if (!status) status = mpmi_heat_films(job);
  if (!status) status = implicit ? mpmi_heat_solve(job) : mpmi_heat_advance(job);
  if (status) return status;
  if (!parts || !parts->context->transport.part) /* all parts know the power, and one of them tells it */
    mpmi_exact_add(&job->heat->sum[MPMI_HEAT_SURFACES], job->step->dt * mpmi_heat_surface_power(job));
  for (int64_t slot = 0; implicit && slot < mpmi_slots(job->step->layout); ++slot)
    mpmi_heat_node(job->heat, slot)[MPMI_HEAT_TEMPERATURE] = job->heat->start[slot];
  mpmi_heat_prescribe(job);
  return mpmi_heat_settle(job);
}

mpm_status mpmi_heat_end(mpmi_step *step, mpmi_heat *heat, const mpmi_heat_history *history) {
  const mpmi_heat_job job = {step, heat, history};
  double clock = mpmi_seconds();
  if (is_void(step)) return MPM_OK;
  mpm_status status = conduct(&job);
  mpmi_lap(step, MPMI_TIME_GRID, &clock);
  if (!status) status = mpmi_heat_gather(&job);
  for (int32_t m = 0; m < step->layout->member_count && !status; ++m)
    if (mpmi_expands(step->layout->member[m].set))
      step->layout->member[m].set->thermal.next = step->work->rows.of[m].heat;
  mpmi_lap(step, MPMI_TIME_G2P, &clock);
  if (!status) status = mpmi_dissipation_prepare(step);
  mpmi_lap(step, MPMI_TIME_LAW, &clock);
  return status;
}

void mpmi_heat_forget(const mpmi_layout *layout) {
  for (int32_t m = 0; m < layout->member_count; ++m) layout->member[m].set->thermal.next = NULL;
}

/* ---- the end ------------------------------------------------------------------------------------------- */
void mpmi_heat_of(const mpmi_heat_rule *rule, const mpm_particles *set, mpmi_whole_sum *sum) {
  if (!rule->on) return;
  const double *mass = mpmi_f64(set, MPMI_MASS, 0), *T = mpmi_f64(set, set->thermal.temperature, 0);
  for (int64_t slot = 0; slot < set->slots; ++slot)
    mpmi_exact_add(sum, rule->desc.specific_heat * (mass[slot] * T[slot]));
}

/* Adds the heat of what a set has dissipated, block by block. */
static void add_dissipated(const mpmi_step *step, int32_t m, mpmi_whole_sum *sum) {
  const mpmi_member *member = &step->layout->member[m];
  const mpmi_member_rows *rows = &step->work->rows.of[m];
  const double *dissipated = rows->heat + MPMI_ROW_DISSIPATED * rows->heat_ld;
  const double share = step->settings->heat.set[m].desc.dissipated_share;
  const double *mass = mpmi_f64(member->set, MPMI_MASS, 0);
  for (int64_t block = 0; block < step->layout->blocks.count; ++block) {
    double here = 0.0;
    for (int64_t slot = member->now.start[block]; slot < member->now.start[block + 1]; ++slot)
      if (mass[slot] > 0.0) here += share * dissipated[slot];
    mpmi_exact_add(sum, here);
  }
}

mpm_status mpmi_heat_add_up(const mpmi_step *step, mpmi_heat *heat) {
  double total[MPMI_HEAT_SUMS];
  for (int64_t block = 0; block < step->layout->blocks.count; ++block) {
    mpmi_exact_add(&heat->sum[MPMI_HEAT_GAINED], heat->part[block].gained);
    mpmi_exact_add(&heat->sum[MPMI_HEAT_SOURCES], heat->part[block].sources);
  }
  for (int32_t m = 0; m < step->layout->member_count; ++m)
    if (mpmi_dissipates(step->settings, m) && step->layout->member[m].set->slots)
      add_dissipated(step, m, &heat->sum[MPMI_HEAT_DISSIPATED]);
  const mpm_status status = mpmi_total_parts(step->settings->context, MPMI_HEAT_SUMS, heat->sum, total);
  memcpy(&heat->sums, total, sizeof total);
  heat->sums.gained += heat->sums.dissipated;
  return status;
}

double mpmi_heat_new_temperature(const mpmi_heat_rule *rule, const mpmi_member_rows *rows,
                                 const mpm_particles *set, int64_t slot) {
  const double mass = mpmi_f64(set, MPMI_MASS, 0)[slot], T = rows->heat[slot];
  if (!(rule->desc.dissipated_share > 0.0 && mass > 0.0)) return T;
  const double dissipated = rows->heat[MPMI_ROW_DISSIPATED * rows->heat_ld + slot];
  return T + rule->desc.dissipated_share * dissipated / (mass * rule->desc.specific_heat);
}

/* Gives a set its new temperatures, with the heat of dissipation. */
static void commit_set(const mpmi_heat_rule *rule, const mpmi_member_rows *rows, const mpm_particles *set) {
  double *T = mpmi_f64(set, set->thermal.temperature, 0);
  if (set->thermal.expansion != 0.0)
    memcpy(mpmi_f64(set, set->thermal.stress_temperature, 0), rows->heat,
           (size_t)set->slots * sizeof(double));
  for (int64_t slot = 0; slot < set->slots; ++slot)
    T[slot] = mpmi_heat_new_temperature(rule, rows, set, slot);
}

static void add(mpmi_heat_sums *to, const mpmi_heat_sums *of) {
  to->gained += of->gained;
  to->sources += of->sources;
  to->surfaces += of->surfaces;
  to->dissipated += of->dissipated;
  for (int32_t face = 0; face < 6; ++face) to->walls[face] += of->walls[face];
}

void mpmi_heat_commit(const mpmi_step *step, const mpmi_heat *heat, mpmi_heat_history *history) {
  const mpmi_heat_rules *rules = &step->settings->heat;
  if (!rules->any) {
    memset(&history->last, 0, sizeof history->last);
    history->iterations = 0;
    return;
  }
  for (int32_t m = 0; m < step->layout->member_count; ++m)
    if (rules->set[m].on && step->layout->member[m].set->slots)
      commit_set(&rules->set[m], &step->work->rows.of[m], step->layout->member[m].set);
  for (int32_t face = 0; face < 6; ++face) {
    history->acted[face] = rules->wall[face].kind == MPM_HEAT_WALL_TEMPERATURE ? 1.0 : 0.0;
    history->prescribed[face] = history->acted[face] > 0.0 ? rules->wall[face].temperature : 0.0;
  }
  mpmi_heat_forget(step->layout);
  history->last = heat->sums;
  history->iterations = heat->iterations;
  add(&history->total, &heat->sums);
}
