/* smoke ISA FOLDER: a host program for systems on which the unit tests do not run. It prints hashes of
 * states, for comparison with another system's, and ends with 1 where something is not as the headers say:
 * steps on one thread and on several, files of every kind in FOLDER, what is refused. Builds without threads
 * or without files are told so by the statuses, and say it. */
#include <inttypes.h>
#include <mpm/mpm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct scene {
  const char *name, *law;
  int32_t dim, basis, scheme, transfer, cells, steps;
  double dt;
} scene;
static const scene scenes[] = {
    {"2-D quadratic, FLIP, neo-Hookean", "neo_hookean", 2, MPM_BSPLINE2, MPM_USL, MPM_FLIP, 20, 60, 2e-4},
    {"2-D cubic, APIC, linear elastic", "linear_elastic", 2, MPM_BSPLINE3, MPM_USL, MPM_APIC, 20, 40, 2e-4},
    {"3-D quadratic, MLS, neo-Hookean", "neo_hookean", 3, MPM_BSPLINE2, MPM_MUSL, MPM_APIC_MLS, 10, 20, 4e-4},
    {"2-D quadratic, Newmark", "neo_hookean", 2, MPM_BSPLINE2, MPM_NEWMARK, MPM_FLIP, 12, 3, 2e-3},
};

typedef struct world {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
} world;

static void fail(const world *w, const char *what, mpm_status status) {
  printf("failed: %s: %s: %s\n", what, mpm_status_name(status), mpm_last_error(w->context));
  exit(1);
}

static void expect(const world *w, const char *what, mpm_status status) {
  if (status) fail(w, what, status);
}

static int32_t isa_of(const char *name) {
  return !strcmp(name, "baseline") ? MPM_ISA_BASELINE : MPM_ISA_BEST;
}

static char refusal[200]; /* of the last context that could not be made */

static mpm_status open_context(world *w, int32_t isa, int32_t threads) {
  mpm_context_desc c;
  mpm_context_desc_init(&c, sizeof c);
  c.error_text = refusal;
  c.error_bytes = sizeof refusal;
  c.isa = isa;
  c.concurrency = threads;
  memset(w, 0, sizeof *w);
  return mpm_context_create(&c, &w->context);
}

static void set_up(world *w, const scene *s) {
  mpm_grid_desc g;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = s->dim;
  g.basis = s->basis;
  for (int32_t k = 0; k < s->dim; ++k) {
    g.cells[k] = s->cells;
    g.spacing[k] = 1.0 / s->cells;
  }
  expect(w, "grid", mpm_grid_create(w->context, &g, &w->grid));
  const mpm_param params[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1e3}};
  expect(w, "material", mpm_material_create(w->context, s->law, params, 3, &w->material));
  expect(w, "particles", mpm_particles_create(w->context, w->grid, w->material, &w->set));
  const double lower[] = {0.25, 0.1, 0.25}, upper[] = {0.75, 0.6, 0.75}, velocity[] = {0.5, -1.0, 0.25};
  const int32_t per_cell[] = {2, 2, 2};
  expect(w, "fill", mpm_particles_fill_box(w->set, lower, upper, per_cell, NULL, NULL));
  expect(w, "velocity", mpm_particles_set_all(w->set, "velocity", MPM_F64, s->dim, velocity));
  mpm_stepper_desc d;
  mpm_stepper_desc_init(&d, sizeof d);
  d.scheme = s->scheme;
  d.transfer = s->transfer;
  d.gravity[1] = -9.81;
  expect(w, "stepper", mpm_stepper_create(w->context, w->grid, &d, &w->stepper));
  expect(w, "set", mpm_stepper_add(w->stepper, w->set));
  for (int32_t face = 0; face < 2 * s->dim; ++face)
    expect(w, "wall", mpm_stepper_set_wall(w->stepper, face, MPM_WALL_SLIP, 0.0));
}

static void take_down(world *w) {
  expect(w, "end of the stepper", mpm_stepper_destroy(w->stepper));
  expect(w, "end of the set", mpm_particles_destroy(w->set));
  expect(w, "end of the material", mpm_material_destroy(w->material));
  expect(w, "end of the grid", mpm_grid_destroy(w->grid));
  expect(w, "end of the context", mpm_context_destroy(w->context));
}

static uint64_t hash_of(const world *w) {
  uint64_t hash = 0;
  expect(w, "hash", mpm_state_hash(w->stepper, &hash));
  return hash;
}

static uint64_t run(const scene *s, int32_t isa, int32_t threads) {
  world w;
  expect(&w, "context", open_context(&w, isa, threads));
  set_up(&w, s);
  for (int32_t k = 0; k < s->steps; ++k) expect(&w, s->name, mpm_step(w.stepper, s->dt, NULL));
  const uint64_t hash = hash_of(&w);
  take_down(&w);
  return hash;
}

/* Whether the build has threads. Where it has none, one thread is all that can be asked for. */
static int32_t has_threads(int32_t isa) {
  world w;
  const mpm_status status = open_context(&w, isa, 4);
  if (status && (status != MPM_E_UNSUPPORTED || !strstr(refusal, "concurrency is 4")))
    fail(&w, "four threads", status);
  expect(&w, "end of a context", mpm_context_destroy(w.context));
  expect(&w, "a thread per processor", open_context(&w, isa, 0));
  expect(&w, "end of a context", mpm_context_destroy(w.context));
  return !status;
}

static int64_t size_of_file(const char *path, char *end, size_t bytes) {
  FILE *file = fopen(path, "rb");
  if (!file) return -1; /* as on Windows, where the C library's paths are not UTF-8 */
  fseek(file, 0, SEEK_END);
  const long size = ftell(file);
  if (bytes && size >= (long)bytes - 1) {
    fseek(file, 1 - (long)bytes, SEEK_END);
    end[fread(end, 1, bytes - 1, file)] = '\0';
  }
  fclose(file);
  return size;
}

static void check(const world *w, const char *what, int32_t holds) {
  if (!holds) fail(w, what, MPM_OK);
}

/* What a callback has taken. */
typedef struct stream {
  unsigned char data[1 << 18];
  int64_t bytes;
} stream;

static mpm_status take(void *user, const void *data, int64_t bytes) {
  stream *s = user;
  if (bytes > (int64_t)sizeof s->data - s->bytes) return 1;
  memcpy(s->data + s->bytes, data, (size_t)bytes);
  s->bytes += bytes;
  return MPM_OK;
}

/* Output without a file, which every build has. */
static void stream_out(int32_t isa) {
  static stream s;
  static const char tail[] = "</VTKFile>\n";
  world w;
  expect(&w, "context", open_context(&w, isa, 1));
  set_up(&w, &scenes[0]);
  expect(&w, "step", mpm_step(w.stepper, scenes[0].dt, NULL));
  const uint64_t saved = hash_of(&w);
  expect(&w, "a state to a callback", mpm_state_save_to(w.stepper, take, &s));
  expect(&w, "step", mpm_step(w.stepper, scenes[0].dt, NULL));
  expect(&w, "loading", mpm_state_load(w.stepper, s.data, s.bytes));
  check(&w, "the state that a callback took", hash_of(&w) == saved);
  for (int32_t nodes = 0; nodes < 2; ++nodes) {
    s.bytes = 0;
    expect(&w, "a step", mpm_step(w.stepper, scenes[0].dt, NULL));
    expect(&w, "a file to a callback",
           nodes ? mpm_write_grid_to(w.stepper, 0, take, &s, 0, NULL)
                 : mpm_write_particles_to(w.set, take, &s, 0, NULL));
    check(&w, "its end",
          s.bytes > 1000 && !memcmp(s.data + s.bytes - (sizeof tail - 1), tail, sizeof tail - 1));
  }
  take_down(&w);
}

/* Writes, overwrites and reads under names in ASCII and in other letters. Returns whether the build has
 * files. */
static int32_t round_trip(int32_t isa, const char *folder) {
  static const char *const names[] = {"smoke.state",
                                      "zust\xc3\xa4nde-\xe2\x82\xac-\xe7\x8a\xb6\xe6\x85\x8b.state"};
  world w;
  char path[1024];
  expect(&w, "context", open_context(&w, isa, 1));
  set_up(&w, &scenes[0]);
  expect(&w, "step", mpm_step(w.stepper, scenes[0].dt, NULL));
  int64_t bytes = 0;
  expect(&w, "size", mpm_state_size(w.stepper, &bytes));
  for (int32_t k = 0; k < 4; ++k) {
    snprintf(path, sizeof path, "%s/%s", folder, names[k % 2]);
    const mpm_status status = mpm_state_save_file(w.stepper, path);
    if (status == MPM_E_UNSUPPORTED && strstr(mpm_last_error(w.context), "no files")) {
      take_down(&w);
      return 0;
    }
    expect(&w, "saving", status);
    const uint64_t saved = hash_of(&w);
    const int64_t size = size_of_file(path, NULL, 0);
    check(&w, "the file's size", size == bytes || (size < 0 && k % 2));
    expect(&w, "step", mpm_step(w.stepper, scenes[0].dt, NULL));
    check(&w, "another state", hash_of(&w) != saved);
    expect(&w, "loading", mpm_state_load_file(w.stepper, path));
    check(&w, "the state that was saved", hash_of(&w) == saved);
    expect(&w, "step", mpm_step(w.stepper, scenes[0].dt, NULL));
  }
  snprintf(path, sizeof path, "%s/smoke.vtp", folder);
  for (int32_t k = 0; k < 2; ++k) expect(&w, "particles", mpm_write_particles(w.set, path, 0, NULL));
  check(&w, "particles in a file", size_of_file(path, NULL, 0) > 1000);
  snprintf(path, sizeof path, "%s/smoke.vti", folder);
  for (int32_t k = 0; k < 2; ++k) expect(&w, "nodes", mpm_write_grid(w.stepper, path, 0, NULL));
  check(&w, "nodes in a file", size_of_file(path, NULL, 0) > 1000);
  mpm_series *series;
  snprintf(path, sizeof path, "%s/smoke.pvd", folder);
  expect(&w, "series", mpm_series_open(w.context, path, &series));
  static const char tail[] = "  </Collection>\n</VTKFile>\n";
  for (int32_t k = 0; k < 5; ++k) {
    expect(&w, "entry", mpm_series_append(series, 0.1 * k, "smoke.vtp"));
    char end[sizeof tail];
    check(&w, "a series", size_of_file(path, end, sizeof end) > 0 && !strcmp(end, tail));
  }
  expect(&w, "end of the series", mpm_series_close(series));
  snprintf(path, sizeof path, "%s/no/such/folder", folder);
  check(&w, "a folder that is not there",
        mpm_state_save_file(w.stepper, path) == MPM_E_IO && strstr(mpm_last_error(w.context), path) != NULL);
  check(&w, "a file that is not there", mpm_state_load_file(w.stepper, path) == MPM_E_IO);
  check(&w, "a folder in place of a file", mpm_state_save_file(w.stepper, folder) == MPM_E_IO);
  take_down(&w);
  return 1;
}

int main(int argc, char **argv) {
  if (argc != 3) return 1;
  const int32_t isa = isa_of(argv[1]), threads = has_threads(isa);
  for (size_t k = 0; k < sizeof scenes / sizeof *scenes; ++k) {
    const uint64_t hash = run(&scenes[k], isa, 1);
    printf("%s %016" PRIx64 "\n", scenes[k].name, hash);
    if (threads && run(&scenes[k], isa, 4) != hash) {
      printf("failed: other bits on four threads\n");
      return 1;
    }
  }
  stream_out(isa);
  const int32_t files = round_trip(isa, argv[2]);
  fprintf(stderr, "%s threads, %s files\n", threads ? "with" : "without", files ? "with" : "without");
  return 0;
}
