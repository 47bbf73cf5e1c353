/* What makes the present state of particles the one that their deformation starts from. */
#ifndef MPMI_REFERENCE_H
#define MPMI_REFERENCE_H

#include "particles/particles.h"

/* Writes F = I into the second copy of F. */
void mpmi_reference_begin(mpm_particles *set);
/* Refuses a law of the host that, asked about the stress in the second copy with F = I, does not answer with
 * it: MPM_E_UNSUPPORTED. */
mpm_status mpmi_reference_fits_host(mpm_particles *set);
/* Takes the F of the second copy for the first: cannot fail. Mass, present volume and the domain that the
 * basis sees stay; initial volume and edges follow. Dilation ratios start anew. */
void mpmi_reference_take(mpm_particles *set);

#endif
