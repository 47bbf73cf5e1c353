/* The sites of surfaces that prescribe: nodes that move, with what the markers around ask of them. A node
 * that several surfaces reach has a site for each.
 *
 * The mean over the markers k around a node is what the surface asks for at their centre, and with a basis of
 * products that lies to one side of the node's foot on a surface that is not along the grid. So means are
 * moved along the surface by their slope: with weights s_k, sum s_k = 1, and arms r_k from the node,
 *
 * q = q_ + C y,   C = sum s q r^T - q_ r_^T,   S y = -r_ in the plane of the surface,   S = sum s r r^T -
 * r_ r_^T
 *
 * Without it the normals of a curved surface would turn a little from node to node, and strain what
 * slides. */
#include "boundary/surface_sites.h"
#include "simd/vector3.h"

#include <math.h>
#include <string.h>

/* The least length of a mean of unit normals that tells a direction. */
static const double least_left = 0.1;
/* Weights that may be rounding. */
static const double weight_rounding = 1e-9;
/* Hardly any slope can be told from markers that lie closer together than this, in spacings. */
static const double least_spread = 1e-3;

/* Returns the site of a surface at a node that moves; *status tells of memory that ran out. */
static int32_t site_at(mpmi_bound *bound, int32_t surface, int64_t slot, mpm_status *status) {
  mpmi_surface_sites *sites = &bound->nodes->surface_sites;
  const int32_t last = sites->last[slot];
  if (last >= 0 && sites->site[last].surface == surface) return last;
  *status = MPMI_RESERVE_NEXT(bound->step->settings->context, sites->site, sites->capacity, sites->count);
  if (*status) return -1;
  sites->site[sites->count] = (mpmi_surface_site){.slot = slot, .surface = surface, .before = last};
  return sites->last[slot] = (int32_t)sites->count++;
}

/* Returns the node that moves for the one in a slot, with the signs by which the latter follows. */
static int64_t original_of(const mpmi_bound *bound, int64_t slot, double *sign) {
  const mpmi_constraints *ties = mpmi_constraints_of(bound);
  const int32_t at = ties->tie_of[slot];
  sign[0] = sign[1] = sign[2] = 1.0;
  if (at < 0) return slot;
  const mpmi_tie *tie = &ties->tie[at];
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    if (ties->follower[i].slot == slot) memcpy(sign, ties->follower[i].sign, 3 * sizeof *sign);
  return tie->master;
}

/* Adds to the sums of a site what a marker prescribes there. */
static void add_marker(mpmi_surface_site *site, const mpmi_marker_aim *aim, int32_t normal_only, double share,
                       const double *sign, const double *arm) {
  double q[4] = {0.0, 0.0, 0.0, 0.0}; /* the vector, and the value */
  for (int32_t c = 0; c < 3; ++c) {
    q[c] = sign[c] * (normal_only ? aim->normal[c] : aim->velocity[c]);
    q[3] += aim->normal[c] * aim->velocity[c];
  }
  site->weight += share;
  site->value += share * q[3];
  for (int32_t c = 0; c < 3; ++c) {
    site->vector[c] += share * q[c];
    site->normal[c] += share * sign[c] * aim->normal[c];
    site->first[c] += share * arm[c];
    for (int32_t k = 0; k < 3; ++k) site->second[c][k] += share * arm[c] * arm[k];
    for (int32_t k = 0; k < 4; ++k) site->slope[k][c] += share * q[k] * arm[c];
  }
}

/* Finds the arm from the node in a slot to a marker, with the signs of the node. */
static void arm_to(const mpmi_bound *bound, int64_t slot, const double *x, const double *sign, double *arm) {
  const mpmi_blocks *blocks = &bound->step->layout->blocks;
  const mpm_grid *grid = blocks->grid;
  int64_t index[3] = {0, 0, 0};
  mpmi_blocks_index(blocks, slot, index);
  arm[0] = arm[1] = arm[2] = 0.0;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double period = (double)grid->desc.cells[k] * grid->desc.spacing[k];
    arm[k] = x[k] - mpmi_node_position(grid, k, index[k]);
    if (grid->desc.periodic[k]) { /* by the nearest image, whichever of them has storage */
      index[k] += grid->desc.cells[k] * (int64_t)nearbyint(arm[k] / period);
      arm[k] = x[k] - mpmi_node_position(grid, k, index[k]);
    }
    arm[k] *= sign[k];
  }
}

static mpm_status find_sites(mpmi_bound *bound, int32_t number) {
  mpm_surface *s = bound->step->settings->surfaces.surface[number];
  const int32_t normal_only = s->desc.prescribes == MPM_PRESCRIBES_NORMAL;
  mpm_status status = MPM_OK;
  for (int64_t k = 0; k < s->next.count; ++k) {
    const double area = mpmi_marker_size(&s->next.at[k], s->grid);
    for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
      double sign[3], arm[3];
      s->site[n] = -1;
      if (s->around.slot[n] < 0 || !(s->around.plain[n] > weight_rounding) || !(area > 0.0)) continue;
      const int64_t slot = original_of(bound, s->around.slot[n], sign);
      if (!mpmi_moves(bound, slot)) continue;
      s->site[n] = site_at(bound, number, slot, &status);
      if (status) return status;
      arm_to(bound, s->around.slot[n], mpmi_marker_place_of(&s->next.at[k], s->grid), sign, arm);
      mpmi_surface_site *site = &bound->nodes->surface_sites.site[s->site[n]];
      site->largest = fmax(site->largest, s->around.plain[n]);
      add_marker(site, &s->aim[k], normal_only, s->around.plain[n] * area, sign, arm);
    }
  }
  return MPM_OK;
}

/* Finds two unit vectors across a unit normal; in 2-D the second is 0. */
static void make_tangents(const double *n, int32_t dim, double (*t)[3]) {
  const double up[3] = {0.0, 0.0, 1.0}, side[3] = {1.0, 0.0, 0.0}, *with = fabs(n[2]) < 0.8 ? up : side;
  memset(t, 0, 6 * sizeof(double));
  mpmi_cross(n, with, t[0]);
  const double length = sqrt(mpmi_inner(t[0], t[0]));
  for (int32_t c = 0; c < 3; ++c) t[0][c] /= length;
  if (dim == 3) mpmi_cross(n, t[0], t[1]);
}

/* Finds P = T (T^T S T)^-1 T^T of a site, with the tangents T at its normal n and the second moment S of the
 * arms; 0 where there is no normal. */
static void find_inverse(const mpmi_surface_site *site, const double *normal, int32_t dim, double spread,
                         double (*P)[3]) {
  const double length = sqrt(mpmi_inner(normal, normal));
  double n[3], t[2][3], S[3] = {spread, 0.0, spread};
  memset(P, 0, 9 * sizeof(double));
  if (dim < 2 || !(length > least_left)) return;
  for (int32_t c = 0; c < 3; ++c) n[c] = normal[c] / length;
  make_tangents(n, dim, t);
  for (int32_t c = 0; c < 3; ++c)
    for (int32_t k = 0; k < 3; ++k) {
      const double s = site->second[c][k] / site->weight - site->first[c] * site->first[k];
      S[0] += t[0][c] * s * t[0][k];
      S[1] += t[0][c] * s * t[1][k];
      S[2] += t[1][c] * s * t[1][k];
    }
  const double by = 1.0 / (S[0] * S[2] - S[1] * S[1]);
  for (int32_t c = 0; c < 3; ++c)
    for (int32_t k = 0; k < 3; ++k)
      P[c][k] = by * (S[2] * t[0][c] * t[0][k] + S[0] * t[1][c] * t[1][k] -
                      S[1] * (t[0][c] * t[1][k] + t[1][c] * t[0][k]));
}

/* Makes means of the sums of a site, moved along the surface to the node, and their slopes. */
static void make_means(mpmi_surface_site *site, int32_t dim, double spacing) {
  const double by = 1.0 / site->weight;
  double normal[3], P[3][3];
  for (int32_t c = 0; c < 3; ++c) {
    site->vector[c] *= by;
    normal[c] = site->normal[c] * by;
    site->first[c] *= by;
  }
  site->value *= by;
  find_inverse(site, normal, dim, least_spread * spacing * spacing, P);
  for (int32_t q = 0; q < 4; ++q) {
    double *mean = q < 3 ? &site->vector[q] : &site->value, covariance[3];
    for (int32_t c = 0; c < 3; ++c) covariance[c] = site->slope[q][c] * by - *mean * site->first[c];
    for (int32_t c = 0; c < 3; ++c) site->slope[q][c] = mpmi_inner(covariance, P[c]);
    *mean -= mpmi_inner(site->slope[q], site->first);
  }
}

/* Leaves out the sites of a surface at nodes that hardly see it. */
static void drop_far_sites(const mpmi_surface_sites *sites, mpm_surface *s) {
  for (int64_t n = 0; n < s->next.count * s->around.nodes; ++n)
    if (s->site[n] >= 0 && mpmi_site_is_far(&sites->site[s->site[n]])) s->site[n] = -1;
}

mpm_status mpmi_surface_sites_find(mpmi_bound *bound) {
  const mpmi_surfaces *list = &bound->step->settings->surfaces;
  mpmi_surface_sites *sites = &bound->nodes->surface_sites;
  mpm_status status = MPM_OK;
  const int64_t slots = mpmi_slots(bound->step->layout);
  if (slots) memset(sites->last, 0xff, (size_t)slots * sizeof *sites->last); /* -1 */
  sites->count = 0;
  for (int32_t i = 0; i < list->count && !status; ++i)
    if (mpmi_surface_prescribes(list->surface[i])) status = find_sites(bound, i);
  for (int32_t i = 0; i < list->count && !status; ++i)
    if (mpmi_surface_prescribes(list->surface[i])) drop_far_sites(sites, list->surface[i]);
  for (int64_t i = 0; i < sites->count && !status; ++i)
    make_means(&sites->site[i], bound->dim, bound->step->settings->grid->h_min);
  return status;
}

/* ---- smooth normals ------------------------------------------------------------------------------------ */
/* A marker ahead of the material, or at a corner of it, where the nodes that are left do not read a linear
 * field, or read it from afar: by so many spacings, and with weights so large. */
static const double off_place = 0.01, far_off = 3.0;
static int32_t reads_linear(const mpmi_bound *bound, const mpm_surface *s, int64_t k) {
  const double plain[3] = {1.0, 1.0, 1.0}, *x = mpmi_marker_place_of(&s->next.at[k], s->grid);
  double off[3] = {0.0, 0.0, 0.0}, arm[3], size = 0.0;
  for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
    if (s->around.slot[n] < 0) continue;
    arm_to(bound, s->around.slot[n], x, plain, arm);
    size += fabs(s->around.weight[n]);
    for (int32_t c = 0; c < 3; ++c) off[c] += s->around.weight[n] * arm[c];
  }
  return sqrt(mpmi_inner(off, off)) <= off_place * s->grid->h_min && size <= far_off;
}

/* Finds the normal of a marker from those of the nodes around it, each moved along the surface to the
 * marker, and its curvature from their slopes. */
static void smooth_normal(const mpmi_bound *bound, mpm_surface *s, int64_t k) {
  double sum[3] = {0.0, 0.0, 0.0}, sign[3], arm[3], weight = 0.0, slope[3][3] = {{0.0}};
  for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
    if (s->site[n] < 0) continue;
    const mpmi_surface_site *site = &bound->nodes->surface_sites.site[s->site[n]];
    original_of(bound, s->around.slot[n], sign);
    arm_to(bound, s->around.slot[n], mpmi_marker_place_of(&s->next.at[k], s->grid), sign, arm);
    weight += s->around.plain[n];
    for (int32_t c = 0; c < 3; ++c) {
      sum[c] += s->around.plain[n] * sign[c] * (site->vector[c] + mpmi_inner(site->slope[c], arm));
      for (int32_t e = 0; e < 3; ++e)
        slope[c][e] += s->around.plain[n] * sign[c] * sign[e] * site->slope[c][e];
    }
  }
  const double length = sqrt(mpmi_inner(sum, sum));
  if (!(length > least_left * weight)) return;
  for (int32_t c = 0; c < 3; ++c) {
    s->aim[k].normal[c] = sum[c] / length;
    for (int32_t e = 0; e < 3; ++e) s->aim[k].curvature[c][e] = 0.5 * (slope[c][e] + slope[e][c]) / weight;
  }
}

mpm_status mpmi_surface_normals_smooth(mpmi_step *step, mpmi_nodes *nodes) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  mpmi_bound bound = {
      .step = step, .nodes = nodes, .values = &nodes->solved, .dim = step->settings->grid->dim};
  const mpm_status status = mpmi_surface_sites_find(&bound);
  for (int64_t i = 0; i < list->count && !status; ++i) {
    mpm_surface *s = list->surface[i];
    for (int64_t k = 0; k < s->next.count && s->desc.prescribes == MPM_PRESCRIBES_NORMAL; ++k) {
      smooth_normal(&bound, s, k);
      if (!reads_linear(&bound, s, k)) s->aim[k].stiffness = 0.0;
    }
  }
  return status;
}
