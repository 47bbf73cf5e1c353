/* The nodes around markers of surfaces, and their weights (docs/theory.md).
 *
 * A marker on a face has weights on nodes that hardly any particle reaches, or none: a force there would be
 * lost or would accelerate hardly any mass. Weights w_i become smaller in proportion to a small mass, and are
 * then made again what a basis has to be, so that total force and moment are kept:
 *
 *   s_i = min(1, m_i / (share m)), m = sum w_i m_i;  u_i = s_i w_i / sum s_j w_j
 *   g_i = A^T grad u_i, with A the inverse of sum (x_i - x) grad u_i^T;  w'_i = u_i - g_i . sum u_j (x_j - x)
 *
 * so that sum w' = 1, sum w' x_i = x, sum g = 0 and sum x_i g_i^T = 1. Inside the material they are w and
 * grad w. */
#include "stages/stages.h"
#include "layout/tasks.h"
#include "layout/tile.h"
#include "simd/vector3.h"

#include <math.h>
#include <string.h>

/* A node with a smaller share of the mass around a marker takes less. */
#define FULL_SHARE 0.02
/* The least determinant of sum (x_i - x) grad u_i^T by which gradients are corrected: with less, nodes of too
 * few lines are left. */
#define LEAST_SPREAD 0.25
/* The least share of a marker's weights that nodes with mass must have for gradients. With less they are
 * rounding, as those of a marker on a row without mass are. */
#define LEAST_SUM 1e-8

typedef struct marker_job {
  mpmi_step *step;
  mpm_surface *surface;
  const mpmi_marker_field *field;
} marker_job;

enum { MOST_NODES = MPMI_MAX_WIDTH * MPMI_MAX_WIDTH * MPMI_MAX_WIDTH };

/* The nodes around one marker: arm is x_i - x. */
typedef struct stencil {
  int32_t count;
  int64_t slot[MOST_NODES];
  double w[MOST_NODES], g[MOST_NODES][3], arm[MOST_NODES][3], mass[MOST_NODES];
} stencil;

/* Returns the slot of a node of the surface's body by its index, or that of its original on a periodic axis,
 * or -1. */
static int64_t slot_of(const marker_job *job, const int64_t *index) {
  const mpmi_blocks *blocks = &job->step->layout->blocks;
  const mpm_grid *grid = blocks->grid;
  const int64_t slot = mpmi_blocks_node(blocks, job->surface->desc.body, index);
  int64_t original[3], moved = 0;
  if (slot >= 0) return slot;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const int64_t cells = grid->desc.cells[k];
    original[k] = grid->desc.periodic[k] ? ((index[k] % cells) + cells) % cells : index[k];
    moved |= original[k] - index[k];
  }
  return moved ? mpmi_blocks_node(blocks, job->surface->desc.body, original) : -1;
}

/* Returns how many mirrored halves of a node there are at walls: one more for each on whose plane it lies. */
static double halves_of(const mpmi_wall *wall, const mpm_grid *grid, const int64_t *index) {
  double halves = 1.0;
  for (int32_t face = 0; face < 2 * grid->dim; ++face)
    if (mpmi_wall_kind_of(wall[face].kind)->holds && index[face / 2] == mpmi_face_node(grid, face))
      halves *= 2.0;
  return halves;
}

/* Returns the mass that goes with a node: that of its tie, which is not folded yet. */
static double mass_of(const mpmi_marker_field *field, int64_t slot) {
  const mpmi_constraints *ties = field->ties;
  if (slot < 0) return 0.0;
  if (ties->tie_of[slot] < 0) return *mpmi_mass(field->masses, slot);
  const mpmi_tie *tie = &ties->tie[ties->tie_of[slot]];
  double mass = *mpmi_mass(field->masses, tie->master);
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    mass += *mpmi_mass(field->masses, ties->follower[i].slot);
  return mass;
}

/* Returns the index of the first node of a stencil along an axis. */
static int64_t first_index(const mpm_grid *grid, const mpmi_weights *W, int32_t k, int64_t p, double x) {
  if (grid->family >= MPMI_FAMILY_OPEN_BSPLINE2) return (int64_t)mpmi_anchor(grid, k, x) - grid->below;
  const double xi = (x - grid->desc.origin[k]) * grid->inverse_spacing[k];
  return (int64_t)floor(xi + W->first[k][p] + 0.5);
}

/* Returns how far node i of a stencil lies from the marker along an axis. */
static double arm_of(const mpm_grid *grid, const mpmi_weights *W, int32_t k, int32_t i, int64_t p) {
  const double cells = grid->family >= MPMI_FAMILY_OPEN_BSPLINE2 ? W->u[k][i][p] : W->first[k][p] + (double)i;
  return cells * grid->desc.spacing[k];
}

static void list_nodes(const marker_job *job, const mpmi_weights *W, int64_t p, const double *x,
                       stencil *to) {
  const mpm_grid *grid = job->step->settings->grid;
  int64_t first[3];
  to->count = 1;
  for (int32_t k = 0; k < grid->dim; ++k) {
    first[k] = first_index(grid, W, k, p, x[k]);
    to->count *= grid->width;
  }
  for (int32_t n = 0; n < to->count; ++n) {
    int64_t index[3];
    int32_t rest = n, at[3];
    to->w[n] = 1.0;
    for (int32_t k = grid->dim - 1; k >= 0; --k) {
      at[k] = rest % grid->width;
      rest /= grid->width;
      index[k] = first[k] + at[k];
      to->w[n] *= W->w[k][at[k]][p];
      to->arm[n][k] = arm_of(grid, W, k, at[k], p);
    }
    for (int32_t k = 0; k < grid->dim; ++k) {
      to->g[n][k] = W->g[k][at[k]][p];
      for (int32_t j = 0; j < grid->dim; ++j)
        if (j != k) to->g[n][k] *= W->w[j][at[j]][p];
    }
    to->slot[n] = slot_of(job, index);
    to->mass[n] = mass_of(job->field, to->slot[n]) * halves_of(job->field->wall, grid, index);
  }
}

/* Finds the share of each node's weight that it may have, in place of its mass. Returns 1 when all have the
 * whole of it. */
static int32_t find_shares(const marker_job *job, stencil *of) {
  const double cut = job->step->layout->mass_cut;
  double mean = 0.0;
  int32_t whole = 1;
  for (int32_t n = 0; n < of->count; ++n) mean += of->w[n] * of->mass[n];
  for (int32_t n = 0; n < of->count; ++n) {
    const double mass = of->mass[n], full = FULL_SHARE * mean;
    const int32_t counts = of->slot[n] >= 0 && mass > cut && mean > cut;
    of->mass[n] = !counts ? 0.0 : mass < full ? mass / full : 1.0;
    if (!counts) of->slot[n] = -1;
    whole &= of->mass[n] >= 1.0 || !(of->w[n] > 0.0);
  }
  return whole;
}

/* Makes of the weights that are left, and their gradients, what sums to one. Returns their sum before. */
static double normalise(int32_t dim, stencil *of) {
  double sum = 0.0, slope[3] = {0.0, 0.0, 0.0};
  for (int32_t n = 0; n < of->count; ++n) {
    of->w[n] *= of->mass[n];
    sum += of->w[n];
    for (int32_t k = 0; k < dim; ++k) slope[k] += of->g[n][k] *= of->mass[n];
  }
  for (int32_t n = 0; n < of->count && sum > 0.0; ++n) {
    of->w[n] /= sum;
    for (int32_t k = 0; k < dim; ++k) of->g[n][k] = (of->g[n][k] - of->w[n] * slope[k]) / sum;
  }
  return sum;
}

/* Makes weights and gradients exact for linear fields. */
static void make_linear(int32_t dim, stencil *of) {
  double spread[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, A[3][3];
  double off[3] = {0.0, 0.0, 0.0};
  for (int32_t c = 0; c < dim; ++c) {
    for (int32_t k = 0; k < dim; ++k) spread[c][k] = 0.0;
    for (int32_t n = 0; n < of->count; ++n) {
      off[c] += of->w[n] * of->arm[n][c];
      for (int32_t k = 0; k < dim; ++k) spread[c][k] += of->arm[n][c] * of->g[n][k];
    }
  }
  if (!(mpmi_invert3(spread, A) > LEAST_SPREAD)) return;
  for (int32_t n = 0; n < of->count; ++n) {
    const double g[3] = {of->g[n][0], of->g[n][1], of->g[n][2]};
    for (int32_t k = 0; k < dim; ++k) {
      of->g[n][k] = 0.0;
      for (int32_t c = 0; c < dim; ++c) of->g[n][k] += g[c] * A[c][k];
      of->w[n] -= of->g[n][k] * off[k];
    }
  }
}

/* Gives the weights to nodes with mass: with the gradients, or without where there are none. */
static void give_to_mass(const marker_job *job, stencil *of) {
  const int32_t dim = job->step->settings->grid->dim;
  if (find_shares(job, of)) return;
  if (normalise(dim, of) > LEAST_SUM)
    make_linear(dim, of);
  else
    memset(of->g, 0, sizeof of->g);
}

/* Keeps the shape functions before they are changed. */
static void keep_plain(const marker_job *job, int64_t marker, const stencil *from) {
  const mpmi_marker_nodes *around = &job->surface->around;
  for (int32_t n = 0; n < from->count && around->plain; ++n)
    around->plain[marker * around->nodes + n] = from->w[n];
}

static void keep_nodes(const marker_job *job, int64_t marker, const stencil *from) {
  const mpmi_marker_nodes *around = &job->surface->around;
  const int32_t dim = job->step->settings->grid->dim;
  for (int32_t n = 0; n < from->count; ++n) {
    const int64_t at = marker * around->nodes + n;
    around->slot[at] = from->slot[n];
    around->weight[at] = from->w[n];
    for (int32_t k = 0; k < dim; ++k) around->gradient[at * dim + k] = from->g[n][k];
  }
}

static void find_nodes_task(void *data, int64_t task) {
  const marker_job *job = data;
  const mpmi_settings *settings = job->step->settings;
  const mpm_grid *grid = settings->grid;
  const mpmi_markers *markers = &job->surface->next;
  const mpmi_weights_fn weights = settings->kernels->weights[grid->family][grid->dim];
  const mpmi_share share = mpmi_share_of(settings, (markers->count + MPMI_CHUNK - 1) / MPMI_CHUNK, task);
  const int32_t corner[3] = {0, 0, 0};
  double x[3][MPMI_CHUNK];
  const mpmi_points points = {.x = {x[0], x[1], x[2]}};
  mpmi_axis axis[3];
  mpmi_weights W;
  stencil near;
  mpmi_block_axes(grid, corner, axis);
  for (int64_t chunk = share.begin; chunk < share.end; ++chunk) {
    const int64_t begin = chunk * MPMI_CHUNK,
                  n = markers->count - begin < MPMI_CHUNK ? markers->count - begin : MPMI_CHUNK;
    for (int64_t p = 0; p < MPMI_CHUNK; ++p)
      for (int32_t k = 0; k < grid->dim; ++k)
        x[k][p] = mpmi_marker_place_of(&markers->at[begin + (p < n ? p : n - 1)], grid)[k];
    weights(axis, MPMI_NEED_GRADIENT | MPMI_NO_PLACE, &points, 0, MPMI_CHUNK, &W);
    for (int64_t p = 0; p < n; ++p) {
      list_nodes(job, &W, p, mpmi_marker_place_of(&markers->at[begin + p], grid), &near);
      keep_plain(job, begin + p, &near);
      give_to_mass(job, &near);
      keep_nodes(job, begin + p, &near);
    }
  }
}

mpm_status mpmi_surface_find(mpmi_step *step, mpm_surface *surface, const mpmi_marker_field *field) {
  marker_job job = {step, surface, field};
  if (!surface->next.count) return MPM_OK;
  return mpmi_run_tasks(step->settings, 0, step->settings->tasks, find_nodes_task, &job);
}
