/* Outer rows, at the rims of bodies, that move with inner ones: extension.c finds them, condense.c takes them
 * out of the system. */
#ifndef MPMI_EXTENSION_H
#define MPMI_EXTENSION_H

#include "implicit/balance.h"

/* Finds outer rows among the numbered ones, and by which inner ones they move; tells whether that differs
 * from the step before. */
mpm_status mpmi_extension_find(mpmi_balance *balance, int64_t rows, int32_t *changed);
/* Returns where the terms of an outer row begin. */
static inline int64_t mpmi_first_term(const mpmi_newton *newton, int64_t outer) {
  return outer ? newton->outer[outer - 1].end : 0;
}

/* Returns 1 for rows that are outer, or move outer ones. */
static inline int32_t mpmi_is_extended(const mpmi_newton *newton, int64_t row) {
  return newton->outer_of[row] >= 0 || newton->led_start[row] < newton->led_start[row + 1];
}

/* ---- condense.c --------------------------------------------------------------------------------------- */
/* Lets the outer rows that may touch something be unknowns of their own in this step, and marks the others in
 * matrix.held (collective). */
mpm_status mpmi_condense_mark(mpmi_balance *balance);
/* Adds the entries of outer rows in a vector of forces to their inner rows, and clears them. */
void mpmi_condense_forces(const mpmi_balance *balance, double *vector);
/* Adds rows and columns of outer rows in the matrix to those of their inner rows: shares^T A shares. */
void mpmi_condense_matrix(mpmi_balance *balance);
/* Sets the entries of outer rows in a vector of displacements from those of their inner rows. */
void mpmi_condense_extend(const mpmi_balance *balance, double *vector);

#endif
