/* Unknowns of an implicit step: nodes that are active, the rows that they move with, who holds them. All of
 * it is frozen during the step. */
#ifndef MPMI_UNKNOWNS_H
#define MPMI_UNKNOWNS_H

#include "implicit/balance.h"

/* From the masses of the nodes and the external forces, whose fourth value tells the nodes that have
 * stiffness. */
mpm_status mpmi_unknowns_find(mpmi_balance *s);
/* Sums of nodal forces over the nodes that move with each row. */
void mpmi_unknowns_fold(const mpmi_balance *s, const mpmi_nodal *forces, double *vector);

#endif
