/* Surfaces in a step (docs/theory.md): their loads, the nodes around their markers, forces on nodes, and
 * their motion.
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
#include "context/structs.h"
#include "layout/particle_batch.h"
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

static mpm_status fail_marker(mpmi_step *step, mpm_status cause, const mpm_surface *surface,
                              const mpmi_marker *marker, const char *what) {
  step->failure = (mpmi_failure){.cause = cause, .set = -1, .particle = -1, .node = -1, .what = what};
  return mpmi_fail(step->settings->context, cause,
                   "marker %lld of surface %d %s in the step from t = %g with dt = %g", (long long)marker->id,
                   (int)surface->number, what, step->t, step->dt);
}

/* ---- loads --------------------------------------------------------------------------------------------- */
/* Lays out what the callback sees; returns the rows that it adds to. */
static double *lay_out(const mpmi_step *step, const mpm_surface *s, double t, mpm_marker_batch *batch) {
  const int32_t dim = s->grid->dim;
  const int64_t n = s->next.count;
  double *position = s->batch, *area = position + dim * n, *reference = area + dim * n;
  double *displacement = reference + n, *velocity = displacement + dim * n, *add = velocity + dim * n;
  for (int64_t i = 0; i < n; ++i) {
    const mpmi_marker *m = &s->next.at[i];
    double a[3];
    mpmi_marker_area(m, s->grid, a);
    s->batch_id[i] = m->id;
    reference[i] = m->reference_area;
    for (int32_t k = 0; k < dim; ++k) {
      position[k * n + i] = m->position[k];
      area[k * n + i] = a[k];
      displacement[k * n + i] = m->displacement[k];
      velocity[k * n + i] = m->velocity[k];
      add[k * n + i] = 0.0;
    }
  }
  *batch = (mpm_marker_batch){.struct_size = sizeof *batch,
                              .dim = dim,
                              .n = n,
                              .ld = n,
                              .t = t,
                              .dt = step->dt,
                              .id = s->batch_id,
                              .position = position,
                              .area = area,
                              .reference_area = reference,
                              .displacement = displacement,
                              .velocity = velocity};
  return add;
}

/* Ends the step when a callback of a surface has not returned MPM_OK. */
static mpm_status end_callback(mpmi_step *step, const mpm_surface *s, mpm_status returned, const char *which,
                               const char *what) {
  if (!returned) return MPM_OK;
  const mpm_status cause = mpmi_callback_cause(returned);
  step->failure = (mpmi_failure){
      .cause = cause, .callback_status = returned, .set = -1, .particle = -1, .node = -1, .what = what};
  return mpmi_fail(step->settings->context, cause,
                   "the %s callback of surface %d returned %d in the step from t = %g with dt = %g", which,
                   (int)s->number, (int)returned, step->t, step->dt);
}

static mpm_status ask_tractions(mpmi_step *step, mpm_surface *s, double t) {
  mpm_marker_batch batch;
  s->asked = NULL;
  if (!s->traction || !s->next.count) return MPM_OK;
  s->asked = lay_out(step, s, t, &batch);
  const mpm_status returned = mpmi_from_host(s->traction(s->traction_user, &batch, s->asked));
  return end_callback(step, s, returned, "traction", "the traction callback of a surface");
}

/* Finds what one surface prescribes: velocities, and the normals of its markers. */
static mpm_status aim_surface(mpmi_step *step, mpm_surface *s) {
  const int64_t n = s->next.count;
  const double *asked = NULL;
  if (s->velocity && n) {
    mpm_marker_batch batch;
    double *add = lay_out(step, s, step->t, &batch);
    const mpm_status returned = mpmi_from_host(s->velocity(s->velocity_user, &batch, add));
    const mpm_status status =
        end_callback(step, s, returned, "velocity", "the velocity callback of a surface");
    if (status) return status;
    asked = add;
  }
  for (int64_t i = 0; i < n; ++i) {
    const mpmi_marker *m = &s->next.at[i];
    mpmi_marker_aim *aim = &s->aim[i];
    double area[3];
    const double size = mpmi_marker_size(m, s->grid);
    mpmi_marker_area(m, s->grid, area);
    *aim = (mpmi_marker_aim){.stiffness = -1.0};
    for (int32_t k = 0; k < s->grid->dim; ++k) {
      aim->normal[k] = size > 0.0 ? area[k] / size : 0.0;
      aim->velocity[k] = s->desc.velocity[k] + m->prescribed_velocity[k] + (asked ? asked[k * n + i] : 0.0);
      if (!isfinite(aim->velocity[k]))
        return fail_marker(step, MPM_NONFINITE, s, m, "prescribes a velocity that is not finite");
    }
  }
  return MPM_OK;
}

mpm_status mpmi_surfaces_aim(mpmi_step *step) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < list->count && !status; ++i)
    if (mpmi_surface_prescribes(list->surface[i])) status = aim_surface(step, list->surface[i]);
  return status;
}

void mpmi_marker_tractions(const mpm_surface *s, int64_t i, double *traction) {
  for (int32_t k = 0; k < s->grid->dim; ++k)
    traction[k] =
        s->desc.traction[k] + s->next.at[i].traction[k] + (s->asked ? s->asked[k * s->next.count + i] : 0.0);
}

/* Finds the forces of markers on their areas as they are. */
static mpm_status load_surface(mpmi_step *step, mpm_surface *s) {
  const int32_t dim = s->grid->dim;
  for (int64_t i = 0; i < s->next.count; ++i) {
    mpmi_marker *m = &s->next.at[i];
    double a[3], traction[3];
    mpmi_marker_area(m, s->grid, a);
    mpmi_marker_tractions(s, i, traction);
    const double size = mpmi_marker_size(m, s->grid);
    for (int32_t k = 0; k < dim; ++k) {
      m->force[k] = traction[k] * size +
                    (s->desc.dead_traction[k] + m->dead_traction[k]) * m->reference_area -
                    (s->desc.pressure + m->pressure) * a[k];
      if (!isfinite(m->force[k]))
        return fail_marker(step, MPM_NONFINITE, s, m, "has a load that is not finite");
    }
  }
  return MPM_OK;
}

mpm_status mpmi_surfaces_load(mpmi_step *step, double t) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < list->count && !status; ++i) {
    status = ask_tractions(step, list->surface[i], t);
    if (!status) status = load_surface(step, list->surface[i]);
  }
  return status;
}

/* ---- the nodes around markers -------------------------------------------------------------------------- */
enum { MOST_NODES = MPMI_MAX_WIDTH * MPMI_MAX_WIDTH * MPMI_MAX_WIDTH };

/* The nodes around one marker: arm is x_i - x. */
typedef struct stencil {
  int32_t count;
  int64_t slot[MOST_NODES];
  double w[MOST_NODES], g[MOST_NODES][3], arm[MOST_NODES][3], mass[MOST_NODES];
} stencil;

/* A surface and the nodes that it gives to, or takes from. */
typedef struct surface_job {
  mpmi_step *step;
  mpm_surface *surface;
  const mpmi_nodal *nodes;
} surface_job;

/* Returns the slot of a node of the surface's body by its index, or that of its original on a periodic axis,
 * or -1. */
static int64_t slot_of(const surface_job *job, const int64_t *index) {
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
static double halves_of(const mpmi_settings *settings, const int64_t *index) {
  double halves = 1.0;
  for (int32_t face = 0; face < 2 * settings->grid->dim; ++face)
    if (mpmi_wall_kind_of(settings->wall[face].kind)->holds &&
        index[face / 2] == mpmi_face_node(settings->grid, face))
      halves *= 2.0;
  return halves;
}

/* Returns the mass that moves with a node: that of its tie, which is not folded yet. */
static double mass_of(const surface_job *job, int64_t slot) {
  const mpmi_constraints *ties = &job->step->layout->constraints;
  if (slot < 0) return 0.0;
  if (ties->tie_of[slot] < 0) return *mpmi_mass(job->nodes, slot);
  const mpmi_tie *tie = &ties->tie[ties->tie_of[slot]];
  double mass = *mpmi_mass(job->nodes, tie->master);
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    mass += *mpmi_mass(job->nodes, ties->follower[i].slot);
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

static void list_nodes(const surface_job *job, const mpmi_weights *W, int64_t p, const double *x,
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
    to->mass[n] = mass_of(job, to->slot[n]) * halves_of(job->step->settings, index);
  }
}

/* Finds the share of each node's weight that it may have, in place of its mass. Returns 1 when all have the
 * whole of it. */
static int32_t find_shares(const surface_job *job, stencil *of) {
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

/* Keeps the shape functions before they are changed. */
static void keep_plain(const surface_job *job, int64_t marker, const stencil *from) {
  const mpmi_marker_nodes *around = &job->surface->around;
  for (int32_t n = 0; n < from->count && around->plain; ++n)
    around->plain[marker * around->nodes + n] = from->w[n];
}

static void keep_nodes(const surface_job *job, int64_t marker, const stencil *from) {
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
  const surface_job *job = data;
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
      if (!find_shares(job, &near) && normalise(grid->dim, &near) > 0.0) make_linear(grid->dim, &near);
      keep_nodes(job, begin + p, &near);
    }
  }
}

/* ---- forces on nodes ----------------------------------------------------------------------------------- */
/* Returns the sign with which a component of a node follows its tie. */
static double sign_of(const mpmi_constraints *ties, const mpmi_tie *tie, int64_t slot, int32_t c) {
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    if (ties->follower[i].slot == slot) return ties->follower[i].sign[c];
  return 1.0;
}

/* Returns the heaviest node of a tie: one without mass could take no force. */
static int64_t heaviest_of(const surface_job *job, const mpmi_tie *tie) {
  const mpmi_constraints *ties = &job->step->layout->constraints;
  int64_t best = tie->master;
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    if (*mpmi_mass(job->nodes, ties->follower[i].slot) > *mpmi_mass(job->nodes, best))
      best = ties->follower[i].slot;
  return best;
}

/* Gives a force to a node: in its sum of forces, or in its momentum where these are not apart. */
static void give_node(const surface_job *job, int64_t slot, const double *force, double weight) {
  const mpmi_constraints *ties = &job->step->layout->constraints;
  const mpmi_tie *tie = ties->tie_of[slot] < 0 ? NULL : &ties->tie[ties->tie_of[slot]];
  const int64_t to = tie ? heaviest_of(job, tie) : slot;
  for (int32_t c = 0; c < job->step->settings->grid->dim; ++c) {
    const double sign = to == slot ? 1.0 : sign_of(ties, tie, slot, c) * sign_of(ties, tie, to, c);
    if (mpmi_has_increments(job->nodes))
      mpmi_increment(job->nodes, to)[c] += sign * weight * force[c];
    else
      mpmi_momentum(job->nodes, to)[c] += job->step->velocity_dt * sign * weight * force[c];
  }
}

static void give_surface(const surface_job *job) {
  const mpm_surface *s = job->surface;
  for (int64_t i = 0; i < s->next.count; ++i)
    for (int64_t n = i * s->around.nodes; n < (i + 1) * s->around.nodes; ++n)
      if (s->around.slot[n] >= 0) give_node(job, s->around.slot[n], s->next.at[i].force, s->around.weight[n]);
}

/* Refuses loads that no node would take. */
static mpm_status check_carried(const surface_job *job) {
  const mpm_surface *s = job->surface;
  for (int64_t i = 0; i < s->next.count; ++i) {
    const mpmi_marker *m = &s->next.at[i];
    int32_t carried = !(fabs(m->force[0]) + fabs(m->force[1]) + fabs(m->force[2]) > 0.0);
    for (int64_t n = i * s->around.nodes; n < (i + 1) * s->around.nodes; ++n)
      carried |= s->around.slot[n] >= 0;
    if (!carried) return fail_marker(job->step, MPM_E_STATE, s, m, "has a load and no material around it");
  }
  return MPM_OK;
}

mpm_status mpmi_surface_find(mpmi_step *step, mpm_surface *surface, const mpmi_nodal *masses) {
  surface_job job = {step, surface, masses};
  if (!surface->next.count) return MPM_OK;
  return mpmi_run_tasks(step->settings, 0, step->settings->tasks, find_nodes_task, &job);
}

mpm_status mpmi_surfaces_find(mpmi_step *step, const mpmi_nodal *masses) {
  const mpmi_settings *settings = step->settings;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < settings->surfaces.count && !status; ++i) {
    const surface_job job = {step, settings->surfaces.surface[i], masses};
    status = mpmi_surface_find(step, job.surface, masses);
    if (!status) status = check_carried(&job);
  }
  return status;
}

mpm_status mpmi_surfaces_give(mpmi_step *step, const mpmi_nodal *to) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  const mpm_status status = mpmi_surfaces_find(step, to);
  for (int64_t i = 0; i < list->count && !status; ++i) {
    const surface_job job = {step, list->surface[i], to};
    give_surface(&job);
  }
  return status;
}

/* ---- motion -------------------------------------------------------------------------------------------- */
/* Finds the velocity of the nodes at a marker, and its gradient. */
static void gather(const surface_job *job, int64_t marker, double *velocity, double L[3][3]) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_marker_nodes *around = &job->surface->around;
  const int32_t dim = settings->grid->dim, lags = settings->desc.position_order == 2 &&
                                                  !mpmi_is_implicit(settings) &&
                                                  mpmi_has_increments(job->nodes);
  memset(velocity, 0, 3 * sizeof *velocity);
  memset(L, 0, 9 * sizeof(double));
  for (int64_t n = marker * around->nodes; n < (marker + 1) * around->nodes; ++n) {
    const int64_t slot = around->slot[n];
    for (int32_t c = 0; c < dim && slot >= 0; ++c) {
      double v = mpmi_velocity(job->nodes, slot)[c];
      if (lags) v -= 0.5 * mpmi_increment(job->nodes, slot)[c];
      velocity[c] += around->weight[n] * v;
      for (int32_t k = 0; k < dim; ++k) L[c][k] += v * around->gradient[n * dim + k];
    }
  }
  const double radius = mpmi_marker_place_of(&job->surface->now.at[marker], settings->grid)[0];
  if (mpmi_is_axisymmetric(settings->grid)) L[2][2] = radius > 0.0 ? velocity[0] / radius : L[0][0];
}

/* Stretches the edges that the marker had at the start of the step, by a gradient of velocities over the
 * positions of that time; or over reference positions, which stretches what the edges were there. */
static void stretch(const surface_job *job, int64_t marker, double L[3][3]) {
  const mpmi_marker *from = &job->surface->now.at[marker];
  mpmi_marker *to = &job->surface->next.at[marker];
  const int32_t dim = mpmi_strain_dim(job->surface->grid);
  const double(*material)[3] =
      mpmi_is_total_lagrangian(job->surface->grid) ? from->reference_edge : from->edge;
  memcpy(to->edge, from->edge, sizeof to->edge);
  for (int32_t e = 0; e < dim - 1; ++e)
    for (int32_t c = 0; c < dim; ++c)
      for (int32_t k = 0; k < dim; ++k) to->edge[e][c] += job->step->dt * L[c][k] * material[e][k];
}

static void stretch_task(void *data, int64_t task) {
  const surface_job *job = data;
  const mpmi_share share = mpmi_share_of(job->step->settings, job->surface->next.count, task);
  for (int64_t i = share.begin; i < share.end && !mpmi_surface_prescribes(job->surface); ++i) {
    double velocity[3], L[3][3];
    gather(job, i, velocity, L);
    stretch(job, i, L);
  }
}

mpm_status mpmi_surfaces_stretch(mpmi_step *step, const mpmi_nodal *from) {
  const mpmi_settings *settings = step->settings;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < settings->surfaces.count && !status; ++i) {
    surface_job job = {step, settings->surfaces.surface[i], from};
    status = mpmi_run_tasks(settings, 0, settings->tasks, stretch_task, &job);
    if (!status) status = load_surface(step, job.surface);
  }
  return status;
}

/* What prescribes moves as it prescribes, and keeps its edges; the rest goes with the material. */
static void move_task(void *data, int64_t task) {
  const surface_job *job = data;
  const double dt = job->step->dt;
  const int32_t prescribes = mpmi_surface_prescribes(job->surface);
  const mpmi_share share = mpmi_share_of(job->step->settings, job->surface->next.count, task);
  for (int64_t i = share.begin; i < share.end; ++i) {
    mpmi_marker *m = &job->surface->next.at[i];
    double L[3][3];
    gather(job, i, m->velocity, L);
    if (!prescribes) {
      stretch(job, i, L);
      memset(m->reaction, 0, sizeof m->reaction);
      memset(m->gap, 0, sizeof m->gap);
    }
    const double *by = prescribes ? job->surface->aim[i].velocity : m->velocity;
    for (int32_t c = 0; c < job->surface->grid->dim; ++c) {
      m->position[c] += dt * by[c];
      m->displacement[c] += dt * by[c];
    }
  }
}

/* Looks where a marker has come to: wraps it, or finds that it *leaves through an open wall. */
static mpm_status look(mpmi_step *step, const mpm_surface *s, mpmi_marker *m, int32_t *leaves) {
  static const char *const through[6] = {
      "would leave the grid through MPM_X_MIN", "would leave the grid through MPM_X_MAX",
      "would leave the grid through MPM_Y_MIN", "would leave the grid through MPM_Y_MAX",
      "would leave the grid through MPM_Z_MIN", "would leave the grid through MPM_Z_MAX"};
  const mpm_grid *grid = s->grid;
  *leaves = 0;
  for (int32_t k = 0; k < grid->dim; ++k) {
    double *x = &m->position[k];
    if (!isfinite(*x) || !isfinite(m->edge[0][k] + m->edge[1][k]))
      return fail_marker(step, MPM_NONFINITE, s, m, "has a position or an edge that is not finite");
    if (mpmi_is_total_lagrangian(grid) || grid->desc.periodic[k] ||
        (*x >= grid->desc.origin[k] && *x <= grid->upper[k]))
      continue;
    const int32_t face = 2 * k + (*x > grid->upper[k]);
    if (mpmi_wall_kind_of(step->settings->wall[face].kind)->opens)
      *leaves = 1;
    else if (!mpmi_is_on_wall(step->settings, k, x))
      return fail_marker(step, MPM_OFF_GRID, s, m, through[face]);
  }
  if (*leaves || mpmi_is_total_lagrangian(grid) || mpmi_grid_place(grid, m->position, 1, NULL, 0) < 0)
    return MPM_OK;
  return fail_marker(step, MPM_NONFINITE, s, m, "crosses too many periods");
}

static mpm_status move_surface(surface_job *job) {
  mpmi_step *step = job->step;
  mpm_surface *s = job->surface;
  const mpmi_settings *settings = step->settings;
  mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, move_task, job);
  int64_t stay = 0;
  for (int64_t i = 0; i < s->next.count && !status; ++i) {
    mpmi_marker *m = &s->next.at[i];
    int32_t leaves;
    for (int32_t c = 0; c < s->grid->dim; ++c) step->host_work += m->force[c] * (step->dt * m->velocity[c]);
    status = look(step, s, m, &leaves);
    mpmi_marker_set_radius(m, s->grid);
    if (!leaves) s->next.at[stay++] = *m;
  }
  if (status) return status;
  s->next.count = stay;
  if (!(s->desc.max_spacing > 0.0)) return MPM_OK;
  return mpmi_markers_split(settings->context, s->grid, &s->next, s->desc.max_spacing, 1);
}

mpm_status mpmi_surfaces_move(mpmi_step *step, const mpmi_nodal *from) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < list->count && !status; ++i) {
    surface_job job = {step, list->surface[i], from};
    status = move_surface(&job);
  }
  return status;
}
