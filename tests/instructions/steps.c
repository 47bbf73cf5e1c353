/* A small fixed body steps through the public interface, for callgrind to count: steps CASE. Prints the
 * particle-steps done. The steps are alike except for the first, which sorts. */
#include <mpm/mpm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 8, MOST_OBSTACLES = 10 };

typedef struct scene {
  const char *name;
  int32_t dim, basis, transfer;
  int32_t cells;     /* of the body on each axis, with two particles on each axis in a cell */
  int32_t obstacles; /* spheres that are far from it */
  int32_t halves;    /* it is cut in the middle of the last axis: two bodies, which touch all over the cut */
  int32_t carries;   /* a free sphere in it, which flies with it: changes are small beside velocities */
  double shift;      /* of all particles, in cells: the last layers hardly reach their outer nodes */
} scene;
static const scene scenes[] = {
    {"3-D quadratic FLIP", 3, MPM_BSPLINE2, MPM_FLIP, 12, 0, 0, 0, 0.0},
    {"3-D quadratic APIC_MLS", 3, MPM_BSPLINE2, MPM_APIC_MLS, 12, 0, 0, 0, 0.0},
    {"3-D linear FLIP", 3, MPM_LINEAR, MPM_FLIP, 12, 0, 0, 0, 0.0},
    {"2-D quadratic FLIP", 2, MPM_BSPLINE2, MPM_FLIP, 48, 0, 0, 0, 0.0},
    {"3-D quadratic FLIP, far obstacles", 3, MPM_BSPLINE2, MPM_FLIP, 12, MOST_OBSTACLES, 0, 0, 0.0},
    {"3-D quadratic FLIP, halves in contact", 3, MPM_BSPLINE2, MPM_FLIP, 6, 0, 1, 0, 0.0},
    {"2-D quadratic FLIP, carried sphere", 2, MPM_BSPLINE2, MPM_FLIP, 48, 0, 0, 1, 0.0},
    {"3-D linear FLIP, light nodes", 3, MPM_LINEAR, MPM_FLIP, 12, 0, 0, 0, 0.3}};

typedef struct simulation {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set[2];
  int32_t sets;
  mpm_stepper *stepper;
  mpm_obstacle *obstacle[MOST_OBSTACLES];
} simulation;

static const double speed = 10.0; /* of all that flies, along each axis */

/* It turns and strains, so that no term is zero. */
static mpm_status spin(mpm_particles *set, int32_t dim, double middle, double along, double shift) {
  const int64_t n = mpm_particles_count(set);
  double *x = malloc((size_t)(dim * n) * sizeof *x), *v = malloc((size_t)(dim * n) * sizeof *v);
  if (!x || !v) exit(1);
  mpm_status status = mpm_particles_get(set, "position", MPM_F64, dim, n, NULL, x);
  for (int64_t i = 0; i < n; ++i) {
    double at[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim; ++k) at[k] = (x[k * n + i] - middle) / middle;
    const double rate[3] = {0.1 * at[2] - at[1], at[0] - 0.2 * at[2], 0.15 * at[0] + 0.1 * at[1]};
    for (int32_t k = 0; k < dim; ++k) v[k * n + i] = 0.2 * rate[k] + along;
    for (int32_t k = 0; k < dim; ++k) x[k * n + i] += shift;
  }
  if (!status) status = mpm_particles_set(set, "position", MPM_F64, dim, n, NULL, x);
  if (!status) status = mpm_particles_set(set, "velocity", MPM_F64, dim, n, NULL, v);
  free(x), free(v);
  return status;
}

/* Beyond the blocks of the body. */
static mpm_status add_obstacles(simulation *sim, const scene *in) {
  mpm_contact_desc contact;
  mpm_obstacle_desc d;
  mpm_status status = mpm_contact_desc_init(&contact, sizeof contact);
  if (!status) status = mpm_obstacle_desc_init(&d, sizeof d);
  for (int32_t i = 0; i < in->obstacles && !status; ++i) {
    d.contact = &contact;
    d.shape = MPM_SHAPE_SPHERE;
    d.size[0] = 1.0;
    for (int32_t k = 0; k < in->dim; ++k) d.position[k] = 3.0 * in->cells;
    d.position[i % in->dim] = 0.25 * in->cells * i;
    status = mpm_obstacle_create(sim->context, &d, &sim->obstacle[i]);
    if (!status) status = mpm_stepper_add_obstacle(sim->stepper, sim->obstacle[i]);
  }
  return status;
}

static mpm_status add_carried(simulation *sim, const scene *in) {
  mpm_contact_desc contact;
  mpm_obstacle_desc d;
  if (!in->carries) return MPM_OK;
  mpm_status status = mpm_contact_desc_init(&contact, sizeof contact);
  if (!status) status = mpm_obstacle_desc_init(&d, sizeof d);
  if (status) return status;
  contact.friction = contact.friction_static = 0.3;
  d.contact = &contact;
  d.shape = MPM_SHAPE_SPHERE;
  d.motion = MPM_MOTION_FREE;
  d.size[0] = 0.25 * in->cells;
  d.mass = 0.2 * in->cells * in->cells;
  d.inertia[8] = 0.5 * d.mass * d.size[0] * d.size[0];
  for (int32_t k = 0; k < in->dim; ++k) d.position[k] = in->cells, d.velocity[k] = speed;
  status = mpm_obstacle_create(sim->context, &d, &sim->obstacle[0]);
  return status ? status : mpm_stepper_add_obstacle(sim->stepper, sim->obstacle[0]);
}

static mpm_status add_set(simulation *sim, const scene *in, int32_t which) {
  static const int32_t per_cell[3] = {2, 2, 2};
  const int32_t last = in->dim - 1;
  double lower[3], upper[3];
  for (int32_t k = 0; k < in->dim; ++k) {
    lower[k] = which && k == last ? in->cells : 0.5 * in->cells;
    upper[k] = in->halves && !which && k == last ? in->cells : 1.5 * in->cells;
  }
  mpm_particles **set = &sim->set[which];
  mpm_status status = mpm_particles_create(sim->context, sim->grid, sim->material, set);
  if (!status) status = mpm_particles_fill_box(*set, lower, upper, per_cell, NULL, NULL);
  if (!status) status = spin(*set, in->dim, in->cells, in->carries ? speed : 0.0, in->shift);
  if (!status) status = mpm_stepper_add(sim->stepper, *set);
  if (!status && which) status = mpm_stepper_set_body(sim->stepper, *set, which);
  return status;
}

static mpm_status set_up(simulation *sim, const scene *in) {
  static const mpm_param elastic[] = {{"E", 1.0}, {"nu", 0.3}, {"density", 1.0}};
  mpm_context_desc c;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_context_desc_init(&c, sizeof c);
  mpm_grid_desc_init(&g, sizeof g);
  mpm_stepper_desc_init(&s, sizeof s);
  c.concurrency = 1;
  c.isa = MPM_ISA_BASELINE; /* all that valgrind knows for certain */
  g.dim = in->dim;
  g.basis = in->basis;
  for (int32_t k = 0; k < in->dim; ++k) {
    g.spacing[k] = 1.0;
    g.cells[k] = 4 * in->cells; /* obstacles are beyond the body's blocks */
  }
  s.transfer = in->transfer;
  mpm_status status = mpm_context_create(&c, &sim->context);
  if (!status) status = mpm_grid_create(sim->context, &g, &sim->grid);
  if (!status) status = mpm_material_create(sim->context, "neo_hookean", elastic, 3, &sim->material);
  if (!status) status = mpm_stepper_create(sim->context, sim->grid, &s, &sim->stepper);
  sim->sets = 1 + in->halves;
  for (int32_t m = 0; m < sim->sets && !status; ++m) status = add_set(sim, in, m);
  if (!status) status = add_obstacles(sim, in);
  if (!status) status = add_carried(sim, in);
  return status;
}

static int run(const scene *in) {
  simulation sim = {0};
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_status status = set_up(&sim, in);
  for (int32_t i = 0; i < STEPS && !status; ++i) status = mpm_step(sim.stepper, 0.02, &info);
  if (status) fprintf(stderr, "%s: %s\n", in->name, mpm_last_error(sim.context));
  int64_t particles = 0;
  for (int32_t m = 0; m < sim.sets; ++m) particles += mpm_particles_count(sim.set[m]);
  if (!status) printf("%lld\n", (long long)(STEPS * particles));
  mpm_stepper_destroy(sim.stepper);
  for (int32_t i = 0; i < in->obstacles + in->carries; ++i) mpm_obstacle_destroy(sim.obstacle[i]);
  for (int32_t m = 0; m < sim.sets; ++m) mpm_particles_destroy(sim.set[m]);
  mpm_material_destroy(sim.material);
  mpm_grid_destroy(sim.grid);
  mpm_context_destroy(sim.context);
  return status != MPM_OK;
}

/* Without a case: their names. */
int main(int argc, char **argv) {
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; ++i) {
    if (argc < 2) puts(scenes[i].name);
    if (argc > 1 && !strcmp(scenes[i].name, argv[1])) return run(&scenes[i]);
  }
  return argc > 1;
}
