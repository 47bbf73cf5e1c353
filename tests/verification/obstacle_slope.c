/* The block of sliding.h on the plane of an obstacle and on a friction wall, and a disc of radius 0.4 that
 * rolls or slides down a slope of 30 degrees, let go where it touches it: on these, on a body of prescribed
 * particles and on an elastic slab. A turned plane lies across the cells of the grid. */
#include "sliding.h"

static const double angle = PI / 6.0, radius = 0.4, end = 0.5;

typedef struct floor_kind {
  const char *name;
  int32_t support, places; /* places: of those of the disc */
  double turn, slab;       /* slab: thickness of one on the body */
} floor_kind;

enum { SURFACES = 3, KINDS = 5 }; /* blocks lie on bodies in contact_block and contact_slab */
static const floor_kind kinds[KINDS] = {{"plane", ON_PLANE, 2, 0.0, 0.0},
                                        {"turned plane", ON_PLANE, 1, PI / 6.0, 0.0},
                                        {"friction wall", ON_WALL, 1, 0.0, 0.0},
                                        {"rigid body", ON_BODY, 2, 0.0, 0.0},
                                        {"elastic slab", ON_BODY, 1, 0.0, 0.2}};

static void blocks(FILE *table) {
  static const int32_t basis[5] = {MPM_BSPLINE2, MPM_LINEAR, MPM_BSPLINE3, MPM_GIMP, MPM_CPGIMP};
  for (int32_t k = 0; k < (verify_quick() ? 1 : SURFACES); ++k)
    for (int32_t b = 0; b < (verify_quick() ? 1 : k ? 3 : 5); ++b) {
      char name[80];
      snprintf(name, sizeof name, "%s (%s)", kinds[k].name, slide_basis(basis[b]));
      const slide_series series = {.name = name,
                                   .support = kinds[k].support,
                                   .basis = basis[b],
                                   .places = kinds[k].turn > 0.0 ? 2 : 6,
                                   .turn = kinds[k].turn,
                                   .sliding = 0.015,
                                   .creep = 2.5e-3,
                                   .stopping = 0.015};
      slide_gates(&series, table);
    }
}

enum { ROLLS, SLIDES };
/* The least and the largest way and spin at several places, over the exact ones, and the larger errors. */
typedef struct disc_errors {
  double low[2], high[2], error[2];
} disc_errors;

/* A solid disc rolls where friction is a third of the slope or more. */
static disc_errors run_disc(const floor_kind *kind, int32_t motion, int32_t settled, double h, FILE *table) {
  static const double places[2] = {0.1, 0.6};
  const double friction = motion == ROLLS ? 0.5 : 0.1, g = slide_gravity;
  const double a = motion == ROLLS ? g * sin(angle) / 1.5 : g * (sin(angle) - friction * cos(angle));
  const double exact[2] = {0.5 * a * end * end,
                           (motion == ROLLS ? a : 2.0 * friction * g * cos(angle)) * end / radius};
  disc_errors all = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}, {0.0, 0.0}};
  for (int32_t k = 0; k < (verify_quick() ? 1 : kind->places); ++k) {
    const slide s = {.support = kind->support,
                     .basis = MPM_BSPLINE2,
                     .settled = settled,
                     .keeps = 0.96,
                     .h = h,
                     .radius = radius,
                     .slab = kind->slab,
                     .angle = angle,
                     .friction = friction,
                     .shift = kind->support == ON_WALL ? 0.0 : places[k],
                     .turn = kind->turn,
                     .end = end};
    const slide_outcome o = slide_run(&s);
    const double found[2] = {o.way, o.spin};
    for (int32_t i = 0; i < 2; ++i) {
      all.low[i] = fmin(all.low[i], found[i] / exact[i]);
      all.high[i] = fmax(all.high[i], found[i] / exact[i]);
      all.error[i] = fmax(all.error[i], fabs(found[i] / exact[i] - 1.0));
    }
    fprintf(table, "%s%s,%s,%g,%g,%.6f,%.6f,%.5f,%.5f,%.5f,%.5f\n", motion == ROLLS ? "rolls" : "slides",
            settled ? " settled" : "", kind->name, s.h, s.shift, o.way, exact[0], o.spin, exact[1],
            o.friction, o.weight);
    verify_progress("%sdisc on a %s, friction %g, h = %g", settled ? "settled " : "", kind->name, friction,
                    s.h);
  }
  return all;
}

static void disc(const floor_kind *kind, int32_t motion, FILE *table) {
  const disc_errors fine = run_disc(kind, motion, 0, 0.02, table);
  char name[80];
  snprintf(name, sizeof name, "%s: disc %s, h = R/20", kind->name, motion == ROLLS ? "rolls" : "slides");
  const char *source = "rigid body, Coulomb's law; set tolerance";
  verify_gate_of(name, "least way / exact", fine.low[0], 0.96, 1.04, source);
  verify_gate_of(name, "largest way / exact", fine.high[0], 0.96, 1.04, source);
  verify_gate_of(name, "least spin / exact", fine.low[1], 0.85, 1.15, source);
  verify_gate_of(name, "largest spin / exact", fine.high[1], 0.85, 1.15, source);
  if (verify_quick()) return;
  const disc_errors coarse = run_disc(kind, motion, 0, 0.04, table);
  const int32_t slower =
      motion == ROLLS ? 0 : 1; /* the way of a disc that slides is too good to have an order */
  /* A slab gives way, and a rigid one is not its limit. */
  if (!(kind->slab > 0.0))
    verify_gate_of(name,
                   slower ? "error of the spin, h = R/10 over R/20" : "error of the way, h = R/10 over R/20",
                   coarse.error[slower] / fine.error[slower], 1.6, HUGE_VAL, "it converges; set tolerance");
}

/* Let go at the touch, the disc swings on its contact, slips where it is lightest, and its spin does not come
 * nearer to that of a rigid one. Settled by the weight across the slope it rolls from the first. */
static void settled_disc(const floor_kind *kind, FILE *table) {
  const disc_errors coarse = run_disc(kind, ROLLS, 1, 0.04, table);
  run_disc(kind, ROLLS, 1, 0.02, table); /* for the picture */
  const disc_errors fine = run_disc(kind, ROLLS, 1, 0.01, table);
  static const char *const what[2][2] = {
      {"error of the way, h = R/40", "error of the way, h = R/10 over R/40"},
      {"error of the spin, h = R/40", "error of the spin, h = R/10 over R/40"}};
  char name[80];
  snprintf(name, sizeof name, "%s: settled disc rolls", kind->name);
  for (int32_t i = 0; i < 2; ++i) {
    verify_gate_of(name, what[i][0], fine.error[i], 0.0, 0.03, "rigid body; set tolerance");
    verify_gate_of(name, what[i][1], coarse.error[i] / fine.error[i], 1.6 * 1.6, HUGE_VAL,
                   "it converges; set tolerance for each halving");
  }
}

/* What slides on prescribed particles, by the normals that it has there: those before it lean forwards, and
 * nodes behind it cannot pull. */
static void friction_by_normals(FILE *table) {
  static const char *const by[4] = {"logistic", "discriminant", "gradient", "fixed"};
  const double friction = 0.1, g = slide_gravity, exact_spin = 2.0 * friction * g * cos(angle) * end / radius,
               exact_way = 0.5 * g * (sin(angle) - friction * cos(angle)) * end * end;
  for (int32_t normal = MPM_NORMAL_LOGISTIC; normal <= MPM_NORMAL_FIXED; ++normal)
    for (int32_t k = 10; k <= 20; k += 10) {
      char what[96];
      const slide s = {.support = ON_BODY,
                       .basis = MPM_BSPLINE2,
                       .normal = normal,
                       .settled = 1,
                       .keeps = 0.96,
                       .h = radius / k,
                       .radius = radius,
                       .angle = angle,
                       .friction = friction,
                       .shift = 0.1,
                       .end = end};
      const slide_outcome o = slide_run(&s);
      fprintf(table, "slides settled,%s normals,%g,%g,%.6f,%.6f,%.5f,%.5f,%.5f,%.5f\n", by[normal], s.h,
              s.shift, o.way, exact_way, o.spin, exact_spin, o.friction, o.weight);
      snprintf(what, sizeof what, "rigid body: settled disc slides, %s normals, h = R/%d: friction / 0.1",
               by[normal], (int)k);
      verify_judge(what, o.friction / friction, 0.95, 1.05, "Coulomb's law; set tolerance",
                   normal == MPM_NORMAL_FIXED ? NULL : "normals before the disc lean forwards");
    }
}

int main(int argc, char **argv) {
  verify_begin("obstacle_slope", argc, argv);
  FILE *block_table = verify_csv("obstacle_slope_block"), *disc_table = verify_csv("obstacle_slope_disc");
  slide_heading(block_table);
  fprintf(disc_table, "case,support,h,shift,way,exact,spin,exact_spin,friction,weight\n");
  blocks(block_table);
  for (int32_t k = 0; k < (verify_quick() ? 1 : KINDS); ++k)
    for (int32_t motion = ROLLS; motion <= SLIDES; ++motion) disc(&kinds[k], motion, disc_table);
  for (int32_t k = 0; k < (verify_quick() ? 0 : KINDS); ++k)
    if (kinds[k].places == 2 && !(kinds[k].slab > 0.0)) settled_disc(&kinds[k], disc_table);
  if (!verify_quick()) friction_by_normals(disc_table);
  fclose(block_table);
  fclose(disc_table);
  return verify_end();
}
