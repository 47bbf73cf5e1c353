/* What is refused, and what becomes of a step when a subroutine does not do its part. */
#include "umat_test.h"

static const double E = 1e7, nu = 0.3, density = 1000.0;

/* ---- descriptions ------------------------------------------------------------------------------------ */
static void ck_refused(mpm_context *context, mpm_umat_fn fn, const mpm_umat_desc *d, mpm_status status,
                       const char *text) {
  mpm_material *material = (mpm_material *)(void *)&material;
  ck_assert_int_eq(mpm_umat_material(context, fn, d, &material), status);
  ck_assert_ptr_null(material);
  if (!strstr(mpm_last_error(context), text))
    ck_abort_msg("\"%s\" lacks \"%s\"", mpm_last_error(context), text);
}

static void dead_umat(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                      double *rpl, double *ddsddt, double *drplde, double *drpldt, const double *stran,
                      const double *dstran, const double *time, const double *dtime, const double *temp,
                      const double *dtemp, const double *predef, const double *dpred, const char *cmname,
                      const int *ndi, const int *nshr, const int *ntens, const int *nstatv,
                      const double *props, const int *nprops, const double *coords, const double *drot,
                      double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1,
                      const int *noel, const int *npt, const int *layer, const int *kspt, const int *jstep,
                      const int *kinc, size_t cmname_length) {
  (void)stress, (void)statev, (void)ddsdde, (void)sse, (void)spd, (void)scd, (void)rpl, (void)ddsddt;
  (void)drplde, (void)drpldt, (void)stran, (void)dstran, (void)time, (void)dtime, (void)temp, (void)dtemp;
  (void)predef, (void)dpred, (void)cmname, (void)ndi, (void)nshr, (void)ntens, (void)nstatv, (void)props;
  (void)nprops, (void)coords, (void)drot, (void)pnewdt, (void)celent, (void)dfgrd0, (void)dfgrd1, (void)noel;
  (void)npt, (void)layer, (void)kspt, (void)jstep, (void)kinc, (void)cmname_length;
}

START_TEST(descriptions) {
  mpm_context *context = context_of(1);
  double props[5] = {E, nu, 0.0, 0.0, 0.0};
  const double state[1] = {(double)NAN};
  const mpm_umat_desc good = umat_desc(density, 2, props, 1);
  mpm_umat_desc d = good;
  ck_assert(good.serial == 1 && !good.kirchhoff && !good.stran && !good.differenced && !good.statev_initial &&
            !good.cmname && good.wave_modulus == 0.0 && good.dim == 0 && !good.message);
#define REFUSED(field, value, status, text)                                                                  \
  d = good;                                                                                                  \
  d.field = value;                                                                                           \
  ck_refused(context, umat_elastic_, &d, status, text)
  REFUSED(density, 0.0, MPM_E_ARG, "density = 0 must");
  REFUSED(density, (double)NAN, MPM_E_ARG, "density = nan");
  REFUSED(nstatv, -1, MPM_E_ARG, "nstatv = -1 must be 0 to 63");
  REFUSED(nstatv, 64, MPM_E_ARG, "nstatv = 64 must be 0 to 63");
  REFUSED(nprops, -2, MPM_E_ARG, "nprops = -2");
  REFUSED(props, NULL, MPM_E_ARG, "props is NULL");
  REFUSED(dim, 4, MPM_E_ARG, "dim = 4 must be 0 to 3");
  REFUSED(serial, 2, MPM_E_ARG, "serial = 2 must be 0 or 1");
  REFUSED(kirchhoff, -1, MPM_E_ARG, "kirchhoff = -1");
  REFUSED(stran, 3, MPM_E_ARG, "stran = 3");
  REFUSED(differenced, 2, MPM_E_ARG, "differenced = 2");
  REFUSED(statev_initial, state, MPM_E_ARG, "statev_initial[0] = nan");
  REFUSED(wave_modulus, -1.0, MPM_E_ARG, "wave_modulus = -1 must");
  REFUSED(wave_modulus, (double)INFINITY, MPM_E_ARG, "wave_modulus = inf");
  REFUSED(celent, -0.5, MPM_E_ARG, "celent = -0.5");
  REFUSED(temperature, (double)INFINITY, MPM_E_ARG, "temperature = inf");
  REFUSED(struct_size, 16, MPM_E_ARG, "struct_size is 16");
  REFUSED(struct_size, 1 << 20, MPM_E_ARG, "struct_size is 1048576");
  char name[90];
  memset(name, 'x', 81);
  name[81] = '\0';
  REFUSED(cmname, name, MPM_E_ARG, "longer than 80");
  name[80] = '\0';
  d = good;
  d.cmname = name;
  mpm_material *material;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, &d, &material));
  ck_ok(context, mpm_material_destroy(material));
  d = good;
  d.nstatv = 58, d.stran = 1;
  ck_refused(context, umat_elastic_, &d, MPM_E_ARG, "nstatv = 58 must be 0 to 57 where stran is 1");
  d.nstatv = 57;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, &d, &material));
  ck_ok(context, mpm_material_destroy(material));
  ck_refused(context, NULL, &good, MPM_E_ARG, "fn is NULL");
  ck_refused(context, umat_elastic_, NULL, MPM_E_ARG, "mpm_umat_desc is NULL");
  ck_assert_int_eq(mpm_umat_material(context, umat_elastic_, &good, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_umat_material(NULL, umat_elastic_, &good, &material), MPM_E_ARG);
  props[1] = (double)INFINITY;
  ck_refused(context, umat_elastic_, &good, MPM_E_ARG, "props[1] = inf");
  /* the modulus of a UMAT that gives none, that has an infinite one, that asks for less, that leaves */
  props[1] = nu;
  ck_refused(context, dead_umat, &good, MPM_E_ARG,
             "the largest modulus of an unstressed particle is 0: give wave_modulus");
  props[1] = 0.5;
  ck_refused(context, umat_elastic_, &good, MPM_E_ARG, "give wave_modulus");
  props[1] = nu;
  d = good;
  d.nprops = 5, props[3] = 1.0, props[2] = 1.0;
  ck_refused(context, umat_moody_, &d, MPM_E_ARG, "PNEWDT");
  props[2] = 4.0;
  ck_refused(context, umat_moody_, &d, MPM_E_ARG, "calls XIT");
  ck_ok(context, mpm_context_destroy(context)); /* nothing is left behind */
}
END_TEST

START_TEST(structs_of_other_versions) {
  mpm_context *context = context_of(1);
  const double props[2] = {E, nu};
  struct {
    mpm_umat_desc known;
    double appended;
  } newer;
  mpm_material *material;
  memset(&newer, 7, sizeof newer);
  ck_ok(NULL, mpm_umat_desc_init(&newer.known, sizeof newer));
  ck_assert(newer.appended == 0.0 && newer.known.struct_size == sizeof newer);
  newer.known.density = density, newer.known.nprops = 2, newer.known.props = props;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, &newer.known, &material));
  ck_ok(context, mpm_material_destroy(material));
  newer.appended = 1.0;
  ck_refused(context, umat_elastic_, &newer.known, MPM_E_UNSUPPORTED, "does not know");
  ck_assert_int_eq(mpm_umat_desc_init(NULL, sizeof newer), MPM_E_ARG);
  ck_assert_int_eq(mpm_umat_desc_init(&newer.known, sizeof newer.known - 8), MPM_E_ARG);
  newer.appended = 3.0;
  ck_ok(NULL, mpm_umat_desc_init(&newer.known, sizeof newer.known));
  ck_assert(newer.appended == 3.0);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Arrays of the caller may go. */
START_TEST(arrays_are_copied) {
  mpm_context *context = context_of(1);
  double *props = malloc(2 * sizeof *props), *state = malloc(sizeof *state);
  char *name = malloc(8);
  mpm_umat_desc *d = malloc(sizeof *d);
  props[0] = E, props[1] = nu, state[0] = 4.5;
  memcpy(name, "CLAY", 5);
  *d = umat_desc(density, 2, props, 1);
  d->statev_initial = state, d->cmname = name;
  mpm_material *material;
  mpm_grid *grid;
  mpm_particles *set;
  mpm_grid_desc g;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, d, &material));
  props[0] = (double)NAN, state[0] = (double)NAN;
  free(props), free(state), free(name), free(d);
  point p = point_of(material, 2);
  step(context, &p, (const double[9]){1.01, 0, 0, 0, 1, 0, 0, 0, 1});
  ck_near(p.stress[0], E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) * log(1.01), 1e-6);
  /* a new particle has the initial state, and has made no step */
  ck_ok(context, mpm_grid_desc_init(&g, sizeof g));
  g.dim = 1, g.cells[0] = 8, g.spacing[0] = 1.0;
  ck_ok(context, mpm_grid_create(context, &g, &grid));
  ck_ok(context, mpm_particles_create(context, grid, material, &set));
  ck_ok(context, mpm_particles_fill_box(set, (const double[]){2.0}, (const double[]){3.0},
                                        (const int32_t[]){1}, NULL, NULL));
  double now[2];
  ck_ok(context, mpm_particles_get(set, "state", MPM_F64, 2, 1, NULL, now));
  ck_assert(now[0] == 4.5 && now[1] == 0.0);
  ck_ok(context, mpm_particles_destroy(set));
  ck_ok(context, mpm_grid_destroy(grid));
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- steps ------------------------------------------------------------------------------------------- */
typedef struct heard {
  int64_t particle;
  int count;
  char text[256];
} heard;

static void hear(void *user, int64_t particle, const char *text) {
  heard *h = user;
  h->particle = particle;
  h->count++;
  snprintf(h->text, sizeof h->text, "%s", text);
}

typedef struct scene {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *block;
  mpm_stepper *stepper;
  heard heard;
  double dt;
} scene;

enum { SICK = 37 }; /* the id of the particle */

/* A block under gravity, of which one particle falls ill at t = 10 dt. */
static void build(scene *s, int32_t threads, double mood, int32_t scheme) {
  mpm_grid_desc g;
  mpm_stepper_desc d;
  const int32_t per_cell[] = {2, 2};
  s->dt = scheme == MPM_NEWMARK ? 1e-3 : 1e-4;
  s->context = context_of(threads);
  s->heard = (heard){.count = 0};
  const double props[5] = {E, nu, mood, SICK + 1.0, 9.5 * s->dt};
  mpm_umat_desc u = umat_desc(density, 5, props, 1);
  u.message = hear;
  u.message_user = &s->heard;
  ck_ok(s->context, mpm_umat_material(s->context, umat_moody_, &u, &s->material));
  ck_ok(s->context, mpm_grid_desc_init(&g, sizeof g));
  ck_ok(s->context, mpm_stepper_desc_init(&d, sizeof d));
  g.dim = 2, g.cells[0] = g.cells[1] = 12, g.spacing[0] = g.spacing[1] = 0.1;
  d.gravity[1] = -10.0;
  d.scheme = scheme;
  ck_ok(s->context, mpm_grid_create(s->context, &g, &s->grid));
  ck_ok(s->context, mpm_particles_create(s->context, s->grid, s->material, &s->block));
  ck_ok(s->context, mpm_particles_fill_box(s->block, (const double[]){0.3, 0.0}, (const double[]){0.8, 0.5},
                                           per_cell, NULL, NULL));
  ck_ok(s->context, mpm_stepper_create(s->context, s->grid, &d, &s->stepper));
  ck_ok(s->context, mpm_stepper_add(s->stepper, s->block));
  ck_ok(s->context, mpm_stepper_set_wall(s->stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
}

static void tear_down(scene *s) {
  ck_ok(s->context, mpm_stepper_destroy(s->stepper));
  ck_ok(s->context, mpm_particles_destroy(s->block));
  ck_ok(s->context, mpm_material_destroy(s->material));
  ck_ok(s->context, mpm_grid_destroy(s->grid));
  ck_ok(s->context, mpm_context_destroy(s->context));
}

/* Ten steps go well; the next fails and leaves no trace; twice. */
static void ck_fails(int32_t threads, int32_t scheme, double mood, mpm_status status, const char *text,
                     mpm_status returned) {
  scene s;
  uint64_t before, after;
  mpm_step_info info = {.struct_size = sizeof info};
  build(&s, threads, mood, scheme);
  for (int k = 0; k < 10; ++k) ck_ok(s.context, mpm_step(s.stepper, s.dt, NULL));
  ck_ok(s.context, mpm_state_hash(s.stepper, &before));
  for (int again = 0; again < 2; ++again) {
    ck_assert_int_eq(mpm_step(s.stepper, s.dt, &info), status);
    if (!strstr(mpm_last_error(s.context), text)) ck_abort_msg("%s", mpm_last_error(s.context));
    ck_assert_int_eq(info.callback_status, returned);
    ck_ok(s.context, mpm_state_hash(s.stepper, &after));
    ck_assert(before == after);
  }
  if (mood == 4.0 || mood == 5.0) {
    ck_assert_int_eq(s.heard.particle, SICK);
    ck_assert_str_eq(s.heard.text, "the subroutine has called XIT");
    ck_assert_int_eq(s.heard.count, mood == 5.0 ? 4 : 2);
  } else {
    ck_assert_int_eq(s.heard.count, 0);
  }
  tear_down(&s);
}

START_TEST(sick_particles) {
  for (int32_t threads = 1; threads <= 4; threads += 3)
    for (int k = 0; k < 2; ++k) {
      const int32_t scheme = k ? MPM_NEWMARK : MPM_USL;
      ck_fails(threads, scheme, 1.0, MPM_CUT_DT, "returned 1", MPM_CUT_DT);
      ck_fails(threads, scheme, 2.0, MPM_NONFINITE, "particle 37", 0);
      ck_fails(threads, scheme, 3.0, MPM_NONFINITE, "particle 37", 0);
      ck_fails(threads, scheme, 4.0, MPM_E_CALLBACK, "returned -1001", MPM_UMAT_EXIT);
      ck_fails(threads, scheme, 5.0, MPM_E_CALLBACK, "returned -1001", MPM_UMAT_EXIT);
    }
}
END_TEST

/* A stiffness that is not a number is none of an explicit step's business, and stops an implicit one. */
START_TEST(sick_stiffness) {
  scene s;
  build(&s, 1, 6.0, MPM_USL);
  for (int k = 0; k < 12; ++k) ck_ok(s.context, mpm_step(s.stepper, s.dt, NULL));
  tear_down(&s);
  build(&s, 1, 6.0, MPM_NEWMARK);
  for (int k = 0; k < 10; ++k) ck_ok(s.context, mpm_step(s.stepper, s.dt, NULL));
  const mpm_status status = mpm_step(s.stepper, s.dt, NULL);
  printf("umat: a tangent that is not a number: %s, %s\n", mpm_status_name(status),
         mpm_last_error(s.context));
  ck_assert_int_ne(status, MPM_OK);
  tear_down(&s);
}
END_TEST

static char said[256];
static void keep_words(void *user, int64_t particle, const char *text) {
  (void)user, (void)particle;
  if (!said[0]) snprintf(said, sizeof said, "%s", text);
}

START_TEST(words_of_the_subroutine) {
  mpm_context *context = context_of(1);
  const double props[5] = {E, nu, 5.0, 1.0, 0.5};
  mpm_umat_desc d = umat_desc(density, 5, props, 1);
  mpm_material *material;
  d.message = keep_words;
  ck_ok(context, mpm_umat_material(context, umat_moody_, &d, &material));
  point p = point_of(material, 2);
  p.t = 1.0; /* of id 0, which is element 1 */
  ck_assert_int_eq(try_step(context, &p, (const double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1}, 0), MPM_E_CALLBACK);
  ck_assert_str_eq(said, "error: element 1 of SOIL at 0.25");
  ck_ok(context, mpm_material_destroy(material));
  mpm_umat_message("nobody listens");
  mpm_umat_exit(); /* comes back: nobody is in a subroutine */
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Once for a material; the bound of the step stays what the host has said. */
START_TEST(modulus_exceeded) {
  mpm_context *context = context_of(1);
  const double props[2] = {E, nu};
  heard ears = {.count = 0};
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  mpm_material *material;
  d.message = hear;
  d.message_user = &ears;
  d.wave_modulus = 1e7;
  ck_ok(context, mpm_umat_material(context, umat_elastic_, &d, &material));
  point p = point_of(material, 1);
  for (int k = 0; k < 3; ++k) step(context, &p, (const double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1});
  ck_assert_int_eq(ears.count, 1);
  ck_assert_int_eq(ears.particle, 0);
  ck_assert_ptr_nonnull(strstr(ears.text, "1.34615e+07"));
  ck_assert_ptr_nonnull(strstr(ears.text, "wave_modulus = 1e+07"));
  ck_near(p.wave_speed, sqrt(1e7 / density), 1e-10);
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- what subroutines do themselves ------------------------------------------------------------------- */
static mpm_context *elsewhere;
static mpm_status inside;

/* An elastic UMAT that does something more. */
static void (*more)(double *ddsdde);
static void busy(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                 double *rpl, double *ddsddt, double *drplde, double *drpldt, const double *stran,
                 const double *dstran, const double *time, const double *dtime, const double *temp,
                 const double *dtemp, const double *predef, const double *dpred, const char *cmname,
                 const int *ndi, const int *nshr, const int *ntens, const int *nstatv, const double *props,
                 const int *nprops, const double *coords, const double *drot, double *pnewdt,
                 const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
                 const int *npt, const int *layer, const int *kspt, const int *jstep, const int *kinc,
                 size_t cmname_length) {
  umat_elastic_(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time,
                dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords,
                drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc, cmname_length);
  more(ddsdde);
}

/* Fibres of ten times the stiffness, along a direction that is none of the axes and between none of them. */
static const double fibre[3] = {2.0, 3.0, 1.0}, stiff = 10.0;
static void fibres(double *ddsdde) {
  static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      ddsdde[i + 6 * j] +=
          stiff * E * fibre[at[i][0]] * fibre[at[i][1]] * fibre[at[j][0]] * fibre[at[j][1]] / (14.0 * 14.0);
}

/* The bound of the step is that of the stiffest direction. */
START_TEST(modulus_of_fibres) {
  more = fibres;
  mpm_context *context = context_of(1);
  const double props[2] = {E, nu}, isotropic = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  mpm_material *material;
  ck_ok(context, mpm_umat_material(context, busy, &d, &material));
  point p = point_of(material, 1);
  step(context, &p, (const double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1});
  const double wanted = sqrt((isotropic + stiff * E) / density);
  ck_near(p.wave_speed, wanted, 1e-6 * wanted);
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* NaN anywhere on the diagonal is no modulus. */
static void lost(double *ddsdde) {
  ddsdde[28] = (double)NAN;
}

START_TEST(modulus_is_a_number) {
  more = lost;
  mpm_context *context = context_of(1);
  const double props[2] = {E, nu};
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  ck_refused(context, busy, &d, MPM_E_ARG, "nan: give wave_modulus");
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Calls on another context, with a UMAT too, are the subroutine's to make; it may leave by XIT after them. */
static point nested;
static int32_t leaves;
static void caller(double *ddsdde) {
  (void)ddsdde;
  if (nested.material)
    inside = try_step(elsewhere, &nested, (const double[9]){1.01, 0, 0, 0, 1, 0, 0, 0, 1}, 0);
  if (nested.material && leaves) mpm_umat_exit();
}

START_TEST(calls_within_calls) {
  more = caller;
  const double props[2] = {E, nu};
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  mpm_context *context = context_of(1);
  mpm_material *outer, *inner;
  d.serial = _i / 2;
  leaves = _i % 2;
  elsewhere = context_of(1);
  ck_ok(elsewhere, mpm_umat_material(elsewhere, umat_elastic_, &d, &inner));
  ck_ok(context, mpm_umat_material(context, busy, &d, &outer));
  nested = point_of(inner, 1);
  point p = point_of(outer, 1);
  inside = MPM_E_INTERNAL;
  const mpm_status status = try_step(context, &p, (const double[9]){1.02, 0, 0, 0, 1, 0, 0, 0, 1}, 0);
  ck_assert_int_eq(inside, MPM_OK);
  if (leaves)
    ck_assert_int_eq(status, MPM_E_CALLBACK);
  else
    ck_ok(context, status);
  ck_near(nested.stress[0], 1.34615e7 * log(1.01), 1.0);
  nested.material = NULL;
  ck_ok(context, mpm_material_destroy(outer));
  ck_ok(elsewhere, mpm_material_destroy(inner));
  ck_ok(context, mpm_context_destroy(context));
  ck_ok(elsewhere, mpm_context_destroy(elsewhere));
}
END_TEST

/* A subroutine must not make materials: it holds what serial calls wait for. */
static void maker(double *ddsdde) {
  const double props[2] = {E, nu};
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  mpm_material *material;
  (void)ddsdde;
  inside = mpm_umat_material(elsewhere, umat_elastic_, &d, &material);
}

START_TEST(materials_of_subroutines) {
  more = maker;
  const double props[2] = {E, nu};
  mpm_umat_desc d = umat_desc(density, 2, props, 0);
  mpm_context *context = context_of(1);
  mpm_material *material;
  elsewhere = context_of(1);
  ck_ok(context, mpm_umat_material(context, busy, &d, &material));
  ck_assert_int_eq(inside, MPM_E_STATE);
  ck_assert_ptr_nonnull(strstr(mpm_last_error(elsewhere), "made by a subroutine"));
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
  ck_ok(elsewhere, mpm_context_destroy(elsewhere));
}
END_TEST

TCase *failures_case(void) {
  TCase *tcase = tcase_create("failures");
  tcase_set_timeout(tcase, 60);
  tcase_add_test(tcase, descriptions);
  tcase_add_test(tcase, structs_of_other_versions);
  tcase_add_test(tcase, arrays_are_copied);
  tcase_add_test(tcase, sick_particles);
  tcase_add_test(tcase, sick_stiffness);
  tcase_add_test(tcase, words_of_the_subroutine);
  tcase_add_test(tcase, modulus_exceeded);
  tcase_add_test(tcase, modulus_of_fibres);
  tcase_add_test(tcase, modulus_is_a_number);
  tcase_add_loop_test(tcase, calls_within_calls, 0, 4);
  tcase_add_test(tcase, materials_of_subroutines);
  return tcase;
}
