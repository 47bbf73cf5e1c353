#include "support.h"

void support_lay(verify_world *w, support *s, double friction, double turn, const double *point) {
  mpm_contact_desc contact;
  mpm_obstacle_desc desc =
      verify_obstacle_defaults(&contact, MPM_SHAPE_PLANE, MPM_MOTION_FIXED, friction, turn);
  if (s->kind == ON_BODY) {
    contact.normal = s->normal;
    contact.detection = MPM_DETECT_GAP;
    if (s->normal == MPM_NORMAL_FIXED) contact.direction[1] = -1.0;
    verify_ok(w, mpm_stepper_set_contact(w->stepper, 0, 1, &contact));
  } else if (s->kind == ON_WALL) {
    verify_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_FRICTION, friction));
  } else {
    for (int32_t c = 0; c < w->dim; ++c) desc.position[c] = point[c];
    if (s->plane) verify_ok(w, mpm_stepper_remove_obstacle(w->stepper, s->plane));
    s->plane = verify_obstacle(w, &desc);
  }
}

mpm_contact_info support_info(const verify_world *w, const support *s) {
  mpm_contact_info info = {.struct_size = sizeof info};
  if (s->kind == ON_BODY) {
    verify_ok(w, mpm_stepper_contact_info(w->stepper, 1, 0, &info));
  } else if (s->kind == ON_PLANE) {
    verify_ok(w, mpm_obstacle_contact_info(s->plane, MPM_BODY_ANY, &info));
  } else {
    verify_ok(w, mpm_stepper_wall_reaction(w->stepper, MPM_Y_MIN, info.force));
    verify_ok(w, mpm_stepper_wall_impulse(w->stepper, MPM_Y_MIN, info.impulse));
    info.touching = info.force[1] > 0.0;
  }
  return info;
}
