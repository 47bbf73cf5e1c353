/* Two elastic discs of two bodies collide (Sulsky, Chen and Schreyer 1994): E = 1000, nu = 0.3, density 1000,
 * radius 0.2, speed 0.1 sqrt 2 along the line of their centres. The reference is a finite element solution of
 * a disc on a frictionless wall, which is the same by symmetry: they touch at 1.586, kinetic energy is least,
 * 0.136, at 2.104, they part at 2.685 and rebound with 0.909 of their speed. */
#include "verify.h"

static const double radius = 0.2, distance = 0.42426406871192851, speed = 0.14142135623730951;

typedef struct hit {
  int cells, scheme, transfer, basis;
  double shift[2], angle, offset, friction; /* shift: in cells; offset: of the lines of flight, in radii */
} hit;

typedef struct outcome {
  double touch, part, least, when, rebound, energy, energy_end, momentum, angular, spin, force, dissipation;
} outcome;

/* The lattice is that of the disc, so that it is symmetric wherever it lies on the grid. */
static void fill_disc(const verify_world *w, mpm_particles *set, const double *centre, const double *v,
                      double spacing) {
  enum { MOST = 1 << 16 };
  const int32_t n = (int32_t)ceil(radius / spacing);
  double *x = verify_array(2 * MOST), *volume = verify_array(MOST);
  int64_t count = 0;
  for (int32_t pass = 0; pass < 2; ++pass) {
    int64_t at = 0;
    for (int32_t i = -n; i < n; ++i)
      for (int32_t j = -n; j < n; ++j) {
        const double place[2] = {(i + 0.5) * spacing, (j + 0.5) * spacing};
        if (place[0] * place[0] + place[1] * place[1] > radius * radius) continue;
        for (int32_t c = 0; c < 2 && pass; ++c) x[c * count + at] = centre[c] + place[c];
        ++at;
      }
    count = at;
  }
  for (int64_t i = 0; i < count; ++i) volume[i] = PI * radius * radius / (double)count;
  verify_ok(w, mpm_particles_add(set, count, x, NULL, volume, NULL, NULL, NULL));
  verify_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  free(x);
  free(volume);
}

/* Angular velocity about the centre of mass, and along `e` the velocity of it. */
static double spin_of(const verify_world *w, const mpm_particles *set, const double *e, double *velocity) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2), *v = verify_get(w, set, "velocity", 2), centre[4] = {0.0};
  for (int64_t i = 0; i < n; ++i)
    for (int c = 0; c < 2; ++c)
      centre[c] += x[c * n + i] / (double)n, centre[2 + c] += v[c * n + i] / (double)n;
  double angular = 0.0, inertia = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    const double a = x[i] - centre[0], b = x[n + i] - centre[1];
    angular += a * (v[n + i] - centre[3]) - b * (v[i] - centre[2]);
    inertia += a * a + b * b;
  }
  *velocity = centre[2] * e[0] + centre[3] * e[1];
  free(x);
  free(v);
  return angular / inertia;
}

static outcome collide(const hit *a, FILE *history) {
  const double h = 1.0 / a->cells, e[2] = {cos(a->angle), sin(a->angle)}, side[2] = {-e[1], e[0]};
  const double mass = 1000.0 * PI * radius * radius;
  verify_setup setup = verify_defaults(2, (int64_t)ceil(1.5 / h), h);
  setup.grid.basis = a->basis;
  setup.grid.origin[0] = setup.grid.origin[1] = -ceil(0.75 / h) * h;
  setup.stepper.scheme = a->scheme;
  setup.stepper.transfer = a->transfer;
  verify_world w;
  verify_open(&w, &setup);
  for (int i = 0; i < 2; ++i) {
    const double sign = i ? 1.0 : -1.0;
    double centre[2], v[2];
    for (int c = 0; c < 2; ++c) {
      centre[c] = sign * (distance * e[c] - 0.5 * a->offset * radius * side[c]) + a->shift[c] * h;
      v[c] = -sign * speed * e[c];
    }
    mpm_particles *disc = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, 1000.0));
    fill_disc(&w, disc, centre, v, 0.5 * h);
    verify_ok(&w, mpm_stepper_set_body(w.stepper, disc, i));
  }
  mpm_contact_desc contact;
  verify_ok(&w, mpm_contact_desc_init(&contact, sizeof contact));
  contact.friction = a->friction;
  verify_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &contact));

  mpm_step_info now = verify_info(&w);
  const double start = now.kinetic_energy, angular = now.angular_momentum[2];
  outcome out = {.touch = -1.0, .least = HUGE_VAL};
  double sample = 0.0;
  for (;;) {
    const double energy = (now.kinetic_energy + now.affine_kinetic_energy + now.strain_energy) / start;
    if (now.kinetic_energy < out.least) out.least = now.kinetic_energy, out.when = now.t;
    out.energy = fmax(out.energy, energy);
    out.energy_end = energy;
    out.momentum = fmax(out.momentum, hypot(now.momentum[0], now.momentum[1]) / (mass * speed));
    out.angular = fmax(out.angular, fabs(now.angular_momentum[2] - angular) / (mass * speed * radius));
    out.dissipation = fmin(out.dissipation, now.contact_dissipation / start);
    if (history && now.t >= sample) {
      fprintf(history, "%.5f,%.6e,%.6e,%.6e\n", now.t, now.kinetic_energy, now.strain_energy, energy);
      sample += 0.02;
    }
    if (now.t >= 3.6 - 1e-12) break;
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, 3.6 - now.t));
    mpm_contact_info info = {.struct_size = sizeof info};
    verify_ok(&w, mpm_stepper_contact_info(w.stepper, 0, 1, &info));
    out.force = fmax(out.force, hypot(info.force[0], info.force[1]));
    if (!info.touching) continue;
    out.part = now.t;
    if (out.touch < 0.0) out.touch = now.t;
  }
  double v[2];
  const double spin[2] = {spin_of(&w, w.set[0], e, &v[0]), spin_of(&w, w.set[1], e, &v[1])};
  out.rebound = 0.5 * (v[1] - v[0]) / speed;
  out.spin = fabs(spin[0]) > fabs(spin[1]) ? spin[0] : spin[1];
  verify_close(&w);
  return out;
}

static void show(const char *name, const hit *a, const outcome *o, FILE *table) {
  fprintf(table, "%s,%d,%.4f,%.4f,%.5f,%.4f,%.5f,%.5f,%.5f,%.2e,%.2e,%.4f,%.3f,%.1e\n", name, a->cells,
          o->touch, o->part, o->least, o->when, o->rebound, o->energy, o->energy_end, o->momentum, o->angular,
          o->spin, o->force, o->dissipation);
  verify_progress("%s, h = 1/%d", name, a->cells);
}

static void gate(const char *name, const char *of, double value, double low, double high,
                 const char *source) {
  char what[160];
  snprintf(what, sizeof what, "%s: %s", name, of);
  verify_gate(what, value, low, high, source);
}

static void keeps_laws(const char *name, const outcome *o) {
  gate(name, "momentum / that of a disc", o->momentum, 0.0, 1e-11, "conservation");
  gate(name, "largest energy / first", o->energy, 0.0, 1.0005, "contact takes energy and never gives any");
  gate(name, "least dissipation of a step", o->dissipation, -1e-12, 0.0, "contact takes energy");
}

static const char *const fem = "own FEM, 23040 elements; set tolerance";

static void refine(FILE *history, FILE *table) {
  hit a = {.scheme = MPM_MUSL, .transfer = MPM_FLIP, .basis = MPM_BSPLINE2, .angle = 0.25 * PI};
  double h[4], error[4];
  const int levels = verify_quick() ? 2 : 4;
  static const char *const name[4] = {"h = 1/20", "h = 1/40", "h = 1/80", "h = 1/160"};
  for (int k = 0; k < levels; ++k) {
    a.cells = 20 << k;
    const outcome o = collide(&a, k == 1 ? history : NULL);
    show("refinement", &a, &o, table);
    h[k] = 1.0 / a.cells;
    error[k] = 0.909 - o.rebound;
    if (!k) continue; /* too coarse for gates: it begins the series */
    keeps_laws(name[k], &o);
    if (k != 2)
      gate(name[k], "they touch (1.586)", o.touch, 1.576, 1.596, fem);
    else
      verify_expected_failure(
          "h = 1/80: they touch (1.586)", o.touch, 1.576, 1.596, fem,
          "the rim of a lattice is uneven: the corner of a particle's cell stands out by a "
          "third of h, and is seen");
    gate(name[k], "least kinetic energy (FEM 0.136)", o.least, 0.136 - (k == 1 ? 0.016 : 0.015), 0.14, fem);
    gate(name[k], "rebound / speed (FEM 0.909)", o.rebound, 0.909 - (k == 1 ? 0.045 : 0.02), 0.919, fem);
  }
  if (levels > 2)
    verify_gate("order of the rebound, 1/20 to 1/80", verify_slope(3, h, error), 0.9, HUGE_VAL,
                "first order");
}

static void turn(FILE *table) {
  hit a = {.cells = 40, .scheme = MPM_MUSL, .transfer = MPM_FLIP, .basis = MPM_BSPLINE2, .angle = 0.25 * PI};
  static const double shift[5][2] = {{0.1, 0.3}, {0.25, 0.25}, {0.37, 0.11}, {0.5, 0.5}, {0.8, 0.6}},
                      degrees[4] = {0.0, 20.0, 33.0, 45.0};
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {0.0, 0.0}, force[2] = {HUGE_VAL, 0.0}, spin = 0.0;
  const int few = verify_quick() ? 1 : 5;
  for (int i = 0; i < few + 4; ++i) {
    const int turned = i >= few;
    a.angle = (turned ? degrees[i - few] : 45.0) * PI / 180.0;
    for (int c = 0; c < 2; ++c) a.shift[c] = turned ? 0.0 : shift[i][c];
    const outcome o = collide(&a, NULL);
    show(turned ? "turned" : "shifted", &a, &o, table);
    low[turned] = fmin(low[turned], o.rebound);
    high[turned] = fmax(high[turned], o.rebound);
    spin = fmax(spin, fabs(o.spin));
    if (!turned) force[0] = fmin(force[0], o.force), force[1] = fmax(force[1], o.force);
  }
  const char *source = "independence of the grid; set tolerance";
  verify_gate("shifted by shares of h: spread of the rebound", high[0] - low[0], 0.0, 0.012, source);
  verify_gate("shifted by shares of h: largest over least peak force", force[1] / force[0], 1.0, 1.04,
              source);
  verify_gate("turned by 0 ... 45 degrees: spread of the rebound", high[1] - low[1], 0.0, 0.035, source);
  verify_gate("shifted and turned: largest spin, rad/s", spin, 0.0, 0.05, source);
}

static void oblique(FILE *table) {
  hit a = {.cells = 40, .scheme = MPM_USL, .transfer = MPM_APIC, .angle = 0.25 * PI, .offset = 1.0};
  static const double friction[3] = {0.0, 0.3, 10.0};
  for (int i = 0; i < (verify_quick() ? 3 : 6); ++i) {
    a.basis = i < 3 ? MPM_BSPLINE2 : MPM_BSPLINE3;
    a.friction = friction[i % 3];
    const outcome o = collide(&a, NULL);
    char name[80];
    snprintf(name, sizeof name, "oblique with friction %g (%s)", a.friction, i < 3 ? "quadratic" : "cubic");
    show(name, &a, &o, table);
    keeps_laws(name, &o);
    gate(name, "change of angular momentum / (m v R)", o.angular, 0.0, 1e-11, "conservation");
    if (!(i % 3)) gate(name, "spin, rad/s", fabs(o.spin), 0.0, 0.03, "none without friction; set tolerance");
    /* The lines of flight make an angle of 30 degrees with the normal. Rigid discs that stick turn with
     * speed / (3 R); elastic ones store what is sheared and give it back, at most as much again. */
    const double stuck = -speed / (3.0 * radius);
    if (i % 3 == 2)
      gate(name, "spin / that of rigid discs that stick", o.spin / stuck, 0.75, 2.0,
           "rigid bodies, and the bound of elastic ones");
  }
}

int main(int argc, char **argv) {
  verify_begin("contact_discs", argc, argv);
  FILE *history = verify_csv("contact_discs"), *table = verify_csv("contact_discs_table");
  fprintf(history, "t,kinetic,strain,total\n");
  fprintf(
      table,
      "case,cells,touch,part,least,when,rebound,energy,energy_end,momentum,angular,spin,force,dissipation\n");
  refine(history, table);
  turn(table);
  oblique(table);
  fclose(history);
  fclose(table);
  return verify_end();
}
