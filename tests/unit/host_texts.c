/* Whatever fails has a sentence: without a context, too, and after others have succeeded. */
#define _POSIX_C_SOURCE 200809L

#include "host_parts.h"

/* ---- contexts that are not made ---- */
static char logged[512];
static int32_t logs;

static void take_log(void *user, int32_t level, const char *text) {
  (void)user;
  ck_assert_int_eq(level, MPM_LOG_WARNING);
  snprintf(logged, sizeof logged, "%s", text);
  ++logs;
}
static mpm_status no_tasks(void *user, int64_t count, mpm_task_fn task, void *data) {
  (void)user, (void)count, (void)task, (void)data;
  return MPM_OK;
}
static void *no_memory(void *user, size_t bytes, size_t alignment) {
  (void)user, (void)bytes, (void)alignment;
  return NULL;
}
static void no_release(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)user, (void)memory, (void)bytes, (void)alignment;
}

/* Creation fails with this status and sentence, for the host's text and its log. */
static void no_context(mpm_context_desc *desc, mpm_status wanted, const char *text) {
  static char place[300];
  mpm_context *context = NULL;
  memset(place, 'x', sizeof place);
  desc->error_text = place;
  desc->error_bytes = sizeof place;
  desc->log = take_log;
  logs = 0;
  ck_assert_int_eq(mpm_context_create(desc, &context), wanted);
  ck_assert_ptr_null(context);
  ck_assert_msg(strstr(place, text) != NULL, "\"%s\" in \"%.299s\"", text, place);
  ck_assert_int_eq(logs, 1);
  ck_assert_ptr_nonnull(strstr(logged, text));
}

START_TEST(contexts_that_are_not_made) {
  mpm_context_desc d = context_desc();
  d.concurrency = 4096;
  no_context(&d, MPM_E_ARG, "concurrency is 4096, must be 0 to 1024");
  d = context_desc();
  d.isa = 8;
  no_context(&d, MPM_E_ARG, "isa is 8");
  d = context_desc();
  d.serial_callbacks = -3;
  no_context(&d, MPM_E_ARG, "serial_callbacks is -3");
  d = context_desc();
  d.alloc = no_memory;
  no_context(&d, MPM_E_ARG, "alloc is set without release");
  d.release = no_release;
  no_context(&d, MPM_E_NOMEM, "bytes refused");
  d = context_desc();
  d.release = no_release;
  no_context(&d, MPM_E_ARG, "release is set without alloc");
  const char *isa = getenv("MPM_ISA");
  char *was = isa ? strdup(isa) : NULL;
  setenv("MPM_ISA", "sse9", 1);
  d = context_desc();
  no_context(&d, MPM_E_ARG, "MPM_ISA is \"sse9\"");
  if (was) setenv("MPM_ISA", was, 1);
  if (!was) unsetenv("MPM_ISA");
  free(was);
  for (d.isa = MPM_ISA_AVX2; d.isa <= MPM_ISA_AVX512; ++d.isa)
    if (!has_isa(d.isa))
      no_context(&d, MPM_E_UNSUPPORTED,
                 d.isa == MPM_ISA_AVX2 ? "instruction set avx2" : "instruction set avx512");
}
END_TEST

/* What a host has from a later release: where to complain is known all the same. */
START_TEST(later_descriptors) {
  struct {
    mpm_context_desc desc;
    double appended;
  } later = {context_desc(), 1.0};
  later.desc.struct_size = sizeof later;
  no_context(&later.desc, MPM_E_UNSUPPORTED, "mpm_context_desc sets a field");
  later.appended = 0.0;
  later.desc.concurrency = -1;
  no_context(&later.desc, MPM_E_ARG, "concurrency is -1");
}
END_TEST

START_TEST(places_for_the_text) {
  char place[16];
  mpm_context_desc d = context_desc();
  mpm_context *context;
  memset(place, 'x', sizeof place);
  d.error_text = place;
  d.error_bytes = 8; /* too small: cut */
  d.isa = 8;
  ck_assert_int_eq(mpm_context_create(&d, &context), MPM_E_ARG);
  ck_assert_str_eq(place, "mpm_con");
  ck_assert_int_eq(place[8], 'x');
  d.error_bytes = 1;
  ck_assert_int_eq(mpm_context_create(&d, &context), MPM_E_ARG);
  ck_assert_str_eq(place, "");
  d = context_desc();
  d.error_text = place;
  ck_assert_int_eq(mpm_context_create(&d, &context), MPM_E_ARG); /* no room at all */
  d = context_desc();
  d.error_bytes = 16;
  ck_assert_int_eq(mpm_context_create(&d, &context), MPM_E_ARG); /* no place */
  memset(place, 'x', sizeof place);
  d.error_text = place;
  ck_ok(NULL, mpm_context_create(&d, &context));
  ck_assert_int_eq(place[0], 'x'); /* nothing has failed */
  ck_ok(context, mpm_context_destroy(context));
  d.concurrency = 2;
  d.parallel_for = no_tasks;
  ck_assert_int_eq(mpm_context_create(&d, NULL), MPM_E_ARG);
  ck_assert_int_eq(strncmp(place, "mpm_context_cre", 15), 0); /* out is NULL */
}
END_TEST

/* ---- without a context ---- */
START_TEST(texts_of_statuses) {
  for (mpm_status s = MPM_E_FORMAT; s <= MPM_CANCELLED; ++s) {
    ck_assert_uint_gt(strlen(mpm_status_text(s)), 20);
    for (mpm_status t = MPM_E_FORMAT; t < s; ++t) ck_assert_str_ne(mpm_status_text(s), mpm_status_text(t));
  }
  ck_assert_ptr_nonnull(strstr(mpm_status_text(MPM_E_INTERNAL), "library itself"));
  ck_assert_str_eq(mpm_status_text(8), "unknown status");
  ck_assert_str_eq(mpm_status_text(INT32_MIN), "unknown status");
}
END_TEST

START_TEST(no_handle) {
  mpm_view view = {.struct_size = sizeof view};
  ck_assert_int_eq(mpm_step(NULL, 1.0, NULL), MPM_E_ARG);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(NULL), "a handle is NULL"));
  ck_assert_int_eq(mpm_view_release(NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_view_release(&view), MPM_E_STATE); /* it was never filled */
  ck_assert_ptr_nonnull(strstr(mpm_last_error(NULL), "mpm_status_text()"));
}
END_TEST

START_TEST(views_given_back_twice) {
  world w;
  mpm_view view = {.struct_size = sizeof view};
  body_open(&w, &(body_desc){.dim = 2});
  ck_ok(&w, mpm_particles_map(w.set[0], "mass", MPM_READ, &view));
  mpm_view copy = view;
  ck_ok(&w, mpm_view_release(&view));
  ck_refused(&w, mpm_view_release(&copy), MPM_E_STATE, "the view is not lent, or was given back already");
  world_step(&w, BODY_DT);
  ck_ok(&w, mpm_grid_map(w.stepper, 0, "mass", MPM_READ, &view));
  copy = view;
  ck_ok(&w, mpm_view_release(&view));
  ck_assert_int_eq(mpm_step(w.stepper, -1.0, NULL), MPM_E_ARG);
  ck_refused(&w, mpm_view_release(&copy), MPM_E_STATE, "the view is not lent");
  world_close(&w);
}
END_TEST

/* ---- the last failure ---- */
START_TEST(the_last_failure_stays) {
  world w;
  double dt;
  uint64_t hash;
  char path[256];
  mpm_grid *grid;
  mpm_material *material;
  mpm_view view = {.struct_size = sizeof view};
  const mpm_param density = {"density", 1.0};
  mpm_grid_desc g = grid_desc(2, 4, 0.1);
  body_open(&w, &(body_desc){.dim = 2});
  ck_assert_str_eq(mpm_last_error(w.context), ""); /* nothing has failed yet */
  ck_ok(&w, mpm_material_create(w.context, "rigid", &density, 1, &material));
  ck_refused(&w, mpm_step(w.stepper, -3.25, NULL), MPM_E_ARG, "-3.25");
#define STAYS(call)                                                                                          \
  ck_ok(&w, call);                                                                                           \
  ck_assert_ptr_nonnull(strstr(mpm_last_error(w.context), "-3.25"))
  STAYS(mpm_grid_destroy(NULL));
  STAYS(mpm_material_destroy(material));
  STAYS(mpm_context_memory(w.context, NULL, NULL));
  STAYS(mpm_stable_dt(w.stepper, &dt));
  STAYS(mpm_step(w.stepper, BODY_DT, NULL));
  STAYS(mpm_state_hash(w.stepper, &hash));
  STAYS(mpm_write_particles(w.set[0], scratch_path("last.vtp", path, sizeof path), 0, NULL));
  STAYS(mpm_particles_map(w.set[0], "mass", MPM_READ, &view));
  STAYS(mpm_view_release(&view));
  STAYS(mpm_grid_create(w.context, &g, &grid));
  STAYS(mpm_grid_destroy(grid));
#undef STAYS
  ck_refused(&w, mpm_step(w.stepper, -4.5, NULL), MPM_E_ARG, "-4.5"); /* until the next */
  world_close(&w);
}
END_TEST

/* A failure that a call gets over is none. */
static int32_t cuts;
static mpm_status cut(void *user, const mpm_particle_batch *b, double *add) {
  (void)user, (void)b, (void)add;
  return cuts-- > 0 ? 1 : 0;
}
START_TEST(what_a_call_gets_over) {
  world w;
  body_open(&w, &(body_desc){.dim = 2});
  body_calm(&w);
  world_step(&w, BODY_DT);
  ck_refused(&w, mpm_step(w.stepper, -3.25, NULL), MPM_E_ARG, "-3.25");
  ck_ok(&w, mpm_stepper_set_force(w.stepper, cut, NULL));
  mpm_advance_desc go = advance_desc(w.info.t + 3.0 * BODY_DT);
  cuts = 3;
  ck_ok(&w, mpm_advance(w.stepper, &go, NULL));
  ck_assert_int_lt(cuts, 0);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(w.context), "-3.25"));
  cuts = 1;
  ck_refused(&w, mpm_step(w.stepper, BODY_DT, NULL), MPM_CUT_DT, "force callback");
  world_close(&w);
}
END_TEST

TCase *host_texts_case(void) {
  TCase *tests = tcase_create("texts");
  tcase_add_test(tests, contexts_that_are_not_made);
  tcase_add_test(tests, later_descriptors);
  tcase_add_test(tests, places_for_the_text);
  tcase_add_test(tests, texts_of_statuses);
  tcase_add_test(tests, no_handle);
  tcase_add_test(tests, views_given_back_twice);
  tcase_add_test(tests, the_last_failure_stays);
  tcase_add_test(tests, what_a_call_gets_over);
  return tests;
}
