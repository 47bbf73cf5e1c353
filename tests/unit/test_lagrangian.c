/* Total Lagrangian grids: gradient, forces, what moves and what stays, surfaces and refusals. */
#include "geometry.h"
#include "lagrangian.h"
#include "reference.h"
#include "tables.h"

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
  const uint64_t hash = world_step_again(&w, 2e-3);
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
  world_step_again(&w, 1e-5);
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

/* Gives all particles the part of F that their grid has. */
static void set_gradient(world *w, mpm_particles *set, const double (*F)[3]) {
  double own[9];
  for (int32_t e = 0; e < 9; ++e)
    own[e] = e / 3 < w->dim && e % 3 < w->dim ? F[e / 3][e % 3] : e % 4 ? 0.0 : 1.0;
  ck_ok(w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, own));
}

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
    const double still[3] = {0.0, 0.0, 0.0};
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, still));
    ck_ok(&w, mpm_step(w.stepper, 1e-3 * pressed, NULL)); /* without stress nothing moves */
    ck_within("a step later", world_stable_dt(&w), pressed, 1e-13 * pressed);
    for (int32_t k = 0; k < 8; ++k) {
      const double general[3][3] = {{1.1 + 0.13 * k, 0.5, 0.1}, {0.3, 1.0, 0.2}, {0.0, 0.7, 1.3}};
      set_gradient(&w, set, general);
      ck_ok(&w, mpm_step(w.stepper, 1e-3 * pressed, NULL));
      const double by_step = world_stable_dt(&w);
      ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, still)); /* asks anew */
      ck_holds(world_stable_dt(&w) == by_step);
    }
    world_close(&w);
  }
}
END_TEST

/* Waves and viscosity of a law of the host. */
static double host_speed, host_viscosity;
static mpm_status loose_law(void *user, const mpm_material_batch *b) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) {
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + p] = 0.0;
    b->wave_speed[p] = host_speed;
    b->kinematic_viscosity[p] = host_viscosity;
    b->energy[p] = 0.0;
  }
  return 0;
}

START_TEST(stable_step_of_host_laws) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    world_desc desc = total_with(broad_methods[0], dim);
    desc.law = (world_law){.density = 1e3, .stress = loose_law};
    host_speed = 900.0, host_viscosity = 0.0;
    mpm_particles *set = open_block_with(&w, &desc);
    const double F[9] = {0.25, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, h = w.desc.grid.spacing[0];
    ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
    ck_within("waves", world_stable_dt(&w), h / 3600.0, 1e-14 * h / 3600.0);
    const double stretch = dim == 1 ? 0.5 : dim == 2 ? sqrt(1.25) : 2.0; /* rows of F^-1 F^-T: 9/16, 5/4, 4 */
    set_gradient(&w, set, (const double[3][3]){{2.0, 0.5, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.5}});
    ck_within("shear", world_stable_dt(&w) * 900.0 * stretch, h, 1e-14 * h);
    ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
    host_viscosity = 7e3;
    ck_ok(&w, mpm_step(w.stepper, 1e-9, NULL));
    const double wanted = h * h / (2.0 * dim * 16.0 * host_viscosity);
    ck_within("viscosity", world_stable_dt(&w), wanted, 1e-13 * wanted);
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
  tcase_add_loop_test(parts, halves_follow_F, 0, 2);
  tcase_add_test(parts, sums_over_particles);
  tcase_add_test(parts, ground_begins_anew);
  tcase_add_test(parts, sections_of_rings);
  tcase_add_loop_test(parts, begun_anew, 0, BROAD);
  tcase_add_test(parts, periodic_axes);
  tcase_add_test(parts, stable_step);
  tcase_add_test(parts, stable_step_of_host_laws);
  tcase_add_test(parts, refusals);
  tcase_add_test(parts, states_know_their_grid);
  suite_add_tcase(suite, parts);
  add_lagrangian_contact(suite);
  TCase *implicit = tcase_create("implicit");
  tcase_add_loop_test(implicit, tangents, 0, IMPLICIT_CASES * BASES);
  tcase_add_loop_test(implicit, implicit_threads, 0, 3 * BASES);
  tcase_set_timeout(implicit, 60);
  suite_add_tcase(suite, implicit);
  TCase *all = tcase_create("combinations");
  add_table(all, wide_case(suite, "more combinations"), combination_works, listed);
  tcase_set_timeout(all, 60);
  suite_add_tcase(suite, all);
  return suite;
}
