/* The front of a dam break on a coarse grid, as it is and with particles split where a cell has fewer of them
 * than the column had and merged where it has many more: Martin and Moyce 1952, Ritter 1892. */
#include "tank.h"

enum { FEWEST = 4, MOST = 10 }; /* particles of a cell; the column has 4 */
enum { RITTER_POINTS = 12, POINTS = TANK_POINTS };

typedef struct flow {
  const char *name;
  double width, depth, length; /* of the column, and of the tank */
  double unit;                 /* of times */
  int32_t cells, points;       /* per depth; how often it is looked at */
} flow;

typedef struct outcome {
  double front[POINTS];              /* where the domain ends that reaches farthest */
  double mass, momentum;             /* largest errors of their books, over mass and weight times time */
  int64_t empty, most, first, count; /* empty cells, summed; particles of the fullest cell, and in all */
  mpm_adaption_info info;
} outcome;

static double time_of(const flow *f, int32_t k) {
  return f->unit * (f->points == TANK_POINTS ? tank_measured[k][0] : 0.5 * (k + 1));
}

/* Where the front is due: as measured, and at the speed of Ritter's. */
static double front_due(const flow *f, int32_t k) {
  return f->points == TANK_POINTS ? TANK_A * tank_measured[k][1]
                                  : f->width + 2.0 * sqrt(TANK_G * f->depth) * time_of(f, k);
}

/* Sees how far the water is, to the end of its particles' domains, how many cells of the bed between the wall
 * and the front have no particle, and how many are in the fullest cell. */
static void look(const tank *it, double h, int32_t divided, int32_t k, outcome *out) {
  const int64_t n = mpm_particles_count(it->water);
  double *x = verify_get(&it->w, it->water, "position", 2), far = 0.0, high = 0.0;
  double *size = divided ? verify_get(&it->w, it->water, "size", 2) : NULL;
  for (int64_t i = 0; i < n; ++i) {
    far = fmax(far, x[i]), high = fmax(high, x[n + i]);
    out->front[k] = fmax(out->front[k], x[i] + 0.5 * (size ? size[i] : 0.5 * h));
  }
  const int64_t columns = (int64_t)floor(far / h) + 1, rows = (int64_t)floor(high / h) + 1;
  double *seen = verify_array(columns * rows), most = 0.0;
  for (int64_t i = 0; i < n; ++i)
    most = fmax(most, seen[(int64_t)floor(x[n + i] / h) * columns + (int64_t)floor(x[i] / h)] += 1.0);
  for (int64_t c = 0; c < columns; ++c) out->empty += seen[c] == 0.0;
  out->most = most > (double)out->most ? (int64_t)most : out->most;
  free(x), free(size), free(seen);
}

static double mass_of(const tank *it) {
  const int64_t n = mpm_particles_count(it->water);
  double *mass = verify_get(&it->w, it->water, "mass", 1), sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += mass[i];
  free(mass);
  return sum;
}

/* Weight and walls account for the momentum, and nothing for mass. */
static void check_books(const tank *it, double mass, outcome *out) {
  const mpm_step_info now = verify_info(&it->w);
  double due[2] = {0.0, -mass * TANK_G * now.t};
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; ++face) {
    double impulse[2];
    verify_ok(&it->w, mpm_stepper_wall_impulse(it->w.stepper, face, impulse));
    for (int32_t c = 0; c < 2; ++c) due[c] += impulse[c];
  }
  out->mass = fmax(out->mass, fabs(mass_of(it) / mass - 1.0));
  for (int32_t c = 0; c < 2; ++c)
    out->momentum = fmax(out->momentum, fabs(now.momentum[c] - due[c]) / (mass * TANK_G * now.t));
}

/* NULL: nothing is split, and nothing merged. */
static outcome run(const flow *f, const char *how, const mpm_adaption_desc *adapt, FILE *csv, FILE *cloud) {
  const double h = f->depth / f->cells;
  tank it;
  tank_open(&it, f->width, f->depth, f->length, f->cells);
  outcome out = {.first = mpm_particles_count(it.water), .info.struct_size = sizeof out.info};
  if (adapt) verify_ok(&it.w, mpm_stepper_set_adaption(it.w.stepper, it.water, adapt));
  const double mass = mass_of(&it);
  for (int32_t k = 0; k < f->points; ++k) {
    verify_advance(&it.w, 0.4, time_of(f, k));
    look(&it, h, adapt != NULL, k, &out);
    check_books(&it, mass, &out);
    fprintf(csv, "%s,%s,%.2f,%.5f,%.5f\n", f->name, how, time_of(f, k) / f->unit, out.front[k],
            front_due(f, k));
  }
  out.count = mpm_particles_count(it.water);
  if (adapt) verify_ok(&it.w, mpm_stepper_adaption_info(it.w.stepper, it.water, &out.info));
  double *x = verify_get(&it.w, it.water, "position", 2), *m = verify_get(&it.w, it.water, "mass", 1);
  for (int64_t i = 0; i < out.count; ++i)
    fprintf(cloud, "%s,%s,%.5f,%.5f,%.4f\n", f->name, how, x[i] / f->depth, x[out.count + i] / f->depth,
            m[i] * (double)out.first / mass);
  free(x), free(m);
  verify_progress(
      "%s, %s: %lld of %lld particles, %lld splits, %lld merges, %lld empty cells, most %lld, %s %.4f",
      f->name, how, (long long)out.count, (long long)out.first, (long long)out.info.splits,
      (long long)out.info.merges, (long long)out.empty, (long long)out.most, "front",
      out.front[f->points - 1]);
  verify_close(&it.w);
  return out;
}

/* How far the front is at most from where it is due, of the latter. */
static double measured_error(const flow *f, const outcome *out) {
  double most = 0.0;
  for (int32_t k = 0; k < f->points; ++k) most = fmax(most, fabs(out->front[k] / front_due(f, k) - 1.0));
  return most;
}

typedef struct outcomes {
  outcome whole, both, alone, by_edge; /* not split; split and merged; split alone; split by edges */
} outcomes;

static outcomes run_all(const flow *f, FILE *csv, FILE *cloud) {
  outcomes out = {.whole = run(f, "not split", NULL, csv, cloud)};
  mpm_adaption_desc adapt;
  verify_ok(&(verify_world){0}, mpm_adaption_desc_init(&adapt, sizeof adapt));
  adapt.min_per_cell = FEWEST;
  adapt.max_per_cell = MOST;
  out.both = run(f, "split and merged", &adapt, csv, cloud);
  adapt.max_per_cell = 0;
  out.alone = run(f, "split alone", &adapt, csv, cloud);
  adapt.min_per_cell = 0;
  adapt.split_edge = 0.52;
  out.by_edge = run(f, "split by edges", &adapt, csv, cloud);
  return out;
}

static void judge(const flow *f, const outcomes *o) {
  const char *books = "conservation", *tolerance = "set tolerance";
  verify_gate_of(f->name, "not split: empty cells", (double)o->whole.empty, 1.0, HUGE_VAL,
                 "why splitting is there");
  verify_gate_of(f->name, "empty cells, of those without splitting",
                 (double)o->both.empty / fmax((double)o->whole.empty, 1.0), 0.0, 0.5, tolerance);
  verify_gate_of(f->name, "change of mass", o->both.mass, 0.0, 1e-12, books);
  verify_gate_of(f->name, "momentum, less weight and walls, over weight times time", o->both.momentum, 0.0,
                 1e-11, books);
  verify_gate_of(f->name, "particles of the fullest cell", (double)o->both.most, 1.0, 1.5 * MOST,
                 "max_per_cell, and half of it for the steps between");
  verify_gate_of(f->name, "particles of the fullest cell, split alone", (double)o->alone.most,
                 (double)o->both.most + 1.0, HUGE_VAL, "why merging is there");
  verify_gate_of(f->name, "particles / first", (double)o->both.count / (double)o->both.first, 1.0, 3.0,
                 tolerance);
  verify_gate_of(f->name, "split_edge = 0.52 instead: particles that are split",
                 (double)o->by_edge.info.splits, 0.0, 0.0, "F of a fluid has the volume, and no shape");
}

/* A reservoir whose gate is taken away. */
static void flood(FILE *csv, FILE *cloud) {
  const double gate = 7.0;
  const flow reservoir = {"Ritter; h0 / 10", gate, 1.0, 20.0, sqrt(1.0 / TANK_G), 10, RITTER_POINTS};
  const outcomes run_out = run_all(&reservoir, csv, cloud);
  judge(&reservoir, &run_out);
  const double is = run_out.both.front[RITTER_POINTS - 1] - gate,
               whole = run_out.whole.front[RITTER_POINTS - 1] - gate,
               due = front_due(&reservoir, RITTER_POINTS - 1) - gate;
  verify_gate_of(reservoir.name, "front / (2 c0 t)", is / due, 0.85, 1.0,
                 "Ritter 1892; the gate of water_column");
  verify_gate_of(reservoir.name, "front, over that without splitting", is / whole, 0.98, 1.02,
                 "no worse; set tolerance");
}

int main(int argc, char **argv) {
  verify_begin("adaption_front", argc, argv);
  FILE *csv = verify_csv("adaption_front"), *cloud = verify_csv("adaption_front_cloud");
  fprintf(csv, "case,method,T,front,due\n");
  fprintf(cloud, "case,method,x,y,mass\n");
  const flow column = {"Martin and Moyce; 2 a / 20",  TANK_A, 2.0 * TANK_A, 6.0 * TANK_A,
                       sqrt(TANK_A / (2.0 * TANK_G)), 20,     TANK_POINTS};
  const outcomes fall = run_all(&column, csv, cloud);
  judge(&column, &fall);
  const double was = measured_error(&column, &fall.whole);
  verify_gate_of(column.name, "not split: front off the experiment, most", was, 0.0, 0.2,
                 "Martin and Moyce 1952, table 2; the gate of water_column");
  verify_gate_of(column.name, "front off the experiment, most, less that without splitting",
                 measured_error(&column, &fall.both) - was, -1.0, 0.02, "no worse; set tolerance");
  if (!verify_quick()) flood(csv, cloud);
  fclose(csv);
  fclose(cloud);
  return verify_end();
}
