/* The generalised vortex (Kamojjala et al. 2015): a ring 0.75 < R < 1.25 whose shells turn by A sin(pi t)
 * h(R), under the body force that the neo-Hookean law asks for. E = density = 1000, nu = 0.3, A = 0.1.
 * Uintah's MMS.cc has the same body force. */
#include "verify.h"

static const double A = 0.1, mu = 1000.0 / 2.6, density = 1000.0;

static double shape(double R) {
  const double s = 4.0 * (R - 1.0);
  return (1.0 - s * s) * (1.0 - s * s);
}

static mpm_status body_force(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  const double g = A * sin(PI * b->t), g1 = A * PI * cos(PI * b->t), g2 = -PI * PI * g;
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->id[i] < 0) continue;
    const double X = b->reference_position[i], Y = b->reference_position[b->ld + i], R = hypot(X, Y),
                 s = R - 1.0;
    const double h = shape(R), h1 = -64.0 * s * (1.0 - 16.0 * s * s), h2 = -64.0 + 3072.0 * s * s;
    const double radial = -R * g1 * g1 * h * h + mu / density * R * g * g * h1 * h1;
    const double hoop = R * g2 * h - mu / density * g * (3.0 * h1 + R * h2);
    const double angle = atan2(Y, X) + g * h;
    add[i] += radial * cos(angle) - hoop * sin(angle);
    add[b->ld + i] += radial * sin(angle) + hoop * cos(angle);
  }
  return MPM_OK;
}

static mpm_status in_ring(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                          uint8_t *inside) {
  (void)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) {
    const double R = hypot(position[i], position[ld + i]);
    inside[i] = R > 0.75 && R < 1.25;
  }
  return MPM_OK;
}

/* Root of the mean square of the error of displacement at t = 0.5 and 1. */
static void turn(int per_unit, int transfer, double error[2], FILE *cloud) {
  const double h = 1.0 / per_unit;
  const int across = (int)(2.5 * per_unit) + 6;
  verify_setup setup = verify_defaults(2, across + across % 2, h);
  setup.grid.origin[0] = setup.grid.origin[1] = -0.5 * h * (double)setup.grid.cells[0];
  setup.stepper.scheme = MPM_MUSL;
  setup.stepper.transfer = transfer;
  setup.stepper.reference_positions = 1;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *ring = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, density));
  verify_ok(&w, mpm_particles_fill(ring, (const double[]){-1.25, -1.25}, (const double[]){1.25, 1.25},
                                   (const int32_t[]){3, 3}, in_ring, NULL, NULL, NULL));
  const int64_t n = mpm_particles_count(ring);
  double *X = verify_get(&w, ring, "position", 2), *v = verify_array(2 * n);
  for (int64_t i = 0; i < n; ++i) {
    const double rate = PI * A * shape(hypot(X[i], X[n + i]));
    v[i] = -rate * X[n + i];
    v[n + i] = rate * X[i];
  }
  verify_put(&w, ring, "velocity", 2, v);
  free(v);
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, body_force, NULL));
  for (int k = 0; k < 2; ++k) {
    const double t = 0.5 * (k + 1);
    verify_advance(&w, 0.4, t);
    double *x = verify_get(&w, ring, "position", 2), sum = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      const double angle = A * sin(PI * t) * shape(hypot(X[i], X[n + i]));
      const double dx = x[i] - cos(angle) * X[i] + sin(angle) * X[n + i],
                   dy = x[n + i] - sin(angle) * X[i] - cos(angle) * X[n + i];
      sum += dx * dx + dy * dy;
      if (cloud) fprintf(cloud, "%.1f,%.6f,%.6f,%.6e\n", t, x[i], x[n + i], hypot(dx, dy));
    }
    error[k] = sqrt(sum / (double)n);
    free(x);
  }
  free(X);
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("vortex", argc, argv);
  FILE *csv = verify_csv("vortex"), *cloud = verify_csv("vortex_cloud");
  fprintf(csv, "transfer,h,error_0.5,error_1\n");
  fprintf(cloud, "t,x,y,error\n");
  const int levels = verify_quick() ? 2 : 4;
  double h[4], error[4][2], at_end[4];
  for (int k = 0; k < levels; ++k) {
    h[k] = 0.1 / (1 << k);
    turn(10 << k, MPM_FLIP, error[k], k == 0 ? cloud : NULL);
    at_end[k] = error[k][1];
    fprintf(csv, "FLIP,%g,%.5e,%.5e\n", h[k], error[k][0], error[k][1]);
  }
  double affine[2];
  turn(20, MPM_APIC, affine, NULL);
  fprintf(csv, "APIC,0.05,%.5e,%.5e\n", affine[0], affine[1]);
  fclose(csv);
  fclose(cloud);
  const char *source = "Kamojjala et al. 2015; set tolerance";
  const char *independent = "an independent implementation, with a margin of 25 %";
  if (verify_quick()) {
    verify_gate("h = 0.05: displacement at t = 1, L2", error[1][1], 0.0, 1.25 * 4.9e-3, independent);
    verify_gate("h = 0.1 to 0.05: order at t = 1", log2(error[0][1] / error[1][1]), 1.2, 3.0, source);
  } else {
    verify_gate("h = 0.025: displacement at t = 1, L2", error[2][1], 0.0, 1.3e-3, source);
    verify_gate("h = 0.1 to 0.025: order at t = 1", verify_slope(3, h, at_end), 1.2, 3.0, source);
  }
  verify_gate("h = 0.05, APIC: displacement at t = 1, L2", affine[1], 0.0, 1.25 * 4.3e-3, independent);
  return verify_end();
}
