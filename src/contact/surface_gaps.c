/* The gap between a body and a surface at a node: the least clearance of the body's particles near the line
 * through the node along the normal. Each particle's clearance, its distance less its half-width, is found
 * once for each surface. */
#include "contact/contact.h"
#include "layout/tasks.h"
#include "layout/visit.h"
#include "particles/values.h"

#include <math.h>

/* Particles farther from the surface, in spacings, cannot decide. */
static const double near_enough = 2.0;

typedef struct surface_job {
  mpmi_contact_search *search;
  int32_t number;
  mpmi_rigid_surface surface; /* where it is at that time */
  double t;
} surface_job;

/* ---- clearances of particles --------------------------------------------------------------------------- */
typedef struct half_edge_cache {
  double volume, edge;
} half_edge_cache;

static void note_fault(const surface_job *job, const mpmi_residents *in, const mpmi_distance_fault *fault,
                       const int64_t *slot, mpmi_failure *failure) {
  const int64_t particle = fault->point < 0 ? -1 : mpmi_i64(in->set, MPMI_ID, 0)[slot[fault->point]];
  const int32_t m = mpmi_resident_home(job->search->step->layout, in->member);
  mpmi_failure found = mpmi_particle_failure(fault->cause, m, particle, fault->what);
  found.callback_status = fault->returned;
  mpmi_failure_take(failure, found);
}

/* Inert slots are no particles of clouds. */
static void clear_chunk(const surface_job *job, const mpmi_residents *in, int64_t begin, int64_t end,
                        half_edge_cache *last, mpmi_failure *failure) {
  const mpmi_contact_nodes *contact = job->search->contact;
  const mpm_particles *set = in->set;
  const mpm_grid *grid = set->grid;
  const int32_t copy = job->search->copy, leaves = copy && !mpmi_is_total_lagrangian(grid);
  const mpmi_widths widths = mpmi_widths_of(set, copy);
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  double *clearance = contact->clearance + contact->clearance_first[in->member];
  mpmi_distances points = {.n = 0, .t = job->t};
  mpmi_distance_fault fault;
  int64_t slot[MPMI_DISTANCE_POINTS];
  for (int64_t s = begin; s < end; ++s) {
    clearance[s] = (double)INFINITY;
    if (id[s] < 0 || (leaves && mpmi_is_beyond(set, copy, s))) continue;
    for (int32_t k = 0; k < grid->dim; ++k)
      points.position[k][points.n] = mpmi_f64(set, MPMI_POSITION, copy)[k * set->ld + s];
    slot[points.n++] = s;
  }
  if (!points.n) return;
  if (mpmi_surface_distances(&job->surface, &points, &fault)) {
    note_fault(job, in, &fault, slot, failure);
    return;
  }
  for (int64_t p = 0; p < points.n; ++p) {
    const double distance = points.distance[p];
    clearance[slot[p]] = distance;
    if (distance > near_enough * grid->h_min) continue;
    const double n[3] = {points.normal[0][p], points.normal[1][p], points.normal[2][p]};
    const double volume = mpmi_initial_extent(set, slot[p]);
    if (volume < last->volume || volume > last->volume)
      *last = (half_edge_cache){volume, mpmi_half_edge(grid->dim, volume)};
    clearance[slot[p]] = distance - mpmi_half_width(&widths, slot[p], last->edge, n);
  }
}

static void clear_block(void *user, const mpmi_visit *visit) {
  const surface_job *job = user;
  const int64_t block = visit->block;
  mpmi_failure *failure = &job->search->step->work->report[visit->task].failure;
  const mpmi_layout *layout = job->search->step->layout;
  const mpmi_contact_nodes *contact = job->search->contact;
  const mpm_grid *grid = layout->blocks.grid;
  half_edge_cache last = {-1.0, 0.0};
  /* stencils and drift take particles less than three spacings out of their block's nodes, steps farther */
  const int32_t far = mpmi_block_is_far(&layout->blocks, block, 3 + job->search->moved, &job->surface,
                                        near_enough * grid->h_min);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpmi_residents in = mpmi_residents_of(layout, m, block);
    double *clearance = contact->clearance + contact->clearance_first[in.member];
    for (int64_t s = in.begin; s < in.end; s += MPMI_DISTANCE_POINTS) {
      const int64_t upto = in.end - s < MPMI_DISTANCE_POINTS ? in.end : s + MPMI_DISTANCE_POINTS;
      for (int64_t p = s; p < upto && far; ++p) clearance[p] = (double)INFINITY;
      if (!far) clear_chunk(job, &in, s, upto, &last, failure);
    }
  }
}

/* ---- gaps ---------------------------------------------------------------------------------------------- */
/* Finds the direction in which what lies along n now lay before the material deformed, as a cloud that is a
 * mirror image sees it: that of F^-1 n. */
static void pull_direction(const mpm_particles *set, int64_t slot, int32_t mirrored, const double *n,
                           double *direction) {
  double inverse[3][3], sign[3], squared = 0.0;
  mpmi_inverse_at(set, slot, inverse);
  for (int32_t k = 0; k < 3; ++k) sign[k] = mirrored >> k & 1 ? -1.0 : 1.0;
  for (int32_t i = 0; i < 3; ++i) {
    direction[i] = 0.0;
    for (int32_t k = 0; k < 3; ++k) direction[i] += sign[i] * inverse[i][k] * sign[k] * n[k];
    squared += direction[i] * direction[i];
  }
  for (int32_t i = 0; i < 3; ++i) direction[i] /= sqrt(squared);
}

/* Returns 1 when a particle, at x in cells, is off the line through its node along n by no more than the
 * reach. */
static int32_t is_beside(const mpm_grid *grid, const double *x, const double *n) {
  double along = 0.0, squared = 0.0;
  for (int32_t k = 0; k < grid->dim; ++k) along += x[k] * grid->desc.spacing[k] * n[k];
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double off = x[k] - along * n[k] * grid->inverse_spacing[k];
    squared += off * off;
  }
  return grid->dim == 1 || squared <= MPMI_CONTACT_REACH * MPMI_CONTACT_REACH;
}

/* Who is near the line is so at the start of the step. */
static double gap_of(const mpmi_contact_search *search, const mpmi_party *party, const double *n) {
  const mpmi_layout *layout = search->step->layout;
  const mpmi_contact_nodes *contact = search->contact;
  double gap = (double)INFINITY;
  for (int64_t i = party->first_cloud; i < party->first_cloud + party->cloud_count; ++i) {
    const mpmi_cloud *cloud = &contact->cloud[i], *source = &contact->cloud[cloud->source];
    const mpmi_cloud_frame frame = mpmi_cloud_frame_of(&layout->blocks, cloud);
    double x[3];
    for (int64_t e = source->first; e < source->first + source->count; ++e) {
      const mpmi_cloud_entry *entry = &contact->entry[e];
      const double clearance = contact->clearance[contact->clearance_first[entry->member] + entry->slot];
      if (!(clearance < gap)) continue;
      const mpm_particles *set = mpmi_resident_set(layout, entry->member);
      mpmi_cloud_place(&frame, mpmi_places(set, 0), set->ld, entry->slot, x);
      double along[3] = {n[0], n[1], n[2]};
      if (mpmi_is_total_lagrangian(set->grid)) pull_direction(set, entry->slot, cloud->mirrored, n, along);
      if (is_beside(layout->blocks.grid, x, along)) gap = clearance;
    }
  }
  return gap;
}

/* The area of the body's surface at the node, without what stands beyond walls. */
static double area_of(const mpmi_contact_nodes *contact, const mpmi_party *party, const double *n) {
  double along = 0.0;
  for (int64_t i = party->first_cloud; i < party->first_cloud + party->cloud_count; ++i) {
    const mpmi_cloud *cloud = &contact->cloud[i];
    for (int32_t k = 0; k < 3 && cloud->source == i; ++k)
      along += (cloud->mirrored >> k & 1 ? -n[k] : n[k]) * cloud->gradient[k];
  }
  return fabs(along);
}

static void find_touch(const mpmi_contact_search *search, mpmi_touch *touch) {
  const mpmi_contact_nodes *contact = search->contact;
  const mpmi_party *party = &contact->party[touch->party[1]];
  for (int32_t k = 0; k < 3; ++k) touch->normal[k] = contact->party[touch->party[0]].normal[k];
  touch->friction = touch->rule->friction;
  touch->friction_static = fmax(touch->rule->friction, touch->rule->friction_static);
  touch->area =
      area_of(contact, party, touch->normal) * mpmi_party_radius(search->step->layout, contact, party);
  touch->gap = gap_of(search, party, touch->normal);
  touch->open =
      touch->rule->kind == MPM_CONTACT_UNILATERAL && !(touch->gap <= search->step->settings->grid->h_min);
}

/* Finds the gap of a touch once more: the least clearance that the same particles have now. */
static void find_gap_after(const mpmi_contact_search *search, mpmi_touch *touch) {
  if (touch->asked)
    touch->gap_after = gap_of(search, &search->contact->party[touch->party[1]], touch->normal);
}

static void gap_task(void *data, int64_t k) {
  const surface_job *job = data;
  const mpmi_contact_nodes *contact = job->search->contact;
  const int64_t *first = contact->by_surface + job->number;
  const mpmi_share share = mpmi_share_of(job->search->step->settings, first[1] - first[0], k);
  const int64_t *list = contact->by_surface + contact->surface_count + 1 + first[0];
  for (int64_t i = share.begin; i < share.end; ++i)
    (job->search->copy ? find_gap_after : find_touch)(job->search, &contact->touch[list[i]]);
}

/* ---- surface by surface -------------------------------------------------------------------------------- */
/* Lists the touches of each surface. */
static mpm_status list_touches(const mpmi_contact_search *search) {
  mpmi_contact_nodes *contact = search->contact;
  const int64_t surfaces = contact->surface_count;
  const mpm_status status =
      MPMI_RESERVE_MORE(search->step->settings->context, contact->by_surface, contact->by_surface_capacity,
                        surfaces + 1 + contact->touch_count);
  if (status) return status;
  int64_t *first = contact->by_surface, *list = first + surfaces + 1;
  for (int64_t i = 0; i <= surfaces; ++i) first[i] = 0;
  for (int64_t i = 0; i < contact->touch_count; ++i)
    if (mpmi_is_of_surface(contact, &contact->touch[i]))
      ++first[contact->party[contact->touch[i].party[0]].surface];
  for (int64_t i = 0; i < surfaces; ++i) first[i + 1] += first[i];
  for (int64_t i = contact->touch_count - 1; i >= 0; --i)
    if (mpmi_is_of_surface(contact, &contact->touch[i]))
      list[--first[contact->party[contact->touch[i].party[0]].surface]] = i;
  return MPM_OK;
}

static mpm_status reserve_clearances(const mpmi_contact_search *search) {
  mpm_context *c = search->step->settings->context;
  const mpmi_layout *layout = search->step->layout;
  mpmi_contact_nodes *contact = search->contact;
  const int32_t members =
      layout->parts && layout->parts->guest_count ? 2 * layout->member_count : layout->member_count;
  mpm_status status = MPMI_RESERVE_MORE(c, contact->clearance_first, contact->first_capacity, members);
  if (status) return status;
  int64_t slots = 0;
  for (int32_t m = 0; m < members; ++m) {
    contact->clearance_first[m] = slots;
    slots += mpmi_resident_set(layout, m)->slots;
  }
  return MPMI_RESERVE_MORE(c, contact->clearance, contact->clearance_capacity, slots);
}

/* Finds the gaps of all touches of a surface. */
static mpm_status find_gaps_of(surface_job *job) {
  const mpmi_contact_search *search = job->search;
  const uint8_t *in_reach = search->contact->in_reach;
  const int32_t asks = job->surface.shape == MPM_SHAPE_DISTANCE;
  mpm_status status = mpmi_visit_marked(search->step, in_reach, asks, clear_block, job);
  if (!status) status = mpmi_visit_ghosts(search->step, in_reach, asks, clear_block, job);
  if (!status) status = mpmi_step_failure(search->step);
  if (!status)
    status = mpmi_run_tasks(search->step->settings, 0, search->step->settings->tasks, gap_task, job);
  return status;
}

static int32_t has_touches(const mpmi_contact_nodes *contact, int64_t i) {
  return contact->by_surface[i] < contact->by_surface[i + 1];
}

static int32_t any_is_asked(const mpmi_contact_nodes *contact, int64_t i) {
  const int64_t *list = contact->by_surface + contact->surface_count + 1;
  int32_t asked = 0;
  for (int64_t k = contact->by_surface[i]; k < contact->by_surface[i + 1]; ++k)
    asked |= contact->touch[list[k]].asked;
  return asked;
}

mpm_status mpmi_surface_gaps_find(mpmi_contact_search *search) {
  const mpmi_contact_nodes *contact = search->contact;
  if (!contact->near_count) return MPM_OK;
  mpm_status status = list_touches(search);
  if (!status) status = reserve_clearances(search);
  for (int32_t i = 0; i < contact->surface_count && !status; ++i) {
    surface_job job = {search, i, contact->surface[i], search->step->t};
    if (has_touches(contact, i)) status = find_gaps_of(&job);
  }
  return status;
}

mpm_status mpmi_surface_gaps_find_after(mpmi_contact_search *search) {
  const mpmi_contact_nodes *contact = search->contact;
  const mpmi_step *step = search->step;
  mpm_status status = MPM_OK;
  if (!contact->near_count || !contact->touch_count) return MPM_OK;
  for (int32_t i = 0; i < contact->surface_count && !status; ++i) {
    surface_job job = {search, i, contact->surface[i], step->t + step->dt};
    mpmi_surface_advance(&job.surface, step->dt);
    if (any_is_asked(contact, i)) status = find_gaps_of(&job);
  }
  return status;
}
