/* Forces and stiffness of the particles on the nodes, for implicit steps. */
#ifndef MPMI_ASSEMBLY_H
#define MPMI_ASSEMBLY_H

#include "implicit/balance.h"

/* External forces, whose fourth value tells the nodes that have stiffness. */
mpm_status mpmi_external_forces(mpmi_balance *s);
/* Stress of the displacements u, and the internal force that it makes. Fails as the law does. */
mpm_status mpmi_internal_forces(mpmi_balance *s, const double *u);
/* Stress of the displacements u, and the stiffness at them. */
mpm_status mpmi_stiffness(mpmi_balance *s, const double *u);

#endif
