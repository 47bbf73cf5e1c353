/* The locking remedy with laws whose shear makes pressure: forces do the work of the stress on what the law
 * sees, their derivative is the matrix of implicit steps, and nothing else changes. */
#include "implicit.h"
#include "tables.h"
#include "material/laws.h"

static const double h = 0.1;

/* Elastic up to a large stress, or sand that yields and dilates, or clay. */
static const mpm_param firm[] = {{"E", 1e5},    {"nu", 0.3},   {"density", 1e3},
                                 {"phi", 30.0}, {"psi", 30.0}, {"cohesion", 1e6}};
static const mpm_param sand[] = {{"E", 1e5},    {"nu", 0.3},   {"density", 1e3},
                                 {"phi", 30.0}, {"psi", 30.0}, {"cohesion", 300.0}};
static const mpm_param loam[] = {{"density", 1e3}, {"kappa", 0.05}, {"lambda", 0.2}, {"M", 1.0},
                                 {"mu0", 1e5},     {"p_ref", 1e4},  {"pc0", 1.2e4}};

static world_desc described(int32_t dim, const basis_option *basis, int32_t scheme, const mpm_param *soil) {
  world_desc d = world_default(dim, 8, h);
  use_basis(basis, &d.grid);
  d.law = (world_law){.model = "mohr_coulomb", .params = soil, .param_count = 6};
  d.stepper.scheme = scheme;
  d.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  return d;
}

/* Gives every particle a stress and a ratio of its own. */
static void disturb(const world *w, mpm_particles *set, dice *d, double pressure) {
  const int64_t n = mpm_particles_count(set);
  double *stress = malloc((size_t)(7 * n) * sizeof *stress), *ratio = stress + 6 * n;
  for (int64_t p = 0; p < n; ++p) {
    ratio[p] = throw_between(d, 0.8, 1.25);
    for (int32_t c = 0; c < 6; ++c)
      stress[c * n + p] = c < 3                   ? throw_between(d, -1.5, -0.5) * pressure
                          : c == 3 || w->dim == 3 ? throw_between(d, -0.3, 0.3) * pressure
                                                  : 0.0;
  }
  put(w, set, "stress", 6, stress);
  put(w, set, "dilation_ratio", 1, ratio);
  free(stress);
}

/* ---- explicit steps ------------------------------------------------------------------------------------ */
/* The kinetic energy gains what the law's energy loses, to first order in dt, in a step of particles whose
 * stress and ratio are all different; so does the power of the nodal forces, whatever particles take of it.
 * Their stress itself stays their own. */
enum { WAYS = 3 };
START_TEST(forces_do_the_work_of_the_law) {
  static const int32_t transfer[WAYS] = {MPM_FLIP, MPM_APIC, MPM_APIC_MLS}, scheme[2] = {MPM_USL, MPM_USF};
  enum { CLOUD = 150 };
  const int32_t dim = 2 + _i % 2, k = _i / 2 % 2, way = _i / 4 % WAYS, seam = _i / (4 * WAYS) % 2;
  const basis_option *basis = &basis_options[_i / (8 * WAYS)];
  if (transfer[way] == MPM_APIC_MLS && !fits_mls(basis)) return;
  if (seam && way) return;
  const double dt = 1e-8, pressure = 1e3, speed = 1.0;
  world_desc d = described(dim, basis, scheme[k], firm);
  d.stepper.transfer = transfer[way];
  d.stepper.flip = 1.0;
  d.grid.periodic[0] = d.grid.periodic[1] = seam;
  world w;
  mpm_particles *set = world_open(&w, &d);
  dice random = {(uint64_t)_i + 5};
  const double low = seam ? 0.0 : 2.0 * h, high = seam ? 8.0 * h : 5.0 * h;
  add_cloud(&w, set, &random, CLOUD, h, low, high, speed);
  disturb(&w, set, &random, pressure);
  double *before = fetch(&w, set, "stress", 6), *V = fetch(&w, set, "volume", 1);
  const mpm_step_info start = world_info(&w);
  int64_t n;
  ck_ok(&w, mpm_step_begin(w.stepper, dt));
  double *f = fetch_nodes(&w, "force", &n), power = 0.0;
  ck_ok(&w, mpm_step_grid(w.stepper));
  double *v = fetch_nodes(&w, "velocity", &n); /* on the linear basis light nodes go with others now */
  for (int64_t i = 0; i < dim * n; ++i) power += f[i] * v[i];
  ck_ok(&w, mpm_step_end(w.stepper, &w.info));
  const double rate = (start.strain_energy - w.info.strain_energy) / dt;
  if (!way) power = (w.info.kinetic_energy - start.kinetic_energy) / dt;
  ck_within(basis->name, power, rate, 2e-5 * pressure * sum_of(CLOUD, V) * speed / h);
  double *after = fetch(&w, set, "stress", 6);
  for (int64_t i = 0; i < 6 * CLOUD; ++i) ck_within("own stress", after[i], before[i], 1.0);
  free(v), free(f), free(V), free(before), free(after);
  world_close(&w);
}
END_TEST

/* Bodies without a rim have the same accelerations in the first step of all schemes. */
static double *accelerations(int32_t dim, int32_t scheme, int64_t *n) {
  const double dt = 1e-9;
  world_desc d = described(dim, &basis_options[1], scheme, firm);
  for (int32_t k = 0; k < dim; ++k) d.grid.periodic[k] = 1, d.grid.cells[k] = 4;
  world w;
  mpm_particles *set = world_open(&w, &d);
  dice random = {21};
  *n = dim * world_fill_cube(&w, set, 0.0, 4.0 * h);
  disturb(&w, set, &random, 1e3);
  world_step(&w, dt);
  double *v = fetch(&w, set, "velocity", dim);
  for (int64_t i = 0; i < *n; ++i) v[i] /= dt;
  world_close(&w);
  return v;
}

START_TEST(schemes_agree) {
  static const int32_t scheme[] = {MPM_MUSL, MPM_USF, MPM_NEWMARK};
  const int32_t dim = 2 + _i % 2;
  int64_t n;
  double *wanted = accelerations(dim, MPM_USL, &n);
  for (int32_t k = 0; k < 3; ++k) {
    double *is = accelerations(dim, scheme[k], &n);
    for (int64_t i = 0; i < n; ++i) ck_within("acceleration", is[i], wanted[i], 1e-5 * largest(n, wanted));
    free(is);
  }
  free(wanted);
}
END_TEST

/* Where all of a cell is strained alike, as but for the rim here, the remedy changes nothing: the forces of
 * USF are those of the new stress. */
START_TEST(uniform_strain_is_not_touched) {
  double *v[2], change = 0.0;
  int64_t n = 0;
  for (int32_t remedy = 0; remedy < 2; ++remedy) {
    world_desc d = described(2, &basis_options[_i], MPM_USF, sand);
    d.stepper.locking_remedy = remedy;
    world w;
    mpm_particles *set = world_open(&w, &d);
    n = 2 * world_fill_cube(&w, set, 2.0 * h, 5.0 * h);
    double *x = fetch(&w, set, "position", 2);
    v[remedy] = malloc((size_t)n * sizeof *x);
    for (int64_t p = 0; p < n / 2; ++p) {
      v[remedy][p] = -0.4 * x[p] + 0.9 * x[n / 2 + p];
      v[remedy][n / 2 + p] = 0.2 * x[p] - 0.1 * x[n / 2 + p];
    }
    put(&w, set, "velocity", 2, v[remedy]);
    free(x);
    world_step(&w, 1e-3);
    double *after = fetch(&w, set, "velocity", 2);
    for (int64_t i = 0; i < n; ++i) change = fmax(change, fabs(after[i] - v[remedy][i]));
    free(v[remedy]);
    v[remedy] = after;
    world_close(&w);
  }
  for (int64_t i = 0; i < n; ++i) ck_within(basis_options[_i].name, v[1][i], v[0][i], 0.1 * change);
  ck_assert_double_gt(change, 1e-4);
  free(v[0]), free(v[1]);
}
END_TEST

/* Sand that yields loses energy in every step, to first order in dt, however different its particles are. */
START_TEST(yield_takes_energy) {
  enum { CLOUD = 150 };
  const int32_t dim = 2 + _i % 2;
  const basis_option *basis = &basis_options[_i / 2];
  const double dt = 1e-8, pressure = 1e3, speed = 1.0;
  int32_t yielded = 0;
  for (int32_t seed = 1; seed <= 10; ++seed) {
    world_desc d = described(dim, basis, MPM_USL, sand);
    d.stepper.flip = 1.0;
    world w;
    mpm_particles *set = world_open(&w, &d);
    dice random = {(uint64_t)seed};
    add_cloud(&w, set, &random, CLOUD, h, 2.0 * h, 5.0 * h, speed);
    disturb(&w, set, &random, pressure);
    double *V = fetch(&w, set, "volume", 1), *stress = fetch(&w, set, "stress", 6);
    for (int64_t i = 0; i < 6 * CLOUD; ++i) stress[i] *= i < 3 * CLOUD ? 0.7 : 3.0;
    put(&w, set, "stress", 6, stress);
    free(stress);
    const double size = pressure * sum_of(CLOUD, V) * speed / h;
    world_step(&w, dt); /* back to the yield surface */
    const mpm_step_info start = world_info(&w), end = world_step(&w, dt);
    const double gain =
        (end.kinetic_energy + end.strain_energy - start.kinetic_energy - start.strain_energy) / dt;
    ck_between(basis->name, gain, -INFINITE, 2e-5 * size);
    yielded += gain < -1e-3 * size;
    free(V);
    world_close(&w);
  }
  ck_assert_int_ge(yielded, 5);
}
END_TEST

/* Sand that is shaken in a box yields and dilates. How far the energy rises above what it had fallen to. */
static double rise_of_energy(const basis_option *basis, int32_t scheme, int32_t remedy) {
  static const mpm_param loose[] = {{"E", 1e5},    {"nu", 0.3},   {"density", 1e3},
                                    {"phi", 30.0}, {"psi", 30.0}, {"cohesion", 10.0}};
  world_desc d = described(2, basis, scheme, loose);
  d.stepper.locking_remedy = remedy;
  d.stepper.flip = 1.0;
  world w;
  mpm_particles *set = world_open(&w, &d);
  world_walls(&w, MPM_WALL_SLIP, 0.0);
  const int64_t n = world_fill_cube(&w, set, 0.0, 8.0 * h);
  double *x = fetch(&w, set, "position", 2), *v = malloc((size_t)(2 * n) * sizeof *v);
  for (int64_t p = 0; p < n; ++p) {
    const double a = PI * x[p] / (8.0 * h), b = PI * x[n + p] / (8.0 * h);
    v[p] = 3.0 * sin(4.0 * b) * sin(a);
    v[n + p] = 1.8 * sin(b) * cos(3.0 * a);
  }
  put(&w, set, "velocity", 2, v);
  free(x), free(v);
  ck_ok(&w, mpm_particles_set_all(set, "stress", MPM_F64, 6, (const double[]){-2e4, -2e4, -2e4, 0, 0, 0}));
  const double dt = 0.2 * world_stable_dt(&w);
  double lowest = INFINITE, rise = 0.0;
  for (int32_t k = 0; k < 3000; ++k) {
    const mpm_step_info info = world_step(&w, dt);
    const double energy = info.kinetic_energy + info.strain_energy;
    if (k)
      lowest = fmin(lowest, energy), rise = fmax(rise, energy - lowest); /* the first has no stress yet */
  }
  world_close(&w);
  return rise;
}

/* Crossing of cells and MUSL make some energy of their own: the remedy adds none to that. */
START_TEST(shaken_sand) {
  static const int32_t scheme[] = {MPM_USL, MPM_MUSL, MPM_USF};
  const basis_option *basis = &basis_options[_i / 3];
  const double without = rise_of_energy(basis, scheme[_i % 3], MPM_LOCKING_NONE),
               with = rise_of_energy(basis, scheme[_i % 3], MPM_LOCKING_CELL_AVERAGE);
  show("%s, scheme %d: energy rises by %.4g, with the remedy by %.4g\n", basis->name, (int)scheme[_i % 3],
       without, with);
  ck_between(basis->name, with, 0.0, 1.05 * without);
}
END_TEST

/* ---- sets in one cell ---------------------------------------------------------------------------------- */
/* Soils take the mean dilation of their own kind, and the rest that of all. */
START_TEST(soils_average_among_themselves) {
  enum { CLOUD = 80 };
  const int32_t dim = 2 + _i % 2;
  const double dt = 1e-3;
  world_desc d = described(dim, &basis_options[0], MPM_USL, firm);
  d.sets = 2;
  d.other_law = (world_law){.model = "neo_hookean", .E = 1e5, .nu = 0.3, .density = 1e3};
  world w;
  world_open(&w, &d);
  dice random = {8};
  for (int32_t m = 0; m < 2; ++m) add_cloud(&w, w.set[m], &random, CLOUD, h, 2.0 * h, 4.0 * h, 1.0);
  double *x[2], *V[2], *grown[2], *ratio[2];
  for (int32_t m = 0; m < 2; ++m) {
    x[m] = fetch(&w, w.set[m], "position", dim);
    V[m] = fetch(&w, w.set[m], "volume", 1);
  }
  world_step(&w, dt);
  for (int32_t m = 0; m < 2; ++m) {
    grown[m] = fetch(&w, w.set[m], "volume", 1);
    ratio[m] = fetch(&w, w.set[m], "dilation_ratio", 1);
  }
  double apart = 0.0;
  for (int32_t m = 0; m < 2; ++m)
    for (int32_t p = 0; p < CLOUD; ++p) {
      double above[2] = {0.0, 0.0}, below[2] = {0.0, 0.0};
      for (int32_t q = 0; q < 2 * CLOUD; ++q) {
        const int32_t other = q / CLOUD, o = q % CLOUD;
        int32_t same = 1;
        for (int32_t k = 0; k < dim; ++k)
          same &= floor(x[other][k * CLOUD + o] / h) == floor(x[m][k * CLOUD + p] / h);
        if (same) above[other] += grown[other][o], below[other] += V[other][o];
      }
      const double own = above[m] / below[m], all = (above[0] + above[1]) / (below[0] + below[1]);
      const double wanted = (m == 0 ? own : all) * V[m][p] / grown[m][p];
      ck_within(m ? "metal" : "soil", ratio[m][p], wanted, 1e-12);
      apart = fmax(apart, fabs(own - all));
    }
  ck_assert_double_gt(apart, 1e-4);
  for (int32_t m = 0; m < 2; ++m) free(x[m]), free(V[m]), free(grown[m]), free(ratio[m]);
  world_close(&w);
}
END_TEST

/* ---- implicit steps ------------------------------------------------------------------------------------ */
/* Largest entries of the matrix, and of what lacks to its symmetry. */
typedef struct matrix_seen {
  double largest, skew;
  int32_t symmetric;
} matrix_seen;

static mpm_status look_at_matrix(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                                 double tolerance, int64_t *iterations) {
  matrix_seen *seen = user;
  const int64_t *start;
  const int32_t *column;
  const double *value;
  mpm_operator_info info = {.struct_size = sizeof info};
  (void)tolerance;
  ck_ok(NULL, mpm_operator_get_info(matrix, &info));
  ck_ok(NULL, mpm_operator_csr(matrix, &start, &column, &value));
  double *dense = calloc((size_t)(info.rows * (info.rows + 1)), sizeof *dense),
         *b = dense + info.rows * info.rows;
  for (int64_t r = 0; r < info.rows; ++r)
    for (int64_t e = start[r]; e < start[r + 1]; ++e) dense[r * info.rows + column[e]] = value[e];
  *seen = (matrix_seen){.symmetric = info.symmetric};
  for (int64_t r = 0; r < info.rows; ++r)
    for (int64_t c = 0; c < info.rows; ++c) {
      seen->largest = fmax(seen->largest, fabs(dense[r * info.rows + c]));
      seen->skew = fmax(seen->skew, fabs(dense[r * info.rows + c] - dense[c * info.rows + r]));
    }
  memcpy(b, rhs, (size_t)info.rows * sizeof *b);
  for (int64_t i = 0; i < info.rows; ++i) /* elimination; inertia holds the diagonal up */
    for (int64_t r = i + 1; r < info.rows; ++r) {
      const double factor = dense[r * info.rows + i] / dense[i * info.rows + i];
      for (int64_t c = i; c < info.rows && factor != 0.0; ++c)
        dense[r * info.rows + c] -= factor * dense[i * info.rows + c];
      b[r] -= factor * b[i];
    }
  for (int64_t i = info.rows - 1; i >= 0; --i) {
    for (int64_t c = i + 1; c < info.rows; ++c) b[i] -= dense[i * info.rows + c] * solution[c];
    solution[i] = b[i] / dense[i * info.rows + i];
  }
  *iterations = 1;
  free(dense);
  return MPM_OK;
}

/* Soils that bear everything, and that yield in the first step. */
static const struct {
  world_law law;
  const char *name;
  double speed; /* of the particles, at most */
} soils[] = {{{.model = "drucker_prager", .params = firm, .param_count = 6}, "elastic", 1.0},
             {{.model = "drucker_prager", .params = sand, .param_count = 6}, "drucker_prager", 1.0},
             {{.model = "mohr_coulomb", .params = sand, .param_count = 6}, "mohr_coulomb", 1.0},
             {{.model = "cam_clay", .params = loam, .param_count = 7}, "cam_clay", 0.2}};
enum { SOILS = sizeof soils / sizeof *soils, VARIANTS = 8 * IMPLICIT_BASES };

/* Opens a body of soil, `mixed` with metal in the same cells, whose particles all differ as the dice fall;
 * `solve` solves. */
static const char *open_implicit(world *w, int32_t soil, int32_t variant, uint64_t seed, mpm_solve_fn solve,
                                 void *user, double tolerance) {
  static char name[120];
  const int32_t dim = 2 + variant % 2, mixed = variant / 2 % 2, seam = variant / 4 % 2;
  const basis_option *basis = implicit_basis(variant / 8);
  if (seam && basis->boundary) return NULL;
  world_desc d = implicit_default(dim, dim == 3 ? 4 : 6, h, basis);
  d.law = soils[soil].law;
  d.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  d.stepper.linear_solver = MPM_SOLVER_HOST;
  d.stepper.linear_tolerance = tolerance;
  d.grid.periodic[0] = seam;
  d.sets = 1 + mixed;
  d.other_law = (world_law){.model = "neo_hookean", .E = 1e5, .nu = 0.3, .density = 1e3};
  world_open(w, &d);
  ck_ok(w, mpm_stepper_set_linear_solver(w->stepper, solve, user));
  dice random = {seed};
  for (int32_t m = 0; m <= mixed; ++m) {
    double low[3] = {seam ? 0.0 : h, h, h},
           high[3] = {(dim == 3 ? 4.0 : 6.0) * h - (seam ? 0.0 : h), 3.0 * h, 3.0 * h};
    const int64_t n = world_fill(w, w->set[m], low, high, 2);
    double *v = malloc((size_t)(dim * n) * sizeof *v);
    for (int64_t i = 0; i < dim * n; ++i) v[i] = soils[soil].speed * throw_between(&random, -1.0, 1.0);
    put(w, w->set[m], "velocity", dim, v);
    free(v);
    if (m == 0) disturb(w, w->set[m], &random, 1e4);
  }
  snprintf(name, sizeof name, "%s, %s in %d-D%s%s", soils[soil].name, basis->name, (int)dim,
           mixed ? ", mixed" : "", seam ? ", periodic" : "");
  return name;
}

/* The forces of associated soils come from a potential: the matrix is symmetric, and the library knows it; it
 * is not with metal in the same cells. Newton's method is quadratic all the same. */
START_TEST(matrix_is_the_derivative) {
  const int32_t mixed = _i / 2 % 2;
  world w;
  matrix_seen seen;
  const char *name = open_implicit(&w, 0, _i, (uint64_t)_i + 1, look_at_matrix, &seen, 0.0);
  if (!name) return;
  for (int32_t k = 0; k < 2; ++k) {
    world_step(&w, 0.01);
    implicit_quadratic(name, &w, 100.0);
    ck_assert_int_eq(seen.symmetric, !mixed);
    if (!mixed) ck_within(name, seen.skew, 0.0, 1e-12 * seen.largest);
  }
  world_close(&w);
}
END_TEST

/* What the next test is about: of each soil a good part yields, and of the firm one nothing does. */
START_TEST(soils_yield) {
  const int32_t soil = _i / 2;
  world w;
  matrix_seen seen;
  const char *name = open_implicit(&w, soil, _i % 2, 1, look_at_matrix, &seen, 0.0);
  const int64_t n = mpm_particles_count(w.set[0]);
  double *before = fetch(&w, w.set[0], "state", 2);
  world_step(&w, 0.01);
  double *after = fetch(&w, w.set[0], "state", 2);
  int64_t yielded = 0;
  for (int64_t i = 0; i < n; ++i) yielded += after[i] != before[i];
  show("%s: %d of %d particles yield\n", name, (int)yielded, (int)n);
  ck_between(name, (double)yielded, soil ? 0.3 * (double)n : 0.0, soil ? (double)n : 0.0);
  free(before), free(after);
  world_close(&w);
}
END_TEST

/* What a solver sees that moves the nodes by `size` in a random direction: the residual before and after, and
 * what the matrix makes of that direction. */
enum { MOST_ROWS = 2000 };
typedef struct probe {
  int32_t calls;
  int64_t rows;
  double size, before[MOST_ROWS], after[MOST_ROWS], by_matrix[MOST_ROWS];
} probe;

static mpm_status move_a_little(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                                double tolerance, int64_t *iterations) {
  probe *p = user;
  mpm_operator_info info = {.struct_size = sizeof info};
  (void)tolerance;
  ck_ok(NULL, mpm_operator_get_info(matrix, &info));
  ck_assert_int_le(info.rows, MOST_ROWS);
  memcpy(p->calls ? p->after : p->before, rhs, (size_t)info.rows * sizeof *rhs);
  if (p->calls++) return -1;
  dice random = {77};
  double along = 0.0, direction[MOST_ROWS];
  for (int64_t i = 0; i < info.rows; ++i) {
    direction[i] = throw_between(&random, -1.0, 1.0);
    along += direction[i] * rhs[i];
  }
  for (int64_t i = 0; i < info.rows; ++i) { /* downhill, so that the step is taken whole */
    direction[i] *= along < 0.0 ? -1.0 : 1.0;
    solution[i] = p->size * direction[i];
  }
  ck_ok(NULL, mpm_operator_apply(matrix, direction, p->by_matrix));
  p->rows = info.rows;
  *iterations = 1;
  return MPM_OK;
}

/* Residuals of a state, and beside it by one, two and three steps of one size. Returns NULL for variants that
 * there are not. */
enum { SIZES = 3 };
static const char *residuals_beside(int32_t soil, int32_t variant, uint64_t seed, probe *p) {
  const char *name = NULL;
  for (int32_t k = 0; k < SIZES; ++k) {
    world w;
    p[k] = (probe){.size = (k + 1) * 1e-6 * h};
    name = open_implicit(&w, soil, variant, seed, move_a_little, &p[k], 1.0);
    if (!name) return NULL;
    ck_refused(&w, mpm_step(w.stepper, 0.01, NULL), MPM_E_CALLBACK, "");
    ck_assert_int_eq(p[k].calls, 2);
    world_close(&w);
  }
  return name;
}

/* The third difference of the residual, which is nothing where that is smooth, and is not where a particle
 * comes to a kink of its yield surface: the matrix has no part in it. */
static double kink_of(const probe *p) {
  double worst = 0.0;
  for (int64_t i = 0; i < p->rows; ++i)
    worst = fmax(worst, fabs(p[2].after[i] - 3.0 * p[1].after[i] + 3.0 * p[0].after[i] - p[0].before[i]));
  return worst / p->size;
}

/* The residual falls as the matrix says, by differences of steps of two sizes, without the term in size^2.
 * States that have a kink between these are thrown again. */
START_TEST(matrix_against_differences) {
  const int32_t soil = _i / VARIANTS, variant = _i % VARIANTS;
  probe *p = malloc(SIZES * sizeof *p);
  const char *name = NULL;
  double size = 0.0, worst = 0.0;
  for (int32_t again = 0;; ++again) {
    name = residuals_beside(soil, variant, (uint64_t)(variant + 1 + 1000 * again), p);
    if (!name) break;
    size = largest(p->rows, p->by_matrix);
    const double kink = kink_of(p);
    show("%s: third difference %.1e of the largest\n", name, kink / size);
    if (kink <= 1e-8 * size) break;
    ck_assert_int_lt(again, soil ? 5 : 0);
  }
  for (int64_t i = 0; name && i < p->rows; ++i) {
    const double once = p[0].after[i] - p[0].before[i], twice = p[1].after[i] - p[1].before[i];
    worst = fmax(worst, fabs((2.0 * once - 0.5 * twice) / p[0].size + p[0].by_matrix[i]));
  }
  if (name) {
    show("%s: %.1e of the largest\n", name, worst / size);
    ck_within(name, worst, 0.0, 1e-8 * size);
  }
  free(p);
}
END_TEST

/* ---- as with every other law --------------------------------------------------------------------------- */
START_TEST(laws_of_soils) {
  int32_t found = 0;
  for (int32_t i = 0; i < mpm_material_model_count(); ++i) {
    const char *name = mpm_material_model_name(i);
    const int32_t wanted =
        !strcmp(name, "drucker_prager") || !strcmp(name, "mohr_coulomb") || !strcmp(name, "cam_clay");
    ck_assert_int_eq(mpmi_law_of(MPM_ISA_BASELINE, i)->pressure_from_shear, wanted);
    found += wanted;
  }
  ck_assert_int_eq(found, 3);
}
END_TEST
static const int32_t all_schemes[] = {MPM_USL, MPM_MUSL, MPM_USF, MPM_NEWMARK};
enum { ALL_SCHEMES = 4, LONG = 40 };

static mpm_particles *open_block(world *w, int32_t scheme, int32_t threads) {
  world_desc d = described(2, &basis_options[0], scheme, sand);
  for (int32_t k = 0; k < 2; ++k) d.grid.cells[k] = LONG;
  d.context.concurrency = threads;
  d.stepper.gravity[1] = -9.81;
  mpm_particles *set = world_open(w, &d);
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  world_fill(w, set, (const double[]){2.0 * h, 0.0}, (const double[]){38.0 * h, 6.0 * h}, 2);
  const int64_t n = mpm_particles_count(set);
  double *v = malloc((size_t)(2 * n) * sizeof *v);
  dice random = {17};
  for (int64_t i = 0; i < 2 * n; ++i) v[i] = throw_between(&random, -0.2, 0.2);
  put(w, set, "velocity", 2, v);
  free(v);
  return set;
}

static double step_of(int32_t scheme) {
  return scheme == MPM_NEWMARK ? 2e-3 : 1e-3;
}

START_TEST(threads_give_the_same_bits) {
  uint64_t hash[2];
  for (int32_t k = 0; k < 2; ++k) {
    world w;
    open_block(&w, all_schemes[_i], k ? 3 : 1);
    for (int32_t s = 0; s < 5; ++s) world_step(&w, step_of(all_schemes[_i]));
    ck_assert_int_gt(world_blocks(&w), 2);
    hash[k] = world_hash(&w);
    world_close(&w);
  }
  ck_assert_uint_eq(hash[0], hash[1]);
}
END_TEST

/* A step that fails for want of memory or inverts particles leaves no trace; nor does a saved state. */
START_TEST(failed_steps_leave_no_trace) {
  const int32_t scheme = all_schemes[_i];
  world w, other;
  mpm_particles *set = open_block(&w, scheme, 2);
  uint64_t before = world_hash(&w);
  mpm_status status = MPM_E_NOMEM;
  int64_t failures = 0;
  for (int64_t k = 1; status; ++k) {
    w.memory.fail_at = w.memory.calls + k;
    status = mpm_step(w.stepper, step_of(scheme), &w.info);
    if (!status) break;
    ck_assert_int_eq(status, MPM_E_NOMEM);
    ck_assert_uint_eq(world_hash(&w), before);
    ++failures;
  }
  w.memory.fail_at = 0;
  ck_assert_int_gt(failures, 5);
  before = world_hash(&w);
  double *v = fetch(&w, set, "velocity", 2),
         *fast = malloc((size_t)(2 * mpm_particles_count(set)) * sizeof *fast);
  const int64_t n = mpm_particles_count(set);
  for (int64_t i = 0; i < 2 * n; ++i) fast[i] = 1e4 * v[i];
  put(&w, set, "velocity", 2, fast);
  ck_assert_int_ne(mpm_step(w.stepper, 0.02, NULL), MPM_OK);
  put(&w, set, "velocity", 2, v);
  ck_assert_uint_eq(world_hash(&w), before);
  free(v), free(fast);

  open_block(&other, scheme, 1);
  world_copy(&w, &other);
  for (int32_t s = 0; s < 3; ++s) world_step(&w, step_of(scheme)), world_step(&other, step_of(scheme));
  ck_assert_uint_eq(world_hash(&w), world_hash(&other));
  world_close(&w), world_close(&other);
}
END_TEST

/* Pressures are averaged before anything else looks at positions. */
START_TEST(positions_that_a_view_has_spoilt) {
  world w;
  mpm_particles *set = open_block(&w, all_schemes[_i], 1);
  world_step(&w, step_of(all_schemes[_i]));
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&w, mpm_particles_map(set, "position", MPM_READ, &view));
  ((double *)view.data)[3] = -1e9; /* far out of the memory of any tile */
  mpm_view_release(&view);
  ck_refused(&w, mpm_step(w.stepper, 1e-3, NULL), MPM_E_STATE, "written through a view for reading");
  world_close(&w);
}
END_TEST

/* The rows of the forces' stress come with the remedy and go with it. */
START_TEST(memory_comes_and_goes) {
  world w;
  mpm_particles *set = open_block(&w, MPM_USL, 1);
  w.desc.stepper.locking_remedy = MPM_LOCKING_NONE;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &w.desc.stepper));
  world_step(&w, 1e-4);
  const int64_t without = w.memory.held;
  w.desc.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &w.desc.stepper));
  world_step(&w, 1e-4);
  const int64_t more = w.memory.held - without, n = mpm_particles_count(set);
  ck_assert_int_ge(more, 48 * n); /* two copies of the ratio, four components of stress */
  w.desc.stepper.locking_remedy = MPM_LOCKING_NONE;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &w.desc.stepper));
  world_step(&w, 1e-4);
  ck_assert_int_le(w.memory.held, without + more - 48 * n);
  world_close(&w);
}
END_TEST

Suite *locking_suite(void) {
  Suite *suite = suite_create("locking");
  TCase *tc = tcase_create("locking");
  tcase_set_timeout(tc, 120.0);
  tcase_add_loop_test(tc, forces_do_the_work_of_the_law, 0, 8 * WAYS * BASES);
  tcase_add_loop_test(tc, schemes_agree, 0, 2);
  tcase_add_loop_test(tc, uniform_strain_is_not_touched, 0, BASES);
  tcase_add_test(tc, laws_of_soils);
  tcase_add_loop_test(tc, shaken_sand, 0, 6); /* linear, quadratic */
  tcase_add_loop_test(tc, yield_takes_energy, 0, 2 * BASES);
  tcase_add_loop_test(tc, soils_average_among_themselves, 0, 2);
  tcase_add_loop_test(tc, matrix_is_the_derivative, 0, VARIANTS);
  tcase_add_loop_test(tc, soils_yield, 0, 2 * SOILS);
  add_table(tc, wide_case(suite, "more soils"), matrix_against_differences, SOILS * VARIANTS);
  tcase_add_loop_test(tc, threads_give_the_same_bits, 0, ALL_SCHEMES);
  tcase_add_loop_test(tc, failed_steps_leave_no_trace, 0, ALL_SCHEMES);
  tcase_add_loop_test(tc, positions_that_a_view_has_spoilt, 0, ALL_SCHEMES);
  tcase_add_test(tc, memory_comes_and_goes);
  suite_add_tcase(suite, tc);
  return suite;
}
