/* Surfaces that prescribe velocities, in explicit steps: what they hold at their sites, and what
 * that takes. */
#include "boundary/surface_holds.h"
#include "parallel/parts.h"

#include <math.h>
#include <string.h>

/* The least part of a unit normal that is left beside what holds the node already. */
static const double least_left = 0.1;

/* ---- what sites hold ----------------------------------------------------------------------------------- */
/* Holds all components that nothing holds yet, nor a wall. */
static void hold_velocity(mpmi_bound *bound, mpmi_surface_site *site) {
  const mpmi_constraints *ties = mpmi_constraints_of(bound);
  const int32_t tie = ties->tie_of[site->slot];
  for (int32_t c = 0; c < bound->dim; ++c) {
    if (bound->nodes->held[site->slot][c] || (tie >= 0 && ties->tie[tie].zero[c])) continue;
    bound->nodes->held[site->slot][c] = MPMI_HELD_BY_SURFACES;
    bound->nodes->held_value[site->slot][c] = site->vector[c];
    site->holds[c] = 1;
  }
}

/* Takes one direction, in which something else sets the velocity, out of what a site prescribes. */
static void take_out(mpmi_surface_site *site, const double *direction, double value) {
  const double part = mpmi_inner(site->vector, direction);
  for (int32_t c = 0; c < 3; ++c) site->vector[c] -= part * direction[c];
  site->value -= part * value;
}

/* Makes a unit vector of the normal of a site; returns 0 where hardly any of it is left. */
static int32_t make_unit(mpmi_surface_site *site, double least) {
  const double length = sqrt(mpmi_inner(site->vector, site->vector));
  if (!(length > least)) return 0;
  for (int32_t c = 0; c < 3; ++c) site->vector[c] /= length;
  site->value /= length;
  return 1;
}

/* Finds the direction in which a site sets the velocity. */
static void find_direction(mpmi_bound *bound, mpmi_surface_site *site) {
  const mpmi_constraints *ties = mpmi_constraints_of(bound);
  const int32_t tie = ties->tie_of[site->slot];
  if (!make_unit(site, least_left)) return;
  for (int32_t c = 0; c < bound->dim; ++c) {
    double axis[3] = {0.0, 0.0, 0.0};
    axis[c] = 1.0;
    if (bound->nodes->held[site->slot][c])
      take_out(site, axis, bound->nodes->held_value[site->slot][c]);
    else if (tie >= 0 && ties->tie[tie].zero[c])
      take_out(site, axis, 0.0);
  }
  for (int32_t at = site->before; at >= 0; at = bound->nodes->surface_sites.site[at].before) {
    const mpmi_surface_site *other = &bound->nodes->surface_sites.site[at];
    if (other->slides) take_out(site, other->vector, other->value);
  }
  site->slides = make_unit(site, least_left);
}

mpm_status mpmi_surface_holds_find(mpmi_bound *bound) {
  mpmi_surface_sites *sites = &bound->nodes->surface_sites;
  const mpm_status status = mpmi_surface_sites_find(bound);
  if (status) return status;
  for (int64_t i = 0; i < sites->count; ++i)
    if (!mpmi_site_slides(bound, &sites->site[i]) && !mpmi_site_is_far(&sites->site[i]))
      hold_velocity(bound, &sites->site[i]);
  for (int64_t i = 0; i < sites->count; ++i)
    if (mpmi_site_slides(bound, &sites->site[i]) && !mpmi_site_is_far(&sites->site[i]))
      find_direction(bound, &sites->site[i]);
  return MPM_OK;
}

int32_t mpmi_surface_direction_at(const mpmi_bound *bound, int64_t slot) {
  const mpmi_surface_sites *sites = &bound->nodes->surface_sites;
  int32_t slides = 0;
  if (!sites->count || !mpmi_surfaces_hold(bound->step->settings)) return -1;
  for (int32_t at = sites->last[slot]; at >= 0; at = sites->site[at].before) slides |= sites->site[at].slides;
  return slides ? sites->last[slot] : -1;
}

/* ---- sliding ------------------------------------------------------------------------------------------- */
/* Sets the velocity of a node along a direction; its increment is that of eq. 30, or 0 by option. */
static void slide(mpmi_bound *bound, mpmi_surface_site *site) {
  const double *along = site->vector;
  double *v = mpmi_velocity(bound->values, site->slot), has = 0.0, gained = 0.0;
  double *dv = mpmi_has_increments(bound->values) ? mpmi_increment(bound->values, site->slot) : NULL;
  mpmi_component before[3];
  for (int32_t c = 0; c < bound->dim; ++c) {
    before[c] = mpmi_component_of(bound, site->slot, c);
    has += along[c] * v[c];
    gained += dv ? along[c] * dv[c] : 0.0;
  }
  const double more = site->value - has,
               more_gained = bound->step->settings->desc.boundary_zero_acceleration ? -gained : more;
  for (int32_t c = 0; c < bound->dim; ++c) {
    v[c] += along[c] * more;
    if (dv) dv[c] += along[c] * more_gained;
    const double impulse = mpmi_record(bound, site->slot, c, before[c]);
    if (!bound->records) continue;
    site->impulse[c] += bound->share * impulse;
    if (mpmi_owns_node(bound->step->layout->parts, site->slot))
      mpmi_exact_add(&bound->step->work->tally.sum[MPMI_TALLY_WORK],
                     bound->share * mpmi_work_done(bound, site->slot, c, before[c], v[c]));
  }
}

void mpmi_surface_holds_slide(mpmi_bound *bound) {
  mpmi_surface_sites *sites = &bound->nodes->surface_sites;
  if (!mpmi_surfaces_hold(bound->step->settings)) return;
  for (int64_t i = 0; i < sites->count; ++i)
    if (sites->site[i].slides) slide(bound, &sites->site[i]);
}

/* ---- reports ------------------------------------------------------------------------------------------- */
/* Finds the impulse of a site that holds components: that on all nodes of its tie. */
static void sum_impulse(const mpmi_step *step, const mpmi_nodes *nodes, mpmi_surface_site *site) {
  const mpmi_constraints *ties = &step->layout->constraints;
  const int32_t at = ties->tie_of[site->slot];
  for (int32_t c = 0; c < step->settings->grid->dim; ++c) {
    if (!site->holds[c]) continue;
    site->impulse[c] += nodes->impulse[site->slot].given[c];
    for (int64_t i = 0; at >= 0 && i < ties->tie[at].count; ++i)
      site->impulse[c] += nodes->impulse[ties->follower[ties->tie[at].first + i].slot].given[c];
  }
}

/* Shares the impulses of its sites out among the markers of a surface. Of several parts each tells of the
 * sites whose nodes it owns (stages/surfaces.c). */
static void tell_surface(const mpmi_step *step, const mpmi_nodes *nodes, mpm_surface *s) {
  const mpmi_parts *parts = step->layout->parts;
  if (parts && s->next.count)
    memset(mpmi_surface_told_impulse(s, 0), 0,
           (size_t)(MPMI_MARKER_VECTOR * s->next.count * s->around.nodes) * sizeof *s->told);
  for (int64_t k = 0; k < s->next.count; ++k) {
    mpmi_marker *m = &s->next.at[k];
    const double area = mpmi_marker_size(m, s->grid);
    memset(m->reaction, 0, sizeof m->reaction);
    memset(m->gap, 0, sizeof m->gap);
    for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
      if (s->site[n] < 0) continue;
      const mpmi_surface_site *site = &nodes->surface_sites.site[s->site[n]];
      const double share = s->around.plain[n] * area / site->weight;
      double impulse[3] = {0.0, 0.0, 0.0};
      for (int32_t c = 0; c < s->grid->dim; ++c) impulse[c] = share * site->impulse[c];
      if (!parts)
        mpmi_surface_impulse_add(s, k, impulse, step->velocity_dt);
      else if (mpmi_owns_node(parts, site->slot))
        memcpy(mpmi_surface_told_impulse(s, n), impulse, sizeof impulse);
    }
  }
}

void mpmi_surface_holds_report(mpmi_step *step, const mpmi_nodes *nodes) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  const mpmi_surface_sites *sites = &nodes->surface_sites;
  if (!mpmi_surfaces_hold(step->settings)) return;
  for (int64_t i = 0; i < sites->count; ++i) sum_impulse(step, nodes, &sites->site[i]);
  for (int64_t i = 0; i < list->count; ++i)
    if (mpmi_surface_prescribes(list->surface[i])) tell_surface(step, nodes, list->surface[i]);
}
