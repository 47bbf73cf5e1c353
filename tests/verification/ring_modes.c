/* Small radial vibrations of an elastic sphere, and of a cylinder in plane strain, as bodies of revolution
 * with R = 20 h. The frequencies are exact: of the sphere tan x = x / (1 - k x^2 / 4) with
 * k = 2 (1 - nu) / (1 - 2 nu), of the cylinder x J0(x) / J1(x) = (1 - 2 nu) / (1 - nu), x = omega R / c_L. */
#include "verify.h"

enum { CELLS = 20 };
static const double radius = 1.0, E = 1.0;

typedef struct mode {
  const char *name;
  int32_t sphere;
  double nu, x;
} mode;

/* v of the mode along the radius. */
static double sphere_shape(double y) {
  return y < 1e-3 ? y / 3.0 : sin(y) / (y * y) - cos(y) / y;
}

static double cylinder_shape(double y) { /* J1 */
  double term = 0.5 * y, sum = term;
  for (int32_t k = 1; k < 20; ++k) sum += term *= -0.25 * y * y / (k * (k + 1.0));
  return sum;
}

static mpm_status in_sphere(void *user, int32_t dim, int64_t n, int64_t ld, const double *x,
                            uint8_t *inside) {
  (void)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = hypot(x[i], x[ld + i]) < radius;
  return MPM_OK;
}

static void start(const verify_world *w, mpm_particles *set, const mode *of) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2), *v = verify_array(2 * n);
  for (int64_t p = 0; p < n; ++p) {
    const double r = of->sphere ? hypot(x[p], x[n + p]) : x[p];
    const double speed = 1e-4 * (of->sphere ? sphere_shape(of->x * r) : cylinder_shape(of->x * r));
    v[p] = speed * x[p] / r;
    if (of->sphere) v[n + p] = speed * x[n + p] / r;
  }
  verify_put(w, set, "velocity", 2, v);
  free(x);
  free(v);
}

/* Returns sum m v . x, whose sign is that of the mode. */
static double outwards(const verify_world *w, mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2), *v = verify_get(w, set, "velocity", 2),
         *m = verify_get(w, set, "mass", 1), sum = 0.0;
  for (int64_t p = 0; p < n; ++p) sum += m[p] * (v[p] * x[p] + v[n + p] * x[n + p]);
  free(x);
  free(v);
  free(m);
  return sum;
}

/* Returns omega R / c_L from the time of the last of five half periods. */
static double frequency(const mode *of, int32_t transfer, int32_t basis, double *drift) {
  const double h = radius / CELLS, speed = verify_speed_of_sound(E, of->nu, 1.0);
  verify_setup setup = verify_defaults(2, CELLS + 3, h);
  setup.grid.geometry = MPM_AXISYMMETRIC;
  setup.grid.basis = basis;
  if (!of->sphere) setup.grid.cells[1] = 4, setup.grid.periodic[1] = 1;
  verify_use(&setup, &verify_schemes[VERIFY_USL], transfer);
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, of->nu, 1.0));
  const double low[] = {0.0, 0.0}, high[] = {radius, of->sphere ? radius : 4.0 * h};
  if (!of->sphere) verify_fill_box(&w, set, low, high, 2);
  if (of->sphere)
    verify_ok(&w, mpm_particles_fill(set, low, high, (const int32_t[]){2, 2}, in_sphere, NULL, NULL, NULL));
  if (of->sphere) verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  start(&w, set, of);
  const double dt = 0.3 * h / speed, first = verify_info(&w).kinetic_energy;
  double t = 0.0, last = outwards(&w, set), crossed = 0.0;
  for (int32_t turns = 0; turns < 5;) {
    const mpm_step_info info = verify_step(&w, dt);
    const double now = outwards(&w, set);
    *drift = info.kinetic_energy + info.strain_energy - first;
    t += dt;
    if (now * last < 0.0) crossed = t - dt * now / (now - last), ++turns;
    last = now;
  }
  *drift /= first;
  verify_close(&w);
  return 4.5 * PI / crossed * radius / speed;
}

int main(int argc, char **argv) {
  verify_begin("ring_modes", argc, argv);
  FILE *csv = verify_csv("ring_modes");
  fprintf(csv, "body,nu,basis,transfer,frequency,exact\n");
  const mode modes[] = {{"sphere, nu = .25", 1, 0.25, 2.5634341631},
                        {"sphere, nu = .3", 1, 0.3, 2.6702147332},
                        {"cylinder, nu = .3", 0, 0.3, 2.1257489278}};
  const struct {
    const char *name;
    int32_t basis, transfer;
  } by[] = {{"quadratic FLIP", MPM_BSPLINE2, MPM_FLIP},
            {"quadratic APIC", MPM_BSPLINE2, MPM_APIC},
            {"linear FLIP", MPM_LINEAR, MPM_FLIP},
            {"cubic FLIP", MPM_BSPLINE3, MPM_FLIP},
            {"uGIMP FLIP", MPM_UGIMP, MPM_FLIP}};
  for (int32_t k = 0; k < 3; ++k)
    for (int32_t m = 0; m < 5; ++m) {
      double drift;
      const double is = frequency(&modes[k], by[m].transfer, by[m].basis, &drift);
      char what[96];
      snprintf(what, sizeof what, "%s, %s: omega R / c over the exact one", modes[k].name, by[m].name);
      verify_gate(what, is / modes[k].x, 0.99, 1.01, "exact; set tolerance");
      snprintf(what, sizeof what, "%s, %s: energy, change over the first", modes[k].name, by[m].name);
      verify_gate(what, drift, -0.1, 1e-3, "conserved; set tolerance");
      fprintf(csv, "\"%s\",%g,%d,%d,%.8f,%.8f\n", modes[k].name, modes[k].nu, (int)by[m].basis,
              (int)by[m].transfer, is, modes[k].x);
    }
  fclose(csv);
  return verify_end();
}
