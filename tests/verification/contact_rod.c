/* A stiff rod hits a soft half space at 100 m/s and bores into it, both elastic-plastic (j2), in plane
 * strain; a half of it beside a symmetry plane. Rod: 10 mm wide, 30 mm long, E = 200 GPa, nu = 0.3,
 * density 7850, yield stress 1 GPa; ground: E = 70 GPa, nu = 0.33, density 2700, yield stress 50 MPa. No
 * particle of one body may lie deeper than half a cell in the other. */
#include "verify.h"

enum { ROD, GROUND };
static const double half_width = 5e-3, length = 30e-3, depth = 30e-3, breadth = 40e-3, speed = 100.0;

typedef struct cloud {
  int64_t n, layers; /* layers: those of a few cells below the surfaces that may meet, listed in `near` */
  int64_t *near;
  double *X, *x, *F; /* [2][n], [2][n], [9][n] */
} cloud;

/* Of the undeformed body below the surface with outward normal N: the bottom and the side of the rod, the
 * top of the ground. */
static double below(int32_t set, int32_t surface, const double *X, double *N) {
  N[0] = set == ROD && surface ? 1.0 : 0.0;
  N[1] = N[0] > 0.0 ? 0.0 : set == ROD ? -1.0 : 1.0;
  return set == ROD ? (surface ? half_width - X[0] : X[1]) : -X[1];
}

static void look(const verify_world *w, cloud *c) {
  for (int32_t set = 0; set < 2; ++set) {
    free(c[set].x);
    free(c[set].F);
    c[set].x = verify_get(w, w->set[set], "position", 2);
    c[set].F = verify_get(w, w->set[set], "deformation_gradient", 9);
  }
}

/* How deep a point lies in a particle of the body, whose square of the given edge F has deformed: the
 * least distance to a surface of the deformed body; < 0 outside of the particle. A plane at depth D of the
 * undeformed body is D / |F^-T N| below the surface. */
static double depth_in(const cloud *c, int32_t set, int64_t i, double edge, const double *point) {
  const int64_t n = c->n;
  const double d[2] = {point[0] - c->x[i], point[1] - c->x[n + i]};
  if (fabs(d[0]) + fabs(d[1]) > 20.0 * edge) return -1.0;
  const double *F = c->F + i, J = F[0] * F[4 * n] - F[n] * F[3 * n];
  const double inverse[4] = {F[4 * n] / J, -F[n] / J, -F[3 * n] / J, F[0] / J};
  const double at[2] = {inverse[0] * d[0] + inverse[1] * d[1], inverse[2] * d[0] + inverse[3] * d[1]};
  if (fmax(fabs(at[0]), fabs(at[1])) > 0.5 * edge) return -1.0;
  const double X[2] = {c->X[i] + at[0], c->X[n + i] + at[1]};
  double least = HUGE_VAL;
  for (int32_t surface = 0; surface < (set == ROD ? 2 : 1); ++surface) {
    double N[2];
    const double D = below(set, surface, X, N);
    const double turned[2] = {inverse[0] * N[0] + inverse[2] * N[1], inverse[1] * N[0] + inverse[3] * N[1]};
    least = fmin(least, D / hypot(turned[0], turned[1]));
  }
  return least;
}

static double deepest(const cloud *c, double edge) {
  double most = 0.0;
  for (int32_t set = 0; set < 2; ++set) {
    const cloud *body = &c[set], *other = &c[!set];
    for (int64_t k = 0; k < body->layers; ++k)
      for (int64_t l = 0; l < other->layers; ++l) {
        const int64_t q = other->near[l];
        const double point[2] = {other->x[q], other->x[other->n + q]};
        most = fmax(most, depth_in(body, set, body->near[k], edge, point));
      }
  }
  return most;
}

static void open_cloud(const verify_world *w, cloud *c, int32_t set, double h) {
  c->n = mpm_particles_count(w->set[set]);
  c->X = verify_get(w, w->set[set], "position", 2);
  c->near = malloc((size_t)c->n * sizeof *c->near);
  for (int64_t i = 0; i < c->n; ++i) {
    double N[2], least = HUGE_VAL;
    for (int32_t surface = 0; surface < (set == ROD ? 2 : 1); ++surface)
      least = fmin(least, below(set, surface, (const double[]){c->X[i], c->X[c->n + i]}, N));
    if (least < 3.0 * h) c->near[c->layers++] = i;
  }
}

static void strike(double h, double friction, FILE *table) {
  verify_setup setup = verify_defaults(2, 1, h);
  setup.grid.cells[0] = (int64_t)(breadth / h + 0.5) + 4;
  setup.grid.cells[1] = (int64_t)((depth + length) / h + 0.5) + 12;
  setup.grid.origin[1] = -depth;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param stiff[] = {{"E", 200e9}, {"nu", 0.3}, {"density", 7850.0}, {"yield_stress", 1e9}},
                  soft[] = {{"E", 70e9}, {"nu", 0.33}, {"density", 2700.0}, {"yield_stress", 50e6}};
  mpm_particles *rod = verify_set(&w, verify_material(&w, "j2", stiff, 4)),
                *ground = verify_set(&w, verify_material(&w, "j2", soft, 4));
  verify_fill_box(&w, rod, (const double[]){0.0, 0.0}, (const double[]){half_width, length}, 2);
  verify_fill_box(&w, ground, (const double[]){0.0, -depth}, (const double[]){breadth, 0.0}, 2);
  verify_ok(&w, mpm_particles_set_all(rod, "velocity", MPM_F64, 2, (const double[]){0.0, -speed}));
  verify_ok(&w, mpm_stepper_set_body(w.stepper, ground, 1));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  mpm_contact_desc contact;
  verify_ok(&w, mpm_contact_desc_init(&contact, sizeof contact));
  contact.friction = friction;
  verify_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &contact));
  cloud c[2] = {{0}, {0}};
  for (int32_t set = 0; set < 2; ++set) open_cloud(&w, &c[set], set, h);
  double most = 0.0, least = 0.0;
  mpm_contact_info info = {.struct_size = sizeof info};
  mpm_step_info now = verify_info(&w);
  const double kinetic = now.kinetic_energy;
  while (now.t < 300e-6) {
    const double start = now.t, next = start + 1e-6, before = info.impulse[1];
    double dt;
    while (now.t < next) {
      verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
      now = verify_step(&w, 0.4 * dt);
      least = fmin(least, now.contact_dissipation / kinetic);
    }
    verify_ok(&w, mpm_stepper_contact_info(w.stepper, 0, 1, &info));
    look(&w, c);
    const double deep = deepest(c, 0.5 * h);
    most = fmax(most, deep);
    double tip = HUGE_VAL;
    for (int64_t i = 0; i < c[ROD].n; ++i) tip = fmin(tip, c[ROD].x[c[ROD].n + i]);
    /* of the face: a particle of the lowest row reaches a quarter of a cell down */
    fprintf(table, "%g,%g,%.3f,%.5f,%.5f,%.3f\n", 1e3 * h, friction, 1e6 * now.t, 1e3 * (0.25 * h - tip),
            deep / h, 1e-6 * (before - info.impulse[1]) / ((now.t - start) * half_width));
  }
  char name[60];
  snprintf(name, sizeof name, "h = %g mm, friction %g", 1e3 * h, friction);
  verify_gate_of(name, "deepest particle in the other body / h", most / h, 0.0, 0.5, "set tolerance");
  verify_gate_of(name, "least dissipation of a step / energy", least, -1e-12, 0.0,
                 "contact takes energy and never gives any");
  verify_progress("%s", name);
  for (int32_t set = 0; set < 2; ++set) {
    free(c[set].near);
    free(c[set].X);
    free(c[set].x);
    free(c[set].F);
  }
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("contact_rod", argc, argv);
  FILE *table = verify_csv("contact_rod");
  fprintf(table, "h,friction,t,bored,deepest,pressure\n");
  for (int32_t k = 0; k < (verify_quick() ? 1 : 4); ++k)
    strike(k < 2 ? 1e-3 : 0.5e-3, k % 2 ? 0.3 : 0.0, table);
  fclose(table);
  return verify_end();
}
