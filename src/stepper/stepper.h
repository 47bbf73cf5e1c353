/* The stepper: one grid, its nodes, many sets, one scheme. What it is made of has a room of its own:
 *
 *   layout/     what the host has set; the sorted layout; the nodes of a velocity field; the step under way;
 *               sums over particles on nodes
 *   boundary/   the conditions on nodal velocities
 *   stages/     particles to nodes, the nodes' own part, nodes to particles
 *   implicit/   Newton's method for the displacements of the nodes
 *   stepper/    the handle; steps as sequences of stages; commit, roll-back and reports */
#ifndef MPMI_STEPPER_H
#define MPMI_STEPPER_H

#include "implicit/balance.h"

/* What one step leaves to the next, and to reports: the state beside that of the particles. */
typedef struct mpmi_history {
  double t;
  int64_t step, removed;
  double previous_dt;   /* of the last step, for the next one's mean; 0: none */
  double controller_dt; /* of mpm_advance; 0: none yet */
  int32_t has_sums;     /* the sums are those of the present state */
  mpmi_sums sums;
  mpm_step_info last; /* of the last step */
  int32_t has_reactions;
  double impulse_by_face[6][3], reaction_dt; /* on the walls in the last step */
} mpmi_history;

enum { MPMI_NODE_VIEWS = 8 };

struct mpm_stepper {
  uint32_t magic;
  int32_t mapped; /* views of nodal fields that are out */
  mpm_context *context;
  mpm_grid *grid;
  mpmi_settings settings;
  mpmi_layout layout;
  mpmi_nodes nodes;
  mpmi_workspace work;
  mpmi_newton *newton; /* memory of implicit steps, or NULL */
  mpmi_profile profile;
  mpmi_step step; /* the one under way, if any */
  mpmi_history history;
  mpmi_view_record view[MPMI_NODE_VIEWS];
  void *view_memory[MPMI_NODE_VIEWS];
  size_t view_bytes[MPMI_NODE_VIEWS];
  int64_t *active; /* slots of active nodes shown by the views */
  int64_t active_count, active_capacity;
};

/* MPM_E_STATE while a step is under way. */
static inline mpm_status mpmi_stepper_idle(const mpm_stepper *s) {
  if (s->step.phase == MPMI_IDLE) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it first");
}

#endif
