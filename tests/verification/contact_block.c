/* An elastic block, 0.8 by 0.4, E = 1e6, nu = 0.3, density 1000, on a rigid floor of prescribed particles,
 * g = 10: it slides down a slope of 30 degrees or rests there, and it slides on a level floor until it
 * stops. Coulomb's law gives the exact answers. The floor lies at several places in its cell. */
#include "verify.h"

static const double gravity = 10.0, width = 0.8, height = 0.4;
enum { FLOORS = 5, SETTLING = 2000 };
static const double floors[FLOORS] = {0.05, 0.1, 0.37, 0.6, 0.9};

typedef struct slide {
  int32_t basis;
  double h, angle, friction, speed, shift, end; /* shift: of the floor, in cells */
} slide;

typedef struct outcome {
  double way, stopped_at, after; /* after: way from the stop to the end */
  double friction, weight;       /* mean forces over those of Coulomb and of gravity */
} outcome;

static void place(const verify_world *w, mpm_particles *set, double lift) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2);
  for (int64_t i = 0; i < n; ++i) x[n + i] += lift;
  verify_put(w, set, "position", 2, x);
  free(x);
}

static double mean_of(const verify_world *w, const mpm_particles *set, const char *field) {
  const int64_t n = mpm_particles_count(set);
  double *value = verify_get(w, set, field, 2), sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += value[i] / (double)n;
  free(value);
  return sum;
}

static void scale_velocities(mpm_particles *set, const verify_world *w, double by, double add) {
  mpm_view view = {.struct_size = sizeof view};
  verify_ok(w, mpm_particles_map(set, "velocity", MPM_READ | MPM_WRITE, &view));
  double *v = view.data;
  for (int64_t i = 0; i < view.count; ++i)
    for (int32_t c = 0; c < 2; ++c) {
      double *at = v + i * view.item_stride + c * view.component_stride;
      *at = *at * by + (c ? 0.0 : add);
    }
  verify_ok(w, mpm_view_release(&view));
}

static void use(verify_world *w, mpm_stepper_desc *d, double gx, double friction) {
  mpm_contact_desc contact;
  verify_ok(w, mpm_contact_desc_init(&contact, sizeof contact));
  contact.friction = friction;
  verify_ok(w, mpm_stepper_set_contact(w->stepper, 0, 1, &contact));
  d->gravity[0] = gx;
  verify_ok(w, mpm_stepper_configure(w->stepper, d));
}

static outcome run(const slide *a) {
  const double h = a->h, zero = -4.0 * h, lift = a->shift * h, two[2] = {0.0, 0.0};
  verify_setup setup = verify_defaults(2, 1, h);
  setup.grid.cells[0] = (int64_t)ceil(2.6 / h);
  setup.grid.cells[1] = (int64_t)ceil(0.8 / h) + 8;
  setup.grid.origin[0] = -8.0 * h;
  setup.grid.origin[1] = 2.0 * zero;
  setup.grid.basis = a->basis;
  setup.stepper.scheme = a->basis == MPM_LINEAR ? MPM_MUSL : MPM_USL;
  setup.stepper.gravity[1] = -gravity * cos(a->angle);
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *block = verify_set(&w, verify_elastic(&w, "neo_hookean", 1e6, 0.3, 1000.0));
  mpm_particles *ground = verify_set(&w, w.material[0]);
  verify_fill_box(&w, block, two, (const double[]){width, height}, 2);
  verify_fill_box(&w, ground, (const double[]){zero, zero}, (const double[]){2.2, 0.0}, 2);
  place(&w, block, lift);
  place(&w, ground, lift);
  const uint8_t all[2] = {1, 1};
  verify_ok(&w, mpm_particles_set_all(ground, "prescribed", MPM_U8, 2, all));
  verify_ok(&w, mpm_stepper_set_body(w.stepper, ground, 1));

  /* it settles under damping: on the slope it sticks, on the level it is free to find its place */
  use(&w, &setup.stepper, a->speed > 0.0 ? 0.0 : gravity * sin(a->angle), a->speed > 0.0 ? 0.0 : 10.0);
  double dt;
  for (int32_t i = 0; i < SETTLING; ++i) {
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    verify_step(&w, 0.4 * dt);
    scale_velocities(block, &w, i < SETTLING * 4 / 5 ? 0.99 : 0.95, 0.0);
  }
  use(&w, &setup.stepper, gravity * sin(a->angle), a->friction);
  scale_velocities(block, &w, 1.0, a->speed);
  verify_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));

  const double start = mean_of(&w, block, "position");
  outcome out = {.stopped_at = -1.0};
  double way_at_stop = 0.0;
  mpm_step_info now = verify_info(&w);
  while (now.t < a->end) {
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, a->end - now.t + 1e-12));
    if (a->speed > 0.0 && out.stopped_at < 0.0 && mean_of(&w, block, "velocity") <= 0.002 * a->speed) {
      out.stopped_at = now.t;
      way_at_stop = mean_of(&w, block, "position") - start;
    }
  }
  out.way = mean_of(&w, block, "position") - start;
  out.after = fabs(out.way - way_at_stop);
  if (out.stopped_at >= 0.0) out.way = way_at_stop;
  mpm_contact_info info = {.struct_size = sizeof info};
  verify_ok(&w, mpm_stepper_contact_info(w.stepper, 1, 0, &info));
  out.weight = info.impulse[1] / (1000.0 * width * height * gravity * cos(a->angle) * now.t);
  out.friction = -info.impulse[0] / info.impulse[1];
  verify_close(&w);
  return out;
}

static const char *name_of(int32_t basis) {
  return basis == MPM_LINEAR ? "linear" : basis == MPM_BSPLINE2 ? "quadratic" : "cubic";
}

int main(int argc, char **argv) {
  verify_begin("contact_block", argc, argv);
  FILE *table = verify_csv("contact_block");
  fprintf(table, "case,basis,shift,way,exact,friction,weight,stopped,after\n");
  const char *source = "Coulomb's law; set tolerance";
  const int32_t basis[3] = {MPM_BSPLINE2, MPM_LINEAR, MPM_BSPLINE3}, kinds = verify_quick() ? 1 : 3;
  for (int32_t b = 0; b < kinds; ++b) {
    double low = HUGE_VAL, high = 0.0, creep = 0.0, way[2] = {HUGE_VAL, 0.0}, after = 0.0, weight = 0.0;
    for (int32_t f = 0; f < (verify_quick() ? 2 : FLOORS); ++f) {
      slide a = {
          .basis = basis[b], .h = 0.05, .angle = PI / 6.0, .friction = 0.3, .shift = floors[f], .end = 0.5};
      const double exact = 0.5 * gravity * (sin(a.angle) - a.friction * cos(a.angle)) * 0.25;
      outcome o = run(&a);
      fprintf(table, "slides,%s,%g,%.6f,%.6f,%.5f,%.5f,,\n", name_of(a.basis), a.shift, o.way, exact,
              o.friction, o.weight);
      low = fmin(low, o.way / exact);
      high = fmax(high, o.way / exact);
      weight = fmax(weight, fabs(o.weight - 1.0));
      a.friction = 0.7;
      o = run(&a);
      fprintf(table, "rests,%s,%g,%.6f,0,%.5f,%.5f,,\n", name_of(a.basis), a.shift, o.way, o.friction,
              o.weight);
      creep = fmax(creep, fabs(o.way));
      a = (slide){
          .basis = basis[b], .h = 0.05, .friction = 0.3, .speed = 1.5, .shift = floors[f], .end = 1.5};
      o = run(&a);
      fprintf(table, "stops,%s,%g,%.6f,0.375,%.5f,%.5f,%.5f,%.6f\n", name_of(a.basis), a.shift, o.way,
              o.friction, o.weight, o.stopped_at, o.after);
      way[0] = fmin(way[0], o.way), way[1] = fmax(way[1], o.way);
      after = fmax(after, o.after);
      verify_progress("%s, floor at %g h", name_of(a.basis), floors[f]);
    }
    const struct {
      const char *what;
      double value, low, high;
      int32_t linear; /* 1: met with the linear basis, too */
    } gates[] = {{"slides down the slope, least way / exact", low, 0.98, 1.02, 0},
                 {"slides down the slope, largest way / exact", high, 0.98, 1.02, 1},
                 {"slides down the slope, floor force / weight - 1", weight, 0.0, 0.02, 1},
                 {"rests on the slope, creep in 0.5 s, m", creep, 0.0, 1e-3, 0},
                 {"stops on the level, least way / exact", way[0] / 0.375, 0.97, 1.03, 0},
                 {"stops on the level, largest way / exact", way[1] / 0.375, 0.97, 1.03, 1},
                 {"rests on the level, moves in 1 s, m", after, 0.0, 2e-3, 0}};
    for (size_t i = 0; i < sizeof gates / sizeof *gates; ++i) {
      char what[120];
      snprintf(what, sizeof what, "%s: %s", name_of(basis[b]), gates[i].what);
      if (basis[b] == MPM_LINEAR && !gates[i].linear)
        verify_expected_failure(
            what, gates[i].value, gates[i].low, gates[i].high, source,
            "forces jump where particles cross cells of the linear basis: the block trembles "
            "at some places of the floor");
      else
        verify_gate(what, gates[i].value, gates[i].low, gates[i].high, source);
    }
  }
  fclose(table);
  return verify_end();
}
