/* Files for visualisation: what is refused, and what stands in a series.
 * Their contents are read with VTK elsewhere. */
#define _POSIX_C_SOURCE 200809L
#include "io.h"

#include <locale.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

static char path[640], text[1 << 16];

static const char *contents(void) {
  FILE *file = fopen(path, "rb");
  ck_assert_ptr_nonnull(file);
  const size_t bytes = fread(text, 1, sizeof text - 1, file);
  fclose(file);
  text[bytes] = '\0';
  return text;
}

static void contains(const char *wanted) {
  if (!strstr(contents(), wanted)) ck_abort_msg("%s is not in:\n%s", wanted, text);
}

START_TEST(particle_arguments) {
  const io_setup setup = io_plain(2);
  world w;
  io_open(&w, &setup);
  mpm_context *c = w.context;
  const mpm_particles *set = w.set[0];
  const char *const bad[] = {"velocity", "strain"}, *const twice[] = {"mass", "id", "mass"};
  const char *const unknown[] = {NULL}, *const state[] = {"state"},
                    *const reference[] = {"reference_position"};
  scratch_path("refused.vtp", path, sizeof path);
  unlink(path);
  ck_assert_int_eq(mpm_write_particles(NULL, path, 0, NULL), MPM_E_ARG);
  ck_refused(c, mpm_write_particles(set, NULL, 0, NULL), MPM_E_ARG, "path");
  ck_refused(c, mpm_write_particles(set, "", 0, NULL), MPM_E_ARG, "path");
  ck_refused(c, mpm_write_particles(set, path, -1, bad), MPM_E_ARG, "count is -1");
  ck_refused(c, mpm_write_particles(set, path, 1, NULL), MPM_E_ARG, "fields");
  ck_refused(c, mpm_write_particles(set, path, 1, unknown), MPM_E_ARG, "NULL");
  ck_refused(c, mpm_write_particles(set, path, 2, bad), MPM_E_NOT_FOUND, "\"strain\"; nearest: ");
  ck_refused(c, mpm_write_particles(set, path, 3, twice), MPM_E_ARG, "\"mass\" is named twice");
  ck_refused(c, mpm_write_particles(set, path, 1, state), MPM_E_NOT_FOUND, "state");
  ck_refused(c, mpm_write_particles(set, path, 1, reference), MPM_E_STATE, "reference_position");
  ck_assert_int_ne(access(path, F_OK), 0);
  ck_refused(c, mpm_write_particles(set, "no/such/place.vtp", 0, NULL), MPM_E_IO, "no/such/place.vtp");
  ck_ok(c, mpm_write_particles(set, path, 2, twice));
  contains("NumberOfPoints=\"36\"");
  contains("Name=\"mass\" NumberOfComponents=\"1\"");
  ck_assert_ptr_null(strstr(text, "velocity"));
  w.memory.calls = 0;
  for (int64_t k = 1; k <= 2; ++k) { /* the index is there already: only the file's name is allocated */
    w.memory.fail_at = w.memory.calls + 1;
    ck_assert_int_eq(mpm_write_particles(set, path, 0, NULL), MPM_E_NOMEM);
    w.memory.fail_at = 0;
  }
  contains("Name=\"mass\"");
  world_close(&w);
}
END_TEST

/* Head, entries, tags that close. */
static void check_series(int32_t entries) {
  const char *at = contents();
  ck_assert_int_eq(strncmp(at, "<?xml version=\"1.0\"?>", 21), 0);
  int32_t found = 0;
  for (; (at = strstr(at, "<DataSet ")); ++at) ++found;
  ck_assert_int_eq(found, entries);
  const char *tail = strstr(text, "  </Collection>\n</VTKFile>\n");
  ck_assert_ptr_nonnull(tail);
  ck_assert_uint_eq(strlen(tail), strlen("  </Collection>\n</VTKFile>\n"));
}

START_TEST(series_is_valid_after_every_append) {
  mpm_context *c = context_with(1, MPM_ISA_BEST, NULL);
  mpm_series *series;
  scratch_path("run.pvd", path, sizeof path);
  for (int32_t again = 0; again < 2; ++again) { /* an old file is replaced */
    ck_ok(c, mpm_series_open(c, path, &series));
    check_series(0);
    for (int32_t k = 0; k < 20; ++k) {
      char name[40];
      snprintf(name, sizeof name, "out_%d.vtp", (int)k);
      ck_ok(c, mpm_series_append(series, 0.1 * k, name));
      check_series(k + 1);
      contains(name);
    }
    contains("timestep=\"0.1\"");
    contains("timestep=\"0.30000000000000004\"");
    ck_refused(c, mpm_context_destroy(c), MPM_E_STATE, "live");
    ck_ok(c, mpm_series_close(series));
    check_series(20);
  }
  ck_ok(c, mpm_series_close(NULL));
  ck_ok(c, mpm_context_destroy(c));
}
END_TEST

START_TEST(series_names) {
  mpm_context *c = context_with(1, MPM_ISA_BEST, NULL);
  mpm_series *series;
  scratch_path("names.pvd", path, sizeof path);
  ck_ok(c, mpm_series_open(c, path, &series));
  ck_ok(c, mpm_series_append(series, -1e-300, "a&b<c>\"d'.vtp"));
  contains("file=\"a&amp;b&lt;c&gt;&quot;d&apos;.vtp\"");
  contains("timestep=\"-1e-300\"");
  ck_ok(c, mpm_series_append(series, 2.5, "d\xc3\xbcnn/\xe2\x82\xac/\xf0\x9d\x84\x9e.vtp"));
  contains("file=\"d\xc3\xbcnn/\xe2\x82\xac/\xf0\x9d\x84\x9e.vtp\"");
  static const char *const bad[] = {"a\nb",     "\x01",         "\xff.vtp",     "cut\xc3",
                                    "\xc0\xaf", "\xed\xa0\x80", "\xef\xbf\xbf", "\xf5\x80\x80\x80"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
    ck_refused(c, mpm_series_append(series, 3.0, bad[i]), MPM_E_ARG, "UTF-8");
  ck_refused(c, mpm_series_append(series, (double)NAN, "x"), MPM_E_ARG, "t is");
  ck_refused(c, mpm_series_append(series, (double)INFINITY, "x"), MPM_E_ARG, "t is");
  ck_refused(c, mpm_series_append(series, 1.0, NULL), MPM_E_ARG, "NULL");
  ck_refused(c, mpm_series_append(series, 1.0, ""), MPM_E_ARG, "empty");
  ck_assert_int_eq(mpm_series_append(NULL, 1.0, "x"), MPM_E_ARG);
  check_series(2);
  ck_ok(c, mpm_series_close(series));
  ck_ok(c, mpm_context_destroy(c));
}
END_TEST

START_TEST(series_failures) {
  host_memory memory = {0};
  mpm_context *c = context_with(1, MPM_ISA_BEST, &memory);
  mpm_series *series;
  scratch_path("failing.pvd", path, sizeof path);
  ck_assert_int_eq(mpm_series_open(NULL, path, &series), MPM_E_ARG);
  ck_assert_ptr_null(series);
  ck_refused(c, mpm_series_open(c, path, NULL), MPM_E_ARG, "out");
  ck_refused(c, mpm_series_open(c, NULL, &series), MPM_E_ARG, "path");
  ck_refused(c, mpm_series_open(c, "no/such/place.pvd", &series), MPM_E_IO, "no/such/place.pvd");
  ck_refused(c, mpm_series_open(c, "/dev/full", &series), MPM_E_IO, "/dev/full");
  for (int64_t k = 1; k <= 2; ++k) {
    memory.calls = 0;
    memory.fail_at = k;
    ck_assert_int_eq(mpm_series_open(c, path, &series), MPM_E_NOMEM);
    ck_assert_ptr_null(series);
  }
  memory.fail_at = 0;
  ck_ok(c, mpm_series_open(c, path, &series));
  ck_ok(c, mpm_series_append(series, 1.0, "first"));
  memory.calls = 0;
  memory.fail_at = 1;
  ck_assert_int_eq(mpm_series_append(series, 2.0, "second"), MPM_E_NOMEM);
  memory.fail_at = 0;
  check_series(1);
  /* storage that is full: the entries so far stay valid */
  struct rlimit old, low;
  getrlimit(RLIMIT_FSIZE, &old);
  low = old;
  low.rlim_cur = (rlim_t)strlen(contents()) + 10;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &low);
  ck_refused(c, mpm_series_append(series, 2.0, "second"), MPM_E_IO, path);
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, handler);
  check_series(1);
  ck_ok(c, mpm_series_append(series, 2.0, "second"));
  check_series(2);
  ck_ok(c, mpm_series_close(series));
  ck_ok(c, mpm_context_destroy(c));
  ck_assert_int_eq(memory.held, 0);
}
END_TEST

/* Times have a point whatever the host's locale writes. */
START_TEST(series_in_a_locale_with_commas) {
  static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE",
                                      "fr_FR",       "ps_AF.UTF-8", "fa_IR.UTF-8"};
  size_t i = 0;
  while (i < sizeof names / sizeof *names && !setlocale(LC_NUMERIC, names[i])) ++i;
  mpm_context *c = context_with(1, MPM_ISA_BEST, NULL);
  mpm_series *series;
  scratch_path("locale.pvd", path, sizeof path);
  ck_ok(c, mpm_series_open(c, path, &series));
  ck_ok(c, mpm_series_append(series, 2.5, "x"));
  contains("timestep=\"2.5\"");
  ck_ok(c, mpm_series_close(series));
  ck_ok(c, mpm_context_destroy(c));
  setlocale(LC_NUMERIC, "C");
}
END_TEST

TCase *io_output_case(void) {
  TCase *tests = tcase_create("output");
  tcase_add_test(tests, particle_arguments);
  tcase_add_test(tests, series_is_valid_after_every_append);
  tcase_add_test(tests, series_names);
  tcase_add_test(tests, series_failures);
  tcase_add_test(tests, series_in_a_locale_with_commas);
  return tests;
}
