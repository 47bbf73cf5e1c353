#include "linalg_fixture.h"

mpm_context *context;
mpmi_solver *solver;
mpmi_matrix A;
mpmi_solve_report report;

void open_solver(void) {
  context = context_with(2, MPM_ISA_BEST, NULL);
  ck_ok(context, mpmi_solver_create(context, &solver));
  mpmi_matrix_init(&A, context);
}

void close_solver(void) {
  mpmi_matrix_free(&A);
  mpmi_solver_destroy(solver);
  ck_ok(context, mpm_context_destroy(context));
}
