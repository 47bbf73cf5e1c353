/* A platen that runs into a bar: the wave of d'Alembert. */
#include "prescribed.h"

/* A platen of prescribed elastic particles runs at v into a bar at rest, E = rho = 1: behind the front the
 * stress is -rho c v, which is the force on the platen until the front has been at the free end and back, at
 * t = 2. Mean of the reaction over 0.2 < t < 1.6 against rho c v, the same for the stress within 0.2 ... 0.5
 * at t = 0.8, the front being at 0.8. */
typedef struct pushed {
  double reaction, stress, work, energy;
} pushed;

static pushed push_bar(const method *how, int32_t cells) {
  const double h = 1.0 / cells, v = 0.001, platen[2] = {1.0, 1.0 + 5.0 * h},
               bar[2] = {1.0 + 5.0 * h, 2.0 + 5.0 * h};
  const uint8_t yes = 1;
  world w;
  world_desc desc = world_with(how, 1, 4 * cells, h);
  desc.law = (world_law){.model = "linear_elastic", .E = 1.0, .density = 1.0};
  desc.sets = 2;
  world_open(&w, &desc);
  mpm_particles *tool = w.set[0], *body = w.set[1];
  world_fill(&w, tool, &platen[0], &platen[1], 2);
  world_fill(&w, body, &bar[0], &bar[1], 2);
  ck_ok(&w, mpm_particles_set_all(tool, "velocity", MPM_F64, 1, &v));
  ck_ok(&w, mpm_particles_set_all(tool, "prescribed", MPM_U8, 1, &yes));
  const mpm_step_info start = world_info(&w);
  const double dt = 0.2 * h;
  pushed out = {0.0, 0.0, 0.0, 0.0};
  double weight = 0.0;
  for (double t = 0.0; t < 1.6; t += dt) {
    double force;
    const mpm_step_info info = world_step(&w, dt);
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, tool, &force));
    out.work += info.external_work;
    if (info.t > 0.2) out.reaction += force, weight += 1.0;
    if (fabs(info.t - 0.8) > 0.51 * dt) continue;
    const int64_t n = mpm_particles_count(body);
    double *x = fetch(&w, body, "position", 1), *s = fetch(&w, body, "stress", 6), sum = 0.0, parts = 0.0;
    for (int64_t p = 0; p < n; ++p)
      if (x[p] > bar[0] + 0.2 && x[p] < bar[0] + 0.5) sum += s[p], parts += 1.0;
    out.stress = -sum / parts / v;
    const mpm_step_info now = world_info(&w);
    out.energy =
        (now.kinetic_energy + now.strain_energy - start.kinetic_energy - start.strain_energy) / out.work;
    free(x), free(s);
  }
  out.reaction /= weight * v;
  world_close(&w);
  return out;
}

START_TEST(platen_pushes_a_bar) {
  const method *how = &methods[_i];
  const pushed coarse = push_bar(how, 40), fine = push_bar(how, 160);
  show("%s: reaction %.5f %.5f, stress %.5f %.5f, energy %.5f %.5f\n", how->name, coarse.reaction,
       fine.reaction, coarse.stress, fine.stress, coarse.energy, fine.energy);
  ck_within(how->name, coarse.reaction, 1.0, 0.02);
  ck_within(how->name, fine.reaction, 1.0, 0.002);
  ck_within(how->name, coarse.stress, 1.0, 0.03);
  ck_within(how->name, fine.stress, 1.0, 0.005);
  /* what the platen spends is in the bar, less what the front dissipates */
  ck_between(how->name, coarse.energy, 0.85, 1.0);
  ck_between(how->name, fine.energy, 1.0 - 0.6 * (1.0 - coarse.energy), 1.0);
}
END_TEST

TCase *prescribed_waves_case(void) {
  TCase *tc = tcase_create("waves");
  tcase_set_timeout(tc, 120);
  tcase_add_loop_test(tc, platen_pushes_a_bar, 0, METHODS);
  return tc;
}
