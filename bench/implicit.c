/* Implicit steps: a cube of soft matter, compressed by a fifth, with noise in its strain, between walls that
 * slip, under its weight. One Newton iteration from there: law and tangent, assembly, a solution to 1e-8, the
 * new residual. */
#include "implicit.h"

#include "process.h"
#include "ceilings.h"
#include "hosts.h"

#include <math.h>
#include <mpm/mpm.h>
#include <stdlib.h>
#include <string.h>

typedef struct implicit_case {
  const char *name;
  int32_t dim, cells, basis, per_cell, solver;
  double strain;    /* compression along the last axis */
  double kappa;     /* over mu */
  const char *host; /* whose solver it is, of MPM_SOLVER_HOST */
} implicit_case;

/* Smooth bases lose their positive matrix earlier, at the rim. */
static const implicit_case cases[] = {
    {"2-D linear 80^2, direct", 2, 80, MPM_LINEAR, 2, MPM_SOLVER_LDLT, 0.2, 10.0, NULL},
    {"2-D linear 80^2, multigrid", 2, 80, MPM_LINEAR, 2, MPM_SOLVER_MULTIGRID_CG, 0.2, 10.0, NULL},
    {"2-D linear 80^2, CG", 2, 80, MPM_LINEAR, 2, MPM_SOLVER_CG, 0.2, 10.0, NULL},
    {"2-D linear 320^2, direct", 2, 320, MPM_LINEAR, 2, MPM_SOLVER_LDLT, 0.2, 10.0, NULL},
    {"2-D linear 320^2, multigrid", 2, 320, MPM_LINEAR, 2, MPM_SOLVER_MULTIGRID_CG, 0.2, 10.0, NULL},
    {"3-D linear 16^3, direct", 3, 16, MPM_LINEAR, 2, MPM_SOLVER_LDLT, 0.2, 10.0, NULL},
    {"3-D linear 16^3, multigrid", 3, 16, MPM_LINEAR, 2, MPM_SOLVER_MULTIGRID_CG, 0.2, 10.0, NULL},
    {"3-D linear 16^3, CHOLMOD", 3, 16, MPM_LINEAR, 2, MPM_SOLVER_HOST, 0.2, 10.0, "CHOLMOD"},
    {"3-D linear 16^3, PETSc GAMG", 3, 16, MPM_LINEAR, 2, MPM_SOLVER_HOST, 0.2, 10.0, "PETSc GAMG"},
    {"3-D linear 32^3, multigrid", 3, 32, MPM_LINEAR, 2, MPM_SOLVER_MULTIGRID_CG, 0.2, 10.0, NULL},
    {"3-D linear 32^3, CG", 3, 32, MPM_LINEAR, 2, MPM_SOLVER_CG, 0.2, 10.0, NULL},
    {"3-D linear 32^3, CHOLMOD", 3, 32, MPM_LINEAR, 2, MPM_SOLVER_HOST, 0.2, 10.0, "CHOLMOD"},
    {"3-D linear 32^3, PETSc GAMG", 3, 32, MPM_LINEAR, 2, MPM_SOLVER_HOST, 0.2, 10.0, "PETSc GAMG"},
    {"3-D linear 64^3, multigrid", 3, 64, MPM_LINEAR, 2, MPM_SOLVER_MULTIGRID_CG, 0.2, 10.0, NULL},
    {"2-D quadratic 80^2, multigrid", 2, 80, MPM_BSPLINE2, 2, MPM_SOLVER_MULTIGRID_CG, 0.02, 10.0, NULL},
    {"2-D cubic 80^2, multigrid", 2, 80, MPM_BSPLINE3, 2, MPM_SOLVER_MULTIGRID_CG, 0.02, 10.0, NULL},
    {"3-D uGIMP 16^3, multigrid", 3, 16, MPM_UGIMP, 2, MPM_SOLVER_MULTIGRID_CG, 0.02, 10.0, NULL},
    {"3-D quadratic 16^3, multigrid", 3, 16, MPM_BSPLINE2, 2, MPM_SOLVER_MULTIGRID_CG, 0.02, 10.0, NULL},
    {"3-D cubic 16^3, multigrid", 3, 16, MPM_BSPLINE3, 2, MPM_SOLVER_MULTIGRID_CG, 0.02, 10.0, NULL},
    {"3-D quadratic 16^3, 3^3", 3, 16, MPM_BSPLINE2, 3, MPM_SOLVER_MULTIGRID_CG, 0.02, 10.0, NULL},
    {"3-D quadratic 16^3, CG", 3, 16, MPM_BSPLINE2, 2, MPM_SOLVER_CG, 0.02, 10.0, NULL},
    {"2-D 80^2, kappa / mu 10^3", 2, 80, MPM_LINEAR, 2, MPM_SOLVER_MULTIGRID_CG, 0.02, 1e3, NULL},
    {"3-D 16^3, kappa / mu 10^3", 3, 16, MPM_LINEAR, 2, MPM_SOLVER_MULTIGRID_CG, 0.02, 1e3, NULL},
};
enum { CASES = sizeof cases / sizeof *cases, MOST_REPEATS = 99 };

typedef struct implicit_result {
  int32_t failed;
  char error[200];
  int64_t unknowns, iterations;
  double total, best, assembly, set_up, solve, bytes; /* seconds; peak of the process for each unknown */
  double residual;
} implicit_result;

typedef struct implicit_job {
  const implicit_case *of;
  int32_t threads, repeats;
  double (*seconds)(void);
} implicit_job;

static double noise(uint64_t *state) {
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return (double)(*state >> 11) * 0x1p-53 - 0.5;
}

static mpm_status strain(mpm_particles *set, const implicit_case *of) {
  const int64_t n = mpm_particles_count(set);
  const double along = 1.0 - of->strain, across = pow(along, -1.0 / (of->dim - 1));
  double *F = calloc((size_t)(9 * n), sizeof *F);
  uint64_t dice = 88172645463325252u;
  if (!F) return MPM_E_NOMEM;
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t r = 0; r < of->dim; ++r)
      for (int32_t c = 0; c < of->dim; ++c)
        F[(3 * r + c) * n + i] = 0.1 * of->strain * noise(&dice) + (r != c             ? 0.0
                                                                    : r == of->dim - 1 ? along
                                                                                       : across);
    for (int32_t r = of->dim; r < 3; ++r) F[4 * r * n + i] = 1.0;
  }
  const mpm_status status = mpm_particles_set(set, "deformation_gradient", MPM_F64, 9, n, NULL, F);
  free(F);
  return status;
}

typedef struct world {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *body;
  mpm_stepper *stepper;
  const bench_host *host;
  void *solver; /* of the host */
} world;

static mpm_status open_world(world *w, const implicit_job *job) {
  const implicit_case *of = job->of;
  const mpm_param soft[] = {{"mu", 1.0}, {"kappa", of->kappa}, {"density", 1.0}};
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {1.0, 1.0, 1.0};
  const int32_t per_cell[] = {of->per_cell, of->per_cell, of->per_cell};
  mpm_context_desc context;
  mpm_grid_desc grid;
  mpm_stepper_desc desc;
  mpm_status status;
  mpm_context_desc_init(&context, sizeof context);
  context.concurrency = job->threads;
  mpm_grid_desc_init(&grid, sizeof grid);
  grid.dim = of->dim;
  grid.basis = of->basis;
  for (int32_t k = 0; k < of->dim; ++k) {
    grid.cells[k] = of->cells + 4;
    grid.spacing[k] = 1.0 / of->cells;
  }
  mpm_stepper_desc_init(&desc, sizeof desc);
  desc.scheme = MPM_NEWMARK;
  desc.quasi_static = 1;
  desc.gravity[of->dim - 1] = -0.01;
  desc.linear_solver = of->solver;
  desc.linear_tolerance = 1e-8;
  desc.newton_max_iterations = 1;
  if ((status = mpm_context_create(&context, &w->context)) ||
      (status = mpm_grid_create(w->context, &grid, &w->grid)) ||
      (status = mpm_material_create(w->context, "neo_hookean_decoupled", soft, 3, &w->material)) ||
      (status = mpm_particles_create(w->context, w->grid, w->material, &w->body)) ||
      (status = mpm_particles_fill_box(w->body, lower, upper, per_cell, NULL, NULL)) ||
      (status = strain(w->body, of)) ||
      (status = mpm_stepper_create(w->context, w->grid, &desc, &w->stepper)) ||
      (status = mpm_stepper_add(w->stepper, w->body)))
    return status;
  for (int32_t k = 0; k < of->dim && !status; ++k)
    status = mpm_stepper_set_wall(w->stepper, 2 * k, MPM_WALL_SLIP, 0.0);
  if (status || !of->host) return status;
  w->host = bench_find_host(of->host);
  w->solver = w->host->open();
  return w->solver ? mpm_stepper_set_linear_solver(w->stepper, w->host->solve, w->solver) : MPM_E_NOMEM;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Each time the same iteration, for the step is given up after it; the first one makes the pattern too. Not
 * again after a minute. */
static mpm_status measure(const world *w, const implicit_job *job, implicit_result *r) {
  double total[MOST_REPEATS], assembly[MOST_REPEATS], set_up[MOST_REPEATS], solve[MOST_REPEATS];
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_profile stage = {.struct_size = sizeof stage};
  mpm_stepper_profile(w->stepper, 1, &stage);
  const double begin = bench_seconds();
  int32_t k = 0;
  for (; k < job->repeats && (k == 0 || bench_seconds() - begin < 60.0); ++k) {
    const double from = job->seconds();
    const mpm_status status = mpm_step(w->stepper, 1.0, &info);
    total[k] = job->seconds() - from;
    if (status != MPM_NOT_CONVERGED || info.linear_solver != job->of->solver)
      return status ? status : MPM_SINGULAR;
    mpm_stepper_profile(w->stepper, 1, &stage);
    assembly[k] = stage.assembly + stage.law;
    set_up[k] = stage.factor;
    solve[k] = stage.solve;
  }
  double *all[] = {total, assembly, set_up, solve}, *to[] = {&r->total, &r->assembly, &r->set_up, &r->solve};
  for (int32_t i = 0; i < 4; ++i) {
    qsort(all[i], (size_t)k, sizeof(double), ascending);
    *to[i] = all[i][k / 2];
  }
  r->best = total[0];
  r->unknowns = info.active_nodes * job->of->dim;
  r->iterations = info.linear_iterations;
  r->residual = info.residual;
  r->bytes = bench_peak_bytes() / (double)r->unknowns;
  return MPM_OK;
}

static void run(const void *data, void *result) {
  const implicit_job *job = data;
  implicit_result *r = result;
  world w = {0};
  mpm_status status = open_world(&w, job);
  if (!status) status = measure(&w, job, r);
  r->failed = status != MPM_OK;
  if (status)
    snprintf(r->error, sizeof r->error, "%s: %s", mpm_status_name(status), mpm_last_error(w.context));
  if (w.solver) w.host->close(w.solver);
  mpm_stepper_destroy(w.stepper);
  mpm_particles_destroy(w.body);
  mpm_material_destroy(w.material);
  mpm_grid_destroy(w.grid);
  mpm_context_destroy(w.context);
}

static void print(FILE *csv, const implicit_job *job, const implicit_result *r) {
  const char *name = job->of->name;
  printf("%-30s %8lld %2d  %5lld  %7.3f  %7.3f %7.3f %7.3f  %5.0f\n", name, (long long)r->unknowns,
         (int)job->threads, (long long)r->iterations, r->total, r->assembly, r->set_up, r->solve, r->bytes);
  fflush(stdout);
  if (!csv) return;
  fprintf(csv, "\"%s\",%lld,%d,%lld,%.4f,%.4f,%.4f,%.4f,%.0f\n", name, (long long)r->unknowns,
          (int)job->threads, (long long)r->iterations, r->total, r->assembly, r->set_up, r->solve, r->bytes);
  fflush(csv);
}

static void print_heads(FILE *csv) {
  printf("%-30s %8s %2s  %5s  %7s  %7s %7s %7s  %5s\n", "one Newton iteration", "unknowns", "th", "iter.",
         "seconds", "assemb.", "set-up", "solve", "B/unk");
  if (csv)
    fprintf(csv, "case,unknowns,threads,iterations,seconds,assembly_s,set_up_s,solve_s,bytes_per_unknown\n");
  if (csv) fflush(csv); /* the process of a case would write what is still in the buffer once more */
}

static uint64_t bits_of(double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

int32_t bench_implicit(const bench_choice *choice, int32_t repeats, const int64_t *threads, int32_t count,
                       FILE *csv) {
  int32_t bad = 0;
  if (!choice->bare && !choice->list) print_heads(csv);
  for (int32_t c = 0; c < CASES; ++c) {
    double residual = 0.0;
    if (!bench_chosen(choice, cases[c].name)) continue;
    if (choice->list && !cases[c].host) puts(cases[c].name);
    if (choice->list || (cases[c].host && !bench_find_host(cases[c].host))) continue;
    const int32_t runs = cases[c].host ? 1 : count; /* these have threads of their own, if any */
    for (int32_t t = 0; t < runs; ++t) {
      const implicit_job job = {&cases[c], (int32_t)threads[t], repeats,
                                choice->bare ? bench_processor_seconds : bench_seconds};
      implicit_result r = {.failed = 1, .error = "the process died"};
      bench_in_process(run, &job, &r, sizeof r);
      bad |= r.failed;
      if (r.failed) fprintf(stderr, "%s: %s\n", cases[c].name, r.error);
      if (r.failed) break;
      if (choice->bare)
        bench_print_bare(cases[c].name, job.threads, r.best, bits_of(r.residual));
      else
        print(csv, &job, &r);
      if (t > 0 && bits_of(r.residual) != bits_of(residual)) {
        fprintf(stderr, "%s: another residual on %d threads\n", cases[c].name, (int)threads[t]);
        bad = 1;
      }
      residual = r.residual;
    }
  }
  return bad;
}
