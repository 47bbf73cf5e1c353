/* A law without a grid: mpm_material_update() runs a material on particles that are the caller's. Items go
 * through the buffers of a batch in portions, because laws of the library take whole, aligned chunks. All
 * tensors are full, as in 3-D. */
#include <math.h>
#include <string.h>

#include "context/structs.h"
#include "particles/builtin_fields.h"
#include "particles/law_batch.h"

enum { FULL = 3, TANGENT_ROWS = 81 };

/* ---- what the caller gave ----------------------------------------------------------------------------- */
typedef struct mpmi_given_row {
  const char *name;
  const void *data;
} mpmi_given_row;

static mpm_status check_rows(const mpm_material *material, const mpm_material_batch *b) {
  const mpmi_given_row rows[] = {{"F", b->F},           {"F_inc", b->F_inc},
                                 {"stress", b->stress}, {"stress_new", b->stress_new},
                                 {"state", b->state},   {"state_new", b->state_new}};
  const int32_t needed = material->state_count ? 6 : 4;
  for (int32_t i = 0; i < needed && b->n; ++i)
    if (!rows[i].data)
      return mpmi_fail(material->context, MPM_E_ARG, "mpm_material_update: %s is NULL", rows[i].name);
  return MPM_OK;
}

static mpm_status check_batch(const mpm_material *material, const mpm_material_batch *b,
                              const double *tangent) {
  mpm_context *context = material->context;
  if (b->n < 0 || b->ld < b->n || b->ld > MPMI_MAX_SLOTS)
    return mpmi_fail(context, MPM_E_ARG,
                     "mpm_material_update: n = %lld and ld = %lld must be 0 <= n <= ld <= %lld",
                     (long long)b->n, (long long)b->ld, (long long)MPMI_MAX_SLOTS);
  if (b->state_count != material->state_count)
    return mpmi_fail(context, MPM_E_ARG, "mpm_material_update: state_count = %d, but the material has %d",
                     b->state_count, material->state_count);
  if (!(b->dt >= 0.0 && isfinite(b->dt)) || !isfinite(b->t))
    return mpmi_fail(context, MPM_E_ARG,
                     "mpm_material_update: t = %g and dt = %g must be finite, and dt >= 0", b->t, b->dt);
  if (tangent && b->dt == 0.0)
    return mpmi_fail(context, MPM_E_ARG, "mpm_material_update: a tangent is that of a step: dt must be > 0");
  return check_rows(material, b);
}

static double determinant(const double *F, int64_t ld, int64_t i) {
  return 1.0 + mpmi_J_minus_1(FULL, mpmi_load_F_minus_1(FULL, F, ld, i));
}

static int64_t id_of(const mpm_material_batch *b, int64_t i) {
  return b->id ? b->id[i] : i;
}

static mpm_status refuse(const mpm_material *material, const mpm_material_batch *b, int64_t i,
                         mpm_status status, const char *what) {
  return mpmi_fail(material->context, status, "mpm_material_update: %s at item %lld, id %lld", what,
                   (long long)i, (long long)id_of(b, i));
}

static int32_t finite_item(const double *a, int32_t rows, int64_t ld, int64_t i) {
  double sum = 0.0;
  for (int32_t r = 0; r < rows; ++r) sum += 0.0 * a[r * ld + i];
  return sum == 0.0;
}

/* L says the same as F_inc: some laws look at one, some at the other. */
static int32_t fits_step(const mpm_material_batch *b, int64_t i) {
  for (int32_t e = 0; e < 9 && b->L; ++e) {
    const double of_L = (e % 4 ? 0.0 : 1.0) + b->dt * b->L[e * b->ld + i], F_inc = b->F_inc[e * b->ld + i];
    if (!(fabs(of_L - F_inc) <= 1e-9 * (1.0 + fabs(F_inc)))) return 0;
  }
  return 1;
}

static mpm_status check_items(const mpm_material *material, const mpm_material_batch *b) {
  for (int64_t i = 0; i < b->n; ++i) {
    if (id_of(b, i) < 0) continue;
    if (!finite_item(b->F, 9, b->ld, i) || !finite_item(b->F_inc, 9, b->ld, i) ||
        !(b->L == NULL || finite_item(b->L, 9, b->ld, i)) || !finite_item(b->stress, 6, b->ld, i) ||
        !finite_item(b->state, material->state_count, b->ld, i))
      return refuse(material, b, i, MPM_NONFINITE, "a value that is not finite is given");
    if (!(determinant(b->F, b->ld, i) > 0.0) || !(determinant(b->F_inc, b->ld, i) > 0.0))
      return refuse(material, b, i, MPM_INVERTED, "det F or det F_inc is not positive");
    if (b->dt > 0.0 && !fits_step(b, i))
      return refuse(material, b, i, MPM_E_ARG, "L is not (F_inc - I) / dt");
  }
  return MPM_OK;
}

/* ---- a portion ---------------------------------------------------------------------------------------- */
/* Items from `begin` on, as many as the buffers hold. */
typedef struct mpmi_portion {
  const mpm_material *material;
  const mpm_material_batch *given;
  mpmi_law_batch law;
  int64_t *id;     /* [law.ld] */
  double *tangent; /* [81][law.ld], or NULL */
  void *tangent_scratch;
  int64_t begin, n;
} mpmi_portion;

static void take(double *to, int64_t ld, const double *from, const mpmi_portion *p, int32_t rows) {
  for (int32_t r = 0; r < rows; ++r)
    memcpy(to + r * ld, from + r * p->given->ld + p->begin, (size_t)p->n * sizeof *to);
}

static void give(const double *from, int64_t ld, double *to, const mpmi_portion *p, int32_t rows) {
  for (int32_t r = 0; to && r < rows; ++r)
    memcpy(to + r * p->given->ld + p->begin, from + r * ld, (size_t)p->n * sizeof *to);
}

/* An inert item gets a state that stays as it is, so that no law meets what it holds. */
static void make_inert(mpmi_portion *p, int64_t i) {
  mpmi_law_batch *b = &p->law;
  for (int32_t e = 0; e < 9; ++e) {
    b->F[e * b->ld + i] = b->F_inc[e * b->ld + i] = e % 4 ? 0.0 : 1.0;
    b->L[e * b->ld + i] = 0.0;
  }
  for (int32_t c = 0; c < 6; ++c) b->stress[c * b->ld + i] = 0.0;
  for (int32_t k = 0; k < FULL; ++k) b->position[k * b->ld + i] = 0.0;
  for (int32_t c = 0; c < p->material->state_count; ++c)
    b->state[c * b->ld + i] = p->material->state_initial ? p->material->state_initial[c] : 0.0;
}

static void load(mpmi_portion *p) {
  mpmi_law_batch *b = &p->law;
  const mpm_material_batch *given = p->given;
  mpmi_law_batch_bind(b, p->material, b->F);
  memset(b->state, 0, (size_t)(p->material->state_count * b->ld) * sizeof(double));
  /* the library's laws take whole chunks: what is beyond the items stays as bound */
  b->batch.n = p->material->law ? (p->n + MPMI_CHUNK - 1) / MPMI_CHUNK * MPMI_CHUNK : p->n;
  b->batch.t = given->t;
  b->batch.dt = given->dt;
  b->batch.id = p->id;
  b->batch.lookup = NULL;
  take(b->F, b->ld, given->F, p, 9);
  take(b->F_inc, b->ld, given->F_inc, p, 9);
  take(b->stress, b->ld, given->stress, p, 6);
  if (p->material->state_count) take(b->state, b->ld, given->state, p, p->material->state_count);
  memset(b->position, 0, (size_t)(FULL * b->ld) * sizeof(double));
  if (given->position) take(b->position, b->ld, given->position, p, FULL);
  if (given->L && given->dt > 0.0) take(b->L, b->ld, given->L, p, 9);
  for (int32_t e = 0; e < 9 && !given->L && given->dt > 0.0; ++e)
    for (int64_t i = 0; i < p->n; ++i)
      b->L[e * b->ld + i] = (b->F_inc[e * b->ld + i] - (e % 4 ? 0.0 : 1.0)) / given->dt;
  for (int32_t e = 0; e < 9 && given->dt == 0.0; ++e)
    for (int64_t i = 0; i < p->n; ++i) b->F_inc[e * b->ld + i] = e % 4 ? 0.0 : 1.0;
  for (int64_t i = 0; i < b->batch.n; ++i) {
    p->id[i] = i < p->n ? id_of(given, p->begin + i) : -1;
    if (p->id[i] < 0) make_inert(p, i);
  }
}

/* A law of the host need not know its energy. */
static int32_t has_energy(const mpmi_portion *p, int64_t i) {
  const double energy = p->law.energy[i];
  return isfinite(energy) || (isnan(energy) && !p->material->law);
}

static mpm_status find_fault(const mpmi_portion *p) {
  const mpmi_law_batch *b = &p->law;
  for (int64_t i = 0; i < p->n; ++i) {
    if (p->id[i] < 0) continue;
    if (!finite_item(b->stress_new, 6, b->ld, i) || !finite_item(b->wave_speed, 1, b->ld, i) ||
        !finite_item(b->viscosity, 1, b->ld, i) ||
        !finite_item(b->state_new, p->material->state_count, b->ld, i))
      return refuse(p->material, p->given, p->begin + i, MPM_NONFINITE,
                    "the material's stress, state or wave speed is not finite");
    if (!has_energy(p, i))
      return refuse(p->material, p->given, p->begin + i, MPM_NONFINITE,
                    "the material's energy is not finite");
  }
  return MPM_OK;
}

static mpm_status find_fault_of_tangent(const mpmi_portion *p) {
  for (int64_t i = 0; i < p->n; ++i)
    if (p->id[i] >= 0 && !finite_item(p->tangent, TANGENT_ROWS, p->law.ld, i))
      return refuse(p->material, p->given, p->begin + i, MPM_NONFINITE,
                    "the material's tangent is not finite");
  return MPM_OK;
}

static mpm_status refuse_law(const mpmi_portion *p, mpm_status status) {
  const mpmi_law_fault *fault = &p->law.fault;
  mpm_context *context = p->material->context;
  if (fault->cause)
    return mpmi_fail(context, fault->cause, "mpm_material_update: %s at id %lld", fault->what,
                     (long long)fault->particle);
  const long long first = (long long)p->begin, last = (long long)(p->begin + p->n - 1);
  if (status > 0)
    return mpmi_fail(
        context, MPM_CUT_DT,
        "mpm_material_update: the law returned %d for items %lld to %lld and asks for a smaller dt", status,
        first, last);
  return mpmi_fail(context, MPM_E_CALLBACK, "mpm_material_update: the law returned %d for items %lld to %lld",
                   status, first, last);
}

static mpm_status run(mpmi_portion *p, double *tangent, int32_t *symmetric) {
  load(p);
  mpm_status status = mpmi_law_batch_run(&p->law, p->material, FULL);
  if (status) return refuse_law(p, status);
  if ((status = find_fault(p))) return status;
  if (tangent) {
    status =
        mpmi_material_tangent(p->material, FULL, &p->law.batch, p->tangent_scratch, p->tangent, symmetric);
    if (status) return refuse_law(p, status);
    if ((status = find_fault_of_tangent(p))) return status;
    give(p->tangent, p->law.ld, tangent, p, TANGENT_ROWS);
  }
  const mpm_material_batch *to = p->given;
  give(p->law.stress_new, p->law.ld, to->stress_new, p, 6);
  give(p->law.state_new, p->law.ld, to->state_new, p, p->material->state_count);
  give(p->law.wave_speed, p->law.ld, to->wave_speed, p, 1);
  give(p->law.viscosity, p->law.ld, to->kinematic_viscosity, p, 1);
  give(p->law.energy, p->law.ld, to->energy, p, 1);
  return MPM_OK;
}

/* ---- all of them -------------------------------------------------------------------------------------- */
static size_t bytes_of_ids(int64_t ld) {
  return mpmi_bytes(ld, sizeof(int64_t));
}

static mpm_status run_all(const mpm_material *material, const mpm_material_batch *batch, double *tangent,
                          int32_t *symmetric) {
  mpm_context *context = material->context;
  const int64_t ld = mpmi_law_batch_length(material);
  const size_t buffers = mpmi_law_batch_bytes(material), ids = bytes_of_ids(ld);
  const size_t rows = tangent ? mpmi_bytes(TANGENT_ROWS * ld, sizeof(double)) : 0;
  const size_t scratch = tangent ? mpmi_material_tangent_scratch(material, ld) : 0;
  const size_t bytes = buffers + ids + rows + scratch;
  char *memory = mpmi_alloc(context, bytes);
  if (!memory) return MPM_E_NOMEM;
  mpmi_portion p = {.material = material, .given = batch};
  p.law.F = (double *)(void *)memory;
  p.id = (int64_t *)(void *)(memory + buffers);
  p.tangent = tangent ? (double *)(void *)(memory + buffers + ids) : NULL;
  p.tangent_scratch = memory + buffers + ids + rows;
  mpm_status status = MPM_OK;
  for (p.begin = 0; p.begin < batch->n && !status; p.begin += ld) {
    p.n = batch->n - p.begin < ld ? batch->n - p.begin : ld;
    status = run(&p, tangent, symmetric);
  }
  mpmi_free(context, memory, bytes);
  return status;
}

mpm_status mpm_material_update(const mpm_material *material, const mpm_material_batch *batch, double *tangent,
                               int32_t *symmetric) {
  MPMI_ENTER(material, MPMI_MATERIAL);
  mpm_material_batch given;
  mpm_status status = mpmi_read_struct(material->context, "mpm_material_batch", batch, sizeof given, &given);
  if (!status) status = check_batch(material, &given, tangent);
  if (!status) status = check_items(material, &given);
  if (status) return status;
  int32_t is_symmetric = 1;
  status = run_all(material, &given, tangent, &is_symmetric);
  if (!status && tangent && symmetric) *symmetric = is_symmetric;
  return status;
}
