/* Tangents of materials: the kernels of built-in laws; the host's callback in both of its forms; or
 * differences of the host's law. */
#include <math.h>
#include <string.h>

#include "material/material.h"
#include "simd/tensor.h"

enum { STRESS_ROWS = 6, F_ROWS = 9 };
/* Rows of a batch that differs in F, F_inc and L and has outputs of its own; then tau at one side of the
 * difference. */
enum { DIFFERENCE_ROWS = 3 * F_ROWS + STRESS_ROWS + 3 + STRESS_ROWS };

/* A power of two near the cube root of the rounding unit, where truncation and rounding weigh alike. */
static const double step = 0x1p-17;

size_t mpmi_material_tangent_scratch(const mpm_material *material, int64_t ld) {
  if (material->law) return 0;
  const mpm_material_desc *custom = &material->custom;
  const int32_t rows = custom->tangent ? custom->tangent_form : DIFFERENCE_ROWS + material->state_count;
  return mpmi_bytes(rows * ld, sizeof(double));
}

static double *row_of(double *tangent, int64_t ld, int i, int j, int k, int l) {
  return tangent + (9 * (3 * i + j) + 3 * k + l) * ld;
}

/* ---- the host's callback ------------------------------------------------------------------------------- */
/* Inert slots get zeros: what the host made of them must not get into sums. */
static void take_row(const mpm_material_batch *batch, const double *from, double *row) {
  for (int64_t p = 0; p < batch->n; ++p) row[p] = batch->id[p] < 0 ? 0.0 : from[p];
}

/* Columns for engineering shear are those of c: the two of c_ijkl L_kl + c_ijlk L_lk share one of 2 D_kl. */
static mpm_status call_tangent(const mpm_material *material, int32_t dim, const mpm_material_batch *batch,
                               double *given, double *tangent, int32_t *symmetric) {
  const mpm_material_desc *custom = &material->custom;
  int32_t is_symmetric = 0;
  const mpm_status status = mpmi_from_host(custom->tangent(custom->user, batch, given, &is_symmetric));
  if (status) return status;
  if (!is_symmetric) *symmetric = 0;
  const int32_t general = custom->tangent_form == MPM_TANGENT_GENERAL;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) {
          const int from =
              general ? 9 * (3 * i + j) + 3 * k + l : 6 * mpmi_sym_index(i, j) + mpmi_sym_index(k, l);
          take_row(batch, given + from * batch->ld, row_of(tangent, batch->ld, i, j, k, l));
        }
  return MPM_OK;
}

/* ---- differences of the host's law --------------------------------------------------------------------- */
typedef struct varied {
  double *F, *F_inc, *L, *tau;
  mpm_material_batch batch;
} varied;

static void bind(varied *v, const mpm_material_batch *batch, double *at) {
  const int64_t ld = batch->ld;
  v->batch = *batch;
  v->batch.F = v->F = at, at += F_ROWS * ld;
  v->batch.F_inc = v->F_inc = at, at += F_ROWS * ld;
  v->batch.L = v->L = at, at += F_ROWS * ld;
  v->tau = at, at += STRESS_ROWS * ld;
  v->batch.stress_new = at, at += STRESS_ROWS * ld;
  v->batch.wave_speed = at, at += ld;
  v->batch.kinematic_viscosity = at, at += ld;
  v->batch.energy = at, at += ld;
  v->batch.state_new = at;
}

/* to = from, with `factor` times row l of `of` added to row k. */
static void add_row(double *to, const double *from, const double *of, double factor, int k, int l,
                    const mpm_material_batch *batch) {
  const int64_t ld = batch->ld;
  for (int c = 0; c < F_ROWS; ++c) memcpy(to + c * ld, from + c * ld, (size_t)batch->n * sizeof *to);
  for (int c = 0; c < 3; ++c)
    for (int64_t p = 0; p < batch->n; ++p) to[(3 * k + c) * ld + p] += factor * of[(3 * l + c) * ld + p];
}

static double jacobian(const double *F, int64_t ld, int64_t p) {
  return 1.0 + mpmi_J_minus_1(3, mpmi_load_F_minus_1(3, F, ld, p));
}

/* Runs the law on the batch with F, F_inc and L changed as by dF = e E_kl F, where E_kl has a 1 at kl and
 * else zeros. */
static mpm_status run_varied(const mpm_material *material, const mpm_material_batch *batch, varied *v, int k,
                             int l, double e) {
  add_row(v->F, batch->F, batch->F, e, k, l, batch);
  add_row(v->F_inc, batch->F_inc, batch->F_inc, e, k, l, batch);
  add_row(v->L, batch->L, batch->F_inc, e / batch->dt, k, l, batch);
  for (int64_t p = 0; p < batch->n; ++p) {
    v->batch.kinematic_viscosity[p] = 0.0;
    v->batch.energy[p] = (double)NAN;
  }
  return mpmi_from_host(material->custom.stress(material->custom.user, &v->batch));
}

/* c_ijkl of one kl, from tau with L_kl = step (in v->tau) and -step (what the law has just computed). */
static void difference(const varied *v, int32_t dim, const mpm_material_batch *batch, int k, int l,
                       double *tangent) {
  const int64_t ld = batch->ld;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      const int ij = mpmi_sym_index(i, j);
      const double *jl = batch->stress_new + mpmi_sym_index(j, l) * ld, *up = v->tau + ij * ld;
      const double *il = batch->stress_new + mpmi_sym_index(i, l) * ld;
      const double *low = v->batch.stress_new + ij * ld;
      double *row = row_of(tangent, ld, i, j, k, l);
      for (int64_t p = 0; p < batch->n; ++p) {
        double turned = (i == k ? jl[p] : 0.0) + (j == k ? il[p] : 0.0);
        double slope = (up[p] - jacobian(v->F, ld, p) * low[p]) / (2.0 * step);
        row[p] = batch->id[p] < 0 ? 0.0 : slope - jacobian(batch->F, ld, p) * turned;
      }
    }
}

static mpm_status difference_law(const mpm_material *material, int32_t dim, const mpm_material_batch *batch,
                                 double *scratch, double *tangent) {
  varied v;
  bind(&v, batch, scratch);
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l) {
      mpm_status status = run_varied(material, batch, &v, k, l, step);
      if (status) return status;
      for (int c = 0; c < STRESS_ROWS; ++c)
        for (int64_t p = 0; p < batch->n; ++p)
          v.tau[c * batch->ld + p] = jacobian(v.F, batch->ld, p) * v.batch.stress_new[c * batch->ld + p];
      status = run_varied(material, batch, &v, k, l, -step);
      if (status) return status;
      difference(&v, dim, batch, k, l, tangent);
    }
  return MPM_OK;
}

/* ---- all materials ------------------------------------------------------------------------------------- */
mpm_status mpmi_material_tangent(const mpm_material *material, int32_t dim, const mpm_material_batch *batch,
                                 void *scratch, double *tangent, int32_t *symmetric) {
  if (material->law) {
    material->law->tangent(material->constants, dim, batch, tangent);
    if (dim > 1 && !material->law->is_symmetric(material->constants)) *symmetric = 0;
    return MPM_OK;
  }
  if (material->custom.tangent) return call_tangent(material, dim, batch, scratch, tangent, symmetric);
  *symmetric = 0;
  return difference_law(material, dim, batch, scratch, tangent);
}
