/* What a callback calls on the context that has called it is refused, whatever the callback, the call and the
 * thread, and does no harm. */
#include <pthread.h>

#include "host_parts.h"

static world w, other;
static mpm_particles *spare; /* of no stepper, with a view out */
static mpm_view lent;
static mpm_series *series;
static char path[256];
static int32_t armed, from_a_thread;

static mpm_status take_none(void *user, const void *data, int64_t bytes) {
  (void)user, (void)data, (void)bytes;
  return MPM_OK;
}

/* Each of them would do something if it were accepted. */
static void try_all(int32_t kind) {
  const int64_t id = 1;
  const int32_t per_cell[] = {1, 1};
  const double x[] = {0.5, 0.5}, F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const mpm_param density = {"density", 1.0};
  const mpm_grid_desc g = grid_desc(2, 4, 0.1);
  const mpm_stepper_desc s = stepper_desc();
  const mpm_advance_desc go = advance_desc(1.0);
  const mpm_material_desc m = material_desc(1.0, host_neo_hookean, NULL);
  const void *made = NULL;
  mpm_view view = {.struct_size = sizeof view};
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_profile profile = {.struct_size = sizeof profile};
  mpm_contact_info contact = {.struct_size = sizeof contact};
  const char *name, *mass = "mass";
  double value[64];
  unsigned char byte[8] = {0};
  int64_t bytes;
  uint64_t hash;
  int32_t count;
  mpm_particles *set = w.set[0];
  mpm_stepper *stepper = w.stepper;
  const mpm_status refused[] = {
      mpm_grid_create(w.context, &g, (mpm_grid **)&made),
      mpm_material_create(w.context, "rigid", &density, 1, (mpm_material **)&made),
      mpm_material_create_custom(w.context, &m, (mpm_material **)&made),
      mpm_particles_create(w.context, w.grid, w.material[0], (mpm_particles **)&made),
      mpm_stepper_create(w.context, w.grid, &s, (mpm_stepper **)&made),
      mpm_series_open(w.context, path, (mpm_series **)&made),
      mpm_series_append(series, 0.0, "a"),
      mpm_series_close(series),
      mpm_set_last_error(w.context, MPM_E_IO, "of the callback"),
      mpm_context_destroy(w.context),
      mpm_grid_destroy(w.grid),
      mpm_material_destroy(w.material[0]),
      mpm_particles_destroy(spare),
      mpm_stepper_destroy(stepper),
      mpm_view_release(&lent),
      mpm_particles_add(set, 1, x, NULL, x, NULL, NULL, NULL),
      mpm_particles_fill_box(set, x, value, per_cell, NULL, NULL),
      mpm_particles_fill_ball(set, x, 0.1, per_cell, NULL, NULL),
      mpm_particles_remove(set, 1, &id),
      mpm_particles_add_field(set, "more", MPM_F64, 1),
      mpm_particles_field_info(set, 0, &name, NULL, NULL, NULL),
      mpm_particles_map(set, "mass", MPM_READ, &view),
      mpm_particles_map(spare, "mass", MPM_READ, &view),
      mpm_particles_get(set, "mass", MPM_F64, 1, 1, &id, value),
      mpm_particles_get_f32(spare, 1, &mass, MPM_BY_ID, mpm_particles_count(spare), (float *)value),
      mpm_particles_packed_size(set, 1, &bytes),
      mpm_particles_pack(set, 1, &id, byte, sizeof byte),
      mpm_particles_unpack(set, byte, sizeof byte),
      mpm_particles_set(set, "velocity", MPM_F64, 2, 1, &id, x),
      mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F),
      mpm_stepper_add(stepper, spare),
      mpm_stepper_remove(stepper, set),
      mpm_stepper_configure(stepper, &s),
      mpm_stepper_set_time(stepper, 0.0, 0),
      mpm_stepper_set_motion(stepper, set, NULL, NULL),
      mpm_stepper_set_body(stepper, set, 1),
      mpm_stepper_body(stepper, set, &count),
      mpm_stepper_set_contact(stepper, 0, 1, NULL),
      mpm_stepper_set_friction(stepper, NULL, NULL),
      mpm_stepper_contact_info(stepper, 0, 1, &contact),
      mpm_stepper_set_wall(stepper, 0, MPM_WALL_SLIP, 0.0),
      mpm_stepper_set_acceleration(stepper, NULL, NULL),
      mpm_stepper_set_force(stepper, NULL, NULL),
      mpm_stepper_set_velocity_bc(stepper, NULL, NULL),
      mpm_stepper_set_node_hook(stepper, MPM_AFTER_P2G, NULL, NULL),
      mpm_stepper_set_linear_solver(stepper, NULL, NULL),
      mpm_stepper_set_progress(stepper, NULL, NULL),
      mpm_stepper_set_balance(stepper, NULL),
      mpm_stable_dt(stepper, value),
      mpm_step(stepper, 1e-5, NULL),
      mpm_advance(stepper, &go, NULL),
      mpm_step_begin(stepper, 1e-5),
      mpm_step_grid(stepper),
      mpm_step_end(stepper, NULL),
      mpm_step_abort(stepper),
      mpm_stepper_info(stepper, &info),
      mpm_stepper_profile(stepper, 1, &profile),
      mpm_stepper_residuals(stepper, 1, value, &count),
      mpm_stepper_wall_reaction(stepper, 0, value),
      mpm_stepper_particles_reaction(stepper, w.set[1], value),
      mpm_stepper_wall_impulse(stepper, 0, value),
      mpm_stepper_particles_impulse(stepper, w.set[1], value),
      mpm_grid_map(stepper, 0, "mass", MPM_READ, &view),
      mpm_state_size(stepper, &bytes),
      mpm_state_save(stepper, byte, sizeof byte),
      mpm_state_load(stepper, byte, sizeof byte),
      mpm_state_load_pieces(stepper, 0, NULL, NULL),
      mpm_state_save_file(stepper, path),
      mpm_state_load_file(stepper, path),
      mpm_state_hash(stepper, &hash),
      mpm_write_particles(set, path, 0, NULL),
      mpm_write_grid(stepper, path, 0, NULL),
      mpm_write_body_grid(stepper, 0, path, 0, NULL),
      mpm_state_save_to(stepper, take_none, NULL),
      mpm_write_particles_to(set, take_none, NULL, 0, NULL),
      mpm_write_grid_to(stepper, 0, take_none, NULL, 0, NULL),
  };
  for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i)
    if (refused[i] != MPM_E_STATE)
      ck_abort_msg("kind %d, call %d: %s", (int)kind, (int)i, mpm_status_name(refused[i]));
  ck_holds(!made && lent.data);
  ck_holds(strstr(mpm_last_error(w.context), "another call on the same context is under way") != NULL);
  ck_holds(mpm_context_memory(w.context, &bytes, NULL) == MPM_OK && bytes > 0);
  ck_holds(mpm_particles_count(spare) > 0);
}

static void *in_a_thread(void *kind) {
  try_all(*(const int32_t *)kind);
  return NULL;
}

static void call_back(int32_t kind) {
  if (!armed) return;
  armed = 0; /* no callback of a callback */
  pthread_t thread;
  if (!from_a_thread) {
    try_all(kind);
  } else if (host_visits.seen[kind] % 8 == 1) {
    ck_assert_int_eq(pthread_create(&thread, NULL, in_a_thread, &kind), 0);
    ck_assert_int_eq(pthread_join(thread, NULL), 0);
  }
  /* another context is as free as ever */
  if (kind == FROM_PROGRESS || kind == FROM_LAW) world_step(&other, BODY_DT);
  armed = 1;
}

static void open_all(int32_t scheme) {
  host_visits = (visits){0};
  armed = 0;
  every_callback_open(&w, scheme);
  ck_ok(&w, mpm_particles_create(w.context, w.grid, w.material[0], &spare));
  world_fill_cube(&w, spare, 0.1, 0.2);
  lent = (mpm_view){.struct_size = sizeof lent};
  ck_ok(&w, mpm_particles_map(spare, "mass", MPM_READ | MPM_WRITE, &lent));
  ck_ok(&w, mpm_series_open(w.context, scratch_path("host.pvd", path, sizeof path), &series));
  scratch_path("refused", path, sizeof path);
}

static void close_all(void) {
  armed = 0;
  ck_ok(&w, mpm_view_release(&lent));
  ck_ok(&w, mpm_particles_destroy(spare));
  ck_ok(&w, mpm_series_close(series));
  world_close(&w);
}

START_TEST(calls_from_callbacks) {
  const int32_t scheme = _i % 2 ? MPM_NEWMARK : MPM_USL;
  from_a_thread = _i / 2;
  open_all(scheme);
  const uint64_t wanted = every_callback_story(&w);
  close_all();
  body_open(&other, &(body_desc){.dim = 2, .method = {METHOD(BSPLINE2, USL, FLIP, 1.0, "")}, .periodic = 1});
  open_all(scheme);
  host_visits.visit = call_back;
  armed = 1;
  ck_assert_uint_eq(every_callback_story(&w), wanted);
  armed = 0;
  /* the refusals are the last failures there were, and nothing is refused any more */
  ck_assert_ptr_nonnull(strstr(mpm_last_error(w.context), "under way"));
  world_step(&w, 1e-5);
  close_all();
  world_close(&other);
}
END_TEST

/* The call of a callback that fails says why, not what the callback was refused last. */
static void call_and_fail(int32_t kind) {
  if (armed && kind == FROM_RELEASE) {
    ck_assert_int_eq(mpm_stepper_set_time(w.stepper, 0.0, 0), MPM_E_STATE);
  }
}
START_TEST(the_call_has_the_last_word) {
  open_all(MPM_USL);
  ck_ok(&w, mpm_step(w.stepper, 1e-4, NULL));
  host_visits.visit = call_and_fail;
  const int64_t ids[2] = {900001, 900001};
  const double x[] = {0.5, 0.5, 0.5, 0.5};
  armed = 1; /* the scratch of the check is given back after the text was written */
  ck_refused(&w, mpm_particles_add(w.set[0], 2, x, NULL, x, NULL, ids, NULL), MPM_E_ARG,
             "900001 is given twice");
  ck_assert_int_gt(host_visits.seen[FROM_RELEASE], 0);
  close_all();
}
END_TEST

/* The linear system is lent to one caller at a time. */
static const mpm_operator *system_lent;
static mpm_status nested = MPM_OK;
static void apply_again(int32_t kind) {
  double x[1] = {0.0};
  if (kind == FROM_ALLOC && system_lent) nested = mpm_operator_apply(system_lent, x, x);
}
static mpm_status ask_for_rows(void *user, const mpm_operator *matrix, const double *rhs, double *x,
                               double tolerance, int64_t *iterations) {
  const int64_t *row_start;
  const int32_t *column;
  const double *value;
  (void)user, (void)rhs, (void)x, (void)tolerance, (void)iterations;
  system_lent = matrix;
  const mpm_status status = mpm_operator_csr(matrix, &row_start, &column, &value); /* takes memory */
  system_lent = NULL;
  ck_assert_int_eq(status, MPM_OK);
  ck_assert_int_eq(nested, MPM_E_STATE);
  ck_assert_int_eq(mpm_operator_apply(matrix, NULL, x), MPM_E_ARG); /* and is free again */
  return 1;
}
START_TEST(the_system_is_in_use) {
  open_all(MPM_NEWMARK);
  ck_ok(&w, mpm_stepper_set_linear_solver(w.stepper, ask_for_rows, NULL));
  host_visits.visit = apply_again;
  ck_assert_int_eq(mpm_step(w.stepper, 1e-4, NULL), MPM_CUT_DT);
  ck_assert_int_eq(nested, MPM_E_STATE);
  host_visits.visit = NULL;
  close_all();
}
END_TEST

/* While a context is destroyed, its memory is given back: too late for calls on it. */
static mpm_context *dying;
static int32_t refusals;
static void disturb(int32_t kind) {
  if (kind != FROM_RELEASE || !dying) return;
  const mpm_status status = mpm_context_destroy(dying);
  refusals += status == MPM_E_STATE || status == MPM_E_ARG;
}
START_TEST(destroyed_once) {
  world_desc d;
  open_all(MPM_USL);
  d = w.desc;
  d.context.parallel_for = NULL; /* a pool of its own */
  close_all();
  ck_ok(NULL, mpm_context_create(&d.context, &dying));
  refusals = 0;
  host_visits.visit = disturb;
  ck_assert_int_eq(mpm_context_destroy(dying), MPM_OK);
  host_visits.visit = NULL;
  ck_assert_int_eq(refusals, 2);
}
END_TEST

TCase *host_reentry_case(void) {
  TCase *tests = tcase_create("reentry");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, calls_from_callbacks, 0, 4);
  tcase_add_test(tests, the_call_has_the_last_word);
  tcase_add_test(tests, the_system_is_in_use);
  tcase_add_test(tests, destroyed_once);
  return tests;
}
