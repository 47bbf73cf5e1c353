/* A state holds the markers of surfaces with what they carry, and the impulses of what surfaces prescribe.
 * Loads of whole surfaces are settings of the host. */
#include "io/state.h"

#include <math.h>
#include <stdio.h>

void mpmi_state_write_surfaces(mpmi_archive *a, const mpm_stepper *s) {
  const mpmi_surfaces *list = &s->settings.surfaces;
  mpmi_archive_same_int(a, "number of surfaces", list->count);
  for (int64_t i = 0; i < list->count; ++i) {
    mpm_surface *surface = list->surface[i];
    mpmi_archive_same_int(a, "body", surface->desc.body);
    int64_t numbers[2] = {surface->now.count, surface->now.next_id};
    mpmi_archive_words(a, numbers, sizeof numbers);
    mpmi_archive_words(a, &surface->impulses, sizeof surface->impulses);
    mpmi_archive_words(a, surface->now.at, surface->now.count * (int64_t)sizeof(mpmi_marker));
  }
}

/* Returns 1 where a step could work with a marker. */
static int32_t is_sound(const mpm_grid *grid, const mpmi_marker *m) {
  const double *place = mpmi_marker_place_of(m, grid);
  double sum = m->reference_area + m->pressure, x[3];
  for (int32_t k = 0; k < 3; ++k) {
    x[k] = place[k];
    sum += m->position[k] + m->reference[k] + m->reference_edge[0][k] + m->reference_edge[1][k];
    sum += m->edge[0][k] + m->edge[1][k] + m->displacement[k] + m->velocity[k] + m->force[k];
    sum += m->traction[k] + m->dead_traction[k];
    sum += m->prescribed_velocity[k] + m->reaction[k] + m->gap[k];
  }
  int32_t sound = isfinite(sum) && m->reference_area >= 0.0 && mpmi_grid_place(grid, x, 1, NULL, 0) < 0;
  for (int32_t k = 0; k < grid->dim; ++k) sound &= !(x[k] < place[k] || x[k] > place[k]);
  return sound;
}

static mpm_status read_surface(mpmi_archive *a, const mpm_surface *surface, mpmi_state_surface *saved) {
  mpmi_markers *to = &saved->markers;
  int64_t numbers[2] = {0, 0};
  double sum = 0.0;
  mpmi_archive_same_int(a, "body", surface->desc.body);
  mpmi_archive_words(a, numbers, sizeof numbers);
  mpmi_archive_words(a, &saved->impulses, sizeof saved->impulses);
  if (a->status) return a->status;
  for (int32_t k = 0; k < 3; ++k) sum += saved->impulses.last[k] + saved->impulses.total[k];
  if (!isfinite(sum)) return mpmi_archive_damaged(a, "the impulses make no sense");
  const int64_t room = (a->size - a->at) / (int64_t)sizeof(mpmi_marker);
  if (numbers[0] < 0 || numbers[0] > room || numbers[1] < numbers[0] || numbers[1] > INT64_MAX / 2)
    return mpmi_archive_damaged(a, "the number of markers makes no sense");
  const mpm_status status = mpmi_markers_reserve(a->context, to, numbers[0]);
  if (status) return status;
  mpmi_archive_words(a, to->at, numbers[0] * (int64_t)sizeof(mpmi_marker));
  to->count = a->status ? 0 : numbers[0];
  to->next_id = numbers[1];
  for (int64_t i = 0; i < to->count && !a->status; ++i)
    if (!is_sound(surface->grid, &to->at[i]) || to->at[i].id >= to->next_id ||
        to->at[i].id <= (i ? to->at[i - 1].id : -1))
      mpmi_archive_damaged(a, "a marker makes no sense");
  return a->status;
}

mpm_status mpmi_state_read_surfaces(mpmi_archive *a, const mpm_stepper *s, mpmi_state_surface *saved) {
  const mpmi_surfaces *list = &s->settings.surfaces;
  mpm_status status = MPM_OK;
  mpmi_archive_same_int(a, "number of surfaces", list->count);
  status = a->status;
  for (int64_t i = 0; i < list->count && !status; ++i) {
    snprintf(a->where, sizeof a->where, "surface %lld: ", (long long)i);
    status = read_surface(a, list->surface[i], &saved[i]);
  }
  a->where[0] = '\0';
  return status;
}

void mpmi_state_take_surfaces(const mpm_stepper *s, mpmi_state_surface *saved) {
  for (int64_t i = 0; i < s->settings.surfaces.count; ++i) {
    mpm_surface *surface = s->settings.surfaces.surface[i];
    const mpmi_markers old = surface->now;
    surface->now = saved[i].markers;
    surface->impulses = saved[i].impulses;
    saved[i].markers = old;
  }
}
