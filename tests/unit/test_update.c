/* Materials without a grid: mpm_material_update gives what the law gives in a step, for any number of
 * items. */
#include "tangent_sample.h"

enum { MOST = 300, SPACE = MOST + 7, PARAMS = 3 };

typedef struct driven {
  double F[9 * SPACE], F_inc[9 * SPACE], L[9 * SPACE], stress[6 * SPACE], state[SPACE], position[3 * SPACE];
  double stress_new[6 * SPACE], state_new[SPACE], wave[SPACE], viscosity[SPACE], energy[SPACE], c[81 * SPACE];
  int64_t id[SPACE];
  mpm_material_batch batch;
} driven;

static const mpm_param metal[] = {{"E", 2.5e6}, {"nu", 0.25}, {"density", 1e3}, {"yield_stress", 4e4}};

static void fill(driven *d, int64_t n, int32_t state_count) {
  uint64_t seed = 5;
  double *rows[] = {d->stress_new, d->state_new, d->wave, d->viscosity, d->energy};
  for (int64_t i = 0; i < SPACE; ++i) {
    const tensor g = random_tensor(&seed, 3, i % 2 ? 0.1L : 1e-3L), s = random_stress(&seed, 3, 1e4L);
    const tensor f =
        multiply(combine(1, identity(), 1, g), combine(1, identity(), 1, random_tensor(&seed, 3, 0.1L)));
    for (int c = 0; c < 9; ++c) {
      d->F[c * SPACE + i] = (double)f.m[c / 3][c % 3];
      d->F_inc[c * SPACE + i] = (double)((c % 4 == 0) + g.m[c / 3][c % 3]);
      d->L[c * SPACE + i] = (d->F_inc[c * SPACE + i] - (c % 4 == 0)) / 0.5;
    }
    for (int c = 0; c < 6; ++c) d->stress[c * SPACE + i] = (double)s.m[sym_row[c]][sym_column[c]];
    for (int c = 0; c < 6; ++c) d->stress_new[c * SPACE + i] = sample_unset;
    d->state[i] = 0.01 * (double)(i % 5);
    d->id[i] = 100 + i;
    for (int k = 1; k < 5; ++k) rows[k][i] = sample_unset;
    for (int k = 0; k < 3; ++k) d->position[k * SPACE + i] = (double)(10 * i + k);
  }
  d->batch = (mpm_material_batch){.struct_size = sizeof d->batch,
                                  .state_count = state_count,
                                  .n = n,
                                  .ld = SPACE,
                                  .t = 1.0,
                                  .dt = 0.5,
                                  .F = d->F,
                                  .F_inc = d->F_inc,
                                  .stress = d->stress,
                                  .state = d->state,
                                  .stress_new = d->stress_new,
                                  .state_new = d->state_new,
                                  .wave_speed = d->wave,
                                  .kinematic_viscosity = d->viscosity,
                                  .energy = d->energy};
}

/* One item at a time, by the law itself. */
static void ck_item(const mpm_material *material, const driven *d, int64_t i) {
  static tangent_batch b;
  sample_clear(&b.s, 0.5);
  for (int c = 0; c < 9; ++c) {
    b.s.F[c * LD] = d->F[c * SPACE + i];
    b.s.F_inc[c * LD] = d->F_inc[c * SPACE + i];
    b.s.L[c * LD] = d->L[c * SPACE + i];
  }
  for (int k = 0; k < ITEMS; ++k)
    for (int c = 0; c < 6; ++c) b.s.stress[c * LD + k] = d->stress[c * SPACE + i];
  b.s.state[0] = d->state[i];
  b.symmetric = 1;
  sample_evaluate(&b.s, material, 3);
  ck_ok(material->context, mpmi_material_tangent(material, 3, &b.s.batch, NULL, b.c, &b.symmetric));
  for (int c = 0; c < 6; ++c) ck_assert(d->stress_new[c * SPACE + i] == b.s.stress_new[c * LD]);
  for (int c = 0; c < 81; ++c) ck_assert(d->c[c * SPACE + i] == b.c[c * LD]);
  ck_assert(d->wave[i] == b.s.wave_speed[0] && d->viscosity[i] == b.s.viscosity[0]);
  ck_assert(d->energy[i] == b.s.energy[0]);
  if (material->state_count) ck_assert(d->state_new[i] == b.s.state_new[0]);
}

START_TEST(is_the_law_of_a_step) {
  static const int64_t counts[] = {0, 1, 63, 64, 65, MOST};
  static driven d;
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa)
    for (int32_t law = 0; law < 2; ++law) {
      mpm_material *m = law_material(isa, law ? "j2" : "neo_hookean", metal, law ? 4 : PARAMS);
      for (int32_t k = 0; m && k < 6; ++k) {
        int32_t symmetric = -1;
        fill(&d, counts[k], m->state_count);
        ck_ok(m->context, mpm_material_update(m, &d.batch, d.c, &symmetric));
        ck_assert_int_eq(symmetric, counts[k] ? !law : 1);
        for (int64_t i = 0; i < counts[k]; ++i) ck_item(m, &d, i);
        for (int64_t i = counts[k]; i < SPACE; ++i) ck_assert(d.stress_new[i] == sample_unset);
      }
      if (m) law_material_free(m);
    }
}
END_TEST

START_TEST(what_may_be_left_out) {
  static driven d, all;
  mpm_material *m = law_material(MPM_ISA_BEST, "j2", metal, 4);
  fill(&all, MOST, 1);
  ck_ok(m->context, mpm_material_update(m, &all.batch, NULL, NULL));
  fill(&d, MOST, 1);
  d.batch.L = d.L;
  d.batch.wave_speed = d.batch.kinematic_viscosity = d.batch.energy = NULL;
  d.batch.stress_new = d.stress; /* in place */
  d.batch.state_new = d.state;
  ck_ok(m->context, mpm_material_update(m, &d.batch, NULL, NULL));
  ck_assert(d.wave[0] == sample_unset && d.energy[MOST - 1] == sample_unset);
  for (int64_t i = 0; i < MOST; ++i) {
    for (int c = 0; c < 6; ++c) ck_assert(d.stress[c * SPACE + i] == all.stress_new[c * SPACE + i]);
    ck_assert(d.state[i] == all.state_new[i]);
  }
  /* the state as it is */
  fill(&d, 3, 1);
  d.batch.dt = 0.0;
  ck_ok(m->context, mpm_material_update(m, &d.batch, NULL, NULL));
  for (int64_t i = 0; i < 3; ++i)
    ck_assert(d.stress_new[i] == d.stress[i] && d.state_new[i] == d.state[i] && d.wave[i] > 0.0);
  /* what an inert item holds does not matter */
  fill(&d, 3, 1);
  d.batch.id = d.id;
  d.id[1] = -1;
  d.F[1] = d.stress[1] = (double)NAN;
  ck_ok(m->context, mpm_material_update(m, &d.batch, d.c, NULL));
  ck_assert(d.stress_new[0] == all.stress_new[0] && d.stress_new[2] == all.stress_new[2]);
  ck_assert(isfinite(d.stress_new[1]) && isfinite(d.c[1]));
  law_material_free(m);
}
END_TEST

static void refuses(mpm_material *m, const driven *d, double *tangent, mpm_status status, const char *text) {
  ck_refused(m->context, mpm_material_update(m, &d->batch, tangent, NULL), status, text);
}

START_TEST(refusals) {
  static driven d;
  mpm_material *m = law_material(MPM_ISA_BEST, "j2", metal, 4);
  static const size_t arrays[] = {
      offsetof(mpm_material_batch, F),          offsetof(mpm_material_batch, F_inc),
      offsetof(mpm_material_batch, stress),     offsetof(mpm_material_batch, state),
      offsetof(mpm_material_batch, stress_new), offsetof(mpm_material_batch, state_new)};
  ck_assert_int_eq(mpm_material_update(NULL, &d.batch, NULL, NULL), MPM_E_ARG);
  ck_refused(m->context, mpm_material_update(m, NULL, NULL, NULL), MPM_E_ARG, "mpm_material_batch is NULL");
  for (int32_t k = 0; k < 6; ++k) {
    fill(&d, 70, 1);
    memset((char *)&d.batch + arrays[k], 0, sizeof(double *));
    refuses(m, &d, NULL, MPM_E_ARG, "is NULL");
    d.batch.n = 0;
    ck_ok(m->context, mpm_material_update(m, &d.batch, NULL, NULL));
  }
  fill(&d, 70, 1), d.batch.struct_size = 8, refuses(m, &d, NULL, MPM_E_ARG, "it has no _init: zero it");
  fill(&d, -1, 1), refuses(m, &d, NULL, MPM_E_ARG, "n = -1");
  fill(&d, 70, 1), d.batch.ld = 69, refuses(m, &d, NULL, MPM_E_ARG, "ld = 69");
  fill(&d, 70, 1), d.batch.ld = INT64_MAX, refuses(m, &d, NULL, MPM_E_ARG, "n <= ld <= 4294967294");
  fill(&d, 70, 2), refuses(m, &d, NULL, MPM_E_ARG, "state_count = 2, but the material has 1");
  fill(&d, 70, 1), d.batch.dt = -1.0, refuses(m, &d, NULL, MPM_E_ARG, "dt = -1");
  fill(&d, 70, 1), d.batch.t = (double)NAN, refuses(m, &d, NULL, MPM_E_ARG, "must be finite");
  fill(&d, 70, 1), d.batch.dt = 0.0, refuses(m, &d, d.c, MPM_E_ARG, "dt must be > 0");
  fill(&d, 70, 1), d.F[66] = (double)INFINITY, refuses(m, &d, NULL, MPM_NONFINITE, "item 66, id 66");
  fill(&d, 70, 1), d.state[67] = (double)NAN, refuses(m, &d, NULL, MPM_NONFINITE, "item 67");
  fill(&d, 70, 1), d.batch.L = d.L, d.L[3] = (double)NAN, refuses(m, &d, NULL, MPM_NONFINITE, "item 3");
  fill(&d, 70, 1), d.batch.id = d.id, d.F_inc[68] = -1.0;
  refuses(m, &d, NULL, MPM_INVERTED, "item 68, id 168");
  fill(&d, 70, 1), d.batch.L = d.L, d.L[4] *= 1.001, refuses(m, &d, NULL, MPM_E_ARG, "L is not");
  fill(&d, 70, 1), d.stress[69] = 1e300,
                   refuses(m, &d, NULL, MPM_NONFINITE, "wave speed is not finite at item 69");
  law_material_free(m);
  m = law_material(MPM_ISA_BEST, "linear_elastic", metal, 3);
  fill(&d, 70, 0), d.stress[68] = 1e160,
                   refuses(m, &d, NULL, MPM_NONFINITE, "energy is not finite at item 68");
  law_material_free(m);
}
END_TEST

static mpm_status tangent_of_host(void *user, const mpm_material_batch *b, double *tangent,
                                  int32_t *symmetric) {
  const double *bad = user;
  for (int64_t i = 0; i < 81 * b->ld; ++i) tangent[i] = 1.0;
  tangent[80 * b->ld + b->n - 1] = *bad;
  *symmetric = 1;
  return MPM_OK;
}

static mpm_status law_at_rest(void *user, const mpm_material_batch *b) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    for (int c = 0; c < 6; ++c) b->stress_new[c * b->ld + i] = 0.0;
    b->wave_speed[i] = 1.0;
  }
  return MPM_OK;
}

START_TEST(tangents_of_the_host) {
  static driven d;
  double last = 1.0;
  int32_t symmetric = 0;
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  mpm_material_desc desc;
  mpm_material *m;
  ck_ok(context, mpm_material_desc_init(&desc, sizeof desc));
  desc.density = 1.0, desc.stress = law_at_rest, desc.tangent = tangent_of_host, desc.user = &last;
  desc.tangent_form = MPM_TANGENT_GENERAL;
  ck_ok(context, mpm_material_create_custom(context, &desc, &m));
  fill(&d, 3, 0);
  ck_ok(context, mpm_material_update(m, &d.batch, d.c, &symmetric));
  ck_assert(symmetric == 1 && d.c[80 * SPACE + 2] == 1.0);
  last = (double)NAN;
  refuses(m, &d, d.c, MPM_NONFINITE, "the material's tangent is not finite at item 2");
  ck_ok(context, mpm_material_update(m, &d.batch, NULL, NULL));
  ck_ok(context, mpm_material_destroy(m));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

typedef struct answer {
  mpm_status status, in_callback;
  double wave_speed;
  const mpm_material *self;
  int32_t at_rest;       /* F_inc is I, L is 0 */
  int64_t calls, spoilt; /* the id that gets an infinite stress */
} answer;

static mpm_status law_of_host(void *user, const mpm_material_batch *b) {
  answer *a = user;
  const void *data;
  int64_t stride;
  ++a->calls;
  a->in_callback = mpm_material_update(a->self, b, NULL, NULL);
  if (mpm_batch_field(b->lookup, "mass", &data, &stride) != MPM_E_ARG) return -7;
  for (int64_t i = 0; i < b->n; ++i) {
    for (int c = 0; c < 9 && a->at_rest; ++c)
      if (b->F_inc[c * b->ld + i] != (c % 4 == 0) || b->L[c * b->ld + i] != 0.0) return -8;
    for (int c = 0; c < 6; ++c)
      b->stress_new[c * b->ld + i] = b->stress[c * b->ld + i] + b->position[c % 3 * b->ld + i] + b->t;
    b->state_new[i] = b->state[i] + (double)b->id[i];
    b->wave_speed[i] = b->id[i] == 399 ? a->wave_speed : 2.0;
    if (b->id[i] == a->spoilt) b->stress_new[5 * b->ld + i] = (double)INFINITY;
  }
  return a->status;
}

START_TEST(laws_of_the_host) {
  static driven d;
  answer a = {.wave_speed = 2.0};
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  mpm_material_desc desc;
  mpm_material *m;
  ck_ok(context, mpm_material_desc_init(&desc, sizeof desc));
  desc.state_count = 1, desc.density = 1.0, desc.stress = law_of_host, desc.user = &a;
  ck_ok(context, mpm_material_create_custom(context, &desc, &m));
  a.self = m;
  fill(&d, MOST, 1);
  d.batch.id = d.id;
  d.batch.position = d.position;
  ck_ok(context, mpm_material_update(m, &d.batch, d.c, NULL));
  ck_assert_int_eq(a.in_callback, MPM_E_STATE);
  ck_assert_int_ge(a.calls, 2);
  for (int64_t i = 0; i < MOST; ++i) {
    for (int c = 0; c < 6; ++c)
      ck_assert(d.stress_new[c * SPACE + i] ==
                d.stress[c * SPACE + i] + d.position[c % 3 * SPACE + i] + d.batch.t);
    ck_assert(d.state_new[i] == d.state[i] + (double)d.id[i] && d.wave[i] == 2.0 && isnan(d.energy[i]));
  }
  d.batch.position = NULL; /* zeros, also where memory was used before */
  ck_ok(context, mpm_material_update(m, &d.batch, NULL, NULL));
  for (int64_t i = 0; i < MOST; ++i) ck_assert(d.stress_new[i] == d.stress[i] + d.batch.t);
  d.batch.dt = 0.0;
  a.at_rest = 1;
  ck_ok(context, mpm_material_update(m, &d.batch, NULL, NULL));
  d.batch.dt = 0.5;
  a.at_rest = 0;
  a.status = 3, refuses(m, &d, NULL, MPM_CUT_DT, "the law returned 3 for items 0 to 255");
  a.status = -3, refuses(m, &d, NULL, MPM_E_CALLBACK, "the law returned -3");
  a.status = 0, a.wave_speed = -1.0, refuses(m, &d, NULL, MPM_E_CALLBACK, "wave speed is negative at id 399");
  a.wave_speed = 2.0, a.spoilt = 377, refuses(m, &d, NULL, MPM_NONFINITE, "item 277, id 377");
  a.spoilt = 0, a.wave_speed = (double)NAN, refuses(m, &d, NULL, MPM_NONFINITE, "item 299, id 399");
  ck_ok(context, mpm_material_destroy(m));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Every law names its state, once each. */
START_TEST(names_of_states) {
  const char *name, *unit, *text, *other;
  for (int32_t m = 0; m < mpm_material_model_count(); ++m) {
    const char *model = mpm_material_model_name(m);
    const int32_t count = mpm_material_state_count(model);
    ck_assert_int_ge(count, 0);
    for (int32_t k = 0; k < count; ++k) {
      ck_ok(NULL, mpm_material_state_name(model, k, &name, &unit, &text));
      ck_assert(name && name[0] && unit && unit[0] && text && text[0]);
      for (int32_t l = 0; l < k; ++l) {
        ck_ok(NULL, mpm_material_state_name(model, l, &other, NULL, NULL));
        ck_assert_str_ne(name, other);
      }
    }
    ck_assert_int_eq(mpm_material_state_name(model, count, NULL, NULL, NULL), MPM_E_NOT_FOUND);
  }
  ck_ok(NULL, mpm_material_state_name("j2", 0, &name, NULL, NULL));
  ck_assert_str_eq(name, "plastic_strain");
  ck_assert_int_eq(mpm_material_state_count("j2"), 1);
  ck_assert_int_eq(mpm_material_state_count("ether"), -1);
  ck_assert_int_eq(mpm_material_state_count(NULL), -1);
  ck_assert_int_eq(mpm_material_state_name("j2", -1, NULL, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_material_state_name(NULL, 0, NULL, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_material_state_name("ether", 0, NULL, NULL, NULL), MPM_E_NOT_FOUND);
}
END_TEST

Suite *update_suite(void) {
  Suite *suite = suite_create("update");
  TCase *tc = tcase_create("update");
  tcase_add_test(tc, is_the_law_of_a_step);
  tcase_add_test(tc, what_may_be_left_out);
  tcase_add_test(tc, refusals);
  tcase_add_test(tc, laws_of_the_host);
  tcase_add_test(tc, tangents_of_the_host);
  tcase_add_test(tc, names_of_states);
  suite_add_tcase(suite, tc);
  return suite;
}
