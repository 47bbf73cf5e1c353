/* A rigid sphere is pressed into a block of rubber, quasi-statically: contact in three dimensions with a tool
 * of prescribed particles, beside the formula of Hertz.
 *
 *   indenter [directory [cells]]
 *
 * A quarter of block and sphere, between two symmetry planes, on a frictionless floor; the cells are counted
 * along an edge of the quarter, 16 by default. Prints force against depth and writes into the directory
 * (default: here) force.csv and, for ParaView, the series block.pvd and sphere.pvd; docs/pictures/draw.py
 * draws them. Fails if the force does not grow with the depth, or if the reactions of sphere, floor and
 * symmetry planes do not balance.
 *
 * What to expect: sphere and block share one velocity field, so they stick, and feel each other across a gap
 * of a cell. Linear functions are taken because with others the gap is wider, and because with quadratic ones
 * Newton's method does not end at large depths. The sphere acts as one whose radius is a cell larger, and the
 * force at the geometric depth is far above Hertz: at 5 mm 3.79, 2.52, 2.18, 1.88 and 1.72 times with 8, 12,
 * 16, 20 and 24 cells. Against Hertz for the larger sphere it is 1.20, 1.08, 1.12, 1.08 and 1.08 times, and
 * less where the radius of contact is but some three cells: 0.71 at depth 0, with 16. Hertz knows neither
 * large strain nor the finite block; the depth reaches half of the radius. */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* of the quarter; of the sphere; to reach; m */
static const double edge = 40e-3, radius = 20e-3, depth = 10e-3;
static const double E = 1e6, nu = 0.45;
enum { STEPS_PER_CELL = 2, SETS = 2 };

typedef struct press {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *rubber, *steel;
  mpm_particles *block, *sphere;
  mpm_stepper *stepper;
  double h, step; /* edge of a cell; way of the sphere in a step */
} press;

static mpm_status in_sphere(void *user, int32_t dim, int64_t n, int64_t ld, const double *x,
                            uint8_t *inside) {
  const double centre = *(const double *)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) {
    const double z = x[2 * ld + i] - centre;
    inside[i] = x[i] * x[i] + x[ld + i] * x[ld + i] + z * z < radius * radius;
  }
  return MPM_OK;
}

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  const double step = *(const double *)user;
  for (int64_t i = 0; i < b->n; ++i) add[2 * b->ld + i] -= step / b->dt;
  return MPM_OK;
}

static mpm_status open_press(press *p, int cells, double *centre) {
  const mpm_param soft[] = {{"E", E}, {"nu", nu}, {"density", 1050.0}}, heavy[] = {{"density", 7800.0}};
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {edge, edge, edge};
  const int32_t per_cell[] = {2, 2, 2};
  const uint8_t all[] = {1, 1, 1};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_status status;
  if ((status = mpm_context_create(NULL, &p->context))) return status;
  p->h = edge / cells;
  const double bottom = edge + 0.5 * p->h, under[] = {0.0, 0.0, bottom};
  const double over[] = {radius, radius, bottom + radius};
  *centre = bottom + radius;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = 3;
  g.basis = MPM_LINEAR;
  for (int c = 0; c < 3; ++c) g.spacing[c] = p->h, g.cells[c] = 2 * cells;
  mpm_stepper_desc_init(&s, sizeof s);
  s.scheme = MPM_NEWMARK;
  s.quasi_static = 1;
  if ((status = mpm_grid_create(p->context, &g, &p->grid)) ||
      (status = mpm_material_create(p->context, "neo_hookean", soft, 3, &p->rubber)) ||
      (status = mpm_material_create(p->context, "rigid", heavy, 1, &p->steel)) ||
      (status = mpm_particles_create(p->context, p->grid, p->rubber, &p->block)) ||
      (status = mpm_particles_create(p->context, p->grid, p->steel, &p->sphere)) ||
      (status = mpm_particles_fill_box(p->block, lower, upper, per_cell, NULL, NULL)) ||
      (status = mpm_particles_fill(p->sphere, under, over, per_cell, in_sphere, centre, NULL, NULL)) ||
      (status = mpm_particles_set_all(p->sphere, "prescribed", MPM_U8, 3, all)) ||
      (status = mpm_stepper_create(p->context, p->grid, &s, &p->stepper)) ||
      (status = mpm_stepper_add(p->stepper, p->block)) || (status = mpm_stepper_add(p->stepper, p->sphere)) ||
      (status = mpm_stepper_set_motion(p->stepper, p->sphere, push, &p->step)))
    return status;
  for (int32_t face = MPM_X_MIN; face <= MPM_Z_MIN && !status; face += 2)
    status = mpm_stepper_set_wall(p->stepper, face, MPM_WALL_SLIP, 0.0);
  return status;
}

/* For a quarter of a frictionless sphere on a half-space. */
static double hertz(double r, double d) {
  return d > 0.0 ? E / (1.0 - nu * nu) / 3.0 * sqrt(r) * pow(d, 1.5) : 0.0;
}

/* Force of the sphere, and what is left of it when all reactions are summed. */
static mpm_status weigh(const press *p, double *force, double *lost) {
  double sum[3], wall[3];
  mpm_status status = mpm_stepper_particles_reaction(p->stepper, p->sphere, sum);
  *force = -sum[2];
  for (int32_t face = MPM_X_MIN; face <= MPM_Z_MIN && !status; face += 2) {
    status = mpm_stepper_wall_reaction(p->stepper, face, wall);
    for (int c = 0; c < 3; ++c) sum[c] += wall[c];
  }
  *lost = fmax(fabs(sum[0]), fmax(fabs(sum[1]), fabs(sum[2])));
  return status;
}

static const char *in_directory(const char *directory, const char *file) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/%s", directory, file);
  return path;
}

/* Ratios are left out where Hertz has no force. */
static void print_row(double d, double force, double small, double large, int iterations) {
  char ratio[16] = "-";
  if (small > 0.0) snprintf(ratio, sizeof ratio, "%.3f", force / small);
  printf("%8.3f %9.4f %9.4f %8s %24.4f %8.3f %12d\n", 1e3 * d, force, small, ratio, large, force / large,
         iterations);
}

static mpm_status write_particles(const press *p, const char *directory, mpm_series *const *series, int k) {
  static const char *const fields[] = {"stress", "deformation_gradient"}, *const name[] = {"block", "sphere"};
  const mpm_particles *const set[] = {p->block, p->sphere};
  mpm_status status = MPM_OK;
  for (int j = 0; j < SETS && !status; ++j) {
    char file[32];
    snprintf(file, sizeof file, "%s_%04d.vtp", name[j], k);
    status = mpm_write_particles(set[j], in_directory(directory, file), 2, fields);
    if (!status) status = mpm_series_append(series[j], (double)k, file);
  }
  return status;
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const int cells = argc > 2 ? atoi(argv[2]) : 16;
  if (cells < 8 || cells > 32) {
    fprintf(stderr, "indenter: cells along an edge: 8 ... 32\n");
    return 1;
  }
  press p = {.context = NULL};
  mpm_series *series[SETS];
  mpm_step_info now = {.struct_size = sizeof now};
  double centre, force = 0.0, lost = 0.0, unbalanced = 0.0, ratio = 0.0;
  int64_t iterations = 0;
  if (open_press(&p, cells, &centre)) goto failed;
  p.step = p.h / STEPS_PER_CELL;
  const int steps = (int)lround((depth + 0.5 * p.h) / p.step);
  FILE *csv = fopen(in_directory(directory, "force.csv"), "w");
  if (!csv) {
    fprintf(stderr, "indenter: cannot write into %s\n", directory);
    return 1;
  }
  if (mpm_series_open(p.context, in_directory(directory, "block.pvd"), &series[0]) ||
      mpm_series_open(p.context, in_directory(directory, "sphere.pvd"), &series[1]) ||
      write_particles(&p, directory, series, 0))
    goto failed;
  printf("A quarter of a block, %" PRId64 " particles, and of a sphere; cells of %.3f mm\n\n",
         mpm_particles_count(p.block), 1e3 * p.h);
  printf("depth/mm   force/N   Hertz/N    ratio   Hertz, a cell larger/N    ratio   iterations\n");
  fprintf(csv, "depth_mm,force_N,hertz_N,hertz_larger_N\n");
  int grows = 1;
  for (int k = 1; k <= steps; ++k) {
    const double before = force;
    if (mpm_step(p.stepper, 1.0, &now) || weigh(&p, &force, &lost) ||
        write_particles(&p, directory, series, k))
      goto failed;
    const double d = k * p.step - 0.5 * p.h, small = hertz(radius, d), large = hertz(radius + p.h, d + p.h);
    ratio = force / large;
    grows &= force > before;
    unbalanced = fmax(unbalanced, lost / force);
    iterations += now.newton_iterations;
    print_row(d, force, small, large, (int)now.newton_iterations);
    fprintf(csv, "%.4f,%.6f,%.6f,%.6f\n", 1e3 * d, force, small, large);
  }
  if (fclose(csv)) {
    fprintf(stderr, "indenter: cannot write into %s\n", directory);
    return 1;
  }
  for (int j = 0; j < SETS; ++j)
    if (mpm_series_close(series[j])) goto failed;
  if (mpm_stepper_destroy(p.stepper) || mpm_particles_destroy(p.block) || mpm_particles_destroy(p.sphere) ||
      mpm_material_destroy(p.rubber) || mpm_material_destroy(p.steel) || mpm_grid_destroy(p.grid) ||
      mpm_context_destroy(p.context))
    goto failed;
  printf("\nwritten to %s: force.csv, block.pvd and sphere.pvd with their .vtp (open in ParaView)\n",
         directory);
  printf("result: force %.2f N, %.3f of Hertz for a sphere that is a cell larger, reactions balance to %.1e, "
         "%d iterations\n",
         force, ratio, unbalanced, (int)iterations);
  /* forces on each node balance to 1e-8 of their norm, those on thousands of them together to 1e-6 */
  return !(grows && unbalanced < 1e-6);

failed:
  fprintf(stderr, "\nindenter: %s\n", mpm_last_error(p.context));
  return 1;
}
