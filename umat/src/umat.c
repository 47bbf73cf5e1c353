/* A UMAT as a material. F_inc = V R; the UMAT gets the stress turned with R, and ln V. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "increment.h"
#include "modulus.h"
#include "subroutine.h"

enum { PIECE = 16, DDSDDE = MPMU_SYM * MPMU_SYM };

/* Of the UMAT's 11 22 33 12 13 23 in xx yy zz xy yz xz. */
static const int place[MPMU_SYM] = {0, 1, 2, 3, 5, 4};
static const int row_of[MPMU_SYM] = {0, 1, 2, 0, 1, 0}, column_of[MPMU_SYM] = {0, 1, 2, 1, 2, 2};

/* What a particle brings and takes away, in the order of the UMAT. */
typedef struct point {
  double stress[MPMU_SYM], stran[MPMU_SYM], dstran[MPMU_SYM];
  double strain[MPMU_SYM]; /* at the end of the step */
  double drot[9], dfgrd0[9], dfgrd1[9], coords[3];
  double statev[MPMU_STATES], ddsdde[DDSDDE], pnewdt, J, steps;
  int64_t at; /* in the batch */
} point;

typedef struct piece {
  mpmu_law *law;
  const mpm_material_batch *batch; /* NULL: the particle that is asked for its modulus */
  mpmu_call call;
  double time, dtime;
  int32_t n;
  point point[PIECE];
} piece;

static void write_sym(mpmu_sym s, double shear, double *umat) {
  umat[0] = s.xx, umat[1] = s.yy, umat[2] = s.zz;
  umat[3] = shear * s.xy, umat[4] = shear * s.xz, umat[5] = shear * s.yz;
}

static mpmu_sym read_sym(const double *umat, double shear) {
  const mpmu_sym s = {umat[0], umat[1], umat[2], shear * umat[3], shear * umat[5], shear * umat[4]};
  return s;
}

static void write_columns(const mpmu_mat *a, double *columns) {
  for (int k = 0; k < 9; ++k) columns[k] = a->m[k % 3][k / 3];
}

/* ---- before the call --------------------------------------------------------------------------------- */
static void load_states(const mpmu_law *law, const mpm_material_batch *b, int64_t i, const mpmu_mat *R,
                        point *p) {
  const double *state = b->state + i;
  for (int32_t k = 0; k < law->desc.nstatv; ++k) p->statev[k] = state[k * b->ld];
  p->steps = state[mpmu_steps_of(law) * b->ld];
  memset(p->stran, 0, sizeof p->stran);
  if (!law->desc.stran) return;
  mpmu_sym strain = mpmu_load_sym(state + mpmu_stran_of(law) * b->ld, b->ld, 0);
  strain.xy *= 0.5, strain.yz *= 0.5, strain.xz *= 0.5;
  write_sym(mpmu_turned(R, strain), 2.0, p->stran);
}

static void load(const mpmu_law *law, const mpm_material_batch *b, int64_t i, point *p) {
  const mpmu_increment in = mpmu_increment_of(b, i);
  const mpmu_polar of = mpmu_polar_of(&in.F_inc);
  write_sym(mpmu_turned(&of.R, mpmu_load_sym(b->stress, b->ld, i)), 1.0, p->stress);
  write_sym(mpmu_log_stretch(&in.G, of.V), 2.0, p->dstran);
  write_columns(&of.R, p->drot);
  write_columns(&in.F_old, p->dfgrd0);
  write_columns(&in.F, p->dfgrd1);
  for (int32_t k = 0; k < 3; ++k) p->coords[k] = k < law->desc.dim ? b->position[k * b->ld + i] : 0.0;
  load_states(law, b, i, &of.R, p);
  for (int k = 0; k < MPMU_SYM; ++k) p->strain[k] = p->stran[k] + p->dstran[k];
  memset(p->ddsdde, 0, sizeof p->ddsdde);
  p->J = mpmu_determinant(&in.F);
  p->at = i;
}

/* ---- the call ---------------------------------------------------------------------------------------- */
/* The UMAT may write to what it is given of a point: these arguments are copies. */
static void call_umat(const mpmu_law *law, double time, double dtime, int64_t id, point *p) {
  double sse = 0.0, spd = 0.0, scd = 0.0, rpl = 0.0, drpldt = 0.0, ddsddt[MPMU_SYM] = {0.0};
  double drplde[MPMU_SYM] = {0.0}, times[2] = {time, time}, predef = 0.0, dpred = 0.0, dtemp = 0.0;
  double temp = law->desc.temperature, celent = law->desc.celent;
  int ndi = 3, nshr = 3, ntens = MPMU_SYM, nstatv = law->desc.nstatv, nprops = law->desc.nprops;
  int noel = (int)(id % INT32_MAX) + 1, npt = 1, layer = 1, kspt = 1, jstep[4] = {1, 0, 1, 0};
  int kinc = (int)fmin(p->steps + 1.0, INT32_MAX);
  p->pnewdt = 1.0;
  law->umat(p->stress, p->statev, p->ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, p->stran,
            p->dstran, times, &dtime, &temp, &dtemp, &predef, &dpred, law->cmname, &ndi, &nshr, &ntens,
            &nstatv, law->props, &nprops, p->coords, p->drot, &p->pnewdt, &celent, p->dfgrd0, p->dfgrd1,
            &noel, &npt, &layer, &kspt, jstep, &kinc, sizeof law->cmname);
}

static void call_all(void *work) {
  piece *w = work;
  for (int32_t k = 0; k < w->n; ++k) {
    point *p = &w->point[k];
    w->call.particle = w->batch ? w->batch->id[p->at] : -1;
    call_umat(w->law, w->time, w->dtime, w->batch ? w->call.particle : 0, p);
  }
}

static mpm_status run_piece(piece *w) {
  w->call = (mpmu_call){.law = w->law, .particle = -1, .run = call_all, .work = w};
  const mpm_status status = mpmu_enter(&w->call);
  for (int32_t k = 0; !status && k < w->n; ++k)
    if (w->point[k].pnewdt < 1.0) return MPM_CUT_DT;
  return status;
}

/* Fills a piece with particles from *i on. */
static void load_piece(mpmu_law *law, const mpm_material_batch *b, int64_t *i, piece *w) {
  w->law = law;
  w->batch = b;
  w->time = b->t - b->dt;
  w->dtime = b->dt;
  w->n = 0;
  for (; *i < b->n && w->n < PIECE; ++*i)
    if (b->id[*i] >= 0) load(law, b, *i, &w->point[w->n++]);
}

/* ---- after the call ---------------------------------------------------------------------------------- */
/* The bound of the step is the host's word: it must not depend on what was called before a state was
 * saved. */
static void watch_modulus(const piece *w, const point *p) {
  mpmu_law *law = w->law;
  if (!law->desc.message) return;
  const double modulus = mpmu_largest_modulus(p->ddsdde);
  if (!(modulus > 1.000001 * law->desc.wave_modulus)) return;
  if (atomic_flag_test_and_set(&law->told)) return;
  char text[192];
  snprintf(text, sizeof text,
           "DDSDDE has a modulus of %g, beyond wave_modulus = %g: explicit steps may be too long", modulus,
           law->desc.wave_modulus);
  law->desc.message(law->desc.message_user, w->batch->id[p->at], text);
}

static void store(const piece *w, const point *p) {
  const mpmu_law *law = w->law;
  const mpm_material_batch *b = w->batch;
  double *state = b->state_new + p->at;
  mpmu_store_sym(b->stress_new, b->ld, p->at, read_sym(p->stress, 1.0));
  for (int32_t k = 0; k < law->desc.nstatv; ++k) state[k * b->ld] = p->statev[k];
  state[mpmu_steps_of(law) * b->ld] = p->steps + 1.0;
  if (law->desc.stran) mpmu_store_sym(state + mpmu_stran_of(law) * b->ld, b->ld, 0, read_sym(p->strain, 1.0));
  watch_modulus(w, p);
}

static mpm_status stress(void *user, const mpm_material_batch *b) {
  mpmu_law *law = user;
  mpmu_answer_of_state(law, b);
  piece w;
  for (int64_t i = 0; b->dt != 0.0 && i < b->n;) {
    load_piece(law, b, &i, &w);
    const mpm_status status = run_piece(&w);
    if (status) return status;
    for (int32_t k = 0; k < w.n; ++k) store(&w, &w.point[k]);
  }
  return MPM_OK;
}

/* ---- the tangent ------------------------------------------------------------------------------------- */
/* c_ijkl = J [DDSDDE_ijkl + s_ij d_kl - 1/2 (d_ik s_lj + d_il s_kj + d_jk s_il + d_jl s_ik)]: DDSDDE is the
 * derivative of the Jaumann rate of the Cauchy stress s; of that of J s, over J, it has s_ij d_kl already. */
static void store_tangent(const piece *w, const point *p, double *tangent) {
  const int64_t ld = w->batch->ld;
  const mpmu_sym s = read_sym(p->stress, 1.0);
  const double T[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  const double of_volume = w->law->desc.kirchhoff ? 0.0 : 1.0;
  for (int a = 0; a < MPMU_SYM; ++a)
    for (int e = 0; e < MPMU_SYM; ++e) {
      const int i = row_of[place[a]], j = column_of[place[a]], k = row_of[place[e]], l = column_of[place[e]];
      const double turned = 0.5 * ((i == k ? T[l][j] : 0.0) + (i == l ? T[k][j] : 0.0) +
                                   (j == k ? T[i][l] : 0.0) + (j == l ? T[i][k] : 0.0));
      const double volume = k == l ? of_volume * T[i][j] : 0.0;
      tangent[(6 * place[a] + place[e]) * ld + p->at] = p->J * (p->ddsdde[a + 6 * e] + volume - turned);
    }
}

static int is_symmetric(const double *ddsdde) {
  for (int a = 0; a < MPMU_SYM; ++a)
    for (int e = 0; e < a; ++e)
      if (ddsdde[a + 6 * e] != ddsdde[e + 6 * a]) return 0;
  return 1;
}

static mpm_status tangent(void *user, const mpm_material_batch *b, double *out, int32_t *symmetric) {
  mpmu_law *law = user;
  piece w;
  *symmetric = law->desc.kirchhoff;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t c = 0; c < DDSDDE && b->id[i] < 0; ++c) out[c * b->ld + i] = 0.0;
  for (int64_t i = 0; i < b->n;) {
    load_piece(law, b, &i, &w);
    const mpm_status status = run_piece(&w);
    if (status) return status;
    for (int32_t k = 0; k < w.n; ++k) {
      store_tangent(&w, &w.point[k], out);
      if (*symmetric) *symmetric = is_symmetric(w.point[k].ddsdde);
    }
  }
  return MPM_OK;
}

/* ---- materials --------------------------------------------------------------------------------------- */
/* The modulus of a particle without stress, in its initial state, by a call without strain. */
static mpm_status ask_modulus(mpm_context *context, mpmu_law *law, const double *initial) {
  static const mpmu_mat unit = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  piece w = {.law = law, .dtime = 1.0, .n = 1};
  point *p = &w.point[0];
  write_columns(&unit, p->drot);
  write_columns(&unit, p->dfgrd0);
  write_columns(&unit, p->dfgrd1);
  for (int32_t k = 0; initial && k < law->desc.nstatv; ++k) p->statev[k] = initial[k];
  const mpm_status status = run_piece(&w);
  const double modulus = mpmu_largest_modulus(p->ddsdde);
  if (status)
    return mpmu_refuse(context, MPM_E_ARG,
                       "mpm_umat_material: the UMAT %s when it is asked for the modulus of an unstressed "
                       "particle: give wave_modulus",
                       status == MPM_UMAT_EXIT ? "calls XIT" : "asks for a smaller step (PNEWDT)");
  if (!(modulus > 0.0 && isfinite(modulus)))
    return mpmu_refuse(
        context, MPM_E_ARG,
        "mpm_umat_material: the largest modulus of an unstressed particle is %g: give wave_modulus", modulus);
  law->desc.wave_modulus = modulus;
  return MPM_OK;
}

mpm_status mpm_umat_material(mpm_context *context, mpm_umat_fn fn, const mpm_umat_desc *desc,
                             mpm_material **out) {
  if (out) *out = NULL;
  if (!context) return MPM_E_ARG;
  if (!out) return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_material: out is NULL");
  if (!fn) return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_material: fn is NULL");
  mpmu_law *law;
  mpm_status status = mpmu_law_make(context, "mpm_umat_material", desc, &law);
  if (status) return status;
  law->umat = fn;
  if (law->desc.wave_modulus == 0.0) status = ask_modulus(context, law, law->desc.statev_initial);
  if (status) {
    mpmu_law_free(law);
    return status;
  }
  return mpmu_law_hand_over(context, law, stress, law->desc.differenced ? NULL : tangent, out);
}
