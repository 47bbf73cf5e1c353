/* Flux and film through the markers of surfaces. Of several parts each knows the nodes around the markers
 * that it gives to, and with implicit conduction also those that it takes from; the part that owns a marker
 * (stages/surfaces.c) tells the others its temperature. */
#include "heat/heat.h"
#include "context/transport.h"
#include "stages/stages.h"

#include <string.h>

static int32_t heats(const mpm_surface *s) {
  return (s->heat.flux != 0.0 || s->heat.film > 0.0) && s->next.count > 0;
}

int32_t mpmi_heat_has_surfaces(const mpmi_settings *settings) {
  int32_t any = 0;
  for (int64_t i = 0; i < settings->surfaces.count; ++i) any |= heats(settings->surfaces.surface[i]);
  return any;
}

/* Returns the temperature of the nodes at a marker. */
static double temperature_of_nodes(const mpmi_heat *heat, const mpm_surface *s, int64_t marker) {
  double sum = 0.0;
  for (int64_t n = marker * s->around.nodes; n < (marker + 1) * s->around.nodes; ++n)
    if (s->around.slot[n] >= 0)
      sum += s->around.weight[n] * mpmi_heat_node(heat, s->around.slot[n])[MPMI_HEAT_TEMPERATURE];
  return sum;
}

/* The same, as parts have told it of a surface with a film. */
static double temperature_at(const mpmi_heat_job *job, const mpm_surface *s, int64_t marker) {
  double T = 0.0;
  if (!job->step->layout->parts) return temperature_of_nodes(job->heat, s, marker);
  if (s->heat.film > 0.0) memcpy(&T, &s->told[marker], sizeof T);
  return T;
}

/* Lets all parts know the temperatures at all markers: of each one part adds its bits to zeros. */
static mpm_status tell_temperatures(const mpmi_heat_job *job, const mpm_surface *s) {
  if (!job->step->layout->parts) return MPM_OK;
  for (int64_t k = 0; k < s->next.count; ++k) {
    const double T = mpmi_owns_marker(job->step, s, k) ? temperature_of_nodes(job->heat, s, k) : 0.0;
    memcpy(&s->told[k], &T, sizeof T);
  }
  return mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, s->next.count, s->told);
}

static mpm_status check_heated(const mpmi_heat_job *job, const mpm_surface *s, int64_t marker,
                               int64_t heated) {
  if (heated) return MPM_OK;
  return mpmi_fail(
      job->step->settings->context, MPM_E_STATE,
      "marker %lld of surface %d heats, and there is no material with heat around it: describe the "
      "heat of its body by mpm_stepper_set_heat, or remove the marker",
      (long long)s->next.at[marker].id, (int)s->number);
}

mpm_status mpmi_heat_surfaces_check(const mpmi_heat_job *job) {
  const mpmi_surfaces *list = &job->step->settings->surfaces;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < list->count && !status && job->step->layout->parts; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!heats(s)) continue;
    for (int64_t k = 0; k < s->next.count; ++k) s->told[k] = mpmi_owns_marker(job->step, s, k);
    status = mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, s->next.count, s->told);
    for (int64_t k = 0; k < s->next.count && !status; ++k) status = check_heated(job, s, k, s->told[k]);
  }
  return status;
}

mpm_status mpmi_heat_surfaces(const mpmi_heat_job *job) {
  const mpmi_surfaces *list = &job->step->settings->surfaces;
  const mpmi_marker_field field = {&job->heat->nodes, &job->heat->ties, job->heat->wall};
  for (int64_t i = 0; i < list->count; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!heats(s)) continue;
    mpm_status status = mpmi_surface_find(job->step, list->surface[i], &field);
    for (int64_t k = 0; k < s->next.count && !status; ++k) {
      const double given =
          mpmi_marker_size(&s->next.at[k], s->grid) * (s->heat.flux + s->heat.film * s->heat.ambient);
      if (!job->step->layout->parts) status = check_heated(job, s, k, mpmi_marker_first_slot(s, k) >= 0);
      for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes && !status; ++n)
        if (s->around.slot[n] >= 0)
          mpmi_heat_node(job->heat, s->around.slot[n])[MPMI_HEAT_POWER] += s->around.weight[n] * given;
    }
    if (status) return status;
  }
  return MPM_OK;
}

int32_t mpmi_heat_has_films(const mpmi_settings *settings) {
  int32_t any = 0;
  for (int64_t i = 0; i < settings->surfaces.count; ++i)
    any |= settings->surfaces.surface[i]->heat.film > 0.0;
  return any;
}

mpm_status mpmi_heat_films(const mpmi_heat_job *job) {
  const mpmi_surfaces *list = &job->step->settings->surfaces;
  for (int64_t i = 0; i < list->count; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!(s->heat.film > 0.0) || !s->next.count) continue;
    const mpm_status status = tell_temperatures(job, s);
    if (status) return status;
    for (int64_t k = 0; k < s->next.count; ++k) {
      const double film = s->heat.film * mpmi_marker_size(&s->next.at[k], s->grid);
      const double taken = film * temperature_at(job, s, k);
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
  return MPM_OK;
}

double mpmi_heat_surface_power(const mpmi_heat_job *job) {
  const mpmi_surfaces *list = &job->step->settings->surfaces;
  double sum = 0.0;
  for (int64_t i = 0; i < list->count; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!heats(s)) continue;
    for (int64_t k = 0; k < s->next.count; ++k)
      sum += mpmi_marker_size(&s->next.at[k], s->grid) *
             (s->heat.flux + s->heat.film * (s->heat.ambient - temperature_at(job, s, k)));
  }
  return sum;
}
