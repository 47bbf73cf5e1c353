/* What the files of the suite share. */
#ifndef DAMPING_H
#define DAMPING_H

#include <check.h>

/* Adds the cases of damping_contact.c. */
void add_damping_contact(Suite *suite);

#endif
