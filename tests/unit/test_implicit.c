/* Implicit steps: Newmark's rule, convergence of the iteration, reactions, initial accelerations. */
#include "implicit.h"
#include "tables.h"
#include "body.h"

const basis_option *implicit_basis(int32_t i) {
  return &basis_options[i < 6 ? i : 7];
}

world_desc implicit_default(int32_t dim, int64_t cells, double h, const basis_option *basis) {
  world_desc d = world_default(dim, cells, h);
  use_basis(basis, &d.grid);
  d.stepper.scheme = MPM_NEWMARK;
  return d;
}

int64_t implicit_block(world *w, mpm_particles *set, double low, double high, const double *velocity) {
  const int64_t n = world_fill_cube(w, set, low, high);
  if (velocity) ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, w->dim, velocity));
  return n;
}

int32_t implicit_history(const world *w, double *residual) {
  int32_t count;
  ck_ok(w, mpm_stepper_residuals(w->stepper, IMPLICIT_HISTORY, residual, &count));
  ck_assert_int_le(count, IMPLICIT_HISTORY);
  return count;
}

/* r' <= C r^1.8 once the iteration is near: that of a tangent that is the derivative of the residual. */
void implicit_quadratic(const char *name, const world *w, double C) {
  double r[IMPLICIT_HISTORY];
  const int32_t n = implicit_history(w, r);
  int32_t checked = 0;
  for (int32_t k = 1; k + 1 < n; ++k) {
    if (r[k] > 0.05 || r[k] < 1e-7) continue;
    ++checked;
    if (!(r[k + 1] <= C * pow(r[k], 1.8) + 1e-13))
      ck_abort_msg("%s: residual %g after %g in iteration %d: more than %g r^1.8", name, r[k + 1], r[k],
                   (int)k, C);
  }
  show("%s:", name);
  for (int32_t k = 0; k < n; ++k) show(" %.1e", r[k]);
  show("\n");
  ck_assert_msg(checked > 0, "%s: no residual to check", name);
}

/* The history is that of the last step, whatever the scheme is by now. */
START_TEST(history_of_a_step) {
  world w;
  world_desc d = implicit_default(2, 12, 0.1, implicit_basis(0));
  mpm_particles *set = world_open(&w, &d);
  implicit_block(&w, set, 0.42, 0.67, (const double[]){0.7, -0.4});
  mpm_stepper_desc other = d.stepper;
  other.scheme = MPM_USL;
  other.transfer = MPM_FLIP;
  double residual[IMPLICIT_HISTORY];
  world_step(&w, 0.01);
  const int32_t known = implicit_history(&w, residual);
  ck_assert_int_gt(known, 0);
  ck_ok(&w, mpm_stepper_configure(w.stepper, &other));
  ck_assert_int_eq(implicit_history(&w, residual), known);
  world_step(&w, 1e-5);
  ck_assert_int_eq(implicit_history(&w, residual), 0);
  ck_ok(&w, mpm_stepper_configure(w.stepper, &d.stepper));
  ck_assert_int_eq(implicit_history(&w, residual), 0);
  world_close(&w);
}
END_TEST

/* A free body keeps its velocity and its shape at any dt. */
START_TEST(free_flight) {
  const basis_option *basis = implicit_basis(_i % IMPLICIT_BASES);
  const int32_t dim = 1 + _i / IMPLICIT_BASES;
  world w;
  world_desc d = implicit_default(dim, 12, 0.1, basis);
  mpm_particles *set = world_open(&w, &d);
  const double v[3] = {0.7, -0.4, 0.3};
  const int64_t n = implicit_block(&w, set, 0.42, 0.67, v);
  double *x0 = fetch(&w, set, "position", dim);
  const double dt = 0.05;
  for (int32_t k = 1; k <= 3; ++k) {
    const mpm_step_info info = world_step(&w, dt);
    ck_assert_int_le(info.newton_iterations, 3);
    double *x = fetch(&w, set, "position", dim), *u = fetch(&w, set, "velocity", dim);
    double *F = fetch(&w, set, "deformation_gradient", 9), *a = fetch(&w, set, "acceleration", dim);
    for (int64_t i = 0; i < n * dim; ++i) {
      ck_within(basis->name, x[i], x0[i] + k * dt * v[i / n], 1e-12);
      ck_within(basis->name, u[i], v[i / n], 1e-11);
      ck_within(basis->name, a[i], 0.0, 1e-8);
    }
    for (int64_t i = 0; i < 9 * n; ++i) ck_within(basis->name, F[i], i / n % 4 ? 0.0 : 1.0, 1e-12);
    free(x), free(u), free(F), free(a);
  }
  free(x0);
  world_close(&w);
}
END_TEST

/* One cell, one particle in its middle, the lower node held: one unknown, here solved apart. P-wave law of
 * neo_hookean in 1-D: sigma = (lambda ln J + mu (J^2 - 1)) / J. */
START_TEST(one_unknown) {
  const double betas[] = {0.25, 0.3025, 0.5}, gammas[] = {0.5, 0.6, 0.5};
  const double beta = betas[_i], gamma = gammas[_i], h = 0.5, g = -3.0, dt = 0.02;
  world w;
  world_desc d = implicit_default(1, 4, h, implicit_basis(0));
  d.stepper.newmark_beta = beta;
  d.stepper.newmark_gamma = gamma;
  d.stepper.gravity[0] = g;
  mpm_particles *set = world_open(&w, &d);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  const double at = 0.5 * h, volume = 0.4;
  ck_ok(&w, mpm_particles_add(set, 1, &at, NULL, &volume, NULL, NULL, NULL));
  const double lambda = d.law.E * d.law.nu / ((1.0 + d.law.nu) * (1.0 - 2.0 * d.law.nu)),
               mu = d.law.E / (2.0 * (1.0 + d.law.nu));
  const double m = d.law.density * volume;
  double x = at, v = 0.0, a = 0.0, F = 1.0;
  for (int32_t k = 0; k < 25; ++k) {
    const double weight = x / h, M = weight * m, G = 1.0 / h;
    const double tau = lambda * log(F) + mu * (F * F - 1.0);
    if (k == 0) a = weight * ((weight * m * g - volume * tau * G) / M);
    /* by bisection: the balance grows with u */
    double low = -0.45 * h, high = 3.0 * h;
    for (int32_t i = 0; i < 200; ++i) {
      const double u = 0.5 * (low + high), inc = 1.0 + u * G, J = inc * F;
      const double t = lambda * log(J) + mu * (J * J - 1.0);
      const double acceleration = (u - dt * v - dt * dt * (0.5 - beta) * a) / (beta * dt * dt);
      const double balance = volume * t * G / inc + M * acceleration - M * g;
      if (balance > 0.0)
        high = u;
      else
        low = u;
    }
    const double u = 0.5 * (low + high), a1 = (u - dt * v - dt * dt * (0.5 - beta) * a) / (beta * dt * dt);
    F *= 1.0 + u * G;
    v += dt * ((1.0 - gamma) * a + gamma * weight * a1);
    a = weight * a1;
    x += weight * u;
    const mpm_step_info info = world_step(&w, dt);
    double *is = fetch(&w, set, "position", 1), *speed = fetch(&w, set, "velocity", 1);
    double *acceleration = fetch(&w, set, "acceleration", 1),
           *stretch = fetch(&w, set, "deformation_gradient", 9);
    ck_within("x", is[0], x, 1e-11);
    ck_within("v", speed[0], v, 1e-9);
    ck_within("a", acceleration[0], a, 1e-7);
    ck_within("F", stretch[0], F, 1e-10);
    ck_assert_int_gt(info.newton_iterations, 0);
    free(is), free(speed), free(acceleration), free(stretch);
  }
  world_close(&w);
}
END_TEST

/* A block in three dimensions and less sags on its fixed foot between slip walls, quasi-static and dynamic:
 * every basis and dimension converges quadratically, and walls carry the weight. */
START_TEST(sagging_block) {
  const basis_option *basis = implicit_basis(_i % IMPLICIT_BASES);
  const int32_t dim = 1 + _i / IMPLICIT_BASES % 3, quasi_static = _i / IMPLICIT_BASES / 3;
  world w;
  world_desc d = implicit_default(dim, 8, 0.1, basis);
  d.stepper.quasi_static = quasi_static;
  d.stepper.gravity[dim - 1] = -30.0;
  mpm_particles *set = world_open(&w, &d);
  implicit_block(&w, set, 0.0, 0.4, NULL);
  for (int32_t k = 0; k < dim; ++k)
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, 2 * k, k == dim - 1 ? MPM_WALL_FIXED : MPM_WALL_SLIP, 0.0));
  char name[80];
  snprintf(name, sizeof name, "%s in %d-D%s", basis->name, (int)dim, quasi_static ? ", quasi-static" : "");
  world_step(&w, 0.05);
  implicit_quadratic(name, &w, 60.0);
  if (quasi_static) {
    double force[3], weight = 30.0 * d.law.density * pow(0.4, dim);
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, 2 * (dim - 1), force));
    ck_within(name, force[dim - 1], weight, 1e-7 * weight);
    const mpm_step_info info = world_info(&w);
    ck_assert_int_gt(info.newton_iterations, 2);
    ck_assert_double_lt(info.residual, 1e-8);
  }
  world_close(&w);
}
END_TEST

/* Every law, with and without the remedy: the iteration knows the derivative of what the law does. */
enum { IMPLICIT_LAWS = 11 };
START_TEST(every_law) {
  static const mpm_param clay[] = {{"E", 1e5},    {"nu", 0.3},  {"density", 1e3},
                                   {"phi", 20.0}, {"psi", 5.0}, {"cohesion", 900.0}};
  static const mpm_param soft[] = {{"density", 1e3}, {"kappa", 0.02}, {"lambda", 0.12}, {"M", 1.05},
                                   {"mu0", 4e4},     {"p_ref", 1e3},  {"pc0", 1.5e3}};
  static const mpm_param decoupled[] = {{"mu", 4e4}, {"kappa", 4e5}, {"density", 1e3}};
  static const mpm_param fluid[] = {{"bulk_modulus", 1e5}, {"viscosity", 300.0}, {"density", 1e3}};
  static const mpm_param mud[] = {{"bulk_modulus", 1e5},  {"shear_modulus", 4e4}, {"density", 1e3},
                                  {"yield_shear", 500.0}, {"consistency", 300.0}, {"n", 0.7}};
  static const mpm_param snow[] = {
      {"E", 1e5}, {"nu", 0.3}, {"density", 1e3}, {"critical_compression", 0.015}};
  static const mpm_param grains[] = {
      {"E", 1e5},    {"nu", 0.3},  {"density", 1e3},         {"mu_s", 0.4},
      {"mu_2", 0.7}, {"I_0", 0.3}, {"grain_diameter", 0.01}, {"grain_density", 2.5e3}};
  static const world_law laws[] = {
      {.model = "neo_hookean", .E = 1e5, .nu = 0.3, .density = 1e3},
      {.model = "linear_elastic", .E = 1e5, .nu = 0.3, .density = 1e3},
      {.model = "j2", .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 900.0, .hardening = 1e4},
      {.model = "newtonian_fluid", .params = fluid, .param_count = 3},
      {.model = "neo_hookean_decoupled", .params = decoupled, .param_count = 3},
      {.model = "drucker_prager", .params = clay, .param_count = 6},
      {.model = "mohr_coulomb", .params = clay, .param_count = 6},
      {.model = "herschel_bulkley", .params = mud, .param_count = 6},
      {.model = "snow", .params = snow, .param_count = 4},
      {.model = "mu_i", .params = grains, .param_count = 8},
      {.model = "cam_clay", .params = soft, .param_count = 7}};
  _Static_assert(sizeof laws / sizeof *laws == IMPLICIT_LAWS, "all are run");
  const int32_t remedy = _i / IMPLICIT_LAWS % 2, dim = 2 + _i / IMPLICIT_LAWS / 2 % 2;
  const basis_option *basis = implicit_basis(_i / IMPLICIT_LAWS / 4);
  world w;
  world_desc d = implicit_default(dim, 6, 0.1, basis);
  d.law = laws[_i % IMPLICIT_LAWS];
  d.stepper.gravity[dim - 1] = -30.0;
  d.stepper.gravity[0] = 6.0;
  d.stepper.locking_remedy = remedy;
  mpm_particles *set = world_open(&w, &d);
  implicit_block(&w, set, 0.0, 0.3, NULL);
  if (d.law.params == soft)
    ck_ok(&w, mpm_particles_set_all(set, "stress", MPM_F64, 6, (const double[]){-1e3, -1e3, -1e3, 0, 0, 0}));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, 2 * (dim - 1), MPM_WALL_FIXED, 0.0));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  char name[80];
  snprintf(name, sizeof name, "%s, %s in %d-D%s", d.law.model, basis->name, (int)dim,
           remedy ? ", remedy" : "");
  world_step(&w, 0.03);
  world_step(&w, 0.03);
  implicit_quadratic(name, &w, 100.0);
  world_close(&w);
}
END_TEST

/* Falling freely, a body has the acceleration of gravity from its first implicit step on: it is found, not
 * taken to be zero; after explicit steps too. */
START_TEST(initial_acceleration) {
  const basis_option *basis = implicit_basis(1);
  world w;
  world_desc d = implicit_default(2, 10, 0.1, basis);
  d.stepper.gravity[1] = -9.0;
  d.stepper.scheme = _i ? MPM_USL : MPM_NEWMARK;
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = implicit_block(&w, set, 0.4, 0.7, NULL);
  double t = 0.0;
  if (_i) {
    for (int32_t k = 0; k < 3; ++k) world_step(&w, 1e-3);
    t = 3e-3;
    d.stepper.scheme = MPM_NEWMARK;
    ck_ok(&w, mpm_stepper_configure(w.stepper, &d.stepper));
  }
  const double dt = 0.01;
  for (int32_t k = 1; k <= 4; ++k) {
    world_step(&w, dt);
    double *v = fetch(&w, set, "velocity", 2), *a = fetch(&w, set, "acceleration", 2);
    for (int64_t i = 0; i < n; ++i) {
      ck_within("v", v[n + i], -9.0 * (t + k * dt), 1e-10);
      ck_within("a", a[n + i], -9.0, 1e-7);
    }
    free(v), free(a);
  }
  world_close(&w);
}
END_TEST

/* Compression between a slip wall and a platen of prescribed particles, all sides free to slide: homogeneous,
 * and known. GIMP with domains that follow F is exact while the platen is in line with nodes. */
START_TEST(patch) {
  static const double kappa = 6e7, mu = 6e6;
  static const mpm_param rubber[] = {{"mu", 6e6}, {"kappa", 6e7}, {"density", 10.0}};
  const double h = 0.5, L = 4.0;
  world w;
  world_desc d = implicit_default(2, 16, h, implicit_basis(6));
  d.law = (world_law){.model = "neo_hookean_decoupled", .params = rubber, .param_count = 3};
  d.stepper.quasi_static = 1;
  mpm_particles *block = world_open(&w, &d);
  mpm_particles *platen = world_add_set(&w, &(world_law){.model = "rigid", .density = 10.0});
  const int64_t n = implicit_block(&w, block, 0.0, L, NULL);
  const double lower[] = {0.0, L}, upper[] = {7.5, L + h}, speed[] = {0.0, -h};
  world_fill(&w, platen, lower, upper, 2);
  ck_ok(&w, mpm_particles_set_all(platen, "velocity", MPM_F64, 2, speed));
  ck_ok(&w, mpm_particles_set_all(platen, "prescribed", MPM_U8, 2, (const uint8_t[]){0, 1}));
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; ++face)
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  for (int32_t k = 1; k <= 4; ++k) {
    world_step(&w, 1.0);
    const double y = 1.0 - k * h / L;
    double low = 1.0, high = 4.0, force[2], floor[2];
    for (int32_t i = 0; i < 200; ++i) {
      const double x = 0.5 * (low + high);
      const double t =
          kappa * log(x * y) + mu * pow(x * y, -2.0 / 3.0) * (x * x - (x * x + y * y + 1.0) / 3.0);
      if (t > 0.0)
        high = x;
      else
        low = x;
    }
    const double J = low * y;
    const double tau = kappa * log(J) + mu * pow(J, -2.0 / 3.0) * (y * y - (low * low + y * y + 1.0) / 3.0);
    double *F = fetch(&w, block, "deformation_gradient", 9);
    for (int64_t i = 0; i < n; ++i) {
      ck_within("F_xx", F[i], low, 1e-9);
      ck_within("F_yy", F[4 * n + i], y, 1e-9);
      ck_within("F_xy", F[n + i], 0.0, 1e-9);
    }
    free(F);
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, platen, force));
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, floor));
    ck_within("platen", force[1], tau / y * L, 1e-8 * fabs(tau) * L);
    ck_within("floor", floor[1], -force[1], 1e-8 * fabs(tau) * L);
  }
  world_close(&w);
}
END_TEST

/* A dead load under which the first increment would turn the cell inside out:
 * it is halved until it does not. */
START_TEST(halved_increments) {
  const double h = 0.5, volume = 0.4, at = 0.5 * h;
  world w;
  world_desc d = implicit_default(1, 4, h, implicit_basis(0));
  const double lambda = d.law.E * d.law.nu / ((1.0 + d.law.nu) * (1.0 - 2.0 * d.law.nu)),
               mu = d.law.E / (2.0 * (1.0 + d.law.nu));
  const double m = d.law.density * volume, load = -1.5 * volume * (lambda + 2.0 * mu) / h;
  d.stepper.quasi_static = 1;
  d.stepper.gravity[0] = load / (0.5 * m);
  mpm_particles *set = world_open(&w, &d);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(&w, mpm_particles_add(set, 1, &at, NULL, &volume, NULL, NULL, NULL));
  world_step(&w, 1.0);
  double *F = fetch(&w, set, "deformation_gradient", 9);
  ck_between("F", F[0], 0.05, 0.9);
  const double tau = lambda * log(F[0]) + mu * (F[0] * F[0] - 1.0);
  ck_within("balance", volume * tau / (F[0] * h), load, 1e-7 * fabs(load));
  free(F);
  world_close(&w);
}
END_TEST

/* Forces are wanted for the end of the step; dynamic ones,
 * where accelerations are to be found, first for its start. */
typedef struct times {
  double t[8];
  int32_t count;
} times;

static mpm_status note_time(void *user, const mpm_particle_batch *b, double *add) {
  times *seen = user;
  (void)add;
  if (seen->count < 8) seen->t[seen->count] = b->t;
  ++seen->count;
  return MPM_OK;
}

START_TEST(time_of_forces) {
  world w;
  world_desc d = implicit_default(2, 8, 0.1, implicit_basis(1));
  d.stepper.quasi_static = _i;
  d.stepper.gravity[1] = -5.0;
  mpm_particles *set = world_open(&w, &d);
  implicit_block(&w, set, 0.0, 0.3, NULL);
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; face += 2)
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  times seen = {{0.0}, 0};
  ck_ok(&w, mpm_stepper_set_force(w.stepper, note_time, &seen));
  const double dt = 0.125;
  world_step(&w, dt);
  ck_assert_int_eq(seen.count, _i ? 1 : 2);
  if (!_i) ck_assert_double_eq(seen.t[0], 0.0);
  ck_assert_double_eq(seen.t[seen.count - 1], dt);
  seen.count = 0;
  world_step(&w, dt);
  ck_assert_int_eq(seen.count, 1);
  ck_assert_double_eq(seen.t[0], 2.0 * dt);
  world_close(&w);
}
END_TEST

/* With the remedy particles of a cell couple across the seam of a periodic axis, however few cells it has. */
START_TEST(remedy_across_a_seam) {
  static const int64_t cells[] = {1, 2, 3, 5, 17};
  const basis_option *basis = implicit_basis(_i % IMPLICIT_BASES);
  const int64_t across = cells[_i / IMPLICIT_BASES];
  world w;
  world_desc d = implicit_default(2, 8, 0.1, basis);
  d.grid.cells[0] = across;
  d.grid.periodic[0] = 1;
  d.stepper.locking_remedy = 1;
  mpm_particles *set = world_open(&w, &d);
  const double lower[] = {0.0, 0.2}, upper[] = {0.1 * (double)across, 0.5};
  const int64_t n = world_fill(&w, set, lower, upper, 2);
  double *v = malloc((size_t)(2 * n) * sizeof *v);
  dice d7 = {7};
  for (int64_t i = 0; i < 2 * n; ++i) v[i] = throw_between(&d7, -1.0, 1.0);
  put(&w, set, "velocity", 2, v);
  free(v);
  for (int32_t k = 0; k < 3; ++k) {
    const mpm_step_info info = world_step(&w, 0.01);
    ck_assert_msg(info.newton_iterations <= 6, "%s on %d cells: %d iterations", basis->name, (int)across,
                  (int)info.newton_iterations);
  }
  world_close(&w);
}
END_TEST

/* However short the step, forces count: rounding is that of what moves, not of inertia over dt^2. */
START_TEST(short_steps) {
  world w;
  world_desc d = implicit_default(2, 8, 1.0, implicit_basis(1));
  d.stepper.gravity[1] = -10.0;
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = implicit_block(&w, set, 3.0, 5.0, NULL);
  const double dt = 1e-9;
  for (int32_t k = 1; k <= 3; ++k) {
    world_step(&w, dt);
    double *v = fetch(&w, set, "velocity", 2);
    for (int64_t i = 0; i < n; ++i) ck_within("v", v[n + i], -10.0 * k * dt, 1e-6 * dt);
    free(v);
  }
  world_close(&w);
}
END_TEST

static mpm_status hold_top(void *user, const mpm_node_batch *b, uint8_t *is_held, double *velocity) {
  const double *from = user;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t i = 0; i < b->n; ++i) {
      is_held[c * b->ld + i] = b->position[i] > from[0] + 1e-9;
      velocity[c * b->ld + i] = c ? 0.0 : from[1];
    }
  return MPM_OK;
}

/* A block on a fixed wall under a platen of law rigid that fills the grid up to another wall, quasi-static:
 * whoever moves the platen carries its weight and what is applied to it, on nodes too that it alone reaches.
 * A prescribed platen reports the block, and works on it alone, whatever it weighs; of the host all reactions
 * carry all. */
START_TEST(heavy_platen) {
  const int32_t by_host = _i % 2, walled = _i / 2 % 2;
  const double h = 0.125, g = -1.0, applied = -0.5, top[2] = {5.0 * h, -0.01};
  double reported[2] = {0.0, 0.0}, work[2] = {0.0, 0.0};
  for (int32_t heavy = 0; heavy < 2; ++heavy) {
    world w;
    world_desc d = implicit_default(2, 8, h, implicit_basis(_i / 4));
    d.stepper.quasi_static = 1;
    d.stepper.newton_tolerance_residual = 1e-12;
    d.stepper.gravity[0] = g;
    d.grid.cells[0] = walled ? 7 : 12;
    d.grid.cells[1] = 4;
    d.grid.periodic[1] = 1;
    d.law.E = 100.0, d.law.density = 1.0;
    mpm_particles *block = world_open(&w, &d);
    const world_law rigid = {.model = "rigid", .density = heavy ? 100.0 : 1.0};
    mpm_particles *platen = world_add_set(&w, &rigid);
    const double low[2][2] = {{0.0, 0.0}, {top[0], 0.0}}, high[2][2] = {{top[0], 0.5}, {7.0 * h, 0.5}};
    world_fill(&w, block, low[0], high[0], 2);
    const int64_t n = world_fill(&w, platen, low[1], high[1], 2);
    ck_ok(&w, mpm_particles_set_all(platen, "applied_force", MPM_F64, 2,
                                    (double[]){(heavy ? applied : 0.0) / (double)n, 0.0}));
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
    if (walled) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_FIXED, 0.0));
    if (by_host) {
      ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, hold_top, (void *)(uintptr_t)top));
    } else {
      ck_ok(&w, mpm_particles_set_all(platen, "prescribed", MPM_U8, 2, (uint8_t[]){1, 1}));
      ck_ok(&w, mpm_particles_set_all(platen, "velocity", MPM_F64, 2, (double[]){top[1], 0.0}));
    }
    const double weight = -g * mass_of(&w, block),
                 carried = -g * mass_of(&w, platen) - (heavy ? applied : 0.0);
    const mpm_step_info info = world_step(&w, 1.0);
    double wall[2], force[2], beyond[2] = {0.0, 0.0};
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, wall));
    if (walled) ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MAX, beyond));
    if (by_host) {
      int64_t nodes;
      double *of_nodes = fetch_nodes(&w, "reaction", &nodes);
      ck_within("host", sum_of(nodes, of_nodes), weight + carried, 1e-9 * (weight + carried));
      free(of_nodes);
    } else {
      ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, platen, force));
      ck_within("platen", wall[0] + beyond[0] + force[0], weight, 1e-9 * (weight + carried));
      reported[heavy] = force[0];
      work[heavy] = info.external_work;
      ck_assert_double_lt(force[0], -0.5);
    }
    world_close(&w);
  }
  ck_within("reaction", reported[1], reported[0], 1e-9);
  if (!walled) /* beside a wall nodes are slower than the particles, on which weight works */
    ck_within("work", work[1], work[0], 1e-11);
}
END_TEST

static mpm_status sink(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= 0.1;
  return MPM_OK;
}

/* A platen in the air: nothing acts on the material but what its own motion takes. */
START_TEST(platen_in_the_air) {
  world w;
  world_desc d = implicit_default(2, 8, 0.1, implicit_basis(1));
  d.law = (world_law){.model = "rigid", .density = 1e3};
  mpm_particles *set = world_open(&w, &d);
  implicit_block(&w, set, 0.3, 0.5, NULL);
  ck_ok(&w, mpm_stepper_set_motion(w.stepper, set, sink, NULL));
  for (int32_t k = 0; k < 4; ++k) {
    world_step(&w, 0.01);
    double force[2];
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, set, force));
    for (int32_t c = 0; c < 2; ++c) ck_within("reaction", force[c], 0.0, 1e-8);
  }
  world_close(&w);
}
END_TEST

/* Returns a method of Newmark's rule, by its number among them. */
static const method *newmark_method(int32_t number) {
  for (int32_t i = 0; i < BROAD; ++i)
    if (broad_methods[i]->scheme == MPM_NEWMARK && !number--) return broad_methods[i];
  ck_abort_msg("there is no such method");
}

/* The same bits on any number of threads, by the pool and by an executor in random order. */
START_TEST(threads) {
  static const int32_t counts[] = {1, 2, 3, 4, 7};
  body_desc o = {.dim = 1 + _i / 3 % 3, .velocity_bc = 1, .led = 1, .periodic = _i / 9};
  o.method = *newmark_method(_i % 3);
  uint64_t alone = 0;
  for (int32_t i = 0; i < 6; ++i) {
    world r;
    o.concurrency = counts[i % 5];
    o.random_order = i == 5;
    if (i == 5) o.concurrency = 4;
    body_open(&r, &o);
    for (int32_t k = 0; k < 4; ++k) world_step(&r, 5.0 * BODY_DT);
    ck_assert_int_gt(r.info.newton_iterations, 0);
    if (!i) alone = world_hash(&r);
    ck_assert_msg(world_hash(&r) == alone, "%d threads give another hash than one", (int)o.concurrency);
    world_close(&r);
  }
}
END_TEST

Suite *implicit_suite(void) {
  Suite *suite = suite_create("implicit");
  TCase *tests = tcase_create("steps");
  tcase_set_timeout(tests, 60.0);
  tcase_add_test(tests, history_of_a_step);
  tcase_add_loop_test(tests, free_flight, 0, 3 * IMPLICIT_BASES);
  tcase_add_loop_test(tests, one_unknown, 0, 3);
  add_sparse(tests, sagging_block, 6 * IMPLICIT_BASES, 5);
  add_sparse(tests, every_law, 8 * IMPLICIT_LAWS, 3);
  tcase_add_loop_test(tests, initial_acceleration, 0, 2);
  tcase_add_test(tests, patch);
  tcase_add_test(tests, halved_increments);
  tcase_add_loop_test(tests, time_of_forces, 0, 2);
  tcase_add_loop_test(tests, remedy_across_a_seam, 0, 5 * IMPLICIT_BASES);
  tcase_add_test(tests, short_steps);
  tcase_add_test(tests, platen_in_the_air);
  tcase_add_loop_test(tests, heavy_platen, 0, 4 * IMPLICIT_BASES);
  TCase *on_threads = tcase_create("threads");
  tcase_set_timeout(on_threads, 60.0);
  tcase_set_tags(on_threads, "long");
  tcase_add_loop_test(on_threads, threads, 0, 18);
  suite_add_tcase(suite, tests);
  suite_add_tcase(suite, on_threads);
  suite_add_tcase(suite, implicit_extension_case());
  suite_add_tcase(suite, implicit_symmetry_case());
  suite_add_tcase(suite, implicit_mirrors_case());
  suite_add_tcase(suite, implicit_failures_case());
  suite_add_tcase(suite, implicit_large_case(wide_case(suite, "more of large bodies")));
  return suite;
}
