/* VUMATs: what they are given, in the frame that turns with R of F = R U, and laws beside others. */
#include "umat_test.h"

static const double E = 70e9, nu = 0.3, density = 2700.0, yield = 300e6, hardening = 1e9;

/* ---- what the subroutine is given -------------------------------------------------------------------- */
enum { BLOCKS = 8 };
static struct {
  int calls, nblock[BLOCKS];
  double strain_inc[6], spin[3], stretch_old[6], stretch_new[6], F_old[9], F_new[9], stress_old[6],
      state_old[2];
  double step_time, total_time, dt, density, celent, temperature, coords[3], props[1];
  int ndir, nshr, nstatev, nfieldv, nprops, lanneal;
  char cmname[80];
} last;

/* Of the last particle of a block; answers with 1 ... 6 and the state plus 1. */
static void recorder(const int *nblock, const int *ndir, const int *nshr, const int *nstatev,
                     const int *nfieldv, const int *nprops, const int *lanneal, const double *step_time,
                     const double *total_time, const double *dt, const char *cmname, const double *coord_mp,
                     const double *char_length, const double *props, const double *rho,
                     const double *strain_inc, const double *rel_spin_inc, const double *temp_old,
                     const double *stretch_old, const double *defgrad_old, const double *field_old,
                     const double *stress_old, const double *state_old, const double *ener_intern_old,
                     const double *ener_inelas_old, const double *temp_new, const double *stretch_new,
                     const double *defgrad_new, const double *field_new, double *stress_new,
                     double *state_new, double *ener_intern_new, double *ener_inelas_new,
                     size_t cmname_length) {
  const int n = *nblock, k = n - 1;
  (void)field_old, (void)field_new;
  ck_assert(ener_intern_old[k] == 0.0 && ener_inelas_old[k] == 0.0 && temp_new[k] == temp_old[k]);
  ck_assert_uint_eq(cmname_length, 80);
  last.nblock[last.calls++ % BLOCKS] = n;
  for (int c = 0; c < 6; ++c) {
    last.strain_inc[c] = strain_inc[c * n + k], last.stress_old[c] = stress_old[c * n + k];
    last.stretch_old[c] = stretch_old[c * n + k], last.stretch_new[c] = stretch_new[c * n + k];
  }
  for (int c = 0; c < 9; ++c) last.F_old[c] = defgrad_old[c * n + k], last.F_new[c] = defgrad_new[c * n + k];
  for (int c = 0; c < 3; ++c) last.spin[c] = rel_spin_inc[c * n + k], last.coords[c] = coord_mp[c * n + k];
  for (int c = 0; c < *nstatev; ++c) last.state_old[c] = state_old[c * n + k];
  last.step_time = *step_time, last.total_time = *total_time, last.dt = *dt, last.density = rho[k];
  last.celent = char_length[k], last.temperature = temp_old[k], last.props[0] = props[0];
  last.ndir = *ndir, last.nshr = *nshr, last.nstatev = *nstatev, last.nfieldv = *nfieldv;
  last.nprops = *nprops, last.lanneal = *lanneal;
  memcpy(last.cmname, cmname, sizeof last.cmname);
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 6; ++c) stress_new[c * n + i] = c + 1.0;
    for (int c = 0; c < *nstatev; ++c) state_new[c * n + i] = state_old[c * n + i] + 1.0;
    ener_intern_new[i] = ener_inelas_new[i] = 1.0;
  }
}

static const int row[9] = {0, 1, 2, 0, 1, 2, 1, 2, 0}, column[9] = {0, 1, 2, 1, 2, 0, 0, 1, 2};
static const int of_library[6] = {0, 4, 8, 1, 5, 2};

static void ck_sym(const double *vumat, const double *full, double off) {
  for (int k = 0; k < 6; ++k) ck_near(vumat[k], full[3 * row[k] + column[k]], off);
}

START_TEST(arguments) {
  mpm_context *context = context_of(1);
  const double props[1] = {7.0}, initial[2] = {1.0, 2.0};
  mpm_umat_desc d = umat_desc(density, 1, props, 2);
  mpm_material *material;
  d.statev_initial = initial, d.cmname = "FOAM", d.celent = 0.25, d.temperature = 300.0, d.wave_modulus = 1e9;
  d.dim = 3;
  memset(&last, 0, sizeof last);
  ck_ok(context, mpm_vumat_material(context, recorder, &d, &material));
  ck_assert_int_eq(last.calls, 0);
  /* F_old = R0 U0, F = R1 U1, F_inc = V R_inc */
  double q[9], r0[9], r1[9], u0[9], u1[9], F0[9], F1[9], inverse[9], F_inc[9], back[9], full[9], seen[9];
  double stress[6], J0 = 1.2 * 0.9 * 1.1, J1 = 1.3 * 0.95 * 1.0;
  uint64_t seed = 2;
  rotation(1.0, -2.0, 0.5, 0.7, q);
  rotation(0.3, 0.2, 1.0, -0.4, r0);
  rotation(0.3, 0.3, 1.0, -0.5, r1);
  stretched(q, 1.2, 0.9, 1.1, u0);
  stretched(q, 1.3, 0.95, 1.0, u1);
  multiply(r0, u0, F0);
  multiply(r1, u1, F1);
  stretched(q, 1.0 / 1.2, 1.0 / 0.9, 1.0 / 1.1, inverse);
  transpose(r0, back);
  multiply(inverse, back, inverse);
  multiply(F1, inverse, F_inc);
  for (int k = 0; k < 6; ++k) full[of_library[k]] = stress[k] = uniform(&seed, -1e8, 1e8);
  full[3] = full[1], full[6] = full[2], full[7] = full[5];
  const double position[3] = {0.1, 0.2, 0.3}, state[3] = {5.0, 6.0, 4.0};
  double stress_new[6], state_new[3], wave_speed;
  mpm_material_batch b = {.struct_size = sizeof b, .state_count = 3, .n = 1, .ld = 1, .t = 5.0, .dt = 0.5};
  b.F = F1, b.F_inc = F_inc, b.stress = stress, b.state = state, b.stress_new = stress_new;
  b.state_new = state_new, b.position = position, b.wave_speed = &wave_speed;
  ck_ok(context, mpm_material_update(material, &b, NULL, NULL));
  ck_assert_int_eq(last.calls, 1);
  for (int k = 0; k < 9; ++k) {
    ck_near(last.F_old[k], F0[3 * row[k] + column[k]], 1e-15 * 4);
    ck_near(last.F_new[k], F1[3 * row[k] + column[k]], 0.0);
  }
  ck_sym(last.stretch_old, u0, 4e-15);
  ck_sym(last.stretch_new, u1, 4e-15);
  multiply(back, full, seen);
  multiply(seen, r0, seen);
  ck_sym(last.stress_old, seen, 1e-6);
  /* U1 and U0 have one set of axes: R_inc = R1 R0^T, nothing turns beside R, ln V is that of the stretches */
  stretched(q, log(1.3 / 1.2), log(0.95 / 0.9), log(1.0 / 1.1), full);
  ck_sym(last.strain_inc, full, 1e-15);
  for (int k = 0; k < 3; ++k) ck_near(last.spin[k], 0.0, 2e-15);
  for (int k = 0; k < 3; ++k) ck_near(last.coords[k], position[k], 0.0);
  ck_near(last.density, density / J1, 1e-12 * density);
  ck_near(wave_speed, sqrt(1e9 * J1 / density), 1e-12 * wave_speed);
  ck_assert(J0 > 0.0 && last.step_time == 5.0 && last.total_time == 5.0 && last.dt == 0.5);
  ck_assert(last.celent == 0.25 && last.temperature == 300.0 && last.props[0] == 7.0);
  ck_assert(last.ndir == 3 && last.nshr == 3 && last.nstatev == 2 && !last.nfieldv && last.nprops == 1 &&
            !last.lanneal);
  ck_assert(last.state_old[0] == 5.0 && last.state_old[1] == 6.0);
  ck_assert(state_new[0] == 6.0 && state_new[1] == 7.0 && state_new[2] == 5.0);
  ck_assert_int_eq(memcmp(last.cmname, "FOAM    ", 8), 0);
  const double answer[9] = {1, 4, 6, 4, 2, 5, 6, 5, 3};
  transpose(r1, back);
  multiply(r1, answer, seen);
  multiply(seen, back, seen);
  for (int k = 0; k < 6; ++k) ck_near(stress_new[k], seen[of_library[k]], 1e-14);
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* A small shear after a stretch: R lags behind the rotation of the step by half of what the lengths make of
 * it. */
START_TEST(relative_spin) {
  mpm_context *context = context_of(1);
  const double props[1] = {7.0}, a = 1.5, by = 1e-6;
  mpm_umat_desc d = umat_desc(density, 1, props, 0);
  mpm_material *material;
  d.wave_modulus = 1e9;
  ck_ok(context, mpm_vumat_material(context, recorder, &d, &material));
  for (int axis = 0; axis < 3; ++axis) { /* 12, 23, 31 */
    const int i = axis, j = (axis + 1) % 3;
    point p = point_of(material, 1);
    double F_inc[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    F_inc[4 * i] = a; /* the stretch */
    step(context, &p, F_inc);
    F_inc[4 * i] = 1.0;
    F_inc[3 * i + j] = by;
    step(context, &p, F_inc);
    /* W_ij = by/2. Of R U = I + ... : W - dR R^T = (U dU - dU U)/... = by/2 (1 - 2/(1 + a)) with U = diag(a,
     * 1) */
    const double wanted = 0.5 * by - by / (1.0 + a);
    for (int c = 0; c < 3; ++c) ck_near(last.spin[c], c == axis ? wanted : 0.0, 1e-11);
  }
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Blocks hold particles alone, and all of them. */
START_TEST(blocks) {
  enum { N = 75 };
  mpm_context *context = context_of(1);
  const double props[1] = {7.0};
  mpm_umat_desc d = umat_desc(density, 1, props, 0);
  mpm_material *material;
  d.wave_modulus = 1e9;
  memset(&last, 0, sizeof last);
  ck_ok(context, mpm_vumat_material(context, recorder, &d, &material));
  static double F[9 * N], stress[6 * N], state[N];
  static int64_t id[N];
  for (int i = 0; i < N; ++i) {
    id[i] = i % 15 == 4 ? -1 : i;
    for (int k = 0; k < 9; k += 4) F[k * N + i] = 1.0;
  }
  mpm_material_batch b = {.struct_size = sizeof b, .state_count = 1, .n = N, .ld = N, .t = 1.0, .dt = 1.0};
  b.id = id, b.F = F, b.F_inc = F, b.stress = b.stress_new = stress, b.state = b.state_new = state;
  ck_ok(context, mpm_material_update(material, &b, NULL, NULL));
  ck_assert(last.calls == 3 && last.nblock[0] == 32 && last.nblock[1] == 32 && last.nblock[2] == 6);
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 6 && id[i] >= 0; ++k) ck_near(stress[k * N + i], k + 1.0, 1e-14);
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Six springs, of which one is the stiffest: of normal strain along that axis, of shear half-way between two,
 * where a quarter of each of theirs comes to it. */
static int stiffest;
static void springs(const int *nblock, const int *ndir, const int *nshr, const int *nstatev,
                    const int *nfieldv, const int *nprops, const int *lanneal, const double *step_time,
                    const double *total_time, const double *dt, const char *cmname, const double *coord_mp,
                    const double *char_length, const double *props, const double *rho,
                    const double *strain_inc, const double *rel_spin_inc, const double *temp_old,
                    const double *stretch_old, const double *defgrad_old, const double *field_old,
                    const double *stress_old, const double *state_old, const double *ener_intern_old,
                    const double *ener_inelas_old, const double *temp_new, const double *stretch_new,
                    const double *defgrad_new, const double *field_new, double *stress_new, double *state_new,
                    double *ener_intern_new, double *ener_inelas_new, size_t cmname_length) {
  (void)ndir, (void)nshr, (void)nstatev, (void)nfieldv, (void)nprops, (void)lanneal, (void)dt, (void)cmname;
  (void)coord_mp, (void)char_length, (void)props, (void)rho, (void)rel_spin_inc, (void)temp_old;
  (void)stretch_old, (void)defgrad_old, (void)field_old, (void)state_old, (void)ener_intern_old;
  (void)ener_inelas_old, (void)temp_new, (void)stretch_new, (void)defgrad_new, (void)field_new;
  (void)state_new, (void)ener_intern_new, (void)ener_inelas_new, (void)cmname_length;
  ck_assert(*step_time == 0.0 && *total_time == 0.0 && *nblock == 6);
  for (int c = 0; c < 6; ++c)
    for (int k = 0; k < *nblock; ++k)
      stress_new[c * *nblock + k] = stress_old[c * *nblock + k] + (c == stiffest ? 5e9 : 1e9) *
                                                                      (c < 3 ? 1.0 : 2.0) *
                                                                      strain_inc[c * *nblock + k];
}

START_TEST(largest_modulus) {
  mpm_context *context = context_of(1);
  const double props[1] = {7.0};
  mpm_umat_desc d = umat_desc(density, 1, props, 1);
  for (stiffest = 0; stiffest < 6; ++stiffest) {
    mpm_material *material;
    ck_ok(context, mpm_vumat_material(context, springs, &d, &material));
    double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, stress[6] = {0.0}, state[2] = {0.0}, wave_speed;
    mpm_material_batch b = {.struct_size = sizeof b, .state_count = 2, .n = 1, .ld = 1};
    b.F = b.F_inc = F, b.stress = b.stress_new = stress, b.state = b.state_new = state;
    b.wave_speed = &wave_speed;
    ck_ok(context, mpm_material_update(material, &b, NULL, NULL));
    ck_near(wave_speed, sqrt((stiffest < 3 ? 5e9 : 5.5e9) / density), 1e-9 * wave_speed);
    ck_ok(context, mpm_material_destroy(material));
  }
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- laws beside others ------------------------------------------------------------------------------ */
static mpm_material *j2_of(mpm_context *context) {
  const double props[4] = {E, nu, yield, hardening};
  mpm_umat_desc d = umat_desc(density, 4, props, 1);
  mpm_material *material;
  ck_ok(context, mpm_vumat_material(context, vumat_j2_, &d, &material));
  return material;
}

static double misses(double xx, double yy, double zz, double xy) {
  return sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) + 3.0 * xy * xy);
}

/* Turns xx yy xy in the plane. */
static void turn(double angle, double *s) {
  const double c = cos(angle), i = sin(angle), xx = s[0], yy = s[1], xy = s[3];
  s[0] = c * c * xx + i * i * yy - 2.0 * c * i * xy;
  s[1] = i * i * xx + c * c * yy + 2.0 * c * i * xy;
  s[3] = c * i * (xx - yy) + (c * c - i * i) * xy;
}

static double angle_of(const double *F) {
  return atan2(F[3] - F[1], F[0] + F[4]);
}

/* Von Mises in the frame that turns with R, in the plane and in closed form; stress xx yy zz xy. */
static void reference(const double *F0, const double *F1, const double *F_inc, double *stress,
                      double *plastic) {
  const double mu = 0.5 * E / (1.0 + nu), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
  const double bxx = F_inc[0] * F_inc[0] + F_inc[1] * F_inc[1],
               byy = F_inc[3] * F_inc[3] + F_inc[4] * F_inc[4];
  const double bxy = F_inc[0] * F_inc[3] + F_inc[1] * F_inc[4], half = 0.5 * atan2(2.0 * bxy, bxx - byy);
  const double mean = 0.5 * (bxx + byy), radius = hypot(0.5 * (bxx - byy), bxy);
  double e[4] = {0.5 * log(mean + radius), 0.5 * log(mean - radius), 0.0, 0.0};
  turn(half, e);
  turn(-angle_of(F1), e);
  turn(-angle_of(F0), stress);
  for (int k = 0; k < 4; ++k) stress[k] += 2.0 * mu * e[k] + (k < 3 ? lambda * (e[0] + e[1]) : 0.0);
  const double q = misses(stress[0], stress[1], stress[2], stress[3]),
               over = q - yield - hardening * *plastic;
  if (over > 0.0) {
    const double more = over / (3.0 * mu + hardening), p = (stress[0] + stress[1] + stress[2]) / 3.0;
    *plastic += more;
    for (int k = 0; k < 4; ++k)
      stress[k] = (1.0 - 3.0 * mu * more / q) * (stress[k] - (k < 3 ? p : 0.0)) + (k < 3 ? p : 0.0);
  }
  turn(angle_of(F1), stress);
}

START_TEST(j2_in_the_plane) {
  mpm_context *context = context_of(1);
  mpm_material *material = j2_of(context);
  uint64_t seed = 4;
  double furthest = 0.0;
  for (int path = 0; path < 20; ++path) {
    point p = point_of(material, 2);
    double stress[4] = {0.0}, plastic = 0.0;
    for (int n = 0; n < 40; ++n) {
      double F_inc[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, F0[9], most = 1.0;
      F_inc[0] += uniform(&seed, -0.02, 0.02), F_inc[1] += uniform(&seed, -0.01, 0.05);
      F_inc[3] += uniform(&seed, -0.01, 0.01), F_inc[4] += uniform(&seed, -0.02, 0.02);
      memcpy(F0, p.F, sizeof F0);
      step(context, &p, F_inc);
      reference(F0, p.F, F_inc, stress, &plastic);
      for (int k = 0; k < 4; ++k) most = fmax(most, fabs(stress[k]));
      for (int k = 0; k < 4; ++k) ck_near(p.stress[k], stress[k], 2e-12 * most);
      ck_near(p.stress[4], 0.0, 1e-12 * most);
      ck_near(p.state[0], plastic, 1e-12);
      ck_near(p.state[1], n + 1.0, 0.0);
      furthest = fmax(furthest, fabs(angle_of(p.F)));
    }
  }
  ck_assert(furthest > 0.3); /* R has turned */
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Axes of stretch that are fixed in the material, under rotations of any size: both frames turn alike, and
 * the VUMAT is the j2 that is built in. */
START_TEST(j2_built_in) {
  mpm_context *context = context_of(1);
  const mpm_param params[] = {
      {"E", E}, {"nu", nu}, {"density", density}, {"yield_stress", yield}, {"hardening", hardening}};
  mpm_material *material = j2_of(context), *built_in;
  ck_ok(context, mpm_material_create(context, "j2", params, 5, &built_in));
  uint64_t seed = 6;
  for (int path = 0; path < 10; ++path) {
    point p = point_of(material, 2), q = point_of(built_in, 1);
    double axes[9], observer[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    rotation(uniform(&seed, -1, 1), 1.0, uniform(&seed, -1, 1), uniform(&seed, -3, 3), axes);
    for (int n = 0; n < 40; ++n) {
      double v[9], r[9], next[9], back[9], F_inc[9], most = 1.0;
      stretched(axes, 1.0 + uniform(&seed, -0.02, 0.02), 1.0 + uniform(&seed, -0.02, 0.02),
                1.0 + uniform(&seed, -0.02, 0.02), v);
      rotation(uniform(&seed, -1, 1), uniform(&seed, -1, 1), 1.0, 0.2, r);
      multiply(r, observer, next);
      transpose(observer, back);
      multiply(next, v, F_inc);
      multiply(F_inc, back, F_inc);
      memcpy(observer, next, sizeof next);
      step(context, &p, F_inc);
      step(context, &q, F_inc);
      for (int k = 0; k < 6; ++k) most = fmax(most, fabs(q.stress[k]));
      for (int k = 0; k < 6; ++k) ck_near(p.stress[k], q.stress[k], 2e-12 * most);
      ck_near(p.state[0], q.state[0], 1e-12);
      ck_near(p.wave_speed, q.wave_speed, 1e-9 * q.wave_speed); /* of stresses at strains of 1e-6 */
    }
  }
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_material_destroy(built_in));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* A hyperelastic law by stretchNew beside the one built in, on any path: no frame makes a difference. */
START_TEST(neo_hookean) {
  mpm_context *context = context_of(1);
  const double props[3] = {1e6, 0.3, 1e3};
  const mpm_param params[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}};
  mpm_umat_desc d = umat_desc(1e3, 3, props, 0);
  mpm_material *material, *built_in;
  ck_ok(context, mpm_vumat_material(context, vumat_neo_hookean_, &d, &material));
  ck_ok(context, mpm_material_create(context, "neo_hookean", params, 3, &built_in));
  uint64_t seed = 8;
  for (int path = 0; path < 20; ++path) {
    point p = point_of(material, 1), q = point_of(built_in, 0);
    for (int n = 0; n < 5; ++n) {
      double F_inc[9], most = 1.0;
      random_increment(&seed, 0.2, F_inc);
      step(context, &p, F_inc);
      step(context, &q, F_inc);
      for (int k = 0; k < 6; ++k) most = fmax(most, fabs(q.stress[k]));
      for (int k = 0; k < 6; ++k) ck_near(p.stress[k], q.stress[k], 1e-12 * most);
    }
    /* the tangent is that of differences */
    double F_inc[9], most = 0.0;
    random_increment(&seed, 0.05, F_inc);
    ck_ok(context, try_step(context, &p, F_inc, 1));
    ck_ok(context, try_step(context, &q, F_inc, 1));
    for (int k = 0; k < 81; ++k) most = fmax(most, fabs(q.tangent[k]));
    for (int k = 0; k < 81; ++k) ck_near(p.tangent[k], q.tangent[k], 1e-8 * most);
  }
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_material_destroy(built_in));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* In 2-D and 3-D steps on four threads: the same as the law that is built in. */
START_TEST(runs) {
  const double props[3] = {1e6, 0.3, 1e3};
  const mpm_param params[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}};
  static double stress[2][6 * 4096];
  for (int32_t dim = 2; dim <= 3; ++dim) {
    int64_t n = 0;
    for (int k = 0; k < 2; ++k) {
      mpm_context *context = context_of(4);
      mpm_umat_desc d = umat_desc(1e3, 3, props, 0);
      mpm_material *material;
      mpm_grid *grid;
      mpm_particles *set;
      mpm_stepper *stepper;
      mpm_grid_desc g;
      if (k)
        ck_ok(context, mpm_material_create(context, "neo_hookean", params, 3, &material));
      else
        ck_ok(context, mpm_vumat_material(context, vumat_neo_hookean_, &d, &material));
      ck_ok(context, mpm_grid_desc_init(&g, sizeof g));
      g.dim = dim;
      for (int i = 0; i < dim; ++i) g.cells[i] = 12, g.spacing[i] = 0.1;
      ck_ok(context, mpm_grid_create(context, &g, &grid));
      ck_ok(context, mpm_particles_create(context, grid, material, &set));
      ck_ok(context,
            mpm_particles_fill_box(set, (const double[]){0.3, 0.0, 0.3}, (const double[]){0.8, 0.5, 0.7},
                                   (const int32_t[]){2, 2, 2}, NULL, &n));
      ck_assert_int_le(n, 4096);
      ck_ok(context, mpm_particles_set_all(set, "velocity", MPM_F64, dim, (const double[]){3.0, -8.0, 1.0}));
      ck_ok(context, mpm_stepper_create(context, grid, NULL, &stepper));
      ck_ok(context, mpm_stepper_add(stepper, set));
      ck_ok(context, mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
      for (int i = 0; i < 60; ++i) ck_ok(context, mpm_step(stepper, 5e-4, NULL));
      ck_ok(context, mpm_particles_get(set, "stress", MPM_F64, 6, n, NULL, stress[k]));
      ck_ok(context, mpm_stepper_destroy(stepper));
      ck_ok(context, mpm_particles_destroy(set));
      ck_ok(context, mpm_material_destroy(material));
      ck_ok(context, mpm_grid_destroy(grid));
      ck_ok(context, mpm_context_destroy(context));
    }
    double most = 0.0, apart = 0.0;
    for (int64_t i = 0; i < 6 * n; ++i) {
      most = fmax(most, fabs(stress[1][i]));
      apart = fmax(apart, fabs(stress[0][i] - stress[1][i]));
    }
    ck_assert(most > 5e4);
    ck_near(apart / most, 0.0, 1e-12);
  }
}
END_TEST

START_TEST(refusals) {
  mpm_context *context = context_of(1);
  const double props[3] = {1e6, 0.3, 0.5};
  mpm_umat_desc d = umat_desc(1e3, 3, props, 0);
  mpm_material *material;
  d.kirchhoff = 1;
  ck_assert_int_eq(mpm_vumat_material(context, vumat_neo_hookean_, &d, &material), MPM_E_UNSUPPORTED);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "kirchhoff = 1 is of UMATs"));
  d.kirchhoff = 0, d.stran = 1;
  ck_assert_int_eq(mpm_vumat_material(context, vumat_neo_hookean_, &d, &material), MPM_E_UNSUPPORTED);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "stretchNew"));
  d.stran = 0;
  ck_assert_int_eq(mpm_vumat_material(context, vumat_neo_hookean_, &d, &material), MPM_E_ARG);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "XPLB_EXIT")); /* J = 1 is beyond 0.5 */
  ck_assert_int_eq(mpm_vumat_material(context, NULL, &d, &material), MPM_E_ARG);
  ck_assert_int_eq(mpm_vumat_material(context, vumat_neo_hookean_, NULL, &material), MPM_E_ARG);
  ck_assert_int_eq(mpm_vumat_material(context, vumat_neo_hookean_, &d, NULL), MPM_E_ARG);
  d.wave_modulus = 1e6;
  ck_ok(context, mpm_vumat_material(context, vumat_neo_hookean_, &d, &material));
  point p = point_of(material, 1), before = p;
  ck_assert_int_eq(try_step(context, &p, (const double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1}, 0), MPM_E_CALLBACK);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "-1001"));
  ck_assert_int_eq(memcmp(&p.stress, &before.stress, sizeof p.stress), 0);
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

TCase *vumat_case(void) {
  TCase *tcase = tcase_create("vumat");
  tcase_set_timeout(tcase, 60);
  tcase_add_test(tcase, arguments);
  tcase_add_test(tcase, relative_spin);
  tcase_add_test(tcase, blocks);
  tcase_add_test(tcase, largest_modulus);
  tcase_add_test(tcase, j2_in_the_plane);
  tcase_add_test(tcase, j2_built_in);
  tcase_add_test(tcase, neo_hookean);
  tcase_add_test(tcase, runs);
  tcase_add_test(tcase, refusals);
  return tcase;
}
