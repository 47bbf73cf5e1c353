/* Ground at rest: the stress that it starts with, by law and dimension; that it stays at rest in explicit and
 * implicit steps; and a reference that is set anew. */
#include "body.h"
#include "tables.h"

enum { DRUCKER = 2, MOHR, CLAY, GRAINS, ELASTIC, DECOUPLED, FLUID, MUD, LAWS_AT_REST };
static const mpm_param fluid[] = {
    {"density", 2e3}, {"bulk_modulus", 2e7}, {"gamma", 7.0}, {"viscosity", 5.0}};
static const mpm_param mud[] = {
    {"density", 2e3},     {"bulk_modulus", 2e7}, {"gamma", 7.0}, {"shear_modulus", 7e6},
    {"yield_shear", 1e9}, {"consistency", 5.0},  {"n", 0.7}};
static const mpm_param decoupled[] = {{"mu", 7.7e6}, {"kappa", 1.7e7}, {"density", 2e3}};
static const mpm_param drucker[] = {{"E", 2e7},    {"nu", 0.3},       {"density", 2e3},
                                    {"phi", 30.0}, {"cohesion", 1e3}, {"cone", 0.0}};
static const mpm_param mohr[] = {{"E", 2e7}, {"nu", 0.3}, {"density", 2e3}, {"phi", 30.0}, {"cohesion", 1e3}};
/* The clay has been under twice the weight of five metres, the grains rest with K0 from 0.39 on. */
static const mpm_param clay[] = {{"density", 2e3}, {"kappa", 0.01}, {"lambda", 0.1}, {"M", 1.2},
                                 {"mu0", 7.7e6},   {"p_ref", 1e5},  {"pc0", 2e5}};
static const mpm_param grains[] = {
    {"E", 2e7},    {"nu", 0.3},  {"density", 2e3},          {"mu_s", 0.6},
    {"mu_2", 0.9}, {"I_0", 0.3}, {"grain_diameter", 0.005}, {"grain_density", 2.6e3}};
static const world_law laws[LAWS_AT_REST] = {
    {.model = "linear_elastic", .E = 2e7, .nu = 0.3, .density = 2e3},
    {.model = "j2", .E = 2e7, .nu = 0.3, .density = 2e3, .yield_stress = 1e9},
    {.model = "drucker_prager", .params = drucker, .param_count = 6},
    {.model = "mohr_coulomb", .params = mohr, .param_count = 5},
    {.model = "cam_clay", .params = clay, .param_count = 7},
    {.model = "mu_i", .params = grains, .param_count = 8},
    {.model = "neo_hookean", .E = 2e7, .nu = 0.3, .density = 2e3},
    {.model = "neo_hookean_decoupled", .params = decoupled, .param_count = 3},
    {.model = "newtonian_fluid", .params = fluid, .param_count = 4},
    {.model = "herschel_bulkley", .params = mud, .param_count = 7}};
static const double density = 2e3, g = 10.0;

static int32_t follows_F(int32_t law) {
  return law >= ELASTIC;
}

/* Opens a column of ground, `cells` cells high and two wide, on a grid of edge h with slip walls all
 * round; the vertical axis is the last. */
static mpm_particles *open_column(world *w, const world_desc *of, int64_t cells, double h, int32_t per_axis) {
  world_desc desc = *of;
  const int32_t up = desc.grid.dim - 1;
  for (int32_t k = 0; k < desc.grid.dim; ++k) desc.grid.cells[k] = k == up ? cells + 3 : 2;
  mpm_particles *set = world_open(w, &desc);
  const double low[3] = {0.0, 0.0, 0.0};
  double high[3] = {2.0 * h, 2.0 * h, 2.0 * h};
  high[up] = (double)cells * h;
  world_fill(w, set, low, high, per_axis);
  for (int32_t face = 0; face < 2 * up + 1; ++face)
    ck_ok(w, mpm_stepper_set_wall(w->stepper, face, MPM_WALL_SLIP, 0.0));
  return set;
}

static world_desc ground(int32_t dim, const world_law *law, double h) {
  world_desc desc = world_default(dim, 4, h);
  desc.law = *law;
  desc.grid.basis = MPM_BSPLINE2;
  desc.stepper.gravity[dim - 1] = -g;
  return desc;
}

/* ---- the stress ---------------------------------------------------------------------------------------- */
/* Checks the stress of a set with ids from 0 on; up: direction of the axis. */
static void ck_stress(const world *w, const mpm_particles *set, int32_t axis, double up, double surface,
                      double K0, double surcharge, double tolerance) {
  double *x = fetch(w, set, "position", w->dim), *s = fetch(w, set, "stress", 6);
  const int64_t n = mpm_particles_count(set);
  for (int64_t i = 0; i < n; ++i) {
    const double along = -surcharge - density * g * up * (surface - x[axis * n + i]);
    for (int32_t c = 0; c < 6; ++c) {
      if (K0 < 0.0 && c != axis) continue; /* the law decides */
      const double wanted = c > 2 ? 0.0 : c == axis ? along : K0 * along;
      ck_within(w->desc.law.model, s[c * n + i], wanted, tolerance * (fabs(along) + 1.0));
    }
  }
  free(x);
  free(s);
}

/* Every law in 1-D to 3-D, along every axis, up and down. What stays is checked, too. */
START_TEST(stress_of_the_weight) {
  const int32_t law = _i % LAWS_AT_REST, dim = 1 + _i / LAWS_AT_REST;
  const double K0 = law == FLUID ? 1.0 : 0.4, surcharge = 3e4;
  for (int32_t axis = 0; axis < dim; ++axis)
    for (int32_t down = 0; down < 2; ++down) {
      world w;
      const world_desc desc = ground(dim, &laws[law], 0.5);
      mpm_particles *set = open_column(&w, &desc, 5, 0.5, 2);
      const int64_t n = mpm_particles_count(set);
      double *mass = fetch(&w, set, "mass", 1), *volume = fetch(&w, set, "volume", 1);
      const double surface = down ? 10.0 : -3.0, up = down ? 1.0 : -1.0;
      ck_ok(&w, mpm_particles_set_geostatic(set, axis, -up * g, surface, K0, surcharge));
      ck_stress(&w, set, axis, up, surface, dim == 1 && follows_F(law) && law < FLUID ? -1.0 : K0, surcharge,
                follows_F(law) ? 1e-11 : 1e-14);
      double *F = fetch(&w, set, "deformation_gradient", 9), *initial = fetch(&w, set, "initial_volume", 1);
      double *now = fetch(&w, set, "volume", 1), *after = fetch(&w, set, "mass", 1);
      for (int64_t i = 0; i < n; ++i) {
        const double J = F[i] * F[4 * n + i] * F[8 * n + i];
        ck_holds(after[i] == mass[i]);
        ck_within("volume", now[i], volume[i], 1e-14 * volume[i]);
        ck_within("initial volume", J * initial[i], volume[i], 1e-14 * volume[i]);
        for (int32_t c = 0; c < 9 && !follows_F(law); ++c) ck_holds(F[c * n + i] == (c % 4 ? 0.0 : 1.0));
        ck_holds(!follows_F(law) || J < 1.0 - 1e-4);
      }
      free(mass), free(volume), free(F), free(initial), free(now), free(after);
      world_close(&w);
    }
}
END_TEST

/* Weights that squeeze what bears them to less than half, and an open side: the equations of the laws are
 * solved, not their tangents at F = I. */
START_TEST(large_weights) {
  static const double K0[] = {0.0, 0.5, 1.0, 2.0};
  for (int32_t law = ELASTIC; law < LAWS_AT_REST; ++law)
    for (int32_t i = 0; i < 4; ++i) {
      world w;
      const world_desc desc = ground(3, &laws[law], 0.5);
      mpm_particles *set = open_column(&w, &desc, 5, 0.5, 1);
      if (law == FLUID && K0[i] != 1.0) {
        ck_refused(&w, mpm_particles_set_geostatic(set, 2, -g, 10.0, K0[i], 0.0), MPM_E_UNSUPPORTED,
                   "use K0 = 1");
      } else {
        ck_ok(&w, mpm_particles_set_geostatic(set, 2, -g, 10.0, K0[i], 3e7));
        ck_stress(&w, set, 2, 1.0, 10.0, K0[i], 3e7, 1e-11);
        double J = 1.0;
        for (int32_t c = 0; c < 9; c += 4) J *= fetch1(&w, set, "deformation_gradient", 9, c, 0);
        ck_assert_double_lt(J, 0.85);
      }
      world_close(&w);
    }
}
END_TEST

/* ---- it stays where it is ------------------------------------------------------------------------------ */
static double fastest(const world *w, const mpm_particles *set) {
  double *v = fetch(w, set, "velocity", w->dim);
  const double most = largest(w->dim * mpm_particles_count(set), v);
  free(v);
  return most;
}

/* One second of explicit steps: |v| < 1e-3 sqrt(g H) h / H, and the stress within 0.5 % of that of the
 * floor. */
START_TEST(column_in_explicit_steps) {
  const int32_t law = _i % LAWS_AT_REST, scheme = _i / LAWS_AT_REST;
  const double h = 0.5, height = 5.0, K0 = law == FLUID ? 1.0 : 0.3 / 0.7;
  world_desc desc = ground(2, &laws[law], h);
  desc.stepper.scheme = scheme ? MPM_USL : MPM_MUSL;
  world w;
  mpm_particles *set = open_column(&w, &desc, 10, h, 3);
  ck_ok(&w, mpm_particles_set_geostatic(set, 1, -g, height, K0, 0.0));
  mpm_advance_desc go = advance_desc(1.0);
  double most = 0.0;
  while (world_info(&w).t < 1.0) {
    go.max_steps = 10;
    ck_ok(&w, mpm_advance(w.stepper, &go, NULL));
    most = fmax(most, fastest(&w, set));
  }
  show("%s %d: |v| %.3g of %.3g\n", laws[law].model, scheme, most, 1e-3 * sqrt(g * height) * h / height);
  ck_assert_double_le(most, 1e-3 * sqrt(g * height) * h / height);
  double *x = fetch(&w, set, "position", 2), *s = fetch(&w, set, "stress", 6);
  const int64_t n = mpm_particles_count(set);
  for (int64_t i = 0; i < n; ++i) {
    const double along = -density * g * (height - x[n + i]);
    ck_within(laws[law].model, s[n + i], along, 5e-3 * density * g * height);
    ck_within(laws[law].model, s[i], K0 * along, 5e-3 * density * g * height);
  }
  free(x), free(s);
  world_close(&w);
}
END_TEST

/* A quasi-static step moves nothing: below 1e-3 of what it does with the weight and without its stress, or
 * with half of it where clay and grains have no stiffness without. */
START_TEST(column_in_a_static_step) {
  double way[2];
  for (int32_t rests = 0; rests < 2; ++rests) {
    world_desc desc = ground(2, &laws[_i], 0.5);
    desc.stepper.scheme = MPM_NEWMARK;
    desc.stepper.quasi_static = 1;
    desc.stepper.reference_positions = 1;
    world w;
    mpm_particles *set = open_column(&w, &desc, 10, 0.5, 3);
    const double K0 = _i == FLUID ? 1.0 : 0.3 / 0.7;
    const double share = rests ? 1.0 : _i == CLAY || _i == GRAINS ? 0.5 : 0.0;
    if (share > 0.0) ck_ok(&w, mpm_particles_set_geostatic(set, 1, -g * share, 5.0, K0, 0.0));
    world_step(&w, 1.0);
    double *x = fetch(&w, set, "position", 2), *was = fetch(&w, set, "reference_position", 2);
    const int64_t n = 2 * mpm_particles_count(set);
    for (int64_t i = 0; i < n; ++i) x[i] -= was[i];
    way[rests] = largest(n, x);
    free(x), free(was);
    world_close(&w);
  }
  show("%s: static %.3g of %.3g\n", laws[_i].model, way[1], way[0]);
  ck_assert_double_le(way[1], 1e-3 * way[0]);
}
END_TEST

/* Two layers, of which the lower bears the upper: dense sand under light elastic ground. */
START_TEST(layers) {
  const double h = 0.5, light = 1200.0;
  world_desc desc = ground(2, &laws[DRUCKER], h);
  const world_law upper = {.model = "neo_hookean", .E = 1e7, .nu = 0.3, .density = light};
  world w;
  mpm_particles *sand = open_column(&w, &desc, 6, h, 3), *cover = world_add_set(&w, &upper);
  const double low[] = {0.0, 3.0}, high[] = {1.0, 4.0};
  world_fill(&w, cover, low, high, 3);
  ck_ok(&w, mpm_particles_set_geostatic(cover, 1, -g, 4.0, 0.3 / 0.7, 0.0));
  ck_ok(&w, mpm_particles_set_geostatic(sand, 1, -g, 3.0, 0.5, light * g * 1.0));
  ck_stress(&w, sand, 1, 1.0, 3.0, 0.5, light * g, 1e-13);
  mpm_advance_desc go = advance_desc(0.5);
  ck_ok(&w, mpm_advance(w.stepper, &go, NULL));
  show("layers: |v| %g, %g\n", fastest(&w, sand), fastest(&w, cover));
  ck_assert_double_le(fastest(&w, sand), 2e-3 * sqrt(g * 4.0) * h / 4.0);
  ck_assert_double_le(fastest(&w, cover), 2e-3 * sqrt(g * 4.0) * h / 4.0);
  world_close(&w);
}
END_TEST

/* ---- sloping ground ------------------------------------------------------------------------------------ */
enum { FOOT = 3, TOP = 10, HIGH = 5 }; /* where the slope begins and ends, and the height of the ground */

static mpm_status below_slope(void *user, int32_t dim, int64_t n, int64_t ld, const double *x,
                              uint8_t *inside) {
  const double slope = *(double *)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = x[ld + i] < HIGH - slope * fmax(0.0, x[i] - FOOT);
  return 0;
}

/* Returns the largest displacement in a set. */
static double moved(const world *w, const mpm_particles *set) {
  double *x = fetch(w, set, "position", 2), *was = fetch(w, set, "reference_position", 2);
  const int64_t n = 2 * mpm_particles_count(set);
  for (int64_t i = 0; i < n; ++i) x[i] -= was[i];
  const double most = largest(n, x);
  free(x), free(was);
  return most;
}

/* A slope of sand with phi = 30: the stress of level ground is a guess, from which local damping finds
 * equilibrium where the slope has 20 degrees. After it, with damping off, velocities 0 and a new
 * reference, it stands. With 40 degrees there is no equilibrium. */
START_TEST(slope) {
  const double h = 0.5, height = HIGH;
  double tangent = tan(_i ? PI / 4.5 : PI / 9.0);
  const mpm_param sand[] = {{"E", 2e7}, {"nu", 0.3}, {"density", 2e3}, {"phi", 30.0}, {"cohesion", 0.0}};
  world_desc desc = ground(2, &laws[MOHR], h);
  desc.law.params = sand;
  desc.grid.cells[0] = 2 * (TOP + 2);
  desc.grid.cells[1] = 2 * HIGH + 2;
  desc.stepper.scheme = MPM_MUSL;
  desc.stepper.local_damping = 0.7;
  desc.stepper.reference_positions = 1;
  world w;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 0.0}, high[] = {TOP + 2.0, height};
  const int32_t per_cell[] = {2, 2};
  ck_ok(&w, mpm_particles_fill(set, low, high, per_cell, below_slope, &tangent, NULL, NULL));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(&w, mpm_particles_set_geostatic(set, 1, -g, height, 0.5, 0.0));
  mpm_advance_desc go = advance_desc(2.0);
  ck_ok(&w, mpm_advance(w.stepper, &go, NULL));
  const double none[] = {0.0, 0.0}, settled = moved(&w, set);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, none));
  ck_ok(&w, mpm_particles_reset_reference(set));
  mpm_stepper_desc free_of = w.desc.stepper;
  free_of.local_damping = 0.0;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &free_of));
  go.t_end = 3.0;
  ck_ok(&w, mpm_advance(w.stepper, &go, NULL));
  show("slope %d: settles by %g of its height, moves by %g\n", _i, settled / height, moved(&w, set) / height);
  if (_i) {
    ck_assert_double_ge(settled, 0.05 * height);
  } else {
    ck_assert_double_le(settled, 5e-3 * height);
    ck_assert_double_le(moved(&w, set), 1e-3 * height);
  }
  world_close(&w);
}
END_TEST

/* ---- a new reference ----------------------------------------------------------------------------------- */
/* Ground that has moved goes on from a new reference as it was: the same accelerations, and displacements
 * from there. Laws of stress rates see no difference at all. */
START_TEST(reset) {
  world w, other;
  world_desc desc = ground(2, &laws[0], 0.5);
  desc.grid.basis = MPM_CPGIMP;
  desc.grid.periodic[0] = 1;
  desc.stepper.reference_positions = 1;
  desc.stepper.locking_remedy = 1;
  desc.grid.cells[0] = 2, desc.grid.cells[1] = 8;
  mpm_particles *set[2];
  const double low[] = {0.0, 0.0}, high[] = {1.0, 3.0};
  for (int32_t k = 0; k < 2; ++k) {
    world *of = k ? &other : &w;
    const double v[] = {8.0, 0.0};
    set[k] = world_open(of, &desc);
    world_fill(of, set[k], low, high, 2);
    ck_ok(of, mpm_particles_set_all(set[k], "velocity", MPM_F64, 2, v));
    ck_ok(of, mpm_stepper_set_wall(of->stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
    for (int32_t i = 0; i < 60; ++i) world_step(of, 0.002);
  }
  const int64_t n = mpm_particles_count(set[0]);
  double *F = fetch(&w, set[0], "deformation_gradient", 9), *size = fetch(&w, set[0], "size", 2);
  double *volume = fetch(&w, set[0], "volume", 1), *x = fetch(&w, set[0], "position", 2);
  int64_t *image = fetch_as(&w, set[0], "image", MPM_I64, 2);
  world_agree("before", &w, &other, "stress", 6, 0.0);
  ck_ok(&w, mpm_particles_reset_reference(set[0]));
  world_agree("stress stays", &w, &other, "stress", 6, 0.0);
  world_agree("mass stays", &w, &other, "mass", 1, 0.0);
  world_agree("volume stays", &w, &other, "volume", 1, 1e-15);
  double *F_now = fetch(&w, set[0], "deformation_gradient", 9), *size_now = fetch(&w, set[0], "size", 2);
  double *initial = fetch(&w, set[0], "initial_volume", 1), *ratio = fetch(&w, set[0], "dilation_ratio", 1);
  double *reference = fetch(&w, set[0], "reference_position", 2);
  double stretched = 0.0, crossed = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t c = 0; c < 9; ++c) ck_holds(F_now[c * n + i] == (c % 4 ? 0.0 : 1.0));
    ck_holds(initial[i] == volume[i] && ratio[i] == 1.0);
    for (int32_t k = 0; k < 2; ++k) {
      ck_within("domains stay", size_now[k * n + i], size[k * n + i] * F[4 * k * n + i], 1e-14);
      ck_holds(reference[k * n + i] == x[k * n + i] + (k ? 0.0 : 1.0) * (double)image[k * n + i]);
    }
    stretched = fmax(stretched, fabs(F[4 * n + i] - 1.0));
    crossed = fmax(crossed, fabs((double)image[i]));
  }
  ck_assert_double_gt(stretched, 1e-4);
  ck_assert_double_gt(crossed, 0.0);
  for (int32_t i = 0; i < 10; ++i) {
    world_step(&w, 0.002);
    world_step(&other, 0.002);
  }
  world_agree("goes on", &w, &other, "stress", 6, 2e-3);
  world_agree("goes on", &w, &other, "velocity", 2, 1e-5);
  free(F), free(size), free(volume), free(x), free(image), free(F_now), free(size_now), free(initial);
  free(ratio), free(reference);
  world_close(&w);
  world_close(&other);
}
END_TEST

/* With points for particles nothing but rounding differs, and so it is with cpGIMP in ground that is set. */
START_TEST(domains_of_ground) {
  world_desc desc = ground(2, &laws[ELASTIC], 0.5);
  desc.grid.basis = MPM_CPGIMP;
  world w;
  mpm_particles *set = open_column(&w, &desc, 5, 0.5, 2);
  ck_ok(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 0.5, 1e6));
  const int64_t n = mpm_particles_count(set);
  double *F = fetch(&w, set, "deformation_gradient", 9), *size = fetch(&w, set, "size", 2);
  for (int64_t i = 0; i < n; ++i)
    for (int32_t k = 0; k < 2; ++k) ck_within("domain", size[k * n + i] * F[4 * k * n + i], 0.25, 1e-15);
  ck_assert_double_lt(F[4 * n], 0.98);
  free(F), free(size);
  world_close(&w);
}
END_TEST

/* ---- laws of the host ---------------------------------------------------------------------------------- */
/* Keeps the stress that it has: its state. */
static mpm_status keeps(void *user, const mpm_material_batch *b) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + i] = b->stress[c * b->ld + i];
    b->wave_speed[i] = 100.0;
  }
  return 0;
}

static mpm_status refuses(void *user, const mpm_material_batch *b) {
  (void)b;
  return *(int32_t *)user ? -7 : 0;
}

START_TEST(laws_of_the_host) {
  int32_t says_no = 1;
  world_law law = {.stress = keeps, .density = density};
  world w;
  world_desc desc = ground(2, &law, 0.5);
  mpm_particles *set = open_column(&w, &desc, 5, 0.5, 2);
  ck_ok(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 0.4, 1e3));
  ck_stress(&w, set, 1, 1.0, 5.0, 0.4, 1e3, 1e-14);
  ck_ok(&w, mpm_particles_reset_reference(set));
  ck_stress(&w, set, 1, 1.0, 5.0, 0.4, 1e3, 1e-14);
  world_close(&w);
  for (int32_t k = 0; k < 2; ++k) {
    law.stress = k ? refuses : host_neo_hookean;
    law.user = &says_no;
    says_no = 0;
    desc = ground(2, &law, 0.5);
    set = open_column(&w, &desc, 5, 0.5, 2);
    world_bits was = world_take(&w);
    says_no = 1;
    if (k)
      ck_refused(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 0.4, 1e3), MPM_E_CALLBACK, "returned -7");
    else
      ck_refused(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 0.4, 1e3), MPM_E_UNSUPPORTED,
                 "its stress is not its state");
    says_no = 0;
    world_same(&w, &was, "refused");
    bits_drop(&was);
    world_close(&w);
  }
}
END_TEST

/* ---- what is refused ----------------------------------------------------------------------------------- */
START_TEST(refusals) {
  static const struct {
    int32_t axis;
    double gravity, surface, K0, surcharge;
    const char *text;
  } bad[] = {{-1, -10, 5, 1, 0, "axis is -1"},
             {2, -10, 5, 1, 0, "a 2-D grid has 0 ... 1"},
             {1, 0, 5, 1, 0, "gravity is 0"},
             {1, NOT_A_NUMBER, 5, 1, 0, "gravity is"},
             {1, INFINITE, 5, 1, 0, "gravity is"},
             {1, -10, NOT_A_NUMBER, 1, 0, "surface is"},
             {1, -10, INFINITE, 1, 0, "surface is"},
             {1, -10, 5, -0.1, 0, "K0 is -0.1"},
             {1, -10, 5, NOT_A_NUMBER, 0, "K0 is"},
             {1, -10, 5, INFINITE, 0, "K0 is"},
             {1, -10, 5, 1, -1, "surcharge is -1"},
             {1, -10, 5, 1, NOT_A_NUMBER, "surcharge is"},
             {1, -10, 5, 1, INFINITE, "surcharge is"},
             {1, -10, 2, 1, 0, "above the surface at 2"},
             {1, 10, 0.2, 1, 0, "the particle with id 0 lies"},
             {1, -1e308, 5, 1, 0, "beyond the range"}};
  for (int32_t law = 0; law < LAWS_AT_REST; ++law) {
    world w;
    const world_desc desc = ground(2, &laws[law], 0.5);
    mpm_particles *set = open_column(&w, &desc, 5, 0.5, 2);
    mpm_view view = {.struct_size = sizeof view};
    ck_ok(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 1.0, 0.0));
    world_bits was = world_take(&w);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
      ck_refused(&w,
                 mpm_particles_set_geostatic(set, bad[i].axis, bad[i].gravity, bad[i].surface, bad[i].K0,
                                             bad[i].surcharge),
                 MPM_E_ARG, bad[i].text);
    if (follows_F(law)) {
      ck_refused(&w, mpm_particles_set_geostatic(set, 1, -1e300, 5.0, 1.0, 0.0), MPM_E_ARG,
                 "no stretch along the axes gives");
      ck_refused(&w, mpm_particles_reset_reference(set), MPM_E_UNSUPPORTED, "set reference_position");
    }
    ck_ok(&w, mpm_particles_map(set, "mass", MPM_READ, &view));
    ck_refused(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 1.0, 0.0), MPM_E_STATE, "");
    ck_refused(&w, mpm_particles_reset_reference(set), MPM_E_STATE, "");
    ck_ok(&w, mpm_view_release(&view));
    world_same(&w, &was, "refused");
    bits_drop(&was);
    world_close(&w);
  }
  ck_assert_int_eq(mpm_particles_set_geostatic(NULL, 0, -1.0, 1.0, 1.0, 0.0), MPM_E_ARG);
  ck_assert_int_eq(mpm_particles_reset_reference(NULL), MPM_E_ARG);
}
END_TEST

/* Rigid sets, periodic axes, empty sets, and steps in parts. */
START_TEST(where_it_makes_no_sense) {
  const world_law rigid = {.model = "rigid", .density = density};
  world w;
  world_desc desc = ground(2, &rigid, 0.5);
  mpm_particles *set = open_column(&w, &desc, 5, 0.5, 2);
  ck_refused(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 1.0, 0.0), MPM_E_UNSUPPORTED, "rigid has no");
  ck_refused(&w, mpm_particles_reset_reference(set), MPM_E_UNSUPPORTED, "rigid");
  world_close(&w);
  desc = ground(2, &laws[0], 0.5);
  desc.grid.periodic[1] = 1;
  desc.grid.cells[0] = desc.grid.cells[1] = 8;
  set = world_open(&w, &desc);
  ck_refused(&w, mpm_particles_set_geostatic(set, 1, -g, 5.0, 1.0, 0.0), MPM_E_ARG, "axis 1 is periodic");
  ck_ok(&w, mpm_particles_set_geostatic(set, 0, -g, 5.0, 1.0, 0.0));
  ck_ok(&w, mpm_particles_reset_reference(set));
  const double low[] = {1.0, 1.0}, high[] = {2.0, 2.0};
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  ck_refused(&w, mpm_particles_set_geostatic(set, 0, -g, 5.0, 1.0, 0.0), MPM_E_STATE, "");
  ck_refused(&w, mpm_particles_reset_reference(set), MPM_E_STATE, "");
  ck_ok(&w, mpm_step_abort(w.stepper));
  world_close(&w);
}
END_TEST

Suite *geostatic_suite(void);
Suite *geostatic_suite(void) {
  Suite *suite = suite_create("geostatic");
  TCase *stress = tcase_create("stress"), *rest = tcase_create("rest"), *other = tcase_create("other");
  tcase_add_loop_test(stress, stress_of_the_weight, 0, 3 * LAWS_AT_REST);
  tcase_add_test(stress, large_weights);
  add_sparse(rest, column_in_explicit_steps, 2 * LAWS_AT_REST, 5);
  tcase_add_loop_test(rest, column_in_a_static_step, 0, LAWS_AT_REST);
  tcase_add_test(rest, layers);
  add_sparse(rest, slope, 2, 3);
  tcase_add_test(other, reset);
  tcase_add_test(other, domains_of_ground);
  tcase_add_test(other, laws_of_the_host);
  tcase_add_test(other, refusals);
  tcase_add_test(other, where_it_makes_no_sense);
  tcase_set_timeout(stress, 60);
  tcase_set_timeout(rest, 120);
  suite_add_tcase(suite, stress);
  suite_add_tcase(suite, rest);
  suite_add_tcase(suite, other);
  return suite;
}
