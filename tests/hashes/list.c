/* The list of scenes: every method, every law, every option. What the library refuses is left out. */
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { IMPLICIT_STEPS = 5, QUASI_STATIC_STEPS = 3, SCHEMES = 5, BASES = 8, IN_TURN = 12, TRANSFERS = 14 };

static const struct {
  int32_t basis, boundary;
  const char *name;
} bases[BASES] = {{MPM_BSPLINE2, MPM_BOUNDARY_GHOST, "quadratic"},
                  {MPM_LINEAR, MPM_BOUNDARY_GHOST, "linear"},
                  {MPM_BSPLINE3, MPM_BOUNDARY_GHOST, "cubic"},
                  {MPM_GIMP, MPM_BOUNDARY_GHOST, "GIMP"},
                  {MPM_BSPLINE2, MPM_BOUNDARY_OPEN_KNOT, "open quadratic"},
                  {MPM_UGIMP, MPM_BOUNDARY_GHOST, "uGIMP"},
                  {MPM_BSPLINE3, MPM_BOUNDARY_OPEN_KNOT, "open cubic"},
                  {MPM_CPGIMP, MPM_BOUNDARY_GHOST, "cpGIMP"}};

static const struct {
  int32_t scheme, quasi_static;
  const char *name;
} schemes[SCHEMES] = {{MPM_USL, 0, "USL"},
                      {MPM_USF, 0, "USF"},
                      {MPM_MUSL, 0, "MUSL"},
                      {MPM_NEWMARK, 0, "Newmark"},
                      {MPM_NEWMARK, 1, "quasi-static"}};

static const struct {
  int32_t transfer, xpic_order, xpic_every;
  double flip, pic_damping;
  const char *name;
} transfers[TRANSFERS] = {
    {MPM_FLIP, 2, 0, 1.0, 0.0, "FLIP"},         {MPM_FLIP, 2, 0, 0.9, 0.0, "FLIP 0.9"},
    {MPM_FLIP, 2, 0, 0.95, 5.0, "FLIP damped"}, {MPM_APIC, 2, 0, 1.0, 0.0, "APIC"},
    {MPM_APIC_MLS, 2, 0, 1.0, 0.0, "APIC_MLS"}, {MPM_TPIC, 2, 0, 1.0, 0.0, "TPIC"},
    {MPM_TFLIP, 2, 0, 0.95, 0.0, "TFLIP"},      {MPM_AFLIP, 2, 0, 0.9, 0.0, "AFLIP"},
    {MPM_XPIC, 1, 0, 1.0, 0.0, "XPIC(1)"},      {MPM_XPIC, 2, 0, 1.0, 0.0, "XPIC(2)"},
    {MPM_XPIC, 3, 0, 1.0, 0.0, "XPIC(3)"},      {MPM_XPIC, 5, 0, 1.0, 0.0, "XPIC(5)"},
    {MPM_FMPM, 2, 0, 1.0, 0.0, "FMPM(2)"},      {MPM_FMPM, 4, 2, 0.95, 0.0, "FMPM(4) every other"}};

static const char *const laws[LAWS] = {
    "",       "neo-Hookean", "linear elastic",        "J2",   "decoupled",    "fluid", "viscous fluid",
    "rigid",  "host law",    "host law with tangent", "soil", "Mohr-Coulomb", "mud",   "snow",
    "grains", "clay"};

typedef struct listing {
  scene *item;
  int32_t count, capacity;
} listing;

/* Of a method; what is not said is the first of its table. */
static scene method(int32_t dim, int32_t scheme, int32_t basis, int32_t transfer) {
  scene is = {.dim = dim, .smoothing = 0.4, .law = {LAW_NEO_HOOKEAN, LAW_NONE}, .position_order = 1};
  is.scheme = schemes[scheme].scheme;
  is.quasi_static = schemes[scheme].quasi_static;
  is.basis = bases[basis].basis;
  is.boundary = bases[basis].boundary;
  const int32_t implicit = is.scheme == MPM_NEWMARK;
  const int32_t t = implicit ? 0 : transfer;
  is.transfer = transfers[t].transfer;
  is.xpic_order = transfers[t].xpic_order;
  is.xpic_every = transfers[t].xpic_every;
  is.flip = transfers[t].flip;
  is.pic_damping = transfers[t].pic_damping;
  is.steps = is.quasi_static ? QUASI_STATIC_STEPS : implicit ? IMPLICIT_STEPS : dim == 3 ? 10 : 15;
  is.wall[MPM_X_MAX] = is.quasi_static || dim == 1 ? MPM_WALL_FIXED : MPM_WALL_SLIP;
  is.wall[MPM_Y_MAX] = implicit ? MPM_WALL_SLIP : MPM_WALL_FRICTION_NODES;
  is.wall[MPM_Z_MAX] = MPM_WALL_SLIP;
  snprintf(is.name, sizeof is.name, "%d-D %s, %s, %s", (int)dim, bases[basis].name, schemes[scheme].name,
           transfers[t].name);
  return is;
}

/* Two threads for every fourth scene. */
static void append(listing *l, scene is, const char *what) {
  if (l->count == l->capacity) {
    l->capacity = 2 * l->capacity + 256;
    l->item = realloc(l->item, (size_t)l->capacity * sizeof *l->item);
    if (!l->item) exit(1);
  }
  if (*what) {
    const size_t had = strlen(is.name);
    snprintf(is.name + had, sizeof is.name - had, ": %s", what);
  }
  is.concurrency = 1 + (l->count % 4 == 3);
  l->item[l->count++] = is;
}

static void list_methods(listing *l, int32_t dim) {
  for (int32_t s = 0; s < SCHEMES; ++s)
    for (int32_t b = 0; b < BASES; ++b)
      for (int32_t t = 0; t < (schemes[s].scheme == MPM_NEWMARK ? 1 : TRANSFERS); ++t) {
        const scene is = method(dim, s, b, t);
        if (is_offered(&is)) append(l, is, "");
      }
}

/* Basis and transfer for the n-th scene with a scheme, of the first IN_TURN; cpGIMP, which not every law goes
 * with, is the last. */
static scene in_turn(int32_t dim, int32_t scheme, int32_t n) {
  _Static_assert(IN_TURN % 5, "a stride of 5 reaches every transfer: with a multiple of 5 take another");
  scene is = method(dim, scheme, n % (BASES - 1), 5 * n % IN_TURN);
  return is_offered(&is) ? is : method(dim, scheme, n % (BASES - 1), 3);
}

/* Prescribed particles do not heed walls, and the nodes of total Lagrangian grids need none to pass. */
static void let_out(scene *is) {
  if (!is->total) is->wall[MPM_Y_MAX] = is->wall[MPM_Z_MAX] = MPM_WALL_OPEN;
}

/* Loads that are balanced without motion need a body that neither flows, tears nor stands under a pressure
 * of its own. */
static int32_t keeps_shape(int32_t law) {
  return law != LAW_FLUID && law != LAW_VISCOUS_FLUID && law != LAW_MUD && law != LAW_GRAINS &&
         law != LAW_SNOW && law != LAW_CLAY;
}

static void list_laws(listing *l, int32_t dim) {
  for (int32_t s = 0; s < SCHEMES; ++s)
    for (int32_t law = LAW_NEO_HOOKEAN; law < LAWS; ++law) {
      scene is = in_turn(dim, s, law);
      if (is.quasi_static && !keeps_shape(law)) continue;
      is.law[law == LAW_RIGID] = law; /* beside another */
      if (law == LAW_RIGID) let_out(&is);
      append(l, is, laws[law]);
    }
}

/* ---- options ---- */
static void all_walls(scene *is, int32_t kind) {
  for (int32_t face = 0; face < 6; ++face) is->wall[face] = kind;
}

typedef struct option {
  const char *name;
  int32_t of_explicit, of_newmark, of_quasi_static;
} option;
enum {
  ORDER_2,
  STAGGERED,
  REMEDY,
  REFERENCE,
  TWO_SETS,
  FIXED,
  SLIP,
  FRICTION,
  OPEN,
  PERIODIC_X,
  PERIODIC,
  PRESCRIBED,
  MOTION,
  VELOCITY,
  ZERO_ACCELERATION,
  FORCE,
  ACCELERATION,
  APPLIED_FORCE,
  HOOK_P2G,
  HOOK_FORCES,
  HOOK_VELOCITY,
  ALL_HOOKS,
  KEPT,
  SPARE_SIZE,
  STAGED_VELOCITY,
  STAGED_FORCE,
  SAVED,
  ADVANCE,
  FAILING,
  CHANGED,
  DIRECT,
  CG,
  MULTIGRID,
  GMRES,
  HOST_SOLVER,
  EVERYTHING,
  CONTACT,
  CONTACT_PERIODIC,
  PLANES,
  OBSTACLES,
  PROJECTED,
  DAMPED,
  REMEDY_OF_SOIL,
  SURFACE,
  RINGS,
  SHEETS,
  TOTAL,
  TOTAL_SETS,
  ADAPTION,
  HEAT,
  HEAT_IMPLICIT,
  HOLDING,
  SLIDING,
  TOTAL_LATTICE,
  OPTIONS
};
static const option options[OPTIONS] = {
    [ORDER_2] = {"positions of order 2", 1, 0, 0},
    [STAGGERED] = {"staggered", 1, 0, 0},
    [REMEDY] = {"locking remedy", 1, 1, 1},
    [REFERENCE] = {"reference positions", 1, 1, 1},
    [TWO_SETS] = {"two sets", 1, 1, 1},
    [FIXED] = {"fixed walls", 1, 1, 1},
    [SLIP] = {"slip walls", 1, 1, 0},
    [FRICTION] = {"friction walls", 1, 0, 0},
    [OPEN] = {"open walls", 1, 1, 0},
    [PERIODIC_X] = {"periodic x", 1, 1, 0},
    [PERIODIC] = {"periodic", 1, 1, 0},
    [PRESCRIBED] = {"prescribed particles", 1, 1, 1},
    [MOTION] = {"prescribed motion", 1, 1, 1},
    [VELOCITY] = {"prescribed nodes", 1, 1, 1},
    [ZERO_ACCELERATION] = {"zero acceleration of prescribed nodes", 1, 1, 0},
    [FORCE] = {"force", 1, 1, 1},
    [ACCELERATION] = {"acceleration", 1, 1, 1},
    [APPLIED_FORCE] = {"applied force", 1, 1, 1},
    [HOOK_P2G] = {"hook after P2G", 1, 0, 0},
    [HOOK_FORCES] = {"hook after forces", 1, 0, 0},
    [HOOK_VELOCITY] = {"hook after velocity", 1, 0, 0},
    [ALL_HOOKS] = {"hooks", 1, 0, 0},
    [KEPT] = {"acceleration and velocity gradient kept", 1, 1, 1},
    [SPARE_SIZE] = {"sizes of domains from volumes", 1, 1, 0},
    [STAGED_VELOCITY] = {"in parts, velocity written", 1, 0, 0},
    [STAGED_FORCE] = {"in parts, force written", 1, 0, 0},
    [SAVED] = {"saved and loaded", 1, 1, 1},
    [ADVANCE] = {"advance", 1, 1, 1},
    [FAILING] = {"a step fails", 1, 1, 0},
    [CHANGED] = {"another method and other particles", 1, 1, 1},
    [DIRECT] = {"LDLT", 0, 1, 1},
    [CG] = {"CG", 0, 1, 1},
    [MULTIGRID] = {"multigrid", 0, 1, 1},
    [GMRES] = {"GMRES", 0, 1, 1},
    [HOST_SOLVER] = {"host solver", 0, 1, 1},
    [EVERYTHING] = {"two sets, periodic x, and all callbacks", 1, 1, 0},
    [CONTACT] = {"contact, saved and loaded", 1, 1, 1},
    [CONTACT_PERIODIC] = {"contact, periodic", 1, 1, 0},
    [PLANES] = {"friction walls, planes", 1, 1, 0},
    [OBSTACLES] = {"obstacles, saved and loaded", 1, 1, 0},
    [PROJECTED] = {"projected positions", 1, 0, 0},
    [DAMPED] = {"nodes damped, slip walls", 1, 1, 0},
    [REMEDY_OF_SOIL] = {"locking remedy, soil and metal", 1, 1, 1},
    [SURFACE] = {"surface, saved and loaded", 1, 1, 0},
    [RINGS] = {"rings with a surface, saved and loaded", 1, 1, 1},
    [SHEETS] = {"sheets with a surface, saved and loaded", 1, 1, 0},
    [TOTAL] = {"total Lagrangian, surface and obstacles, saved and loaded", 1, 1, 0},
    [TOTAL_SETS] = {"total Lagrangian, two sets, locking remedy, all callbacks", 1, 1, 0},
    [ADAPTION] = {"splitting and merging, saved and loaded", 1, 1, 1},
    [HOLDING] = {"surface that holds, saved and loaded", 1, 1, 1},
    [SLIDING] = {"surface to slide along, saved and loaded", 1, 1, 0},
    [HEAT] = {"heat, expansion, dissipation, saved and loaded", 1, 1, 1},
    [HEAT_IMPLICIT] = {"heat, implicit conduction, saved and loaded", 1, 1, 1},
    [TOTAL_LATTICE] = {"total Lagrangian, a lattice, saved and loaded", 1, 1, 0},
};

static void apply_walls(scene *is, int32_t o) {
  static const int32_t kind[] = {[FIXED] = MPM_WALL_FIXED,
                                 [SLIP] = MPM_WALL_SLIP,
                                 [FRICTION] = MPM_WALL_FRICTION_NODES,
                                 [OPEN] = MPM_WALL_OPEN};
  if (o >= FIXED && o <= OPEN) all_walls(is, kind[o]);
  if (o == PLANES) all_walls(is, MPM_WALL_FRICTION);
  if (o == DAMPED) all_walls(is, MPM_WALL_SLIP);
  is->periodic[0] = o == PERIODIC_X || o == PERIODIC || o == EVERYTHING;
  is->periodic[1] = is->periodic[2] = o == PERIODIC;
  if (o == CONTACT_PERIODIC) is->periodic[0] = is->periodic[1] = is->periodic[2] = 1;
  if (is->periodic[0]) is->steps += is->steps / 2;
}

static void apply(scene *is, int32_t o) {
  static const int32_t with[OPTIONS] = {
      [REFERENCE] = WITH_FORCE,
      [PRESCRIBED] = WITH_PRESCRIBED,
      [MOTION] = WITH_PRESCRIBED | WITH_MOTION,
      [VELOCITY] = WITH_VELOCITY,
      [ZERO_ACCELERATION] = WITH_PRESCRIBED | WITH_MOTION | WITH_VELOCITY,
      [FORCE] = WITH_FORCE,
      [ACCELERATION] = WITH_ACCELERATION,
      [APPLIED_FORCE] = WITH_APPLIED_FORCE,
      [HOOK_P2G] = WITH_HOOK,
      [HOOK_FORCES] = WITH_HOOK << 1,
      [HOOK_VELOCITY] = WITH_HOOK << 2,
      [ALL_HOOKS] = 7 * WITH_HOOK,
      [KEPT] = WITH_KEPT,
      [SPARE_SIZE] = WITH_SPARE_SIZE,
      [SAVED] = WITH_KEPT | WITH_FORCE,
      [EVERYTHING] = WITH_FORCE | WITH_ACCELERATION | WITH_APPLIED_FORCE | WITH_VELOCITY | WITH_PRESCRIBED |
                     WITH_MOTION | WITH_KEPT,
      [CONTACT] = WITH_BODIES,
      [CONTACT_PERIODIC] = WITH_BODIES | WITH_FORCE,
      [OBSTACLES] = WITH_BODIES | WITH_OBSTACLES,
      [SURFACE] = WITH_SURFACE,
      [RINGS] = WITH_SURFACE,
      [SHEETS] = WITH_SURFACE,
      [TOTAL] = WITH_SURFACE | WITH_OBSTACLES,
      [ADAPTION] = WITH_ADAPTION | WITH_APPLIED_FORCE,
      [HOLDING] = WITH_SURFACE | WITH_HOLDING,
      [SLIDING] = WITH_SURFACE | WITH_SLIDING,
      [HEAT] = WITH_HEAT | WITH_SURFACE,
      [HEAT_IMPLICIT] = WITH_HEAT | WITH_IMPLICIT_HEAT | WITH_SURFACE,
      [TOTAL_SETS] =
          WITH_FORCE | WITH_ACCELERATION | WITH_VELOCITY | WITH_PRESCRIBED | WITH_MOTION | WITH_KEPT,
  };
  static const int32_t story[OPTIONS] = {[STAGED_VELOCITY] = STORY_STAGED_VELOCITY,
                                         [STAGED_FORCE] = STORY_STAGED_FORCE,
                                         [SAVED] = STORY_SAVED,
                                         [CONTACT] = STORY_SAVED,
                                         [OBSTACLES] = STORY_SAVED,
                                         [SURFACE] = STORY_SAVED,
                                         [RINGS] = STORY_SAVED,
                                         [SHEETS] = STORY_SAVED,
                                         [TOTAL] = STORY_SAVED,
                                         [ADAPTION] = STORY_SAVED,
                                         [HOLDING] = STORY_SAVED,
                                         [SLIDING] = STORY_SAVED,
                                         [HEAT] = STORY_SAVED,
                                         [HEAT_IMPLICIT] = STORY_SAVED,
                                         [TOTAL_LATTICE] = STORY_SAVED,
                                         [ADVANCE] = STORY_ADVANCE,
                                         [FAILING] = STORY_FAILING,
                                         [CHANGED] = STORY_CHANGED};
  static const int32_t solver[OPTIONS] = {[DIRECT] = MPM_SOLVER_LDLT,
                                          [CG] = MPM_SOLVER_CG,
                                          [MULTIGRID] = MPM_SOLVER_MULTIGRID_CG,
                                          [GMRES] = MPM_SOLVER_GMRES,
                                          [HOST_SOLVER] = MPM_SOLVER_HOST};
  is->with = with[o];
  is->story = story[o];
  is->solver = solver[o];
  is->remedy = o == REMEDY || o == REMEDY_OF_SOIL || (o == TOTAL_SETS && is->dim > 1);
  is->total = o == TOTAL || o == TOTAL_SETS || o == TOTAL_LATTICE;
  is->lattice = o == TOTAL_LATTICE;
  is->reference = o == REFERENCE;
  is->large = o == MULTIGRID;
  if (is->large) is->steps = 2;
  is->zero_acceleration = o == ZERO_ACCELERATION;
  if (o == ORDER_2) is->position_order = 2;
  is->staggered = o == STAGGERED;
  is->projected = o == PROJECTED;
  is->damped = o == DAMPED;
  is->geometry = o == RINGS ? MPM_AXISYMMETRIC : o == SHEETS ? MPM_PLANE_STRESS : MPM_PLANE_STRAIN;
  if (o == SHEETS) is->law[0] = LAW_J2;
  if (o == TWO_SETS || o == SAVED || o == EVERYTHING || o == TOTAL_SETS || is->with & WITH_BODIES)
    is->law[1] = LAW_J2;
  if (o == REMEDY_OF_SOIL) is->law[0] = LAW_MOHR_COULOMB, is->law[1] = LAW_J2;
  if (o == EVERYTHING && is->scheme != MPM_NEWMARK) is->with |= 7 * WITH_HOOK;
  apply_walls(is, o);
  if (is->with & WITH_PRESCRIBED) let_out(is);
}

static void list_options(listing *l, int32_t dim) {
  for (int32_t s = 0; s < SCHEMES; ++s)
    for (int32_t o = 0; o < OPTIONS; ++o) {
      const int32_t offered[SCHEMES] = {options[o].of_explicit, options[o].of_explicit,
                                        options[o].of_explicit, options[o].of_newmark,
                                        options[o].of_quasi_static};
      if (!offered[s] || (o == PROJECTED && schemes[s].scheme != MPM_MUSL)) continue;
      scene is = o == SPARE_SIZE  ? method(dim, s, 3, 1)
                 : o == MULTIGRID ? method(dim, s, 0, 0)
                 : o == GMRES     ? method(dim, s, 1, 0)
                                  : in_turn(dim, s, o + 2 * s + dim);
      apply(&is, o);
      if (is_offered(&is)) append(l, is, options[o].name);
    }
}

scene *list_scenes(int32_t *count) {
  listing l = {NULL, 0, 0};
  for (int32_t dim = 1; dim <= 3; ++dim) {
    list_methods(&l, dim);
    list_laws(&l, dim);
    list_options(&l, dim);
  }
  *count = l.count;
  return l.item;
}
