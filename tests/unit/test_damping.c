/* Damping of nodes: what it does to the motion of bodies that move as one, against the rules of the scheme;
 * what it takes of the energy; that it leaves alone what is held. */
#include "damping.h"
#include "body.h"

enum { STEPS = 12 };

/* Opens a block of 2 cells an edge in the middle of a grid without walls. */
static mpm_particles *open_block(world *w, const method *how, double alpha, double rate, double gravity) {
  world_desc desc = world_with(how, 2, 8, 0.25);
  desc.stepper.local_damping = alpha;
  desc.stepper.mass_damping = rate;
  desc.stepper.gravity[1] = gravity;
  desc.stepper.reference_positions = 1;
  mpm_particles *set = world_open(w, &desc);
  const double low[] = {0.8, 0.75}, high[] = {1.3, 1.25};
  world_fill(w, set, low, high, 2);
  return set;
}

static void set_velocity(const world *w, mpm_particles *set, double v) {
  const double velocity[] = {0.0, v};
  ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, velocity));
}

/* ---- bodies that move as one --------------------------------------------------------------------------- */
typedef struct spring {
  double omega;
} spring;

/* Draws particles back to where they were. */
static mpm_status pull(void *user, const mpm_particle_batch *b, double *add) {
  const spring *s = user;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t c = 0; c < b->dim && b->id[i] >= 0; ++c)
      add[c * b->ld + i] -=
          s->omega * s->omega * (b->position[c * b->ld + i] - b->reference_position[c * b->ld + i]);
  return 0;
}

/* Steps through the middle until the block turns, and returns how far it then is from where it belongs. */
static double next_peak(world *w, const mpm_particles *set, double dt) {
  double peak = 0.0, before = 0.0;
  int32_t beyond = 0;
  for (int64_t k = 0; k < 10000; ++k) {
    world_step(w, dt);
    const double way = fetch1(w, set, "position", 2, 1, 0) - fetch1(w, set, "reference_position", 2, 1, 0);
    beyond |= way * before < 0.0;
    before = way;
    if (!beyond) continue;
    if (fabs(way) < peak) return peak;
    peak = fabs(way);
  }
  return NOT_A_NUMBER;
}

/* A spring with Cundall's damping: between two peaks alpha |f| works against the motion, so that
 * x' (1 + alpha) = x (1 - alpha) for squares: sqrt((1 - alpha) / (1 + alpha)). */
START_TEST(peaks_of_a_spring) {
  static const double alphas[] = {0.1, 0.3, 0.8}, ratios[] = {0.904534, 0.733799, 0.333333};
  const method *how = broad_methods[_i / 3];
  const double omega = 4.0, dt = 2.0 * PI / omega / 800.0, start = 0.04;
  spring s = {omega};
  world w;
  if (how->scheme == MPM_NEWMARK) return;
  mpm_particles *set = open_block(&w, how, alphas[_i % 3], 0.0, 0.0);
  double *x = fetch(&w, set, "position", 2);
  const int64_t n = mpm_particles_count(set);
  for (int64_t i = 0; i < n; ++i) x[n + i] += start;
  put(&w, set, "position", 2, x);
  free(x);
  ck_ok(&w, mpm_stepper_set_acceleration(w.stepper, pull, &s));
  /* forces of the start on positions of second order add pi omega dt / 4 to half a cycle */
  const double grows = w.desc.stepper.position_order == 2 ? 0.25 * PI * omega * dt : 0.0;
  const double wanted = ratios[_i % 3] * (1.0 + grows), first = next_peak(&w, set, dt);
  ck_within(how->name, first / start, wanted, 2e-3);
  ck_within(how->name, next_peak(&w, set, dt) / first, wanted, 2e-3);
  world_close(&w);
}
END_TEST

/* Free decay by a / 2 to either side of the middle of each step: the ratio is that of the rule, and all
 * energy goes to the damping. */
START_TEST(decay_by_mass) {
  const method *how = broad_methods[_i];
  const double rate = 3.0, dt = 0.01, v = 0.5, factor = (1.0 - 0.5 * rate * dt) / (1.0 + 0.5 * rate * dt);
  world w;
  mpm_particles *set = open_block(&w, how, 0.0, rate, 0.0);
  set_velocity(&w, set, v);
  const double mass = mass_of(&w, set);
  double now = v, taken = 0.0;
  for (int32_t k = 0; k < STEPS; ++k) {
    world_step(&w, dt);
    now *= factor;
    taken += w.info.damping_dissipation;
    ck_within(how->name, fetch1(&w, set, "velocity", 2, 1, 0), now, 1e-12);
    ck_within(how->name, w.info.kinetic_energy, 0.5 * mass * now * now, 1e-11 * mass);
    ck_within(how->name, w.info.damping_dissipation, w.info.dissipation, 1e-11 * mass);
  }
  ck_within(how->name, taken, 0.5 * mass * (v * v - now * now), 1e-11 * mass);
  ck_within(how->name, w.info.damping_dissipation_total, taken, 1e-13 * mass);
  ck_assert_double_gt(taken, 0.01 * mass);
  world_close(&w);
}
END_TEST

/* Free fall with (1 - alpha) g, once there is a direction to be damped against, and with both kinds of
 * damping by the rule; with positions of second order the balance of energy closes to rounding. */
START_TEST(slow_fall) {
  const method *how = broad_methods[_i / 2];
  const double alpha = 0.3, g = 10.0, dt = 0.002, rate = _i % 2 ? 20.0 : 0.0;
  world w;
  if (how->scheme == MPM_NEWMARK) return;
  mpm_particles *set = open_block(&w, how, alpha, rate, -g);
  const double mass = mass_of(&w, set);
  const int32_t exact = w.desc.stepper.position_order == 2;
  double now = 0.0, taken = 0.0;
  for (int32_t k = 0; k < STEPS; ++k) {
    world_step(&w, dt);
    const double local = -g * dt * (k ? 1.0 - alpha : 1.0);
    const double by = (local - rate * dt * now) / (1.0 + 0.5 * rate * dt);
    taken -= mass * (by + g * dt) * (now + 0.5 * by);
    now += by;
    ck_within(how->name, fetch1(&w, set, "velocity", 2, 1, 0), now, 1e-12);
    ck_within(how->name, w.info.damping_dissipation_total, taken, 1e-12 * mass);
    if (exact) ck_within(how->name, w.info.dissipation, w.info.damping_dissipation, 1e-12 * mass);
  }
  ck_assert_double_gt(taken, 0.0);
  world_close(&w);
}
END_TEST

/* What walls give to a body that moves along and off them, through mirrored ghosts as well, is the same in
 * a step with damping and in one without: that is no reaction of walls. */
START_TEST(no_reaction_of_walls) {
  const method *how = broad_methods[_i];
  double force[2][4], mass = 0.0;
  for (int32_t damped = 0; damped < 2; ++damped) {
    world w;
    mpm_particles *set = open_block(&w, how, 0.0, damped ? 3.0 : 0.0, 0.0);
    const double low[] = {0.5, 0.0}, high[] = {1.5, 0.5}, v[] = {0.5, 0.3};
    world_fill(&w, set, low, high, 2);
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, _i % 2 ? MPM_WALL_FIXED : MPM_WALL_SLIP, 0.0));
    world_step(&w, 1e-3);
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, force[damped]));
    mass = mass_of(&w, set);
    world_close(&w);
  }
  if (how->scheme == MPM_USF || how->scheme == MPM_NEWMARK) return; /* they have the stress of the step */
  if (how->transfer == MPM_FMPM && !how->xpic_every) return; /* walls act on the damped velocities again */
  for (int32_t c = 0; c < 2; ++c) ck_within(how->name, force[1][c], force[0][c], 1e-9 * mass);
}
END_TEST

/* Both at once, in a step in parts, on the seam of a periodic axis: the block does what it does elsewhere. */
START_TEST(across_a_seam) {
  const method *how = &methods[_i];
  double taken[2], v[2];
  for (int32_t seam = 0; seam < 2; ++seam) {
    world_desc desc = world_with(how, 2, 8, 0.25);
    desc.grid.periodic[1] = 1;
    desc.stepper.local_damping = 0.4;
    desc.stepper.mass_damping = 2.0;
    desc.stepper.gravity[1] = -10.0;
    world w;
    mpm_particles *set = world_open(&w, &desc);
    const double low[] = {0.75, seam ? 0.0 : 0.75}, high[] = {1.25, seam ? 0.5 : 1.25};
    world_fill(&w, set, low, high, 2);
    for (int32_t k = 0; k < STEPS; ++k) {
      if (k % 2)
        world_staged_step(&w, 0.002);
      else
        world_step(&w, 0.002);
    }
    taken[seam] = w.info.damping_dissipation_total / mass_of(&w, set);
    v[seam] = fetch1(&w, set, "velocity", 2, 1, 0);
    world_close(&w);
  }
  ck_within(how->name, taken[1], taken[0], 1e-12);
  ck_within(how->name, v[1], v[0], 1e-12);
}
END_TEST

/* ---- bodies that deform -------------------------------------------------------------------------------- */
/* Half a bar on a slip wall is the whole bar, damped or not: ghosts are counted in. */
START_TEST(half_of_a_bar) {
  const method *how = &methods[_i];
  double taken[2], v[2];
  for (int32_t whole = 0; whole < 2; ++whole) {
    world_desc desc = world_with(how, 1, 24, 0.25);
    desc.stepper.local_damping = 0.2;
    desc.stepper.mass_damping = 1.0;
    world w;
    mpm_particles *set = world_open(&w, &desc);
    const double middle = whole ? 3.0 : 0.0, low = whole ? 2.0 : 0.0, high = middle + 1.0;
    const int32_t n = (int32_t)world_fill(&w, set, &low, &high, 2);
    double *x = fetch(&w, set, "position", 1);
    for (int32_t i = 0; i < n; ++i) x[i] = 0.3 * (x[i] - middle);
    put(&w, set, "velocity", 1, x);
    free(x);
    if (!whole) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    for (int32_t k = 0; k < 40; ++k) world_step(&w, 0.004);
    taken[whole] = w.info.damping_dissipation_total;
    v[whole] = fetch1(&w, set, "velocity", 1, 0, n - 1);
    world_close(&w);
  }
  ck_assert_double_gt(taken[0], 0.0);
  ck_within(how->name, taken[1], 2.0 * taken[0], 1e-9 * taken[0]);
  ck_within(how->name, v[1], v[0], 1e-9);
}
END_TEST

/* What a bar loses is what damping took, but for an error of the scheme that falls with dt: FLIP has no other
 * loss on particles that keep to the modes of the nodes. */
START_TEST(balance_of_a_bar) {
  double gap[2];
  for (int32_t fine = 0; fine < 2; ++fine) {
    const method how = {METHOD(BSPLINE2, USL, FLIP, 1.0, "bar"), .position_order = _i ? 2 : 1};
    world_desc desc = world_with(&how, 1, 24, 0.25);
    desc.stepper.local_damping = _i ? 0.2 : 0.0;
    desc.stepper.mass_damping = _i ? 0.0 : 4.0;
    const double low = 0.0, high = 3.0;
    world w;
    mpm_particles *set = world_open(&w, &desc);
    const int32_t n = (int32_t)world_fill(&w, set, &low, &high, 2);
    double *x = fetch(&w, set, "position", 1);
    for (int32_t i = 0; i < n; ++i) x[i] = 0.05 * sin(0.5 * PI * x[i] / high);
    put(&w, set, "velocity", 1, x);
    free(x);
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    const mpm_step_info before = world_info(&w);
    const double dt = fine ? 0.001 : 0.002;
    for (double t = 0.0; t < 0.5; t += dt) world_step(&w, dt);
    const double lost =
        before.kinetic_energy + before.strain_energy - w.info.kinetic_energy - w.info.strain_energy;
    ck_assert_double_gt(lost, 0.3 * before.kinetic_energy);
    gap[fine] = fabs(lost - w.info.damping_dissipation_total) / lost;
    show("bar %d: lost %g, damping %g\n", _i, lost, w.info.damping_dissipation_total);
    world_close(&w);
  }
  ck_assert_double_le(gap[1], 0.02);
  ck_assert_double_le(gap[1], 0.7 * gap[0]);
}
END_TEST

/* A bar hung up swings to rest, where its end is as long as its weight makes it, and where the reaction is
 * its weight. */
START_TEST(comes_to_rest) {
  const method *how = &methods[_i];
  const double g = 10.0, high = 1.0, low = 0.0;
  world_desc desc = world_with(how, 1, 16, 0.25);
  desc.stepper.local_damping = 0.7;
  desc.stepper.gravity[0] = -g;
  world w;
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, &low, &high, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  const double weight = g * mass_of(&w, set), dt = 0.3 * world_stable_dt(&w);
  double force = 0.0, mean = 0.0;
  for (int32_t k = 0; k < 400; ++k) {
    world_step(&w, dt);
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, &force));
    if (k >= 300) mean += force / 100.0;
  }
  ck_within(how->name, mean, weight, 2e-3 * weight);
  /* FLIP keeps what the nodes do not see */
  ck_assert_double_le(w.info.kinetic_energy, (how->flip == 1.0 ? 2e-3 : 1e-4) * w.info.strain_energy);
  world_close(&w);
}
END_TEST

/* ---- what is held -------------------------------------------------------------------------------------- */
static mpm_status steady(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const double *v = user;
  for (int64_t i = 0; i < b->n; ++i) {
    prescribed[b->ld + i] = 1;
    velocity[b->ld + i] = *v;
  }
  return 0;
}

/* A block that is moved against its weight at a steady speed costs its weight times the way: damping takes
 * nothing of it, whatever the sign of the velocity. */
START_TEST(held_nodes_are_not_damped) {
  const method *how = broad_methods[_i];
  double v = _i % 2 ? 0.2 : -0.2;
  const int32_t implicit = how->scheme == MPM_NEWMARK;
  const double dt = 0.004, g = 10.0;
  world w;
  mpm_particles *set = open_block(&w, how, implicit ? 0.0 : 0.8, 5.0, -g);
  set_velocity(&w, set, v);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, steady, &v));
  const double scale = g * mass_of(&w, set) * fabs(v) * dt;
  for (int32_t k = 0; k < STEPS; ++k) {
    world_step(&w, dt);
    ck_within(how->name, w.info.damping_dissipation, 0.0, 1e-12 * scale);
    ck_within(how->name, w.info.external_work, 0.0, 1e-9 * scale);
    ck_within(how->name, fetch1(&w, set, "velocity", 2, 1, 0), v, 1e-12);
  }
  world_close(&w);
}
END_TEST

/* ---- the rest ------------------------------------------------------------------------------------------ */
/* Implicit steps ask after each Newton iteration as well, before the energies are known. */
static mpm_status stop(void *user, const mpm_step_info *info) {
  *(double *)user = info->damping_dissipation;
  return info->damping_dissipation != 0.0;
}

/* A cloud between all kinds of walls gets the same bits from any number of threads, after a failure, and from
 * a state that was saved; what damping took goes with it. */
START_TEST(same_bits) {
  const method *how = broad_methods[_i];
  uint64_t hash = 0;
  for (int32_t threads = 1; threads < 4; threads += 2) {
    world w, other;
    double shown = 0.0;
    body_open(&w, &(body_desc){
                      .dim = 2, .method = *how, .led = how->scheme != MPM_NEWMARK, .concurrency = threads});
    mpm_stepper_desc desc = w.desc.stepper;
    desc.local_damping = how->scheme == MPM_NEWMARK ? 0.0 : 0.3;
    desc.mass_damping = 2.0;
    ck_ok(&w, mpm_stepper_configure(w.stepper, &desc));
    world_steps(&w, 3);
    ck_assert_double_gt(fabs(w.info.damping_dissipation), 0.0);
    world_bits was = world_take(&w);
    const mpm_step_info before = world_info(&w);
    ck_ok(&w, mpm_stepper_set_progress(w.stepper, stop, &shown));
    mpm_step_info info = {.struct_size = sizeof info};
    ck_assert_int_eq(mpm_step(w.stepper, BODY_DT, &info), MPM_CANCELLED);
    ck_assert_double_gt(fabs(shown), 0.0);
    ck_assert_double_eq(info.damping_dissipation, 0.0);
    ck_assert_double_eq(info.damping_dissipation_total, before.damping_dissipation_total);
    world_same(&w, &was, how->name);
    bits_drop(&was);
    ck_ok(&w, mpm_stepper_set_progress(w.stepper, NULL, NULL));
    world_steps(&w, 1);
    body_open(&other, &(body_desc){.dim = 2, .method = *how, .led = how->scheme != MPM_NEWMARK});
    ck_ok(&other, mpm_stepper_configure(other.stepper, &desc));
    world_copy(&w, &other);
    same_info(&w, &other);
    ck_assert_double_eq(world_info(&other).damping_dissipation, w.info.damping_dissipation);
    world_steps(&w, 1);
    world_steps(&other, 1);
    ck_assert_uint_eq(world_hash(&w), world_hash(&other));
    ck_assert_double_eq(other.info.damping_dissipation_total, w.info.damping_dissipation_total);
    if (threads == 1) hash = world_hash(&w);
    ck_assert_uint_eq(world_hash(&w), hash);
    ck_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));
    ck_assert_double_eq(world_info(&w).damping_dissipation_total, 0.0);
    world_close(&w);
    world_close(&other);
  }
}
END_TEST

START_TEST(refusals) {
  static const double bad[] = {-0.1, 1.0, 1.5, NOT_A_NUMBER, INFINITE};
  world w;
  world_desc d = world_default(2, 8, 0.25);
  world_open(&w, &d);
  for (int32_t i = 0; i < 5; ++i) {
    mpm_stepper_desc desc = stepper_desc();
    desc.local_damping = bad[i];
    ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_ARG, "local_damping is");
    desc = stepper_desc();
    desc.mass_damping = bad[i];
    if (bad[i] >= 1.0 && bad[i] < 2.0) continue;
    ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_ARG, "mass_damping is");
  }
  mpm_stepper_desc desc = stepper_desc();
  desc.scheme = MPM_NEWMARK;
  desc.local_damping = 0.1;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_UNSUPPORTED, "use mass_damping");
  desc.local_damping = 0.0;
  desc.mass_damping = 1.0;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &desc));
  desc.quasi_static = 1;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_UNSUPPORTED, "use mass_damping = 0");
  world_close(&w);
}
END_TEST

Suite *damping_suite(void);
Suite *damping_suite(void) {
  Suite *suite = suite_create("damping");
  TCase *blocks = tcase_create("blocks"), *bars = tcase_create("bars"), *other = tcase_create("other");
  tcase_add_loop_test(blocks, peaks_of_a_spring, 0, 3 * BROAD);
  tcase_add_loop_test(blocks, decay_by_mass, 0, BROAD);
  tcase_add_loop_test(blocks, slow_fall, 0, 2 * BROAD);
  tcase_add_loop_test(blocks, no_reaction_of_walls, 0, BROAD);
  tcase_add_loop_test(blocks, across_a_seam, 0, METHODS);
  tcase_add_loop_test(blocks, held_nodes_are_not_damped, 0, BROAD);
  tcase_add_loop_test(bars, half_of_a_bar, 0, METHODS);
  tcase_add_loop_test(bars, balance_of_a_bar, 0, 2);
  tcase_add_loop_test(bars, comes_to_rest, 0, METHODS);
  tcase_add_loop_test(other, same_bits, 0, BROAD);
  tcase_add_test(other, refusals);
  tcase_set_timeout(blocks, 60);
  tcase_set_timeout(bars, 60);
  suite_add_tcase(suite, blocks);
  suite_add_tcase(suite, bars);
  suite_add_tcase(suite, other);
  add_damping_contact(suite);
  return suite;
}
