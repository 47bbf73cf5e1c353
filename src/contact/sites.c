/* Sites: the places of blocks where there may be contact, because several bodies have blocks there or a
 * surface is near; and what near surfaces are at the nodes of these blocks. */
#include "contact/contact.h"
#include "layout/tasks.h"

#include <math.h>

/* Nodes no farther from a surface than this many spacings along its normal are bound to it: at least one row
 * outside that is more than a tenth of a cell away, without which a body at rest chatters. */
static const double bound_within = 1.1;
/* On a total Lagrangian grid these rows are of the same material for ever, and more of them would be stiff:
 * the row at the surface or the next one outside is enough, by the distance of rows as they are. */
static const double bound_within_total = 0.6;

/* ---- surfaces ------------------------------------------------------------------------------------------ */
static mpm_status make_surfaces(const mpmi_settings *settings, mpmi_contact_nodes *contact) {
  const mpm_grid *grid = settings->grid;
  const mpmi_obstacles *obstacles = &settings->obstacles;
  int64_t count = obstacles->count;
  for (int32_t face = 0; face < 2 * grid->dim; ++face) count += mpmi_is_friction_plane(settings, face);
  const mpm_status status =
      MPMI_RESERVE_MORE(settings->context, contact->surface, contact->surface_capacity, count);
  if (status) return status;
  contact->surface_count = count;
  for (int64_t i = 0; i < obstacles->count; ++i)
    mpmi_surface_of_obstacle(&contact->surface[i], grid, obstacles->obstacle[i]);
  int64_t at = obstacles->count;
  for (int32_t face = 0; face < 2 * grid->dim; ++face)
    if (mpmi_is_friction_plane(settings, face))
      mpmi_surface_of_wall(&contact->surface[at++], grid, face, &settings->wall[face]);
  return MPM_OK;
}

void mpmi_rigid_surfaces_predict(mpmi_contact_nodes *contact, const mpmi_settings *settings,
                                 double velocity_dt) {
  for (int64_t i = 0; i < contact->surface_count; ++i)
    if (mpmi_is_free(&contact->surface[i]))
      mpmi_rigid_predict(&contact->surface[i], settings->desc.gravity, velocity_dt);
}

/* ---- sites --------------------------------------------------------------------------------------------- */
/* A ball around nodes. */
typedef struct ball {
  double centre[3], radius;
} ball;

static ball ball_around(const mpm_grid *grid, const int64_t *first, const int64_t *last) {
  ball of = {{0.0, 0.0, 0.0}, 0.0};
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double low = mpmi_node_position(grid, k, first[k]), high = mpmi_node_position(grid, k, last[k]);
    of.centre[k] = 0.5 * (low + high);
    of.radius += 0.25 * (high - low) * (high - low);
  }
  of.radius = sqrt(of.radius);
  return of;
}

static ball ball_of_block(const mpmi_blocks *b, int64_t block, int64_t margin) {
  int64_t first[3], last[3];
  mpmi_blocks_index(b, block * b->nodes, first);
  mpmi_blocks_index(b, (block + 1) * b->nodes - 1, last);
  for (int32_t k = 0; k < b->grid->dim; ++k) first[k] -= margin, last[k] += margin;
  return ball_around(b->grid, first, last);
}

static double widest_spacing(const mpm_grid *grid) {
  double h = 0.0;
  for (int32_t k = 0; k < grid->dim; ++k) h = fmax(h, grid->desc.spacing[k]);
  return h;
}

/* Nodes of a total Lagrangian grid may be anywhere. */
int32_t mpmi_block_is_far(const mpmi_blocks *b, int64_t block, int64_t margin,
                          const mpmi_rigid_surface *surface, double beyond) {
  if (mpmi_is_total_lagrangian(b->grid)) return 0;
  const ball of = ball_of_block(b, block, margin);
  return mpmi_surface_is_far(surface, of.centre, of.radius, beyond);
}

/* Surfaces that are far from all blocks need not be looked at again. */
static void find_active(const mpmi_blocks *b, mpmi_contact_nodes *contact, double beyond) {
  int64_t first[3], last[3], index[3];
  for (int64_t block = 0; block < b->count; ++block)
    for (int32_t end = 0; end < 2; ++end) {
      mpmi_blocks_index(b, end ? (block + 1) * b->nodes - 1 : block * b->nodes, index);
      for (int32_t k = 0; k < b->grid->dim; ++k) {
        first[k] = block + end == 0 || index[k] < first[k] ? index[k] : first[k];
        last[k] = block + end == 0 || index[k] > last[k] ? index[k] : last[k];
      }
    }
  for (int64_t i = 0; i < contact->surface_count; ++i) {
    mpmi_rigid_surface *surface = &contact->surface[i];
    surface->active = 0;
    if (!b->count || surface->rule.kind == MPM_CONTACT_NONE) continue;
    const ball all = ball_around(b->grid, first, last);
    surface->active =
        mpmi_is_total_lagrangian(b->grid) || !mpmi_surface_is_far(surface, all.centre, all.radius, beyond);
  }
}

/* Goes through the places of blocks; counts sites and near surfaces, or writes them with `fill`. */
static void visit_places(const mpmi_layout *layout, mpmi_contact_nodes *contact, double beyond,
                         int32_t fill) {
  const mpmi_blocks *b = &layout->blocks;
  int64_t sites = 0, nears = 0, end;
  for (int64_t first = 0; first < b->count; first = end) {
    const int64_t first_near = nears;
    for (end = first + 1; end < b->count && b->key[end] == b->key[first];) ++end;
    for (int32_t i = 0; i < contact->surface_count; ++i) {
      if (!contact->surface[i].active || mpmi_block_is_far(b, first, 0, &contact->surface[i], beyond))
        continue;
      if (fill) contact->near_surface[nears] = (mpmi_near){i, (int32_t)first};
      contact->at_walls |= contact->surface[i].face >= 0;
      ++nears;
    }
    if (end - first < 2 && nears == first_near) continue;
    if (fill)
      contact->site[sites] =
          (mpmi_site){{(int32_t)first, (int32_t)(end - first)}, first_near, (int32_t)(nears - first_near)};
    ++sites;
  }
  contact->site_count = sites;
  contact->near_count = nears;
}

/* Without surfaces only groups of blocks are sites. */
static mpm_status find_sites(const mpmi_layout *layout, const mpmi_settings *settings,
                             mpmi_contact_nodes *contact) {
  mpm_context *c = settings->context;
  const mpmi_block_groups *groups = &layout->groups;
  const double beyond = bound_within * widest_spacing(settings->grid);
  int32_t active = 0;
  if (contact->surface_count) find_active(&layout->blocks, contact, beyond);
  for (int64_t i = 0; i < contact->surface_count; ++i) active |= contact->surface[i].active;
  contact->site_count = groups->count;
  contact->near_count = 0;
  contact->at_walls = 0;
  if (active) visit_places(layout, contact, beyond, 0);
  const int64_t values = contact->near_count * MPMI_NEAR_ROWS * layout->blocks.nodes;
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(c, contact->site, contact->site_capacity, contact->site_count)) ||
      (status = MPMI_RESERVE_MORE(c, contact->near_surface, contact->near_capacity, contact->near_count)) ||
      (status = MPMI_RESERVE_MORE(c, contact->near_value, contact->value_capacity, values)))
    return status;
  if (active)
    visit_places(layout, contact, beyond, 1);
  else
    for (int64_t g = 0; g < groups->count; ++g) contact->site[g] = (mpmi_site){groups->group[g], 0, 0};
  return MPM_OK;
}

static mpm_status add_records(const mpmi_layout *layout, const mpmi_contact_nodes *contact,
                              mpm_context *context, mpmi_pair_records *records) {
  const int32_t *body = layout->blocks.body;
  mpm_status status = MPM_OK;
  for (int64_t at = 0; at < contact->site_count; ++at) {
    const mpmi_site *site = &contact->site[at];
    const int32_t end = site->blocks.first + site->blocks.count;
    for (int32_t i = site->blocks.first; i < end; ++i) {
      for (int32_t j = i + 1; j < end && !status; ++j)
        status = mpmi_pair_add(records, context, body[i], body[j]);
      for (int32_t j = 0; j < site->near_count && !status; ++j) {
        const int32_t surface = contact->near_surface[site->first_near + j].surface;
        status = mpmi_pair_add(records, context, mpmi_code_of(&contact->surface[surface]), body[i]);
      }
    }
  }
  return status;
}

mpm_status mpmi_contact_prepare(const mpmi_layout *layout, const mpmi_settings *settings,
                                mpmi_contact_nodes *contact, mpmi_pair_records *records) {
  contact->touch_count = contact->meeting_count = contact->party_count = 0;
  mpm_status status = make_surfaces(settings, contact);
  if (!status) status = find_sites(layout, settings, contact);
  contact->anywhere = contact->site_count > 0;
  return status ? status : add_records(layout, contact, settings->context, records);
}

/* ---- surfaces at the nodes of sites -------------------------------------------------------------------- */
static double spacing_along(const mpm_grid *grid, const double *n) {
  double squared = 0.0;
  for (int32_t k = 0; k < grid->dim; ++k)
    squared += n[k] * n[k] * grid->desc.spacing[k] * grid->desc.spacing[k];
  return sqrt(squared);
}

/* Finds how far apart nodes are along a normal around node i of a block: on a total Lagrangian grid by the
 * places of those beside it that move with mass. */
static double distance_of_nodes(const mpmi_contact_search *search, int64_t block, int32_t i,
                                const double *n) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  const int64_t slot = block * b->nodes + i;
  double squared = 0.0;
  if (!mpmi_is_total_lagrangian(b->grid)) return spacing_along(b->grid, n);
  for (int32_t k = 0; k < b->grid->dim; ++k) {
    double most = 0.0;
    for (int32_t side = -1; side <= 1; side += 2) {
      const int32_t offset[3] = {k == 0 ? side : 0, k == 1 ? side : 0, k == 2 ? side : 0};
      const int64_t beside = mpmi_blocks_around(b, slot, offset);
      double along = 0.0;
      if (beside < 0 || !(*mpmi_mass(search->values, beside) > search->step->layout->mass_cut)) continue;
      for (int32_t c = 0; c < b->grid->dim; ++c)
        along += n[c] * (search->contact->place[beside][c] - search->contact->place[slot][c]);
      most = fmax(most, fabs(along));
    }
    squared += most * most;
  }
  return squared > 0.0 ? sqrt(squared) : spacing_along(b->grid, n);
}

/* Nodes of a block that lie beyond the grid have no material: hosts are not asked for them, and none of them
 * is bound. */
static void measure_near(const mpmi_contact_search *search, int64_t which, mpmi_failure *failure) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  const mpmi_contact_nodes *contact = search->contact;
  const mpmi_near *near = &contact->near_surface[which];
  const int64_t first = (int64_t)near->block * b->nodes;
  double *value = contact->near_value + which * MPMI_NEAR_ROWS * b->nodes;
  const double within = mpmi_is_total_lagrangian(b->grid) ? bound_within_total : bound_within;
  mpmi_distances points = {.n = 0, .t = search->step->t, .moves = 1};
  mpmi_distance_fault fault;
  int32_t node[MPMI_DISTANCE_POINTS];
  for (int32_t i = 0; i < b->nodes; ++i) {
    int64_t index[3];
    double x[3];
    value[MPMI_NEAR_DISTANCE * b->nodes + i] = (double)INFINITY;
    mpmi_blocks_index(b, first + i, index);
    if (!mpmi_node_exists(b->grid, index)) continue;
    mpmi_contact_position(b, contact, first + i, x);
    for (int32_t k = 0; k < b->grid->dim; ++k) points.position[k][points.n] = x[k];
    node[points.n++] = i;
  }
  if (!points.n) return;
  if (mpmi_surface_distances(&contact->surface[near->surface], &points, &fault)) {
    const int64_t slot = first + node[fault.point < 0 ? 0 : fault.point];
    mpmi_failure found = mpmi_node_failure(fault.cause, b, slot, fault.what);
    found.callback_status = fault.returned;
    found.body = 0; /* all bodies of the site have the node */
    mpmi_failure_take(failure, found);
    return;
  }
  for (int64_t p = 0; p < points.n; ++p) {
    const int32_t i = node[p];
    const double n[3] = {points.normal[0][p], points.normal[1][p], points.normal[2][p]};
    const int32_t binds = points.distance[p] <= within * distance_of_nodes(search, near->block, i, n);
    if (binds) value[MPMI_NEAR_DISTANCE * b->nodes + i] = points.distance[p];
    for (int32_t k = 0; k < 3; ++k) {
      value[(MPMI_NEAR_NORMAL + k) * b->nodes + i] = n[k];
      value[(MPMI_NEAR_VELOCITY + k) * b->nodes + i] = points.velocity[k][p];
    }
  }
}

static void measure_task(void *data, int64_t k) {
  const mpmi_contact_search *search = data;
  const mpmi_share share = mpmi_share_of(search->step->settings, search->contact->near_count, k);
  for (int64_t i = share.begin; i < share.end; ++i)
    measure_near(search, i, &search->step->work->report[k].failure);
}

int32_t mpmi_asks_distances(const mpmi_contact_nodes *contact) {
  int32_t asks = 0;
  for (int64_t i = 0; i < contact->surface_count; ++i)
    asks |= contact->surface[i].shape == MPM_SHAPE_DISTANCE;
  return asks;
}

mpm_status mpmi_sites_measure(mpmi_contact_search *search) {
  const mpmi_settings *settings = search->step->settings;
  if (!search->contact->near_count) return MPM_OK;
  const mpm_status status =
      mpmi_run_tasks(settings, mpmi_asks_distances(search->contact), settings->tasks, measure_task, search);
  return status ? status : mpmi_step_failure(search->step);
}
