/* A linear solver of the host: a block of rubber, bonded between two platens, is squeezed in quasi-static
 * steps, once with the library's solvers and once with PETSc's multigrid, by libmpm-petsc.
 *
 *   petsc_solver [-cells 16] [-locking_remedy] [options of PETSc, such as -ksp_view]
 *
 * An eighth of the block, between symmetry planes; -cells: along its edge. With -locking_remedy the matrix is
 * not symmetric. Prints iterations, times and the force of the platen; fails if the two answers differ by
 * more than Newton's method leaves open. Built where pkg-config finds PETSc: Debian's petsc-dev. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <mpm/mpm_petsc.h>
#include <petscsys.h>

static const double edge = 0.1, way = 0.01; /* of the platen, m */
enum { STEPS = 2 };

typedef struct press {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *rubber, *steel;
  mpm_particles *block, *platen;
  mpm_stepper *stepper;
} press;

typedef struct options {
  PetscInt cells;
  PetscBool remedy;
} options;

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[2 * b->ld + i] -= way / STEPS / b->dt;
  return MPM_OK;
}

static mpm_status open_press(press *p, const options *o, int32_t solver, mpm_petsc *own) {
  const mpm_param soft[] = {{"E", 1e6}, {"nu", 0.45}, {"density", 1050.0}}, heavy[] = {{"density", 7800.0}};
  const double h = edge / o->cells, wide = edge + 3.0 * h;
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {edge, edge, edge};
  const double under[] = {0.0, 0.0, edge}, over[] = {wide, wide, edge + h};
  const int32_t per_cell[] = {2, 2, 2};
  const uint8_t all[] = {1, 1, 1};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_status status;
  if ((status = mpm_context_create(NULL, &p->context))) return status;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = 3;
  g.basis = MPM_BSPLINE2;
  for (int c = 0; c < 3; ++c) g.spacing[c] = h, g.cells[c] = o->cells + 6;
  mpm_stepper_desc_init(&s, sizeof s);
  s.scheme = MPM_NEWMARK;
  s.quasi_static = 1;
  s.locking_remedy = o->remedy ? MPM_LOCKING_CELL_AVERAGE : MPM_LOCKING_NONE;
  s.linear_solver = solver;
  if ((status = mpm_grid_create(p->context, &g, &p->grid)) ||
      (status = mpm_material_create(p->context, "neo_hookean", soft, 3, &p->rubber)) ||
      (status = mpm_material_create(p->context, "rigid", heavy, 1, &p->steel)) ||
      (status = mpm_particles_create(p->context, p->grid, p->rubber, &p->block)) ||
      (status = mpm_particles_create(p->context, p->grid, p->steel, &p->platen)) ||
      (status = mpm_particles_fill_box(p->block, lower, upper, per_cell, NULL, NULL)) ||
      (status = mpm_particles_fill_box(p->platen, under, over, per_cell, NULL, NULL)) ||
      (status = mpm_particles_set_all(p->platen, "prescribed", MPM_U8, 3, all)) ||
      (status = mpm_stepper_create(p->context, p->grid, &s, &p->stepper)) ||
      (status = mpm_stepper_add(p->stepper, p->block)) || (status = mpm_stepper_add(p->stepper, p->platen)) ||
      (status = mpm_stepper_set_motion(p->stepper, p->platen, push, NULL)))
    return status;
  for (int32_t face = MPM_X_MIN; face <= MPM_Z_MIN && !status; face += 2)
    status = mpm_stepper_set_wall(p->stepper, face, MPM_WALL_SLIP, 0.0);
  return status ? status : mpm_stepper_set_linear_solver(p->stepper, mpm_petsc_solve, own);
}

typedef struct answer {
  int64_t n;
  double *x, force[3]; /* positions, [3][n]; of the platen */
} answer;

static int run(const options *o, int32_t solver, mpm_petsc *own, answer *is) {
  press p = {.context = NULL};
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_profile profile = {.struct_size = sizeof profile};
  int64_t newton = 0, linear = 0;
  mpm_status status = open_press(&p, o, solver, own);
  if (!status) status = mpm_stepper_profile(p.stepper, 1, &profile);
  for (int step = 0; step < STEPS && !status; ++step) {
    status = mpm_step(p.stepper, 1.0, &info);
    newton += info.newton_iterations;
    linear += info.linear_iterations;
  }
  if (!status) status = mpm_stepper_profile(p.stepper, 0, &profile);
  if (!status) status = mpm_stepper_particles_reaction(p.stepper, p.platen, is->force);
  is->n = status ? 0 : mpm_particles_count(p.block);
  is->x = malloc(3 * (size_t)is->n * sizeof *is->x);
  if (!status && is->x) status = mpm_particles_get(p.block, "position", MPM_F64, 3, is->n, NULL, is->x);
  if (status || !is->x) {
    fprintf(stderr, "petsc_solver: %s %s\n", p.context ? mpm_last_error(p.context) : "no context",
            mpm_petsc_last_error(own));
    return 1;
  }
  printf("%-8s %6" PRId64 " %8" PRId64 " %12.2f s %8.2f s %16.8f N\n",
         solver == MPM_SOLVER_HOST ? "PETSc" : "built in", newton, linear, profile.assembly,
         profile.factor + profile.solve, -is->force[2]);
  mpm_stepper_destroy(p.stepper);
  mpm_particles_destroy(p.block);
  mpm_particles_destroy(p.platen);
  mpm_material_destroy(p.rubber);
  mpm_material_destroy(p.steel);
  mpm_grid_destroy(p.grid);
  return mpm_context_destroy(p.context) != MPM_OK;
}

/* Newton's method ends with an increment of 1e-8 of the largest of its step, and with forces that balance to
 * 1e-8: that much each answer may be off. */
static int compare(mpm_petsc *own, const answer *a, const answer *b) {
  const double allowed = 2e-8;
  mpm_petsc_info info = {.struct_size = sizeof info};
  double apart = 0.0;
  for (int64_t i = 0; i < 3 * a->n; ++i) apart = fmax(apart, fabs(a->x[i] - b->x[i]));
  apart /= way;
  const double force = fabs(a->force[2] - b->force[2]) / fabs(a->force[2]);
  if (mpm_petsc_get_info(own, &info)) return 1;
  printf("result: positions differ by %.1e of the way of the platen, forces by %.1e, with %d unknowns, %d "
         "patterns for %d solves\n",
         apart, force, (int)info.unknowns, (int)info.patterns, (int)info.solves);
  return !(apart <= allowed * STEPS && force <= allowed);
}

int main(int argc, char **argv) {
  mpm_petsc *own = NULL;
  options o = {.cells = 16};
  answer a = {.n = 0}, b = {.n = 0};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || mpm_petsc_open(PETSC_COMM_SELF, "", &own) ||
      PetscOptionsGetInt(NULL, NULL, "-cells", &o.cells, NULL) ||
      PetscOptionsHasName(NULL, NULL, "-locking_remedy", &o.remedy))
    return 1;
  if (o.cells < 4 || o.cells > 40) {
    fprintf(stderr, "petsc_solver: cells along the edge: 4 ... 40\n");
    return 1;
  }
  printf("         Newton   linear       assembly     solver   force of the platen\n");
  if (run(&o, MPM_SOLVER_AUTO, own, &a) || run(&o, MPM_SOLVER_HOST, own, &b)) return 1;
  const int failed = compare(own, &a, &b);
  free(a.x);
  free(b.x);
  return mpm_petsc_close(own) || PetscFinalize() || failed;
}
