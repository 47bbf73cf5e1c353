/* Bits that kernels return for a batch of particles when one of them deserves a look: it has left its bounds
 * or the grid, or a value is not finite, or a volume is not positive. */
#ifndef MPMI_FLAGS_H
#define MPMI_FLAGS_H

#include <stdint.h>

enum { MPMI_LEFT_BOUNDS = 1, MPMI_OUTSIDE = 2, MPMI_NONFINITE = 4, MPMI_NOT_POSITIVE = 8 };

#endif
