/* A program that knows nothing of parts, told on several: its calls of the library come here first, and what
 * it reads and writes of particles and nodes is that of all parts. main() begins with "--parts N"; each part
 * runs the program, writes to a folder part_K of that of "--out", and tells the hash of every stepper at its
 * end. One part has a transport, too, and with it the linear solver that several have. Linked with --wrap for
 * each call below. */
#include "table.h"

#include <mpm/mpm.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

static const mpm_transport *way;

#define REAL(type, name, ...)                                                                                \
  type __real_##name(__VA_ARGS__);                                                                           \
  type __wrap_##name(__VA_ARGS__)

/* Values by component, [components][n], as a row for each item, and back. */
static void turn(char *to, const char *from, int64_t n, int32_t components, size_t size, int32_t back) {
  for (int64_t i = 0; i < n; ++i)
    for (int32_t c = 0; c < components; ++c) {
      const int64_t in_rows = i * components + c, in_columns = c * n + i;
      memcpy(to + size * (size_t)(back ? in_columns : in_rows),
             from + size * (size_t)(back ? in_rows : in_columns), size);
    }
}

static size_t size_of(int32_t type) {
  return type == MPM_U8 ? 1 : type == MPM_F64 || type == MPM_I64 ? 8 : 4;
}

/* ---- particles ---------------------------------------------------------------------------------------- */

REAL(int64_t, mpm_particles_count, const mpm_particles *set) {
  int64_t n = __real_mpm_particles_count(set);
  must(mpm_particles_total(set, &n));
  return n;
}

REAL(mpm_status, mpm_particles_add, mpm_particles *set, int64_t n, const double *position,
     const double *velocity, const double *volume, const double *size, const int64_t *ids,
     int64_t *first_id) {
  return __real_mpm_particles_add(set, way->part ? 0 : n, position, velocity, volume, size, ids, first_id);
}

/* How many particles all parts have filled in, and the first of their ids. */
static mpm_status sum_filled(mpm_status status, int64_t own_first, int64_t own_count, int64_t *first_id,
                             int64_t *count) {
  int64_t first = own_count > 0 ? -own_first : -INT64_MAX;
  if (!status) {
    must(way->reduce(way->user, MPM_REDUCE_SUM, 1, &own_count));
    must(way->reduce(way->user, MPM_REDUCE_MAX, 1, &first));
  }
  if (first_id && !status) *first_id = -first;
  if (count && !status) *count = own_count;
  return status;
}

REAL(mpm_status, mpm_particles_fill_box, mpm_particles *set, const double *lower, const double *upper,
     const int32_t *per_cell, int64_t *first_id, int64_t *count) {
  int64_t first = 0, n = 0;
  const mpm_status status = __real_mpm_particles_fill_box(set, lower, upper, per_cell, &first, &n);
  return sum_filled(status, first, n, first_id, count);
}

REAL(mpm_status, mpm_particles_fill_ball, mpm_particles *set, const double *centre, double radius,
     const int32_t *per_cell, int64_t *first_id, int64_t *count) {
  int64_t first = 0, n = 0;
  const mpm_status status = __real_mpm_particles_fill_ball(set, centre, radius, per_cell, &first, &n);
  return sum_filled(status, first, n, first_id, count);
}

REAL(mpm_status, mpm_particles_fill, mpm_particles *set, const double *lower, const double *upper,
     const int32_t *per_cell, mpm_inside_fn inside, void *user, int64_t *first_id, int64_t *count) {
  int64_t first = 0, n = 0;
  const mpm_status status = __real_mpm_particles_fill(set, lower, upper, per_cell, inside, user, &first, &n);
  return sum_filled(status, first, n, first_id, count);
}

REAL(mpm_status, mpm_particles_get, const mpm_particles *set, const char *field, int32_t type,
     int32_t components, int64_t n, const int64_t *ids, void *out);

static int64_t *own_ids(const mpm_particles *set, int64_t *n) {
  *n = __real_mpm_particles_count(set);
  int64_t *id = room_for(*n, sizeof *id);
  must(__real_mpm_particles_get(set, "id", MPM_I64, 1, *n, NULL, id));
  return id;
}

mpm_status __wrap_mpm_particles_get(const mpm_particles *set, const char *field, int32_t type,
                                    int32_t components, int64_t n, const int64_t *ids, void *out) {
  const size_t size = size_of(type), width = size * (size_t)components;
  int64_t own;
  int64_t *id = own_ids(set, &own);
  char *columns = room_for(own, width), *rows = room_for(own, width);
  mpm_status status = __real_mpm_particles_get(set, field, type, components, own, NULL, columns);
  if (!status) {
    table t;
    turn(rows, columns, own, components, size, 0);
    gather_rows(way, own, id, rows, width, &t);
    char *found = room_for(n, width);
    if (!ids && n != t.n) status = MPM_E_ARG;
    for (int64_t i = 0; i < n && !status; ++i) {
      const row *r = ids ? find_row(&t, ids[i]) : &t.row[i];
      if (!r) status = MPM_E_NOT_FOUND;
      if (r) memcpy(found + width * (size_t)i, r->bytes, width);
    }
    if (!status) turn(out, found, n, components, size, 1);
    free(found);
    drop_rows(&t);
  }
  free(id);
  free(columns);
  free(rows);
  return status;
}

/* Each part sets its own particles among those that are given. */
REAL(mpm_status, mpm_particles_set, mpm_particles *set, const char *field, int32_t type, int32_t components,
     int64_t n, const int64_t *ids, const void *values) {
  const size_t size = size_of(type), width = size * (size_t)components;
  int64_t own, given = 0;
  int64_t *id = own_ids(set, &own), *found = room_for(own, sizeof *found);
  char *rows = room_for(n, width), *picked = room_for(own, width), *columns = room_for(own, width);
  table t, all = {0};
  gather_rows(way, own, id, (const char *)id, sizeof *id, &all);
  if (!ids && n != all.n) stop("values for other particles than there are");
  turn(rows, values, n, components, size, 0);
  t = (table){.n = n, .row = room_for(n, sizeof *t.row)};
  for (int64_t i = 0; i < n; ++i) t.row[i] = (row){ids ? ids[i] : all.row[i].key, rows + width * (size_t)i};
  sort_rows(&t);
  for (int64_t i = 0; i < own; ++i) {
    const row *r = find_row(&t, id[i]);
    if (!r) continue;
    memcpy(picked + width * (size_t)given, r->bytes, width);
    found[given++] = id[i];
  }
  turn(columns, picked, given, components, size, 1);
  const mpm_status status = __real_mpm_particles_set(set, field, type, components, given, found, columns);
  drop_rows(&t);
  drop_rows(&all);
  free(id), free(found), free(rows), free(picked), free(columns);
  return status;
}

/* ---- nodes -------------------------------------------------------------------------------------------- */

/* The nodes that this part owns, as a table of all parts by their place in the grid. */
REAL(mpm_status, mpm_grid_map, mpm_stepper *stepper, int32_t body, const char *field, int32_t access,
     mpm_view *view);
REAL(mpm_status, mpm_view_release, mpm_view *view);

static char *read_nodes(mpm_stepper *stepper, int32_t body, const char *field, mpm_view *view) {
  *view = (mpm_view){.struct_size = sizeof *view};
  if (__real_mpm_grid_map(stepper, body, field, MPM_READ, view)) return NULL;
  const size_t size = size_of(view->type);
  char *rows = room_for(view->count, size * (size_t)view->components);
  for (int64_t i = 0; i < view->count; ++i)
    for (int32_t c = 0; c < view->components; ++c)
      memcpy(rows + size * (size_t)(i * view->components + c),
             (const char *)view->data + (int64_t)size * (i * view->item_stride + c * view->component_stride),
             size);
  must(__real_mpm_view_release(view));
  return rows;
}

mpm_status __wrap_mpm_grid_map(mpm_stepper *stepper, int32_t body, const char *field, int32_t access,
                               mpm_view *view) {
  mpm_view of_index, of_owned, of_field;
  if (access != MPM_READ) stop("nodes are read here, not written");
  char *rows = read_nodes(stepper, body, field, &of_field);
  if (!rows) return MPM_E_NOT_FOUND;
  char *index = read_nodes(stepper, body, "index", &of_index),
       *owned = read_nodes(stepper, body, "owned", &of_owned);
  if (!index || !owned) stop("nodes without places");
  const size_t width = size_of(of_field.type) * (size_t)of_field.components;
  int64_t *key = room_for(of_field.count, sizeof *key), n = 0;
  for (int64_t i = 0; i < of_field.count; ++i) {
    if (!owned[i]) continue;
    key[n] = 0;
    for (int32_t c = 0; c < of_index.components; ++c) {
      int64_t along;
      memcpy(&along, index + 8 * (i * of_index.components + c), sizeof along);
      key[n] = key[n] * (1 << 20) + along + (1 << 18);
    }
    memmove(rows + width * (size_t)n++, rows + width * (size_t)i, width);
  }
  table t;
  gather_rows(way, n, key, rows, width, &t);
  char *all = room_for(t.n, width);
  for (int64_t i = 0; i < t.n; ++i) memcpy(all + width * (size_t)i, t.row[i].bytes, width);
  *view = (mpm_view){
      view->struct_size, of_field.type, of_field.components, access, t.n, of_field.components, 1, all, NULL};
  drop_rows(&t);
  free(key), free(rows), free(index), free(owned);
  return MPM_OK;
}

mpm_status __wrap_mpm_view_release(mpm_view *view) {
  if (view->owner) return __real_mpm_view_release(view);
  free(view->data);
  view->data = NULL;
  return MPM_OK;
}

/* ---- contexts and steppers ---------------------------------------------------------------------------- */

REAL(mpm_status, mpm_context_create, const mpm_context_desc *desc, mpm_context **out) {
  mpm_context_desc own;
  must(mpm_context_desc_init(&own, sizeof own));
  if (desc) own = *desc;
  own.transport = way;
  return __real_mpm_context_create(&own, out);
}

REAL(mpm_status, mpm_state_load, mpm_stepper *stepper, const void *buffer, int64_t bytes) {
  return mpm_state_load_pieces(stepper, 1, &buffer, &bytes);
}

REAL(mpm_status, mpm_stepper_destroy, mpm_stepper *stepper) {
  uint64_t hash = 0;
  if (stepper) {
    must(mpm_state_hash(stepper, &hash));
    printf("HASH %016" PRIx64 "\n", hash);
  }
  return __real_mpm_stepper_destroy(stepper);
}

/* Times differ from run to run. */
int __wrap_timespec_get(struct timespec *now, int base);
int __wrap_timespec_get(struct timespec *now, int base) {
  *now = (struct timespec){0};
  return base;
}

/* ---- the program -------------------------------------------------------------------------------------- */

int __real_main(int argc, char **argv);

int __wrap_main(int argc, char **argv) {
  static char folder[4000], log[4096];
  const int32_t parts = argc > 2 && !strcmp(argv[1], "--parts") ? atoi(argv[2]) : 0;
  int32_t out = 0;
  for (int32_t i = 3; i + 1 < argc; ++i)
    if (!strcmp(argv[i], "--out")) out = i + 1;
  if (parts < 1 || parts > PROCESSES_MOST || !out) stop("--parts N ... --out FOLDER");
  int status = 0;
  way = processes_start(parts, &status);
  if (!way) return status;
  snprintf(folder, sizeof folder, "%s/part_%d", argv[out], (int)way->part);
  snprintf(log, sizeof log, "%s/log", folder);
  mkdir(folder, 0777);
  if (!freopen(log, "w", stdout)) stop("cannot write a log");
  argv[out] = folder;
  argv[2] = argv[0];
  exit(__real_main(argc - 2, argv + 2));
}
