/* The floating-point environment of a host is any: traps, rounding, tiny numbers flushed to zero. The library
 * neither depends on it nor leaves a trace in it. */
#define _GNU_SOURCE
#include <fenv.h>
#include <pthread.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include "combinations.h"
#include "context/context.h"
#include "host_parts.h"
#include "implicit.h"
#include "reference.h"
#include "tables.h"

enum { SPURIOUS = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };
static const int roundings[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
enum { ROUNDINGS = sizeof roundings / sizeof *roundings };

/* Only glibc can set traps. */
static int trap(int exceptions) {
#if defined(__GLIBC__)
  return feenableexcept(exceptions);
#else
  return exceptions & 0;
#endif
}
static int trapped(void) {
#if defined(__GLIBC__)
  return fegetexcept();
#else
  return 0;
#endif
}
static void trap_nothing(void) {
#if defined(__GLIBC__)
  fedisableexcept(FE_ALL_EXCEPT);
#endif
}

/* ---- traps ---- */
static reference_law elastic = {.E = 1e5, .nu = 0.3, .wave_speed = 12.0};

/* A life, in which every operation that no one asked for is deadly. */
static void live(world_desc *d, double low, double high, int32_t steps, double courant) {
  static const double velocity[3] = {0.5, -0.4, 0.3};
  char path[256];
  world w;
  feclearexcept(FE_ALL_EXCEPT);
  trap(SPURIOUS);
  mpm_particles *set = world_open(&w, d);
  world_fill_cube(&w, set, low, high);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, w.dim, velocity));
  const double p = d->law.yield_stress, stress[6] = {-p, -p, -p, 0.0, 0.0, 0.0};
  if (d->law.model && !strcmp(d->law.model, "cam_clay"))
    ck_ok(&w, mpm_particles_set_all(set, "stress", MPM_F64, 6, stress));
  for (int32_t i = 0; i < steps; ++i) world_step(&w, courant * fmin(world_stable_dt(&w), 0.01));
  world_hash(&w);
  ck_ok(&w, mpm_write_particles(set, scratch_path("host.vtp", path, sizeof path), 0, NULL));
  const saved_state state = world_save(&w);
  world_load(&w, &state);
  free(state.data);
  world_close(&w);
  trap_nothing();
  ck_assert_int_eq(fetestexcept(SPURIOUS), 0);
}

enum { SHARES = 4 };
START_TEST(explicit_steps_trap_nothing) {
  int32_t count, lived = 0;
  combination *list = list_combinations(&count);
  for (int32_t i = _i; i < count; i += SHARES) {
    const combination *c = &list[i];
    if (refusal_of(c)) continue;
    if (!getenv("MPM_FULL") && i / SHARES % 2) continue;
    world_desc d = describe_combination(c);
    d.law = (world_law){.model = law_options[c->choice[CHOOSE_LAW]].model,
                        .E = 1e5,
                        .nu = 0.3,
                        .density = 1e3,
                        .yield_stress = 10.0,
                        .hardening = 1e3,
                        .stress = reference_law_stress,
                        .user = &elastic};
    live(&d, 0.75, 1.25, 3, 0.4);
    ++lived;
  }
  free(list);
  ck_assert_int_gt(lived, 100);
}
END_TEST

START_TEST(implicit_steps_trap_nothing) {
  for (int32_t b = 0; b < IMPLICIT_BASES; ++b)
    for (int32_t law = 0; law < LAWS; ++law)
      for (int32_t solver = MPM_SOLVER_AUTO; solver <= MPM_SOLVER_GMRES; ++solver) {
        if (law && solver != MPM_SOLVER_AUTO) continue;
        const char *model = law_options[law].model;
        if (keeps_volume_alone(model) && implicit_basis(b)->basis == MPM_CPGIMP) continue;
        if (model && !strcmp(model, "rigid")) continue; /* nothing is left to be solved for */
        world_desc d = implicit_default(1 + _i, 8, 0.25, implicit_basis(b));
        d.stepper.linear_solver = solver;
        d.stepper.locking_remedy = _i > 0 && b % 2 && solver == MPM_SOLVER_AUTO; /* not symmetric */
        d.law = (world_law){.model = model,
                            .E = 1e5,
                            .nu = 0.3,
                            .density = 1e3,
                            .yield_stress = 10.0,
                            .hardening = 1e3,
                            .stress = reference_law_stress,
                            .user = &elastic};
        live(&d, 0.75, 1.25, 2, 1.0);
      }
}
END_TEST

/* ---- rounding, tiny numbers ---- */
static void flush_tiny_numbers(int32_t on) {
#if defined(__x86_64__)
  _mm_setcsr(on ? _mm_getcsr() | 0x8040u : _mm_getcsr() & ~0x8040u);
#else
  (void)on;
#endif
}

/* Sets an environment: 0 ... ROUNDINGS - 1 are roundings, the last flushes tiny numbers to zero. */
static void set_environment(int32_t which) {
  fesetround(roundings[which % ROUNDINGS]);
  flush_tiny_numbers(which == ROUNDINGS);
}

/* Some particles get numbers that are tiny. */
static void add_tiny_numbers(world *w) {
  static const double tiny[3] = {3e-310, -2e-310, 5e-310};
  enum { SOME = 6 };
  int64_t *ids = fetch_ids(w, w->set[0]);
  double velocity[3 * SOME];
  for (int32_t i = 0; i < w->dim * SOME; ++i) velocity[i] = tiny[i / SOME];
  ck_ok(w, mpm_particles_set(w->set[0], "velocity", MPM_F64, w->dim, SOME, ids, velocity));
  free(ids);
}

/* A story with a hash, of a body in an environment that is set once it is there. */
static uint64_t story(const body_desc *of, int32_t environment) {
  world w;
  mpm_status status = MPM_OK;
  uint64_t hash = 0;
  body_open(&w, of);
  add_tiny_numbers(&w);
  set_environment(environment);
  for (int32_t i = 0; i < 6 && !status; ++i) status = mpm_step(w.stepper, BODY_DT, NULL);
  if (!status) status = mpm_state_hash(w.stepper, &hash);
  set_environment(0);
  ck_ok(&w, status);
  world_close(&w);
  return hash;
}

START_TEST(every_environment_gives_the_same_bits) {
  const method *how = &methods[_i];
  for (int32_t dim = 1; dim <= 3; ++dim) {
    body_desc of = {.dim = dim,
                    .method = *how,
                    .velocity_bc = 1,
                    .led = how->scheme != MPM_NEWMARK,
                    .stress = host_neo_hookean};
    if (dim == 3 && _i % 4) continue;
    const uint64_t wanted = story(&of, 0);
    for (int32_t e = 1; e <= ROUNDINGS; ++e) ck_assert_uint_eq(story(&of, e), wanted);
    of.concurrency = 4; /* threads begin with what the thread has that starts them, whatever it sets later */
    for (int32_t e = 0; e <= ROUNDINGS; ++e) ck_assert_uint_eq(story(&of, e), wanted);
  }
}
END_TEST

/* Threads of a pool that is made in a strange environment: each takes one task, because none goes on before
 * all have one. */
enum { POOL = 4 };
typedef struct meeting {
  pthread_barrier_t all;
  int rounding[POOL], traps[POOL];
  int32_t flushes[POOL], caller[POOL];
  pthread_t self;
} meeting;

static void meet(void *data, int64_t k) {
  meeting *m = data;
  volatile double tiny = 3e-310;
  pthread_barrier_wait(&m->all);
  m->rounding[k] = fegetround();
  m->traps[k] = trapped();
  m->flushes[k] = !(tiny * 0.5 > 0.0);
  m->caller[k] = pthread_equal(pthread_self(), m->self) != 0;
}

START_TEST(pools_of_strange_hosts) {
  meeting m;
  mpm_context *context;
  mpm_context_desc desc = context_desc();
  desc.concurrency = POOL;
  ck_assert_int_eq(pthread_barrier_init(&m.all, NULL, POOL), 0);
  m.self = pthread_self();
  set_environment(1 + _i);
  trap(FE_INVALID);
  const mpm_status made = mpm_context_create(&desc, &context);
  trap_nothing();
  set_environment(0);
  ck_ok(NULL, made);
  ck_ok(context, mpmi_parallel_for(context, POOL, meet, &m));
  int32_t callers = 0;
  for (int32_t k = 0; k < POOL; ++k) {
    callers += m.caller[k];
    if (!m.caller[k]) ck_assert(m.rounding[k] == FE_TONEAREST && !m.traps[k] && !m.flushes[k]);
  }
  ck_assert_int_eq(callers, 1);
  ck_ok(context, mpm_context_destroy(context));
  pthread_barrier_destroy(&m.all);
}
END_TEST

/* Numbers that are made when objects are, and texts in files. */
static void make_all(int32_t environment, double *position, uint64_t *hash, char *file, size_t room) {
  static const mpm_param j2[] = {{"E", 7e4}, {"nu", 0.3}, {"density", 0.3}, {"yield_stress", 13.0}};
  static const double lower[] = {0.1, 0.2}, upper[] = {0.7, 0.9}, velocity[] = {0.1, 0.7};
  static const int32_t per_cell[] = {3, 3};
  char path[256];
  mpm_grid_desc g = grid_desc(2, 10, 0.1);
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
  mpm_context *context;
  mpm_step_info info = {.struct_size = sizeof info};
  scratch_path("round.vtp", path, sizeof path);
  set_environment(environment);
  mpm_status status = mpm_context_create(NULL, &context);
  if (!status) status = mpm_grid_create(context, &g, &grid);
  if (!status) status = mpm_material_create(context, "j2", j2, 4, &material);
  if (!status) status = mpm_particles_create(context, grid, material, &set);
  if (!status) status = mpm_particles_fill_box(set, lower, upper, per_cell, NULL, NULL);
  if (!status) status = mpm_particles_set_all(set, "velocity", MPM_F64, 2, velocity);
  if (!status)
    status = mpm_particles_get(set, "position", MPM_F64, 2, mpm_particles_count(set), NULL, position);
  if (!status) status = mpm_stepper_create(context, grid, NULL, &stepper);
  if (!status) status = mpm_stepper_add(stepper, set);
  if (!status) status = mpm_step(stepper, 1e-4, &info);
  if (!status) status = mpm_state_hash(stepper, hash);
  if (!status) status = mpm_write_grid(stepper, scratch_path("round.vti", path, sizeof path), 0, NULL);
  set_environment(0);
  ck_ok(context, status);
  FILE *stream = fopen(path, "rb");
  ck_assert_ptr_nonnull(stream);
  memset(file, 0, room);
  ck_assert_uint_gt(fread(file, 1, room, stream), 1000);
  fclose(stream);
  ck_ok(context, mpm_stepper_destroy(stepper));
  ck_ok(context, mpm_particles_destroy(set));
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_grid_destroy(grid));
  ck_ok(context, mpm_context_destroy(context));
}

START_TEST(creation_and_files) {
  enum { MOST = 2048, ROOM = 1 << 16 };
  static double wanted[MOST], position[MOST];
  static char first[ROOM], file[ROOM];
  uint64_t wanted_hash, hash;
  make_all(0, wanted, &wanted_hash, first, ROOM);
  for (int32_t e = 1; e <= ROUNDINGS; ++e) {
    make_all(e, position, &hash, file, ROOM);
    ck_assert(!memcmp(position, wanted, sizeof wanted));
    ck_assert_uint_eq(hash, wanted_hash);
    ck_assert(!memcmp(file, first, ROOM));
  }
}
END_TEST

/* ---- what the host finds afterwards ---- */
typedef struct strange {
  int rounding, traps, flags;
} strange;

static strange look(void) {
  const strange now = {fegetround(), trapped(), fetestexcept(FE_ALL_EXCEPT)};
  return now;
}
/* Returns what there is then: not every processor has traps. */
static strange make_strange(const strange *s) {
  feclearexcept(FE_ALL_EXCEPT);
  trap_nothing();
  feraiseexcept(s->flags); /* before the traps */
  fesetround(s->rounding);
  trap(s->traps);
  return look();
}
static void make_plain(void) {
  trap_nothing();
  fesetround(FE_TONEAREST);
  feclearexcept(FE_ALL_EXCEPT);
}

/* The call must leave the environment as it was. */
#define UNTOUCHED(s, call)                                                                                   \
  do {                                                                                                       \
    const strange was_ = make_strange(s);                                                                    \
    call;                                                                                                    \
    const strange now_ = look();                                                                             \
    make_plain();                                                                                            \
    ck_assert_msg(!memcmp(&now_, &was_, sizeof now_), "%s: rounding %x %x, traps %x %x, flags %x %x", #call, \
                  (unsigned)now_.rounding, (unsigned)was_.rounding, (unsigned)now_.traps,                    \
                  (unsigned)was_.traps, (unsigned)now_.flags, (unsigned)was_.flags);                         \
  } while (0)

START_TEST(hosts_find_their_environment) {
  /* traps are set for what has not happened: some processors would trap at once otherwise */
  const strange hosts[] = {{FE_TONEAREST, 0, 0},
                           {FE_TONEAREST, 0, FE_ALL_EXCEPT},
                           {FE_UPWARD, FE_INVALID, FE_INEXACT | FE_OVERFLOW},
                           {FE_TOWARDZERO, SPURIOUS, FE_UNDERFLOW}};
  char path[256];
  const strange *s = &hosts[_i];
  world w;
  double dt;
  uint64_t hash;
  mpm_view view = {.struct_size = sizeof view};
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_context *context;
  mpm_context_desc desc = context_desc();
  desc.concurrency = 2;
  body_open(&w, &(body_desc){.dim = 2, .stress = host_neo_hookean});
  UNTOUCHED(s, mpm_context_create(&desc, &context));
  UNTOUCHED(s, mpm_context_destroy(context));
  UNTOUCHED(s, mpm_step(w.stepper, BODY_DT, &info));
  UNTOUCHED(s, mpm_step(w.stepper, -1.0, &info));
  UNTOUCHED(s, mpm_stable_dt(w.stepper, &dt));
  UNTOUCHED(s, mpm_state_hash(w.stepper, &hash));
  UNTOUCHED(s, mpm_stepper_info(w.stepper, &info));
  UNTOUCHED(s, mpm_write_particles(w.set[0], scratch_path("host.vtp", path, sizeof path), 0, NULL));
  float *packed = malloc(2 * (size_t)mpm_particles_count(w.set[0]) * sizeof *packed);
  UNTOUCHED(s, mpm_particles_get_f32(w.set[0], 1, (const char *const[]){"velocity"}, MPM_LIBRARY_ORDER,
                                     mpm_particles_count(w.set[0]), packed));
  free(packed);
  UNTOUCHED(s, mpm_particles_map(w.set[0], "velocity", MPM_READ | MPM_WRITE, &view));
  UNTOUCHED(s, mpm_view_release(&view));
  UNTOUCHED(s, mpm_step_begin(w.stepper, BODY_DT));
  UNTOUCHED(s, mpm_step_abort(w.stepper));
  UNTOUCHED(s, mpm_step(NULL, BODY_DT, NULL));
  world_close(&w);
}
END_TEST

/* ---- the host's executor ---- */
typedef struct share {
  mpm_task_fn task;
  void *data;
  int64_t begin, end;
  int32_t environment, same;
} share;

static void *run_share(void *argument) {
  share *s = argument;
  set_environment(s->environment);
  feclearexcept(FE_ALL_EXCEPT);
  trap(SPURIOUS);
  const strange before = look();
  for (int64_t k = s->begin; k < s->end; ++k) s->task(s->data, k);
  const strange after = look();
  s->same = after.rounding == before.rounding && after.traps == before.traps && !(after.flags & SPURIOUS);
  return NULL;
}

static mpm_status strange_threads(void *user, int64_t count, mpm_task_fn task, void *data) {
  share part[2];
  pthread_t thread[2];
  for (int32_t k = 0; k < 2; ++k) {
    part[k] = (share){task, data, count * k / 2, count * (k + 1) / 2, *(int32_t *)user + k, 0};
    ck_assert_int_eq(pthread_create(&thread[k], NULL, run_share, &part[k]), 0);
  }
  for (int32_t k = 0; k < 2; ++k) ck_assert_int_eq(pthread_join(thread[k], NULL), 0);
  ck_assert(part[0].same && part[1].same);
  return MPM_OK;
}

START_TEST(threads_of_the_host) {
  int32_t environment = _i;
  body_desc of = {.dim = 2, .method = methods[_i], .stress = host_neo_hookean};
  const uint64_t wanted = story(&of, 0);
  world_desc d = world_of_body(&of);
  d.context.concurrency = 3;
  d.context.parallel_for = strange_threads;
  d.context.parallel_user = &environment;
  world w;
  world_open(&w, &d);
  add_tiny_numbers(&w);
  for (int32_t i = 0; i < 6; ++i) world_step(&w, BODY_DT);
  ck_assert_uint_eq(world_hash(&w), wanted);
  world_close(&w);
}
END_TEST

TCase *host_environment_case(void) {
  TCase *tests = tcase_create("environment");
  tcase_set_timeout(tests, 300);
  tcase_add_loop_test(tests, explicit_steps_trap_nothing, 0, SHARES);
  tcase_add_loop_test(tests, implicit_steps_trap_nothing, 0, 3);
  add_sparse(tests, every_environment_gives_the_same_bits, ALL_METHODS, 5);
  tcase_add_loop_test(tests, pools_of_strange_hosts, 0, ROUNDINGS);
  tcase_add_test(tests, creation_and_files);
  tcase_add_loop_test(tests, hosts_find_their_environment, 0, 4);
  tcase_add_loop_test(tests, threads_of_the_host, 0, 4);
  return tests;
}
