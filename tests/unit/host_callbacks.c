/* A host that sets every callback there is; what environment its callbacks find, and what becomes of that
 * which they leave behind. */
#define _GNU_SOURCE
#include <fenv.h>

#include "host_parts.h"
#include "reference.h"

visits host_visits;

static void visit(int32_t kind) {
  ++host_visits.seen[kind];
  if (host_visits.visit) host_visits.visit(kind);
}

/* ---- the callbacks ---- */
static mpm_status law(void *user, const mpm_material_batch *b) {
  static reference_law elastic = {.E = 1e5, .nu = 0.3, .wave_speed = 12.0};
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) b->energy[p] = 0.0;
  const mpm_status status = reference_law_stress(&elastic, b);
  visit(FROM_LAW);
  return status;
}

/* That of linear elasticity is near enough for a small strain. */
static mpm_status tangent(void *user, const mpm_material_batch *b, double *C, int32_t *symmetric) {
  const double lambda = 1e5 * 0.3 / (1.3 * 0.4), mu = 1e5 / 2.6;
  (void)user;
  *symmetric = 1;
  for (int32_t i = 0; i < 36; ++i)
    for (int64_t p = 0; p < b->n; ++p)
      C[i * b->ld + p] = (i / 6 < 3 && i % 6 < 3 ? lambda : 0.0) + (i % 7 ? 0.0 : i < 21 ? 2.0 * mu : mu);
  visit(FROM_TANGENT);
  return MPM_OK;
}

static mpm_status inside(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                         uint8_t *in) {
  (void)user, (void)dim, (void)ld, (void)position;
  memset(in, 1, (size_t)n);
  visit(FROM_INSIDE);
  return MPM_OK;
}

static mpm_status take_bytes(void *user, const void *data, int64_t bytes) {
  (void)user, (void)data;
  visit(FROM_WRITE);
  return bytes > 0 ? MPM_OK : MPM_E_ARG;
}

static void take_log(void *user, int32_t level, const char *text) {
  (void)user, (void)level, (void)text;
  visit(FROM_LOG);
}

static mpm_status progress(void *user, const mpm_step_info *info) {
  (void)user, (void)info;
  visit(FROM_PROGRESS);
  return MPM_OK;
}

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  for (int64_t p = 0; p < b->n; ++p) add[p] += 1e-3 / 3.0 * (double)(b->id[p] % 5);
  visit(*(const int32_t *)user);
  return MPM_OK;
}
static const int32_t from_force = FROM_FORCE, from_acceleration = FROM_ACCELERATION,
                     from_motion = FROM_MOTION;

static mpm_status hold(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    if (b->index[i] == 4) prescribed[i] = 1, velocity[i] = 0.01 / 3.0;
  visit(FROM_VELOCITY);
  return MPM_OK;
}

static mpm_status hook(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user, (void)force;
  for (int64_t i = 0; i < b->n; ++i) velocity[i] *= 0.999;
  visit(FROM_HOOK);
  return MPM_OK;
}

static mpm_status rub(void *user, const mpm_contact_batch *b, double *friction) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) friction[i] = 1.0 / 3.0;
  visit(FROM_FRICTION);
  return MPM_OK;
}

static double dot(int64_t n, const double *a, const double *b) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

/* Conjugate gradients. */
static mpm_status solve(void *user, const mpm_operator *matrix, const double *rhs, double *x,
                        double tolerance, int64_t *iterations) {
  (void)user;
  mpm_operator_info info = {.struct_size = sizeof info};
  ck_assert_int_eq(mpm_operator_get_info(matrix, &info), MPM_OK);
  const int64_t n = info.rows;
  double *r = malloc((size_t)(3 * n) * sizeof *r), *p = r + n, *Ap = p + n;
  for (int64_t i = 0; i < n; ++i) x[i] = 0.0, r[i] = p[i] = rhs[i];
  double rr = dot(n, r, r);
  for (const double end = 1e-4 * tolerance * tolerance * rr; rr > end && *iterations < 10 * n;
       ++*iterations) {
    ck_assert_int_eq(mpm_operator_apply(matrix, p, Ap), MPM_OK);
    const double a = rr / dot(n, p, Ap), was = rr;
    for (int64_t i = 0; i < n; ++i) x[i] += a * p[i], r[i] -= a * Ap[i];
    rr = dot(n, r, r);
    for (int64_t i = 0; i < n; ++i) p[i] = r[i] + rr / was * p[i];
  }
  free(r);
  visit(FROM_SOLVER);
  return MPM_OK;
}

static mpm_status run_tasks(void *user, int64_t count, mpm_task_fn task, void *data) {
  (void)user;
  for (int64_t k = 0; k < count; ++k) task(data, k);
  visit(FROM_EXECUTOR);
  return MPM_OK;
}

static void *give_memory(void *user, size_t bytes, size_t alignment) {
  (void)user;
  visit(FROM_ALLOC);
  return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}
static void take_memory(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)user, (void)bytes, (void)alignment;
  visit(FROM_RELEASE);
  free(memory);
}

static void release_user(void *user) {
  (void)user;
  visit(FROM_RELEASE_USER);
}

/* ---- the host ---- */
void every_callback_open(world *w, int32_t scheme) {
  static const uint8_t all[2] = {1, 1};
  const int32_t implicit = scheme == MPM_NEWMARK;
  world_desc d = world_default(2, 12, 0.1);
  d.context.concurrency = 2;
  d.context.parallel_for = run_tasks;
  d.context.alloc = give_memory;
  d.context.release = take_memory;
  d.context.log = take_log;
  d.stepper.scheme = scheme;
  d.stepper.linear_solver = implicit ? MPM_SOLVER_HOST : MPM_SOLVER_AUTO;
  d.law = (world_law){.density = 1e3, .stress = law, .tangent = tangent};
  world_open(w, &d);
  mpm_particles *led =
      world_add_set(w, &(world_law){.model = "neo_hookean", .E = 1e5, .nu = 0.3, .density = 1e3});
  world_fill_cube(w, w->set[0], 0.3, 0.6);
  world_fill_cube(w, led, 0.7, 0.8);
  ck_ok(w, mpm_particles_set_all(led, "prescribed", MPM_U8, 2, all));
  ck_ok(w, mpm_stepper_set_motion(w->stepper, led, push, (void *)(uintptr_t)&from_motion));
  ck_ok(w, mpm_stepper_set_force(w->stepper, push, (void *)(uintptr_t)&from_force));
  ck_ok(w, mpm_stepper_set_acceleration(w->stepper, push, (void *)(uintptr_t)&from_acceleration));
  ck_ok(w, mpm_stepper_set_velocity_bc(w->stepper, hold, NULL));
  ck_ok(w, mpm_stepper_set_progress(w->stepper, progress, NULL));
  ck_ok(w, mpm_stepper_set_linear_solver(w->stepper, solve, NULL));
  for (int32_t at = MPM_AFTER_P2G; at <= MPM_AFTER_VELOCITY && !implicit; ++at)
    ck_ok(w, mpm_stepper_set_node_hook(w->stepper, at, hook, NULL));
  if (implicit) return;
  mpm_contact_desc contact;
  ck_ok(w, mpm_contact_desc_init(&contact, sizeof contact));
  contact.offset = 0.2; /* they are half of that apart */
  ck_ok(w, mpm_stepper_set_body(w->stepper, led, 1));
  ck_ok(w, mpm_stepper_set_contact(w->stepper, 0, 1, &contact));
  ck_ok(w, mpm_stepper_set_friction(w->stepper, rub, NULL));
}

static uint64_t mix(uint64_t h, const void *data, size_t bytes) {
  const unsigned char *at = data;
  for (size_t i = 0; i < bytes; ++i) h = mixed(h ^ at[i]);
  return h;
}

/* After F was set the law is asked by whatever call needs the stress. What is computed here is exact, because
 * a test may round otherwise. */
static void stretch(world *w, int32_t k) {
  const double s = 1.0 + k / 1024.0, F[9] = {s, 0, 0, 0, 1, 0, 0, 0, 1};
  ck_ok(w, mpm_particles_set_all(w->set[0], "deformation_gradient", MPM_F64, 9, F));
}

uint64_t every_callback_story(world *w) {
  static const double lower[] = {0.6, 0.3}, upper[] = {0.65, 0.5};
  static const int32_t per_cell[] = {2, 2};
  mpm_particles *set = w->set[0];
  const int64_t n = mpm_particles_count(set), gone = 3;
  char path[256];
  double dt, *stress = malloc((size_t)(6 * n) * sizeof *stress);
  uint64_t h = 0, hash;
  mpm_view view = {.struct_size = sizeof view};
  mpm_step_info info = {.struct_size = sizeof info};
  stretch(w, 1);
  ck_ok(w, mpm_stable_dt(w->stepper, &dt));
  h = mix(h, &dt, sizeof dt);
  stretch(w, 2);
  ck_ok(w, mpm_particles_get(set, "stress", MPM_F64, 6, n, NULL, stress));
  h = mix(h, stress, (size_t)(6 * n) * sizeof *stress);
  free(stress);
  stretch(w, 3);
  ck_ok(w, mpm_particles_map(set, "stress", MPM_READ, &view));
  ck_ok(w, mpm_view_release(&view));
  stretch(w, 4);
  ck_ok(w, mpm_stepper_info(w->stepper, &info));
  stretch(w, 5);
  ck_ok(w, mpm_state_hash(w->stepper, &hash));
  stretch(w, 6);
  ck_ok(w, mpm_state_save_file(w->stepper, scratch_path("host.state", path, sizeof path)));
  stretch(w, 7);
  ck_ok(w, mpm_write_particles(set, scratch_path("host.vtp", path, sizeof path), 0, NULL));
  stretch(w, 8);
  ck_ok(w, mpm_state_save_to(w->stepper, take_bytes, NULL));
  stretch(w, 9);
  ck_ok(w, mpm_write_particles_to(set, take_bytes, NULL, 0, NULL));
  stretch(w, 3);
  ck_ok(w, mpm_particles_fill(set, lower, upper, per_cell, inside, NULL, NULL, NULL));
  for (int32_t i = 0; i < 3; ++i) ck_ok(w, mpm_step(w->stepper, 1e-4, &info));
  if (w->desc.stepper.scheme != MPM_NEWMARK) world_staged_step(w, 1e-4);
  ck_ok(w, mpm_particles_remove(set, 1, &gone));
  mpm_advance_desc go = advance_desc(8e-4);
  go.dt_max = 1e-4;
  ck_ok(w, mpm_advance(w->stepper, &go, &info));
  ck_ok(w, mpm_write_grid(w->stepper, scratch_path("host.vti", path, sizeof path), 0, NULL));
  ck_ok(w, mpm_write_grid_to(w->stepper, 0, take_bytes, NULL, 0, NULL));
  ck_ok(w, mpm_state_load_file(w->stepper, scratch_path("host.state", path, sizeof path)));
  ck_ok(w, mpm_step(w->stepper, 1e-4, &info));
  mpm_material *material;
  mpm_material_desc d = material_desc(1.0, law, NULL);
  d.release_user = release_user;
  ck_ok(w, mpm_material_create_custom(w->context, &d, &material));
  ck_ok(w, mpm_material_destroy(material));
  ck_ok(w, mpm_state_hash(w->stepper, &hash));
  return mix(h, &hash, sizeof hash);
}

/* ---- their environment ---- */
static int32_t spoils;

static void look_around(int32_t kind) {
  if (fegetround() != FE_TONEAREST) ck_abort_msg("kind %d: rounding %x", (int)kind, (unsigned)fegetround());
#if defined(__GLIBC__)
  if (fegetexcept()) ck_abort_msg("kind %d: traps %x", (int)kind, (unsigned)fegetexcept());
#endif
  if (!spoils) return;
  feraiseexcept(FE_INVALID | FE_DIVBYZERO);
  fesetround(FE_UPWARD);
}

/* In a host that rounds downward and has traps they find the default, and may leave anything behind. */
START_TEST(callbacks_find_the_default) {
  static const int32_t schemes[] = {MPM_USL, MPM_NEWMARK};
  world w;
  host_visits = (visits){0};
  every_callback_open(&w, schemes[_i]);
  const uint64_t wanted = every_callback_story(&w);
  world_close(&w);
  for (spoils = 0; spoils <= 1; ++spoils) {
    host_visits = (visits){0};
    every_callback_open(&w, schemes[_i]);
    host_visits.visit = look_around;
    feclearexcept(FE_ALL_EXCEPT);
    fesetround(FE_DOWNWARD);
    const uint64_t hash = every_callback_story(&w);
    const int rounding = fegetround(), flags = fetestexcept(FE_INVALID | FE_DIVBYZERO);
    fesetround(FE_TONEAREST);
    host_visits.visit = NULL;
    ck_assert_int_eq(rounding, FE_DOWNWARD);
    ck_assert_int_eq(flags, 0);
    ck_assert_uint_eq(hash, wanted);
    for (int32_t k = 0; k < KINDS; ++k) {
      const int32_t none = _i ? k == FROM_HOOK || k == FROM_FRICTION : k == FROM_TANGENT || k == FROM_SOLVER;
      ck_assert_msg(none || host_visits.seen[k] > 0, "kind %d was never called", (int)k);
    }
    world_close(&w);
  }
}
END_TEST

TCase *host_callbacks_case(void) {
  TCase *tests = tcase_create("callbacks");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, callbacks_find_the_default, 0, 2);
  return tests;
}
