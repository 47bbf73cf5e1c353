/* States in files: the path holds the old state or the new one. */
#define _POSIX_C_SOURCE 200809L
#include "io.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char directory[512], path[640];

static void make_directory(void) {
  scratch_path("state_files", directory, sizeof directory);
  mkdir(directory, 0777);
  snprintf(path, sizeof path, "%s/run.state", directory);
  unlink(path);
}

/* Files in the directory, none of which is a temporary one. */
static int32_t count_files(void) {
  int32_t count = 0;
  DIR *open = opendir(directory);
  ck_assert_ptr_nonnull(open);
  for (struct dirent *entry = readdir(open); entry; entry = readdir(open)) {
    ck_assert_msg(!strstr(entry->d_name, ".tmp"), "%s is left behind", entry->d_name);
    count += entry->d_name[0] != '.';
  }
  closedir(open);
  return count;
}

START_TEST(round_trip) {
  const io_setup setup = {_i, MPM_APIC, MPM_USL, 0, 1, 0, 0};
  world a, b;
  io_open(&a, &setup);
  io_open(&b, &setup);
  for (int32_t k = 0; k < 3; ++k) { /* also over an older state */
    world_steps(&a, 4);
    ck_ok(&a, mpm_state_save_file(a.stepper, path));
    ck_ok(&b, mpm_state_load_file(b.stepper, path));
    ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  }
  ck_assert_int_eq(count_files(), 1);
  const saved_state saved = world_save(&a);
  unsigned char *data = malloc((size_t)saved.bytes + 1);
  FILE *file = fopen(path, "rb");
  ck_assert_int_eq((int64_t)fread(data, 1, (size_t)saved.bytes + 1, file), saved.bytes);
  fclose(file);
  ck_assert_mem_eq(data, saved.data, (size_t)saved.bytes);
  free(data);
  free(saved.data);
  world_close(&a);
  world_close(&b);
}
END_TEST

START_TEST(bad_paths) {
  const io_setup setup = io_plain(1);
  world w;
  io_open(&w, &setup);
  char missing[700];
  snprintf(missing, sizeof missing, "%s/no/such/place", directory);
  ck_refused(&w, mpm_state_save_file(w.stepper, NULL), MPM_E_ARG, "path is NULL");
  ck_refused(&w, mpm_state_load_file(w.stepper, NULL), MPM_E_ARG, "path is NULL");
  ck_refused(&w, mpm_state_save_file(w.stepper, ""), MPM_E_ARG, "empty");
  ck_refused(&w, mpm_state_save_file(w.stepper, missing), MPM_E_IO, missing);
  ck_refused(&w, mpm_state_load_file(w.stepper, missing), MPM_E_IO, "No such file");
  ck_refused(&w, mpm_state_save_file(w.stepper, directory), MPM_E_IO, "not a regular file");
  ck_refused(&w, mpm_state_load_file(w.stepper, directory), MPM_E_IO, directory);
  ck_assert_int_eq(count_files(), 0);
  world_close(&w);
}
END_TEST

static void write_bytes(const void *data, size_t bytes) {
  FILE *file = fopen(path, "wb");
  ck_assert_ptr_nonnull(file);
  ck_assert_uint_eq(fwrite(data, 1, bytes, file), bytes);
  fclose(file);
}

START_TEST(foreign_files) {
  const io_setup setup = io_plain(1);
  world w;
  io_open(&w, &setup);
  const saved_state saved = world_save(&w);
  write_bytes("", 0);
  ck_refused(&w, mpm_state_load_file(w.stepper, path), MPM_E_FORMAT, "too few");
  write_bytes("a text that has nothing to do with it at all", 44);
  ck_refused(&w, mpm_state_load_file(w.stepper, path), MPM_E_FORMAT, "not a state");
  write_bytes(saved.data, (size_t)saved.bytes - 100);
  ck_refused(&w, mpm_state_load_file(w.stepper, path), MPM_E_FORMAT, "of which there are");
  saved.data[saved.bytes / 2] ^= 16;
  write_bytes(saved.data, (size_t)saved.bytes);
  ck_refused(&w, mpm_state_load_file(w.stepper, path), MPM_E_FORMAT, "checksum");
  free(saved.data);
  world_close(&w);
}
END_TEST

/* Storage that is full in the middle of the file, by a limit on its size. */
static mpm_status save_with_limit(const world *w, rlim_t bytes) {
  struct rlimit old, low;
  getrlimit(RLIMIT_FSIZE, &old);
  low = old;
  low.rlim_cur = bytes;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &low);
  const mpm_status status = mpm_state_save_file(w->stepper, path);
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, handler);
  return status;
}

START_TEST(full_storage_keeps_the_old_state) {
  const io_setup setup = io_plain(2);
  world w;
  io_open(&w, &setup);
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  const uint64_t old = world_hash(&w);
  world_steps(&w, 2);
  int64_t bytes;
  ck_ok(&w, mpm_state_size(w.stepper, &bytes));
  for (int64_t limit = 0; limit < bytes; limit += bytes / 7)
    ck_refused(&w, save_with_limit(&w, (rlim_t)limit), MPM_E_IO, "File too large");
  ck_assert_int_eq(count_files(), 1);
  ck_ok(&w, mpm_state_load_file(w.stepper, path));
  ck_assert_uint_eq(world_hash(&w), old);
  world_close(&w);
}
END_TEST

START_TEST(every_failing_allocation) {
  const io_setup setup = io_plain(1);
  world w;
  io_open(&w, &setup);
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  const uint64_t hash = world_hash(&w);
  for (int32_t load = 0; load < 2; ++load) {
    mpm_status status = MPM_E_NOMEM;
    for (int64_t k = 1; status; ++k) {
      w.memory.calls = 0;
      w.memory.fail_at = k;
      status = load ? mpm_state_load_file(w.stepper, path) : mpm_state_save_file(w.stepper, path);
      w.memory.fail_at = 0;
      ck_assert(status == MPM_OK || status == MPM_E_NOMEM);
      ck_assert_uint_eq(world_hash(&w), hash);
      ck_assert_int_eq(count_files(), 1);
    }
  }
  world_close(&w);
}
END_TEST

TCase *io_file_case(void) {
  TCase *tests = tcase_create("files");
  tcase_add_checked_fixture(tests, make_directory, NULL);
  tcase_add_loop_test(tests, round_trip, 1, 4);
  tcase_add_test(tests, bad_paths);
  tcase_add_test(tests, foreign_files);
  tcase_add_test(tests, full_storage_keeps_the_old_state);
  tcase_add_test(tests, every_failing_allocation);
  return tests;
}
