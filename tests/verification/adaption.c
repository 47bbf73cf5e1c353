/* Splitting and merging: a bar drawn to four times its length holds together, a disc that spins and is
 * split and merged all the time keeps its momenta, and a bar that vibrates keeps its energy when all of it
 * is split. */
#include "drawn.h"

static const double E = DRAWN_E, nu = DRAWN_NU;

/* ---- a bar is drawn ----------------------------------------------------------------------------------- */
/* Cells without particles in the row at the symmetry plane, between the first and the last with some. */
static int64_t holes(const verify_world *w, mpm_particles *set, double h) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2), far = 0.0;
  for (int64_t i = 0; i < n; ++i) far = fmax(far, x[i]);
  const int64_t cells = (int64_t)floor(far / h);
  double *seen = verify_array(cells + 1);
  for (int64_t i = 0; i < n; ++i)
    if (x[n + i] < h) seen[(int64_t)floor(x[i] / h)] = 1.0;
  int64_t empty = 0;
  for (int64_t c = 0; c < cells; ++c) empty += seen[c] == 0.0;
  free(x), free(seen);
  return empty;
}

typedef struct drawn {
  double stretch, force, across; /* force and F22 over the exact ones - 1 */
  int64_t empty, count;
} drawn;

static drawn draw(const char *name, int32_t transfer, double split_edge, double h, FILE *table) {
  verify_setup setup = verify_defaults(2, (int64_t)lround(4.5 * DRAWN_LENGTH / h) + 2, h);
  setup.grid.cells[1] = (int64_t)lround(1.0 / h);
  setup.stepper.transfer = transfer;
  const double rate = 0.02 * verify_speed_of_sound(E, nu, 1.0) / DRAWN_LENGTH,
               t_end = (DRAWN_LAST - 1.0) / rate;
  drawn_pull by = {rate, h, 0};
  verify_world w;
  mpm_particles *set = drawn_open(&w, &setup, &by, 0);
  const int64_t n = mpm_particles_count(set);
  mpm_adaption_desc adapt;
  verify_ok(&w, mpm_adaption_desc_init(&adapt, sizeof adapt));
  adapt.split_edge = split_edge;
  if (split_edge > 0.0) verify_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  mpm_step_info now = verify_info(&w);
  mpm_status status = MPM_OK;
  while (now.t < t_end * (1.0 - 1e-12) && !status) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    status = mpm_step(w.stepper, fmin(0.4 * dt, t_end - now.t), &now);
  }
  const double stretch = 1.0 + rate * now.t;
  double exact;
  const double across = drawn_thinning(stretch, &exact),
               force = status ? HUGE_VAL : drawn_force(&w) / exact - 1.0;
  drawn out = {stretch, force, 0.0, holes(&w, set, h), mpm_particles_count(set)};
  double *F = verify_get(&w, set, "deformation_gradient", 9), *at = verify_get(&w, set, "position", 2);
  for (int64_t i = 0; i < out.count; ++i) {
    out.across = fmax(out.across, fabs(F[4 * out.count + i] / across - 1.0));
    fprintf(table, "%s,%.6f,%.6f,%.6f\n", name, at[i], at[out.count + i], F[i]);
  }
  verify_progress("%s: stretch %.3f, %lld of %lld particles, force %.3e, F22 %.3e, %lld cells empty", name,
                  stretch, (long long)out.count, (long long)n, force, out.across, (long long)out.empty);
  free(F), free(at);
  verify_close(&w);
  return out;
}

/* ---- a disc spins ------------------------------------------------------------------------------------- */
static void spin(const char *name, int32_t scheme, int32_t transfer) {
  const double h = 0.1, radius = 0.8;
  verify_setup setup = verify_defaults(2, 30, h);
  setup.stepper.scheme = scheme;
  setup.stepper.transfer = transfer;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, nu, 1.0));
  verify_ok(&w, mpm_particles_fill_ball(set, (const double[]){1.5, 1.5}, radius, (const int32_t[]){2, 2},
                                        NULL, NULL));
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 2), *v = verify_array(2 * n), *C = verify_array(9 * n);
  const double omega = 4.0;
  for (int64_t i = 0; i < n; ++i) {
    v[i] = -omega * (x[n + i] - 1.5) + 0.3, v[n + i] = omega * (x[i] - 1.5) - 0.2;
    C[n + i] = -omega, C[3 * n + i] = omega;
  }
  verify_put(&w, set, "velocity", 2, v);
  if (transfer == MPM_APIC || transfer == MPM_APIC_MLS) verify_put(&w, set, "velocity_gradient", 9, C);
  free(x), free(v), free(C);
  mpm_adaption_desc adapt;
  verify_ok(&w, mpm_adaption_desc_init(&adapt, sizeof adapt));
  adapt.max_per_cell = 3;
  adapt.min_per_cell = 1;
  adapt.split_edge = 0.52;
  adapt.merge_distance = 0.6;
  adapt.merge_tolerance = 0.2;
  verify_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  const mpm_step_info first = verify_info(&w);
  double dt, momentum = 0.0, angular = 0.0;
  verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
  for (int32_t k = 0; k < 1000; ++k) {
    verify_step(&w, 0.3 * dt);
    const mpm_step_info now = verify_info(&w);
    for (int32_t c = 0; c < 2; ++c)
      momentum = fmax(momentum, fabs(now.momentum[c] / first.momentum[c] - 1.0));
    angular = fmax(angular, fabs(now.angular_momentum[2] / first.angular_momentum[2] - 1.0));
  }
  mpm_adaption_info info = {.struct_size = sizeof info};
  verify_ok(&w, mpm_stepper_adaption_info(w.stepper, set, &info));
  const int32_t matrix = transfer != MPM_FLIP;
  verify_gate_of(name, "splits", (double)info.splits, 1000.0, HUGE_VAL, "it is split all the time");
  verify_gate_of(name, "merges", (double)info.merges, 1000.0, HUGE_VAL, "and merged");
  verify_gate_of(name, "change of momentum", momentum, 0.0, 1e-12, "conservation");
  if (matrix) {
    verify_gate_of(name, "change of angular momentum", angular, 0.0, 1e-12, "conservation");
    verify_gate_of(name, "angular momentum that is told as lost",
                   fabs(info.angular_momentum_loss[2] / first.angular_momentum[2]), 0.0, 1e-13,
                   "conservation");
  } else {
    verify_gate_of(name, "angular momentum that is told as lost, of the first",
                   info.angular_momentum_loss[2] / first.angular_momentum[2], 0.001, 0.2,
                   "without a matrix merging loses it");
  }
  verify_gate_of(name, "kinetic energy that is told as lost, of the first",
                 info.kinetic_loss / first.kinetic_energy, 0.0, matrix ? 0.002 : 0.2,
                 "merging loses m1 m2 / (2 M) |v1 - v2|^2; set tolerance");
  verify_close(&w);
}

/* ---- a bar vibrates ----------------------------------------------------------------------------------- */
/* Returns the energy after ten periods, over the first. */
static double vibrate(int32_t split) {
  const int32_t cells = 32;
  const double h = 1.0 / cells;
  verify_setup setup = verify_defaults(1, cells, h);
  setup.stepper.scheme = MPM_MUSL;
  setup.stepper.pic_damping = 0.0;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", E, 0.0, 1.0));
  verify_fill_box(&w, set, (const double[]){0.0}, (const double[]){1.0}, 2);
  for (int32_t face = 0; face < 2; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_FIXED, 0.0));
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(&w, set, "position", 1), *v = verify_array(n);
  for (int64_t i = 0; i < n; ++i) v[i] = 0.5 * sin(PI * x[i]);
  verify_put(&w, set, "velocity", 1, v);
  free(x), free(v);
  mpm_adaption_desc adapt;
  verify_ok(&w, mpm_adaption_desc_init(&adapt, sizeof adapt));
  adapt.every = 0;
  adapt.split_edge = 0.4;
  verify_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  const double period = 2.0 / sqrt(E), first = verify_info(&w).kinetic_energy;
  for (int32_t k = 1; k <= 400; ++k) {
    if (k == 130 && split) verify_ok(&w, mpm_stepper_adapt(w.stepper));
    verify_advance(&w, 0.4, 10.0 * period * k / 400.0);
  }
  const mpm_step_info now = verify_info(&w);
  const double energy = (now.kinetic_energy + now.strain_energy) / first;
  verify_progress("%s: %lld particles, energy %.5f", split ? "split" : "whole",
                  (long long)mpm_particles_count(set), energy);
  verify_close(&w);
  return energy;
}

int main(int argc, char **argv) {
  verify_begin("adaption", argc, argv);
  const char *exact = "uniaxial tension of the law", *there = "it gets there", *whole = "it holds together";
  FILE *table = verify_csv("adaption_bar");
  fprintf(table, "method,x,y,F11\n");
  const drawn alone = draw("APIC_MLS; not split", MPM_APIC_MLS, 0.0, 0.125, table);
  verify_gate("APIC_MLS; not split: empty cells", (double)alone.empty, 1.0, HUGE_VAL,
              "why splitting is there");
  for (int32_t fine = 0; fine < (verify_quick() ? 1 : 2); ++fine) {
    const char *name = fine ? "APIC_MLS; h = 1/16" : "APIC_MLS; h = 1/8";
    const drawn o = draw(name, MPM_APIC_MLS, 0.52, fine ? 0.0625 : 0.125, table);
    verify_gate_of(name, "stretch", o.stretch, DRAWN_LAST * (1.0 - 1e-9), DRAWN_LAST * (1.0 + 1e-9), there);
    verify_gate_of(name, "empty cells", (double)o.empty, 0.0, 0.0, whole);
    verify_gate_of(name, "force / exact - 1", fabs(o.force), 0.0, 0.002, exact);
    verify_gate_of(name, "F22 / exact - 1, largest", o.across, 0.0, 0.01, exact);
    verify_gate_of(name, "particles / first", (double)o.count / (fine ? 1024.0 : 256.0), 4.0, 4.2,
                   "edges are halved twice");
  }
  static const struct {
    const char *name;
    int32_t transfer;
  } others[] = {{"APIC; h = 1/8", MPM_APIC}, {"FLIP; h = 1/8", MPM_FLIP}};
  for (int32_t k = 0; k < 2; ++k) {
    const drawn o = draw(others[k].name, others[k].transfer, 0.52, 0.125, table);
    verify_gate_of(others[k].name, "empty cells", (double)o.empty, 0.0, 0.0, whole);
    verify_gate_of(others[k].name, "force / exact - 1", fabs(o.force), 0.0, 0.05, exact);
  }
  fclose(table);
  spin("spinning disc, APIC, USL", MPM_USL, MPM_APIC);
  spin("spinning disc, APIC_MLS, USL", MPM_USL, MPM_APIC_MLS);
  spin("spinning disc, APIC, MUSL", MPM_MUSL, MPM_APIC);
  spin("spinning disc, FLIP, USL", MPM_USL, MPM_FLIP);
  const double undivided = vibrate(0);
  verify_gate("vibrating bar: energy after ten periods, split in the fourth, over that without",
              vibrate(1) / undivided, 0.995, 1.005, "splitting keeps the energy");
  return verify_end();
}
