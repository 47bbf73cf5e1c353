/* Whether particles are where their blocks expect them. */
#include "stages/stages.h"
#include "simd/rounding.h"

/* Where the particles of a block may be along an axis; on periodic ones their image that is near counts. */
typedef struct reach {
  double centre, half, period, inverse_period, low, high;
} reach;

static reach reach_of(const mpmi_blocks *blocks, int64_t block, int32_t k) {
  const mpm_grid *grid = blocks->grid;
  const mpmi_cover *cover = &blocks->cover[block];
  const double length = grid->desc.periodic[k] ? grid->upper[k] - grid->desc.origin[k] : 0.0;
  return (reach){.centre = cover->centre[k],
                 .half = cover->half[k],
                 .period = length,
                 .inverse_period = length > 0.0 ? 1.0 / length : 0.0,
                 .low = cover->low[k],
                 .high = cover->high[k]};
}

/* Returns how far x is beyond the reach: 0 within it, and NaN where x is NaN. A mask would be slower, because
 * compilers for SSE2 split masks of 64 bits. */
MPMI_INLINE mpmi_lanes excess(int32_t periodic, mpmi_lanes x, const reach *of) {
  const mpmi_lanes none = {0.0};
  if (!periodic) return mpmi_lanes_max(of->low - x, none) + mpmi_lanes_max(x - of->high, none);
  mpmi_lanes away = x - of->centre;
  away -= of->period * mpmi_lanes_round(away * of->inverse_period);
  return mpmi_lanes_max(mpmi_lanes_abs(away) - of->half, none);
}

MPMI_INLINE int32_t any_beyond(int32_t periodic, const double *x, const reach *of, int64_t n) {
  mpmi_mask bits = {0}; /* bits can be gathered faster than a sum, in which each term waits for the last */
  for (int64_t p = 0; p < n; p += MPMI_LANES) bits |= (mpmi_mask)excess(periodic, mpmi_lanes_load(x + p), of);
  return mpmi_lanes_any(bits, 1) != 0;
}

/* Nothing but a host that writes through a view for reading can bring a particle there, where its stencil
 * would meet nodes that nobody looks after, or lie beyond the tile's memory. */
static int32_t any_astray(const double *x, const reach *of, int64_t n) {
  return of->period > 0.0 ? any_beyond(1, x, of, n) : any_beyond(0, x, of, n);
}

static int32_t is_astray(double x, const reach *of) {
  const mpmi_lanes zero = {0.0};
  return mpmi_lanes_any((mpmi_mask)excess(of->period > 0.0, zero + x, of), 1) != 0;
}

int32_t mpmi_were_shown(const mpmi_step *step, int32_t m) {
  const mpm_particles *set = step->layout->member[m].set;
  const mpmi_settings *settings = step->settings;
  return set->lent || !set->material->law || settings->motion[m].fn || settings->force ||
         settings->acceleration;
}

int32_t mpmi_is_in_place(mpmi_step *step, const mpmi_visit *visit, int32_t m) {
  const mpmi_layout *layout = step->layout;
  const mpm_particles *set = layout->member[m].set;
  const int64_t *start = layout->member[m].now.start;
  const int64_t begin = start[visit->block], n = start[visit->block + 1] - begin;
  if (!n) return 1; /* an empty set has no rows */
  for (int32_t k = 0; k < set->grid->dim; ++k) {
    const reach of = reach_of(&layout->blocks, visit->block, k);
    const double *x = mpmi_places(set, 0) + k * set->ld + begin;
    if (!any_astray(x, &of, n)) continue;
    int64_t p = 0;
    while (p < n - 1 && !is_astray(x[p], &of)) ++p;
    mpmi_failure_take(&step->work->report[visit->task].failure,
                      mpmi_particle_failure(MPM_E_STATE, m, mpmi_i64(set, MPMI_ID, 0)[begin + p],
                                            "a position that was written through a view for reading"));
    return 0;
  }
  return 1;
}

static void check_block(void *user, const mpmi_visit *visit) {
  mpmi_step *step = user;
  for (int32_t m = 0; m < step->layout->member_count; ++m) mpmi_is_in_place(step, visit, m);
}

mpm_status mpmi_places_check(mpmi_step *step) {
  const mpm_status status = mpmi_visit_blocks(step, 0, check_block, step);
  return status ? status : mpmi_step_failure(step);
}
