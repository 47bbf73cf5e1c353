/* Surfaces in implicit steps: forces t = (T |a| + D A0 - p a) at the end of the step, with weights of its
 * start and areas of the displacements as they are. The area vector of the edges e_k, which were E_k where
 * the weights are made, changes with the displacement u_b of a node by
 *
 *   de_k = (E_k . grad w_b) du_b,  da = de_0 x e_1 + e_0 x de_1 (2-D: de_0 turned),  dt = P da,
 *   P = T (x) a / |a| - p 1
 *
 * which is not symmetric. Dead loads D have no stiffness.
 *
 * Of several parts each knows how the nodes move around its own and around the markers beside these, and so
 * the forces and stiffness of all markers there. */
#include "implicit/surface_springs.h"
#include "boundary/surface_sites.h"
#include "context/transport.h"
#include "stages/stages.h"
#include "simd/vector3.h"

#include <math.h>

/* Leaves out the nodes of a marker that are no unknowns, and gives the others their weight. Returns the share
 * of the weight that they had. */
static double leave_out(const mpmi_balance *balance, mpmi_marker_nodes *around, int64_t marker) {
  const int64_t first = marker * around->nodes, end = first + around->nodes;
  double all = 0.0, left = 0.0;
  for (int64_t n = first; n < end; ++n) {
    if (around->slot[n] < 0) continue;
    all += around->weight[n];
    if (balance->newton->active_of[around->slot[n]] >= 0) continue;
    left += around->weight[n];
    around->slot[n] = -1;
  }
  for (int64_t n = first; n < end && left != 0.0 && left < all; ++n) around->weight[n] *= all / (all - left);
  return left != 0.0 ? left / all : 0.0;
}

/* Nodes that particles reach by rounding alone are no unknowns, nor are those of rigid particles in
 * quasi-static steps; more than this share of a force is not lost by rounding. */
static const double WEIGHT_ROUNDING = 1e-8;

/* Leaves out the nodes of a marker that are no unknowns; returns 1 where nothing carries its load then. Of
 * several parts one says so, that which knows how the marker moves. */
static int32_t is_uncarried(const mpmi_balance *balance, mpm_surface *s, int64_t marker) {
  const mpmi_marker *m = &s->next.at[marker];
  const int32_t tells = mpmi_owns_marker(balance->step, s, marker),
                loads = fabs(m->force[0]) + fabs(m->force[1]) + fabs(m->force[2]) > 0.0;
  return leave_out(balance, &s->around, marker) > WEIGHT_ROUNDING && loads && tells;
}

/* Leaves out such nodes of all markers of a surface. */
static mpm_status find_carried(const mpmi_balance *balance, mpm_surface *s) {
  mpm_context *c = balance->settings->context;
  const int32_t shared = balance->layout->parts != NULL;
  int64_t first = -1;
  for (int64_t k = 0; k < s->next.count; ++k) {
    const int32_t uncarried = is_uncarried(balance, s, k);
    if (shared) s->told[k] = uncarried;
    if (uncarried && first < 0) first = k;
  }
  if (shared && s->next.count) {
    const mpm_status status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, s->next.count, s->told);
    if (status) return status;
    for (first = 0; first < s->next.count && !s->told[first];) ++first;
    if (first == s->next.count) first = -1;
  }
  if (first < 0) return MPM_OK;
  return mpmi_fail(c, MPM_SINGULAR,
                   "marker %lld of surface %d loads rigid particles, and nothing carries its force: "
                   "prescribe their motion, or set quasi_static = 0",
                   (long long)s->next.at[first].id, (int)s->number);
}

mpm_status mpmi_surface_loads_find(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  mpm_status status = mpmi_surfaces_find(balance->step, &balance->nodes->solved);
  if (list->count) status = mpmi_vote(balance, status, 0);
  if (!status) status = mpmi_surfaces_carried(balance->step);
  if (!status && mpmi_surfaces_prescribe(list))
    status = mpmi_vote(balance, mpmi_surface_normals_smooth(balance->step, balance->nodes), 0);
  for (int64_t i = 0; i < list->count && !status; ++i) status = find_carried(balance, list->surface[i]);
  return status ? status : mpmi_springs_find(balance);
}

mpm_status mpmi_surface_loads_add(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  const int32_t dim = balance->settings->grid->dim;
  const mpm_status status = mpmi_surfaces_stretch(balance->step, &balance->nodes->solved);
  for (int64_t i = 0; i < list->count && !status; ++i) {
    const mpmi_marker_nodes *around = &list->surface[i]->around;
    for (int64_t n = 0; n < list->surface[i]->next.count * around->nodes; ++n) {
      if (around->slot[n] < 0) continue;
      const double *force = list->surface[i]->next.at[n / around->nodes].force;
      for (int32_t c = 0; c < dim; ++c)
        mpmi_momentum(&balance->newton->force, around->slot[n])[c] -= around->weight[n] * force[c];
    }
  }
  return status;
}

/* Finds P of a marker and its area vector; returns 0 when its force follows nothing. */
static int32_t response_of(const mpm_surface *s, int64_t i, double *area, double P[3][3]) {
  const mpmi_marker *m = &s->next.at[i];
  const double pressure = s->desc.pressure + m->pressure, size = mpmi_marker_size(m, s->grid);
  double traction[3] = {0.0, 0.0, 0.0}, most = pressure < 0.0 ? -pressure : pressure;
  mpmi_marker_area(m, s->grid, area);
  mpmi_marker_tractions(s, i, traction);
  for (int32_t r = 0; r < 3; ++r)
    for (int32_t c = 0; c < 3; ++c) {
      const double of_traction = size > 0.0 ? traction[r] * area[c] / size : 0.0;
      most += of_traction < 0.0 ? -of_traction : of_traction;
      P[r][c] = of_traction - (r == c ? pressure : 0.0);
    }
  return most > 0.0;
}

/* Finds by how much the area vector changes with component j of a node's displacement: stretch[k] is E_k .
 * grad w, hoop what a radial displacement makes of E_1 along the hoop of a ring. */
static void area_change(const mpm_grid *grid, const mpmi_marker *marker, int32_t j, const double *stretch,
                        double hoop, double *change) {
  double d[2][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int32_t k = 0; k < 2; ++k) d[k][j] = stretch[k];
  if (j == 0) d[1][2] += hoop;
  if (mpmi_strain_dim(grid) == 2) {
    change[0] = d[0][1], change[1] = -d[0][0], change[2] = 0.0;
    return;
  }
  double first[3];
  mpmi_cross(d[0], marker->edge[1], first);
  mpmi_cross(marker->edge[0], d[1], change);
  for (int32_t c = 0; c < 3; ++c) change[c] += first[c];
}

/* Adds the block of one node's force by the displacement of another; change: of the area, by component. */
static void add_block(mpmi_balance *balance, int64_t slot_a, int64_t slot_b, double weight,
                      double change[3][3], double P[3][3]) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  const mpmi_active_node *A = &newton->active[newton->active_of[slot_a]];
  const mpmi_active_node *B = &newton->active[newton->active_of[slot_b]];
  if (!mpmi_is_kept(newton, A->row)) return;
  const int64_t entry = mpmi_matrix_entry(&newton->matrix, A->row, B->row);
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      double sum = 0.0;
      for (int32_t k = 0; k < dim; ++k) sum += P[i][k] * change[j][k];
      newton->matrix.value[(entry * dim + i) * dim + j] -= A->sign[i] * B->sign[j] * weight * sum;
    }
}

static void stiffen_marker(mpmi_balance *balance, const mpm_surface *s, int64_t i) {
  const mpm_grid *grid = s->grid;
  const mpmi_marker_nodes *around = &s->around;
  const mpmi_marker *start = &s->now.at[i];
  const int32_t dim = grid->dim;
  const int64_t first = i * around->nodes, end = first + around->nodes;
  const double(*material)[3] = mpmi_is_total_lagrangian(grid) ? start->reference_edge : start->edge;
  double area[3], P[3][3];
  if (!response_of(s, i, area, P)) return;
  balance->newton->matrix.symmetric = 0;
  const double radius = mpmi_is_axisymmetric(grid) ? mpmi_marker_place_of(start, grid)[0] : 0.0;
  for (int64_t b = first; b < end; ++b) {
    const double hoop = radius > 0.0 ? around->weight[b] / radius * material[1][2] : 0.0;
    double stretch[2] = {0.0, 0.0}, change[3][3];
    if (around->slot[b] < 0) continue;
    for (int32_t k = 0; k < 2; ++k)
      for (int32_t c = 0; c < dim; ++c) stretch[k] += material[k][c] * around->gradient[b * dim + c];
    for (int32_t j = 0; j < dim; ++j) area_change(grid, &s->next.at[i], j, stretch, hoop, change[j]);
    for (int64_t a = first; a < end; ++a)
      if (around->slot[a] >= 0)
        add_block(balance, around->slot[a], around->slot[b], around->weight[a], change, P);
  }
}

mpm_status mpmi_surface_loads_stiffen(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  mpm_status status = mpmi_surfaces_stretch(balance->step, &balance->nodes->solved);
  for (int64_t s = 0; s < list->count && !status && balance->settings->grid->dim > 1; ++s)
    for (int64_t i = 0; i < list->surface[s]->next.count && !mpmi_surface_prescribes(list->surface[s]); ++i)
      stiffen_marker(balance, list->surface[s], i);
  if (!status) mpmi_springs_stiffen(balance);
  if (!balance->layout->parts || !list->count) return status;
  double unsymmetric = !balance->newton->matrix.symmetric;
  if ((status = mpmi_vote(balance, status, 0)) || (status = mpmi_largest_of_parts(balance, 1, &unsymmetric)))
    return status;
  balance->newton->matrix.symmetric = !(unsymmetric > 0.0);
  return MPM_OK;
}
