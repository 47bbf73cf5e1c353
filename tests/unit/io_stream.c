/* Output through a callback: the bytes are those of the file, and a host that refuses them ends the call. */
#include "io.h"

enum { PIECE = 65536 };
enum { PARTICLES, SOME_OF_PARTICLES, GRID, OTHER_BODY, STATE, OUTPUTS };

/* What the callback has taken, and which of its calls, from 1, gets another answer than 0. */
typedef struct stream {
  unsigned char *data;
  int64_t bytes, room;
  int32_t calls, refused, ended;
  mpm_status answer;
} stream;

static mpm_status take(void *user, const void *data, int64_t bytes) {
  stream *s = user;
  ck_holds(!s->ended && bytes > 0 && bytes <= PIECE); /* only the last piece may be smaller */
  s->ended = bytes < PIECE;
  if (++s->calls == s->refused) {
    s->ended = 1;
    return s->answer;
  }
  if (s->room - s->bytes < bytes) {
    s->room = 2 * s->room + PIECE;
    s->data = realloc(s->data, (size_t)s->room);
  }
  memcpy(s->data + s->bytes, data, (size_t)bytes);
  s->bytes += bytes;
  return MPM_OK;
}

static void drop(stream *s) {
  free(s->data);
  *s = (stream){0};
}

static const char *const some[] = {"velocity", "mass"};

static mpm_status stream_out(const world *w, int32_t output, mpm_write_fn write, void *user) {
  switch (output) {
  case PARTICLES:
    return mpm_write_particles_to(w->set[0], write, user, 0, NULL);
  case SOME_OF_PARTICLES:
    return mpm_write_particles_to(w->set[1], write, user, 2, some);
  case GRID:
    return mpm_write_grid_to(w->stepper, 0, write, user, 0, NULL);
  case OTHER_BODY:
    return mpm_write_grid_to(w->stepper, 1, write, user, 2, some);
  default:
    return mpm_state_save_to(w->stepper, write, user);
  }
}

static mpm_status write_file(const world *w, int32_t output, const char *path) {
  switch (output) {
  case PARTICLES:
    return mpm_write_particles(w->set[0], path, 0, NULL);
  case SOME_OF_PARTICLES:
    return mpm_write_particles(w->set[1], path, 2, some);
  case GRID:
    return mpm_write_grid(w->stepper, path, 0, NULL);
  case OTHER_BODY:
    return mpm_write_body_grid(w->stepper, 1, path, 2, some);
  default:
    return mpm_state_save_file(w->stepper, path);
  }
}

/* Returns how many pieces there were. */
static int32_t compare(const world *w, int32_t output) {
  char path[640];
  stream s = {0};
  scratch_path("stream", path, sizeof path);
  ck_ok(w, write_file(w, output, path));
  ck_ok(w, stream_out(w, output, take, &s));
  FILE *file = fopen(path, "rb");
  ck_assert_ptr_nonnull(file);
  unsigned char *wanted = malloc((size_t)s.bytes + 1);
  ck_assert_int_eq((int64_t)fread(wanted, 1, (size_t)s.bytes + 1, file), s.bytes);
  fclose(file);
  for (int64_t i = 0; i < s.bytes; ++i)
    if (s.data[i] != wanted[i]) ck_abort_msg("output %d: byte %lld differs", (int)output, (long long)i);
  free(wanted);
  const int32_t calls = s.calls;
  drop(&s);
  return calls;
}

/* Two bodies, each in a field of its own, after a step. */
static void open_streams(world *w, int32_t dim, int32_t open) {
  mpm_grid_desc grid = grid_desc(dim, 20, 0.1);
  grid.basis = MPM_BSPLINE2;
  grid.boundary_basis = open ? MPM_BOUNDARY_OPEN_KNOT : MPM_BOUNDARY_GHOST;
  const world_desc d = io_bare_desc(&grid);
  world_open(w, &d);
  ck_ok(w, mpm_particles_add_field(w->set[0], "colour", MPM_U8, 3));
  world_fill_cube(w, w->set[0], 0.3, 0.9);
  world_fill_cube(w, w->set[1], 1.2, 1.7);
  ck_ok(w, mpm_stepper_set_body(w->stepper, w->set[1], 1));
  world_step(w, 1e-5);
}

START_TEST(the_bytes_of_the_file) {
  const int32_t dim = 1 + _i % 3, open = _i / 3;
  world w;
  open_streams(&w, dim, open);
  for (int32_t output = 0; output < OUTPUTS; ++output) {
    const int32_t calls = compare(&w, output);
    if (dim == 3 && (output == PARTICLES || output == GRID || output == STATE)) ck_assert_int_gt(calls, 1);
  }
  stream s = {0};
  ck_ok(&w, stream_out(&w, GRID, take, &s));
  s.data[100] = '\0';
  ck_assert_ptr_nonnull(strstr((char *)s.data, open ? "type=\"RectilinearGrid\"" : "type=\"ImageData\""));
  drop(&s);
  world_close(&w);
}
END_TEST

/* What is a hole in a file is zeros in a stream. */
START_TEST(zeros_between_bodies) {
  static const char *const mass[] = {"mass"};
  world w;
  io_open_apart(&w, 2, 700);
  int64_t before, peak;
  ck_ok(&w, mpm_context_memory(w.context, &before, NULL));
  ck_assert_int_gt(compare(&w, GRID), 700 * 700 * 8 / PIECE);
  ck_ok(&w, mpm_context_memory(w.context, NULL, &peak));
  ck_assert_int_lt(peak - before, PIECE + 100000);
  world_close(&w);
  io_open_apart(&w, 3, 900000); /* no one waits for all of them */
  stream s = {.refused = 40, .answer = 1};
  ck_refused(&w, mpm_write_grid_to(w.stepper, 0, take, &s, 1, mass), MPM_E_CALLBACK, "returned 1 after");
  ck_assert_int_eq(s.calls, 40);
  drop(&s);
  world_close(&w);
}
END_TEST

/* The host refuses the first piece, one in the middle or the last one; nothing has changed then. */
START_TEST(hosts_that_refuse) {
  static const mpm_status answers[] = {7, -3};
  world w;
  open_streams(&w, 3, 0);
  for (int32_t output = 0; output < OUTPUTS; ++output) {
    const int32_t calls = compare(&w, output);
    const uint64_t hash = world_hash(&w);
    const int64_t held = w.memory.held;
    for (int32_t k = 0; k < 3; ++k) {
      stream s = {.refused = k == 0 ? 1 : k == 1 ? 1 + calls / 2 : calls, .answer = answers[k % 2]};
      char text[80];
      snprintf(text, sizeof text, "takes the output returned %d after %d bytes", (int)s.answer,
               (int)(s.refused - 1) * PIECE);
      ck_refused(&w, stream_out(&w, output, take, &s), MPM_E_CALLBACK, text);
      ck_assert_int_eq(s.calls, s.refused);
      ck_assert_int_eq(w.memory.held, held);
      drop(&s);
    }
    ck_assert_uint_eq(world_hash(&w), hash);
    ck_assert_int_eq(compare(&w, output), calls);
  }
  ck_assert_int_eq(world_info(&w).callback_status, 0);
  world_close(&w);
}
END_TEST

START_TEST(no_memory_for_a_piece) {
  world w;
  open_streams(&w, 2, 0);
  for (int32_t output = 0; output < OUTPUTS; ++output) {
    mpm_status status = MPM_E_NOMEM;
    int32_t failures = -1;
    stream s = {0};
    for (int64_t k = 1; status; ++k, ++failures) {
      w.memory.calls = 0;
      w.memory.fail_at = k;
      status = stream_out(&w, output, take, &s);
      ck_assert(!status || (status == MPM_E_NOMEM && !s.calls));
    }
    w.memory.fail_at = 0;
    ck_assert_int_ge(failures, 1);
    drop(&s);
  }
  world_close(&w);
}
END_TEST

START_TEST(stream_arguments) {
  const io_setup setup = io_plain(2);
  const char *const bad[] = {"velocty"}, *const twice[] = {"mass", "mass"};
  world w;
  stream s = {0};
  io_open(&w, &setup);
  mpm_context *c = w.context;
  ck_assert_int_eq(mpm_write_particles_to(NULL, take, &s, 0, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_write_grid_to(NULL, 0, take, &s, 0, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_state_save_to(NULL, take, &s), MPM_E_ARG);
  for (int32_t output = 0; output < OUTPUTS; ++output)
    ck_refused(c, stream_out(&w, output, NULL, &s), MPM_E_ARG, "write is NULL");
  ck_refused(c, mpm_write_particles_to(w.set[0], take, &s, -1, bad), MPM_E_ARG, "count is -1");
  ck_refused(c, mpm_write_particles_to(w.set[0], take, &s, 1, NULL), MPM_E_ARG, "fields is NULL");
  ck_refused(c, mpm_write_particles_to(w.set[0], take, &s, 1, bad), MPM_E_NOT_FOUND, "nearest: velocity");
  ck_refused(c, mpm_write_particles_to(w.set[0], take, &s, 2, twice), MPM_E_ARG, "is named twice");
  ck_refused(c, mpm_write_grid_to(w.stepper, 0, take, &s, 0, NULL), MPM_E_STATE, "no nodal fields");
  world_steps(&w, 1);
  ck_refused(c, mpm_write_grid_to(w.stepper, 0, take, &s, 1, bad), MPM_E_NOT_FOUND, "nearest: velocity");
  ck_refused(c, mpm_write_grid_to(w.stepper, 0, take, &s, 2, twice), MPM_E_ARG, "is named twice");
  ck_refused(c, mpm_write_grid_to(w.stepper, 5, take, &s, 0, NULL), MPM_E_NOT_FOUND, "body is 5");
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(c, mpm_particles_map(w.set[0], "velocity", MPM_READ | MPM_WRITE, &view));
  ck_refused(c, mpm_state_save_to(w.stepper, take, &s), MPM_E_STATE, "mapped for writing");
  ck_ok(c, mpm_view_release(&view));
  ck_ok(c, mpm_step_begin(w.stepper, 1e-4));
  ck_refused(c, mpm_state_save_to(w.stepper, take, &s), MPM_E_STATE, "a step is under way");
  ck_assert_int_eq(s.calls, 0);
  ck_ok(c, mpm_write_grid_to(w.stepper, 0, take, &s, 0, NULL));
  ck_ok(c, mpm_step_abort(w.stepper));
  drop(&s);
  world_close(&w);
}
END_TEST

/* A host that writes where it may only read, in the middle of a state, does not get a damaged one for a good
 * one. */
typedef struct meddler {
  stream taken;
  double *value;
} meddler;

static mpm_status take_and_meddle(void *user, const void *data, int64_t bytes) {
  meddler *m = user;
  if (m->value && !m->taken.calls) *m->value += 1.0;
  return take(&m->taken, data, bytes);
}

START_TEST(a_state_that_changes_meanwhile) {
  world w;
  open_streams(&w, 3, 0);
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&w, mpm_particles_map(w.set[1], "velocity", MPM_READ, &view));
  const double was = *(double *)view.data;
  for (int32_t meddles = 0; meddles < 2; ++meddles) {
    meddler m = {.value = meddles ? view.data : NULL};
    if (meddles)
      ck_refused(&w, mpm_state_save_to(w.stepper, take_and_meddle, &m), MPM_E_STATE, "changed while");
    else
      ck_ok(&w, mpm_state_save_to(w.stepper, take_and_meddle, &m));
    *(double *)view.data = was;
    ck_assert_int_gt(m.taken.calls, 1);
    drop(&m.taken);
  }
  ck_ok(&w, mpm_view_release(&view));
  world_close(&w);
}
END_TEST

/* Pieces are full whatever is written at a time, and none is empty. */
START_TEST(pieces) {
  static const int64_t sizes[] = {0, 1, PIECE - 1, PIECE, PIECE + 1, 3 * PIECE};
  static const int64_t portions[] = {1, 4096, 65521, 3 * PIECE};
  static unsigned char data[3 * PIECE];
  mpm_context *c = context_with(1, MPM_ISA_BEST, NULL);
  for (int64_t i = 0; i < 3 * PIECE; ++i) data[i] = (unsigned char)(i * 31 % 251);
  for (int32_t k = 0; k < 6 * 4; ++k) {
    const int64_t size = sizes[k / 4], portion = portions[k % 4];
    stream s = {0};
    mpmi_output out;
    ck_ok(c, mpmi_output_open(&out, c, &(mpmi_target){.write = take, .user = &s}));
    for (int64_t at = 0; at < size; at += portion)
      mpmi_output_write(&out, data + at, (size_t)(size - at < portion ? size - at : portion));
    ck_ok(c, mpmi_output_close(&out, 0));
    ck_assert_int_eq(s.bytes, size);
    ck_assert_int_eq(s.calls, (size + PIECE - 1) / PIECE);
    ck_assert(!size || !memcmp(s.data, data, (size_t)size));
    drop(&s);
  }
  ck_ok(c, mpm_context_destroy(c));
}
END_TEST

TCase *io_stream_case(void) {
  TCase *tests = tcase_create("streams");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, the_bytes_of_the_file, 0, 6);
  tcase_add_test(tests, zeros_between_bodies);
  tcase_add_test(tests, hosts_that_refuse);
  tcase_add_test(tests, no_memory_for_a_piece);
  tcase_add_test(tests, stream_arguments);
  tcase_add_test(tests, a_state_that_changes_meanwhile);
  tcase_add_test(tests, pieces);
  return tests;
}
