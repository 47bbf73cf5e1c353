/* Rows of tangents c_ijkl, [81][ld], worked out for 16 particles at a time: row 9 (3 i + j) + 3 k + l of
 * those that `dim` has. `tangent` points at the first of the 16 in row 0; other pointers are to values of 16
 * particles, component after component. */
#ifndef MPMI_TANGENT_ROWS_H
#define MPMI_TANGENT_ROWS_H

#include "simd/chunk.h"
#include "simd/tensor.h"

/* isotropic: volumetric d_ij d_kl + shear (d_ik d_jl + d_il d_jk). mixed: adds s_ij d_kl + d_ij s_kl. */
void KERNEL(isotropic_rows)(int32_t dim, const double *volumetric, const double *shear, double *tangent,
                            int64_t ld);
void KERNEL(add_mixed_rows)(int32_t dim, const double (*s)[MPMI_CHUNK], double *tangent, int64_t ld);

#endif
