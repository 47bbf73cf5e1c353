/* Laws of soils, mud and snow on paths without a grid, by mpm_material_update(): stresses of the critical
 * state, of an integration of the rate equations, of closed forms, and of another program. */
#include <string.h>

#include "verify.h"

typedef struct path {
  mpm_material *law;
  const char *name;
  double F[9], stress[6], state[8], dt;
  int32_t states;
} path;

static path path_of(verify_world *w, const char *name, const char *model, const mpm_param *params,
                    int32_t count, double pressure) {
  path p = {.name = name, .F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .dt = 1.0};
  verify_ok(w, mpm_material_create(w->context, model, params, count, &p.law));
  p.states = mpm_material_state_count(model);
  for (int c = 0; c < 3; ++c) p.stress[c] = -pressure;
  return p;
}

static void update(verify_world *w, path *p, const double *F_inc) {
  double F[9] = {0.0}, stress[6], state[8];
  for (int i = 0; i < 9; ++i)
    for (int k = 0; k < 3; ++k) F[i] += F_inc[i / 3 * 3 + k] * p->F[3 * k + i % 3];
  const mpm_material_batch batch = {.struct_size = sizeof batch,
                                    .state_count = p->states,
                                    .n = 1,
                                    .ld = 1,
                                    .dt = p->dt,
                                    .F = F,
                                    .F_inc = F_inc,
                                    .stress = p->stress,
                                    .state = p->states ? p->state : NULL,
                                    .stress_new = stress,
                                    .state_new = p->states ? state : NULL};
  verify_ok(w, mpm_material_update(p->law, &batch, NULL, NULL));
  memcpy(p->F, F, sizeof F);
  memcpy(p->stress, stress, sizeof stress);
  memcpy(p->state, state, (size_t)p->states * sizeof *state);
}

static double pressure_of(const path *p) {
  return -(p->stress[0] + p->stress[1] + p->stress[2]) / 3.0;
}
static double deviator_of(const path *p) {
  return p->stress[0] - p->stress[2];
}

/* Strains along the axes, in equal steps, with the stresses of each written. */
static void strain(verify_world *w, path *p, double x, double y, double z, int32_t steps, FILE *csv) {
  const double F_inc[9] = {exp(x / steps), 0, 0, 0, exp(y / steps), 0, 0, 0, exp(z / steps)};
  for (int32_t k = 0; k <= steps; ++k) {
    if (csv)
      fprintf(csv, "\"%s\",%d,%.6f,%.6f,%.6f\n", p->name, (int)steps, -z * k / steps, 1e-3 * pressure_of(p),
              1e-3 * deviator_of(p));
    if (k < steps) update(w, p, F_inc);
  }
}

static void gate(const char *name, const char *what, double value, double exact, double within,
                 const char *source) {
  verify_gate_of(name, what, value / exact - 1.0, -within, within, source);
}

/* ---- clay ---------------------------------------------------------------------------------------------- */
static const double kappa = 0.02, lambda = 0.12, M = 1.05;

static path clay_of(verify_world *w, const char *name, double pc) {
  const mpm_param clay[] = {{"density", 2e3}, {"kappa", kappa}, {"lambda", lambda}, {"M", M},
                            {"mu0", 4e6},     {"p_ref", 1e5},   {"pc0", pc}};
  path p = path_of(w, name, "cam_clay", clay, 7, 1e5);
  p.state[0] = pc;
  return p;
}

/* Without drainage clay ends at the critical state q = M p, at a pressure that its history alone decides. */
static void undrained(verify_world *w, int32_t steps, FILE *csv) {
  static const struct {
    const char *name;
    double ocr;
  } rows[] = {{"undrained, OCR 1", 1.0001}, {"undrained, OCR 2", 2.0}, {"undrained, OCR 5", 5.0}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    path p = clay_of(w, rows[k].name, 1e5 * rows[k].ocr);
    strain(w, &p, 0.15, 0.15, -0.3, steps, csv);
    const double critical = 1e5 * pow(0.5 * rows[k].ocr, (lambda - kappa) / lambda);
    gate(rows[k].name, "pressure over the critical state's, less 1", pressure_of(&p), critical, 1e-3,
         "closed form");
    gate(rows[k].name, "q over M p, less 1", deviator_of(&p), M * pressure_of(&p), 1e-3, "critical state");
    verify_ok(w, mpm_material_destroy(p.law));
  }
}

static void oedometer(verify_world *w, int32_t steps, FILE *csv) {
  path p = clay_of(w, "oedometer", 1.2e5);
  strain(w, &p, 0.0, 0.0, -0.2, steps, csv);
  const char *source = "rate equations, integrated by another program";
  gate(p.name, "axial stress over exact, less 1", p.stress[2], -849039.3460, 1e-3, source);
  gate(p.name, "stress across over exact, less 1", p.stress[0], -619503.3192, 1e-3, source);
  gate(p.name, "preconsolidation over exact, less 1", p.state[0], 626063.2744, 1e-3, source);
  verify_ok(w, mpm_material_destroy(p.law));
}

/* ---- mud ----------------------------------------------------------------------------------------------- */
/* In steady shear the stress is yield + k rate^n, with no stress less than the yield at any rate. */
static void mud(verify_world *w, FILE *csv) {
  static const double powers[] = {0.5, 1.0, 1.5}, rates[] = {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0};
  double worst = 0.0;
  for (size_t k = 0; k < 3; ++k)
    for (size_t r = 0; r < sizeof rates / sizeof *rates; ++r) {
      const mpm_param of[] = {{"density", 1e3},      {"bulk_modulus", 1e9}, {"shear_modulus", 1e7},
                              {"yield_shear", 50.0}, {"consistency", 20.0}, {"n", powers[k]}};
      path p = path_of(w, "mud", "herschel_bulkley", of, 6, 0.0);
      const double exact = 50.0 + 20.0 * pow(rates[r], powers[k]), step = 0.2 * exact / 1e7;
      p.dt = step / rates[r];
      const double F_inc[9] = {1, step, 0, 0, 1, 0, 0, 0, 1};
      for (int32_t i = 0; i < 100; ++i) update(w, &p, F_inc);
      worst = fmax(worst, fabs(p.stress[3] / exact - 1.0));
      fprintf(csv, "%g,%g,%.6f,%.6f\n", powers[k], rates[r], p.stress[3], exact);
      verify_ok(w, mpm_material_destroy(p.law));
    }
  verify_gate("mud: shear stress over yield + k rate^n, largest error", worst, 0.0, 2e-3,
              "the law in steady shear");
}

/* ---- snow ---------------------------------------------------------------------------------------------- */
/* Three legs, each of which is one step, as the numbers of the other program are; and in parts, for the
 * picture alone. */
static path snow_path(verify_world *w, int32_t parts, FILE *csv) {
  const mpm_param of[] = {{"E", 1.4e5}, {"nu", 0.2}, {"density", 400.0}};
  path p = path_of(w, "snow", "snow", of, 3, 0.0);
  static const struct {
    double x, y, shear;
  } legs[3] = {{0.97, 0.96, 0.0}, {1.0, 1.0, 0.1}, {1.0, 1.03, 0.0}};
  fprintf(csv, "%d,0,0,0,0\n", (int)parts);
  for (int32_t k = 0; k < 3 * parts; ++k) {
    const int32_t leg = k / parts;
    const double share = 1.0 / parts, F_inc[9] = {pow(legs[leg].x, share),
                                                  share * legs[leg].shear,
                                                  0,
                                                  0,
                                                  pow(legs[leg].y, share),
                                                  0,
                                                  0,
                                                  0,
                                                  1};
    update(w, &p, F_inc);
    fprintf(csv, "%d,%.6f,%.6f,%.6f,%.6f\n", (int)parts, share * (k + 1), p.stress[0], p.stress[1],
            p.stress[3]);
  }
  verify_ok(w, mpm_material_destroy(p.law));
  return p;
}

static void snow(verify_world *w, FILE *csv) {
  const path p = snow_path(w, 1, csv);
  snow_path(w, 100, csv);
  const char *source = "another program, equal to 1e-9";
  gate("snow", "xx after three legs over exact, less 1", p.stress[0], -2365.649999755, 1e-9, source);
  gate("snow", "yy after three legs over exact, less 1", p.stress[1], 143.395564477, 1e-8, source);
  gate("snow", "xy after three legs over exact, less 1", p.stress[3], 1470.680581838, 1e-9, source);
}

int main(int argc, char **argv) {
  verify_begin("soil_paths", argc, argv);
  const verify_setup setup = verify_defaults(3, 4, 1.0);
  verify_world w;
  FILE *clay = verify_csv("soil_paths_clay"), *rates = verify_csv("soil_paths_mud"),
       *legs = verify_csv("soil_paths_snow");
  fprintf(clay, "path,steps,strain,p,q\n");
  fprintf(rates, "n,rate,stress,exact\n");
  fprintf(legs, "parts,leg,xx,yy,xy\n");
  verify_open(&w, &setup);
  undrained(&w, 1000, clay);
  oedometer(&w, 1000, clay);
  snow(&w, legs);
  mud(&w, rates);
  verify_close(&w);
  fclose(clay), fclose(rates), fclose(legs);
  return verify_end();
}
