/* A block between two fixed walls, stretched or compressed along x and in equilibrium, with speeds of 1e-5
 * of that of sound: nothing should happen. E = 1000, nu = 0.3, density 1, 18 by 18 cells, periodic in y,
 * four tenths of the stable step. What grows is a mode that the method makes. Beside it nearly incompressible
 * blocks with the locking remedy, stretched at constant volume, or without getting thinner. */
#include "spinning_square.h"

enum { STEPS = 3000, MANY_STEPS = 100000, CELLS = 18 };

typedef struct method {
  const char *name;
  int32_t transfer;
  double flip;
  int32_t order; /* 0: that of the library */
  int32_t total; /* mpm_grid_desc.total_lagrangian */
} method;

typedef struct block {
  double stretch, across, nu; /* stretches along x and y */
  int32_t remedy;
} block;

static int32_t steps(void) {
  return verify_quick() ? STEPS / 6 : STEPS;
}

/* Kinetic over strain energy at the end; 1 or more where a step failed. */
static double shake(const method *how, const verify_scheme *by, const block *is, int32_t steps,
                    double *first) {
  const double h = 0.05, speed = 1e-3;
  verify_setup setup = verify_defaults(2, CELLS, h);
  setup.grid.periodic[1] = 1;
  setup.grid.total_lagrangian = how->total;
  verify_use(&setup, by, how->transfer);
  setup.stepper.flip = how->flip;
  if (how->order) setup.stepper.xpic_order = how->order;
  setup.stepper.locking_remedy = is->remedy;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, is->nu, 1.0));
  verify_fill_box(&w, set, (const double[]){0.0, 0.0}, (const double[]){CELLS * h, CELLS * h}, 2);
  const double F[9] = {is->stretch, 0.0, 0.0, 0.0, is->across, 0.0, 0.0, 0.0, 1.0};
  verify_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_FIXED, 0.0));
  const int64_t n = 2 * mpm_particles_count(set);
  double *v = verify_array(n);
  verify_noise(n, speed, v);
  verify_put(&w, set, "velocity", 2, v);
  free(v);
  mpm_step_info now = verify_info(&w);
  const double strain = now.strain_energy;
  mpm_status status = MPM_OK;
  *first = now.kinetic_energy / strain;
  for (int32_t k = 0; k < steps && !status; ++k) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    status = mpm_step(w.stepper, 0.4 * dt, &now);
  }
  verify_close(&w);
  return status ? 1.0 : now.kinetic_energy / strain;
}

/* From which stretch on MUSL makes something grow: where there is more kinetic energy after 3000 steps than
 * after a third of them. */
static void onsets(void) {
  static const double stretch[] = {1.05, 1.1, 1.2, 1.3, 1.5};
  static const struct {
    method how;
    double least;
  } list[] = {{{"FLIP", MPM_FLIP, 1.0, 0, 0}, 1.05},       {{"XPIC(2)", MPM_XPIC, 1.0, 2, 0}, 1.1},
              {{"TFLIP", MPM_TFLIP, 1.0, 0, 0}, 1.2},      {{"AFLIP", MPM_AFLIP, 1.0, 0, 0}, 1.2},
              {{"FMPM(2)", MPM_FMPM, 1.0, 2, 0}, 1.2},     {{"TPIC", MPM_TPIC, 1.0, 0, 0}, 1.2},
              {{"APIC", MPM_APIC, 1.0, 0, 0}, 1.3},        {{"FMPM(8)", MPM_FMPM, 1.0, 8, 0}, 1.3},
              {{"APIC_MLS", MPM_APIC_MLS, 1.0, 0, 0}, 1.5}};
  for (size_t m = 0; m < sizeof list / sizeof *list; ++m) {
    double least = HUGE_VAL, first;
    for (size_t s = 0; s < sizeof stretch / sizeof *stretch && least == HUGE_VAL; ++s) {
      const block is = {stretch[s], 1.0, 0.3, 0};
      const verify_scheme *by = &verify_schemes[VERIFY_MUSL];
      const double third = shake(&list[m].how, by, &is, STEPS / 3, &first);
      if (shake(&list[m].how, by, &is, STEPS, &first) > third) least = stretch[s];
    }
    char what[100];
    snprintf(what, sizeof what, "MUSL, %s: least of the stretches 1.05, 1.1, 1.2, 1.3, 1.5 at which it grows",
             list[m].how.name);
    verify_gate(what, least, list[m].least, list[m].least, "as the guide says");
  }
}

/* Nearly incompressible blocks with the remedy and APIC. Where the volume is kept nothing may grow. Where it
 * has to grow, the stress is of the size of the bulk modulus, and a total Lagrangian grid alone rests. */
static void incompressible(void) {
  static const char *const reason = "the volume is forced to grow: stress of the size of the bulk modulus";
  static const method updated = {"APIC", MPM_APIC, 1.0, 0, 0}, total = {"APIC", MPM_APIC, 1.0, 0, 1};
  static const struct {
    double nu, stretch;
    int32_t kept, scheme, total, grows; /* kept: the volume */
  } list[] = {{0.49, 1.5, 1, VERIFY_MUSL, 0, 0},       {0.49, 1.5, 1, VERIFY_PROJECTED, 0, 0},
              {0.49, 2.0, 1, VERIFY_USL, 0, 0},        {0.49, 2.0, 1, VERIFY_MUSL, 0, 0},
              {0.49, 2.0, 1, VERIFY_PROJECTED, 0, 0},  {0.499, 2.0, 1, VERIFY_USL, 0, 0},
              {0.499, 2.0, 1, VERIFY_MUSL, 0, 0},      {0.499, 2.0, 1, VERIFY_PROJECTED, 0, 0},
              {0.49, 1.2, 0, VERIFY_USL, 0, 0},        {0.49, 1.2, 0, VERIFY_MUSL, 0, 1},
              {0.49, 1.2, 0, VERIFY_PROJECTED, 0, 0},  {0.499, 1.2, 0, VERIFY_MUSL, 0, 1},
              {0.499, 1.2, 0, VERIFY_PROJECTED, 0, 1}, {0.499, 1.2, 0, VERIFY_MUSL, 1, 0},
              {0.499, 1.5, 0, VERIFY_MUSL, 1, 0}};
  for (size_t i = 0; i < (verify_quick() ? 2 : sizeof list / sizeof *list); ++i) {
    const block is = {list[i].stretch, list[i].kept ? 1.0 / list[i].stretch : 1.0, list[i].nu, 1};
    const verify_scheme *by = &verify_schemes[list[i].scheme];
    char what[160];
    double first;
    const double last = shake(list[i].total ? &total : &updated, by, &is, steps(), &first);
    snprintf(what, sizeof what, "nu = %g, remedy, APIC, %s, stretch %g, %s%s: kinetic energy, last / first",
             is.nu, list[i].kept ? "volume kept" : "confined", is.stretch, by->name,
             list[i].total ? ", total Lagrangian" : "");
    verify_judge(what, last / first, 0.0, 1.0, "equilibrium", list[i].grows ? reason : NULL);
  }
}

/* A square of 8 cells that spins freely: what the centrifugal force stretches. */
enum { LOST = 1, ENERGY = 2, SPIN = 4, SHAPE = 8 };
typedef struct spinner {
  const char *name;
  int32_t basis, scheme, transfer; /* scheme: index of verify_schemes */
  double omega;
  int32_t steps, unmet; /* unmet: gates that are expected to fail */
  const char *reason;
} spinner;

static void spin(const spinner *is) {
  const double h = 0.05, dt = 0.4 * h / spinning_square_speed();
  verify_setup setup = verify_defaults(2, 20, h);
  setup.grid.basis = is->basis;
  verify_use(&setup, &verify_schemes[is->scheme], is->transfer);
  verify_world w;
  mpm_particles *set = spinning_square(&w, &setup, is->omega);
  const mpm_step_info first = verify_info(&w);
  mpm_step_info now = first;
  mpm_status status = MPM_OK;
  double most = 0.0, radius = 0.0;
  int32_t steps = 0;
  while (steps < is->steps && !status) {
    status = mpm_step(w.stepper, dt, &now);
    steps += !status;
    most = fmax(most, now.kinetic_energy + now.strain_energy);
  }
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 2);
  for (int64_t i = 0; i < n; ++i) radius = fmax(radius, hypot(x[i], x[n + i]));
  free(x);
  verify_close(&w);
  const double turn = is->omega * dt / (2.0 * PI);
  const struct {
    int32_t unmet;
    const char *what, *source;
    double value, low, high;
  } gates[] = {{LOST, "turns without loss", "it survives", steps * turn, is->steps * turn, is->steps * turn},
               {ENERGY, "largest energy / first", "energy is not made, but for the start without stress",
                most / (first.kinetic_energy + first.strain_energy), 0.0, 1.002},
               {SPIN, "change of angular momentum", "conservation",
                fabs(now.angular_momentum[2] / first.angular_momentum[2] - 1.0), 0.0, 1e-8},
               {SHAPE, "largest radius / that of the corners", "it stays a body; set tolerance",
                radius / (sqrt(2.0) * (0.5 * spinning_square_side - 0.25 * h)), 0.95, 1.03}};
  for (size_t k = 0; k < sizeof gates / sizeof *gates; ++k) {
    char what[160];
    snprintf(what, sizeof what, "spinning square, %.0f turns, %s: %s", is->steps * turn, is->name,
             gates[k].what);
    verify_judge(what, gates[k].value, gates[k].low, gates[k].high, gates[k].source,
                 is->unmet & gates[k].unmet ? is->reason : NULL);
  }
  verify_progress("spinning square, %s: %d steps", is->name, (int)steps);
}

int main(int argc, char **argv) {
  verify_begin("tension", argc, argv);
  FILE *table = verify_csv("tension");
  fprintf(table, "stretch,transfer,scheme,first,last\n");
  static const method methods[] = {{"FLIP", MPM_FLIP, 1.0, 0, 0},      {"APIC", MPM_APIC, 1.0, 0, 0},
                                   {"FLIP .98", MPM_FLIP, 0.98, 0, 0}, {"APIC_MLS", MPM_APIC_MLS, 1.0, 0, 0},
                                   {"TPIC", MPM_TPIC, 1.0, 0, 0},      {"TFLIP", MPM_TFLIP, 1.0, 0, 0},
                                   {"AFLIP", MPM_AFLIP, 1.0, 0, 0},    {"XPIC(2)", MPM_XPIC, 1.0, 2, 0},
                                   {"FMPM(8)", MPM_FMPM, 1.0, 8, 0}};
  static const double stretch[3] = {0.8, 1.05, 1.5};
  const int32_t transfers = verify_quick() ? 2 : (int32_t)(sizeof methods / sizeof *methods);
  for (int32_t s = 0; s < 3; ++s)
    for (int32_t k = 0; k < VERIFY_SCHEMES; ++k) {
      if (verify_quick() && k != VERIFY_USL && k != VERIFY_PROJECTED) continue;
      double most = 0.0;
      for (int32_t m = 0; m < transfers; ++m) {
        double first;
        const double last =
            shake(&methods[m], &verify_schemes[k], &(block){stretch[s], 1.0, 0.3, 0}, steps(), &first);
        most = fmax(most, last / first);
        fprintf(table, "%g,%s,%s,%.2e,%.2e\n", stretch[s], methods[m].name, verify_schemes[k].name, first,
                last);
      }
      char what[100];
      snprintf(what, sizeof what, "stretch %g, %s: largest kinetic energy, last / first", stretch[s],
               verify_schemes[k].name);
      const int32_t grows = (k == VERIFY_USF || k == VERIFY_MUSL) && stretch[s] > 1.0;
      verify_judge(what, most, 0.0, 1.0, "equilibrium",
                   grows ? "these schemes make a mode that grows in tension" : NULL);
      verify_progress("stretch %g, %s", stretch[s], verify_schemes[k].name);
    }
  /* on a total Lagrangian grid no scheme makes anything grow */
  static const method total[] = {{"FLIP", MPM_FLIP, 1.0, 0, 1}, {"APIC", MPM_APIC, 1.0, 0, 1}};
  for (int32_t s = verify_quick() ? 2 : 0; s < 3; ++s)
    for (int32_t k = 0; k < VERIFY_SCHEMES; ++k) {
      double most = 0.0, first;
      const int32_t many = !verify_quick() && (k == VERIFY_USF || k == VERIFY_MUSL);
      for (int32_t m = 0; m < 2; ++m) {
        const double at_end = shake(&total[m], &verify_schemes[k], &(block){stretch[s], 1.0, 0.3, 0},
                                    many ? MANY_STEPS : steps(), &first);
        most = fmax(most, at_end / first);
        fprintf(table, "%g,\"%s, total\",%s,%.2e,%.2e\n", stretch[s], total[m].name, verify_schemes[k].name,
                first, at_end);
      }
      char what[120];
      snprintf(what, sizeof what, "stretch %g, %s, total Lagrangian%s: largest kinetic energy, last / first",
               stretch[s], verify_schemes[k].name, many ? ", 100 000 steps" : "");
      verify_gate(what, most, 0.0, 1.0, "equilibrium");
      verify_progress("%s: %g", what, most);
    }
  incompressible();
  if (!verify_quick()) onsets();
  for (int32_t s = 0; s < (verify_quick() ? 0 : 6); ++s) {
    const int32_t projected = s >= 3; /* MUSL with FLIP, which damps nothing */
    char what[100];
    double first;
    const double last =
        shake(&methods[projected ? 0 : 1], &verify_schemes[projected ? VERIFY_PROJECTED : VERIFY_USL],
              &(block){stretch[s % 3], 1.0, 0.3, 0}, MANY_STEPS, &first);
    snprintf(what, sizeof what, "stretch %g, %s, 100 000 steps: kinetic energy, last / first", stretch[s % 3],
             projected ? "MUSL projected, FLIP" : "USL, APIC");
    verify_gate(what, last / first, 0.0, 1.0, "equilibrium");
    verify_progress("%s", what);
  }
  static const char *const creep = "the corners creep outward";
  static const char *const noise = "the increments of FLIP are no affine field: the spin becomes noise";
  static const spinner spinners[] = {
      {"USL, APIC", MPM_BSPLINE2, VERIFY_USL, MPM_APIC, 2.0, MANY_STEPS, 0, NULL},
      {"USL, APIC_MLS", MPM_BSPLINE2, VERIFY_USL, MPM_APIC_MLS, 2.0 * PI, MANY_STEPS, 0, NULL},
      {"USL, APIC, cubic", MPM_BSPLINE3, VERIFY_USL, MPM_APIC, 2.0 * PI, MANY_STEPS, 0, NULL},
      {"USL, APIC", MPM_BSPLINE2, VERIFY_USL, MPM_APIC, 2.0 * PI, MANY_STEPS / 2, SHAPE, creep},
      {"USL, APIC", MPM_BSPLINE2, VERIFY_USL, MPM_APIC, 2.0 * PI, MANY_STEPS, LOST | SHAPE, creep},
      {"USL, FLIP", MPM_BSPLINE2, VERIFY_USL, MPM_FLIP, 2.0 * PI, MANY_STEPS / 10, SPIN,
       "the increments of FLIP are no affine field, and USL damps what becomes of the spin"},
      {"MUSL, FLIP", MPM_BSPLINE2, VERIFY_MUSL, MPM_FLIP, 2.0 * PI, MANY_STEPS / 10, ENERGY | SPIN | SHAPE,
       noise},
      {"MUSL, FLIP", MPM_BSPLINE2, VERIFY_MUSL, MPM_FLIP, 2.0 * PI, MANY_STEPS, LOST | ENERGY | SPIN | SHAPE,
       noise},
      {"MUSL projected, FLIP", MPM_BSPLINE2, VERIFY_PROJECTED, MPM_FLIP, 2.0 * PI, MANY_STEPS,
       ENERGY | SPIN | SHAPE, noise}};
  for (size_t k = 0; k < sizeof spinners / sizeof *spinners && !verify_quick(); ++k) spin(&spinners[k]);
  fclose(table);
  return verify_end();
}
