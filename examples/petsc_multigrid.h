/* PETSc as the solver of MPM_SOLVER_HOST: multigrid by smoothed aggregation (GAMG), which is told the rigid
 * motions of a body, preconditions conjugate gradients, or GMRES where the matrix is not symmetric.
 *
 *   multigrid own = {.pattern_id = -1};
 *   multigrid_defaults() || PetscInitialize(&argc, &argv, NULL, NULL)
 *   mpm_stepper_set_linear_solver(stepper, multigrid_solve, &own)
 *   multigrid_forget(&own) || PetscFinalize()
 *
 * One multigrid serves one stepper, on the calling thread. Options of PETSc's command line hold, such as
 * -ksp_view or -pc_type ilu. */
#ifndef EXAMPLES_PETSC_MULTIGRID_H
#define EXAMPLES_PETSC_MULTIGRID_H

#include <mpm/mpm.h>
#include <petscksp.h>

/* Multigrid wants as many unknowns at each node as there are axes. Those that a symmetry plane
 * holds are not in the library's rows, and come back here as rows of the identity, as large as
 * the diagonal of their neighbours. */
typedef struct multigrid {
  int64_t pattern_id;
  PetscInt n;
  PetscInt *place;  /* of each of the library's rows among the n of A */
  PetscBool *found; /* whether the library has the row */
  PetscInt *column;
  PetscScalar *value;
  Mat A;
  Vec b, x;
  KSP ksp;
  int32_t patterns, solves;
} multigrid;

typedef struct lent {
  mpm_operator_info info;
  const int64_t *start;
  const int32_t *column;
  const double *value;
} lent;

/* Before PetscInitialize(). Splines overlap far: a sweep of Gauss-Seidel smooths what PETSc's usual smoother,
 * Chebyshev's over the diagonal, does not. An aggregate of few nodes does not have all rigid motions: the
 * shift is the diagonal of those that it lacks. */
static PetscErrorCode multigrid_defaults(void) {
  static const char *const options[][2] = {{"-mg_levels_pc_type", "sor"},
                                           {"-mg_levels_ksp_type", "richardson"},
                                           {"-mg_levels_ksp_max_it", "1"},
                                           {"-mg_levels_pc_sor_diagonal_shift", "1e-12"}};
  PetscErrorCode failed = 0;
  for (size_t i = 0; i < sizeof options / sizeof *options && !failed; ++i)
    failed = PetscOptionsSetValue(NULL, options[i][0], options[i][1]);
  return failed;
}

static PetscInt length_of(const lent *l, int64_t row) {
  return (PetscInt)(l->start[row + 1] - l->start[row]);
}

static PetscErrorCode multigrid_forget(multigrid *m) {
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&m->ksp));
  PetscCall(MatDestroy(&m->A));
  PetscCall(VecDestroy(&m->b));
  PetscCall(VecDestroy(&m->x));
  PetscCall(PetscFree4(m->place, m->found, m->column, m->value));
  m->pattern_id = -1;
  PetscFunctionReturn(0);
}

/* Rows of one node follow each other. */
static PetscErrorCode number(multigrid *m, const lent *l) {
  const mpm_operator_info *info = &l->info;
  PetscInt nodes = 0, longest = 0;
  PetscFunctionBeginUser;
  for (int64_t r = 0; r < info->rows; ++r) longest = PetscMax(longest, length_of(l, r));
  PetscCall(PetscMalloc4((size_t)info->rows, &m->place, (size_t)(info->rows * info->block), &m->found,
                         longest, &m->column, longest, &m->value));
  for (int64_t r = 0; r < info->rows; ++r) {
    nodes += r == 0 || info->node[r] != info->node[r - 1];
    m->place[r] = (nodes - 1) * info->block + info->component[r];
  }
  m->n = nodes * info->block;
  for (PetscInt i = 0; i < m->n; ++i) m->found[i] = PETSC_FALSE;
  for (int64_t r = 0; r < info->rows; ++r) m->found[m->place[r]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode make_matrix(multigrid *m, const lent *l) {
  PetscInt *entries;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->n, &entries));
  for (PetscInt i = 0; i < m->n; ++i) entries[i] = 1;
  for (int64_t r = 0; r < l->info.rows; ++r) entries[m->place[r]] = length_of(l, r);
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, m->n, m->n, 0, entries, &m->A));
  PetscCall(MatSetBlockSize(m->A, l->info.block));
  PetscCall(MatCreateVecs(m->A, &m->x, &m->b));
  PetscCall(PetscFree(entries));
  PetscFunctionReturn(0);
}

static PetscErrorCode tell_rigid_motions(const multigrid *m, const mpm_operator_info *info) {
  MatNullSpace motions;
  Vec where;
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(m->x, &where));
  PetscCall(VecGetArray(where, &x));
  for (int64_t r = 0; r < info->rows; ++r)
    for (PetscInt c = 0; c < info->block; ++c)
      x[m->place[r] - info->component[r] + c] = info->position[c * info->ld + r];
  PetscCall(VecRestoreArray(where, &x));
  PetscCall(MatNullSpaceCreateRigidBody(where, &motions));
  PetscCall(MatSetNearNullSpace(m->A, motions));
  PetscCall(MatNullSpaceDestroy(&motions));
  PetscCall(VecDestroy(&where));
  PetscFunctionReturn(0);
}

/* The library's tolerance is on the residual itself, so the preconditioner must not enter its norm. */
static PetscErrorCode make_solver(multigrid *m, const mpm_operator_info *info) {
  const int by_cg = info->symmetric && info->positive_definite;
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(KSPCreate(PETSC_COMM_SELF, &m->ksp));
  PetscCall(KSPSetOperators(m->ksp, m->A, m->A));
  PetscCall(KSPSetType(m->ksp, by_cg ? KSPCG : KSPGMRES));
  if (!by_cg) PetscCall(KSPSetPCSide(m->ksp, PC_RIGHT));
  PetscCall(KSPSetNormType(m->ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetInitialGuessNonzero(m->ksp, PETSC_TRUE));
  PetscCall(KSPGetPC(m->ksp, &pc));
  PetscCall(PCSetType(pc, PCGAMG));
  PetscCall(PCGAMGSetReuseInterpolation(pc, PETSC_TRUE)); /* while the pattern lasts */
  PetscCall(KSPSetFromOptions(m->ksp));
  PetscFunctionReturn(0);
}

static PetscErrorCode prepare(multigrid *m, const lent *l) {
  PetscFunctionBeginUser;
  PetscCall(multigrid_forget(m));
  PetscCall(number(m, l));
  PetscCall(make_matrix(m, l));
  PetscCall(tell_rigid_motions(m, &l->info));
  PetscCall(make_solver(m, &l->info));
  m->pattern_id = l->info.pattern_id;
  ++m->patterns;
  PetscFunctionReturn(0);
}

static PetscErrorCode set_values(const multigrid *m, const lent *l) {
  const PetscInt block = l->info.block;
  PetscFunctionBeginUser;
  for (int64_t r = 0; r < l->info.rows; ++r) {
    const PetscInt row = m->place[r], n = length_of(l, r);
    PetscScalar diagonal = 1.0;
    for (PetscInt k = 0; k < n; ++k) {
      m->column[k] = m->place[l->column[l->start[r] + k]];
      m->value[k] = l->value[l->start[r] + k];
      if (m->column[k] == row) diagonal = m->value[k];
    }
    PetscCall(MatSetValues(m->A, 1, &row, n, m->column, m->value, INSERT_VALUES));
    for (PetscInt i = row / block * block; i < (row / block + 1) * block; ++i)
      if (!m->found[i]) PetscCall(MatSetValue(m->A, i, i, diagonal, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(m->A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(m->A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

static PetscErrorCode set_vector(const multigrid *m, int64_t rows, const double *from, Vec to) {
  PetscScalar *v;
  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(to));
  PetscCall(VecGetArray(to, &v));
  for (int64_t r = 0; r < rows; ++r) v[m->place[r]] = from[r];
  PetscCall(VecRestoreArray(to, &v));
  PetscFunctionReturn(0);
}

static PetscErrorCode solve_system(multigrid *m, const lent *l, const double *rhs, double *solution,
                                   double tolerance, int64_t *iterations, KSPConvergedReason *reason) {
  const PetscScalar *x;
  PetscInt count;
  PetscFunctionBeginUser;
  if (m->pattern_id != l->info.pattern_id) PetscCall(prepare(m, l));
  PetscCall(set_values(m, l));
  PetscCall(set_vector(m, l->info.rows, rhs, m->b));
  PetscCall(set_vector(m, l->info.rows, solution, m->x));
  PetscCall(KSPSetTolerances(m->ksp, tolerance, 0.0, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(KSPSolve(m->ksp, m->b, m->x));
  PetscCall(KSPGetConvergedReason(m->ksp, reason));
  PetscCall(KSPGetIterationNumber(m->ksp, &count));
  PetscCall(VecGetArrayRead(m->x, &x));
  for (int64_t r = 0; r < l->info.rows; ++r) solution[r] = x[m->place[r]];
  PetscCall(VecRestoreArrayRead(m->x, &x));
  *iterations = count;
  ++m->solves;
  PetscFunctionReturn(0);
}

static mpm_status multigrid_solve(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                                  double tolerance, int64_t *iterations) {
  lent l = {.info = {.struct_size = sizeof l.info}};
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  if (mpm_operator_get_info(matrix, &l.info) || mpm_operator_csr(matrix, &l.start, &l.column, &l.value))
    return -1;
  if (l.info.rows * l.info.block > PETSC_MAX_INT || l.info.nonzeros > PETSC_MAX_INT) return -1;
  if (solve_system(user, &l, rhs, solution, tolerance, iterations, &reason)) return -1;
  return reason > 0 ? MPM_OK : 1; /* a shorter step may do */
}

#endif
