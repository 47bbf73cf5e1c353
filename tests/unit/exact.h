/* Parts of test_exact.c. */
#ifndef EXACT_H
#define EXACT_H

#include "world.h"

TCase *basis_case(void);
TCase *clusters_case(void);
TCase *kernels_case(void);
TCase *conservation_case(void);
TCase *patch_case(void);
TCase *rotation_case(void);
TCase *weights_case(void);

#endif
