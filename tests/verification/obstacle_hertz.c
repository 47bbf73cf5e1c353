/* An elastic sphere, radius 0.3, E = 1e5, nu = 0.3, density 1000, hits the plane of an obstacle and a
 * friction wall with speed 0.1, without friction: a quarter of it, between planes of symmetry. Or two such
 * spheres meet with half that speed each. Hertz: m w'' = -K w^(3/2) with K = 4/3 E / (1 - nu^2) sqrt(R),
 * which holds for slow impacts; for two spheres E, R and m are halves. */
#include "support.h"

static const double R = 0.3, E = 1e5, nu = 0.3, density = 1000.0, speed = 0.1;

typedef struct hertz {
  double time, depth, force;
} hertz;

/* share: 1 for a sphere on a plane, 1/2 for two spheres. */
static hertz theory(double share) {
  const double mass = share * 4.0 / 3.0 * PI * R * R * R * density,
               K = 4.0 / 3.0 * share * E / (1.0 - nu * nu) * sqrt(share * R);
  hertz it = {.depth = pow(1.25 * mass * speed * speed / K, 0.4)};
  it.time = 2.9432 * it.depth / speed;
  it.force = K * pow(it.depth, 1.5);
  return it;
}

/* Fills a quarter of a sphere by shells: a lattice of its bounding cube, drawn in along rays so that cubes
 * become spheres. Its surface is smooth, where that of a lattice has steps as wide as the contact. */
static void fill_shells(const verify_world *w, mpm_particles *set, double height, double spacing) {
  const int32_t n = (int32_t)floor(R / spacing + 0.5);
  const int64_t count = 2LL * n * n * n;
  double *x = verify_array(3 * count), *volume = verify_array(count);
  int64_t at = 0;
  for (int32_t i = 0; i < n; ++i)
    for (int32_t j = -n; j < n; ++j)
      for (int32_t k = 0; k < n; ++k, ++at) {
        const double p[3] = {(i + 0.5) * spacing, (j + 0.5) * spacing, (k + 0.5) * spacing};
        const double shell = fmax(fmax(p[0], fabs(p[1])), p[2]);
        const double share = shell / sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        for (int32_t c = 0; c < 3; ++c) x[c * count + at] = share * p[c] + (c == 1 ? height : 0.0);
        volume[at] = pow(share * spacing, 3);
      }
  verify_ok(w, mpm_particles_add(set, count, x, NULL, volume, NULL, NULL, NULL));
  free(x);
  free(volume);
}

typedef struct outcome {
  hertz is;
  double touch, rebound, energy, momentum; /* energy: largest / first; momentum: less impulse / first */
} outcome;

typedef struct hit {
  const char *name;
  int32_t support, lattice; /* lattice: of the grid instead of shells */
} hit;

/* Along axis y. */
static double momentum_of(const verify_world *w, const mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  double *m = verify_get(w, set, "mass", 1), *v = verify_get(w, set, "velocity", 3), sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += m[i] * v[n + i];
  free(m);
  free(v);
  return sum;
}

static mpm_particles *add_sphere(verify_world *w, const hit *a, double h, double centre, double fall) {
  mpm_particles *sphere = verify_set(w, verify_elastic(w, "neo_hookean", E, nu, density));
  const double at[3] = {0.0, R, 0.0}, by[3] = {0.0, centre - R, 0.0}, v[3] = {0.0, -fall, 0.0};
  const int32_t two[3] = {2, 2, 2};
  if (a->lattice)
    verify_ok(w, mpm_particles_fill_ball(sphere, at, R, two, NULL, NULL));
  else
    fill_shells(w, sphere, R, 0.5 * h);
  verify_place(w, sphere, 0.0, by);
  verify_ok(w, mpm_particles_set_all(sphere, "velocity", MPM_F64, 3, v));
  return sphere;
}

static outcome impact(const hit *a, int32_t cells, FILE *history) {
  const int32_t spheres = a->support == ON_BODY ? 2 : 1;
  const double h = R / cells, lift = a->support == ON_WALL ? 0.0 : 0.3 * h, gap = 0.2 * h;
  const hertz exact = theory(1.0 / spheres);
  verify_setup setup = verify_defaults(3, cells + 4, h);
  setup.grid.cells[1] = spheres * (2 * cells + 8);
  setup.grid.origin[1] = a->support == ON_WALL ? 0.0 : spheres == 2 ? -(2 * cells + 8) * h : -4.0 * h;
  setup.stepper.scheme = MPM_MUSL;
  verify_world w;
  verify_open(&w, &setup);
  const double fall = speed / spheres;
  mpm_particles *sphere = add_sphere(&w, a, h, R + lift + gap, fall);
  if (spheres == 2) {
    mpm_particles *other = add_sphere(&w, a, h, lift - R, -fall);
    verify_ok(&w, mpm_stepper_set_body(w.stepper, other, 1));
  }
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Z_MIN, MPM_WALL_SLIP, 0.0));
  support on = {.kind = a->support};
  support_lay(&w, &on, 0.0, 0.0, (const double[]){0.0, lift, 0.0});

  mpm_step_info now = verify_info(&w);
  const double start = now.kinetic_energy, first = momentum_of(&w, sphere), mass = -first / fall;
  double sunk = -gap, force = 0.0, last = 0.0; /* sunk: way of the centres of mass, from the touch on */
  outcome out = {.touch = -1.0};
  while (out.touch < 0.0 || now.t < last + 0.1 * exact.time) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, 0.4 * dt);
    const mpm_contact_info info = support_info(&w, &on);
    if (info.touching) last = now.t;
    if (info.touching && out.touch < 0.0) out.touch = now.t - now.dt;
    if (out.touch < 0.0 && now.t > 2.0 * gap / speed) break;
    const double momentum = momentum_of(&w, sphere);
    sunk -= spheres * now.dt * momentum / mass;
    force += (4.0 * info.force[1] - force) * fmin(1.0, now.dt / (0.02 * exact.time));
    out.is.force = fmax(out.is.force, force);
    out.is.depth = fmax(out.is.depth, sunk);
    out.energy = fmax(out.energy, (now.kinetic_energy + now.strain_energy) / start);
    out.momentum = fmax(out.momentum, fabs((momentum - first - info.impulse[1]) / first));
    out.rebound = momentum / (mass * fall);
    fprintf(history, "%s,%.6f,%.6e,%.6e\n", a->name, now.t - gap / speed, force / exact.force,
            sunk / exact.depth);
  }
  out.is.time = last - out.touch;
  verify_progress("%s, R = %d h, %lld particles, %lld steps", a->name, cells,
                  (long long)mpm_particles_count(sphere), (long long)now.step);
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("obstacle_hertz", argc, argv);
  FILE *history = verify_csv("obstacle_hertz"), *table = verify_csv("obstacle_hertz_table");
  fprintf(history, "case,t,force,depth\n");
  fprintf(table, "case,cells,touch,time,depth,force,rebound,energy,momentum\n");
  static const hit hits[4] = {{"plane", ON_PLANE, 0},
                              {"friction wall", ON_WALL, 0},
                              {"lattice on a plane", ON_PLANE, 1},
                              {"two spheres", ON_BODY, 0}};
  /* In the quick variant cells are twice as large, and so are the bounds. */
  const int32_t cells = verify_quick() ? 10 : 20;
  const double wide = verify_quick() ? 2.0 : 1.0;
  const char *source = "Hertz; set tolerance";
  for (int32_t k = 0; k < 4; ++k) {
    const char *name = hits[k].name;
    const hertz exact = theory(hits[k].support == ON_BODY ? 0.5 : 1.0);
    const outcome o = impact(&hits[k], cells, history);
    const struct {
      const char *what;
      double value, within;
    } gates[3] = {{"time of contact / Hertz", o.is.time / exact.time, 0.08 * wide},
                  {"depth / Hertz", o.is.depth / exact.depth, 0.12 * wide},
                  {"largest force / Hertz", o.is.force / exact.force, 0.12 * wide}};
    fprintf(table, "%s,%d,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.1e\n", name, cells, o.touch, gates[0].value,
            gates[1].value, gates[2].value, o.rebound, o.energy, o.momentum);
    for (int32_t i = 0; i < 3; ++i) {
      char what[80];
      snprintf(what, sizeof what, "%s: %s", name, gates[i].what);
      if (hits[k].lattice && i < 2)
        verify_expected_failure(what, gates[i].value, 1.0 - gates[i].within, 1.0 + gates[i].within, source,
                                "the lowest layer of the lattice is flat over three quarters of the contact");
      else
        verify_gate(what, gates[i].value, 1.0 - gates[i].within, 1.0 + gates[i].within, source);
    }
    verify_gate_of(name, "rebound / speed", o.rebound, 0.0, 1.0, "contact takes energy and never gives any");
    verify_gate_of(name, "largest energy / first", o.energy, 0.0, 1.0005,
                   "contact takes energy and never gives any");
    verify_gate_of(name, "momentum less impulse / first momentum", o.momentum, 0.0, 1e-11, "conservation");
  }
  fclose(history);
  fclose(table);
  return verify_end();
}
