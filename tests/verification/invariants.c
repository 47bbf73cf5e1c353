/* What must not depend on the frame, on threads or on an interruption: two disks that collide, turned by 90
 * degrees, moved by h / 3, run on two threads, saved and continued. */
#include "verify.h"

enum { PLAIN, TURNED, MOVED, SAVED };

typedef struct outcome {
  double rebound, least; /* speed of the first disk at the end; least kinetic energy */
  uint64_t hash;
} outcome;

static void one_disk(const verify_world *w, mpm_particles *set, double sign, int turned, double shift,
                     double h) {
  /* The lattice of particles goes with the disk. */
  const int across = (int)(0.4 / (0.5 * h) + 0.5);
  double x[2][4096], v[2][4096], volume[4096], flat[2 * 4096], flat_v[2 * 4096];
  int64_t n = 0;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      const double dx = (i + 0.5) * 0.5 * h - 0.2, dy = (j + 0.5) * 0.5 * h - 0.2;
      if (hypot(dx, dy) >= 0.2) continue;
      const double px = 0.5 - 0.3 * sign + dx, py = 0.5 - 0.3 * sign + dy;
      x[0][n] = (turned ? 1.0 - py : px) + shift;
      x[1][n] = (turned ? px : py) + shift;
      v[0][n] = turned ? -0.1 * sign : 0.1 * sign;
      v[1][n] = 0.1 * sign;
      volume[n++] = 0.25 * h * h;
    }
  for (int c = 0; c < 2; ++c)
    for (int64_t i = 0; i < n; ++i) flat[c * n + i] = x[c][i], flat_v[c * n + i] = v[c][i];
  verify_ok(w, mpm_particles_add(set, n, flat, flat_v, volume, NULL, NULL, NULL));
}

static outcome collide(int variant, int threads, int transfer) {
  const double h = 1.0 / 40.0;
  verify_setup setup = verify_defaults(2, 46, h);
  setup.grid.origin[0] = setup.grid.origin[1] = -3.0 * h;
  setup.stepper.scheme = MPM_MUSL;
  setup.stepper.transfer = transfer;
  verify_world w = {.dim = 2};
  mpm_context_desc desc;
  verify_ok(&w, mpm_context_desc_init(&desc, sizeof desc));
  desc.concurrency = threads;
  verify_ok(&w, mpm_context_create(&desc, &w.context));
  verify_ok(&w, mpm_grid_create(w.context, &setup.grid, &w.grid));
  verify_ok(&w, mpm_stepper_create(w.context, w.grid, &setup.stepper, &w.stepper));
  verify_watch(&w);
  mpm_particles *disks = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, 1000.0));
  const double shift = variant == MOVED ? h / 3.0 : 0.0;
  one_disk(&w, disks, 1.0, variant == TURNED, shift, h);
  const int64_t half = mpm_particles_count(disks);
  one_disk(&w, disks, -1.0, variant == TURNED, shift, h);
  outcome out = {0.0, HUGE_VAL, 0};
  for (int k = 1; k <= 180; ++k) {
    const mpm_step_info now = verify_advance(&w, 0.4, 0.02 * k);
    out.least = fmin(out.least, now.kinetic_energy);
    if (variant == SAVED && k == 90) {
      int64_t bytes;
      verify_ok(&w, mpm_state_size(w.stepper, &bytes));
      void *state = malloc((size_t)bytes);
      if (!state) exit(2);
      verify_ok(&w, mpm_state_save(w.stepper, state, bytes));
      verify_advance(&w, 0.4, 2.5); /* to be forgotten */
      verify_ok(&w, mpm_state_load(w.stepper, state, bytes));
      free(state);
    }
  }
  const int64_t n = mpm_particles_count(disks);
  double *v = verify_get(&w, disks, "velocity", 2), mean[2] = {0.0, 0.0};
  for (int c = 0; c < 2; ++c)
    for (int64_t i = 0; i < half; ++i) mean[c] += v[c * n + i] / (double)half;
  out.rebound = hypot(mean[0], mean[1]);
  free(v);
  verify_ok(&w, mpm_state_hash(w.stepper, &out.hash));
  verify_close(&w);
  return out;
}

int main(int argc, char **argv) {
  verify_begin("invariants", argc, argv);
  FILE *csv = verify_csv("invariants");
  fprintf(csv, "transfer,variant,rebound,kinetic_least\n");
  static const struct {
    int transfer;
    const char *name;
  } transfers[] = {{MPM_FLIP, "FLIP"}, {MPM_APIC, "APIC"}};
  for (int k = 0; k < 2; ++k) {
    const outcome plain = collide(PLAIN, 1, transfers[k].transfer),
                  turned = collide(TURNED, 1, transfers[k].transfer),
                  moved = collide(MOVED, 1, transfers[k].transfer),
                  saved = collide(SAVED, 1, transfers[k].transfer),
                  threads = collide(PLAIN, 2, transfers[k].transfer);
    const outcome *const all[3] = {&plain, &turned, &moved};
    const char *const variant[3] = {"plain", "turned", "moved"};
    for (int i = 0; i < 3; ++i)
      fprintf(csv, "%s,%s,%.8f,%.8f\n", transfers[k].name, variant[i], all[i]->rebound, all[i]->least);
    char what[5][80];
    snprintf(what[0], 80, "%s: turned by 90 degrees: change of the rebound", transfers[k].name);
    snprintf(what[1], 80, "%s: moved by h / 3: change of the rebound", transfers[k].name);
    snprintf(what[2], 80, "%s: moved by h / 3: change of the least kinetic energy", transfers[k].name);
    snprintf(what[3], 80, "%s: saved and continued: bits differ", transfers[k].name);
    snprintf(what[4], 80, "%s: two threads: bits differ", transfers[k].name);
    verify_gate(what[0], turned.rebound / plain.rebound - 1.0, -1e-6, 1e-6,
                "the axes are alike, up to round-off");
    verify_gate(what[1], moved.rebound / plain.rebound - 1.0, -0.03, 0.03, "set tolerance");
    verify_gate(what[2], moved.least / plain.least - 1.0, -0.2, 0.2,
                "set tolerance; the gap in cells is not the same");
    verify_gate(what[3], saved.hash != plain.hash, 0.0, 0.0, "restart bit for bit; set tolerance");
    verify_gate(what[4], threads.hash != plain.hash, 0.0, 0.0,
                "same bits on any number of threads; set tolerance");
  }
  fclose(csv);
  return verify_end();
}
