/* Flux and film through the markers of surfaces. */
#include "heat/heat.h"
#include "stages/stages.h"

static int32_t heats(const mpm_surface *s) {
  return s->heat.flux != 0.0 || s->heat.film > 0.0;
}

/* Returns the temperature of the nodes at a marker. */
static double temperature_at(const mpmi_heat *heat, const mpm_surface *s, int64_t marker) {
  double sum = 0.0;
  for (int64_t n = marker * s->around.nodes; n < (marker + 1) * s->around.nodes; ++n)
    if (s->around.slot[n] >= 0)
      sum += s->around.weight[n] * mpmi_heat_node(heat, s->around.slot[n])[MPMI_HEAT_TEMPERATURE];
  return sum;
}

static mpm_status check_heated(const mpmi_heat_job *job, const mpm_surface *s, int64_t marker) {
  for (int64_t n = marker * s->around.nodes; n < (marker + 1) * s->around.nodes; ++n)
    if (s->around.slot[n] >= 0) return MPM_OK;
  return mpmi_fail(
      job->step->settings->context, MPM_E_STATE,
      "marker %lld of surface %d heats, and there is no material with heat around it: describe the "
      "heat of its body by mpm_stepper_set_heat, or remove the marker",
      (long long)s->next.at[marker].id, (int)s->number);
}

mpm_status mpmi_heat_surfaces(const mpmi_heat_job *job) {
  const mpmi_surfaces *list = &job->step->settings->surfaces;
  for (int64_t i = 0; i < list->count; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!heats(s) || !s->next.count) continue;
    mpm_status status = mpmi_surface_find(job->step, list->surface[i], &job->heat->nodes);
    for (int64_t k = 0; k < s->next.count && !status; ++k) {
      const double given =
          mpmi_marker_size(&s->next.at[k], s->grid) * (s->heat.flux + s->heat.film * s->heat.ambient);
      status = check_heated(job, s, k);
      for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes && !status; ++n)
        if (s->around.slot[n] >= 0)
          mpmi_heat_node(job->heat, s->around.slot[n])[MPMI_HEAT_POWER] += s->around.weight[n] * given;
    }
    if (status) return status;
  }
  return MPM_OK;
}

int32_t mpmi_heat_films(const mpmi_heat_job *job) {
  const mpmi_surfaces *list = &job->step->settings->surfaces;
  int32_t any = 0;
  for (int64_t i = 0; i < list->count; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!(s->heat.film > 0.0)) continue;
    any = 1;
    for (int64_t k = 0; k < s->next.count; ++k) {
      const double film = s->heat.film * mpmi_marker_size(&s->next.at[k], s->grid);
      const double taken = film * temperature_at(job->heat, s, k);
      for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
        const double w = s->around.weight[n];
        if (s->around.slot[n] < 0) continue;
        double *flow = mpmi_heat_flow(job->heat, s->around.slot[n]);
        flow[MPMI_HEAT_OUTFLOW] += w * taken;
        flow[MPMI_HEAT_DIAGONAL] += w * w * film;
        flow[MPMI_HEAT_FILM] += w * film;
      }
    }
  }
  return any;
}

double mpmi_heat_surface_power(const mpmi_heat_job *job) {
  const mpmi_surfaces *list = &job->step->settings->surfaces;
  double sum = 0.0;
  for (int64_t i = 0; i < list->count; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!heats(s)) continue;
    for (int64_t k = 0; k < s->next.count; ++k)
      sum += mpmi_marker_size(&s->next.at[k], s->grid) *
             (s->heat.flux + s->heat.film * (s->heat.ambient - temperature_at(job->heat, s, k)));
  }
  return sum;
}
