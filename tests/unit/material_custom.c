/* Laws of the host: copied, called, released; refused descriptors; memory that runs out. */
#include "law_sample.h"

static mpm_context *context;
static mpm_material *material;

static void setup(void) {
  context = context_with(1, MPM_ISA_BEST, NULL);
}
static void teardown(void) {
  ck_assert_int_eq(context->children, 0);
  ck_ok(context, mpm_context_destroy(context));
}

static void refused(mpm_status got, mpm_status expected, const char *text) {
  ck_refused(context, got, expected, text);
  ck_assert_ptr_null(material);
  ck_assert_int_eq(context->children, 0);
}

typedef struct host {
  int32_t stress_calls, released;
  mpm_status answer;
} host;

static mpm_status host_stress(void *user, const mpm_material_batch *batch) {
  host *h = user;
  h->stress_calls++;
  batch->stress_new[0] = 2.0 * batch->F[0];
  return h->answer;
}
static mpm_status host_tangent(void *user, const mpm_material_batch *batch, double *tangent,
                               int32_t *symmetric) {
  (void)user, (void)batch, (void)tangent;
  *symmetric = 1;
  return MPM_OK;
}
static void host_release(void *user) {
  ((host *)user)->released++;
}

static mpm_material_desc host_desc(host *h) {
  mpm_material_desc d = material_desc(0.0, NULL, NULL);
  ck_assert_int_eq(d.tangent_form, MPM_TANGENT_MINOR_SYMMETRIC);
  ck_assert(d.struct_size == sizeof d && d.state_count == 0 && d.density == 0.0 && !d.stress &&
            !d.state_initial);
  *h = (host){0};
  d.density = 7.0;
  d.stress = host_stress;
  d.user = h;
  d.release_user = host_release;
  return d;
}

START_TEST(custom_law) {
  host h;
  mpm_material_desc d = host_desc(&h);
  double initial[] = {1.0, 2.0, 3.0};
  d.state_count = 3;
  d.state_initial = initial;
  ck_ok(context, mpm_material_create_custom(context, &d, &material));
  initial[1] = 50.0;
  ck_assert(material->state_count == 3 && material->density == 7.0 && !material->law);
  for (int k = 0; k < 3; ++k) ck_assert_double_eq(material->state_initial[k], k + 1.0);
  ck_assert_ptr_eq(material->custom.state_initial, material->state_initial);
  ck_assert_int_eq(mpmi_material_stress_from_F(material), 0);

  static const mpm_status answers[] = {MPM_OK, MPM_CUT_DT, MPM_E_CALLBACK, 77, -77};
  sample s;
  for (int k = 0; k < 5; ++k) {
    sample_clear(&s, 0.5);
    h.answer = answers[k];
    ck_assert_int_eq(mpmi_material_evaluate(material, 3, &s.batch), answers[k]);
    ck_assert_double_eq(s.stress_new[0], 2.0);
  }
  ck_assert_int_eq(h.stress_calls, 5);
  ck_assert_int_eq(h.released, 0);
  ck_ok(context, mpm_material_destroy(material));
  ck_assert_int_eq(h.released, 1);

  d.release_user = NULL;
  d.state_initial = NULL;
  d.tangent_form = 0;
  ck_ok(context, mpm_material_create_custom(context, &d, &material));
  ck_assert_ptr_null(material->state_initial);
  ck_ok(context, mpm_material_destroy(material));
  d.tangent = host_tangent;
  d.tangent_form = MPM_TANGENT_GENERAL;
  d.state_count = 64;
  ck_ok(context, mpm_material_create_custom(context, &d, &material));
  ck_ok(context, mpm_material_destroy(material));
}
END_TEST

START_TEST(refused_custom) {
  host h;
  const double nan = (double)NAN, inf = (double)INFINITY, initial[] = {0.0, nan};
  for (int k = 0; k < 13; ++k) {
    mpm_material_desc d = host_desc(&h);
    const char *text = "mpm_material_desc";
    mpm_status expected = MPM_E_ARG;
    if (k == 0) d.density = 0.0, text = "density = 0";
    if (k == 1) d.density = nan, text = "density";
    if (k == 2) d.density = inf, text = "density = inf";
    if (k == 3) d.stress = NULL, text = "stress is NULL";
    if (k == 4) d.state_count = -1, text = "state_count = -1";
    if (k == 5) d.state_count = 65, text = "state_count = 65";
    if (k == 6) d.tangent_form = 37, text = "tangent_form = 37";
    if (k == 7) d.tangent_form = 0, d.tangent = host_tangent, text = "tangent_form = 0";
    if (k == 8) d.state_count = 2, d.state_initial = initial, text = "state_initial[1]";
    if (k == 9) d.reserved = 1, text = "reserved is 1", expected = MPM_E_UNSUPPORTED;
    if (k == 10) d.struct_size = 0, text = "struct_size";
    if (k == 11) d.struct_size--, text = "struct_size";
    if (k == 12) d.density = -1.0, text = "density = -1";
    material = (mpm_material *)&material;
    refused(mpm_material_create_custom(context, &d, &material), expected, text);
    ck_assert_int_eq(h.released, 0);
  }
  mpm_material_desc d = host_desc(&h);
  refused(mpm_material_create_custom(context, NULL, &material), MPM_E_ARG, "NULL");
  refused(mpm_material_create_custom(context, &d, NULL), MPM_E_ARG, "out is NULL");
  ck_assert_int_eq(mpm_material_create_custom(NULL, &d, &material), MPM_E_ARG);
  ck_assert_int_eq(mpm_material_desc_init(NULL, sizeof d), MPM_E_ARG);
  ck_assert_int_eq(mpm_material_desc_init(&d, 8), MPM_E_ARG);
}
END_TEST

/* ---- memory that runs out ---- */
/* Memory that stays readable after its release, so that a second destroy can be tried. */
static _Alignas(64) unsigned char arena[1 << 16];
static size_t arena_used;
static int32_t allocations_left;

static void *arena_alloc(void *user, size_t bytes, size_t alignment) {
  (void)user;
  size_t size = (bytes + alignment - 1) / alignment * alignment;
  if (allocations_left-- <= 0 || size > sizeof arena - arena_used) return NULL;
  arena_used += size;
  return arena + arena_used - size;
}
static void arena_release(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)user, (void)memory, (void)bytes, (void)alignment;
}

START_TEST(out_of_memory) {
  mpm_context_desc cd = context_desc();
  mpm_context *small;
  cd.alloc = arena_alloc;
  cd.release = arena_release;
  allocations_left = 100;
  ck_ok(NULL, mpm_context_create(&cd, &small));
  host h;
  mpm_material_desc d = host_desc(&h);
  const double initial = 1.0;
  const mpm_param p[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}};
  d.state_count = 1;
  d.state_initial = &initial;
  int64_t before, after;
  ck_ok(small, mpm_context_memory(small, &before, NULL));
  allocations_left = 0;
  ck_assert_int_eq(mpm_material_create_custom(small, &d, &material), MPM_E_NOMEM);
  ck_assert_ptr_null(material);
  ck_assert_int_eq(mpm_material_create(small, "neo_hookean", p, 3, &material), MPM_E_NOMEM);
  ck_assert_ptr_null(material);
  ck_ok(small, mpm_context_memory(small, &after, NULL));
  ck_assert(before == after && h.released == 0 && small->children == 0);
  allocations_left = 1; /* of a material and everything that it keeps */
  ck_ok(small, mpm_material_create_custom(small, &d, &material));
  ck_assert_double_eq(material->state_initial[0], initial);
  ck_assert_int_eq(mpm_material_destroy(material), MPM_OK);
  ck_assert_int_eq(h.released, 1);
  ck_assert_int_eq(mpm_context_memory(small, &after, NULL), MPM_OK);
  ck_assert(before == after);
  allocations_left = 1;
  ck_ok(small, mpm_material_create(small, "neo_hookean", p, 3, &material));
  ck_ok(small, mpm_material_destroy(material));
  ck_assert_int_eq(mpm_material_destroy(material), MPM_E_ARG);
  ck_ok(small, mpm_context_destroy(small));
}
END_TEST

TCase *custom_material_case(void) {
  TCase *tc = tcase_create("custom");
  tcase_add_checked_fixture(tc, setup, teardown);
  tcase_add_test(tc, custom_law);
  tcase_add_test(tc, refused_custom);
  tcase_add_test(tc, out_of_memory);
  return tc;
}
