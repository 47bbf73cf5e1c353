/* How a scene is stepped, with dt that changes. A step that a smaller dt may cure is repeated with half of
 * it, and its report counts. What a story is told for has to come to pass, or the scene fails. */
#include "scene.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if !defined(__wasi__) /* which has no jumps: the first scene that fails ends the program there */
#include <setjmp.h>
#define MAY_FAIL
#endif

static void expect(const world *w, int32_t holds, const char *what) {
  if (holds) return;
  fprintf(stderr, "%s: %s\n", w->is->name, what);
  give_up();
}

static double dt_of(const world *w, int32_t step) {
  static const double share[] = {1.0, 0.75, 1.125, 0.875, 1.25};
  return share[step % 5] * w->dt;
}

static void whole_step(world *w, double dt) {
  mpm_status status = MPM_CUT_DT;
  for (int32_t trial = 0; trial < 8 && status >= MPM_CUT_DT && status <= MPM_SINGULAR; ++trial, dt *= 0.5) {
    status = mpm_step(w->stepper, dt, &w->info);
    mix_info(&w->hash, &w->info);
  }
  must(w, status);
}

static void write_nodes(world *w, const char *field) {
  const int32_t dim = w->is->dim;
  mpm_view mass = {.struct_size = sizeof mass}, out = mass;
  must(w, mpm_grid_map(w->stepper, 0, "mass", MPM_READ, &mass));
  must(w, mpm_grid_map(w->stepper, 0, field, MPM_READ | MPM_WRITE, &out));
  for (int64_t i = 0; i < out.count; ++i) {
    const double m = ((const double *)mass.data)[i * mass.item_stride];
    double *value = (double *)out.data + i * out.item_stride;
    value[0] *= 0.995;
    value[(dim - 1) * out.component_stride] += (w->is->story == STORY_STAGED_FORCE ? 50.0 * m : 0.05);
  }
  must(w, mpm_view_release(&out));
  must(w, mpm_view_release(&mass));
}

/* "velocity" is written before the nodal update in even steps and after it in odd ones. */
static void step_in_parts(world *w, int32_t step) {
  const int32_t late = w->is->story == STORY_STAGED_VELOCITY && step % 2;
  const char *field = w->is->story == STORY_STAGED_FORCE ? "force" : "velocity";
  must(w, mpm_step_begin(w->stepper, dt_of(w, step)));
  if (!late) write_nodes(w, field);
  must(w, mpm_step_grid(w->stepper));
  if (late) write_nodes(w, field);
  must(w, mpm_step_end(w->stepper, &w->info));
  mix_info(&w->hash, &w->info);
}

static void save_and_load(world *w) {
  world other;
  int64_t bytes = 0;
  must(w, mpm_state_size(w->stepper, &bytes));
  void *buffer = malloc((size_t)bytes);
  expect(w, buffer != NULL, "no memory");
  must(w, mpm_state_save(w->stepper, buffer, bytes));
  open_world(&other, w->is, w->how, 1);
  must(&other, mpm_state_load_pieces(other.stepper, 1, (const void *const *)&buffer, &bytes));
  free(buffer);
  other.hash = w->hash;
  other.info = w->info;
  close_world(w);
  *w = other;
}

static void fail(world *w) {
  const mpm_status status = mpm_step(w->stepper, 400.0 * w->dt, &w->info);
  expect(w, status > 0, "the step that is far too large did not fail");
  mix(&w->hash, (uint64_t)status);
  mix_info(&w->hash, &w->info);
}

/* Where the particle is, on all parts; it is on one of them. */
static void find_place(world *w, int64_t id, int32_t is_here, double *x) {
  int64_t bits[3] = {0, 0, 0};
  if (is_here) must(w, mpm_particles_get(w->set[0], "position", MPM_F64, w->is->dim, 1, &id, x));
  memcpy(bits, x, sizeof bits);
  sum_parts(w, 3, bits);
  memcpy(x, bits, sizeof bits);
}

/* Some particles go, one comes, and the steps go on by another method. */
static void change(world *w) {
  enum { IDS = 16384 }; /* all are smaller */
  const int64_t n = mpm_particles_count(w->set[0]), born = 5000;
  int64_t *own = malloc(((size_t)n + 1) * sizeof *own);
  int64_t *has = calloc(IDS, sizeof *has), *all = calloc(IDS, sizeof *all);
  int64_t whole = 0, some = 0, middle = 0;
  double x[3] = {0.0, 0.0, 0.0}, v[3] = {1.0, 2.0, 3.0};
  const double volume = 1e-4;
  expect(w, own && has && all, "no memory");
  must(w, mpm_particles_get(w->set[0], "id", MPM_I64, 1, n, NULL, own));
  for (int64_t i = 0; i < n; ++i) has[own[i]] = all[own[i]] = 1;
  sum_parts(w, IDS, all);
  for (int64_t id = 0; id < IDS; ++id) whole += all[id];
  for (int64_t id = 0, i = 0; id < IDS; ++id) {
    if (!all[id]) continue;
    if (i == whole / 2) middle = id;
    if (i++ % 11 == 4 && has[id]) own[some++] = id;
  }
  find_place(w, middle, has[middle] != 0, x);
  if (some) must(w, mpm_particles_remove(w->set[0], some, own));
  free(own);
  free(has);
  free(all);
  const mpm_transport *between = w->how->transport;
  const int32_t adds = !between || between->part == between->parts - 1; /* the last of all */
  must(w, mpm_particles_add(w->set[0], adds, x, v, &volume, NULL, &born, NULL));
  mpm_stepper_desc d = describe_stepper(w->is);
  d.scheme = w->is->scheme == MPM_MUSL ? MPM_USL : MPM_MUSL;
  d.transfer = w->is->transfer == MPM_APIC ? MPM_FLIP : MPM_APIC;
  d.quasi_static = d.staggered = 0;
  must(w, mpm_stepper_configure(w->stepper, &d));
  if (w->is->scheme == MPM_NEWMARK) w->dt /= 4.0;
}

static void advance(world *w) {
  mpm_advance_desc d;
  mpm_advance_desc_init(&d, sizeof d);
  for (int32_t i = 1; i <= 3; ++i) {
    d.t_end = i * w->is->steps / 3.0 * w->dt;
    d.cfl = 0.25 + 0.1 * i;
    d.dt_first = i == 1 ? 0.2 * w->dt : 0.0;
    d.dt_max = i == 2 ? 0.7 * w->dt : 0.0;
    must(w, mpm_advance(w->stepper, &d, &w->info));
    expect(w, !(w->info.t < d.t_end), "the end was not reached");
    mix_info(&w->hash, &w->info);
  }
}

static void ck_told(const world *w) {
  const scene *is = w->is;
  if (is->wall[MPM_X_MAX] == MPM_WALL_OPEN && !is->periodic[0])
    expect(w, w->info.removed > 0, "no particle left");
  if (is->total)
    expect(w, w->info.resorts <= 1 + (is->story == STORY_SAVED), "particles were sorted anew");
  else if (is->scheme != MPM_NEWMARK)
    expect(w, w->info.resorts > 1, "particles were not sorted anew");
  expect(w, w->info.active_nodes > 0, "no node is active");
}

/* Beside the state what has been hashed so far. */
static void leave(const world *w, const char *file) {
  char name[520];
  snprintf(name, sizeof name, "%s.hash", file);
  FILE *out = fopen(name, "w");
  expect(w, out && fprintf(out, "%016" PRIx64 "\n", w->hash) > 0 && !fclose(out), "the hash is not written");
  must(w, mpm_state_save_file(w->stepper, file));
}

static void take(world *w, const char *file) {
  char name[520];
  snprintf(name, sizeof name, "%s.hash", file);
  FILE *in = fopen(name, "r");
  expect(w, in && fscanf(in, "%" SCNx64, &w->hash) == 1 && !fclose(in), "there is no hash of the first half");
  must(w, mpm_state_load_file(w->stepper, file));
}

static uint64_t tell(const scene *is, const errand *how) {
  const int32_t steps = how->half == FIRST_HALF ? is->steps / 2 : is->steps;
  const int32_t first = how->half == SECOND_HALF ? is->steps / 2 : 0;
  world w;
  open_world(&w, is, how, how->half == SECOND_HALF);
  w.info.struct_size = sizeof w.info;
  if (how->half) expect(&w, is->story == STORY_PLAIN, "only scenes of plain steps are told in halves");
  if (how->half == SECOND_HALF) take(&w, how->file);
  for (int32_t i = first; i < steps && is->story != STORY_ADVANCE; ++i) {
    if (i == is->steps / 2 && is->story == STORY_SAVED) save_and_load(&w);
    if (i == is->steps / 2 && is->story == STORY_FAILING) fail(&w);
    if (i == is->steps / 2 && is->story == STORY_CHANGED) change(&w);
    if (is->story == STORY_STAGED_VELOCITY || is->story == STORY_STAGED_FORCE)
      step_in_parts(&w, i);
    else
      whole_step(&w, dt_of(&w, i));
  }
  if (is->story == STORY_ADVANCE) advance(&w);
  if (how->half == FIRST_HALF) {
    leave(&w, how->file);
  } else {
    ck_told(&w);
    mix_world(&w);
  }
  const uint64_t hash = w.hash;
  close_world(&w);
  return hash;
}

#if defined(MAY_FAIL)
static _Thread_local jmp_buf failed;
static _Thread_local int32_t is_told;

void give_up(void) {
  if (!is_told) exit(1);
  longjmp(failed, 1);
}

int32_t run_scene(const scene *is, const errand *how, uint64_t *hash) {
  is_told = 1;
  if (setjmp(failed)) return 0;
  *hash = tell(is, how);
  return 1;
}
#else
void give_up(void) {
  exit(1);
}

int32_t run_scene(const scene *is, const errand *how, uint64_t *hash) {
  *hash = tell(is, how);
  return 1;
}
#endif
