/* Which blocks of other parts share nodes with one's own.
 *
 * A block with particles reaches the nodes of its tile. The part that has it wants the sums on these nodes
 * to be whole, on those that are tied to them by walls and periods, and on `margin` more around them: that
 * is what the block wants. A block of another part whose tile meets that is a ghost here; its owner sends
 * what its particles give there. Each part finds out by itself what it has to send and what will come, once
 * it knows the blocks of the others that are near its own.
 *
 * Where bodies have nodes of their own, they may meet at these: a block wants those of all bodies. */
#include "parallel/parts.h"

#include <string.h>

/* Nodes beyond a wall are so far from it, at most, and so are those that they mirror. */
enum { BEYOND_WALL = 4 };

/* A stretch of nodes along an axis, by index: low <= i < high. */
typedef struct stretch {
  int64_t low, high;
} stretch;

static stretch tile_of(const mpmi_parts *parts, int64_t coord) {
  const mpm_grid *grid = parts->grid;
  const int64_t low = coord * MPMI_BLOCK_EDGE(grid->dim) - MPMI_RING - grid->below;
  return (stretch){low, low + MPMI_BLOCK_EDGE(grid->dim) + 2 * MPMI_RING + grid->width - 1};
}

/* Returns the nodes of a tile and those within a margin around it, to the mirror images behind a wall. */
static stretch around(const mpmi_parts *parts, int32_t axis, int64_t coord, int32_t margin) {
  const int64_t cells = parts->grid->desc.cells[axis];
  stretch s = tile_of(parts, coord);
  s.low -= margin;
  s.high += margin;
  if (parts->grid->desc.periodic[axis]) return s;
  if (s.low < BEYOND_WALL && s.low > -BEYOND_WALL) s.low = -BEYOND_WALL;
  if (s.high > cells - BEYOND_WALL && s.high <= cells + BEYOND_WALL) s.high = cells + BEYOND_WALL + 1;
  return s;
}

static stretch wanted_by(const mpmi_parts *parts, int32_t axis, int64_t coord) {
  return around(parts, axis, coord, parts->margin);
}

static stretch meet(stretch a, stretch b) {
  return (stretch){a.low > b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}

/* A place along an axis where a block may be that is near another; over a period the other one stands `shift`
 * nodes further on. */
enum { MOST_PLACES = 24 };
typedef struct place {
  int64_t coord, shift;
  int32_t wants, wanted; /* the block there wants nodes of this one's tile; the other way round */
} place;

static int32_t places_near(const mpmi_parts *parts, int32_t axis, int64_t coord, place *out) {
  const mpm_grid *grid = parts->grid;
  const int64_t edge = MPMI_BLOCK_EDGE(grid->dim), cells = grid->desc.cells[axis], last = cells / edge;
  const int32_t periodic = grid->desc.periodic[axis] != 0;
  const stretch tile = tile_of(parts, coord), wants = wanted_by(parts, axis, coord);
  int32_t count = 0;
  for (int64_t turn = -periodic; turn <= periodic; ++turn) {
    const int64_t shift = turn * cells,
                  reach = edge + grid->width + 2 * MPMI_RING + 2 * BEYOND_WALL + parts->margin;
    int64_t low = (coord * edge + shift - reach) / edge - 1, high = (coord * edge + shift + reach) / edge + 1;
    low = low < 0 ? 0 : low;
    high = high > last ? last : high;
    for (int64_t at = low; at <= high; ++at) {
      const stretch its_tile = tile_of(parts, at), its_wants = wanted_by(parts, axis, at);
      const stretch mine = {tile.low + shift, tile.high + shift},
                    asked = {wants.low + shift, wants.high + shift};
      const stretch a = meet(mine, its_wants), b = meet(asked, its_tile);
      const place p = {at, shift, a.low < a.high, b.low < b.high};
      if ((p.wants || p.wanted) && count < MOST_PLACES) out[count++] = p;
    }
  }
  return count;
}

/* Calls fn for every place near a block. */
typedef struct nearby {
  mpmi_parts *parts;
  const mpmi_blocks *blocks;
  int32_t coord[3];
  void *user;
} nearby;
typedef void (*near_fn)(nearby *n, const int32_t *coord, const place *const *at);

static void each_near(nearby *n, near_fn fn) {
  place list[3][MOST_PLACES];
  int32_t count[3] = {1, 1, 1};
  const int32_t dim = n->parts->grid->dim;
  for (int32_t k = 0; k < 3; ++k) {
    list[k][0] = (place){0, 0, 1, 1};
    if (k < dim) count[k] = places_near(n->parts, k, n->coord[k], list[k]);
  }
  for (int32_t i = 0; i < count[0]; ++i)
    for (int32_t j = 0; j < count[1]; ++j)
      for (int32_t l = 0; l < count[2]; ++l) {
        const place *at[3] = {&list[0][i], &list[1][j], &list[2][l]};
        const int32_t coord[3] = {(int32_t)at[0]->coord, (int32_t)at[1]->coord, (int32_t)at[2]->coord};
        fn(n, coord, at);
      }
}

static int32_t all_want(const place *const *at) {
  return at[0]->wants && at[1]->wants && at[2]->wants;
}
static int32_t all_wanted(const place *const *at) {
  return at[0]->wanted && at[1]->wanted && at[2]->wanted;
}

/* ---- who is near --------------------------------------------------------------------------------------- */
/* What parts tell each other of their blocks. */
typedef struct told_block {
  int32_t coord[3], body;
} told_block;

typedef struct telling {
  told_block block;
  int64_t number; /* of the block, from 1: the last that a part was told is its owner_count */
  mpm_status status;
} telling;

/* Tells a block to the part that has a place near it, once. */
static void tell_owner(nearby *n, const int32_t *coord, const place *const *at) {
  telling *t = n->user;
  if (t->status || (!all_want(at) && !all_wanted(at))) return;
  mpm_context *c = n->parts->context;
  const int32_t owner = mpmi_cut_owner(n->parts, mpmi_block_key(n->parts->grid, coord));
  if (owner == c->transport.part || n->parts->owner_count[owner] == t->number) return;
  n->parts->owner_count[owner] = t->number;
  void *to = mpmi_buffer_take(c, &n->parts->out[owner], sizeof t->block);
  if (to) memcpy(to, &t->block, sizeof t->block);
  t->status = to ? MPM_OK : MPM_E_NOMEM;
}

static mpm_status tell(mpmi_parts *parts, const mpmi_blocks *blocks) {
  telling t = {.number = 1};
  memset(parts->owner_count, 0, (size_t)mpmi_part_count(parts) * sizeof *parts->owner_count);
  for (; t.number <= blocks->count && !t.status; ++t.number) {
    const int64_t i = t.number - 1;
    nearby n = {parts, blocks, {blocks->coord[i][0], blocks->coord[i][1], blocks->coord[i][2]}, &t};
    t.block = (told_block){{n.coord[0], n.coord[1], n.coord[2]}, blocks->body[i]};
    each_near(&n, tell_owner);
  }
  return t.status;
}

/* ---- what is sent and what comes ----------------------------------------------------------------------- */
/* Looks for blocks of any body near one whose numbers are in [first, end): `wants` says that one wants
 * something of it, and the box says what; `wanted` the other way round. */
typedef struct search {
  int64_t first, end;
  int32_t wants, wanted;
  mpmi_node_box box; /* in the tile of the one that is searched around */
} search;

static int32_t is_there(const nearby *n, const search *s, const int32_t *coord) {
  for (int32_t i = 0; i < n->parts->body_count; ++i) {
    const int32_t found = mpmi_blocks_find(n->blocks, n->parts->body[i], coord);
    if (found >= s->first && found < s->end) return 1;
  }
  return 0;
}

static void look_up(nearby *n, const int32_t *coord, const place *const *at) {
  search *s = n->user;
  if ((!all_want(at) && !all_wanted(at)) || !is_there(n, s, coord)) return;
  s->wanted |= all_wanted(at);
  if (!all_want(at)) return;
  s->wants = 1;
  for (int32_t k = 0; k < n->parts->grid->dim; ++k) {
    const stretch tile = tile_of(n->parts, n->coord[k]);
    const stretch w = wanted_by(n->parts, k, at[k]->coord);
    const stretch both = meet(tile, (stretch){w.low - at[k]->shift, w.high - at[k]->shift});
    if (both.low - tile.low < s->box.low[k]) s->box.low[k] = (uint8_t)(both.low - tile.low);
    if (both.high - tile.low > s->box.high[k]) s->box.high[k] = (uint8_t)(both.high - tile.low);
  }
}

static search look_around(mpmi_parts *parts, const mpmi_blocks *blocks, const told_block *block,
                          int64_t first, int64_t end) {
  search s = {first, end, 0, 0, {{255, 255, 255}, {0, 0, 0}}};
  nearby n = {parts, blocks, {block->coord[0], block->coord[1], block->coord[2]}, &s};
  each_near(&n, look_up);
  for (int32_t k = parts->grid->dim; k < 3; ++k) s.box.low[k] = 0, s.box.high[k] = 1;
  return s;
}

/* Inserts those of a partner's blocks that are near, in its order. [first, end) are then their numbers. */
static mpm_status insert_ghosts(mpmi_parts *parts, mpmi_blocks *blocks, int64_t own, int32_t partner,
                                const mpm_message *in) {
  const told_block *told = in->data;
  const int64_t count = in->bytes / (int64_t)sizeof *told;
  for (int64_t i = 0; i < count; ++i) {
    /* seen from the ghost: an own block wants of its tile, or it wants of an own one */
    const search s = look_around(parts, blocks, &told[i], 0, own);
    if (!s.wants && !s.wanted) continue;
    int32_t block;
    mpm_status status = mpmi_blocks_insert(blocks, told[i].body, told[i].coord, &block);
    if (!status && s.wants)
      status = MPMI_RESERVE_NEXT(parts->context, parts->ghost, parts->ghost_capacity, parts->ghost_count);
    if (status) return status;
    if (s.wants) parts->ghost[parts->ghost_count++] = (mpmi_shared_block){block, partner, s.box, NULL, NULL};
  }
  return MPM_OK;
}

/* Lists what a partner wants of the blocks that were told it. */
static mpm_status list_sent(mpmi_parts *parts, const mpmi_blocks *blocks, int32_t partner, int64_t first,
                            const mpmi_buffer *out) {
  const told_block *told = (const void *)out->at;
  const int64_t count = out->used / (int64_t)sizeof *told, end = blocks->count;
  for (int64_t i = 0; i < count; ++i) {
    const search s = look_around(parts, blocks, &told[i], first, end);
    if (!s.wants) continue;
    const mpm_status status =
        MPMI_RESERVE_NEXT(parts->context, parts->sent, parts->sent_capacity, parts->sent_count);
    if (status) return status;
    parts->sent[parts->sent_count++] = (mpmi_shared_block){
        mpmi_blocks_find(blocks, told[i].body, told[i].coord), partner, s.box, NULL, NULL};
  }
  return MPM_OK;
}

static mpm_status add_partner(mpmi_parts *parts, mpmi_blocks *blocks, int64_t own, const mpm_message *in) {
  const int64_t first = blocks->count;
  mpm_status status =
      MPMI_RESERVE_NEXT(parts->context, parts->partner, parts->partner_capacity, parts->partner_count);
  if (status) return status;
  mpmi_partner p = {.part = in->part, .first_sent = parts->sent_count, .first_ghost = parts->ghost_count};
  if ((status = insert_ghosts(parts, blocks, own, (int32_t)parts->partner_count, in)) ||
      (status = list_sent(parts, blocks, (int32_t)parts->partner_count, first, &parts->out[in->part])))
    return status;
  p.sent = parts->sent_count - p.first_sent;
  p.ghosts = parts->ghost_count - p.first_ghost;
  if (p.sent || p.ghosts) parts->partner[parts->partner_count++] = p;
  return MPM_OK;
}

mpm_status mpmi_pattern_find(mpmi_parts *parts, mpmi_blocks *blocks, mpm_status status) {
  const int64_t own = blocks->count;
  mpmi_arrivals in;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) parts->out[r].used = 0;
  if (!status) status = tell(parts, blocks);
  const mpm_status lost = mpmi_parts_exchange(parts, &in);
  if (lost) return lost;
  parts->partner_count = parts->sent_count = parts->ghost_count = 0;
  for (int32_t i = 0; i < in.count && !status; ++i) status = add_partner(parts, blocks, own, &in.message[i]);
  parts->info.neighbours = (int32_t)parts->partner_count;
  parts->info.blocks = own;
  parts->info.ghosts = parts->ghost_count;
  return status;
}

/* ---- nodes --------------------------------------------------------------------------------------------- */
/* Flags the nodes of a body's block that lie in a box; part: whose tile the box is, or -1. */
static void flag_block(const mpmi_parts *parts, const mpmi_blocks *blocks, int64_t block, const stretch *box,
                       uint8_t flag, int32_t part) {
  int64_t low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
  const int32_t dim = blocks->grid->dim, edge = blocks->edge;
  for (int32_t k = 0; k < dim; ++k) {
    const int64_t first = (int64_t)blocks->coord[block][k] * edge;
    const stretch both = meet(box[k], (stretch){first, first + edge});
    low[3 - dim + k] = both.low - first;
    high[3 - dim + k] = both.high - first;
  }
  for (int64_t x = low[0]; x < high[0]; ++x)
    for (int64_t y = low[1]; y < high[1]; ++y)
      for (int64_t z = low[2]; z < high[2]; ++z) {
        const int64_t slot = block * blocks->nodes + (x * edge + y) * edge + z;
        parts->flags[slot] |= flag;
        if (parts->names_owners && part >= 0 && part < parts->lowest[slot]) parts->lowest[slot] = part;
      }
}

static int64_t block_at(const mpmi_blocks *blocks, int64_t node) {
  return node >= 0 ? node / blocks->edge : -((blocks->edge - 1 - node) / blocks->edge);
}

/* Flags the nodes of a body in a box. */
static void flag_box(const mpmi_parts *parts, const mpmi_blocks *blocks, int32_t body, const stretch *box,
                     int32_t flag, int32_t part) {
  int64_t low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (int32_t k = 0; k < blocks->grid->dim; ++k) {
    low[k] = block_at(blocks, box[k].low);
    high[k] = block_at(blocks, box[k].high - 1);
  }
  for (int64_t x = low[0]; x <= high[0]; ++x)
    for (int64_t y = low[1]; y <= high[1]; ++y)
      for (int64_t z = low[2]; z <= high[2]; ++z) {
        const int32_t coord[3] = {(int32_t)x, (int32_t)y, (int32_t)z};
        const int32_t block = mpmi_blocks_find(blocks, body, coord);
        if (block >= 0) flag_block(parts, blocks, block, box, (uint8_t)flag, part);
      }
}

/* Flags the nodes of a block's tile. */
static void flag_tile(const mpmi_parts *parts, const mpmi_blocks *blocks, int64_t block, int32_t flag,
                      int32_t part) {
  stretch box[3];
  for (int32_t k = 0; k < blocks->grid->dim; ++k) box[k] = tile_of(parts, blocks->coord[block][k]);
  flag_box(parts, blocks, blocks->body[block], box, flag, part);
}

/* Flags the nodes of all bodies within a margin around a tile, also a period further on: not all that are
 * there are tied to nodes here. */
static void flag_around(const mpmi_parts *parts, const mpmi_blocks *blocks, int64_t block, int32_t margin,
                        int32_t flag) {
  const mpm_grid *grid = blocks->grid;
  int32_t turns[3] = {0, 0, 0};
  for (int32_t k = 0; k < grid->dim; ++k) turns[k] = grid->desc.periodic[k] != 0;
  for (int32_t x = -turns[0]; x <= turns[0]; ++x)
    for (int32_t y = -turns[1]; y <= turns[1]; ++y)
      for (int32_t z = -turns[2]; z <= turns[2]; ++z) {
        const int32_t turn[3] = {x, y, z};
        stretch box[3];
        for (int32_t k = 0; k < grid->dim; ++k) {
          const int64_t shift = turn[k] * grid->desc.cells[k];
          box[k] = around(parts, k, blocks->coord[block][k], margin);
          box[k] = (stretch){box[k].low + shift, box[k].high + shift};
        }
        for (int32_t i = 0; i < parts->body_count; ++i)
          flag_box(parts, blocks, parts->body[i], box, flag, -1);
      }
}

/* Nodes that are tied move as one: what is so for one of them is so for all. */
static void join_ties(const mpmi_parts *parts, const mpmi_constraints *constraints) {
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    uint8_t all = parts->flags[tie->master];
    int32_t lowest = parts->names_owners ? parts->lowest[tie->master] : 0;
    for (int64_t f = tie->first; f < tie->first + tie->count; ++f) {
      const int64_t slot = constraints->follower[f].slot;
      all |= parts->flags[slot];
      if (parts->names_owners && parts->lowest[slot] < lowest) lowest = parts->lowest[slot];
    }
    parts->flags[tie->master] |= all;
    if (parts->names_owners) parts->lowest[tie->master] = lowest;
    for (int64_t f = tie->first; f < tie->first + tie->count; ++f)
      parts->flags[constraints->follower[f].slot] |= all;
  }
}

/* Blocks near a ghost may share nodes with it. */
static void flag_near(nearby *n, const int32_t *coord, const place *const *at) {
  for (int32_t i = 0; i < n->parts->body_count && (all_want(at) || all_wanted(at)); ++i) {
    const int32_t found = mpmi_blocks_find(n->blocks, n->parts->body[i], coord);
    if (found >= 0 && n->parts->near[found]) n->parts->near[found] = 2;
  }
}

mpm_status mpmi_pattern_adopt(mpmi_parts *parts, const mpmi_blocks *blocks) {
  mpm_context *c = parts->context;
  const int64_t count = blocks->count;
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(c, parts->mark, parts->mark_capacity, count + 1)) ||
      (status = MPMI_RESERVE_MORE(c, parts->is_boundary, parts->is_boundary_capacity, count + 1)) ||
      (status = MPMI_RESERVE_MORE(c, parts->is_inner, parts->is_inner_capacity, count + 1)) ||
      (status = MPMI_RESERVE_MORE(c, parts->near, parts->near_capacity, count + 1)) ||
      (status = MPMI_RESERVE_MORE(c, parts->guest_of, parts->guest_capacity, count + 1)) ||
      (status = MPMI_RESERVE_MORE(c, parts->given, parts->given_capacity, count + 1)) ||
      (status = MPMI_RESERVE_MORE(c, parts->boundary, parts->boundary_capacity, parts->sent_count + 1)))
    return status;
  memset(parts->mark, 0, (size_t)(count + 1) * sizeof *parts->mark);
  memset(parts->guest_of, 0, (size_t)(count + 1) * sizeof *parts->guest_of);
  memset(parts->given, 0, (size_t)(count + 1));
  memset(parts->is_boundary, 0, (size_t)(count + 1));
  memset(parts->is_inner, 0, (size_t)(count + 1));
  for (int64_t i = 0; i < parts->info.blocks; ++i) parts->is_inner[blocks->order[i]] = 1;
  memcpy(parts->near, parts->is_inner, (size_t)(count + 1));
  for (int64_t i = 0; i < parts->ghost_count; ++i)
    parts->ghost[i].block = blocks->order[parts->ghost[i].block];
  parts->boundary_count = 0;
  for (int64_t i = 0; i < parts->sent_count; ++i) {
    const int64_t block = parts->sent[i].block = blocks->order[parts->sent[i].block];
    if (parts->mark[block]) continue;
    parts->boundary[parts->boundary_count] = block;
    parts->mark[block] = (int32_t)++parts->boundary_count;
    parts->is_boundary[block] = 1;
    parts->is_inner[block] = 0;
  }
  parts->info.boundary = parts->boundary_count;
  parts->version = -1;
  return mpmi_find_early(parts, blocks);
}

static void flag_ghost(mpmi_parts *parts, const mpmi_blocks *blocks, const mpmi_shared_block *ghost) {
  const int32_t *coord = blocks->coord[ghost->block];
  const int32_t part = parts->partner[ghost->partner].part, lower = part < parts->context->transport.part;
  nearby n = {parts, blocks, {coord[0], coord[1], coord[2]}, NULL};
  flag_tile(parts, blocks, ghost->block, MPMI_NODE_GIVEN | (lower ? MPMI_NODE_LOWER : 0), part);
  each_near(&n, flag_near);
}

static int32_t is_partial(const mpmi_parts *parts, int64_t slot) {
  return (parts->flags[slot] & (MPMI_NODE_GIVEN | MPMI_NODE_WHOLE)) == MPMI_NODE_GIVEN;
}

mpm_status mpmi_pattern_nodes(mpmi_parts *parts, const mpmi_blocks *blocks,
                              const mpmi_constraints *constraints) {
  mpm_context *c = parts->context;
  const int64_t slots = blocks->count * blocks->nodes;
  mpm_status status = MPMI_RESERVE_MORE(c, parts->flags, parts->flags_capacity, slots + 1);
  if (!status && parts->names_owners)
    status = MPMI_RESERVE_MORE(c, parts->lowest, parts->lowest_capacity, slots + 1);
  if (status) return status;
  memset(parts->flags, 0, (size_t)(slots + 1));
  for (int64_t i = 0; i < slots && parts->names_owners; ++i) parts->lowest[i] = INT32_MAX;
  for (int64_t i = 0; i < parts->ghost_count; ++i) flag_ghost(parts, blocks, &parts->ghost[i]);
  for (int64_t block = 0; block < blocks->count; ++block) {
    if (parts->near[block] != 2) continue;
    flag_tile(parts, blocks, block, MPMI_NODE_OWN | MPMI_NODE_MEETS, c->transport.part);
    flag_around(parts, blocks, block, parts->margin, MPMI_NODE_WHOLE);
    if (parts->meeting_margin) flag_around(parts, blocks, block, parts->meeting_margin, MPMI_NODE_MEETS);
  }
  join_ties(parts, constraints);
  int64_t count = 0;
  for (int64_t slot = 0; slot < slots; ++slot) count += is_partial(parts, slot);
  if ((status = MPMI_RESERVE_MORE(c, parts->partial, parts->partial_capacity, count + 1))) return status;
  parts->partial_count = 0;
  for (int64_t slot = 0; slot < slots; ++slot)
    if (is_partial(parts, slot)) parts->partial[parts->partial_count++] = slot;
  return MPM_OK;
}
