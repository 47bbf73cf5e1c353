/* What the host sets: walls, callbacks, hooks, the motion of prescribed particles. */
#include "layout/members.h"
#include "stepper/stepper.h"

mpm_status mpm_stepper_set_wall(mpm_stepper *s, int32_t face, int32_t kind, double friction) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = mpmi_check_face(s, face);
  if (status) return status;
  const mpmi_wall_kind *row = mpmi_wall_kind_of(kind);
  if (!row)
    return mpmi_fail(s->context, MPM_E_ARG,
                     "kind is %d: it must be an MPM_WALL_NONE ... MPM_WALL_FRICTION_NODES", (int)kind);
  if (s->grid->desc.periodic[face / 2] && kind != MPM_WALL_NONE)
    return mpmi_fail(s->context, MPM_E_ARG, "face %d belongs to a periodic axis and can have no wall",
                     (int)face);
  if (row->opens && kind != MPM_WALL_NONE && mpmi_is_total_lagrangian(s->grid))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "kind is MPM_WALL_OPEN, and nothing leaves a grid with total_lagrangian = 1: use "
                     "MPM_WALL_NONE, and mpm_particles_remove");
  if (mpmi_is_axis_face(s->grid, face) && kind != MPM_WALL_SLIP)
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "face %d is the axis of an MPM_AXISYMMETRIC grid, where nothing can cross: leave it "
                     "MPM_WALL_SLIP, which it is from the start",
                     (int)face);
  if (row->rubs && (status = mpmi_check_magnitude(s->context, "friction", friction))) return status;
  if (row->rubs == MPMI_RUBS_NODES && mpmi_is_implicit(&s->settings))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no walls of the kind MPM_WALL_FRICTION_NODES: use "
                     "MPM_WALL_FRICTION, or an explicit scheme");
  if (s->settings.wall[face].kind != kind) s->layout.walls_changed = 1;
  if (row->rubs == MPMI_RUBS_PLANE) mpmi_layout_touches(&s->layout, &s->settings);
  s->settings.wall[face] = (mpmi_wall){kind, row->rubs ? friction : 0.0};
  return MPM_OK;
}

#define SETTER(name, type, member)                                                                           \
  mpm_status name(mpm_stepper *s, type fn, void *user) {                                                     \
    MPMI_ENTER(s, MPMI_STEPPER);                                                                             \
    mpm_status status = mpmi_stepper_idle(s);                                                                \
    if (status) return status;                                                                               \
    s->settings.member = fn;                                                                                 \
    s->settings.member##_user = user;                                                                        \
    return MPM_OK;                                                                                           \
  }
SETTER(mpm_stepper_set_acceleration, mpm_particle_fn, acceleration)
SETTER(mpm_stepper_set_force, mpm_particle_fn, force)
SETTER(mpm_stepper_set_velocity_bc, mpm_velocity_fn, velocity_bc)
SETTER(mpm_stepper_set_progress, mpm_progress_fn, progress)
SETTER(mpm_stepper_set_linear_solver, mpm_solve_fn, solver)

mpm_status mpm_stepper_set_node_hook(mpm_stepper *s, int32_t stage, mpm_node_fn fn, void *user) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (stage < MPM_AFTER_P2G || stage > MPM_AFTER_VELOCITY)
    return mpmi_fail(s->context, MPM_E_ARG, "stage is %d: it must be an MPM_AFTER_P2G ... MPM_AFTER_VELOCITY",
                     (int)stage);
  if (fn && mpmi_is_implicit(&s->settings))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no node hooks: use force and velocity callbacks, or an explicit "
                     "scheme");
  s->settings.hook[stage - MPM_AFTER_P2G] = fn;
  s->settings.hook_user[stage - MPM_AFTER_P2G] = user;
  return MPM_OK;
}

mpm_status mpm_stepper_set_motion(mpm_stepper *s, mpm_particles *particles, mpm_particle_fn mean_velocity,
                                  void *user) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = mpmi_members_find(&s->layout, &s->settings, particles, &m);
  if (status) return status;
  s->settings.motion[m] = (mpmi_motion){mean_velocity, user, 0};
  return MPM_OK;
}

mpm_status mpmi_motions_are_set(const mpm_stepper *s) {
  const mpmi_obstacles *obstacles = &s->settings.obstacles;
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    if (s->settings.motion[m].is_awaited)
      return mpmi_fail(s->context, MPM_E_STATE,
                       "prescribed particles of set %d had a motion callback when the state was saved: give "
                       "it to mpm_stepper_set_motion(), or NULL to let them keep their velocities",
                       (int)m);
  for (int64_t i = 0; i < obstacles->count; ++i)
    if (obstacles->obstacle[i]->awaits_motion)
      return mpmi_fail(s->context, MPM_E_STATE,
                       "obstacle %lld had a motion callback when the state was saved: give it to "
                       "mpm_obstacle_set_motion(), or NULL to let it keep its velocities",
                       (long long)i);
  return MPM_OK;
}
