/* Materials: one constitutive law with its parameters, built in or the host's.
 *
 * Built-in laws are kernels: plain loops over the component arrays of an mpm_material_batch, compiled once
 * for each instruction set, of type mpmi_law_fn. Batch lengths are multiples of 16 and every array is 64-byte
 * aligned. */
#ifndef MPMI_MATERIAL_H
#define MPMI_MATERIAL_H

#include "context/context.h"
#include "material/deformation.h"

enum {
  MPMI_LAW_NEO_HOOKEAN,
  MPMI_LAW_LINEAR_ELASTIC,
  MPMI_LAW_J2,
  MPMI_LAW_NEO_HOOKEAN_DECOUPLED,
  MPMI_LAW_NEWTONIAN_FLUID,
  MPMI_LAW_RIGID,
  MPMI_LAW_COUNT,
  MPMI_LAW_CUSTOM = MPMI_LAW_COUNT
};
enum { MPMI_MAX_PARAMS = 8, MPMI_MAX_CONSTANTS = 16 };

/* Evaluates a built-in law on batch->n particles (a multiple of 16). constants: made by the law's prepare
 * function. dim tells which entries of the full tensors can be anything but those of the identity, so that
 * 1-D and 2-D need not pay for 3-D; stress_new has all six rows written for the components that exist in
 * `dim` (xx yy zz; xy in 2-D; yz xz in 3-D), others are left alone. */
typedef void (*mpmi_law_fn)(const double *constants, int32_t dim, const mpm_material_batch *batch);

/* The tangent of a built-in law at a batch whose law has just run, as mpmi_material_tangent() writes it. */
typedef void (*mpmi_tangent_fn)(const double *constants, int32_t dim, const mpm_material_batch *batch,
                                double *tangent);

typedef struct mpmi_law_param {
  const char *name, *unit, *text;
  double value, low, high; /* default (NaN: must be given); inclusive range */
  const char *range;       /* the same in words */
  int32_t whole;           /* 1: whole numbers only */
} mpmi_law_param;

typedef struct mpmi_law {
  const char *name;
  int32_t index; /* MPMI_LAW_... */
  int32_t state_count;
  int32_t stress_from_F; /* 1: hyperelastic, fluid, rigid; 0: hypoelastic, the host may set the stress */
  int32_t kinematics;    /* MPMI_F_... */
  int32_t param_count;
  mpmi_law_param param[MPMI_MAX_PARAMS];
  /* Derived constants for the kernel from the parameter values, where it has any. */
  void (*prepare)(const double *value, double *constants);
} mpmi_law;

struct mpm_material {
  uint32_t magic;
  int32_t users; /* sets */
  mpm_context *context;
  const mpmi_law *law; /* NULL: the host's */
  double value[MPMI_MAX_PARAMS], constants[MPMI_MAX_CONSTANTS];
  double density;
  int32_t state_count;
  double *state_initial;    /* [state_count], or NULL: zeros */
  mpm_material_desc custom; /* the host's callbacks */
};

const mpmi_law *mpmi_law_by_index(int32_t index);
/* The law's kernel for an instruction set. */
mpmi_law_fn mpmi_law_kernel(int32_t isa, int32_t law);
mpmi_tangent_fn mpmi_tangent_kernel(int32_t isa, int32_t law);
/* Runs a material's law, built in or the host's, on a batch. Callback statuses pass through unchanged. */
mpm_status mpmi_material_evaluate(const mpm_material *material, int32_t isa, int32_t dim,
                                  const mpm_material_batch *batch);
/* 1 when stress follows from F, and from the step where the law is viscous. */
int32_t mpmi_material_stress_from_F(const mpm_material *material);
int32_t mpmi_material_kinematics(const mpm_material *material);

/* Tangent of a material on a batch whose law has just run (outputs in place): c_ijkl of mpm_tangent_fn: with
 * tau = J sigma and dF = L F:  c_ijkl = d tau_ij / d L_kl - delta_ik tau_jl - delta_jk tau_il,
 * [81][batch->ld], component 9 * (3 * i + j) + 3 * k + l. Only components with i, j, k, l < dim are written;
 * others are left alone. It is the derivative of the step as the law computes it: F = F_inc F_old, with
 * F_old, old stress and state fixed. batch->dt > 0. Inert slots of a host's law get zeros. scratch:
 * mpmi_material_tangent_scratch(material, batch->ld) bytes, 64-byte aligned. *symmetric is set to 0 where c
 * has no major symmetry, else left alone. Callback statuses pass through. */
size_t mpmi_material_tangent_scratch(const mpm_material *material, int64_t ld);
mpm_status mpmi_material_tangent(const mpm_material *material, int32_t isa, int32_t dim,
                                 const mpm_material_batch *batch, void *scratch, double *tangent,
                                 int32_t *symmetric);

#endif
