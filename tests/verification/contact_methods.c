/* The scenes of contact on coarse grids by every explicit scheme, three transfers and four bases: momentum is
 * what forces and contact gave, and no method has more energy than it was given. The linear basis goes with
 * MUSL alone. */
#include "discs.h"

#include <string.h>

enum { SCHEMES = 3, TRANSFERS = 3, BASES = 4, MOST_BODIES = 5 };
static const int32_t schemes[SCHEMES] = {MPM_USL, MPM_USF, MPM_MUSL},
                     transfers[TRANSFERS] = {MPM_FLIP, MPM_APIC, MPM_TFLIP},
                     bases[BASES] = {MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP, MPM_LINEAR};
static const char *const scheme_name[SCHEMES] = {"USL", "USF", "MUSL"},
                         *const transfer_name[TRANSFERS] = {"FLIP", "APIC", "TFLIP"},
                         *const basis_name[BASES] = {"quadratic", "cubic", "GIMP", "linear"};

typedef struct body {
  double lower[2], upper[2], v[2]; /* a box; a disc in it where `round` is set */
  double E, density;               /* 0: prescribed, at rest */
  int32_t round;
} body;

typedef struct scene {
  const char *name;
  int32_t dim;
  double h, lower[2], upper[2];         /* of the grid */
  double friction, gravity, angle, end; /* angle: of a slope, whose surface is the line y = 0 */
  double nu, shift;
  int32_t plane; /* an obstacle is there in place of a body */
  body bodies[MOST_BODIES];
} scene;

/* What scenes share: lines of bars of unit speed of sound, discs that fly, blocks on a floor. */
#define BARS(from, to, time) .dim = 1, .h = 0.05, .lower = {from}, .upper = {to}, .end = time
#define BAR(from, to, speed, stiff)                                                                          \
  { {from}, {to}, {speed}, stiff, stiff, 0 }
#define DISCS .dim = 2, .h = 0.05, .lower = {-0.7, -0.7}, .upper = {0.7, 0.7}, .end = 3.6, .nu = 0.3
#define DISC(x, y, vx, vy)                                                                                   \
  { {x, y}, {x + 0.4, y + 0.4}, {vx, vy}, 1e3, 1e3, 1 }
#define FLOOR                                                                                                \
  .dim = 2, .h = 0.1, .lower = {-1.0, -0.5}, .upper = {2.4, 1.0}, .nu = 0.3, .friction = 0.3, .gravity = 10.0
#define BLOCK(speed)                                                                                         \
  {                                                                                                          \
    {{0.0, 0.0}, {0.8, 0.4}, {speed, 0.0}, 1e6, 1e3, 0}, {                                                   \
      {-0.8, -0.3}, {2.2, 0.0}, {0.0, 0.0}, 0.0, 1e3, 0                                                      \
    }                                                                                                        \
  }

/* Those of the other cases; discs that meet fly at 45 degrees or are turned from it. */
static const scene scenes[] = {
    {.name = "bars of one kind",
     BARS(-1.0, 2.5, 3.0),
     .bodies = {BAR(-0.6, 0.0, 0.01, 1.0), BAR(0.0, 1.5, 0.0, 1.0)}},
    {.name = "strips",
     .dim = 2,
     .h = 0.1,
     .lower = {-1.2, -0.5},
     .upper = {2.5, 0.8},
     .end = 3.0,
     .bodies = {{{-0.6, 0.0}, {0.0, 0.3}, {0.01, 0.0}, 1.0, 1.0, 0},
                {{0.0, 0.0}, {1.5, 0.3}, {0.0, 0.0}, 1.0, 1.0, 0}}},
    {.name = "bars with a gap",
     BARS(-1.5, 1.5, 4.0),
     .bodies = {BAR(-1.003, -0.003, 0.01, 1.0), BAR(0.0, 1.0, 0.0, 1.0)}},
    {.name = "bars of two kinds",
     BARS(-1.5, 1.5, 3.0),
     .bodies = {BAR(-1.0, 0.0, 0.01, 1.0), BAR(0.0, 1.0, 0.0, 4.0)}},
    {.name = "five bars",
     BARS(-1.0, 3.5, 5.0),
     .bodies = {BAR(-0.5, 0.0, 0.01, 1.0), BAR(0.0, 0.5, 0.0, 1.0), BAR(0.5, 1.0, 0.0, 1.0),
                BAR(1.0, 1.5, 0.0, 1.0), BAR(1.5, 2.0, 0.0, 1.0)}},
    {.name = "discs", DISCS, .bodies = {DISC(-0.5, -0.5, 0.1, 0.1), DISC(0.1, 0.1, -0.1, -0.1)}},
    {.name = "discs, elsewhere",
     DISCS,
     .shift = 0.37,
     .bodies = {DISC(-0.5, -0.35, 0.13, 0.05), DISC(0.1, -0.05, -0.13, -0.05)}},
    {.name = "discs, oblique, friction",
     DISCS,
     .friction = 0.3,
     .bodies = {DISC(-0.5, -0.3, 0.14, 0.0), DISC(0.1, -0.1, -0.14, 0.0)}},
    {.name = "block down a slope", FLOOR, .end = 0.5, .angle = 30.0, .shift = 0.37, .bodies = BLOCK(0.0)},
    {.name = "block that comes to rest", FLOOR, .end = 0.8, .shift = 0.6, .bodies = BLOCK(1.5)},
    {.name = "disc that rolls",
     .dim = 2,
     .h = 0.08,
     .lower = {-0.8, -0.4},
     .upper = {1.6, 1.2},
     .end = 0.6,
     .nu = 0.3,
     .friction = 0.5,
     .gravity = 10.0,
     .angle = 30.0,
     .plane = 1,
     .bodies = {{{-0.4, 0.0}, {0.4, 0.8}, {0.0, 0.0}, 1e6, 1e3, 1}}},
    {.name = "disc against a plane",
     .dim = 2,
     .h = 0.025,
     .lower = {-0.5, -0.3},
     .upper = {0.5, 0.8},
     .end = 3.6,
     .nu = 0.3,
     .plane = 1,
     .bodies = {DISC(-0.2, 0.05, 0.0, -0.14)}},
};
enum { SCENES = sizeof scenes / sizeof scenes[0] };

static void fill(verify_world *w, const scene *s) {
  for (int32_t m = 0; m < MOST_BODIES && s->bodies[m].density > 0.0; ++m) {
    const body *b = &s->bodies[m];
    const uint8_t held[2] = {1, 1};
    mpm_particles *set =
        verify_set(w, verify_elastic(w, "neo_hookean", b->E > 0.0 ? b->E : 1e6, s->nu, b->density));
    if (b->round) {
      const double centre[2] = {0.5 * (b->lower[0] + b->upper[0]), 0.5 * (b->lower[1] + b->upper[1])};
      disc_fill(w, set, centre, 0.5 * (b->upper[0] - b->lower[0]), b->v, 0.5 * s->h);
    } else {
      verify_fill_box(w, set, b->lower, b->upper, 2);
      verify_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, s->dim, b->v));
    }
    if (!(b->E > 0.0)) verify_ok(w, mpm_particles_set_all(set, "prescribed", MPM_U8, s->dim, held));
    verify_ok(w, mpm_stepper_set_body(w->stepper, set, m));
  }
}

/* Largest error of momentum over the momenta of the bodies, and energy above that of the start over it, both
 * less what forces gave. */
typedef struct outcome {
  double momentum, energy, dissipation;
} outcome;

static void take_worst(outcome *worst, const outcome *other) {
  worst->momentum = fmax(worst->momentum, other->momentum);
  worst->energy = fmax(worst->energy, other->energy);
  worst->dissipation = fmin(worst->dissipation, other->dissipation);
}

static void gates(const char *name, const outcome *worst) {
  const char *never = "contact takes energy and never gives any";
  char what[120];
  snprintf(what, sizeof what, "%s, 30 methods", name);
  verify_gate_of(what, "momentum less impulses, over all", worst->momentum, 0.0, 1e-12, "conservation");
  verify_gate_of(what, "energy above that of the start, over it", worst->energy, 0.0, 5e-4, never);
  verify_gate_of(what, "least dissipation of a step / energy", worst->dissipation, -1e-12, 0.0, never);
}

static double mass_of(const verify_world *w, const mpm_particles *set) {
  double *m = verify_get(w, set, "mass", 1), sum = 0.0;
  for (int64_t i = 0; i < mpm_particles_count(set); ++i) sum += m[i];
  free(m);
  return sum;
}

static outcome run(const scene *s, int32_t scheme, int32_t transfer, int32_t basis) {
  verify_setup setup = verify_defaults(s->dim, 1, s->h);
  const double slope = s->angle * PI / 180.0, pull[2] = {s->gravity * sin(slope), -s->gravity * cos(slope)};
  for (int32_t c = 0; c < s->dim; ++c) {
    setup.grid.cells[c] = lround((s->upper[c] - s->lower[c]) / s->h) + 2;
    setup.grid.origin[c] = s->lower[c] - s->shift * s->h;
    setup.stepper.gravity[c] = pull[c];
  }
  setup.grid.basis = basis;
  setup.stepper.scheme = scheme;
  setup.stepper.transfer = transfer;
  verify_world w;
  verify_open(&w, &setup);
  mpm_contact_desc contact;
  mpm_obstacle_desc plane =
      verify_obstacle_defaults(&contact, MPM_SHAPE_PLANE, MPM_MOTION_FIXED, s->friction, 0.0);
  verify_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &contact));
  fill(&w, s);
  mpm_obstacle *ground = s->plane ? verify_obstacle(&w, &plane) : NULL;
  const int32_t held = w.sets > 1 && !(s->bodies[1].E > 0.0);
  const double mass = s->gravity > 0.0 ? mass_of(&w, w.set[0]) : 0.0;
  const mpm_step_info first = verify_info(&w);
  double start = first.kinetic_energy + first.strain_energy, scale = 0.0;
  for (int32_t m = 0; m < w.sets; ++m)
    scale += mass_of(&w, w.set[m]) * hypot(s->bodies[m].v[0], s->bodies[m].v[1]);
  /* what starts at rest is measured by what its weight gives it in all */
  if (!(start > 0.0)) start = 0.5 * mass * pow(pull[0] * s->end, 2);
  if (!(scale > 0.0)) scale = mass * fabs(pull[0]) * s->end;
  outcome out = {0.0, 0.0, 0.0};
  mpm_advance_desc one;
  verify_ok(&w, mpm_advance_desc_init(&one, sizeof one));
  one.t_end = s->end;
  one.cfl = scheme == MPM_USL ? 0.25 : scheme == MPM_MUSL ? 0.2 : 0.4;
  one.max_steps = 1;
  for (mpm_step_info now = first; now.t < s->end;) {
    now = (mpm_step_info){.struct_size = sizeof now};
    if (mpm_advance(w.stepper, &one, &now)) {
      verify_progress("%s: %s", s->name, mpm_last_error(w.context));
      out.momentum = out.energy = HUGE_VAL;
      break;
    }
    const double energy = now.kinetic_energy + now.affine_kinetic_energy + now.strain_energy -
                          first.kinetic_energy - first.strain_energy - now.external_work_total;
    mpm_contact_info got = {.struct_size = sizeof got};
    if (ground) verify_ok(&w, mpm_obstacle_contact_info(ground, MPM_BODY_ANY, &got));
    if (held) verify_ok(&w, mpm_stepper_contact_info(w.stepper, 1, 0, &got));
    for (int32_t c = 0; c < s->dim; ++c)
      out.momentum =
          fmax(out.momentum,
               fabs(now.momentum[c] - first.momentum[c] - got.impulse[c] - mass * pull[c] * now.t) / scale);
    out.energy = fmax(out.energy, energy / start);
    out.dissipation = fmin(out.dissipation, now.contact_dissipation / start);
  }
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("contact_methods", argc, argv);
  FILE *table = verify_csv("contact_methods");
  fprintf(table, "scene,scheme,transfer,basis,momentum,energy,dissipation\n");
  for (int32_t k = 0; k < SCENES; k += verify_quick() ? 5 : 1) {
    outcome worst = {0.0, 0.0, 0.0};
    for (int32_t m = 0; m < SCHEMES * TRANSFERS * BASES; ++m) {
      const int32_t a = m / (TRANSFERS * BASES), b = m / BASES % TRANSFERS, c = m % BASES;
      if (bases[c] == MPM_LINEAR && schemes[a] != MPM_MUSL) continue;
      const outcome out = run(&scenes[k], schemes[a], transfers[b], bases[c]);
      fprintf(table, "\"%s\",%s,%s,%s,%.3e,%.6e,%.3e\n", scenes[k].name, scheme_name[a], transfer_name[b],
              basis_name[c], out.momentum, out.energy, out.dissipation);
      take_worst(&worst, &out);
    }
    verify_progress("%s", scenes[k].name);
    gates(scenes[k].name, &worst);
  }
  fclose(table);
  return verify_end();
}
