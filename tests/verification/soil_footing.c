/* A flexible strip of width B = 1 on weightless ground of friction and cohesion that dilates by its angle
 * of friction (associated), in plane strain and quasi-static steps: the load at collapse beside the exact
 * one of Prandtl and Reissner, q = c N_c + q_0 N_q, with N_q = exp(pi tan phi) tan^2(45 + phi / 2) and N_c
 * = (N_q - 1) / tan phi. By law, basis, cells, and with the remedy against locking. Half of it. The load at
 * collapse is the last one of which Newton's method finds the equilibrium. */
#include "soil.h"

enum { PER_CELL = 2, STEPS = 40 };
static const double sunk = 0.02; /* a settlement over B, beyond that of elastic ground */

enum {
  EVEN = 1,   /* both rows of particles bear the same, in place of a load at the surface */
  FINER = 2,  /* steps are a quarter of the others' */
  BESIDE = 4, /* the variant before is the same without the remedy, and loads at `sunk` are compared */
  UNTOLD = 8  /* rounding decides which load is the last: that at `sunk` is judged in its place */
};
typedef struct variant {
  int32_t mohr, phi, surcharge; /* surcharge: N_q, by a load beside the strip, without cohesion; else N_c */
  int32_t basis, remedy, per_B;
  int32_t how;        /* what is unlike the rest: flags from above */
  const char *reason; /* why it misses the gate */
} variant;

typedef struct strip {
  double load, beside, height, row; /* load: at t = 1, beyond that beside the strip */
  int32_t even;
} strip;

static mpm_status lie(void *user, const mpm_particle_batch *b, double *add) {
  const strip *is = user;
  for (int64_t p = 0; p < b->n; ++p) {
    const double deep = is->height - b->reference_position[b->ld + p];
    const double q = is->beside + (b->reference_position[p] < 0.5 ? is->load * b->t : 0.0);
    const double share = !is->even ? soil_row_share(deep, is->row) : deep < 2.0 * is->row ? 0.5 : 0.0;
    add[b->ld + p] -= share * q * is->row;
  }
  return MPM_OK;
}

/* Loads over the exact limit: the last one, and that at the settlement `sunk`. */
typedef struct loads {
  double last, sunk;
} loads;

static loads collapse(const variant *v, const char *name, FILE *csv, FILE *cloud) {
  const double h = 1.0 / v->per_B, wide = v->phi > 20 ? 6.0 : 4.0, deep = v->phi > 20 ? 3.0 : 2.0;
  const double angle = v->phi * PI / 180.0, N_q = exp(PI * tan(angle)) * pow(tan(PI / 4.0 + 0.5 * angle), 2);
  verify_setup setup = verify_defaults(2, 1, h);
  setup.grid.basis = v->basis;
  setup.grid.cells[0] = (int64_t)wide * v->per_B;
  setup.grid.cells[1] = (int64_t)deep * v->per_B + 3;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = 1;
  setup.stepper.locking_remedy = v->remedy;
  setup.stepper.reference_positions = 1;
  verify_world w;
  verify_open(&w, &setup);
  const double exact = v->surcharge ? N_q : (N_q - 1.0) / tan(angle);
  const mpm_param params[] = {{"E", 100.0 * v->phi}, {"nu", 0.3},     {"density", 1.0},
                              {"phi", v->phi},       {"psi", v->phi}, {"cohesion", v->surcharge ? 0.0 : 1.0},
                              {"cone", 2.0}};
  mpm_particles *ground = verify_set(
      &w, verify_material(&w, v->mohr ? "mohr_coulomb" : "drucker_prager", params, v->mohr ? 6 : 7));
  verify_fill_box(&w, ground, (const double[]){0.0, 0.0}, (const double[]){wide, deep}, PER_CELL);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  strip load = {v->surcharge ? exact - 1.0 : exact, v->surcharge ? 1.0 : 0.0, deep, h / PER_CELL,
                v->how & EVEN};
  verify_ok(&w, mpm_stepper_set_force(w.stepper, lie, &load));
  const int64_t n = mpm_particles_count(ground);
  double *X = verify_get(&w, ground, "position", 2);
  int64_t middle = 0; /* of the strip */
  for (int64_t p = 0; p < n; ++p)
    if (X[n + p] - X[p] > X[n + middle] - X[middle]) middle = p;
  soil_settle(&w, &(soil_rest){load.beside, 0.0, deep, 1.0});
  const double step = 1.0 / (STEPS * (v->how & FINER ? 4 : 1));
  double dt = step, carried = 0.0, settled = 0.0;
  loads of = {0.0, 0.0};
  while (dt > 0.1 * step && carried < 1.5) {
    mpm_step_info info = {.struct_size = sizeof info};
    if (mpm_step(w.stepper, dt, &info)) {
      dt *= 0.5;
      continue;
    }
    double *x = verify_get(&w, ground, "position", 2);
    const double now = (load.beside + load.load * info.t) / exact, down = X[n + middle] - x[n + middle];
    if (settled < sunk && down >= sunk)
      of.sunk = carried + (now - carried) * (sunk - settled) / (down - settled);
    carried = now, settled = down;
    fprintf(csv, "\"%s\",%d,%.5f,%.6f,%d\n", name, (int)v->per_B, carried, settled,
            (int)info.newton_iterations);
    free(x);
  }
  if (cloud) {
    char label[112];
    snprintf(label, sizeof label, "\"%s\"", name);
    soil_cloud(&w, label, 1.0, 100.0, cloud);
  }
  free(X);
  verify_close(&w);
  of.last = carried;
  return of;
}

int main(int argc, char **argv) {
  verify_begin("soil_footing", argc, argv);
  static const char *const locks = "volumetric locking of plastic flow; it goes with h";
  static const char *const together = "the law dilates at one rate in the whole cell, which is that of the "
                                      "largest shear in it; it goes with h";
  static const char *const rows = "the remedy leaves a cell one pressure: that the upper of two rows bears "
                                  "more is up to shear, which yields";
  static const char *const sinks =
      "the last load comes when the strip has sunk by 0.07 B and more; it begins "
      "to sink at 1.03 to 1.07";
  static const variant list[] = {
      {1, 20, 0, MPM_BSPLINE2, 0, 6, 0, NULL},     {0, 20, 1, MPM_BSPLINE2, 0, 6, 0, NULL},
      {1, 20, 0, MPM_BSPLINE2, 0, 8, 0, NULL},     {1, 20, 0, MPM_BSPLINE2, 0, 16, 0, NULL},
      {0, 20, 0, MPM_BSPLINE2, 0, 8, 0, NULL},     {1, 30, 0, MPM_BSPLINE2, 0, 4, 0, NULL},
      {1, 30, 0, MPM_BSPLINE2, 0, 8, 0, NULL},     {0, 30, 0, MPM_BSPLINE2, 0, 8, 0, NULL},
      {1, 20, 1, MPM_BSPLINE2, 0, 8, 0, NULL},     {0, 20, 1, MPM_BSPLINE2, 0, 8, 0, NULL},
      {1, 30, 1, MPM_BSPLINE2, 0, 8, 0, NULL},     {0, 30, 1, MPM_BSPLINE2, 0, 8, 0, NULL},
      {1, 20, 0, MPM_LINEAR, 0, 8, 0, locks},      {1, 20, 0, MPM_LINEAR, 0, 16, 0, NULL},
      {1, 20, 0, MPM_LINEAR, 1, 8, 0, NULL},       {1, 20, 0, MPM_LINEAR, 1, 16, 0, NULL},
      {0, 20, 0, MPM_LINEAR, 1, 8, 0, NULL},       {0, 20, 1, MPM_LINEAR, 1, 8, 0, NULL},
      {1, 30, 1, MPM_LINEAR, 1, 16, 0, NULL},      {1, 20, 0, MPM_GIMP, 1, 16, 0, NULL},
      {1, 20, 0, MPM_BSPLINE2, 1, 8, 0, together}, {1, 20, 0, MPM_BSPLINE2, 1, 16, 0, rows},
      {1, 20, 0, MPM_BSPLINE2, 1, 16, EVEN, NULL}, {0, 30, 0, MPM_LINEAR, 1, 8, 0, NULL},
      {1, 30, 0, MPM_LINEAR, 1, 16, 0, NULL},      {0, 30, 1, MPM_LINEAR, 1, 16, 0, NULL},
      {1, 20, 1, MPM_GIMP, 1, 16, 0, NULL},        {1, 30, 1, MPM_GIMP, 1, 16, 0, NULL},
      {1, 20, 1, MPM_LINEAR, 0, 8, 0, locks},      {1, 20, 1, MPM_LINEAR, 1, 8, BESIDE, NULL},
      {1, 30, 1, MPM_LINEAR, 0, 8, 0, locks},      {1, 30, 1, MPM_LINEAR, 1, 8, BESIDE, sinks},
      {0, 30, 1, MPM_LINEAR, 0, 8, UNTOLD, NULL},  {0, 30, 1, MPM_LINEAR, 1, 8, BESIDE | UNTOLD, NULL},
      {1, 30, 1, MPM_GIMP, 0, 8, 0, locks},        {1, 30, 1, MPM_GIMP, 1, 8, BESIDE, sinks},
      {1, 30, 0, MPM_LINEAR, 0, 8, 0, locks},      {1, 30, 0, MPM_LINEAR, 1, 8, BESIDE, NULL},
      {1, 30, 1, MPM_LINEAR, 0, 8, FINER, locks},  {1, 30, 1, MPM_LINEAR, 1, 8, FINER | BESIDE, NULL},
      {1, 30, 0, MPM_LINEAR, 1, 8, FINER, NULL},   {1, 20, 1, MPM_LINEAR, 0, 16, 0, NULL},
      {1, 30, 1, MPM_LINEAR, 0, 16, 0, NULL},      {1, 30, 0, MPM_LINEAR, 0, 16, 0, NULL},
      {1, 20, 1, MPM_GIMP, 0, 16, 0, NULL}};
  FILE *csv = verify_csv("soil_footing"), *cloud = verify_csv("soil_footing_cloud");
  fprintf(csv, "variant,cells,load,settlement,iterations\n");
  fprintf(cloud, "variant,x,y,plastic\n");
  loads above = {0.0, 0.0};
  const int32_t count = verify_quick() ? 2 : (int32_t)(sizeof list / sizeof *list);
  for (int32_t i = 0; i < count; ++i) {
    const variant *v = &list[i];
    char name[96], what[140];
    const char *basis = v->basis == MPM_LINEAR ? "linear" : v->basis == MPM_GIMP ? "GIMP" : "quadratic";
    snprintf(name, sizeof name, "N_%s, phi = %d, %s, %s%s%s%s", v->surcharge ? "q" : "c", (int)v->phi,
             v->mohr ? "mohr_coulomb" : "drucker_prager", basis, v->remedy ? ", remedy" : "",
             v->how & EVEN ? ", both rows alike" : "", v->how & FINER ? ", steps of 0.6 %" : "");
    const int32_t untold = v->how & UNTOLD;
    snprintf(what, sizeof what, "%s, h = B/%d: load at %s / exact", name, (int)v->per_B,
             untold ? "0.02 B" : "collapse");
    const int32_t drawn = v->mohr && !v->surcharge && v->basis == MPM_BSPLINE2 && !v->remedy && v->per_B == 8;
    const loads is = collapse(v, name, csv, drawn ? cloud : NULL);
    verify_progress("%s, h = B/%d", name, (int)v->per_B);
    verify_judge(what, untold ? is.sunk : is.last, 0.97, 1.10, "Prandtl, Reissner; set tolerance", v->reason);
    if (v->how & BESIDE) {
      snprintf(what, sizeof what, "%s, h = B/%d: load at 0.02 B / that without", name, (int)v->per_B);
      verify_gate(what, is.sunk / above.sunk, 0.9, 0.99, "set gate: the remedy softens");
    }
    above = is;
  }
  fclose(csv), fclose(cloud);
  return verify_end();
}
