/* Buffers that are not what mpm_state_save() wrote. */
#include "io.h"

static world w;
static saved_state saved;
static uint64_t before;

/* A small sorted state, and a world to load it into. */
static void open_in(int32_t dim) {
  const io_setup setup = {
      .dim = dim, .transfer = MPM_APIC, .scheme = MPM_USL, .periodic = dim > 1, .concurrency = 1};
  world from;
  io_open(&from, &setup);
  world_steps(&from, 1);
  ck_assert_int_eq(mpmi_state_is_sorted(from.stepper), 1);
  saved = world_save(&from);
  world_close(&from);
  io_open(&w, &setup);
  before = world_hash(&w);
}

static void open_small(void) {
  open_in(1);
}

static void close_small(void) {
  free(saved.data);
  world_close(&w);
}

/* Copies, so that reading past the end is noticed by memory checkers. */
static mpm_status load_copy(const unsigned char *data, int64_t bytes) {
  unsigned char *copy = malloc((size_t)bytes + (bytes == 0));
  memcpy(copy, data, (size_t)bytes);
  const mpm_status status = mpm_state_load(w.stepper, copy, bytes);
  free(copy);
  return status;
}

static void refuses(const unsigned char *data, int64_t bytes, const char *text) {
  ck_refused(&w, load_copy(data, bytes), MPM_E_FORMAT, text);
  ck_assert_uint_eq(world_hash(&w), before);
}

START_TEST(truncated_at_every_length) {
  for (int64_t bytes = 0; bytes < saved.bytes; ++bytes) refuses(saved.data, bytes, "");
  refuses(saved.data, 31, "too few");
  refuses(saved.data, saved.bytes - 1, "of which there are");
}
END_TEST

START_TEST(every_byte_counts) {
  for (int64_t i = 0; i < saved.bytes; ++i) {
    const unsigned char kept = saved.data[i];
    saved.data[i] = (unsigned char)(kept ^ (1u << i % 8));
    refuses(saved.data, saved.bytes, "");
    saved.data[i] = kept;
  }
  ck_ok(&w, load_copy(saved.data, saved.bytes));
}
END_TEST

START_TEST(foreign_data) {
  unsigned char *data = calloc(1, (size_t)saved.bytes + 8);
  refuses(data, saved.bytes, "not a state");
  memcpy(data, saved.data, (size_t)saved.bytes);
  refuses(data, saved.bytes + 8, "of which there are");
  for (int32_t i = 0; i < 4; ++i) data[8 + i] = saved.data[11 - i];
  refuses(data, saved.bytes, "byte order");
  memcpy(data, saved.data, (size_t)saved.bytes);
  data[12] = MPMI_STATE_FORMAT + 1;
  refuses(data, saved.bytes, "this library knows format");
  free(data);
}
END_TEST

START_TEST(buffers_need_no_alignment) {
  unsigned char *data = malloc((size_t)saved.bytes + 1);
  memcpy(data + 1, saved.data, (size_t)saved.bytes);
  ck_ok(&w, mpm_state_load(w.stepper, data + 1, saved.bytes));
  ck_ok(&w, mpm_state_save(w.stepper, data + 1, saved.bytes));
  ck_assert_mem_eq(data + 1, saved.data, (size_t)saved.bytes);
  free(data);
}
END_TEST

/* Gives changed contents the checksum that belongs to them. */
static void seal(unsigned char *data, int64_t bytes) {
  mpmi_state_header header;
  mpmi_checksum sum;
  mpmi_checksum_begin(&sum);
  mpmi_checksum_add(&sum, data + sizeof header, bytes - (int64_t)sizeof header);
  memcpy(&header, data, sizeof header);
  header.bytes = bytes;
  header.checksum = mpmi_checksum_end(&sum);
  memcpy(data, &header, sizeof header);
}

static uint64_t next_random(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return *state >> 20;
}

/* Well sealed nonsense is refused, or harmless: it may be loaded and stepped. */
static void try_forged(const unsigned char *data, int64_t bytes) {
  const mpm_status status = load_copy(data, bytes);
  if (status) {
    ck_assert_int_eq(status, MPM_E_FORMAT);
    ck_assert_uint_eq(world_hash(&w), before);
    return;
  }
  for (int32_t i = 0; i < 3; ++i) mpm_step(w.stepper, 1e-3, NULL);
  ck_ok(&w, load_copy(saved.data, saved.bytes));
  before = world_hash(&w);
}

START_TEST(forged_words) {
  static const int64_t odd[] = {
      0, 1, -1, 16, 17, INT64_MAX, INT64_MIN, 0x7ff8000000000000, 0x7fefffffffffffff, 48};
  unsigned char *data = malloc((size_t)saved.bytes);
  ck_ok(&w, load_copy(saved.data, saved.bytes));
  before = world_hash(&w);
  for (int64_t at = sizeof(mpmi_state_header); at < saved.bytes; at += 8)
    for (size_t k = 0; k < sizeof odd / sizeof *odd; ++k) {
      memcpy(data, saved.data, (size_t)saved.bytes);
      memcpy(data + at, &odd[k], 8);
      seal(data, saved.bytes);
      try_forged(data, saved.bytes);
    }
  free(data);
}
END_TEST

/* Fields that steps write and never read hold numbers too. */
START_TEST(forged_fields) {
  static const char *const field[] = {"acceleration", "reference_position"};
  const double mark[] = {12345.678}, bad = NOT_A_NUMBER;
  io_setup setup = io_plain(1);
  setup.references = 1;
  world other;
  io_open(&other, &setup);
  for (int32_t i = 0; i < 2; ++i) {
    ck_ok(&other, mpm_particles_set_all(other.set[0], field[i], MPM_F64, 1, mark));
    const saved_state good = world_save(&other);
    int64_t found = 0;
    for (int64_t at = 0; at + 8 <= good.bytes && !found; at += 8)
      if (!memcmp(good.data + at, mark, 8)) found = at;
    ck_assert_int_gt(found, 0);
    memcpy(good.data + found, &bad, 8);
    seal(good.data, good.bytes);
    const uint64_t hash = world_hash(&other);
    ck_refused(&other, mpm_state_load(other.stepper, good.data, good.bytes), MPM_E_FORMAT, field[i]);
    ck_assert_uint_eq(world_hash(&other), hash);
    memcpy(good.data + found, mark, 8);
    seal(good.data, good.bytes);
    world_load(&other, &good);
    ck_ok(&other, mpm_particles_set_all(other.set[0], field[i], MPM_F64, 1, (double[]){0.5}));
    free(good.data);
  }
  world_close(&other);
}
END_TEST

/* A volume that does not follow from F is made anew: a step that fails leaves what was loaded. */
START_TEST(forged_volume) {
  const io_setup setup = io_plain(2);
  const double force[] = {1e300, 0.0};
  world other;
  io_open(&other, &setup);
  world_steps(&other, 1);
  const saved_state good = world_save(&other);
  const uint64_t hash = world_hash(&other);
  double *volume = mpmi_f64(other.set[1], MPMI_VOLUME, 0);
  int32_t found = 0;
  for (int64_t at = 0; at + 8 <= good.bytes; at += 8)
    if (!memcmp(good.data + at, volume, 8)) {
      const double twice = 2.0 * *volume;
      memcpy(good.data + at, &twice, 8);
      ++found;
      break;
    }
  ck_assert_int_eq(found, 1);
  seal(good.data, good.bytes);
  world_load(&other, &good);
  ck_assert_uint_eq(world_hash(&other), hash);
  ck_ok(&other, mpm_particles_set_all(other.set[0], "applied_force", MPM_F64, 2, force));
  const uint64_t loaded = world_hash(&other);
  ck_assert_int_gt(mpm_step(other.stepper, 1e200, NULL), 0);
  ck_assert_uint_eq(world_hash(&other), loaded);
  free(good.data);
  world_close(&other);
}
END_TEST

/* Half of the changes hit the beginning: setup, numbers and blocks, which decide how the rest is read. */
START_TEST(forged_at_random) {
  close_small();
  open_in(_i);
  const int64_t head = sizeof(mpmi_state_header), span = saved.bytes - head,
                first = span < 5000 ? span : 5000;
  unsigned char *data = malloc((size_t)saved.bytes);
  uint64_t random = 7;
  ck_ok(&w, load_copy(saved.data, saved.bytes));
  before = world_hash(&w);
  for (int32_t i = 0; i < 2000; ++i) {
    memcpy(data, saved.data, (size_t)saved.bytes);
    int64_t bytes = saved.bytes;
    const uint64_t changes = 1 + next_random(&random) % 4;
    for (uint64_t k = 0; k < changes; ++k) {
      const int64_t among = next_random(&random) % 2 ? first : span;
      data[head + (int64_t)(next_random(&random) % (uint64_t)among)] = (unsigned char)next_random(&random);
    }
    if (i % 5 == 0) bytes -= 8 * (int64_t)(next_random(&random) % 40);
    seal(data, bytes);
    try_forged(data, bytes);
  }
  free(data);
}
END_TEST

TCase *io_damage_case(void) {
  TCase *tests = tcase_create("damaged states");
  tcase_set_timeout(tests, 120);
  tcase_add_checked_fixture(tests, open_small, close_small);
  tcase_add_test(tests, truncated_at_every_length);
  tcase_add_test(tests, every_byte_counts);
  tcase_add_test(tests, foreign_data);
  tcase_add_test(tests, buffers_need_no_alignment);
  tcase_add_test(tests, forged_words);
  tcase_add_test(tests, forged_fields);
  tcase_add_test(tests, forged_volume);
  tcase_add_loop_test(tests, forged_at_random, 1, 4);
  return tests;
}
