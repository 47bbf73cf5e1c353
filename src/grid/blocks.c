#include "grid/blocks.h"
#include "context/radix.h"
#include "simd/rounding.h"

#include <math.h>
#include <string.h>

/* Block coordinates start at -1 (ghost nodes) or -2 (periodic halo of the first block), and are shifted to
 * be positive. */
enum { COORD_SHIFT = 4, FIRST_CAPACITY = 64 };

static uint64_t spread(uint64_t v, int32_t dim) {
  if (dim == 1) return v;
  if (dim == 2) {
    v &= 0xffffffffu;
    v = (v | v << 16) & 0x0000ffff0000ffffu;
    v = (v | v << 8) & 0x00ff00ff00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0f0f0f0f0fu;
    v = (v | v << 2) & 0x3333333333333333u;
    return (v | v << 1) & 0x5555555555555555u;
  }
  v &= 0x1fffffu;
  v = (v | v << 32) & 0x001f00000000ffffu;
  v = (v | v << 16) & 0x001f0000ff0000ffu;
  v = (v | v << 8) & 0x100f00f00f00f00fu;
  v = (v | v << 4) & 0x10c30c30c30c30c3u;
  return (v | v << 2) & 0x1249249249249249u;
}

static uint64_t morton(const int32_t *coord, int32_t dim) {
  uint64_t key = 0;
  for (int32_t k = 0; k < dim; ++k)
    key |= spread((uint64_t)(uint32_t)(coord[k] + COORD_SHIFT), dim) << (dim - 1 - k);
  return key;
}

uint64_t mpmi_block_key(const mpm_grid *grid, const int32_t *coord) {
  return morton(coord, grid->dim);
}

static uint64_t hash(uint64_t key, int32_t body) {
  key = (key ^ (uint64_t)body * 0xd6e8feb86659fd93u) * 0x9e3779b97f4a7c15u;
  return key ^ (key >> 29);
}

void mpmi_blocks_init(mpmi_blocks *b, const mpm_grid *grid) {
  memset(b, 0, sizeof *b);
  b->grid = grid;
  b->context = grid->context;
  b->edge = MPMI_BLOCK_EDGE(grid->dim);
  b->nodes = b->neighbours = 1;
  for (int32_t k = 0; k < grid->dim; ++k) {
    b->nodes *= b->edge;
    b->neighbours *= 3;
  }
}

/* This lists every array of the structure with its size per block, so that allocation, release and growth
 * are one loop each. */
enum { ARRAYS = 11 };
typedef struct block_array {
  void **at;
  size_t size;
} block_array;
static void arrays_of(mpmi_blocks *b, block_array *a) {
  const block_array list[ARRAYS] = {
      {(void **)&b->key, sizeof *b->key},
      {(void **)&b->cover, sizeof *b->cover},
      {(void **)&b->reached, sizeof *b->reached},
      {(void **)&b->body, sizeof *b->body},
      {(void **)&b->coord, sizeof *b->coord},
      {(void **)&b->neighbour, sizeof *b->neighbour},
      {(void **)&b->order, sizeof *b->order},
      {(void **)&b->order_scratch, sizeof *b->order_scratch},
      {(void **)&b->key_scratch, sizeof *b->key_scratch},
      {(void **)&b->body_scratch, sizeof *b->body_scratch},
      {(void **)&b->coord_scratch, sizeof *b->coord_scratch},
  };
  memcpy(a, list, sizeof list);
}

void mpmi_blocks_free(mpmi_blocks *b) {
  block_array a[ARRAYS];
  arrays_of(b, a);
  for (int32_t i = 0; i < ARRAYS; ++i) {
    mpmi_free(b->context, *a[i].at, mpmi_bytes(b->capacity, a[i].size));
    *a[i].at = NULL;
  }
  MPMI_FREE_ARRAY(b->context, b->table_key, b->table_size);
  MPMI_FREE_ARRAY(b->context, b->table_block, b->table_size);
  b->table_key = NULL;
  b->table_block = NULL;
  b->capacity = b->table_size = b->count = 0;
}

static void table_put(mpmi_blocks *b, int32_t block) {
  const uint64_t key = b->key[block], mask = (uint64_t)b->table_size - 1;
  uint64_t at = hash(key, b->body[block]) & mask;
  while (b->table_block[at] >= 0) at = (at + 1) & mask;
  b->table_key[at] = key;
  b->table_block[at] = block;
}

static int32_t table_get(const mpmi_blocks *b, int32_t body, uint64_t key) {
  if (!b->table_size) return MPMI_NO_BLOCK;
  const uint64_t mask = (uint64_t)b->table_size - 1;
  for (uint64_t at = hash(key, body) & mask; b->table_block[at] >= 0; at = (at + 1) & mask)
    if (b->table_key[at] == key && b->body[b->table_block[at]] == body) return b->table_block[at];
  return MPMI_NO_BLOCK;
}

static void table_fill(mpmi_blocks *b) {
  for (int64_t i = 0; i < b->table_size; ++i) b->table_block[i] = MPMI_NO_BLOCK;
  for (int64_t i = 0; i < b->count; ++i) table_put(b, (int32_t)i);
}

void mpmi_blocks_clear(mpmi_blocks *b) {
  b->count = 0;
  for (int64_t i = 0; i < b->table_size; ++i) b->table_block[i] = MPMI_NO_BLOCK;
}

static mpm_status grow(mpmi_blocks *b) {
  mpmi_blocks next = *b;
  next.capacity = b->capacity ? 2 * b->capacity : FIRST_CAPACITY;
  next.table_size = 4 * next.capacity;
  if (next.capacity > INT32_MAX / 8)
    return mpmi_fail(b->context, MPM_E_NOMEM, "the material covers more than %d blocks of the grid",
                     INT32_MAX / 8);
  block_array from[ARRAYS], to[ARRAYS];
  arrays_of(b, from);
  arrays_of(&next, to);
  for (int32_t i = 0; i < ARRAYS; ++i) *to[i].at = NULL;
  next.table_key = NULL;
  next.table_block = NULL;
  mpm_status failed = MPM_OK;
  for (int32_t i = 0; i < ARRAYS && !failed; ++i) {
    *to[i].at = mpmi_alloc(b->context, mpmi_bytes(next.capacity, to[i].size));
    if (!*to[i].at) failed = MPM_E_NOMEM;
  }
  if (!failed) next.table_key = mpmi_alloc(b->context, mpmi_bytes(next.table_size, sizeof *next.table_key));
  if (!failed && next.table_key)
    next.table_block = mpmi_alloc(b->context, mpmi_bytes(next.table_size, sizeof *next.table_block));
  if (failed || !next.table_block) {
    mpmi_blocks_free(&next);
    return MPM_E_NOMEM;
  }
  for (int32_t i = 0; i < ARRAYS; ++i)
    if (b->count) memcpy(*to[i].at, *from[i].at, (size_t)b->count * from[i].size);
  const int64_t count = b->count;
  mpmi_blocks_free(b);
  *b = next;
  b->count = count;
  table_fill(b);
  return MPM_OK;
}

mpm_status mpmi_blocks_insert(mpmi_blocks *b, int32_t body, const int32_t *coord, int32_t *block) {
  const int32_t dim = b->grid->dim;
  const uint64_t key = morton(coord, dim);
  *block = table_get(b, body, key);
  if (*block >= 0) return MPM_OK;
  if (b->count == b->capacity) {
    mpm_status status = grow(b);
    if (status) return status;
  }
  *block = (int32_t)b->count;
  for (int32_t k = 0; k < 3; ++k) b->coord[b->count][k] = k < dim ? coord[k] : 0;
  b->key[b->count] = key;
  b->body[b->count] = body;
  ++b->count;
  table_put(b, *block);
  return MPM_OK;
}

int32_t mpmi_blocks_find(const mpmi_blocks *b, int32_t body, const int32_t *coord) {
  return table_get(b, body, morton(coord, b->grid->dim));
}

static int64_t floor_div(int64_t a, int64_t b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

static void neighbour_coord(const int32_t *coord, int32_t which, int32_t dim, int32_t *out) {
  for (int32_t k = dim - 1; k >= 0; --k) {
    out[k] = coord[k] + which % 3 - 1;
    which /= 3;
  }
}

/* Inserts the blocks that hold the periodic originals of this block's nodes. */
static mpm_status insert_originals(mpmi_blocks *b, int64_t of) {
  const mpm_grid *grid = b->grid;
  int32_t choice[3][8], choices[3] = {1, 1, 1}, coord[3], unused;
  int32_t outside = 0;
  for (int32_t k = 0; k < grid->dim; ++k) {
    choice[k][0] = b->coord[of][k];
    const int64_t cells = grid->desc.cells[k], first = (int64_t)b->coord[of][k] * b->edge;
    if (!grid->desc.periodic[k] || (first >= 0 && first + b->edge <= cells)) continue;
    outside = 1;
    choices[k] = 0;
    for (int64_t node = first; node < first + b->edge; ++node) {
      const int32_t at = (int32_t)((node - floor_div(node, cells) * cells) / b->edge);
      int32_t known = 0;
      for (int32_t i = 0; i < choices[k]; ++i) known |= choice[k][i] == at;
      /* The nodes within reach of a stencil lie in at most three blocks on either side of the seam. */
      if (!known && choices[k] < 8) choice[k][choices[k]++] = at;
    }
  }
  if (!outside) return MPM_OK;
  for (int32_t i = 0; i < choices[0]; ++i)
    for (int32_t j = 0; j < choices[1]; ++j)
      for (int32_t l = 0; l < choices[2]; ++l) {
        coord[0] = choice[0][i];
        if (grid->dim > 1) coord[1] = choice[1][j];
        if (grid->dim > 2) coord[2] = choice[2][l];
        mpm_status status = mpmi_blocks_insert(b, b->body[of], coord, &unused);
        if (status) return status;
      }
  return MPM_OK;
}

/* Puts blocks at one place in the order of their bodies: place[i] is the block that is i-th by place. */
static void order_bodies(const mpmi_blocks *b, uint32_t *place) {
  for (int64_t i = 1; i < b->count; ++i) {
    const uint32_t block = place[i];
    int64_t at = i;
    while (at > 0 && memcmp(b->coord[place[at - 1]], b->coord[block], sizeof *b->coord) == 0 &&
           b->body[place[at - 1]] > b->body[block]) {
      place[at] = place[at - 1];
      --at;
    }
    place[at] = block;
  }
}

static void sort_blocks(mpmi_blocks *b) {
  mpmi_radix_sort(b->count, b->key, b->order_scratch, b->key_scratch, b->order);
  order_bodies(b, b->order_scratch);
  memcpy(b->coord_scratch, b->coord, (size_t)b->count * sizeof *b->coord);
  memcpy(b->body_scratch, b->body, (size_t)b->count * sizeof *b->body);
  for (int64_t i = 0; i < b->count; ++i) {
    const uint32_t from = b->order_scratch[i];
    memcpy(b->coord[i], b->coord_scratch[from], sizeof *b->coord);
    b->body[i] = b->body_scratch[from];
    b->order[from] = (uint32_t)i;
    b->key[i] = morton(b->coord[i], b->grid->dim);
  }
}

mpm_status mpmi_blocks_order(mpmi_blocks *b) {
  const int32_t dim = b->grid->dim;
  const int64_t with_particles = b->count;
  int32_t coord[3], unused;
  mpm_status status;
  for (int64_t i = 0; i < with_particles; ++i)
    for (int32_t n = 0; n < b->neighbours; ++n) {
      neighbour_coord(b->coord[i], n, dim, coord);
      if ((status = mpmi_blocks_insert(b, b->body[i], coord, &unused))) return status;
    }
  const int64_t with_halo = b->count;
  for (int64_t i = 0; i < with_halo; ++i)
    if ((status = insert_originals(b, i))) return status;

  if (!b->count) return MPM_OK;
  sort_blocks(b);
  table_fill(b);
  for (int64_t i = 0; i < b->count; ++i)
    for (int32_t n = 0; n < b->neighbours; ++n) {
      neighbour_coord(b->coord[i], n, dim, coord);
      b->neighbour[i][n] = mpmi_blocks_find(b, b->body[i], coord);
    }
  return MPM_OK;
}

/* Returns the nearest node as the kernel of the basis has it. */
static double nearest_node(const mpm_grid *grid, double xi) {
  if (!mpmi_is_total_lagrangian(grid) || grid->family != MPMI_FAMILY_BSPLINE2) return floor(xi + 0.5);
  const double nearest = mpmi_round(xi);
  return mpmi_even_of(nearest, xi - nearest);
}

int32_t mpmi_anchor(const mpm_grid *grid, int32_t axis, double x) {
  const double xi = (x - grid->desc.origin[axis]) * grid->inverse_spacing[axis];
  const int64_t cells = grid->desc.cells[axis];
  /* a position that a host has spoilt behind the library's back has no anchor: any will do */
  const double place = grid->centred ? nearest_node(grid, xi) : floor(xi), far = 1e15;
  int64_t node = (int64_t)(!(place > -far) ? -far : place < far ? place : far);
  if (grid->desc.periodic[axis]) node -= floor_div(node, cells) * cells;
  const int64_t high = grid->centred ? cells : cells - 1;
  return (int32_t)(node < 0 ? 0 : node > high ? high : node);
}

void mpmi_blocks_of_position(const mpm_grid *grid, const double *x, int64_t stride, int32_t edge,
                             int32_t *coord) {
  for (int32_t k = 0; k < grid->dim; ++k) {
    coord[k] = mpmi_anchor(grid, k, x[k * stride]) / edge;
  }
}

int64_t mpmi_blocks_node(const mpmi_blocks *b, int32_t body, const int64_t *index) {
  int32_t coord[3];
  int64_t place = 0;
  for (int32_t k = 0; k < b->grid->dim; ++k) {
    coord[k] = (int32_t)floor_div(index[k], b->edge);
    place = place * b->edge + (index[k] - (int64_t)coord[k] * b->edge);
  }
  const int32_t block = mpmi_blocks_find(b, body, coord);
  return block < 0 ? -1 : (int64_t)block * b->nodes + place;
}

int64_t mpmi_blocks_near(const mpmi_blocks *b, int64_t block, const int32_t *at) {
  int32_t n = 0, place = 0;
  for (int32_t k = 0; k < b->grid->dim; ++k) {
    const int32_t side = at[k] < 0 ? 0 : at[k] >= b->edge ? 2 : 1;
    n = 3 * n + side;
    place = place * b->edge + at[k] - (side - 1) * b->edge;
  }
  const int32_t other = b->neighbour[block][n];
  return other == MPMI_NO_BLOCK ? -1 : (int64_t)other * b->nodes + place;
}

int64_t mpmi_blocks_beside(const mpmi_blocks *b, int64_t slot, const int32_t *offset) {
  int32_t place = (int32_t)(slot % b->nodes), at[3];
  for (int32_t k = b->grid->dim - 1; k >= 0; --k) {
    at[k] = place % b->edge + offset[k];
    place /= b->edge;
  }
  return mpmi_blocks_near(b, slot / b->nodes, at);
}

int64_t mpmi_blocks_around(const mpmi_blocks *b, int64_t slot, const int32_t *offset) {
  const int64_t near = mpmi_blocks_beside(b, slot, offset);
  int64_t index[3], moved = 0;
  if (near >= 0) return near;
  mpmi_blocks_index(b, slot, index);
  for (int32_t k = 0; k < b->grid->dim; ++k) {
    const int64_t cells = b->grid->desc.cells[k], at = index[k] + offset[k];
    index[k] = b->grid->desc.periodic[k] ? at - floor_div(at, cells) * cells : at;
    moved |= index[k] - at;
  }
  return moved ? mpmi_blocks_node(b, b->body[slot / b->nodes], index) : -1;
}

void mpmi_blocks_index(const mpmi_blocks *b, int64_t slot, int64_t *index) {
  const int64_t block = slot / b->nodes;
  int64_t place = slot % b->nodes;
  for (int32_t k = b->grid->dim - 1; k >= 0; --k) {
    index[k] = (int64_t)b->coord[block][k] * b->edge + place % b->edge;
    place /= b->edge;
  }
}

int64_t mpmi_blocks_number(const mpmi_blocks *b, int64_t slot) {
  int64_t index[3];
  mpmi_blocks_index(b, slot, index);
  for (int32_t k = 0; k < b->grid->dim; ++k)
    if (b->grid->desc.periodic[k])
      index[k] -= floor_div(index[k], b->grid->desc.cells[k]) * b->grid->desc.cells[k];
  return mpmi_node_number(b->grid, index);
}
