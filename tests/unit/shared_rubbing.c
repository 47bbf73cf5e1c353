/* Friction walls that act on nodes, in several parts: the contacts of all parts are swept together. */
#include "shared.h"

static mpm_status set_up_corner(world *w, const scene *is) {
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 2 * w->dim && !status; ++face)
    if (!w->desc.grid.periodic[face / 2])
      status = mpm_stepper_set_wall(w->stepper, face, MPM_WALL_FRICTION_NODES, 0.1 + 0.2 * face);
  if (!status) status = fill_middle(w, w->set[0], 0.0, 0.6);
  return status ? status : set_velocities(w, w->set[0], -is->speed);
}

START_TEST(walls_combine) {
  scene is;
  char name[300];
  if (!describe_option(&is, _i, _i % 2, name, sizeof name)) return;
  is.set_up = set_up_corner;
  is.speed = 2.0;
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* A channel that is so narrow that contacts of both walls share nodes, and other walls at its ends. */
static mpm_status set_up_channel(world *w, const scene *is) {
  static const int32_t kind[] = {MPM_WALL_SLIP, MPM_WALL_FRICTION_NODES, MPM_WALL_FRICTION_NODES,
                                 MPM_WALL_FRICTION_NODES};
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 4 && !status; ++face)
    status = mpm_stepper_set_wall(w->stepper, face, kind[face], face ? 0.3 : 0.0);
  const double h = w->desc.grid.spacing[0], low[] = {0.0, 0.0},
               high[] = {90.0 * h, (double)w->desc.grid.cells[1] * h};
  const int32_t per_cell[] = {2, 2};
  if (!status) status = mpm_particles_fill_box(w->set[0], low, high, per_cell, NULL, NULL);
  return status ? status : set_velocities(w, w->set[0], is->speed);
}

START_TEST(channels_are_narrow) {
  scene is = scene_of(2, 96, set_up_channel);
  is.desc.grid.cells[1] = 1 + _i % 3;
  is.desc.grid.basis = _i % 2 ? MPM_LINEAR : MPM_BSPLINE2;
  is.desc.stepper.scheme = scheme_options[_i % 3].scheme;
  is.speed = 3.0;
  check_made(&is, "channel", 2 + _i % 4);
}
END_TEST

/* ---- failures ------------------------------------------------------------------------------------------ */
/* In the fifth step the host says no at some nodes, which one part alone may have. */
static mpm_status refuse_far(void *user, const mpm_node_batch *batch, double *velocity, double *force) {
  const world *w = user;
  (void)velocity, (void)force;
  for (int64_t i = 0; i < batch->n; ++i)
    if (batch->t > 3.5 * batch->dt && batch->position[i] > 50.0 * w->desc.grid.spacing[0]) return -4;
  return MPM_OK;
}

static mpm_status fail_at_walls(world *w, const scene *is, outcome *found) {
  (void)is;
  mpm_status status = mpm_stepper_set_node_hook(w->stepper, MPM_AFTER_P2G, refuse_far, w);
  for (int32_t i = 0; i < 5 && !status; ++i) status = mpm_step(w->stepper, 2e-5, &w->info);
  if (status != MPM_E_CALLBACK) {
    fprintf(stderr, "%s: %s\n", mpm_status_name(status), mpm_last_error(w->context));
    return MPM_E_INTERNAL;
  }
  found->failed = w->info;
  status = mpm_stepper_set_node_hook(w->stepper, MPM_AFTER_P2G, NULL, NULL);
  for (int32_t i = 0; i < 5 && !status; ++i) status = mpm_step(w->stepper, 2e-5, &w->info);
  if (!status) status = mpm_step_begin(w->stepper, 2e-5);
  if (!status) status = mpm_step_grid(w->stepper);
  if (!status) status = mpm_step_end(w->stepper, &w->info);
  return status;
}

START_TEST(walls_fail_together) {
  scene is = scene_of(2, 96, set_up_corner);
  is.desc.stepper.scheme = scheme_options[_i % 3].scheme;
  is.run = fail_at_walls;
  check_made(&is, "failure at walls", 2 + _i % 4);
}
END_TEST

START_TEST(transport_fails_at_walls) {
  scene is = scene_of(2, 48, set_up_corner);
  is.desc.stepper.scheme = MPM_USF;
  check_lost_transport(&is, 6, 100);
}
END_TEST

void add_shared_rubbing(Suite *suite) {
  TCase *rubbing = tcase_create("rubbing");
  tcase_set_timeout(rubbing, 120);
  add_option_list(rubbing);
  TCase *wide = wide_case(suite, "more rubbing");
  add_option_list(wide);
  add_table(rubbing, wide, walls_combine, OPTIONS_SAMPLE);
  tcase_add_loop_test(rubbing, channels_are_narrow, 0, 6);
  tcase_add_loop_test(rubbing, walls_fail_together, 0, 6);
  suite_add_tcase(suite, rubbing);
  tcase_add_test(faults_case(suite, "faults of rubbing", 1), transport_fails_at_walls);
}
