/* Von Mises plasticity in the time loop: a body whose nodes are led through a homogeneous uniaxial strain. */
#include "world.h"

typedef struct lead {
  double rate; /* v_x = rate x, v_y = v_z = 0 */
} lead;

static mpm_status lead_nodes(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const lead *l = user;
  for (int32_t k = 0; k < b->dim; ++k)
    for (int64_t i = 0; i < b->n; ++i) {
      prescribed[k * b->ld + i] = 1;
      velocity[k * b->ld + i] = k == 0 ? l->rate * b->position[i] : 0.0;
    }
  return MPM_OK;
}

/* Closed form along the path: stresses and equivalent plastic strain by the logarithmic strain, one increment
 * after the other; in uniaxial strain the deviator is (2, -1, -1) q / 3. */
typedef struct path {
  double mean, q, plastic;
} path;

static void follow(path *p, double strain, const world_law *d) {
  const double K = d->E / (3.0 * (1.0 - 2.0 * d->nu)), G = d->E / (2.0 * (1.0 + d->nu));
  p->mean += K * strain;
  p->q += 2.0 * G * strain;
  const double beyond = fabs(p->q) - d->yield_stress - d->hardening * p->plastic;
  if (beyond <= 0.0) return;
  const double increment = beyond / (3.0 * G + d->hardening);
  p->q -= (p->q > 0.0 ? 3.0 : -3.0) * G * increment;
  p->plastic += increment;
}

/* Loads to 2 %, back to -1 % and to 1 %: yields both ways. */
START_TEST(uniaxial_strain) {
  const int32_t hardens = _i % 2, dim = _i / 2 % 3 + 1;
  const method *how = &methods[_i / 6 * 5]; /* quadratic FLIP USL, quadratic PIC MUSL, linear FLIP USL */
  const double lower[3] = {0.2, 0.2, 0.2}, upper[3] = {0.5, 0.4, 0.4}, dt = 1e-4;
  lead l = {0.0};
  world w;
  world_desc desc = world_with(how, dim, 8, 0.1);
  desc.law.model = "j2";
  desc.law.hardening = hardens ? 2e4 : 0.0;
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, lead_nodes, &l));
  const double nu = desc.law.nu, Y = desc.law.yield_stress, yield_at = Y * (1.0 - nu) / (1.0 - 2.0 * nu);
  const double K = desc.law.E / (3.0 * (1.0 - 2.0 * nu)), G = desc.law.E / (2.0 * (1.0 + nu)),
               M = K + 4.0 / 3.0 * G;
  double total = 0.0, first_yield = 0.0, plastic_once = 0.0;
  path exact = {0.0, 0.0, 0.0};
  for (int32_t step = 0; step < 600; ++step) {
    l.rate = step < 200 || step >= 500 ? 1.0 : -1.0;
    world_step(&w, dt);
    const double strain = log1p(dt * l.rate);
    total += strain;
    follow(&exact, strain, &desc.law);
    double *stress = fetch(&w, set, "stress", 6), *plastic = fetch(&w, set, "state", 1);
    for (int64_t p = 0; p < n; ++p) {
      ck_within(how->name, stress[p], exact.mean + 2.0 / 3.0 * exact.q, 1e-10 * Y);
      ck_within(how->name, stress[n + p], exact.mean - exact.q / 3.0, 1e-10 * Y);
      ck_within(how->name, stress[2 * n + p], exact.mean - exact.q / 3.0, 1e-10 * Y);
      for (int32_t c = 3; c < 6; ++c) ck_within(how->name, stress[c * n + p], 0.0, 1e-10 * Y);
      ck_within(how->name, plastic[p], exact.plastic, 1e-12);
    }
    if (plastic[0] == 0.0) { /* elastic: the modulus of the p wave */
      ck_within(how->name, stress[0], M * total, 1e-10 * Y);
      ck_assert_double_le(stress[0], yield_at);
    } else if (first_yield == 0.0) {
      first_yield = total;
    }
    if (step < 200 && !hardens && plastic[0] > 0.0) /* then the bulk modulus only */
      ck_within(how->name, stress[0], yield_at + K * (total - yield_at / M), 1e-10 * Y);
    if (step == 199) plastic_once = exact.plastic;
    free(stress), free(plastic);
  }
  ck_within(how->name, first_yield, yield_at / M, 1.1 * dt);
  ck_assert_double_gt(plastic_once, 0.0);
  ck_assert_double_gt(exact.plastic, 1.2 * plastic_once); /* yielded in both directions */
  world_close(&w);
}
END_TEST

/* Work on a body without inertia to speak of: what is not stored goes into plastic flow,
 * q times the plastic strain. */
START_TEST(plastic_work_is_dissipated) {
  const double dt = 1e-3;
  lead l = {0.005};
  world w;
  world_desc desc = world_default(2, 10, 0.1);
  desc.law = (world_law){
      .model = "j2", .E = 1e5, .nu = 0.3, .density = 1e-6, .yield_stress = 100.0, .hardening = 1e4};
  desc.stepper.flip = 0.0;
  mpm_particles *set = world_open(&w, &desc);
  world_fill_cube(&w, set, 0.2, 0.6);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, lead_nodes, &l));
  path exact = {0.0, 0.0, 0.0};
  double work = 0.0, lost = 0.0, flow = 0.0;
  mpm_step_info now = {.t = 0.0};
  for (int32_t step = 0; step < 400; ++step) {
    const path old = exact;
    now = world_step(&w, dt);
    follow(&exact, log1p(dt * l.rate), &desc.law);
    flow += 0.16 * 0.5 * (old.q + exact.q) * (exact.plastic - old.plastic);
    work += now.external_work;
    lost += now.dissipation;
  }
  show("plastic: work %.5f stored %.5f lost %.5f flow %.5f\n", work, now.strain_energy, lost, flow);
  ck_within("plastic", work, now.strain_energy + lost, 1e-10 * work);
  ck_within("plastic", lost, flow, 0.02 * flow); /* work is with the old stress; volumes grow by 0.2 % */
  world_close(&w);
}
END_TEST

Suite *plasticity_suite(void) {
  Suite *suite = suite_create("plasticity");
  TCase *tc = tcase_create("plasticity");
  tcase_set_timeout(tc, 30.0);
  tcase_add_loop_test(tc, uniaxial_strain, 0, 18);
  tcase_add_test(tc, plastic_work_is_dissipated);
  suite_add_tcase(suite, tc);
  return suite;
}
