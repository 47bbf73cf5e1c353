/* What callbacks over particles are given and what becomes of their answers; when and where they run; what
 * they may not call. */
#include <pthread.h>

#include "stepper_parts.h"

static world r;

static void open_run(void) {
  body_open(&r, &(body_desc){.dim = 2});
  body_calm(&r);
}
static void close_run(void) {
  world_close(&r);
}

/* A batch is compared with what the set says of its particles before the step. */
static struct {
  world *r;
  double t, dt;
  int64_t seen[2], tensors;
  int32_t references, calls;
  int64_t *ids[2];
  double *x[2], *v[2], *mass[2], *volume[2], *F[2], *heat[2];
} known;

static void know(world *of) {
  const int32_t dim = of->dim;
  memset(&known, 0, sizeof known);
  known.r = of;
  for (int32_t m = 0; m < 2; ++m) {
    known.ids[m] = fetch_ids(of, of->set[m]);
    known.x[m] = fetch(of, of->set[m], "position", dim);
    known.v[m] = fetch(of, of->set[m], "velocity", dim);
    known.mass[m] = fetch(of, of->set[m], "mass", 1);
    known.volume[m] = fetch(of, of->set[m], "volume", 1);
    known.F[m] = fetch(of, of->set[m], "deformation_gradient", 9);
    known.heat[m] = fetch(of, of->set[m], "heat", 1);
  }
}
static void forget(void) {
  for (int32_t m = 0; m < 2; ++m) {
    free(known.ids[m]), free(known.x[m]), free(known.v[m]), free(known.mass[m]);
    free(known.volume[m]), free(known.F[m]), free(known.heat[m]);
  }
}

static const double *looked_up(const mpm_particle_batch *b, const char *field, int64_t *stride) {
  const void *data = NULL;
  ck_holds(mpm_batch_field(b->lookup, field, &data, stride) == MPM_OK);
  ck_holds(*stride >= b->n);
  return data;
}

static void check_item(const mpm_particle_batch *b, int32_t m, int64_t p, int64_t i) {
  const int64_t n = mpm_particles_count(known.r->set[m]);
  for (int32_t c = 0; c < b->dim; ++c) {
    ck_holds(b->position[c * b->ld + p] == known.x[m][c * n + i]);
    ck_holds(b->velocity[c * b->ld + p] == known.v[m][c * n + i]);
  }
  ck_holds(b->mass[p] == known.mass[m][i]);
  ck_holds(b->volume[p] == known.volume[m][i]);
  int64_t stride;
  ck_holds(looked_up(b, "heat", &stride)[p] == known.heat[m][i]);
  ck_holds(((const int64_t *)(const void *)looked_up(b, "id", &stride))[p] == b->id[p]);
  if (!known.tensors) return;
  const double *F = looked_up(b, "deformation_gradient", &stride);
  static const int32_t stored[3][9] = {{0}, {0, 1, 3, 4, 8}, {0, 1, 2, 3, 4, 5, 6, 7, 8}},
                       count[3] = {1, 5, 9};
  for (int32_t c = 0; c < count[b->dim - 1]; ++c)
    ck_holds(F[c * stride + p] == known.F[m][stored[b->dim - 1][c] * n + i]);
}

static mpm_status inspect(void *user, const mpm_particle_batch *b, double *add) {
  ck_assert_ptr_eq(user, &known);
  ck_assert_uint_eq(b->struct_size, sizeof *b);
  ck_holds(b->dim == known.r->dim);
  ck_holds(b->t == known.t); /* explicit forces: t_n */
  ck_holds(b->dt == known.dt);
  ck_assert_int_ge(b->ld, b->n);
  ck_assert(b->particles == known.r->set[0] || b->particles == known.r->set[1]);
  const int32_t m = b->particles == known.r->set[1];
  ck_holds((b->reference_position != NULL) == known.references);
  ++known.calls;
  for (int64_t p = 0; p < b->n; ++p) {
    for (int32_t c = 0; c < b->dim; ++c) ck_holds(add[c * b->ld + p] == 0.0);
    if (b->id[p] < 0) { /* inert */
      ck_holds(b->mass[p] == 0.0);
      continue;
    }
    int64_t i = 0;
    while (known.ids[m][i] != b->id[p]) ++i;
    check_item(b, m, p, i);
    ++known.seen[m];
  }
  const void *data;
  int64_t stride;
  ck_holds(mpm_batch_field(b->lookup, "warmth", &data, &stride) == MPM_E_NOT_FOUND);
  ck_holds(mpm_batch_field(NULL, "heat", &data, &stride) == MPM_E_ARG);
  ck_holds(mpm_batch_field(b->lookup, NULL, &data, &stride) == MPM_E_ARG);
  ck_holds(mpm_batch_field(b->lookup, "heat", NULL, &stride) == MPM_E_ARG);
  ck_holds(mpm_batch_field(b->lookup, "heat", &data, NULL) == MPM_E_ARG);
  return 0;
}

static void inspect_steps(world *of, int32_t references) {
  for (int32_t i = 0; i < 8; ++i) { /* over a new sort */
    know(of);
    known.references = references;
    known.t = of->info.t;
    known.dt = BODY_DT * (1.0 + 0.1 * i);
    world_step(of, known.dt);
    ck_assert_int_eq(known.seen[0], mpm_particles_count(of->set[0]));
    ck_assert_int_eq(known.seen[1], mpm_particles_count(of->set[1]));
    forget();
  }
}

START_TEST(batches) {
  world other;
  body_open(&other, &(body_desc){.dim = 1 + _i % 3, .periodic = 1});
  ck_ok(&other, mpm_stepper_set_force(other.stepper, NULL, NULL)); /* sources add to the same array */
  ck_ok(&other, mpm_stepper_set_acceleration(other.stepper, NULL, NULL));
  if (_i < 3)
    ck_ok(&other, mpm_stepper_set_force(other.stepper, inspect, &known));
  else
    ck_ok(&other, mpm_stepper_set_acceleration(other.stepper, inspect, &known));
  inspect_steps(&other, 0);
  mpm_stepper_desc d = body_stepper(&other);
  d.reference_positions = 1;
  ck_ok(&other, mpm_stepper_configure(other.stepper, &d));
  inspect_steps(&other, 1);
  world_close(&other);
}
END_TEST

/* Tensors are full in callbacks, whatever is stored. */
static mpm_status inspect_tensors(void *user, const mpm_particle_batch *b, double *add) {
  known.tensors = 1;
  return inspect(user, b, add);
}
START_TEST(stored_tensors) {
  world other;
  body_open(&other, &(body_desc){.dim = 1 + _i});
  body_calm(&other);
  world_steps(&other, 2);
  know(&other);
  known.t = other.info.t;
  known.dt = BODY_DT;
  ck_ok(&other, mpm_stepper_set_force(other.stepper, inspect_tensors, &known));
  world_step(&other, BODY_DT);
  ck_assert_int_gt(known.calls, 0);
  forget();
  world_close(&other);
}
END_TEST

/* Optional fields that nobody uses are not there to be lent. */
static mpm_status absent_fields(void *user, const mpm_particle_batch *b, double *add) {
  static const char *const field[] = {"acceleration", "applied_force", "velocity_gradient"};
  (void)add;
  for (int32_t f = 0; f < 3; ++f) {
    const void *data = NULL;
    int64_t stride;
    ck_assert_int_eq(mpm_batch_field(b->lookup, field[f], &data, &stride), MPM_E_STATE);
    ck_assert_ptr_null(data);
  }
  ++*(int32_t *)user;
  return 0;
}
START_TEST(optional_fields) {
  int32_t calls = 0;
  ck_ok(&r, mpm_stepper_set_force(r.stepper, absent_fields, &calls));
  world_steps(&r, 1);
  ck_assert_int_gt(calls, 0);
}
END_TEST

/* ---- sources add up ---- */
static mpm_status by_id(void *user, const mpm_particle_batch *b, double *add) {
  const double factor = *(double *)user;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t p = 0; p < b->n; ++p)
      add[c * b->ld + p] += factor * (double)(b->id[p] % 7 - c) * (b->id[p] < 0 ? NOT_A_NUMBER : 1.0);
  return 0;
}

/* The same force as applied_force, from the callback and, by mass, as an acceleration; inert slots may be
 * given anything. */
START_TEST(three_ways_of_a_force) {
  world way[3];
  double force = 0.125, acceleration = 0.0;
  for (int32_t k = 0; k < 3; ++k) {
    body_open(&way[k], &(body_desc){.dim = 2});
    body_calm(&way[k]);
    const double mass = fetch1(&way[k], way[k].set[0], "mass", 1, 0, 1);
    acceleration = force / mass;
    if (k == 0) ck_ok(&way[k], mpm_stepper_set_force(way[k].stepper, by_id, &force));
    if (k == 1) ck_ok(&way[k], mpm_stepper_set_acceleration(way[k].stepper, by_id, &acceleration));
    for (int32_t m = 0; m < 2 && k == 2; ++m) {
      const int64_t n = mpm_particles_count(way[k].set[m]);
      double *f = malloc((size_t)(2 * n) * sizeof *f);
      int64_t *ids = fetch_ids(&way[k], way[k].set[m]);
      for (int64_t i = 0; i < 2 * n; ++i) f[i] = force * (double)(ids[i % n] % 7 - i / n);
      put(&way[k], way[k].set[m], "applied_force", 2, f);
      free(f);
      free(ids);
    }
    world_steps(&way[k], 9);
  }
  world_agree("bodies", &way[0], &way[2], "position", 2, 0.0);
  world_agree("bodies", &way[0], &way[2], "velocity", 2, 0.0);
  world_agree("bodies", &way[0], &way[1], "position", 2, 1e-13);
  world_agree("bodies", &way[0], &way[1], "velocity", 2, 1e-13);
  /* all of them at once are the sum */
  world all;
  body_open(&all, &(body_desc){.dim = 2});
  body_calm(&all);
  double parts[2] = {0.5 * force, 0.5 * acceleration};
  ck_ok(&all, mpm_stepper_set_force(all.stepper, by_id, &parts[0]));
  ck_ok(&all, mpm_stepper_set_acceleration(all.stepper, by_id, &parts[1]));
  world_steps(&all, 9);
  world_agree("bodies", &all, &way[0], "velocity", 2, 1e-13);
  ck_ok(&all, mpm_stepper_set_force(all.stepper, NULL, NULL));
  ck_ok(&all, mpm_stepper_set_acceleration(all.stepper, NULL, NULL));
  world_steps(&all, 1);
  for (int32_t k = 0; k < 3; ++k) world_close(&way[k]);
  world_close(&all);
}
END_TEST

/* Inert slots lie among moving particles and stay at rest, or they would wander off and cause sorts. */
static mpm_status look_at_inert(void *user, const mpm_particle_batch *b, double *add) {
  const void *lent;
  int64_t stride;
  (void)add;
  ck_ok(NULL, mpm_batch_field(b->lookup, "velocity", &lent, &stride));
  const double *v = lent;
  for (int64_t p = 0; p < b->n; ++p) {
    if (b->id[p] >= 0) continue;
    ++*(int64_t *)user;
    for (int32_t c = 0; c < b->dim; ++c) ck_assert(v[c * stride + p] == 0.0);
  }
  return 0;
}

START_TEST(inert_slots_rest) {
  world other;
  int64_t seen = 0;
  body_desc o = {.dim = 1 + _i / PLAIN, .method = *broad_methods[_i % PLAIN]};
  body_open(&other, &o);
  ck_ok(&other, mpm_stepper_set_force(other.stepper, look_at_inert, &seen));
  world_steps(&other, 6);
  ck_assert_int_gt(seen, 0);
  world_close(&other);
}
END_TEST

/* ---- refusals and calls from inside ---- */
static struct {
  mpm_status answer;
  int32_t calls;
} told;
static mpm_status answering(void *user, const mpm_particle_batch *b, double *add) {
  (void)user, (void)b, (void)add;
  ++told.calls;
  return told.answer;
}

START_TEST(answers) {
  static const mpm_status answer[] = {1, 6, INT32_MAX, -1, -8, INT32_MIN};
  mpm_step_info info = {.struct_size = sizeof info};
  char text[64];
  ck_ok(&r, mpm_stepper_set_acceleration(r.stepper, answering, NULL));
  for (int32_t i = 0; i < 6; ++i) {
    told.answer = answer[i];
    snprintf(text, sizeof text, "acceleration callback returned %d for set 0", (int)answer[i]);
    ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), answer[i] > 0 ? MPM_CUT_DT : MPM_E_CALLBACK, text);
    ck_assert_int_eq(info.callback_status, answer[i]);
    ck_assert_int_eq(info.set, 0);
    ck_ok(&r, mpm_stepper_info(r.stepper, &info)); /* kept until the next step */
    ck_assert_int_eq(info.callback_status, answer[i]);
  }
  told.answer = 0;
  ck_ok(&r, mpm_step(r.stepper, BODY_DT, &info));
  ck_assert_int_eq(info.callback_status, 0);
  ck_assert_int_eq(info.set, -1);
  ck_assert_int_eq(info.cause, MPM_OK);
}
END_TEST

static mpm_status calls_the_library(void *user, const mpm_particle_batch *b, double *add) {
  world *of = user;
  const mpm_stepper_desc d = body_stepper(of);
  const mpm_advance_desc advance = advance_desc(1.0);
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_view view = {.struct_size = sizeof view};
  double dt, value[2] = {0.0, 0.0};
  uint64_t hash;
  int64_t id = 1;
  char byte;
  (void)b, (void)add;
  const mpm_status refused[] = {
      mpm_step(of->stepper, BODY_DT, NULL),
      mpm_step_begin(of->stepper, BODY_DT),
      mpm_step_grid(of->stepper),
      mpm_step_end(of->stepper, NULL),
      mpm_step_abort(of->stepper),
      mpm_advance(of->stepper, &advance, NULL),
      mpm_stepper_destroy(of->stepper),
      mpm_stepper_add(of->stepper, of->set[0]),
      mpm_stepper_remove(of->stepper, of->set[0]),
      mpm_stepper_configure(of->stepper, &d),
      mpm_stepper_set_time(of->stepper, 0.0, 0),
      mpm_stepper_set_wall(of->stepper, 0, MPM_WALL_SLIP, 0.0),
      mpm_stepper_set_force(of->stepper, NULL, NULL),
      mpm_stepper_set_acceleration(of->stepper, NULL, NULL),
      mpm_stepper_set_velocity_bc(of->stepper, NULL, NULL),
      mpm_stepper_set_progress(of->stepper, NULL, NULL),
      mpm_stable_dt(of->stepper, &dt),
      mpm_stepper_info(of->stepper, &info),
      mpm_grid_map(of->stepper, 0, "mass", MPM_READ, &view),
      mpm_state_hash(of->stepper, &hash),
      mpm_state_save(of->stepper, &byte, 1),
      mpm_state_load(of->stepper, &byte, 1),
      mpm_particles_map(of->set[0], "mass", MPM_WRITE, &view),
      mpm_particles_set(of->set[0], "velocity", MPM_F64, 2, 1, &id, value),
      mpm_particles_remove(of->set[0], 1, &id),
      mpm_particles_add(of->set[0], 1, value, NULL, value, NULL, NULL, NULL),
      mpm_particles_add_field(of->set[0], "more", MPM_F64, 1),
      mpm_particles_destroy(of->set[0]),
  };
  for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i)
    ck_assert_msg(refused[i] == MPM_E_STATE, "call %d: %s", (int)i, mpm_status_name(refused[i]));
  ck_assert_uint_eq(mpm_version(), MPM_VERSION);
  ++told.calls;
  return 0;
}

START_TEST(calls_from_inside) {
  world other;
  body_open(&other, &(body_desc){.dim = 2});
  body_calm(&other);
  told.calls = 0;
  ck_ok(&r, mpm_stepper_set_force(r.stepper, calls_the_library, &r));
  world_steps(&r, 2);
  ck_assert_int_gt(told.calls, 1);
  world_steps(&other, 2);
  ck_assert(world_hash(&r) == world_hash(&other));
  world_close(&other);
}
END_TEST

/* ---- threads ---- */
static pthread_t caller;
static int32_t elsewhere; /* calls on other threads; written by one thread or not at all where that counts */

static void note_thread(void) {
  if (!pthread_equal(pthread_self(), caller)) elsewhere = 1;
}
static mpm_status where_force(void *user, const mpm_particle_batch *b, double *add) {
  (void)user, (void)b, (void)add;
  note_thread();
  return 0;
}
static mpm_status where_nodes(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user, (void)b, (void)prescribed, (void)velocity;
  note_thread();
  return 0;
}
static mpm_status where_law(void *user, const mpm_material_batch *b) {
  note_thread();
  return host_neo_hookean(user, b);
}

/* With one thread, and with serial_callbacks, the host is called on the calling thread only. */
START_TEST(serial_callbacks) {
  world w;
  world_desc d = world_default(2, 80, 0.1);
  d.context.concurrency = 1 + 3 * _i;
  d.context.serial_callbacks = _i;
  d.law = (world_law){.density = body_density, .stress = where_law};
  caller = pthread_self();
  elsewhere = 0;
  mpm_particles *set = world_open(&w, &d);
  world_fill_cube(&w, set, 1.0, 7.0);
  ck_ok(&w, mpm_stepper_set_force(w.stepper, where_force, NULL));
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, where_nodes, NULL));
  for (int32_t i = 0; i < 20; ++i) world_step(&w, 1e-4);
  ck_assert_int_eq(elsewhere, 0);
  world_close(&w);
}
END_TEST

TCase *stepper_callbacks_case(void) {
  TCase *tests = tcase_create("callbacks");
  tcase_set_timeout(tests, 60);
  tcase_add_checked_fixture(tests, open_run, close_run);
  tcase_add_loop_test(tests, batches, 0, 6);
  tcase_add_loop_test(tests, stored_tensors, 0, 3);
  tcase_add_test(tests, optional_fields);
  tcase_add_test(tests, three_ways_of_a_force);
  tcase_add_loop_test(tests, inert_slots_rest, 0, 3 * PLAIN);
  tcase_add_test(tests, answers);
  tcase_add_test(tests, calls_from_inside);
  tcase_add_loop_test(tests, serial_callbacks, 0, 2);
  return tests;
}
