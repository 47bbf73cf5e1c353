/* Memory that runs out: every allocation of a whole run fails once, the call that needed it says so and
 * changes nothing, and the same call succeeds when memory is there again. In the steady state nothing is
 * allocated. */
#include "body.h"
#include "context/context.h"
#include "material/material.h"

enum { STEPS = 15, SAVED_AT = 6 };

/* A call of the script that may fail, and what it works on. */
typedef struct script {
  world r;
  char *state;
  int64_t bytes;
  int32_t failures;
} script;
typedef mpm_status (*part_fn)(script *s);

static mpm_status open_part(script *s) {
  return world_try_open(&s->r);
}
static mpm_status step_part(script *s) {
  return mpm_step(s->r.stepper, BODY_DT, &s->r.info);
}
static mpm_status staged_part(script *s) {
  mpm_status status = mpm_step_begin(s->r.stepper, BODY_DT);
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
  ck_ok(&s->r, mpm_view_release(&view));
  status = mpm_grid_map(s->r.stepper, 0, "velocity", MPM_READ, &view);
  if (!status) ck_ok(&s->r, mpm_view_release(&view));
  return status;
}
static mpm_status wall_part(script *s) {
  return mpm_stepper_set_wall(s->r.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0);
}
/* velocity_gradient and acceleration come into being, and the law is asked for the state as it is */
static mpm_status field_part(script *s) {
  const int64_t n = mpm_particles_count(s->r.set[0]);
  double *L = fetch(&s->r, s->r.set[0], "velocity_gradient", 9);
  mpm_status status = mpm_particles_set(s->r.set[0], "velocity_gradient", MPM_F64, 9, n, NULL, L);
  free(L);
  const double zero[3] = {0.0, 0.0, 0.0};
  if (!status) status = mpm_particles_set_all(s->r.set[0], "applied_force", MPM_F64, s->r.dim, zero);
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
  x[0] = s->r.dim == 2 ? 1.2 : 0.2;
  return mpm_particles_add(s->r.set[0], 1, x, v, &volume, NULL, &id, NULL);
}
static mpm_status law_part(script *s) {
  double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, stress[6] = {0.0}, state[2] = {0.0}, c[81];
  const mpm_material_batch batch = {.struct_size = sizeof batch,
                                    .state_count = s->r.material[0]->state_count,
                                    .n = 1,
                                    .ld = 1,
                                    .dt = 1.0,
                                    .F = F,
                                    .F_inc = F,
                                    .stress = stress,
                                    .state = state,
                                    .stress_new = stress,
                                    .state_new = state};
  return mpm_material_update(s->r.material[0], &batch, c, NULL);
}
static mpm_status references_part(script *s) {
  mpm_stepper_desc d = body_stepper(&s->r);
  d.reference_positions = 1;
  d.local_damping = d.scheme == MPM_NEWMARK ? 0.0 : 0.1;
  return mpm_stepper_configure(s->r.stepper, &d);
}
static mpm_status ground_part(script *s) {
  return mpm_particles_set_geostatic(s->r.set[0], s->r.dim - 1, -0.1, 100.0, 1.0, 0.0);
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
  scratch_path("allocation.state", path, sizeof path);
  mpm_status status = mpm_state_save_file(s->r.stepper, path);
  return status ? status : mpm_state_load_file(s->r.stepper, path);
}

/* A failing call leaves the run as it was, and is repeated: then it must succeed. */
static void play(script *s, part_fn part) {
  const int32_t open = part != open_part;
  const int64_t fail_at = s->r.memory.fail_at;
  world_bits was = {.hash = 0};
  if (open && fail_at > s->r.memory.calls) { /* looking at the run allocates, too */
    const int64_t before = s->r.memory.calls;
    s->r.memory.fail_at = 0;
    was = world_take(&s->r);
    s->r.memory.calls = before;
    s->r.memory.fail_at = fail_at;
  }
  const mpm_status status = part(s);
  if (status) {
    ck_refused(&s->r, status, MPM_E_NOMEM, s->r.context ? "memory" : "");
    ck_assert(s->r.memory.calls >= fail_at && fail_at > 0);
    ++s->failures;
    s->r.memory.fail_at = 0;
    if (open && part != staged_part) world_same(&s->r, &was, "out of memory");
    ck_ok(&s->r, part(s)); /* again */
  }
  bits_drop(&was);
}

/* The whole run with allocation number fail_at failing; how many there were, and the hash at the end. */
static int64_t tell(const body_desc *o, int64_t fail_at, uint64_t *hash, int32_t *failures) {
  script s = {.r = {.desc = world_of_body(o), .memory = {.fail_at = fail_at}}};
  play(&s, open_part);
  play(&s, dt_part);
  for (int32_t i = 1; i <= STEPS; ++i) {
    play(&s, i % 5 == 3 ? staged_part : step_part);
    if (i == 2) play(&s, map_part);
    if (i == 3 && !o->periodic) play(&s, wall_part);
    if (i == 4) play(&s, field_part);
    if (i == 5) play(&s, remove_part);
    if (i == SAVED_AT) play(&s, save_part);
    if (i == SAVED_AT) play(&s, load_part);
    if (i == 8) play(&s, add_part);
    if (i == 9) play(&s, references_part);
    if (i == 10) play(&s, law_part);
    if (i == 11 && !o->periodic) play(&s, ground_part);
    if (i == 11) play(&s, write_part);
  }
  const int64_t calls = s.r.memory.calls;
  *failures = s.failures;
  *hash = world_hash(&s.r);
  ck_assert_int_ge(s.r.info.resorts, 2); /* with the first sort */
  world_close(&s.r);
  free(s.state);
  return calls;
}

/* The library's own memory, below and above what large pages are for: aligned, and its to write whole. */
START_TEST(sizes_around_large_pages) {
  enum { LARGE = 1 << 21, ARRAYS = 8 };
  static const int32_t near[] = {-64, 0, 64, LARGE - 8};
  mpm_context *context;
  ck_assert_int_eq(mpm_context_create(NULL, &context), MPM_OK);
  char *array[ARRAYS];
  for (int32_t k = 0; k < ARRAYS; ++k) {
    const size_t bytes = (size_t)(LARGE + near[k % 4]);
    array[k] = mpmi_alloc(context, bytes);
    ck_assert_ptr_nonnull(array[k]);
    ck_assert_uint_eq((uintptr_t)array[k] % MPMI_ALIGNMENT, 0);
    memset(array[k], k, bytes);
  }
  for (int32_t k = 0; k < ARRAYS; ++k) {
    const size_t bytes = (size_t)(LARGE + near[k % 4]);
    ck_assert_int_eq(array[k][0], k);
    ck_assert_int_eq(array[k][bytes - 1], k);
    mpmi_free(context, array[k], bytes);
  }
  int64_t held, peak;
  ck_assert_int_eq(mpm_context_memory(context, &held, &peak), MPM_OK);
  ck_assert(peak > ARRAYS * (int64_t)LARGE && held < LARGE);
  mpm_context_destroy(context);
}
END_TEST

START_TEST(every_allocation_fails_once) {
  static const body_desc cases[] = {
      {.dim = 2,
       .method.basis = MPM_BSPLINE2,
       .method.scheme = MPM_MUSL,
       .method.transfer = MPM_APIC,
       .velocity_bc = 1},
      {.dim = 1,
       .method.basis = MPM_LINEAR,
       .method.scheme = MPM_USL,
       .method.transfer = MPM_FLIP,
       .concurrency = 2},
      {.dim = 3, .method.basis = MPM_BSPLINE2, .method.scheme = MPM_USL, .method.transfer = MPM_APIC_MLS},
      {.dim = 1,
       .method.basis = MPM_BSPLINE2,
       .method.scheme = MPM_MUSL,
       .method.transfer = MPM_FLIP,
       .periodic = 1,
       .stress = host_neo_hookean},
      {.dim = 2,
       .method.basis = MPM_BSPLINE2,
       .method.scheme = MPM_MUSL,
       .method.transfer = MPM_APIC_MLS,
       .led = 1}};
  uint64_t wanted, hash;
  int32_t failures, all = 0;
  const int64_t calls = tell(&cases[_i], 0, &wanted, &failures);
  ck_assert_int_eq(failures, 0);
  ck_assert_int_gt(calls, 100);
  for (int64_t k = 1; k <= calls; ++k) {
    tell(&cases[_i], k, &hash, &failures);
    ck_assert_int_le(failures, 1);
    ck_assert_msg(hash == wanted, "without allocation %lld the run is another", (long long)k);
    all += failures;
  }
  ck_assert_int_ge(all, calls - calls / 20); /* looking at the run spares it some */
}
END_TEST

/* A small run that is to take over a large state, and fails at it, goes on as the small one that it was. */
START_TEST(loading_a_larger_state) {
  body_desc o = {.dim = 1 + _i};
  const double x[3] = {0.25, 0.75, 0.4}, volume = 1e-3;
  world large, small;
  uint64_t hash = 0;
  int32_t failures = 0;
  body_open(&large, &o);
  world_steps(&large, 2);
  const saved_state state = world_save(&large);
  world_steps(&large, 3);
  o.empty = 1;
  for (int64_t k = 0;; ++k) { /* k = 0: nothing is loaded */
    body_open(&small, &o);
    ck_ok(&small, mpm_particles_add(small.set[1], 1, x, NULL, &volume, NULL, NULL, NULL));
    world_steps(&small, 2);
    small.memory.fail_at = k ? small.memory.calls + k : 0;
    const mpm_status status = k ? mpm_state_load(small.stepper, state.data, state.bytes) : MPM_OK;
    small.memory.fail_at = 0;
    if (k && !status) break;
    if (k) ck_assert_int_eq(status, MPM_E_NOMEM);
    failures += k > 0;
    world_steps(&small, 3);
    if (k)
      ck_assert_msg(world_hash(&small) == hash, "after failure %lld the run is another", (long long)k);
    else
      hash = world_hash(&small);
    world_close(&small);
  }
  world_steps(&small, 3);
  ck_assert(world_hash(&small) == world_hash(&large));
  ck_assert_int_gt(failures, 20);
  world_close(&small);
  world_close(&large);
  free(state.data);
}
END_TEST

/* After some steps that find how much is needed, 20 steps do without a single allocation. */
START_TEST(steady_state) {
  const body_desc o = {
      .dim = 3, .large = 1, .periodic = 1, .concurrency = 2, .led = _i % 2, .method = *broad_methods[_i]};
  if (o.method.scheme == MPM_NEWMARK) return; /* a matrix grows with its nodes */
  world r;
  body_open(&r, &o);
  world_steps(&r, 2);
  const int64_t calls = r.memory.calls, held = r.memory.held;
  int64_t bytes, peak;
  ck_ok(&r, mpm_context_memory(r.context, &bytes, &peak));
  ck_assert_int_eq(bytes, held);
  /* within one arrangement of the blocks */
  const int64_t resorts = r.info.resorts;
  for (int32_t i = 0; i < 20; ++i) world_step(&r, 0.1 * BODY_DT);
  ck_assert_int_eq(r.memory.calls, calls);
  ck_assert_int_eq(r.memory.held, held);
  ck_assert_int_eq(r.info.resorts, resorts);
  world_close(&r);
}
END_TEST

/* A body in uniform motion around a periodic axis: once each block has been seen,
 * sorting anew needs nothing. */
START_TEST(steady_resorts) {
  world r;
  body_open(&r, &(body_desc){.dim = 3, .periodic = 1, .method = *broad_methods[_i]});
  body_calm(&r);
  const double v[3] = {17.5, 0.0, 0.0};
  for (int32_t m = 0; m < 2; ++m) ck_ok(&r, mpm_particles_set_all(r.set[m], "velocity", MPM_F64, 3, v));
  world_steps(&r, 45); /* once around */
  const int64_t calls = r.memory.calls, resorts = r.info.resorts;
  world_steps(&r, 20);
  ck_assert_int_gt(r.info.resorts, resorts);
  ck_assert_int_eq(r.memory.calls, calls);
  world_close(&r);
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
  tcase_add_test(steady, sizes_around_large_pages);
  tcase_add_loop_test(steady, steady_state, 0, BROAD);
  tcase_add_loop_test(steady, steady_resorts, 0, 6);
  suite_add_tcase(suite, steady);
  return suite;
}
