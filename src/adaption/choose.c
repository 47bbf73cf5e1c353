/* Which particles are split and which pairs are merged. The order of ids decides, so that nothing depends on
 * where particles lie in memory. */
#include <math.h>
#include <stdlib.h>

#include "adaption/adaption.h"
#include "context/radix.h"

typedef struct choice {
  mpmi_adaption *a;
  const mpm_particles *set;
  int32_t copy;
  mpm_status status;
  const double *x[3]; /* rows of positions */
} choice;

void mpmi_adaption_free(mpmi_adaption *a, mpm_context *context) {
  MPMI_FREE_ARRAY(context, a->split, a->split_capacity);
  MPMI_FREE_ARRAY(context, a->pair, a->pair_capacity);
  MPMI_FREE_ARRAY(context, a->merged, a->merged_capacity);
  MPMI_FREE_ARRAY(context, a->key, a->key_capacity);
  MPMI_FREE_ARRAY(context, a->order, a->order_capacity);
  MPMI_FREE_ARRAY(context, a->taken, a->taken_capacity);
  MPMI_FREE_ARRAY(context, a->stray, a->stray_capacity);
  MPMI_FREE_ARRAY(context, a->gone, a->gone_capacity);
  MPMI_FREE_ARRAY(context, a->away, a->away_capacity);
  *a = (mpmi_adaption){0};
}

double mpmi_edge_in_cells(const mpm_grid *grid, const double *edge) {
  double square = 0.0;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double cells = edge[k] * grid->inverse_spacing[k];
    square += cells * cells;
  }
  return sqrt(square);
}

/* ---- particles by cell -------------------------------------------------------------------------------- */
/* Numbers cells; two have the same number where a grid has more than 2^64 of them. */
static uint64_t cell_of(const choice *c, int64_t slot) {
  const mpm_grid *grid = c->set->grid;
  uint64_t cell = 0;
  for (int32_t k = 0; k < grid->dim; ++k)
    cell = cell * (uint64_t)grid->desc.cells[k] + (uint64_t)mpmi_cell_along(grid, k, c->x[k][slot]);
  return cell;
}

int32_t mpmi_adapts_slot(const mpm_particles *set, int32_t copy, int64_t slot) {
  const mpm_grid *grid = set->grid;
  int32_t inside = mpmi_i64(set, MPMI_ID, 0)[slot] >= 0;
  for (int32_t k = 0; k < grid->dim && inside; ++k) {
    const double x = mpmi_row_of(set, MPMI_POSITION, copy, k)[slot];
    inside = x >= grid->desc.origin[k] && x <= grid->upper[k];
  }
  return inside;
}

static int32_t is_chosen_here(const choice *c, int64_t slot) {
  const int32_t away = c->a->skips && slot < c->a->own && c->a->away[slot];
  return !away && mpmi_adapts_slot(c->set, c->copy, slot);
}

/* Lists the particles, by cell and in a cell by id where that is asked for: order[i] is the slot of the i-th.
 * Returns how many there are. */
static int64_t list(choice *c, int32_t by_cell) {
  mpmi_adaption *a = c->a;
  const int64_t slots = c->set->slots, *id = mpmi_i64(c->set, MPMI_ID, 0);
  uint64_t *key = a->key, *spare = a->key + slots;
  uint32_t *first = a->order, *order = a->order + slots, *scratch = a->order + 2 * slots;
  int64_t n = 0;
  for (int64_t s = 0; s < slots; ++s)
    if (is_chosen_here(c, s)) {
      first[n] = (uint32_t)s;
      key[n++] = (uint64_t)id[s];
    }
  for (int32_t round = 0; round < 2 * by_cell; ++round) {
    for (int64_t i = 0; i < n && round; ++i) key[i] = cell_of(c, first[i]);
    mpmi_radix_sort(n, key, order, spare, scratch);
    for (int64_t i = 0; i < n; ++i) scratch[i] = first[order[i]];
    for (int64_t i = 0; i < n; ++i) first[i] = scratch[i];
  }
  return n;
}

/* ---- splitting ---------------------------------------------------------------------------------------- */
/* Returns 1 where all that comes of a particle lies in the grid. */
static int32_t has_room(const choice *c, int64_t slot, int32_t edges) {
  const mpm_grid *grid = c->set->grid;
  double reach[3] = {0.0}, edge[3];
  for (int32_t a = 0; a < grid->dim; ++a) {
    if (!(edges & 1 << a)) continue;
    mpmi_domain_edge(c->set, c->copy, slot, a, edge);
    for (int32_t k = 0; k < grid->dim; ++k) reach[k] += 0.25 * fabs(edge[k]);
  }
  int32_t room = 1;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double x = c->x[k][slot];
    room &=
        grid->desc.periodic[k] || (x - reach[k] >= grid->desc.origin[k] && x + reach[k] <= grid->upper[k]);
  }
  return room;
}

/* Takes a particle with these edges; returns how many more there will be. */
static int64_t take_split(choice *c, int64_t slot, int32_t edges) {
  mpmi_adaption *a = c->a;
  if (!edges || a->taken[slot] || !has_room(c, slot, edges) || c->status) return 0;
  c->status = MPMI_RESERVE_NEXT(c->set->context, a->split, a->split_capacity, a->splits);
  if (c->status) return 0;
  a->split[a->splits++] = (mpmi_splitting){mpmi_i64(c->set, MPMI_ID, 0)[slot], slot, edges, 0};
  a->taken[slot] = (uint8_t)mpmi_parts_of(edges);
  return mpmi_parts_of(edges) - 1;
}

/* Returns the edges of a particle that are too long, and with `one` at least the longest; none becomes
 * shorter than the least. */
static int32_t edges_of(const choice *c, int64_t slot, int32_t one) {
  const mpm_adaption_desc *desc = &c->a->desc;
  double longest = 0.0, edge[3];
  int32_t edges = 0, the_longest = 0;
  for (int32_t a = 0; a < c->set->grid->dim; ++a) {
    mpmi_domain_edge(c->set, c->copy, slot, a, edge);
    const double length = mpmi_edge_in_cells(c->set->grid, edge);
    if (0.5 * length < desc->least_edge) continue;
    if (desc->split_edge > 0.0 && length > desc->split_edge) edges |= 1 << a;
    if (length > longest) longest = length, the_longest = 1 << a;
  }
  return edges || !one ? edges : the_longest;
}

static void split_long(choice *c, const uint32_t *slot, int64_t n) {
  for (int64_t i = 0; i < n && c->a->desc.split_edge > 0.0; ++i)
    take_split(c, slot[i], edges_of(c, slot[i], 0));
}

static void split_few(choice *c, const uint32_t *slot, int64_t n) {
  int64_t count = n;
  for (int64_t i = 0; i < n; ++i)
    if (c->a->taken[slot[i]] > 1) count += c->a->taken[slot[i]] - 1;
  for (int64_t i = 0; i < n && count < c->a->desc.min_per_cell; ++i)
    count += take_split(c, slot[i], edges_of(c, slot[i], 1));
}

/* ---- merging ------------------------------------------------------------------------------------------ */
/* Returns the distance in cells; HUGE_VAL where one axis alone makes it longer than the bound, as it does for
 * most pairs of a full cell. */
static double distance_in_cells(const choice *c, int64_t s, int64_t t, double bound) {
  const mpm_grid *grid = c->set->grid;
  double way[3];
  for (int32_t k = 0; k < grid->dim; ++k) {
    way[k] = c->x[k][t] - c->x[k][s];
    if (fabs(way[k] * grid->inverse_spacing[k]) > bound) return HUGE_VAL;
  }
  return mpmi_edge_in_cells(grid, way);
}

static int32_t same_words(const choice *c, int32_t field, int64_t s, int64_t t) {
  const mpmi_field *at = &c->set->field[field];
  const size_t size = mpmi_type_size(at->type);
  const char *data = at->data[at->two_copies ? c->copy : 0];
  for (int32_t k = 0; at->present && k < at->components; ++k)
    if (memcmp(data + (size_t)(k * c->set->ld + s) * size, data + (size_t)(k * c->set->ld + t) * size,
               size) != 0)
      return 0;
  return 1;
}

/* Returns 1 for particles that deform alike and that nothing sets apart. The law is asked later. */
static int32_t deform_alike(const choice *c, int64_t s, int64_t t) {
  double unlike = 0.0, norm[2] = {0.0, 0.0};
  for (int32_t e = 0; e < mpmi_tensor_components(c->set->grid->dim); ++e) {
    const double *F = mpmi_row_of(c->set, MPMI_F, c->copy, e);
    unlike += (F[s] - F[t]) * (F[s] - F[t]);
    norm[0] += F[s] * F[s];
    norm[1] += F[t] * F[t];
  }
  const double larger = norm[0] > norm[1] ? norm[0] : norm[1];
  int32_t alike = sqrt(unlike) <= c->a->desc.merge_tolerance * sqrt(larger);
  for (int32_t k = 0; k < c->set->grid->dim; ++k) {
    const double *v = mpmi_row_of(c->set, MPMI_VELOCITY, c->copy, k);
    alike &= !mpmi_keeps_velocity(c->set, s, k) || !(v[s] < v[t] || v[s] > v[t]);
  }
  return alike && same_words(c, MPMI_PRESCRIBED, s, t) && same_words(c, MPMI_IMAGE, s, t);
}

/* The heavier one stays, of two equal ones that with the lower id, which is s. */
static void take_pair(choice *c, int64_t s, int64_t t) {
  mpmi_adaption *a = c->a;
  const double *mass = mpmi_f64(c->set, MPMI_MASS, 0);
  const int64_t *id = mpmi_i64(c->set, MPMI_ID, 0);
  const int64_t stays = mass[t] > mass[s] ? t : s, goes = stays == s ? t : s;
  if (!c->status) c->status = MPMI_RESERVE_NEXT(c->set->context, a->pair, a->pair_capacity, a->pairs);
  if (c->status) return;
  a->pair[a->pairs++] = (mpmi_merging){.id = id[stays], .other = id[goes], .stays = stays, .goes = goes};
  a->taken[s] = a->taken[t] = 1;
}

static void pair_up(choice *c, const uint32_t *slot, int64_t n) {
  mpmi_adaption *a = c->a;
  int64_t surplus = a->desc.max_per_cell > 0 ? n - a->desc.max_per_cell : 0;
  for (int64_t i = 0; i < n && surplus > 0; ++i) {
    double nearest = a->desc.merge_distance;
    int64_t with = -1;
    for (int64_t j = i + 1; j < n && !a->taken[slot[i]]; ++j) {
      if (a->taken[slot[j]]) continue;
      const double away = distance_in_cells(c, slot[i], slot[j], nearest);
      if (away > nearest || (with >= 0 && away >= nearest) || !deform_alike(c, slot[i], slot[j])) continue;
      nearest = away;
      with = slot[j];
    }
    if (with < 0) continue;
    take_pair(c, slot[i], with);
    --surplus;
  }
}

/* ---- both --------------------------------------------------------------------------------------------- */
static int compare_splits(const void *a, const void *b) {
  const int64_t x = ((const mpmi_splitting *)a)->id, y = ((const mpmi_splitting *)b)->id;
  return x < y ? -1 : x > y;
}

static int compare_pairs(const void *a, const void *b) {
  const int64_t x = ((const mpmi_merging *)a)->id, y = ((const mpmi_merging *)b)->id;
  return x < y ? -1 : x > y;
}

mpm_status mpmi_adaption_choose(mpmi_adaption *a, const mpm_particles *set, int32_t copy) {
  choice c = {a, set, copy, MPM_OK, {NULL}};
  mpm_context *context = set->context;
  const int32_t by_cell = a->desc.min_per_cell > 0 || a->desc.max_per_cell > 0;
  a->splits = a->pairs = 0;
  if (!set->slots || !(by_cell || a->desc.split_edge > 0.0)) return MPM_OK;
  mpm_status status = MPMI_RESERVE_MORE(context, a->key, a->key_capacity, 2 * set->slots);
  if (!status) status = MPMI_RESERVE_MORE(context, a->order, a->order_capacity, 3 * set->slots);
  if (!status) status = MPMI_RESERVE_MORE(context, a->taken, a->taken_capacity, set->slots);
  if (status) return status;
  memset(a->taken, 0, (size_t)set->slots);
  for (int32_t k = 0; k < set->grid->dim; ++k) c.x[k] = mpmi_row_of(set, MPMI_POSITION, copy, k);
  const int64_t n = list(&c, by_cell);
  split_long(&c, a->order, n);
  for (int64_t begin = 0, end; begin < n && by_cell; begin = end) {
    const uint64_t cell = cell_of(&c, a->order[begin]);
    for (end = begin + 1; end < n && cell_of(&c, a->order[end]) == cell;) ++end;
    split_few(&c, a->order + begin, end - begin);
    pair_up(&c, a->order + begin, end - begin);
  }
  if (a->splits) qsort(a->split, (size_t)a->splits, sizeof *a->split, compare_splits);
  if (a->pairs) qsort(a->pair, (size_t)a->pairs, sizeof *a->pair, compare_pairs);
  return c.status;
}
