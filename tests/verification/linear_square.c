/* The linear basis in explicit steps (docs/theory.md, section 16): a free square that vibrates, v = 0.2 (x -
 * 0.75, 0.75 - y), and drifts across cells into empty ones until t = 5. Edge 0.5, E = 1000, nu = 0.3, density
 * 1000, cells of 1/40. Steps are shares of the stable one. The quadratic basis for comparison. And a
 * block in slow flight. */
#include "verify.h"

typedef struct method {
  const char *name;
  int32_t transfer, xpic_order;
} method;
enum { FLIP, XPIC_2, APIC, TPIC, TFLIP, AFLIP, XPIC_5, METHODS };
static const method methods[METHODS] = {
    {"FLIP", MPM_FLIP, 2},   {"XPIC(2)", MPM_XPIC, 2}, {"APIC", MPM_APIC, 2},   {"TPIC", MPM_TPIC, 2},
    {"TFLIP", MPM_TFLIP, 2}, {"AFLIP", MPM_AFLIP, 2},  {"XPIC(5)", MPM_XPIC, 5}};

static int32_t is_affine(int32_t m) {
  return m >= APIC && m <= AFLIP;
}

typedef struct series {
  const char *name;
  int32_t basis, remedy, methods; /* the first so many */
} series;
static const series all[] = {{"linear", MPM_LINEAR, MPM_LOCKING_NONE, METHODS},
                             {"linear, remedy", MPM_LINEAR, MPM_LOCKING_CELL_AVERAGE, APIC + 1},
                             {"quadratic", MPM_BSPLINE2, MPM_LOCKING_NONE, XPIC_2 + 1},
                             {"quadratic, remedy", MPM_BSPLINE2, MPM_LOCKING_CELL_AVERAGE, XPIC_2 + 1}};

typedef struct outcome {
  mpm_status status;
  double t, end, most; /* energies over the first: in the end, and the largest on the way */
} outcome;
static const double t_end = 5.0;

static outcome drift(const series *on, const method *how, const verify_scheme *by, double share) {
  verify_setup setup = verify_defaults(2, 60, 1.0 / 40.0);
  setup.grid.basis = on->basis;
  setup.stepper.locking_remedy = on->remedy;
  verify_use(&setup, by, how->transfer);
  setup.stepper.xpic_order = how->xpic_order;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, 1000.0));
  verify_fill_box(&w, set, (const double[]){0.5, 0.5}, (const double[]){1.0, 1.0}, 2);
  const int64_t n = mpm_particles_count(set);
  const double L[9] = {0.2, 0.0, 0.0, 0.0, -0.2, 0.0, 0.0, 0.0, 0.0};
  double *v = verify_get(&w, set, "position", 2);
  for (int64_t i = 0; i < n; ++i) {
    v[i] = 0.05 + L[0] * (v[i] - 0.75);
    v[n + i] = 0.03 + L[4] * (v[n + i] - 0.75);
  }
  verify_put(&w, set, "velocity", 2, v);
  free(v);
  verify_ok(&w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, L));
  mpm_step_info now = verify_info(&w);
  const double first = now.kinetic_energy + now.strain_energy;
  outcome out = {MPM_OK, 0.0, 1.0, 1.0};
  for (;;) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    const int last = share * dt >= t_end - out.t;
    out.status = mpm_step(w.stepper, last ? t_end - out.t : share * dt, &now);
    if (out.status) break;
    out.t = last ? t_end : now.t;
    out.end = (now.kinetic_energy + now.strain_energy) / first;
    out.most = fmax(out.most, out.end);
    if (last) break;
  }
  verify_close(&w);
  return out;
}

/* t: shortest time reached, with least energy at the end and largest on the way, over shares. */
static void judge(const series *on, int32_t m, int32_t scheme, double t, double least, double most) {
  const int32_t linear = on->basis == MPM_LINEAR;
  const int32_t sways = linear && scheme == VERIFY_USF && is_affine(m);
  const char *const rows[] = {"shortest time reached", "least energy at the end / first",
                              "largest energy / first"};
  const char *const unmet[] = {NULL,
                               m == XPIC_2 || m == XPIC_5 ? "XPIC damps what its filter takes"
                               : !linear                  ? NULL
                               : is_affine(m)         ? "affine transfers damp where particles cross nodes"
                               : scheme == VERIFY_USL ? "USL damps where particles cross nodes"
                                                      : NULL,
                               sways                  ? "strain and motion of USF are a step apart"
                               : !linear || m != FLIP ? NULL
                               : scheme == VERIFY_USL ? NULL
                               : on->remedy           ? "nothing resists noise in the dilations of one cell"
                               : scheme == VERIFY_USF ? "strain and motion of USF are a step apart"
                                                      : NULL};
  const double value[] = {t, least, most}, low[] = {t_end, 0.95, 0.0},
               high[] = {t_end, (double)INFINITY, 1.05};
  for (int32_t k = 0; k < 3; ++k) {
    char what[120];
    snprintf(what, sizeof what, "%s, %s, %s: %s", on->name, methods[m].name, verify_schemes[scheme].name,
             rows[k]);
    verify_judge(what, value[k], low[k], high[k], k == 0 ? "it stays a body" : "conservation; set tolerance",
                 unmet[k]);
  }
}

/* A block of 2 x 2 cells without stress, that goes a thousandth of a cell by each step of 0.4 of the stable
 * one. Returns how many of 2000 steps it makes before it is strained by more than a thousandth of its motion.
 */
static int32_t fly(int32_t scheme, int32_t transfer) {
  enum { STEPS = 2000 };
  verify_setup setup = verify_defaults(2, 12, 1.0);
  setup.grid.basis = MPM_LINEAR;
  verify_use(&setup, &verify_schemes[scheme], transfer);
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, 1.0));
  verify_fill_box(&w, set, (const double[]){3.0, 3.0}, (const double[]){5.0, 5.0}, 2);
  double dt;
  verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
  dt *= 0.4;
  const double v[2] = {1e-3 / dt, 5e-4 / dt};
  verify_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  int32_t k = 0;
  for (mpm_step_info now = {.struct_size = sizeof now}; k < STEPS; ++k)
    if (mpm_step(w.stepper, dt, &now) || now.strain_energy > 1e-3 * now.kinetic_energy) break;
  verify_close(&w);
  return k;
}

static void flights(void) {
  static const int32_t transfers[] = {FLIP, APIC};
  for (int32_t scheme = 0; scheme < VERIFY_SCHEMES; ++scheme)
    for (int32_t i = 0; i < 2; ++i) {
      const method *how = &methods[transfers[i]];
      char what[120];
      snprintf(what, sizeof what, "slow flight, linear, %s, %s: steps until it is strained", how->name,
               verify_schemes[scheme].name);
      verify_gate(what, fly(scheme, how->transfer), 2000.0, 2000.0, "it flies on");
    }
}

int main(int argc, char **argv) {
  verify_begin("linear_square", argc, argv);
  FILE *table = verify_csv("linear_square");
  fprintf(table, "series,transfer,scheme,share,status,t,end,most\n");
  static const double share[4] = {0.5, 0.3, 0.1, 0.02};
  double small_t = t_end, small_most = 0.0; /* over the affine transfers at the smallest share */
  for (size_t a = 0; a < sizeof all / sizeof *all; ++a) {
    const int32_t shares = verify_quick() ? 1 : a == 0 ? 4 : 3;
    for (int32_t k = 0; k < VERIFY_SCHEMES; ++k) {
      const char *scheme = verify_schemes[k].name;
      for (int32_t m = 0; m < all[a].methods; ++m) {
        double t = t_end, least = 1.0, most = 1.0;
        for (int32_t s = 0; s < shares; ++s) {
          const outcome o = drift(&all[a], &methods[m], &verify_schemes[k], share[s]);
          fprintf(table, "\"%s\",%s,%s,%g,%s,%.3f,%.5f,%.5f\n", all[a].name, methods[m].name, scheme,
                  share[s], mpm_status_name(o.status), o.t, o.end, o.most);
          if (s < 3) t = fmin(t, o.t);
          if (s < 3) least = fmin(least, o.end), most = fmax(most, o.most);
          if (s == 3 && is_affine(m)) small_t = fmin(small_t, o.t), small_most = fmax(small_most, o.most);
        }
        judge(&all[a], m, k, t, least, most);
      }
      verify_progress("%s, %s", all[a].name, scheme);
    }
  }
  if (!verify_quick()) {
    verify_gate("linear, affine transfers, share 0.02: shortest time reached", small_t, t_end, t_end,
                "it stays a body");
    verify_gate("linear, affine transfers, share 0.02: largest energy / first", small_most, 0.0, 1.05,
                "conservation; set tolerance");
  }
  flights();
  fclose(table);
  return verify_end();
}
