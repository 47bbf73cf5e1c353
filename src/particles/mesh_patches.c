/* A mesh is sorted along a curve that fills space, so that neighbours come together, and halved again and
 * again into patches. Where two patches join, the common part of their boundaries cancels. */
#include <math.h>
#include <string.h>

#include "context/radix.h"
#include "particles/mesh.h"

enum { LEAF = 8, CURVE_BITS = 20 };

/* The boundaries of patches whose other half is still to come lie on a stack. */
typedef struct division {
  mpmi_mesh *mesh;
  mpmi_side *stack, *joined; /* [dim * elements] each */
  int64_t top;
} division;

/* ---- order --------------------------------------------------------------------------------------------- */
/* Finds the place of an element's centre on the curve: bits of its coordinates in turn (Morton's order). */
static uint64_t place_on_curve(const mpmi_mesh *mesh, const int32_t *corner) {
  uint64_t cell[3] = {0, 0, 0}, place = 0;
  for (int32_t k = 0; k < mesh->dim; ++k) {
    double centre = 0.0;
    for (int32_t j = 0; j < mesh->dim; ++j) centre += mesh->point[(int64_t)corner[j] * mesh->dim + k];
    const double share = (centre / mesh->dim - mesh->lower[k]) / (mesh->upper[k] - mesh->lower[k]);
    cell[k] = (uint64_t)(fmin(fmax(share, 0.0), 1.0) * ((1 << CURVE_BITS) - 1));
  }
  for (int32_t bit = CURVE_BITS - 1; bit >= 0; --bit)
    for (int32_t k = 0; k < mesh->dim; ++k) place = place << 1 | (cell[k] >> bit & 1);
  return place;
}

static mpm_status sort_elements(mpmi_mesh *mesh) {
  const int64_t n = mesh->elements;
  const size_t key_bytes = mpmi_bytes(2 * n, sizeof(uint64_t)), order_bytes = mpmi_bytes(2 * n, 4),
               corner_bytes = mpmi_bytes(n * mesh->dim, 4);
  uint64_t *key = mpmi_alloc(mesh->context, key_bytes);
  uint32_t *order = key ? mpmi_alloc(mesh->context, order_bytes) : NULL;
  int32_t *sorted = order ? mpmi_alloc(mesh->context, corner_bytes) : NULL;
  if (sorted) {
    for (int64_t e = 0; e < n; ++e) key[e] = place_on_curve(mesh, mesh->corner + e * mesh->dim);
    mpmi_radix_sort(n, key, order, key + n, order + n);
    for (int64_t e = 0; e < n; ++e)
      memcpy(sorted + e * mesh->dim, mesh->corner + (int64_t)order[e] * mesh->dim,
             (size_t)mesh->dim * sizeof *sorted);
    mpmi_free(mesh->context, mesh->corner, corner_bytes);
    mesh->corner = sorted;
  }
  mpmi_free(mesh->context, order, order_bytes);
  mpmi_free(mesh->context, key, key_bytes);
  return sorted ? MPM_OK : MPM_E_NOMEM;
}

/* ---- boundaries ---------------------------------------------------------------------------------------- */
static int32_t compare(const mpmi_side *a, const mpmi_side *b) {
  if (a->from != b->from) return a->from < b->from ? -1 : 1;
  return a->to < b->to ? -1 : a->to > b->to;
}

/* Puts a side into an ascending list, and returns the new length. */
static int64_t put(mpmi_side *list, int64_t n, mpmi_side side) {
  int64_t i = n;
  while (i > 0 && compare(&list[i - 1], &side) > 0) --i;
  if (i > 0 && compare(&list[i - 1], &side) == 0) {
    list[i - 1].times += side.times;
    if (list[i - 1].times) return n;
    memmove(list + i - 1, list + i, (size_t)(n - i) * sizeof *list);
    return n - 1;
  }
  memmove(list + i + 1, list + i, (size_t)(n - i) * sizeof *list);
  list[i] = side;
  return n + 1;
}

static int64_t boundary_of_elements(const mpmi_mesh *mesh, const mpmi_patch *of, mpmi_side *list) {
  int64_t n = 0;
  for (int32_t e = of->begin; e < of->end; ++e) {
    const int32_t *c = mesh->corner + (int64_t)e * mesh->dim;
    if (mesh->dim == 2) {
      n = put(list, n, (mpmi_side){c[0], 0, -1});
      n = put(list, n, (mpmi_side){c[1], 0, 1});
    }
    for (int32_t j = 0; j < 3 && mesh->dim == 3; ++j) {
      const int32_t from = c[j], to = c[(j + 1) % 3];
      if (from < to) n = put(list, n, (mpmi_side){from, to, 1});
      if (from > to) n = put(list, n, (mpmi_side){to, from, -1});
    }
  }
  return n;
}

/* Joins the two ascending lists on top of the stack, the upper of which has n sides. */
static int64_t join(division *d, int64_t begin, int64_t n) {
  const mpmi_side *a = d->stack + begin, *b = d->stack + d->top - n, *a_end = b, *b_end = b + n;
  int64_t joined = 0;
  while (a < a_end || b < b_end) {
    const int32_t which = a == a_end ? 1 : b == b_end ? -1 : compare(a, b);
    mpmi_side side = which <= 0 ? *a++ : *b++;
    if (which == 0) side.times += (b++)->times;
    if (side.times) d->joined[joined++] = side;
  }
  if (joined) memcpy(d->stack + begin, d->joined, (size_t)joined * sizeof *d->stack);
  d->top = begin + joined;
  return joined;
}

/* A fan is worth keeping where it has at most half as many elements as the patch. */
static mpm_status keep_boundary(mpmi_mesh *mesh, mpmi_patch *patch, const mpmi_side *list, int64_t n) {
  patch->sides = -1;
  if (2 * n > patch->end - patch->begin) return MPM_OK;
  patch->side = mesh->sides;
  patch->sides = n;
  for (int64_t i = 0; i < n; ++i) {
    const mpm_status status = mpmi_reserve_next(mesh->context, (void **)&mesh->side, &mesh->side_capacity,
                                                mesh->sides, sizeof *mesh->side);
    if (status) return status;
    mesh->side[mesh->sides++] = list[i];
  }
  return MPM_OK;
}

/* ---- patches ------------------------------------------------------------------------------------------- */
static void box_of_elements(const mpmi_mesh *mesh, mpmi_patch *patch) {
  for (int32_t k = 0; k < mesh->dim; ++k) {
    patch->lower[k] = HUGE_VAL;
    patch->upper[k] = -HUGE_VAL;
    for (int64_t c = (int64_t)patch->begin * mesh->dim; c < (int64_t)patch->end * mesh->dim; ++c) {
      const double x = mesh->point[(int64_t)mesh->corner[c] * mesh->dim + k];
      patch->lower[k] = fmin(patch->lower[k], x);
      patch->upper[k] = fmax(patch->upper[k], x);
    }
  }
}

/* Makes the patch of the elements [begin, end) and those within; leaves its boundary on the stack. */
static mpm_status divide(division *d, int32_t begin, int32_t end) {
  mpmi_mesh *mesh = d->mesh;
  mpmi_patch *patch = &mesh->patch[mesh->patches++];
  const int64_t bottom = d->top;
  *patch = (mpmi_patch){.begin = begin, .end = end};
  if (end - begin <= LEAF) {
    box_of_elements(mesh, patch);
    d->top += boundary_of_elements(mesh, patch, d->stack + bottom);
  } else {
    const int32_t middle = begin + (end - begin) / 2;
    const mpmi_patch *first = patch + 1;
    mpm_status status = divide(d, begin, middle);
    const int64_t before = d->top;
    patch->second = (int32_t)mesh->patches;
    if (!status) status = divide(d, middle, end);
    if (status) return status;
    const mpmi_patch *second = &mesh->patch[patch->second];
    for (int32_t k = 0; k < mesh->dim; ++k) {
      patch->lower[k] = fmin(first->lower[k], second->lower[k]);
      patch->upper[k] = fmax(first->upper[k], second->upper[k]);
    }
    join(d, bottom, d->top - before);
  }
  return keep_boundary(mesh, patch, d->stack + bottom, d->top - bottom);
}

mpm_status mpmi_mesh_divide(mpmi_mesh *mesh) {
  /* Leaves have four elements or more, but for a mesh of fewer. */
  const size_t patch_bytes = mpmi_bytes(mesh->elements / 2 + 1, sizeof *mesh->patch),
               side_bytes = mpmi_bytes(mesh->dim * mesh->elements, sizeof(mpmi_side));
  division d = {.mesh = mesh};
  mpm_status status = sort_elements(mesh);
  if (status) return status;
  mesh->patch = mpmi_alloc(mesh->context, patch_bytes);
  if (mesh->patch) d.stack = mpmi_alloc(mesh->context, side_bytes);
  if (d.stack) d.joined = mpmi_alloc(mesh->context, side_bytes);
  status = d.joined ? divide(&d, 0, (int32_t)mesh->elements) : MPM_E_NOMEM;
  mpmi_free(mesh->context, d.joined, side_bytes);
  mpmi_free(mesh->context, d.stack, side_bytes);
  return status;
}
