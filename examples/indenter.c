/* A sphere is pressed into a block of rubber, quasi-statically: contact of two bodies in three dimensions,
 * beside the formula of Hertz. The sphere is of steel, rigid beside rubber; then it is of the same rubber,
 * half a sphere glued to a plate that comes down.
 *
 *   indenter [directory [cells]]
 *
 * A quarter of block and sphere, between two symmetry planes, on a floor, all without friction; the cells are
 * counted along an edge of the quarter, 16 by default. Prints forces against depth and writes into the
 * directory (default: here) force.csv and, for ParaView, block.pvd and sphere.pvd of the steel sphere, and
 * soft_block.pvd and soft_sphere.pvd of the other; docs/pictures/draw.py draws the first two. Fails if a
 * force does not grow with the depth, or if contact, floor and plate do not balance.
 *
 * What to expect: the block is as deep as the sphere is wide, which Hertz does not know, nor large strain;
 * the depth reaches half of the radius. The steel sphere needs 1.42, 1.26, 1.23 and 1.19 times the force of
 * Hertz at the end with 8, 12, 16 and 20 cells, and more at the beginning, where the radius of contact is few
 * cells. The rubber sphere, held by a plate across its middle, needs 1.94, 1.69, 1.67 and 1.60 times that of
 * two such bodies: two thirds of the steel one's. */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* of the quarter; of the sphere; to reach; m */
static const double edge = 40e-3, radius = 20e-3, depth = 10e-3;
static const double E = 1e6, nu = 0.45;
enum { STEPS_PER_CELL = 5, SETS = 2 };
enum { STEEL, RUBBER, TOOLS };
static const char *const files[TOOLS][SETS] = {{"block", "sphere"}, {"soft_block", "soft_sphere"}};

typedef struct press {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *soft, *rigid;
  mpm_particles *block, *sphere; /* bodies 0 and 1 */
  mpm_stepper *stepper;
  double h, step; /* edge of a cell; way of the plate, or of the steel, in a unit of time */
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
  const double speed = *(const double *)user;
  for (int64_t i = 0; i < b->n; ++i) add[2 * b->ld + i] -= speed;
  return MPM_OK;
}

/* Takes hold of all of a steel sphere, and of the uppermost layer of a soft one. */
static mpm_status hold(const press *p, int tool) {
  const int64_t n = mpm_particles_count(p->sphere);
  double *x = malloc((size_t)(3 * n) * sizeof *x);
  uint8_t *held = calloc((size_t)(3 * n), sizeof *held);
  mpm_status status = MPM_E_NOMEM;
  if (x && held) status = mpm_particles_get(p->sphere, "position", MPM_F64, 3, n, NULL, x);
  for (int64_t i = 0; i < n && !status; ++i)
    for (int64_t c = 0; c < 3; ++c)
      held[c * n + i] = tool == STEEL || x[2 * n + i] > edge + radius - 0.5 * p->h;
  if (!status) status = mpm_particles_set(p->sphere, "prescribed", MPM_U8, 3, n, NULL, held);
  free(x);
  free(held);
  return status;
}

static mpm_status open_press(press *p, int tool, int cells) {
  const mpm_param soft[] = {{"E", E}, {"nu", nu}, {"density", 1050.0}}, heavy[] = {{"density", 7800.0}};
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {edge, edge, edge};
  const double centre = edge + radius, under[] = {0.0, 0.0, edge}, over[] = {radius, radius, centre};
  const int32_t per_cell[] = {2, 2, 2};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_status status;
  p->h = edge / cells;
  p->step = p->h / STEPS_PER_CELL;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = 3;
  g.basis = MPM_LINEAR;
  for (int c = 0; c < 3; ++c) g.spacing[c] = p->h, g.cells[c] = 2 * cells;
  mpm_stepper_desc_init(&s, sizeof s);
  s.scheme = MPM_NEWMARK;
  s.quasi_static = 1;
  if ((status = mpm_grid_create(p->context, &g, &p->grid)) ||
      (status = mpm_material_create(p->context, "neo_hookean", soft, 3, &p->soft)) ||
      (status = mpm_material_create(p->context, "rigid", heavy, 1, &p->rigid)) ||
      (status = mpm_particles_create(p->context, p->grid, p->soft, &p->block)) ||
      (status = mpm_particles_create(p->context, p->grid, tool == STEEL ? p->rigid : p->soft, &p->sphere)) ||
      (status = mpm_particles_fill_box(p->block, lower, upper, per_cell, NULL, NULL)) ||
      (status =
           mpm_particles_fill(p->sphere, under, over, per_cell, in_sphere, (void *)&centre, NULL, NULL)) ||
      (status = hold(p, tool)) || (status = mpm_stepper_create(p->context, p->grid, &s, &p->stepper)) ||
      (status = mpm_stepper_add(p->stepper, p->block)) || (status = mpm_stepper_add(p->stepper, p->sphere)) ||
      (status = mpm_stepper_set_body(p->stepper, p->sphere, 1)) ||
      (status = mpm_stepper_set_motion(p->stepper, p->sphere, push, &p->step)))
    return status;
  for (int32_t face = MPM_X_MIN; face <= MPM_Z_MIN && !status; face += 2)
    status = mpm_stepper_set_wall(p->stepper, face, MPM_WALL_SLIP, 0.0);
  return status;
}

static mpm_status close_press(const press *p) {
  mpm_status status;
  if ((status = mpm_stepper_destroy(p->stepper)) || (status = mpm_particles_destroy(p->block)) ||
      (status = mpm_particles_destroy(p->sphere)) || (status = mpm_material_destroy(p->soft)) ||
      (status = mpm_material_destroy(p->rigid)))
    return status;
  return mpm_grid_destroy(p->grid);
}

/* For a quarter of two frictionless bodies; both give way where the sphere is soft. */
static double hertz(int tool, double d) {
  const double modulus = E / (1.0 - nu * nu) / (tool == STEEL ? 1.0 : 2.0);
  return modulus / 3.0 * sqrt(radius) * pow(d, 1.5);
}

/* The force on the block, and the largest difference to that of the floor, and to that of the plate. */
static mpm_status weigh(const press *p, int tool, double *force, double *lost) {
  mpm_contact_info contact = {.struct_size = sizeof contact};
  double floor[3], plate[3];
  mpm_status status;
  if ((status = mpm_stepper_contact_info(p->stepper, 1, 0, &contact)) ||
      (status = mpm_stepper_wall_reaction(p->stepper, MPM_Z_MIN, floor)) ||
      (status = mpm_stepper_particles_reaction(p->stepper, p->sphere, plate)))
    return status;
  *force = -contact.force[2];
  *lost = fabs(floor[2] - *force);
  if (tool == RUBBER) *lost = fmax(*lost, fabs(plate[2] + *force));
  return MPM_OK;
}

static const char *in_directory(const char *directory, const char *file, const char *ending) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/%s%s", directory, file, ending);
  return path;
}

typedef struct curve {
  double *force, unbalanced; /* of each step; the largest share that does not balance */
  int64_t iterations;
  int grows;
} curve;

static mpm_status write_particles(const press *p, int tool, const char *directory, mpm_series *const *series,
                                  int k) {
  static const char *const fields[] = {"stress", "deformation_gradient"};
  const mpm_particles *const set[SETS] = {p->block, p->sphere};
  mpm_status status = MPM_OK;
  for (int j = 0; j < SETS && !status; ++j) {
    char name[32];
    snprintf(name, sizeof name, "%s_%04d.vtp", files[tool][j], k);
    status = mpm_write_particles(set[j], in_directory(directory, name, ""), 2, fields);
    if (!status) status = mpm_series_append(series[j], (double)k, name);
  }
  return status;
}

/* Steps are shorter where bodies slide by more than half a cell in one. Every fifth is written: the plate has
 * then come down by a cell. */
static mpm_status run(mpm_context *context, int tool, int cells, const char *directory, int steps, curve *c) {
  press p = {.context = context};
  mpm_series *series[SETS];
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_advance_desc advance;
  mpm_status status = open_press(&p, tool, cells);
  if (!status) status = mpm_advance_desc_init(&advance, sizeof advance);
  advance.dt_first = 1.0;
  for (int j = 0; j < SETS && !status; ++j)
    status = mpm_series_open(context, in_directory(directory, files[tool][j], ".pvd"), &series[j]);
  if (!status) status = write_particles(&p, tool, directory, series, 0);
  c->grows = 1;
  for (int k = 1; k <= steps && !status; ++k) {
    double lost = 0.0;
    advance.t_end = k;
    status = mpm_advance(p.stepper, &advance, &now);
    if (!status) status = weigh(&p, tool, &c->force[k], &lost);
    if (!status && k % STEPS_PER_CELL == 0) status = write_particles(&p, tool, directory, series, k);
    c->grows &= c->force[k] > c->force[k - 1];
    c->unbalanced = fmax(c->unbalanced, lost / c->force[k]);
    c->iterations += now.newton_iterations;
  }
  for (int j = 0; j < SETS && !status; ++j) status = mpm_series_close(series[j]);
  return status ? status : close_press(&p);
}

static int write_table(const char *directory, int steps, double step, const curve *c) {
  FILE *csv = fopen(in_directory(directory, "force", ".csv"), "w");
  if (!csv) return 1;
  printf("depth/mm   steel/N   Hertz/N    ratio  rubber/N   Hertz/N    ratio\n");
  fprintf(csv, "depth_mm,steel_N,steel_hertz_N,rubber_N,rubber_hertz_N\n");
  for (int k = 1; k <= steps; ++k) {
    const double d = k * step, *F[TOOLS] = {c[STEEL].force, c[RUBBER].force};
    const double H[TOOLS] = {hertz(STEEL, d), hertz(RUBBER, d)};
    fprintf(csv, "%.4f,%.6f,%.6f,%.6f,%.6f\n", 1e3 * d, F[STEEL][k], H[STEEL], F[RUBBER][k], H[RUBBER]);
    if (k % STEPS_PER_CELL == 0)
      printf("%8.3f %9.4f %9.4f %8.3f %9.4f %9.4f %8.3f\n", 1e3 * d, F[STEEL][k], H[STEEL],
             F[STEEL][k] / H[STEEL], F[RUBBER][k], H[RUBBER], F[RUBBER][k] / H[RUBBER]);
  }
  return fclose(csv);
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const int cells = argc > 2 ? atoi(argv[2]) : 16;
  if (cells < 8 || cells > 32) {
    fprintf(stderr, "indenter: cells along an edge: 8 ... 32\n");
    return 1;
  }
  const double h = edge / cells, step = h / STEPS_PER_CELL;
  const int steps = (int)lround(depth / h) * STEPS_PER_CELL;
  mpm_context *context = NULL;
  curve c[TOOLS] = {{.force = NULL}, {.force = NULL}};
  mpm_status status = mpm_context_create(NULL, &context);
  for (int tool = 0; tool < TOOLS && !status; ++tool) {
    c[tool].force = calloc((size_t)steps + 1, sizeof *c[tool].force);
    status = c[tool].force ? run(context, tool, cells, directory, steps, &c[tool]) : MPM_E_NOMEM;
  }
  if (status) {
    fprintf(stderr, "\nindenter: %s\n", mpm_last_error(context));
    return 1;
  }
  printf("A quarter of a block and of a sphere, cells of %.3f mm\n\n", 1e3 * h);
  if (write_table(directory, steps, step, c)) {
    fprintf(stderr, "indenter: cannot write into %s\n", directory);
    return 1;
  }
  printf(
      "\nwritten to %s: force.csv; block, sphere, soft_block, soft_sphere, each .pvd with its .vtp (open in "
      "ParaView)\n",
      directory);
  const double unbalanced = fmax(c[STEEL].unbalanced, c[RUBBER].unbalanced), d = steps * step;
  printf("result: steel %.2f N, %.3f of Hertz; rubber %.2f N, %.3f of Hertz; forces balance to %.1e, %" PRId64
         " iterations\n",
         c[STEEL].force[steps], c[STEEL].force[steps] / hertz(STEEL, d), c[RUBBER].force[steps],
         c[RUBBER].force[steps] / hertz(RUBBER, d), unbalanced, c[STEEL].iterations + c[RUBBER].iterations);
  /* forces on each node balance to 1e-8 of their norm, those on thousands of them together to 1e-6 */
  const int good = c[STEEL].grows && c[RUBBER].grows && unbalanced < 1e-6;
  for (int tool = 0; tool < TOOLS; ++tool) free(c[tool].force);
  return mpm_context_destroy(context) || !good;
}
