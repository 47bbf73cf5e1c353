#include "subroutine.h"
#include "tensor.h"

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the way in and out ------------------------------------------------------------------------------- */
/* SAVE and COMMON belong to the process, and subroutines share COMMON: one lock for each material would
 * not do. XIT has no argument that could say whose it is: the thread must know. Both hold nothing between
 * calls. */
static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;
typedef struct inside {
  jmp_buf out;
  const mpmu_call *call;
} inside;
static _Thread_local inside *under_way;
/* How many serial calls are under way on this thread: a subroutine, or who hears of it, may make calls on
 * other contexts, with materials of subroutines as well. */
static _Thread_local int serial_calls;

int mpmu_is_inside(void) {
  return under_way != NULL;
}

void mpm_umat_exit(void) {
  if (under_way) longjmp(under_way->out, 1);
}

static void tell(const mpmu_call *call, const char *text) {
  if (call->law->desc.message) call->law->desc.message(call->law->desc.message_user, call->particle, text);
}

void mpm_umat_message(const char *text) {
  if (under_way && text) tell(under_way->call, text);
}

/* Comes back in either way. */
static mpm_status run(mpmu_call *call) {
  inside here;
  inside *volatile const around = under_way;
  here.call = call;
  under_way = &here;
  if (setjmp(here.out)) {
    under_way = around;
    return MPM_UMAT_EXIT;
  }
  call->run(call->work);
  under_way = around;
  return MPM_OK;
}

mpm_status mpmu_enter(mpmu_call *call) {
  const int32_t serial = call->law->desc.serial;
  if (serial && !serial_calls++) pthread_mutex_lock(&one_at_a_time);
  const mpm_status status = run(call);
  if (serial && !--serial_calls) pthread_mutex_unlock(&one_at_a_time);
  if (status) tell(call, "the subroutine has called XIT");
  return status;
}

/* ---- descriptions -------------------------------------------------------------------------------------- */
enum { LARGEST_STRUCT = 1 << 16 };
static const uint32_t first_size = sizeof(mpm_umat_desc);

mpm_status mpm_umat_desc_init(mpm_umat_desc *desc, uint32_t struct_size) {
  if (!desc || struct_size < first_size || struct_size > LARGEST_STRUCT) return MPM_E_ARG;
  memset(desc, 0, struct_size);
  desc->struct_size = struct_size;
  desc->serial = 1;
  return MPM_OK;
}

mpm_status mpmu_refuse(mpm_context *context, mpm_status status, const char *format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return mpm_set_last_error(context, status, text);
}

static mpm_status read_desc(mpm_context *context, const mpm_umat_desc *desc, mpm_umat_desc *d) {
  if (!desc) return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc is NULL");
  const uint32_t given = desc->struct_size;
  if (given < first_size || given > LARGEST_STRUCT)
    return mpmu_refuse(context, MPM_E_ARG,
                       "mpm_umat_desc: struct_size is %u, must be at least %u (call its _init first)", given,
                       first_size);
  const unsigned char *bytes = (const unsigned char *)desc;
  for (uint32_t i = sizeof *d; i < given; ++i)
    if (bytes[i])
      return mpmu_refuse(
          context, MPM_E_UNSUPPORTED,
          "mpm_umat_desc sets a field that this version of libmpm-umat does not know (byte %u of "
          "%u): use the version that the host was compiled for",
          i, given);
  *d = *desc;
  return MPM_OK;
}

static mpm_status check_switches(mpm_context *context, const mpm_umat_desc *d) {
  const struct {
    const char *name;
    int32_t value;
  } switches[] = {{"serial", d->serial},
                  {"kirchhoff", d->kirchhoff},
                  {"stran", d->stran},
                  {"differenced", d->differenced}};
  for (int k = 0; k < 4; ++k)
    if (switches[k].value != 0 && switches[k].value != 1)
      return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: %s = %d must be 0 or 1", switches[k].name,
                         switches[k].value);
  if (d->dim < 0 || d->dim > 3)
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: dim = %d must be 0 to 3", d->dim);
  return MPM_OK;
}

static mpm_status check_numbers(mpm_context *context, const mpm_umat_desc *d) {
  if (!(d->density > 0.0 && isfinite(d->density)))
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: density = %.17g must be finite and > 0",
                       d->density);
  if (!(d->wave_modulus >= 0.0 && isfinite(d->wave_modulus)))
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: wave_modulus = %.17g must be finite and >= 0",
                       d->wave_modulus);
  if (!(d->celent >= 0.0 && isfinite(d->celent)))
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: celent = %.17g must be finite and >= 0",
                       d->celent);
  if (!isfinite(d->temperature))
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: temperature = %g must be finite", d->temperature);
  return MPM_OK;
}

static mpm_status check_arrays(mpm_context *context, const mpm_umat_desc *d) {
  const int32_t most = MPMU_STATES - 1 - (d->stran ? MPMU_SYM : 0);
  if (d->nstatv < 0 || d->nstatv > most)
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: nstatv = %d must be 0 to %d%s", d->nstatv, most,
                       d->stran ? " where stran is 1" : "");
  if (d->nprops < 0 || (d->nprops > 0 && !d->props))
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: nprops = %d must be >= 0%s", d->nprops,
                       d->nprops > 0 ? ", and props is NULL" : "");
  for (int32_t k = 0; k < d->nprops; ++k)
    if (!isfinite(d->props[k]))
      return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: props[%d] = %g must be finite", k, d->props[k]);
  for (int32_t k = 0; d->statev_initial && k < d->nstatv; ++k)
    if (!isfinite(d->statev_initial[k]))
      return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: statev_initial[%d] = %g must be finite", k,
                         d->statev_initial[k]);
  if (d->cmname && memchr(d->cmname, '\0', MPMU_CMNAME + 1) == NULL)
    return mpmu_refuse(context, MPM_E_ARG, "mpm_umat_desc: cmname \"%.32s...\" is longer than %d characters",
                       d->cmname, MPMU_CMNAME);
  return MPM_OK;
}

/* ---- materials --------------------------------------------------------------------------------------- */
mpm_status mpmu_law_make(mpm_context *context, const char *name, const mpm_umat_desc *desc, mpmu_law **out) {
  if (mpmu_is_inside())
    return mpmu_refuse(context, MPM_E_STATE, "%s: the call is made by a subroutine", name);
  mpm_umat_desc d;
  mpm_status status = read_desc(context, desc, &d);
  if (!status) status = check_switches(context, &d);
  if (!status) status = check_numbers(context, &d);
  if (!status) status = check_arrays(context, &d);
  if (status) return status;
  const size_t props = (size_t)d.nprops * sizeof(double);
  mpmu_law *law = malloc(sizeof *law + props);
  if (!law)
    return mpmu_refuse(context, MPM_E_NOMEM, "%s: no memory for %zu bytes", name, sizeof *law + props);
  *law = (mpmu_law){.desc = d, .told = ATOMIC_FLAG_INIT};
  law->props = (double *)(void *)(law + 1);
  if (d.nprops) memcpy(law->props, d.props, props);
  memset(law->cmname, ' ', sizeof law->cmname);
  if (d.cmname) memcpy(law->cmname, d.cmname, strlen(d.cmname));
  law->state_count = d.nstatv + (d.stran ? MPMU_SYM : 0) + 1;
  *out = law;
  return MPM_OK;
}

void mpmu_law_free(void *law) {
  free(law);
}

mpm_status mpmu_law_hand_over(mpm_context *context, mpmu_law *law, mpm_stress_fn stress,
                              mpm_tangent_fn tangent, mpm_material **out) {
  double initial[MPMU_STATES] = {0.0};
  mpm_material_desc m;
  mpm_status status = mpm_material_desc_init(&m, sizeof m);
  for (int32_t k = 0; law->desc.statev_initial && k < law->desc.nstatv; ++k)
    initial[k] = law->desc.statev_initial[k];
  m.state_count = law->state_count;
  m.state_initial = initial;
  m.density = law->desc.density;
  m.stress = stress;
  m.tangent = tangent;
  m.user = law;
  m.release_user = mpmu_law_free;
  /* the caller's arrays may be gone tomorrow */
  law->desc.props = law->props;
  law->desc.statev_initial = NULL;
  law->desc.cmname = NULL;
  if (!status) status = mpm_material_create_custom(context, &m, out);
  if (status) mpmu_law_free(law);
  return status;
}

void mpmu_answer_of_state(const mpmu_law *law, const mpm_material_batch *b) {
  for (int64_t i = 0; i < b->n; ++i) {
    const mpmu_mat F = mpmu_load_mat(b->F, b->ld, i);
    b->wave_speed[i] = sqrt(law->desc.wave_modulus * mpmu_determinant(&F) / law->desc.density);
    if (b->dt != 0.0 && b->id[i] >= 0) continue;
    for (int32_t c = 0; c < MPMU_SYM; ++c) b->stress_new[c * b->ld + i] = b->stress[c * b->ld + i];
    for (int32_t c = 0; c < law->state_count; ++c) b->state_new[c * b->ld + i] = b->state[c * b->ld + i];
  }
}
