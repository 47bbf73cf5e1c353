/* Surfaces that prescribe how the material moves, wherever they lie on the grid: a thick elastic cylinder
 * (a = 1, b = 2, E = 1, nu = 0.3, plane strain) under an inner pressure, held at its outer face, in the plane
 * and as a body of revolution; and a block that slides down an inclined line, by explicit and by implicit
 * steps. */
#include "verify.h"

static const double a = 1.0, b = 2.0, E = 1.0, nu = 0.3, p = 1e-5, penalty = 100.0;

/* Lame's displacement with u(b) = 0. */
static double displacement(double r) {
  const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 * E / (1.0 + nu);
  return p / (2.0 * (lambda + mu) + 2.0 * mu * b * b / (a * a)) * (b * b / r - r);
}

/* What springs give way at the outer face: t / beta, with the traction of the exact solution. */
static double give_way(double h) {
  const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 * E / (1.0 + nu);
  const double A = p / (2.0 * (lambda + mu) + 2.0 * mu * b * b / (a * a));
  return 2.0 * A * h / penalty;
}

static mpm_surface *make_surface(const verify_world *w, int32_t prescribes, double pressure) {
  mpm_surface_desc d;
  mpm_surface *s;
  verify_ok(w, mpm_surface_desc_init(&d, sizeof d));
  d.prescribes = prescribes;
  d.penalty = penalty;
  d.pressure = pressure;
  verify_ok(w, mpm_surface_create(w->context, w->grid, &d, &s));
  verify_ok(w, mpm_stepper_add_surface(w->stepper, s));
  return s;
}

static void drop_surface(const verify_world *w, mpm_surface *s) {
  verify_ok(w, mpm_stepper_remove_surface(w->stepper, s));
  verify_ok(w, mpm_surface_destroy(s));
}

typedef struct outcome {
  double inner, outer, force; /* u(a) over exact, u(b) over u(a), radial force at b over that at a */
  int32_t iterations;
} outcome;

/* ---- in the plane -------------------------------------------------------------------------------------- */
enum { AROUND = 384 };

/* A closed line of markers; with out 0 the material is outside of it. */
static void add_circle(const verify_world *w, mpm_surface *s, const double *centre, double r, double spacing,
                       int32_t out) {
  double at[2 * AROUND];
  for (int32_t i = 0; i < AROUND; ++i) {
    at[i] = centre[0] + r * cos(2.0 * PI * i / AROUND);
    at[AROUND + i] = centre[1] + (out ? r : -r) * sin(2.0 * PI * i / AROUND);
  }
  verify_ok(w, mpm_surface_add_polyline(s, AROUND, at, 1, spacing, NULL, NULL));
}

/* Returns the mean of a radial component over the markers, where they were at the start. */
static double mean_radial(const verify_world *w, const mpm_surface *s, const double *centre,
                          const char *field, FILE *csv, const char *name) {
  const int64_t n = mpm_surface_count(s);
  double *x = verify_array(2 * n), *u = verify_array(2 * n), *v = verify_array(2 * n), sum = 0.0;
  verify_ok(w, mpm_surface_get(s, "position", MPM_F64, 2, n, NULL, x));
  verify_ok(w, mpm_surface_get(s, "displacement", MPM_F64, 2, n, NULL, u));
  verify_ok(w, mpm_surface_get(s, field, MPM_F64, 2, n, NULL, v));
  for (int64_t i = 0; i < n; ++i) {
    const double arm[2] = {x[i] - u[i] - centre[0], x[n + i] - u[n + i] - centre[1]};
    const double r = sqrt(arm[0] * arm[0] + arm[1] * arm[1]),
                 radial = (arm[0] * v[i] + arm[1] * v[n + i]) / r;
    if (csv)
      fprintf(csv, "%s,%.6f,%.6f,%.6e,%.6e\n", name, r, atan2(arm[1], arm[0]), radial, displacement(r));
    sum += radial / (double)n;
  }
  free(x), free(u), free(v);
  return sum;
}

/* Writes the mean radial displacement of rings of markers between the faces. */
static void write_profile(const verify_world *w, mpm_surface *const *ring, int32_t rings,
                          const double *centre, FILE *csv, const char *name) {
  for (int32_t k = 0; k < rings; ++k) mean_radial(w, ring[k], centre, "displacement", csv, name);
}

enum { RINGS = 4 };
static outcome in_the_plane(int32_t per_unit, int32_t shifted, FILE *csv) {
  const double h = 1.0 / per_unit;
  verify_setup setup = verify_defaults(2, 5 * per_unit, h);
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  const double centre[2] = {2.5 + (shifted ? 0.37 * h : 0.0), 2.5 + (shifted ? 0.21 * h : 0.0)};
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, nu, 1.0));
  verify_fill_rings(&w, set, centre, a, b, 2 * per_unit);
  mpm_surface *inner = make_surface(&w, MPM_PRESCRIBES_NOTHING, p),
              *outer = make_surface(&w, MPM_PRESCRIBES_VELOCITY, 0.0), *seen[RINGS];
  add_circle(&w, inner, centre, a, 0.5 * h, 0);
  add_circle(&w, outer, centre, b, 0.5 * h, 1);
  for (int32_t k = 0; k < RINGS; ++k) {
    seen[k] = make_surface(&w, MPM_PRESCRIBES_NOTHING, 0.0);
    add_circle(&w, seen[k], centre, a + (b - a) * (k + 1) / (RINGS + 1), h, 1);
  }
  outcome is = {.iterations = verify_step(&w, 1.0).newton_iterations};
  char name[64];
  snprintf(name, sizeof name, "%d %s", (int)per_unit, shifted ? "shifted" : "aligned");
  is.inner = mean_radial(&w, inner, centre, "displacement", csv, name) / displacement(a);
  is.outer = mean_radial(&w, outer, centre, "gap", csv, name) / displacement(a);
  const double loads = (double)mpm_surface_count(inner) * mean_radial(&w, inner, centre, "force", NULL, name);
  const double holds =
      (double)mpm_surface_count(outer) * mean_radial(&w, outer, centre, "reaction", NULL, name);
  is.force = -holds / loads;
  write_profile(&w, seen, RINGS, centre, csv, name);
  drop_surface(&w, inner);
  drop_surface(&w, outer);
  for (int32_t k = 0; k < RINGS; ++k) drop_surface(&w, seen[k]);
  verify_close(&w);
  return is;
}

/* ---- as a body of revolution --------------------------------------------------------------------------- */
static outcome of_revolution(int32_t per_unit, double shift) {
  const double h = 1.0 / per_unit;
  verify_setup setup = verify_defaults(2, 3 * per_unit, h);
  setup.grid.geometry = MPM_AXISYMMETRIC;
  setup.grid.origin[0] = shift * h;
  setup.grid.cells[1] = 4;
  setup.grid.periodic[1] = 1;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "linear_elastic", E, nu, 1.0));
  const int32_t layers = 2 * per_unit;
  for (int32_t i = 0; i < layers; ++i)
    for (int32_t k = 0; k < 8; ++k) {
      const double x[] = {a + (i + 0.5) * 0.5 * h, (k + 0.5) * 0.5 * h}, volume = 0.25 * h * h * x[0];
      verify_ok(&w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
    }
  mpm_surface *inner = make_surface(&w, MPM_PRESCRIBES_NOTHING, p),
              *outer = make_surface(&w, MPM_PRESCRIBES_NORMAL, 0.0);
  for (int32_t k = 0; k < 8; ++k) {
    const double at[] = {a, (k + 0.5) * 0.5 * h}, far[] = {b, at[1]};
    const double out_of_inner[] = {-a * 0.5 * h, 0.0}, out_of_outer[] = {b * 0.5 * h, 0.0};
    verify_ok(&w, mpm_surface_add(inner, 1, at, out_of_inner, NULL));
    verify_ok(&w, mpm_surface_add(outer, 1, far, out_of_outer, NULL));
  }
  outcome is = {.iterations = verify_step(&w, 1.0).newton_iterations};
  double u[16], gap[16];
  verify_ok(&w, mpm_surface_get(inner, "displacement", MPM_F64, 2, 8, NULL, u));
  verify_ok(&w, mpm_surface_get(outer, "gap", MPM_F64, 2, 8, NULL, gap));
  is.inner = u[0] / displacement(a);
  is.outer = gap[0] / displacement(a);
  drop_surface(&w, inner);
  drop_surface(&w, outer);
  verify_close(&w);
  return is;
}

/* ---- a block on a slope -------------------------------------------------------------------------------- */
/* An elastic block of ten by five cells, let go on a line at 30 degrees, along which it slides freely. */
static const double slope = PI / 6.0, gravity = 10.0, h_block = 0.05, end_time = 0.4;
typedef struct slide_result {
  double way, off, largest_off, force,
      energy; /* over exact; over h; over h; over the weight across; balance */
} slide_result;

static slide_result slides(int32_t implicit, int32_t basis, double place, const char *name, FILE *csv) {
  const double h = h_block, c = cos(slope), s = sin(slope);
  verify_setup setup = verify_defaults(2, 60, h);
  setup.grid.basis = basis;
  setup.stepper.gravity[1] = -gravity;
  if (implicit) setup.stepper.scheme = MPM_NEWMARK;
  verify_world w;
  verify_open(&w, &setup);
  const double stiff = 1e7, density = 1e3, length = 10.0 * h, height = 5.0 * h,
               first[2] = {1.8, 1.6 + place * h};
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", stiff, nu, density));
  const double volume = 0.25 * h * h;
  /* along is down the slope, and n out of the material, down into the slope */
  const double along[2] = {-c, -s}, n[2] = {s, -c};
  for (int32_t i = 0; i < 20; ++i)
    for (int32_t k = 0; k < 10; ++k) {
      const double t = (i + 0.5) * 0.5 * h, d = (k + 0.5) * 0.5 * h;
      const double x[2] = {first[0] + t * along[0] - d * n[0], first[1] + t * along[1] - d * n[1]};
      verify_ok(&w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
    }
  mpm_surface *line = make_surface(&w, MPM_PRESCRIBES_NORMAL, 0.0),
              *base = make_surface(&w, MPM_PRESCRIBES_NOTHING, 0.0);
  const int32_t markers = 2 * (int32_t)((length + 0.5 * gravity * s * end_time * end_time) / h) + 8;
  for (int32_t i = 0; i < markers; ++i) {
    const double t = (i - 2.5) * 0.5 * h, x[2] = {first[0] + t * along[0], first[1] + t * along[1]},
                 area[2] = {0.5 * h * n[0], 0.5 * h * n[1]};
    verify_ok(&w, mpm_surface_add(line, 1, x, area, NULL));
  }
  enum { SEEN = 9 };
  for (int32_t i = 0; i < SEEN; ++i) {
    const double t = (i + 1.0) * length / (SEEN + 1.0),
                 x[2] = {first[0] + t * along[0], first[1] + t * along[1]};
    verify_ok(&w, mpm_surface_add(base, 1, x, NULL, NULL));
  }
  slide_result is = {0.0, 0.0, 0.0, 0.0, 0.0};
  double u[2 * SEEN], impulse[3];
  const double weight = density * length * height * gravity;
  enum { FRAMES = 20 };
  for (int32_t frame = 1; frame <= FRAMES; ++frame) {
    const double t = end_time * frame / FRAMES, exact = 0.5 * gravity * s * t * t;
    if (implicit)
      for (int32_t k = 0; k < 4; ++k) verify_step(&w, end_time / FRAMES / 4);
    else
      verify_advance(&w, 0.4, t);
    verify_ok(&w, mpm_surface_get(base, "displacement", MPM_F64, 2, SEEN, NULL, u));
    double way = 0.0, off = 0.0, most = 0.0;
    for (int32_t i = 0; i < SEEN; ++i) {
      const double across = n[0] * u[i] + n[1] * u[SEEN + i];
      way += (along[0] * u[i] + along[1] * u[SEEN + i]) / SEEN;
      off += across / SEEN;
      most = fmax(most, fabs(across));
    }
    fprintf(csv, "\"%s\",%.4f,%.6e,%.6e,%.6e,%.6e\n", name, t, way, exact, off / h, most / h);
    is.way = way / exact;
    is.off = off / h;
    is.largest_off = fmax(is.largest_off, most / h);
  }
  verify_ok(&w, mpm_stepper_surface_impulse(w.stepper, line, impulse));
  is.force = -(n[0] * impulse[0] + n[1] * impulse[1]) / (weight * c * end_time);
  const mpm_step_info info = verify_info(&w);
  is.energy = (info.kinetic_energy + info.strain_energy) / info.external_work_total;
  drop_surface(&w, line);
  drop_surface(&w, base);
  verify_close(&w);
  return is;
}

/* ---- a bar that swings --------------------------------------------------------------------------------- */
/* A bar of n cells in its first mode, held at one end by one marker in the midst of a cell: the period over
 * the exact one, 4 L / c; and the least and largest energy over the first, in ten periods. */
typedef struct swing {
  double period, least, most;
} swing;

static swing bar(int32_t implicit, int32_t cells, double steps, const char *name, FILE *csv) {
  const double stiff = 100.0, density = 1.0, speed = 0.1, h = 1.0 / cells,
               period = 4.0 / sqrt(stiff / density);
  verify_setup setup = verify_defaults(1, cells + 8, h);
  if (implicit) setup.stepper.scheme = MPM_NEWMARK;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "linear_elastic", stiff, 0.0, density));
  const double start = 3.37 * h, length = 0.5 * h, out = -1.0;
  for (int32_t i = 0; i < 2 * cells; ++i) {
    const double at = (i + 0.5) * length, x = start + at, v = speed * sin(0.5 * PI * at);
    verify_ok(&w, mpm_particles_add(set, 1, &x, &v, &length, NULL, NULL, NULL));
  }
  mpm_surface *s = make_surface(&w, MPM_PRESCRIBES_VELOCITY, 0.0);
  verify_ok(&w, mpm_surface_add(s, 1, &start, &out, NULL));
  const double dt = period / steps, first = verify_info(&w).kinetic_energy;
  swing is = {0.0, 1.0, 1.0};
  double before = 1.0, t_first = 0.0, t_last = 0.0;
  int32_t crossings = 0;
  for (int32_t k = 1; k <= (int32_t)(10.0 * steps); ++k) {
    const mpm_step_info info = verify_step(&w, dt);
    const double energy = (info.kinetic_energy + info.strain_energy) / first, momentum = info.momentum[0];
    is.least = fmin(is.least, energy);
    is.most = fmax(is.most, energy);
    fprintf(csv, "\"%s\",%.5f,%.6f,%.6e\n", name, k * dt / period, energy, momentum);
    if (before > 0.0 && momentum <= 0.0) {
      t_last = (k - 1 + before / (before - momentum)) * dt;
      if (!crossings++) t_first = t_last;
    }
    before = momentum;
  }
  is.period = (t_last - t_first) / (crossings - 1) / period;
  drop_surface(&w, s);
  verify_close(&w);
  return is;
}

static void bars(FILE *csv) {
  double error[2][3], spacing[3];
  const int32_t levels = verify_quick() ? 2 : 3;
  for (int32_t implicit = 0; implicit < 2; ++implicit) {
    for (int32_t k = 0; k < levels; ++k) {
      const int32_t cells = 10 << k;
      char name[64];
      snprintf(name, sizeof name, "bar, %s, h = L/%d", implicit ? "implicit" : "explicit", (int)cells);
      const swing is = bar(implicit, cells, implicit ? 80.0 : 16.0 * cells, name, csv);
      spacing[k] = 1.0 / cells;
      error[implicit][k] = fabs(is.period - 1.0);
      verify_gate_of(name, "period over exact", is.period, implicit ? 0.99 : 0.8, 1.01,
                     "4 L / c; set tolerance");
      verify_gate_of(name, "least energy over the first", is.least, k ? 0.97 : 0.85, 1.0,
                     "energies close; set tolerance");
      verify_gate_of(name, "largest energy over the first", is.most, 1.0, 1.02,
                     "energies close; set tolerance");
    }
    if (!implicit)
      verify_gate("bar, explicit: order of the period", verify_slope(levels, spacing, error[0]), 0.8, 1.6,
                  "the wall is smeared over a part of a cell");
  }
}

/* ---- gates --------------------------------------------------------------------------------------------- */
static void cylinders(FILE *csv) {
  char what[96];
  for (int32_t n = 5; n <= (verify_quick() ? 10 : 20); n *= 2)
    for (int32_t shifted = 0; shifted < 2; ++shifted)
      for (int32_t ring = 0; ring < 2; ++ring) {
        const outcome is = ring ? of_revolution(n, shifted ? 0.37 : 0.0) : in_the_plane(n, shifted, csv);
        const char *kind = ring ? "of revolution" : "in the plane", *place = shifted ? "shifted" : "aligned";
        const double gives = give_way(1.0 / n) / displacement(a);
        snprintf(what, sizeof what, "%s, h = a/%d, %s: u(a) over exact", kind, (int)n, place);
        verify_gate(what, is.inner, 0.99, 1.01, "Lame with u(b) = 0; set tolerance");
        snprintf(what, sizeof what, "%s, h = a/%d, %s: u(b) over t / beta", kind, (int)n, place);
        verify_gate(what, is.outer / gives, 0.97, 1.03, "the springs' way; set tolerance");
        if (!ring) {
          snprintf(what, sizeof what, "%s, h = a/%d, %s: force at b over exact", kind, (int)n, place);
          const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 * E / (1.0 + nu);
          const double A = p / (2.0 * (lambda + mu) + 2.0 * mu * b * b / (a * a));
          const double exact = 2.0 * A * (lambda + 2.0 * mu) * b / (p * a);
          verify_gate(what, is.force / exact, 0.99, 1.01, "Lame with u(b) = 0; set tolerance");
        }
        verify_progress("cylinder %s, h = a/%d, %s", kind, (int)n, place);
      }
}

static void blocks(FILE *csv) {
  static const struct {
    const char *name;
    int32_t implicit, basis;
  } kinds[4] = {{"explicit", 0, MPM_BSPLINE2},
                {"implicit", 1, MPM_BSPLINE2},
                {"explicit, GIMP", 0, MPM_GIMP},
                {"implicit, cubic", 1, MPM_BSPLINE3}};
  for (int32_t k = 0; k < (verify_quick() ? 2 : 4); ++k)
    for (int32_t place = 0; place < (verify_quick() ? 1 : 3); ++place) {
      char name[64];
      snprintf(name, sizeof name, "%s, place %d", kinds[k].name, (int)place);
      const slide_result is = slides(kinds[k].implicit, kinds[k].basis, 0.3 * place, name, csv);
      verify_gate_of(name, "way over exact", is.way, 0.98, 1.02, "g sin theta; set tolerance");
      verify_gate_of(name, "largest distance from the line over h", is.largest_off, 0.0, 1e-3,
                     "the line; set tolerance");
      verify_gate_of(name, "impulse across over that of the weight", is.force, 0.99, 1.01,
                     "balance; set tolerance");
      verify_gate_of(name, "energy over work", is.energy, 0.98, 1.005, "energies close; set tolerance");
      verify_progress("block %s", name);
    }
}

int main(int argc, char **argv) {
  verify_begin("surface_held", argc, argv);
  FILE *csv = verify_csv("surface_held"), *slide = verify_csv("surface_held_slope"),
       *swings = verify_csv("surface_held_bar");
  fprintf(csv, "variant,r,angle,u,u_exact\n");
  fprintf(slide, "variant,t,way,way_exact,off,largest_off\n");
  cylinders(csv);
  blocks(slide);
  fprintf(swings, "variant,t,energy,momentum\n");
  bars(swings);
  fclose(swings);
  fclose(csv);
  fclose(slide);
  return verify_end();
}
