/* Earth pressure at rest and in Rankine's limit states: a block of ground without cohesion, under its
 * weight and a load on top, between smooth walls, one of which moves away or against it, in quasi-static
 * steps. The ratio of pressures is K_a = tan^2(45 - phi / 2), K_p = 1 / K_a, and K_a at rest where nu / (1
 * - nu) is less. */
#include "soil.h"

enum { CELLS = 4, PER_CELL = 2, STEPS = 20 };
static const double side = 1.0, load = 1.0, weight = 1.0,
                    E = 2e5; /* stiff, so that the block keeps its size */
enum { REST, ACTIVE, PASSIVE };

typedef struct variant {
  int32_t mohr, phi, state;
  double psi;
} variant;

typedef struct ground {
  double speed; /* of the wall */
  double from;  /* share of load and weight at the start */
  double row;   /* between rows of particles */
} ground;

/* The share of load and weight that acts at a time. */
static double share(const ground *g, double t) {
  return g->from + (1.0 - g->from) * t;
}

/* The load on top, and the weight. */
static mpm_status weigh(void *user, const mpm_particle_batch *b, double *add) {
  const ground *g = user;
  for (int64_t p = 0; p < b->n; ++p) {
    const double deep = side - b->reference_position[b->ld + p], now = share(g, b->t);
    add[b->ld + p] -= now * weight * b->mass[p];
    add[b->ld + p] -= now * soil_row_share(deep, g->row) * load * g->row;
  }
  return MPM_OK;
}

/* Nodes on the wall and beyond it move as the block would if it were stretched evenly. */
static mpm_status push(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const ground *g = user;
  for (int64_t i = 0; i < b->n; ++i)
    if (b->position[i] > side - 1e-9) {
      prescribed[i] = 1;
      velocity[i] = g->speed * b->position[i] / side;
    }
  return MPM_OK;
}

static void press(const variant *v, FILE *csv) {
  static const char *const names[] = {"at rest", "active", "passive"};
  const double h = side / CELLS, K_a = pow(tan(PI / 4.0 - v->phi * PI / 360.0), 2);
  const double exact = v->state == PASSIVE ? 1.0 / K_a : K_a;
  verify_setup setup = verify_defaults(2, CELLS + 1, h);
  setup.grid.basis = MPM_LINEAR;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  setup.stepper.reference_positions = 1;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param params[] = {{"E", E},        {"nu", 0.2},     {"density", 1.0},
                              {"phi", v->phi}, {"psi", v->psi}, {"cone", 2.0}};
  const char *law = v->mohr ? "mohr_coulomb" : "drucker_prager";
  mpm_particles *set = verify_set(&w, verify_material(&w, law, params, v->mohr ? 5 : 6));
  verify_fill_box(&w, set, (const double[]){0.0, 0.0}, (const double[]){side, side}, PER_CELL);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  ground g = {v->state == ACTIVE    ? 1e-4
              : v->state == PASSIVE ? -2e-4
                                    : 0.0,
              v->state == REST ? 0.02 : 1.0, h / PER_CELL};
  verify_ok(&w, mpm_stepper_set_force(w.stepper, weigh, &g));
  verify_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, push, &g));
  const int64_t n = mpm_particles_count(set);
  double force[2];
  soil_settle(&w, &(soil_rest){g.from * load, g.from * weight, side, 1.0});
  char name[80];
  snprintf(name, sizeof name, "phi = %d, %s, %s", (int)v->phi, law, names[v->state]);
  double ratio = 0.0;
  for (int32_t k = 1; k <= STEPS; ++k) {
    const mpm_step_info info = verify_advance(&w, 0.5, (double)k / STEPS);
    verify_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, force));
    ratio = force[0] / (share(&g, info.t) * (load + 0.5 * weight * side) * side);
    fprintf(csv, "\"%s\",%d,%d,%d,%.5f,%.6f\n", law, (int)v->phi, (int)v->state, (int)info.newton_iterations,
            info.t, ratio);
  }
  verify_gate_of(name, "thrust on the wall / that of the exact K", ratio / exact, 0.999, 1.001,
                 "Rankine; set tolerance");
  double *s = verify_get(&w, set, "stress", 6), worst = 0.0;
  for (int64_t p = 0; p < n; ++p) worst = fmax(worst, fabs(s[p] / s[n + p] / exact - 1.0));
  free(s);
  verify_gate_of(name, "ratio of stresses of a particle / K, less 1, largest", worst, 0.0, 1e-3,
                 "Rankine; set tolerance");
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("soil_pressure", argc, argv);
  static const variant list[] = {{1, 20, ACTIVE, 0.0},   {1, 20, PASSIVE, 0.0}, {1, 30, ACTIVE, 0.0},
                                 {1, 30, PASSIVE, 0.0},  {1, 30, REST, 0.0},    {0, 20, ACTIVE, 20.0},
                                 {0, 20, PASSIVE, 20.0}, {0, 30, ACTIVE, 30.0}, {0, 30, PASSIVE, 30.0}};
  FILE *csv = verify_csv("soil_pressure");
  fprintf(csv, "law,phi,state,iterations,t,ratio\n");
  for (size_t i = 0; i < sizeof list / sizeof *list; ++i) press(&list[i], csv);
  fclose(csv);
  return verify_end();
}
