/* FMPM: the series against the inverse of the full mass matrix, what boundaries make of it, and which steps
 * have it. Whole steps stand beside the reference in `schemes`, walls in `walls`. */
#include "obstacle.h"
#include "body.h"
#include "reference.h"

static world_desc described(int32_t dim, const basis_option *b, int32_t scheme, int32_t order,
                            int32_t every) {
  world_desc d = world_default(dim, 8, 0.25);
  use_basis(b, &d.grid);
  d.stepper.scheme = scheme;
  d.stepper.transfer = MPM_FMPM;
  d.stepper.xpic_order = order;
  d.stepper.xpic_every = every;
  return d;
}

/* ---- the series --------------------------------------------------------------------------------------- */
enum { NODES = 16 };

/* Opens 16 periodic cells with two particles each, and with the velocities of a wave of a third of them. */
static mpm_particles *open_wave(world *w, int32_t order) {
  world_desc d = described(1, &basis_options[1], MPM_USL, order, 0);
  d.grid.cells[0] = NODES;
  d.grid.spacing[0] = 1.0;
  d.grid.periodic[0] = 1;
  mpm_particles *set = world_open(w, &d);
  double v[2 * NODES];
  ck_assert_int_eq(world_fill(w, set, (const double[]){0.0}, (const double[]){NODES}, 2), 2 * NODES);
  double *x = fetch(w, set, "position", 1);
  for (int32_t p = 0; p < 2 * NODES; ++p) v[p] = sin(2.0 * PI * 3.0 * x[p] / NODES);
  put(w, set, "velocity", 1, v);
  free(x);
  return set;
}

/* What a step leaves of a wave of nearly five cells. The orders 1 ... 16 were computed by the matrices. */
START_TEST(share_of_a_wave) {
  static const struct {
    int32_t order;
    double kept;
  } table[] = {{1, 0.704651}, {2, 0.912707}, {4, 0.992276}, {8, 0.999817}, {16, 0.999875}};
  world w;
  mpm_particles *set = open_wave(&w, table[_i].order);
  double *before = fetch(&w, set, "velocity", 1);
  world_step(&w, 1e-9);
  double *after = fetch(&w, set, "velocity", 1), squares = 0.0, was = 0.0;
  for (int32_t p = 0; p < 2 * NODES; ++p) squares += after[p] * after[p], was += before[p] * before[p];
  ck_within("amplitude", sqrt(squares / was), table[_i].kept, 1e-6);
  free(before), free(after);
  world_close(&w);
}
END_TEST

/* The same wave as sums over particles by the 16 quadratic functions: the velocities of the nodes approach
 * those of the full mass matrix, and particles get them by their weights. */
static void weights_of(double x, double *w) {
  for (int32_t i = 0; i < NODES; ++i) {
    double away = fabs(x - i);
    away = fmin(away, NODES - away);
    w[i] = away < 0.5 ? 0.75 - away * away : away < 1.5 ? 0.5 * (1.5 - away) * (1.5 - away) : 0.0;
  }
}

/* Solves A x = b by elimination; A is positive definite. x in b. */
static void solve(double (*A)[NODES], double *b) {
  for (int32_t k = 0; k < NODES; ++k)
    for (int32_t i = k + 1; i < NODES; ++i) {
      const double by = A[i][k] / A[k][k];
      for (int32_t j = k; j < NODES; ++j) A[i][j] -= by * A[k][j];
      b[i] -= by * b[k];
    }
  for (int32_t k = NODES - 1; k >= 0; --k) {
    for (int32_t j = k + 1; j < NODES; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
}

START_TEST(tends_to_the_full_mass_matrix) {
  static const struct {
    int32_t order;
    double error;
  } table[] = {{1, 0.295261}, {2, 0.087179}, {4, 0.00760018}, {8, 5.776e-5}, {16, 3.3e-9}};
  double full[NODES][NODES] = {{0.0}}, exact[NODES] = {0.0}, weight[NODES], off = 0.0, size = 0.0;
  double normal[NODES][NODES] = {{0.0}}, of_nodes[NODES] = {0.0};
  world w;
  mpm_particles *set = open_wave(&w, table[_i].order);
  double *x = fetch(&w, set, "position", 1), *v = fetch(&w, set, "velocity", 1);
  world_step(&w, 1e-9);
  double *after = fetch(&w, set, "velocity", 1);
  for (int32_t p = 0; p < 2 * NODES; ++p) {
    weights_of(x[p], weight);
    for (int32_t i = 0; i < NODES; ++i) {
      exact[i] += weight[i] * v[p];
      of_nodes[i] += weight[i] * after[p]; /* the nodes' values follow from those of the particles */
      for (int32_t j = 0; j < NODES; ++j) full[i][j] += weight[i] * weight[j];
    }
  }
  memcpy(normal, full, sizeof full);
  solve(full, exact);
  solve(normal, of_nodes);
  for (int32_t i = 0; i < NODES; ++i) {
    off += (of_nodes[i] - exact[i]) * (of_nodes[i] - exact[i]);
    size += exact[i] * exact[i];
  }
  ck_within("error", sqrt(off / size), table[_i].error, 1e-6);
  free(x), free(v), free(after);
  world_close(&w);
}
END_TEST

/* Velocities after steps of a random cloud, by ascending id; to be freed. */
static double *after_steps(const world_desc *d, int32_t steps, int64_t *count) {
  world w;
  mpm_particles *set = world_open(&w, d);
  dice random = {42};
  add_cloud(&w, set, &random, 60, 0.25, 0.5, 1.5, 1.0);
  for (int32_t i = 0; i < steps; ++i) world_step(&w, 1e-3);
  double *v = fetch(&w, set, "velocity", w.dim);
  *count = mpm_particles_count(set) * w.dim;
  world_close(&w);
  return v;
}

static double difference(const double *a, const double *b, int64_t n) {
  double most = 0.0;
  for (int64_t i = 0; i < n; ++i) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* Order 1 is PIC, and every order keeps the momentum. */
START_TEST(order_one_is_pic) {
  const basis_option *b = &basis_options[_i % BASES];
  world_desc d = described(2, b, scheme_options[_i / BASES].scheme, 1, 0);
  int64_t n;
  double *one = after_steps(&d, 5, &n);
  d.stepper.xpic_order = 2;
  double *two = after_steps(&d, 5, &n);
  d.stepper.transfer = MPM_FLIP;
  d.stepper.flip = 0.0;
  double *pic = after_steps(&d, 5, &n);
  ck_within(b->name, difference(one, pic, n), 0.0, 1e-13);
  ck_assert_double_gt(difference(two, pic, n), 1e-3);
  free(one), free(two), free(pic);
}
END_TEST

START_TEST(momentum_is_kept) {
  const basis_option *b = &basis_options[_i % BASES];
  const int32_t dim = 1 + _i / BASES;
  world_desc d = described(dim, b, MPM_USL, 32, 0);
  world w;
  mpm_particles *set = world_open(&w, &d);
  dice random = {7};
  add_cloud(&w, set, &random, dim == 1 ? 20 : 60, 0.25, 0.75, 1.25, 1.0);
  const mpm_step_info start = world_info(&w);
  double scale = 0.0, *m = fetch(&w, set, "mass", 1), *v = fetch(&w, set, "velocity", dim);
  for (int64_t i = 0; i < dim * mpm_particles_count(set); ++i)
    scale += m[i % mpm_particles_count(set)] * fabs(v[i]);
  for (int32_t k = 0; k < 5; ++k) world_step(&w, 1e-3);
  for (int32_t c = 0; c < dim; ++c) ck_within(b->name, w.info.momentum[c], start.momentum[c], 1e-12 * scale);
  free(m), free(v);
  world_close(&w);
}
END_TEST

/* ---- boundaries --------------------------------------------------------------------------------------- */
/* Nodes below a line all go the same way. */
static mpm_status lead_below(void *user, const mpm_node_batch *b, uint8_t *held, double *velocity) {
  const double line = *(const double *)user;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t c = 0; c < b->dim && b->position[i] < line; ++c) {
      held[c * b->ld + i] = 1;
      velocity[c * b->ld + i] = 0.25;
    }
  return MPM_OK;
}

/* Where the whole stencil of a particle is held, it has the held velocity to rounding at any order, which the
 * series without the condition misses. What the host gives is the change of the momentum. */
START_TEST(held_nodes_stay_held) {
  const basis_option *b = &basis_options[_i % BASES];
  const int32_t orders[3] = {2, 8, 32}, order = orders[_i / BASES];
  world_desc d = described(2, b, MPM_USL, order, 0);
  world w;
  mpm_particles *set = world_open(&w, &d);
  double line = 1.05;
  dice random = {3};
  add_cloud(&w, set, &random, 200, 0.25, 0.5, 1.5, 1.0);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, lead_below, &line));
  double *x = fetch(&w, set, "position", 2), *m = fetch(&w, set, "mass", 1);
  const mpm_step_info before = world_info(&w);
  world_step(&w, 1e-4);
  double *v = fetch(&w, set, "velocity", 2);
  const int64_t n = mpm_particles_count(set);
  int32_t inside = 0, others = 0;
  for (int64_t p = 0; p < n; ++p) {
    if (x[p] + reference_reach(b) * 0.25 < line) {
      ck_within(b->name, v[p], 0.25, 1e-12);
      ck_within(b->name, v[n + p], 0.25, 1e-12);
      ++inside;
    }
    others += x[p] > line;
  }
  ck_assert_int_gt(inside, 5);
  ck_assert_int_gt(others, 5);
  int64_t nodes;
  double *reaction = fetch_nodes(&w, "reaction", &nodes), given[2] = {0.0, 0.0};
  for (int64_t i = 0; i < 2 * nodes; ++i) given[i / nodes] += 1e-4 * reaction[i];
  for (int32_t c = 0; c < 2; ++c)
    ck_within(b->name, w.info.momentum[c] - before.momentum[c], given[c], 1e-12 * sum_of(n, m));
  /* the held velocity is 1/4 on both axes, and so is the work of the impulse */
  ck_within("work", w.info.external_work, 0.25 * (given[0] + given[1]), 1e-12 * sum_of(n, m));
  free(x), free(v), free(m), free(reaction);
  world_close(&w);
}
END_TEST

/* Prescribed particles among others: what they report is what the others gain, at any order. */
START_TEST(prescribed_particles_report) {
  const basis_option *b = &basis_options[_i % BASES];
  world_desc d = described(2, b, scheme_options[_i / BASES % SCHEMES].scheme, 6, 0);
  world w;
  mpm_particles *set = world_open(&w, &d);
  dice random = {5};
  add_cloud(&w, set, &random, 120, 0.25, 0.5, 1.5, 1.0);
  const int64_t n = mpm_particles_count(set);
  uint8_t *flags = calloc((size_t)(2 * n), 1);
  double *m = fetch(&w, set, "mass", 1), *v = fetch(&w, set, "velocity", 2);
  for (int64_t i = 0; i < 2 * n; ++i) {
    flags[i] = i % n < 10;
    if (flags[i]) v[i] = 0.3; /* they go alike, so that no node has two of their velocities */
  }
  put(&w, set, "velocity", 2, v);
  ck_ok(&w, mpm_particles_set(set, "prescribed", MPM_U8, 2, n, NULL, flags));
  const mpm_step_info before = world_info(&w);
  double impulse[3];
  world_step(&w, 1e-4);
  ck_ok(&w, mpm_stepper_particles_impulse(w.stepper, set, impulse));
  for (int32_t c = 0; c < 2; ++c)
    ck_within(b->name, w.info.momentum[c] - before.momentum[c], impulse[c], 1e-12 * sum_of(n, m));
  free(flags), free(m), free(v);
  world_close(&w);
}
END_TEST

static void momentum_of(const world *w, const mpm_particles *set, double *momentum) {
  double *v = fetch(w, set, "velocity", 2), *mass = fetch(w, set, "mass", 1);
  const int64_t n = mpm_particles_count(set);
  for (int32_t c = 0; c < 2; ++c) momentum[c] = weighted_sum(n, mass, v + c * n);
  free(v), free(mass);
}

/* Two bodies collide in flight, or on a floor that rubs: each gains what contact is said to have given, and
 * both what the floor has given. */
START_TEST(contact_gives_its_impulse) {
  const int32_t rests = _i % 2, nodes = _i / 2 % 2;
  const double low = rests ? 0.0 : 1.0, dt = 2e-4, toward[2][2] = {{1.0, -0.5}, {-1.0, -0.25}};
  world_desc d = described(2, &basis_options[1], scheme_options[_i / 4].scheme, 8, 0);
  d.sets = 2;
  d.grid.cells[0] = d.grid.cells[1] = 12;
  world w;
  world_open(&w, &d);
  mpm_contact_desc rule;
  ck_ok(&w, mpm_contact_desc_init(&rule, sizeof rule));
  rule.friction = 0.3;
  ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[1], 1));
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &rule));
  ck_ok(&w,
        mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, nodes ? MPM_WALL_FRICTION_NODES : MPM_WALL_FRICTION, 0.2));
  for (int32_t m = 0; m < 2; ++m) {
    world_fill(&w, w.set[m], (const double[]){m ? 1.5 : 0.75, low},
               (const double[]){m ? 2.25 : 1.5, low + 0.75}, 2);
    ck_ok(&w, mpm_particles_set_all(w.set[m], "velocity", MPM_F64, 2, toward[m]));
  }
  mpm_contact_info pair = {.struct_size = sizeof pair};
  const double mass = mass_of(&w, w.set[0]);
  double at_wall[3], mutual = 0.0, carried = 0.0, before[2][2], after[2][2];
  for (int32_t k = 0; k < 8; ++k) {
    const double told[2] = {pair.impulse[0], pair.impulse[1]};
    for (int32_t m = 0; m < 2; ++m) momentum_of(&w, w.set[m], before[m]);
    world_step(&w, dt);
    for (int32_t m = 0; m < 2; ++m) momentum_of(&w, w.set[m], after[m]);
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, at_wall));
    ck_ok(&w, mpm_stepper_contact_info(w.stepper, 0, 1, &pair));
    for (int32_t c = 0; c < 2; ++c) {
      const double gain[2] = {after[0][c] - before[0][c], after[1][c] - before[1][c]};
      ck_within("both", gain[0] + gain[1], dt * at_wall[c], 1e-12 * mass);
      if (!rests) ck_within("the second", gain[1], pair.impulse[c] - told[c], 1e-12 * mass);
    }
    mutual = fmax(mutual, pair.impulse[0]);
    carried = fmax(carried, dt * at_wall[1]);
  }
  ck_assert_double_gt(mutual, 1e-3 * mass);
  ck_assert_int_eq(carried > 1e-3 * mass, rests);
  world_close(&w);
}
END_TEST

/* A block comes down askew on an obstacle, fixed, driven towards it, or free: the block gains what the
 * obstacle is said to have given, a free obstacle the opposite, and contact with what does not drive makes no
 * energy. */
START_TEST(obstacles_give_their_impulse) {
  const int32_t motion = MPM_MOTION_FIXED + _i % 3, scheme = scheme_options[_i / 3].scheme;
  const double dt = 2e-4, v[] = {0.6, -1.0}, low[] = {0.75, 0.75}, high[] = {1.5, 1.5};
  const world_desc d = described(2, &basis_options[1], scheme, 8, 0);
  world w;
  mpm_particles *set = world_open(&w, &d);
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_obstacle_desc of = obstacle_desc(MPM_SHAPE_SPHERE);
  const mpm_contact_desc rule = rule_with(0.3);
  of.contact = &rule;
  of.motion = motion;
  of.size[0] = 0.5;
  of.position[0] = 1.0;
  of.position[1] = 0.749 - 0.5;
  of.mass = 400.0;
  of.inertia[0] = of.inertia[4] = of.inertia[8] = 40.0;
  if (motion == MPM_MOTION_PRESCRIBED) of.velocity[1] = 0.5;
  mpm_obstacle *obstacle = put_obstacle(&w, &of);
  const double mass = mass_of(&w, set);
  mpm_contact_info told = {0};
  double before[2], after[2], start[2], carried = 0.0, most = 0.0;
  const mpm_step_info first = world_info(&w);
  momentum_of(&w, set, start);
  for (int32_t k = 0; k < 60; ++k) {
    const double was[2] = {told.impulse[0], told.impulse[1]};
    momentum_of(&w, set, before);
    const mpm_step_info now = world_step(&w, dt);
    momentum_of(&w, set, after);
    told = touch_of(&w, obstacle);
    for (int32_t c = 0; c < 2; ++c)
      ck_within("gain", after[c] - before[c], told.impulse[c] - was[c], 1e-12 * mass);
    carried = fmax(carried, told.impulse[1] - was[1]);
    most = fmax(most, now.kinetic_energy + now.strain_energy);
  }
  ck_assert_double_gt(carried, 1e-3 * mass);
  ck_holds(after[0] < start[0]); /* it rubs */
  if (motion == MPM_MOTION_FREE) {
    double velocity[3];
    ck_ok(&w, mpm_obstacle_get_pose(obstacle, NULL, NULL, velocity, NULL));
    for (int32_t c = 0; c < 2; ++c)
      ck_within("obstacle", 400.0 * velocity[c], start[c] - after[c], 1e-10 * mass);
  }
  show("motion %d: energy %g of the first, carried %g\n", (int)motion, most / first.kinetic_energy,
       carried / mass);
  if (motion != MPM_MOTION_PRESCRIBED) ck_holds(most <= 1.0001 * first.kinetic_energy);
  drop_obstacle(&w, obstacle);
  world_close(&w);
}
END_TEST

/* A block comes down on a friction wall, or on the plane of an obstacle where that wall is; returns the
 * energy at the end, over the first. */
static double land(int32_t scheme, int32_t on_wall) {
  const double v[] = {0.6, -1.0}, low[] = {0.75, 0.0}, high[] = {1.5, 0.75};
  const world_desc d = described(2, &basis_options[1], scheme, 8, 0);
  world w;
  mpm_particles *set = world_open(&w, &d);
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_obstacle_desc of = obstacle_desc(MPM_SHAPE_PLANE);
  const mpm_contact_desc rule = rule_with(0.3);
  of.contact = &rule;
  of.position[1] = 0.0;
  mpm_obstacle *plane = on_wall ? NULL : put_obstacle(&w, &of);
  if (on_wall) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.3));
  const mpm_step_info first = world_info(&w);
  double start[2], end[2], impulse[3];
  momentum_of(&w, set, start);
  for (int32_t k = 0; k < 400; ++k) {
    const mpm_step_info now = world_step(&w, 5e-4);
    ck_holds(now.kinetic_energy + now.strain_energy <= 1.0001 * first.kinetic_energy);
  }
  momentum_of(&w, set, end);
  ck_ok(&w, mpm_stepper_wall_impulse(w.stepper, MPM_Y_MIN, impulse));
  for (int32_t c = 0; c < 2 && on_wall; ++c)
    ck_within("impulse", end[c] - start[c], impulse[c], 1e-11 * mass_of(&w, set));
  ck_holds(end[1] > 0.0 && end[0] < start[0]);
  if (plane) drop_obstacle(&w, plane);
  const double share = (w.info.kinetic_energy + w.info.strain_energy) / first.kinetic_energy;
  world_close(&w);
  return share;
}

/* A friction wall is the plane of an obstacle with FMPM, too, and makes no energy. */
START_TEST(friction_walls_are_planes) {
  const double on_wall = land(scheme_options[_i].scheme, 1), on_plane = land(scheme_options[_i].scheme, 0);
  show("energy left %.12f on the wall, %.12f on the plane\n", on_wall, on_plane);
  ck_within("energy", on_wall, on_plane, 1e-9);
}
END_TEST

/* ---- which steps have it ------------------------------------------------------------------------------ */
/* The steps of a number that xpic_every divides are those of the order, the others those of FLIP. */
START_TEST(every_so_many_steps) {
  const int32_t transfer = _i ? MPM_XPIC : MPM_FMPM, every = 3;
  world_desc d = described(2, &basis_options[1], MPM_USL, 4, every);
  d.stepper.transfer = transfer;
  d.stepper.flip = 0.95;
  world counted, by_hand;
  const world_desc *const both[2] = {&d, &d};
  world *const of[2] = {&counted, &by_hand};
  for (int32_t k = 0; k < 2; ++k) {
    mpm_particles *set = world_open(of[k], both[k]);
    dice random = {9};
    add_cloud(of[k], set, &random, 60, 0.25, 0.5, 1.5, 1.0);
  }
  for (int32_t step = 1; step <= 8; ++step) {
    mpm_stepper_desc now = d.stepper;
    now.xpic_every = step % 2; /* 0 and 1 are the same */
    if (step % every) now.transfer = MPM_FLIP;
    ck_ok(&by_hand, mpm_stepper_configure(by_hand.stepper, &now));
    world_step(&counted, 1e-3);
    world_step(&by_hand, 1e-3);
    ck_assert(world_hash(&counted) == world_hash(&by_hand));
  }
  world_close(&counted);
  world_close(&by_hand);
}
END_TEST

/* A state that is saved between two such steps goes on with the same bits. A step that fails or is aborted
 * does not count, and set_time() says which is next. */
static mpm_status refuse(void *user, const mpm_step_info *info) {
  (void)info;
  return *(const int32_t *)user ? 1 : MPM_OK;
}

START_TEST(the_count_goes_on) {
  world_desc d = described(2, &basis_options[1], MPM_USL, 3, 3);
  world w, loaded, failing;
  world *const of[3] = {&w, &loaded, &failing};
  int32_t refuses = 0;
  for (int32_t k = 0; k < 3; ++k) {
    mpm_particles *set = world_open(of[k], &d);
    dice random = {21};
    add_cloud(of[k], set, &random, 60, 0.25, 0.5, 1.5, 1.0);
  }
  ck_ok(&failing, mpm_stepper_set_progress(failing.stepper, refuse, &refuses));
  for (int32_t k = 0; k < 7; ++k) {
    if (k == 4) world_copy(&w, &loaded);
    world_step(&w, 1e-3);
    if (k >= 4) {
      world_step(&loaded, 1e-3);
      ck_assert(world_hash(&w) == world_hash(&loaded));
    }
    refuses = 1;
    ck_assert_int_eq(mpm_step(failing.stepper, 1e-3, NULL), MPM_CANCELLED);
    refuses = 0;
    ck_ok(&failing, mpm_step_begin(failing.stepper, 1e-3));
    ck_ok(&failing, mpm_step_abort(failing.stepper));
    world_step(&failing, 1e-3);
    ck_assert(world_hash(&w) == world_hash(&failing));
  }
  /* the seventh was not one; told that it was the second, the next one is */
  mpm_stepper_desc full = d.stepper;
  full.xpic_every = 1;
  ck_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 2));
  ck_ok(&loaded, mpm_stepper_set_time(loaded.stepper, 0.0, 2));
  ck_ok(&loaded, mpm_stepper_configure(loaded.stepper, &full));
  world_step(&w, 1e-3);
  world_step(&loaded, 1e-3);
  ck_assert(world_hash(&w) == world_hash(&loaded));
  world_step(&w, 1e-3);
  world_step(&loaded, 1e-3);
  ck_assert(world_hash(&w) != world_hash(&loaded));
  for (int32_t k = 0; k < 3; ++k) world_close(of[k]);
}
END_TEST

/* Each transfer has its own range of orders, and the others do not look at them. */
START_TEST(orders_are_bounded) {
  world_desc d = described(1, &basis_options[0], MPM_USL, 32, 0);
  world w;
  world_open(&w, &d);
  mpm_stepper_desc desc = d.stepper;
  desc.xpic_order = 33;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_ARG, "xpic_order is 33: it must be 1 ... 32");
  desc.xpic_order = 0;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_ARG, "xpic_order is 0");
  desc.transfer = MPM_XPIC;
  desc.xpic_order = 6;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_ARG, "xpic_order is 6: it must be 1 ... 5");
  desc.transfer = MPM_FLIP;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &desc));
  desc.transfer = MPM_FMPM;
  desc.scheme = MPM_NEWMARK;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_UNSUPPORTED, "use transfer MPM_FLIP");
  world_close(&w);
}
END_TEST

/* Full steps far apart feed waves where the strain is that of projected velocities, unless the order is 1. */
START_TEST(far_apart) {
  static const int32_t schemes[3] = {MPM_USL, MPM_USF, MPM_MUSL};
  for (int32_t s = 0; s < 3; ++s) {
    world_desc d = described(2, &basis_options[1], schemes[s], 2, 2);
    world w;
    world_open(&w, &d);
    mpm_stepper_desc desc = d.stepper;
    desc.xpic_every = 3;
    if (schemes[s] == MPM_USL)
      ck_ok(&w, mpm_stepper_configure(w.stepper, &desc));
    else
      ck_refused(&w, mpm_stepper_configure(w.stepper, &desc), MPM_E_UNSUPPORTED, "use 2, scheme MPM_USL");
    desc.xpic_order = 1;
    ck_ok(&w, mpm_stepper_configure(w.stepper, &desc));
    desc.transfer = MPM_XPIC;
    desc.xpic_order = 5;
    ck_ok(&w, mpm_stepper_configure(w.stepper, &desc));
    world_close(&w);
  }
}
END_TEST

/* What noise makes of the energy of a block at the largest steps that are taken by default: that of FLIP
 * grows by 4 % at most, and nothing grows more. */
START_TEST(noise_does_not_grow) {
  static const struct {
    int32_t scheme, order, every;
    double share;
  } way[] = {{MPM_USL, 4, 1, 0.40},  {MPM_USL, 32, 1, 0.40}, {MPM_USL, 8, 5, 0.40},   {MPM_USL, 4, 20, 0.40},
             {MPM_USF, 32, 1, 0.67}, {MPM_USF, 8, 2, 0.67},  {MPM_MUSL, 32, 1, 0.67}, {MPM_MUSL, 8, 2, 0.67}};
  world_desc d = described(2, &basis_options[1], way[_i].scheme, way[_i].order, way[_i].every);
  d.grid.cells[0] = d.grid.cells[1] = 18;
  world w;
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = world_fill_cube(&w, set, 1.0, 3.5);
  double *v = fetch(&w, set, "velocity", 2), most = 0.0;
  for (int64_t i = 0; i < 2 * n; ++i) v[i] = 0.1 * noise_at((uint64_t)i);
  put(&w, set, "velocity", 2, v);
  const double start = world_info(&w).kinetic_energy;
  for (int32_t k = 0; k < 600; ++k) {
    world_step(&w, way[_i].share * world_stable_dt(&w));
    most = fmax(most, w.info.kinetic_energy + w.info.strain_energy);
  }
  ck_between("energy / start", most / start, 0.0, 1.05);
  free(v);
  world_close(&w);
}
END_TEST

Suite *fmpm_suite(void);
Suite *fmpm_suite(void) {
  Suite *suite = suite_create("fmpm");
  TCase *series = tcase_create("series"), *boundaries = tcase_create("boundaries"),
        *steps = tcase_create("steps");
  tcase_add_loop_test(series, share_of_a_wave, 0, 5);
  tcase_add_loop_test(series, tends_to_the_full_mass_matrix, 0, 5);
  tcase_add_loop_test(series, order_one_is_pic, 0, SCHEMES * BASES);
  tcase_add_loop_test(series, momentum_is_kept, 0, 3 * BASES);
  tcase_add_loop_test(boundaries, held_nodes_stay_held, 0, 3 * BASES);
  tcase_add_loop_test(boundaries, prescribed_particles_report, 0, SCHEMES * BASES);
  tcase_add_loop_test(boundaries, contact_gives_its_impulse, 0, 4 * SCHEMES);
  tcase_add_loop_test(boundaries, obstacles_give_their_impulse, 0, 3 * SCHEMES);
  tcase_add_loop_test(boundaries, friction_walls_are_planes, 0, SCHEMES);
  tcase_add_loop_test(steps, every_so_many_steps, 0, 2);
  tcase_add_test(steps, the_count_goes_on);
  tcase_add_test(steps, orders_are_bounded);
  tcase_add_test(steps, far_apart);
  tcase_add_loop_test(steps, noise_does_not_grow, 0, 8);
  suite_add_tcase(suite, series);
  suite_add_tcase(suite, boundaries);
  suite_add_tcase(suite, steps);
  return suite;
}
