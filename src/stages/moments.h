/* Second moments of the basis at particles, for the affine part of the angular momentum. */
#ifndef MPMI_MOMENTS_H
#define MPMI_MOMENTS_H

#include "layout/settings.h"
#include "particles/particles.h"

/* Gives the job those of n particles from slot `begin`; copy: of their positions. buffer: [3][ld]. */
void mpmi_sums_moments(const mpmi_settings *settings, const mpm_particles *set, int32_t copy, int64_t begin,
                       int64_t n, int64_t ld, double *buffer, mpmi_sums_job *job);

#endif
