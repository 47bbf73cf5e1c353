/* What calls and callbacks cost from C: the scene of bindings/python/costs.py. Each kind makes five steps in
 * a row, by turns. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <mpm/mpm.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static mpm_status pull(void *user, const mpm_particle_batch *batch, double *add) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i) add[batch->ld + i] += batch->mass[i] * (-0.05 * batch->position[i]);
  return MPM_OK;
}

static mpm_status neo_hookean(void *user, const mpm_material_batch *b) {
  const double mu = 1e3 / 2.6, lambda = 300 / (1.3 * 0.4);
  static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) {
    double F[9];
    for (int c = 0; c < 9; ++c) F[c] = b->F[c * b->ld + p];
    const double J = (F[0] * F[4] - F[1] * F[3]) * F[8], pressure = lambda * log(J);
    for (int c = 0; c < 6; ++c) {
      const double *x = F + 3 * row[c], *y = F + 3 * column[c];
      double s = mu * (x[0] * y[0] + x[1] * y[1] + x[2] * y[2]);
      if (c < 3) s += pressure - mu;
      b->stress_new[c * b->ld + p] = s / J;
    }
    b->wave_speed[p] = 1.16;
  }
  return MPM_OK;
}

static void ensure(mpm_context *context, mpm_status status) {
  if (status == MPM_OK) return;
  fprintf(stderr, "%s\n", mpm_last_error(context));
  exit(1);
}

static mpm_stepper *make(mpm_particle_fn force, mpm_stress_fn law, mpm_particles **set) {
  mpm_context *context;
  ensure(NULL, mpm_context_create(NULL, &context));
  mpm_grid_desc box;
  mpm_grid_desc_init(&box, sizeof box);
  box.dim = 2;
  box.cells[0] = box.cells[1] = 200;
  box.spacing[0] = box.spacing[1] = 1.0 / 200;
  mpm_grid *grid;
  ensure(context, mpm_grid_create(context, &box, &grid));
  mpm_material *material;
  if (law) {
    mpm_material_desc desc;
    mpm_material_desc_init(&desc, sizeof desc);
    desc.density = 1e3;
    desc.stress = law;
    ensure(context, mpm_material_create_custom(context, &desc, &material));
  } else
    ensure(context,
           mpm_material_create(context, "neo_hookean",
                               (mpm_param[]){{"E", 1e3}, {"nu", 0.3}, {"density", 1e3}}, 3, &material));
  ensure(context, mpm_particles_create(context, grid, material, set));
  ensure(context, mpm_particles_fill_box(*set, (double[]){0.1, 0.1}, (double[]){0.45, 0.45},
                                         (int32_t[]){2, 2}, NULL, NULL));
  mpm_stepper_desc options;
  mpm_stepper_desc_init(&options, sizeof options);
  options.transfer = MPM_APIC_MLS;
  mpm_stepper *stepper;
  ensure(context, mpm_stepper_create(context, grid, &options, &stepper));
  ensure(context, mpm_stepper_add(stepper, *set));
  ensure(context, mpm_stepper_set_force(stepper, force, NULL));
  for (int k = 0; k < 20; ++k) ensure(context, mpm_step(stepper, 1e-4, NULL));
  return stepper;
}

int main(void) {
  mpm_particles *set, *other;
  mpm_stepper *kinds[] = {make(NULL, NULL, &set), make(pull, NULL, &other), make(NULL, neo_hookean, &other)};
  double best[5] = {1, 1, 1, 1, 1};
  volatile int64_t sum = 0;
  for (int k = 0; k < 200; ++k) {
    double start = now();
    for (int i = 0; i < 1000; ++i) sum += mpm_particles_count(set);
    best[3] = fmin(best[3], (now() - start) / 1000);
    start = now();
    for (int i = 0; i < 100; ++i) {
      mpm_view view = {.struct_size = sizeof view};
      if (mpm_particles_map(set, "position", MPM_READ, &view) || mpm_view_release(&view)) return 1;
    }
    best[4] = fmin(best[4], (now() - start) / 100);
  }
  for (int round = 0; round < 40; ++round)
    for (int k = 0; k < 3; ++k)
      for (int step = 0; step < 5; ++step) {
        const double start = now();
        if (mpm_step(kinds[k], 1e-4, NULL)) return 1;
        best[k] = fmin(best[k], now() - start);
      }
  printf("%lld particles: count %.1f ns, view %.0f ns, step %.0f us, force +%.0f us, law +%.0f us\n",
         (long long)mpm_particles_count(set), 1e9 * best[3], 1e9 * best[4], 1e6 * best[0],
         1e6 * (best[1] - best[0]), 1e6 * (best[2] - best[0]));
  return 0;
}
