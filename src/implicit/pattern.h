/* The pattern of the matrix: which rows couple. Nodes couple when a stencil holds both, or with the locking
 * remedy a cell; what its images and ghosts couple with is a row's too. */
#ifndef MPMI_PATTERN_H
#define MPMI_PATTERN_H

#include "implicit/balance.h"

/* Of the active nodes as they are numbered, with so many rows. */
mpm_status mpmi_make_pattern(mpmi_balance *s, int64_t rows);

#endif
