/* Fields are packed into floats for renderers, in the full layout, particle by particle. */
#include "particles/values.h"

enum { PORTION = 512 };

/* What is packed: fields by number, and where each begins within a particle. */
typedef struct packing {
  const mpm_particles *set;
  int32_t count, stride;
  int32_t field[MPMI_MAX_FIELDS], first[MPMI_MAX_FIELDS];
} packing;

static mpm_status add_field(packing *p, const char *name) {
  const mpm_particles *set = p->set;
  int32_t f = -1;
  mpm_status status = mpmi_require_field(set, name, &f);
  if (!status) status = mpmi_check_exists(set, f);
  for (int32_t i = 0; i < p->count && !status; ++i)
    if (p->field[i] == f) status = mpmi_fail(set->context, MPM_E_ARG, "field \"%s\" is named twice", name);
  if (status) return status;
  p->field[p->count] = f;
  p->first[p->count++] = p->stride;
  p->stride += set->field[f].full_components;
  return MPM_OK;
}

static mpm_status choose(packing *p, int32_t count, const char *const *fields) {
  mpm_context *context = p->set->context;
  if (count < 1) return mpmi_fail(context, MPM_E_ARG, "count is %d, must be >= 1", (int)count);
  if (!fields) return mpmi_fail(context, MPM_E_ARG, "fields is NULL");
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < count && !status; ++i) status = add_field(p, fields[i]);
  return status;
}

static mpm_status check_rest(const packing *p, int32_t order, int64_t n, const float *out) {
  mpm_context *context = p->set->context;
  if (order != MPM_BY_ID && order != MPM_LIBRARY_ORDER)
    return mpmi_fail(context, MPM_E_ARG, "order is %d, must be MPM_BY_ID or MPM_LIBRARY_ORDER", (int)order);
  if (n != p->set->count)
    return mpmi_fail(context, MPM_E_ARG, "n is %lld, but the set has %lld particles", (long long)n,
                     (long long)p->set->count);
  if (!out && n > 0 && p->stride > 0) return mpmi_fail(context, MPM_E_ARG, "out is NULL");
  return MPM_OK;
}

/* Brings up to date what follows from other fields, and the index if the order needs it. Both are caches,
 * which const sets have too. */
static mpm_status settle(const packing *p, int32_t order) {
  mpm_particles *set = (mpm_particles *)(uintptr_t)p->set;
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < p->count && !status; ++i) status = mpmi_settle(set, p->field[i]);
  return status || order == MPM_LIBRARY_ORDER ? status : mpmi_index_build(set);
}

/* Writes n values of one component, of the particles in slot[], to every `stride`-th element of out. */
static void pack_component(const mpm_particles *set, int32_t f, int32_t c, int64_t n, const int64_t *slot,
                           int32_t stride, float *out) {
  const mpmi_field *field = &set->field[f];
  const int32_t stored = mpmi_stored_component(set, f, c);
  const int64_t first = stored * set->ld;
  if (stored < 0) {
    const float value = (float)mpmi_unstored_value(f, c);
    for (int64_t i = 0; i < n; ++i) out[i * stride] = value;
  } else if (!field->present) {
    for (int64_t i = 0; i < n; ++i) out[i * stride] = (float)mpmi_absent_value(set, f, c, slot[i]);
  } else if (field->type == MPM_F64) {
    const double *row = mpmi_f64(set, f, 0) + first;
    for (int64_t i = 0; i < n; ++i) out[i * stride] = (float)row[slot[i]];
  } else if (field->type == MPM_I64) {
    const int64_t *row = mpmi_i64(set, f, 0) + first;
    for (int64_t i = 0; i < n; ++i) out[i * stride] = (float)row[slot[i]];
  } else {
    const uint8_t *row = (const uint8_t *)field->data[0] + first;
    for (int64_t i = 0; i < n; ++i) out[i * stride] = (float)row[slot[i]];
  }
}

static void pack(const packing *p, int64_t n, const int64_t *slot, float *out) {
  for (int32_t i = 0; i < p->count; ++i)
    for (int32_t c = 0; c < p->set->field[p->field[i]].full_components; ++c)
      pack_component(p->set, p->field[i], c, n, slot, p->stride, out + p->first[i] + c);
}

static void pack_by_id(const packing *p, float *out) {
  const mpm_particles *set = p->set;
  int64_t slot[PORTION];
  for (int64_t begin = 0, n; begin < set->count; begin += n) {
    n = set->count - begin < PORTION ? set->count - begin : PORTION;
    for (int64_t i = 0; i < n; ++i) slot[i] = set->index[begin + i].slot;
    pack(p, n, slot, out + begin * p->stride);
  }
}

/* Ids that the host has spoilt must not lead beyond the end of its buffer. */
static mpm_status pack_in_library_order(const packing *p, float *out) {
  const mpm_particles *set = p->set;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  int64_t slot[PORTION], done = 0;
  for (int64_t begin = 0; begin < set->slots; begin += PORTION) {
    const int64_t end = set->slots - begin < PORTION ? set->slots : begin + PORTION;
    int64_t n = 0;
    for (int64_t s = begin; s < end; ++s) {
      slot[n] = s;
      n += id[s] >= 0;
    }
    if (n > set->count - done) return mpmi_refuse_ids(set);
    pack(p, n, slot, out + done * p->stride);
    done += n;
  }
  return done == set->count ? MPM_OK : mpmi_refuse_ids(set);
}

mpm_status mpm_particles_get_f32(const mpm_particles *particles, int32_t count, const char *const *fields,
                                 int32_t order, int64_t n, float *out) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  packing p = {.set = particles};
  mpm_status status = choose(&p, count, fields);
  if (!status) status = check_rest(&p, order, n, out);
  if (!status) status = settle(&p, order);
  if (status || !out) return status;
  if (order == MPM_LIBRARY_ORDER) return pack_in_library_order(&p, out);
  pack_by_id(&p, out);
  return MPM_OK;
}
