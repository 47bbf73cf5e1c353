/* snow: numbers of an independent program, whole steps again in extended precision, and what the host may
 * set. */
#include "law_path.h"
#include "simd/elementary.h"
#include "simd/tensor.h"

enum { HARDENING = 3, COMPRESSION, STRETCH, MOST, PARAMS };
typedef struct snow {
  mpm_param value[PARAMS];
} snow;

static snow with(double hardening, double compression, double stretch, double most) {
  return (snow){{{"E", 1.4e5},
                 {"nu", 0.2},
                 {"density", 400.0},
                 {"hardening", hardening},
                 {"critical_compression", compression},
                 {"critical_stretch", stretch},
                 {"hardening_max", most}}};
}
static snow usual(void) {
  return with(10.0, 0.025, 0.0075, 148.4131591025766);
}
static path open_snow(const snow *of) {
  return path_of("snow", of->value, PARAMS);
}

static tensor tensor_of(const double *rows) {
  tensor t;
  for (int c = 0; c < 9; ++c) t.m[c / 3][c % 3] = rows[mpmi_sym_index(c / 3, c % 3)];
  return t;
}

/* J_P of a particle: det F over the root of det b. */
static double plastic_volume(const path *s) {
  return jacobian_of(s) / (double)sqrtl(1 + det_minus_1(tensor_of(s->state)));
}

START_TEST(uniaxial) {
  static const struct {
    double F, S, J_P, along, across;
  } rows[] = {{0.93, 0.975, 0.953846153846, -6015.528069687, -1503.882017422},
              {1.02, 1.0075, 1.012406947891, 1038.267247790, 259.566811948}};
  const snow of = usual();
  path s = open_snow(&of);
  for (int k = 0; k < 2; ++k) {
    start(&s, 0.0);
    stretch(&s, mpmi_ln(rows[k].F), 0.0, 0.0);
    const double J = jacobian_of(&s);
    ck_within("S", sqrt(1.0 + s.state[0]), rows[k].S, 1e-14);
    ck_within("J_P", plastic_volume(&s), rows[k].J_P, 1e-12);
    ck_number("along", J * s.stress[0], rows[k].along);
    ck_number("across", J * s.stress[1], rows[k].across);
    ck_number("across", J * s.stress[2], rows[k].across);
  }
  law_material_free(s.material);
}
END_TEST

START_TEST(path_with_shear) {
  const snow of = usual();
  path s = open_snow(&of);
  start(&s, 0.0);
  stretch(&s, mpmi_ln(0.97), mpmi_ln(0.96), 0.0);
  shear(&s, 0.1, 1);
  ck_number("xx", s.stress[0], -2825.545507915);
  ck_number("yy", s.stress[1], -3161.687886230);
  ck_number("xy", s.stress[3], 3361.423783147);
  ck_within("J_P", plastic_volume(&s), 0.947967169307, 1e-12);
  stretch(&s, 0.0, mpmi_ln(1.03), 0.0);
  ck_number("xx", s.stress[0], -2365.649999755);
  ck_number("yy", s.stress[1], 143.395564477);
  ck_number("xy", s.stress[3], 1470.680581838);
  ck_within("J_P", plastic_volume(&s), 0.967024809669, 1e-12);
  law_material_free(s.material);
}
END_TEST

/* Small steps forth and back leave nothing. */
START_TEST(digits) {
  const snow of = usual();
  path s = open_snow(&of);
  start(&s, 0.0);
  stretch(&s, -0.004, 0.0, 0.0);
  const double before = s.stress[0];
  for (int k = 0; k < 4000; ++k) shear(&s, k % 4 < 2 ? 1e-7 : -1e-7, 1);
  ck_within("stress", s.stress[0], before, 1e-11 * fabs(before));
  law_material_free(s.material);
}
END_TEST

/* Compaction stiffens up to hardening_max, and what is torn bears nothing: both are states. */
START_TEST(ends_of_the_range) {
  const snow of = usual();
  path s = open_snow(&of);
  const double mu = 1.4e5 / 2.4, lambda = 2.0 * mu * 0.2 / 0.6;
  start(&s, 0.0);
  for (int k = 0; k < 20; ++k) stretch(&s, -0.1, -0.1, -0.1);
  const double S = 0.975, J_E = S * S * S;
  ck_number("pressure", jacobian_of(&s) * s.stress[0],
            148.4131591025766 * (2.0 * mu * (S - 1.0) * S + lambda * (J_E - 1.0) * J_E));
  ck_number("wave", s.wave, sqrt(148.4131591025766 * (2.0 * mu * S * S + lambda * J_E * J_E) / 400.0));
  ck_number("energy", s.energy,
            148.4131591025766 *
                (3.0 * mu * (S - 1.0) * (S - 1.0) + 0.5 * lambda * (J_E - 1.0) * (J_E - 1.0)));
  for (int k = 0; k < 200; ++k) stretch(&s, 0.1, 0.1, 0.1);
  for (int c = 0; c < 6; ++c) ck_within("stress", s.stress[c], 0.0, 1e-9);
  for (int c = 0; c < 81; ++c) ck_holds(fabs(s.tangent[c]) < 1e-9);
  ck_holds(s.wave >= 0.0 && s.energy >= 0.0);
  law_material_free(s.material);
}
END_TEST

START_TEST(parameters_are_refused) {
  static const struct {
    int which;
    double value;
    const char *text;
  } rows[] = {{HARDENING, -1.0, "hardening = -1"},
              {COMPRESSION, 0.0, "critical_compression = 0"},
              {COMPRESSION, 1.0, "critical_compression = 1"},
              {STRETCH, -0.1, "critical_stretch = -0.1"},
              {MOST, 0.5, "hardening_max = 0.5"}};
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    snow of = usual();
    mpm_material *m;
    of.value[rows[k].which].value = rows[k].value;
    ck_refused(context, mpm_material_create(context, "snow", of.value, PARAMS, &m), MPM_E_ARG, rows[k].text);
    ck_assert_ptr_null(m);
  }
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Stress follows from F and state, when the host sets either; it is not the host's to set. */
START_TEST(state_of_the_host) {
  const int32_t dim = 1 + _i;
  const snow of = usual();
  const double F[9] = {0.9, 0, 0, 0, 1, 0, 0, 0, 1}, zero[6] = {0.0};
  const double be[6] = {-0.01, 0.002, 0.003, dim > 1 ? 0.004 : 0.0, 0.0, 0.0};
  world w;
  world_desc d = world_default(dim, 8, 0.1);
  d.law = (world_law){.model = "snow", .params = of.value, .param_count = PARAMS};
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = world_fill_cube(&w, set, 0.2, 0.6);
  path s = open_snow(&of);
  ck_refused(&w, mpm_particles_set_all(set, "stress", MPM_F64, 6, zero), MPM_E_UNSUPPORTED, "state");
  for (int k = 0; k < 2; ++k) {
    if (k == 0) ck_ok(&w, mpm_particles_set_all(set, "state", MPM_F64, 6, be));
    if (k == 1) ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
    start(&s, 0.0);
    memcpy(s.state, be, sizeof be);
    if (k == 1) memcpy(s.F, F, sizeof F);
    stretch(&s, 0.0, 0.0, 0.0);
    double *stress = fetch(&w, set, "stress", 6), *state = fetch(&w, set, "state", 6);
    ck_holds(fabs(s.stress[0]) > 100.0);
    for (int64_t i = 0; i < n; ++i)
      for (int c = 0; c < 6; ++c) {
        ck_within("stress", stress[c * n + i], s.stress[c], 1e-11 * 1e5);
        ck_holds(state[c * n + i] == be[c]);
      }
    free(stress), free(state);
  }
  law_material_free(s.material);
  world_close(&w);
}
END_TEST

/* All nodes move as v = A (x - 0.4). */
static mpm_status lead_nodes(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const double *A = user;
  for (int32_t k = 0; k < b->dim; ++k)
    for (int64_t i = 0; i < b->n; ++i) {
      double v = 0.0;
      for (int32_t c = 0; c < b->dim; ++c) v += A[3 * k + c] * (b->position[c * b->ld + i] - 0.4);
      prescribed[k * b->ld + i] = 1;
      velocity[k * b->ld + i] = v;
    }
  return MPM_OK;
}

/* Steps of a grid are those of the law without one. */
START_TEST(steps_of_a_grid) {
  const int32_t dim = 1 + _i;
  const snow of = usual();
  double A[9] = {-6.0, 2.0, 1.0, 3.0, -2.0, 1.0, -1.0, 2.0, 1.5}, F_inc[9];
  const double dt = 1e-3;
  for (int c = 0; c < 9; ++c) {
    if (c / 3 >= dim || c % 3 >= dim) A[c] = 0.0;
    F_inc[c] = (c % 4 == 0) + dt * A[c];
  }
  world w;
  world_desc d = world_default(dim, 8, 0.1);
  d.law = (world_law){.model = "snow", .params = of.value, .param_count = PARAMS};
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = world_fill_cube(&w, set, 0.2, 0.6);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, lead_nodes, A));
  path s = open_snow(&of);
  start(&s, 0.0);
  for (int k = 0; k < 8; ++k) {
    world_step(&w, dt);
    advance(&s, F_inc);
  }
  double *stress = fetch(&w, set, "stress", 6), *state = fetch(&w, set, "state", 6);
  ck_holds(fabs(s.state[0]) > 0.01);
  for (int64_t i = 0; i < n; ++i)
    for (int c = 0; c < 6; ++c) {
      ck_within("stress", stress[c * n + i], s.stress[c], 1e-9 * 1e5);
      ck_within("state", state[c * n + i], s.state[c], 1e-12);
    }
  free(stress), free(state);
  law_material_free(s.material);
  world_close(&w);
}
END_TEST

/* Snow with a negative ratio of Poisson, far from its plastic limits, has no waves once it has stretched
 * enough: the step in which that comes to pass ends, whichever pass asks the law. */
START_TEST(states_without_waves) {
  static const int32_t schemes[] = {MPM_USL, MPM_USF, MPM_MUSL};
  snow of = with(0.0, 0.025, 1.0, 2.0);
  of.value[0].value = of.value[2].value = 100.0;
  of.value[1].value = -0.9;
  world w;
  world_desc d = world_default(3, 16, 0.5);
  d.law = (world_law){.model = "snow", .params = of.value, .param_count = PARAMS};
  d.stepper.scheme = schemes[_i];
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = world_fill_cube(&w, set, 3.0, 5.0);
  double *v = fetch(&w, set, "position", 3);
  for (int64_t i = 0; i < 3 * n; ++i) v[i] = 5.0 * (v[i] - 4.0);
  put(&w, set, "velocity", 3, v);
  free(v);
  mpm_status status = MPM_OK;
  for (int k = 0; k < 60 && !status; ++k) status = mpm_step(w.stepper, 2e-3, NULL);
  ck_assert_int_eq(status, MPM_NONFINITE);
  ck_assert_ptr_nonnull(strstr(last_error_of(&w), "wave speed is not finite"));
  ck_assert_ptr_nonnull(strstr(last_error_of(&w), "particle"));
  ck_holds(world_stable_dt(&w) > 0.0); /* of the state before */
  world_close(&w);
}
END_TEST

/* ---- random states ------------------------------------------------------------------------------------- */
enum { RANDOM = 100000, TESTED = 3000 };

static snow random_snow(uint64_t *seed) {
  snow of = with(wide(seed, 0.0, 20.0), wide(seed, 0.005, 0.1), wide(seed, 0.0, 0.05), wide(seed, 1.0, 20.0));
  of.value[1].value = wide(seed, -0.2, 0.45);
  return of;
}

/* A step of a random size from a random elastic and plastic deformation. */
static void random_step(uint64_t *seed, path *s, double *F_inc) {
  random_increment(seed, F_inc);
  tensor be = {{{0}}}, F = random_tensor(seed, 3, 0.1L);
  for (int k = 0; k < 3; ++k) be.m[k][k] = 0.05L * uniform(seed);
  be = turned(random_rotation(seed, 3), be);
  start(s, 0.0);
  for (int c = 0; c < 6; ++c) s->state[c] = (double)be.m[sym_row[c]][sym_column[c]];
  for (int c = 0; c < 9; ++c) s->F[c] += (double)F.m[c / 3][c % 3];
}

/* The step in extended precision. Returns how many stretches were cut off below, above; 16 more for the
 * largest h. */
static int32_t reference(const path *from, const double *F_inc, tensor *be, tensor *tau) {
  const double *value = from->material->value;
  const real mu = value[0] / (2 * (1 + (real)value[1])),
             lambda = 2 * mu * value[1] / (1 - 2 * (real)value[1]);
  tensor f, F, b = combine(1, identity(), 1, tensor_of(from->state));
  for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = F_inc[c], F.m[c / 3][c % 3] = from->F[c];
  b = turned(f, b);
  const tensor axes = diagonalise(&b);
  real S[3], J_E = 1;
  int32_t regime = 0;
  for (int k = 0; k < 3; ++k) {
    const real trial = sqrtl(b.m[k][k]), least = 1 - (real)value[COMPRESSION],
               most = 1 + (real)value[STRETCH];
    S[k] = trial < least ? least : trial > most ? most : trial;
    regime += trial < least ? 1 : trial > most ? 4 : 0;
    J_E *= S[k];
  }
  const real J_P = det(f) * det(F) / J_E, grown = expl(value[HARDENING] * (1 - J_P));
  const real h = grown > value[MOST] ? value[MOST] : grown;
  tensor t = {{{0}}}, e = {{{0}}};
  for (int k = 0; k < 3; ++k) {
    e.m[k][k] = S[k] * S[k] - 1;
    t.m[k][k] = h * (2 * mu * (S[k] - 1) * S[k] + lambda * (J_E - 1) * J_E);
  }
  *be = turned(axes, e);
  *tau = turned(axes, t);
  return regime + 16 * (grown > value[MOST]);
}

START_TEST(random_states) {
  uint64_t seed = 51;
  int32_t seen[32] = {0};
  for (int32_t round = 0; round < RANDOM / 500; ++round) {
    const snow of = random_snow(&seed);
    path s = open_snow(&of);
    for (int32_t k = 0; k < 500; ++k) {
      double F_inc[9];
      tensor be, tau;
      random_step(&seed, &s, F_inc);
      ++seen[reference(&s, F_inc, &be, &tau)];
      advance(&s, F_inc);
      const double J = jacobian_of(&s);
      for (int c = 0; c < 6; ++c) {
        ck_within("b", s.state[c], (double)be.m[sym_row[c]][sym_column[c]], 1e-14);
        ck_within("stress", J * s.stress[c], (double)tau.m[sym_row[c]][sym_column[c]], 1e-12 * 20.0 * 1.4e6);
      }
      ck_holds(s.energy >= 0.0 && s.wave > 0.0);
    }
    law_material_free(s.material);
  }
  for (int k = 0; k < 16; ++k) /* low and high ones: three at most */
    if (k % 4 + k / 4 <= 3) ck_assert_int_gt(seen[k], 100);
  ck_assert_int_gt(seen[16] + seen[17] + seen[18] + seen[19], 1000);
}
END_TEST

/* Steps within one regime: which stretches are cut off, and whether h is the largest. */
static int32_t regime_of(const path *from, const path *to) {
  double F_inc[9];
  tensor F, now, be, tau;
  for (int c = 0; c < 9; ++c) F.m[c / 3][c % 3] = from->F[c], now.m[c / 3][c % 3] = to->F[c];
  now = multiply(now, inverse(F));
  for (int c = 0; c < 9; ++c) F_inc[c] = (double)now.m[c / 3][c % 3];
  return reference(from, F_inc, &be, &tau);
}

START_TEST(random_tangents) {
  uint64_t seed = 52;
  int32_t compared = 0, cut = 0, most = 0;
  double worst = 0.0;
  for (int32_t k = 0; k < TESTED; ++k) {
    const snow of = random_snow(&seed);
    path s = open_snow(&of), end;
    double F_inc[9];
    int32_t smooth;
    random_step(&seed, &s, F_inc);
    end = s;
    advance(&end, F_inc);
    const int32_t regime = regime_of(&s, &end);
    const double stiffest = end.wave * end.wave * 400.0;
    const double off = tangent_off(&s, F_inc, regime_of, &smooth) / stiffest;
    if (smooth) {
      worst = fmax(worst, off);
      ++compared;
      cut += regime % 16 > 0;
      most += regime >= 16;
    }
    law_material_free(s.material);
  }
  ck_assert_int_gt(compared, TESTED * 9 / 10);
  ck_assert_int_gt(cut, TESTED / 4);
  ck_assert_int_gt(most, TESTED / 50);
  ck_between("tangent", worst, 0.0, 1e-8);
}
END_TEST

/* A frame that turns with the end of the step turns stress and state; one that turned before it changes
 * nothing. */
START_TEST(frames) {
  uint64_t seed = 53;
  for (int32_t k = 0; k < 500; ++k) {
    const snow of = random_snow(&seed);
    path s = open_snow(&of);
    double F_inc[9];
    random_step(&seed, &s, F_inc);
    const tensor q = random_rotation(&seed, 3);
    path other = s;
    tensor f;
    for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = F_inc[c];
    f = multiply(q, f);
    double turned_inc[9];
    for (int c = 0; c < 9; ++c) turned_inc[c] = (double)f.m[c / 3][c % 3];
    advance(&s, F_inc);
    advance(&other, turned_inc);
    const tensor stress = turned(q, tensor_of(s.stress)), be = turned(q, tensor_of(s.state));
    for (int c = 0; c < 6; ++c) {
      ck_within("stress", other.stress[c], (double)stress.m[sym_row[c]][sym_column[c]], 1e-7);
      ck_within("state", other.state[c], (double)be.m[sym_row[c]][sym_column[c]], 1e-13);
    }
    law_material_free(s.material);
  }
}
END_TEST

START_TEST(dimensions) {
  static const double be[6] = {0.004, -0.03, 0.01, 0.0, 0.0, 0.0};
  const snow of = usual();
  ck_dimensions(_i, "snow", of.value, PARAMS, 0.0L, 0.0L, be, 54);
}
END_TEST

Suite *snow_suite(void) {
  Suite *suite = suite_create("snow");
  TCase *tc = tcase_create("snow");
  tcase_set_timeout(tc, 60.0);
  tcase_add_test(tc, uniaxial);
  tcase_add_test(tc, path_with_shear);
  tcase_add_test(tc, digits);
  tcase_add_test(tc, ends_of_the_range);
  tcase_add_test(tc, parameters_are_refused);
  tcase_add_loop_test(tc, state_of_the_host, 0, 3);
  tcase_add_loop_test(tc, steps_of_a_grid, 0, 3);
  tcase_add_loop_test(tc, states_without_waves, 0, 3);
  tcase_add_test(tc, random_states);
  tcase_add_test(tc, random_tangents);
  tcase_add_test(tc, frames);
  tcase_add_loop_test(tc, dimensions, 0, LAW_LOOPS);
  suite_add_tcase(suite, tc);
  return suite;
}
