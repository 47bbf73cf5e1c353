/* The step in parts: order, bits, what the host does between the parts, and dropping it. */
#include "stepper_parts.h"

static body_desc numbered(int32_t i) {
  body_desc o = {.dim = 1 + i / PLAIN, .velocity_bc = i % 2, .method = *broad_methods[i % PLAIN]};
  return o;
}
enum { COMBINATIONS = 3 * PLAIN };

START_TEST(parts_make_the_whole) {
  const body_desc o = numbered(_i);
  world whole, parts;
  body_open(&whole, &o);
  body_open(&parts, &o);
  for (int32_t i = 0; i < 9; ++i) {
    world_steps(&whole, 1);
    if (i == 4) /* whole steps in between do no harm */
      world_steps(&parts, 1);
    else
      world_staged_step(&parts, BODY_DT);
    ck_assert_int_eq(parts.info.step, i + 1);
    if (o.method.transfer != MPM_APIC_MLS) {
      ck_assert_msg(world_hash(&whole) == world_hash(&parts), "step %d differs", (int)i + 1);
      ck_assert_double_eq(whole.info.dissipation, parts.info.dissipation);
    }
  }
  static const char *const field[] = {"position", "velocity"};
  for (int32_t f = 0; f < 2; ++f) world_agree("bodies", &whole, &parts, field[f], o.dim, 1e-12);
  world_agree("bodies", &whole, &parts, "stress", 6, 1e-12);
  world_close(&whole);
  world_close(&parts);
}
END_TEST

START_TEST(order_of_the_parts) {
  world r;
  body_open(&r, &(body_desc){.dim = 2});
  const uint64_t hash = world_hash(&r);
  mpm_step_info info = {.struct_size = sizeof info};
  ck_refused(&r, mpm_step_grid(r.stepper), MPM_E_STATE, "must follow mpm_step_begin");
  ck_refused(&r, mpm_step_end(r.stepper, &info), MPM_E_STATE, "must follow mpm_step_grid");
  ck_refused(&r, mpm_step_abort(r.stepper), MPM_E_STATE, "no step is under way");
  ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
  ck_refused(&r, mpm_step_begin(r.stepper, BODY_DT), MPM_E_STATE, "under way");
  ck_refused(&r, mpm_step(r.stepper, BODY_DT, NULL), MPM_E_STATE, "under way");
  ck_refused(&r, mpm_step_end(r.stepper, &info), MPM_E_STATE, "must follow mpm_step_grid");
  ck_ok(&r, mpm_step_grid(r.stepper));
  ck_refused(&r, mpm_step_grid(r.stepper), MPM_E_STATE, "must follow mpm_step_begin");
  ck_refused(&r, mpm_step_begin(r.stepper, BODY_DT), MPM_E_STATE, "under way");
  ck_assert(world_hash(&r) == hash);
  ck_ok(&r, mpm_step_end(r.stepper, &info));
  ck_assert_int_eq(info.step, 1);
  ck_assert(world_hash(&r) != hash);
  ck_refused(&r, mpm_step_end(r.stepper, &info), MPM_E_STATE, "must follow mpm_step_grid");
  ck_refused(&r, mpm_step_grid(r.stepper), MPM_E_STATE, "must follow mpm_step_begin");
  world_close(&r);
}
END_TEST

/* Between the parts the host sees the state before the step, whatever the scheme has made already. */
START_TEST(old_state_between_parts) {
  world r;
  body_open(&r, &(body_desc){.dim = 2, .method.scheme = _i});
  world_steps(&r, 2);
  double *before = fetch(&r, r.set[0], "volume", 1);
  const int64_t n = mpm_particles_count(r.set[0]);
  for (int32_t part = 0; part < 2; ++part) {
    ck_ok(&r, part ? mpm_step_grid(r.stepper) : mpm_step_begin(r.stepper, BODY_DT));
    double *volume = fetch(&r, r.set[0], "volume", 1);
    ck_assert_int_eq(memcmp(volume, before, (size_t)n * sizeof *volume), 0);
    free(volume);
  }
  ck_ok(&r, mpm_step_end(r.stepper, NULL));
  double *after = fetch(&r, r.set[0], "volume", 1);
  ck_assert_int_ne(memcmp(after, before, (size_t)n * sizeof *after), 0);
  free(before), free(after);
  world_close(&r);
}
END_TEST

/* While a step is under way nothing of the stepper may change. */
START_TEST(nothing_else_meanwhile) {
  world r;
  body_open(&r, &(body_desc){.dim = 2});
  const mpm_advance_desc advance = advance_desc(1.0);
  const mpm_stepper_desc d = body_stepper(&r);
  mpm_step_info info = {.struct_size = sizeof info};
  double dt;
  char byte;
  for (int32_t part = 0; part < 2; ++part) {
    ck_ok(&r, part ? mpm_step_grid(r.stepper) : mpm_step_begin(r.stepper, BODY_DT));
#define REFUSED(call) ck_refused(&r, call, MPM_E_STATE, "")
    REFUSED(mpm_stepper_add(r.stepper, r.set[0]));
    REFUSED(mpm_stepper_remove(r.stepper, r.set[0]));
    REFUSED(mpm_stepper_configure(r.stepper, &d));
    REFUSED(mpm_stepper_set_time(r.stepper, 0.0, 0));
    REFUSED(mpm_stepper_set_wall(r.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    REFUSED(mpm_stepper_set_force(r.stepper, NULL, NULL));
    REFUSED(mpm_stepper_set_acceleration(r.stepper, NULL, NULL));
    REFUSED(mpm_stepper_set_velocity_bc(r.stepper, NULL, NULL));
    REFUSED(mpm_stepper_set_progress(r.stepper, NULL, NULL));
    REFUSED(mpm_stable_dt(r.stepper, &dt));
    REFUSED(mpm_advance(r.stepper, &advance, NULL));
    REFUSED(mpm_stepper_info(r.stepper, &info));
    REFUSED(mpm_stepper_destroy(r.stepper));
    REFUSED(mpm_state_save(r.stepper, &byte, 1));
    REFUSED(mpm_state_load(r.stepper, &byte, 1));
    REFUSED(mpm_particles_remove(r.set[0], 1, (int64_t[]){1}));
#undef REFUSED
  }
  ck_ok(&r, mpm_step_end(r.stepper, NULL));
  world_close(&r);
}
END_TEST

/* A step that was dropped never was. */
START_TEST(abort_leaves_no_trace) {
  const body_desc o = numbered(_i);
  world r, other;
  body_open(&r, &o);
  body_open(&other, &o);
  for (int32_t i = 0; i < 6; ++i) {
    world_bits was = world_take(&r);
    ck_ok(&r, mpm_step_begin(r.stepper, 3.0 * BODY_DT));
    if (i % 2) {
      mpm_view view = {.struct_size = sizeof view};
      ck_ok(&r, mpm_step_grid(r.stepper));
      ck_ok(&r, mpm_grid_map(r.stepper, 0, "velocity", MPM_WRITE, &view));
      for (int64_t k = 0; k < view.count; ++k) ((double *)view.data)[k] = 1e3;
      ck_refused(&r, mpm_step_abort(r.stepper), MPM_E_STATE, "1 views of nodal fields");
      ck_ok(&r, mpm_view_release(&view));
    }
    ck_ok(&r, mpm_step_abort(r.stepper));
    world_same(&r, &was, "aborted");
    bits_drop(&was);
    world_steps(&r, 1);
    world_steps(&other, 1);
    ck_assert(world_hash(&r) == world_hash(&other));
    ck_assert_double_eq(r.info.external_work, other.info.external_work);
  }
  world_close(&r);
  world_close(&other);
}
END_TEST

/* A part that fails ends the step; one that is refused does not. */
static mpm_status refuse(void *user, const mpm_particle_batch *b, double *add) {
  (void)b, (void)add;
  return *(mpm_status *)user;
}
static mpm_status refuse_nodes(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)b, (void)prescribed, (void)velocity;
  return *(mpm_status *)user;
}
static mpm_status refuse_progress(void *user, const mpm_step_info *info) {
  (void)info;
  return *(mpm_status *)user;
}

static mpm_status note(void *user, const mpm_step_info *info) {
  *(mpm_step_info *)user = *info;
  return 0;
}

/* The info of a step has nothing of the step before, made or failed, but the count of nodes until it has its
 * own. */
START_TEST(info_of_its_own_step) {
  world r;
  mpm_status answer = 4;
  mpm_step_info info = {.struct_size = sizeof info}, shown = {.cause = -1};
  body_open(&r, &(body_desc){.dim = 2});
  world_steps(&r, 2);
  ck_assert_int_gt(r.info.active_nodes, 0);
  ck_assert_double_gt(fabs(r.info.external_work), 0.0);
  ck_ok(&r, mpm_stepper_set_force(r.stepper, refuse, &answer));
  ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), MPM_CUT_DT, "force callback returned 4");
  ck_assert_int_eq(info.set, 0);
  ck_assert_int_eq(info.active_nodes, r.info.active_nodes);
  ck_assert_double_eq(info.external_work, 0.0);
  ck_assert_double_eq(info.dissipation, 0.0);
  ck_ok(&r, mpm_stepper_set_force(r.stepper, NULL, NULL));
  ck_ok(&r, mpm_stepper_set_progress(r.stepper, note, &shown));
  world_steps(&r, 1);
  ck_assert_int_eq(shown.cause, MPM_OK);
  ck_assert_int_eq(shown.callback_status, 0);
  ck_assert_int_eq(shown.set, -1);
  ck_assert_int_eq(shown.particle, -1);
  ck_assert_int_eq(shown.node, -1);
  ck_assert_double_eq(shown.dt, BODY_DT);
  ck_assert_double_eq(shown.dt_suggested, 0.0);
  ck_assert_int_eq(shown.active_nodes, r.info.active_nodes);
  ck_ok(&r, mpm_stepper_set_progress(r.stepper, refuse_progress, &answer));
  ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), MPM_CANCELLED, "progress callback returned 4");
  ck_ok(&r, mpm_stepper_set_progress(r.stepper, NULL, NULL));
  world_steps(&r, 1);
  ck_assert_int_eq(info.active_nodes, r.info.active_nodes);
  world_close(&r);
}
END_TEST

START_TEST(failing_parts_abort) {
  world r;
  mpm_status answer = 4;
  mpm_step_info info = {.struct_size = sizeof info};
  body_open(&r, &(body_desc){.dim = 2});
  world_steps(&r, 2);
  world_bits was = world_take(&r);
  ck_ok(&r, mpm_stepper_set_force(r.stepper, refuse, &answer));
  ck_refused(&r, mpm_step_begin(r.stepper, BODY_DT), MPM_CUT_DT, "force callback returned 4");
  ck_refused(&r, mpm_step_grid(r.stepper), MPM_E_STATE, "must follow");
  ck_ok(&r, mpm_stepper_set_force(r.stepper, NULL, NULL));
  ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, refuse_nodes, &answer));
  ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
  ck_refused(&r, mpm_step_grid(r.stepper), MPM_CUT_DT, "velocity callback returned 4");
  ck_refused(&r, mpm_step_end(r.stepper, &info), MPM_E_STATE, "must follow");
  ck_refused(&r, mpm_step_abort(r.stepper), MPM_E_STATE, "no step");
  ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, NULL, NULL));
  ck_ok(&r, mpm_stepper_set_progress(r.stepper, refuse_progress, &answer));
  ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
  ck_ok(&r, mpm_step_grid(r.stepper));
  ck_refused(&r, mpm_step_end(r.stepper, &info), MPM_CANCELLED, "progress callback returned 4");
  ck_assert_int_eq(info.cause, MPM_CANCELLED);
  ck_assert_int_eq(info.callback_status, 4);
  ck_refused(&r, mpm_step_abort(r.stepper), MPM_E_STATE, "no step");
  world_same(&r, &was, "a part that failed");
  bits_drop(&was);
  ck_ok(&r, mpm_stepper_set_progress(r.stepper, NULL, NULL));

  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
  ck_ok(&r, mpm_grid_map(r.stepper, 0, "mass", MPM_READ, &view));
  ck_refused(&r, mpm_step_grid(r.stepper), MPM_E_STATE, "1 views of nodal fields");
  ck_ok(&r, mpm_view_release(&view));
  ck_ok(&r, mpm_step_grid(r.stepper));
  ck_ok(&r, mpm_particles_map(r.set[1], "mass", MPM_READ, &view));
  ck_refused(&r, mpm_step_end(r.stepper, &info), MPM_E_STATE, "set 1 is mapped");
  ck_ok(&r, mpm_view_release(&view));
  ck_ok(&r, mpm_step_end(r.stepper, &info));
  ck_assert_int_eq(info.step, 3);
  world_close(&r);
}
END_TEST

/* ---- what the host changes ---- */
static mpm_status constant(void *user, const mpm_particle_batch *b, double *add) {
  const double *a = user;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t p = 0; p < b->n; ++p) add[c * b->ld + p] += b->mass[p] * a[c];
  return 0;
}

/* m_i a on the nodes is what m_p a on the particles is. */
START_TEST(forces_on_nodes) {
  const body_desc o = numbered(_i);
  double a[3] = {300.0, -200.0, 100.0};
  world nodes, particles;
  body_open(&nodes, &o);
  body_open(&particles, &o);
  ck_ok(&nodes, mpm_stepper_set_force(nodes.stepper, NULL, NULL));
  ck_ok(&particles, mpm_stepper_set_force(particles.stepper, constant, a));
  for (int32_t i = 0; i < 3; ++i) {
    world_steps(&particles, 1);
    mpm_view mass = {.struct_size = sizeof mass}, force = mass;
    ck_ok(&nodes, mpm_step_begin(nodes.stepper, BODY_DT));
    ck_ok(&nodes, mpm_grid_map(nodes.stepper, 0, "mass", MPM_READ, &mass));
    ck_ok(&nodes, mpm_grid_map(nodes.stepper, 0, "force", MPM_READ | MPM_WRITE, &force));
    ck_assert_int_eq(force.access, MPM_READ | MPM_WRITE);
    for (int64_t k = 0; k < force.count; ++k)
      for (int32_t c = 0; c < o.dim; ++c)
        ((double *)force.data)[c * force.component_stride + k * force.item_stride] +=
            ((double *)mass.data)[k * mass.item_stride] * a[c];
    ck_ok(&nodes, mpm_view_release(&force));
    ck_ok(&nodes, mpm_view_release(&mass));
    ck_ok(&nodes, mpm_step_grid(nodes.stepper));
    ck_ok(&nodes, mpm_step_end(nodes.stepper, NULL));
  }
  world_agree("bodies", &nodes, &particles, "position", o.dim, 1e-12);
  world_agree("bodies", &nodes, &particles, "velocity", o.dim, 1e-11);
  world_agree("bodies", &nodes, &particles, "stress", 6, 1e-9);
  world_close(&nodes);
  world_close(&particles);
}
END_TEST

/* One more to every nodal velocity: before the forces it moves the particles but does not change them with
 * FLIP; after them it does both. */
START_TEST(velocities_of_nodes) {
  body_desc o = numbered(_i);
  o.velocity_bc = 0;
  for (int32_t late = 0; late < 2; ++late) {
    world r, other;
    body_open(&r, &o);
    body_open(&other, &o);
    body_calm(&r);
    body_calm(&other);
    world_steps(&other, 1);
    mpm_view v = {.struct_size = sizeof v};
    ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
    if (late) ck_ok(&r, mpm_step_grid(r.stepper));
    ck_ok(&r, mpm_grid_map(r.stepper, 0, "velocity", MPM_READ | MPM_WRITE, &v));
    for (int64_t k = 0; k < v.count * o.dim; ++k) ((double *)v.data)[k] += 1.0;
    ck_ok(&r, mpm_view_release(&v));
    if (!late) ck_ok(&r, mpm_step_grid(r.stepper));
    ck_ok(&r, mpm_step_end(r.stepper, NULL));
    const double gain = o.method.transfer == MPM_FLIP && !late ? 0.0 : 1.0;
    for (int32_t m = 0; m < 2; ++m) {
      const int64_t n = mpm_particles_count(r.set[m]) * o.dim;
      double *x[2] = {fetch(&other, other.set[m], "position", o.dim), fetch(&r, r.set[m], "position", o.dim)};
      double *u[2] = {fetch(&other, other.set[m], "velocity", o.dim), fetch(&r, r.set[m], "velocity", o.dim)};
      for (int64_t i = 0; i < n; ++i) {
        ck_within("displacement", x[1][i] - x[0][i], BODY_DT, 1e-12);
        ck_within("velocity", u[1][i] - u[0][i], gain, 1e-10);
      }
      for (int32_t k = 0; k < 2; ++k) free(x[k]), free(u[k]);
    }
    world_close(&r);
    world_close(&other);
  }
}
END_TEST

TCase *stepper_staged_case(void) {
  TCase *tests = tcase_create("staged");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, parts_make_the_whole, 0, COMBINATIONS);
  tcase_add_test(tests, order_of_the_parts);
  tcase_add_loop_test(tests, old_state_between_parts, MPM_USL, MPM_MUSL + 1);
  tcase_add_test(tests, nothing_else_meanwhile);
  tcase_add_loop_test(tests, abort_leaves_no_trace, 0, COMBINATIONS);
  tcase_add_test(tests, info_of_its_own_step);
  tcase_add_test(tests, failing_parts_abort);
  tcase_add_loop_test(tests, forces_on_nodes, 0, COMBINATIONS);
  tcase_add_loop_test(tests, velocities_of_nodes, 0, COMBINATIONS);
  return tests;
}
