/* What holds nodes in an implicit step: the residual of their balance is the force of the constraint. It is
 * recorded as the boundary stage does: to the host and to prescribed particles what acts on the components
 * that they hold, the rest of a tie to the wall that binds it. */
#ifndef MPMI_REACTIONS_H
#define MPMI_REACTIONS_H

#include "implicit/balance.h"

/* Impulses of what holds nodes; then the prescribed particles' share. */
mpm_status mpmi_record_reactions(mpmi_balance *s);

#endif
