/* Prescribed particles: their own motion, who comes first, reactions, work; walls, states and waves in files
 * of their own. */
#include "prescribed.h"

void open_clouds(world *w, const method *how, int32_t dim, int32_t walled, int32_t all) {
  world_desc desc = world_with(how, dim, 8, 0.1);
  desc.grid.periodic[0] = 1;
  memcpy(desc.stepper.gravity, (double[]){1.0, -5.0, 2.0}, 3 * sizeof(double));
  desc.sets = 2;
  world_open(w, &desc);
  dice d = {29};
  const double low = walled ? 0.0 : 0.2, high = walled ? 0.8 : 0.6;
  for (int32_t m = 0; m < 2; ++m) add_cloud(w, w->set[m], &d, CLOUD, 0.1, low, high, 1.0);
  uint8_t *flags = malloc((size_t)(dim * CLOUD));
  for (int32_t i = 0; i < dim * CLOUD; ++i) flags[i] = all || throw_between(&d, 0.0, 1.0) < 0.1;
  ck_ok(w, mpm_particles_set(w->set[1], "prescribed", MPM_U8, dim, CLOUD, NULL, flags));
  free(flags);
  if (!walled) return;
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.3));
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MAX, MPM_WALL_SLIP, 0.0));
  if (dim == 3) ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Z_MIN, MPM_WALL_FIXED, 0.0));
}

mpm_status prescribed_turn(void *user, const mpm_particle_batch *b, double *add) {
  ck_assert_ptr_eq(user, (void *)(uintptr_t)b->particles);
  for (int64_t p = 0; p < b->n; ++p)
    for (int32_t c = 0; c < b->dim; ++c) {
      if (b->id[p] >= 0) ck_assert_double_eq(add[c * b->ld + p], 0.0);
      add[c * b->ld + p] += (c ? -0.5 : 0.7) * b->position[(c + 1) % b->dim * b->ld + p] + b->t;
    }
  return 0;
}

uint8_t *fetch_flags(const world *w, const mpm_particles *set) {
  return fetch_as(w, set, "prescribed", MPM_U8, w->dim);
}

/* v = u and x += dt u to the last bit but one, whatever the transfer; others move on as they do. */
START_TEST(exact_motion) {
  const method *how = &methods[_i % METHODS];
  const int32_t dim = 2 + _i / METHODS % 2, moved = _i / METHODS / 2;
  world w;
  open_clouds(&w, how, dim, 1, 0);
  uint8_t *flags = fetch_flags(&w, w.set[1]);
  double *acceleration = calloc(3 * CLOUD, sizeof *acceleration);
  put(&w, w.set[1], "acceleration", dim, acceleration);
  free(acceleration);
  if (moved) ck_ok(&w, mpm_stepper_set_motion(w.stepper, w.set[1], prescribed_turn, w.set[1]));
  const double dt = 1e-3;
  for (int32_t i = 0; i < 4; ++i) {
    int32_t checked = 0;
    double *x = fetch(&w, w.set[1], "position", dim), *v = fetch(&w, w.set[1], "velocity", dim);
    const double t = world_info(&w).t;
    world_step(&w, dt);
    double *x_new = fetch(&w, w.set[1], "position", dim), *v_new = fetch(&w, w.set[1], "velocity", dim);
    double *a = fetch(&w, w.set[1], "acceleration", dim);
    for (int32_t c = 0; c < dim; ++c)
      for (int32_t p = 0; p < CLOUD; ++p) {
        const int32_t at = c * CLOUD + p;
        const double u = moved ? (c ? -0.5 : 0.7) * x[(c + 1) % dim * CLOUD + p] + t : v[at];
        if (!flags[at]) continue;
        ++checked;
        ck_within(how->name, v_new[at], u, 1e-15);
        ck_within(how->name, remainder(x_new[at] - x[at] - dt * u, 0.8), 0.0, 4e-16);
        ck_within(how->name, a[at], (u - v[at]) / dt, 1e-11);
      }
    ck_assert_int_gt(checked, 20);
    free(x), free(v), free(x_new), free(v_new), free(a);
  }
  free(flags);
  world_close(&w);
}
END_TEST

double of_field(const world *w, const mpm_particles *set, const char *field, int32_t c) {
  double *mass = fetch(w, set, "mass", 1), *v = fetch(w, set, field, w->dim);
  const double sum = weighted_sum(mpm_particles_count(set), mass, v + c * mpm_particles_count(set));
  free(mass), free(v);
  return sum;
}

/* What the prescribed set and the walls exert on the other, with its weight, is the change of its momentum.
 */
START_TEST(reactions_balance) {
  const method *how = &methods[_i % METHODS];
  const int32_t dim = 2 + _i / METHODS % 2, walled = _i / METHODS / 2;
  const double g[3] = {1.0, -5.0, 2.0}, dt = 1e-3;
  world w;
  open_clouds(&w, how, dim, walled, 1);
  ck_ok(&w, mpm_stepper_set_motion(w.stepper, w.set[1], prescribed_turn, w.set[1]));
  double force[2 * CLOUD * 3];
  dice d = {3};
  for (int32_t i = 0; i < 2 * CLOUD * 3; ++i) force[i] = throw_between(&d, -1.0, 1.0);
  for (int32_t m = 0; m < 2; ++m) put(&w, w.set[m], "applied_force", dim, force + m * 3 * CLOUD);
  for (int32_t i = 0; i < 4; ++i) {
    double before[3], reaction[3], other[3], wall[3], sum[3] = {0.0, 0.0, 0.0}, scale = 0.0;
    for (int32_t c = 0; c < dim; ++c) before[c] = of_field(&w, w.set[0], "velocity", c);
    world_step(&w, dt);
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, w.set[1], reaction));
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, w.set[0], other));
    for (int32_t face = 2; face < 2 * dim; ++face) {
      ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, face, wall));
      for (int32_t c = 0; c < dim; ++c) sum[c] += wall[c], scale += fabs(wall[c]);
    }
    for (int32_t c = 0; c < dim; ++c) {
      for (int32_t p = 0; p < CLOUD; ++p) sum[c] += force[c * CLOUD + p];
      sum[c] += mass_of(&w, w.set[0]) * g[c] + reaction[c];
      scale += fabs(reaction[c]) + mass_of(&w, w.set[0]) * 1.0 / dt;
    }
    for (int32_t c = 0; c < dim; ++c) {
      ck_within(how->name, other[c], 0.0, 0.0);
      ck_assert_double_gt(fabs(reaction[c]), 1e-3);
      ck_within(how->name, (of_field(&w, w.set[0], "velocity", c) - before[c]) / dt, sum[c], 1e-12 * scale);
    }
  }
  world_close(&w);
}
END_TEST

static double speeds[2];
static mpm_status both_alike(void *user, const mpm_particle_batch *b, double *add) {
  for (int64_t p = 0; p < b->n; ++p) add[p] += speeds[*(int32_t *)user];
  return 0;
}

/* The first set goes: the second keeps its motion and its impulses. The first comes back without any. */
static void first_goes_and_comes_back(world *w, const char *name) {
  double was[2], now[2], none[2];
  ck_ok(w, mpm_stepper_particles_reaction(w->stepper, w->set[1], &was[0]));
  ck_ok(w, mpm_stepper_particles_impulse(w->stepper, w->set[1], &was[1]));
  ck_ok(w, mpm_stepper_remove(w->stepper, w->set[0]));
  ck_ok(w, mpm_stepper_particles_reaction(w->stepper, w->set[1], &now[0]));
  ck_ok(w, mpm_stepper_particles_impulse(w->stepper, w->set[1], &now[1]));
  ck_assert_mem_eq(now, was, sizeof was);
  ck_ok(w, mpm_stepper_add(w->stepper, w->set[0]));
  ck_ok(w, mpm_stepper_particles_reaction(w->stepper, w->set[0], &none[0]));
  ck_ok(w, mpm_stepper_particles_impulse(w->stepper, w->set[0], &none[1]));
  ck_assert(none[0] == 0.0 && none[1] == 0.0);
  const double kept = speeds[0];
  speeds[0] = 0.9, speeds[1] = -0.4;
  world_step(w, 1e-3);
  ck_within(name, fetch1(w, w->set[0], "velocity", 1, 0, 0), kept, 1e-15);
  ck_within(name, fetch1(w, w->set[1], "velocity", 1, 0, 0), speeds[1], 1e-15);
}

/* Two sets of one particle each within one cell of a third: nodes have the mean by mass; impulses are shared
 * by mass. */
START_TEST(two_sets_on_one_node) {
  const method *how = &methods[_i];
  const double x[2] = {0.43, 0.47}, volume[2] = {0.001, 0.003}, xm = 0.45, vm = 0.02;
  int32_t number[2] = {0, 1};
  const uint8_t yes = 1;
  world w;
  world_desc desc = world_with(how, 1, 8, 0.1);
  desc.sets = 2;
  world_open(&w, &desc);
  speeds[0] = 0.3, speeds[1] = -0.5;
  for (int32_t m = 0; m < 2; ++m) {
    ck_ok(&w, mpm_particles_add(w.set[m], 1, &x[m], NULL, &volume[m], NULL, NULL, NULL));
    ck_ok(&w, mpm_particles_set_all(w.set[m], "prescribed", MPM_U8, 1, &yes));
    ck_ok(&w, mpm_stepper_set_motion(w.stepper, w.set[m], both_alike, &number[m]));
  }
  mpm_particles *third = world_add_set(&w, NULL);
  ck_ok(&w, mpm_particles_add(third, 1, &xm, NULL, &vm, NULL, NULL, NULL));
  world_step(&w, 1e-3);
  int64_t n;
  int64_t *index = fetch_node_indices(&w, &n);
  double *v = fetch_nodes(&w, "velocity", &n), *r = fetch_nodes(&w, "reaction", &n), force[2],
         shares[2] = {0.0, 0.0};
  int32_t checked = 0;
  for (int64_t i = 0; i < n; ++i) {
    double weight[2], mass = 0.0, momentum = 0.0;
    for (int32_t m = 0; m < 2; ++m) {
      const double f = fabs(x[m] / 0.1 - (double)index[i]);
      weight[m] = how->basis == MPM_LINEAR ? fmax(0.0, 1.0 - f)
                  : f < 0.5                ? 0.75 - f * f
                                           : 0.5 * pow(fmax(0.0, 1.5 - f), 2.0);
      mass += weight[m] * volume[m] * 1e3;
      momentum += weight[m] * volume[m] * 1e3 * speeds[m];
    }
    if (!(mass > 1e-9)) continue;
    ++checked;
    ck_within(how->name, v[i], momentum / mass, 1e-12);
    for (int32_t m = 0; m < 2; ++m) shares[m] += r[i] * weight[m] * volume[m] * 1e3 / mass;
  }
  ck_assert_int_ge(checked, 2);
  /* less what they would have gained themselves, at rest as they were: the nodes' increments or velocities */
  for (int32_t m = 0; m < 2; ++m) {
    double gain = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      const double f = fabs(x[m] / 0.1 - (double)index[i]);
      const double weight = how->basis == MPM_LINEAR ? fmax(0.0, 1.0 - f)
                            : f < 0.5                ? 0.75 - f * f
                                                     : 0.5 * pow(fmax(0.0, 1.5 - f), 2.0);
      gain += weight * v[i]; /* all started at rest: increment and velocity are the same */
    }
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, w.set[m], &force[m]));
    ck_within(how->name, force[m], shares[m] - volume[m] * 1e3 * gain / 1e-3, 1e-9);
    ck_assert_double_gt(fabs(force[m]), 1.0);
  }
  free(index), free(v), free(r);
  ck_ok(&w, mpm_stepper_remove(w.stepper, third));
  ck_refused(&w, mpm_stepper_particles_reaction(w.stepper, third, force), MPM_E_NOT_FOUND,
             "not in this stepper");
  first_goes_and_comes_back(&w, how->name);
  world_close(&w);
}
END_TEST

/* Prescribes x at nodes left of 0.4. */
static mpm_status hold_left(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    if (b->position[i] < 0.4 - 1e-9) prescribed[i] = 1, velocity[i] = 3.0;
  return 0;
}

static mpm_status to_corner(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) {
    add[p] += -2.0;
    add[b->ld + p] += 0.25;
  }
  return 0;
}

/* Callback, prescribed particles, walls, by node and axis; the reaction goes to the first. On the plane of a
 * wall that mirrors, particles and their images stand still across it. A block covers the floor; prescribed
 * are its particles with x < 0.6, in x and y. */
START_TEST(precedence) {
  const method *how = &methods[_i % METHODS];
  static const int32_t kinds[3] = {MPM_WALL_FIXED, MPM_WALL_SLIP, MPM_WALL_FRICTION_NODES};
  const int32_t kind = kinds[_i / METHODS % 3];
  const double lower[2] = {0.1, 0.0}, upper[2] = {1.1, 0.4}, down[2] = {0.0, -1.0};
  const double pressed[9] = {1.0, 0.0, 0.0, 0.0, 0.98, 0.0, 0.0, 0.0, 1.0};
  world w;
  world_desc desc = world_with(how, 2, 12, 0.1);
  desc.stepper.boundary_zero_acceleration = _i / METHODS / 3;
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, down));
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, pressed));
  const int64_t count = mpm_particles_count(set);
  double *x = fetch(&w, set, "position", 2);
  uint8_t *flags = malloc((size_t)(2 * count));
  for (int64_t p = 0; p < 2 * count; ++p) flags[p] = x[p % count] < 0.6;
  ck_ok(&w, mpm_particles_set(set, "prescribed", MPM_U8, 2, count, NULL, flags));
  ck_ok(&w, mpm_stepper_set_motion(w.stepper, set, to_corner, NULL));
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, hold_left, NULL));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, kind, 0.5));
  world_step(&w, 1e-4);
  const int64_t last = how->basis == MPM_LINEAR ? 6 : 7; /* that prescribed particles touch */
  int64_t n, seen[3] = {0, 0, 0};
  int64_t *index = fetch_node_indices(&w, &n);
  double *v = fetch_nodes(&w, "velocity", &n), *r = fetch_nodes(&w, "reaction", &n);
  double floor_force[2], platen[2], wall_sum[2] = {0.0, 0.0};
  double *a = how->transfer == MPM_APIC_MLS ? NULL : fetch_nodes(&w, "acceleration", &n);
  for (int64_t i = 0; i < n; ++i) {
    if (index[n + i] < 0) continue;
    const int32_t host = index[i] < 4, particle = index[i] <= last;
    /* the mirror image of the row that touches the ghosts counts against it, where the wall reverses */
    const int32_t mirrored = last == 7 && kind < MPM_WALL_FRICTION && index[n + i] == 1;
    const double share[2] = {mirrored && kind == MPM_WALL_FIXED ? 0.96875 : 1.0, mirrored ? 0.96875 : 1.0};
    ++seen[host ? 0 : particle ? 1 : 2];
    if (host) ck_within(how->name, v[i], 3.0, 0.0);
    if (particle && !host) ck_within(how->name, v[i], -2.0 * share[0], 1e-12);
    const int32_t on_plane = kind < MPM_WALL_FRICTION && index[n + i] == 0;
    if (particle && !on_plane) ck_within(how->name, v[n + i], 0.25 * share[1], 1e-12);
    if (particle && on_plane) ck_within(how->name, v[n + i], 0.0, 0.0);
    if (!particle && index[n + i] == 0) ck_within(how->name, v[n + i], 0.0, 1e-15);
    if (particle && a)
      ck_assert_msg((fabs(a[i]) <= 0.0) == desc.stepper.boundary_zero_acceleration, "%s: acceleration %g",
                    how->name, a[i]);
    if (!particle)
      for (int32_t c = 0; c < 2; ++c) wall_sum[c] += r[c * n + i];
  }
  for (int32_t k = 0; k < 3; ++k) ck_assert_int_gt(seen[k], 5);
  for (int64_t i = 0; i < n; ++i) /* ghosts below the part that only the wall holds */
    for (int32_t c = 0; c < 2; ++c)
      if (index[n + i] < 0 && index[i] > last) wall_sum[c] += r[c * n + i];
  ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, floor_force));
  ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, set, platen));
  for (int32_t c = 0; c < 2; ++c)
    ck_within(how->name, floor_force[c], wall_sum[c], 1e-9 * (1.0 + fabs(wall_sum[c])));
  ck_assert_double_gt(floor_force[1], 1.0);
  double gained = 0.0, *moved = fetch(&w, set, "velocity", 2), *mass = fetch(&w, set, "mass", 1);
  for (int64_t p = 0; p < count; ++p) gained += flags[p] ? 0.0 : mass[p] * (moved[count + p] - down[1]);
  ck_within(how->name, 1e-4 * (platen[1] + floor_force[1]), gained, 1e-9 * gained);
  free(moved), free(mass);
  /* without acceleration FLIP particles get nothing, and the pressed part is in balance */
  if (!desc.stepper.boundary_zero_acceleration || how->transfer != MPM_FLIP || how->flip < 1.0) {
    ck_assert_double_gt(platen[1], 1.0);
    ck_assert_double_lt(platen[0], -1.0);
  }
  free(index), free(v), free(r), free(x), free(flags), free(a);
  world_close(&w);
}
END_TEST

/* Positions that are moved after the velocities give prescribed particles no second impulse. */
START_TEST(reaction_with_projected_positions) {
  double reaction[2][2];
  for (int32_t projected = 0; projected < 2; ++projected) {
    const double lower[2] = {0.1, 0.3}, upper[2] = {1.1, 0.7}, down[2] = {0.0, -1.0};
    method how = methods[1]; /* quadratic FLIP MUSL */
    how.projected = projected;
    world_desc desc = world_with(&how, 2, 12, 0.1);
    world w;
    mpm_particles *set = world_open(&w, &desc);
    const int64_t count = world_fill(&w, set, lower, upper, 2);
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, down));
    double *x = fetch(&w, set, "position", 2);
    uint8_t *flags = malloc((size_t)(2 * count));
    for (int64_t p = 0; p < 2 * count; ++p) flags[p] = x[p % count] < 0.6;
    ck_ok(&w, mpm_particles_set(set, "prescribed", MPM_U8, 2, count, NULL, flags));
    ck_ok(&w, mpm_stepper_set_motion(w.stepper, set, to_corner, NULL));
    world_step(&w, 1e-4);
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, set, reaction[projected]));
    free(x), free(flags);
    world_close(&w);
  }
  for (int32_t c = 0; c < 2; ++c) {
    ck_assert_double_gt(fabs(reaction[0][c]), 1.0);
    ck_within("reaction", reaction[1][c], reaction[0][c], 1e-9 * fabs(reaction[0][c]));
  }
}
END_TEST

static mpm_status slide_along(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) add[p] += 0.5;
  return 0;
}

/* A body that is driven along a friction wall is still held up by it, and is not held back. */
START_TEST(driven_along_a_wall) {
  const method *how = &methods[_i % METHODS];
  const int32_t plane = _i / METHODS;
  const double lower[2] = {0.1, 0.0}, upper[2] = {0.7, 0.4}, down[2] = {0.0, -1.0};
  const uint8_t along[2] = {1, 0};
  world w;
  world_desc desc = world_with(how, 2, 12, 0.1);
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, down));
  ck_ok(&w, mpm_particles_set_all(set, "prescribed", MPM_U8, 2, along));
  ck_ok(&w, mpm_stepper_set_motion(w.stepper, set, slide_along, NULL));
  const int32_t kind = plane ? MPM_WALL_FRICTION : MPM_WALL_FRICTION_NODES;
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, kind, 0.5));
  double up = 0.0;
  for (int32_t i = 0; i < 5; ++i) {
    double force[2];
    int64_t n;
    world_step(&w, 1e-3);
    int64_t *index = fetch_node_indices(&w, &n);
    double *v = fetch_nodes(&w, "velocity", &n), *gap = fetch_nodes(&w, "contact_gap", &n);
    for (int64_t k = 0; k < n; ++k) {
      ck_within(how->name, v[k], 0.5, 1e-12);
      if (!plane && index[n + k] == 0) ck_between(how->name, v[n + k], -1e-15, 1.0);
      if (plane && gap[k] < 0.1) ck_between(how->name, v[n + k], -fmax(gap[k], 0.0) / 1e-3 - 1e-12, 1.0);
    }
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, force));
    ck_within(how->name, force[0], 0.0, 0.0);
    up += force[1];
    free(index), free(v), free(gap);
  }
  ck_assert_double_gt(up, 100.0);
  world_close(&w);
}
END_TEST

/* A body that is prescribed whole, at constant speed under gravity, holds itself: no force on anything, no
 * strain; and when it is made faster, the work is that of its momentum. */
START_TEST(nothing_to_push) {
  const method *how = &methods[_i];
  const double v0[3] = {0.4, -0.3, 0.2};
  const uint8_t all[3] = {1, 1, 1};
  world w;
  world_desc desc = world_with(how, 3, 8, 0.1);
  memcpy(desc.stepper.gravity, (double[]){1.0, -5.0, 2.0}, 3 * sizeof(double));
  mpm_particles *set = world_open(&w, &desc);
  double force[3];
  world_fill_cube(&w, set, 0.2, 0.6);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 3, v0));
  ck_ok(&w, mpm_particles_set_all(set, "prescribed", MPM_U8, 3, all));
  ck_refused(&w, mpm_stepper_particles_reaction(w.stepper, set, force), MPM_E_STATE, "no step");
  const double mass = mass_of(&w, set), squared = 0.29;
  for (int32_t i = 0; i < 5; ++i) {
    const mpm_step_info info = world_step(&w, 1e-3);
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, set, force));
    for (int32_t c = 0; c < 3; ++c) ck_within(how->name, force[c], 0.0, 1e-9 * mass);
    ck_within(how->name, info.external_work, 0.0, 1e-12 * mass);
    ck_within(how->name, info.kinetic_energy, 0.5 * mass * squared, 1e-12 * mass);
  }
  double *F = fetch(&w, set, "deformation_gradient", 9);
  const int64_t n = mpm_particles_count(set);
  for (int64_t p = 0; p < 9 * n; ++p) ck_within(how->name, F[p], p / n % 4 ? 0.0 : 1.0, 1e-13);
  free(F);
  world_close(&w);
}
END_TEST

static mpm_status double_speed(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t p = 0; p < b->n; ++p) add[c * b->ld + p] += 2.0 * b->velocity[c * b->ld + p];
  return 0;
}

/* Twice as fast: the work is the change of momentum times the mean velocity of the
 * step, whatever gravity does. */
START_TEST(work_of_moving_itself) {
  const method *how = &methods[_i % METHODS];
  const double lower = 0.2, upper = 0.6, v0 = 0.4;
  const uint8_t yes = 1;
  world w;
  world_desc desc = world_with(how, 1, 8, 0.1);
  desc.stepper.gravity[0] = -7.0;
  desc.stepper.boundary_zero_acceleration = _i / METHODS;
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, &lower, &upper, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 1, &v0));
  ck_ok(&w, mpm_particles_set_all(set, "prescribed", MPM_U8, 1, &yes));
  ck_ok(&w, mpm_stepper_set_motion(w.stepper, set, double_speed, NULL));
  const double mass = mass_of(&w, set);
  const mpm_step_info info = world_step(&w, 1e-3);
  ck_within(how->name, info.external_work, mass * (0.8 - 0.4) * 0.8, 1e-12 * mass);
  ck_within(how->name, info.dissipation, mass * (0.32 - 0.5 * (0.64 - 0.16)), 1e-12 * mass);
  world_close(&w);
}
END_TEST

static mpm_status only_light(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p)
    if (b->id[p] == 1000) add[p] += 50.0;
  return 0;
}

/* First moment along x of the nodes' mass: that of the particles, if each has been added where it is. */
static double moment_of_nodes(world *w) {
  int64_t n;
  double *mass = fetch_nodes(w, "mass", &n), *x = fetch_nodes(w, "position", &n);
  const double sum = weighted_sum(n, mass, x);
  free(mass), free(x);
  return sum;
}

/* A light particle is driven through a heavy body that is held, half a cell in each step and unlike the nodes
 * about it: it is missed as soon as it has left its tile, not when the nodes would have taken it there. */
START_TEST(light_through_heavy) {
  const double lower[2] = {0.0, 0.0}, upper[2] = {4.0, 0.4}, x[2] = {1.42, 0.2}, volume = 1e-4;
  const int64_t id = 1000;
  const uint8_t all[2] = {1, 1};
  world w;
  world_desc desc = world_default(2, 40, 0.1);
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 1);
  ck_ok(&w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, &id, NULL));
  ck_ok(&w, mpm_particles_set_all(set, "prescribed", MPM_U8, 2, all));
  ck_ok(&w, mpm_stepper_set_motion(w.stepper, set, only_light, NULL));
  for (int32_t i = 1; i <= 45; ++i) {
    double now[2];
    const double moment = of_field(&w, set, "position", 0);
    const mpm_step_info info = world_step(&w, 1e-3);
    ck_within("light", moment_of_nodes(&w), moment, 1e-12 * moment);
    ck_ok(&w, mpm_particles_get(set, "position", MPM_F64, 2, 1, &id, now));
    ck_within("light", now[0], 1.42 + 5e-2 * i, 1e-12);
    ck_within("light", now[1], 0.2, 0.0);
    if (i == 45) ck_assert_int_ge(info.resorts, 2); /* the first sort is one of them */
  }
  world_close(&w);
}
END_TEST

/* A block on a wall is pressed by a platen, whose domains end on nodes; `origin` moves all of it. */
static double force_on_wall(int32_t basis, int32_t scheme, double origin) {
  world w;
  world_desc desc = world_default(2, 12, 0.1);
  desc.grid.basis = basis;
  desc.grid.origin[0] = origin;
  desc.grid.periodic[1] = 1;
  desc.sets = 2;
  desc.stepper.scheme = scheme;
  desc.stepper.quasi_static = scheme == MPM_NEWMARK;
  world_open(&w, &desc);
  const double at[] = {origin, origin + 0.5, origin + 0.7}, v[2] = {-0.01, 0.0};
  const uint8_t all[2] = {1, 1};
  for (int32_t m = 0; m < 2; ++m)
    world_fill(&w, w.set[m], (const double[]){at[m], 0.0}, (const double[]){at[m + 1], 1.2}, 2);
  ck_ok(&w, mpm_particles_set_all(w.set[1], "prescribed", MPM_U8, 2, all));
  ck_ok(&w, mpm_particles_set_all(w.set[1], "velocity", MPM_F64, 2, v));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  double force[2], dt;
  ck_ok(&w, mpm_stable_dt(w.stepper, &dt)); /* a wave has long come to the wall */
  for (int32_t i = 0; i < 40; ++i) world_step(&w, 0.4 * dt);
  ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, force));
  world_close(&w);
  return force[0];
}

/* Whether rounding lets a domain reach a node or not, the platen holds the same nodes. */
START_TEST(domains_that_end_on_nodes) {
  static const int32_t basis[] = {MPM_GIMP, MPM_UGIMP, MPM_CPGIMP}, scheme[] = {MPM_USL, MPM_NEWMARK};
  const double at_rest = force_on_wall(basis[_i / 2], scheme[_i % 2], 0.0);
  ck_assert_double_gt(at_rest, 0.0);
  for (int32_t k = 0; k < 12; ++k)
    ck_within("force on the wall", force_on_wall(basis[_i / 2], scheme[_i % 2], 0.1 * k - 0.2), at_rest,
              1e-8 * at_rest);
}
END_TEST

Suite *prescribed_suite(void) {
  Suite *suite = suite_create("prescribed");
  TCase *tc = tcase_create("prescribed");
  tcase_set_timeout(tc, 120);
  tcase_add_loop_test(tc, exact_motion, 0, 4 * METHODS);
  tcase_add_loop_test(tc, reactions_balance, 0, 4 * METHODS);
  tcase_add_loop_test(tc, two_sets_on_one_node, 0, METHODS);
  tcase_add_loop_test(tc, precedence, 0, 6 * METHODS);
  tcase_add_test(tc, reaction_with_projected_positions);
  tcase_add_loop_test(tc, driven_along_a_wall, 0, 2 * METHODS);
  tcase_add_loop_test(tc, nothing_to_push, 0, METHODS);
  tcase_add_loop_test(tc, work_of_moving_itself, 0, 2 * METHODS);
  tcase_add_test(tc, light_through_heavy);
  tcase_add_loop_test(tc, domains_that_end_on_nodes, 0, 6);
  suite_add_tcase(suite, tc);
  suite_add_tcase(suite, prescribed_walls_case());
  suite_add_tcase(suite, prescribed_state_case());
  suite_add_tcase(suite, prescribed_waves_case());
  return suite;
}
