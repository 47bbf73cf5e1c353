/* Where the nodes of a total Lagrangian grid are now: obstacles and friction walls meet bodies in space. A
 * node moves with the mean displacement of the particles around, x_i = X_i + sum w m (x_p - X_p) / m_i, which
 * is projected as their velocity is, images and walls with it. */
#include "stages/stages.h"
#include "boundary/boundary.h"
#include "layout/tasks.h"

typedef struct places_job {
  const mpmi_step *step;
  mpmi_nodes *nodes;
} places_job;

/* The second copy of the velocities is free until particles move. */
static void find_displacements(const mpmi_step *step) {
  for (int32_t m = 0; m < step->layout->member_count; ++m) {
    const mpm_particles *set = step->layout->member[m].set;
    for (int32_t k = 0; k < set->grid->dim && set->slots; ++k) {
      const double *x = mpmi_f64(set, MPMI_POSITION, 0) + k * set->ld, *X = mpmi_places(set, 0) + k * set->ld;
      double *u = mpmi_f64(set, MPMI_VELOCITY, 1) + k * set->ld;
      for (int64_t s = 0; s < set->slots; ++s) u[s] = x[s] - X[s];
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
  if (!mpmi_places_nodes(step->settings, nodes) || !step->layout->blocks.count) return MPM_OK;
  find_displacements(step);
  mpm_status status = mpmi_p2g_stage(step, projection, nodes);
  if (!status) status = mpmi_node_update_stage(step, projection, nodes);
  if (!status) status = mpmi_boundary_stage(step, projection, nodes, 0.0);
  return status ? status : mpmi_run_tasks(step->settings, 0, step->settings->tasks, place_nodes, &job);
}
