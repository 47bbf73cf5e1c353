/* A linear system of libmpm becomes a matrix of PETSc, which solves it. */
#include <mpm/mpm_petsc.h>

#include <ctype.h>
#include <petscksp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PREFIX = 64, TEXT = 512 };

struct mpm_petsc {
  MPI_Comm comm;
  char prefix[PREFIX], text[TEXT];
  int told; /* the error under way has its sentence */
  mpm_petsc_info info;
  int64_t pattern_id; /* that the matrix has; -1: there is no matrix */
  int by_cg;          /* the solver is for symmetric positive definite matrices */
  /* Multigrid wants as many unknowns at each node as there are axes. Those that are held are not in the
   * library's rows, and come back as rows of the identity, as large as the diagonal beside them. */
  PetscInt block, n;     /* n: unknowns of this process */
  PetscInt *place;       /* of each of the library's owned rows among the n */
  PetscInt fills;        /* rows of the identity, whose entries follow those of the library */
  PetscInt *fill_beside; /* [fills] an owned row of the same node */
  PetscScalar *value;    /* of all entries */
  Mat A;
  Vec b, x;
  KSP ksp;
};

/* What the library lends. */
typedef struct lent {
  mpm_operator_info info;
  const int64_t *start;
  const int32_t *column;
  const double *value, *rhs;
  double *solution, tolerance;
} lent;

/* ---- failures ------------------------------------------------------------------------------------------ */
__attribute__((format(printf, 3, 4))) static mpm_status fail(mpm_petsc *m, mpm_status status,
                                                             const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(m->text, sizeof m->text, format, arguments);
  va_end(arguments);
  return status;
}

/* Stands in the place of PETSc's handler, which prints: keeps the first sentence of an error. */
static PetscErrorCode keep_error(MPI_Comm comm, int line, const char *function, const char *file,
                                 PetscErrorCode code, PetscErrorType type, const char *text, void *context) {
  mpm_petsc *m = context;
  (void)comm, (void)file, (void)type;
  if (!m->told)
    fail(m, MPM_E_CALLBACK, "PETSc: %s, line %d: error %d: %s", function ? function : "?", line, (int)code,
         text ? text : "");
  m->told = 1;
  return code;
}

static void begin(mpm_petsc *m) {
  m->told = 0;
  m->text[0] = '\0';
  (void)!PetscPushErrorHandler(keep_error, m);
}

static mpm_status end(mpm_petsc *m, PetscErrorCode code) {
  (void)!PetscPopErrorHandler();
  if (!code) return MPM_OK;
  if (!m->told) fail(m, MPM_E_CALLBACK, "PETSc: error %d", (int)code);
  return MPM_E_CALLBACK;
}

/* All processes have the lowest status of any. */
static mpm_status agree(mpm_petsc *m, mpm_status status) {
  int64_t lowest = status;
  if (MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT64_T, MPI_MIN, m->comm))
    return fail(m, MPM_E_CALLBACK, "MPI_Allreduce has failed");
  if (lowest && !status) fail(m, (mpm_status)lowest, "another process has failed: its sentence is there");
  return (mpm_status)lowest;
}

/* ---- structure ----------------------------------------------------------------------------------------- */
static PetscErrorCode forget(mpm_petsc *m) {
  PetscFunctionBeginUser;
  m->pattern_id = -1;
  PetscCall(KSPDestroy(&m->ksp));
  PetscCall(MatDestroy(&m->A));
  PetscCall(VecDestroy(&m->b));
  PetscCall(VecDestroy(&m->x));
  PetscCall(PetscFree3(m->place, m->fill_beside, m->value));
  PetscFunctionReturn(0);
}

/* Rows of one node follow each other, by ascending component. */
static int is_new_node(const mpm_operator_info *info, int64_t r) {
  return r == 0 || info->node[r] != info->node[r - 1] || info->component[r] <= info->component[r - 1];
}

static int64_t count_nodes(const mpm_operator_info *info) {
  int64_t nodes = 0;
  for (int64_t r = 0; r < info->owned_rows; ++r) nodes += is_new_node(info, r);
  return nodes;
}

static PetscErrorCode place_rows(mpm_petsc *m, const lent *l) {
  const mpm_operator_info *info = &l->info;
  const int64_t rows = info->owned_rows;
  PetscFunctionBeginUser;
  m->block = info->block;
  m->n = (PetscInt)count_nodes(info) * m->block;
  m->fills = m->n - (PetscInt)rows;
  PetscCall(PetscMalloc3((size_t)rows + 1, &m->place, (size_t)m->fills + 1, &m->fill_beside,
                         (size_t)info->nonzeros + (size_t)m->fills + 1, &m->value));
  PetscInt node = -m->block;
  for (int64_t r = 0; r < rows; ++r) {
    if (is_new_node(info, r)) node += m->block;
    m->place[r] = node + info->component[r];
  }
  PetscFunctionReturn(0);
}

/* Finds the columns of A behind the library's columns: owned ones from `first` on, others as their owners
 * say. */
static PetscErrorCode find_columns(const mpm_petsc *m, const mpm_operator_info *info, PetscInt first,
                                   PetscInt *column) {
  const PetscInt own = (PetscInt)info->owned_rows, others = (PetscInt)(info->rows - info->owned_rows);
  Vec numbers, wanted;
  VecScatter bring;
  IS rows;
  PetscScalar *number;
  const PetscScalar *brought;
  PetscInt *index, low;
  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(m->comm, own, PETSC_DETERMINE, &numbers));
  PetscCall(VecGetOwnershipRange(numbers, &low, NULL));
  PetscCheck(low == (PetscInt)info->first_row, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "processes of the communicator are not in the order of the parts");
  PetscCall(VecGetArray(numbers, &number));
  for (PetscInt r = 0; r < own; ++r) {
    column[r] = first + m->place[r];
    number[r] = (PetscScalar)column[r];
  }
  PetscCall(VecRestoreArray(numbers, &number));
  PetscCall(PetscMalloc1(others, &index));
  for (PetscInt r = 0; r < others; ++r) index[r] = (PetscInt)info->number[own + r];
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, others, index, PETSC_OWN_POINTER, &rows));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, others, &wanted));
  PetscCall(VecScatterCreate(numbers, rows, wanted, NULL, &bring));
  PetscCall(VecScatterBegin(bring, numbers, wanted, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(bring, numbers, wanted, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArrayRead(wanted, &brought));
  for (PetscInt r = 0; r < others; ++r) column[own + r] = (PetscInt)PetscRealPart(brought[r]);
  PetscCall(VecRestoreArrayRead(wanted, &brought));
  PetscCall(VecScatterDestroy(&bring));
  PetscCall(ISDestroy(&rows));
  PetscCall(VecDestroy(&wanted));
  PetscCall(VecDestroy(&numbers));
  PetscFunctionReturn(0);
}

/* Lists the entries: those of the library in its order, then those of rows of the identity. */
static PetscErrorCode list_entries(mpm_petsc *m, const lent *l, PetscInt first, const PetscInt *column,
                                   PetscInt *row_of, PetscInt *column_of) {
  const mpm_operator_info *info = &l->info;
  PetscInt count = 0, fills = 0;
  PetscFunctionBeginUser;
  for (int64_t r = 0; r < info->owned_rows; ++r)
    for (int64_t e = l->start[r]; e < l->start[r + 1]; ++e) {
      row_of[count] = first + m->place[r];
      column_of[count++] = column[l->column[e]];
    }
  for (int64_t r = 0, next; r < info->owned_rows; r = next) {
    const PetscInt node = m->place[r] - info->component[r];
    PetscInt c = 0;
    for (next = r; next < info->owned_rows && (next == r || !is_new_node(info, next)); ++next, ++c)
      for (; c < info->component[next]; ++c)
        m->fill_beside[fills++] = (PetscInt)r, row_of[count++] = first + node + c;
    for (; c < m->block; ++c) m->fill_beside[fills++] = (PetscInt)r, row_of[count++] = first + node + c;
  }
  for (PetscInt k = count - fills; k < count; ++k) column_of[k] = row_of[k];
  PetscFunctionReturn(0);
}

static PetscErrorCode make_matrix(mpm_petsc *m, const lent *l) {
  const PetscInt entries = (PetscInt)l->info.nonzeros + m->fills;
  PetscInt *column, *row_of, *column_of, first, all;
  PetscLayout rows;
  PetscFunctionBeginUser;
  PetscCall(MatCreate(m->comm, &m->A));
  PetscCall(MatSetSizes(m->A, m->n, m->n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(m->A, m->block));
  PetscCall(MatSetOptionsPrefix(m->A, m->prefix));
  PetscCall(MatSetType(m->A, MATAIJ));
  PetscCall(MatSetFromOptions(m->A));
  PetscCall(MatGetLayouts(m->A, &rows, NULL));
  PetscCall(PetscLayoutSetUp(rows));
  PetscCall(PetscLayoutGetRange(rows, &first, NULL));
  PetscCall(PetscLayoutGetSize(rows, &all));
  m->info.unknowns = all;
  PetscCall(PetscMalloc3((size_t)l->info.rows + 1, &column, (size_t)entries + 1, &row_of, (size_t)entries + 1,
                         &column_of));
  PetscCall(find_columns(m, &l->info, first, column));
  PetscCall(list_entries(m, l, first, column, row_of, column_of));
  PetscCall(MatSetPreallocationCOO(m->A, entries, row_of, column_of));
  PetscCall(PetscFree3(column, row_of, column_of));
  PetscCall(MatCreateVecs(m->A, &m->x, &m->b));
  PetscFunctionReturn(0);
}

static PetscErrorCode tell_rigid_motions(const mpm_petsc *m, const mpm_operator_info *info) {
  MatNullSpace motions;
  Vec where;
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(m->x, &where));
  PetscCall(VecGetArray(where, &x));
  for (int64_t r = 0; r < info->owned_rows; ++r)
    for (PetscInt c = 0; c < m->block; ++c)
      x[m->place[r] - info->component[r] + c] = info->position[c * info->ld + r];
  PetscCall(VecRestoreArray(where, &x));
  PetscCall(MatNullSpaceCreateRigidBody(where, &motions));
  PetscCall(MatSetNearNullSpace(m->A, motions));
  PetscCall(MatNullSpaceDestroy(&motions));
  PetscCall(VecDestroy(&where));
  PetscFunctionReturn(0);
}

/* ---- the solver ---------------------------------------------------------------------------------------- */
/* The library's tolerance is on the residual itself, so the preconditioner must not enter its norm. */
static PetscErrorCode make_solver(mpm_petsc *m, int by_cg) {
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&m->ksp));
  PetscCall(KSPCreate(m->comm, &m->ksp));
  PetscCall(KSPSetOptionsPrefix(m->ksp, m->prefix));
  PetscCall(KSPSetOperators(m->ksp, m->A, m->A));
  PetscCall(KSPSetType(m->ksp, by_cg ? KSPCG : KSPGMRES));
  if (!by_cg) PetscCall(KSPSetPCSide(m->ksp, PC_RIGHT));
  PetscCall(KSPSetNormType(m->ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetInitialGuessNonzero(m->ksp, PETSC_TRUE));
  PetscCall(KSPGetPC(m->ksp, &pc));
  PetscCall(PCSetType(pc, PCGAMG));
  PetscCall(PCGAMGSetReuseInterpolation(pc, PETSC_TRUE)); /* while the pattern lasts */
  PetscCall(KSPSetFromOptions(m->ksp));
  PetscBool applies_only;
  PetscCall(PetscObjectTypeCompare((PetscObject)m->ksp, KSPPREONLY, &applies_only));
  if (applies_only) PetscCall(KSPSetInitialGuessNonzero(m->ksp, PETSC_FALSE)); /* it refuses another one */
  m->by_cg = by_cg;
  PetscFunctionReturn(0);
}

/* Splines overlap far, and PETSc's usual smoother, Chebyshev's over the diagonal, is weak there. Incomplete
 * factors, of the rows of each process with those beside them, smooth nearly alike on any number of them.
 * For conjugate gradients they must be symmetric: what processes find for the same row is added, and
 * Chebyshev's polynomial damps it; GMRES takes each row from its own process. An aggregate of few nodes does
 * not have all rigid motions: the shift makes pivots of those that it lacks. Levels take their options from
 * the database alone: there they stand while they are made, where the host has none. */
enum { DEFAULTS = 6 };
typedef struct defaults {
  char name[DEFAULTS][PREFIX + 64];
  int given; /* bits: the host has none of these */
} defaults;

static PetscErrorCode give_defaults(const mpm_petsc *m, defaults *d) {
  const char *const options[DEFAULTS][2] = {
      {"mg_levels_ksp_type", "chebyshev"},
      {"mg_levels_ksp_max_it", "2"},
      {"mg_levels_pc_type", "asm"},
      {"mg_levels_pc_asm_type", m->by_cg ? "basic" : "restrict"},
      {"mg_levels_sub_pc_type", m->by_cg ? "icc" : "ilu"},
      {"mg_levels_sub_pc_factor_shift_type", m->by_cg ? "positive_definite" : "nonzero"}};
  PetscFunctionBeginUser;
  d->given = 0;
  for (int i = 0; i < DEFAULTS; ++i) {
    PetscBool is_set;
    snprintf(d->name[i], sizeof d->name[i], "-%s%s", m->prefix, options[i][0]);
    PetscCall(PetscOptionsHasName(NULL, NULL, d->name[i], &is_set));
    if (is_set) continue;
    PetscCall(PetscOptionsSetValue(NULL, d->name[i], options[i][1]));
    d->given |= 1 << i;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode take_defaults(const defaults *d) {
  PetscFunctionBeginUser;
  for (int i = 0; i < DEFAULTS; ++i)
    if (d->given >> i & 1) PetscCall(PetscOptionsClearValue(NULL, d->name[i]));
  PetscFunctionReturn(0);
}

static PetscErrorCode prepare(mpm_petsc *m, const lent *l) {
  PetscFunctionBeginUser;
  PetscCall(forget(m));
  PetscCall(place_rows(m, l));
  PetscCall(make_matrix(m, l));
  PetscCall(tell_rigid_motions(m, &l->info));
  m->pattern_id = l->info.pattern_id;
  ++m->info.patterns;
  PetscFunctionReturn(0);
}

static PetscErrorCode set_values(const mpm_petsc *m, const lent *l) {
  const int64_t entries = l->info.nonzeros;
  PetscFunctionBeginUser;
  for (int64_t e = 0; e < entries; ++e) m->value[e] = l->value[e];
  for (PetscInt k = 0; k < m->fills; ++k) {
    const int64_t r = m->fill_beside[k];
    m->value[entries + k] = 1.0;
    for (int64_t e = l->start[r]; e < l->start[r + 1]; ++e)
      if (l->column[e] == r) m->value[entries + k] = l->value[e];
  }
  PetscCall(MatSetValuesCOO(m->A, m->value, INSERT_VALUES));
  PetscFunctionReturn(0);
}

static PetscErrorCode set_vector(const mpm_petsc *m, int64_t rows, const double *from, Vec to) {
  PetscScalar *v;
  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(to));
  PetscCall(VecGetArray(to, &v));
  for (int64_t r = 0; r < rows; ++r) v[m->place[r]] = from[r];
  PetscCall(VecRestoreArray(to, &v));
  PetscFunctionReturn(0);
}

static PetscErrorCode solve_system(mpm_petsc *m, const lent *l, PetscInt *iterations) {
  const int by_cg = l->info.symmetric && l->info.positive_definite;
  const PetscScalar *x;
  KSPConvergedReason reason;
  PetscFunctionBeginUser;
  if (m->pattern_id != l->info.pattern_id) PetscCall(prepare(m, l));
  if (!m->ksp || m->by_cg != by_cg) PetscCall(make_solver(m, by_cg));
  PetscCall(set_values(m, l));
  PetscCall(set_vector(m, l->info.owned_rows, l->rhs, m->b));
  PetscCall(set_vector(m, l->info.owned_rows, l->solution, m->x));
  PetscCall(KSPSetTolerances(m->ksp, l->tolerance, 0.0, PETSC_DEFAULT, PETSC_DEFAULT));
  defaults d;
  PetscCall(give_defaults(m, &d));
  const PetscErrorCode failed = KSPSetUp(m->ksp);
  PetscCall(take_defaults(&d));
  PetscCall(failed);
  PetscCall(KSPSolve(m->ksp, m->b, m->x));
  PetscCall(KSPGetConvergedReason(m->ksp, &reason));
  PetscCall(KSPGetIterationNumber(m->ksp, iterations));
  PetscCall(VecGetArrayRead(m->x, &x));
  for (int64_t r = 0; r < l->info.owned_rows; ++r) l->solution[r] = PetscRealPart(x[m->place[r]]);
  PetscCall(VecRestoreArrayRead(m->x, &x));
  m->info.reason = reason;
  m->info.iterations += *iterations;
  ++m->info.solves;
  PetscFunctionReturn(0);
}

static mpm_status borrow(mpm_petsc *m, const mpm_operator *matrix, lent *l) {
  mpm_status status = mpm_operator_get_info(matrix, &l->info);
  if (status) return fail(m, status, "mpm_operator_get_info: %s", mpm_status_name(status));
  if ((status = mpm_operator_csr(matrix, &l->start, &l->column, &l->value)))
    return fail(m, status, "mpm_operator_csr: %s", mpm_status_name(status));
  const int64_t full = count_nodes(&l->info) * l->info.block;
  if (l->info.nonzeros + full > PETSC_MAX_INT || l->info.all_rows > PETSC_MAX_INT / l->info.block)
    return fail(m, MPM_E_UNSUPPORTED,
                "%lld rows, %lld entries on this process: PetscInt counts to %lld, use a PETSc with "
                "--with-64-bit-indices",
                (long long)l->info.all_rows, (long long)l->info.nonzeros, (long long)PETSC_MAX_INT);
  return MPM_OK;
}

/* The rows of all processes must be those of all parts, in their order. */
static mpm_status check_parts(mpm_petsc *m, const mpm_operator_info *info) {
  int64_t rows = info->owned_rows, before = 0;
  int rank = 0;
  if (MPI_Comm_rank(m->comm, &rank) || MPI_Exscan(&rows, &before, 1, MPI_INT64_T, MPI_SUM, m->comm))
    return fail(m, MPM_E_CALLBACK, "MPI_Exscan has failed");
  int64_t word[] = {rows, (rank ? before : 0) != info->first_row};
  if (MPI_Allreduce(MPI_IN_PLACE, word, 2, MPI_INT64_T, MPI_SUM, m->comm))
    return fail(m, MPM_E_CALLBACK, "MPI_Allreduce has failed");
  if (word[0] != info->all_rows)
    return fail(
        m, MPM_E_ARG,
        "processes of the communicator have %lld rows, parts of the context %lld: give the communicator of "
        "the parts, or MPI_COMM_SELF for one part",
        (long long)word[0], (long long)info->all_rows);
  if (!word[1]) return MPM_OK;
  return fail(m, MPM_E_ARG, "processes of the communicator are not in the order of the parts");
}

mpm_status mpm_petsc_solve(void *petsc, const mpm_operator *matrix, const double *rhs, double *solution,
                           double tolerance, int64_t *iterations) {
  mpm_petsc *m = petsc;
  lent l = {.info = {.struct_size = sizeof l.info}, .rhs = rhs, .solution = solution, .tolerance = tolerance};
  PetscInt count = 0;
  if (!m || !matrix || !rhs || !solution || !iterations) return MPM_E_ARG;
  m->text[0] = '\0';
  mpm_status status = agree(m, borrow(m, matrix, &l));
  if (!status) status = agree(m, check_parts(m, &l.info));
  if (status) return status;
  begin(m);
  status = agree(m, end(m, solve_system(m, &l, &count)));
  if (status) {
    m->pattern_id = -1; /* of what is half made nothing is kept */
    return status;
  }
  *iterations = count;
  if (m->info.reason > 0) return MPM_OK;
  return fail(m, MPM_CUT_DT, "PETSc has not solved the system: %s after %lld iterations",
              KSPConvergedReasons[m->info.reason], (long long)count);
}

/* ---- the handle ---------------------------------------------------------------------------------------- */
static int is_prefix(const char *prefix) {
  const size_t length = strlen(prefix);
  if (length >= PREFIX || (length && !isalpha((unsigned char)prefix[0]))) return 0;
  for (const char *c = prefix; *c; ++c)
    if (!isalnum((unsigned char)*c) && *c != '_') return 0;
  return 1;
}

/* The error handler of the host's communicator would end the program where duplicating fails. */
static mpm_status duplicate(MPI_Comm comm, MPI_Comm *out) {
  MPI_Errhandler of_host;
  if (MPI_Comm_get_errhandler(comm, &of_host)) return MPM_E_CALLBACK;
  MPI_Comm_set_errhandler(comm, MPI_ERRORS_RETURN);
  const int failed = MPI_Comm_dup(comm, out);
  MPI_Comm_set_errhandler(comm, of_host);
  MPI_Errhandler_free(&of_host);
  if (failed) return MPM_E_CALLBACK;
  if (!MPI_Comm_set_errhandler(*out, MPI_ERRORS_RETURN)) return MPM_OK;
  MPI_Comm_free(out);
  return MPM_E_CALLBACK;
}

mpm_status mpm_petsc_open(MPI_Comm comm, const char *prefix, mpm_petsc **out) {
  PetscBool started = PETSC_FALSE, ended = PETSC_FALSE;
  int between = 0;
  if (out) *out = NULL;
  if (!prefix) prefix = "mpm_";
  if (!out || !is_prefix(prefix)) return MPM_E_ARG;
  if (PetscInitialized(&started) || PetscFinalized(&ended)) return MPM_E_CALLBACK;
  if (!started || ended) return MPM_E_STATE;
  if (comm == MPI_COMM_NULL || MPI_Comm_test_inter(comm, &between) || between) return MPM_E_ARG;
  MPI_Comm own;
  mpm_status status = duplicate(comm, &own);
  if (status) return status;
  mpm_petsc nobody = {.comm = own}, *m = calloc(1, sizeof *m);
  if ((status = agree(&nobody, m ? MPM_OK : MPM_E_NOMEM))) {
    MPI_Comm_free(&own);
    free(m);
    return status;
  }
  m->comm = own;
  m->pattern_id = -1;
  snprintf(m->prefix, sizeof m->prefix, "%s", prefix);
  *out = m;
  return MPM_OK;
}

mpm_status mpm_petsc_close(mpm_petsc *m) {
  PetscBool ended = PETSC_FALSE;
  if (!m) return MPM_OK;
  mpm_status status = PetscFinalized(&ended) ? MPM_E_CALLBACK : MPM_E_STATE;
  if (!ended) {
    begin(m);
    status = end(m, forget(m));
    if (MPI_Comm_free(&m->comm) && !status) status = MPM_E_CALLBACK;
  }
  free(m);
  return status;
}

const char *mpm_petsc_last_error(const mpm_petsc *m) {
  return m ? m->text : "there is no mpm_petsc: the status of mpm_petsc_open() says why";
}

mpm_status mpm_petsc_get_info(mpm_petsc *m, mpm_petsc_info *info) {
  uint32_t given = 0;
  if (!m) return MPM_E_ARG;
  if (!info) return fail(m, MPM_E_ARG, "info is NULL");
  memcpy(&given, info, sizeof given);
  if (given < sizeof given || given > 1u << 16)
    return fail(m, MPM_E_ARG, "mpm_petsc_info: struct_size is %u, expected %u", given,
                (unsigned)sizeof m->info);
  mpm_petsc_info now = m->info;
  now.struct_size = given;
  memcpy(info, &now, given < sizeof now ? given : sizeof now);
  return MPM_OK;
}
