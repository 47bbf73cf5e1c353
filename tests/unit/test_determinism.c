/* Results do not depend on threads, executor or order of filling, for every method; instruction sets agree to
 * round-off. Bodies of many blocks that move through them, lose particles and are sorted anew. */
#include "run_support.h"
#include "stepper/stepper.h"

enum { REMOVED_AT = 6, COMPARED_AT = 10 };

/* Positions, velocities and stresses of both sets. */
typedef struct sample {
  int64_t n[2];
  double *value[2][3];
} sample;
static const struct {
  const char *name;
  int32_t components; /* 0: dim */
} sampled[3] = {{"position", 0}, {"velocity", 0}, {"stress", 6}};

static int32_t components_of(const run *r, int32_t f) {
  return sampled[f].components ? sampled[f].components : r->options.dim;
}

static sample take_sample(const run *r) {
  sample s;
  for (int32_t m = 0; m < 2; ++m) {
    s.n[m] = mpm_particles_count(r->set[m]);
    for (int32_t f = 0; f < 3; ++f) s.value[m][f] = run_get(r, m, sampled[f].name, components_of(r, f));
  }
  return s;
}

static void drop_sample(sample *s) {
  for (int32_t m = 0; m < 2; ++m)
    for (int32_t f = 0; f < 3; ++f) free(s->value[m][f]);
}

static void ck_agree(const run *r, const sample *a, const sample *b) {
  for (int32_t m = 0; m < 2; ++m) {
    ck_assert_int_eq(a->n[m], b->n[m]);
    for (int32_t f = 0; f < 3; ++f) {
      double largest = 0.0, apart = 0.0;
      for (int64_t i = 0; i < a->n[m] * components_of(r, f); ++i) {
        largest = fmax(largest, fabs(a->value[m][f][i]));
        apart = fmax(apart, fabs(a->value[m][f][i] - b->value[m][f][i]));
      }
      ck_assert_msg(largest > 0.0 && apart <= 1e-12 * largest, "%s of set %d: %g apart of %g",
                    sampled[f].name, (int)m, apart, largest);
    }
  }
}

static void remove_some(run *r) {
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r->set[m]);
    int64_t *ids = malloc((size_t)n * sizeof *ids), some = 0;
    run_ok(r, mpm_particles_get(r->set[m], "id", MPM_I64, 1, n, NULL, ids));
    for (int64_t i = 0; i < n; ++i)
      if (ids[i] % 13 == 4) ids[some++] = ids[i];
    ck_assert_int_gt(some, 3);
    run_ok(r, mpm_particles_remove(r->set[m], some, ids));
    free(ids);
  }
}

/* The whole story of one run; at: receives the fields after COMPARED_AT steps, or NULL. */
static uint64_t tell(const run_options *options, sample *at) {
  run r;
  run_open(&r, options);
  run_steps(&r, REMOVED_AT);
  ck_assert_int_ge(r.stepper->cut.count, 27);
  remove_some(&r);
  run_steps(&r, COMPARED_AT - REMOVED_AT);
  if (at) *at = take_sample(&r);
  run_steps(&r, options->dim == 1
                    ? 14
                    : 10); /* far enough for three sorts more, too short for linear bases to fail */
  ck_assert_int_ge(r.info.resorts, 4); /* the first sort is one of them */
  if (options->periodic)
    ck_assert_int_eq(r.info.removed, 0);
  else
    ck_assert_int_gt(r.info.removed, 0);
  ck_assert(isfinite(r.info.strain_energy) && r.info.strain_energy > 0.0);
  const uint64_t hash = run_hash(&r);
  run_close(&r);
  return hash;
}

static int32_t has_isa(int32_t isa) {
  mpm_context_desc d;
  mpm_context *context;
  ck_assert_int_eq(mpm_context_desc_init(&d, sizeof d), MPM_OK);
  d.isa = isa;
  const mpm_status status = mpm_context_create(&d, &context);
  if (status == MPM_OK) mpm_context_destroy(context);
  return status == MPM_OK;
}

/* One instruction set; the best one is tried more often. */
static void one_isa(run_options o, int32_t thorough, sample *at) {
  const uint64_t alone = tell(&o, at);
  static const int32_t threads[] = {2, 3, 7};
  for (int32_t i = 0; i < 3 && thorough; ++i) {
    o.concurrency = threads[i];
    ck_assert_msg(tell(&o, NULL) == alone, "%d threads give another hash than one", (int)threads[i]);
  }
  o.concurrency = 5;
  o.own_order = 1;
  ck_assert_msg(tell(&o, NULL) == alone, "tasks in another order give another hash");
  if (!thorough) return;
  o.own_order = 0;
  o.concurrency = 2;
  o.shuffled = 1;
  ck_assert_msg(tell(&o, NULL) == alone, "another order of filling gives another hash");
}

static run_options numbered(int32_t i) {
  run_options o = {.dim = 1 + i / (2 * RUN_METHODS), .large = 1, .periodic = i / RUN_METHODS % 2};
  run_use(&o, &run_methods[i % RUN_METHODS]);
  return o;
}
enum { COMBINATIONS = 3 * 2 * RUN_METHODS };

START_TEST(same_bits) {
  run_options o = numbered(_i);
  sample first = {{0, 0}, {{NULL}}};
  int32_t tried = 0;
  for (int32_t isa = MPM_ISA_AVX512; isa >= MPM_ISA_BASELINE; --isa) {
    if (!has_isa(isa)) continue;
    sample other;
    o.isa = isa;
    one_isa(o, !tried, tried ? &other : &first);
    if (tried++) {
      run r = {.options = o};
      ck_agree(&r, &first, &other);
      drop_sample(&other);
    }
  }
  ck_assert_int_ge(tried, 1);
  drop_sample(&first);
}
END_TEST

/* The hash tells runs apart. */
START_TEST(hash_differs) {
  run_options o = {.dim = 2};
  run a, b;
  run_open(&a, &o);
  run_open(&b, &o);
  run_steps(&a, 3);
  run_steps(&b, 3);
  ck_assert(run_hash(&a) == run_hash(&b));
  run_step_of(&a, RUN_DT);
  run_step_of(&b, RUN_DT * (1.0 + 1e-15));
  ck_assert(run_hash(&a) != run_hash(&b));
  run_close(&a);
  run_close(&b);
}
END_TEST

/* MPM_ISA_BEST is one of the sets, and a pool is as good as an executor of the host on it. */
START_TEST(best_isa_is_one_of_them) {
  run_options o = {.dim = 3, .large = 1};
  const uint64_t best = tell(&o, NULL);
  int32_t same = 0;
  for (o.isa = MPM_ISA_BASELINE; o.isa <= MPM_ISA_AVX512; ++o.isa)
    if (has_isa(o.isa)) same += tell(&o, NULL) == best;
  ck_assert_int_ge(same, 1);
}
END_TEST

Suite *determinism_suite(void) {
  Suite *suite = suite_create("determinism");
  TCase *methods = tcase_create("methods");
  tcase_set_tags(methods, "long");
  tcase_set_timeout(methods, 900);
  tcase_add_loop_test(methods, same_bits, 0, COMBINATIONS);
  suite_add_tcase(suite, methods);
  TCase *hashes = tcase_create("hashes");
  tcase_set_tags(hashes, "long");
  tcase_set_timeout(hashes, 900);
  tcase_add_test(hashes, hash_differs);
  tcase_add_test(hashes, best_isa_is_one_of_them);
  suite_add_tcase(suite, hashes);
  return suite;
}
