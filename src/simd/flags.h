/* What kernels tell of a batch as a whole: that some particle deserves a look. */
#ifndef MPMI_FLAGS_H
#define MPMI_FLAGS_H

enum { MPMI_LEFT_TILE = 1, MPMI_OUTSIDE = 2, MPMI_NONFINITE = 4, MPMI_NOT_POSITIVE = 8 };

#endif
