/* Two elastic discs of two bodies collide: discs.h. They are refined, shifted and turned on the grid, hit
 * each other off centre with friction, and do the same in implicit steps. */
#include "discs.h"

static void show(const char *name, const disc_hit *a, const disc_outcome *o, FILE *table) {
  fprintf(table, "%s,%d,%.4f,%.4f,%.5f,%.4f,%.5f,%.5f,%.5f,%.2e,%.2e,%.4f,%.3f,%.1e\n", name, a->cells,
          o->touch, o->part, o->least, o->when, o->rebound, o->energy, o->energy_end, o->momentum, o->angular,
          o->spin, o->force, o->dissipation);
  verify_progress("%s, h = 1/%d", name, a->cells);
}

static void keeps_laws(const char *name, const disc_outcome *o) {
  const verify_laws laws = {.momentum = o->momentum, .energy = o->energy, .dissipation = o->dissipation};
  verify_laws_gates(name, &laws, 1e-11, 1.0005);
}

static void refine(FILE *history, FILE *table) {
  disc_hit a = {.scheme = MPM_MUSL, .transfer = MPM_FLIP, .basis = MPM_BSPLINE2, .angle = 0.25 * PI};
  double h[4], error[4];
  const int levels = verify_quick() ? 2 : 4;
  static const char *const name[4] = {"h = 1/20", "h = 1/40", "h = 1/80", "h = 1/160"};
  for (int k = 0; k < levels; ++k) {
    a.cells = 20 << k;
    const disc_outcome o = disc_collide(&a, k == 1 ? history : NULL);
    show("refinement", &a, &o, table);
    h[k] = 1.0 / a.cells;
    error[k] = 0.909 - o.rebound;
    if (!k) continue; /* too coarse for gates: it begins the series */
    keeps_laws(name[k], &o);
    /* The outline of a lattice stands out by up to a third of a cell, and is not where that of the disc is:
     * theirs meet at 1.563, 1.563 and 1.578. */
    verify_gate_of(name[k], "they touch after their outlines meet, in cells of way",
                   (o.touch - disc_outlines_meet(a.cells, a.angle)) * 2.0 * disc_speed * a.cells, -0.5, 0.5,
                   "outlines of lattices; set tolerance");
    verify_gate_of(name[k], "least kinetic energy (FEM 0.136)", o.least, 0.136 - (k == 1 ? 0.016 : 0.015),
                   0.14, disc_reference);
    verify_gate_of(name[k], "rebound / speed (FEM 0.909)", o.rebound, 0.909 - (k == 1 ? 0.045 : 0.02), 0.919,
                   disc_reference);
  }
  if (levels > 2)
    verify_gate("order of the rebound, 1/20 to 1/80", verify_slope(3, h, error), 0.9, HUGE_VAL,
                "first order");
}

/* The outline of shells is that of the disc along the axes of their square, and nearly so elsewhere. */
static void smooth(FILE *table) {
  disc_hit a = {.scheme = MPM_MUSL, .transfer = MPM_FLIP, .basis = MPM_BSPLINE2, .shells = 1};
  for (int k = 0; k < (verify_quick() ? 1 : 3); ++k) {
    char name[80];
    a.cells = 40 << k;
    const disc_outcome o = disc_collide(&a, NULL);
    snprintf(name, sizeof name, "smooth outline, h = 1/%d", a.cells);
    show("shells", &a, &o, table);
    keeps_laws(name, &o);
    verify_gate_of(name, "they touch (1.586)", o.touch, 1.576, 1.596, disc_reference);
    const double least = 0.909 - (k ? 0.02 : 0.045);
    if (k != 1) {
      verify_gate_of(name, "rebound / speed (FEM 0.909)", o.rebound, least, 0.919, disc_reference);
      continue;
    }
    char what[120];
    snprintf(what, sizeof what, "%s: rebound / speed (FEM 0.909)", name);
    verify_expected_failure(
        what, o.rebound, least, 0.919, disc_reference,
        "the gate is that of the lattice turned by 45 degrees; the rebound depends on place and turn");
  }
}

static void turn(FILE *table) {
  disc_hit a = {
      .cells = 40, .scheme = MPM_MUSL, .transfer = MPM_FLIP, .basis = MPM_BSPLINE2, .angle = 0.25 * PI};
  static const double shift[5][2] = {{0.1, 0.3}, {0.25, 0.25}, {0.37, 0.11}, {0.5, 0.5}, {0.8, 0.6}},
                      degrees[4] = {0.0, 20.0, 33.0, 45.0};
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {0.0, 0.0}, spin = 0.0;
  double least[2] = {HUGE_VAL, HUGE_VAL}, most[2] = {0.0, 0.0}; /* of the largest force */
  const int few = verify_quick() ? 1 : 5;
  for (int i = 0; i < few + 4; ++i) {
    const int turned = i >= few;
    a.angle = (turned ? degrees[i - few] : 45.0) * PI / 180.0;
    for (int c = 0; c < 2; ++c) a.shift[c] = turned ? 0.0 : shift[i][c];
    const disc_outcome o = disc_collide(&a, NULL);
    show(turned ? "turned" : "shifted", &a, &o, table);
    low[turned] = fmin(low[turned], o.rebound);
    high[turned] = fmax(high[turned], o.rebound);
    spin = fmax(spin, fabs(o.spin));
    least[turned] = fmin(least[turned], o.force);
    most[turned] = fmax(most[turned], o.force);
  }
  const char *source = "independence of the grid; set tolerance";
  verify_gate("shifted by shares of h: spread of the rebound", high[0] - low[0], 0.0, 0.012, source);
  verify_gate("shifted by shares of h: largest over least peak force", most[0] / least[0], 1.0, 1.04, source);
  verify_gate("turned by 0 ... 45 degrees: spread of the rebound", high[1] - low[1], 0.0, 0.035, source);
  verify_gate("turned by 0 ... 45 degrees: largest over least peak force", most[1] / least[1], 1.0, 1.04,
              source);
  verify_gate("shifted and turned: largest spin, rad/s", spin, 0.0, 0.05, source);
}

/* The lines of flight make an angle of 30 degrees with the normal. Rigid discs that stick would turn with
 * speed / (3 R) = 0.236; elastic ones give back a part of what is sheared. */
static void turns(const char *name, double friction, const disc_outcome *o) {
  const double elements = friction > 1.0 ? 0.3783 : 0.4475;
  verify_gate_of(name, "spin / that of finite elements", -o->spin / elements, 0.9, 1.1,
                 "own FEM, 8256 elements; set tolerance");
}

static void oblique(FILE *table) {
  disc_hit a = {.cells = 40, .scheme = MPM_USL, .transfer = MPM_APIC, .angle = 0.25 * PI, .offset = 1.0};
  static const double friction[3] = {0.0, 0.3, 10.0};
  for (int i = 0; i < (verify_quick() ? 3 : 6); ++i) {
    a.basis = i < 3 ? MPM_BSPLINE2 : MPM_BSPLINE3;
    a.friction = friction[i % 3];
    const disc_outcome o = disc_collide(&a, NULL);
    char name[80];
    snprintf(name, sizeof name, "oblique with friction %g (%s)", a.friction, i < 3 ? "quadratic" : "cubic");
    show(name, &a, &o, table);
    keeps_laws(name, &o);
    verify_gate_of(name, "change of angular momentum / (m v R)", o.angular, 0.0, 1e-11, "conservation");
    if (!(i % 3))
      verify_gate_of(name, "spin, rad/s", fabs(o.spin), 0.0, 0.03, "none without friction; set tolerance");
    if (i % 3) turns(name, a.friction, &o);
  }
  if (verify_quick()) return;
  a.basis = MPM_BSPLINE2;
  a.cells = 80;
  for (int i = 1; i < 3; ++i) {
    a.friction = friction[i];
    const disc_outcome fine = disc_collide(&a, NULL);
    char name[80];
    snprintf(name, sizeof name, "oblique with friction %g (quadratic), h = 1/80", a.friction);
    show("finer", &a, &fine, table);
    turns(name, a.friction, &fine);
  }
}

static void implicit(FILE *table) {
  disc_hit a = {.scheme = MPM_NEWMARK, .transfer = MPM_FLIP, .basis = MPM_BSPLINE2, .angle = 0.25 * PI};
  for (int k = 0; k < (verify_quick() ? 1 : 4); ++k) {
    a.cells = 40 << k / 2;
    a.cfl = k % 2 ? 4.0 : 1.0;
    const disc_outcome o = disc_collide(&a, NULL);
    char name[80];
    snprintf(name, sizeof name, "implicit at CFL %g, h = 1/%d", a.cfl, a.cells);
    show("implicit", &a, &o, table);
    keeps_laws(name, &o);
    if (k != 1)
      verify_gate_of(name, "rebound / speed (FEM 0.909)", o.rebound, 0.909 - (k < 2 ? 0.045 : 0.02), 0.919,
                     disc_reference);
    else
      verify_expected_failure(
          "implicit at CFL 4, h = 1/40: rebound / speed (FEM 0.909)", o.rebound, 0.864, 0.919, disc_reference,
          "the gate is that of explicit steps, and steps of four times the stable one lose 0.013 more");
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
  smooth(table);
  turn(table);
  oblique(table);
  implicit(table);
  fclose(history);
  fclose(table);
  return verify_end();
}
