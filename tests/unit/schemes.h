/* Parts of test_schemes.c. */
#ifndef SCHEMES_H
#define SCHEMES_H

#include "world.h"

TCase *schemes_options_case(void);
TCase *schemes_flight_case(void);
TCase *schemes_lattices_case(void);

#endif
