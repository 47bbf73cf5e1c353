#include "layout/member_rows.h"
#include "context/slack.h"

#include <string.h>

static void free_rows(mpm_context *c, double **rows, int64_t *ld, int32_t components) {
  mpmi_free(c, *rows, mpmi_bytes(*ld * components, sizeof **rows));
  *rows = NULL;
  *ld = 0;
}

static void free_member(const mpmi_settings *settings, mpmi_member_rows *of) {
  mpm_context *c = settings->context;
  const int32_t dim = settings->grid->dim;
  free_rows(c, &of->force, &of->force_ld, dim);
  free_rows(c, &of->mean, &of->mean_ld, dim);
  free_rows(c, &of->wave_speed, &of->wave_speed_ld, 1);
  free_rows(c, &of->nodal_stress, &of->nodal_stress_ld, mpmi_stress_components(dim));
  free_rows(c, &of->heat, &of->heat_ld, MPMI_HEAT_ROWS);
}

void mpmi_member_rows_free(mpmi_step_rows *rows, const mpmi_settings *settings) {
  for (int64_t m = 0; m < rows->count; ++m) free_member(settings, &rows->of[m]);
  MPMI_FREE_ARRAY(settings->context, rows->of, rows->count);
  rows->count = 0;
}

/* Makes room for rows where they are wanted, else frees them. */
static mpm_status reserve_rows(mpm_context *c, const mpm_particles *set, int32_t wanted, int32_t components,
                               double **rows, int64_t *ld) {
  if (wanted ? !*rows || *ld != set->ld : *rows != NULL) {
    double *memory = NULL;
    if (wanted && !(memory = mpmi_alloc_zeroed(c, mpmi_bytes(set->ld * components, sizeof *memory))))
      return MPM_E_NOMEM;
    free_rows(c, rows, ld, components);
    *rows = memory;
    *ld = wanted ? set->ld : 0;
  }
  mpmi_slack_rows(*rows, (size_t)components, (size_t)*ld, (size_t)set->slots, sizeof **rows);
  return MPM_OK;
}

static mpm_status reserve_count(mpmi_step_rows *rows, const mpmi_settings *settings, int64_t count) {
  for (int64_t m = count; m < rows->count; ++m) free_member(settings, &rows->of[m]);
  if (count <= rows->count) return MPM_OK;
  mpmi_member_rows *more = mpmi_alloc_zeroed(settings->context, mpmi_bytes(count, sizeof *more));
  if (!more) return MPM_E_NOMEM;
  if (rows->count) memcpy(more, rows->of, (size_t)rows->count * sizeof *more);
  MPMI_FREE_ARRAY(settings->context, rows->of, rows->count);
  *rows = (mpmi_step_rows){more, count};
  return MPM_OK;
}

mpm_status mpmi_member_rows_prepare(mpmi_step_rows *rows, const mpmi_settings *settings,
                                    const mpmi_layout *layout) {
  mpm_context *c = settings->context;
  const int32_t dim = settings->grid->dim, asks = settings->acceleration || settings->force;
  mpm_status status = reserve_count(rows, settings, layout->member_count);
  for (int32_t m = 0; !status && m < layout->member_count; ++m) {
    const mpmi_member *member = &layout->member[m];
    const mpm_particles *set = member->set;
    mpmi_member_rows *of = &rows->of[m];
    const int32_t forced = asks || set->field[MPMI_APPLIED_FORCE].present,
                  moved = member->prescribed && settings->motion[m].fn;
    if ((status = reserve_rows(c, set, forced, dim, &of->force, &of->force_ld)) ||
        (status = reserve_rows(c, set, moved, dim, &of->mean, &of->mean_ld)) ||
        (status =
             reserve_rows(c, set, mpmi_deforms_first(settings), 1, &of->wave_speed, &of->wave_speed_ld)) ||
        (status = reserve_rows(c, set, mpmi_averages_pressure(settings, set), mpmi_stress_components(dim),
                               &of->nodal_stress, &of->nodal_stress_ld)) ||
        (status = reserve_rows(c, set, settings->heat.set[m].on, MPMI_HEAT_ROWS, &of->heat, &of->heat_ld)))
      return status;
  }
  return status;
}
