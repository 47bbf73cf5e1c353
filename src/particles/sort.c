#include "particles/sort.h"
#include "context/slack.h"
#include "particles/clusters.h"

#include <string.h>

#define NONE UINT32_MAX

void mpmi_arrangement_init(mpmi_arrangement *a, mpm_context *context) {
  memset(a, 0, sizeof *a);
  a->context = context;
}

void mpmi_arrangement_free(mpmi_arrangement *a) {
  MPMI_FREE_ARRAY(a->context, a->start, a->start_capacity);
  mpmi_arrangement_init(a, a->context);
}

void mpmi_sorting_free(mpmi_sorting *sorting, mpm_context *context) {
  MPMI_FREE_ARRAY(context, sorting->source, sorting->source_capacity);
  memset(sorting, 0, sizeof *sorting);
}

mpm_status mpmi_arrangement_reserve_blocks(mpmi_arrangement *a, int64_t blocks) {
  const mpm_status status =
      mpmi_reserve(a->context, (void **)&a->start, &a->start_capacity,
                   blocks + 1 > a->start_capacity ? 2 * blocks + 2 : blocks + 1, sizeof *a->start);
  const size_t size = sizeof *a->start;
  if (!status) mpmi_slack(a->start, (size_t)a->start_capacity * size, (size_t)(blocks + 1) * size);
  return status;
}

/* From mpmi_sort_blocks() to mpmi_sort_plan() the memory for the next positions holds the provisional
 * block of each slot. */
static uint32_t *blocks_of_slots(const mpm_particles *set) {
  return set->field[MPMI_POSITION].data[1];
}

const uint32_t *mpmi_sort_blocks_of_slots(const mpm_particles *set) {
  return blocks_of_slots(set);
}

mpm_status mpmi_sort_blocks(mpm_particles *set, int32_t body, mpmi_blocks *blocks) {
  uint32_t *of_slot = blocks_of_slots(set);
  mpm_status status;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  const double *x = mpmi_places(set, 0);
  int32_t last[3] = {0, 0, 0}, coord[3] = {0, 0, 0}, block = MPMI_NO_BLOCK;
  for (int64_t s = 0; s < set->slots; ++s) {
    of_slot[s] = NONE;
    if (id[s] < 0) continue;
    mpmi_blocks_of_position(set->grid, x + s, set->ld, blocks->edge, coord);
    if (block < 0 || memcmp(coord, last, sizeof coord) != 0) {
      if ((status = mpmi_blocks_insert(blocks, body, coord, &block))) return status;
      memcpy(last, coord, sizeof coord);
    }
    of_slot[s] = (uint32_t)block;
  }
  return MPM_OK;
}

static int64_t padded(int64_t count) {
  return (count + MPMI_PAD - 1) / MPMI_PAD * MPMI_PAD;
}

/* Returns the i-th slot in the order in which particles are taken. */
static int64_t slot_in_turn(const mpmi_sorting *sorting, int64_t i) {
  if (!sorting->tail_low) return i;
  if (i < sorting->tail_low) return sorting->tail + i;
  return i < sorting->tail + sorting->tail_low ? i - sorting->tail_low : i;
}

/* Orders the particles of each block for kernels that take clusters; behind the slots there is room for those
 * of one block. */
static void order_clusters(const mpm_particles *set, int64_t blocks, mpmi_sorting *sorting,
                           const mpmi_arrangement *to) {
  uint32_t *room = sorting->source + to->start[blocks];
  for (int64_t b = 0; b < blocks; ++b) {
    uint32_t *source = sorting->source + to->start[b];
    int64_t count = to->start[b + 1] - to->start[b];
    while (count && source[count - 1] == NONE) --count;
    mpmi_clusters_first(set, count, source, room);
  }
}

mpm_status mpmi_sort_plan(mpm_particles *set, const mpmi_blocks *blocks, mpmi_sorting *sorting,
                          mpmi_arrangement *to) {
  const uint32_t *of_slot = blocks_of_slots(set);
  mpm_status status = mpmi_arrangement_reserve_blocks(to, blocks->count);
  if (status) return status;
  /* the order of particles that stay is a function of places and ids alone, whoever has come and gone */
  const int32_t stay = mpmi_is_total_lagrangian(set->grid);
  const int32_t by_id = (stay || set->dirty & (MPMI_DIRTY_ORDER | MPMI_DIRTY_IDS)) &&
                        (sorting->tail_low || !mpmi_ids_ascend(set));
  if (by_id && (status = mpmi_index_build(set))) return status;
  memset(to->start, 0, (size_t)(blocks->count + 1) * sizeof *to->start);
  for (int64_t s = 0; s < set->slots; ++s)
    if (of_slot[s] != NONE) ++to->start[blocks->order[of_slot[s]]];
  int64_t slots = 0, most = 0;
  for (int64_t b = 0; b <= blocks->count; ++b) {
    const int64_t here = padded(to->start[b]);
    to->start[b] = slots;
    slots += here;
    if (stay && here > most) most = here;
  }
  const int64_t room = (slots > set->ld ? mpmi_leading_dimension(slots) : set->ld) + most;
  if ((status = mpmi_reserve(set->context, (void **)&sorting->source, &sorting->source_capacity, room,
                             sizeof *sorting->source)))
    return status;
  if (slots) memset(sorting->source, 0xff, (size_t)slots * sizeof *sorting->source);
  /* start[b] serves as the cursor of block b and is put back afterwards. */
  const int64_t n = by_id ? set->count : set->slots;
  for (int64_t i = 0; i < n; ++i) {
    const int64_t s = by_id ? set->index[i].slot : slot_in_turn(sorting, i);
    if (of_slot[s] != NONE) sorting->source[to->start[blocks->order[of_slot[s]]]++] = (uint32_t)s;
  }
  for (int64_t b = blocks->count; b > 0; --b) to->start[b] = padded(to->start[b - 1]);
  to->start[0] = 0;
  if (stay && slots) order_clusters(set, blocks->count, sorting, to);
  return mpmi_particles_reserve(set,
                                slots); /* last, because the second copies may move, and with them of_slot */
}

/* A move takes one component array from one place to another. */
typedef struct move {
  const char *from;
  char *to;
  size_t size;
} move;
enum { MAX_MOVES = 96 };
typedef struct moving {
  const uint32_t *source; /* NULL: plain copy */
  int64_t slots, pieces;
  int32_t count;
  move list[MAX_MOVES];
} moving;

/* Element types are 8 bytes or 1. */
static void move_piece(void *data, int64_t k) {
  const moving *m = data;
  const int64_t begin = m->slots * k / m->pieces, end = m->slots * (k + 1) / m->pieces;
  for (int32_t i = 0; i < m->count; ++i) {
    const move *v = &m->list[i];
    if (!m->source) {
      memcpy(v->to + (size_t)begin * v->size, v->from + (size_t)begin * v->size,
             (size_t)(end - begin) * v->size);
    } else if (v->size == 8) {
      uint64_t *to = (uint64_t *)(void *)v->to;
      const uint64_t *from = (const uint64_t *)(const void *)v->from;
      for (int64_t s = begin; s < end; ++s)
        if (m->source[s] != NONE) to[s] = from[m->source[s]];
    } else {
      for (int64_t s = begin; s < end; ++s)
        if (m->source[s] != NONE) v->to[s] = v->from[m->source[s]];
    }
  }
}

static void run(mpm_particles *set, moving *m) {
  m->pieces = set->context->concurrency;
  if (m->count) mpmi_parallel_for_sure(set->context, m->pieces, move_piece, m);
  m->count = 0;
}

/* Collects component arrays that a sort may use as scratch: the second copies, before they receive their
 * own field. */
static int32_t collect_spares(const mpm_particles *set, char **spare, int32_t capacity) {
  int32_t count = 0;
  for (int32_t f = 0; f < set->field_count; ++f) {
    const mpmi_field *field = &set->field[f];
    for (int32_t c = 0; field->present && field->two_copies && c < field->components && count < capacity; ++c)
      spare[count++] = (char *)field->data[1] + (size_t)(c * set->ld) * mpmi_type_size(field->type);
  }
  return count;
}

/* Fields with one copy go out to the spares in the new order, and straight back. */
static void sort_single_copies(mpm_particles *set, const uint32_t *source, int64_t slots) {
  char *spare[MAX_MOVES];
  const int32_t spares = collect_spares(set, spare, MAX_MOVES);
  moving out = {source, slots, 0, 0, {{0}}}, back = {NULL, slots, 0, 0, {{0}}};
  for (int32_t f = 0; f < set->field_count; ++f) {
    const mpmi_field *field = &set->field[f];
    if (!field->present || field->two_copies) continue;
    const size_t size = mpmi_type_size(field->type);
    for (int32_t c = 0; c < field->components; ++c) {
      char *at = (char *)field->data[0] + (size_t)(c * set->ld) * size;
      out.list[out.count] = (move){at, spare[out.count], size};
      back.list[out.count] = (move){spare[out.count], at, size};
      back.count = ++out.count;
      if (out.count < spares) continue;
      run(set, &out);
      run(set, &back);
    }
  }
  run(set, &out);
  run(set, &back);
}

static void sort_double_copies(mpm_particles *set, const uint32_t *source, int64_t slots) {
  moving out = {source, slots, 0, 0, {{0}}};
  for (int32_t f = 0; f < set->field_count; ++f) {
    mpmi_field *field = &set->field[f];
    if (!field->present || !field->two_copies) continue;
    const size_t size = mpmi_type_size(field->type);
    for (int32_t c = 0; c < field->components; ++c) {
      const size_t offset = (size_t)(c * set->ld) * size;
      out.list[out.count++] = (move){(char *)field->data[0] + offset, (char *)field->data[1] + offset, size};
      if (out.count == MAX_MOVES) run(set, &out);
    }
  }
  run(set, &out);
  for (int32_t f = 0; f < set->field_count; ++f) {
    mpmi_field *field = &set->field[f];
    if (!field->present || !field->two_copies) continue;
    void *swap = field->data[0];
    field->data[0] = field->data[1];
    field->data[1] = swap;
  }
}

/* Finds a place inside both the block and the grid. */
static void hole_position(const mpm_grid *grid, const mpmi_blocks *blocks, int64_t b, double *x) {
  for (int32_t k = 0; k < grid->dim; ++k) {
    x[k] =
        grid->desc.origin[k] + grid->desc.spacing[k] * (((double)blocks->coord[b][k] + 0.5) * blocks->edge);
    if (x[k] > grid->upper[k]) x[k] = grid->upper[k];
  }
}

void mpmi_sort_apply(mpm_particles *set, const mpmi_blocks *blocks, mpmi_sorting *sorting,
                     const mpmi_arrangement *to) {
  const int64_t slots = to->start[blocks->count];
  if (slots) {
    sort_single_copies(set, sorting->source, slots);
    sort_double_copies(set, sorting->source, slots);
  }
  for (int64_t b = 0; b < blocks->count; ++b) {
    int64_t end = to->start[b + 1], begin = end;
    while (begin > to->start[b] && sorting->source[begin - 1] == NONE) --begin;
    if (begin == end) continue;
    double position[3];
    hole_position(set->grid, blocks, b, position);
    mpmi_fill_holes(set, 0, begin, end, position);
  }
  sorting->tail_low = 0;
  set->slots = slots;
  mpmi_particles_watch(set, slots);
  set->dirty &= ~(uint32_t)(MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_IDS);
  mpmi_index_drop(set);
}

static void turn_round(char *row, size_t size, int64_t first, int64_t end) {
  for (--end; first < end; ++first, --end)
    for (size_t i = 0; i < size; ++i) {
      const char swap = row[(size_t)first * size + i];
      row[(size_t)first * size + i] = row[(size_t)end * size + i];
      row[(size_t)end * size + i] = swap;
    }
}

void mpmi_sort_settle(mpm_particles *set, mpmi_sorting *sorting) {
  const int64_t low = sorting->tail_low, end = sorting->tail + low;
  for (int32_t f = 0; f < set->field_count && low; ++f) {
    const mpmi_field *field = &set->field[f];
    const size_t size = mpmi_type_size(field->type);
    for (int32_t c = 0; c < field->components && field->present; ++c) {
      char *row = (char *)field->data[0] + (size_t)(c * set->ld) * size;
      turn_round(row, size, 0, end);
      turn_round(row, size, 0, low);
      turn_round(row, size, low, end);
    }
  }
  if (low) mpmi_index_drop(set);
  sorting->tail_low = 0;
}
