/* Single particles: what a UMAT is given, what becomes of its answer, and laws beside those built in. */
#include "umat_test.h"

static const double E = 70e9, nu = 0.3, density = 2700.0, yield = 300e6, hardening = 1e9;

/* ---- what the subroutine is given ---------------------------------------------------------------------- */
typedef struct seen {
  double stress[6], statev[3], stran[6], dstran[6], time[2], dtime, temp, props[2], coords[3], drot[9],
      celent;
  double dfgrd0[9], dfgrd1[9], predef, ddsdde[36];
  char cmname[81];
  int ndi, nshr, ntens, nstatv, nprops, noel, kinc, jstep[4], calls;
  size_t cmname_length;
} seen;
static seen last;

/* Writes STRESS = 1 ... 6 and adds 10, 20, 30 to STATEV. */
static void recorder(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                     double *rpl, double *ddsddt, double *drplde, double *drpldt, const double *stran,
                     const double *dstran, const double *time, const double *dtime, const double *temp,
                     const double *dtemp, const double *predef, const double *dpred, const char *cmname,
                     const int *ndi, const int *nshr, const int *ntens, const int *nstatv,
                     const double *props, const int *nprops, const double *coords, const double *drot,
                     double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1,
                     const int *noel, const int *npt, const int *layer, const int *kspt, const int *jstep,
                     const int *kinc, size_t cmname_length) {
  ck_assert(*sse == 0.0 && *spd == 0.0 && *scd == 0.0 && *rpl == 0.0 && *drpldt == 0.0 && *dtemp == 0.0);
  ck_assert(*predef == 0.0 && *dpred == 0.0 && *pnewdt == 1.0 && *npt == 1 && *layer == 1 && *kspt == 1);
  for (int k = 0; k < 6; ++k) ck_assert(ddsddt[k] == 0.0 && drplde[k] == 0.0);
  memcpy(last.stress, stress, sizeof last.stress);
  memcpy(last.statev, statev, (size_t)*nstatv * sizeof(double));
  memcpy(last.stran, stran, sizeof last.stran);
  memcpy(last.dstran, dstran, sizeof last.dstran);
  memcpy(last.time, time, sizeof last.time);
  memcpy(last.props, props, (size_t)*nprops * sizeof(double));
  memcpy(last.coords, coords, sizeof last.coords);
  memcpy(last.drot, drot, sizeof last.drot);
  memcpy(last.dfgrd0, dfgrd0, sizeof last.dfgrd0);
  memcpy(last.dfgrd1, dfgrd1, sizeof last.dfgrd1);
  memcpy(last.ddsdde, ddsdde, sizeof last.ddsdde);
  memcpy(last.jstep, jstep, sizeof last.jstep);
  memcpy(last.cmname, cmname, 80);
  last.dtime = *dtime, last.temp = *temp, last.celent = *celent;
  last.ndi = *ndi, last.nshr = *nshr, last.ntens = *ntens, last.nstatv = *nstatv, last.nprops = *nprops;
  last.noel = *noel, last.kinc = *kinc, last.cmname_length = cmname_length, last.calls++;
  for (int k = 0; k < 6; ++k) stress[k] = k + 1.0;
  for (int k = 0; k < *nstatv; ++k) statev[k] += 10.0 * (k + 1);
  for (int k = 0; k < 36; ++k) ddsdde[k] = 100.0 + k;
}

static const double state_0[3] = {1.0, 2.0, 3.0}, props_0[2] = {7.0, 8.0};

static mpm_material *recorded(mpm_context *context, int32_t stran) {
  mpm_umat_desc d = umat_desc(density, 2, props_0, 3);
  mpm_material *material;
  d.statev_initial = state_0;
  d.cmname = "SOIL-1";
  d.celent = 0.25;
  d.temperature = 293.0;
  d.wave_modulus = 27e9;
  d.dim = 3;
  d.stran = stran;
  memset(&last, 0, sizeof last);
  ck_ok(context, mpm_umat_material(context, recorder, &d, &material));
  ck_assert_int_eq(last.calls, 0); /* the modulus is given */
  return material;
}

static void ck_columns(const double *columns, const double *rows, double off) {
  for (int k = 0; k < 9; ++k) ck_near(columns[k], rows[k % 3 * 3 + k / 3], off);
}

static const int of_umat[6] = {0, 4, 8, 1, 2, 5}; /* 11 22 33 12 13 23 in a full matrix */
static const int of_library[6] = {0, 4, 8, 1, 5, 2};

static void ck_umat_sym(const double *umat, const double *full, double shear, double off) {
  for (int k = 0; k < 6; ++k) ck_near(umat[k], (k < 3 ? 1.0 : shear) * full[of_umat[k]], off);
}

START_TEST(arguments) {
  mpm_context *context = context_of(1);
  mpm_material *material = recorded(context, 0);
  double q[9], r[9], v[9], log_v[9], F_inc[9], F_old[9], F[9], stress[6], full[9], back[9], turned[9];
  uint64_t seed = 1;
  rotation(1.0, -2.0, 0.5, 0.7, q);
  rotation(0.3, 0.2, 1.0, -0.4, r);
  stretched(q, exp(0.02), exp(-0.3), exp(0.1), v);
  stretched(q, 0.02, -0.3, 0.1, log_v);
  multiply(v, r, F_inc);
  random_increment(&seed, 0.3, F_old);
  multiply(F_inc, F_old, F);
  for (int k = 0; k < 6; ++k) full[of_library[k]] = stress[k] = uniform(&seed, -1e8, 1e8);
  full[3] = full[1], full[6] = full[2], full[7] = full[5];
  const double position[3] = {0.1, 0.2, 0.3};
  const int64_t id = INT64_C(0x700000005);
  double state[4] = {1.0, 2.0, 3.0, 4.0}, stress_new[6], state_new[4], wave_speed;
  mpm_material_batch b = {.struct_size = sizeof b, .state_count = 4, .n = 1, .ld = 1, .t = 5.0, .dt = 0.5};
  b.id = &id, b.F = F, b.F_inc = F_inc, b.stress = stress, b.state = state, b.stress_new = stress_new;
  b.state_new = state_new, b.position = position, b.wave_speed = &wave_speed;
  ck_ok(context, mpm_material_update(material, &b, NULL, NULL));
  ck_assert_int_eq(last.calls, 1);
  ck_columns(last.drot, r, 1e-15);
  ck_columns(last.dfgrd0, F_old, 1e-14);
  ck_columns(last.dfgrd1, F, 0.0);
  ck_umat_sym(last.dstran, log_v, 2.0, 1e-15);
  transpose(r, back);
  multiply(r, full, turned);
  multiply(turned, back, turned);
  ck_umat_sym(last.stress, turned, 1.0, 1e-6);
  for (int k = 0; k < 6; ++k) ck_near(last.stran[k], 0.0, 0.0);
  for (int k = 0; k < 36; ++k) ck_near(last.ddsdde[k], 0.0, 0.0);
  for (int k = 0; k < 3; ++k) {
    ck_near(last.coords[k], position[k], 0.0);
    ck_near(last.statev[k], k + 1.0, 0.0);
    ck_near(state_new[k], 11.0 * (k + 1), 0.0);
  }
  ck_assert(last.time[0] == 4.5 && last.time[1] == 4.5 && last.dtime == 0.5 && last.temp == 293.0);
  ck_assert(last.props[0] == 7.0 && last.props[1] == 8.0 && last.celent == 0.25 && last.nprops == 2);
  ck_assert(last.ndi == 3 && last.nshr == 3 && last.ntens == 6 && last.nstatv == 3);
  ck_assert(last.kinc == 5 && state_new[3] == 5.0 && last.jstep[0] == 1 && last.jstep[2] == 1);
  ck_assert_int_eq(last.noel, (int)(id % INT32_MAX) + 1);
  ck_assert_uint_eq(last.cmname_length, 80);
  ck_assert_int_eq(memcmp(last.cmname, "SOIL-1    ", 10), 0);
  ck_assert_int_eq(last.cmname[79], ' ');
  static const double wanted[6] = {1.0, 2.0, 3.0, 4.0, 6.0, 5.0}; /* 12 13 23 are xy xz yz */
  for (int k = 0; k < 6; ++k) ck_near(stress_new[k], wanted[k], 0.0);
  double J = 0.0;
  for (int k = 0; k < 3; ++k)
    J += F[k] * (F[3 + (k + 1) % 3] * F[6 + (k + 2) % 3] - F[3 + (k + 2) % 3] * F[6 + (k + 1) % 3]);
  ck_near(wave_speed, sqrt(27e9 * J / density), 1e-12 * wave_speed);
  /* the state as it is: the UMAT is left alone */
  b.dt = 0.0;
  ck_ok(context, mpm_material_update(material, &b, NULL, NULL));
  ck_assert_int_eq(last.calls, 1);
  ck_assert(!memcmp(stress_new, stress, sizeof stress) && !memcmp(state_new, state, sizeof state));
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Of more items than a piece has, with inert ones in between: each gets its own, and ld is not n. */
START_TEST(many_items) {
  enum { N = 75, LD = 80 };
  mpm_context *context = context_of(1);
  const double props[2] = {E, nu};
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  const mpm_param elastic[] = {{"E", E}, {"nu", nu}, {"density", density}};
  mpm_material *material, *built_in;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, &d, &material));
  ck_ok(context, mpm_material_create(context, "linear_elastic", elastic, 3, &built_in));
  static double F[9 * LD], F_inc[9 * LD], stress[6 * LD], out[2][6 * LD], state[LD], state_new[LD];
  static int64_t id[LD];
  uint64_t seed = 3;
  for (int i = 0; i < N; ++i) {
    double f[9];
    random_increment(&seed, 0.05, f);
    id[i] = i % 7 == 3 ? -1 : 1000 + i;
    state[i] = i;
    for (int k = 0; k < 9; ++k) F[k * LD + i] = F_inc[k * LD + i] = f[k];
    for (int k = 0; k < 6; ++k) stress[k * LD + i] = uniform(&seed, -1e8, 1e8);
  }
  mpm_material_batch b = {.struct_size = sizeof b, .n = N, .ld = LD, .t = 1.0, .dt = 1.0};
  b.id = id, b.F = F, b.F_inc = F_inc, b.stress = stress, b.stress_new = out[0];
  ck_ok(context, mpm_material_update(built_in, &b, NULL, NULL));
  b.state_count = 1, b.state = state, b.state_new = state_new, b.stress_new = out[1];
  ck_ok(context, mpm_material_update(material, &b, NULL, NULL));
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 6 && id[i] >= 0; ++k) {
      ck_near(out[1][k * LD + i], out[0][k * LD + i], 1e-12 * 1e10);
      ck_near(state_new[i], i + 1.0, 0.0);
    }
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_material_destroy(built_in));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* STRAN is the sum of the increments, each turned by the rotations that came after it, and in the right
 * places. */
START_TEST(total_strain) {
  mpm_context *context = context_of(1);
  mpm_material *material = recorded(context, 1);
  point p = point_of(material, 3 + 6 + 1);
  double sum[9] = {0.0}, F_inc[9], q[9], r[9], back[9], v[9], e[9];
  for (int n = 0; n < 4; ++n) {
    rotation(1.0, n, 0.5 * n, 0.3 * n, q);
    rotation(0.2, 1.0, -n, 0.5, r);
    stretched(q, exp(0.1), exp(-0.05 * n), exp(0.02), v);
    stretched(q, 0.1, -0.05 * n, 0.02, e);
    multiply(v, r, F_inc);
    transpose(r, back);
    multiply(r, sum, sum);
    multiply(sum, back, sum);
    step(context, &p, F_inc);
    ck_umat_sym(last.stran, sum, 2.0, 1e-14);
    for (int k = 0; k < 9; ++k) sum[k] += e[k];
    for (int k = 0; k < 6; ++k) ck_near(p.state[3 + k], (k < 3 ? 1.0 : 2.0) * sum[of_library[k]], 1e-14);
    ck_assert_int_eq(last.kinc, n + 1);
    for (int k = 0; k < 36; ++k) ck_near(last.ddsdde[k], 0.0, 0.0); /* whatever it wrote the last time */
    ck_near(p.state[9], n + 1.0, 0.0);
    ck_near(p.state[2], 30.0 * (n + 1), 0.0);
  }
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Increments of any size, and the digits of tiny ones, which L has and F_inc has not. */
START_TEST(logarithm) {
  static const double sizes[] = {1e-14, 1e-9, 1e-4, 0.03, 0.3, 1.2, 3.0};
  mpm_context *context = context_of(1);
  mpm_material *material = recorded(context, 0);
  uint64_t seed = 11;
  for (int i = 0; i < 70; ++i) {
    const double size = sizes[i % 7], a = uniform(&seed, -size, size), b = uniform(&seed, -size, size);
    const int turns = i / 7 % 2;
    double q[9], r[9], L[9], log_v[9], F_inc[9], stress[6] = {0.0}, state[4] = {0.0};
    rotation(uniform(&seed, -1, 1), uniform(&seed, -1, 1), 1.0, uniform(&seed, -3, 3), q);
    rotation(uniform(&seed, -1, 1), uniform(&seed, -1, 1), 1.0, turns ? uniform(&seed, -3, 3) : 0.0, r);
    stretched(q, expm1(a), expm1(b), expm1(size), L);
    stretched(q, a, b, size, log_v);
    for (int k = 0; k < 9; ++k) F_inc[k] = L[k] + (k % 4 ? 0.0 : 1.0);
    multiply(F_inc, r, F_inc);
    mpm_material_batch batch = {.struct_size = sizeof batch, .state_count = 4, .n = 1, .ld = 1, .dt = 1.0};
    batch.F = batch.F_inc = F_inc, batch.L = turns ? NULL : L;
    batch.stress = batch.stress_new = stress, batch.state = batch.state_new = state;
    ck_ok(context, mpm_material_update(material, &batch, NULL, NULL));
    ck_umat_sym(last.dstran, log_v, 2.0, 4e-15 * (turns ? 1.0 + size : size) * exp(2.0 * size));
    ck_columns(last.drot, r, 3e-15 * exp(2.0 * size));
  }
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- laws beside those built in ---------------------------------------------------------------------- */
static mpm_material *j2_of(mpm_context *context, int32_t differenced) {
  static double props[4];
  props[0] = E, props[1] = nu, props[2] = yield, props[3] = hardening;
  mpm_umat_desc d = umat_desc(density, 4, props, 1);
  mpm_material *material;
  d.differenced = differenced;
  ck_ok(context, mpm_umat_material(context, umat_j2_, &d, &material));
  return material;
}

static mpm_material *built_in_j2(mpm_context *context) {
  const mpm_param params[] = {
      {"E", E}, {"nu", nu}, {"density", density}, {"yield_stress", yield}, {"hardening", hardening}};
  mpm_material *material;
  ck_ok(context, mpm_material_create(context, "j2", params, 5, &material));
  return material;
}

START_TEST(j2_paths) {
  static const double sizes[] = {1e-4, 1e-3, 1e-2, 0.1};
  mpm_context *context = context_of(1);
  mpm_material *material = j2_of(context, 0), *built_in = built_in_j2(context);
  uint64_t seed = 5;
  for (int path = 0; path < 40; ++path) {
    point p = point_of(material, 2), q = point_of(built_in, 1);
    for (int n = 0; n < 50; ++n) {
      double F_inc[9], most = 0.0;
      random_increment(&seed, sizes[path % 4], F_inc);
      const double J = p.F[0] * (p.F[4] * p.F[8] - p.F[5] * p.F[7]) -
                       p.F[1] * (p.F[3] * p.F[8] - p.F[5] * p.F[6]) +
                       p.F[2] * (p.F[3] * p.F[7] - p.F[4] * p.F[6]);
      if (J < 0.3 || J > 3.0) break;
      step(context, &p, F_inc);
      step(context, &q, F_inc);
      for (int k = 0; k < 6; ++k) most = fmax(most, fabs(q.stress[k]));
      for (int k = 0; k < 6; ++k) ck_near(p.stress[k], q.stress[k], 1e-12 * most + 1e-4);
      ck_near(p.state[0], q.state[0], 1e-12 * (1.0 + q.state[0]));
      ck_near(p.wave_speed, q.wave_speed, 1e-12 * q.wave_speed); /* the modulus that the UMAT was asked for */
    }
  }
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_material_destroy(built_in));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* DDSDDE gives the tangent of the rates: in small increments it is that of the differences, with stresses
 * that are not small beside the moduli. */
static void ck_tangent(mpm_context *context, const mpm_material *material, const mpm_material *differenced,
                       int32_t states, uint64_t seed, double pressure, double off) {
  for (int trial = 0; trial < 20; ++trial) {
    point p = point_of(material, states), q;
    double F_inc[9], most = 0.0;
    for (int k = 0; k < 6; ++k) p.stress[k] = uniform(&seed, -0.3, 0.3) * pressure - (k < 3 ? pressure : 0.0);
    random_increment(&seed, 1e-5, F_inc);
    q = p;
    q.material = differenced;
    ck_ok(context, try_step(context, &p, F_inc, 1));
    ck_ok(context, try_step(context, &q, F_inc, 1));
    for (int k = 0; k < 81; ++k) most = fmax(most, fabs(q.tangent[k]));
    for (int k = 0; k < 81; ++k) ck_near(p.tangent[k], q.tangent[k], off * most);
  }
}

START_TEST(tangents) {
  mpm_context *context = context_of(1);
  mpm_material *material = j2_of(context, 0), *differenced = j2_of(context, 1);
  ck_tangent(context, material, differenced, 2, 7, 0.0, 1e-4); /* elastic, and no stress in it */
  ck_tangent(context, material, differenced, 2, 8, 4e9, 1e-4); /* yields; the stress is seen */
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_material_destroy(differenced));
  const double soil[5] = {2e7, 0.3, 1.2, 0.4, 5e3};
  mpm_umat_desc d = umat_desc(2000.0, 5, soil, 1);
  ck_ok(context, mpm_umat_material(context, umat_drucker_prager_, &d, &material));
  d.differenced = 1;
  ck_ok(context, mpm_umat_material(context, umat_drucker_prager_, &d, &differenced));
  ck_tangent(context, material, differenced, 2, 9, 3e6, 2e-4);
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_material_destroy(differenced));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* With "kirchhoff" the volume's term is that of the UMAT, and the tangent of a symmetric DDSDDE is
 * symmetric. */
START_TEST(tangent_of_kirchhoff) {
  mpm_context *context = context_of(1);
  const double props[2] = {E, nu};
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  mpm_material *cauchy, *kirchhoff;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, &d, &cauchy));
  d.kirchhoff = 1;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, &d, &kirchhoff));
  point p = point_of(cauchy, 1), q = point_of(kirchhoff, 1);
  const double F_inc[9] = {1.1, 0.02, 0.0, 0.01, 0.9, 0.03, -0.05, 0.0, 1.2};
  ck_ok(context, try_step(context, &p, F_inc, 1));
  ck_ok(context, try_step(context, &q, F_inc, 1));
  const double J = 1.1 * (0.9 * 1.2) - 0.02 * (0.01 * 1.2 + 0.03 * 0.05);
  static const int sym[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
  for (int ij = 0; ij < 9; ++ij)
    for (int kl = 0; kl < 9; ++kl) {
      const double volume = kl % 4 ? 0.0 : J * p.stress[sym[ij]];
      ck_near(p.tangent[9 * ij + kl] - q.tangent[9 * ij + kl], volume, 1e-15 * 1e11 * 4);
      ck_near(q.tangent[9 * ij + kl], q.tangent[9 * kl + ij], 1e-15 * 1e11 * 4);
    }
  ck_assert_int_eq(p.symmetric, 0);
  ck_assert_int_eq(q.symmetric, 1);
  ck_ok(context, mpm_material_destroy(cauchy));
  /* a UMAT whose DDSDDE is not symmetric: the recorder's */
  mpm_material *unsymmetric;
  d = umat_desc(density, 2, props_0, 3);
  d.kirchhoff = 1;
  d.wave_modulus = 1e9;
  ck_ok(context, mpm_umat_material(context, recorder, &d, &unsymmetric));
  point s = point_of(unsymmetric, 4);
  ck_ok(context, try_step(context, &s, F_inc, 1));
  ck_assert_int_eq(s.symmetric, 0);
  ck_near(s.tangent[9 * 0 + 4], J * 106.0, 1e-10);                             /* xx yy: DDSDDE(1,2) */
  ck_near(s.tangent[9 * 0 + 1], J * (118.0 - 0.5 * s.stress[3] * 2.0), 1e-10); /* xx xy: DDSDDE(1,4) */
  ck_near(s.tangent[9 * 8 + 5], J * (132.0 - s.stress[4]), 1e-10);             /* zz yz: DDSDDE(3,6) */
  ck_ok(context, mpm_material_destroy(unsymmetric));
  ck_ok(context, mpm_material_destroy(kirchhoff));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* A tensor among the states, which the UMAT turns with DROT by ROTSIG: what an observer sees who turns is the
 * same. */
START_TEST(tensor_states_turn) {
  mpm_context *context = context_of(1);
  const double props[4] = {E, nu, yield, 20e9};
  mpm_umat_desc d = umat_desc(density, 4, props, 6);
  mpm_material *material;
  ck_ok(context, mpm_umat_material(context, umat_kinematic_, &d, &material));
  point p = point_of(material, 7), q = point_of(material, 7);
  uint64_t seed = 13;
  double observer[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int n = 0; n < 30; ++n) {
    double F_inc[9], turn[9], next[9], back[9], other[9], full[9], backstress[9];
    random_increment(&seed, 0.02, F_inc);
    rotation(1.0, 0.3 * n, -2.0, 0.2, turn);
    multiply(turn, observer, next);
    transpose(observer, back);
    multiply(next, F_inc, other);
    multiply(other, back, other);
    step(context, &p, F_inc);
    step(context, &q, other);
    memcpy(observer, next, sizeof next);
    transpose(observer, back);
    static const int sym[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2}, umat[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
    for (int k = 0; k < 9; ++k) full[k] = p.stress[sym[k]], backstress[k] = p.state[umat[k]];
    multiply(observer, full, full);
    multiply(full, back, full);
    multiply(observer, backstress, backstress);
    multiply(backstress, back, backstress);
    for (int k = 0; k < 9; ++k) {
      ck_near(q.stress[sym[k]], full[k], 1e-12 * 1e11);
      ck_near(q.state[umat[k]], backstress[k], 1e-12 * 1e11);
    }
  }
  double most = 0.0;
  for (int k = 0; k < 6; ++k) most = fmax(most, fabs(p.state[k]));
  ck_assert(most > 1e8); /* there was a back stress to turn */
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* The library's law is elastic in the whole logarithmic strain and yields in Kirchhoff stress, the UMAT in
 * rates of the Cauchy stress. As long as the axes stay, and only then, the UMAT does to its stress exactly
 * what the library does to J times its own. */
START_TEST(drucker_prager_on_fixed_axes) {
  mpm_context *context = context_of(1);
  const double phi = 30.0, psi = 10.0, c = 5e3, radians = acos(-1.0) / 180.0;
  const double sp = sin(phi * radians), ss = sin(psi * radians), cp = cos(phi * radians);
  const double props[5] = {2e7, 0.3, 6.0 * sp / (3.0 - sp), 6.0 * ss / (3.0 - ss), c * 6.0 * cp / (3.0 - sp)};
  mpm_umat_desc d = umat_desc(2000.0, 5, props, 1);
  const mpm_param params[] = {{"E", 2e7},   {"nu", 0.3},     {"density", 2000.0}, {"phi", phi},
                              {"psi", psi}, {"cohesion", c}, {"close_gaps", 0}};
  mpm_material *material, *built_in;
  ck_ok(context, mpm_umat_material(context, umat_drucker_prager_, &d, &material));
  ck_ok(context, mpm_material_create(context, "drucker_prager", params, 7, &built_in));
  uint64_t seed = 17;
  int yields = 0, apex = 0;
  for (int path = 0; path < 20; ++path) {
    point p = point_of(material, 2), q = point_of(built_in, 2);
    double axes[9], most = 1.0;
    rotation(uniform(&seed, -1, 1), 1.0, uniform(&seed, -1, 1), uniform(&seed, -3, 3), axes);
    for (int n = 0; n < 40; ++n) {
      double F_inc[9];
      const double squeeze = path % 2 ? -2e-4 : 2e-4,
                   e[3] = {uniform(&seed, -2e-3, 2e-3), uniform(&seed, -2e-3, 2e-3),
                           uniform(&seed, -2e-3, 2e-3) + squeeze};
      stretched(axes, exp(e[0]), exp(e[1]), exp(e[2]), F_inc);
      const double before = p.state[0];
      step(context, &p, F_inc);
      step(context, &q, F_inc);
      double J = q.F[0] * (q.F[4] * q.F[8] - q.F[5] * q.F[7]) - q.F[1] * (q.F[3] * q.F[8] - q.F[5] * q.F[6]) +
                 q.F[2] * (q.F[3] * q.F[7] - q.F[4] * q.F[6]);
      for (int k = 0; k < 6; ++k) most = fmax(most, fabs(p.stress[k]));
      for (int k = 0; k < 6; ++k) ck_near(p.stress[k], J * q.stress[k], 1e-12 * most);
      ck_near(p.state[0], q.state[0], 1e-12);
      yields += p.state[0] > before;
      apex += fabs(p.stress[0] - p.stress[1]) < 1e-6 && p.stress[0] > 0.0;
    }
  }
  ck_assert_int_gt(yields, 200);
  ck_assert_int_gt(apex, 20);
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_material_destroy(built_in));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- utility routines -------------------------------------------------------------------------------- */
void rotsig_(const double *, const double *, double *, const int *, const int *, const int *);
void sprinc_(const double *, double *, const int *, const int *, const int *);
void sprind_(const double *, double *, double *, const int *, const int *, const int *);
void sinv_(const double *, double *, double *, const int *, const int *);

START_TEST(utilities) {
  double q[9], full[9], columns[9], s[6], turned[6], value[3], direction[9], mean, mises;
  const int three = 3, one = 1, two = 2;
  rotation(1.0, 2.0, -0.5, 0.9, q);
  stretched(q, 5.0, -3.0, 2.0, full);
  for (int k = 0; k < 6; ++k) s[k] = full[of_umat[k]];
  sprinc_(s, value, &one, &three, &three);
  ck_assert(fabs(value[0] - 5.0) < 1e-14 && fabs(value[1] - 2.0) < 1e-14 && fabs(value[2] + 3.0) < 1e-14);
  sprind_(s, value, direction, &one, &three, &three);
  static const int column[3] = {0, 2, 1};
  for (int k = 0; k < 3; ++k) {
    double along = 0.0;
    for (int i = 0; i < 3; ++i) along += direction[k + 3 * i] * q[3 * i + column[k]];
    ck_near(fabs(along), 1.0, 1e-14);
  }
  for (int k = 3; k < 6; ++k) s[k] *= 2.0; /* a strain */
  sprinc_(s, value, &two, &three, &three);
  ck_assert(fabs(value[0] - 5.0) < 1e-14 && fabs(value[2] + 3.0) < 1e-14);
  transpose(q, columns); /* by columns it is q */
  const double axes[6] = {5.0, -3.0, 2.0, 0.0, 0.0, 0.0};
  rotsig_(axes, columns, turned, &two, &three, &three);
  for (int k = 0; k < 6; ++k) ck_near(turned[k], s[k], 1e-14);
  rotsig_(axes, columns, turned, &one, &three, &three);
  ck_umat_sym(turned, full, 1.0, 1e-14);
  sinv_(turned, &mean, &mises, &three, &three);
  ck_near(mean, 4.0 / 3.0, 1e-14);
  ck_near(mises, sqrt(0.5 * (64.0 + 25.0 + 9.0)), 1e-13);
  const double plane[4] = {1.0, 2.0, 3.0, 2.0}; /* 11 22 33 12 */
  sprinc_(plane, value, &one, &three, &one);
  ck_near(value[0], 1.5 + sqrt(4.25), 1e-14);
}
END_TEST

TCase *element_case(void) {
  TCase *tcase = tcase_create("element");
  tcase_add_test(tcase, arguments);
  tcase_add_test(tcase, many_items);
  tcase_add_test(tcase, total_strain);
  tcase_add_test(tcase, logarithm);
  tcase_add_test(tcase, j2_paths);
  tcase_add_test(tcase, tangents);
  tcase_add_test(tcase, tangent_of_kirchhoff);
  tcase_add_test(tcase, tensor_states_turn);
  tcase_add_test(tcase, drucker_prager_on_fixed_axes);
  tcase_add_test(tcase, utilities);
  return tcase;
}
