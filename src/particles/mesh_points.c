/* A mesh as the host gives it is checked, scaled, and its points are told apart by their coordinates: files
 * of triangles have every corner as often as there are triangles round it. */
#include "particles/mesh.h"

#include <math.h>
#include <string.h>

#include "context/radix.h"

static mpm_status check_points(mpm_context *c, int32_t dim, int64_t n, const double *position) {
  for (int32_t k = 0; k < dim; ++k)
    for (int64_t i = 0; i < n; ++i)
      if (!isfinite(position[k * n + i]))
        return mpmi_fail(c, MPM_E_ARG, "point %lld: position[%d] is %g, must be finite", (long long)i, (int)k,
                         position[k * n + i]);
  return MPM_OK;
}

static mpm_status check_corners(mpm_context *c, int32_t dim, int64_t points, int64_t n,
                                const int64_t *corner) {
  for (int64_t i = 0; i < n * dim; ++i)
    if (corner[i] < 0 || corner[i] >= points)
      return mpmi_fail(c, MPM_E_ARG, "%s %lld: corner %lld does not exist, there are %lld",
                       dim == 3 ? "triangle" : "edge", (long long)(i / dim), (long long)corner[i],
                       (long long)points);
  return MPM_OK;
}

/* The bounds of the points that elements have. */
static mpm_status find_bounds(mpmi_mesh *mesh, int64_t points, const double *position,
                              const int64_t *corner) {
  double longest = 0.0;
  for (int32_t k = 0; k < mesh->dim; ++k) {
    mesh->lower[k] = HUGE_VAL;
    mesh->upper[k] = -HUGE_VAL;
    for (int64_t i = 0; i < mesh->elements * mesh->dim; ++i) {
      const double x = position[k * points + corner[i]];
      mesh->lower[k] = fmin(mesh->lower[k], x);
      mesh->upper[k] = fmax(mesh->upper[k], x);
    }
    const double edge = mesh->upper[k] - mesh->lower[k];
    if (!(edge > 0) || !isfinite(edge))
      return mpmi_fail(mesh->context, MPM_E_ARG,
                       "the mesh reaches from %g to %g on axis %d: it has no volume, or it is out of range",
                       mesh->lower[k], mesh->upper[k], (int)k);
    longest = fmax(longest, edge);
  }
  mesh->scale = 1.0;
  while (mesh->scale * longest > 1.0) mesh->scale *= 0.5;
  while (mesh->scale * longest < 0.5 && mesh->scale < 0x1p1000) mesh->scale *= 2.0;
  for (int32_t k = 0; k < mesh->dim; ++k) {
    mesh->lower[k] *= mesh->scale;
    mesh->upper[k] *= mesh->scale;
  }
  return MPM_OK;
}

/* Returns a key that has the order of doubles; both zeros have the same. */
static uint64_t key_of(double x) {
  const double same = x + 0.0;
  uint64_t bits;
  memcpy(&bits, &same, sizeof bits);
  return bits >> 63 ? ~bits : bits | (uint64_t)1 << 63;
}

/* Scratch of the search for equal points. */
typedef struct points_scratch {
  uint64_t *key;            /* [2 n] */
  uint32_t *order, *passed; /* [2 n] and [n] */
  int32_t *number;          /* [n] the number of a point among those that differ */
} points_scratch;

/* Sorts by the last coordinate first: each further sort keeps the order of what is equal. */
static void sort_points(int32_t dim, int64_t n, const double *position, const points_scratch *s) {
  for (int64_t i = 0; i < n; ++i) s->passed[i] = (uint32_t)i;
  for (int32_t k = dim - 1; k >= 0; --k) {
    for (int64_t i = 0; i < n; ++i) s->key[i] = key_of(position[k * n + s->passed[i]]);
    mpmi_radix_sort(n, s->key, s->order, s->key + n, s->order + n);
    for (int64_t i = 0; i < n; ++i) s->order[i] = s->passed[s->order[i]];
    memcpy(s->passed, s->order, (size_t)n * sizeof *s->passed);
  }
}

static void number_points(mpmi_mesh *mesh, int64_t n, const double *position, const points_scratch *s) {
  for (int64_t i = 0; i < n; ++i) {
    const int64_t at = s->passed[i], before = i ? s->passed[i - 1] : at;
    int32_t differs = i == 0;
    for (int32_t k = 0; k < mesh->dim && !differs; ++k)
      differs = key_of(position[k * n + at]) != key_of(position[k * n + before]);
    if (differs) {
      for (int32_t k = 0; k < mesh->dim; ++k)
        mesh->point[mesh->points * mesh->dim + k] = position[k * n + at] * mesh->scale;
      mesh->points++;
    }
    s->number[at] = (int32_t)(mesh->points - 1);
  }
}

static mpm_status copy_mesh(mpmi_mesh *mesh, int64_t n, const double *position, const int64_t *corner) {
  mpm_context *c = mesh->context;
  const size_t key_bytes = mpmi_bytes(2 * n, sizeof(uint64_t)), order_bytes = mpmi_bytes(3 * n, 4),
               number_bytes = mpmi_bytes(n, 4);
  points_scratch s = {.key = mpmi_alloc(c, key_bytes)};
  if (s.key) s.order = mpmi_alloc(c, order_bytes);
  if (s.order) s.number = mpmi_alloc(c, number_bytes);
  if (s.number) mesh->point = mpmi_alloc(c, mpmi_bytes(n * mesh->dim, sizeof(double)));
  if (mesh->point) mesh->corner = mpmi_alloc(c, mpmi_bytes(mesh->elements * mesh->dim, 4));
  if (mesh->corner) {
    s.passed = s.order + 2 * n;
    sort_points(mesh->dim, n, position, &s);
    number_points(mesh, n, position, &s);
    for (int64_t i = 0; i < mesh->elements * mesh->dim; ++i) mesh->corner[i] = s.number[corner[i]];
  }
  mpmi_free(c, s.number, number_bytes);
  mpmi_free(c, s.order, order_bytes);
  mpmi_free(c, s.key, key_bytes);
  return mesh->corner ? MPM_OK : MPM_E_NOMEM;
}

mpm_status mpmi_mesh_open(mpm_context *context, int32_t dim, int64_t points, const double *position,
                          int64_t elements, const int64_t *corner, mpmi_mesh *out) {
  mpm_status status = check_points(context, dim, points, position);
  if (!status) status = check_corners(context, dim, points, elements, corner);
  if (status) return status;
  *out = (mpmi_mesh){.context = context, .dim = dim, .elements = elements, .given = points};
  status = find_bounds(out, points, position, corner);
  if (!status) status = copy_mesh(out, points, position, corner);
  if (!status) status = mpmi_mesh_divide(out);
  if (status) mpmi_mesh_close(out);
  return status;
}

void mpmi_mesh_close(mpmi_mesh *mesh) {
  mpm_context *c = mesh->context;
  mpmi_free(c, mesh->side, mpmi_bytes(mesh->side_capacity, sizeof *mesh->side));
  mpmi_free(c, mesh->patch, mpmi_bytes(mesh->elements / 2 + 1, sizeof *mesh->patch));
  mpmi_free(c, mesh->corner, mpmi_bytes(mesh->elements * mesh->dim, 4));
  mpmi_free(c, mesh->point, mpmi_bytes(mesh->given * mesh->dim, sizeof(double)));
}
