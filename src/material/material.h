/* Materials: one constitutive law with its parameters, built in or the host's. */
#ifndef MPMI_MATERIAL_H
#define MPMI_MATERIAL_H

#include "context/context.h"
#include "material/law.h"

struct mpm_material {
  uint32_t magic;
  int32_t users; /* sets of particles that have this material */
  mpm_context *context;
  const mpmi_law *law;   /* with the kernels of the context's instruction set; NULL: the law is the host's */
  const double *value;   /* parameters of a built-in law */
  const void *constants; /* what the law has made of them */
  double density;
  int32_t state_count;
  const double *state_initial; /* [state_count], or NULL: zeros */
  mpm_material_desc custom;    /* the host's callbacks */
  size_t size;                 /* of the whole allocation, `memory` included */
  double memory[];             /* values, constants, initial state; or the host's initial state */
};

/* Runs a material's law, built in or the host's, on a batch. Callback statuses pass through unchanged. */
mpm_status mpmi_material_evaluate(const mpm_material *material, int32_t dim, const mpm_material_batch *batch);
/* Does so in 2-D, with a law that looks at F alone, on a batch whose F has the rows that a set stores. In 1-D
 * and 3-D those are the rows of a batch. */
void mpmi_material_evaluate_stored(const mpm_material *material, const mpm_material_batch *batch);
/* 0 when the law never writes a kinematic viscosity. */
int32_t mpmi_may_be_viscous(const mpm_material *material);
/* 1 when stress follows from F, and from the step where the law is viscous. */
int32_t mpmi_material_stress_from_F(const mpm_material *material);
/* 1 when the mean stress follows from F and the deviator is the state. */
int32_t mpmi_material_mean_from_F(const mpm_material *material);
int32_t mpmi_material_kinematics(const mpm_material *material);
/* 1 when shear makes pressure: the mean stress is no function of the dilation alone. */
int32_t mpmi_material_pressure_from_shear(const mpm_material *material);

/* Tangent of a material on a batch whose law has just run (outputs in place): c_ijkl of mpm_tangent_fn: with
 * tau = J sigma and dF = L F:  c_ijkl = d tau_ij / d L_kl - delta_ik tau_jl - delta_jk tau_il,
 * [81][batch->ld], component 9 * (3 * i + j) + 3 * k + l. Only components with i, j, k, l < dim are written;
 * others are left alone. It is the derivative of the step as the law computes it: F = F_inc F_old, with
 * F_old, old stress and state fixed. batch->dt > 0. Inert slots of a host's law get zeros. scratch:
 * mpmi_material_tangent_scratch(material, batch->ld) bytes, 64-byte aligned. *symmetric is set to 0 where c
 * has no major symmetry, else left alone. Callback statuses pass through. */
size_t mpmi_material_tangent_scratch(const mpm_material *material, int64_t ld);
mpm_status mpmi_material_tangent(const mpm_material *material, int32_t dim, const mpm_material_batch *batch,
                                 void *scratch, double *tangent, int32_t *symmetric);

#endif
