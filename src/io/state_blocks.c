/* A state says which slots lie in which block, because a continued step must add things up in the same
 * order. */
#include "io/byte_order.h"
#include "io/state.h"

#include <string.h>

int32_t mpmi_state_is_sorted(const mpm_stepper *s) {
  if (s->layout.blocks.count == 0) return 0;
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    if (s->layout.member[m].set->dirty & (MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE)) return 0;
  return 1;
}

static int32_t has_slots(const mpm_stepper *s, int64_t block) {
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    if (s->layout.member[m].now.start[block + 1] > s->layout.member[m].now.start[block]) return 1;
  return 0;
}

int64_t mpmi_state_count_blocks(const mpm_stepper *s) {
  int64_t count = 0;
  for (int64_t b = 0; b < s->layout.blocks.count; ++b) count += has_slots(s, b);
  return count;
}

void mpmi_state_write_blocks(mpmi_archive *a, const mpm_stepper *s) {
  for (int64_t b = 0; b < s->layout.blocks.count; ++b) {
    if (!has_slots(s, b)) continue;
    int64_t place[4] = {s->layout.blocks.coord[b][0], s->layout.blocks.coord[b][1],
                        s->layout.blocks.coord[b][2], s->layout.blocks.body[b]};
    mpmi_archive_words(a, place, sizeof place);
  }
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    int64_t *start = s->layout.member[m].now.start;
    for (int64_t b = 0; b < s->layout.blocks.count; ++b)
      if (has_slots(s, b)) mpmi_archive_words(a, start + b, sizeof *start);
    mpmi_archive_words(a, start + s->layout.blocks.count, sizeof *start);
  }
}

/* Reads the blocks with slots, in the order of the state. They are inserted as provisional blocks and must
 * come out in the same order. */
static mpm_status read_places(mpmi_archive *a, mpmi_blocks *blocks, uint32_t format, int64_t count) {
  const mpm_grid *grid = blocks->grid;
  mpm_status status;
  for (int64_t i = 0; i < count; ++i) {
    int64_t saved[4] = {0, 0, 0, 0};
    int32_t coord[3] = {0, 0, 0}, block = 0;
    mpmi_archive_words(a, saved, (format > 2 ? 4 : 3) * (int64_t)sizeof *saved);
    if (a->status) return a->status;
    if (saved[3] < 0 || saved[3] >= MPMI_MAX_BODIES)
      return mpmi_archive_damaged(a, "the body of a block makes no sense");
    for (int32_t k = 0; k < grid->dim; ++k) {
      if (saved[k] < 0 || saved[k] > grid->desc.cells[k] / blocks->edge)
        return mpmi_archive_damaged(a, "a block lies outside the grid");
      coord[k] = (int32_t)saved[k];
    }
    if ((status = mpmi_blocks_insert(blocks, (int32_t)saved[3], coord, &block))) return status;
    if (block != i) return mpmi_archive_damaged(a, "a block stands there twice");
  }
  if ((status = mpmi_blocks_order(blocks))) return status;
  for (int64_t i = 1; i < count; ++i)
    if (blocks->order[i - 1] >= blocks->order[i])
      return mpmi_archive_damaged(a, "its blocks are out of order");
  return MPM_OK;
}

/* Returns entry i of a list of first slots: one for each of the state's blocks, then the number of slots. */
static int64_t saved_start(const unsigned char *starts, int64_t i) {
  int64_t value;
  memcpy(&value, starts + (size_t)i * sizeof value, sizeof value);
  return (int64_t)mpmi_little_64((uint64_t)value);
}

static int32_t starts_are_good(const unsigned char *starts, int64_t count, int64_t slots) {
  int64_t before = 0;
  for (int64_t i = 0; i <= count; ++i) {
    const int64_t start = saved_start(starts, i);
    if (start < before || start % MPMI_PAD || (i == 0 && start)) return 0;
    before = start;
  }
  return before == slots;
}

static mpm_status read_starts(mpmi_archive *a, const mpmi_blocks *blocks, int64_t count,
                              const mpmi_state_set_numbers *set, mpmi_arrangement *to) {
  const unsigned char *starts = mpmi_archive_take(a, (count + 1) * (int64_t)sizeof(int64_t));
  if (!starts) return a->status;
  if (!starts_are_good(starts, count, set->slots))
    return mpmi_archive_damaged(a, "the slots of a set make no sense");
  mpm_status status = mpmi_arrangement_reserve_blocks(to, blocks->count);
  if (status) return status;
  int64_t i = 0;
  for (int64_t b = 0; b <= blocks->count; ++b) { /* blocks that only the halo brings have no slots */
    to->start[b] = saved_start(starts, i);
    if (i == count || (int64_t)blocks->order[i] != b) continue;
    ++i;
    if (blocks->body[b] != set->body && saved_start(starts, i) != to->start[b])
      return mpmi_archive_damaged(a, "a set has slots in blocks of another body");
  }
  return MPM_OK;
}

mpm_status mpmi_state_read_blocks(mpmi_archive *a, mpm_stepper *s, uint32_t format, int64_t count,
                                  const mpmi_state_set *set) {
  mpmi_blocks *blocks = &s->layout.next_blocks;
  mpmi_blocks_clear(blocks);
  mpm_status status = read_places(a, blocks, format, count);
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m)
    status = read_starts(a, blocks, count, &set[m].numbers, &s->layout.member[m].next);
  return status;
}
