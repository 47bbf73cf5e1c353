/* Particle-steps per second of whole explicit steps through the public interface: mpm_stable_dt and mpm_step
 * every step, re-sorts included, with momentum, energy and the hash of the state looked at in the end.
 *
 *   bench [--quick] [--implicit] [--only TEXT] [--particles N,N] [--threads N,N] [--repeats N] [--spread X]
 *         [--markers N] [--csv FILE] [--case NAME] [--list] [--bare]
 *
 * --implicit: implicit steps in their place, implicit.c.
 * --only: cases whose name contains the text; --case: the one of this name. --list: their names, those with a
 * solver of the host left out. --bare: for against.py, see choice.h. --spread: bounds of the grid over the
 * size of the body. --markers: a surface of so many through its middle prescribes. A line gives the median
 * and the best of the repeats, nanoseconds per particle and step by stage (weights are part of P2G and
 * G2P), those of a thread for each node of the stencil, the rate as a share of what one core, times the
 * threads, can do in multiply-adds and in memory traffic, and the peak of the whole process. */
#include "process.h"
#include "ceilings.h"
#include "choice.h"
#include "implicit.h"
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The linear basis needs small steps at a free surface, where nodes are light; its body moves faster, so that
 * it has to be sorted again within the time. */
static const bench_case cases[] = {
    {"3-D quadratic FLIP", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D quadratic APIC_MLS", 3, MPM_BSPLINE2, MPM_USL, MPM_APIC_MLS, "neo_hookean", 0.3, 0.125, 40,
     BENCH_FREE},
    {"3-D linear FLIP", 3, MPM_LINEAR, MPM_USL, MPM_FLIP, "neo_hookean", 0.02, 2.0, 100, BENCH_FREE},
    {"2-D quadratic FLIP", 2, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D FLIP, six walls", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_WALLS},
    {"3-D FLIP, force callback", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_FORCE},
    {"3-D FLIP, law of the host", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "host", 0.3, 0.125, 40, BENCH_HOST_LAW},
    {"3-D FLIP, MUSL", 3, MPM_BSPLINE2, MPM_MUSL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D quadratic APIC", 3, MPM_BSPLINE2, MPM_USL, MPM_APIC, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D FLIP, J2", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "j2", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D FLIP, Drucker-Prager", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "drucker_prager", 0.3, 0.125, 40,
     BENCH_FREE},
    {"3-D FLIP, Mohr-Coulomb", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "mohr_coulomb", 0.3, 0.125, 40,
     BENCH_FREE},
    {"3-D FLIP, Herschel-Bulkley", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "herschel_bulkley", 0.3, 0.125, 40,
     BENCH_FREE},
    {"3-D FLIP, snow", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "snow", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D FLIP, mu(I)", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "mu_i", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D FLIP, Cam-clay", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "cam_clay", 0.3, 0.125, 40, BENCH_FREE},
    {"1-D quadratic FLIP", 1, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D cubic FLIP", 3, MPM_BSPLINE3, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D cubic APIC_MLS", 3, MPM_BSPLINE3, MPM_USL, MPM_APIC_MLS, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D open quadratic FLIP", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_OPEN_KNOTS},
    {"3-D open cubic FLIP", 3, MPM_BSPLINE3, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_OPEN_KNOTS},
    {"3-D uGIMP FLIP", 3, MPM_UGIMP, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D GIMP FLIP", 3, MPM_GIMP, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D cpGIMP FLIP", 3, MPM_CPGIMP, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D FLIP, USF", 3, MPM_BSPLINE2, MPM_USF, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D FLIP, second order", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_SECOND_ORDER},
    {"3-D FLIP, locking remedy", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_REMEDY},
    {"3-D FLIP, ten far obstacles", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_OBSTACLES},
    {"3-D FLIP, corner in contact", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_CORNER},
    {"3-D FLIP, halves in contact", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_HALVES},
    {"3-D FLIP, total Lagrangian", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_TOTAL},
    {"3-D FLIP, total Lagrangian, lattice", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_TOTAL_LATTICE},
    {"3-D FLIP, heat", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_HEAT},
    {"3-D FLIP, heat, implicit", 3, MPM_BSPLINE2, MPM_USL, MPM_FLIP, "neo_hookean", 0.3, 0.125, 40,
     BENCH_HEAT_IMPLICIT},
    {"3-D quadratic TFLIP", 3, MPM_BSPLINE2, MPM_USL, MPM_TFLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D quadratic AFLIP", 3, MPM_BSPLINE2, MPM_USL, MPM_AFLIP, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D quadratic XPIC(2)", 3, MPM_BSPLINE2, MPM_USL, MPM_XPIC, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
    {"3-D quadratic FMPM(2)", 3, MPM_BSPLINE2, MPM_USL, MPM_FMPM, "neo_hookean", 0.3, 0.125, 40, BENCH_FREE},
};
enum { CASES = sizeof cases / sizeof *cases, MOST_NUMBERS = 16, MOST_REPEATS = 99, WARM_UP = 45 };

typedef struct settings {
  bench_choice choice;
  const char *csv;
  int32_t repeats, implicit;
  struct numbers {
    int32_t count;
    int64_t at[MOST_NUMBERS];
  } particles, threads;
  double spread;
  int64_t markers;
} settings;

typedef struct result {
  int32_t failed;
  char error[200];
  int64_t particles, resorts, allocations;
  double median, best, bytes; /* particle-steps per second; peak of the process per particle */
  double weights, p2g, grid, g2p, law, sort, callbacks;
  double momentum, energy; /* relative changes over the whole run */
  uint64_t hash;
} result;

static mpm_status one_step(const bench_scene *scene, const bench_case *of, mpm_step_info *info) {
  double dt;
  const mpm_status status = mpm_stable_dt(scene->stepper, &dt);
  return status ? status : mpm_step(scene->stepper, of->cfl * dt, info);
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double size_of(const double *v) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static mpm_status measure(const bench_scene *scene, const bench_case *of, const settings *how, result *r) {
  mpm_step_info first = {.struct_size = sizeof first}, info = {.struct_size = sizeof info};
  mpm_profile stage = {.struct_size = sizeof stage};
  double rate[MOST_REPEATS], (*seconds)(void) = how->choice.bare ? bench_processor_seconds : bench_seconds;
  mpm_status status = mpm_stepper_info(scene->stepper, &first);
  for (int32_t i = 0; i < WARM_UP && !status; ++i) status = one_step(scene, of, &info);
  if (status) return status;
  mpm_stepper_profile(scene->stepper, 1, &stage);
  const int64_t sorted = info.resorts, allocated = scene->allocations;
  const double n = (double)scene->particles, steps = (double)of->steps;
  for (int32_t k = 0; k < how->repeats; ++k) {
    const double from = seconds();
    for (int32_t i = 0; i < of->steps && !status; ++i) status = one_step(scene, of, &info);
    if (status) return status;
    rate[k] = n * steps / (seconds() - from);
  }
  mpm_stepper_profile(scene->stepper, 0, &stage);
  const double peak = bench_peak_bytes(); /* of the steps: the hash lists the ids for itself */
  if ((status = mpm_state_hash(scene->stepper, &r->hash))) return status;
  qsort(rate, (size_t)how->repeats, sizeof *rate, ascending);
  const double ns = 1e9 / (n * steps * how->repeats);
  r->particles = (int64_t)n;
  r->resorts = info.resorts - sorted;
  r->allocations = scene->allocations - allocated;
  r->median = rate[how->repeats / 2];
  r->best = rate[how->repeats - 1];
  r->bytes = peak / n;
  r->weights = stage.weights * ns, r->p2g = stage.p2g * ns, r->grid = stage.grid * ns,
  r->g2p = stage.g2p * ns;
  r->law = stage.law * ns, r->sort = stage.sort * ns, r->callbacks = stage.callbacks * ns;
  const double change[3] = {info.momentum[0] - first.momentum[0], info.momentum[1] - first.momentum[1],
                            info.momentum[2] - first.momentum[2]};
  const double energy = first.kinetic_energy + first.strain_energy;
  r->momentum = size_of(change) / sqrt(2.0 * n * pow(0.5, of->dim) * first.kinetic_energy);
  r->energy = (info.kinetic_energy + info.strain_energy) / energy - 1.0;
  return MPM_OK;
}

typedef struct run_job {
  const bench_case *of;
  const settings *how;
  int64_t particles;
  int32_t threads;
} run_job;

static void run(const void *data, void *to) {
  const run_job *job = data;
  result *r = to;
  bench_scene scene;
  const bench_options options = {job->particles, job->threads, job->how->spread, job->how->markers};
  mpm_status status = bench_open(&scene, job->of, &options);
  if (!status) status = measure(&scene, job->of, job->how, r);
  r->failed = status != MPM_OK;
  if (status) snprintf(r->error, sizeof r->error, "%s", mpm_last_error(scene.context));
  bench_close(&scene);
}

/* What a run must keep whatever its speed. Work is done by the force; walls take momentum; plastic laws
 * dissipate. */
static int32_t is_sound(const bench_case *of, const settings *how, const result *r) {
  const int32_t free_body = !how->markers && of->extras != BENCH_WALLS && of->extras != BENCH_FORCE;
  int32_t good = isfinite(r->energy) && r->energy < 0.01;
  if (free_body) good &= r->momentum < 1e-9 && (bench_yields(of) || r->energy > -0.2);
  if (!good)
    fprintf(stderr, "%s: momentum changed by %.1e, energy by %.1e\n", of->name, r->momentum, r->energy);
  return good;
}

static void print(FILE *csv, const bench_case *of, int32_t threads, double spread, const result *r,
                  double peak, double bandwidth) {
  const double gflops = bench_flops(of) * r->median * 1e-9, gbytes = bench_bytes(of) * r->median * 1e-9;
  const double per_node = 1e9 * threads / (r->median * bench_nodes(of));
  printf("%-26s %6.0fk %2d %7.2f %7.2f  %4.1f %5.1f %4.1f %5.1f %5.1f %4.1f %4.1f %5.2f  %3.0f%% %3.0f%%  "
         "%4.0f  "
         "%3lld %2lld\n",
         of->name, 1e-3 * (double)r->particles, (int)threads, 1e-6 * r->median, 1e-6 * r->best, r->weights,
         r->p2g, r->grid, r->g2p, r->law, r->sort, r->callbacks, per_node, 100.0 * gflops / (peak * threads),
         100.0 * gbytes / (bandwidth * threads), r->bytes, (long long)r->resorts, (long long)r->allocations);
  fflush(stdout);
  if (!csv) return;
  fprintf(csv,
          "\"%s\",%lld,%d,%.0f,%.3f,%.3f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.3f,%.4f,%.4f,%.1f,%lld,%lld,%"
          "016llx\n",
          of->name, (long long)r->particles, (int)threads, spread, 1e-6 * r->median, 1e-6 * r->best,
          r->weights, r->p2g, r->grid, r->g2p, r->law, r->sort, r->callbacks, per_node,
          gflops / (peak * threads), gbytes / (bandwidth * threads), r->bytes, (long long)r->resorts,
          (long long)r->allocations, (unsigned long long)r->hash);
  fflush(csv);
}

/* One case on all numbers of threads, which must agree in every bit. */
static int32_t run_threads(const bench_case *of, const settings *how, int64_t particles, FILE *csv,
                           double peak, double bandwidth) {
  int32_t bad = 0;
  uint64_t hash = 0;
  for (int32_t t = 0; t < how->threads.count; ++t) {
    const int32_t threads = (int32_t)how->threads.at[t];
    const run_job job = {of, how, particles, threads};
    result r = {.failed = 1, .error = "the process died"};
    bench_in_process(run, &job, &r, sizeof r);
    if (r.failed) fprintf(stderr, "%s: %s\n", of->name, r.error);
    if (r.failed) return 1;
    if (how->choice.bare)
      bench_print_bare(of->name, threads, 1e-6 * r.best, r.hash);
    else
      print(csv, of, threads, how->spread, &r, peak, bandwidth);
    bad |= !is_sound(of, how, &r);
    if (t > 0 && r.hash != hash) {
      fprintf(stderr, "%s: another hash on %d threads\n", of->name, (int)threads);
      bad = 1;
    }
    hash = r.hash;
  }
  return bad;
}

static void print_heads(FILE *csv, double peak, double bandwidth) {
  printf("one core: %.1f GFLOP/s in multiply-adds, %.1f GB/s in an in-place update\n\n", peak, bandwidth);
  printf("%-26s %7s %2s %7s %7s  %4s %5s %4s %5s %5s %4s %4s %5s  %4s %4s  %4s  %3s %2s\n", "", "", "",
         "median", "best", "ns:", "", "", "", "", "", "call", "per", "", "", "B per", "", "");
  printf("%-26s %7s %2s %7s %7s  %4s %5s %4s %5s %5s %4s %4s %5s  %4s %4s  %4s  %3s %2s\n", "case", "part.",
         "th", "Mp/s", "Mp/s", "wgt", "p2g", "grid", "g2p", "law", "sort", "back", "node", "fma", "mem",
         "part.", "srt", "al");
  if (csv) {
    fprintf(csv, "# one core: %.2f GFLOP/s in multiply-adds, %.2f GB/s in an in-place update\n", peak,
            bandwidth);
    fprintf(
        csv,
        "case,particles,threads,spread,median_Mps,best_Mps,weights_ns,p2g_ns,grid_ns,g2p_ns,law_ns,sort_ns,"
        "callbacks_ns,ns_per_node,share_of_fma,share_of_bandwidth,bytes_per_particle,resorts,"
        "allocations,hash\n");
  }
}

static int32_t run_all(const settings *how, FILE *csv) {
  const int32_t bare = how->choice.bare || how->choice.list;
  const double peak = bare ? 1.0 : bench_fma_peak(), bandwidth = bare ? 1.0 : bench_update_bandwidth();
  if (!bare) print_heads(csv, peak, bandwidth);
  int32_t bad = 0;
  for (int32_t c = 0; c < CASES; ++c) {
    if (!bench_chosen(&how->choice, cases[c].name)) continue;
    if (how->choice.list) puts(cases[c].name);
    for (int32_t n = 0; n < how->particles.count && !how->choice.list; ++n)
      bad |= run_threads(&cases[c], how, how->particles.at[n], csv, peak, bandwidth);
  }
  return bad;
}

static int32_t read_numbers(const char *text, int64_t low, int64_t high, struct numbers *list) {
  list->count = 0;
  for (char *end; *text && list->count < MOST_NUMBERS; text = *end == ',' ? end + 1 : end) {
    const long long number = strtoll(text, &end, 10);
    if (end == text || number < low || number > high) return 0;
    list->at[list->count++] = number;
  }
  return list->count > 0 && !*text; /* and no more than there is room for */
}

/* 0 when an option is not understood. */
static int32_t read_options(int argc, char **argv, settings *how) {
  for (int i = 1; i < argc; ++i) {
    if (!strcmp(argv[i], "--quick")) {
      how->particles = (struct numbers){1, {60000}};
      how->repeats = 3;
      continue;
    }
    int32_t *flag = !strcmp(argv[i], "--implicit") ? &how->implicit
                    : !strcmp(argv[i], "--list")   ? &how->choice.list
                    : !strcmp(argv[i], "--bare")   ? &how->choice.bare
                                                   : NULL;
    if (flag) {
      *flag = 1;
      continue;
    }
    const char *value = i + 1 < argc ? argv[i + 1] : NULL;
    int32_t good = value != NULL;
    if (good && !strcmp(argv[i], "--only"))
      how->choice.only = value;
    else if (good && !strcmp(argv[i], "--case"))
      how->choice.exactly = value;
    else if (good && !strcmp(argv[i], "--csv"))
      how->csv = value;
    else if (good && !strcmp(argv[i], "--particles"))
      good = read_numbers(value, 64, INT64_C(1) << 31, &how->particles);
    else if (good && !strcmp(argv[i], "--repeats"))
      good = (how->repeats = atoi(value)) >= 1 && how->repeats <= MOST_REPEATS;
    else if (good && !strcmp(argv[i], "--spread"))
      good = (how->spread = atof(value)) >= 3.0;
    else if (good && !strcmp(argv[i], "--markers"))
      good = (how->markers = atoll(value)) >= 0;
    else if (good && !strcmp(argv[i], "--threads"))
      good = read_numbers(value, 1, 1024, &how->threads);
    else
      good = 0;
    if (!good) {
      fprintf(stderr, "bench: %s %s is not understood\n", argv[i], value ? value : "");
      return 0;
    }
    ++i;
  }
  return 1;
}

int main(int argc, char **argv) {
  settings how = {.particles = {1, {1000000}}, .repeats = 5, .threads = {2, {1, 2}}, .spread = 3.0};
  if (!read_options(argc, argv, &how)) return 2;
  FILE *csv = how.csv ? fopen(how.csv, "w") : NULL;
  if (how.csv && !csv) {
    perror(how.csv);
    return 2;
  }
  if (how.choice.bare && !bench_print_library()) return 2;
  const int32_t bad = how.implicit
                          ? bench_implicit(&how.choice, how.repeats, how.threads.at, how.threads.count, csv)
                          : run_all(&how, csv);
  if (csv && fclose(csv)) return 2;
  return bad;
}
