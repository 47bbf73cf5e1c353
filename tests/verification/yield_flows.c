/* Steady flows of materials that yield, in a strip that is periodic along x. A channel of half-width H = 0.5
 * between walls that hold, driven from rest by a pressure gradient G, of Bingham and Herschel-Bulkley fluids:
 * with the plug w = yield / G,
 *
 *   u(y) = n / (n + 1) (G / k)^(1/n) ((H - w)^(1 + 1/n) - (|y| - w)^(1 + 1/n)),  |y| > w.
 *
 * Grains that run down a slope of angle theta, by mu_i: mu(I) = tan theta is met by one I, and (Bagnold)
 *
 *   u(y) = 2/3 I / d sqrt(phi g cos theta) (H^1.5 - (H - y)^1.5)
 *
 * with the share phi of the volume that is grains. */
#include "verify.h"

enum { WIDE = 4, PER_CELL = 2 };

/* Writes the profile, and returns the mean, over the particles, of |u - exact| over a speed. */
typedef double (*profile_fn)(const void *flow, double y);
static double compare(const verify_world *w, const char *name, profile_fn exact, const void *flow,
                      double speed, FILE *csv) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *x = verify_get(w, w->set[0], "position", 2), *v = verify_get(w, w->set[0], "velocity", 2);
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    const double u = exact(flow, x[n + i]);
    sum += fabs(v[i] - u);
    if (csv) fprintf(csv, "\"%s\",%.5f,%.6f,%.6f\n", name, x[n + i], v[i] / speed, u / speed);
  }
  free(x), free(v);
  return sum / ((double)n * speed);
}

static mpm_particles *open_strip(verify_world *w, int32_t cells, double height, double over, double angle,
                                 double g, const char *model, const mpm_param *params, int32_t count) {
  const double h = height / cells;
  verify_setup setup = verify_defaults(2, WIDE, h);
  setup.grid.cells[1] = cells + (int64_t)over;
  setup.grid.periodic[0] = 1;
  setup.grid.boundary_basis = MPM_BOUNDARY_OPEN_KNOT;
  setup.stepper.transfer = MPM_APIC;
  setup.stepper.gravity[0] = g * sin(angle);
  setup.stepper.gravity[1] = -g * cos(angle);
  verify_open(w, &setup);
  mpm_particles *set = verify_set(w, verify_material(w, model, params, count));
  verify_fill_box(w, set, (const double[]){0.0, 0.0}, (const double[]){WIDE * h, height}, PER_CELL);
  verify_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  return set;
}

/* ---- the channel -------------------------------------------------------------------------------------- */
typedef struct channel {
  const char *name;
  double yield, k, n, gradient;
  double fastest, flux; /* of the whole width, by the formula */
} channel;
static const double half = 0.5;

/* y from the wall. */
static double in_channel(const void *flow, double y) {
  const channel *is = flow;
  const double plug = is->yield / is->gradient, power = 1.0 + 1.0 / is->n;
  const double off = fmax(half - y - plug, 0.0);
  return is->n / (is->n + 1.0) * pow(is->gradient / is->k, 1.0 / is->n) *
         (pow(half - plug, power) - pow(off, power));
}

static void run_channel(const channel *is, int32_t cells, double until, FILE *csv) {
  const double density = 1.0;
  const mpm_param mud[] = {{"density", density},       {"bulk_modulus", 1e5},  {"shear_modulus", 1e4},
                           {"yield_shear", is->yield}, {"consistency", is->k}, {"n", is->n}};
  verify_world w;
  /* the pressure gradient is a weight along x */
  mpm_particles *set =
      open_strip(&w, cells, half, 0.0, 0.5 * PI, is->gradient / density, "herschel_bulkley", mud, 6);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MAX, MPM_WALL_SLIP, 0.0));
  verify_advance(&w, 0.4, until);
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 2), *v = verify_get(&w, set, "velocity", 2);
  double fastest = 0.0, flux = 0.0, plug = 0.0, moving = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    fastest = fmax(fastest, v[i]);
    flux += 2.0 * half * v[i] / (double)n;
    if (x[n + i] > half - 0.8 * is->yield / is->gradient) plug += v[i], moving += 1.0;
  }
  plug /= moving;
  double uneven = 0.0;
  for (int64_t i = 0; i < n; ++i)
    if (x[n + i] > half - 0.8 * is->yield / is->gradient) uneven = fmax(uneven, fabs(v[i] / plug - 1.0));
  free(x), free(v);
  verify_gate_of(is->name, "speed of the plug over exact", plug / is->fastest, 0.97, 1.03,
                 "closed form; set gate");
  verify_gate_of(is->name, "largest speed over exact", fastest / is->fastest, 0.97, 1.03,
                 "closed form; set gate");
  verify_gate_of(is->name, "flux over exact", flux / is->flux, 0.97, 1.03, "closed form; set gate");
  verify_gate_of(is->name, "largest speed within the plug over its mean, less 1", uneven, 0.0, 0.01,
                 "a rigid plug");
  verify_gate_of(is->name, "profile: mean error over the speed of the plug",
                 compare(&w, is->name, in_channel, is, is->fastest, csv), 0.0, 0.02, "closed form; set gate");
  verify_close(&w);
}

/* ---- the slope ---------------------------------------------------------------------------------------- */
static const double g = 9.81, mu_s = 0.3819, mu_2 = 0.6435, I_0 = 0.279, grain = 0.01, grain_density = 2500.0;
static const double share = 0.6, depth = 0.4;
typedef struct slope {
  const char *name;
  double degrees, surface; /* speed of the surface by the formula */
  double from, until;      /* the speed at the start over that of the formula; time */
} slope;

static double on_slope(const void *flow, double y) {
  const slope *is = flow;
  const double angle = is->degrees * PI / 180.0, friction = tan(angle);
  const double I = I_0 * (friction - mu_s) / (mu_2 - friction);
  return 2.0 / 3.0 * I / grain * sqrt(share * g * cos(angle)) *
         (pow(depth, 1.5) - pow(fmax(depth - y, 0.0), 1.5));
}

static void run_slope(const slope *is, int32_t cells, FILE *csv) {
  const double angle = is->degrees * PI / 180.0, density = share * grain_density;
  const mpm_param grains[] = {
      {"E", 1e6},     {"nu", 0.3},  {"density", density},      {"mu_s", mu_s},
      {"mu_2", mu_2}, {"I_0", I_0}, {"grain_diameter", grain}, {"grain_density", grain_density}};
  verify_world w;
  mpm_particles *set = open_strip(&w, cells, depth, 4.0, angle, g, "mu_i", grains, 8);
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 2), *stress = verify_array(6 * n), *start = verify_array(2 * n);
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t c = 0; c < 3; ++c) stress[c * n + i] = -density * g * cos(angle) * (depth - x[n + i]);
    start[i] = is->from * on_slope(is, x[n + i]);
  }
  verify_put(&w, set, "stress", 6, stress);
  verify_put(&w, set, "velocity", 2, start);
  free(x), free(stress), free(start);
  verify_advance(&w, 0.4, is->until);
  double surface = 0.0, middle = 0.0, on_top = 0.0, between = 0.0;
  const double h = depth / cells;
  double *at = verify_get(&w, set, "position", 2), *v = verify_get(&w, set, "velocity", 2);
  for (int64_t i = 0; i < n; ++i) {
    const double u = on_slope(is, at[n + i]);
    if (at[n + i] > depth - h) surface += v[i] / u, on_top += 1.0;
    if (fabs(at[n + i] - 0.5 * depth) < h) middle += v[i] / u, between += 1.0;
  }
  free(at), free(v);
  verify_gate_of(is->name, "speed of the surface over exact", surface / on_top, 0.95, 1.05,
                 "Bagnold; set gate");
  verify_gate_of(is->name, "speed at half depth over exact", middle / between, 0.95, 1.05,
                 "Bagnold; set gate");
  verify_gate_of(is->name, "profile: mean error over the speed of the surface",
                 compare(&w, is->name, on_slope, is, is->surface, csv), 0.0, 0.05, "Bagnold; set gate");
  verify_close(&w);
}

int main(int argc, char **argv) {
  static const channel channels[] = {{"Bingham", 50.0, 20.0, 1.0, 200.0, 0.3125, 0.2604167},
                                     {"n = 0.5", 50.0, 20.0, 0.5, 200.0, 0.5208333, 0.4557292},
                                     {"n = 0.6", 30.0, 10.0, 0.6, 120.0, 0.5850236, 0.5052477}};
  static const slope slopes[] = {{"24 degrees, from rest", 24.0, 3.4851280, 0.0, 30.0},
                                 {"26 degrees, from 0.9", 26.0, 7.3533624, 0.9, 18.0}};
  verify_begin("yield_flows", argc, argv);
  FILE *in = verify_csv("yield_flows_channel"), *on = verify_csv("yield_flows_slope");
  fprintf(in, "flow,y,u,u_exact\n");
  fprintf(on, "flow,y,u,u_exact\n");
  const int32_t quick = verify_quick();
  for (int32_t k = 0; k < (quick ? 1 : 3); ++k) run_channel(&channels[k], 20, 0.3, in);
  for (int32_t k = 0; k < (quick ? 0 : 2); ++k) run_slope(&slopes[k], 20, on);
  fclose(in), fclose(on);
  return verify_end();
}
