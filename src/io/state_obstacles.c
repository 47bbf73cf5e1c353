/* A state holds where obstacles are, how they move and what acts on them. What they are is compared. */
#include "io/state.h"

#include <math.h>
#include <stdio.h>

static void same_obstacle(mpmi_archive *a, const mpm_obstacle_desc *d) {
  mpmi_archive_same_int(a, "shape", d->shape);
  mpmi_archive_same_int(a, "motion", d->motion);
  mpmi_archive_same_int(a, "inside", d->inside);
  for (int32_t k = 0; k < 3; ++k) mpmi_archive_same_real(a, "size", d->size[k]);
  if (d->motion != MPM_MOTION_FREE) return;
  mpmi_archive_same_real(a, "mass", d->mass);
  for (int32_t k = 0; k < 9; ++k) mpmi_archive_same_real(a, "inertia", d->inertia[k]);
}

void mpmi_state_write_obstacles(mpmi_archive *a, const mpm_stepper *s) {
  const mpmi_obstacles *list = &s->settings.obstacles;
  mpmi_archive_same_int(a, "number of obstacles", list->count);
  for (int64_t i = 0; i < list->count; ++i) {
    const mpm_obstacle *obstacle = list->obstacle[i];
    mpmi_state_obstacle saved = {.pose = obstacle->pose,
                                 .has_motion = obstacle->motion || obstacle->awaits_motion};
    for (int32_t k = 0; k < 3; ++k) {
      saved.force[k] = obstacle->force[k];
      saved.torque[k] = obstacle->torque[k];
    }
    same_obstacle(a, &obstacle->desc);
    mpmi_archive_words(a, &saved, sizeof saved);
  }
}

static void check_saved(mpmi_archive *a, const mpm_obstacle *obstacle, const mpmi_state_obstacle *saved) {
  int32_t sound = mpmi_pose_is_sound(&saved->pose) && !(saved->has_motion & ~1) &&
                  (!saved->has_motion || obstacle->desc.motion == MPM_MOTION_PRESCRIBED);
  for (int32_t k = 0; k < 3; ++k) {
    const int32_t moves = saved->pose.velocity[k] < 0.0 || saved->pose.velocity[k] > 0.0 ||
                          saved->pose.spin[k] < 0.0 || saved->pose.spin[k] > 0.0;
    sound &= isfinite(saved->force[k]) && isfinite(saved->torque[k]);
    sound &= !moves || obstacle->desc.motion != MPM_MOTION_FIXED;
  }
  if (!sound || mpmi_obstacle_fits(obstacle, &saved->pose, obstacle->grid->dim))
    mpmi_archive_damaged(a, "the pose of an obstacle makes no sense");
}

mpm_status mpmi_state_read_obstacles(mpmi_archive *a, const mpm_stepper *s, mpmi_state_obstacle *saved) {
  const mpmi_obstacles *list = &s->settings.obstacles;
  mpmi_archive_same_int(a, "number of obstacles", list->count);
  for (int64_t i = 0; i < list->count && !a->status; ++i) {
    snprintf(a->where, sizeof a->where, "obstacle %lld: ", (long long)i);
    same_obstacle(a, &list->obstacle[i]->desc);
    if (!a->status) mpmi_archive_words(a, &saved[i], sizeof saved[i]);
    if (!a->status) check_saved(a, list->obstacle[i], &saved[i]);
  }
  a->where[0] = '\0';
  return a->status;
}

void mpmi_state_take_obstacles(const mpm_stepper *s, const mpmi_state_obstacle *saved) {
  for (int64_t i = 0; i < s->settings.obstacles.count; ++i) {
    mpm_obstacle *obstacle = s->settings.obstacles.obstacle[i];
    obstacle->pose = saved[i].pose;
    obstacle->awaits_motion = saved[i].has_motion && !obstacle->motion;
    for (int32_t k = 0; k < 3; ++k) {
      obstacle->force[k] = saved[i].force[k];
      obstacle->torque[k] = saved[i].torque[k];
    }
  }
}
