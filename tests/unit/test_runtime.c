/* Particles that come and go during a run, in combination with all that such a run may meet: open walls,
 * periodic axes, two sets, fields of the host, saved states, threads, views.
 *
 * A stream without stress: every particle has the same velocity, so that places, images and removals are
 * known.
 */
#include "body.h"
#include "tables.h"

enum { SETS = 2, MOST = 4000, PER_EMISSION = 3 };

static const double dt = 1e-3, low = -0.35, period[3] = {2.0, 0.9, 1.2};
static const double velocity[3] = {11.3, -7.7, 23.1}, volume = 1e-3;

/* What is known of a particle: set, id, place and time of its birth; where it is then, not wrapped. */
typedef struct birth {
  int64_t id;
  double x[3], t;
} birth;

typedef struct births {
  birth list[SETS][MOST];
  int64_t count[SETS];
} births;

static mpm_status add_fields(world *w, int32_t m) {
  mpm_status status = mpm_particles_add_field(w->set[m], "born", MPM_F64, 1);
  if (!status) status = mpm_particles_add_field(w->set[m], "label", MPM_I64, 2);
  return status ? status : mpm_particles_add_field(w->set[m], "colour", MPM_U8, 3);
}

static void open_stream(world *w, int32_t dim, int32_t periodic, int32_t transfer, int32_t concurrency) {
  static const fill_fn fill[] = {add_fields, NULL};
  world_desc d = world_default(dim, 12, 1.0);
  /* soft: nodes that are too light to count strain a particle near them by some 1e-9 */
  d.law = (world_law){.model = "neo_hookean", .E = 1e-3, .nu = 0.3, .density = 2e3};
  d.other_law =
      (world_law){.model = "j2", .E = 1e-3, .nu = 0.3, .density = 2e3, .yield_stress = 1.0, .hardening = 1.0};
  d.context.concurrency = concurrency;
  d.stepper.transfer = transfer;
  d.sets = SETS;
  d.fill = fill;
  d.grid.cells[0] = periodic ? 40 : 160;
  for (int32_t k = 0; k < dim; ++k) {
    d.grid.spacing[k] = period[k] / (double)d.grid.cells[k];
    d.grid.origin[k] = low;
    d.grid.periodic[k] = k && periodic;
  }
  world_open(w, &d);
  world_walls(w, MPM_WALL_OPEN, 0.0);
}

/* Where a new particle starts; on periodic axes perhaps periods away from the grid. */
static void start(const world *s, int64_t number, birth *b) {
  for (int32_t k = 0; k < s->dim; ++k) {
    b->x[k] = low + period[k] * (0.45 + 0.4 * noise_at((uint64_t)(3 * number + k)));
    if (s->desc.grid.periodic[k]) b->x[k] += period[k] * (double)(number % 5 - 2);
  }
  b->x[0] = low + 0.03 * period[0] * (1.5 + noise_at((uint64_t)(3 * number)));
}

/* Writes what the host knows of a particle into its fields. */
static void label(world *s, int32_t m, const birth *b) {
  const int64_t words[] = {b->id * b->id, -m};
  const uint8_t colour[] = {(uint8_t)b->id, (uint8_t)(b->id / 7), (uint8_t)(250 + m)};
  ck_ok(s, mpm_particles_set(s->set[m], "born", MPM_F64, 1, 1, &b->id, &b->t));
  ck_ok(s, mpm_particles_set(s->set[m], "label", MPM_I64, 2, 1, &b->id, words));
  ck_ok(s, mpm_particles_set(s->set[m], "colour", MPM_U8, 3, 1, &b->id, colour));
}

/* Adds particles to a set: to set 0 with ids of the host, every third number; to set 1 numbered on. With
 * `backwards` in the opposite order. */
static void emit(world *s, int32_t m, const birth *b, int64_t n, int32_t backwards) {
  double x[3 * PER_EMISSION], v[3 * PER_EMISSION], V[PER_EMISSION];
  int64_t ids[PER_EMISSION], first = -1;
  for (int64_t i = 0; i < n; ++i) {
    const birth *from = &b[backwards ? n - 1 - i : i];
    for (int32_t k = 0; k < s->dim; ++k) x[k * n + i] = from->x[k], v[k * n + i] = velocity[k];
    V[i] = volume;
    ids[i] = from->id;
  }
  const int32_t numbered = m && !backwards;
  ck_ok(s, mpm_particles_add(s->set[m], n, x, v, V, NULL, numbered ? NULL : ids, &first));
  ck_assert_int_eq(first, backwards ? b[n - 1].id : b[0].id);
  for (int64_t i = 0; i < n; ++i) label(s, m, &b[i]);
}

static void new_births(const world *s, births *all, double t) {
  for (int32_t m = 0; m < SETS; ++m)
    for (int32_t i = 0; i < PER_EMISSION; ++i) {
      birth *b = &all->list[m][all->count[m]];
      *b = (birth){.id = m ? all->count[m] : 5 + 3 * all->count[m], .t = t};
      start(s, 2 * all->count[m] + m, b);
      ++all->count[m];
    }
}

static int32_t stays(const birth *b, double t) {
  return b->x[0] + velocity[0] * (t - b->t) <= low + period[0];
}

/* Every particle that was born and has not left is where it must be, and has what the host gave it. */
static int64_t check_set(const world *s, int32_t m, const births *all, double t) {
  const int64_t n = mpm_particles_count(s->set[m]);
  int64_t *id = fetch_ids(s, s->set[m]), *image = fetch_as(s, s->set[m], "image", MPM_I64, s->dim),
          *words = fetch_as(s, s->set[m], "label", MPM_I64, 2), at = 0;
  double *x = fetch_as(s, s->set[m], "position", MPM_F64, s->dim),
         *born = fetch_as(s, s->set[m], "born", MPM_F64, 1);
  uint8_t *colour = fetch_as(s, s->set[m], "colour", MPM_U8, 3);
  for (int64_t i = 0; i < all->count[m]; ++i) {
    const birth *b = &all->list[m][i];
    if (!stays(b, t)) continue;
    if (at >= n || id[at] != b->id) ck_abort_msg("set %d has lost particle %d", m, (int)b->id);
    for (int32_t k = 0; k < s->dim; ++k) {
      const double place = x[k * n + at] + period[k] * (double)image[k * n + at];
      const double wanted = b->x[k] + velocity[k] * (t - b->t);
      if (!(fabs(place - wanted) < 1e-11))
        ck_abort_msg("particle %d, axis %d: %g is off by %g", (int)b->id, (int)k, place, place - wanted);
      if (x[k * n + at] < low || x[k * n + at] > low + period[k]) ck_abort_msg("outside the grid");
      if (!s->desc.grid.periodic[k] && image[k * n + at])
        ck_abort_msg("image on an axis that is not periodic");
    }
    if (born[at] != b->t || words[at] != b->id * b->id || words[n + at] != -m ||
        colour[at] != (uint8_t)b->id || colour[n + at] != (uint8_t)(b->id / 7) ||
        colour[2 * n + at] != 250 + m)
      ck_abort_msg("particle %d has lost what the host gave it", (int)b->id);
    ++at;
  }
  ck_assert_int_eq(at, n);
  free(id), free(image), free(words), free(x), free(born), free(colour);
  return n;
}

/* Sum of mass and first moments of the particles, or of the nodes of the last step. */
static void of_particles(const world *s, double *sum) {
  for (int32_t m = 0; m < SETS; ++m) {
    const int64_t n = mpm_particles_count(s->set[m]);
    double *x = fetch_as(s, s->set[m], "position", MPM_F64, s->dim);
    sum[0] += 2e3 * volume * (double)n;
    for (int64_t i = 0; i < n * s->dim; ++i) sum[1 + i / n] += 2e3 * volume * x[i];
    free(x);
  }
}

static void of_nodes(world *s, double *sum) {
  mpm_view mass = {.struct_size = sizeof mass}, x = mass;
  ck_ok(s, mpm_grid_map(s->stepper, 0, "mass", MPM_READ, &mass));
  ck_ok(s, mpm_grid_map(s->stepper, 0, "position", MPM_READ, &x));
  ck_assert_int_eq(mass.count, s->info.active_nodes);
  for (int64_t i = 0; i < mass.count; ++i) {
    const double m = ((double *)mass.data)[i];
    sum[0] += m;
    for (int32_t k = 0; k < s->dim; ++k) sum[1 + k] += m * ((double *)x.data)[i + k * x.component_stride];
  }
  ck_ok(s, mpm_view_release(&mass));
  ck_ok(s, mpm_view_release(&x));
}

static void step(world *s) {
  int64_t before = 0, after = 0;
  const int64_t removed = s->info.removed;
  double particles[4] = {0.0}, nodes[4] = {0.0};
  of_particles(s, particles);
  for (int32_t m = 0; m < SETS; ++m) before += mpm_particles_count(s->set[m]);
  ck_ok(s, mpm_step(s->stepper, dt, &s->info));
  for (int32_t m = 0; m < SETS; ++m) after += mpm_particles_count(s->set[m]);
  if (s->info.removed - removed != before - after) ck_abort_msg("removed particles are not counted");
  double square = 0.0;
  for (int32_t k = 0; k < s->dim; ++k) square += velocity[k] * velocity[k];
  const double each = 0.5 * 2e3 * volume * square, scale = each * (double)before;
  if (!(fabs(s->info.kinetic_energy - each * (double)after) <= 1e-11 * scale))
    ck_abort_msg("kinetic energy of those who stay");
  /* what has left takes its energy along: nothing is lost in the step */
  if (!(fabs(s->info.dissipation) <= 1e-9 * scale)) ck_abort_msg("dissipation is %g", s->info.dissipation);
  if (s->desc.grid.periodic[1]) return; /* images are listed beside their nodes */
  of_nodes(s, nodes);
  for (int32_t k = 0; k <= s->dim; ++k)
    if (!(fabs(nodes[k] - particles[k]) <= 1e-9 * particles[0]))
      ck_abort_msg("the nodes of the last step are not its own");
}

/* Copies the state, and with it the count of removed particles. */
static void copy_state(const world *from, world *to) {
  world_copy(from, to);
  to->info.removed = from->info.removed;
}

static const int32_t transfers[] = {MPM_FLIP, MPM_APIC, MPM_APIC_MLS};
static births all;

/* A stream in and out, beside it one on other threads that is added to in the opposite order and loads the
 * first one's states now and then. */
START_TEST(emission_through_open_walls) {
  const int32_t dim = 1 + _i % 3, periodic = dim > 1;
  world s, twin;
  memset(&all, 0, sizeof all);
  open_stream(&s, dim, periodic, transfers[_i / 3], 1);
  open_stream(&twin, dim, periodic, transfers[_i / 3], 3);
  int64_t here = 0;
  for (int32_t k = 0; k < 400; ++k) {
    const double t = s.info.t;
    if (k % 4 == 0 && k < 300) {
      const births before = all;
      new_births(&s, &all, t);
      for (int32_t m = 0; m < SETS; ++m) {
        emit(&s, m, &all.list[m][before.count[m]], PER_EMISSION, 0);
        emit(&twin, m, &all.list[m][before.count[m]], PER_EMISSION, 1);
      }
    }
    if (k % 37 == 20) copy_state(&s, &twin);
    step(&s);
    step(&twin);
    if (world_hash(&s) != world_hash(&twin)) ck_abort_msg("the twin differs after step %d", k);
    if (k % 5 == 0)
      for (int32_t m = 0; m < SETS; ++m) here = check_set(&s, m, &all, s.info.t);
  }
  ck_assert_int_gt(s.info.removed, 300);
  ck_assert_int_gt(here, 40);
  ck_assert_int_gt(s.info.resorts, 10);
  world late;
  open_stream(&late, dim, periodic, transfers[_i / 3], 1);
  copy_state(&s, &late);
  ck_assert_int_eq(world_info(&late).removed, s.info.removed);
  world_close(&late);
  world_close(&s);
  world_close(&twin);
}
END_TEST

/* Without periodic axes particles leave through all faces, and nodal fields are looked at in each step. */
START_TEST(open_on_all_sides) {
  const int32_t dim = 1 + _i;
  world s;
  memset(&all, 0, sizeof all);
  open_stream(&s, dim, 0, MPM_FLIP, 1);
  for (int32_t k = 0; k < 260; ++k) { /* the last ones leave blocks behind while others go through the wall */
    if (k % 3 == 0 && k < 150) {
      const births before = all;
      new_births(&s, &all, s.info.t);
      for (int32_t m = 0; m < SETS; ++m) emit(&s, m, &all.list[m][before.count[m]], PER_EMISSION, 0);
    }
    step(&s);
  }
  ck_assert_int_gt(s.info.removed, 100);
  world_close(&s);
}
END_TEST

static void remove_all(world *s, int32_t m) {
  int64_t *id = fetch_ids(s, s->set[m]);
  ck_ok(s, mpm_particles_remove(s->set[m], mpm_particles_count(s->set[m]), id));
  ck_assert_int_eq(mpm_particles_count(s->set[m]), 0);
  free(id);
}

/* A run goes on without particles, and with new ones; it then is one that had these only. */
START_TEST(all_removed_and_anew) {
  const int32_t dim = 1 + _i;
  world s, fresh;
  double stable;
  memset(&all, 0, sizeof all);
  open_stream(&s, dim, 1, MPM_APIC, 1);
  open_stream(&fresh, dim, 1, MPM_APIC, 2);
  new_births(&s, &all, 0.0);
  for (int32_t m = 0; m < SETS; ++m) emit(&s, m, all.list[m], PER_EMISSION, 0);
  for (int32_t k = 0; k < 10; ++k) step(&s);
  remove_all(&s, 0);
  for (int32_t k = 0; k < 5; ++k) step(&s);
  remove_all(&s, 1);
  ck_refused(&s, mpm_stable_dt(s.stepper, &stable), MPM_E_STATE, "no particles");
  for (int32_t k = 0; k < 5; ++k) {
    ck_ok(&s, mpm_step(s.stepper, dt, &s.info));
    ck_assert_int_eq(s.info.active_nodes, 0);
    ck_assert_double_eq(s.info.kinetic_energy, 0.0);
    ck_assert_double_eq(s.info.strain_energy, 0.0);
  }
  mpm_view v = {.struct_size = sizeof v};
  ck_ok(&s, mpm_grid_map(s.stepper, 0, "velocity", MPM_READ, &v));
  ck_assert_int_eq(v.count, 0);
  ck_ok(&s, mpm_view_release(&v));
  copy_state(&s, &s); /* the numbers that ids go on from are kept */
  ck_ok(&fresh, mpm_stepper_set_time(fresh.stepper, s.info.t, s.info.step));
  const births before = all;
  new_births(&s, &all, s.info.t);
  for (int32_t m = 0; m < SETS; ++m) {
    emit(&s, m, &all.list[m][before.count[m]], PER_EMISSION, 0);
    emit(&fresh, m, &all.list[m][before.count[m]], PER_EMISSION, 1);
  }
  for (int32_t k = 0; k < 20; ++k) {
    step(&s);
    step(&fresh);
    ck_assert_uint_eq(world_hash(&s), world_hash(&fresh));
  }
  world_close(&s);
  world_close(&fresh);
}
END_TEST

/* Ids of the host and of the library mix: numbers go on from the largest so far and are never used again. */
START_TEST(ids_go_on) {
  world s, other;
  const double x[] = {0.1, 0.1}, V[] = {volume, volume};
  int64_t first;
  open_stream(&s, 1, 0, MPM_FLIP, 1);
  open_stream(&other, 1, 0, MPM_FLIP, 1);
  mpm_particles *set = s.set[0];
  const int64_t far[] = {700, 40}, again[] = {41, 700}, small[] = {2, 3};
  ck_ok(&s, mpm_particles_add(set, 2, x, NULL, V, NULL, far, &first));
  ck_assert_int_eq(first, 700);
  ck_ok(&s, mpm_particles_add(set, 2, x, NULL, V, NULL, NULL, &first));
  ck_assert_int_eq(first, 701);
  ck_ok(&s, mpm_step(s.stepper, dt, NULL));
  ck_refused(&s, mpm_particles_add(set, 2, x, NULL, V, NULL, again, NULL), MPM_E_ARG, "id 700 is in use");
  ck_assert_int_eq(mpm_particles_count(set), 4);
  remove_all(&s, 0);
  ck_ok(&s, mpm_step(s.stepper, dt, NULL));
  copy_state(&s, &other);
  for (int32_t k = 0; k < 2; ++k) {
    world *at = k ? &other : &s;
    ck_ok(at, mpm_particles_add(at->set[0], 2, x, NULL, V, NULL, NULL, &first));
    ck_assert_int_eq(first, 703);
    ck_ok(at,
          mpm_particles_add(at->set[0], 2, x, NULL, V, NULL, small, &first)); /* free, and the host's own */
    ck_assert_int_eq(first, 2);
    ck_ok(at, mpm_particles_add(at->set[0], 1, x, NULL, V, NULL, NULL, &first));
    ck_assert_int_eq(first, 705);
    ck_ok(at,
          mpm_particles_add(at->set[1], 1, x, NULL, V, NULL, NULL, &first)); /* each set counts for itself */
    ck_assert_int_eq(first, 0);
    ck_ok(at, mpm_step(at->stepper, dt, NULL));
  }
  ck_assert_uint_eq(world_hash(&s), world_hash(&other));
  world_close(&s);
  world_close(&other);
}
END_TEST

static mpm_status refuse_late(void *user, const mpm_particle_batch *b, double *add) {
  (void)add;
  return b->t > *(const double *)user ? -3 : 0;
}

/* A step that fails, or that the host aborts, removes nothing; views and parts of a step bar both ways. */
START_TEST(only_what_is_committed) {
  world s;
  double last = 1e9;
  memset(&all, 0, sizeof all);
  open_stream(&s, 2, 1, MPM_FLIP, 1);
  new_births(&s, &all, 0.0);
  for (int32_t m = 0; m < SETS; ++m) emit(&s, m, all.list[m], PER_EMISSION, 0);
  ck_ok(&s, mpm_stepper_set_progress(s.stepper, NULL, NULL));
  ck_ok(&s, mpm_stepper_set_force(s.stepper, refuse_late, &last));
  int64_t left = 0;
  for (int32_t k = 0; k < 300 && left < 4; ++k) {
    const uint64_t hash = world_hash(&s);
    const int64_t removed = s.info.removed;
    ck_ok(&s, mpm_step_begin(s.stepper, dt));
    const double x[] = {0.0, 0.0};
    const int64_t id = all.list[0][0].id;
    ck_refused(&s, mpm_particles_add(s.set[0], 1, x, NULL, &volume, NULL, NULL, NULL), MPM_E_STATE, "step");
    ck_refused(&s, mpm_particles_remove(s.set[0], 1, &id), MPM_E_STATE, "step");
    ck_ok(&s, mpm_step_grid(s.stepper));
    ck_ok(&s, mpm_step_abort(s.stepper));
    ck_assert_uint_eq(world_hash(&s), hash);
    mpm_view v = {.struct_size = sizeof v};
    ck_ok(&s, mpm_particles_map(s.set[0], "velocity", MPM_READ, &v));
    ck_refused(&s, mpm_particles_add(s.set[0], 1, x, NULL, &volume, NULL, NULL, NULL), MPM_E_STATE, "views");
    ck_refused(&s, mpm_step(s.stepper, dt, NULL), MPM_E_STATE, "mapped");
    ck_ok(&s, mpm_view_release(&v));
    last = -1.0;
    ck_refused(&s, mpm_step(s.stepper, dt, &s.info), MPM_E_CALLBACK, "-3");
    ck_assert_int_eq(s.info.removed, removed);
    ck_assert_uint_eq(world_hash(&s), hash);
    last = 1e9;
    step(&s);
    left += s.info.removed - removed;
  }
  ck_assert_int_ge(left, 4);
  world_close(&s);
}
END_TEST

/* Periods are counted whichever way and however many in one step,
 * from where particles were added, and over saving. */
START_TEST(images) {
  world s, other;
  open_stream(&s, 2, 1, MPM_FLIP, 1);
  open_stream(&other, 2, 1, MPM_FLIP, 1);
  const double y = low + 0.31 * period[1];
  const double x[] = {0.0, 0.7, y + 3.0 * period[1], y - 2.0 * period[1]};
  const double v[] = {0.0, 0.0, 2.6 * period[1] / dt, -1.7 * period[1] / dt}, V[] = {volume, volume};
  ck_ok(&s, mpm_particles_add(s.set[0], 2, x, v, V, NULL, NULL, NULL));
  for (int32_t k = 0; k <= 12; ++k) {
    int64_t *image = fetch_as(&s, s.set[0], "image", MPM_I64, 2);
    double *at = fetch_as(&s, s.set[0], "position", MPM_F64, 2);
    for (int32_t p = 0; p < 2; ++p) {
      const double periods = (p ? -2.0 : 3.0) + 0.31 + (p ? -1.7 : 2.6) * k;
      ck_assert_int_eq(image[2 + p], (int64_t)floor(periods));
      ck_assert_int_eq(image[p], 0);
      ck_assert_double_eq_tol(at[2 + p], low + period[1] * (periods - floor(periods)), 1e-10);
    }
    free(image), free(at);
    if (k == 6) {
      copy_state(&s, &other);
      ck_assert_uint_eq(world_hash(&s), world_hash(&other));
      copy_state(&other, &s);
    }
    ck_ok(&s, mpm_step(s.stepper, dt, NULL));
  }
  world_close(&s);
  world_close(&other);
}
END_TEST

/* Reference positions start where particles are added, periods included. */
START_TEST(reference_positions) {
  world s;
  memset(&all, 0, sizeof all);
  open_stream(&s, 3, 1, MPM_FLIP, 1);
  mpm_stepper_desc d = stepper_desc();
  d.reference_positions = 1;
  ck_ok(&s, mpm_stepper_configure(s.stepper, &d));
  for (int32_t k = 0; k < 60; ++k) {
    if (k % 6 == 0) {
      const births before = all;
      new_births(&s, &all, s.info.t);
      for (int32_t m = 0; m < SETS; ++m) emit(&s, m, &all.list[m][before.count[m]], PER_EMISSION, 0);
    }
    if (k == 31) copy_state(&s, &s);
    step(&s);
  }
  for (int32_t m = 0; m < SETS; ++m)
    for (int64_t i = 0; i < all.count[m]; ++i) {
      const birth *b = &all.list[m][i];
      double x[3];
      if (!stays(b, s.info.t)) continue;
      ck_ok(&s, mpm_particles_get(s.set[m], "reference_position", MPM_F64, 3, 1, &b->id, x));
      for (int32_t k = 0; k < 3; ++k) ck_assert_double_eq_tol(x[k], b->x[k], 1e-14);
    }
  world_close(&s);
}
END_TEST

Suite *runtime_suite(void) {
  Suite *suite = suite_create("runtime");
  TCase *tests = tcase_create("particles that come and go");
  tcase_set_timeout(tests, 120);
  add_sparse(tests, emission_through_open_walls, 9, 4);
  tcase_add_loop_test(tests, open_on_all_sides, 0, 3);
  tcase_add_loop_test(tests, all_removed_and_anew, 0, 3);
  tcase_add_test(tests, ids_go_on);
  tcase_add_test(tests, only_what_is_committed);
  tcase_add_test(tests, images);
  tcase_add_test(tests, reference_positions);
  suite_add_tcase(suite, tests);
  return suite;
}
