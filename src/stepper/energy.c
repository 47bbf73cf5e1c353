/* Energies, momenta and the stable step of the present state. After a step they are there; after the host has
 * changed something, or before the first step, the particles are asked. */
#include "stepper/stepper.h"

#include <math.h>
#include <string.h>

void mpmi_add_sums(mpmi_sums *sum, const mpmi_sums *other) {
  sum->kinetic += other->kinetic;
  sum->strain += other->strain;
  sum->work += other->work;
  for (int32_t k = 0; k < 3; ++k) {
    sum->momentum[k] += other->momentum[k];
    sum->angular[k] += other->angular[k];
  }
  if (other->rate > sum->rate) sum->rate = other->rate;
  if (other->viscous_rate > sum->viscous_rate) sum->viscous_rate = other->viscous_rate;
}

void mpmi_sums_moments(const mpm_stepper *s, const mpm_particles *set, int32_t copy, int64_t begin, int64_t n,
                       int64_t ld, double *buffer, mpmi_sums_job *job) {
  const mpm_grid *grid = s->grid;
  const int32_t dim = grid->dim, anywhere[3] = {0, 0, 0};
  for (int32_t k = 0; k < dim; ++k) {
    job->constant_moment[k] = grid->moment * grid->desc.spacing[k] * grid->desc.spacing[k];
    job->moment[k] = grid->moment > 0.0 ? NULL : buffer + k * ld;
  }
  if (grid->moment > 0.0) return;
  const mpmi_points points = mpmi_points_of(set, copy);
  mpmi_axis axis[3];
  mpmi_weights W;
  mpmi_block_axes(grid, anywhere, axis);
  for (int64_t p = 0; p < n; p += MPMI_CHUNK) {
    const int64_t count = n - p < MPMI_CHUNK ? n - p : MPMI_CHUNK;
    s->kernels->weights[grid->family][dim](axis, MPMI_NEED_MOMENT | MPMI_NO_PLACE, &points, begin + p, count,
                                           &W);
    for (int32_t k = 0; k < dim; ++k)
      for (int64_t i = 0; i < count; ++i) {
        const double inverse = W.inverse_moment[k][i];
        buffer[k * ld + p + i] = inverse > 0.0 ? 1.0 / inverse : 0.0;
      }
  }
}

/* The law is asked for the state as it is: F_inc = I, dt = 0. */
static mpm_status sum_set(mpm_stepper *s, int32_t m, mpmi_sums *sums) {
  mpm_particles *set = s->member[m].set;
  const mpm_grid *grid = s->grid;
  const int32_t dim = grid->dim;
  const size_t batch = mpmi_law_batch_bytes(set->material);
  const size_t bytes = batch + mpmi_bytes(3 * mpmi_law_batch_length(set->material), sizeof(double));
  char *memory = mpmi_alloc(s->context, bytes);
  if (!memory) return MPM_E_NOMEM;
  mpmi_law_batch b;
  mpmi_law_batch_bind(&b, set->material, memory);
  mpm_status status = MPM_OK;
  for (int64_t begin = 0; begin < set->slots && !status; begin += b.ld) {
    const int64_t n = set->slots - begin < b.ld ? set->slots - begin : b.ld;
    mpmi_law_batch_load(&b, set, begin, n, s->t, 0.0);
    mpmi_law_batch_load_F(&b, set, begin, n);
    const mpm_status refused = mpmi_law_batch_run(&b, set);
    if (refused) {
      s->failure.callback_status = refused;
      s->failure.set = m;
      status =
          mpmi_fail(s->context, MPM_E_CALLBACK,
                    "the material of set %d returned %d when asked for its wave speed", (int)m, (int)refused);
      break;
    }
    mpmi_sums_job job = {.what = MPMI_SUMS_LAW | MPMI_SUMS_MOTION,
                         .ld = b.ld,
                         .mass = mpmi_f64(set, MPMI_MASS, 0) + begin,
                         .initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + begin,
                         .wave_speed = b.wave_speed,
                         .kinematic_viscosity = b.viscosity,
                         .energy = b.energy,
                         .viscous_factor = 2.0 * dim / (grid->h_min * grid->h_min)};
    for (int32_t k = 0; k < dim; ++k) {
      job.x[k] = mpmi_f64(set, MPMI_POSITION, 0) + k * set->ld + begin;
      job.v[k] = mpmi_f64(set, MPMI_VELOCITY, 0) + k * set->ld + begin;
      job.inverse_spacing[k] = grid->inverse_spacing[k];
    }
    if (mpmi_is_affine(s) && set->field[MPMI_L].present) {
      mpmi_sums_moments(s, set, 0, begin, n, b.ld, (double *)(void *)(memory + batch), &job);
      for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
        job.affine[mpmi_gradient_map(dim)[c]] = mpmi_f64(set, MPMI_L, 0) + c * set->ld + begin;
    }
    if (s->kernels->sums[dim](&job, n, sums))
      status = mpmi_fail(s->context, MPM_NONFINITE,
                         "the material of set %d gives a wave speed that is not finite", (int)m);
  }
  mpmi_free(s->context, memory, bytes);
  return status;
}

/* MPM_E_STATE when a set has views out of the given access, or holds bad values. */
static mpm_status check_sets(mpm_stepper *s, int32_t access) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpm_particles *set = s->member[m].set;
    for (int32_t v = 0; v < MPMI_MAX_VIEWS && set->mapped; ++v)
      if (set->view[v].live && (set->view[v].access & access))
        return mpmi_fail(s->context, MPM_E_STATE, "set %d is mapped: release its views first", (int)m);
    const mpm_status status = mpmi_usable(set);
    if (status) return status;
  }
  return MPM_OK;
}

mpm_status mpmi_stepper_energies(mpm_stepper *s) {
  uint32_t dirty = 0;
  for (int32_t m = 0; m < s->member_count; ++m) dirty |= s->member[m].set->dirty;
  if (s->energies.valid && !(dirty & MPMI_DIRTY_SUMS)) return MPM_OK;
  mpmi_sums sums = {0};
  mpm_status status = check_sets(s, MPM_READ | MPM_WRITE);
  /* sums follow the order of the slots, which must not be that in which the host added particles; without
   * such there is no sorting, which would end the nodal fields of the last step */
  if (!status && dirty & MPMI_DIRTY_ORDER) status = mpmi_stepper_sort(s);
  for (int32_t m = 0; m < s->member_count && !status; ++m) {
    status = mpmi_particles_refresh(s->member[m].set);
    if (!status) status = sum_set(s, m, &sums);
  }
  if (status) return status;
  for (int32_t m = 0; m < s->member_count; ++m) s->member[m].set->dirty &= ~(uint32_t)MPMI_DIRTY_SUMS;
  s->energies = (mpmi_energies){1, sums};
  return MPM_OK;
}

double mpmi_stable_dt_of(const mpm_stepper *s, const mpmi_sums *sums) {
  (void)s;
  const double rate = sums->rate > sums->viscous_rate ? sums->rate : sums->viscous_rate;
  return rate > 0.0 ? 1.0 / rate : (double)INFINITY;
}

mpm_status mpm_stable_dt(mpm_stepper *s, double *dt) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!dt) return mpmi_fail(s->context, MPM_E_ARG, "dt is NULL");
  if (s->phase != MPMI_IDLE)
    return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it first");
  int64_t count = 0;
  for (int32_t m = 0; m < s->member_count; ++m) count += s->member[m].set->count;
  if (!count) return mpmi_fail(s->context, MPM_E_STATE, "the stepper has no particles");
  mpm_status status = check_sets(s, MPM_READ | MPM_WRITE);
  if (!status) status = mpmi_stepper_energies(s);
  if (status) return status;
  const double stable = mpmi_stable_dt_of(s, &s->energies.sums);
  if (!(stable > 0.0))
    return mpmi_fail(s->context, MPM_NONFINITE,
                     "velocity and wave speed over the spacing are beyond the range of double precision: no "
                     "step is stable");
  *dt = stable;
  return MPM_OK;
}

void mpmi_fill_info(const mpm_stepper *s, mpm_step_info *info) {
  const mpmi_sums *sums = &s->energies.sums;
  *info = s->last;
  info->struct_size = sizeof *info;
  info->step = s->step;
  info->removed = s->removed;
  info->resorts = s->resorts;
  info->t = s->t;
  info->kinetic_energy = sums->kinetic;
  info->strain_energy = sums->strain;
  for (int32_t k = 0; k < 3; ++k) {
    info->momentum[k] = sums->momentum[k];
    info->angular_momentum[k] = sums->angular[k];
  }
}

mpm_status mpm_stepper_info(const mpm_stepper *stepper, mpm_step_info *info) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  /* the sums are a cache of the particles' state */
  mpm_stepper *s = (mpm_stepper *)(uintptr_t)stepper;
  if (!info) return mpmi_fail(s->context, MPM_E_ARG, "info is NULL");
  if (s->phase != MPMI_IDLE)
    return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it first");
  mpm_status status = check_sets(s, MPM_WRITE);
  if (!status) status = mpmi_stepper_energies(s);
  if (status) return status;
  mpm_step_info now;
  mpmi_fill_info(s, &now);
  return mpmi_write_struct(s->context, "mpm_step_info", &now, sizeof now, info);
}
