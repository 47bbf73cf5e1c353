/* The tests of libmpm-umat, and what they share. */
#include "umat_test.h"

mpm_context *context_of(int32_t threads) {
  mpm_context_desc d;
  mpm_context *context = NULL;
  ck_ok(NULL, mpm_context_desc_init(&d, sizeof d));
  d.concurrency = threads;
  ck_ok(NULL, mpm_context_create(&d, &context));
  return context;
}

mpm_umat_desc umat_desc(double density, int32_t nprops, const double *props, int32_t nstatv) {
  mpm_umat_desc d;
  ck_ok(NULL, mpm_umat_desc_init(&d, sizeof d));
  d.density = density;
  d.nprops = nprops;
  d.props = props;
  d.nstatv = nstatv;
  return d;
}

point point_of(const mpm_material *material, int32_t state_count) {
  point p = {.material = material, .state_count = state_count};
  for (int k = 0; k < 9; k += 4) p.F[k] = 1.0;
  return p;
}

mpm_status try_step(mpm_context *context, point *p, const double *F_inc, int tangent) {
  (void)context;
  double F[9], state[64];
  multiply(F_inc, p->F, F);
  memcpy(state, p->state, sizeof state);
  mpm_material_batch b = {.struct_size = sizeof b, .state_count = p->state_count, .n = 1, .ld = 1, .dt = 1.0};
  b.t = p->t + 1.0;
  b.F = F;
  b.F_inc = F_inc;
  b.stress = b.stress_new = p->stress;
  b.state = b.state_new = p->state;
  b.wave_speed = &p->wave_speed;
  const mpm_status status = mpm_material_update(p->material, &b, tangent ? p->tangent : NULL, &p->symmetric);
  if (status) return status;
  p->t = b.t;
  memcpy(p->F, F, sizeof F);
  return MPM_OK;
}

void step(mpm_context *context, point *p, const double *F_inc) {
  ck_ok(context, try_step(context, p, F_inc, 0));
}

void multiply(const double *a, const double *b, double *c) {
  double product[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      product[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  memcpy(c, product, sizeof product);
}

void transpose(const double *a, double *t) {
  double other[9];
  for (int k = 0; k < 9; ++k) other[k] = a[k % 3 * 3 + k / 3];
  memcpy(t, other, sizeof other);
}

void rotation(double x, double y, double z, double angle, double *r) {
  const double length = sqrt(x * x + y * y + z * z), n[3] = {x / length, y / length, z / length};
  const double c = cos(angle), s = sin(angle);
  const double cross[9] = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};
  for (int k = 0; k < 9; ++k) r[k] = (k % 4 ? 0.0 : c) + (1.0 - c) * n[k / 3] * n[k % 3] + s * cross[k];
}

void stretched(const double *q, double a, double b, double c, double *s) {
  const double d[9] = {a, 0, 0, 0, b, 0, 0, 0, c};
  double back[9], half[9];
  transpose(q, back);
  multiply(q, d, half);
  multiply(half, back, s);
}

double uniform(uint64_t *seed, double low, double high) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * (double)(*seed >> 11) / 9007199254740992.0;
}

void random_increment(uint64_t *seed, double size, double *F_inc) {
  for (int k = 0; k < 9; ++k) F_inc[k] = (k % 4 ? 0.0 : 1.0) + uniform(seed, -size, size);
}

int main(void) {
  Suite *suite = suite_create("umat");
  suite_add_tcase(suite, element_case());
  suite_add_tcase(suite, runs_case());
  suite_add_tcase(suite, failures_case());
  suite_add_tcase(suite, vumat_case());
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_ENV);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
