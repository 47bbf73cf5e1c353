/* The obstacles of a stepper: coming and going, their motion in a step, and what they report. */
#include "context/structs.h"
#include "stepper/stepper.h"

#include <math.h>

/* ---- coming and going ---------------------------------------------------------------------------------- */
mpm_status mpm_stepper_add_obstacle(mpm_stepper *s, mpm_obstacle *obstacle) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_context *c = s->context;
  mpmi_obstacles *list = &s->settings.obstacles;
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!obstacle || obstacle->magic != (uint32_t)MPMI_OBSTACLE || obstacle->context != c)
    return mpmi_fail(c, MPM_E_ARG, "obstacle is NULL, destroyed or of another context");
  if (obstacle->stepper)
    return mpmi_fail(c, MPM_E_STATE, "the obstacle already belongs to %s stepper",
                     obstacle->stepper == s ? "this" : "another");
  if (mpmi_is_implicit(&s->settings) && obstacle->desc.motion == MPM_MOTION_FREE)
    return mpmi_fail(
        c, MPM_E_UNSUPPORTED,
        "scheme MPM_NEWMARK has no free obstacles: use MPM_MOTION_FIXED or MPM_MOTION_PRESCRIBED, "
        "or an explicit scheme");
  if (mpmi_is_axisymmetric(s->grid) && obstacle->desc.motion == MPM_MOTION_FREE)
    return mpmi_fail(
        c, MPM_E_UNSUPPORTED,
        "the grid is MPM_AXISYMMETRIC, where obstacles are rings or lie on the axis, and none is "
        "free: use MPM_MOTION_FIXED or MPM_MOTION_PRESCRIBED");
  if ((status = mpmi_obstacle_fits(obstacle, &obstacle->pose, s->grid->dim)) ||
      (status = MPMI_RESERVE_NEXT(c, list->obstacle, list->capacity, list->count)))
    return status;
  obstacle->number = (int32_t)list->count;
  obstacle->stepper = s;
  obstacle->grid = s->grid;
  obstacle->owner = &mpmi_stepper_owns;
  list->obstacle[list->count++] = obstacle;
  mpmi_layout_touches(&s->layout, &s->settings);
  return MPM_OK;
}

static void let_go(mpm_obstacle *obstacle) {
  obstacle->stepper = NULL;
  obstacle->grid = NULL;
  obstacle->owner = NULL;
  obstacle->awaits_motion = 0;
}

mpm_status mpm_stepper_remove_obstacle(mpm_stepper *s, mpm_obstacle *obstacle) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpmi_obstacles *list = &s->settings.obstacles;
  const mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  int64_t at = 0;
  while (at < list->count && list->obstacle[at] != obstacle) ++at;
  if (at == list->count) return mpmi_fail(s->context, MPM_E_NOT_FOUND, "the obstacle is not in this stepper");
  mpmi_pairs_drop(&s->history.pairs, mpmi_code_of_obstacle(at));
  let_go(obstacle);
  for (--list->count; at < list->count; ++at) {
    list->obstacle[at] = list->obstacle[at + 1];
    list->obstacle[at]->number = (int32_t)at;
  }
  return MPM_OK;
}

void mpmi_obstacles_release(mpm_stepper *s) {
  mpmi_obstacles *list = &s->settings.obstacles;
  for (int64_t i = 0; i < list->count; ++i) let_go(list->obstacle[i]);
  MPMI_FREE_ARRAY(s->context, list->obstacle, list->capacity);
  *list = (mpmi_obstacles){0, 0, NULL};
}

/* ---- motion -------------------------------------------------------------------------------------------- */
static mpm_status fail_motion(mpmi_step *step, mpm_status cause, mpm_status returned, const char *what,
                              int64_t number) {
  step->failure = mpmi_particle_failure(cause, -1, -1, "the motion callback of an obstacle");
  step->failure.callback_status = returned;
  if (returned)
    return mpmi_fail(step->settings->context, cause,
                     "the motion callback of obstacle %lld returned %d in the step from t = %g with dt = %g",
                     (long long)number, (int)returned, step->t, step->dt);
  return mpmi_fail(step->settings->context, cause,
                   "the motion callback of obstacle %lld %s in the step from t = %g with dt = %g",
                   (long long)number, what, step->t, step->dt);
}

/* Asks the host how an obstacle moves in the step. */
static mpm_status ask_motion(mpmi_step *step, mpmi_rigid_surface *surface) {
  const mpm_obstacle *obstacle = surface->obstacle;
  mpmi_pose pose = obstacle->pose;
  const mpm_status returned =
      mpmi_from_host(obstacle->motion(obstacle->motion_user, step->t, step->dt, pose.velocity, pose.spin));
  if (returned) return fail_motion(step, mpmi_callback_cause(returned), returned, "", obstacle->number);
  if (!mpmi_pose_is_sound(&pose))
    return fail_motion(step, MPM_NONFINITE, 0, "gave a velocity that is not finite", obstacle->number);
  if (mpmi_obstacle_fits(obstacle, &pose, step->settings->grid->dim))
    return fail_motion(step, MPM_E_CALLBACK, 0, "gave a velocity out of the grid's axes", obstacle->number);
  for (int32_t k = 0; k < 3; ++k) surface->velocity[k] = pose.velocity[k], surface->spin[k] = pose.spin[k];
  return MPM_OK;
}

mpm_status mpmi_obstacles_begin(mpmi_step *step, mpmi_contact_nodes *contact) {
  mpm_status status = MPM_OK;
  mpmi_rigid_surfaces_predict(contact, step->settings, step->velocity_dt);
  for (int64_t i = 0; i < contact->surface_count && !status; ++i) {
    const mpm_obstacle *obstacle = contact->surface[i].obstacle;
    if (obstacle && obstacle->motion) status = ask_motion(step, &contact->surface[i]);
  }
  return status;
}

mpm_status mpmi_obstacles_end(const mpmi_step *step, const mpmi_contact_nodes *contact) {
  for (int64_t i = 0; i < step->settings->obstacles.count; ++i) {
    mpm_obstacle *obstacle = step->settings->obstacles.obstacle[i];
    mpmi_rigid_move(&contact->surface[i], step->dt, &obstacle->next);
    if (!mpmi_pose_is_sound(&obstacle->next))
      return mpmi_fail(step->settings->context, MPM_NONFINITE,
                       "the pose of obstacle %lld is not finite in the step from t = %g with dt = %g",
                       (long long)i, step->t, step->dt);
  }
  return MPM_OK;
}

void mpmi_obstacles_commit(const mpmi_obstacles *list) {
  for (int64_t i = 0; i < list->count; ++i) list->obstacle[i]->pose = list->obstacle[i]->next;
}

/* ---- reports ------------------------------------------------------------------------------------------- */
mpm_status mpm_obstacle_contact_info(const mpm_obstacle *o, int32_t body, mpm_contact_info *info) {
  MPMI_ENTER(o, MPMI_OBSTACLE);
  if (!info) return mpmi_fail(o->context, MPM_E_ARG, "info is NULL");
  if (body < MPM_BODY_ANY || body >= MPMI_MAX_BODIES)
    return mpmi_fail(o->context, MPM_E_ARG, "body is %d: it must be MPM_BODY_ANY or 0 ... %d", (int)body,
                     MPMI_MAX_BODIES - 1);
  const mpm_stepper *s = o->stepper;
  if (!s) return mpmi_fail(o->context, MPM_E_STATE, "the obstacle is in no stepper");
  if (!s->history.has_reactions) return mpmi_fail(o->context, MPM_E_STATE, "no step has been made yet");
  mpm_contact_info now = {.struct_size = sizeof now, .gap = (double)INFINITY};
  for (int64_t i = 0; i < s->history.pairs.count; ++i) {
    const mpmi_pair_record *record = &s->history.pairs.record[i];
    if (record->a == mpmi_code_of_obstacle(o->number) && (body == MPM_BODY_ANY || body == record->b))
      mpmi_pair_tell(record, 1.0, s->history.reaction_dt, &now);
  }
  return mpmi_write_struct(o->context, "mpm_contact_info", &now, sizeof now, info);
}
