/* A block in the middle of a grid, and surfaces in and around it. */
#ifndef SURFACES_H
#define SURFACES_H

#include "body.h"
#include "io/state.h"

enum { EDGES = 24, CELLS = 12 };
static const double spacing = 0.25;

/* Opens a block in the middle of a grid without walls. */
static inline mpm_particles *open_block_with(world *w, const world_desc *desc) {
  mpm_particles *set = world_open(w, desc);
  const double low[] = {0.9, 0.85, 0.9}, high[] = {2.1, 2.1, 2.15};
  world_fill(w, set, low, high, 2);
  return set;
}

static inline mpm_particles *open_block(world *w, const method *how, int32_t dim) {
  const world_desc desc = world_with(how, dim, CELLS, spacing);
  return open_block_with(w, &desc);
}

static inline mpm_surface_desc load_desc(void) {
  mpm_surface_desc d;
  ck_assert_int_eq(mpm_surface_desc_init(&d, sizeof d), MPM_OK);
  return d;
}

static inline mpm_surface *put_surface(world *w, const mpm_surface_desc *d) {
  mpm_surface *s;
  ck_ok(w, mpm_surface_create(w->context, w->grid, d, &s));
  ck_ok(w, mpm_stepper_add_surface(w->stepper, s));
  return s;
}

static inline void drop_surface(world *w, mpm_surface *s) {
  ck_ok(w, mpm_stepper_remove_surface(w->stepper, s));
  ck_ok(w, mpm_surface_destroy(s));
}

/* Adds the polygon of 24 corners on a circle around the middle; it crosses the faces of the block. */
static inline void add_circle(const world *w, mpm_surface *s, double radius, double longest) {
  double at[2 * EDGES];
  for (int32_t i = 0; i < EDGES; ++i) {
    at[i] = 1.5 + radius * cos(2.0 * PI * i / EDGES);
    at[EDGES + i] = 1.5 + radius * sin(2.0 * PI * i / EDGES);
  }
  ck_ok(w, mpm_surface_add_polyline(s, EDGES, at, 1, longest, NULL, NULL));
}

static inline double area_of_circle(double radius) {
  return 0.5 * EDGES * radius * radius * sin(2.0 * PI / EDGES);
}

/* Adds an octahedron around the middle. */
static inline void add_octahedron(const world *w, mpm_surface *s, double radius, double longest) {
  double at[18];
  int64_t corner[24];
  for (int32_t i = 0; i < 18; ++i) at[i] = 1.5;
  for (int32_t i = 0; i < 6; ++i) at[i / 2 * 6 + i] += i % 2 ? -radius : radius;
  for (int32_t f = 0; f < 8; ++f) {
    const int32_t odd = (f & 1) ^ (f >> 1 & 1) ^ (f >> 2 & 1);
    corner[3 * f] = f & 1;
    corner[3 * f + 1 + odd] = 2 + (f >> 1 & 1);
    corner[3 * f + 2 - odd] = 4 + (f >> 2 & 1);
  }
  ck_ok(w, mpm_surface_add_triangles(s, 6, at, 8, corner, longest, NULL, NULL));
}

static inline void add_closed(const world *w, mpm_surface *s, double radius) {
  if (w->dim == 2) add_circle(w, s, radius, 0.1);
  if (w->dim == 3) add_octahedron(w, s, radius, 0.3);
  const double ends[] = {1.5 - radius, 1.5 + radius}, areas[] = {-1.0, 1.0};
  if (w->dim == 1) ck_ok(w, mpm_surface_add(s, 2, ends, areas, NULL));
}

/* Returns a field of all markers; the caller frees it. */
static inline double *markers(const mpm_surface *s, const char *field, int32_t components) {
  const int64_t n = mpm_surface_count(s);
  double *out = malloc((size_t)(n * components + 1) * sizeof *out);
  ck_assert_int_eq(mpm_surface_get(s, field, MPM_F64, components, n, NULL, out), MPM_OK);
  return out;
}

/* Sums of vectors at points: force, and in 2-D and 3-D its moment about the middle. */
typedef struct resultant {
  double force[3], moment[3], scale;
} resultant;

static inline resultant resultant_of(int32_t dim, int64_t n, const double *x, const double *f) {
  resultant sum = {{0.0}, {0.0}, 0.0};
  for (int64_t i = 0; i < n; ++i) {
    double arm[3] = {0.0, 0.0, 0.0}, v[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim; ++k) {
      arm[k] = x[k * n + i] - 1.5;
      v[k] = f[k * n + i];
      sum.force[k] += v[k];
      sum.scale += fabs(v[k]);
    }
    for (int32_t k = 0; k < 3; ++k)
      sum.moment[k] += arm[(k + 1) % 3] * v[(k + 2) % 3] - arm[(k + 2) % 3] * v[(k + 1) % 3];
  }
  return sum;
}

/* What all surfaces give to the nodes, in a step that is then dropped. The block is at rest and has no
 * stress. */
static inline resultant on_nodes(world *w) {
  int64_t n;
  ck_ok(w, mpm_step_begin(w->stepper, 1e-4));
  double *f = fetch_nodes(w, "force", &n), *x = fetch_nodes(w, "position", &n);
  const resultant sum = resultant_of(w->dim, n, x, f);
  free(f);
  free(x);
  ck_ok(w, mpm_step_abort(w->stepper));
  return sum;
}

static inline int32_t is_explicit(const method *how) {
  return how->scheme != MPM_NEWMARK;
}

/* Water: pressure that grows with the depth lifts by the weight of what the surface encloses. */
typedef struct water {
  double level, weight;
  int32_t answer;
  double t, dt;
} water;

static inline mpm_status push_by_depth(void *user, const mpm_marker_batch *b, double *add) {
  water *of = user;
  of->t = b->t;
  of->dt = b->dt;
  for (int64_t i = 0; i < b->n; ++i) {
    double size = 0.0;
    for (int32_t k = 0; k < b->dim; ++k) size += b->area[k * b->ld + i] * b->area[k * b->ld + i];
    const double p = of->weight * (of->level - b->position[b->ld + i]) / sqrt(size);
    for (int32_t k = 0; k < b->dim; ++k) add[k * b->ld + i] -= p * b->area[k * b->ld + i];
  }
  return of->answer;
}

/* Makes a step in which the nodes get this velocity in the end. */
static inline mpm_step_info step_with(world *w, double dt, void (*field)(const double *x, double *v)) {
  ck_ok(w, mpm_step_begin(w->stepper, dt));
  ck_ok(w, mpm_step_grid(w->stepper));
  mpm_view x = {.struct_size = sizeof x}, v = {.struct_size = sizeof v};
  ck_ok(w, mpm_grid_map(w->stepper, 0, "position", MPM_READ, &x));
  ck_ok(w, mpm_grid_map(w->stepper, 0, "velocity", MPM_WRITE, &v));
  for (int64_t i = 0; i < x.count; ++i) {
    double at[3] = {1.5, 1.5, 1.5}, to[3]; /* there is nothing across a plane */
    for (int32_t k = 0; k < w->dim; ++k)
      at[k] = ((const double *)x.data)[k * x.component_stride + i * x.item_stride];
    field(at, to);
    for (int32_t k = 0; k < w->dim; ++k)
      ((double *)v.data)[k * v.component_stride + i * v.item_stride] = to[k];
  }
  ck_ok(w, mpm_view_release(&x));
  ck_ok(w, mpm_view_release(&v));
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_step_end(w->stepper, &info));
  return info;
}

static inline void away(const double *x, double *v) {
  for (int32_t k = 0; k < 3; ++k) v[k] = x[k] - 1.5;
}

/* Makes the next part of a story, number `done`; it may fail, and is then tried again. */
typedef mpm_status (*story_fn)(world *w, mpm_surface **s, int32_t done);

/* Runs a story of so many parts in which one allocation fails, or none; returns how many there were. */
static inline int64_t run_story(const method *how, int32_t parts, story_fn part, int64_t fail_at,
                                uint64_t *hash) {
  world w;
  mpm_surface *s = NULL;
  open_block(&w, how, 2);
  const int64_t start = w.memory.calls;
  w.memory.fail_at = fail_at ? start + fail_at : 0;
  for (int32_t done = 0, tries = 0; done < parts;) {
    const mpm_status status = part(&w, &s, done);
    ck_assert(status == MPM_OK || (status == MPM_E_NOMEM && fail_at && !tries++));
    if (!status) ++done;
  }
  const int64_t calls = w.memory.calls - start;
  w.memory.fail_at = 0;
  *hash = world_hash(&w);
  drop_surface(&w, s);
  world_close(&w);
  return calls;
}

/* The story ends the same whichever of its allocations fails. */
static inline void fail_every_allocation(const method *how, int32_t parts, story_fn part) {
  uint64_t wanted, hash;
  const int64_t calls = run_story(how, parts, part, 0, &wanted);
  ck_assert(calls > 5);
  for (int64_t k = 1; k <= calls; ++k) {
    run_story(how, parts, part, k, &hash);
    ck_assert_msg(hash == wanted, "without allocation %lld the story is another", (long long)k);
  }
}

/* Add the cases of surface_motion.c, surface_states.c and surface_implicit.c. */
void add_surface_motion(Suite *suite);
void add_surface_states(Suite *suite);
void add_surface_implicit(Suite *suite);

#endif
