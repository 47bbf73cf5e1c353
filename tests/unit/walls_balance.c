/* The balance of walls: impulse, work and energy, for every basis and kind of wall. */
#include "walls.h"
#include "tables.h"

enum { CLOUD = 160 };

typedef struct balance {
  world w;
  mpm_particles *set;
  double *mass, total, dt, scale;
  char name[96];
} balance;

static double reaction_of(balance *b, const wall_setup *walls, int32_t face, double friction, double *force) {
  ck_ok(&b->w, mpm_stepper_wall_reaction(b->w.stepper, face, force));
  const int32_t k = face / 2, kind = walls->kind[face];
  const double normal = face % 2 ? -force[k] : force[k];
  double along = 0.0;
  for (int32_t c = 0; c < b->w.dim; ++c)
    if (c != k) along += force[c] * force[c];
  if (!wall_is_linear(kind)) ck_assert_double_ge(normal, 0.0); /* pushes, never pulls */
  if (!wall_is_linear(kind)) /* to rounding of momentum, which is all that is left of a light touch */
    ck_between(b->name, sqrt(along) * b->dt, 0.0, friction * normal * b->dt + 1e-12 * b->scale);
  return normal;
}

static void check_step(balance *b, const wall_setup *walls, double friction, const double *gravity) {
  const int32_t dim = b->w.dim;
  const mpm_step_info before = world_info(&b->w);
  double *v0 = fetch(&b->w, b->set, "velocity", dim), *x0 = fetch(&b->w, b->set, "position", dim);
  const mpm_step_info after = world_step(&b->w, b->dt);
  double *x1 = fetch(&b->w, b->set, "position", dim), reaction[3] = {0.0, 0.0, 0.0}, work = 0.0;
  double scale = 0.0;
  for (int64_t i = 0; i < dim * CLOUD; ++i)
    scale += b->mass[i % CLOUD] * (fabs(v0[i]) + b->dt * fabs(gravity[i / CLOUD]));
  b->scale = scale;
  int64_t n;
  double *of_nodes = fetch_nodes(&b->w, "reaction", &n);
  for (int32_t face = 0; face < 2 * dim; ++face) {
    double force[3] = {0.0, 0.0, 0.0};
    if (walls->periodic && face / 2 == 1) continue;
    reaction_of(b, walls, face, friction, force);
    for (int32_t c = 0; c < dim; ++c) reaction[c] += force[c];
    for (int32_t c = 0; c < dim; ++c)
      if (walls->kind[face] < MPM_WALL_FIXED || (walls->kind[face] == MPM_WALL_SLIP && c != face / 2))
        ck_within(b->name, force[c], 0.0, 0.0);
  }
  for (int64_t i = 0; i < dim * CLOUD; ++i) {
    double away = x1[i] - x0[i]; /* without the period of the axis */
    if (walls->periodic && i / CLOUD == 1 && fabs(away) > 0.01) away = 0.0;
    work += b->mass[i % CLOUD] * gravity[i / CLOUD] * away;
  }
  for (int32_t c = 0; c < dim; ++c) {
    ck_within(b->name, b->dt * sum_of(n, of_nodes + c * n), b->dt * reaction[c], 1e-12 * scale);
    ck_within(b->name, after.momentum[c] - before.momentum[c], b->dt * (reaction[c] + b->total * gravity[c]),
              1e-12 * scale);
  }
  const double energy = before.kinetic_energy + before.strain_energy,
               small = 1e-12 * (energy + b->dt * scale);
  if (!walls->periodic) ck_within(b->name, after.external_work, work, small); /* walls do none */
  ck_within(b->name, after.dissipation,
            energy + after.external_work - after.kinetic_energy - after.strain_energy, small);
  free(v0), free(x0), free(x1), free(of_nodes);
}

/* Moves the particles of two layers of cells away from the nodes between: these have next to no mass then,
 * but forces all the same on the linear basis. */
static void thin_out(balance *b) {
  double *x = fetch(&b->w, b->set, "position", b->w.dim);
  for (int64_t p = 0; p < CLOUD; ++p) {
    const double layer = floor(x[p] / 0.1);
    if (layer == 1.0) x[p] = 0.1 * (layer + 1e-6);
    if (layer == 2.0) x[p] = 0.1 * (layer + 1.0 - 1e-6);
  }
  put(&b->w, b->set, "position", b->w.dim, x);
  free(x);
}

static void check_balance(const method *how, const wall_setup *walls, int32_t dim, int64_t cells,
                          int32_t thin) {
  const double gravity[3] = {3.0, -10.0, 1.0}, friction = 0.3;
  balance b = {.dt = 2e-5};
  world_desc desc = world_with(how, dim, cells, 0.1);
  wall_describe(walls, &desc.grid);
  memcpy(desc.stepper.gravity, gravity, sizeof gravity);
  snprintf(b.name, sizeof b.name, "%s, %d-D, walls %d, %d cells%s", how->name, (int)dim,
           (int)(walls - wall_setups), (int)cells, thin ? ", thin" : "");
  b.set = world_open(&b.w, &desc);
  dice d = {11};
  add_cloud(&b.w, b.set, &d, CLOUD, 0.1, 0.0, 0.1 * (double)cells, 1.0);
  if (carries_matrix(how->transfer)) add_affine(&b.w, b.set, &d, 3.0);
  if (thin) thin_out(&b);
  wall_set(&b.w, walls, friction);
  b.mass = fetch(&b.w, b.set, "mass", 1);
  b.total = sum_of(CLOUD, b.mass);
  for (int32_t step = 0; step < 4; ++step) check_step(&b, walls, friction, gravity);
  free(b.mass);
  world_close(&b.w);
}

/* What the walls give is what the particles get: reactions and weight are the change of momentum, and the
 * reactions of nodes add up to those of faces. */
START_TEST(impulses_balance) {
  const method how = wall_method_of(_i);
  for (int32_t setup = 0; setup < WALL_SETUPS; ++setup)
    for (int32_t dim = 1; dim <= 3; ++dim)
      for (int32_t thin = 0; thin < 2; ++thin) check_balance(&how, &wall_setups[setup], dim, 6, thin);
}
END_TEST

START_TEST(impulses_balance_on_tiny_grids) {
  const method how = wall_method_of(_i);
  for (int32_t setup = 0; setup < WALL_SETUPS; ++setup)
    for (int32_t dim = 1; dim <= 3; ++dim)
      for (int64_t cells = 1; cells <= 3; ++cells) check_balance(&how, &wall_setups[setup], dim, cells, 0);
}
END_TEST

TCase *walls_balance_case(TCase *wide) {
  TCase *tc = tcase_create("balance");
  tcase_set_timeout(tc, 60.0);
  add_table(tc, wide, impulses_balance, WALL_METHODS);
  add_table(tc, wide, impulses_balance_on_tiny_grids, WALL_METHODS);
  return tc;
}
