/* A step that fails leaves everything as it was, says why and where, and the run goes on as if nothing had
 * been tried: every way to fail, in every method, before the first step and in the middle of a run. */
#include "body.h"
#include "stepper/stepper.h"
#include "tables.h"

/* What the host's callbacks are to do wrong, and when: only in the step of this dt. */
typedef struct trouble {
  double dt;
  int64_t bad[4]; /* set, id; set, id: particles that get NaN */
  mpm_status law, force, acceleration, velocity_bc, progress, executor, motion, hook;
  int32_t law_nan, force_nan, velocity_nan, motion_nan, hook_nan;
  const mpm_particles *set[2];
  int64_t node[3]; /* index of a node that is prescribed NaN */
  int32_t runs;    /* calls of the executor left before it fails */
} trouble;
static trouble wrong;

static int32_t now(double dt) {
  return dt > 0.0 && !(dt < wrong.dt || dt > wrong.dt);
}

static mpm_status law(void *user, const mpm_material_batch *b) {
  host_neo_hookean(user, b);
  if (!now(b->dt)) return 0;
  for (int64_t i = 0; i < b->n && wrong.law_nan; ++i)
    if (b->id[i] == wrong.bad[1] || b->id[i] == wrong.bad[3])
      (wrong.law_nan == 1   ? b->stress_new
       : wrong.law_nan == 2 ? b->state_new
                            : b->wave_speed)[i] = NOT_A_NUMBER;
  return wrong.law;
}

static mpm_status force(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  if (!now(b->dt)) return 0;
  for (int64_t i = 0; i < b->n && wrong.force_nan; ++i)
    for (int32_t k = 0; k < 2; ++k)
      if (b->particles == wrong.set[wrong.bad[2 * k]] && b->id[i] == wrong.bad[2 * k + 1])
        add[(b->dim - 1) * b->ld + i] = k ? INFINITE : NOT_A_NUMBER;
  return wrong.force;
}

static mpm_status acceleration(void *user, const mpm_particle_batch *b, double *add) {
  (void)user, (void)add;
  return now(b->dt) && b->particles == wrong.set[1] ? wrong.acceleration : 0;
}

static mpm_status velocity_bc(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  if (!now(b->dt)) return 0;
  for (int64_t i = 0; i < b->n && wrong.velocity_nan; ++i) {
    if (b->position[i] < 0.3) continue;
    prescribed[i] = 1;
    velocity[i] = -INFINITE;
  }
  return wrong.velocity_bc;
}

static mpm_status motion(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n && now(b->dt) && wrong.motion_nan; ++i)
    if (b->id[i] == wrong.bad[1] || b->id[i] == wrong.bad[3]) add[i] = NOT_A_NUMBER;
  return now(b->dt) ? wrong.motion : 0;
}

static mpm_status hook(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user;
  for (int64_t i = 0; i < b->n && now(b->dt) && wrong.hook_nan; ++i)
    if (b->position[i] > 0.3) (wrong.hook_nan == 1 ? velocity : force)[i] = NOT_A_NUMBER;
  return now(b->dt) ? wrong.hook : 0;
}

static mpm_status progress(void *user, const mpm_step_info *info) {
  (void)user;
  return now(info->dt) ? wrong.progress : 0;
}

typedef struct expected {
  mpm_status cause;
  int32_t callback_status, set;
  int64_t particle; /* -2: any but none */
  const char *text;
} expected;

/* The failing step must change nothing, and report what was expected. */
static void fails(world *r, double dt, const expected *e) {
  world_bits was = world_take(r);
  const mpm_step_info before = world_info(r);
  mpm_step_info info;
  memset(&info, 0xff, sizeof info);
  info.struct_size = sizeof info;
  wrong.dt = dt;
  ck_refused(r, mpm_step(r->stepper, dt, &info), e->cause, e->text);
  ck_assert_int_eq(info.cause, e->cause);
  ck_assert_int_eq(info.callback_status, e->callback_status);
  ck_assert_int_eq(info.set, e->set);
  if (e->particle == -2)
    ck_assert_int_ge(info.particle, 0);
  else
    ck_assert_int_eq(info.particle, e->particle);
  ck_assert_double_eq(info.t, before.t);
  ck_assert_int_eq(info.step, before.step);
  ck_assert_int_eq(info.removed, before.removed);
  ck_assert_double_eq(info.dt, dt);
  ck_assert_double_eq(info.dt_suggested, 0.6 * dt);
  ck_assert_double_eq(info.kinetic_energy, before.kinetic_energy);
  ck_assert_double_eq(info.strain_energy, before.strain_energy);
  ck_assert_double_eq(info.external_work, 0.0);
  for (int32_t k = 0; k < 3; ++k) ck_assert_double_eq(info.momentum[k], before.momentum[k]);
  world_same(r, &was, e->text);
  bits_drop(&was);
  wrong.dt = 0.0;
}

/* ---- the stories ---- */
typedef void (*story_fn)(world *r);

static world_desc options_of(int32_t i, int32_t threads) {
  return world_of_body(&(body_desc){
      .dim = 1 + i / BROAD, .concurrency = threads, .stress = law, .method = *broad_methods[i % BROAD]});
}
enum { COMBINATIONS = 3 * BROAD };

static void open_for_trouble(world *r, const world_desc *d) {
  memset(&wrong, 0, sizeof wrong);
  world_open(r, d);
  wrong.set[0] = r->set[0];
  wrong.set[1] = r->set[1];
  ck_ok(r, mpm_stepper_set_force(r->stepper, force, NULL));
  ck_ok(r, mpm_stepper_set_acceleration(r->stepper, acceleration, NULL));
  ck_ok(r, mpm_stepper_set_velocity_bc(r->stepper, velocity_bc, NULL));
  ck_ok(r, mpm_stepper_set_progress(r->stepper, progress, NULL));
}

/* Three runs: one without trouble, and with it on one and three threads. */
static void tell(int32_t i, story_fn story) {
  uint64_t hash = 0;
  for (int32_t threads = 0; threads <= 3; threads += threads ? 2 : 1) {
    const world_desc o = options_of(i, threads);
    world r;
    open_for_trouble(&r, &o);
    if (threads) story(&r);
    world_steps(&r, 4);
    if (threads) story(&r);
    world_steps(&r, 3);
    if (threads)
      ck_assert_msg(world_hash(&r) == hash, "the run is not what it is without failures");
    else
      hash = world_hash(&r);
    world_close(&r);
  }
}

static int32_t has_hooks(const world *r) {
  return r->desc.body.method.scheme != MPM_NEWMARK;
}

/* Hooks and prescribed particles for the steps that fail. */
static void lead(world *r, int32_t stage) {
  uint8_t flags[3] = {stage != 0, 0, 0};
  ck_ok(r, mpm_particles_set_all(r->set[1], "prescribed", MPM_U8, r->dim, flags));
  ck_ok(r, mpm_stepper_set_motion(r->stepper, r->set[1], stage ? motion : NULL, NULL));
  for (int32_t k = MPM_AFTER_P2G; k <= MPM_AFTER_VELOCITY && has_hooks(r); ++k)
    ck_ok(r, mpm_stepper_set_node_hook(r->stepper, k, k == stage ? hook : NULL, NULL));
}

static void callbacks_refuse(world *r) {
  static const mpm_status answer[2] = {7, -3};
  for (int32_t k = 0; k < 2; ++k) {
    const mpm_status cause = k ? MPM_E_CALLBACK : MPM_CUT_DT;
    wrong.law = answer[k];
    fails(r, 0.9 * BODY_DT, &(expected){cause, answer[k], 1, -1, "material"});
    wrong.law = 0;
    wrong.force = answer[k];
    fails(r, 0.9 * BODY_DT, &(expected){cause, answer[k], 0, -1, "force"});
    wrong.acceleration = answer[1 - k]; /* of set 1: the force callback of set 0 comes first */
    fails(r, 0.9 * BODY_DT, &(expected){cause, answer[k], 0, -1, "force"});
    wrong.force = 0;
    fails(r, 0.9 * BODY_DT,
          &(expected){k ? MPM_CUT_DT : MPM_E_CALLBACK, answer[1 - k], 1, -1, "acceleration"});
    wrong.acceleration = 0;
    wrong.velocity_bc = answer[k];
    fails(r, 0.9 * BODY_DT, &(expected){cause, answer[k], -1, -1, "velocity"});
    wrong.velocity_bc = 0;
    wrong.progress = answer[k];
    fails(r, 0.9 * BODY_DT, &(expected){k ? MPM_E_CALLBACK : MPM_CANCELLED, answer[k], -1, -1, "progress"});
    wrong.progress = 0;
    for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY; ++stage) {
      lead(r, stage);
      wrong.hook = answer[k];
      if (has_hooks(r)) fails(r, 0.9 * BODY_DT, &(expected){cause, answer[k], -1, -1, "the hook after"});
      wrong.hook = 0;
    }
    wrong.motion = answer[k];
    fails(r, 0.9 * BODY_DT, &(expected){cause, answer[k], 1, -1, "motion"});
    wrong.motion = 0;
    lead(r, 0);
  }
}
START_TEST(refusing_callbacks) {
  tell(_i, callbacks_refuse);
}
END_TEST

/* The id with number k of a set, counted from the first or, negative, the last. */
static int64_t id_of(const world *r, int32_t m, int64_t k) {
  const int64_t n = mpm_particles_count(r->set[m]);
  int64_t *ids = fetch_ids(r, r->set[m]);
  const int64_t id = ids[k < 0 ? n + k : k];
  free(ids);
  return id;
}

/* Bad particles far apart, in other blocks and tasks: the smallest (set, id) is reported. */
static void nan_from_callbacks(world *r) {
  wrong.force_nan = 1;
  memcpy(wrong.bad, (int64_t[]){1, id_of(r, 1, 2), 0, id_of(r, 0, -3)}, sizeof wrong.bad);
  fails(r, 0.8 * BODY_DT, &(expected){MPM_NONFINITE, 0, 0, wrong.bad[3], "force"});
  memcpy(wrong.bad, (int64_t[]){1, id_of(r, 1, -2), 1, id_of(r, 1, 3)}, sizeof wrong.bad);
  fails(r, 0.8 * BODY_DT, &(expected){MPM_NONFINITE, 0, 1, wrong.bad[3], "force"});
  wrong.force_nan = 0;
  for (wrong.law_nan = 1; wrong.law_nan <= 3; ++wrong.law_nan)
    fails(r, 0.8 * BODY_DT, &(expected){MPM_NONFINITE, 0, 1, wrong.bad[3], "material"});
  wrong.law_nan = 0;
  wrong.velocity_nan = 1;
  fails(r, 0.8 * BODY_DT, &(expected){MPM_NONFINITE, 0, -1, -1, "velocity"});
  wrong.velocity_nan = 0;
  for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY; ++stage) {
    lead(r, stage);
    const int32_t kinds = !has_hooks(r) ? 0 : stage == MPM_AFTER_VELOCITY ? 1 : 2;
    for (wrong.hook_nan = 1; wrong.hook_nan <= kinds; ++wrong.hook_nan)
      fails(r, 0.8 * BODY_DT, &(expected){MPM_NONFINITE, 0, -1, -1, "of the hook after"});
  }
  wrong.hook_nan = 0;
  wrong.motion_nan = 1;
  fails(r, 0.8 * BODY_DT, &(expected){MPM_NONFINITE, 0, 1, wrong.bad[3], "prescribed velocity"});
  wrong.motion_nan = 0;
  lead(r, 0);
}
START_TEST(values_not_finite) {
  tell(_i, nan_from_callbacks);
}
END_TEST

/* Everything falls towards its middle along x, at a rate that turns it inside out within COLLAPSE_DT. */
#define COLLAPSE_DT 3e-3
static void collapse(world *r) {
  double low = INFINITE, high = -INFINITE;
  double *x[2];
  const int32_t dim = r->dim;
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r->set[m]);
    x[m] = fetch(r, r->set[m], "position", dim);
    for (int64_t i = 0; i < n; ++i) {
      low = fmin(low, x[m][i]);
      high = fmax(high, x[m][i]);
    }
  }
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r->set[m]);
    double *v = calloc((size_t)(n * dim), sizeof *v);
    for (int64_t i = 0; i < n; ++i) v[i] = -1.5 / COLLAPSE_DT * (x[m][i] - 0.5 * (low + high));
    put(r, r->set[m], "velocity", dim, v);
    free(x[m]);
    free(v);
  }
}

START_TEST(inversion) {
  mpm_step_info info[2];
  uint64_t hash[3];
  for (int32_t k = 0; k < 3; ++k) {
    const world_desc o = options_of(_i, k == 1 ? 3 : 1);
    if (o.stepper.scheme == MPM_NEWMARK) return; /* iterations look for a way around */
    world r;
    open_for_trouble(&r, &o);
    collapse(&r);
    if (k < 2) { /* at the first step: nothing is known yet of stresses */
      fails(&r, COLLAPSE_DT, &(expected){MPM_INVERTED, 0, 0, -2, "det F"});
      info[k] = world_info(&r);
    }
    for (int32_t i = 0; i < 2; ++i) world_step(&r, 0.01 * COLLAPSE_DT);
    if (k < 2) fails(&r, COLLAPSE_DT, &(expected){MPM_INVERTED, 0, 0, -2, "det F"});
    for (int32_t i = 0; i < 2; ++i) world_step(&r, 0.01 * COLLAPSE_DT);
    hash[k] = world_hash(&r);
    world_close(&r);
  }
  ck_assert_int_eq(info[0].particle, info[1].particle);
  ck_assert(hash[0] == hash[2] && hash[1] == hash[2]);
}
END_TEST

/* det(I + dt L) of all particles of a set, with L from a step so short that nothing moves. */
static double *determinants(world *r, int32_t m) {
  const int64_t n = mpm_particles_count(r->set[m]);
  double *L = fetch(r, r->set[m], "velocity_gradient", 9), *det = malloc((size_t)n * sizeof *det);
  for (int64_t i = 0; i < n; ++i) {
    double F[9];
    for (int32_t c = 0; c < 9; ++c) F[c] = (c % 4 == 0 ? 1.0 : 0.0) + COLLAPSE_DT * L[c * n + i];
    det[i] = determinant(F);
  }
  free(L);
  return det;
}

/* Of all particles that turn inside out the first is reported, wherever it lies: a twin tells which do. */
START_TEST(first_of_the_inverted) {
  const world_desc o = options_of(_i, 3);
  if (o.stepper.transfer != MPM_FLIP) return;  /* others keep another matrix than L */
  if (o.stepper.scheme == MPM_NEWMARK) return; /* iterations look for a way around */
  const double zero[9] = {0.0};
  world r, twin;
  open_for_trouble(&twin, &o);
  collapse(&twin);
  for (int32_t m = 0; m < 2; ++m)
    ck_ok(&twin, mpm_particles_set_all(twin.set[m], "velocity_gradient", MPM_F64, 9, zero));
  world_step(&twin, 1e-9 * COLLAPSE_DT);
  open_for_trouble(&r, &o);
  collapse(&r);
  mpm_step_info info = {.struct_size = sizeof info};
  ck_refused(&r, mpm_step(r.stepper, COLLAPSE_DT, &info), MPM_INVERTED, "det F");
  double *det = determinants(&twin, info.set);
  int64_t i = 0;
  for (; id_of(&r, info.set, i) < info.particle; ++i)
    ck_assert_msg(det[i] > -0.01, "particle %lld has det %g", (long long)id_of(&r, info.set, i), det[i]);
  ck_assert_int_eq(id_of(&r, info.set, i), info.particle);
  ck_assert_double_lt(det[i], 0.01);
  ck_assert_int_eq(info.set, 0);
  free(det);
  world_close(&r);
  world_close(&twin);
}
END_TEST

/* ---- off the grid ---- */
/* One particle of each set flies out far ahead of all others; a wall does not hold what jumps over it. */
static void fly(world *r, const int64_t *id, int32_t face) {
  const int32_t axis = face / 2, dim = r->dim;
  for (int32_t m = 0; m < 2; ++m) {
    double v[3];
    ck_ok(r, mpm_particles_get(r->set[m], "velocity", MPM_F64, dim, 1, &id[m], v));
    v[axis] = face % 2 ? 4e4 : -4e4;
    ck_ok(r, mpm_particles_set(r->set[m], "velocity", MPM_F64, dim, 1, &id[m], v));
  }
}

START_TEST(off_the_grid) {
  for (int32_t kind = MPM_WALL_NONE; kind <= MPM_WALL_FRICTION_NODES; ++kind) {
    if (kind == MPM_WALL_OPEN) continue;
    int64_t reported = -1;
    for (int32_t threads = 1; threads <= 3; threads += 2) {
      const world_desc o = options_of(_i, threads);
      if (o.stepper.scheme == MPM_NEWMARK)
        continue; /* what holds the particle lets the iterations fail first */
      const int32_t face = 2 * (o.grid.dim - 1) + 1;
      world r;
      open_for_trouble(&r, &o);
      ck_ok(&r, mpm_stepper_set_wall(r.stepper, face, kind, 0.2));
      world_steps(&r, 1);
      const int64_t id[2] = {id_of(&r, 0, mpm_particles_count(r.set[0]) / 2),
                             id_of(&r, 1, mpm_particles_count(r.set[1]) / 2)};
      const uint64_t calm = world_hash(&r);
      fly(&r, id, face);
      world_bits was = world_take(&r);
      mpm_step_info info = {.struct_size = sizeof info};
      const mpm_status status = mpm_step(r.stepper, 2e-3, &info);
      /* USF strains before it moves, and the flight may tear a particle's neighbourhood */
      if (o.stepper.scheme == MPM_USF && status == MPM_INVERTED)
        ck_refused(&r, status, MPM_INVERTED, "det F");
      else
        ck_refused(&r, status, MPM_OFF_GRID, "leave the grid");
      ck_assert_int_eq(info.set, 0);
      ck_assert_int_ge(info.particle, 0);
      if (threads == 1)
        reported = info.particle;
      else
        ck_assert_int_eq(info.particle, reported);
      world_same(&r, &was, "off the grid");
      ck_assert(calm != was.hash);
      bits_drop(&was);
      world_close(&r);
    }
  }
}
END_TEST

/* ---- the host's executor ---- */
static mpm_status failing_executor(void *user, int64_t count, mpm_task_fn task, void *task_data) {
  trouble *t = user;
  const int32_t fails_now = t->executor && --t->runs == 0;
  for (int64_t i = 0; i < (fails_now ? count / 2 : count); ++i) task(task_data, i);
  return fails_now ? t->executor : 0;
}

/* Fails in every call that a step makes of the executor, each in turn. */
START_TEST(executor_fails) {
  world_desc o = options_of(_i, 3);
  o.context.parallel_for = failing_executor;
  o.context.parallel_user = &wrong;
  world r;
  open_for_trouble(&r, &o);
  world_steps(&r, 2);
  world_bits was = world_take(&r);
  int32_t failures = 0;
  wrong.executor = 5;
  for (int32_t k = 1; k < 200; ++k) {
    mpm_step_info info = {.struct_size = sizeof info};
    wrong.runs = k;
    const mpm_status status = mpm_step(r.stepper, BODY_DT, &info);
    if (status == MPM_OK) break;
    ++failures;
    ck_assert_int_eq(status, MPM_E_CALLBACK);
    ck_assert_int_eq(info.cause, MPM_E_CALLBACK);
    wrong.executor = 0;
    world_same(&r, &was, "executor");
    wrong.executor = 5;
  }
  ck_assert_int_ge(failures, 5);
  bits_drop(&was);
  wrong.executor = 0;
  world_steps(&r, 2);
  const uint64_t hash = world_hash(&r);
  world_close(&r);
  open_for_trouble(&r, &o);
  world_steps(&r, 5);
  ck_assert(world_hash(&r) == hash);
  world_close(&r);
}
END_TEST

/* Moves all particles by three cells along the first axis, or by as much as there is room for. */
static void carry(const world *r, int32_t dim) {
  const double end = body_origin[0] + body_spacing[0] * (double)body_cells[dim - 1][0];
  double last = body_origin[0], x[3];
  for (int32_t pass = 0; pass < 2; ++pass)
    for (int32_t m = 0; m < 2; ++m)
      for (int64_t i = 0; i < mpm_particles_count(r->set[m]); ++i) {
        const int64_t id = id_of(r, m, i);
        ck_ok(r, mpm_particles_get(r->set[m], "position", MPM_F64, dim, 1, &id, x));
        last = fmax(last, x[0]);
        if (!pass) continue;
        x[0] += fmin(3.0 * body_spacing[0], 0.9 * (end - last));
        ck_ok(r, mpm_particles_set(r->set[m], "position", MPM_F64, dim, 1, &id, x));
      }
}

static double mass_of_particles(const world *r) {
  double sum = 0.0, mass;
  for (int32_t m = 0; m < 2; ++m)
    for (int64_t i = 0; i < mpm_particles_count(r->set[m]); ++i) {
      const int64_t id = id_of(r, m, i);
      ck_ok(r, mpm_particles_get(r->set[m], "mass", MPM_F64, 1, 1, &id, &mass));
      sum += mass;
    }
  return sum;
}

/* The same in the first step after particles have been sorted anew, between walls: the step after that leaves
 * no mass of the old arrangement on nodes that nobody meets any more. */
START_TEST(executor_fails_after_a_sort) {
  const int32_t dim = 1 + _i;
  int32_t failures = 0;
  for (int32_t k = 1; k < 200; ++k) {
    world_desc o = options_of(_i * BROAD, 3);
    o.context.parallel_for = failing_executor;
    o.context.parallel_user = &wrong;
    world r;
    open_for_trouble(&r, &o);
    body_calm(&r);
    world_walls(&r, MPM_WALL_SLIP, 0.0);
    world_steps(&r, 2);
    carry(&r, dim);
    wrong.executor = 5;
    wrong.runs = k;
    const mpm_status status = mpm_step(r.stepper, BODY_DT, NULL);
    wrong.executor = 0;
    if (status) ck_ok(&r, mpm_step(r.stepper, BODY_DT, NULL));
    const mpmi_nodal *nodes = &r.stepper->nodes.solved;
    double mass = 0.0;
    for (int64_t slot = 0; slot < mpmi_slots(&r.stepper->layout); ++slot) mass += *mpmi_mass(nodes, slot);
    const double all = mass_of_particles(&r);
    ck_assert_double_eq_tol(mass, all, 1e-12 * all);
    world_close(&r);
    failures += status != MPM_OK;
    if (wrong.runs > 0) break; /* the step has made fewer calls */
  }
  ck_assert_int_ge(failures, 3);
}
END_TEST

Suite *rollback_suite(void) {
  Suite *suite = suite_create("rollback");
  TCase *tests = tcase_create("rollback"), *wide = wide_case(suite, "more combinations");
  tcase_set_timeout(tests, 300);
  add_table(tests, wide, refusing_callbacks, COMBINATIONS);
  add_table(tests, wide, values_not_finite, COMBINATIONS);
  add_table(tests, wide, inversion, COMBINATIONS);
  add_table(tests, wide, first_of_the_inverted, COMBINATIONS);
  add_table(tests, wide, off_the_grid, COMBINATIONS);
  add_table(tests, wide, executor_fails, COMBINATIONS);
  tcase_add_loop_test(tests, executor_fails_after_a_sort, 0, 3);
  suite_add_tcase(suite, tests);
  return suite;
}
