/* A cylindrical cavity of radius 1 expands to a radius a in undrained clay (Tresca: `mohr_coulomb` with phi
 * = 0, G = 100 c_u, nearly incompressible), in plane strain and quasi-static steps. A pressure of c_u (1 +
 * ln (G / c_u (1 - 1 / a^2))) does it, which comes near the limit c_u (1 + ln 100) = 5.605 c_u. A quarter;
 * nodes in the cavity move as the clay there would, and their work gives the pressure. The outer face bears
 * what elastic clay beyond it would give it. */
#include "verify.h"

static const double G = 100.0, nu = 0.49; /* c_u = 1 */
enum { X, Y, PLANE };

typedef struct cavity {
  double h, largest, outer; /* outer: radius of the outer face when the cavity is largest */
  int32_t steps;
  double shift;                /* r^2 - R^2 then: the clay keeps its volume */
  double face;                 /* outer radius at first */
  int64_t last[2], in_ring[2]; /* of the two outermost rings: first particle, number */
  const mpm_particles *clay;
} cavity;

static double radius(const cavity *is, double t) {
  return 1.0 + (is->largest - 1.0) * t;
}

/* Nodes in the cavity, as a flow without change of volume. */
static mpm_status widen(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const cavity *is = user;
  const double a = radius(is, b->t), mean = radius(is, b->t + 0.5 * b->dt);
  for (int64_t i = 0; i < b->n; ++i) {
    const double x = b->position[i], y = b->position[b->ld + i], rr = x * x + y * y;
    if (rr > a * a || !(rr > 0.0)) continue;
    prescribed[i] = prescribed[b->ld + i] = 1;
    velocity[i] = (is->largest - 1.0) * mean / rr * x;
    velocity[b->ld + i] = (is->largest - 1.0) * mean / rr * y;
  }
  return MPM_OK;
}

/* The pressure of elastic clay beyond the outer face, on two rings, as on a straight line to the face. */
static mpm_status hold(void *user, const mpm_particle_batch *b, double *add) {
  const cavity *is = user;
  const double a = radius(is, b->t), rr = is->face * is->face + a * a - 1.0, p = G * (a * a - 1.0) / rr;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t k = 0; k < 2; ++k) {
      const int64_t in_ring = b->id[i] - is->last[k];
      if (in_ring < 0 || in_ring >= is->in_ring[k]) continue;
      const double x = b->position[i], y = b->position[b->ld + i];
      const double force = (k ? 1.5 : -0.5) * p * sqrt(rr) * 0.5 * PI / (double)is->in_ring[k] / hypot(x, y);
      add[i] -= force * x;
      add[b->ld + i] -= force * y;
    }
  return MPM_OK;
}

/* Rings of particles that are half a cell apart when the cavity is largest. */
static void fill(const verify_world *w, mpm_particles *clay, cavity *is) {
  const int64_t rings = lround((is->outer - is->largest) / (0.5 * is->h));
  for (int64_t k = 0; k < rings; ++k) {
    const double r0 = is->largest + (double)k * 0.5 * is->h, r1 = r0 + 0.5 * is->h;
    const double R0 = sqrt(r0 * r0 - is->shift), R1 = sqrt(r1 * r1 - is->shift);
    const double R = sqrt(0.5 * (R0 * R0 + R1 * R1));
    const int64_t n = (int64_t)ceil(PI * r1 / is->h);
    double *x = verify_array(2 * n), *volume = verify_array(n);
    for (int64_t i = 0; i < n; ++i) {
      const double angle = 0.5 * PI * ((double)i + 0.5) / (double)n;
      x[i] = R * cos(angle);
      x[n + i] = R * sin(angle);
      volume[i] = 0.25 * PI * (R1 * R1 - R0 * R0) / (double)n;
    }
    is->last[0] = is->last[1], is->in_ring[0] = is->in_ring[1];
    is->last[1] = mpm_particles_count(clay), is->in_ring[1] = n;
    is->face = R1;
    verify_ok(w, mpm_particles_add(clay, n, x, NULL, volume, NULL, NULL, NULL));
    free(x), free(volume);
  }
}

/* Work of the reactions of the cavity's nodes over the volume that it gains. */
static double pressure(const verify_world *w, const cavity *is, const mpm_step_info *info) {
  static const char *const fields[3] = {"reaction", "velocity", "position"};
  mpm_view view[3];
  const double *of[3];
  for (int32_t f = 0; f < 3; ++f) {
    view[f] = (mpm_view){.struct_size = sizeof view[f]};
    verify_ok(w, mpm_grid_map(w->stepper, 0, fields[f], MPM_READ, &view[f]));
    of[f] = view[f].data;
  }
  const double a = radius(is, info->t), mean = radius(is, info->t - 0.5 * info->dt);
  double power = 0.0;
  for (int64_t i = 0; i < view[0].count; ++i) {
    double value[3][PLANE];
    for (int32_t f = 0; f < 3; ++f)
      for (int32_t c = 0; c < PLANE; ++c)
        value[f][c] = of[f][i * view[f].item_stride + c * view[f].component_stride];
    if (value[2][X] < 0.0 || value[2][Y] < 0.0 || hypot(value[2][X], value[2][Y]) > a) continue;
    for (int32_t c = 0; c < PLANE; ++c) power += value[0][c] * value[1][c];
  }
  for (int32_t f = 0; f < 3; ++f) verify_ok(w, mpm_view_release(&view[f]));
  return power / (0.5 * PI * (is->largest - 1.0) * mean);
}

/* Radial stress beside the exact one. */
static void draw(const verify_world *w, const cavity *is, FILE *field) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *x = verify_get(w, w->set[0], "position", 2), *s = verify_get(w, w->set[0], "stress", 6);
  const double plastic = sqrt(G * is->shift); /* radius of the plastic zone */
  for (int64_t i = 0; i < n; ++i) {
    const double r = hypot(x[i], x[n + i]), c = x[i] / r, z = x[n + i] / r;
    const double radial = s[i] * c * c + s[n + i] * z * z + 2.0 * s[3 * n + i] * c * z;
    const double exact = r < plastic ? 2.0 * log(r / plastic) - 1.0 : -pow(plastic / r, 2);
    fprintf(field, "%.3f,%.4f,%.4f\n", r, -radial, -exact);
  }
  free(x), free(s);
}

static void expand(cavity is, FILE *csv, FILE *field) {
  is.shift = is.largest * is.largest - 1.0;
  verify_setup setup = verify_defaults(2, lround(is.outer / is.h) + 2, is.h);
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param params[] = {
      {"E", 2.0 * G * (1.0 + nu)}, {"nu", nu}, {"density", 1.0}, {"phi", 0.0}, {"cohesion", 1.0}};
  mpm_particles *clay = verify_set(&w, verify_material(&w, "mohr_coulomb", params, 5));
  fill(&w, clay, &is);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, widen, &is));
  verify_ok(&w, mpm_stepper_set_force(w.stepper, hold, &is));
  double mean = 0.0, worst = 0.0, end = 0.0;
  int32_t count = 0;
  for (int32_t k = 1; k <= is.steps; ++k) {
    const mpm_step_info info = verify_advance(&w, 0.5, (double)k / is.steps);
    const double a = radius(&is, info.t), exact = 1.0 + log(G * (1.0 - 1.0 / (a * a)));
    end = pressure(&w, &is, &info);
    fprintf(csv, "%g,%.4f,%.5f,%.5f,%d\n", is.h, a, end, exact, (int)info.newton_iterations);
    if (2 * k <= is.steps) continue;
    mean += end / exact;
    worst = fmax(worst, fabs(end / exact - 1.0));
    ++count;
  }
  if (field) draw(&w, &is, field);
  verify_close(&w);
  char name[64];
  snprintf(name, sizeof name, "h = %g, up to a = %g", is.h, is.largest);
  verify_gate_of(name, "pressure / exact, mean of the second half", mean / count, 0.95, 1.05,
                 "closed form; set tolerance");
  verify_gate_of(name, "pressure / exact, less 1, largest there", worst, 0.0, 0.05,
                 "closed form; set tolerance");
  if (is.largest > 2.0)
    verify_gate_of(name, "pressure at the end / limit", end / (1.0 + log(G)), 0.95, 1.05,
                   "closed form; set tolerance");
}

int main(int argc, char **argv) {
  verify_begin("soil_cavity", argc, argv);
  FILE *csv = verify_csv("soil_cavity"), *field = verify_csv("soil_cavity_field");
  fprintf(csv, "h,a,p,exact,iterations\n");
  fprintf(field, "r,radial,exact\n");
  expand((cavity){.h = 0.5, .largest = 1.6, .outer = 13.6, .steps = 40}, csv, NULL);
  if (!verify_quick()) {
    expand((cavity){.h = 0.25, .largest = 1.6, .outer = 13.6, .steps = 60}, csv, NULL);
    expand((cavity){.h = 0.5, .largest = 3.0, .outer = 30.0, .steps = 120}, csv, field);
  }
  fclose(csv), fclose(field);
  return verify_end();
}
