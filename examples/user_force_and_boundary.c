/* Loads and boundary conditions of the host: a bar is fixed to the wall x = 0 and drawn out
 * by a grip at x = 1, while a body acceleration along the bar is switched on slowly and the
 * air resists. Three callbacks say so:
 *
 *   acceleration   g(t) on every particle,
 *   force          -damping * mass * velocity on every particle,
 *   velocity       the speed of the grip on the nodes at and beyond x = 1.
 *
 * When all has come to rest, the forces of wall and grip are those of statics, and the work put in is the
 * energy stored. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;
static const double h = 0.025, length = 1.0, grip_length = 0.1, width = 0.1;
static const double E = 100.0, density = 1.0; /* nu = 0: the bar is uniaxial */
static const double t_load = 1.0, t_end = 2.0, pull = 0.005, g_full = 0.4, damping = 15.0;

/* Smooth rise from 0 to 1 during t_load, and its rate. */
static double ramp(double t) {
  return t < t_load ? 0.5 * (1.0 - cos(pi * t / t_load)) : 1.0;
}

static mpm_status body_acceleration(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) add[p] += g_full * ramp(b->t);
  return MPM_OK;
}

static mpm_status drag(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p)
    for (int c = 0; c < 2; ++c) add[c * b->ld + p] -= damping * b->mass[p] * b->velocity[c * b->ld + p];
  return MPM_OK;
}

/* Mean velocity of the step: the grip then is where the ramp has it, whatever dt. */
static double grip_speed(double t, double dt) {
  return pull * (ramp(t + dt) - ramp(t)) / dt;
}

static mpm_status grip(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->position[i] < length - 0.01 * h) continue;
    prescribed[i] = 1;
    velocity[i] = grip_speed(b->t, b->dt);
  }
  return MPM_OK;
}

/* Force along x that the held nodes at and beyond x_min exert on the material. */
static mpm_status reaction_beyond(mpm_stepper *stepper, double x_min, double *force) {
  mpm_view position = {.struct_size = sizeof position}, reaction = {.struct_size = sizeof reaction};
  mpm_status status = mpm_grid_map(stepper, 0, "position", MPM_READ, &position);
  if (!status) status = mpm_grid_map(stepper, 0, "reaction", MPM_READ, &reaction);
  if (status) return status;
  *force = 0.0;
  for (int64_t i = 0; i < reaction.count; ++i)
    if (((const double *)position.data)[i * position.item_stride] > x_min - 0.01 * h)
      *force += ((const double *)reaction.data)[i * reaction.item_stride];
  status = mpm_view_release(&reaction);
  return status ? status : mpm_view_release(&position);
}

int main(void) {
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *bar;
  mpm_stepper *stepper;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s))
    goto failed;
  g.dim = 2;
  g.basis = MPM_BSPLINE2;
  g.origin[1] = -2.0 * h;
  g.cells[0] = 48;
  g.cells[1] = 8;
  g.spacing[0] = g.spacing[1] = h;
  s.scheme = MPM_USL;

  const mpm_param elastic[] = {{"E", E}, {"nu", 0.0}, {"density", density}};
  const double lower[] = {0.0, 0.0}, upper[] = {length + grip_length, width};
  const int32_t per_cell[] = {2, 2};
  double stable;
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &bar) ||
      mpm_particles_fill_box(bar, lower, upper, per_cell, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, bar) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0) ||
      mpm_stepper_set_acceleration(stepper, body_acceleration, NULL) ||
      mpm_stepper_set_force(stepper, drag, NULL) || mpm_stepper_set_velocity_bc(stepper, grip, NULL) ||
      mpm_stable_dt(stepper, &stable))
    goto failed;

  const int steps = (int)ceil(t_end / (0.4 * stable));
  const double dt = t_end / steps;
  double work = 0.0, grip_work = 0.0, wall[2] = {0.0, 0.0}, grip_force = 0.0;
  mpm_step_info now = {.struct_size = sizeof now};
  printf("   t   wall force   grip force   work put in   of it grip   energy held\n");
  for (int k = 1; k <= steps; ++k) {
    const double speed = grip_speed(now.t, dt);
    if (mpm_step(stepper, dt, &now) || reaction_beyond(stepper, length, &grip_force) ||
        mpm_stepper_wall_reaction(stepper, MPM_X_MIN, wall))
      goto failed;
    work += now.external_work; /* of acceleration, drag and grip together */
    grip_work += grip_force * speed * dt;
    if (k % (steps / 10) == 0)
      printf("%4.2f %12.6f %12.6f %13.4e %12.4e %13.4e\n", now.t, wall[0], grip_force, work, grip_work,
             now.kinetic_energy + now.strain_energy);
  }

  /* Statics: the normal force falls linearly from the wall to the grip;
   * the grip also holds its own piece of bar. */
  const double area = width, stretch = 1.0 + pull / length, weight = density * area * length * g_full;
  const double mean_force = 0.5 * E * area * (stretch - 1.0 / stretch);
  const double wall_static = -(mean_force + 0.5 * weight);
  const double grip_static = mean_force - 0.5 * weight - density * area * grip_length * g_full;
  const double held = now.kinetic_energy + now.strain_energy;
  printf("\nstatics %12.6f %12.6f\n", wall_static, grip_static);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(bar) || mpm_material_destroy(rubber) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("result: wall force %.5f (deviation %+.2f %%), grip force %.5f (deviation %+.2f %%), "
         "energy balance %+.2f %%\n",
         wall[0], 100.0 * (wall[0] / wall_static - 1.0), grip_force, 100.0 * (grip_force / grip_static - 1.0),
         100.0 * (held / work - 1.0));
  return 0;

failed:
  fprintf(stderr, "user_force_and_boundary: %s\n", mpm_last_error(ctx));
  return 1;
}
