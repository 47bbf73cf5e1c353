/* A block with next to no stress in uniform flight over nodes, on which its particles land to the last digit
 * or nearly, keeps its velocity and its shape, whatever its basis, scheme, transfer and surroundings. Bodies
 * that reach a little into cells stay bounded. */
#include "schemes.h"

static const double offsets[] = {0.0,    1e-15, -1e-15, 1e-13, -1e-13, 1e-12, -1e-12, 1e-11,
                                 -1e-11, 1e-10, -1e-10, 1e-9,  -1e-9,  1e-7,  -1e-7};
enum { OFFSETS = sizeof offsets / sizeof *offsets };
/* AROUND: over a periodic seam, on more cells than a block of nodes has. LED: a callback prescribes what
 * the block does. PUSHED: the same, for a block that was at rest. HASTENED: gravity and a hook accelerate
 * all of it. BY_LIGHT, BY_HEAVY: beside one at rest with a millionth of the density, or a million times
 * it. */
enum { ALONE, SLIDING, AROUND, LED, PUSHED, HASTENED, BY_LIGHT, BY_HEAVY, SURROUNDINGS };
typedef struct stepping {
  int32_t scheme, projected;
} stepping;
static const stepping ways[] = {{MPM_USL, 0}, {MPM_USF, 0}, {MPM_MUSL, 0}, {MPM_MUSL, 1}, {MPM_NEWMARK, 0}};
enum { WAYS = sizeof ways / sizeof *ways };

typedef struct lead {
  const double *v;
  double from; /* nodes beyond this x are led */
} lead;

static mpm_status keep_going(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const lead *by = user;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t k = 0; k < b->dim; ++k) {
      prescribed[k * b->ld + i] = b->position[i] > by->from;
      velocity[k * b->ld + i] = by->v[k];
    }
  return MPM_OK;
}

/* Accelerates all nodes along x; user: the acceleration. */
static mpm_status hasten(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)velocity;
  for (int64_t i = 0; i < b->n; ++i) force[i] += b->mass[i] * *(const double *)user;
  return MPM_OK;
}

/* A world of cells of edge 1, whose waves travel at 37 and whose bodies go by this method. */
static world_desc flight_world(int32_t dim, int64_t cells, const basis_option *basis, const stepping *how,
                               const transfer_option *by) {
  world_desc d = world_default(dim, cells, 1.0);
  use_basis(basis, &d.grid);
  d.stepper.scheme = how->scheme;
  d.stepper.projected_positions = how->projected;
  d.stepper.transfer = by->transfer;
  d.stepper.flip = by->flip;
  d.stepper.pic_damping = by->pic_damping;
  d.stepper.xpic_order = by->xpic_order;
  d.stepper.xpic_every = by->xpic_every;
  d.law = (world_law){.model = "neo_hookean", .E = 1000.0, .nu = 0.3, .density = 1.0};
  return d;
}

/* Fills a cube with two particles per cell along each axis, and moves it. Returns the count of particles. */
static int64_t fill_beside(world *w, mpm_particles *set, double low, double high, double by) {
  const double lower[3] = {low, low, low}, upper[3] = {high, high, high};
  const int64_t n = world_fill(w, set, lower, upper, 2);
  double *x = fetch(w, set, "position", w->dim);
  for (int64_t i = 0; i < w->dim * n; ++i) x[i] += by;
  put(w, set, "position", w->dim, x);
  free(x);
  return n;
}

/* Cells have the edge 1, and each step goes a quarter of it, or a quarter farther than the last one: two
 * particles per cell land on nodes. */
static void fly(int32_t dim, const basis_option *basis, const stepping *how, const transfer_option *by,
                int32_t among, double offset) {
  char name[120];
  world w;
  const int64_t cells = among == AROUND ? (dim == 1 ? 80 : dim == 2 ? 40 : 14) : 12;
  world_desc d = flight_world(dim, cells, basis, how, by);
  d.grid.periodic[0] = among == AROUND;
  const double other = among == BY_LIGHT ? 1e-6 : 1e6;
  const world_law law = {.model = "neo_hookean", .E = 1e3 * other, .nu = 0.3, .density = other};
  snprintf(name, sizeof name, "%s, scheme %d%s, %s, %g, among %d", basis->name, (int)how->scheme,
           how->projected ? " projected" : "", by->name, offset, (int)among);
  const double dt = 1.0 / 64.0, speed = 0.25 / dt, a = among == HASTENED ? speed / dt : 0.0;
  d.stepper.gravity[0] = 0.5 * a;
  mpm_particles *set = world_open(&w, &d);
  double v[3] = {speed, among == SLIDING || among >= BY_LIGHT ? 0.0 : 0.5 * speed,
                 dim == 3 ? 0.25 * speed : 0.0};
  const double from = among == AROUND ? (double)cells - 3.0 : 4.0,
               low[3] = {from, among == SLIDING ? 0.0 : 3.0, 3.0},
               high[3] = {from + 2.0, among == SLIDING ? 2.0 : 5.0, 5.0};
  const int64_t n = world_fill(&w, set, low, high, 2);
  if (among >= BY_LIGHT)
    world_fill(&w, world_add_set(&w, &law), (const double[]){3.0, 9.0, 3.0}, (const double[]){5.0, 11.0, 5.0},
               2);
  if (among != PUSHED) ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
  /* next to nothing, but not for what a node far out has of mass */
  const double F0[9] = {1.0 + 0x1p-43, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F0));
  double *x = fetch(&w, set, "position", dim);
  for (int64_t i = 0; i < dim * n; ++i) x[i] += among == PUSHED ? 0.25 + offset : offset;
  put(&w, set, "position", dim, x);
  if (among == SLIDING) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  lead with = {v, among == PUSHED ? -1e3 : 6.5};
  if (among == LED || among == PUSHED) ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, keep_going, &with));
  const int32_t steps = among == HASTENED ? 4 : 9;
  double half = 0.5 * a;
  if (among == HASTENED) ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, MPM_AFTER_P2G, hasten, &half));
  for (int32_t k = 0; k < steps; ++k) {
    const mpm_status status = mpm_step(w.stepper, dt, NULL);
    if (status) ck_abort_msg("%s, %d-D: %s", name, (int)dim, last_error_of(&w));
  }
  double *to = fetch(&w, set, "position", dim), *F = fetch(&w, set, "deformation_gradient", 9),
         *u = fetch(&w, set, "velocity", dim);
  const double length = (double)cells, tolerance = how->scheme == MPM_NEWMARK ? 1e-8 : 1e-12;
  for (int64_t i = 0; i < dim * n; ++i) {
    double way = to[i] - x[i], gain = i < n ? steps * dt * a : 0.0;
    if (among == AROUND && i < n) way -= length * floor(way / length);
    ck_within(name, way, steps * dt * v[i / n] + 0.5 * (steps + 1) * dt * gain, tolerance);
    ck_within(name, u[i], v[i / n] + gain, tolerance * speed);
  }
  for (int64_t i = 0; i < 9 * n; ++i) ck_within(name, F[i], i / n % 4 ? 0.0 : 1.0, tolerance);
  free(x), free(to), free(F), free(u);
  world_close(&w);
}

static int32_t has_affine_steps(const basis_option *basis) {
  return basis->boundary == MPM_BOUNDARY_GHOST &&
         (basis->basis == MPM_BSPLINE2 || basis->basis == MPM_BSPLINE3);
}

START_TEST(flight) {
  const basis_option *basis = &basis_options[_i];
  for (int32_t s = 0; s < WAYS; ++s) {
    const int32_t implicit = ways[s].scheme == MPM_NEWMARK;
    for (int32_t t = 0; t < (implicit ? 1 : TRANSFERS); ++t) {
      const transfer_option *by = &transfer_options[t];
      if (by->transfer == MPM_APIC_MLS && !has_affine_steps(basis)) continue;
      if (implicit && basis->basis == MPM_UGIMP) continue; /* it is GIMP there */
      for (int32_t k = 0; k < OFFSETS; ++k)
        for (int32_t dim = 1; dim <= (k < 2 && t < 1 ? 3 : 2); ++dim)
          fly(dim, basis, &ways[s], by, ALONE, offsets[k]);
    }
  }
}
END_TEST

START_TEST(flight_among) {
  const basis_option *basis = &basis_options[_i];
  for (int32_t among = SLIDING; among < SURROUNDINGS; ++among)
    for (int32_t s = 0; s < WAYS; ++s)
      for (int32_t k = 0; k < OFFSETS; ++k) {
        /* below a wall there is no way out */
        if (among == SLIDING && offsets[k] < 0.0) continue;
        /* a mean of two velocities moves particles of implicit steps, which have no hooks */
        if ((among == PUSHED || among == HASTENED) && ways[s].scheme == MPM_NEWMARK) continue;
        for (int32_t dim = among == AROUND ? 1 : 2; dim <= (among == AROUND && k < 2 ? 3 : 2); ++dim)
          fly(dim, basis, &ways[s], &transfer_options[0], among, offsets[k]);
      }
}
END_TEST

/* A block that goes a thousandth of a cell by each step of 0.4 of the stable one: its particles are next to
 * nodes for hundreds of steps. */
static void fly_slowly(const basis_option *basis, const stepping *how, const transfer_option *by,
                       double offset) {
  char name[120];
  world w;
  const world_desc d = flight_world(2, 12, basis, how, by);
  snprintf(name, sizeof name, "%s, scheme %d%s, %s, %g, slowly", basis->name, (int)how->scheme,
           how->projected ? " projected" : "", by->name, offset);
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = fill_beside(&w, set, 5.0, 7.0, offset);
  const double dt = 0.4 * world_stable_dt(&w), v[2] = {1e-3 / dt, 5e-4 / dt};
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  for (int32_t k = 0; k < 600; ++k) {
    const mpm_status status = mpm_step(w.stepper, dt, NULL);
    if (status) ck_abort_msg("%s: %s", name, last_error_of(&w));
  }
  double *F = fetch(&w, set, "deformation_gradient", 9), *u = fetch(&w, set, "velocity", 2);
  for (int64_t i = 0; i < 2 * n; ++i) ck_within(name, u[i], v[i / n], 1e-9 * v[0]);
  for (int64_t i = 0; i < 9 * n; ++i) ck_within(name, F[i], i / n % 4 ? 0.0 : 1.0, 1e-10);
  free(F), free(u);
  world_close(&w);
}

START_TEST(slow_flight) {
  const basis_option *basis = &basis_options[_i];
  static const double places[] = {0.0, 1e-5, 0.013};
  for (int32_t s = 0; s < WAYS; ++s)
    for (int32_t t = 0; t < TRANSFERS && ways[s].scheme != MPM_NEWMARK; ++t) {
      const transfer_option *by = &transfer_options[t];
      if (by->transfer == MPM_APIC_MLS && !has_affine_steps(basis)) continue;
      for (int32_t k = 0; k < 3; ++k) fly_slowly(basis, &ways[s], by, places[k]);
    }
}
END_TEST

/* A lone particle that hardly reaches into a cell keeps its affine field: no line of nodes gives the far node
 * a velocity. */
START_TEST(alone_with_a_gradient) {
  const int32_t dim = 1 + _i;
  world w;
  world_desc d = world_default(dim, 12, 1.0);
  d.grid.basis = MPM_LINEAR;
  d.stepper.transfer = MPM_TPIC;
  mpm_particles *set = world_open(&w, &d);
  const double x[3] = {5.0 + 1e-9, 4.3, 6.6}, v[3] = {1.0, 2.0, 3.0}, volume = 1.0;
  double L[9] = {0.0};
  for (int32_t k = 0; k < dim; ++k)
    for (int32_t j = 0; j < dim; ++j) L[3 * k + j] = 0.1 * (k + 1) - 0.3 * j;
  ck_ok(&w, mpm_particles_add(set, 1, x, v, &volume, NULL, NULL, NULL));
  ck_ok(&w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, L));
  world_step(&w, 1e-6);
  double *after = fetch(&w, set, "velocity_gradient", 9);
  for (int32_t c = 0; c < 9; ++c) ck_within("L", after[c], L[c], 1e-4);
  free(after);
  world_close(&w);
}
END_TEST

/* A block of 8 x 8 cells with noise, of which a row reaches a little into the next cells, stays bounded at
 * half of the stable step, by every scheme and transfer, whatever share of a layer the nodes there have. */
static void shake(const stepping *how, const transfer_option *by, double into) {
  char name[120];
  world w;
  const world_desc d = flight_world(2, 14, &basis_options[0], how, by);
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = fill_beside(&w, set, 3.0, 11.0, 0.25 + into);
  double *v = malloc((size_t)(2 * n) * sizeof *v);
  for (int64_t i = 0; i < 2 * n; ++i) v[i] = 1e-4 * noise_at((uint64_t)i);
  put(&w, set, "velocity", 2, v);
  free(v);
  const double dt = 0.5 * world_stable_dt(&w);
  const double first = world_info(&w).kinetic_energy;
  for (int32_t k = 0; k < 600; ++k) world_step(&w, dt);
  snprintf(name, sizeof name, "scheme %d%s, %s, %g into the next cells", (int)how->scheme,
           how->projected ? " projected" : "", by->name, into);
  ck_between(name, (w.info.kinetic_energy + w.info.strain_energy) / first, 0.0, 4.0);
  world_close(&w);
}

START_TEST(slivers) {
  static const double into[] = {0.003, 0.02, 0.05, 0.07, 0.12};
  ck_assert_int_eq(basis_options[0].basis, MPM_LINEAR);
  for (int32_t s = 0; s < WAYS; ++s)
    for (int32_t t = 0; t < TRANSFERS && ways[s].scheme != MPM_NEWMARK; ++t)
      if (transfer_options[t].transfer != MPM_APIC_MLS) shake(&ways[s], &transfer_options[t], into[_i]);
}
END_TEST

/* Where no other light node gives to its leaders, one has the velocity that these end with. */
START_TEST(light_node_follows) {
  world w;
  const world_desc d = flight_world(1, 12, &basis_options[0], &ways[_i], &transfer_options[0]);
  mpm_particles *set = world_open(&w, &d);
  const int64_t count = fill_beside(&w, set, 3.0, 8.0, 0.28);
  double v[10], F[90] = {0.0};
  ck_assert_int_eq(count, 10);
  for (int64_t p = 0; p < count; ++p) {
    v[p] = noise_at((uint64_t)p);
    F[p] = 1.0 + 0.1 * noise_at((uint64_t)(p + count));
    F[4 * count + p] = F[8 * count + p] = 1.0;
  }
  put(&w, set, "velocity", 1, v);
  put(&w, set, "deformation_gradient", 9, F);
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-2));
  ck_ok(&w, mpm_step_grid(w.stepper));
  int64_t n;
  double *x = fetch_nodes(&w, "position", &n), *u = fetch_nodes(&w, "velocity", &n);
  ck_assert_int_eq(n, 7);
  ck_holds(x[6] == 9.0);
  ck_within("velocity of a light node", u[6], 2.0 * u[5] - u[4], 1e-12);
  free(x), free(u);
  ck_ok(&w, mpm_step_end(w.stepper, NULL));
  world_close(&w);
}
END_TEST

/* Where a light material and a heavy one share a node, the next node of the light one has little mass and is
 * no sliver: it keeps the velocity of its material. */
START_TEST(light_material) {
  const int32_t dim = 1 + _i % 3, scheme = _i / 3;
  const world_law law = {.model = "neo_hookean", .E = 1e6, .nu = 0.3, .density = 1e3};
  world w;
  const world_desc d = flight_world(dim, 12, &basis_options[0], &ways[scheme], &transfer_options[0]);
  mpm_particles *set = world_open(&w, &d);
  world_fill(&w, set, (const double[]){6.0, 3.0, 3.0}, (const double[]){9.0, 9.0, 9.0}, 2);
  world_fill(&w, world_add_set(&w, &law), (const double[]){3.0, 3.0, 3.0}, (const double[]){6.0, 9.0, 9.0},
             2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, (const double[]){1.0, 1.0, 1.0}));
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-6));
  ck_ok(&w, mpm_step_grid(w.stepper));
  int64_t n;
  int32_t seen = 0;
  double *x = fetch_nodes(&w, "position", &n), *v = fetch_nodes(&w, "velocity", &n);
  for (int64_t i = 0; i < n; ++i) {
    if (x[i] != 7.0) continue;
    ck_within("velocity of the light material", v[i], 1.0, 1e-6);
    ++seen;
  }
  ck_assert_int_gt(seen, 0);
  ck_ok(&w, mpm_step_end(w.stepper, NULL));
  free(x), free(v);
  world_close(&w);
}
END_TEST

TCase *schemes_flight_case(void) {
  TCase *tc = tcase_create("flight");
  tcase_set_timeout(tc, 60.0);
  tcase_add_loop_test(tc, flight, 0, BASES);
  tcase_add_loop_test(tc, flight_among, 0, BASES);
  tcase_add_loop_test(tc, slow_flight, 0, BASES);
  tcase_add_loop_test(tc, alone_with_a_gradient, 0, 3);
  tcase_add_loop_test(tc, slivers, 0, 5);
  tcase_add_loop_test(tc, light_node_follows, 0, WAYS - 1); /* not of implicit steps */
  tcase_add_loop_test(tc, light_material, 0, 9);
  return tc;
}
