/* A column of dry sand as high as it is wide, in plane strain, collapses beside a smooth wall on a rough
 * floor (phi = 30 degrees, psi = 0, no cohesion): how far it runs, by the cone of `drucker_prager`, by what
 * becomes of gaps, by cells and by damping, and with `mohr_coulomb`; beside the experiments of Lube et al.
 * 2005. */
#include "soil.h"

static const double wide = 0.2, high = 0.2, E = 1e6, nu = 0.3, density = 2000.0, phi = 30.0, g = 9.81;
static const double experiment = 1.2; /* run-out over the width, of columns as high as wide */

typedef struct variant {
  const char *name;
  int32_t mohr, cone, closes, cells; /* cells: in the width */
  double damping;
  double run_out, height, volume; /* of an independent implementation; 0: it has none */
  const char *beyond;             /* why it does not meet the experiments */
} variant;

typedef struct outcome {
  double run_out, height, volume;
} outcome;

static int compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Run-out of 99 % of the mass, height at the wall, and all volume, over those of the column. */
static outcome look(const verify_world *w) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *x = verify_get(w, w->set[0], "position", 2), *volume = verify_get(w, w->set[0], "volume", 1);
  outcome out = {0.0, 0.0, 0.0};
  for (int64_t i = 0; i < n; ++i) {
    out.volume += volume[i] / (wide * high);
    if (x[i] < 0.1 * wide) out.height = fmax(out.height, x[n + i] / wide);
  }
  qsort(x, (size_t)n, sizeof *x, compare);
  out.run_out = x[(int64_t)(0.99 * (double)n)] / wide - 1.0;
  free(x), free(volume);
  return out;
}

static outcome collapse(const variant *v, FILE *csv, FILE *film) {
  verify_setup setup = verify_defaults(2, 0, wide / v->cells);
  setup.grid.cells[0] = 9 * v->cells / 2;
  setup.grid.cells[1] = 13 * v->cells / 10 + 4;
  setup.stepper.scheme = MPM_MUSL;
  setup.stepper.gravity[1] = -g;
  setup.stepper.pic_damping = v->damping;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param params[] = {
      {"E", E}, {"nu", nu}, {"density", density}, {"phi", phi}, {"close_gaps", v->closes}, {"cone", v->cone}};
  mpm_particles *sand = verify_set(
      &w, verify_material(&w, v->mohr ? "mohr_coulomb" : "drucker_prager", params, v->mohr ? 5 : 6));
  verify_fill_box(&w, sand, (const double[]){0.0, 0.0}, (const double[]){wide, high}, 2);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  soil_settle(&w, &(soil_rest){0.0, density * g, high, nu / (1.0 - nu)});
  outcome out = look(&w);
  enum { SAMPLES = 25 };
  for (int32_t k = 0; k <= SAMPLES; ++k) {
    const double t = 5.0 * k / SAMPLES;
    if (k > 0) verify_advance(&w, 0.4, t * sqrt(high / g));
    out = look(&w);
    fprintf(csv, "\"%s\",%.2f,%.5f,%.5f,%.5f\n", v->name, t, out.run_out, out.height, out.volume);
    if (film && (k == 5 || k == 10 || k == 15 || k == SAMPLES)) {
      char label[16];
      snprintf(label, sizeof label, "%.1f", t);
      soil_cloud(&w, label, wide, 1.0, film);
    }
  }
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("soil_column", argc, argv);
  static const char *const moves =
      "FLIP without damping loses no energy to the grid; what is in front still moves";
  static const variant list[] = {
      {"cone 2, h = L/10", 0, 2, 1, 10, 5.0, 1.446, 0.819, 1.053, NULL},
      {"cone 2, gaps stay open, h = L/10", 0, 2, 0, 10, 5.0, 1.530, 0.839, 1.097, NULL},
      {"cone 0, h = L/10", 0, 0, 1, 10, 5.0, 0.922, 0.919, 1.019, NULL},
      {"cone 2, h = L/20", 0, 2, 1, 20, 5.0, 1.524, 0.821, 1.028, NULL},
      {"cone 2, no damping, h = L/20", 0, 2, 1, 20, 0.0, 1.670, 0.817, 1.058, moves},
      {"Mohr-Coulomb, h = L/20", 1, 0, 1, 20, 5.0, 0.0, 0.0, 0.0, NULL}};
  FILE *csv = verify_csv("soil_column"), *film = verify_csv("soil_column_film");
  fprintf(csv, "variant,t,run_out,height,volume\n");
  fprintf(film, "t,x,y,plastic\n");
  const char *source = "an independent implementation, with a margin of 5 %";
  for (int32_t i = 0; i < (verify_quick() ? 3 : 6); ++i) {
    const variant *v = &list[i];
    const outcome is = collapse(v, csv, i == 3 ? film : NULL);
    if (v->run_out > 0.0) {
      verify_gate_of(v->name, "run-out / L", is.run_out, 0.95 * v->run_out, 1.05 * v->run_out, source);
      verify_gate_of(v->name, "height at the wall / L", is.height, 0.95 * v->height, 1.05 * v->height,
                     source);
      verify_gate_of(v->name, "volume / first", is.volume, 0.98 * v->volume, 1.02 * v->volume,
                     "an independent implementation, with a margin of 2 %");
    }
    char what[96];
    snprintf(what, sizeof what, "%s: run-out / that of experiments", v->name);
    verify_judge(what, is.run_out / experiment, 0.7, 1.3, "Lube et al. 2005; set tolerance", v->beyond);
  }
  fclose(csv), fclose(film);
  return verify_end();
}
