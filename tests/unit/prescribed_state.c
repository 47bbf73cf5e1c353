/* Motions that fail, and prescribed particles in saved states. */
#include "prescribed.h"

typedef struct trouble {
  mpm_status status;
  int64_t id;
} trouble;

static mpm_status misbehave(void *user, const mpm_particle_batch *b, double *add) {
  const trouble *t = user;
  for (int64_t p = 0; p < b->n; ++p)
    if (b->id[p] == t->id) add[p] = (double)NAN;
  return t->status;
}

START_TEST(motions_that_fail) {
  const method *how = &methods[_i];
  mpm_step_info info = {.struct_size = sizeof info};
  double force[3];
  world w, other;
  open_clouds(&w, how, 2, 1, 0);
  open_clouds(&other, how, 2, 0, 0);
  uint8_t *flags = fetch_flags(&w, w.set[1]);
  trouble t = {0, 0};
  while (!flags[t.id]) ++t.id;
  ck_refused(&w, mpm_stepper_set_motion(w.stepper, other.set[1], prescribed_turn, NULL), MPM_E_NOT_FOUND,
             "not in this stepper");
  ck_refused(&w, mpm_stepper_set_motion(w.stepper, NULL, prescribed_turn, NULL), MPM_E_ARG,
             "particles is NULL");
  ck_refused(&w, mpm_stepper_particles_reaction(w.stepper, w.set[1], NULL), MPM_E_ARG, "force is NULL");
  ck_refused(&w, mpm_stepper_particles_reaction(w.stepper, other.set[0], force), MPM_E_NOT_FOUND,
             "not in this stepper");
  ck_refused(&w, mpm_stepper_particles_reaction(w.stepper, w.set[1], force), MPM_E_STATE, "no step");
  world_step(&w, 1e-3);
  ck_ok(&w, mpm_stepper_set_motion(w.stepper, w.set[1], misbehave, &t));
  const uint64_t was = world_hash(&w);
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_NONFINITE, "prescribed velocity");
  ck_assert_int_eq(info.set, 1);
  ck_assert_int_eq(info.particle, t.id);
  t.status = 3;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_CUT_DT, "motion callback returned 3 for set 1");
  t.status = -3;
  ck_refused(&w, mpm_step_begin(w.stepper, 1e-3), MPM_E_CALLBACK, "motion callback returned -3 for set 1");
  ck_assert(world_hash(&w) == was);
  t.status = 0;
  while (flags[t.id]) ++t.id; /* what is said of others does not count */
  world_step(&w, 1e-3);
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  ck_refused(&w, mpm_stepper_set_motion(w.stepper, w.set[1], prescribed_turn, NULL), MPM_E_STATE,
             "under way");
  ck_ok(&w, mpm_step_abort(w.stepper));
  free(flags);
  world_close(&w), world_close(&other);
}
END_TEST

/* A state holds the flags and the last reactions; the callback is the host's to set. */
START_TEST(saved_and_restored) {
  const method *how = &methods[_i];
  world a, b;
  double force[2][2];
  open_clouds(&a, how, 2, 1, 0);
  open_clouds(&b, how, 2, 1, 1);
  ck_ok(&a, mpm_stepper_set_motion(a.stepper, a.set[1], prescribed_turn, a.set[1]));
  ck_ok(&b, mpm_stepper_set_motion(b.stepper, b.set[1], prescribed_turn, b.set[1]));
  for (int32_t i = 0; i < 3; ++i) world_step(&a, 1e-3);
  world_copy(&a, &b);
  for (int32_t i = 0; i < 4; ++i) {
    ck_ok(&a, mpm_stepper_particles_reaction(a.stepper, a.set[1], force[0]));
    ck_ok(&b, mpm_stepper_particles_reaction(b.stepper, b.set[1], force[1]));
    ck_assert_double_gt(fabs(force[0][1]), 1e-3);
    for (int32_t c = 0; c < 2; ++c) ck_within(how->name, force[1][c], force[0][c], 0.0);
    ck_assert(world_hash(&a) == world_hash(&b));
    if (i == 1) { /* they come and go */
      const int64_t ids[3] = {4, 9, 77};
      const double x[2] = {0.3, 0.4}, volume = 1e-3;
      ck_ok(&a, mpm_particles_remove(a.set[1], 3, ids));
      ck_ok(&b, mpm_particles_remove(b.set[1], 3, ids));
      ck_ok(&a, mpm_particles_add(a.set[1], 1, x, NULL, &volume, NULL, NULL, NULL));
      ck_ok(&b, mpm_particles_add(b.set[1], 1, x, NULL, &volume, NULL, NULL, NULL));
    }
    world_step(&a, 1e-3), world_step(&b, 1e-3);
  }
  world_close(&a), world_close(&b);
}
END_TEST

/* Without the callback that the state had no step is made, until the host has answered. */
START_TEST(motion_is_awaited) {
  world a, b;
  open_clouds(&a, &methods[_i], 2, 1, 0);
  open_clouds(&b, &methods[_i], 2, 1, 0);
  ck_ok(&a, mpm_stepper_set_motion(a.stepper, a.set[1], prescribed_turn, a.set[1]));
  for (int32_t i = 0; i < 3; ++i) world_step(&a, 1e-3);
  for (int32_t way = 0; way < 3; ++way) {
    world_copy(way == 2 ? &b : &a, &b); /* way 2: what awaits it is saved, and loaded again */
    const uint64_t was = world_hash(&b);
    ck_refused(&b, mpm_step(b.stepper, 1e-3, NULL), MPM_E_STATE,
               "prescribed particles of set 1 had a motion callback when the state was saved");
    ck_assert(world_hash(&b) == was);
    if (way) continue;
    ck_ok(&b, mpm_stepper_set_motion(b.stepper, b.set[1], NULL, NULL));
    world_step(&b, 1e-3); /* at their last velocities */
  }
  ck_ok(&b, mpm_stepper_set_motion(b.stepper, b.set[1], prescribed_turn, b.set[1]));
  for (int32_t i = 0; i < 3; ++i) world_step(&a, 1e-3), world_step(&b, 1e-3);
  ck_assert(world_hash(&a) == world_hash(&b));
  world_close(&a), world_close(&b);
}
END_TEST

TCase *prescribed_state_case(void) {
  TCase *tc = tcase_create("state");
  tcase_set_timeout(tc, 120);
  tcase_add_loop_test(tc, motions_that_fail, 0, METHODS);
  tcase_add_loop_test(tc, saved_and_restored, 0, METHODS);
  tcase_add_loop_test(tc, motion_is_awaited, 0, METHODS);
  return tc;
}
