/* Packed particles: what one set gives another takes, bit by bit, or not at all. */
#include "body.h"
#include "combinations.h"
#include "io/state.h"
#include "particles/builtin_fields.h"

enum { SAMPLE = 150 };
static world from, to;

/* ---- bytes ---- */
static saved_state pack_some(const world *w, int32_t m, int64_t n, const int64_t *ids) {
  enum { GUARD = 8 };
  saved_state packed;
  ck_ok(w, mpm_particles_packed_size(w->set[m], n, &packed.bytes));
  packed.data = malloc((size_t)packed.bytes + GUARD);
  memset(packed.data + packed.bytes, 0x5a, GUARD);
  ck_ok(w, mpm_particles_pack(w->set[m], n, ids, packed.data, packed.bytes));
  for (int32_t i = 0; i < GUARD; ++i) ck_holds(packed.data[packed.bytes + i] == 0x5a);
  return packed;
}

static saved_state pack_all(const world *w, int32_t m) {
  return pack_some(w, m, mpm_particles_count(w->set[m]), NULL);
}

/* Unpacks a copy, so that reading past the end is noticed by memory checkers. */
static mpm_status unpack_copy(world *w, int32_t m, const unsigned char *data, int64_t bytes) {
  unsigned char *copy = malloc((size_t)bytes + (bytes == 0));
  memcpy(copy, data, (size_t)bytes);
  const mpm_status status = mpm_particles_unpack(w->set[m], copy, bytes);
  free(copy);
  return status;
}

static void remove_all(world *w, int32_t m) {
  int64_t *ids = fetch_ids(w, w->set[m]);
  ck_ok(w, mpm_particles_remove(w->set[m], mpm_particles_count(w->set[m]), ids));
  free(ids);
}

/* All fields of set m must have the same bits in both worlds. */
static void same_set(const world *a, const world *b, int32_t m, const char *what) {
  size_t bytes, other;
  char *x = world_fields(a, m, &bytes), *y = world_fields(b, m, &other);
  ck_assert_msg(bytes == other && memcmp(x, y, bytes) == 0, "%s: set %d has other fields", what, (int)m);
  free(x), free(y);
}

/* ---- bodies with a history ---- */
static void add_host_fields(world *w) {
  ck_ok(w, mpm_particles_add_field(w->set[0], "grain", MPM_I64, 2));
  ck_ok(w, mpm_particles_add_field(w->set[0], "colour", MPM_U8, 3));
  ck_ok(w, mpm_particles_add_field(w->set[0], "label", MPM_F64, 1));
}

static void fill_host_fields(world *w) {
  const int64_t n = mpm_particles_count(w->set[0]);
  int64_t *grain = calloc((size_t)n, 2 * sizeof *grain);
  double *label = calloc((size_t)n, sizeof *label);
  uint8_t *colour = calloc((size_t)n, 3);
  for (int64_t i = 0; i < 2 * n; ++i) grain[i] = i % 2 ? INT64_MIN + i : INT64_MAX - i;
  for (int64_t i = 0; i < 3 * n; ++i) colour[i] = (uint8_t)(i * 37);
  for (int64_t i = 0; i < n; ++i) label[i] = i % 3 ? noise_at((uint64_t)i) : -0.0;
  ck_ok(w, mpm_particles_set(w->set[0], "grain", MPM_I64, 2, n, NULL, grain));
  ck_ok(w, mpm_particles_set(w->set[0], "colour", MPM_U8, 3, n, NULL, colour));
  put(w, w->set[0], "label", 1, label);
  free(grain), free(label), free(colour);
}

/* Fields that take memory only when they are used. */
static void use_optional_fields(world *w, int32_t m) {
  const int64_t n = mpm_particles_count(w->set[m]);
  double *x = calloc((size_t)n, 3 * sizeof *x);
  uint8_t *flag = calloc((size_t)n, 3);
  for (int64_t i = 0; i < n * w->dim; ++i) x[i] = 0.1 * noise_at((uint64_t)i), flag[i] = i % 11 == 3;
  put(w, w->set[m], "applied_force", w->dim, x);
  put(w, w->set[m], "acceleration", w->dim, x);
  ck_ok(w, mpm_particles_set(w->set[m], "prescribed", MPM_U8, w->dim, n, NULL, flag));
  for (int64_t i = 0; i < n * w->dim; ++i) x[i] = 0.1 + 0.01 * fabs(x[i]);
  put(w, w->set[m], "size", w->dim, x);
  free(x), free(flag);
}

static void throw_particles(world *w, int32_t m, double speed) {
  const int64_t n = mpm_particles_count(w->set[m]);
  double *x = fetch(w, w->set[m], "position", w->dim), *v = calloc((size_t)n, 3 * sizeof *v);
  for (int64_t i = 0; i < n; ++i)
    for (int32_t c = 0; c < w->dim; ++c)
      v[c * n + i] =
          speed * (1.0 - 0.4 * c + (w->dim > 1 ? (c ? -1.0 : 1.0) * (x[(1 - c % 2) * n + i] - 1.0) : 0.0));
  put(w, w->set[m], "velocity", w->dim, v);
  free(x), free(v);
}

static void play(world *w, double speed, int32_t steps) {
  add_host_fields(w);
  world_fill_cube(w, w->set[0], 0.5, 1.25);
  if (w->sets > 1) world_fill_cube(w, w->set[1], 1.25, 1.5);
  fill_host_fields(w);
  for (int32_t m = 0; m < w->sets; ++m) throw_particles(w, m, speed);
  world_walls(w, MPM_WALL_SLIP, 0.0);
  const double pressed[6] = {-2e3, -2e3, -2e3}; /* clay needs an initial stress */
  if (w->desc.law.model && !strcmp(w->desc.law.model, "cam_clay"))
    ck_ok(w, mpm_particles_set_all(w->set[0], "stress", MPM_F64, 6, pressed));
  const double dt = 0.3 * world_stable_dt(w);
  for (int32_t i = 0; i < steps; ++i) world_step(w, dt);
}

/* Takes all particles over into a world that is described alike, and back into the one where they were. Steps
 * from there have the same bits in both. */
static void check_taken_over(const char *what) {
  world_open(&to, &from.desc);
  add_host_fields(&to);
  world_walls(&to, MPM_WALL_SLIP, 0.0);
  for (int32_t m = 0; m < from.sets; ++m) {
    const saved_state packed = pack_all(&from, m);
    ck_ok(&to, unpack_copy(&to, m, packed.data, packed.bytes));
    same_set(&from, &to, m, what);
    const saved_state again = pack_all(&to, m);
    ck_assert_msg(again.bytes == packed.bytes && !memcmp(again.data, packed.data, (size_t)packed.bytes),
                  "%s: set %d is packed to other bytes", what, (int)m);
    remove_all(&from, m);
    ck_ok(&from, unpack_copy(&from, m, packed.data, packed.bytes));
    same_set(&from, &to, m, what);
    free(packed.data), free(again.data);
  }
  ck_ok(&from, mpm_stepper_set_time(from.stepper, 0.0, 0));
  const double dt = 0.2 * world_stable_dt(&from);
  for (int32_t i = 0; i < 4; ++i) {
    const mpm_status a = mpm_step(from.stepper, dt, NULL), b = mpm_step(to.stepper, dt, NULL);
    ck_assert_msg(a == b, "%s: %s and %s", what, last_error_of(&from), last_error_of(&to));
  }
  if (!from.desc.stepper.staggered) /* the mean of two dt needs the last */
    for (int32_t m = 0; m < from.sets; ++m) same_set(&from, &to, m, what);
  world_close(&to);
  world_close(&from);
}

static combination *list;
static int32_t list_count;
static void set_up_list(void) {
  list = list_combinations(&list_count);
}
static void tear_down_list(void) {
  free(list);
}

START_TEST(every_method) {
  char name[300];
  const combination *c = &list[(int64_t)_i * list_count / SAMPLE + (_i * 7) % (list_count / SAMPLE)];
  if (refusal_of(c)) return;
  world_desc d = describe_combination(c);
  d.stepper.reference_positions = _i % 3 == 0;
  world_open(&from, &d);
  play(&from, 2.0, 4);
  if (_i % 2) use_optional_fields(&from, 0);
  check_taken_over(name_of(c, name, sizeof name));
}
END_TEST

/* Every law, in one to three dimensions, on a periodic axis that particles cross. */
START_TEST(every_law) {
  const law_option *law = &law_options[_i % LAWS];
  const int32_t dim = 1 + _i / LAWS;
  world_desc d = world_default(dim, 8, 0.25);
  d.sets = 2;
  d.other_law = d.law;
  d.law.model = law->model;
  d.law.yield_stress = 1e3, d.law.hardening = 1e4;
  if (!law->model) d.law.stress = host_neo_hookean, d.law.state_count = 1;
  for (int32_t k = 0; k < dim; ++k) d.grid.periodic[k] = 1;
  d.stepper.transfer = MPM_APIC;
  d.stepper.locking_remedy = dim > 1 && _i % 2;
  world_open(&from, &d);
  play(&from, 6.0, 40);
  int64_t *image = fetch_as(&from, from.set[0], "image", MPM_I64, dim), crossed = 0;
  for (int64_t i = 0; i < mpm_particles_count(from.set[0]); ++i) crossed += image[i] != 0;
  free(image);
  ck_assert_int_gt(crossed, 0);
  check_taken_over(law->name);
}
END_TEST

/* Rings, sheets, and grids on which particles keep their places. */
START_TEST(every_geometry) {
  world_desc d = world_default(2, 8, 0.25);
  if (_i == 0) d.grid.geometry = MPM_AXISYMMETRIC;
  if (_i == 1) d.grid.geometry = MPM_PLANE_STRESS;
  if (_i == 2) d.grid.total_lagrangian = 1;
  d.grid.basis = _i == 1 ? MPM_CPGIMP : MPM_BSPLINE2;
  world_open(&from, &d);
  play(&from, 1.0, 8);
  check_taken_over("geometry");
}
END_TEST

/* ---- what is packed ---- */
static void open_small(int32_t dim) {
  world_desc d = world_default(dim, 8, 0.25);
  d.law =
      (world_law){.model = "j2", .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3, .hardening = 1e3};
  d.stepper.transfer = MPM_APIC;
  world_open(&from, &d);
  add_host_fields(&from);
  world_fill_cube(&from, from.set[0], 0.5, dim == 1 ? 1.25 : 1.0);
  fill_host_fields(&from);
  throw_particles(&from, 0, 4.0);
  for (int32_t i = 0; i < 3; ++i) world_step(&from, 1e-3);
  use_optional_fields(&from, 0);
  world_open(&to, &d);
  add_host_fields(&to);
}

static void open_line(void) {
  open_small(1);
}
static void open_square(void) {
  open_small(2);
}
static void close_both(void) {
  world_close(&from);
  world_close(&to);
}

START_TEST(some_in_an_order) {
  const int64_t ids[] = {7, 3, 12, 0}, more[] = {5};
  const saved_state packed = pack_some(&from, 0, 4, ids), one = pack_some(&from, 0, 1, more);
  ck_ok(&to, unpack_copy(&to, 0, packed.data, packed.bytes));
  ck_ok(&to, unpack_copy(&to, 0, one.data, one.bytes));
  ck_assert_int_eq(mpm_particles_count(to.set[0]), 5);
  ck_assert_int_eq(to.set[0]->next_id, 13);
  const int64_t *id = mpmi_i64(to.set[0], MPMI_ID, 0);
  for (int32_t i = 0; i < 4; ++i) ck_assert_int_eq(id[i], ids[i]);
  for (int32_t i = 0; i < 4; ++i)
    ck_assert(fetch1(&to, to.set[0], "stress", 6, 0, ids[i]) ==
              fetch1(&from, from.set[0], "stress", 6, 0, ids[i]));
  ck_assert(to.set[0]->mass_max > 0.0);
  ck_ok(&to, mpm_particles_add(to.set[0], 1, (double[]){0.3, 0.3}, NULL, (double[]){1e-3}, NULL, NULL, NULL));
  ck_assert_int_eq(to.set[0]->next_id, 14);
  free(packed.data), free(one.data);
}
END_TEST

START_TEST(no_particles) {
  const saved_state packed = pack_some(&from, 0, 0, (int64_t[]){0});
  ck_ok(&to, unpack_copy(&to, 0, packed.data, packed.bytes));
  ck_assert_int_eq(mpm_particles_count(to.set[0]), 0);
  const saved_state empty = pack_all(&to, 0);
  ck_ok(&from, unpack_copy(&from, 0, empty.data, empty.bytes));
  free(packed.data), free(empty.data);
}
END_TEST

/* Portions end within the list, at its end, and one behind it. */
START_TEST(portions) {
  static const int64_t counts[] = {1, 255, 256, 257, 511, 512, 513};
  for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
    const int64_t n = counts[k];
    world_desc d = world_default(1, 8, 0.25);
    world_open(&from, &d);
    world_open(&to, &d);
    for (int32_t i = 0; i < 2; ++i) add_host_fields(i ? &to : &from);
    double *x = malloc((size_t)n * sizeof *x), *volume = malloc((size_t)n * sizeof *x);
    for (int64_t i = 0; i < n; ++i) x[i] = 0.5 + (double)i / (double)n, volume[i] = 1e-3;
    ck_ok(&from, mpm_particles_add(from.set[0], n, x, x, volume, NULL, NULL, NULL));
    fill_host_fields(&from);
    const saved_state packed = pack_all(&from, 0);
    ck_ok(&to, unpack_copy(&to, 0, packed.data, packed.bytes));
    same_set(&from, &to, 0, "portions");
    free(x), free(volume), free(packed.data);
    world_close(&from);
    world_close(&to);
  }
}
END_TEST

/* What the buffer lacks has the values of new particles. */
START_TEST(values_that_are_lacking) {
  world_desc d = world_default(2, 8, 0.25);
  world_open(&from, &d);
  world_fill_cube(&from, from.set[0], 0.5, 1.0);
  const saved_state packed = pack_all(&from, 0);
  d.grid.basis = MPM_GIMP;
  d.grid.periodic[1] = 1;
  d.stepper.reference_positions = d.stepper.locking_remedy = 1;
  world_open(&to, &d);
  add_host_fields(&to);
  world_fill_cube(&to, to.set[0], 1.0, 1.25);
  fill_host_fields(&to);
  remove_all(&to, 0);
  ck_ok(&to, unpack_copy(&to, 0, packed.data, packed.bytes));
  const int64_t n = mpm_particles_count(to.set[0]);
  ck_assert_int_eq(n, mpm_particles_count(from.set[0]));
  double *size = fetch(&to, to.set[0], "size", 2), *J = fetch(&to, to.set[0], "dilation_ratio", 1);
  double *X = fetch(&to, to.set[0], "reference_position", 2), *x = fetch(&to, to.set[0], "position", 2);
  double *label = fetch(&to, to.set[0], "label", 1);
  for (int64_t i = 0; i < 2 * n; ++i) ck_holds(X[i] == x[i] && fabs(size[i] - 0.125) < 1e-15);
  for (int64_t i = 0; i < n; ++i) ck_holds(J[i] == 1.0 && label[i] == 0.0);
  world_step(&to, 1e-4);
  free(size), free(J), free(X), free(x), free(label), free(packed.data);
  close_both();
}
END_TEST

/* Particles get along on another grid, if they lie inside. */
START_TEST(another_grid) {
  world other;
  world_desc d = from.desc;
  d.grid = grid_desc(2, 40, 0.1);
  d.grid.basis = MPM_BSPLINE3;
  d.grid.origin[0] = -1.0;
  world_open(&other, &d);
  add_host_fields(&other);
  const saved_state packed = pack_all(&from, 0);
  ck_ok(&other, unpack_copy(&other, 0, packed.data, packed.bytes));
  same_set(&from, &other, 0, "another grid");
  world_step(&other, 1e-4);
  world_close(&other);
  d.grid.origin[0] = 0.6;
  world_open(&other, &d);
  add_host_fields(&other);
  ck_refused(&other, unpack_copy(&other, 0, packed.data, packed.bytes), MPM_E_ARG,
             "position of the packed particle with id");
  ck_assert_int_eq(mpm_particles_count(other.set[0]), 0);
  free(packed.data);
  world_close(&other);
}
END_TEST

/* Accelerations of implicit steps stay good, those that nobody knows do not become so. */
START_TEST(accelerations) {
  const saved_state packed = pack_all(&from, 0);
  ck_assert_int_eq(from.set[0]->dirty & MPMI_DIRTY_ACCELERATION, 0);
  ck_ok(&to, unpack_copy(&to, 0, packed.data, packed.bytes));
  ck_assert_uint_eq(to.set[0]->dirty, MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS);
  remove_all(&to, 0);
  from.set[0]->dirty |= MPMI_DIRTY_ACCELERATION;
  const saved_state unknown = pack_all(&from, 0);
  ck_ok(&to, unpack_copy(&to, 0, unknown.data, unknown.bytes));
  ck_assert(to.set[0]->dirty & MPMI_DIRTY_ACCELERATION);
  free(packed.data), free(unknown.data);
}
END_TEST

/* ---- what is refused ---- */
START_TEST(bad_arguments) {
  mpm_particles *set = from.set[0];
  const int64_t twice[] = {1, 2, 1}, missing[] = {1, 999};
  const int64_t all = mpm_particles_count(set);
  int64_t bytes = 0, same = 0;
  ck_refused(&from, mpm_particles_packed_size(set, 1, NULL), MPM_E_ARG, "bytes is NULL");
  ck_refused(&from, mpm_particles_packed_size(set, -1, &bytes), MPM_E_ARG, "n is -1");
  ck_refused(&from, mpm_particles_packed_size(set, INT64_MAX, &bytes), MPM_E_ARG, "n is 9223372036854775807");
  ck_ok(&from, mpm_particles_packed_size(set, 3, &bytes));
  ck_ok(&from, mpm_particles_packed_size(set, 3, &same));
  ck_assert_int_eq(bytes, same);
  unsigned char *data = malloc((size_t)bytes);
  memset(data, 0x5a, (size_t)bytes);
  ck_refused(&from, mpm_particles_pack(set, 3, (int64_t[]){1, 2, 3}, NULL, bytes), MPM_E_ARG,
             "buffer is NULL");
  ck_refused(&from, mpm_particles_pack(set, 3, (int64_t[]){1, 2, 3}, data, bytes - 1), MPM_E_ARG,
             "capacity is");
  ck_refused(&from, mpm_particles_pack(set, 3, twice, data, bytes), MPM_E_ARG, "id 1 is given twice");
  ck_refused(&from, mpm_particles_pack(set, 2, missing, data, bytes), MPM_E_NOT_FOUND, "id 999");
  ck_refused(&from, mpm_particles_pack(set, all - 1, NULL, data, bytes), MPM_E_ARG, "ids is NULL");
  for (int64_t i = 0; i < bytes; ++i) ck_holds(data[i] == 0x5a);
  ck_refused(&to, mpm_particles_unpack(to.set[0], NULL, 8), MPM_E_ARG, "buffer is NULL");
  ck_refused(&to, mpm_particles_unpack(to.set[0], data, -8), MPM_E_ARG, "bytes is -8");
  free(data);
}
END_TEST

START_TEST(at_a_bad_time) {
  mpm_view view = {.struct_size = sizeof view};
  const saved_state packed = pack_all(&from, 0);
  ck_ok(&from, mpm_particles_map(from.set[0], "velocity", MPM_READ, &view));
  saved_state same = pack_all(&from, 0);
  ck_assert_mem_eq(same.data, packed.data, (size_t)packed.bytes);
  ck_refused(&from, unpack_copy(&from, 0, packed.data, packed.bytes), MPM_E_STATE, "1 views");
  ck_ok(&from, mpm_view_release(&view));
  ck_ok(&from, mpm_particles_map(from.set[0], "velocity", MPM_WRITE, &view));
  ck_refused(&from, mpm_particles_pack(from.set[0], 1, (int64_t[]){1}, same.data, same.bytes), MPM_E_STATE,
             "velocity of the set is mapped for writing");
  const double was = *(double *)view.data;
  *(double *)view.data = NOT_A_NUMBER;
  ck_refused(&from, mpm_view_release(&view), MPM_E_ARG, "must be finite");
  ck_refused(&from, mpm_particles_pack(from.set[0], 1, (int64_t[]){1}, same.data, same.bytes), MPM_E_STATE,
             "velocity of");
  ck_ok(&from, mpm_particles_map(from.set[0], "velocity", MPM_WRITE, &view));
  *(double *)view.data = was;
  ck_ok(&from, mpm_view_release(&view));
  ck_ok(&from, mpm_step_begin(from.stepper, 1e-4));
  ck_refused(&from, mpm_particles_pack(from.set[0], 1, (int64_t[]){1}, same.data, same.bytes), MPM_E_STATE,
             "staged step");
  ck_refused(&from, unpack_copy(&from, 0, packed.data, packed.bytes), MPM_E_STATE, "staged step");
  ck_ok(&from, mpm_step_abort(from.stepper));
  free(packed.data), free(same.data);
}
END_TEST

static void refused_by(const world_desc *d, const saved_state *packed, mpm_status status, const char *text) {
  world other;
  world_open(&other, d);
  add_host_fields(&other);
  ck_refused(&other, unpack_copy(&other, 0, packed->data, packed->bytes), status, text);
  ck_assert_int_eq(mpm_particles_count(other.set[0]), 0);
  world_close(&other);
}

START_TEST(unlike_setups) {
  const saved_state packed = pack_all(&from, 0);
  world_desc d = from.desc;
  d.law.model = "linear_elastic";
  refused_by(&d, &packed, MPM_E_FORMAT, "the buffer is of an unlike setup: law is \"j2\" there");
  d = from.desc;
  d.law.hardening *= 2.0;
  refused_by(&d, &packed, MPM_E_FORMAT, "hardening is 1000 there, 2000 here");
  d = from.desc;
  d.law.density = 1.0;
  refused_by(&d, &packed, MPM_E_FORMAT, "density is 1000 there, 1 here");
  d = world_default(3, 8, 0.25);
  d.law = from.desc.law;
  refused_by(&d, &packed, MPM_E_FORMAT, "dim is 2 there, 3 here");
  d = from.desc;
  d.grid.geometry = MPM_AXISYMMETRIC;
  refused_by(&d, &packed, MPM_E_FORMAT, "geometry is 0 there, 1 here");
  d = from.desc;
  d.grid.total_lagrangian = 1;
  refused_by(&d, &packed, MPM_E_FORMAT, "total_lagrangian is 0 there, 1 here");
  free(packed.data);
}
END_TEST

/* Fields of the host, fields that only a stepper keeps, and images. */
START_TEST(unlike_fields) {
  world other;
  world_desc d = from.desc;
  const saved_state packed = pack_all(&from, 0);
  world_open(&other, &d);
  ck_refused(&other, unpack_copy(&other, 0, packed.data, packed.bytes), MPM_E_FORMAT,
             "field \"grain\" is there, but not here");
  ck_ok(&other, mpm_particles_add_field(other.set[0], "grain", MPM_I64, 3));
  ck_refused(&other, unpack_copy(&other, 0, packed.data, packed.bytes), MPM_E_FORMAT,
             "number of components of grain is 2 there, 3 here");
  world_close(&other);
  world_open(&other, &d);
  ck_ok(&other, mpm_particles_add_field(other.set[0], "grain", MPM_F64, 2));
  ck_refused(&other, unpack_copy(&other, 0, packed.data, packed.bytes), MPM_E_FORMAT, "type of grain is");
  ck_assert_int_eq(other.set[0]->field[MPMI_PRESCRIBED].present, 0);
  world_close(&other);
  free(packed.data);

  d.stepper.locking_remedy = d.grid.periodic[0] = 1;
  world_open(&other, &d);
  world_fill_cube(&other, other.set[0], 0.5, 1.0);
  const saved_state ratio = pack_all(&other, 0);
  refused_by(&from.desc, &ratio, MPM_E_FORMAT, "field \"image\" is there, but not here");
  d.stepper.locking_remedy = 0;
  refused_by(&d, &ratio, MPM_E_FORMAT, "field \"dilation_ratio\" is there, but not here");
  d.stepper.locking_remedy = 1;
  d.grid.cells[0] = 16;
  refused_by(&d, &ratio, MPM_E_FORMAT, "period[0] is 2 there, 4 here");
  world_close(&other);
  free(ratio.data);
}
END_TEST

/* An id that is in use is named, and nothing is added. */
START_TEST(ids_in_use) {
  const saved_state packed = pack_all(&from, 0);
  const int64_t id = 4;
  ck_refused(&from, unpack_copy(&from, 0, packed.data, packed.bytes), MPM_E_ARG, "id 0 is in use");
  saved_state some = pack_some(&from, 0, 1, &id);
  ck_ok(&to, unpack_copy(&to, 0, some.data, some.bytes));
  const saved_state before = pack_all(&to, 0);
  ck_refused(&to, unpack_copy(&to, 0, packed.data, packed.bytes), MPM_E_ARG, "id 4 is in use");
  const saved_state after = pack_all(&to, 0);
  ck_assert_int_eq(after.bytes, before.bytes);
  ck_assert_mem_eq(after.data, before.data, (size_t)after.bytes);
  free(packed.data), free(some.data), free(before.data), free(after.data);
}
END_TEST

/* ---- damage ---- */
static void refuses(const unsigned char *data, int64_t bytes, const char *text) {
  ck_refused(&to, unpack_copy(&to, 0, data, bytes), MPM_E_FORMAT, text);
  ck_holds(mpm_particles_count(to.set[0]) == 0 && to.set[0]->next_id == 0 && to.set[0]->dirty == 0);
}

START_TEST(truncated_at_every_length) {
  const saved_state packed = pack_all(&from, 0);
  to.set[0]->dirty = 0;
  for (int64_t bytes = 0; bytes < packed.bytes; ++bytes) refuses(packed.data, bytes, "");
  refuses(packed.data, 31, "too few for packed particles");
  refuses(packed.data, packed.bytes - 1, "of which there are");
  free(packed.data);
}
END_TEST

START_TEST(every_byte_counts) {
  const saved_state packed = pack_all(&from, 0);
  to.set[0]->dirty = 0;
  for (int64_t i = 0; i < packed.bytes; ++i)
    for (int32_t bit = 0; bit < 8; bit += 7) {
      packed.data[i] ^= (unsigned char)(1u << bit);
      refuses(packed.data, packed.bytes, "");
      packed.data[i] ^= (unsigned char)(1u << bit);
    }
  ck_ok(&to, unpack_copy(&to, 0, packed.data, packed.bytes));
  free(packed.data);
}
END_TEST

START_TEST(foreign_data) {
  const saved_state packed = pack_all(&from, 0), state = world_save(&from);
  unsigned char *data = calloc(1, (size_t)packed.bytes + 8);
  to.set[0]->dirty = 0;
  refuses(data, packed.bytes, "no packed particles");
  refuses(state.data, state.bytes, "no packed particles");
  memcpy(data, packed.data, (size_t)packed.bytes);
  refuses(data, packed.bytes + 8, "of which there are");
  for (int32_t i = 0; i < 4; ++i) data[8 + i] = packed.data[11 - i];
  refuses(data, packed.bytes, "byte order");
  memcpy(data, packed.data, (size_t)packed.bytes);
  data[12] = 2;
  refuses(data, packed.bytes, "this library knows format 1");
  ck_assert_int_eq(mpm_state_load(from.stepper, packed.data, packed.bytes), MPM_E_FORMAT);
  memcpy(data + 1, packed.data, (size_t)packed.bytes); /* buffers need no alignment */
  ck_ok(&to, mpm_particles_unpack(to.set[0], data + 1, packed.bytes));
  free(data), free(packed.data), free(state.data);
}
END_TEST

/* Gives changed contents the checksum that belongs to them. */
static void seal(unsigned char *data, int64_t bytes) {
  mpmi_state_header header;
  mpmi_checksum sum;
  mpmi_checksum_begin(&sum);
  mpmi_checksum_add(&sum, data + sizeof header, bytes - (int64_t)sizeof header);
  memcpy(&header, data, sizeof header);
  header = mpmi_state_turn_header(header);
  header.bytes = bytes;
  header.checksum = mpmi_checksum_end(&sum);
  header = mpmi_state_turn_header(header);
  memcpy(data, &header, sizeof header);
}

/* Well sealed nonsense is refused, or harmless: it may be added and stepped. */
START_TEST(forged_words) {
  static const int64_t odd[] = {
      0, 1, -1, 16, 17, INT64_MAX, INT64_MIN, 0x7ff8000000000000, 0x7fefffffffffffff, 48};
  const int64_t ids[] = {2, 5, 4};
  const saved_state packed = pack_some(&from, 0, 3, ids);
  unsigned char *data = malloc((size_t)packed.bytes);
  int32_t taken = 0;
  for (int64_t at = sizeof(mpmi_state_header); at < packed.bytes; at += 8)
    for (size_t k = 0; k < sizeof odd / sizeof *odd; ++k) {
      memcpy(data, packed.data, (size_t)packed.bytes);
      memcpy(data + at, &odd[k], 8);
      seal(data, packed.bytes);
      const mpm_status status = unpack_copy(&to, 0, data, packed.bytes);
      ck_assert_msg(status == MPM_OK || status == MPM_E_FORMAT || status == MPM_E_ARG, "word %lld: %s",
                    (long long)at, last_error_of(&to));
      ck_assert_int_eq(mpm_particles_count(to.set[0]), status ? 0 : 3);
      if (status) continue;
      ++taken;
      mpm_step(to.stepper, 1e-3, NULL);
      remove_all(&to, 0);
    }
  ck_assert_int_gt(taken, 10);
  free(data), free(packed.data);
}
END_TEST

/* An id that stands there twice, one below 0, and values that a step could not bear. */
START_TEST(forged_values) {
  const int64_t ids[] = {2, 5};
  const double bad = NOT_A_NUMBER, none = 0.0;
  const saved_state packed = pack_some(&from, 0, 2, ids);
  const struct {
    const void *find, *write;
    const char *text;
  } forged[] = {{&ids[1], &ids[0], "an id stands there twice"},
                {&ids[1], &(int64_t){-1}, "its ids make no sense"},
                {&ids[1], &(int64_t){INT64_MAX}, "its ids make no sense"},
                {mpmi_f64(from.set[0], MPMI_INITIAL_VOLUME, 0), &none, "values of"},
                {mpmi_f64(from.set[0], MPMI_VELOCITY, 0) + mpmi_index_find(from.set[0], 2), &bad,
                 "values of velocity make no sense"}};
  unsigned char *data = malloc((size_t)packed.bytes);
  to.set[0]->dirty = 0;
  for (size_t k = 0; k < sizeof forged / sizeof *forged; ++k) {
    int64_t at = packed.bytes - 8;
    memcpy(data, packed.data, (size_t)packed.bytes);
    while (at > 0 && memcmp(data + at, forged[k].find, 8) != 0) at -= 8;
    ck_assert_int_gt(at, 0);
    memcpy(data + at, forged[k].write, 8);
    seal(data, packed.bytes);
    refuses(data, packed.bytes, forged[k].text);
  }
  free(data), free(packed.data);
}
END_TEST

/* ---- memory ---- */
/* Every allocation fails once, in a set that has room for nothing yet: the call says so and leaves the set as
 * it was, and then goes through. */
START_TEST(memory_runs_out) {
  const saved_state packed = pack_all(&from, 0);
  int32_t failures = 0;
  const int64_t id = 1;
  const world_desc desc = to.desc;
  for (mpm_status status = MPM_E_NOMEM; status; ++failures) {
    world_close(&to);
    world_open(&to, &desc);
    add_host_fields(&to);
    const saved_state before = pack_all(&to, 0);
    to.memory.fail_at = to.memory.calls + 1 + failures;
    status = unpack_copy(&to, 0, packed.data, packed.bytes);
    to.memory.fail_at = 0;
    if (status) {
      const saved_state after = pack_all(&to, 0);
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert(after.bytes == before.bytes && !memcmp(after.data, before.data, (size_t)after.bytes));
      free(after.data);
      ck_ok(&to, unpack_copy(&to, 0, packed.data, packed.bytes));
      same_set(&from, &to, 0, "memory");
    }
    free(before.data);
  }
  ck_assert_int_gt(failures, 50);
  same_set(&from, &to, 0, "memory");
  failures = 0;
  unsigned char *data = malloc((size_t)packed.bytes);
  for (mpm_status status = MPM_E_NOMEM; status; ++failures) {
    mpmi_index_drop(from.set[0]);
    from.memory.fail_at = from.memory.calls + 1 + failures;
    status = mpm_particles_pack(from.set[0], 1, &id, data, packed.bytes);
    from.memory.fail_at = 0;
    ck_assert(!status || status == MPM_E_NOMEM);
  }
  ck_assert_int_gt(failures, 2);
  free(data), free(packed.data);
}
END_TEST

Suite *packed_suite(void) {
  Suite *suite = suite_create("packed");
  TCase *bits = tcase_create("bits");
  tcase_set_timeout(bits, 120);
  tcase_add_unchecked_fixture(bits, set_up_list, tear_down_list);
  tcase_add_loop_test(bits, every_method, 0, SAMPLE);
  tcase_add_loop_test(bits, every_law, 0, 3 * LAWS);
  tcase_add_loop_test(bits, every_geometry, 0, 3);
  tcase_add_test(bits, portions);
  tcase_add_test(bits, values_that_are_lacking);
  suite_add_tcase(suite, bits);
  TCase *some = tcase_create("some");
  tcase_add_checked_fixture(some, open_square, close_both);
  tcase_add_test(some, some_in_an_order);
  tcase_add_test(some, no_particles);
  tcase_add_test(some, another_grid);
  tcase_add_test(some, accelerations);
  tcase_add_test(some, bad_arguments);
  tcase_add_test(some, at_a_bad_time);
  tcase_add_test(some, unlike_setups);
  tcase_add_test(some, unlike_fields);
  tcase_add_test(some, ids_in_use);
  suite_add_tcase(suite, some);
  TCase *damage = tcase_create("damage");
  tcase_set_timeout(damage, 120);
  tcase_add_checked_fixture(damage, open_line, close_both);
  tcase_add_test(damage, truncated_at_every_length);
  tcase_add_test(damage, every_byte_counts);
  tcase_add_test(damage, foreign_data);
  tcase_add_test(damage, forged_words);
  tcase_add_test(damage, forged_values);
  tcase_add_test(damage, memory_runs_out);
  suite_add_tcase(suite, damage);
  return suite;
}
