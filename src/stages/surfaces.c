/* Surfaces in a step (docs/theory.md): what the host asks of them, their loads, forces on the nodes around
 * their markers, and their motion. */
#include "stages/stages.h"
#include "context/transport.h"
#include "layout/tasks.h"
#include "parallel/parts.h"

#include <math.h>
#include <string.h>

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
  step->failure = mpmi_callback_failure(returned, -1, what);
  return mpmi_fail(step->settings->context, step->failure.cause,
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

/* A surface and the nodes that it gives to, or takes from. */
typedef struct surface_job {
  mpmi_step *step;
  mpm_surface *surface;
  const mpmi_nodal *nodes;
  mpmi_tie_state *states; /* where it gives */
  int32_t told;           /* of several parts: the velocities are those that parts have told */
} surface_job;

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

/* Gives a force to a node: in its sum of forces, or in its momentum where these are not apart. What mirror
 * images turn round is the wall's. */
static void give_node(const surface_job *job, int64_t slot, const double *force, double weight) {
  const mpmi_constraints *ties = &job->step->layout->constraints;
  const mpmi_tie *tie = ties->tie_of[slot] < 0 ? NULL : &ties->tie[ties->tie_of[slot]];
  const int64_t to = tie ? heaviest_of(job, tie) : slot;
  for (int32_t c = 0; c < job->step->settings->grid->dim; ++c) {
    const double its_sign = tie ? sign_of(ties, tie, slot, c) : 1.0;
    const double sign = to == slot ? 1.0 : its_sign * sign_of(ties, tie, to, c);
    if (tie) job->states[ties->tie_of[slot]].mirrored[c] += (its_sign - 1.0) * weight * force[c];
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

int64_t mpmi_marker_first_slot(const mpm_surface *s, int64_t marker) {
  for (int64_t n = marker * s->around.nodes; n < (marker + 1) * s->around.nodes; ++n)
    if (s->around.slot[n] >= 0) return s->around.slot[n];
  return -1;
}

/* Refuses loads that no node would take. carried: of each marker, whether some part has such nodes; NULL
 * where there is one part. */
static mpm_status check_carried(mpmi_step *step, const mpm_surface *s, const int64_t *carried) {
  for (int64_t i = 0; i < s->next.count; ++i) {
    const mpmi_marker *m = &s->next.at[i];
    if (!(fabs(m->force[0]) + fabs(m->force[1]) + fabs(m->force[2]) > 0.0)) continue;
    if (carried ? !carried[i] : mpmi_marker_first_slot(s, i) < 0)
      return fail_marker(step, MPM_E_STATE, s, m, "has a load and no material around it");
  }
  return MPM_OK;
}

mpm_status mpmi_surfaces_find(mpmi_step *step, const mpmi_nodal *masses) {
  const mpmi_settings *settings = step->settings;
  const mpmi_marker_field motion = {masses, &step->layout->constraints, settings->wall};
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < settings->surfaces.count && !status; ++i) {
    mpm_surface *surface = settings->surfaces.surface[i];
    status = mpmi_surface_find(step, surface, &motion);
    if (!status && !step->layout->parts) status = check_carried(step, surface, NULL);
  }
  return status;
}

mpm_status mpmi_surfaces_give(mpmi_step *step, mpmi_nodes *nodes) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  const mpm_status status = mpmi_surfaces_find(step, &nodes->solved);
  for (int64_t t = 0; t < step->layout->constraints.tie_count && list->count; ++t)
    for (int32_t c = 0; c < 3; ++c) nodes->tie_state[t].mirrored[c] = 0.0;
  for (int64_t i = 0; i < list->count && !status; ++i) {
    const surface_job job = {step, list->surface[i], &nodes->solved, nodes->tie_state, 0};
    give_surface(&job);
  }
  return status;
}

/* ---- several parts ------------------------------------------------------------------------------------- */
/* All parts have all markers. Who has a node in a tile of its own knows all nodes around markers beside it,
 * and the forces of all markers there: the part that owns the first node around a marker tells the others
 * how it moves. */
int32_t mpmi_owns_marker(const mpmi_step *step, const mpm_surface *s, int64_t marker) {
  const int64_t slot = mpmi_marker_first_slot(s, marker);
  return slot >= 0 && mpmi_owns_node(step->layout->parts, slot);
}

mpm_status mpmi_surfaces_carried(mpmi_step *step) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < list->count && !status && step->layout->parts; ++i) {
    const mpm_surface *s = list->surface[i];
    if (!s->next.count) continue;
    for (int64_t k = 0; k < s->next.count; ++k) s->told[k] = mpmi_owns_marker(step, s, k);
    status = mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, s->next.count, s->told);
    if (!status) status = check_carried(step, s, s->told);
  }
  return status;
}

/* ---- motion -------------------------------------------------------------------------------------------- */
/* Finds the velocity of one of the nodes around a marker with which markers move. */
static void velocity_of(const surface_job *job, int64_t node, double *velocity) {
  const mpmi_settings *settings = job->step->settings;
  const int64_t slot = job->surface->around.slot[node];
  const int32_t lags =
      settings->desc.position_order == 2 && !mpmi_is_implicit(settings) && mpmi_has_increments(job->nodes);
  if (job->told) {
    memcpy(velocity, mpmi_surface_told_velocity(job->surface, node), MPMI_MARKER_VECTOR * sizeof *velocity);
    return;
  }
  for (int32_t c = 0; c < settings->grid->dim; ++c) {
    velocity[c] = mpmi_velocity(job->nodes, slot)[c];
    if (lags) velocity[c] -= 0.5 * mpmi_increment(job->nodes, slot)[c];
  }
}

/* Finds the velocity of the nodes at a marker, and its gradient. */
static void gather(const surface_job *job, int64_t marker, double *velocity, double L[3][3]) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_marker_nodes *around = &job->surface->around;
  const int32_t dim = settings->grid->dim;
  memset(velocity, 0, 3 * sizeof *velocity);
  memset(L, 0, 9 * sizeof(double));
  for (int64_t n = marker * around->nodes; n < (marker + 1) * around->nodes; ++n) {
    double v[3];
    if (around->slot[n] < 0) continue;
    velocity_of(job, n, v);
    for (int32_t c = 0; c < dim; ++c) {
      velocity[c] += around->weight[n] * v[c];
      for (int32_t k = 0; k < dim; ++k) L[c][k] += v[c] * around->gradient[n * dim + k];
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

/* Writes how the nodes move at markers of this part, and 0 for others. */
static void tell_task(void *data, int64_t task) {
  const surface_job *job = data;
  const mpmi_share share = mpmi_share_of(job->step->settings, job->surface->next.count, task);
  for (int64_t i = share.begin; i < share.end; ++i) {
    double motion[MPMI_MARKER_MOTION] = {0.0};
    if (mpmi_owns_marker(job->step, job->surface, i)) gather(job, i, motion, (double(*)[3])(motion + 3));
    memcpy(&job->surface->told[MPMI_MARKER_MOTION * i], motion, sizeof motion);
  }
}

/* Adds up what a surface that prescribes has given to the nodes, as parts have told it. */
static void take_impulses(const mpmi_step *step, mpm_surface *s) {
  for (int64_t k = 0; k < s->next.count; ++k)
    for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
      double impulse[MPMI_MARKER_VECTOR];
      memcpy(impulse, mpmi_surface_told_impulse(s, n), sizeof impulse);
      mpmi_surface_impulse_add(s, k, impulse, step->velocity_dt);
    }
}

/* Lets all parts know the velocities of the nodes around markers, each from the part that owns it. */
static mpm_status tell_velocities(const surface_job *job) {
  const mpm_surface *s = job->surface;
  const int64_t nodes = s->next.count * s->around.nodes;
  for (int64_t n = 0; n < nodes; ++n) {
    double v[MPMI_MARKER_VECTOR] = {0.0, 0.0, 0.0};
    if (s->around.slot[n] >= 0 && mpmi_owns_node(job->step->layout->parts, s->around.slot[n]))
      velocity_of(job, n, v);
    memcpy(mpmi_surface_told_velocity(s, n), v, sizeof v);
  }
  return mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, MPMI_MARKER_VECTOR * nodes,
                           mpmi_surface_told_velocity(s, 0));
}

/* Lets all parts know how all markers move, of which one part each adds its bits to zeros, and what a surface
 * that prescribes has given. */
static mpm_status tell(mpmi_step *step, const mpmi_nodal *from, int32_t meets) {
  const mpmi_settings *settings = step->settings;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < settings->surfaces.count && !status; ++i) {
    surface_job job = {step, settings->surfaces.surface[i], from, NULL, 0};
    mpm_surface *s = job.surface;
    if (!s->next.count) continue;
    if (meets && (status = tell_velocities(&job))) return status;
    job.told = meets;
    mpmi_parallel_for_sure(settings->context, settings->tasks, tell_task, &job);
    status =
        mpmi_reduce_parts(settings->context, MPM_REDUCE_SUM, MPMI_MARKER_MOTION * s->next.count, s->told);
    /* in implicit steps springs hold, which tell by themselves what they have given */
    if (status || !mpmi_surface_prescribes(s) || mpmi_is_implicit(settings)) continue;
    status = mpmi_reduce_parts(settings->context, MPM_REDUCE_SUM,
                               MPMI_MARKER_VECTOR * s->next.count * s->around.nodes,
                               mpmi_surface_told_impulse(s, 0));
    if (!status) take_impulses(step, s);
  }
  return status;
}

static void find_motion(const surface_job *job, int64_t marker, double *velocity, double L[3][3]) {
  double motion[MPMI_MARKER_MOTION];
  if (!job->step->layout->parts) {
    gather(job, marker, velocity, L);
    return;
  }
  memcpy(motion, &job->surface->told[MPMI_MARKER_MOTION * marker], sizeof motion);
  memcpy(velocity, motion, 3 * sizeof *motion);
  memcpy(L, motion + 3, 9 * sizeof *motion);
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
    surface_job job = {step, settings->surfaces.surface[i], from, NULL, 0};
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
    find_motion(job, i, m->velocity, L);
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
  /* iterations have found the forces of the markers beside this part; now that all of them have moved, those
   * of others are known, too */
  if (!status && step->layout->parts && mpmi_is_implicit(settings)) status = load_surface(step, s);
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

mpm_status mpmi_surfaces_move(mpmi_step *step, const mpmi_nodal *from, int32_t meets) {
  const mpmi_surfaces *list = &step->settings->surfaces;
  mpm_status status = step->layout->parts ? tell(step, from, meets) : MPM_OK;
  for (int64_t i = 0; i < list->count && !status; ++i) {
    surface_job job = {step, list->surface[i], from, NULL, 0};
    status = move_surface(&job);
  }
  return status;
}
