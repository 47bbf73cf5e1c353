/* Conduction on the grid: exact solutions, what is kept, the balance, faces, surfaces, and that nothing else
 * matters. */
#include "heat.h"

/* ---- exact solutions ----------------------------------------------------------------------------------- */
/* A bar that fills the grid along x, of unit diffusivity, and hardly moves. */
static mpm_particles *open_bar(world *w, int32_t dim, int64_t cells, const basis_option *basis,
                               int32_t per_cell) {
  world_desc desc = world_default(dim, cells, 1.0 / (double)cells);
  use_basis(basis, &desc.grid);
  double high[3] = {1.0, 0.0, 0.0};
  for (int32_t k = 1; k < dim; ++k) {
    desc.grid.cells[k] = 3;
    high[k] = 3.0 / (double)cells;
  }
  desc.law.E = 1e-6;
  desc.law.density = 2.0;
  mpm_particles *set = world_open(w, &desc);
  const double low[3] = {0.0, 0.0, 0.0};
  world_fill(w, set, low, high, per_cell);
  const mpm_heat_desc heat = heat_desc(3.0, 6.0);
  ck_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
  return set;
}

typedef double (*exact_fn)(double x, double t);

static double sine(double x, double t) {
  return sin(PI * x) * exp(-PI * PI * t);
}

static double step_at_ends(double x, double t) {
  return erfc(0.5 * x / sqrt(t)) + erfc(0.5 * (1.0 - x) / sqrt(t));
}

static void put_exact(const world *w, mpm_particles *set, exact_fn exact) {
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(w, set, "position", w->dim);
  for (int64_t p = 0; p < n; ++p) x[p] = exact(x[p], 0.0);
  put(w, set, "temperature", 1, x);
  free(x);
}

static double error_of(const world *w, const mpm_particles *set, exact_fn exact, double t) {
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(w, set, "position", w->dim), *T = fetch(w, set, "temperature", 1), sum = 0.0;
  for (int64_t p = 0; p < n; ++p) sum += pow(T[p] - exact(x[p], t), 2.0);
  free(x), free(T);
  return sqrt(sum / (double)n);
}

static void run_to(world *w, double t, double share) {
  const double most = share * heat_dt(w, 1.0) * w->dim;
  const int32_t steps = (int32_t)ceil(t / most - 1e-9);
  for (int32_t i = 0; i < steps; ++i) world_step(w, t / steps);
}

static const basis_option quadratic = {MPM_BSPLINE2, MPM_BOUNDARY_GHOST, 0.5, "quadratic"};

/* The errors of a sine that decays are those of the scheme by itself, computed apart from the library. */
START_TEST(sine_decays) {
  static const double errors[] = {1.31387e-2, 3.27188e-3, 8.13332e-4};
  for (int32_t i = 0; i < 3; ++i) {
    world w;
    mpm_particles *set = open_bar(&w, 1, 8 << i, &quadratic, 2);
    put_exact(&w, set, sine);
    hold_ends(&w, 0.0);
    run_to(&w, 0.05, 0.5);
    ck_within("sine", error_of(&w, set, sine, 0.05), errors[i], 1e-3 * errors[i]);
    world_close(&w);
  }
}
END_TEST

/* Every basis has second order, explicit and implicit; but open knots, whose last functions have their mass
 * where they do not stand, lose some of it by capacities that are lumped. */
START_TEST(every_basis_converges) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t dim = 1 + _i / BASES % 3, implicit = _i / BASES / 3;
  double error[2];
  for (int32_t i = 0; i < 2; ++i) {
    world w;
    mpm_particles *set = open_bar(&w, dim, (dim == 3 ? 6 : 8) << i, basis, 2);
    put_exact(&w, set, sine);
    hold_ends(&w, 0.0);
    if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-12));
    run_to(&w, 0.05, implicit ? 2.0 / dim : 0.5 / dim);
    error[i] = error_of(&w, set, sine, 0.05);
    world_close(&w);
  }
  show("%s %d-D %s: %.3e %.3e, order %.2f\n", basis->name, dim, implicit ? "implicit" : "explicit", error[0],
       error[1], log2(error[0] / error[1]));
  ck_between(basis->name, log2(error[0] / error[1]), basis->boundary == MPM_BOUNDARY_OPEN_KNOT ? 1.1 : 1.6,
             3.2);
}
END_TEST

/* Where a temperature is prescribed suddenly, that reaches the particles, and once. */
START_TEST(sudden_step) {
  static const double most[] = {4.6e-2, 2.0e-2, 1.05e-2};
  for (int32_t i = 0; i < 3; ++i) {
    world w;
    mpm_particles *set = open_bar(&w, 1, 10 << i, &quadratic, 2);
    hold_ends(&w, 1.0);
    run_to(&w, 0.01, 0.5);
    ck_between("erfc", error_of(&w, set, step_at_ends, 0.01), 0.0, most[i]);
    world_close(&w);
  }
}
END_TEST

/* The same jump may come later: in a bar that is warm throughout the faces cool down by 1. */
START_TEST(later_step) {
  world w;
  const double warm = 5.0;
  mpm_particles *set = open_bar(&w, 1, 20, &quadratic, 2);
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &warm));
  hold_ends(&w, warm);
  run_to(&w, 0.01, 0.5);
  ck_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));
  double *T = fetch(&w, set, "temperature", 1);
  for (int64_t p = 0; p < 40; ++p) ck_within("still warm", T[p], warm, 1e-14 * warm);
  hold_ends(&w, warm - 1.0);
  run_to(&w, 0.01, 0.5);
  double *x = fetch(&w, set, "position", 1), sum = 0.0;
  free(T);
  T = fetch(&w, set, "temperature", 1);
  for (int64_t p = 0; p < 40; ++p) sum += pow(warm - step_at_ends(x[p], 0.01) - T[p], 2.0);
  ck_between("erfc", sqrt(sum / 40.0), 0.0, 2.0e-2);
  free(T), free(x);
  world_close(&w);
}
END_TEST

/* What is tied for heat alone begins each step anew: a wall that the body does not touch, but whose mirror
 * nodes are those of nodes that it does, makes no difference, whatever it does to velocities. */
START_TEST(mirrors_begin_anew) {
  const double x[] = {1.6, 1.9, 2.2, 2.7, 3.2}, volume[] = {0.5, 0.5, 0.5, 0.5, 0.5},
               start[] = {5, 6, 7, 8, 9};
  double *T[2];
  for (int32_t i = 0; i < 2; ++i) {
    world w;
    world_desc desc = world_default(1, 12, 1.0);
    desc.law.E = 1e-6;
    mpm_particles *set = world_open(&w, &desc);
    ck_ok(&w, mpm_particles_add(set, 5, x, NULL, volume, NULL, NULL, NULL));
    const mpm_heat_desc heat = heat_desc(3.0, 6.0);
    ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
    put(&w, set, "temperature", 1, start);
    ck_ok(&w, mpm_stepper_set_conduction(w.stepper, _i, 1e-12));
    if (i) ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 100.0));
    for (int32_t k = 0; k < 5; ++k) world_step(&w, 1.0);
    T[i] = fetch(&w, set, "temperature", 1);
    world_close(&w);
  }
  for (int64_t p = 0; p < 5; ++p) ck_within("apart", T[1][p], T[0][p], 1e-9);
  free(T[0]), free(T[1]);
}
END_TEST

/* A face between periodic axes meets the material around their seam as it meets the rest. */
START_TEST(faces_meet_images) {
  const int32_t dim = 2 + _i / 2, implicit = _i % 2;
  world w;
  world_desc desc = world_default(dim, 8, 0.25);
  double high[3] = {2.0, 2.0, 2.0}, low[3] = {0.0, 0.0, 0.0};
  for (int32_t k = 1; k < dim; ++k) desc.grid.periodic[k] = 1;
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill(&w, set, low, high, 2);
  const mpm_heat_desc heat = heat_desc(3.0, 6.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  ck_ok(&w, mpm_stepper_set_conduction(w.stepper, implicit, 1e-14));
  ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 10.0));
  world_step(&w, 1e-3);
  double *x = fetch(&w, set, "position", dim), *T = fetch(&w, set, "temperature", 1), largest_there = 0.0;
  for (int64_t p = 0; p < n; ++p) largest_there = fmax(largest_there, T[p]);
  for (int64_t p = 0; p < n; ++p)
    if (x[p] < 0.125) ck_within("along the face", T[p], largest_there, 1e-9);
  ck_between("jump", largest_there, 6.0, 10.0);
  free(x), free(T);
  world_close(&w);
}
END_TEST

/* Sets that have heat again meet the faces as they did the first time. */
START_TEST(faces_meet_anew) {
  world w;
  const double cold = 0.0;
  mpm_heat_info info[2];
  mpm_particles *set = open_bar(&w, 1, 8, &quadratic, 2);
  ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 100.0));
  for (int32_t i = 0; i < 2; ++i) {
    const mpm_heat_desc heat = heat_desc(3.0, 6.0);
    ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, NULL));
    ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &cold));
    ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
    world_step(&w, 0.2 * heat_dt(&w, 1.0));
    info[i] = heat_told(&w);
  }
  ck_holds(info[0].gained > 0.0);
  ck_within("anew", info[1].gained, info[0].gained, 1e-9 * info[0].gained);
  world_close(&w);
}
END_TEST

/* A bar at 1 whose faces are brought to 2, one at once and the others little by little, and held there: in
 * the end it has 2 everywhere, and has gained what that takes. What is left by then falls further, with open
 * knots slowly. */
START_TEST(changed_faces_come_through) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t dim = 1 + _i / BASES % 3, implicit = _i / BASES / 3, ramp = 20;
  const double exact = basis->boundary == MPM_BOUNDARY_OPEN_KNOT ? 2e-2 : 5e-3, start = 1.0;
  world w;
  mpm_particles *set = open_bar(&w, dim, 6, basis, 2);
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &start));
  if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-14));
  const double capacity = 3.0 * mass_of(&w, set), dt = implicit ? 0.04 : 0.9 * heat_dt(&w, 1.0);
  for (int32_t k = 0; k * dt < (implicit ? 8.0 : 3.0); ++k) {
    for (int32_t face = 0; face < 2 * dim; ++face)
      ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, face, MPM_HEAT_WALL_TEMPERATURE,
                                          face && k < ramp ? 1.0 + (k + 1.0) / ramp : 2.0));
    world_step(&w, dt);
    const mpm_heat_info info = heat_told(&w);
    ck_within(basis->name, heat_missing(&info), 0.0, 1e-12 * capacity);
  }
  const int64_t n = mpm_particles_count(set);
  double *T = fetch(&w, set, "temperature", 1);
  for (int64_t p = 0; p < n; ++p) ck_within(basis->name, T[p], 2.0, exact);
  ck_within(basis->name, heat_told(&w).gained_total, capacity, exact * capacity);
  free(T);
  world_close(&w);
}
END_TEST

/* Two cells between faces of different temperature: one node has mirrors at both, and the field that is left
 * is linear. */
START_TEST(mirrors_at_both_faces) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t implicit = _i / BASES;
  if (basis->boundary == MPM_BOUNDARY_OPEN_KNOT) return;
  world w;
  mpm_particles *set = open_bar(&w, 1, 2, basis, 2);
  if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-14));
  ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 2.0));
  ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MAX, MPM_HEAT_WALL_TEMPERATURE, 5.0));
  for (int32_t k = 0; k < 1000; ++k) world_step(&w, 0.5 * heat_dt(&w, 1.0));
  double *x = fetch(&w, set, "position", 1), *T = fetch(&w, set, "temperature", 1);
  for (int64_t p = 0; p < 4; ++p) ck_within(basis->name, T[p], 2.0 + 3.0 * x[p], 1e-6);
  free(x), free(T);
  world_close(&w);
}
END_TEST

/* Nodes around a face show what is prescribed there after the step that changes it, and its mirror image. */
START_TEST(nodes_mirror_at_the_face) {
  const double start = 1.0, later[] = {3.0, 5.0};
  int64_t n;
  world w;
  mpm_particles *set = open_bar(&w, 1, 6, &quadratic, 2);
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &start));
  ck_ok(&w, mpm_stepper_set_conduction(w.stepper, _i, 1e-14));
  for (int32_t k = 0; k < 2; ++k) {
    hold_ends(&w, later[k]);
    world_step(&w, 0.2 * heat_dt(&w, 1.0));
    double *T = fetch_nodes(&w, "temperature", &n), *x = fetch_nodes(&w, "position", &n);
    int32_t seen = 0;
    for (int64_t i = 0; i < n; ++i)
      for (int64_t j = 0; j < n; ++j) {
        if (fabs(x[i] + x[j]) > 1e-12) continue;
        ck_within("mirrored", T[i] + T[j], 2.0 * later[k], 1e-12);
        ++seen;
      }
    ck_assert_int_eq(seen, 3);
    free(T), free(x);
  }
  world_close(&w);
}
END_TEST

/* A linear field between two faces is at rest, from the first step on. */
START_TEST(linear_field_stays) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t dim = 1 + _i / BASES % 3, implicit = _i / BASES / 3;
  if (is_gimp(basis->basis)) return; /* domains at the faces reach beyond the nodes that mirror */
  world w;
  mpm_particles *set = open_bar(&w, dim, 6, basis, 2);
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(&w, set, "position", dim);
  for (int64_t p = 0; p < n; ++p) x[p] = 20.0 - 7.0 * x[p];
  put(&w, set, "temperature", 1, x);
  ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 20.0));
  ck_ok(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MAX, MPM_HEAT_WALL_TEMPERATURE, 13.0));
  if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-13));
  for (int32_t i = 0; i < 3; ++i) world_step(&w, heat_dt(&w, 1.0));
  double *T = fetch(&w, set, "temperature", 1), area = 1.0;
  double worst = 0.0;
  for (int64_t p = 0; p < n; ++p) worst = fmax(worst, fabs(T[p] - x[p]));
  show("%s %d-D: %.2e\n", basis->name, dim, worst);
  if (basis->boundary == MPM_BOUNDARY_GHOST) ck_within(basis->name, worst, 0.0, 1.0);
  for (int32_t k = 1; k < dim; ++k) area *= 0.5;
  const mpm_heat_info info = heat_told(&w);
  ck_within(basis->name, heat_missing(&info), 0.0, 1e-12 * 42.0 * area);
  free(x), free(T);
  world_close(&w);
}
END_TEST

/* ---- what is kept -------------------------------------------------------------------------------------- */
/* The balance of a cloud closes in every method, and the sum of mass, capacity and temperature is the heat.
 * */
START_TEST(balance_closes) {
  const method *how = broad_methods[_i % BROAD];
  const int32_t dim = 1 + _i / BROAD % 3, implicit = _i / BROAD / 3;
  world w;
  if (dim == 1 && how->remedy) return;
  world_desc desc = world_with(how, dim, 8, 0.25);
  desc.grid.total_lagrangian = _i % 2 && how->basis != MPM_CPGIMP;
  desc.law.E = 1e3;
  mpm_particles *set = open_cloud(&w, &desc, 5 + (uint64_t)_i);
  equip_faces(&w);
  world_walls(&w, MPM_WALL_SLIP, 0.0);
  mpm_surface_desc d = load_desc();
  mpm_surface *s = put_surface(&w, &d);
  const double at[] = {0.9, 0.9, 0.9}, normal[] = {1.0, 0.0, 0.0};
  ck_ok(&w, mpm_surface_add(s, 1, at, normal, NULL));
  ck_ok(&w, mpm_surface_set_heat(s, 40.0, 3.0, 400.0));
  if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-12));
  double before = heat_told(&w).heat, gained = 0.0;
  const double scale = fabs(before), dt = fmin(0.1 * world_stable_dt(&w), 1e-3);
  for (int32_t i = 0; i < 6; ++i) {
    world_step(&w, dt);
    const mpm_heat_info info = heat_told(&w);
    ck_within(how->name, heat_missing(&info), 0.0, (implicit ? 1e-11 : 1e-13) * scale);
    ck_within(how->name, info.heat - before, info.gained, 1e-12 * scale);
    ck_holds(info.walls[0] != 0.0 && info.surfaces != 0.0 && info.sources > 0.0 && info.walls[1] == 0.0);
    ck_holds(implicit ? info.iterations > 0 : info.iterations == 0);
    before = info.heat;
    gained += info.gained;
    ck_within(how->name, info.gained_total, gained, 1e-12 * scale);
  }
  (void)set;
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A body of one temperature keeps it, and one that conducts nothing keeps every bit while it flies. */
START_TEST(motion_carries_temperatures) {
  const method *how = broad_methods[_i % BROAD];
  const int32_t dim = 1 + _i / BROAD;
  if (dim == 1 && how->remedy) return;
  world w;
  const world_desc desc = world_with(how, dim, 12, 0.25);
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.3, 1.1);
  mpm_heat_desc heat = heat_desc(2.0, 0.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  const double v[] = {1.0, 0.7, -0.1}, even = 293.15;
  double *T = malloc((size_t)n * sizeof *T);
  for (int64_t p = 0; p < n; ++p) T[p] = noise_at((uint64_t)p);
  put(&w, set, "temperature", 1, T);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
  const double dt = 0.2 * world_stable_dt(&w);
  for (int32_t i = 0; i < 10; ++i) world_step(&w, dt);
  double *now = fetch(&w, set, "temperature", 1);
  ck_assert_mem_eq(now, T, (size_t)n * sizeof *T);
  free(now);
  heat.conductivity = 10.0;
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &even));
  for (int32_t i = 0; i < 10; ++i) world_step(&w, dt);
  now = fetch(&w, set, "temperature", 1);
  for (int64_t p = 0; p < n; ++p) ck_within(how->name, now[p], even, 1e-12 * even);
  free(now), free(T);
  world_close(&w);
}
END_TEST

/* Halves keep the temperature, and pairs the heat. */
START_TEST(parts_keep_heat) {
  world w;
  const world_desc desc = world_default(2, 8, 0.25);
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.6, 1.4);
  const mpm_heat_desc heat = heat_desc(2.0, 0.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  double *T = fetch(&w, set, "temperature", 1), *m = fetch(&w, set, "mass", 1);
  for (int64_t p = 0; p < n; ++p) T[p] = 300.0 + (double)p, m[p] *= 1.0 + 0.5 * noise_at((uint64_t)p);
  put(&w, set, "temperature", 1, T);
  put(&w, set, "mass", 1, m);
  const double all = heat_told(&w).heat;
  mpm_adaption_desc split, merge;
  ck_ok(&w, mpm_adaption_desc_init(&split, sizeof split));
  merge = split;
  split.least_edge = 1e-6, split.split_edge = 2e-6;
  merge.max_per_cell = 1, merge.merge_distance = 2.0, merge.merge_tolerance = 1e6;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &split));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  const int64_t parts = mpm_particles_count(set);
  ck_assert_int_gt(parts, n);
  ck_within("split", heat_told(&w).heat, all, 1e-13 * all);
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &merge));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_lt(mpm_particles_count(set), parts);
  ck_within("merge", heat_told(&w).heat, all, 1e-13 * all);
  free(T), free(m);
  world_close(&w);
}
END_TEST

/* Heat does not cross between bodies, nor to a set that is not described, and crosses between sets of one. */
START_TEST(bodies_and_sets) {
  for (int32_t kind = 0; kind < 3; ++kind) {
    world w;
    world_desc desc = world_default(2, 8, 0.25);
    desc.sets = 2;
    world_open(&w, &desc);
    const double low[] = {0.5, 0.5}, middle[] = {1.0, 1.0}, low2[] = {1.0, 0.5}, high[] = {1.5, 1.0};
    world_fill(&w, w.set[0], low, middle, 2);
    world_fill(&w, w.set[1], low2, high, 2);
    const mpm_heat_desc heat = heat_desc(2.0, 100.0);
    for (int32_t m = 0; m < (kind == 2 ? 1 : 2); ++m)
      ck_ok(&w, mpm_stepper_set_heat(w.stepper, w.set[m], &heat));
    if (kind == 1) ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[1], 1));
    const double hot = 10.0;
    ck_ok(&w, mpm_particles_set_all(w.set[0], "temperature", MPM_F64, 1, &hot));
    for (int32_t i = 0; i < 3; ++i) world_step(&w, 1e-4);
    double *T = fetch(&w, w.set[0], "temperature", 1);
    double smallest = hot;
    for (int64_t p = 0; p < mpm_particles_count(w.set[0]); ++p) smallest = fmin(smallest, T[p]);
    if (kind == 0)
      ck_holds(smallest < hot - 1e-5);
    else
      ck_within("apart", smallest, hot, 1e-13 * hot);
    free(T);
    world_close(&w);
  }
}
END_TEST

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* A flux gives its power times the area; a film cools a body that conducts well by the rule of one unknown.
 * */
START_TEST(flux_and_film) {
  for (int32_t implicit = 0; implicit < 2; ++implicit) {
    world w;
    world_desc desc = world_default(2, 12, 0.25);
    mpm_particles *set = world_open(&w, &desc);
    const double low[] = {1.0, 1.0}, high[] = {2.0, 2.0}, at[] = {2.0, 1.0, 2.0, 2.0}, hot = 400.0;
    world_fill(&w, set, low, high, 2);
    const mpm_heat_desc heat = heat_desc(2.0, 1e9);
    ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
    ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &hot));
    mpm_surface_desc d = load_desc();
    mpm_surface *s = put_surface(&w, &d);
    ck_ok(&w, mpm_surface_add_polyline(s, 2, at, 0, 0.125, NULL, NULL));
    if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-13));
    const double dt = implicit ? 1e-3 : 0.9 * heat_dt(&w, 1e9 / 2e3), capacity = 2.0 * mass_of(&w, set);
    ck_ok(&w, mpm_surface_set_heat(s, 5.0, 0.0, 0.0));
    world_step(&w, dt);
    mpm_heat_info info = heat_told(&w);
    ck_within("flux", info.surfaces, 5.0 * dt, 1e-12 * 5.0 * dt);
    ck_within("flux", info.gained, 5.0 * dt, 1e-9 * 5.0 * dt + 1e-13 * capacity * hot);
    const double film = 1e5, cold = 300.0;
    ck_ok(&w, mpm_surface_set_heat(s, 0.0, film, cold));
    const double start = info.heat / capacity, rate = film * dt / capacity;
    world_step(&w, dt);
    info = heat_told(&w);
    const double wanted = -(start - cold) * (implicit ? film * dt / (1.0 + rate) : film * dt);
    ck_within("film", info.surfaces, wanted, 2e-3 * fabs(wanted));
    ck_within("film", heat_missing(&info), 0.0, 1e-12 * capacity * hot);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* Makes a step of a block at 300 near a wall of the motion that is insulated, with a film to 300 and a flux.
 * Returns temperatures; the caller frees them. */
static double *heat_near_wall(const basis_option *basis, int32_t implicit, double gap, int32_t wall,
                              double flux) {
  const double low[] = {gap, 0.75}, high[] = {gap + 1.25, 2.0}, at[] = {gap, gap + 1.25, 2.0, 2.0},
               warm = 300.0, dt = 0.1;
  world w;
  world_desc desc = world_default(2, 12, 0.25);
  use_basis(basis, &desc.grid);
  desc.law.E = 1e-6;
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, low, high, 2);
  world_walls(&w, wall, 0.0);
  const mpm_heat_desc heat = heat_desc(2.0, 6.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &warm));
  if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-14));
  mpm_surface_desc d = load_desc();
  mpm_surface *s = put_surface(&w, &d);
  ck_ok(&w, mpm_surface_add_polyline(s, 2, at, 0, 0.0625, NULL, NULL));
  ck_ok(&w, mpm_surface_set_heat(s, flux, 50.0, warm));
  world_step(&w, dt);
  const mpm_heat_info info = heat_told(&w);
  const double rounding = 1e-13 * info.heat;
  ck_within(basis->name, heat_missing(&info), 0.0, implicit ? 10.0 * rounding : rounding);
  if (flux == 0.0 || !implicit) {
    ck_within(basis->name, info.surfaces, 1.25 * dt * flux, 1e-12 * 1.25 * dt * (flux + 50.0 * warm));
    ck_within(basis->name, info.gained, 1.25 * dt * flux, rounding);
  }
  double *T = fetch(&w, set, "temperature", 1);
  drop_surface(&w, s);
  world_close(&w);
  return T;
}

/* Surfaces see what particles reach in the heat, whatever the walls of the motion mirror. */
START_TEST(surfaces_near_insulated_walls) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t implicit = _i / BASES;
  for (int32_t k = 0; k < 4; ++k) {
    const double gap = k % 2 ? 0.3 * 0.25 : 0.0, flux = k / 2 ? 1e4 : 0.0;
    double *free_there = heat_near_wall(basis, implicit, gap, MPM_WALL_NONE, flux);
    double *slip = heat_near_wall(basis, implicit, gap, MPM_WALL_SLIP, flux);
    double *fixed = heat_near_wall(basis, implicit, gap, MPM_WALL_FIXED, flux);
    for (int64_t p = 0; p < 100; ++p) {
      ck_assert(slip[p] == free_there[p] && fixed[p] == free_there[p]);
      if (flux == 0.0) ck_within(basis->name, slip[p], 300.0, 1e-10);
    }
    free(free_there), free(slip), free(fixed);
  }
}
END_TEST

/* Explicit conduction takes no step in which a film takes more than the difference to the ambient; below that
 * the surface comes to the ambient without passing it. Implicit conduction takes both. */
START_TEST(films_bound_the_step) {
  world w;
  world_desc desc = world_default(2, 12, 0.25);
  desc.law.E = 1e-6;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {1.0, 1.0}, high[] = {2.0, 2.0}, at[] = {2.0, 1.0, 2.0, 2.0}, hot = 400.0,
               cold = 300.0;
  const int64_t n = world_fill(&w, set, low, high, 2);
  const mpm_heat_desc heat = heat_desc(2.0, 1e-3);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &hot));
  mpm_surface_desc d = load_desc();
  mpm_surface *s = put_surface(&w, &d);
  ck_ok(&w, mpm_surface_add_polyline(s, 2, at, 0, 0.125, NULL, NULL));
  const double dt = 1e-3, layer = 2.0 * desc.law.density * 0.125 / dt; /* what takes all from a layer */
  ck_ok(&w, mpm_surface_set_heat(s, 0.0, 4.0 * layer, cold));
  ck_refused(&w, mpm_step(w.stepper, dt, NULL), MPM_CUT_DT, "in a film that takes more");
  double *T = fetch(&w, set, "temperature", 1);
  for (int64_t p = 0; p < n; ++p) ck_assert(T[p] == hot);
  free(T);
  if (_i) {
    ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-12));
  } else {
    ck_ok(&w, mpm_surface_set_heat(s, 0.0, 0.3 * layer, cold));
  }
  double first = 0.0, last = 0.0;
  for (int32_t i = 0; i < 200; ++i) {
    world_step(&w, dt);
    last = heat_told(&w).surfaces;
    ck_holds(last < 1e-9);
    if (!i) first = last;
  }
  show("film: %g, then %g\n", first, last);
  ck_holds(first < -1.0 && fabs(last) < 1e-3 * fabs(first));
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

Suite *heat_suite(void);
Suite *heat_suite(void) {
  Suite *suite = suite_create("heat");
  TCase *grid = tcase_create("grid");
  tcase_add_test(grid, sine_decays);
  tcase_add_loop_test(grid, every_basis_converges, 0, 6 * BASES);
  tcase_add_test(grid, sudden_step);
  tcase_add_test(grid, later_step);
  tcase_add_test(grid, faces_meet_anew);
  tcase_add_loop_test(grid, faces_meet_images, 0, 4);
  tcase_add_loop_test(grid, mirrors_begin_anew, 0, 2);
  tcase_add_loop_test(grid, changed_faces_come_through, 0, 6 * BASES);
  tcase_add_loop_test(grid, mirrors_at_both_faces, 0, 2 * BASES);
  tcase_add_loop_test(grid, nodes_mirror_at_the_face, 0, 2);
  tcase_add_loop_test(grid, linear_field_stays, 0, 6 * BASES);
  tcase_add_loop_test(grid, balance_closes, 0, 6 * BROAD);
  tcase_add_loop_test(grid, motion_carries_temperatures, 0, 3 * BROAD);
  tcase_add_test(grid, parts_keep_heat);
  tcase_add_test(grid, bodies_and_sets);
  tcase_add_test(grid, flux_and_film);
  tcase_add_loop_test(grid, surfaces_near_insulated_walls, 0, 2 * BASES);
  tcase_add_loop_test(grid, films_bound_the_step, 0, 2);
  tcase_set_timeout(grid, 120);
  suite_add_tcase(suite, grid);
  add_heat_laws(suite);
  add_heat_exact(suite);
  add_heat_states(suite);
  return suite;
}
