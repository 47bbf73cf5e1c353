/* A step in parts, with a second solver between them: an elastic bar flies through space with a mass on a
 * spring at its right end. The bar is libmpm's; spring and mass are the host's.
 *
 *   mpm_step_begin   the grid has masses, velocities and internal forces
 *     host           the spring's force goes onto the nodes at the end of the bar
 *   mpm_step_grid    the grid has its new velocities
 *     host           the mass takes the opposite impulse; the spring's end moves with the nodes
 *   mpm_step_end     the particles follow
 *
 * Nothing acts from outside, so momentum stays exactly, and energy nearly. Bar and mass start in their first
 * common mode of vibration, whose period is known. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double h = 1.0 / 40.0, left = 0.25, length = 1.0, width = 0.1;
static const double E = 100.0, density = 1.0; /* nu = 0: the bar is uniaxial */
static const double k_spring = 10.0, mass = 0.1, drift_speed = 0.1, amplitude = 0.1;

/* The host's solver. */
typedef struct spring_mass {
  double end;  /* position of the spring's end at the bar */
  double x, v; /* of the mass; the spring is unstretched when x = end */
  int64_t n;   /* nodes that the spring holds on to */
  int64_t node[64];
  double share[64]; /* of each in force and velocity, adding up to 1 */
} spring_mass;

/* Wave number b of the first mode: u = cos(b X) in the bar, with w = b sqrt(E/density), and the mass swinging
 * with y = k u(L) / (k - M w^2), so that E A u'(L) = k (y - u(L)). Multiplied out to be free of poles. */
static double mode_equation(double b) {
  const double w2 = b * b * E / density, EA = E * width;
  return EA * b * sin(b * length) * (k_spring - mass * w2) + k_spring * mass * w2 * cos(b * length);
}

static double first_mode(void) {
  double low = 1e-3, high = low;
  while (mode_equation(high) > 0.0) high += 1e-3;
  low = high - 1e-3;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    *(mode_equation(middle) > 0.0 ? &low : &high) = middle;
  }
  return low;
}

/* Component c of item i of a view. */
static double *at(const mpm_view *view, int64_t i, int c) {
  return (double *)view->data + i * view->item_stride + c * view->component_stride;
}

/* Finds the nodes around the spring's end, and puts the spring's force on them. Shares go with nodal mass, so
 * that neighbours are accelerated alike; the same shares give the velocity of the end, so that force times
 * velocity is the same power on both sides. The shares reach over two cells: over one, the period is closer
 * to theory (+0.1 %), but 3 % of the energy is lost, whatever dt. */
static mpm_status push(mpm_stepper *stepper, spring_mass *s) {
  mpm_view position = {.struct_size = sizeof position}, node_mass = {.struct_size = sizeof node_mass},
           force = {.struct_size = sizeof force};
  mpm_status status = mpm_grid_map(stepper, 0, "position", MPM_READ, &position);
  if (!status) status = mpm_grid_map(stepper, 0, "mass", MPM_READ, &node_mass);
  if (!status) status = mpm_grid_map(stepper, 0, "force", MPM_READ | MPM_WRITE, &force);
  if (status) return status;
  double sum = 0.0;
  s->n = 0;
  for (int64_t i = 0; i < position.count && s->n < 64; ++i) {
    const double weight = (1.0 - fabs(*at(&position, i, 0) - s->end) / (2.0 * h)) * *at(&node_mass, i, 0);
    if (weight <= 0.0) continue;
    s->node[s->n] = i;
    s->share[s->n++] = weight;
    sum += weight;
  }
  for (int64_t j = 0; j < s->n; ++j) {
    s->share[j] /= sum;
    *at(&force, s->node[j], 0) += s->share[j] * k_spring * (s->x - s->end);
  }
  status = mpm_view_release(&force);
  if (!status) status = mpm_view_release(&node_mass);
  return status ? status : mpm_view_release(&position);
}

/* Moves the mass and the spring's end over dt. */
static mpm_status follow(mpm_stepper *stepper, spring_mass *s, double dt) {
  mpm_view velocity = {.struct_size = sizeof velocity};
  const mpm_status status = mpm_grid_map(stepper, 0, "velocity", MPM_READ, &velocity);
  if (status) return status;
  double end_velocity = 0.0;
  for (int64_t j = 0; j < s->n; ++j) end_velocity += s->share[j] * *at(&velocity, s->node[j], 0);
  s->v -= dt / mass * k_spring * (s->x - s->end);
  s->x += dt * s->v;
  s->end += dt * end_velocity;
  return mpm_view_release(&velocity);
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
  g.cells[0] = 80;
  g.cells[1] = 12;
  g.origin[1] = -4.0 * h;
  g.spacing[0] = g.spacing[1] = h;
  s.scheme = MPM_USL;

  const mpm_param elastic[] = {{"E", E}, {"nu", 0.0}, {"density", density}};
  const double lower[] = {left, 0.0}, upper[] = {left + length, width};
  const int32_t per_cell[] = {3, 2};
  int64_t n;
  double stable;
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &bar) ||
      mpm_particles_fill_box(bar, lower, upper, per_cell, NULL, &n) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, bar) ||
      mpm_stable_dt(stepper, &stable))
    goto failed;

  /* Start: the first mode passes through rest, on top of a common drift. */
  const double b = first_mode(), omega = b * sqrt(E / density), period = 2.0 * pi / omega;
  spring_mass load = {.end = left + length, .x = left + length};
  load.v = drift_speed + amplitude * k_spring * cos(b * length) / (k_spring - mass * omega * omega);
  double *x = malloc(4 * (size_t)n * sizeof *x), *v = x + 2 * n;
  if (!x) {
    fprintf(stderr, "staged_coupling: out of memory\n");
    return 1;
  }
  if (mpm_particles_get(bar, "position", MPM_F64, 2, n, NULL, x)) goto failed;
  for (int64_t i = 0; i < n; ++i) {
    v[i] = drift_speed + amplitude * cos(b * (x[i] - left));
    v[n + i] = 0.0;
  }
  mpm_step_info now = {.struct_size = sizeof now};
  if (mpm_particles_set(bar, "velocity", MPM_F64, 2, n, NULL, v) || mpm_stepper_info(stepper, &now))
    goto failed;
  free(x);

  enum { PERIODS = 4, ROWS = 4 * PERIODS };
  const int steps = ROWS * (int)ceil(PERIODS * period / (0.3 * stable * ROWS));
  const double dt = PERIODS * period / steps;
  const double momentum0 = now.momentum[0] + mass * load.v;
  const double all_mass = density * length * width + mass,
               drift_energy = 0.5 * momentum0 * momentum0 / all_mass;
  double vibration0 = 0.0, energy_error = 0.0, momentum_error = 0.0, first = 0.0, last = 0.0, before = 0.0;
  int crossings = 0;
  printf("   t    spring      bar p      mass p     sum of p      energy of vibration\n");
  for (int k = 0; k <= steps; ++k) {
    if (k > 0 && (mpm_step_begin(stepper, dt) || push(stepper, &load) || mpm_step_grid(stepper) ||
                  follow(stepper, &load, dt) || mpm_step_end(stepper, &now)))
      goto failed;
    const double stretch = load.x - load.end, momentum = now.momentum[0] + mass * load.v;
    const double vibration = now.kinetic_energy + now.strain_energy + 0.5 * mass * load.v * load.v +
                             0.5 * k_spring * stretch * stretch - drift_energy;
    if (k == 0) vibration0 = vibration;
    energy_error = fmax(energy_error, fabs(vibration / vibration0 - 1.0));
    momentum_error = fmax(momentum_error, fabs(momentum / momentum0 - 1.0));
    if (k > 0 && (before < 0.0) != (stretch < 0.0)) { /* passes through rest: twice in a period */
      last = now.t - dt * stretch / (stretch - before);
      if (crossings++ == 0) first = last;
    }
    before = stretch;
    if (k % (steps / ROWS) == 0)
      printf("%5.3f %+9.6f %10.6f %11.6f %12.9f %12.4e\n", now.t, stretch, now.momentum[0], mass * load.v,
             momentum, vibration);
  }
  const double measured = 2.0 * (last - first) / (crossings - 1);

  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(bar) || mpm_material_destroy(rubber) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nresult: period %.4f (theory %.4f, deviation %+.2f %%), momentum kept to %.0e, energy of "
         "vibration to %.2f %%\n",
         measured, period, 100.0 * (measured / period - 1.0), momentum_error, 100.0 * energy_error);
  return 0;

failed:
  fprintf(stderr, "staged_coupling: %s\n", mpm_last_error(ctx));
  return 1;
}
