/* What the host has set: the method, the walls, its callbacks. Stages read it; only calls between steps write
 * it. */
#ifndef MPMI_SETTINGS_H
#define MPMI_SETTINGS_H

#include "grid/constraints.h"
#include "layout/contact_rules.h"
#include "layout/heat_rules.h"
#include "layout/transfers.h"
#include "material/deformation.h"
#include "material/dilation.h"
#include "material/pull_back.h"
#include "obstacle/obstacle.h"
#include "surface/surface.h"
#include "transfer/kernels.h"

/* How the prescribed particles of a set move; fn NULL: they keep their velocity, unless the callback that the
 * loaded state had is awaited. */
typedef struct mpmi_motion {
  mpm_particle_fn fn;
  void *user;
  int32_t is_awaited;
} mpmi_motion;

typedef struct mpmi_settings {
  mpm_context *context;
  const mpm_grid *grid;
  const mpmi_kernels *kernels;         /* of transfer/ */
  const mpmi_deformation *deformation; /* kernels of material/deformation.c */
  const mpmi_dilation *dilation;       /* kernels of material/dilation.c */
  const mpmi_pull_back *pull_back;     /* kernels of material/pull_back.c */
  int32_t tasks;                       /* how many work at a time; no result depends on it */
  mpm_stepper_desc desc;
  const mpmi_transfer *transfer; /* the row of desc.transfer */
  mpmi_wall wall[6];
  mpm_particle_fn acceleration, force;
  void *acceleration_user, *force_user;
  mpmi_motion *motion; /* [sets] */
  int64_t motion_capacity;
  mpm_velocity_fn velocity_bc;
  void *velocity_bc_user;
  mpm_node_fn hook[3]; /* by stage, from MPM_AFTER_P2G */
  void *hook_user[3];
  mpm_progress_fn progress;
  void *progress_user;
  mpmi_heat_rules heat;
  mpmi_contact_rules contact; /* how bodies meet */
  mpmi_obstacles obstacles;
  mpmi_surfaces surfaces;
  mpm_friction_fn friction;
  void *friction_user;
  mpm_solve_fn solver;
  void *solver_user;
} mpmi_settings;

static inline int32_t mpmi_is_implicit(const mpmi_settings *set) {
  return set->desc.scheme == MPM_NEWMARK;
}
/* Returns 1 when implicit steps have inertia. */
static inline int32_t mpmi_is_dynamic(const mpmi_settings *set) {
  return !set->desc.quasi_static;
}
/* Returns 1 when the new stress is there before the particles move. */
static inline int32_t mpmi_deforms_first(const mpmi_settings *set) {
  return set->desc.scheme == MPM_USF || mpmi_is_implicit(set);
}
/* Returns 1 when particles move with their strain, after the velocities of MUSL have been projected again. */
static inline int32_t mpmi_moves_last(const mpmi_settings *set) {
  return set->desc.projected_positions;
}
static inline int32_t mpmi_is_affine(const mpmi_settings *set) {
  return set->transfer->carries != MPMI_CARRIES_NOTHING;
}
/* Returns 1 when there are steps that project corrections. Those of order 1 are PIC. */
static inline int32_t mpmi_is_corrected(const mpmi_settings *set) {
  return set->transfer->most_order > 0 && set->desc.xpic_order > 1;
}
/* Returns how new velocities follow from the nodes, MPMI_TAKES_..., in the step of this number. */
static inline int32_t mpmi_takes_in_step(const mpmi_settings *set, int64_t number) {
  const int32_t every = set->transfer->most_order > 0 ? set->desc.xpic_every : 0;
  return every > 1 && number % every ? (int32_t)MPMI_TAKES_BLEND : set->transfer->takes;
}
/* Returns 1 when the work that a set dissipates becomes heat. */
static inline int32_t mpmi_dissipates(const mpmi_settings *set, int32_t m) {
  return set->heat.set[m].on && set->heat.set[m].desc.dissipated_share > 0.0;
}
/* Returns 1 when explicit steps damp the nodes. */
static inline int32_t mpmi_is_damped(const mpmi_settings *set) {
  return set->desc.local_damping > 0.0 || set->desc.mass_damping > 0.0;
}
/* Returns 1 when the plane of a face is an obstacle with friction. */
static inline int32_t mpmi_is_friction_plane(const mpmi_settings *set, int32_t face) {
  return mpmi_wall_kind_of(set->wall[face].kind)->rubs == MPMI_RUBS_PLANE;
}
static inline int32_t mpmi_has_friction_planes(const mpmi_settings *set) {
  for (int32_t face = 0; face < 2 * set->grid->dim; ++face)
    if (mpmi_is_friction_plane(set, face)) return 1;
  return 0;
}
/* Returns 1 where some wall lets nodes on its plane rub. */
static inline int32_t mpmi_has_friction_nodes(const mpmi_settings *set) {
  for (int32_t face = 0; face < 2 * set->grid->dim; ++face)
    if (mpmi_wall_kind_of(set->wall[face].kind)->rubs == MPMI_RUBS_NODES &&
        !set->grid->desc.periodic[face / 2])
      return 1;
  return 0;
}
static inline int32_t mpmi_has_free_obstacles(const mpmi_settings *set) {
  for (int64_t i = 0; i < set->obstacles.count; ++i)
    if (set->obstacles.obstacle[i]->desc.motion == MPM_MOTION_FREE) return 1;
  return 0;
}
static inline int32_t mpmi_has_hooks(const mpmi_settings *set) {
  return set->hook[0] || set->hook[1] || set->hook[2];
}

#endif
