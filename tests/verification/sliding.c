#include "sliding.h"

#include "discs.h"

const double slide_gravity = 10.0;
static const double width = 0.8, height = 0.4, density = 1000.0;
enum { PLACES = 6, SETTLING = 2000 };
/* At the last a row of nodes lies just outside, and the next a cell above. */
static const double places[PLACES] = {0.05, 0.1, 0.37, 0.6, 0.9, 0.98};

/* The mean along a direction. */
static double mean_of(const verify_world *w, const char *field, const double *e) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *value = verify_get(w, w->set[0], field, 2), sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += (value[i] * e[0] + value[n + i] * e[1]) / (double)n;
  free(value);
  return sum;
}

static void momentum_of_body(const verify_world *w, double *p) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *m = verify_get(w, w->set[0], "mass", 1), *v = verify_get(w, w->set[0], "velocity", 2);
  p[0] = p[1] = 0.0;
  for (int64_t i = 0; i < n; ++i)
    for (int32_t c = 0; c < 2; ++c) p[c] += m[i] * v[c * n + i];
  free(m);
  free(v);
}

static void scale_velocities(const verify_world *w, mpm_particles *set, double by, const double *add) {
  mpm_view view = {.struct_size = sizeof view};
  verify_ok(w, mpm_particles_map(set, "velocity", MPM_READ | MPM_WRITE, &view));
  double *v = view.data;
  for (int64_t i = 0; i < view.count; ++i)
    for (int32_t c = 0; c < 2; ++c) {
      double *at = v + i * view.item_stride + c * view.component_stride;
      *at = *at * by + add[c];
    }
  verify_ok(w, mpm_view_release(&view));
}

typedef struct floor_frame {
  double down[2], normal[2]; /* along the slope, and out of it */
} floor_frame;

static void open_grid(verify_world *w, verify_setup *setup, const slide *a) {
  const double h = a->h, reach = (a->turn != 0.0 ? ceil(1.2 / h) * h : 0.0) + ceil(a->slab / h) * h;
  *setup = verify_defaults(2, 1, h);
  setup->grid.cells[0] = (int64_t)ceil(2.6 / h);
  setup->grid.cells[1] = (int64_t)ceil((a->radius > 0.0 ? 1.2 : 0.8) / h + reach / h) + 8;
  setup->grid.origin[0] = -8.0 * h;
  setup->grid.origin[1] = a->support == ON_WALL ? 0.0 : -8.0 * h - reach;
  setup->grid.basis = a->basis;
  setup->stepper.scheme = a->basis == MPM_LINEAR ? MPM_MUSL : MPM_USL;
  verify_open(w, setup);
}

/* The share of gravity along the support may be left out. */
static void use(verify_world *w, mpm_stepper_desc *d, support *s, const slide *a, const floor_frame *f,
                int32_t along, double friction) {
  const double down = along ? slide_gravity * sin(a->angle) : 0.0, press = -slide_gravity * cos(a->angle);
  const double point[2] = {a->shift * a->h * f->normal[0], a->shift * a->h * f->normal[1]};
  support_lay(w, s, friction, -a->turn, point);
  for (int32_t c = 0; c < 2; ++c) d->gravity[c] = down * f->down[c] + press * f->normal[c];
  verify_ok(w, mpm_stepper_configure(w->stepper, d));
}

/* Prescribed particles that reach four cells deep, below the slab. */
static void lay_ground(verify_world *w, const slide *a, const double *lift) {
  const double end = -4.0 * a->h, length = 2.2;
  for (int32_t held = a->slab > 0.0 ? 0 : 1; held < 2; ++held) {
    const uint8_t all[2] = {(uint8_t)held, (uint8_t)held};
    mpm_particles *ground = verify_set(w, w->material[0]);
    verify_fill_box(w, ground, (const double[]){end, held ? end - a->slab : -a->slab},
                    (const double[]){length, held ? -a->slab : 0.0}, 2);
    verify_place(w, ground, 0.0, lift);
    verify_ok(w, mpm_particles_set_all(ground, "prescribed", MPM_U8, 2, all));
    verify_ok(w, mpm_stepper_set_body(w->stepper, ground, 1));
  }
}

slide_outcome slide_run(const slide *a) {
  const double h = a->h, two[2] = {0.0, 0.0};
  const floor_frame f = {{cos(a->turn), -sin(a->turn)}, {sin(a->turn), cos(a->turn)}};
  const double lift[2] = {a->shift * h * f.normal[0], a->shift * h * f.normal[1]};
  const double faster = a->speed + a->push, keeps = a->keeps > 0.0 ? a->keeps : 0.99;
  const double push[2] = {faster * f.down[0], faster * f.down[1]};
  const double area = a->radius > 0.0 ? PI * a->radius * a->radius : width * height;
  verify_world w;
  verify_setup setup;
  open_grid(&w, &setup, a);
  mpm_particles *body = verify_set(&w, verify_elastic(&w, "neo_hookean", 1e6, 0.3, density));
  if (a->radius > 0.0)
    disc_fill(&w, body, (const double[]){a->radius, a->radius}, a->radius, two, 0.5 * h);
  else
    verify_fill_box(&w, body, two, (const double[]){width, height}, 2);
  verify_place(&w, body, -a->turn, lift);
  if (a->support == ON_BODY) lay_ground(&w, a, lift);
  support on = {.kind = a->support, .normal = a->normal};

  /* A block that is let go on the slope settles sticking; what is to move is free to find its place. */
  const int32_t sticks = !(a->speed > 0.0 || a->radius > 0.0);
  use(&w, &setup.stepper, &on, a, &f, sticks, sticks ? 10.0 : 0.0);
  double dt;
  for (int32_t i = 0; i < (a->settled ? SETTLING : 0); ++i) {
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    verify_step(&w, 0.4 * dt);
    for (int32_t m = 0; m < w.sets; ++m)
      scale_velocities(&w, w.set[m], i < SETTLING * 4 / 5 ? keeps : 0.95, two);
  }
  use(&w, &setup.stepper, &on, a, &f, 1, a->friction);
  scale_velocities(&w, body, 1.0, push);
  verify_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));

  const double start = mean_of(&w, "position", f.down);
  slide_outcome out = {.stopped_at = -1.0};
  double way_at_stop = 0.0, least[2] = {HUGE_VAL, HUGE_VAL}, most[2] = {-HUGE_VAL, -HUGE_VAL};
  mpm_step_info now = verify_info(&w);
  double first[2], last[2];
  momentum_of_body(&w, first);
  while (now.t < a->end) {
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, a->end - now.t + 1e-12));
    if (a->speed > 0.0 && out.stopped_at < 0.0 && mean_of(&w, "velocity", f.down) <= 0.002 * a->speed) {
      out.stopped_at = now.t;
      way_at_stop = mean_of(&w, "position", f.down) - start;
    }
    if (out.stopped_at < 0.0) continue;
    const double place = mean_of(&w, "position", f.down);
    for (int32_t k = 0; k < (now.t < a->end * 2.0 / 3.0 ? 1 : 2); ++k)
      least[k] = fmin(least[k], place), most[k] = fmax(most[k], place);
  }
  if (out.stopped_at >= 0.0) out.range = most[0] - least[0], out.late = most[1] - least[1];
  out.way = mean_of(&w, "position", f.down) - start;
  if (out.stopped_at >= 0.0) out.way = way_at_stop;
  const mpm_contact_info info = support_info(&w, &on);
  const double weight = density * area * slide_gravity * now.t;
  momentum_of_body(&w, last);
  for (int32_t c = 0; c < 2; ++c) {
    const double gained = last[c] - first[c] - density * area * setup.stepper.gravity[c] * now.t;
    out.balance = fmax(out.balance, fabs(info.impulse[c] - gained) / weight);
  }
  const double up = info.impulse[0] * f.normal[0] + info.impulse[1] * f.normal[1];
  out.weight = up / (weight * cos(a->angle));
  out.friction = -(info.impulse[0] * f.down[0] + info.impulse[1] * f.down[1]) / up;
  out.spin = -disc_spin(&w, body, f.down, &(double){0.0});
  verify_close(&w);
  return out;
}

const char *slide_basis(int32_t basis) {
  static const char *const name[] = {[MPM_LINEAR] = "linear",
                                     [MPM_BSPLINE2] = "quadratic",
                                     [MPM_BSPLINE3] = "cubic",
                                     [MPM_GIMP] = "GIMP",
                                     [MPM_CPGIMP] = "cpGIMP"};
  return name[basis];
}

void slide_heading(FILE *table) {
  fprintf(table, "case,name,cells,shift,way,exact,friction,weight,stopped,range\n");
}

/* Finite elements creep by 1.54 mm where they are let go while they swing (contact_release). */
static const double most_of_elements = 2e-3;

void slide_gates(const slide_series *s, FILE *table) {
  double low = HUGE_VAL, high = 0.0, creep = 0.0, swings = 0.0, way[2] = {HUGE_VAL, 0.0}, range = 0.0,
         late = 0.0, weight = 0.0, balance = 0.0;
  const int32_t count = s->support == ON_WALL || verify_quick() ? 1 : s->places;
  for (int32_t k = 0; k < count; ++k) {
    slide a = {.support = s->support,
               .basis = s->basis,
               .settled = 1,
               .h = s->h > 0.0 ? s->h : 0.05,
               .slab = s->slab,
               .angle = PI / 6.0,
               .friction = 0.3,
               .shift = s->support == ON_WALL ? 0.0 : (s->place ? s->place : places)[k],
               .turn = s->turn,
               .end = 0.5};
    const double exact = 0.5 * slide_gravity * (sin(a.angle) - a.friction * cos(a.angle)) * 0.25;
    slide_outcome o = slide_run(&a);
    fprintf(table, "slides,%s,%g,%g,%.6f,%.6f,%.5f,%.5f,,\n", s->name, 1.0 / a.h, a.shift, o.way, exact,
            o.friction, o.weight);
    low = fmin(low, o.way / exact);
    high = fmax(high, o.way / exact);
    weight = fmax(weight, fabs(o.weight - 1.0));
    balance = fmax(balance, o.balance);
    a.friction = 0.7;
    o = slide_run(&a);
    fprintf(table, "swings,%s,%g,%g,%.6f,0,%.5f,%.5f,,\n", s->name, 1.0 / a.h, a.shift, o.way, o.friction,
            o.weight);
    swings = fmax(swings, fabs(o.way));
    a.keeps = 0.96; /* what is to rest has settled: it swings no more */
    o = slide_run(&a);
    fprintf(table, "rests,%s,%g,%g,%.6f,0,%.5f,%.5f,,\n", s->name, 1.0 / a.h, a.shift, o.way, o.friction,
            o.weight);
    creep = fmax(creep, fabs(o.way));
    a.friction = 0.3, a.keeps = 0.0, a.angle = 0.0, a.speed = 1.5, a.end = 1.5;
    o = slide_run(&a);
    fprintf(table, "stops,%s,%g,%g,%.6f,0.375,%.5f,%.5f,%.5f,%.6f\n", s->name, 1.0 / a.h, a.shift, o.way,
            o.friction, o.weight, o.stopped_at, o.range);
    way[0] = fmin(way[0], o.way), way[1] = fmax(way[1], o.way);
    range = fmax(range, o.range), late = fmax(late, o.late);
    verify_progress("%s, at %g h", s->name, a.shift);
  }
  const struct {
    const char *what;
    double value, low, high;
    const char *reason;
  } gates[] = {
      {"slides down the slope, least way / exact", low, 1.0 - s->sliding, 1.0 + s->sliding, NULL},
      {"slides down the slope, largest way / exact", high, 1.0 - s->sliding, 1.0 + s->sliding, NULL},
      {"slides down the slope, floor force / weight - 1", weight, 0.0, s->weight, s->hops},
      {"slides down the slope, impulse less weight and momentum / weight", balance, 0.0, 1e-11, NULL},
      {"rests on the slope, creep in 0.5 s, m", creep, 0.0, s->creep, NULL},
      {"let go while it swings, creep in 0.5 s, m", swings, 0.0, fmax(s->creep, most_of_elements), s->creeps},
      {"stops on the level, least way / exact", way[0] / 0.375, 1.0 - s->stopping, 1.0 + s->stopping, NULL},
      {"stops on the level, largest way / exact", way[1] / 0.375, 1.0 - s->stopping, 1.0 + s->stopping, NULL},
      /* an elastic slab springs back with it */
      {"rests on the level, moves from its stop to 1.5 s, m", range, 0.0,
       s->slab > 0.0 || s->turn != 0.0 ? 0.0 : 2e-3, NULL},
      {"rests on the level, moves from 1 to 1.5 s, m", late, 0.0, 1e-3, NULL}};
  const char *source = "Coulomb's law; set tolerance";
  for (size_t i = 0; i < sizeof gates / sizeof *gates; ++i) {
    char what[120];
    if (!(gates[i].high > 0.0)) continue;
    snprintf(what, sizeof what, "%s: %s", s->name, gates[i].what);
    verify_judge(what, gates[i].value, gates[i].low, gates[i].high, source, gates[i].reason);
  }
}
