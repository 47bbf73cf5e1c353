/* Where the nodes of a total Lagrangian grid are now: obstacles and friction walls meet bodies in space. A
 * node is where the particles around it have come to, each with its F:
 *
 *   x_i = sum w m (x_p + F_p (X_i - X_p)) / m_i
 *
 * What that is beyond X_i is projected as affine velocities are, images and walls with it. What a node gives
 * to particles by an affine transfer has that arm, so that obstacles are given the opposite torque. */
#include "stages/stages.h"
#include "boundary/boundary.h"
#include "layout/tasks.h"

typedef struct places_job {
  const mpmi_step *step;
  mpmi_nodes *nodes;
} places_job;

/* Writes x - X and F - I where velocity and F have their second copies, which are free until particles
 * move. */
static void find_displacements(void *data, int64_t task) {
  const places_job *job = data;
  for (int32_t m = 0; m < job->step->layout->member_count; ++m) {
    const mpm_particles *set = job->step->layout->member[m].set;
    const int32_t dim = set->grid->dim;
    const mpmi_share share = mpmi_share_of(job->step->settings, set->slots, task);
    for (int32_t k = 0; k < dim && set->slots; ++k) {
      const double *x = mpmi_f64(set, MPMI_POSITION, 0) + k * set->ld, *X = mpmi_places(set, 0) + k * set->ld;
      double *u = mpmi_f64(set, MPMI_VELOCITY, 1) + k * set->ld;
      for (int64_t s = share.begin; s < share.end; ++s) u[s] = x[s] - X[s];
    }
    for (int32_t c = 0; c < mpmi_gradient_components(dim) && set->slots; ++c) {
      const double *F = mpmi_f64(set, MPMI_F, 0) + c * set->ld, unit = c % (dim + 1) ? 0.0 : 1.0;
      double *H = mpmi_f64(set, MPMI_F, 1) + c * set->ld;
      for (int64_t s = share.begin; s < share.end; ++s) H[s] = F[s] - unit;
    }
  }
}

static void place_nodes(void *data, int64_t task) {
  const places_job *job = data;
  const mpmi_blocks *b = &job->step->layout->blocks;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), task);
  for (int64_t i = share.begin; i < share.end; ++i) {
    int64_t index[3];
    mpmi_blocks_index(b, i, index);
    for (int32_t k = 0; k < b->grid->dim; ++k)
      job->nodes->contact.place[i][k] =
          mpmi_node_position(b->grid, k, index[k]) + mpmi_velocity(&job->nodes->projected, i)[k];
  }
}

mpm_status mpmi_node_places_stage(mpmi_step *step, mpmi_nodes *nodes) {
  const mpmi_projection *projection = &mpmi_projections[MPMI_PROJECT_DISPLACEMENT];
  places_job job = {step, nodes};
  if (!mpmi_places_nodes(step->settings, nodes)) return MPM_OK;
  if (!step->layout->blocks.count && !step->layout->parts) return MPM_OK;
  mpm_status status = mpmi_run_tasks(step->settings, 0, step->settings->tasks, find_displacements, &job);
  if (!status) status = mpmi_p2g_stage(step, projection, nodes);
  if (!status) status = mpmi_node_update_stage(step, projection, nodes);
  if (!status) status = mpmi_boundary_stage(step, projection, nodes, 0.0);
  return status ? status : mpmi_run_tasks(step->settings, 0, step->settings->tasks, place_nodes, &job);
}
