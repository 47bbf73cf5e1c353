/* Tangents of the host's laws: a neo-Hookean law with its tangent in either form and without one, against the
 * built-in law; a law of the rate of deformation, whose differences are known; statuses and inert slots. */
#include "tangent_sample.h"

static const mpm_param params[] = {{"E", 2.5e6}, {"nu", 0.25}, {"density", 1e3}};
static const double shear = 1e6, lame = 1e6; /* of E = 2.5e6, nu = 0.25 */
static const double stiffness = 3e5, viscosity = 2e4;

typedef struct host {
  int32_t stress_calls, tangent_calls, fails_at; /* call of the stress, from 1 */
  int32_t symmetric, rows;
  mpm_status answer;
} host;

static tensor load(const double *rows, int64_t ld, int64_t i) {
  tensor t;
  for (int c = 0; c < 9; ++c) t.m[c / 3][c % 3] = rows[c * ld + i];
  return t;
}
static void store_outputs(const mpm_material_batch *batch, int64_t i, tensor stress) {
  for (int c = 0; c < 6; ++c)
    batch->stress_new[c * batch->ld + i] = (double)stress.m[sym_row[c]][sym_column[c]];
  for (int c = 0; c < batch->state_count; ++c)
    batch->state_new[c * batch->ld + i] = batch->state[c * batch->ld + i] + 1.0;
  batch->wave_speed[i] = 1.0;
  ck_assert(batch->kinematic_viscosity[i] == 0.0 && isnan(batch->energy[i])); /* preset, call by call */
  batch->kinematic_viscosity[i] = 2.0;
  batch->energy[i] = 3.0;
}

static mpm_status neo_hookean(void *user, const mpm_material_batch *batch) {
  host *h = user;
  h->stress_calls++;
  for (int64_t i = 0; i < batch->n; ++i) {
    tensor f = load(batch->F, batch->ld, i), b = multiply(f, transpose(f));
    real j = det(f), pressure = lame * logl(j) / j;
    store_outputs(batch, i, combine(shear / j, b, pressure - shear / j, identity()));
  }
  return h->stress_calls == h->fails_at ? h->answer : MPM_OK;
}

/* A different number in every component: stress = stiffness F_inc F_inc^T +
 * viscosity (L + L^T) + old stress. */
static mpm_status rate_law(void *user, const mpm_material_batch *batch) {
  host *h = user;
  h->stress_calls++;
  for (int64_t i = 0; i < batch->n; ++i) {
    tensor f = load(batch->F_inc, batch->ld, i), l = load(batch->L, batch->ld, i), old = {{{0}}};
    for (int c = 0; c < 6; ++c)
      old.m[sym_row[c]][sym_column[c]] = old.m[sym_column[c]][sym_row[c]] = batch->stress[c * batch->ld + i];
    tensor rate = combine(viscosity, l, viscosity, transpose(l));
    store_outputs(
        batch, i,
        combine(1, combine(stiffness, multiply(f, transpose(f)), 1, rate), 1 + batch->state[i], old));
  }
  return MPM_OK;
}

static void host_rows(const mpm_material_batch *batch, double *tangent, int32_t form) {
  for (int64_t p = 0; p < batch->n; ++p) {
    const double m = shear - lame * log((double)det(load(batch->F, batch->ld, p)));
    for (int row = 0; row < form; ++row) {
      int i = row / 27, j = row / 9 % 3, k = row / 3 % 3, l = row % 3;
      if (form == MPM_TANGENT_MINOR_SYMMETRIC) {
        i = sym_row[row / 6], j = sym_column[row / 6];
        k = sym_row[row % 6], l = sym_column[row % 6];
      }
      tangent[row * batch->ld + p] =
          lame * (i == j) * (k == l) + m * ((i == k) * (j == l) + (i == l) * (j == k));
      if (batch->id[p] < 0) tangent[row * batch->ld + p] = (double)NAN;
    }
  }
}
static mpm_status minor_symmetric(void *user, const mpm_material_batch *batch, double *tangent,
                                  int32_t *symmetric) {
  host *h = user;
  h->tangent_calls++;
  host_rows(batch, tangent, MPM_TANGENT_MINOR_SYMMETRIC);
  *symmetric = h->symmetric;
  return h->answer;
}
static mpm_status general(void *user, const mpm_material_batch *batch, double *tangent, int32_t *symmetric) {
  host *h = user;
  h->tangent_calls++;
  host_rows(batch, tangent, MPM_TANGENT_GENERAL);
  *symmetric = h->symmetric;
  return h->answer;
}
/* Each component its own number. */
static mpm_status numbered(void *user, const mpm_material_batch *batch, double *tangent, int32_t *symmetric) {
  (void)symmetric;
  const host *h = user;
  for (int row = 0; row < h->rows; ++row)
    for (int64_t p = 0; p < batch->n; ++p) tangent[row * batch->ld + p] = row + 0.5;
  return MPM_OK;
}

static mpm_material *host_material(host *h, mpm_stress_fn stress, mpm_tangent_fn tangent, int32_t form) {
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  mpm_material *material;
  mpm_material_desc d = material_desc(1e3, stress, h);
  *h = (host){.symmetric = 1, .rows = form};
  d.state_count = 1;
  d.tangent = tangent;
  d.tangent_form = form;
  ck_ok(context, mpm_material_create_custom(context, &d, &material));
  return material;
}

/* ---- a batch of the host ---- */
static _Alignas(64) double scratch[96 * LD];
static tangent_batch b;

/* States, and the outputs that a law finds preset. */
static void fill(int32_t dim) {
  uint64_t state = 61;
  tangent_fill(&b, &state, dim);
  memset(b.s.stress, 0, sizeof b.s.stress);
  for (int i = 0; i < ITEMS; ++i) {
    sample_set_stress(&b.s, dim, i, random_stress(&state, dim, 5e4L));
    b.s.energy[i] = (double)NAN;
  }
  b.s.id[3] = -1;
}

/* The tangent alone; what it leaves of rows, scratch and the batch is checked. */
static mpm_status run(const mpm_material *material, int32_t dim) {
  static sample before;
  const size_t used = mpmi_material_tangent_scratch(material, LD) / sizeof(double);
  ck_assert_uint_ge(used, 36 * LD);
  ck_assert_uint_lt(used, sizeof scratch / sizeof scratch[0]);
  for (size_t k = 0; k < sizeof scratch / sizeof scratch[0]; ++k) scratch[k] = sample_unset;
  for (int k = 0; k < 81 * LD; ++k) b.c[k] = sample_unset;
  before = b.s;
  b.symmetric = 1;
  mpm_status status =
      mpmi_material_tangent(material, MPM_ISA_BASELINE, dim, &b.s.batch, scratch, b.c, &b.symmetric);
  ck_assert_mem_eq(&before, &b.s, sizeof before);
  for (size_t k = used; k < sizeof scratch / sizeof scratch[0]; ++k) ck_assert(scratch[k] == sample_unset);
  for (int row = 0; row < 81; ++row) {
    const int32_t exists = row / 27 < dim && row / 9 % 3 < dim && row / 3 % 3 < dim && row % 3 < dim;
    for (int i = exists ? ITEMS : 0; i < LD; ++i) ck_assert(b.c[row * LD + i] == sample_unset);
    if (exists && !status) ck_assert(b.c[row * LD + 3] == 0.0); /* inert */
  }
  return status;
}

/* Largest error of the items that are not inert. */
static real against(real (*exact)[81], int32_t dim) {
  real worst = 0, odd;
  for (int i = 0; i < ITEMS; ++i)
    if (b.s.id[i] >= 0) worst = fmaxl(worst, tangent_error(&b, dim, i, exact[i], &odd));
  return worst;
}

START_TEST(forms_agree) {
  const int32_t dim = _i;
  static real exact[ITEMS][81];
  mpm_material *built_in = law_material(MPM_ISA_BASELINE, "neo_hookean", params, 3);
  fill(dim);
  tangent_run(&b, built_in, MPM_ISA_BASELINE, dim);
  for (int i = 0; i < ITEMS; ++i)
    for (int row = 0; row < 81; ++row) exact[i][row] = b.c[row * LD + i];
  law_material_free(built_in);

  const struct {
    mpm_tangent_fn tangent;
    int32_t form, rows;
    real tolerance;
  } way[] = {{minor_symmetric, MPM_TANGENT_MINOR_SYMMETRIC, 36, 1e-14L},
             {general, MPM_TANGENT_GENERAL, 81, 1e-14L},
             {NULL, MPM_TANGENT_MINOR_SYMMETRIC, 43, 1e-8L}};
  for (int k = 0; k < 3; ++k) {
    host h;
    mpm_material *material = host_material(&h, neo_hookean, way[k].tangent, way[k].form);
    fill(dim);
    sample_evaluate(&b.s, material, dim);
    ck_assert_uint_eq(mpmi_material_tangent_scratch(material, LD), (size_t)way[k].rows * LD * sizeof(double));
    ck_ok(material->context, run(material, dim));
    const real error = against(exact, dim);
    ck_assert_msg(error <= way[k].tolerance, "form %d, %d-D: %Lg", k, dim, error);
    ck_assert_int_eq(b.symmetric, k < 2);
    ck_assert_int_eq(h.tangent_calls, k < 2);
    ck_assert_int_eq(h.stress_calls, 1 + (k < 2 ? 0 : 2 * dim * dim));
    h.symmetric = 0;
    ck_ok(material->context, run(material, dim));
    ck_assert_int_eq(b.symmetric, 0);
    law_material_free(material);
  }
}
END_TEST

/* Components go where they belong; a callback that is silent about symmetry has none. */
START_TEST(components) {
  host h;
  static const int32_t forms[] = {MPM_TANGENT_MINOR_SYMMETRIC, MPM_TANGENT_GENERAL};
  for (int n = 0; n < 2; ++n) {
    const int32_t minor = n == 0;
    mpm_material *material = host_material(&h, neo_hookean, numbered, forms[n]);
    fill(3);
    ck_ok(material->context, run(material, 3));
    ck_assert_int_eq(b.symmetric, 0);
    for (int row = 0; row < 6 * 6; ++row) {
      const int i = sym_row[row / 6], j = sym_column[row / 6], k = sym_row[row % 6], l = sym_column[row % 6];
      const double expected = (minor ? row : tangent_row(i, j, k, l)) + 0.5;
      ck_assert_double_eq(b.c[tangent_row(i, j, k, l) * LD], expected);
      if (minor) ck_assert_double_eq(b.c[tangent_row(j, i, k, l) * LD], expected);
      if (minor) ck_assert_double_eq(b.c[tangent_row(i, j, l, k) * LD], expected);
    }
    law_material_free(material);
  }
}
END_TEST

/* With M = J (stiffness F_inc F_inc^T + viscosity F_inc / dt), d tau_ij / d L_kl = d_kl tau_ij + d_ik M_lj +
 * d_jk M_li. */
START_TEST(rate_of_deformation) {
  const int32_t dim = _i;
  static real exact[ITEMS][81];
  host h;
  mpm_material *material = host_material(&h, rate_law, NULL, MPM_TANGENT_MINOR_SYMMETRIC);
  fill(dim);
  sample_evaluate(&b.s, material, dim);
  ck_ok(material->context, run(material, dim));
  ck_assert_int_eq(b.symmetric, 0);
  for (int p = 0; p < ITEMS; ++p) {
    tensor f = load(b.s.F_inc, LD, p), tau = {{{0}}};
    const real jacobian = det(sample_F(&b.s, p));
    for (int c = 0; c < 6; ++c)
      tau.m[sym_row[c]][sym_column[c]] = tau.m[sym_column[c]][sym_row[c]] =
          jacobian * b.s.stress_new[c * LD + p];
    tensor m = combine(jacobian * stiffness, multiply(f, transpose(f)), jacobian * viscosity / tangent_dt, f);
    for (int row = 0; row < 81; ++row) {
      const int i = row / 27, j = row / 9 % 3, k = row / 3 % 3, l = row % 3;
      exact[p][row] = (k == l) * tau.m[i][j] + (i == k) * (m.m[l][j] - tau.m[j][l]) +
                      (j == k) * (m.m[l][i] - tau.m[i][l]);
    }
  }
  const real error = against(exact, dim);
  ck_assert_msg(error <= 1e-9L, "%d-D: %Lg", dim, error);
  law_material_free(material);
}
END_TEST

START_TEST(statuses) {
  static const mpm_status answers[] = {MPM_CUT_DT, MPM_E_CALLBACK, 77, -77};
  for (int k = 0; k < 4; ++k) {
    host h;
    mpm_material *material = host_material(&h, neo_hookean, minor_symmetric, MPM_TANGENT_MINOR_SYMMETRIC);
    fill(2);
    h.answer = answers[k];
    ck_assert_int_eq(run(material, 2), answers[k]);
    ck_assert_int_eq(h.tangent_calls, 1);
    law_material_free(material);
    for (int call = 1; call <= 8; ++call) {
      material = host_material(&h, neo_hookean, NULL, MPM_TANGENT_MINOR_SYMMETRIC);
      fill(2);
      h.answer = answers[k];
      h.fails_at = call;
      ck_assert_int_eq(run(material, 2), answers[k]);
      ck_assert_int_eq(h.stress_calls, call);
      law_material_free(material);
    }
  }
}
END_TEST

TCase *tangent_host_case(void) {
  TCase *tc = tcase_create("host");
  tcase_add_loop_test(tc, forms_agree, 1, 4);
  tcase_add_test(tc, components);
  tcase_add_loop_test(tc, rate_of_deformation, 1, 4);
  tcase_add_test(tc, statuses);
  return tc;
}
