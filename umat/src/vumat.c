/* A VUMAT as a material. It sees what an observer sees who turns with the R of F = R U: the stress R^T s R,
 * and R^T (ln V) R with the R of the end of the step, F_inc = V R_inc. */
#include <math.h>
#include <string.h>

#include "increment.h"
#include "modulus.h"
#include "subroutine.h"

enum { BLOCK = 32, GRADIENT = 9, SPIN = 3 };
static const double probe = 1e-6; /* strain of the call that asks for the modulus */

/* Rows are [components][n]: they follow each other as n of the block has it. */
typedef struct block {
  const mpmu_law *law;
  const mpm_material_batch *batch; /* NULL: the particles that are asked for their modulus */
  mpmu_call call;
  double time, dt;
  int n;
  double density[BLOCK], celent[BLOCK], temperature[BLOCK], zeros[BLOCK], coords[3 * BLOCK];
  double strain_inc[MPMU_SYM * BLOCK], spin[SPIN * BLOCK], stretch_old[MPMU_SYM * BLOCK];
  double stretch_new[MPMU_SYM * BLOCK], F_old[GRADIENT * BLOCK], F_new[GRADIENT * BLOCK];
  double stress_old[MPMU_SYM * BLOCK], stress_new[MPMU_SYM * BLOCK], energy[2 * BLOCK];
  double state_old[MPMU_STATES * BLOCK], state_new[MPMU_STATES * BLOCK];
  mpmu_mat R[BLOCK]; /* at the end of the step */
  int64_t at[BLOCK]; /* in the batch */
} block;

/* ---- before the call --------------------------------------------------------------------------------- */
/* 11 22 33 12 23 31 21 32 13 */
static void store_gradient(double *rows, int n, int k, const mpmu_mat *F) {
  static const int row[GRADIENT] = {0, 1, 2, 0, 1, 2, 1, 2, 0},
                   column[GRADIENT] = {0, 1, 2, 1, 2, 0, 0, 1, 2};
  for (int c = 0; c < GRADIENT; ++c) rows[c * n + k] = F->m[row[c]][column[c]];
}

/* The rotation of the step as that observer sees it, as the entries 12 23 31 of its logarithm. */
static void store_spin(double *rows, int n, int k, const mpmu_mat *R) {
  const double skew[SPIN] = {0.5 * (R->m[0][1] - R->m[1][0]), 0.5 * (R->m[1][2] - R->m[2][1]),
                             0.5 * (R->m[2][0] - R->m[0][2])};
  const double sine = sqrt(skew[0] * skew[0] + skew[1] * skew[1] + skew[2] * skew[2]);
  const double cosine = 0.5 * (R->m[0][0] + R->m[1][1] + R->m[2][2] - 1.0);
  const double factor = sine > 1e-8 ? atan2(sine, cosine) / sine : 1.0;
  for (int c = 0; c < SPIN; ++c) rows[c * n + k] = factor * skew[c];
}

static void load_frames(block *w, int k) {
  const mpm_material_batch *b = w->batch;
  const int64_t i = w->at[k];
  const int n = w->n;
  const mpmu_increment in = mpmu_increment_of(b, i);
  const mpmu_polar end = mpmu_polar_of(&in.F), start = mpmu_polar_of(&in.F_old);
  const mpmu_polar of = mpmu_polar_of(&in.F_inc);
  const mpmu_mat from_end = mpmu_transposed(&end.R), from_start = mpmu_transposed(&start.R);
  const mpmu_mat turned = mpmu_product(&of.R, &start.R), relative = mpmu_product(&from_end, &turned);
  store_gradient(w->F_old, n, k, &in.F_old);
  store_gradient(w->F_new, n, k, &in.F);
  mpmu_store_sym(w->stretch_old, n, k, mpmu_turned(&from_start, start.V));
  mpmu_store_sym(w->stretch_new, n, k, mpmu_turned(&from_end, end.V));
  mpmu_store_sym(w->strain_inc, n, k, mpmu_turned(&from_end, mpmu_log_stretch(&in.G, of.V)));
  mpmu_store_sym(w->stress_old, n, k, mpmu_turned(&from_start, mpmu_load_sym(b->stress, b->ld, i)));
  store_spin(w->spin, n, k, &relative);
  w->R[k] = end.R;
  w->density[k] = w->law->desc.density / mpmu_determinant(&in.F);
}

/* Takes the next particles, as many as a block has. */
static void load_block(const mpmu_law *law, const mpm_material_batch *b, int64_t *i, block *w) {
  w->law = law;
  w->batch = b;
  w->time = b->t;
  w->dt = b->dt;
  w->n = 0;
  for (; *i < b->n && w->n < BLOCK; ++*i)
    if (b->id[*i] >= 0) w->at[w->n++] = *i;
  const int n = w->n;
  for (int k = 0; k < n; ++k) {
    load_frames(w, k);
    for (int c = 0; c < 3; ++c)
      w->coords[c * n + k] = c < law->desc.dim ? b->position[c * b->ld + w->at[k]] : 0.0;
    for (int32_t c = 0; c < law->desc.nstatv; ++c) w->state_old[c * n + k] = b->state[c * b->ld + w->at[k]];
  }
}

/* ---- the call ---------------------------------------------------------------------------------------- */
/* The new values start as the old ones: some subroutines write only what changes. */
static void preset(block *w) {
  for (int k = 0; k < w->n; ++k) {
    w->celent[k] = w->law->desc.celent;
    w->temperature[k] = w->law->desc.temperature;
    w->zeros[k] = 0.0;
  }
  memcpy(w->stress_new, w->stress_old, (size_t)(MPMU_SYM * w->n) * sizeof(double));
  memcpy(w->state_new, w->state_old, (size_t)(w->law->desc.nstatv * w->n) * sizeof(double));
  memset(w->energy, 0, sizeof w->energy);
}

static void call_vumat(void *work) {
  block *w = work;
  const mpmu_law *law = w->law;
  int block_of[4 + BLOCK] = {w->n, 1, 1, 1}, ndir = 3, nshr = SPIN, nstatev = law->desc.nstatv, nfieldv = 0,
                   nprops = law->desc.nprops;
  int lanneal = 0;
  double step_time = w->time, total_time = w->time, dt = w->dt;
  /* nblock alone, or what subroutines with jblock(*) read: then npt, layer, kspt and numbers of elements */
  for (int k = 0; k < w->n; ++k)
    block_of[4 + k] = (int)((w->batch ? w->batch->id[w->at[k]] : 0) % INT32_MAX) + 1;
  w->call.particle = w->batch ? w->batch->id[w->at[0]] : -1;
  law->vumat(block_of, &ndir, &nshr, &nstatev, &nfieldv, &nprops, &lanneal, &step_time, &total_time, &dt,
             law->cmname, w->coords, w->celent, law->props, w->density, w->strain_inc, w->spin,
             w->temperature, w->stretch_old, w->F_old, w->zeros, w->stress_old, w->state_old, w->zeros,
             w->zeros, w->temperature, w->stretch_new, w->F_new, w->zeros, w->stress_new, w->state_new,
             w->energy, w->energy + BLOCK, sizeof law->cmname);
}

static mpm_status run_block(block *w) {
  if (!w->n) return MPM_OK;
  preset(w);
  w->call = (mpmu_call){.law = w->law, .particle = -1, .run = call_vumat, .work = w};
  return mpmu_enter(&w->call);
}

/* ---- after the call ---------------------------------------------------------------------------------- */
static void store_block(const block *w) {
  const mpm_material_batch *b = w->batch;
  const mpmu_law *law = w->law;
  const int32_t steps = mpmu_steps_of(law);
  for (int k = 0; k < w->n; ++k) {
    const int64_t i = w->at[k];
    mpmu_store_sym(b->stress_new, b->ld, i, mpmu_turned(&w->R[k], mpmu_load_sym(w->stress_new, w->n, k)));
    for (int32_t c = 0; c < law->desc.nstatv; ++c) b->state_new[c * b->ld + i] = w->state_new[c * w->n + k];
    b->state_new[steps * b->ld + i] = b->state[steps * b->ld + i] + 1.0;
  }
}

static mpm_status stress(void *user, const mpm_material_batch *b) {
  const mpmu_law *law = user;
  mpmu_answer_of_state(law, b);
  block w;
  for (int64_t i = 0; b->dt != 0.0 && i < b->n;) {
    load_block(law, b, &i, &w);
    const mpm_status status = run_block(&w);
    if (status) return status;
    store_block(&w);
  }
  return MPM_OK;
}

/* ---- materials --------------------------------------------------------------------------------------- */
/* Six particles without stress, in their initial state, are strained along and across the axes. */
static mpm_status ask_modulus(mpm_context *context, mpmu_law *law, const double *initial) {
  static const mpmu_mat unit = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  enum { N = MPMU_SYM };
  block w = {.law = law, .dt = 1.0, .n = N};
  for (int k = 0; k < N; ++k) {
    const double at = k < 3 ? probe : 0.5 * probe; /* tensor shear of an engineering shear */
    const int i = k % 3, j = k < 3 ? i : (k + 1) % 3;
    mpmu_mat F = unit;
    F.m[i][j] += at;
    if (i != j) F.m[j][i] += at;
    store_gradient(w.F_old, N, k, &unit);
    store_gradient(w.F_new, N, k, &F);
    mpmu_store_sym(w.stretch_old, N, k, (mpmu_sym){1.0, 1.0, 1.0, 0.0, 0.0, 0.0});
    mpmu_store_sym(w.stretch_new, N, k,
                   (mpmu_sym){F.m[0][0], F.m[1][1], F.m[2][2], F.m[0][1], F.m[1][2], F.m[0][2]});
    w.strain_inc[k * N + k] = at;
    w.density[k] = law->desc.density;
    for (int32_t c = 0; initial && c < law->desc.nstatv; ++c) w.state_old[c * N + k] = initial[c];
  }
  if (run_block(&w))
    return mpmu_refuse(context, MPM_E_ARG,
                       "mpm_vumat_material: the VUMAT calls XPLB_EXIT when it is asked for the modulus of an "
                       "unstressed particle: give wave_modulus");
  static const int of_umat[N] = {0, 1, 2, 3, 5, 4}; /* 12, 23, 13 are 12, 13, 23 */
  double stiffness[N * N];
  for (int k = 0; k < N; ++k)
    for (int c = 0; c < N; ++c) stiffness[of_umat[c] + N * of_umat[k]] = w.stress_new[c * N + k] / probe;
  const double modulus = mpmu_largest_modulus(stiffness);
  if (!(modulus > 0.0 && isfinite(modulus)))
    return mpmu_refuse(
        context, MPM_E_ARG,
        "mpm_vumat_material: the largest modulus of an unstressed particle is %g: give wave_modulus",
        modulus);
  law->desc.wave_modulus = modulus;
  return MPM_OK;
}

mpm_status mpm_vumat_material(mpm_context *context, mpm_vumat_fn fn, const mpm_umat_desc *desc,
                              mpm_material **out) {
  if (out) *out = NULL;
  if (!context) return MPM_E_ARG;
  if (!out) return mpmu_refuse(context, MPM_E_ARG, "mpm_vumat_material: out is NULL");
  if (!fn) return mpmu_refuse(context, MPM_E_ARG, "mpm_vumat_material: fn is NULL");
  mpmu_law *law;
  mpm_status status = mpmu_law_make(context, "mpm_vumat_material", desc, &law);
  if (status) return status;
  law->vumat = fn;
  if (law->desc.kirchhoff || law->desc.stran)
    status =
        mpmu_refuse(context, MPM_E_UNSUPPORTED, "mpm_vumat_material: %s = 1 is of UMATs: a VUMAT has %s",
                    law->desc.kirchhoff ? "kirchhoff" : "stran",
                    law->desc.kirchhoff ? "no DDSDDE, leave it at 0"
                                        : "stretchNew and defgradNew for the whole strain, leave it at 0");
  if (!status && law->desc.wave_modulus == 0.0) status = ask_modulus(context, law, law->desc.statev_initial);
  if (status) {
    mpmu_law_free(law);
    return status;
  }
  return mpmu_law_hand_over(context, law, stress, NULL, out);
}
