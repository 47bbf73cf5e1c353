/* Heat: a sine that decays and a sudden temperature at the ends of a bar, a bar that is heated between two
 * walls, a strip of two metals that bends, and a block whose plastic work heats it. */
#include "verify.h"

/* ---- conduction ---------------------------------------------------------------------------------------- */
static mpm_particles *open_bar(verify_world *w, int64_t cells, int32_t basis, int32_t implicit) {
  verify_setup setup = verify_defaults(1, cells, 1.0 / (double)cells);
  setup.grid.basis = basis;
  verify_open(w, &setup);
  mpm_particles *set = verify_set(w, verify_elastic(w, "linear_elastic", 1e-6, 0.0, 1.0));
  const double low = 0.0, high = 1.0;
  verify_fill_box(w, set, &low, &high, 2);
  mpm_heat_desc heat;
  verify_ok(w, mpm_heat_desc_init(&heat, sizeof heat));
  heat.specific_heat = heat.conductivity = 1.0;
  verify_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
  verify_ok(w, mpm_stepper_set_conduction(w->stepper, implicit, 1e-12));
  return set;
}

static double exact_of(double x, double t, int32_t sudden) {
  return sudden ? erfc(0.5 * x / sqrt(t)) + erfc(0.5 * (1.0 - x) / sqrt(t)) : sin(PI * x) * exp(-PI * PI * t);
}

/* Returns the root mean square of the error at time t. */
static double conduct(int64_t cells, int32_t basis, int32_t implicit, int32_t sudden, double t, FILE *table) {
  verify_world w;
  mpm_particles *set = open_bar(&w, cells, basis, implicit);
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 1), *T = verify_array(n), sum = 0.0;
  for (int64_t i = 0; i < n && !sudden; ++i) T[i] = sin(PI * x[i]);
  verify_put(&w, set, "temperature", 1, T);
  for (int32_t face = 0; face < 2; ++face)
    verify_ok(&w, mpm_stepper_set_heat_wall(w.stepper, face, MPM_HEAT_WALL_TEMPERATURE, sudden ? 1.0 : 0.0));
  const double h = 1.0 / (double)cells, most = implicit ? 0.5 * h * h : 0.25 * h * h;
  const int32_t steps = (int32_t)ceil(t / most - 1e-9);
  for (int32_t i = 0; i < steps; ++i) verify_step(&w, t / steps);
  free(T);
  T = verify_get(&w, set, "temperature", 1);
  for (int64_t i = 0; i < n; ++i) {
    const double exact = exact_of(x[i], t, sudden);
    sum += (T[i] - exact) * (T[i] - exact);
    if (table) fprintf(table, "%d,%lld,%.9f,%.9f,%.9f\n", (int)sudden, (long long)cells, x[i], T[i], exact);
  }
  free(x), free(T);
  verify_close(&w);
  return sqrt(sum / (double)n);
}

static void conduction(void) {
  static const struct {
    const char *name;
    int32_t basis, implicit;
  } ways[] = {{"linear, explicit", MPM_LINEAR, 0},
              {"quadratic, explicit", MPM_BSPLINE2, 0},
              {"cubic, explicit", MPM_BSPLINE3, 0},
              {"quadratic, implicit", MPM_BSPLINE2, 1}};
  FILE *table = verify_csv("heat_bar"), *fine = verify_csv("heat_refinement");
  fprintf(table, "sudden,cells,x,T,exact\n");
  fprintf(fine, "way,cells,sine,sudden\n");
  for (int32_t k = 0; k < 4; ++k) {
    double h[3], sine[3], sudden[3];
    for (int32_t i = 0; i < 3; ++i) {
      const int64_t cells = 8 << i, ends = 10 << i;
      FILE *shown = k == 1 && i == 1 ? table : NULL;
      h[i] = 1.0 / (double)cells;
      sine[i] = conduct(cells, ways[k].basis, ways[k].implicit, 0, 0.05, shown);
      sudden[i] = conduct(ends, ways[k].basis, ways[k].implicit, 1, 0.01, shown);
      fprintf(fine, "%d,%lld,%.9e,%.9e\n", (int)k, (long long)cells, sine[i], sudden[i]);
    }
    verify_gate_of(ways[k].name, "sine, 32 cells: error", sine[2], 0.0, 2e-3,
                   "exact solution; set tolerance");
    verify_gate_of(ways[k].name, "sine: order", verify_slope(3, h, sine), 1.8, 2.5, "second order");
    verify_gate_of(ways[k].name, "sudden ends, 40 cells: error", sudden[2], 0.0, 0.03,
                   "complementary error function; set tolerance");
    verify_gate_of(ways[k].name, "sudden ends: order", verify_slope(3, h, sudden), 1.5, 2.5,
                   "second order; set tolerance");
    if (k != 1) continue;
    static const double by_itself[3] = {1.3139e-2, 3.2719e-3, 8.1333e-4};
    for (int32_t i = 0; i < 3; ++i)
      verify_gate(i == 0   ? "sine, 8 cells: error over that of an independent program"
                  : i == 1 ? "sine, 16 cells: error over that of an independent program"
                           : "sine, 32 cells: error over that of an independent program",
                  sine[i] / by_itself[i], 0.99, 1.01, "an independent implementation");
  }
  fclose(table), fclose(fine);
}

/* ---- expansion ----------------------------------------------------------------------------------------- */
static void expand(const verify_world *w, mpm_particles *set, double expansion) {
  mpm_heat_desc heat;
  verify_ok(w, mpm_heat_desc_init(&heat, sizeof heat));
  heat.specific_heat = 450.0;
  heat.expansion = expansion;
  verify_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
}

static void heat_up(const verify_world *w, mpm_particles *set, double T) {
  verify_ok(w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &T));
}

/* Steel between two walls, free at its sides: -E a dT. */
static void bar_between_walls(void) {
  verify_setup setup = verify_defaults(3, 8, 0.25);
  setup.grid.cells[0] = 4;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "linear_elastic", 200e9, 0.3, 7800.0));
  const double low[] = {0.0, 0.75, 0.75}, high[] = {1.0, 1.25, 1.25};
  verify_fill_box(&w, set, low, high, 2);
  for (int32_t face = 0; face < 2; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  expand(&w, set, 1.2e-5);
  heat_up(&w, set, 100.0);
  verify_step(&w, 1.0);
  const int64_t n = mpm_particles_count(set);
  double *stress = verify_get(&w, set, "stress", 6), worst = 0.0;
  for (int64_t i = 0; i < n; ++i) worst = fmax(worst, fabs(stress[i] / -240e6 - 1.0));
  verify_gate("bar between walls: stress over -E a dT, largest difference", worst, 0.0, 2e-3,
              "-E a dT; F is not small by (1 + nu) a dT");
  free(stress);
  verify_close(&w);
}

/* A strip of two metals of equal stiffness bends to the curvature 3/2 (a' - a) dT / height; in plane strain
 * expansions count 1 + nu. Returns the deflection of its end over L^2 / 2 times that. */
static double bend(int64_t across, FILE *table) {
  const double h = 0.1 / (double)across, length = 1.0, nu = 0.3, difference = 1e-5, dT = 50.0;
  verify_setup setup = verify_defaults(2, 1, h);
  setup.grid.cells[0] = (int64_t)lround(1.1 * length / h);
  setup.grid.cells[1] = 3 * across;
  setup.grid.total_lagrangian = 1;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  mpm_material *metal = verify_elastic(&w, "neo_hookean", 100e9, nu, 8000.0);
  mpm_particles *set[2];
  for (int32_t m = 0; m < 2; ++m) {
    const double low[] = {0.0, h * (double)across + 0.05 * m},
                 high[] = {length, h * (double)across + 0.05 * (m + 1)};
    set[m] = verify_set(&w, metal);
    verify_fill_box(&w, set[m], low, high, 2);
    expand(&w, set[m], (m ? 1.0 : 2.0) * difference);
    heat_up(&w, set[m], dT);
  }
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  verify_step(&w, 1.0);
  const int64_t n = mpm_particles_count(set[1]);
  double *x = verify_get(&w, set[1], "position", 2), *X = verify_get(&w, set[1], "reference_position", 2);
  double up = 0.0, most = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    if (X[i] > most) most = X[i], up = 0.0;
    if (X[i] >= most) up = x[n + i] - X[n + i];
  }
  for (int32_t m = 0; m < 2 && table; ++m) {
    double *at = verify_get(&w, set[m], "position", 2), *stress = verify_get(&w, set[m], "stress", 6);
    for (int64_t i = 0; i < mpm_particles_count(set[m]); ++i)
      fprintf(table, "%.6f,%.6f,%.6e\n", at[i], at[mpm_particles_count(set[m]) + i], stress[i]);
    free(at), free(stress);
  }
  free(x), free(X);
  verify_close(&w);
  return up / (0.5 * most * most * 1.5 * (1.0 + nu) * difference * dT / 0.1);
}

/* ---- dissipation --------------------------------------------------------------------------------------- */
/* A block is squeezed without friction: yield stress times plastic strain heats it. */
static void squeeze(void) {
  const double E = 200e9, yield = 400e6, density = 7800.0, capacity = 450.0, h = 0.125;
  verify_setup setup = verify_defaults(3, 12, h);
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param law[] = {{"E", E}, {"nu", 0.3}, {"density", density}, {"yield_stress", yield}};
  mpm_particles *set = verify_set(&w, verify_material(&w, "j2", law, 4));
  const double low[] = {0.0, 0.0, 0.0}, high[] = {0.5, 0.5, 0.5}, rate = -0.1;
  verify_fill_box(&w, set, low, high, 2);
  for (int32_t k = 0; k < 3; ++k) verify_ok(&w, mpm_stepper_set_wall(w.stepper, 2 * k, MPM_WALL_SLIP, 0.0));
  mpm_heat_desc heat;
  verify_ok(&w, mpm_heat_desc_init(&heat, sizeof heat));
  heat.specific_heat = capacity;
  heat.dissipated_share = 0.9;
  verify_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 3), *v = verify_array(3 * n);
  uint8_t *held = calloc((size_t)(3 * n), 1);
  for (int64_t i = 0; i < n && held; ++i)
    if (x[i] > 0.5 - 0.5 * h) held[i] = 1, v[i] = rate;
  verify_ok(&w, mpm_particles_set(set, "prescribed", MPM_U8, 3, n, NULL, held));
  verify_put(&w, set, "velocity", 3, v);
  for (int32_t i = 0; i < 20; ++i) verify_step(&w, 0.01);
  double *T = verify_get(&w, set, "temperature", 1), *state = verify_get(&w, set, "state", 1), warm = 0.0,
         work = 0.0;
  double *V = verify_get(&w, set, "volume", 1), *m = verify_get(&w, set, "mass", 1);
  for (int64_t i = 0; i < n; ++i) {
    warm += T[i] * m[i] * capacity;
    work += 0.9 * yield * state[i] * V[i];
  }
  verify_progress("squeezed: %.3f K, plastic strain %.4f", T[0], state[0]);
  verify_gate("squeezed block: heat over 0.9 yield stress times plastic strain", warm / work, 0.98, 1.02,
              "adiabatic limit");
  free(x), free(v), free(held), free(T), free(state), free(V), free(m);
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("heat", argc, argv);
  conduction();
  bar_between_walls();
  FILE *table = verify_csv("heat_strip");
  fprintf(table, "x,y,stress\n");
  verify_gate("two metals: deflection over Timoshenko's, 4 cells across", bend(4, NULL), 0.95, 1.05,
              "Timoshenko 1925; the clamp");
  if (!verify_quick())
    verify_gate("two metals: deflection over Timoshenko's, 8 cells across", bend(8, table), 0.97, 1.03,
                "Timoshenko 1925; the clamp");
  fclose(table);
  squeeze();
  return verify_end();
}
