/* One solver and one matrix for each test of the methods of solution. */
#ifndef LINALG_FIXTURE_H
#define LINALG_FIXTURE_H

#include "linalg.h"

extern mpm_context *context; /* of two threads */
extern mpmi_solver *solver;
extern mpmi_matrix A;
extern mpmi_solve_report report; /* of the last solution */

void open_solver(void);
void close_solver(void);

#endif
