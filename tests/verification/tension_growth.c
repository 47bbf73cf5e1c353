/* How fast what MUSL and USF make in tension grows, against the equations of a step made linear
 * (docs/theory.md, 11.1). A stretched bar in a periodic box of 18 cells, in equilibrium but for speeds of
 * 1e-9 of that of sound; the same speeds go through the linear equations, which know nothing of the library.
 * E = 1000, nu = 0.3, density 1. */
#include "verify.h"

enum { CELLS = 18, PER_CELL = 2, COUNT = CELLS * PER_CELL, LONGEST = 6000 };
static const double E = 1000.0, nu = 0.3, density = 1.0, h = 0.05;

typedef struct setting {
  int32_t basis, scheme, projected;
  double stretch, share, flip; /* share: of h over the speed of sound in the bar at rest */
  const char *name;
  int32_t by_rate; /* 1: a rate of damping takes what flip takes */
} setting;

/* Value, slope and curvature of a B-spline at r nodes from its own, in cells. */
static void spline(int32_t basis, double r, double *w) {
  const double a = fabs(r), s = r < 0.0 ? -1.0 : 1.0;
  w[0] = w[1] = w[2] = 0.0;
  if (basis == MPM_BSPLINE2 && a < 0.5) {
    w[0] = 0.75 - a * a, w[1] = -2.0 * r, w[2] = -2.0;
  } else if (basis == MPM_BSPLINE2 && a < 1.5) {
    w[0] = 0.5 * (1.5 - a) * (1.5 - a), w[1] = -s * (1.5 - a), w[2] = 1.0;
  } else if (basis == MPM_BSPLINE3 && a < 1.0) {
    w[0] = 2.0 / 3.0 - a * a + 0.5 * a * a * a, w[1] = s * (1.5 * a * a - 2.0 * a), w[2] = 3.0 * a - 2.0;
  } else if (basis == MPM_BSPLINE3 && a < 2.0) {
    w[0] = (2.0 - a) * (2.0 - a) * (2.0 - a) / 6.0, w[1] = -0.5 * s * (2.0 - a) * (2.0 - a), w[2] = 2.0 - a;
  }
}

/* The bar made linear: displacement, velocity and logarithm of the stretch of each particle beside those of
 * the bar at rest; weights of all nodes at all particles, whose neighbours are those of a ring. */
typedef struct bar {
  double w[COUNT][CELLS], g[COUNT][CELLS], c[COUNT][CELLS];
  double u[COUNT], v[COUNT], e[COUNT];
  double tau, stiffness; /* Kirchhoff stress, and its change with e */
} bar;

/* shift: of all particles, over their distance. */
static void prepare(bar *b, const setting *is, const double *v, double shift) {
  const double mu = E / (2.0 * (1.0 + nu)), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu), s = is->stretch;
  b->tau = lambda * log(s) + mu * (s * s - 1.0);
  b->stiffness = lambda + 2.0 * mu * s * s;
  for (int32_t p = 0; p < COUNT; ++p) {
    b->u[p] = b->e[p] = 0.0;
    b->v[p] = v[p];
    for (int32_t i = 0; i < CELLS; ++i) {
      double r = (p + 0.5 + shift) / PER_CELL - i, w[3];
      r -= CELLS * nearbyint(r / CELLS);
      spline(is->basis, r, w);
      b->w[p][i] = w[0], b->g[p][i] = w[1] / h, b->c[p][i] = w[2] / (h * h);
    }
  }
}

static void to_nodes(const bar *b, double *node) {
  for (int32_t i = 0; i < CELLS; ++i) {
    node[i] = 0.0;
    for (int32_t p = 0; p < COUNT; ++p) node[i] += b->w[p][i] * b->v[p] / PER_CELL;
  }
}

static void strain(bar *b, const double *node, double dt) {
  for (int32_t p = 0; p < COUNT; ++p)
    for (int32_t i = 0; i < CELLS; ++i) b->e[p] += dt * b->g[p][i] * node[i];
}

static void displace(bar *b, const double *node, double dt) {
  for (int32_t p = 0; p < COUNT; ++p)
    for (int32_t i = 0; i < CELLS; ++i) b->u[p] += dt * b->w[p][i] * node[i];
}

static void linear_step(bar *b, const setting *is, double dt) {
  double old[CELLS], new[CELLS];
  to_nodes(b, old);
  if (is->scheme == MPM_USF) strain(b, old, dt);
  for (int32_t i = 0; i < CELLS; ++i) {
    double force = 0.0; /* per mass of a particle */
    for (int32_t p = 0; p < COUNT; ++p)
      force -= (b->stiffness * b->e[p] * b->g[p][i] + b->tau * b->u[p] * b->c[p][i]) / density;
    new[i] = old[i] + dt *force / PER_CELL;
  }
  for (int32_t p = 0; p < COUNT; ++p) {
    double mean = 0.0, gain = 0.0;
    for (int32_t i = 0; i < CELLS; ++i) mean += b->w[p][i] * new[i], gain += b->w[p][i] * (new[i] - old[i]);
    b->v[p] = is->flip * (b->v[p] + gain) + (1.0 - is->flip) * mean;
  }
  if (!is->projected) displace(b, new, dt);
  if (is->scheme == MPM_USL) strain(b, new, dt);
  if (is->scheme != MPM_MUSL) return;
  to_nodes(b, old);
  strain(b, old, dt);
  if (is->projected) displace(b, old, dt);
}

/* Kinetic energies of a run: at its start, after half of its steps, at its end. */
typedef struct run {
  double first, middle, last;
} run;

/* Growth of the amplitude per step in the second half. */
static double growth(const run *r, int32_t steps) {
  return 0.5 * log(r->last / r->middle) / (steps - steps / 2);
}

static double energy(const bar *b) {
  double sum = 0.0;
  for (int32_t p = 0; p < COUNT; ++p) sum += 0.5 * density * h / PER_CELL * b->v[p] * b->v[p];
  return sum;
}

static run of_equations(bar *b, const setting *is, double dt, int32_t steps) {
  run r = {energy(b), 0.0, 0.0};
  for (int32_t k = 0; k < steps; ++k) {
    linear_step(b, is, dt);
    if (k + 1 == steps / 2) r.middle = energy(b);
  }
  r.last = energy(b);
  return r;
}

/* A and K_tau / m of the theory, of the wave whose phase grows by so much per cell. */
typedef struct shares {
  double kept, pull;
} shares;

static shares of_wave(const bar *b, double phase) {
  shares s = {0.0, 0.0};
  for (int32_t p = 0; p < PER_CELL; ++p) {
    double w[2] = {0.0, 0.0}, c[2] = {0.0, 0.0};
    for (int32_t i = 0; i < CELLS; ++i) {
      const double at = phase * (i > CELLS / 2 ? i - CELLS : i);
      w[0] += b->w[p][i] * cos(at), w[1] += b->w[p][i] * sin(at);
      c[0] += b->c[p][i] * cos(at), c[1] += b->c[p][i] * sin(at);
    }
    s.kept += (w[0] * w[0] + w[1] * w[1]) / PER_CELL;
    s.pull -= b->tau * (c[0] * w[0] + c[1] * w[1]) / (PER_CELL * density);
  }
  return s;
}

/* What the theory's formula says of the wave that grows fastest: growth of amplitude per step. */
static double estimate(const bar *b, const setting *is, double dt) {
  double most = -1.0;
  for (int32_t wave = 1; wave <= CELLS / 2; ++wave) {
    const shares s = of_wave(b, 2.0 * PI * wave / CELLS);
    most = fmax(most, 0.5 * (1.0 - s.kept) * (dt * dt * s.pull - (1.0 - is->flip)));
  }
  return most;
}

/* The largest K_tau / m over tau / (rho h^2) of all waves, of those of an endless bar too: with the particles
 * where the fill puts them, and wherever they have moved. */
static void bounds(bar *b, const setting *is, double filled, double anywhere) {
  enum { PHASES = 180, SHIFTS = 40 };
  static const double rest[COUNT];
  double most[2] = {0.0, 0.0};
  for (int32_t shift = 0; shift < SHIFTS; ++shift) {
    prepare(b, is, rest, (double)shift / SHIFTS);
    for (int32_t k = 1; k <= PHASES; ++k)
      most[shift > 0] = fmax(most[shift > 0], of_wave(b, PI * k / PHASES).pull * density * h * h / b->tau);
  }
  verify_gate_of(is->name, "K_tau / m over tau / (rho h^2), largest of all waves, filled", most[0],
                 filled - 5e-3, filled + 5e-3, "theory 11.1");
  verify_gate_of(is->name, "K_tau / m over tau / (rho h^2), largest of all waves, anywhere",
                 fmax(most[0], most[1]), anywhere - 5e-3, anywhere + 5e-3, "theory 11.1");
}

static run of_library(const setting *is, const double *v, double dt, int32_t steps) {
  verify_setup setup = verify_defaults(1, CELLS, h);
  setup.grid.basis = is->basis;
  setup.grid.periodic[0] = 1;
  setup.stepper.scheme = is->scheme;
  setup.stepper.flip = is->by_rate ? 1.0 : is->flip;
  if (is->by_rate) setup.stepper.pic_damping = (1.0 - is->flip) / dt;
  setup.stepper.projected_positions = is->projected;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, nu, density));
  verify_fill_box(&w, set, (const double[]){0.0}, (const double[]){CELLS * h}, PER_CELL);
  const double F[9] = {is->stretch, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  verify_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  verify_put(&w, set, "velocity", 1, v);
  mpm_step_info now = verify_info(&w);
  run r = {now.kinetic_energy, 0.0, 0.0};
  for (int32_t k = 0; k < steps; ++k) {
    now = verify_step(&w, dt);
    if (k + 1 == steps / 2) r.middle = now.kinetic_energy;
  }
  r.last = now.kinetic_energy;
  verify_close(&w);
  return r;
}

int main(int argc, char **argv) {
  verify_begin("tension_growth", argc, argv);
  FILE *table = verify_csv("tension_growth");
  fprintf(table, "setting,stretch,share,steps,estimate,linear,library\n");
  static const setting list[] = {
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.02, 0.4, 1.0, "quadratic MUSL", 0},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.05, 0.4, 1.0, "quadratic MUSL", 0},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.05, 0.2, 1.0, "quadratic MUSL", 0},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.2, 0.2, 1.0, "quadratic MUSL", 0},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.5, 0.2, 1.0, "quadratic MUSL", 0},
      {MPM_BSPLINE2, MPM_USF, 0, 1.05, 0.4, 1.0, "quadratic USF", 0},
      {MPM_BSPLINE2, MPM_USF, 0, 1.5, 0.2, 1.0, "quadratic USF", 0},
      {MPM_BSPLINE3, MPM_MUSL, 0, 1.2, 0.4, 1.0, "cubic MUSL", 0},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.2, 0.4, 0.97, "quadratic MUSL flip .97", 0},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.2, 0.4, 0.92, "quadratic MUSL flip .92", 0},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.2, 0.4, 0.97, "quadratic MUSL rate of .03 a step", 1},
      {MPM_BSPLINE2, MPM_MUSL, 0, 1.2, 0.4, 0.92, "quadratic MUSL rate of .08 a step", 1},
      {MPM_BSPLINE2, MPM_MUSL, 0, 0.8, 0.4, 1.0, "quadratic MUSL", 0},
      {MPM_BSPLINE2, MPM_USL, 0, 1.5, 0.2, 1.0, "quadratic USL", 0},
      {MPM_BSPLINE2, MPM_MUSL, 1, 1.05, 0.4, 1.0, "quadratic MUSL projected", 0},
      {MPM_BSPLINE2, MPM_MUSL, 1, 1.5, 0.2, 1.0, "quadratic MUSL projected", 0},
      {MPM_BSPLINE3, MPM_MUSL, 1, 1.5, 0.2, 1.0, "cubic MUSL projected", 0}};
  const double speed = verify_speed_of_sound(E, nu, density);
  double v[COUNT];
  verify_noise(COUNT, 1e-9 * speed, v);
  static bar b;
  for (size_t k = 0; k < sizeof list / sizeof *list; ++k) {
    const setting *is = &list[k];
    const double dt = is->share * h / speed;
    prepare(&b, is, v, 0.0);
    const double formula = is->scheme == MPM_USL || is->projected ? 0.0 : estimate(&b, is, dt);
    const int32_t grows = formula > 0.0;
    const int32_t steps = grows ? (int32_t)fmin(LONGEST, 14.0 / formula) : LONGEST / 3; /* 14: 1e6-fold */
    const run linear = of_equations(&b, is, dt, steps), library = of_library(is, v, dt, steps);
    const double by_linear = growth(&linear, steps), by_library = growth(&library, steps);
    fprintf(table, "%s,%g,%g,%d,%.5e,%.5e,%.5e\n", is->name, is->stretch, is->share, steps, formula,
            by_linear, by_library);
    char what[160];
    snprintf(what, sizeof what, "%s, stretch %g, %g h/c", is->name, is->stretch, is->share);
    if (grows) {
      verify_gate_of(what, "growth / that of the linear equations", by_library / by_linear, 0.99, 1.01,
                     "theory 11.1");
      verify_gate_of(what, "formula / linear equations", formula / by_linear, 0.9, 1.1, "theory 11.1");
    } else {
      verify_gate_of(what, "kinetic energy, last / first", library.last / library.first, 0.0, 1.0,
                     "equilibrium");
      verify_gate_of(what, "that / the same of the linear equations",
                     library.last / library.first * linear.first / linear.last, 0.99, 1.01, "theory 11.1");
    }
  }
  bounds(&b, &(setting){.basis = MPM_BSPLINE2, .stretch = 1.2, .name = "quadratic"}, 1.6, 1.6);
  bounds(&b, &(setting){.basis = MPM_BSPLINE3, .stretch = 1.2, .name = "cubic"}, 1.04, 1.15);
  fclose(table);
  return verify_end();
}
