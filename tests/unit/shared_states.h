/* States of one problem in several parts: test cases of the suite `shared`. */
#ifndef SHARED_STATES_H
#define SHARED_STATES_H

#include <check.h>

TCase *shared_states_case(Suite *suite);
TCase *shared_pieces_case(Suite *suite);

#endif
