/* Particle-steps per second of whole explicit steps through the public interface: a jittered, shuffled body
 * that rotates and strains, mpm_stable_dt and mpm_step every step, re-sorts included.
 *
 *   throughput [particles] [steps] [threads ...]          default 1000000 40 1 2 */
#include <math.h>
#include <mpm/mpm.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double seconds(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double uniform(uint64_t *state) {
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return (double)(*state >> 11) * 0x1p-53;
}

typedef struct benchmark {
  const char *name;
  int32_t dim, basis, scheme, transfer;
  const char *law;
  double cfl;
} benchmark;

/* The linear basis needs small steps at a free surface, where nodes are light. */
static const benchmark cases[] = {
    {"3-D quadratic FLIP", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3},
    {"3-D quadratic APIC_MLS", 3, MPM_BSPLINE2, MPM_USL, MPM_APIC_MLS, "neo_hookean", 0.3},
    {"3-D quadratic APIC", 3, MPM_BSPLINE2, MPM_USL, MPM_APIC, "neo_hookean", 0.3},
    {"3-D linear FLIP", 3, MPM_LINEAR, MPM_USL, MPM_FLIP, "neo_hookean", 0.02},
    {"3-D quadratic FLIP MUSL", 3, MPM_BSPLINE2, MPM_MUSL, MPM_FLIP, "neo_hookean", 0.3},
    {"3-D quadratic FLIP J2", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "j2", 0.3},
    {"2-D quadratic FLIP", 2, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3},
    {"1-D quadratic FLIP", 1, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3},
};
static const mpm_param parameters[] = {
    {"E", 1.0}, {"nu", 0.3}, {"density", 1.0}, {"yield_stress", 0.02}, {"hardening", 0.1}};

/* A cube of side^dim particles, 2^dim per cell, in the middle of a grid three times as wide. */
static mpm_status fill(mpm_particles *set, int32_t dim, int64_t side, double cells) {
  uint64_t state = 88172645463325252u;
  int64_t n = 1;
  for (int32_t k = 0; k < dim; ++k) n *= side;
  double *x = malloc((size_t)(n * dim) * sizeof *x), *v = malloc((size_t)(n * dim) * sizeof *v);
  double *volume = malloc((size_t)n * sizeof *volume);
  int64_t *order = malloc((size_t)n * sizeof *order);
  if (!x || !v || !volume || !order) exit(1);
  for (int64_t i = 0; i < n; ++i) order[i] = i;
  for (int64_t i = n - 1; i > 0; --i) {
    const int64_t j = (int64_t)(uniform(&state) * (double)(i + 1)), swap = order[i];
    order[i] = order[j];
    order[j] = swap;
  }
  for (int64_t i = 0; i < n; ++i) {
    int64_t place = order[i];
    double at[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim; ++k) {
      x[k * n + i] = cells + 0.5 * ((double)(place % side) + 0.25 + 0.5 * uniform(&state));
      at[k] = (x[k * n + i] - 1.25 * cells) / cells;
      place /= side;
    }
    const double rate[3] = {0.1 * at[2] - at[1], at[0] - 0.2 * at[2], 0.15 * at[0] + 0.1 * at[1]};
    for (int32_t k = 0; k < dim; ++k) v[k * n + i] = dim > 1 ? rate[k] : 0.2 * at[0] + 0.5;
    volume[i] = pow(0.5, dim);
  }
  const mpm_status status = mpm_particles_add(set, n, x, v, volume, NULL, NULL, NULL);
  free(x), free(v), free(volume), free(order);
  return status;
}

typedef struct simulation {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *body;
  mpm_stepper *stepper;
} simulation;

static mpm_status set_up(simulation *sim, const benchmark *b, int64_t particles, int32_t threads) {
  mpm_context_desc services;
  mpm_context_desc_init(&services, sizeof services);
  services.concurrency = threads;
  mpm_status status = mpm_context_create(&services, &sim->context);
  if (status) return status;
  const int64_t side = (int64_t)llround(pow((double)particles, 1.0 / b->dim));
  const double cells = ceil(0.5 * (double)side);
  mpm_grid_desc g;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = b->dim;
  g.basis = b->basis;
  for (int32_t k = 0; k < b->dim; ++k) {
    g.spacing[k] = 1.0;
    g.cells[k] = 3 * (int64_t)cells;
  }
  mpm_stepper_desc s;
  mpm_stepper_desc_init(&s, sizeof s);
  s.scheme = b->scheme;
  s.transfer = b->transfer;
  const int32_t count = b->law[0] == 'j' ? 5 : 3;
  if ((status = mpm_grid_create(sim->context, &g, &sim->grid)) ||
      (status = mpm_material_create(sim->context, b->law, parameters, count, &sim->material)) ||
      (status = mpm_particles_create(sim->context, sim->grid, sim->material, &sim->body)) ||
      (status = fill(sim->body, b->dim, side, cells)) ||
      (status = mpm_stepper_create(sim->context, sim->grid, &s, &sim->stepper)))
    return status;
  return mpm_stepper_add(sim->stepper, sim->body);
}

enum { WARM_UP = 5 };

static mpm_status measure(const simulation *sim, const benchmark *b, int32_t steps, int32_t threads) {
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_profile stage = {.struct_size = sizeof stage};
  int64_t bytes, peak, first_resorts = 0;
  double best = 1e300, total = 0.0, dt;
  mpm_status status = MPM_OK;
  for (int32_t i = -WARM_UP; i < steps && !status; ++i) {
    if (i == 0) {
      mpm_stepper_profile(sim->stepper, 1, &stage);
      first_resorts = info.resorts;
    }
    const double from = seconds();
    status = mpm_stable_dt(sim->stepper, &dt);
    if (!status) status = mpm_step(sim->stepper, b->cfl * dt, &info);
    const double took = seconds() - from;
    if (i < 0) continue;
    total += took;
    best = took < best ? took : best;
  }
  if (status) return status;
  mpm_stepper_profile(sim->stepper, 0, &stage);
  mpm_context_memory(sim->context, &bytes, &peak);
  const double n = (double)mpm_particles_count(sim->body), ns = 1e9 / n / steps;
  printf("%-24s %7.0fk %2d thread%c %6.2f Mp/s (best %6.2f)  ns: p2g %5.1f grid %4.1f g2p %5.1f law %5.1f "
         "sort %4.1f"
         "  resorts %lld  %4.0f B/particle\n",
         b->name, 1e-3 * n, (int)threads, threads > 1 ? 's' : ' ', 1e-6 * n * steps / total, 1e-6 * n / best,
         stage.p2g * ns, stage.grid * ns, stage.g2p * ns, stage.law * ns, stage.sort * ns,
         (long long)(info.resorts - first_resorts), (double)peak / n);
  fflush(stdout);
  return MPM_OK;
}

static int run(const benchmark *b, int64_t particles, int32_t steps, int32_t threads) {
  simulation sim = {0};
  mpm_status status = set_up(&sim, b, particles, threads);
  if (!status) status = measure(&sim, b, steps, threads);
  if (status) fprintf(stderr, "%s: %s\n", b->name, mpm_last_error(sim.context));
  if (sim.stepper) mpm_stepper_destroy(sim.stepper);
  if (sim.body) mpm_particles_destroy(sim.body);
  mpm_material_destroy(sim.material);
  mpm_grid_destroy(sim.grid);
  mpm_context_destroy(sim.context);
  return status != MPM_OK;
}

int main(int argc, char **argv) {
  const int64_t particles = argc > 1 ? atoll(argv[1]) : 1000000;
  const int32_t steps = argc > 2 ? atoi(argv[2]) : 40;
  int failed = 0;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    if (argc <= 3) failed |= run(&cases[c], particles, steps, 1) | run(&cases[c], particles, steps, 2);
    for (int i = 3; i < argc; ++i) failed |= run(&cases[c], particles, steps, atoi(argv[i]));
  }
  return failed;
}
