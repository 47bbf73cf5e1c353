/* Energies, momenta and rates of the present state. After a step they are there; after the host has changed
 * something, or before the first step, the particles are asked. */
#include "stepper/together.h"
#include "stages/batch.h"

#include <math.h>

mpm_status mpmi_stable_dt(const mpm_stepper *s, double *dt) {
  const mpmi_sums *sums = &s->history.sums;
  const mpmi_obstacles *obstacles = &s->settings.obstacles;
  double rate = sums->rate > sums->viscous_rate ? sums->rate : sums->viscous_rate, of_heat;
  const mpm_status status = mpmi_heat_rate(&s->settings, &s->layout, &of_heat);
  rate = of_heat > rate ? of_heat : rate;
  for (int64_t i = 0; i < obstacles->count; ++i) {
    const double of_obstacle = mpmi_obstacle_rate(obstacles->obstacle[i]);
    rate = of_obstacle > rate ? of_obstacle : rate;
  }
  *dt = rate > 0.0 ? 1.0 / rate : (double)INFINITY;
  return status;
}

/* ---- sums over particles ------------------------------------------------------------------------------ */
static void bind_particles(const mpm_stepper *s, const mpm_particles *set, const mpmi_law_batch *b,
                           int64_t begin, int64_t n, double *moments, mpmi_sums_job *job) {
  const mpm_grid *grid = s->grid;
  *job = (mpmi_sums_job){.what = MPMI_SUMS_LAW | MPMI_SUMS_MOTION,
                         .ld = b->ld,
                         .mass = mpmi_f64(set, MPMI_MASS, 0) + begin,
                         .initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + begin,
                         .wave_speed = b->wave_speed,
                         .kinematic_viscosity = b->viscosity,
                         .squared = b->squares,
                         .energy = b->energy,
                         .viscous_factor = 2.0 * grid->dim / (grid->h_min * grid->h_min),
                         .carried = mpmi_is_total_lagrangian(grid) ? 0.0 : 1.0};
  for (int32_t k = 0; k < grid->dim; ++k) {
    job->x[k] = mpmi_f64(set, MPMI_POSITION, 0) + k * set->ld + begin;
    job->v[k] = mpmi_f64(set, MPMI_VELOCITY, 0) + k * set->ld + begin;
    job->spacing[k] = grid->desc.spacing[k];
    job->inverse_spacing[k] = grid->inverse_spacing[k];
  }
  if (mpmi_is_total_lagrangian(grid)) mpmi_point_at(set, MPMI_F, 0, begin, job->F);
  if (!mpmi_is_affine(&s->settings) || !set->field[MPMI_L].present) return;
  mpmi_sums_moments(&s->settings, set, 0, begin, n, b->ld, moments, job);
  for (int32_t c = 0; c < mpmi_gradient_components(grid->dim); ++c)
    job->affine[mpmi_gradient_map(grid->dim)[c]] = mpmi_f64(set, MPMI_L, 0) + c * set->ld + begin;
}

static mpm_status refused(mpm_stepper *s, int32_t m, mpm_status status, const mpmi_law_fault *fault,
                          mpmi_failure *failure) {
  if (failure && fault->cause)
    *failure = mpmi_particle_failure(fault->cause, m, fault->particle, fault->what);
  if (fault->cause)
    return mpmi_fail(s->context, fault->cause, "%s at particle %lld of set %d, as it is", fault->what,
                     (long long)fault->particle, (int)m);
  if (failure) {
    failure->callback_status = status;
    failure->set = m;
  }
  return mpmi_fail(s->context, MPM_E_CALLBACK,
                   "the material of set %d returned %d when asked for its wave speed", (int)m, (int)status);
}

static mpm_status not_finite(mpm_stepper *s, int32_t m, const mpmi_law_batch *b, mpmi_failure *failure) {
  int64_t p = 0;
  while (p + 1 < b->batch.n && (b->batch.id[p] < 0 || (isfinite(b->wave_speed[p]) &&
                                                       b->wave_speed[p] >= 0.0 && isfinite(b->viscosity[p]))))
    ++p;
  if (failure)
    *failure = mpmi_particle_failure(MPM_NONFINITE, m, b->batch.id[p], "the wave speed is not finite");
  return mpmi_fail(s->context, MPM_NONFINITE,
                   "the material gives wave speed %g and kinematic viscosity %g at particle %lld of set %d",
                   b->squares ? sqrt(b->wave_speed[p]) : b->wave_speed[p], b->viscosity[p],
                   (long long)b->batch.id[p], (int)m);
}

/* What a set comes to, with the memory that takes. */
typedef struct summing {
  mpm_stepper *s;
  int32_t m;
  mpmi_law_batch law;
  double *moments;
  mpmi_whole_sum *sum; /* of energies and momenta */
  mpmi_sums *rates;
} summing;

/* Moves a job on by so many slots. */
static void shift_job(mpmi_sums_job *job, int64_t by) {
  const double **row[] = {
      &job->x[0],   &job->x[1],      &job->x[2],           &job->v[0],       &job->v[1],
      &job->v[2],   &job->mass,      &job->initial_volume, &job->wave_speed, &job->kinematic_viscosity,
      &job->energy, &job->moment[0], &job->moment[1],      &job->moment[2]};
  for (size_t i = 0; i < sizeof row / sizeof row[0]; ++i)
    if (*row[i]) *row[i] += by;
  for (int32_t c = 0; c < 9; ++c) {
    if (job->affine[c]) job->affine[c] += by;
    if (job->F[c]) job->F[c] += by;
  }
}

/* Adds particles one by one: which of them lie side by side depends on the parts. Returns what the sums of
 * all of them would. */
static uint32_t sum_singly(const summing *of, const mpmi_sums_job *job, int64_t n) {
  const mpmi_sums_fn sums = of->s->settings.kernels->sums[of->s->grid->dim];
  double mass[MPMI_CHUNK] = {0.0}, volume[MPMI_CHUNK] = {0.0};
  uint32_t bad = 0;
  for (int64_t p = 0; p < n; ++p) {
    const int64_t lane = p % MPMI_CHUNK;
    mpmi_sums_job one = *job;
    mpmi_sums here = {0};
    if (!(job->initial_volume[p] > 0.0)) continue;
    shift_job(&one, p - lane);
    mass[lane] = one.mass[lane];
    volume[lane] = one.initial_volume[lane];
    one.mass = mass;
    one.initial_volume = volume;
    bad |= sums(&one, MPMI_CHUNK, &here);
    mpmi_tally_block(of->sum, &here, of->rates);
    mass[lane] = volume[lane] = 0.0;
  }
  return bad;
}

/* Adds the sums of the slots [begin, end) of a set, those of a block, or singly. The law is asked for the
 * state as it is: F_inc = I, dt = 0. */
static mpm_status sum_slots(summing *of, int64_t begin, int64_t end, int32_t singly, mpmi_failure *failure) {
  mpm_stepper *s = of->s;
  const int32_t m = of->m;
  mpmi_law_batch *b = &of->law;
  mpmi_sums here = {0};
  mpm_particles *set = s->layout.member[m].set;
  for (; begin < end; begin += b->ld) {
    const int64_t n = end - begin < b->ld ? end - begin : b->ld;
    mpmi_law_batch_load(b, set, begin, n, s->history.t, 0.0);
    mpmi_law_batch_load_F(b, set, begin, n);
    const mpm_status answer = mpmi_law_batch_run_in(b, set);
    if (answer) return refused(s, m, answer, &b->fault, failure);
    if (mpmi_is_total_lagrangian(set->grid)) mpmi_take_reference_speeds(&s->settings, set, 0, begin, n, b);
    mpmi_sums_job job;
    bind_particles(s, set, b, begin, n, of->moments, &job);
    if (singly ? sum_singly(of, &job, n) : s->settings.kernels->sums[s->grid->dim](&job, n, &here))
      return not_finite(s, m, b, failure);
  }
  if (!singly) mpmi_tally_block(of->sum, &here, of->rates);
  return MPM_OK;
}

/* Adds the sums of a set, block by block, and in the end those of slots that are in none yet. */
static mpm_status sum_set(mpm_stepper *s, int32_t m, mpmi_whole_sum *sums, mpmi_sums *rates,
                          mpmi_failure *failure) {
  const mpmi_member *member = &s->layout.member[m];
  const mpm_material *material = member->set->material;
  const size_t batch = mpmi_law_batch_bytes(material);
  const size_t bytes = batch + mpmi_bytes(3 * mpmi_law_batch_length(material), sizeof(double));
  if (!member->set->slots) return MPM_OK;
  char *memory = mpmi_alloc(s->context, bytes);
  if (!memory) return MPM_E_NOMEM;
  summing of = {.s = s, .m = m, .moments = (double *)(void *)(memory + batch), .sum = sums, .rates = rates};
  mpmi_law_batch_bind(&of.law, material, memory);
  of.law.squares = mpmi_takes_squares(&s->settings, material);
  mpm_status status = MPM_OK;
  const int64_t *start = member->now.start;
  const int64_t blocks = start ? s->layout.blocks.count : 0;
  for (int64_t block = 0; block <= blocks && !status; ++block) {
    const int64_t begin = start ? start[block] : 0,
                  end = block < blocks ? start[block + 1] : member->set->slots;
    if (begin < end) status = sum_slots(&of, begin, end, block == blocks, failure);
  }
  mpmi_free(s->context, memory, bytes);
  return status;
}

mpm_status mpmi_check_sets(mpm_stepper *s, int32_t access) {
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    mpm_particles *set = s->layout.member[m].set;
    for (int32_t v = 0; v < MPMI_MAX_VIEWS && set->mapped; ++v)
      if (set->view[v].live && (set->view[v].access & access))
        return mpmi_fail(s->context, MPM_E_STATE, "set %d is mapped: release its views first", (int)m);
    if (mpmi_particles_check_suspects(set)) return MPM_E_STATE;
  }
  return MPM_OK;
}

/* Returns 1 where sets have come or gone since the last sort, so that there are particles in no block. */
static int32_t is_without_blocks(const mpmi_layout *layout) {
  int32_t without = layout->parts ? layout->parts->is_stale : layout->blocks.count == 0;
  for (int32_t m = 0; m < layout->member_count; ++m) without |= !layout->member[m].now.start;
  return without;
}

mpm_status mpmi_state_sums(mpm_stepper *s, mpmi_failure *failure) {
  mpmi_layout *layout = &s->layout;
  uint32_t dirty = 0;
  for (int32_t m = 0; m < layout->member_count; ++m) dirty |= layout->member[m].set->dirty;
  if (s->history.has_sums && !(dirty & MPMI_DIRTY_SUMS)) return MPM_OK;
  mpmi_whole_sum sum[MPMI_TALLY_FACES];
  double total[MPMI_TALLY_FACES];
  mpmi_sums sums = {0};
  mpm_status status = mpmi_check_sets(s, MPM_READ | MPM_WRITE);
  /* sums are made by blocks, and new particles have none until they are sorted; else nothing is sorted,
   * because that would end the nodal fields */
  status = mpmi_together(s, status);
  if (!status && (dirty & MPMI_DIRTY_ORDER || is_without_blocks(layout)))
    status = mpmi_layout_sort(layout, &s->settings);
  for (int32_t i = 0; i < MPMI_TALLY_FACES; ++i) mpmi_exact_clear(&sum[i]);
  for (int32_t m = 0; m < layout->member_count && !status; ++m) {
    status = mpmi_particles_refresh(layout->member[m].set);
    if (!status) status = sum_set(s, m, sum, &sums, failure);
  }
  if ((status = mpmi_together(s, status)) ||
      (status = mpmi_total_parts(s->context, MPMI_TALLY_FACES, sum, total)) ||
      (status = mpmi_together_rates(s, &sums)))
    return status;
  mpmi_tally_read(total, &sums);
  for (int32_t m = 0; m < layout->member_count; ++m)
    layout->member[m].set->dirty &= ~(uint32_t)MPMI_DIRTY_SUMS;
  s->history.has_sums = 1;
  s->history.sums = sums;
  return MPM_OK;
}
