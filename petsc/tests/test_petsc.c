/* libmpm-petsc on as many processes as there are, each with its part of a problem by libmpm-mpi:
 *
 *   test_petsc history LAW CELLS FILE   a block is pressed; the history of Newton's method is that of FILE,
 *                                       which one process writes; prints iterations
 *   test_petsc gradients CELLS          one process: the answer is that of the library's conjugate gradients
 *   test_petsc faults                   what is refused, and solvers that fail */
#include <mpm/mpm_mpi.h>
#include <mpm/mpm_petsc.h>

#include <inttypes.h>
#include <math.h>
#include <petscsys.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int rank, size;

/* A process for which something is not so says what, and ends all. */
static void quit(int line, const char *what) {
  fprintf(stderr, "test_petsc.c:%d: on process %d: %s\n", line, rank, what);
  fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, 1);
}
#define MUST(that)                                                                                           \
  do {                                                                                                       \
    if (!(that)) quit(__LINE__, #that);                                                                      \
  } while (0)
#define MUST_SAY(text, words)                                                                                \
  do {                                                                                                       \
    if (!strstr(text, words)) quit(__LINE__, text);                                                          \
  } while (0)
#define OK(w, call)                                                                                          \
  do {                                                                                                       \
    const mpm_status status_ = (call);                                                                       \
    if (!status_) break;                                                                                     \
    fprintf(stderr, "%s: %s: %s: %s\n", #call, mpm_status_name(status_), mpm_last_error((w)->context),       \
            mpm_petsc_last_error((w)->solver));                                                              \
    quit(__LINE__, "a call has failed");                                                                     \
  } while (0)

/* ---- a block between a platen and planes of symmetry --------------------------------------------------- */
typedef struct world {
  mpm_mpi *mpi;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *law, *steel;
  mpm_particles *block, *platen;
  mpm_stepper *stepper;
  mpm_petsc *solver;
} world;

static const double edge = 0.1, way = 0.004; /* of the platen, m */
enum { STEPS = 2, HISTORY = 64 };

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[2 * b->ld + i] -= way / STEPS / b->dt;
  return MPM_OK;
}

/* The law is neo_hookean, or one whose matrix is not symmetric. The context is of all processes, or of one.
 * */
static void open_world(world *w, const char *law, int32_t cells, int32_t linear_solver, int alone) {
  const mpm_param soft[] = {{"E", 1e6},
                            {"nu", 0.3},
                            {"density", 1050.0},
                            {"yield_stress", 5e4},
                            {"hardening", 1e5}},
                  heavy[] = {{"density", 7800.0}};
  const double h = edge / cells, wide = edge + 3.0 * h;
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {edge, edge, edge};
  const double under[] = {0.0, 0.0, edge}, over[] = {wide, wide, edge + h};
  const int32_t per_cell[] = {2, 2, 2};
  const uint8_t all[] = {1, 1, 1};
  mpm_context_desc c;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  *w = (world){.mpi = NULL};
  MUST(!mpm_context_desc_init(&c, sizeof c) && !mpm_grid_desc_init(&g, sizeof g));
  MUST(!mpm_stepper_desc_init(&s, sizeof s));
  if (!alone) MUST(!mpm_mpi_open(MPI_COMM_WORLD, &c, &w->mpi));
  MUST(!mpm_context_create(&c, &w->context));
  for (int k = 0; k < 3; ++k) g.spacing[k] = h, g.cells[k] = cells + 6;
  s.scheme = MPM_NEWMARK;
  s.quasi_static = 1;
  s.linear_solver = linear_solver;
  s.linear_tolerance = 1e-12;
  OK(w, mpm_grid_create(w->context, &g, &w->grid));
  OK(w, mpm_material_create(w->context, law, soft, strcmp(law, "j2") ? 3 : 5, &w->law));
  OK(w, mpm_material_create(w->context, "rigid", heavy, 1, &w->steel));
  OK(w, mpm_particles_create(w->context, w->grid, w->law, &w->block));
  OK(w, mpm_particles_create(w->context, w->grid, w->steel, &w->platen));
  OK(w, mpm_particles_fill_box(w->block, lower, upper, per_cell, NULL, NULL));
  OK(w, mpm_particles_fill_box(w->platen, under, over, per_cell, NULL, NULL));
  if (mpm_particles_count(w->platen)) OK(w, mpm_particles_set_all(w->platen, "prescribed", MPM_U8, 3, all));
  OK(w, mpm_stepper_create(w->context, w->grid, &s, &w->stepper));
  OK(w, mpm_stepper_add(w->stepper, w->block));
  OK(w, mpm_stepper_add(w->stepper, w->platen));
  OK(w, mpm_stepper_set_motion(w->stepper, w->platen, push, NULL));
  for (int32_t face = MPM_X_MIN; face <= MPM_Z_MIN; face += 2)
    OK(w, mpm_stepper_set_wall(w->stepper, face, MPM_WALL_SLIP, 0.0));
}

static void lend_solver(world *w, MPI_Comm comm, const char *prefix) {
  MUST(!mpm_petsc_open(comm, prefix, &w->solver));
  MUST(!strcmp(mpm_petsc_last_error(w->solver), ""));
  OK(w, mpm_stepper_set_linear_solver(w->stepper, mpm_petsc_solve, w->solver));
}

static void close_world(world *w) {
  MUST(!mpm_stepper_destroy(w->stepper) && !mpm_particles_destroy(w->block));
  MUST(!mpm_particles_destroy(w->platen) && !mpm_material_destroy(w->law));
  MUST(!mpm_material_destroy(w->steel) && !mpm_grid_destroy(w->grid) && !mpm_context_destroy(w->context));
  MUST(!mpm_petsc_close(w->solver) && !mpm_mpi_close(w->mpi));
}

static mpm_petsc_info info_of(const world *w) {
  mpm_petsc_info info = {.struct_size = sizeof info};
  MUST(!mpm_petsc_get_info(w->solver, &info));
  return info;
}

/* ---- the same history on any number of processes ------------------------------------------------------- */
typedef struct history {
  int32_t count;
  double residual[HISTORY];
  mpm_step_info info;
} history;

static history step(world *w) {
  history h = {.info = {.struct_size = sizeof h.info}};
  OK(w, mpm_step(w->stepper, 1.0, &h.info));
  OK(w, mpm_stepper_residuals(w->stepper, HISTORY, h.residual, &h.count));
  return h;
}

static void compare_histories(const char *law, int32_t cells, const char *path) {
  world w;
  open_world(&w, law, cells, MPM_SOLVER_HOST, 0);
  lend_solver(&w, MPI_COMM_WORLD, NULL);
  history is[STEPS];
  double worst = 0.0;
  for (int k = 0; k < STEPS; ++k) is[k] = step(&w);
  FILE *file = fopen(path, size == 1 ? "wb" : "rb");
  MUST(file);
  if (size == 1)
    MUST(fwrite(is, sizeof is, 1, file) == 1);
  else {
    history one[STEPS];
    MUST(fread(one, sizeof one, 1, file) == 1);
    for (int k = 0; k < STEPS; ++k) {
      MUST(is[k].count == one[k].count && is[k].info.newton_iterations == one[k].info.newton_iterations);
      for (int i = 0; i < is[k].count; ++i) worst = fmax(worst, fabs(is[k].residual[i] - one[k].residual[i]));
      worst = fmax(worst, fabs(is[k].info.strain_energy / one[k].info.strain_energy - 1.0));
    }
    MUST(worst <= 1e-10);
  }
  MUST(!fclose(file));
  const mpm_petsc_info did = info_of(&w);
  MUST(did.reason > 0 && did.solves > STEPS && did.patterns >= 1 && did.patterns <= did.solves);
  int64_t last = 0;
  for (int k = 0; k < STEPS; ++k) last += is[k].info.linear_iterations;
  MUST(last == did.iterations);
  if (!rank)
    printf("%-12s %d processes: %" PRId64 " unknowns, %" PRId64 " solves, %" PRId64
           " iterations, %.1f for each; Newton's history differs by %.1e\n",
           law, size, did.unknowns, did.solves, did.iterations, (double)did.iterations / (double)did.solves,
           worst);
  close_world(&w);
}

/* ---- as the library's own solver ----------------------------------------------------------------------- */
static double *places(const world *w, int64_t *n) {
  *n = mpm_particles_count(w->block);
  double *x = malloc(3 * (size_t)*n * sizeof *x);
  MUST(x);
  OK(w, mpm_particles_get(w->block, "position", MPM_F64, 3, *n, NULL, x));
  return x;
}

static void compare_with_gradients(int32_t cells) {
  world a, b;
  int64_t n, m;
  open_world(&a, "neo_hookean", cells, MPM_SOLVER_CG, 1);
  open_world(&b, "neo_hookean", cells, MPM_SOLVER_HOST, 1);
  lend_solver(&b, MPI_COMM_SELF, NULL);
  for (int k = 0; k < STEPS; ++k) MUST(step(&a).count == step(&b).count);
  double *x = places(&a, &n), *y = places(&b, &m), apart = 0.0;
  MUST(n == m);
  for (int64_t i = 0; i < 3 * n; ++i) apart = fmax(apart, fabs(x[i] - y[i]));
  printf("conjugate gradients of the library: positions differ by %.1e of the way\n", apart / way);
  MUST(apart <= 1e-10 * way);
  free(x);
  free(y);
  close_world(&a);
  close_world(&b);
}

/* ---- what goes wrong ----------------------------------------------------------------------------------- */
static void check_arguments(void) {
  static const char *const bad[] = {"1mpm_", "mpm-", "_", "mpm ",
                                    "a23456789012345678901234567890123456789012345678901234567890abcd"};
  mpm_petsc *solver = (mpm_petsc *)1;
  mpm_petsc_info info = {.struct_size = 0};
  MUST(mpm_petsc_open(MPI_COMM_SELF, NULL, NULL) == MPM_E_ARG);
  MUST(mpm_petsc_open(MPI_COMM_NULL, NULL, &solver) == MPM_E_ARG && !solver);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
    MUST(mpm_petsc_open(MPI_COMM_SELF, bad[i], &solver) == MPM_E_ARG && !solver);
  MUST(!mpm_petsc_close(NULL) && mpm_petsc_get_info(NULL, &info) == MPM_E_ARG);
  MUST_SAY(mpm_petsc_last_error(NULL), "there is no mpm_petsc");
  MUST(!mpm_petsc_open(MPI_COMM_SELF, "", &solver));
  MUST(mpm_petsc_get_info(solver, NULL) == MPM_E_ARG);
  MUST(mpm_petsc_get_info(solver, &info) == MPM_E_ARG);
  MUST_SAY(mpm_petsc_last_error(solver), "struct_size is 0");
  MUST(mpm_petsc_solve(solver, NULL, NULL, NULL, 1e-3, NULL) == MPM_E_ARG);
  info.struct_size = offsetof(mpm_petsc_info, patterns);
  info.patterns = -5;
  MUST(!mpm_petsc_get_info(solver, &info) && info.solves == 0 && info.patterns == -5);
  MUST(!mpm_petsc_close(solver));
}

/* A step whose solver fails leaves the state as it was, and another solver goes on from there. */
static void fails(world *w, mpm_petsc *with, mpm_status wanted, int32_t returned, const char *words) {
  mpm_step_info info = {.struct_size = sizeof info};
  uint64_t before, after;
  OK(w, mpm_state_hash(w->stepper, &before));
  OK(w, mpm_stepper_set_linear_solver(w->stepper, mpm_petsc_solve, with));
  const mpm_status status = mpm_step(w->stepper, 1.0, &info);
  if (status != wanted) fprintf(stderr, "%s: %s\n", mpm_status_name(status), mpm_last_error(w->context));
  MUST(status == wanted && info.callback_status == returned);
  MUST_SAY(mpm_last_error(w->context), "the linear solver returned");
  MUST_SAY(mpm_petsc_last_error(with), words);
  OK(w, mpm_state_hash(w->stepper, &after));
  MUST(before == after);
}

static void check_faults(void) {
  world w;
  mpm_petsc *poor, *odd, *alone, *turned, *direct;
  MPI_Comm backwards;
  check_arguments();
  open_world(&w, "neo_hookean", 10, MPM_SOLVER_HOST, 0);
  lend_solver(&w, MPI_COMM_WORLD, NULL);
  MUST(!PetscOptionsSetValue(NULL, "-poor_ksp_max_it", "2"));
  MUST(!PetscOptionsSetValue(NULL, "-odd_pc_type", "nonsense"));
  MUST(!mpm_petsc_open(MPI_COMM_WORLD, "poor_", &poor) && !mpm_petsc_open(MPI_COMM_WORLD, "odd_", &odd));
  MUST(!mpm_petsc_open(MPI_COMM_SELF, NULL, &alone));
  fails(&w, poor, MPM_CUT_DT, MPM_CUT_DT, "PETSc has not solved the system: DIVERGED_ITS after 2 iterations");
  for (int again = 0; again < 2; ++again) fails(&w, odd, MPM_E_CALLBACK, MPM_E_CALLBACK, "PETSc: PCSetType");
  if (size > 1) fails(&w, alone, MPM_E_CALLBACK, MPM_E_ARG, "give the communicator of the parts");
  MPI_Comm_split(MPI_COMM_WORLD, 0, size - rank, &backwards);
  MUST(!mpm_petsc_open(backwards, NULL, &turned));
  if (size > 1) fails(&w, turned, MPM_E_CALLBACK, MPM_E_ARG, "are not in the order of the parts");
  /* of PETSc's own factors there are only those of one process */
  MUST(!PetscOptionsSetValue(NULL, "-direct_ksp_type", "preonly"));
  MUST(!PetscOptionsSetValue(NULL, "-direct_pc_type", size == 1 ? "lu" : "redundant"));
  MUST(!mpm_petsc_open(MPI_COMM_WORLD, "direct_", &direct));
  OK(&w, mpm_stepper_set_linear_solver(w.stepper, mpm_petsc_solve, direct));
  step(&w);
  MUST(!PetscOptionsClearValue(NULL, "-poor_ksp_max_it") && !PetscOptionsClearValue(NULL, "-odd_pc_type"));
  OK(&w, mpm_stepper_set_linear_solver(w.stepper, mpm_petsc_solve, w.solver));
  step(&w);
  OK(&w, mpm_stepper_set_linear_solver(w.stepper, mpm_petsc_solve, odd)); /* which is no longer odd */
  step(&w);
  MUST(!mpm_petsc_close(poor) && !mpm_petsc_close(odd) && !mpm_petsc_close(alone));
  MUST(!mpm_petsc_close(turned) && !mpm_petsc_close(direct));
  MPI_Comm_free(&backwards);
  close_world(&w);
}

/* A solver that goes from one stepper to another has the structure that each needs. */
static void serve_two(void) {
  world small, large;
  open_world(&small, "neo_hookean", 6, MPM_SOLVER_HOST, 0);
  open_world(&large, "neo_hookean", 8, MPM_SOLVER_HOST, 0);
  lend_solver(&small, MPI_COMM_WORLD, NULL);
  OK(&large, mpm_stepper_set_linear_solver(large.stepper, mpm_petsc_solve, small.solver));
  for (int k = 0; k < STEPS; ++k) {
    MUST(step(&small).info.linear_solver == MPM_SOLVER_HOST);
    const int64_t patterns = info_of(&small).patterns;
    MUST(step(&large).info.linear_solver == MPM_SOLVER_HOST);
    MUST(info_of(&small).patterns > patterns);
  }
  close_world(&large);
  close_world(&small);
}

int main(int argc, char **argv) {
  mpm_petsc *early = NULL, *late = NULL;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  MUST(mpm_petsc_open(MPI_COMM_SELF, NULL, &early) == MPM_E_STATE && !early);
  MUST(!PetscInitializeNoArguments());
  MUST(argc >= 2);
  if (!strcmp(argv[1], "history") && argc == 5)
    compare_histories(argv[2], atoi(argv[3]), argv[4]);
  else if (!strcmp(argv[1], "gradients") && argc == 3)
    compare_with_gradients(atoi(argv[2]));
  else if (!strcmp(argv[1], "faults"))
    check_faults(), serve_two();
  else
    quit(__LINE__, "unknown arguments");
  MUST(!mpm_petsc_open(MPI_COMM_SELF, NULL, &late));
  MUST(!PetscFinalize());
  MUST(mpm_petsc_open(MPI_COMM_SELF, NULL, &early) == MPM_E_STATE && !early);
  MUST(mpm_petsc_close(late) == MPM_E_STATE);
  return MPI_Finalize();
}
