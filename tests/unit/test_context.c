/* Contexts: descriptors, memory, texts. */
#define _POSIX_C_SOURCE 200809L

#include "context/structs.h"
#include "context/arena.h"
#include "transfer/kernels.h"
#include "particles/particles.h"
#include "body.h"

/* ---- a host that counts ---- */
typedef struct host {
  int64_t held, calls, refuse_after, misaligned; /* refuse_after: calls granted before refusing, < 0 never */
  int32_t bad_alignment, logged;
  char text[256];
} host;

static void *host_alloc(void *user, size_t bytes, size_t alignment) {
  host *h = user;
  if (alignment != 64) h->bad_alignment++;
  if (h->refuse_after >= 0 && h->calls >= h->refuse_after) return NULL;
  h->calls++;
  void *memory;
  if (posix_memalign(&memory, alignment, bytes + 64)) return NULL;
  h->held += (int64_t)bytes;
  return (char *)memory + h->misaligned;
}

static void host_release(void *user, void *memory, size_t bytes, size_t alignment) {
  host *h = user;
  if (alignment != 64) h->bad_alignment++;
  h->held -= (int64_t)bytes;
  free((char *)memory - h->misaligned);
}

static void host_log(void *user, int32_t level, const char *text) {
  host *h = user;
  h->logged += level;
  snprintf(h->text, sizeof h->text, "%s", text);
}

static mpm_context_desc host_desc(host *h) {
  memset(h, 0, sizeof *h);
  h->refuse_after = -1;
  mpm_context_desc desc = context_desc();
  desc.alloc = host_alloc;
  desc.release = host_release;
  desc.alloc_user = h;
  return desc;
}

static mpm_context *make(const mpm_context_desc *desc) {
  mpm_context *context = NULL;
  ck_ok(NULL, mpm_context_create(desc, &context));
  ck_assert_ptr_nonnull(context);
  return context;
}

static void refuse(const mpm_context_desc *desc, mpm_status expected) {
  mpm_context *context = (mpm_context *)&context;
  ck_assert_int_eq(mpm_context_create(desc, &context), expected);
  ck_assert_ptr_null(context);
}

/* ---- creation ---- */
START_TEST(version_and_names) {
  ck_assert_uint_eq(mpm_version(), MPM_VERSION);
  ck_assert_str_eq(mpm_status_name(MPM_OK), "MPM_OK");
  ck_assert_str_eq(mpm_status_name(MPM_CANCELLED), "MPM_CANCELLED");
  ck_assert_str_eq(mpm_status_name(MPM_E_INTERNAL), "MPM_E_INTERNAL");
  ck_assert_str_eq(mpm_status_name(8), "unknown status");
  ck_assert_str_eq(mpm_status_name(-9), "unknown status");
  for (mpm_status s = MPM_E_FORMAT; s <= MPM_CANCELLED; ++s)
    ck_assert_int_eq(strncmp(mpm_status_name(s), "MPM_", 4), 0);
}
END_TEST

START_TEST(defaults) {
  mpm_context_desc desc = context_desc();
  ck_assert_uint_eq(desc.struct_size, sizeof desc);
  ck_assert_int_eq(desc.concurrency, 1);
  ck_assert_int_eq(desc.isa, MPM_ISA_BEST);
  ck_assert_int_eq(desc.serial_callbacks, 0);
  ck_assert(!desc.alloc && !desc.release && !desc.parallel_for && !desc.log);
  mpm_context *context = make(NULL);
  ck_assert_int_eq(context->concurrency, 1);
  ck_assert_ptr_null(context->pool);
  ck_assert_int_ge(context->isa, MPM_ISA_BASELINE);
  ck_assert_str_eq(mpm_last_error(context), "");
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

START_TEST(bad_descs) {
  mpm_context_desc desc = context_desc();
  ck_assert_int_eq(mpm_context_create(&desc, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_context_desc_init(NULL, sizeof desc), MPM_E_ARG);
  ck_assert_int_eq(mpm_context_desc_init(&desc, 0), MPM_E_ARG);
  ck_assert_int_eq(mpm_context_desc_init(&desc, mpmi_first_size("mpm_context_desc") - 1), MPM_E_ARG);
  ck_assert_int_eq(mpm_context_desc_init(&desc, UINT32_MAX), MPM_E_ARG);
  const int32_t bad_concurrency[] = {-1, INT32_MIN, 1025, INT32_MAX};
  for (int k = 0; k < 4; ++k) {
    desc = context_desc();
    desc.concurrency = bad_concurrency[k];
    refuse(&desc, MPM_E_ARG);
  }
  const int32_t bad_isa[] = {-1, 5, 99};
  for (int k = 0; k < 3; ++k) {
    desc = context_desc();
    desc.isa = bad_isa[k];
    refuse(&desc, MPM_E_ARG);
  }
  desc = context_desc();
  desc.serial_callbacks = 2;
  refuse(&desc, MPM_E_ARG);
  desc = context_desc();
  desc.struct_size = 0;
  refuse(&desc, MPM_E_ARG);
  desc = context_desc();
  desc.struct_size = mpmi_first_size("mpm_context_desc") - 8;
  refuse(&desc, MPM_E_ARG);
}
END_TEST

START_TEST(allocator_pairs) {
  host h;
  mpm_context_desc desc = host_desc(&h);
  desc.release = NULL;
  refuse(&desc, MPM_E_ARG);
  desc = host_desc(&h);
  desc.alloc = NULL;
  refuse(&desc, MPM_E_ARG);
  ck_assert_int_eq(h.calls, 0);
}
END_TEST

/* Every allocation of a creation may fail; nothing is lost. */
START_TEST(creation_out_of_memory) {
  host h;
  mpm_context_desc desc = host_desc(&h);
  desc.concurrency = 3;
  for (h.refuse_after = 0; h.refuse_after < 2; ++h.refuse_after) {
    h.calls = 0;
    refuse(&desc, MPM_E_NOMEM);
    ck_assert_int_eq(h.held, 0);
  }
  h.calls = 0;
  mpm_context *context = make(&desc);
  ck_ok(context, mpm_context_destroy(context));
  ck_assert_int_eq(h.held, 0);
  ck_assert_int_eq(h.bad_alignment, 0);
}
END_TEST

START_TEST(misaligned_allocator) {
  host h;
  mpm_context_desc desc = host_desc(&h);
  h.misaligned = 16;
  refuse(&desc, MPM_E_NOMEM);
  ck_assert_int_eq(h.held, 0);
}
END_TEST

/* A context of a later version with a longer descriptor: accepted while the tail is zero. */
START_TEST(longer_desc) {
  struct {
    mpm_context_desc desc;
    uint64_t later[2];
  } longer;
  ck_ok(NULL, mpm_context_desc_init(&longer.desc, sizeof longer));
  ck_assert_uint_eq(longer.desc.struct_size, sizeof longer);
  ck_assert_uint_eq(longer.later[0] | longer.later[1], 0);
  ck_assert_int_eq(longer.desc.concurrency, 1);
  mpm_context *context = make(&longer.desc);
  ck_assert_uint_eq(context->host.struct_size, sizeof(mpm_context_desc));
  ck_ok(context, mpm_context_destroy(context));
  longer.later[1] = UINT64_C(1) << 63;
  refuse(&longer.desc, MPM_E_UNSUPPORTED);
}
END_TEST

START_TEST(structs_written) {
  struct {
    mpm_view view;
    uint64_t guard;
  } out;
  mpm_view value;
  memset(&value, 0x11, sizeof value);
  mpm_context *context = make(NULL);
  memset(&out, 0x22, sizeof out);
  out.view.struct_size = sizeof out;
  ck_ok(context, mpmi_write_struct(context, "mpm_view", &value, sizeof value, &out));
  ck_assert_uint_eq(out.view.struct_size, sizeof out);
  ck_assert_int_eq(out.view.count, value.count);
  ck_assert_uint_eq(out.guard, UINT64_C(0x2222222222222222));
  memset(&out, 0x22, sizeof out);
  out.view.struct_size = 8; /* an old caller: nothing beyond its own size */
  ck_ok(context, mpmi_write_struct(context, "mpm_view", &value, sizeof value, &out));
  ck_assert_int_eq(out.view.type, 0x11111111);
  ck_assert_int_eq(out.view.components, 0x22222222);
  out.view.struct_size = 0;
  ck_refused(context, mpmi_write_struct(context, "mpm_view", &value, sizeof value, &out), MPM_E_ARG,
             "mpm_view");
  ck_assert_int_eq(mpmi_write_struct(context, "mpm_view", &value, sizeof value, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpmi_read_struct(context, "mpm_view", NULL, sizeof value, &out), MPM_E_ARG);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- instruction sets ---- */
START_TEST(isa_environment) {
  static const char *const names[] = {"baseline", "avx2", "avx512", "neon"};
  const char *outside = getenv("MPM_ISA");
  char *kept = outside ? strdup(outside) : NULL;
  unsetenv("MPM_ISA");
  mpm_context *context = make(NULL);
  int32_t best = context->isa;
  ck_ok(context, mpm_context_destroy(context));
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa) {
    const int32_t has = best == MPM_ISA_NEON ? isa == MPM_ISA_BASELINE || isa == best : isa <= best;
    mpm_context_desc desc = context_desc();
    setenv("MPM_ISA", names[isa - 1], 1);
    mpm_status status = mpm_context_create(&desc, &context);
    ck_assert_int_eq(status, has ? MPM_OK : MPM_E_UNSUPPORTED);
    if (context) ck_assert_int_eq(context->isa, isa);
    ck_ok(context, mpm_context_destroy(context));
    setenv("MPM_ISA", "baseline", 1); /* the descriptor wins */
    desc.isa = isa;
    ck_assert_int_eq(mpm_context_create(&desc, &context), status);
    if (context) ck_assert_int_eq(context->isa, isa);
    ck_ok(context, mpm_context_destroy(context));
  }
  setenv("MPM_ISA", "portable", 1);
  context = make(NULL);
  ck_assert_int_eq(context->isa, MPM_ISA_PORTABLE);
  ck_ok(context, mpm_context_destroy(context));
  setenv("MPM_ISA", "sse9", 1);
  refuse(NULL, MPM_E_ARG);
  setenv("MPM_ISA", "", 1);
  ck_ok(NULL, mpm_context_destroy(make(NULL)));
  unsetenv("MPM_ISA");
  if (kept) setenv("MPM_ISA", kept, 1);
  free(kept);
}
END_TEST

START_TEST(isa_has_kernels_of_its_own) {
#if MPMI_HAS_X86
  for (int32_t isa = MPM_ISA_BASELINE; isa < MPM_ISA_AVX512; ++isa)
    ck_assert_ptr_ne(mpmi_kernels_of(isa), mpmi_kernels_of(isa + 1));
#elif MPMI_HAS_NEON
  ck_assert_ptr_ne(mpmi_kernels_of(MPM_ISA_BASELINE), mpmi_kernels_of(MPM_ISA_NEON));
  ck_assert(has_isa(MPM_ISA_NEON));
#endif
  ck_assert(mpmi_kernels_of(MPM_ISA_BASELINE)->scatter[3][3][MPMI_SCATTER_8] != NULL);
}
END_TEST

/* ---- memory ---- */
START_TEST(memory_counted) {
  host h;
  mpm_context_desc desc = host_desc(&h);
  mpm_context *context = make(&desc);
  int64_t start, bytes, peak;
  ck_ok(context, mpm_context_memory(context, &start, &peak));
  ck_assert_int_eq(start, h.held);
  ck_assert_int_eq(start, peak);
  void *a = mpmi_alloc(context, 1000), *empty = mpmi_alloc(context, 0);
  unsigned char *zeroed = mpmi_alloc_zeroed(context, 300);
  ck_assert(a && empty && zeroed);
  ck_assert_uint_eq((uintptr_t)a % 64, 0);
  for (int k = 0; k < 300; ++k) ck_assert_uint_eq(zeroed[k], 0);
  ck_ok(context, mpm_context_memory(context, &bytes, NULL));
  ck_assert_int_eq(bytes, start + 1000 + 64 + 300);
  ck_assert_int_eq(bytes, h.held);
  mpmi_free(context, a, 1000);
  mpmi_free(context, empty, 0);
  mpmi_free(context, zeroed, 300);
  mpmi_free(context, NULL, 5);
  ck_ok(context, mpm_context_memory(context, &bytes, &peak));
  ck_assert_int_eq(bytes, start);
  ck_assert_int_eq(peak, start + 1364);
  ck_assert_int_eq(mpm_context_memory(NULL, &bytes, &peak), MPM_E_ARG);
  ck_ok(context, mpm_context_destroy(context));
  ck_assert_int_eq(h.held, 0);
  ck_assert_int_eq(h.bad_alignment, 0);
}
END_TEST

START_TEST(memory_refused) {
  host h;
  mpm_context_desc desc = host_desc(&h);
  mpm_context *context = make(&desc);
  int64_t calls = h.calls;
  ck_assert_uint_eq(mpmi_bytes(3, 8), 24);
  ck_assert_uint_eq(mpmi_bytes(0, 8), 0);
  ck_assert_uint_eq(mpmi_bytes(-1, 8), SIZE_MAX);
  ck_assert_uint_eq(mpmi_bytes(INT64_MAX, 8), SIZE_MAX);
  ck_assert_ptr_null(mpmi_alloc(context, SIZE_MAX));
  ck_assert_ptr_null(mpmi_alloc(context, (size_t)PTRDIFF_MAX + 1));
  ck_assert_ptr_null(mpmi_alloc_zeroed(context, SIZE_MAX));
  ck_assert_int_eq(h.calls, calls); /* the host is not bothered */
  ck_assert_str_ne(mpm_last_error(context), "");
  h.refuse_after = 0;
  ck_assert_ptr_null(mpmi_alloc(context, 123457));
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "123457"));
  ck_ok(context, mpm_context_destroy(context));
  ck_assert_int_eq(h.held, 0);
}
END_TEST

#if MPMI_WATCHED
#include <sanitizer/asan_interface.h>

/* Under the address sanitizer what is held and not in use is closed, and what is in use is open. */
START_TEST(slack_is_closed) {
  mpm_context *context;
  ck_assert_int_eq(mpm_context_create(NULL, &context), MPM_OK);
  mpmi_arena count = {NULL, 0};
  for (int32_t i = 0; i < 3; ++i) mpmi_arena_take(&count, 5, sizeof(double));
  char *memory = mpmi_alloc(context, count.used);
  mpmi_arena from = {memory, 0};
  for (int32_t i = 0; i < 3; ++i) {
    char *at = mpmi_arena_take(&from, 5, sizeof(double));
    ck_assert(!__asan_region_is_poisoned(at, 5 * sizeof(double)));
    for (char *k = at + 5 * sizeof(double); k < memory + from.used; ++k)
      ck_assert(__asan_address_is_poisoned(k));
  }
  mpmi_free(context, memory, count.used);
  int64_t *list = NULL, capacity = 0;
  for (int64_t n = 1; n < 100; n += 7) {
    ck_assert_int_eq(MPMI_RESERVE_MORE(context, list, capacity, n), MPM_OK);
    ck_assert(!__asan_region_is_poisoned(list, (size_t)n * sizeof *list));
    for (int64_t k = n; k < capacity; ++k) ck_assert(__asan_address_is_poisoned(list + k));
  }
  MPMI_FREE_ARRAY(context, list, capacity);
  ck_assert_int_eq(mpm_context_destroy(context), MPM_OK);
}
END_TEST

/* The slots that a set has room for beyond those in use, in every field, and the members of a stepper. */
START_TEST(slack_of_sets_is_closed) {
  world w;
  int32_t seen = 0;
  body_open(&w, &(body_desc){.dim = 2});
  for (int32_t again = 0; again < 3; ++again) {
    for (int32_t m = 0; m < 2; ++m) {
      const mpm_particles *set = w.set[m];
      if (set->slots == set->ld) continue;
      ++seen;
      for (int32_t f = 0; f < set->field_count; ++f)
        for (int32_t copy = 0; copy < 2 && set->field[f].data[copy]; ++copy)
          for (int32_t c = 0; c < set->field[f].components; ++c) {
            const size_t size = mpmi_type_size(set->field[f].type);
            const char *row = (const char *)set->field[f].data[copy] + (size_t)(c * set->ld) * size;
            ck_assert(!__asan_address_is_poisoned(row + (size_t)set->slots * size - 1));
            ck_assert(__asan_address_is_poisoned(row + (size_t)set->slots * size));
            ck_assert(__asan_address_is_poisoned(row + (size_t)set->ld * size - 1));
          }
    }
    const double x[] = {w.grid->desc.origin[0] + 0.5, w.grid->desc.origin[1] + 0.5}, volume[] = {1e-6};
    if (again) world_steps(&w, 1);
    ck_ok(&w, mpm_particles_add(w.set[0], 1, x, NULL, volume, NULL, NULL, NULL));
  }
  ck_assert_int_gt(seen, 2);
  world_close(&w);
}
END_TEST
#endif

START_TEST(living_children) {
  mpm_context *context = make(NULL);
  context->children = 2;
  ck_refused(context, mpm_context_destroy(context), MPM_E_STATE, "2 objects");
  context->children = 0;
  ck_ok(context, mpm_context_destroy(context));
  ck_ok(NULL, mpm_context_destroy(NULL));
  uint32_t other[256] = {MPMI_GRID};
  ck_assert_int_eq(mpm_context_destroy((mpm_context *)(void *)other), MPM_E_ARG);
}
END_TEST

/* ---- texts ---- */
START_TEST(last_error) {
  mpm_context *context = make(NULL);
  ck_assert_int_eq(mpmi_fail(context, MPM_E_IO, "file %s: %d", "a.vtp", 7), MPM_E_IO);
  ck_assert_str_eq(mpm_last_error(context), "file a.vtp: 7");
  ck_assert_str_eq(mpm_last_error(context), "file a.vtp: 7"); /* asking does not clear */
  mpmi_fail(context, MPM_E_IO, "set 1: %s", mpm_last_error(context));
  ck_assert_str_eq(mpm_last_error(context), "set 1: file a.vtp: 7");
  char endless[4096];
  memset(endless, 'x', sizeof endless - 1);
  endless[sizeof endless - 1] = '\0';
  mpmi_fail(context, MPM_E_IO, "%s", endless);
  ck_assert_uint_eq(strlen(mpm_last_error(context)), sizeof context->text[0] - 1);
  ck_assert_int_eq(mpmi_fail(NULL, MPM_E_ARG, "nobody listens"), MPM_E_ARG);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Of a library that stands on this one. */
START_TEST(last_error_from_outside) {
  mpm_context_desc desc = context_desc();
  mpm_context *context = make(&desc);
  ck_assert_int_eq(mpm_set_last_error(context, MPM_E_UNSUPPORTED, "no 100 % of that"), MPM_E_UNSUPPORTED);
  ck_assert_str_eq(mpm_last_error(context), "no 100 % of that");
  ck_assert_int_eq(mpm_set_last_error(context, MPM_CUT_DT, mpm_last_error(context)), MPM_CUT_DT);
  ck_assert_str_eq(mpm_last_error(context), "no 100 % of that");
  ck_assert_int_eq(mpm_set_last_error(context, MPM_OK, "fine"), MPM_E_ARG);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "MPM_OK"));
  ck_assert_int_eq(mpm_set_last_error(context, MPM_E_IO, NULL), MPM_E_ARG);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "NULL"));
  ck_assert_int_eq(mpm_set_last_error(NULL, MPM_E_IO, "text"), MPM_E_ARG);
  char text[2000];
  memset(text, 'x', sizeof text);
  text[sizeof text - 1] = '\0';
  ck_assert_int_eq(mpm_set_last_error(context, MPM_E_IO, text), MPM_E_IO);
  ck_assert_uint_eq(strlen(mpm_last_error(context)), sizeof context->text[0] - 1);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

START_TEST(log_reaches_the_host) {
  host h;
  mpm_context_desc desc = host_desc(&h);
  desc.log = host_log;
  desc.log_user = &h;
  mpm_context *context = make(&desc);
  ck_assert_int_eq(h.logged, MPM_LOG_INFO);
  mpmi_log(context, MPM_LOG_WARNING, "step %d", 12);
  ck_assert_int_eq(h.logged, MPM_LOG_INFO + MPM_LOG_WARNING);
  ck_assert_str_eq(h.text, "step 12");
  ck_ok(context, mpm_context_destroy(context));
  context = make(NULL);
  mpmi_log(context, MPM_LOG_WARNING, "into the void");
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

START_TEST(nearest_names) {
  static const char *const laws[] = {"linear_elastic", "neo_hookean", "neo_hookean_decoupled", "j2",
                                     "newtonian_fluid"};
  char text[128];
  mpmi_nearest_names("neohookean", laws, 5, text, sizeof text);
  ck_assert_int_eq(strncmp(text, "neo_hookean, ", 13), 0);
  mpmi_nearest_names("fluid", laws, 5, text, sizeof text);
  ck_assert_int_eq(strncmp(text, "newtonian_fluid, ", 17), 0);
  mpmi_nearest_names("J2", laws, 5, text, sizeof text);
  ck_assert_int_eq(strncmp(text, "j2, ", 4), 0);
  mpmi_nearest_names("neo_hookean", laws, 2, text, sizeof text);
  ck_assert_str_eq(text, "neo_hookean, linear_elastic");
  mpmi_nearest_names("neo_hookean", laws, 2, text, 20); /* the second does not fit */
  ck_assert_str_eq(text, "neo_hookean");
  mpmi_nearest_names("x", laws, 0, text, sizeof text);
  ck_assert_str_eq(text, "");
  mpmi_nearest_names(NULL, laws, 5, text, sizeof text);
  ck_assert_int_eq(strncmp(text, "j2, ", 4), 0);
}
END_TEST

Suite *context_suite(void) {
  Suite *suite = suite_create("context");
  TCase *creation = tcase_create("creation");
  tcase_add_test(creation, version_and_names);
  tcase_add_test(creation, defaults);
  tcase_add_test(creation, bad_descs);
  tcase_add_test(creation, allocator_pairs);
  tcase_add_test(creation, creation_out_of_memory);
  tcase_add_test(creation, misaligned_allocator);
  tcase_add_test(creation, longer_desc);
  tcase_add_test(creation, structs_written);
  tcase_add_test(creation, isa_environment);
  tcase_add_test(creation, isa_has_kernels_of_its_own);
  suite_add_tcase(suite, creation);
  TCase *memory = tcase_create("memory");
  tcase_add_test(memory, memory_counted);
  tcase_add_test(memory, memory_refused);
  tcase_add_test(memory, living_children);
#if MPMI_WATCHED
  tcase_add_test(memory, slack_is_closed);
  tcase_add_test(memory, slack_of_sets_is_closed);
#endif
  suite_add_tcase(suite, memory);
  TCase *texts = tcase_create("texts");
  tcase_add_test(texts, last_error);
  tcase_add_test(texts, last_error_from_outside);
  tcase_add_test(texts, log_reaches_the_host);
  tcase_add_test(texts, nearest_names);
  suite_add_tcase(suite, texts);
  return suite;
}
