/* This file chooses the method that solves a linear system, and goes on to another one where that fails. */
#include <math.h>
#include <string.h>

#include "context/transport.h"
#include "linalg/methods.h"
#include "simd/elementary.h"

enum { RESTART = 60, MOST_RESTARTS = 50, MOST_CYCLES = 500, RESTART_INNER = 10 };

/* ---- methods ------------------------------------------------------------------------------------------- */
static mpm_status bad_diagonal(const mpmi_system *s, int64_t row) {
  return mpmi_system_fail_at(s, MPM_NONFINITE, row, "a diagonal entry of the linear system is not finite");
}

static mpm_status not_positive(const mpmi_system *s) {
  s->report->indefinite = 1;
  return mpmi_fail(s->context, MPM_SINGULAR, "conjugate gradients: the matrix is not positive definite: %s",
                   mpmi_has_transport(s->context) ? "use MPM_SOLVER_GMRES or MPM_SOLVER_AUTO"
                                                  : "use MPM_SOLVER_LDLT or MPM_SOLVER_AUTO");
}

static mpm_status by_cg(mpmi_system *s, int64_t limit) {
  int64_t row = 0;
  const double started = mpmi_seconds();
  s->report->solver = MPM_SOLVER_CG;
  mpm_status status = mpmi_inverse_diagonal(s, &row);
  s->report->factor_seconds += mpmi_seconds() - started;
  if (status == MPM_SINGULAR)
    status = mpmi_system_fail_at(s, status, row, "conjugate gradients: a diagonal entry is not positive");
  if (status == MPM_NONFINITE) status = bad_diagonal(s, row);
  status = mpmi_system_together_at(s, status, row);
  if (status) {
    s->report->indefinite = status == MPM_SINGULAR;
    return status;
  }
  status = mpmi_cg(s, NULL, NULL, limit);
  if (status == MPM_NOT_CONVERGED) return mpmi_system_not_converged(s, "conjugate gradients");
  return status == MPM_SINGULAR ? not_positive(s) : status;
}

static mpm_status times_cycle(void *multigrid, const double *r, double *z) {
  return mpmi_multigrid_cycle(multigrid, r, z);
}

static mpm_status prepare_multigrid(mpmi_system *s) {
  int64_t row = -1;
  const double started = mpmi_seconds();
  const mpm_status status = mpmi_multigrid_prepare(&s->solver->multigrid, s->A, &row);
  s->report->factor_seconds += mpmi_seconds() - started;
  if (status == MPM_SINGULAR) s->report->indefinite = 1;
  if (status == MPM_SINGULAR && row >= 0)
    return mpmi_system_fail_at(s, status, row, "multigrid: a diagonal entry is not positive");
  if (status == MPM_SINGULAR)
    return mpmi_fail(
        s->context, status,
        "multigrid: the matrix is not positive definite: use MPM_SOLVER_LDLT or MPM_SOLVER_AUTO");
  if (status == MPM_NONFINITE && row >= 0) return bad_diagonal(s, row);
  if (status == MPM_NONFINITE)
    return mpmi_fail(s->context, status, "multigrid: a coarser level is not finite");
  return status;
}

static mpm_status by_multigrid(mpmi_system *s, int64_t limit) {
  s->report->solver = MPM_SOLVER_MULTIGRID_CG;
  mpm_status status = prepare_multigrid(s);
  if (!status) status = mpmi_cg(s, times_cycle, &s->solver->multigrid, limit);
  if (status == MPM_NOT_CONVERGED) return mpmi_system_not_converged(s, "multigrid conjugate gradients");
  return status == MPM_SINGULAR && !s->report->indefinite ? not_positive(s) : status;
}

/* Solves with the factor where iterations have failed, unless the factor is too large for a machine. */
static mpm_status fall_back(mpmi_system *s, mpm_status status) {
  const double most = 4.0e9;
  const mpm_status analysed = mpmi_factor_analyse(&s->solver->factor, s->A);
  if (analysed) return analysed;
  const double bytes = mpmi_factor_bytes(&s->solver->factor);
  if (bytes > most && status == MPM_NONFINITE) return status;
  if (bytes > most)
    return mpmi_fail(
        s->context, status,
        "the linear system has %lld unknowns, is %s, and its factor would take %.1f GB: hold the "
        "body in each direction, use a smaller dt%s",
        (long long)s->n, s->report->indefinite ? "not positive definite" : "too hard for iterations",
        1e-9 * bytes, s->A->symmetric ? ", or MPM_SOLVER_LDLT if there is room" : "");
  s->report->indefinite = 0; /* the factor will say whether it is */
  mpmi_forget(s->context);   /* drops what the iterations wrote */
  s->report->node = -1;
  return mpmi_direct(s);
}

/* Costs are in products of the matrix with a vector, measured on bodies of soft matter. Iterations of CG grow
 * with the number of nodes in a row, or with the step: inertia is its share of the diagonal. Multigrid needs
 * more cycles where stencils are wide, because functions that alternate from node to node are then soft. */
typedef struct costs {
  double cg, multigrid, factor;
} costs;

/* Counts the nodes along each axis; the longest comes first. */
static void extents_of(const mpmi_matrix *A, double *extent) {
  int64_t bound[6];
  for (int32_t k = 0; k < 6; ++k) bound[k] = A->rows || A->shared ? -INT64_MAX : 0;
  for (int64_t i = 0; i < A->rows; ++i)
    for (int32_t k = 0; k < 3 && mpmi_is_own_row(A, i); ++k) {
      if (A->index[i][k] > bound[k]) bound[k] = A->index[i][k];
      if (-A->index[i][k] > bound[3 + k]) bound[3 + k] = -A->index[i][k];
    }
  if (A->shared && mpmi_reduce_parts(A->context, MPM_REDUCE_MAX, 6, bound)) memset(bound, 0, sizeof bound);
  for (int32_t k = 0; k < 3; ++k) {
    const int64_t high = bound[k], low = -bound[3 + k];
    int32_t at = k;
    for (; at > 0 && extent[at - 1] < (double)(high - low + 1); --at) extent[at] = extent[at - 1];
    extent[at] = (double)(high - low + 1);
  }
}

/* Stiff couplings of bodies in contact are hard for CG, and coarser levels do not know the bodies apart. */
static const double cg_in_contact = 10.0;

static costs costs_of(const mpmi_matrix *A, double inertia, int32_t several_fields) {
  double extent[3];
  extents_of(A, extent);
  const double entries = (double)A->row_start[A->rows], rows = (double)A->rows;
  const double dim = 1.0 + (extent[1] > 1.0) + (extent[2] > 1.0);
  const double half_stencil = fmax(1.0, 0.5 * (mpmi_pow(entries / rows, 1.0 / dim) - 1.0));
  /* The factor spends its work on separators. They are half a stencil wide, and a long body has many of
   * them. One takes 7 times the cube of its size, and 20 of these multiplications take as long as one of a
   * product. */
  const double separator = (double)mpmi_matrix_unknowns(A) / extent[0] * half_stencil;
  const double factor = 7.0 * separator * separator * separator * extent[0] / extent[1];
  costs c;
  c.cg = fmin(20.0 * extent[0], inertia > 0.0 ? 20.0 / sqrt(inertia) : (double)INFINITY);
  c.multigrid = 75.0 + 12.0 * half_stencil * half_stencil;
  c.factor = factor / (20.0 * entries * (double)(A->block * A->block));
  if (several_fields) {
    c.cg *= cg_in_contact;
    c.multigrid = (double)INFINITY;
  }
  return c;
}

static int64_t most_of_cg(const mpmi_system *s, const mpmi_solve_job *job) {
  if (job->max_iterations) return job->max_iterations;
  return 5000 + 30 * (int64_t)costs_of(s->A, 0.0, job->several_fields).cg;
}

/* Goes on where the blocks of the diagonal are too weak a preconditioner, and no other method follows. */
static mpm_status by_inner_cg(mpmi_system *s, const mpmi_solve_job *job) {
  mpmi_inner_cg inner = {s, most_of_cg(s, job)};
  const mpmi_gmres_plan plan = {.precondition = mpmi_times_inner_cg,
                                .user = &inner,
                                .together = 1,
                                .impatient = 1,
                                .restart = RESTART_INNER,
                                .limit = inner.limit};
  int64_t row = 0;
  const mpm_status status = mpmi_system_together(s, mpmi_reserve_inner_cg(s, &row));
  if (status) return status > 0 ? MPM_NOT_CONVERGED : status;
  return mpmi_gmres(s, &plan);
}

/* The preconditioner is a cycle of multigrid, or the blocks of the diagonal where there are no levels, as
 * with a transport. */
static mpm_status by_gmres(mpmi_system *s, const mpmi_solve_job *job, int32_t last, int32_t multigrid) {
  const int64_t limit = job->max_iterations;
  mpmi_gmres_plan plan = {.precondition = times_cycle,
                          .user = &s->solver->multigrid,
                          .restart = RESTART,
                          .impatient = !last,
                          .limit = limit ? limit : RESTART * MOST_RESTARTS};
  mpm_status status = multigrid ? prepare_multigrid(s) : MPM_SINGULAR;
  const int32_t blocks = status > 0;
  s->report->solver = MPM_SOLVER_GMRES;
  if (blocks) {
    int64_t row = 0;
    const double started = mpmi_seconds();
    plan.precondition = mpmi_times_inverse_blocks;
    plan.user = s;
    s->report->indefinite = 0;
    s->report->node = -1;
    mpmi_forget(s->context); /* drops what prepare_multigrid() wrote */
    status = mpmi_inverse_blocks(s, &row);
    s->report->factor_seconds += mpmi_seconds() - started;
    if (status == MPM_NONFINITE) status = bad_diagonal(s, row);
    if ((status = mpmi_system_together_at(s, status, row))) return status;
  }
  if (!status) status = mpmi_gmres(s, &plan);
  if (status == MPM_NOT_CONVERGED && blocks && last) status = by_inner_cg(s, job);
  return status == MPM_NOT_CONVERGED ? mpmi_system_not_converged(s, "GMRES") : status;
}

static mpm_status by_cheapest(mpmi_system *s, const mpmi_solve_job *job) {
  const costs c = costs_of(s->A, job->inertia, job->several_fields);
  const int64_t limit = job->max_iterations;
  mpm_status status;
  if (c.factor <= fmin(c.cg, c.multigrid)) return mpmi_direct(s);
  if (!s->A->symmetric)
    status = by_gmres(s, job, 0, c.multigrid < c.cg);
  else if (c.multigrid < c.cg)
    status = by_multigrid(s, limit ? limit : MOST_CYCLES);
  else
    status = by_cg(s, limit ? limit : 500 + 3 * (int64_t)c.cg);
  return status > 0 ? fall_back(s, status) : status;
}

/* Returns 1 where GMRES takes a cycle of multigrid as its preconditioner. */
static int32_t has_levels(const mpmi_system *s, const mpmi_solve_job *job) {
  return !mpmi_has_transport(s->context) && s->n > MPMI_ALONE_UNKNOWNS && !job->several_fields;
}

/* What MPM_SOLVER_AUTO stands for with a transport: one part has the bits of several. */
static int32_t choice_of(const mpmi_solve_job *job) {
  if (job->choice || !mpmi_has_transport(job->matrix->context)) return job->choice;
  return job->matrix->symmetric ? MPM_SOLVER_CG : MPM_SOLVER_GMRES;
}

/* With a transport GMRES goes on where conjugate gradients fail and the library chooses. What is singular for
 * both is told as such. */
static mpm_status by_cg_or_gmres(mpmi_system *s, const mpmi_solve_job *job) {
  const mpm_status status = by_cg(s, most_of_cg(s, job));
  if (status <= 0 || job->choice) return status;
  const int64_t node = s->report->node;
  memset(s->x, 0, (size_t)s->n * sizeof *s->x); /* what they have left may be far off */
  s->report->iterations = 0;
  const mpm_status then = by_gmres(s, job, 1, 0);
  if (then != MPM_NOT_CONVERGED || status != MPM_SINGULAR) return then;
  s->report->node = node;
  s->report->indefinite = 1;
  return mpmi_fail(s->context, MPM_SINGULAR,
                   "conjugate gradients and GMRES: the matrix is not positive definite, and hard");
}

static mpm_status by_choice(mpmi_system *s, const mpmi_solve_job *job) {
  const int64_t limit = job->max_iterations;
  switch (choice_of(job)) {
  case MPM_SOLVER_HOST:
    return mpmi_solve_by_host(s, job);
  case MPM_SOLVER_CG:
    return by_cg_or_gmres(s, job);
  case MPM_SOLVER_MULTIGRID_CG:
    return by_multigrid(s, limit ? limit : 10 * MOST_CYCLES);
  case MPM_SOLVER_LDLT:
    return mpmi_direct(s);
  case MPM_SOLVER_GMRES:
    return by_gmres(s, job, 1, has_levels(s, job));
  default:
    return by_cheapest(s, job);
  }
}

/* ---- the call ------------------------------------------------------------------------------------------ */
static mpm_status check_choice(mpm_context *context, const mpmi_solve_job *job) {
  const int32_t choice = job->choice;
  if (choice == MPM_SOLVER_HOST && !job->host)
    return mpmi_fail(context, MPM_E_STATE,
                     "MPM_SOLVER_HOST has no solver: call mpm_stepper_set_linear_solver first");
  if (choice == MPM_SOLVER_MULTIGRID_CG && job->several_fields)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "MPM_SOLVER_MULTIGRID_CG is for one body: where bodies touch use MPM_SOLVER_LDLT, "
                     "MPM_SOLVER_CG or MPM_SOLVER_AUTO");
  static const char *symmetric_only[] = {[MPM_SOLVER_CG] = "MPM_SOLVER_CG",
                                         [MPM_SOLVER_MULTIGRID_CG] = "MPM_SOLVER_MULTIGRID_CG",
                                         [MPM_SOLVER_LDLT] = "MPM_SOLVER_LDLT"};
  if (choice >= MPM_SOLVER_CG && choice <= MPM_SOLVER_LDLT && !job->matrix->symmetric)
    return mpmi_fail(
        context, MPM_E_UNSUPPORTED,
        "%s is for symmetric matrices, and this one is not: use MPM_SOLVER_GMRES or MPM_SOLVER_AUTO",
        symmetric_only[choice]);
  if (choice != MPM_SOLVER_HOST && (choice < MPM_SOLVER_AUTO || choice > MPM_SOLVER_GMRES))
    return mpmi_fail(context, MPM_E_ARG, "linear_solver is %d, must be MPM_SOLVER_AUTO ... MPM_SOLVER_HOST",
                     (int)choice);
  return MPM_OK;
}

static mpm_status check_rhs(const mpmi_system *s) {
  mpm_status status = MPM_OK;
  int64_t row = -1;
  for (int64_t i = 0; i < s->n && !status; ++i) {
    if (isfinite(s->b[i]) || !mpmi_is_own_row(s->A, i / s->A->block)) continue;
    row = i / s->A->block;
    status =
        mpmi_system_fail_at(s, MPM_NONFINITE, row, "the right-hand side of the linear system is not finite");
  }
  status = mpmi_system_together_at(s, status, row);
  if (status) return status;
  return mpmi_fail(s->context, MPM_NONFINITE, "the right-hand side of the linear system is too large");
}

static mpm_status find_norm(mpmi_system *s) {
  if (!s->A->shared) return mpmi_norm(s->context, s->b, s->n, &s->b_norm);
  const mpm_status status = mpmi_rows_sum(s->A->shared, MPMI_BY_FOURS, 1,
                                          &(mpmi_row_terms){.a = s->b, .b = s->b}, &s->b_norm, MPM_OK);
  s->b_norm = sqrt(s->b_norm);
  return status;
}

/* Keeps a guess only if its residual is smaller than that of x = 0. */
static mpm_status take_guess(mpmi_system *s) {
  int32_t any = 0;
  for (int64_t i = 0; i < s->n; ++i) {
    if (s->A->held[i]) s->x[i] = 0.0;
    any |= s->x[i] != 0.0;
  }
  mpm_status status = any ? mpmi_system_work(s, 1, 0) : MPM_OK;
  if (!any || status) return status;
  status = mpmi_matrix_residual(s->A, s->b, s->x, s->solver->work, &s->reached);
  if (!status && !(s->reached < s->b_norm)) memset(s->x, 0, (size_t)s->n * sizeof *s->x);
  return status;
}

static mpm_status solve(mpmi_solver *solver, const mpmi_solve_job *job, mpmi_solve_report *report) {
  mpmi_system s = {.solver = solver,
                   .context = solver->context,
                   .A = job->matrix,
                   .b = job->rhs,
                   .x = job->x,
                   .n = mpmi_matrix_unknowns(job->matrix),
                   .report = report};
  mpm_status status = check_choice(s.context, job);
  if (!status) status = find_norm(&s);
  if (status) return status;
  if (!isfinite(s.b_norm)) return check_rhs(&s);
  if (!(s.b_norm > 0.0)) {
    memset(s.x, 0, (size_t)s.n * sizeof *s.x);
    report->solver = choice_of(job);
    if (!report->solver) report->solver = s.A->symmetric ? MPM_SOLVER_LDLT : MPM_SOLVER_GMRES;
    return MPM_OK;
  }
  s.wanted = s.reached = job->tolerance * s.b_norm;
  status = take_guess(&s);
  return status ? status : by_choice(&s, job);
}

mpm_status mpmi_solve(mpmi_solver *solver, const mpmi_solve_job *job, mpmi_solve_report *report) {
  const double started = mpmi_seconds();
  memset(report, 0, sizeof *report);
  report->solver = job->choice;
  report->negative = report->node = -1;
  const mpm_status status = solve(solver, job, report);
  report->solve_seconds = mpmi_seconds() - started - report->factor_seconds;
  return status;
}
