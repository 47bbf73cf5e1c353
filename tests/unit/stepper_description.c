/* mpm_stepper_desc: defaults, and what is refused at creation and by mpm_stepper_configure(). */
#include <stddef.h>

#include "context/structs.h"
#include "stepper_parts.h"

static world r;
static mpm_stepper *stepper; /* one more */

static void open_run(void) {
  body_open(&r, &(body_desc){.dim = 2});
}
static void close_run(void) {
  world_close(&r);
}

START_TEST(defaults) {
  mpm_stepper_desc d;
  memset(&d, 0x5a, sizeof d);
  ck_assert_int_eq(mpm_stepper_desc_init(NULL, sizeof d), MPM_E_ARG);
  ck_assert_int_eq(mpm_stepper_desc_init(&d, mpmi_first_size("mpm_stepper_desc") - 1), MPM_E_ARG);
  ck_ok(NULL, mpm_stepper_desc_init(&d, sizeof d));
  ck_assert_uint_eq(d.struct_size, sizeof d);
  ck_assert_int_eq(d.scheme, MPM_USL);
  ck_assert_int_eq(d.transfer, MPM_FLIP);
  ck_assert_int_eq(d.xpic_order, 2);
  ck_assert_int_eq(d.position_order, 1);
  ck_assert_int_eq(d.locking_remedy, MPM_LOCKING_NONE);
  ck_assert_int_eq(d.reference_positions, 0);
  ck_assert_int_eq(d.quasi_static, 0);
  ck_assert_int_eq(d.staggered, 0);
  ck_assert_int_eq(d.boundary_zero_acceleration, 0);
  ck_assert_double_eq(d.flip, 1.0);
  ck_assert_double_eq(d.pic_damping, 0.0);
  for (int32_t k = 0; k < 3; ++k) ck_assert_double_eq(d.gravity[k], 0.0);
  ck_assert_double_eq(d.newmark_beta, 0.25);
  ck_assert_double_eq(d.newmark_gamma, 0.5);
  ck_assert_double_eq(d.newton_tolerance_displacement, 1e-8);
  ck_assert_double_eq(d.newton_tolerance_energy, 1e-14);
  ck_assert_double_eq(d.newton_tolerance_residual, 1e-8);
  ck_assert_double_eq(d.newton_residual_floor, 0.0);
  ck_assert_int_eq(d.newton_max_iterations, 20);
  ck_assert_int_eq(d.linear_solver, MPM_SOLVER_AUTO);
  ck_assert_double_eq(d.linear_tolerance, 0.0);
  ck_assert_int_eq(d.linear_max_iterations, 0);
  ck_assert_int_eq(d.projected_positions, 0);
}
END_TEST

/* One field with a value that is refused. */
#define INT(field, value, status, text)                                                                      \
  { #field, offsetof(mpm_stepper_desc, field), value, 0.0, 0, status, text }
#define REAL(field, value, status, text)                                                                     \
  { #field, offsetof(mpm_stepper_desc, field), 0, value, 1, status, text }
static const struct {
  const char *name;
  size_t offset;
  int32_t whole;
  double real;
  int32_t is_real;
  mpm_status status;
  const char *text;
} bad[] = {
    INT(scheme, 0, MPM_E_ARG, "scheme is 0"),
    INT(scheme, 99, MPM_E_ARG, "scheme is 99"),
    INT(transfer, 0, MPM_E_ARG, "transfer is 0"),
    INT(transfer, 9, MPM_E_ARG, "transfer is 9"),
    INT(xpic_every, -1, MPM_E_ARG, "xpic_every is -1"),
    INT(position_order, 0, MPM_E_ARG, "position_order is 0"),
    INT(position_order, 3, MPM_E_ARG, "position_order is 3"),
    INT(locking_remedy, -1, MPM_E_ARG, "locking_remedy is -1"),
    INT(locking_remedy, 2, MPM_E_ARG, "locking_remedy is 2"),
    INT(reference_positions, 2, MPM_E_ARG, "reference_positions is 2"),
    INT(reference_positions, -1, MPM_E_ARG, "reference_positions is -1"),
    INT(quasi_static, 2, MPM_E_ARG, "quasi_static is 2"),
    INT(quasi_static, 1, MPM_E_UNSUPPORTED, "use scheme MPM_NEWMARK"),
    INT(staggered, -1, MPM_E_ARG, "staggered is -1"),
    INT(boundary_zero_acceleration, 5, MPM_E_ARG, "boundary_zero_acceleration is 5"),
    INT(projected_positions, 2, MPM_E_ARG, "projected_positions is 2"),
    INT(projected_positions, 1, MPM_E_UNSUPPORTED, "MPM_MUSL: use that"),
    REAL(flip, -0.1, MPM_E_ARG, "flip is -0.1"),
    REAL(flip, 1.1, MPM_E_ARG, "flip is 1.1"),
    REAL(flip, NOT_A_NUMBER, MPM_E_ARG, "flip is nan"),
    REAL(pic_damping, -1.0, MPM_E_ARG, "pic_damping is -1"),
    REAL(pic_damping, INFINITE, MPM_E_ARG, "pic_damping is inf"),
    REAL(gravity, NOT_A_NUMBER, MPM_E_ARG, "gravity[0] is nan"),
    REAL(gravity[1], INFINITE, MPM_E_ARG, "gravity[1] is inf"),
};
enum { BAD = (int)(sizeof bad / sizeof *bad) };

static mpm_stepper_desc with_bad(int32_t i) {
  mpm_stepper_desc d = body_stepper(&r);
  if (bad[i].is_real)
    memcpy((char *)&d + bad[i].offset, &bad[i].real, sizeof bad[i].real);
  else
    memcpy((char *)&d + bad[i].offset, &bad[i].whole, sizeof bad[i].whole);
  return d;
}

START_TEST(refused_values) {
  const mpm_stepper_desc d = with_bad(_i);
  stepper = r.stepper;
  ck_refused(&r, mpm_stepper_create(r.context, r.grid, &d, &stepper), bad[_i].status, bad[_i].text);
  ck_assert_ptr_null(stepper);
  /* and the same by configure, which leaves everything as it was */
  world other;
  body_open(&other, &r.desc.body);
  ck_refused(&r, mpm_stepper_configure(r.stepper, &d), bad[_i].status, bad[_i].text);
  world_steps(&r, 2);
  world_steps(&other, 2);
  ck_assert(world_hash(&r) == world_hash(&other));
  world_close(&other);
}
END_TEST

START_TEST(refused_arguments) {
  mpm_stepper_desc d = body_stepper(&r);
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  ck_assert_int_eq(mpm_stepper_create(NULL, r.grid, &d, &stepper), MPM_E_ARG);
  ck_assert_int_eq(mpm_stepper_create((mpm_context *)r.grid, r.grid, &d, &stepper), MPM_E_ARG);
  ck_refused(&r, mpm_stepper_create(r.context, r.grid, &d, NULL), MPM_E_ARG, "out");
  ck_refused(&r, mpm_stepper_create(r.context, NULL, &d, &stepper), MPM_E_ARG, "grid");
  ck_refused(&r, mpm_stepper_create(r.context, (mpm_grid *)r.set[0], &d, &stepper), MPM_E_ARG, "grid");
  stepper = r.stepper;
  ck_refused(context, mpm_stepper_create(context, r.grid, &d, &stepper), MPM_E_ARG, "another context");
  ck_assert_ptr_null(stepper);
  ck_ok(context, mpm_context_destroy(context));
  ck_refused(&r, mpm_stepper_configure(r.stepper, NULL), MPM_E_ARG, "desc is NULL");
  ck_assert_int_eq(mpm_stepper_configure(NULL, &d), MPM_E_ARG);
  d.struct_size = 0;
  ck_refused(&r, mpm_stepper_create(r.context, r.grid, &d, &stepper), MPM_E_ARG, "struct_size is 0");
  d.struct_size = mpmi_first_size("mpm_stepper_desc") - 8;
  ck_refused(&r, mpm_stepper_configure(r.stepper, &d), MPM_E_ARG, "struct_size is");
}
END_TEST

/* A caller with a later struct is served as long as it asks for nothing new. */
START_TEST(larger_struct) {
  struct {
    mpm_stepper_desc known;
    double later;
  } d;
  memset(&d, 0, sizeof d);
  ck_ok(NULL, mpm_stepper_desc_init(&d.known, sizeof d));
  ck_assert_uint_eq(d.known.struct_size, sizeof d);
  ck_ok(&r, mpm_stepper_create(r.context, r.grid, &d.known, &stepper));
  ck_ok(&r, mpm_stepper_destroy(stepper));
  d.later = 1.0;
  ck_refused(&r, mpm_stepper_create(r.context, r.grid, &d.known, &stepper), MPM_E_UNSUPPORTED,
             "does not know");
}
END_TEST

START_TEST(mls_needs_a_quadratic_basis) {
  world linear;
  body_open(&linear, &(body_desc){.dim = 2, .method.basis = MPM_LINEAR});
  mpm_stepper_desc d = body_stepper(&r);
  d.transfer = MPM_APIC_MLS;
  ck_refused(&linear, mpm_stepper_create(linear.context, linear.grid, &d, &stepper), MPM_E_UNSUPPORTED,
             "use MPM_APIC");
  ck_refused(&linear, mpm_stepper_configure(linear.stepper, &d), MPM_E_UNSUPPORTED, "use MPM_APIC");
  d.transfer = MPM_APIC;
  ck_ok(&linear, mpm_stepper_configure(linear.stepper, &d));
  world_close(&linear);
}
END_TEST

/* Gravity of axes that the grid does not have is ignored, and NULL asks for the defaults. */
START_TEST(accepted) {
  mpm_stepper_desc d = body_stepper(&r);
  d.gravity[2] = NOT_A_NUMBER;
  ck_ok(&r, mpm_stepper_configure(r.stepper, &d));
  world_steps(&r, 1);
  ck_ok(&r, mpm_stepper_create(r.context, r.grid, NULL, &stepper));
  mpm_step_info info;
  memset(&info, 0x5a, sizeof info);
  info.struct_size = sizeof info;
  ck_ok(&r, mpm_stepper_info(stepper, &info));
  ck_assert_int_eq(info.cause, MPM_OK);
  ck_assert_int_eq(info.callback_status, 0);
  ck_assert_int_eq(info.newton_iterations, 0);
  ck_assert_int_eq(info.linear_solver, 0);
  ck_assert_int_eq(info.set, -1);
  ck_assert_int_eq(info.particle, -1);
  ck_assert_int_eq(info.node, -1);
  ck_assert_int_eq(info.step, 0);
  ck_assert_int_eq(info.removed, 0);
  ck_assert_double_eq(info.t, 0.0);
  ck_assert_double_eq(info.dt, 0.0);
  ck_assert_double_eq(info.kinetic_energy, 0.0);
  for (int32_t k = 0; k < 3; ++k) ck_assert_double_eq(info.momentum[k], 0.0);
  ck_ok(&r, mpm_stepper_destroy(stepper));
  ck_ok(&r, mpm_stepper_destroy(NULL));
}
END_TEST

/* Without a handle, and what there is of implicit steps where there are none. */
START_TEST(bare_calls) {
  double value[3];
  int32_t count = 7;
  ck_ok(&r, mpm_stepper_set_linear_solver(r.stepper, NULL, NULL));
  ck_ok(&r, mpm_stepper_residuals(r.stepper, 0, NULL, &count));
  ck_assert_int_eq(count, 0);
  ck_refused(&r, mpm_stepper_residuals(r.stepper, 0, NULL, NULL), MPM_E_ARG, "count is NULL");
  ck_refused(&r, mpm_stepper_residuals(r.stepper, -1, NULL, &count), MPM_E_ARG, "capacity is -1");
  ck_refused(&r, mpm_stepper_residuals(r.stepper, 1, NULL, &count), MPM_E_ARG, "residual is NULL");
  ck_assert_int_eq(mpm_stepper_set_motion(NULL, r.set[0], NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_stepper_set_node_hook(NULL, MPM_AFTER_P2G, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_stepper_set_linear_solver(NULL, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_stepper_residuals(NULL, 0, NULL, &count), MPM_E_ARG);
  ck_assert_int_eq(mpm_stepper_particles_reaction(NULL, r.set[0], value), MPM_E_ARG);
  ck_assert_int_eq(mpm_stepper_particles_impulse(NULL, r.set[0], value), MPM_E_ARG);
  ck_assert_int_eq(mpm_operator_get_info(NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_operator_apply(NULL, value, value), MPM_E_ARG);
  ck_assert_int_eq(mpm_operator_csr(NULL, NULL, NULL, NULL), MPM_E_ARG);
}
END_TEST

TCase *stepper_description_case(void) {
  TCase *tests = tcase_create("description");
  tcase_add_checked_fixture(tests, open_run, close_run);
  tcase_add_test(tests, defaults);
  tcase_add_loop_test(tests, refused_values, 0, BAD);
  tcase_add_test(tests, refused_arguments);
  tcase_add_test(tests, larger_struct);
  tcase_add_test(tests, mls_needs_a_quadratic_basis);
  tcase_add_test(tests, accepted);
  tcase_add_test(tests, bare_calls);
  return tests;
}
