/* Memory that runs out: every allocation of a whole run fails once, the call that needed it
 * says so and changes nothing, and the same call succeeds when memory is there again. In the
 * steady state nothing is allocated. */
#include "run_support.h"

enum { STEPS = 15, SAVED_AT = 6 };

/* A call of the script that may fail, and what it works on. */
typedef struct script {
  run r, loaded;
  run_memory *memory;
  char *state;
  int64_t bytes;
  int32_t failures;
} script;
typedef mpm_status (*part_fn)(script *s);

static mpm_status open_part(script *s) {
  return run_try_open(&s->r);
}
static mpm_status step_part(script *s) {
  s->r.info.struct_size = sizeof s->r.info;
  return mpm_step(s->r.stepper, RUN_DT, &s->r.info);
}
static mpm_status staged_part(script *s) {
  mpm_status status = mpm_step_begin(s->r.stepper, RUN_DT);
  if (!status) status = mpm_step_grid(s->r.stepper);
  return status ? status : mpm_step_end(s->r.stepper, NULL);
}
static mpm_status dt_part(script *s) {
  double dt;
  return mpm_stable_dt(s->r.stepper, &dt);
}
static mpm_status map_part(script *s) {
  mpm_view view = {.struct_size = sizeof view};
  mpm_status status = mpm_grid_map(s->r.stepper, 0, "mass", MPM_READ, &view);
  if (status) return status;
  run_ok(&s->r, mpm_view_release(&view));
  status = mpm_grid_map(s->r.stepper, 0, "velocity", MPM_READ, &view);
  if (!status) run_ok(&s->r, mpm_view_release(&view));
  return status;
}
static mpm_status wall_part(script *s) {
  return mpm_stepper_set_wall(s->r.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0);
}
/* velocity_gradient and acceleration come into being, and the law is asked for the state as it is */
static mpm_status field_part(script *s) {
  const int64_t n = mpm_particles_count(s->r.set[0]);
  double *L = run_get(&s->r, 0, "velocity_gradient", 9);
  mpm_status status = mpm_particles_set(s->r.set[0], "velocity_gradient", MPM_F64, 9, n, NULL, L);
  free(L);
  const double zero[3] = {0.0, 0.0, 0.0};
  if (!status) status = mpm_particles_set_all(s->r.set[0], "applied_force", MPM_F64, s->r.options.dim, zero);
  return status;
}
static mpm_status remove_part(script *s) {
  const int64_t id = 1;
  return mpm_particles_remove(s->r.set[0], 1, &id);
}
static mpm_status add_part(script *s) {
  double x[3] = {0.05, 0.6, 0.4}, v[3] = {1.0, 2.0, 3.0};
  const double volume = 1e-3;
  const int64_t id = 100000;
  x[0] = s->r.options.dim == 2 ? 1.2 : 0.2;
  return mpm_particles_add(s->r.set[0], 1, x, v, &volume, NULL, &id, NULL);
}
static mpm_status references_part(script *s) {
  mpm_stepper_desc d;
  ck_assert_int_eq(mpm_stepper_desc_init(&d, sizeof d), MPM_OK);
  d.scheme = s->r.options.scheme;
  d.transfer = s->r.options.transfer;
  d.reference_positions = 1;
  return mpm_stepper_configure(s->r.stepper, &d);
}
static mpm_status save_part(script *s) {
  const mpm_status status = mpm_state_size(s->r.stepper, &s->bytes);
  if (status) return status;
  s->state = realloc(s->state, (size_t)s->bytes);
  return mpm_state_save(s->r.stepper, s->state, s->bytes);
}
/* into the run that goes on: it must survive that as it was */
static mpm_status load_part(script *s) {
  return mpm_state_load(s->r.stepper, s->state, s->bytes);
}
static mpm_status write_part(script *s) {
  char path[512];
  const char *scratch = getenv("MPM_SCRATCH");
  snprintf(path, sizeof path, "%s/allocation.state", scratch ? scratch : ".");
  mpm_status status = mpm_state_save_file(s->r.stepper, path);
  return status ? status : mpm_state_load_file(s->r.stepper, path);
}

/* A failing call leaves the run as it was, and is repeated: then it must succeed. */
static void play(script *s, part_fn part) {
  const int32_t open = part != open_part;
  const int64_t fail_at = s->memory->fail_at;
  run_state was = {{NULL, NULL}, {0, 0}, 0};
  if (open && fail_at > s->memory->calls) { /* looking at the run allocates, too */
    const int64_t before = s->memory->calls;
    s->memory->fail_at = 0;
    was = run_take(&s->r);
    s->memory->calls = before;
    s->memory->fail_at = fail_at;
  }
  const mpm_status status = part(s);
  if (status) {
    ck_assert_msg(status == MPM_E_NOMEM && s->memory->calls >= fail_at && fail_at > 0, "%s: %s",
                  mpm_status_name(status), s->r.context ? mpm_last_error(s->r.context) : "");
    if (s->r.context)
      ck_assert_msg(strstr(mpm_last_error(s->r.context), "memory"), "no word of memory: \"%s\"",
                    mpm_last_error(s->r.context));
    ++s->failures;
    s->memory->fail_at = 0;
    if (open && part != staged_part) run_same(&s->r, &was, "out of memory");
    const mpm_status again = part(s);
    ck_assert_msg(again == MPM_OK, "again: %s: %s", mpm_status_name(again),
                  s->r.context ? mpm_last_error(s->r.context) : "");
  }
  run_drop(&was);
}

/* The whole run with allocation number fail_at failing; how many there were, and the hash at the end. */
static int64_t tell(run_options o, int64_t fail_at, uint64_t *hash, int32_t *failures) {
  run_memory memory = {.fail_at = fail_at};
  script s = {.memory = &memory};
  o.memory = &memory;
  s.r.options = o;
  play(&s, open_part);
  play(&s, dt_part);
  for (int32_t i = 1; i <= STEPS; ++i) {
    play(&s, i % 5 == 3 ? staged_part : step_part);
    if (i == 2) play(&s, map_part);
    if (i == 3 && !o.periodic) play(&s, wall_part);
    if (i == 4) play(&s, field_part);
    if (i == 5) play(&s, remove_part);
    if (i == SAVED_AT) play(&s, save_part);
    if (i == SAVED_AT) play(&s, load_part);
    if (i == 8) play(&s, add_part);
    if (i == 9) play(&s, references_part);
    if (i == 11) play(&s, write_part);
  }
  const int64_t calls = memory.calls;
  *failures = s.failures;
  *hash = run_hash(&s.r);
  ck_assert_int_ge(s.r.info.resorts, 2); /* with the first sort */
  run_close(&s.r);
  ck_assert_int_eq(memory.held, 0);
  free(s.state);
  return calls;
}

START_TEST(every_allocation_fails_once) {
  static const run_options cases[] = {
      {.dim = 2, .basis = MPM_BSPLINE2, .scheme = MPM_MUSL, .transfer = MPM_APIC, .velocity_bc = 1},
      {.dim = 1, .basis = MPM_LINEAR, .scheme = MPM_USL, .transfer = MPM_FLIP, .concurrency = 2},
      {.dim = 3, .basis = MPM_BSPLINE2, .scheme = MPM_USL, .transfer = MPM_APIC_MLS},
      {.dim = 1,
       .basis = MPM_BSPLINE2,
       .scheme = MPM_MUSL,
       .transfer = MPM_FLIP,
       .periodic = 1,
       .stress = run_neo_hookean},
      {.dim = 2, .basis = MPM_BSPLINE2, .scheme = MPM_MUSL, .transfer = MPM_APIC_MLS, .led = 1}};
  uint64_t wanted, hash;
  int32_t failures, all = 0;
  const int64_t calls = tell(cases[_i], 0, &wanted, &failures);
  ck_assert_int_eq(failures, 0);
  ck_assert_int_gt(calls, 100);
  for (int64_t k = 1; k <= calls; ++k) {
    tell(cases[_i], k, &hash, &failures);
    ck_assert_int_le(failures, 1);
    ck_assert_msg(hash == wanted, "without allocation %lld the run is another", (long long)k);
    all += failures;
  }
  ck_assert_int_ge(all, calls - calls / 20); /* looking at the run spares it some */
}
END_TEST

/* A small run that is to take over a large state, and fails at it, goes on as the small one that it was. */
START_TEST(loading_a_larger_state) {
  run_memory memory = {0};
  run_options o = {.dim = 1 + _i, .memory = &memory};
  const double x[3] = {0.25, 0.75, 0.4}, volume = 1e-3;
  run large, small;
  int64_t bytes;
  uint64_t hash = 0;
  int32_t failures = 0;
  run_open(&large, &o);
  run_steps(&large, 2);
  run_ok(&large, mpm_state_size(large.stepper, &bytes));
  char *state = malloc((size_t)bytes);
  run_ok(&large, mpm_state_save(large.stepper, state, bytes));
  run_steps(&large, 3);
  o.empty = 1;
  for (int64_t k = 0;; ++k) { /* k = 0: nothing is loaded */
    run_open(&small, &o);
    run_ok(&small, mpm_particles_add(small.set[1], 1, x, NULL, &volume, NULL, NULL, NULL));
    run_steps(&small, 2);
    memory.fail_at = k ? memory.calls + k : 0;
    const mpm_status status = k ? mpm_state_load(small.stepper, state, bytes) : MPM_OK;
    memory.fail_at = 0;
    if (k && !status) break;
    if (k) ck_assert_int_eq(status, MPM_E_NOMEM);
    failures += k > 0;
    run_steps(&small, 3);
    if (k)
      ck_assert_msg(run_hash(&small) == hash, "after failure %lld the run is another", (long long)k);
    else
      hash = run_hash(&small);
    run_close(&small);
  }
  run_steps(&small, 3);
  ck_assert(run_hash(&small) == run_hash(&large));
  ck_assert_int_gt(failures, 20);
  run_close(&small);
  run_close(&large);
  ck_assert_int_eq(memory.held, 0);
  free(state);
}
END_TEST

/* After some steps that find how much is needed, 20 steps do without a single allocation. */
START_TEST(steady_state) {
  run_memory memory = {0};
  run_options o = {.dim = 3, .large = 1, .periodic = 1, .memory = &memory, .concurrency = 2, .led = _i % 2};
  run_use(&o, &run_methods[_i]);
  if (o.scheme == MPM_NEWMARK) return; /* a matrix grows with its nodes */
  run r;
  run_open(&r, &o);
  run_steps(&r, 2);
  const int64_t calls = memory.calls, held = memory.held;
  int64_t bytes, peak;
  run_ok(&r, mpm_context_memory(r.context, &bytes, &peak));
  ck_assert_int_eq(bytes, held);
  /* within one arrangement of the blocks */
  const int64_t resorts = r.info.resorts;
  for (int32_t i = 0; i < 20; ++i) run_step_of(&r, 0.1 * RUN_DT);
  ck_assert_int_eq(memory.calls, calls);
  ck_assert_int_eq(memory.held, held);
  ck_assert_int_eq(r.info.resorts, resorts);
  run_close(&r);
}
END_TEST

/* A body in uniform motion around a periodic axis: once each block has been seen,
 * sorting anew needs nothing. */
START_TEST(steady_resorts) {
  run_memory memory = {0};
  run_options o = {.dim = 3, .periodic = 1, .memory = &memory};
  run_use(&o, &run_methods[_i]);
  run r;
  run_open(&r, &o);
  run_ok(&r, mpm_stepper_set_force(r.stepper, NULL, NULL));
  run_ok(&r, mpm_stepper_set_acceleration(r.stepper, NULL, NULL));
  for (int32_t face = MPM_Y_MIN; face <= MPM_Z_MAX; ++face)
    run_ok(&r, mpm_stepper_set_wall(r.stepper, face, MPM_WALL_NONE, 0.0));
  mpm_stepper_desc d;
  ck_assert_int_eq(mpm_stepper_desc_init(&d, sizeof d), MPM_OK);
  d.scheme = o.scheme;
  d.transfer = o.transfer;
  run_ok(&r, mpm_stepper_configure(r.stepper, &d));
  const double v[3] = {17.5, 0.0, 0.0};
  for (int32_t m = 0; m < 2; ++m) run_ok(&r, mpm_particles_set_all(r.set[m], "velocity", MPM_F64, 3, v));
  run_steps(&r, 45); /* once around */
  const int64_t calls = memory.calls, resorts = r.info.resorts;
  run_steps(&r, 20);
  ck_assert_int_gt(r.info.resorts, resorts);
  ck_assert_int_eq(memory.calls, calls);
  run_close(&r);
}
END_TEST

Suite *allocation_suite(void) {
  Suite *suite = suite_create("allocation");
  TCase *failing = tcase_create("failing");
  tcase_set_timeout(failing, 600);
  tcase_add_loop_test(failing, every_allocation_fails_once, 0, 5);
  tcase_add_loop_test(failing, loading_a_larger_state, 0, 3);
  suite_add_tcase(suite, failing);
  TCase *steady = tcase_create("steady");
  tcase_set_timeout(steady, 600);
  tcase_add_loop_test(steady, steady_state, 0, RUN_ALL);
  tcase_add_loop_test(steady, steady_resorts, 0, 6);
  suite_add_tcase(suite, steady);
  return suite;
}
