/* G2P: the named passes from nodes to particles. */
#ifndef MPMI_G2P_H
#define MPMI_G2P_H

#include "stages/batch.h"

/* Velocity and position, deformation gradient and stress: all of USL. */
mpm_status mpmi_g2p_move_and_deform(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
/* Velocity and position alone. */
mpm_status mpmi_g2p_move(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
/* Deformation gradient and stress alone. */
mpm_status mpmi_g2p_deform(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
/* The nodes' vectors, interpolated, into the second copy of the particles' velocities; or of their
 * accelerations, of the sets that do not know them. */
mpm_status mpmi_g2p_velocities(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
mpm_status mpmi_g2p_accelerations(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);

#endif
