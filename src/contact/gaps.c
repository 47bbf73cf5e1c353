/* Normal, gap and area of each touch, from the particles around its node. */
#include "contact/contact.h"
#include "layout/tasks.h"
#include "particles/particles.h"

#include <math.h>

/* A gap above this share of the spacing, and above what both bodies can close in two steps, stays open: no
 * better normal is looked for. */
static const double surely_open = 0.25;

/* ---- particles of a touch ------------------------------------------------------------------------------ */
/* The particles of the two parties, side by side in arrays, those of the second from padded[0] on. */
typedef struct around {
  const mpmi_contact_search *search;
  const mpmi_party *party[2];
  mpmi_separation points;
  double *x[3], *weight, *half_edge; /* the last: half the edge of the cube that a particle has been */
  double *far;                       /* towards the other party, along the normal that is looked at */
  const double *way;                 /* of the node, by which particles have moved along, or NULL */
  double offset;
} around;
enum { ROWS = 6, IN_TURN = 4 };

static int64_t party_particles(const mpmi_contact_nodes *contact, const mpmi_party *party) {
  int64_t count = 0;
  for (int64_t i = 0; i < party->cloud_count; ++i)
    count += contact->cloud[contact->cloud[party->first_cloud + i].source].count;
  return count;
}

static int64_t padded(int64_t count) {
  return (count + MPMI_CHUNK - 1) / MPMI_CHUNK * MPMI_CHUNK;
}

/* The edges of particles: equal volumes in a row have equal ones. ball: their sum for the discriminant. */
typedef struct edges_in_turn {
  double volume, half, ball;
} edges_in_turn;

/* Collects particles in a row from `at` on, up to the first of another set, and returns how many. */
static int64_t collect_set(around *of, const mpmi_cloud_frame *frame, const mpm_particles *set,
                           const mpmi_cloud_entry *entry, int64_t count, int64_t at, edges_in_turn *edges) {
  const double *position = mpmi_f64(set, MPMI_POSITION, of->search->copy);
  const int32_t member = entry->member;
  int64_t e = 0;
  for (; e < count && entry[e].member == member; ++e) {
    const int64_t slot = entry[e].slot;
    const double volume = mpmi_initial_extent(set, slot), share = entry[e].volume;
    for (int32_t k = 0; k < frame->dim; ++k)
      of->x[k][at + e] = mpmi_cloud_coordinate(frame, k, position[k * set->ld + slot]);
    if (volume < edges->volume || volume > edges->volume) edges->half = mpmi_half_edge(frame->dim, volume);
    edges->volume = volume;
    edges->ball += share * edges->half * edges->half / 3.0;
    of->weight[at + e] = share;
    of->half_edge[at + e] = edges->half;
  }
  return e;
}

/* Collects the particles of one party. */
static void collect(around *of, int32_t which) {
  const mpmi_layout *layout = of->search->step->layout;
  const mpm_grid *grid = layout->blocks.grid;
  const mpmi_contact_nodes *contact = of->search->contact;
  const mpmi_party *party = of->party[which];
  int64_t at = of->points.first[which];
  edges_in_turn edges = {.volume = -1.0};
  for (int64_t i = party->first_cloud; i < party->first_cloud + party->cloud_count; ++i) {
    const mpmi_cloud *source = &contact->cloud[contact->cloud[i].source];
    mpmi_cloud_frame frame = mpmi_cloud_frame_of(&layout->blocks, &contact->cloud[i]);
    if (of->way) mpmi_cloud_frame_move(&frame, of->way);
    for (int64_t e = source->first, some, end = e + source->count; e < end; at += some, e += some) {
      const mpmi_cloud_entry *entry = &contact->entry[e];
      some = collect_set(of, &frame, mpmi_resident_set(layout, entry->member), entry, end - e, at, &edges);
    }
  }
  for (int32_t k = 0; k < grid->dim; ++k)
    of->points.ball[which][k] = edges.ball * grid->inverse_spacing[k] * grid->inverse_spacing[k];
  for (; at < of->points.first[which] + of->points.padded[which]; ++at) {
    for (int32_t k = 0; k < grid->dim; ++k) of->x[k][at] = 0.0;
    of->weight[at] = 0.0;
  }
}

/* ---- gaps ---------------------------------------------------------------------------------------------- */
enum { AT_ONCE = 64 };

/* Lists which of some particles may reach farther than `most`, without a branch that depends on where they
 * are; returns how many there are. */
static int32_t list_far(const double *far, int32_t n, double half, double most, int32_t *list) {
  int32_t count = 0;
  for (int32_t p = 0; p < n; ++p) {
    list[count] = p;
    count += far[p] + half > most;
  }
  return count;
}

static double gap_between(const around *of, const double *most) {
  return -most[0] - most[1] - of->offset;
}

/* Finds how far a party reaches towards the other one along the unit vector n of the projection: the largest
 * x . n + R over its particles that are near the line through the node, in the place of the same without R.
 * It stops where this is known to be enough for a gap no wider than that. */
static void reach_out(const around *of, int32_t which, const double *n, double enough, double *most) {
  const mpmi_layout *layout = of->search->step->layout;
  const mpm_grid *grid = layout->blocks.grid;
  const mpmi_contact_nodes *contact = of->search->contact;
  const mpmi_party *party = of->party[which];
  const double half = 0.5 * grid->h_min;
  int64_t at = of->points.first[which];
  int32_t member = -1, list[AT_ONCE];
  mpmi_widths widths = {0};
  for (int64_t i = party->first_cloud; i < party->first_cloud + party->cloud_count; ++i) {
    const mpmi_cloud *cloud = &contact->cloud[i], *source = &contact->cloud[cloud->source];
    double seen[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < grid->dim; ++k) seen[k] = cloud->mirrored >> k & 1 ? -n[k] : n[k];
    for (int64_t e = source->first, left = source->count; left > 0; e += AT_ONCE, left -= AT_ONCE) {
      const int32_t some = left < AT_ONCE ? (int32_t)left : AT_ONCE;
      const int32_t far_ones = list_far(of->far + at, some, half, most[which], list);
      for (int32_t l = 0; l < far_ones; ++l) {
        const double along = of->far[at + list[l]];
        const mpmi_cloud_entry *entry = &contact->entry[e + list[l]];
        if (along + half <= most[which]) continue;
        if (entry->member != member)
          widths = mpmi_widths_of(mpmi_resident_set(layout, member = entry->member), of->search->copy);
        const double edge = of->half_edge[at + list[l]];
        const double far = along + mpmi_half_width(&widths, entry->slot, edge, seen);
        most[which] = far > most[which] ? far : most[which];
      }
      if (gap_between(of, most) <= enough) return;
      at += some;
    }
  }
}

/* The gap between all particles of both, or between those near the line through the node; infinite where one
 * of them has none. One that is no wider than `enough` need not be found: then any other such is returned. */
static double gap_along(const around *of, const double *n, int32_t whole, double enough) {
  const mpmi_step *step = of->search->step;
  const mpm_grid *grid = step->layout->blocks.grid;
  const double limit = whole || grid->dim == 1 ? (double)INFINITY : MPMI_CONTACT_REACH * MPMI_CONTACT_REACH;
  double most[2];
  step->settings->kernels->project[grid->dim](&of->points, grid->desc.spacing, n, limit, of->far, most);
  for (int32_t which = 0; which < 2 && !(gap_between(of, most) <= enough); ++which)
    reach_out(of, which, n, enough, most);
  return gap_between(of, most);
}

/* ---- normals ------------------------------------------------------------------------------------------- */
/* Makes a unit vector of the direction of a plane in cells. */
static void normal_of_plane(const mpm_grid *grid, const double *plane, double *n) {
  double squared = 0.0;
  for (int32_t k = 0; k < 3; ++k) {
    n[k] = k < grid->dim ? plane[k] * grid->inverse_spacing[k] : 0.0;
    squared += n[k] * n[k];
  }
  for (int32_t k = 0; k < 3; ++k) n[k] /= sqrt(squared);
}

/* The mean gradient of both, G_a - G_b: twice the area of the node times its normal; with or without what
 * stands beyond walls on whose plane the node lies. */
static void mean_gradient(const around *of, int32_t images, double *gradient) {
  const mpmi_contact_nodes *contact = of->search->contact;
  for (int32_t k = 0; k < 3; ++k) gradient[k] = 0.0;
  for (int32_t which = 0; which < 2; ++which) {
    const mpmi_party *party = of->party[which];
    const double sign = which ? -1.0 : 1.0;
    for (int64_t i = party->first_cloud; i < party->first_cloud + party->cloud_count; ++i) {
      const mpmi_cloud *cloud = &contact->cloud[i];
      if (!images && cloud->source != i) continue;
      for (int32_t k = 0; k < 3; ++k)
        gradient[k] += (cloud->mirrored >> k & 1 ? -sign : sign) * contact->cloud[cloud->source].gradient[k];
    }
  }
}

/* Returns 0 where both are all around the node, and no gradient is left but rounding. */
static int32_t gradient_normal(const mpm_grid *grid, const double *gradient, double *n) {
  const double squared = gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
  double cell = 1.0, inverse = grid->inverse_spacing[0];
  for (int32_t k = 0; k < grid->dim; ++k) {
    cell *= grid->desc.spacing[k];
    inverse = fmin(inverse, grid->inverse_spacing[k]);
  }
  const double least = 1e-10 * cell * inverse; /* of its smallest face */
  if (!(squared > least * least)) return 0;
  for (int32_t k = 0; k < 3; ++k) n[k] = gradient[k] / sqrt(squared);
  return 1;
}

/* How fast the bodies move against each other at the node. */
static double relative_speed(const around *of) {
  const mpmi_nodal *values = of->search->values;
  double squared = 0.0;
  for (int32_t k = 0; k < of->search->step->layout->blocks.grid->dim; ++k) {
    const double u =
        mpmi_velocity(values, of->party[1]->slot)[k] - mpmi_velocity(values, of->party[0]->slot)[k];
    squared += u * u;
  }
  return sqrt(squared);
}

/* Improves a normal by regression, where that ends. */
static void fit_normal(around *of, double *normal) {
  const mpm_grid *grid = of->search->step->layout->blocks.grid;
  double fitted[3];
  if (!of->search->step->settings->kernels->fit[grid->dim](&of->points)) return;
  normal_of_plane(grid, of->points.plane, fitted);
  if (!(fitted[0] - fitted[0] + fitted[1] - fitted[1] + fitted[2] - fitted[2] == 0.0)) return;
  for (int32_t k = 0; k < 3; ++k) normal[k] = fitted[k];
}

/* Finds the normal by the particles. Returns 0 where there is none; open becomes 1 where the bodies are too
 * far apart to need a better one than that of the discriminant. */
static int32_t plane_normal(around *of, mpmi_touch *touch) {
  const mpmi_step *step = of->search->step;
  const mpm_grid *grid = step->layout->blocks.grid;
  const mpmi_kernels *kernels = step->settings->kernels;
  if (!kernels->discriminate[grid->dim](&of->points)) return 0;
  normal_of_plane(grid, of->points.plane, touch->normal);
  if (!mpmi_detects_by_velocity(touch->rule)) {
    /* what an implicit step solves for may be faster than what it starts from */
    const double least = mpmi_is_implicit(step->settings)
                             ? grid->h_min
                             : fmax(surely_open * grid->h_min, 2.0 * step->dt * relative_speed(of));
    /* that of all particles is no wider than that of some */
    double gap = gap_along(of, touch->normal, 0, least);
    if (gap > least) gap = gap_along(of, touch->normal, 1, least);
    touch->open = gap > least;
    if (touch->open) touch->gap = gap;
  }
  if (!touch->open && touch->rule->normal != MPM_NORMAL_DISCRIMINANT) fit_normal(of, touch->normal);
  return 1;
}

static int32_t find_normal(around *of, const double *gradient, mpmi_touch *touch) {
  const mpm_contact_desc *rule = touch->rule;
  if (rule->kind == MPM_CONTACT_TIED || rule->normal == MPM_NORMAL_GRADIENT)
    return gradient_normal(of->search->step->layout->blocks.grid, gradient, touch->normal);
  if (rule->normal != MPM_NORMAL_FIXED) return plane_normal(of, touch);
  for (int32_t k = 0; k < 3; ++k) touch->normal[k] = touch->direction_sign * rule->direction[k];
  return 1;
}

/* Collects the particles around a touch. */
static around around_touch(const mpmi_contact_search *search, const mpmi_touch *touch, double *memory) {
  const mpmi_contact_nodes *contact = search->contact;
  around of = {.search = search,
               .party = {&contact->party[touch->party[0]], &contact->party[touch->party[1]]},
               .offset = touch->rule->offset,
               .way = search->copy ? touch->way : NULL};
  int64_t first = 0;
  for (int32_t c = 0; c < 2; ++c) {
    of.points.count[c] = party_particles(contact, of.party[c]);
    of.points.first[c] = first;
    of.points.padded[c] = padded(of.points.count[c]);
    first += of.points.padded[c];
  }
  for (int32_t k = 0; k < 3; ++k) of.points.x[k] = of.x[k] = memory + k * first;
  of.points.weight = of.weight = memory + 3 * first;
  of.half_edge = memory + 4 * first;
  of.far = memory + 5 * first;
  collect(&of, 0);
  collect(&of, 1);
  return of;
}

static void find_touch(const mpmi_contact_search *search, mpmi_touch *touch, double *memory) {
  const mpmi_contact_nodes *contact = search->contact;
  const mpm_grid *grid = search->step->layout->blocks.grid;
  around of = around_touch(search, touch, memory);
  double gradient[3], along = 0.0;
  touch->open = touch->ambiguous = 0;
  touch->gap = (double)INFINITY;
  touch->friction = touch->rule->friction;
  touch->friction_static = fmax(touch->rule->friction, touch->rule->friction_static);
  mean_gradient(&of, 1, gradient);
  if (!find_normal(&of, gradient, touch)) {
    touch->open = touch->ambiguous = touch->rule->kind != MPM_CONTACT_TIED;
    return;
  }
  mean_gradient(&of, 0, gradient);
  for (int32_t k = 0; k < 3; ++k) along += gradient[k] * touch->normal[k];
  touch->area = 0.25 * fabs(along) *
                (mpmi_party_radius(search->step->layout, contact, of.party[0]) +
                 mpmi_party_radius(search->step->layout, contact, of.party[1]));
  if (touch->open || touch->rule->kind == MPM_CONTACT_TIED) return;
  touch->gap = gap_along(&of, touch->normal, 0, -(double)INFINITY);
  if (!mpmi_detects_by_velocity(touch->rule)) touch->open = !(touch->gap <= grid->h_min);
}

/* Finds the gap of a touch once more, where its node is a point of the second body that has moved along.
 * Weights of particles, and a normal by gradients, stay those of the start. */
static void find_gap_after(const mpmi_contact_search *search, mpmi_touch *touch, double *memory) {
  const mpm_grid *grid = search->step->layout->blocks.grid;
  const int32_t rule = touch->rule->normal;
  double normal[3] = {touch->normal[0], touch->normal[1], touch->normal[2]};
  around of = around_touch(search, touch, memory);
  if ((rule == MPM_NORMAL_LOGISTIC || rule == MPM_NORMAL_DISCRIMINANT) &&
      search->step->settings->kernels->discriminate[grid->dim](&of.points)) {
    normal_of_plane(grid, of.points.plane, normal);
    if (rule == MPM_NORMAL_LOGISTIC) fit_normal(&of, normal);
  }
  touch->gap_after = gap_along(&of, normal, 0, -(double)INFINITY);
}

/* Asks for the particles of a touch of bodies, which were written some time ago. */
static void fetch_touch(const mpmi_contact_nodes *contact, const mpmi_touch *touch) {
  enum { IN_LINE = 64 / (int32_t)sizeof(mpmi_cloud_entry) };
  for (int32_t which = 0; which < 2 && !mpmi_is_of_surface(contact, touch); ++which) {
    const mpmi_cloud *cloud = &contact->cloud[contact->party[touch->party[which]].first_cloud];
    for (int64_t e = 0; e < cloud->count; e += IN_LINE) __builtin_prefetch(&contact->entry[cloud->first + e]);
  }
}

/* Touches that are open at once cost less than others, and lie side by side: tasks take a few in turn. */
static void find_task(void *data, int64_t k) {
  const mpmi_contact_search *search = data;
  mpmi_contact_nodes *contact = search->contact;
  const int32_t tasks = search->step->settings->tasks;
  for (int64_t i = 0; i < contact->touch_count; ++i)
    if (i / IN_TURN % tasks == k && !mpmi_is_of_surface(contact, &contact->touch[i])) {
      if (i + 1 < contact->touch_count) fetch_touch(contact, &contact->touch[i + 1]);
      find_touch(search, &contact->touch[i], contact->work + k * contact->work_each);
    }
}

static void find_task_after(void *data, int64_t k) {
  const mpmi_contact_search *search = data;
  mpmi_contact_nodes *contact = search->contact;
  const int32_t tasks = search->step->settings->tasks;
  for (int64_t i = 0; i < contact->touch_count; ++i)
    if (i / IN_TURN % tasks == k && contact->touch[i].asked &&
        !mpmi_is_of_surface(contact, &contact->touch[i]))
      find_gap_after(search, &contact->touch[i], contact->work + k * contact->work_each);
}

mpm_status mpmi_gaps_find_after(mpmi_contact_search *search) {
  const mpmi_settings *settings = search->step->settings;
  return mpmi_run_tasks(settings, 0, settings->tasks, find_task_after, search);
}

mpm_status mpmi_gaps_find(mpmi_contact_search *search) {
  const mpmi_settings *settings = search->step->settings;
  mpmi_contact_nodes *contact = search->contact;
  contact->work_each = 0;
  for (int64_t i = 0; i < contact->touch_count; ++i) {
    int64_t most = 0;
    for (int32_t c = 0; c < 2 && !mpmi_is_of_surface(contact, &contact->touch[i]); ++c)
      most += padded(party_particles(contact, &contact->party[contact->touch[i].party[c]]));
    if (ROWS * most > contact->work_each) contact->work_each = ROWS * most;
  }
  const mpm_status status = MPMI_RESERVE_MORE(settings->context, contact->work, contact->work_capacity,
                                              contact->work_each * settings->tasks);
  return status ? status : mpmi_run_tasks(settings, 0, settings->tasks, find_task, search);
}
