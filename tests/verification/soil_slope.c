/* An infinite slope of ground without cohesion: a layer of depth 1 on a rough base, a strip of it between
 * periodic faces, in which gravity leans over slowly to an angle beta and stays. It stands where tan beta
 * is less than a limit and flows where it is more. The limit is tan phi of ground that dilates by its angle
 * of friction (associated); in shear without dilation the most that mohr_coulomb bears is sin phi (Davis
 * 1968), and drucker_prager M / sqrt 3. With the limit in the place of tan phi the layer gains speed along
 * the slope by g (sin beta - cos beta tan phi) / (1 + tan^2 psi), because it rises as it dilates. */
#include "soil.h"

enum { ROWS = 10, COLUMNS = 3 };
static const double E = 200.0, nu = 0.3, lean = 2.0, wait = 4.0; /* weight, depth and gravity are 1 */

typedef struct variant {
  int32_t mohr, phi, psi;
} variant;

typedef struct slope {
  double angle;
} slope;

static mpm_status pull(void *user, const mpm_particle_batch *b, double *add) {
  const slope *s = user;
  for (int64_t p = 0; p < b->n; ++p) {
    add[p] += sin(s->angle) * fmin(b->t / lean, 1.0);
    add[b->ld + p] -= cos(s->angle);
  }
  return MPM_OK;
}

typedef struct moment {
  double speed, plastic; /* means */
} moment;

static moment look(const verify_world *w) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *v = verify_get(w, w->set[0], "velocity", 2), *state = verify_get(w, w->set[0], "state", 2);
  moment m = {0.0, 0.0};
  for (int64_t i = 0; i < n; ++i) m.speed += v[i] / (double)n, m.plastic += state[i] / (double)n;
  free(v), free(state);
  return m;
}

/* Over the last second: what the mean speed gains, and the mean plastic strain. */
static moment run(const variant *v, const char *name, double angle, FILE *csv) {
  const double h = 1.0 / ROWS;
  verify_setup setup = verify_defaults(2, COLUMNS, h);
  setup.grid.cells[1] = ROWS + 6;
  setup.grid.periodic[0] = 1;
  setup.stepper.scheme = MPM_MUSL;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param params[] = {{"E", E},        {"nu", nu},      {"density", 1.0},
                              {"phi", v->phi}, {"psi", v->psi}, {"cone", 2.0}};
  mpm_particles *set = verify_set(
      &w, verify_material(&w, v->mohr ? "mohr_coulomb" : "drucker_prager", params, v->mohr ? 5 : 6));
  verify_fill_box(&w, set, (const double[]){0.0, 0.0}, (const double[]){COLUMNS * h, 1.0}, 2);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  slope s = {angle};
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, pull, &s));
  soil_settle(&w, &(soil_rest){0.0, cos(angle), 1.0, nu / (1.0 - nu)});
  moment before = {0.0, 0.0}, now = before;
  enum { SAMPLES = 24 };
  for (int32_t k = 1; k <= SAMPLES; ++k) {
    const double t = (lean + wait) * k / SAMPLES;
    verify_advance(&w, 0.4, t);
    now = look(&w);
    if (k == SAMPLES - 4) before = now;
    fprintf(csv, "\"%s\",%.4f,%.2f,%.6f,%.6f\n", name, tan(angle), t, now.speed, now.plastic);
  }
  verify_close(&w);
  return (moment){now.speed - before.speed, now.plastic - before.plastic};
}

int main(int argc, char **argv) {
  verify_begin("soil_slope", argc, argv);
  static const variant list[] = {{1, 30, 30}, {1, 30, 0}, {0, 30, 30}, {0, 30, 0}, {1, 20, 20}, {1, 20, 0}};
  FILE *csv = verify_csv("soil_slope");
  fprintf(csv, "variant,slope,t,speed,plastic\n");
  for (int32_t i = 0; i < (verify_quick() ? 1 : 6); ++i) {
    const variant *v = &list[i];
    const double phi = v->phi * PI / 180.0, t = tan(phi), psi = v->psi * PI / 180.0;
    const double limit = v->psi ? t : v->mohr ? sin(phi) : 3.0 * t / sqrt(9.0 + 12.0 * t * t);
    char name[80];
    snprintf(name, sizeof name, "%s, phi = %d, psi = %d", v->mohr ? "mohr_coulomb" : "drucker_prager",
             (int)v->phi, (int)v->psi);
    const moment stands = run(v, name, atan(0.98 * limit), csv);
    verify_gate_of(name, "tan beta = 0.98 of the limit: plastic strain of the last second", stands.plastic,
                   0.0, 1e-4, "equilibrium; set tolerance");
    const double beta = atan(1.02 * limit);
    const double exact = cos(beta) * (tan(beta) - limit) / (1.0 + pow(tan(psi), 2));
    const moment flows = run(v, name, beta, csv);
    verify_gate_of(name, "tan beta = 1.02 of the limit: speed gained in the last second / exact",
                   flows.speed / exact, 0.9, 1.1,
                   "momentum of a layer that yields at its base; set tolerance");
  }
  fclose(csv);
  return verify_end();
}
