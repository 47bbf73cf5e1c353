/* Surfaces in implicit steps: forces t = (T |a| + D A0 - p a) at the end of the step, with weights of its
 * start and areas of the displacements as they are. With g = F_inc^-T grad w an area vector changes by
 *
 *   da = (a (x) g_b - g_b (x) a) du_b,  dt = P da,  P = T (x) a / |a| - p 1
 *
 * which is not symmetric. Dead loads D have no stiffness. */
#include "implicit/balance.h"
#include "stages/stages.h"

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

mpm_status mpmi_surface_loads_find(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  const mpm_status status = mpmi_surfaces_find(balance->step, &balance->nodes->solved);
  for (int64_t i = 0; i < list->count && !status; ++i) {
    mpm_surface *s = list->surface[i];
    for (int64_t k = 0; k < s->next.count; ++k) {
      const mpmi_marker *m = &s->next.at[k];
      const double left = leave_out(balance, &s->around, k);
      const int32_t loads = fabs(m->force[0]) + fabs(m->force[1]) + fabs(m->force[2]) > 0.0;
      if (loads && left > WEIGHT_ROUNDING)
        return mpmi_fail(balance->settings->context, MPM_SINGULAR,
                         "marker %lld of surface %lld loads rigid particles, and nothing carries its force: "
                         "prescribe their motion, or set quasi_static = 0",
                         (long long)m->id, (long long)i);
    }
  }
  return status;
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

/* Adds the block of one node's force by the displacement of another. hoop: by how much a radial one stretches
 * the hoop of a ring, and with it the area. */
static void add_block(mpmi_balance *balance, int64_t slot_a, int64_t slot_b, double weight,
                      const double *area, const double *g, double hoop, double P[3][3]) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  const mpmi_active_node *A = &newton->active[newton->active_of[slot_a]];
  const mpmi_active_node *B = &newton->active[newton->active_of[slot_b]];
  const int64_t entry = mpmi_matrix_entry(&newton->matrix, A->row, B->row);
  if (entry < 0) return; /* without it the iteration takes longer */
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      double sum = 0.0;
      for (int32_t k = 0; k < dim; ++k)
        sum += P[i][k] * (area[k] * (j == 0 ? g[j] + hoop : g[j]) - g[k] * area[j]);
      newton->matrix.value[(entry * dim + i) * dim + j] -= A->sign[i] * B->sign[j] * weight * sum;
    }
}

static void stiffen_marker(mpmi_balance *balance, mpm_surface *s, int64_t i) {
  const mpmi_marker_nodes *around = &s->around;
  const int32_t dim = balance->settings->grid->dim;
  const int64_t first = i * around->nodes, end = first + around->nodes;
  double area[3], P[3][3], F[3][3], inverse[3][3];
  if (!response_of(s, i, area, P)) return;
  balance->newton->matrix.symmetric = 0;
  mpmi_marker_deformation(balance->step, s, &balance->nodes->solved, i, F);
  mpmi_marker_invert(F, inverse);
  const double radius = mpmi_is_axisymmetric(s->grid) ? s->now.at[i].position[0] : 0.0;
  for (int64_t b = first; b < end; ++b) {
    const double hoop = radius > 0.0 ? around->weight[b] / radius * inverse[2][2] : 0.0;
    double g[3] = {0.0, 0.0, 0.0};
    if (around->slot[b] < 0) continue;
    for (int32_t k = 0; k < dim; ++k)
      for (int32_t c = 0; c < dim; ++c) g[k] += inverse[c][k] * around->gradient[b * dim + c];
    for (int64_t a = first; a < end; ++a)
      if (around->slot[a] >= 0)
        add_block(balance, around->slot[a], around->slot[b], around->weight[a], area, g, hoop, P);
  }
}

mpm_status mpmi_surface_loads_stiffen(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  const mpm_status status = mpmi_surfaces_stretch(balance->step, &balance->nodes->solved);
  for (int64_t s = 0; s < list->count && !status && balance->settings->grid->dim > 1; ++s)
    for (int64_t i = 0; i < list->surface[s]->next.count; ++i) stiffen_marker(balance, list->surface[s], i);
  return status;
}
