/* Exact cases: answers known to rounding, or closed forms. */
#include "exact.h"

/* A stress-free block of 4 cells edge flies 1000 steps across many cells. */
static void fly(const method *how, int32_t dim, int32_t periodic) {
  const double v[3] = {0.3, -0.2, 0.1}, h = 0.25, dt = 0.01, start[3] = {1.0, 3.5, 1.0};
  const int32_t steps = 1000;
  double lower[3], upper[3];
  world w;
  world_desc desc = world_with(how, dim, periodic ? 8 : 24, h);
  /* with the linear basis light nodes make rounding grow by (c dt / h)^2 / share of mass a step: a soft law
   */
  if (how->basis == MPM_LINEAR) desc.law.E = 1e3;
  for (int32_t k = 0; k < dim; ++k) {
    lower[k] = periodic ? 0.5 : start[k] - 0.125;
    upper[k] = lower[k] + 1.0;
    desc.grid.periodic[k] = periodic;
  }
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
  const int64_t n = mpm_particles_count(set);
  double *x0 = fetch(&w, set, "position", dim);
  for (int32_t i = 0; i < steps; ++i) world_step(&w, dt);
  double *x = fetch(&w, set, "position", dim), *v1 = fetch(&w, set, "velocity", dim);
  double *stress = fetch(&w, set, "stress", 6);
  int64_t *image = fetch_as(&w, set, "image", MPM_I64, dim), crossed = 0;
  for (int32_t k = 0; k < dim; ++k)
    for (int64_t p = 0; p < n; ++p) {
      const int64_t i = k * n + p;
      const double unwrapped = x[i] + (double)image[i] * (double)desc.grid.cells[k] * h;
      crossed += image[i] != 0;
      ck_within(how->name, v1[i], v[k], 1e-12);
      ck_within(how->name, unwrapped, x0[i] + v[k] * steps * dt, 1e-12);
    }
  ck_assert_int_eq(crossed > 0, periodic);
  ck_within(how->name, largest(6 * n, stress) / desc.law.E, 0.0, 1e-12);
  free(x0), free(x), free(v1), free(stress), free(image);
  world_close(&w);
}

START_TEST(translation_is_free_of_stress) {
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t periodic = 0; periodic < 2; ++periodic) fly(&methods[_i], dim, periodic);
}
END_TEST

static mpm_status fall(void *user, const mpm_particle_batch *b, double *add) {
  const double *g = user;
  for (int32_t k = 0; k < b->dim; ++k)
    for (int64_t p = 0; p < b->n; ++p) add[k * b->ld + p] += g[k];
  return MPM_OK;
}

static mpm_status weigh(void *user, const mpm_particle_batch *b, double *add) {
  const double *g = user;
  for (int32_t k = 0; k < b->dim; ++k)
    for (int64_t p = 0; p < b->n; ++p) add[k * b->ld + p] += b->mass[p] * g[k];
  return MPM_OK;
}

/* Free fall by each way to give a weight; symplectic Euler: v = g t, x = g t (t + dt) / 2. */
START_TEST(free_fall) {
  enum { BY_GRAVITY, BY_ACCELERATION, BY_FORCE, BY_FIELD, WAYS };
  const method *how = &methods[_i / WAYS];
  const int32_t way = _i % WAYS, steps = 200;
  const double lower[3] = {0.5, 5.5, 0.5}, upper[3] = {1.5, 6.5, 1.5}, dt = 1.0 / steps;
  double g[3] = {1.0, -9.81, 2.0};
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    world_desc desc = world_with(how, dim, 16, 0.5);
    if (way == BY_GRAVITY) memcpy(desc.stepper.gravity, g, sizeof g);
    mpm_particles *set = world_open(&w, &desc);
    const int64_t n = world_fill(&w, set, lower, upper, 2);
    double *x0 = fetch(&w, set, "position", dim), *mass = fetch(&w, set, "mass", 1), weight[3];
    const double total = sum_of(n, mass);
    for (int32_t k = 0; k < 3; ++k) weight[k] = mass[0] * g[k];
    if (way == BY_ACCELERATION) ck_ok(&w, mpm_stepper_set_acceleration(w.stepper, fall, g));
    if (way == BY_FORCE) ck_ok(&w, mpm_stepper_set_force(w.stepper, weigh, g));
    if (way == BY_FIELD) ck_ok(&w, mpm_particles_set_all(set, "applied_force", MPM_F64, dim, weight));
    double work = 0.0, lost = 0.0, expected_work = 0.0, expected_loss = 0.0;
    for (int32_t i = 0; i < steps; ++i) {
      const mpm_step_info info = world_step(&w, dt);
      work += info.external_work;
      lost += info.dissipation;
    }
    double *x = fetch(&w, set, "position", dim), *v = fetch(&w, set, "velocity", dim);
    double *stress = fetch(&w, set, "stress", 6);
    for (int32_t k = 0; k < dim; ++k) {
      for (int64_t p = 0; p < n; ++p) {
        ck_within(how->name, v[k * n + p], g[k], 1e-12 * 9.81);
        ck_within(how->name, x[k * n + p] - x0[k * n + p], 0.5 * g[k] * (1.0 + dt), 1e-12 * 9.81);
      }
      expected_work += 0.5 * total * g[k] * g[k] * (1.0 + dt);
      expected_loss +=
          0.5 * total * g[k] * g[k] * dt; /* m g x is more than m v^2 / 2: the last dt counts whole */
    }
    ck_within(how->name, largest(6 * n, stress) / desc.law.E, 0.0, 1e-12);
    ck_within(how->name, work, expected_work, 1e-12 * expected_work);
    ck_within(how->name, lost, expected_loss, 1e-11 * expected_work);
    free(x0), free(mass), free(x), free(v), free(stress);
    world_close(&w);
  }
}
END_TEST

/* Small-strain law of constant volume: stress = E strain / J,
 * so that V stress = V0 E strain. State: the strain. */
static mpm_status spring(void *user, const mpm_material_batch *b) {
  const double E = *(const double *)user;
  for (int64_t p = 0; p < b->n; ++p) {
    const double strain = b->state[p] + b->dt * b->L[p];
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + p] = 0.0;
    b->stress_new[p] = E * strain / b->F[p];
    b->state_new[p] = strain;
    b->wave_speed[p] = sqrt(E);
    b->energy[p] = 0.5 * E * strain * strain;
  }
  return MPM_OK;
}

/* No projected velocity, force or acceleration of node 0,
 * so that the wall takes nothing from the particle. */
static void clear_node_0(world *w) {
  static const char *const fields[] = {"velocity", "force"};
  int64_t n;
  int64_t *index = fetch_node_indices(w, &n);
  for (int32_t f = 0; f < 2; ++f) {
    mpm_view view = {.struct_size = sizeof view};
    ck_ok(w, mpm_grid_map(w->stepper, 0, fields[f], MPM_READ | MPM_WRITE, &view));
    for (int64_t i = 0; i < n; ++i)
      if (index[i] == 0) ((double *)view.data)[i * view.item_stride] = 0.0;
    ck_ok(w, mpm_view_release(&view));
  }
  free(index);
}

/* One particle in one cell whose left node is fixed: v = v0 cos 2 pi t,
 * x = x0 exp(v0 sin(2 pi t) / (2 pi)). */
START_TEST(single_particle_oscillates) {
  const double x0 = 0.5, v0 = 0.01, one = 1.0, dt = _i ? 2.5e-4 : 5e-5;
  const int32_t steps = (int32_t)(10.0 / dt + 0.5);
  double E = 4.0 * PI * PI;
  world w;
  world_desc desc = world_default(1, 2, 1.0);
  desc.grid.basis = MPM_LINEAR;
  /* USL takes L from v + dt f / m of a node that has half the mass:
   * damped by dt omega^2 / 2, hence the small dt */
  desc.stepper.scheme = _i ? MPM_MUSL : MPM_USL;
  desc.law = (world_law){.density = 1.0, .state_count = 1, .stress = spring, .user = &E};
  mpm_particles *set = world_open(&w, &desc);
  ck_ok(&w, mpm_particles_add(set, 1, &x0, &v0, &one, NULL, NULL, NULL));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  double last = v0, first_zero = 0.0, last_zero = 0.0, top = 0.0;
  int32_t zeros = 0;
  for (int32_t i = 1; i <= steps; ++i) {
    ck_ok(&w, mpm_step_begin(w.stepper, dt));
    clear_node_0(&w);
    ck_ok(&w, mpm_step_grid(w.stepper));
    ck_ok(&w, mpm_step_end(w.stepper, NULL));
    const double v = fetch1(&w, set, "velocity", 1, 0, 0), x = fetch1(&w, set, "position", 1, 0, 0);
    ck_within("oscillator", v, v0 * cos(2.0 * PI * i * dt), 0.01 * v0);
    ck_within("oscillator", x, x0 * exp(v0 * sin(2.0 * PI * i * dt) / (2.0 * PI)),
              0.01 * x0 * v0 / (2.0 * PI));
    if (last > 0.0 && v <= 0.0) {
      last_zero = (i - 1 + last / (last - v)) * dt;
      if (!zeros++) first_zero = last_zero;
    }
    if (10 * i > 9 * steps && fabs(v) > top) top = fabs(v);
    last = v;
  }
  const double period = (last_zero - first_zero) / (zeros - 1);
  ck_assert_int_eq(zeros, 10);
  ck_within("oscillator", period, 1.0, 1e-3);
  ck_within("oscillator", top / v0, 1.0, 0.01);
  show("oscillator T %.8f amplitude %.8f\n", period, top / v0);
  world_close(&w);
}
END_TEST

Suite *exact_suite(void) {
  Suite *suite = suite_create("exact");
  TCase *motion = tcase_create("motion");
  tcase_set_tags(motion, "long");
  tcase_set_timeout(motion, 30.0);
  tcase_add_loop_test(motion, translation_is_free_of_stress, 0, METHODS);
  tcase_add_loop_test(motion, free_fall, 0, 4 * METHODS);
  tcase_add_loop_test(motion, single_particle_oscillates, 0, 2);
  suite_add_tcase(suite, basis_case());
  suite_add_tcase(suite, kernels_case());
  suite_add_tcase(suite, clusters_case());
  suite_add_tcase(suite, weights_case());
  suite_add_tcase(suite, conservation_case());
  suite_add_tcase(suite, motion);
  suite_add_tcase(suite, rotation_case());
  suite_add_tcase(suite, patch_case());
  return suite;
}
