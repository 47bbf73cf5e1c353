/* Strain: deformation gradient, volume and stress of particles from the velocity gradient that a batch has
 * gathered, MPoint theory eqs 38 to 40; and what the step sums up over particles. */
#ifndef MPMI_STRAIN_H
#define MPMI_STRAIN_H

#include "stages/batch.h"

void mpmi_strain_bind(mpmi_batch *b);
void mpmi_strain_enter(mpmi_batch *b);
/* Keeps the gradient of the batch: what an affine transfer carries comes with the velocities, in the pass
 * that moves; otherwise that of the strain is kept where the host wants it. */
void mpmi_gradient_keep(mpmi_batch *b);
/* New deformation gradient and volume; 0 where they are no state that a law can be asked about. */
int32_t mpmi_strain_deform(mpmi_batch *b);
/* The law at that; b->law_ran tells whether it has answered. */
void mpmi_strain_law(mpmi_batch *b);

/* Where the law runs before the particles move, the sums over the motion want its wave speed: it is left in
 * the member's row meanwhile. */
void mpmi_wave_speed_leave(const mpmi_batch *b);
void mpmi_wave_speed_fetch(mpmi_batch *b);

/* Adds energies, momenta and rates of the batch to those of its block; what:
 * MPMI_SUMS_LAW, MPMI_SUMS_MOTION. */
void mpmi_batch_sums(mpmi_batch *b, int32_t what);

/* Volumes, of which there is one copy, by a copy of F: after a step that failed, and where the host looks on
 * in between. */
void mpmi_make_volumes(const mpmi_layout *layout, const mpmi_settings *settings, int32_t copy);

#endif
