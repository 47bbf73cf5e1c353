/* The description of a stepper: its defaults, and what it may ask for. */
#ifndef MPMI_DESCRIPTION_H
#define MPMI_DESCRIPTION_H

#include "grid/grid.h"

/* The host's description, or the defaults for NULL, checked for a grid. */
mpm_status mpmi_description_read(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *desc,
                                 mpm_stepper_desc *out);

#endif
