/* Total Lagrangian grids: gradient, forces, what moves and what stays, surfaces and refusals. */
#include "geometry.h"
#include "reference.h"
#include "surfaces.h"

static world_desc total_with(const method *how, int32_t dim) {
  world_desc d = world_with(how, dim, CELLS, spacing);
  d.grid.total_lagrangian = 1;
  return d;
}

/* Do particles deform by the velocities that nodes have at the end of the step? */
static int32_t strains_by_nodes(const method *how) {
  return how->scheme == MPM_USL && !how->remedy;
}

/* ---- the gradient -------------------------------------------------------------------------------------- */
/* A gradient over reference positions that turns, stretches and shears a lot in one step. */
static const double growth[3][3] = {{0.9, -0.7, 0.2}, {0.6, -0.2, -0.3}, {-0.1, 0.4, 0.5}};

static void grow(const double *x, double *v) {
  for (int32_t i = 0; i < 3; ++i) {
    v[i] = 0.0;
    for (int32_t k = 0; k < 3; ++k) v[i] += growth[i][k] * (x[k] - 1.5);
  }
}

static int32_t is_inside(int32_t dim, int64_t n, const double *X, int64_t p) {
  int32_t inside = 1;
  for (int32_t k = 0; k < dim; ++k)
    inside &= fabs(X[k * n + p] - 1.5) < 0.3; /* nodes farther out are empty */
  return inside;
}

/* Velocities that are linear over the reference make F = I + t dF/dt, step by step: no terms of higher order,
 * whatever the body has come to. Positions leave the grid, and particles stay where they were sorted. */
START_TEST(linear_motion) {
  const method *how = broad_methods[_i % BROAD];
  const int32_t dim = 1 + _i / BROAD;
  if (!strains_by_nodes(how) || how->position_order == 2) return;
  if (how->remedy && dim == 1) return;
  world w;
  const world_desc desc = total_with(how, dim);
  mpm_particles *set = open_block_with(&w, &desc);
  const int64_t n = mpm_particles_count(set);
  const double dt = 0.4;
  for (int32_t k = 0; k < 3; ++k) step_with(&w, dt, grow);
  ck_assert_int_eq(w.info.resorts, 0);
  double *F = fetch(&w, set, "deformation_gradient", 9), *x = fetch(&w, set, "position", dim),
         *X = fetch(&w, set, "reference_position", dim), *volume = fetch(&w, set, "volume", 1),
         *initial = fetch(&w, set, "initial_volume", 1);
  int64_t inside = 0;
  for (int64_t p = 0; p < n; ++p) {
    if (!is_inside(dim, n, X, p)) continue;
    ++inside;
    double J[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    for (int32_t i = 0; i < dim; ++i) {
      double at = X[i * n + p];
      for (int32_t k = 0; k < dim; ++k) {
        J[3 * i + k] = (i == k) + 3.0 * dt * growth[i][k];
        ck_within(how->name, F[(3 * i + k) * n + p], J[3 * i + k], 1e-13);
        at += 3.0 * dt * growth[i][k] * (X[k * n + p] - 1.5);
      }
      if (!how->staggered) ck_within(how->name, x[i * n + p], at, 1e-13);
    }
    ck_within(how->name, volume[p], determinant(J) * initial[p], 1e-13);
  }
  ck_holds(inside > 0);
  free(F);
  free(x);
  free(X);
  free(volume);
  free(initial);
  world_close(&w);
}
END_TEST

/* ---- forces -------------------------------------------------------------------------------------------- */
static int32_t axes; /* of wild() */

static void wild(const double *x, double *v) {
  uint64_t seed = 70;
  for (int32_t k = 0; k < axes; ++k) seed = 1000 * seed + (uint64_t)llround(x[k] * 64.0);
  for (int32_t k = 0; k < 3; ++k) v[k] = 0.1 * noise_at(3 * seed + (uint64_t)k);
}

static void set_wild(const world *w, mpm_particles *set, int64_t n) {
  double *stress = calloc((size_t)(6 * n), sizeof *stress), *F = calloc((size_t)(9 * n), sizeof *F);
  for (int32_t c = 0; c < 6; ++c)
    for (int64_t p = 0; p < n; ++p) {
      const int32_t there = w->dim == 3 || c < 3 || (w->dim == 2 && c == 3);
      stress[c * n + p] = there ? 1e3 * noise_at((uint64_t)(c * n + p) + 3) : 0.0;
    }
  for (int32_t e = 0; e < 9; ++e)
    for (int64_t p = 0; p < n; ++p) {
      const int32_t there = e / 3 < w->dim && e % 3 < w->dim;
      F[e * n + p] = (e % 4 ? 0.0 : 1.0) + (there ? 0.3 * noise_at((uint64_t)(e * n + p) + 99) : 0.0);
    }
  if (w->desc.grid.geometry == MPM_AXISYMMETRIC)
    for (int64_t p = 0; p < n; ++p) F[8 * n + p] = 1.4;
  put(w, set, "deformation_gradient", 9, F);
  put(w, set, "stress", 6, stress);
  free(stress);
  free(F);
}

/* Finds the power V sigma : dF/dt F^-1 of a particle by Cramer's rule. */
static double power_of(int64_t n, int64_t p, const double *stress, const double *F, const double *new,
                       double dt) {
  static const int32_t voigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  double A[9], power = 0.0;
  for (int32_t e = 0; e < 9; ++e) A[e] = F[e * n + p];
  const double J = determinant(A);
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j)
      for (int32_t k = 0; k < 3; ++k) {
        double cofactor[9];
        memcpy(cofactor, A, sizeof A);
        for (int32_t e = 0; e < 3; ++e) cofactor[3 * e + k] = e == j; /* (F^-1)_kj */
        const double rate = (new[(3 * i + k) * n + p] - F[(3 * i + k) * n + p]) / dt;
        power += stress[voigt[i][j] * n + p] * rate * determinant(cofactor) / J;
      }
  return power;
}

/* The forces of particles do the power of their stress: sum f v = - sum V sigma : dF/dt F^-1, for whatever
 * stress, deformation and velocity of the nodes. */
static void check_power(const world_desc *desc, const char *name) {
  world w;
  world_desc d = *desc;
  const double dt = 1e-2;
  axes = d.grid.dim;
  d.law.model = "linear_elastic";
  mpm_particles *set = world_open(&w, &d);
  const double low[] = {0.7, 0.7, 0.9}, high[] = {1.3, 1.4, 1.4};
  const int64_t n = world_fill(&w, set, low, high, 2);
  set_wild(&w, set, n);
  double *stress = fetch(&w, set, "stress", 6), *volume = fetch(&w, set, "volume", 1),
         *F = fetch(&w, set, "deformation_gradient", 9);
  int64_t nodes = 0, count = 0;
  ck_ok(&w, mpm_step_begin(w.stepper, dt));
  double *f = fetch_nodes(&w, "force", &nodes);
  ck_ok(&w, mpm_step_abort(w.stepper));
  step_with(&w, dt, wild);
  double *at = fetch_nodes(&w, "position", &count), *new = fetch(&w, set, "deformation_gradient", 9);
  ck_assert_int_eq(nodes, count);
  double of_nodes = 0.0, of_particles = 0.0, scale = 0.0;
  for (int64_t i = 0; i < nodes; ++i) {
    double x[3] = {0.0, 0.0, 0.0}, v[3];
    for (int32_t k = 0; k < w.dim; ++k) x[k] = at[k * nodes + i];
    wild(x, v);
    for (int32_t k = 0; k < w.dim; ++k) of_nodes += f[k * nodes + i] * v[k];
  }
  for (int64_t p = 0; p < n; ++p) {
    const double power = volume[p] * power_of(n, p, stress, F, new, dt);
    of_particles += power;
    scale += fabs(power);
  }
  ck_holds(scale > 0.0);
  ck_within(name, of_nodes, -of_particles, 1e-11 * scale);
  free(stress);
  free(volume);
  free(f);
  free(at);
  free(F);
  free(new);
  world_close(&w);
}

START_TEST(forces_do_the_power_of_stresses) {
  const method *how = broad_methods[_i % BROAD];
  const int32_t dim = 1 + _i / BROAD;
  if (!strains_by_nodes(how)) return;
  world_desc desc = total_with(how, dim);
  check_power(&desc, how->name);
  if (dim != 2 || how->transfer == MPM_APIC_MLS) return;
  desc.grid.geometry = MPM_AXISYMMETRIC;
  check_power(&desc, how->name);
}
END_TEST

/* ---- implicit steps ------------------------------------------------------------------------------------ */
static world_desc implicit_total(const basis_option *basis, int32_t dim, int32_t remedy, const char *model) {
  const method how = method_of(basis, &(scheme_option){MPM_NEWMARK, "Newmark"}, &transfer_options[0]);
  world_desc d = total_with(&how, dim);
  d.stepper.flip = 1.0;
  d.stepper.pic_damping = 0.0;
  d.stepper.locking_remedy = remedy;
  d.stepper.transfer = MPM_FLIP;
  d.law =
      (world_law){.model = model, .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 4e3, .hardening = 1e4};
  return d;
}

enum { IMPLICIT_CASES = 12 }; /* dim 2, 3, or rings; remedy; law */

/* With open knots the rim of a block that nothing holds has nodes of hardly any stiffness, on any grid: they
 * are pressed less. */
static double load_of(const basis_option *basis) {
  return basis->boundary == MPM_BOUNDARY_OPEN_KNOT ? 0.1 : 1.0;
}

/* A block that stands on a floor is pressed from the side and from above in two steps, by a fifth of its
 * stiffness or so that it yields: Newton's iteration has the tangent of its forces, whatever the block has
 * come to, and takes few steps. */
START_TEST(tangents) {
  static const char *const models[] = {"neo_hookean", "j2"};
  const basis_option *basis = &basis_options[_i / IMPLICIT_CASES];
  const int32_t kind = _i % IMPLICIT_CASES / 4, remedy = _i / 2 % 2, yields = _i % 2, dim = kind == 1 ? 3 : 2;
  world w;
  world_desc desc = implicit_total(basis, dim, remedy, models[yields]);
  desc.stepper.quasi_static = 1;
  if (kind == 2) desc.grid.geometry = MPM_AXISYMMETRIC;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.5, 0.0, 0.5}, high[] = {1.25, 0.75, 1.0};
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  mpm_surface_desc d = load_desc();
  d.pressure = (yields ? 2e3 : 1e4) * load_of(basis);
  d.traction[0] = 0.1 * d.pressure;
  mpm_surface *s = put_surface(&w, &d);
  const int32_t deep = dim == 3 ? 4 : 1;
  for (int32_t k = 0; k < 12 * deep; ++k) {
    const int32_t top = k / deep >= 6;
    const double along = 0.0625 + 0.125 * (k / deep % 6), z = 0.5625 + 0.125 * (k % deep);
    const double edge = dim == 3 ? 0.125 * 0.125 : 0.125;
    const double at[] = {top ? 0.5 + along : 1.25, top ? 0.75 : along, z};
    const double size = edge * (kind == 2 ? at[0] : 1.0), area[] = {top ? 0.0 : size, top ? size : 0.0, 0.0};
    ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
  }
  const int64_t n = mpm_surface_count(s);
  for (int32_t step = 1; step <= 2; ++step) {
    const mpm_step_info info = world_step(&w, 1.0);
    show("%s, %d, %s, remedy %d: %d iterations\n", basis->name, (int)kind, models[yields], (int)remedy,
         (int)info.newton_iterations);
    ck_assert_int_le(info.newton_iterations, 8);
    double reaction[3], *f = markers(s, "force", dim), across = 0.0;
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, reaction));
    for (int64_t i = 0; i < n; ++i) across += f[n + i];
    ck_within("reaction", reaction[1], -across, 1e-6 * 1e4);
    free(f);
    d.pressure *= 1.5;
    ck_ok(&w, mpm_surface_configure(s, &d));
  }
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

static uint64_t implicit_hash(const basis_option *basis, int32_t dim, const char *model,
                              int32_t concurrency) {
  world w;
  world_desc desc = implicit_total(basis, dim, dim > 1 && basis->basis % 2, model);
  desc.context.concurrency = concurrency;
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 1.0, 1.75);
  double *v = malloc((size_t)(dim * n + 1) * sizeof *v);
  for (int64_t i = 0; i < dim * n; ++i) v[i] = noise_at((uint64_t)i);
  put(&w, set, "velocity", dim, v);
  free(v);
  for (int32_t k = 0; k < 3; ++k) world_step(&w, 2e-3);
  const saved_state state = world_save(&w);
  world_step(&w, 2e-3);
  const uint64_t hash = world_hash(&w);
  world_load(&w, &state);
  world_step(&w, 2e-3);
  ck_assert_uint_eq(world_hash(&w), hash);
  free(state.data);
  world_close(&w);
  return hash;
}

START_TEST(implicit_threads) {
  static const char *const models[] = {"neo_hookean", "j2", "linear_elastic"};
  const basis_option *basis = &basis_options[_i / 3];
  const int32_t dim = 1 + _i % 3;
  const char *model = models[(_i / 3 + _i) % 3];
  ck_assert_uint_eq(implicit_hash(basis, dim, model, 1), implicit_hash(basis, dim, model, 3));
}
END_TEST

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* Area vectors follow F as Nanson's relation has it, for a body that has turned and stretched a lot, and the
 * halves of markers have the area of the whole. */
START_TEST(areas_follow_F) {
  const int32_t dim = 2 + _i;
  world w;
  const world_desc desc = total_with(broad_methods[0], dim);
  open_block_with(&w, &desc);
  mpm_surface_desc d = load_desc();
  mpm_surface *s = put_surface(&w, &d);
  add_closed(&w, s, 0.2);
  const int64_t n = mpm_surface_count(s);
  double *before = markers(s, "area", dim), *X = markers(s, "position", dim);
  for (int32_t k = 0; k < 3; ++k) step_with(&w, 0.4, grow);
  double *after = markers(s, "area", dim), *x = markers(s, "position", dim),
         *moved = markers(s, "displacement", dim);
  double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t k = 0; k < dim; ++k) F[3 * i + k] += 1.2 * growth[i][k];
  for (int64_t p = 0; p < n; ++p)
    for (int32_t i = 0; i < dim; ++i) {
      double wanted = 0.0, at = X[i * n + p];
      for (int32_t k = 0; k < dim; ++k) {
        double cofactor[9]; /* J F^-T */
        memcpy(cofactor, F, sizeof F);
        for (int32_t e = 0; e < 3; ++e) cofactor[3 * i + e] = e == k;
        wanted += determinant(cofactor) * before[k * n + p];
        at += 1.2 * growth[i][k] * (X[k * n + p] - 1.5);
      }
      ck_within("area", after[i * n + p], wanted, 1e-13);
      ck_within("position", x[i * n + p], at, 1e-13);
      ck_within("displacement", moved[i * n + p], at - X[i * n + p], 1e-13);
    }
  int64_t added;
  ck_ok(&w, mpm_surface_refine(s, 0.05, &added));
  ck_assert_int_gt(added, n);
  step_with(&w, 0.1, grow);
  const int64_t all = mpm_surface_count(s);
  double *halves = markers(s, "area", dim);
  for (int32_t i = 0; i < dim; ++i) ck_within("closed", sum_of(all, halves + i * all), 0.0, 1e-13);
  ck_refused(&w, mpm_surface_set(s, "area", MPM_F64, dim, all, NULL, halves), MPM_E_UNSUPPORTED,
             "remove it and add another");
  free(halves);
  free(before);
  free(after);
  free(X);
  free(x);
  free(moved);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A closed surface under pressure has no force, whatever the body has come to; and saved and loaded markers
 * go on with the same bits. */
START_TEST(pressure_on_what_has_moved) {
  const int32_t dim = 2 + _i % 2;
  const method *how = broad_methods[_i / 2];
  if (!is_explicit(how)) return;
  world w;
  const world_desc desc = total_with(how, dim);
  open_block_with(&w, &desc);
  mpm_surface_desc d = load_desc();
  mpm_surface *s = put_surface(&w, &d);
  add_closed(&w, s, 0.3);
  step_with(&w, 0.4, grow);
  d.pressure = 1e3;
  ck_ok(&w, mpm_surface_configure(s, &d));
  double *f;
  world_step(&w, 1e-5);
  f = markers(s, "force", dim);
  const int64_t n = mpm_surface_count(s);
  for (int32_t k = 0; k < dim; ++k) ck_within(how->name, sum_of(n, f + k * n), 0.0, 1e-9);
  ck_holds(largest(n, f) > 1.0);
  free(f);
  const saved_state state = world_save(&w);
  world_step(&w, 1e-5);
  const uint64_t hash = world_hash(&w);
  world_load(&w, &state);
  world_step(&w, 1e-5);
  ck_assert_uint_eq(world_hash(&w), hash);
  free(state.data);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* The halves of a split marker have the area of the whole from then on, those of rings with the radius at
 * which each half was. */
START_TEST(halves_follow_F) {
  static const double along[3] = {0.6, 0.0, 0.0};
  world w;
  world_desc desc = total_with(broad_methods[0], 2);
  if (_i) desc.grid.geometry = MPM_AXISYMMETRIC;
  open_block_with(&w, &desc);
  mpm_surface_desc d = load_desc();
  mpm_surface *whole = put_surface(&w, &d), *split = put_surface(&w, &d);
  const double at[] = {1.5, 1.5}, area[] = {0.0, _i ? 1.5 * along[0] : along[0]};
  ck_ok(&w, mpm_surface_add(whole, 1, at, area, NULL));
  ck_ok(&w, mpm_surface_add(split, 1, at, area, NULL));
  step_with(&w, 0.3, grow);
  ck_ok(&w, mpm_surface_refine(split, 0.1, NULL));
  step_with(&w, 0.3, grow);
  const int64_t n = mpm_surface_count(split);
  ck_assert_int_ge(n, 4);
  double *a = markers(whole, "area", 2), *b = markers(split, "area", 2), *x = markers(split, "position", 2);
  for (int32_t k = 0; k < 2; ++k) ck_within("area", sum_of(n, b + k * n), a[k], _i ? 0.02 : 1e-13);
  /* of rings an area is that of one radian: length times radius */
  for (int64_t i = 1; i < n && _i; ++i) ck_within("radius", b[n + i] / b[n], x[i] / x[0], 1e-12);
  free(a);
  free(b);
  free(x);
  drop_surface(&w, split);
  drop_surface(&w, whole);
  world_close(&w);
}
END_TEST

/* ---- obstacles ----------------------------------------------------------------------------------------- */
/* A block flies a long way, out of the grid, turned by half a right angle in between, and falls on a plane:
 * it touches where it is and not where it was, and leaves with the momentum that the plane reports. */
START_TEST(obstacles_meet_what_has_moved) {
  const int32_t dim = 1 + _i % 3, implicit = _i >= 3;
  world w;
  world_desc desc =
      implicit ? implicit_total(&basis_options[0], dim, 0, "neo_hookean") : total_with(broad_methods[0], dim);
  desc.stepper.flip = 1.0;
  mpm_particles *set = open_block_with(&w, &desc);
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(&w, set, "position", dim), *moved = malloc((size_t)(dim * n) * sizeof *moved);
  double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const double turn = sqrt(0.5);
  if (dim > 1) F[0] = F[4] = turn, F[1] = -turn, F[3] = turn;
  for (int64_t p = 0; p < n; ++p)
    for (int32_t i = 0; i < dim; ++i) {
      moved[i * n + p] = 20.0;
      for (int32_t k = 0; k < dim; ++k) moved[i * n + p] += F[3 * i + k] * (x[k * n + p] - 1.5);
    }
  put(&w, set, "position", dim, moved);
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  const int32_t down = dim > 1 ? 1 : 0;
  double v[3] = {0.0, 0.0, 0.0}, lowest = moved[down * n];
  for (int64_t p = 0; p < n; ++p) lowest = fmin(lowest, moved[down * n + p]);
  v[down] = -1.0;
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
  mpm_obstacle_desc d;
  mpm_obstacle *floor;
  ck_ok(&w, mpm_obstacle_desc_init(&d, sizeof d));
  d.shape = MPM_SHAPE_PLANE;
  d.position[down] = lowest - 0.3;
  ck_ok(&w, mpm_obstacle_create(w.context, &d, &floor));
  ck_ok(&w, mpm_stepper_add_obstacle(w.stepper, floor));
  mpm_contact_info info = {.struct_size = sizeof info};
  const double mass = mass_of(&w, set), dt = implicit ? 1e-2 : 1e-3;
  double first = 0.0, most = 0.0;
  while (w.info.t < 0.9) {
    world_step(&w, dt);
    ck_ok(&w, mpm_obstacle_contact_info(floor, MPM_BODY_ANY, &info));
    if (info.touching && first == 0.0) first = w.info.t;
    most = fmax(most, info.normal_force);
  }
  show("%d-D, implicit %d: first touch %g, momentum %g of %g, force %g\n", (int)dim, (int)implicit, first,
       w.info.momentum[down], mass, most);
  ck_between("first touch", first, 0.2, 0.3);
  ck_within("momentum", w.info.momentum[down], info.impulse[down] - mass, 1e-10 * mass);
  ck_between("rebound", w.info.momentum[down] / mass, 0.4, 1.0); /* on its edge */
  ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, floor));
  ck_ok(&w, mpm_obstacle_destroy(floor));
  free(x);
  free(moved);
  world_close(&w);
}
END_TEST

/* Returns what came of a block that is turned by so many right angles, F and positions alike, when it comes
 * down on a ball, fixed or free: momentum, angular momentum, and those that the ball says it has got. */
typedef struct landing {
  double momentum[2], spin, force[2], torque;
} landing;

static landing land(const method *how, int32_t turns, int32_t is_free) {
  static const double cosine[4] = {1.0, 0.0, -1.0, 0.0}, sine[4] = {0.0, 1.0, 0.0, -1.0};
  const double c = cosine[turns], s = sine[turns], F[9] = {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0},
               v[] = {0.4, -1.0};
  world w;
  const world_desc desc = total_with(how, 2);
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {1.0, 1.0}, high[] = {2.0, 2.0};
  const int64_t n = world_fill(&w, set, low, high, 2);
  double *x = fetch(&w, set, "position", 2), *moved = malloc((size_t)(2 * n) * sizeof *moved);
  for (int64_t p = 0; p < n; ++p)
    for (int32_t i = 0; i < 2; ++i)
      moved[i * n + p] = 8.0 + 2.0 * i + F[3 * i] * (x[p] - 1.5) + F[3 * i + 1] * (x[n + p] - 1.5);
  put(&w, set, "position", 2, moved);
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_obstacle_desc d;
  mpm_contact_desc rule;
  mpm_obstacle *ball;
  ck_ok(&w, mpm_contact_desc_init(&rule, sizeof rule));
  ck_ok(&w, mpm_obstacle_desc_init(&d, sizeof d));
  rule.friction = 0.4;
  d.contact = &rule;
  d.shape = MPM_SHAPE_SPHERE;
  d.motion = is_free ? MPM_MOTION_FREE : MPM_MOTION_FIXED;
  d.size[0] = 0.6;
  d.position[0] = 7.8, d.position[1] = 8.85;
  d.mass = 500.0;
  d.inertia[0] = d.inertia[4] = d.inertia[8] = 50.0;
  ck_ok(&w, mpm_obstacle_create(w.context, &d, &ball));
  ck_ok(&w, mpm_stepper_add_obstacle(w.stepper, ball));
  mpm_contact_info info = {.struct_size = sizeof info};
  landing of = {.torque = 0.0};
  const double before = world_info(&w).angular_momentum[2];
  for (int32_t k = 0; k < 150; ++k) {
    world_step(&w, 1e-3);
    ck_ok(&w, mpm_obstacle_contact_info(ball, MPM_BODY_ANY, &info));
    of.torque += 1e-3 * info.torque[2];
  }
  double at[3], velocity[3], spin[3];
  ck_ok(&w, mpm_obstacle_get_pose(ball, at, NULL, velocity, spin));
  const double of_ball = is_free ? 500.0 * (at[0] * velocity[1] - at[1] * velocity[0]) + 50.0 * spin[2] : 0.0;
  for (int32_t i = 0; i < 2; ++i) of.momentum[i] = w.info.momentum[i], of.force[i] = info.impulse[i];
  of.spin = w.info.angular_momentum[2] + of_ball - before;
  ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, ball));
  ck_ok(&w, mpm_obstacle_destroy(ball));
  free(x);
  free(moved);
  world_close(&w);
  return of;
}

/* Contact does not know how a body was turned before; and with a transfer that keeps angular momentum a free
 * ball gets what the body loses. */
START_TEST(contact_is_objective) {
  const method how =
      method_of(&basis_options[_i % 2 ? 1 : 2], &scheme_options[0], &transfer_options[_i / 2 ? 3 : 0]);
  for (int32_t is_free = 0; is_free < 2; ++is_free) {
    const landing first = land(&how, 0, is_free);
    ck_holds(first.force[1] > 50.0);
    /* of some 1e4; internal forces keep it as far as F is the gradient of the places of nodes */
    if (is_affine(&how) && is_free) ck_within("angular momentum", first.spin, 0.0, 0.5);
    for (int32_t turns = 1; turns < 4; ++turns) {
      const landing now = land(&how, turns, is_free);
      for (int32_t i = 0; i < 2; ++i) {
        ck_within(how.name, now.momentum[i], first.momentum[i], 1e-7 * 1e3);
        ck_within(how.name, now.force[i], first.force[i], 1e-7 * 1e3);
      }
      ck_within(how.name, now.torque, first.torque, 1e-7 * 1e3);
    }
  }
}
END_TEST

/* What lies on a plane does not sink into it, however far it is drawn out. */
START_TEST(stretched_bodies_rest) {
  const double stretch = 3.0, F[9] = {1.0, 0.0, 0.0, 0.0, stretch, 0.0, 0.0, 0.0, 1.0};
  world w;
  world_desc desc = total_with(&methods[0], 2);
  desc.law.model = "linear_elastic"; /* whose stress is its state: drawn out, it rests */
  desc.law.E = 1e6;
  desc.stepper.gravity[1] = -1.0;
  desc.stepper.mass_damping = 20.0;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {1.0, 1.0}, high[] = {2.0, 1.5};
  const int64_t n = world_fill(&w, set, low, high, 1);
  double *x = fetch(&w, set, "position", 2);
  for (int64_t p = 0; p < n; ++p) x[n + p] = stretch * (x[n + p] - 1.0); /* its face is at y = 0 */
  put(&w, set, "position", 2, x);
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  mpm_obstacle_desc d;
  mpm_obstacle *floor;
  ck_ok(&w, mpm_obstacle_desc_init(&d, sizeof d));
  d.shape = MPM_SHAPE_PLANE;
  ck_ok(&w, mpm_obstacle_create(w.context, &d, &floor));
  ck_ok(&w, mpm_stepper_add_obstacle(w.stepper, floor));
  for (int32_t k = 0; k < 600; ++k) world_step(&w, 2e-3);
  free(x);
  x = fetch(&w, set, "position", 2);
  double lowest = 10.0;
  for (int64_t p = 0; p < n; ++p) lowest = fmin(lowest, x[n + p]);
  ck_within("face", lowest - 0.5 * stretch * spacing, 0.0, 0.05 * spacing);
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_ok(&w, mpm_obstacle_contact_info(floor, MPM_BODY_ANY, &info));
  ck_assert_int_eq((int)info.nodes, 5); /* one row: two would make it stiff */
  free(x);
  ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, floor));
  ck_ok(&w, mpm_obstacle_destroy(floor));
  world_close(&w);
}
END_TEST

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Energy and angular momentum of the matrices count over the reference, the latter as F has turned it. */
START_TEST(sums_over_particles) {
  const method how = method_of(&basis_options[1], &scheme_options[0], &transfer_options[3]);
  world w;
  const world_desc desc = total_with(&how, 2);
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 1.0, 2.0);
  world_step(&w, 1e-4); /* from here on there is a matrix */
  double *F = calloc((size_t)(9 * n), sizeof *F), *C = calloc((size_t)(9 * n), sizeof *C),
         *v = fetch(&w, set, "velocity", 2);
  for (int64_t p = 0; p < n; ++p) {
    for (int32_t e = 0; e < 4; ++e) {
      F[(3 * (e / 2) + e % 2) * n + p] = (e % 3 ? 0.0 : 1.0) + 0.4 * noise_at((uint64_t)(4 * p + e));
      C[(3 * (e / 2) + e % 2) * n + p] = noise_at((uint64_t)(4 * p + e) + 5000);
    }
    F[8 * n + p] = 1.0;
    for (int32_t k = 0; k < 2; ++k) v[k * n + p] = noise_at((uint64_t)(2 * p + k) + 9000);
  }
  put(&w, set, "deformation_gradient", 9, F);
  put(&w, set, "velocity_gradient", 9, C);
  put(&w, set, "velocity", 2, v);
  double *x = fetch(&w, set, "position", 2), *m = fetch(&w, set, "mass", 1);
  const double D = 0.25 * spacing * spacing;
  double spin = 0.0, energy = 0.0;
  for (int64_t p = 0; p < n; ++p) {
    double of_matrix = 0.0;
    for (int32_t k = 0; k < 2; ++k) { /* (C F^T)_10 - (C F^T)_01 */
      of_matrix += C[(3 + k) * n + p] * F[k * n + p] - C[k * n + p] * F[(3 + k) * n + p];
      for (int32_t i = 0; i < 2; ++i)
        energy += 0.5 * m[p] * D * C[(3 * i + k) * n + p] * C[(3 * i + k) * n + p];
    }
    spin += m[p] * (x[p] * v[n + p] - x[n + p] * v[p] + D * of_matrix);
  }
  world_stable_dt(&w);
  const mpm_step_info info = world_info(&w);
  ck_within("angular momentum", info.angular_momentum[2], spin, 1e-11 * 1e3);
  ck_within("energy", info.affine_kinetic_energy, energy, 1e-11 * energy);
  free(F);
  free(C);
  free(v);
  free(x);
  free(m);
  world_close(&w);
}
END_TEST

/* ---- the reference ------------------------------------------------------------------------------------- */
/* Begun anew, a body goes on as it would have: velocity, matrices and stress stay, F is I, and particles are
 * sorted where they are. */
START_TEST(begun_anew) {
  const method *how = broad_methods[_i];
  if (!strains_by_nodes(how) || !carries_matrix(how->transfer)) return;
  world w;
  world_desc desc = total_with(how, 2);
  desc.law.model = "linear_elastic";
  mpm_particles *set = open_block_with(&w, &desc);
  step_with(&w, 0.8, grow);
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(&w, set, "position", 2), *L = fetch(&w, set, "velocity_gradient", 9),
         *F = fetch(&w, set, "deformation_gradient", 9), *stress = fetch(&w, set, "stress", 6);
  ck_ok(&w, mpm_particles_reset_reference(set));
  double *X = fetch(&w, set, "reference_position", 2), *now = fetch(&w, set, "velocity_gradient", 9),
         *F_now = fetch(&w, set, "deformation_gradient", 9), *stress_now = fetch(&w, set, "stress", 6);
  for (int64_t i = 0; i < 2 * n; ++i) ck_within("reference", X[i], x[i], 0.0);
  for (int64_t i = 0; i < 6 * n; ++i) ck_within("stress", stress_now[i], stress[i], 0.0);
  for (int64_t p = 0; p < n; ++p)
    for (int32_t i = 0; i < 2; ++i)
      for (int32_t k = 0; k < 2; ++k) {
        double rate = 0.0;
        for (int32_t j = 0; j < 2; ++j) rate += now[(3 * i + j) * n + p] * F[(3 * j + k) * n + p];
        ck_within("matrix", rate, L[(3 * i + k) * n + p], 1e-13);
        ck_within("F", F_now[(3 * i + k) * n + p], i == k, 0.0);
      }
  const int64_t sorts = world_info(&w).resorts;
  world_step(&w, 1e-4);
  ck_assert_int_eq(w.info.resorts, sorts + 1);
  mpm_surface *s = put_surface(&w, NULL);
  const double face[] = {1.5, 1.5};
  ck_ok(&w, mpm_surface_add(s, 1, face, NULL, NULL));
  ck_refused(&w, mpm_particles_reset_reference(set), MPM_E_STATE, "take them out");
  drop_surface(&w, s);
  const double far[] = {40.0, 1.5};
  ck_ok(&w, mpm_particles_set_all(set, "position", MPM_F64, 2, far));
  ck_refused(&w, mpm_particles_reset_reference(set), MPM_E_ARG, "reference_position");
  free(x);
  free(L);
  free(F);
  free(stress);
  free(X);
  free(now);
  free(F_now);
  free(stress_now);
  world_close(&w);
}
END_TEST

/* On a periodic axis the reference is wrapped and the position is not; particles that come later are counted
 * from where they came. */
START_TEST(periodic_axes) {
  world w;
  world_desc desc = total_with(broad_methods[0], 2);
  desc.grid.periodic[0] = 1;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 1.0}, high[] = {3.0, 2.0}, v[] = {7.0, 0.0};
  world_fill(&w, set, low, high, 2);
  const double at[] = {3.5, 1.1}, volume = 1e-3;
  int64_t id;
  ck_ok(&w, mpm_particles_add(set, 1, at, NULL, &volume, NULL, NULL, &id));
  ck_within("wrapped", fetch1(&w, set, "position", 2, 0, id), 0.5, 1e-15);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  for (int32_t k = 0; k < 100; ++k) world_step(&w, 1e-2);
  ck_within("far", fetch1(&w, set, "position", 2, 0, id), 7.5, 1e-12);
  ck_within("stays", fetch1(&w, set, "reference_position", 2, 0, id), 0.5, 1e-15);
  ck_within("at rest", w.info.strain_energy, 0.0, 1e-15);
  const double there[] = {-0.5, 1.2};
  ck_ok(&w, mpm_particles_set(set, "reference_position", MPM_F64, 2, 1, &id, there));
  ck_within("wrapped", fetch1(&w, set, "reference_position", 2, 0, id), 2.5, 1e-15);
  world_step(&w, 1e-2);
  world_close(&w);
}
END_TEST

/* Ground that has deformed begins anew before it is given the stress of its weight. */
START_TEST(ground_begins_anew) {
  world w;
  world_desc desc = total_with(broad_methods[0], 2);
  desc.law.model = "linear_elastic";
  mpm_particles *set = open_block_with(&w, &desc);
  step_with(&w, 0.1, grow);
  ck_refused(&w, mpm_particles_set_geostatic(set, 1, -9.81, 4.0, 0.5, 0.0), MPM_E_UNSUPPORTED,
             "call mpm_particles_reset_reference first");
  ck_ok(&w, mpm_particles_reset_reference(set));
  ck_ok(&w, mpm_particles_set_geostatic(set, 1, -9.81, 4.0, 0.5, 0.0));
  world_close(&w);
}
END_TEST

/* Rings have the size of their section, from fills and where they are added one by one. */
START_TEST(sections_of_rings) {
  world w;
  world_desc desc = total_with(&methods[0], 2);
  desc.grid.geometry = MPM_AXISYMMETRIC;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.5, 1.0}, high[] = {1.0, 1.5}, at[] = {0.5, 2.0}, volume = 0.5 * 0.01;
  const int64_t n = world_fill(&w, set, low, high, 2) + 1;
  ck_ok(&w, mpm_particles_add(set, 1, at, NULL, &volume, NULL, NULL, NULL));
  double *size = fetch(&w, set, "size", 2);
  for (int64_t i = 0; i < 2 * n; ++i) ck_within("size", size[i], i % n == n - 1 ? 0.1 : 0.5 * spacing, 1e-14);
  free(size);
  world_close(&w);
}
END_TEST

/* The stable step shrinks with what is pressed together, and not with speed. */
START_TEST(stable_step) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    world_desc desc = total_with(broad_methods[0], dim);
    desc.law.model = "linear_elastic"; /* its wave speed is that of the law, whatever F is */
    mpm_particles *set = open_block_with(&w, &desc);
    const double at_rest = world_stable_dt(&w), v[] = {1e6, -1e6, 1e6};
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
    ck_within("speed", world_stable_dt(&w), at_rest, 1e-14 * at_rest);
    double F[9] = {0.25, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
    const double pressed = world_stable_dt(&w);
    ck_within("pressed", pressed / at_rest, 0.5, 1e-13); /* waves are half as fast in what is denser */
    world_close(&w);
  }
}
END_TEST

/* ---- refusals ------------------------------------------------------------------------------------------ */
START_TEST(refusals) {
  mpm_context *c = context_with(1, 0, NULL);
  mpm_grid_desc d = grid_desc(2, 8, 0.25);
  mpm_grid *grid;
  mpm_particles *set;
  d.total_lagrangian = 2;
  ck_refused(c, mpm_grid_create(c, &d, &grid), MPM_E_ARG, "total_lagrangian is 2");
  d.total_lagrangian = 1;
  ck_ok(c, mpm_grid_create(c, &d, &grid));
  mpm_material *liquid, *rubber;
  const mpm_param of_water[] = {{"density", 1e3}, {"bulk_modulus", 1e6}, {"viscosity", 1e-3}};
  ck_ok(c, mpm_material_create(c, "newtonian_fluid", of_water, 3, &liquid));
  ck_refused(c, mpm_particles_create(c, grid, liquid, &set), MPM_E_UNSUPPORTED, "use total_lagrangian = 0");
  const mpm_param of_rubber[] = {{"density", 1e3}, {"E", 1e6}, {"nu", 0.3}};
  ck_ok(c, mpm_material_create(c, "neo_hookean", of_rubber, 3, &rubber));
  ck_ok(c, mpm_particles_create(c, grid, rubber, &set));
  mpm_stepper *s;
  ck_ok(c, mpm_stepper_create(c, grid, NULL, &s));
  ck_ok(c, mpm_stepper_add(s, set));
  ck_refused(c, mpm_stepper_set_body(s, set, 1), MPM_E_UNSUPPORTED, "bodies meet in space");
  ck_ok(c, mpm_stepper_set_body(s, set, 0));
  const double low[] = {0.5, 0.5}, high[] = {1.5, 1.5}, out[] = {9.0, 1.0}, volume = 1e-3;
  const int32_t two[] = {2, 2};
  ck_ok(c, mpm_particles_fill_box(set, low, high, two, NULL, NULL));
  ck_refused(c, mpm_particles_set_geostatic(set, 1, -9.81, 2.0, 0.5, 0.0), MPM_E_UNSUPPORTED,
             "use total_lagrangian = 0");
  ck_refused(c, mpm_stepper_set_wall(s, MPM_X_MAX, MPM_WALL_OPEN, 0.0), MPM_E_UNSUPPORTED, "nothing leaves");
  ck_ok(c, mpm_stepper_set_wall(s, MPM_X_MAX, MPM_WALL_NONE, 0.0));
  ck_refused(c, mpm_particles_add(set, 1, out, NULL, &volume, NULL, NULL, NULL), MPM_E_ARG,
             "reference_position");
  ck_refused(c, mpm_particles_set_all(set, "reference_position", MPM_F64, 2, out), MPM_E_ARG,
             "inside the grid");
  ck_ok(c, mpm_particles_set_all(set, "position", MPM_F64, 2, out));
  ck_ok(c, mpm_stepper_destroy(s));
  ck_ok(c, mpm_particles_destroy(set));
  ck_ok(c, mpm_material_destroy(liquid));
  ck_ok(c, mpm_material_destroy(rubber));
  ck_ok(c, mpm_grid_destroy(grid));
  ck_ok(c, mpm_context_destroy(c));
}
END_TEST

/* A state loads where the grid says the same alone. */
START_TEST(states_know_their_grid) {
  for (int32_t from = 0; from < 2; ++from) {
    world a, b;
    world_desc desc = world_default(2, 8, 0.25);
    desc.stepper.reference_positions = 1;
    desc.grid.total_lagrangian = from;
    world_fill_cube(&a, world_open(&a, &desc), 0.7, 1.3);
    const saved_state state = world_save(&a);
    desc.grid.total_lagrangian = !from;
    world_open(&b, &desc);
    ck_refused(&b, mpm_state_load(b.stepper, state.data, state.bytes), MPM_E_FORMAT,
               from ? "total_lagrangian is 1 there, 0 here" : "total_lagrangian is 0 there, 1 here");
    free(state.data);
    world_close(&a);
    world_close(&b);
  }
}
END_TEST

/* ---- every combination --------------------------------------------------------------------------------- */
static combination *list;
static int32_t listed;

START_TEST(combination_works) {
  check_geometry(&list[_i], _i % 3, 1);
  if (_i % 3) check_geometry(&list[_i], MPM_PLANE_STRAIN, 1);
}
END_TEST

Suite *lagrangian_suite(void);
Suite *lagrangian_suite(void) {
  Suite *suite = suite_create("lagrangian");
  TCase *parts = tcase_create("parts");
  if (!list) list = list_combinations(&listed);
  tcase_add_loop_test(parts, linear_motion, 0, 3 * BROAD);
  tcase_add_loop_test(parts, forces_do_the_power_of_stresses, 0, 3 * BROAD);
  tcase_add_loop_test(parts, areas_follow_F, 0, 2);
  tcase_add_loop_test(parts, pressure_on_what_has_moved, 0, 2 * BROAD);
  tcase_add_loop_test(parts, obstacles_meet_what_has_moved, 0, 6);
  tcase_add_loop_test(parts, halves_follow_F, 0, 2);
  tcase_add_loop_test(parts, contact_is_objective, 0, 4);
  tcase_add_test(parts, stretched_bodies_rest);
  tcase_add_test(parts, sums_over_particles);
  tcase_add_test(parts, ground_begins_anew);
  tcase_add_test(parts, sections_of_rings);
  tcase_add_loop_test(parts, begun_anew, 0, BROAD);
  tcase_add_test(parts, periodic_axes);
  tcase_add_test(parts, stable_step);
  tcase_add_test(parts, refusals);
  tcase_add_test(parts, states_know_their_grid);
  tcase_set_timeout(parts, 60);
  suite_add_tcase(suite, parts);
  TCase *implicit = tcase_create("implicit");
  tcase_add_loop_test(implicit, tangents, 0, IMPLICIT_CASES * BASES);
  tcase_add_loop_test(implicit, implicit_threads, 0, 3 * BASES);
  tcase_set_timeout(implicit, 60);
  suite_add_tcase(suite, implicit);
  TCase *all = tcase_create("combinations");
  tcase_add_loop_test(all, combination_works, 0, listed);
  tcase_set_timeout(all, 60);
  suite_add_tcase(suite, all);
  return suite;
}
