/* Rows of tangents c_ijkl, [81][ld], for a chunk of particles at a time: row 9 (3 i + j) + 3 k + l of those
 * that `dim` has. `tangent` points at the first particle of the chunk in row 0; other pointers are to values
 * of the chunk, component after component. */
#ifndef MPMI_TANGENT_ROWS_H
#define MPMI_TANGENT_ROWS_H

#include "simd/chunk.h"
#include "simd/tensor.h"

/* isotropic_rows writes volumetric d_ij d_kl + shear (d_ik d_jl + d_il d_jk); add_mixed_rows adds s_ij d_kl +
 * d_ij s_kl. */
void KERNEL(isotropic_rows)(int32_t dim, const double *volumetric, const double *shear, double *tangent,
                            int64_t ld);
void KERNEL(add_mixed_rows)(int32_t dim, const double (*s)[MPMI_CHUNK], double *tangent, int64_t ld);

#endif
