/* Energies, momenta and rates of the present state. After a step they are there; after the host has changed
 * something, or before the first step, the particles are asked. */
#ifndef MPMI_STATE_SUMS_H
#define MPMI_STATE_SUMS_H

#include "stepper/stepper.h"

/* Brings the sums of the history up to date; failure takes the refusal of a law, and may be NULL. */
mpm_status mpmi_state_sums(mpm_stepper *s, mpmi_failure *failure);
/* The sums over the blocks of a step, in the order of the blocks. */
mpmi_sums mpmi_block_sums(const mpmi_step *step);
/* The largest stable step: Courant's condition and that of viscosity. */
double mpmi_stable_dt(const mpmi_sums *sums);
/* MPM_E_STATE when a set has views out of the given access, or holds bad values. */
mpm_status mpmi_check_sets(mpm_stepper *s, int32_t access);

#endif
