/* What a written file takes over from the one whose place it takes: links, mode, owner; and what writers
 * leave behind that die. */
#define _POSIX_C_SOURCE 200809L
#define _DEFAULT_SOURCE 1 /* flock */
#include "io.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static char folder[512], path[640], other[640];
static world w;

static int32_t count_files(const char *with) {
  int32_t count = 0;
  DIR *open_folder = opendir(folder);
  ck_assert_ptr_nonnull(open_folder);
  for (struct dirent *entry = readdir(open_folder); entry; entry = readdir(open_folder))
    count += entry->d_name[0] != '.' && strstr(entry->d_name, with) != NULL;
  closedir(open_folder);
  return count;
}

static void in_folder(const char *name, char *out) {
  snprintf(out, 640, "%s/%s", folder, name);
}

static void leave(const char *name, const char *contents) {
  FILE *file = fopen(name, "wb");
  ck_assert_ptr_nonnull(file);
  fputs(contents, file);
  fclose(file);
}

static mode_t mode_of(const char *name) {
  struct stat info;
  ck_assert_int_eq(stat(name, &info), 0);
  return info.st_mode & 07777;
}

static void open_all(void) {
  scratch_path("replaced_XXXXXX", folder, sizeof folder);
  ck_assert_ptr_nonnull(mkdtemp(folder));
  in_folder("run.state", path);
  in_folder("other", other);
  const io_setup setup = io_plain(2);
  io_open(&w, &setup);
}

static void close_all(void) {
  world_close(&w);
}

/* Writes of every kind: a state, and the same way particles and nodes. */
static mpm_status write_kind(int32_t kind) {
  return kind == 0   ? mpm_state_save_file(w.stepper, path)
         : kind == 1 ? mpm_write_particles(w.set[0], path, 0, NULL)
                     : mpm_write_grid(w.stepper, path, 0, NULL);
}

START_TEST(links_are_followed) {
  world_steps(&w, 1);
  char target[640], inner[640];
  in_folder("inner", inner);
  ck_assert_int_eq(mkdir(inner, 0777), 0);
  in_folder("inner/target", target);
  ck_assert_int_eq(symlink("inner/second", path), 0); /* relative to where the link stands */
  in_folder("inner/second", inner);
  ck_assert_int_eq(symlink(target, inner), 0);
  for (int32_t k = 0; k < 2; ++k) { /* what the links lead to does not exist at first */
    ck_ok(&w, write_kind(_i));
    struct stat info;
    ck_assert_int_eq(lstat(path, &info), 0);
    ck_assert_msg(S_ISLNK(info.st_mode), "the link has gone");
    ck_assert_int_eq(lstat(inner, &info), 0);
    ck_assert_msg(S_ISLNK(info.st_mode), "the second link has gone");
    ck_assert_int_eq(lstat(target, &info), 0);
    ck_assert_msg(S_ISREG(info.st_mode) && info.st_size > 0, "the links lead to nothing");
  }
  ck_assert_int_eq(unlink(inner), 0);
  ck_assert_int_eq(symlink("../run.state", inner), 0); /* a circle */
  ck_refused(&w, write_kind(_i), MPM_E_IO, path);
}
END_TEST

START_TEST(mode_is_kept) {
  world_steps(&w, 1);
  const mode_t old_mask = umask(027);
  ck_ok(&w, write_kind(_i));
  ck_assert_int_eq((int)mode_of(path), 0640); /* a new file has what the host gives to new files */
  static const mode_t modes[] = {0600, 0644, 0444, 0666, 0755};
  for (size_t i = 0; i < sizeof modes / sizeof *modes; ++i) {
    ck_assert_int_eq(chmod(path, modes[i]), 0);
    ck_ok(&w, write_kind(_i));
    ck_assert_int_eq((int)mode_of(path), (int)modes[i]);
  }
  umask(old_mask);
  ck_assert_int_eq(count_files(".tmp"), 0);
}
END_TEST

START_TEST(owner_is_kept_where_permitted) {
  leave(path, "");
  const int32_t may = !chown(path, 1234, 4321);
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  struct stat info;
  ck_assert_int_eq(stat(path, &info), 0);
  ck_assert_int_eq((int)info.st_uid, may ? 1234 : (int)geteuid());
  if (may) ck_assert_int_eq((int)info.st_gid, 4321);
  if (geteuid()) return;
  /* Who is not root writes over a file of root's in a folder of everyone's: the file is its own then, and the
   * group that it could not keep takes no rights along. */
  ck_assert_int_eq(chmod(folder, 0777), 0);
  ck_assert_int_eq(chown(path, 0, 0), 0);
  ck_assert_int_eq(chmod(path, 0674), 0);
  fflush(NULL);
  const pid_t child = fork();
  if (!child) {
    if (setgid(4321) || setuid(1234)) _exit(2);
    const mpm_status status = mpm_state_save_file(w.stepper, path);
    _exit(status == MPM_OK ? 0 : 3);
  }
  int status = 0;
  ck_assert_int_eq(waitpid(child, &status, 0), child);
  ck_assert_int_eq(status, 0);
  ck_assert_int_eq(stat(path, &info), 0);
  ck_assert_int_eq((int)info.st_uid, 1234);
  ck_assert_int_eq((int)mode_of(path), 0644);
}
END_TEST

/* A child that writes forever, killed in the middle. */
static void kill_a_writer(void) {
  fflush(NULL);
  const pid_t child = fork();
  ck_assert_int_ge(child, 0);
  if (!child)
    for (;;)
      if (mpm_state_save_file(w.stepper, path)) _exit(1);
  for (int32_t k = 0; k < 20000 && !count_files(".tmp"); ++k) {
    struct timespec little = {0, 100000};
    nanosleep(&little, NULL);
  }
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
}

START_TEST(what_dead_writers_leave_is_removed) {
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  for (int32_t k = 0; k < 30 && !count_files(".tmp"); ++k) kill_a_writer();
  ck_assert_msg(count_files(".tmp") > 0, "no writer was killed before its file was complete");
  ck_ok(&w, mpm_state_load_file(w.stepper, path)); /* the old one, whole */
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  ck_assert_int_eq(count_files(".tmp"), 0);
  ck_assert_int_eq(count_files(""), 1);
}
END_TEST

/* A writer that lives: someone has locked the first name. */
START_TEST(what_living_writers_have_is_left) {
  char taken[700];
  snprintf(taken, sizeof taken, "%s.tmp0", path);
  const int file = open(taken, O_RDWR | O_CREAT | O_EXCL, 0666);
  ck_assert_int_ge(file, 0);
  ck_assert_int_eq(flock(file, LOCK_EX | LOCK_NB), 0);
  for (int32_t k = 0; k < 3; ++k) {
    ck_ok(&w, mpm_state_save_file(w.stepper, path));
    ck_assert_int_eq(access(taken, F_OK), 0);
    ck_assert_int_eq(count_files(""), 2);
  }
  close(file);
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  ck_assert_int_eq(count_files(""), 1);
  /* Of two that were there at once the later one was killed. */
  snprintf(taken, sizeof taken, "%s.tmp1", path);
  leave(taken, "half");
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  ck_assert_int_eq(count_files(""), 1);
}
END_TEST

/* Names that look like a temporary file's and are none: a folder, a link to another file, a pipe. */
START_TEST(what_is_no_temporary_file_is_left) {
  char name[700];
  snprintf(name, sizeof name, "%s.tmp0", path);
  ck_assert_int_eq(mkdir(name, 0777), 0);
  snprintf(name, sizeof name, "%s.tmp1", path);
  leave(other, "precious");
  ck_assert_int_eq(symlink("other", name), 0);
  snprintf(name, sizeof name, "%s.tmp2", path);
  ck_assert_int_eq(mkfifo(name, 0666), 0);
  ck_ok(&w, mpm_state_save_file(w.stepper, path));
  ck_ok(&w, mpm_state_load_file(w.stepper, path));
  ck_assert_int_eq(count_files(".tmp"), 3);
  struct stat info;
  ck_assert_int_eq(stat(other, &info), 0);
  ck_assert_int_eq((int)info.st_size, 8);
}
END_TEST

/* Processes that write the same path side by side: all succeed, what stands there is whole, nothing is
 * left. */
START_TEST(writers_side_by_side) {
  enum { WRITERS = 4 };
  pid_t child[WRITERS];
  fflush(NULL);
  for (int32_t k = 0; k < WRITERS; ++k) {
    child[k] = fork();
    if (child[k]) continue;
    for (int32_t times = 0; times < 25; ++times) {
      const mpm_status status = mpm_state_save_file(w.stepper, path);
      if (status) _exit(1);
      if (mpm_state_load_file(w.stepper, path)) _exit(2);
    }
    _exit(0);
  }
  for (int32_t k = 0; k < WRITERS; ++k) {
    int status = 0;
    ck_assert_int_eq(waitpid(child[k], &status, 0), child[k]);
    ck_assert_int_eq(status, 0);
  }
  ck_ok(&w, mpm_state_load_file(w.stepper, path));
  ck_assert_int_eq(count_files(""), 1);
}
END_TEST

TCase *io_replace_case(void) {
  TCase *tests = tcase_create("replaced files");
  tcase_add_checked_fixture(tests, open_all, close_all);
  tcase_set_timeout(tests, 30);
  tcase_add_loop_test(tests, links_are_followed, 0, 3);
  tcase_add_loop_test(tests, mode_is_kept, 0, 3);
  tcase_add_test(tests, owner_is_kept_where_permitted);
  tcase_add_test(tests, what_dead_writers_leave_is_removed);
  tcase_add_test(tests, what_living_writers_have_is_left);
  tcase_add_test(tests, what_is_no_temporary_file_is_left);
  tcase_add_test(tests, writers_side_by_side);
  return tests;
}
