/* A state says which slots lie in which block, because a continued step must add things up in the same
 * order. */
#include "io/byte_order.h"
#include "io/state.h"

#include <string.h>

int32_t mpmi_state_is_sorted(const mpm_stepper *s) {
  return !mpmi_layout_is_moved(&s->layout);
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

/* ---- reading ------------------------------------------------------------------------------------------- */
static size_t start_bytes(int32_t sets, int64_t count) {
  return mpmi_bytes(sets * (count + 1) + 1, sizeof(int64_t));
}

mpm_status mpmi_state_blocks_make(mpm_context *c, int32_t sets, int64_t count, mpmi_state_blocks *blocks) {
  *blocks = (mpmi_state_blocks){.count = count};
  blocks->place = mpmi_alloc(c, mpmi_bytes(count + 1, sizeof *blocks->place));
  if (blocks->place) blocks->start = mpmi_alloc_zeroed(c, start_bytes(sets, count));
  return blocks->start ? MPM_OK : MPM_E_NOMEM;
}

void mpmi_state_blocks_free(mpm_context *c, int32_t sets, mpmi_state_blocks *blocks) {
  mpmi_free(c, blocks->place, mpmi_bytes(blocks->count + 1, sizeof *blocks->place));
  mpmi_free(c, blocks->start, start_bytes(sets, blocks->count));
  *blocks = (mpmi_state_blocks){0};
}

static mpm_status read_place(mpmi_archive *a, const mpm_grid *grid, uint32_t format, int64_t *place) {
  memset(place, 0, 4 * sizeof *place);
  mpmi_archive_words(a, place, (format > 2 ? 4 : 3) * (int64_t)sizeof *place);
  if (a->status) return a->status;
  if (place[3] < 0 || place[3] >= MPMI_MAX_BODIES)
    return mpmi_archive_damaged(a, "the body of a block makes no sense");
  for (int32_t k = 0; k < 3; ++k) {
    if (k >= grid->dim) place[k] = 0;
    if (place[k] < 0 || place[k] > grid->desc.cells[k] / MPMI_BLOCK_EDGE(grid->dim))
      return mpmi_archive_damaged(a, "a block lies outside the grid");
  }
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

mpm_status mpmi_state_read_blocks(mpmi_archive *a, const mpm_stepper *s, uint32_t format,
                                  const mpmi_state_head *head, mpmi_state_blocks *to, int64_t first,
                                  const int64_t *slots) {
  const int64_t count = head->numbers.blocks;
  for (int64_t i = 0; i < count; ++i) {
    int64_t place[4];
    const mpm_status status = read_place(a, s->grid, format, place);
    if (status) return status;
    if (to) memcpy(to->place[first + i], place, sizeof place);
  }
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    const unsigned char *starts = mpmi_archive_take(a, (count + 1) * (int64_t)sizeof(int64_t));
    if (!starts) return a->status;
    if (!starts_are_good(starts, count, head->set[m].numbers.slots))
      return mpmi_archive_damaged(a, "the slots of a set make no sense");
    for (int64_t i = 0; to && i <= count; ++i)
      mpmi_state_starts(to, m)[first + i] = slots[m] + saved_start(starts, i);
  }
  return MPM_OK;
}

static mpm_status refuse(const mpm_stepper *s, const char *what) {
  return mpmi_fail(s->context, MPM_E_FORMAT, "the state is damaged: %s", what);
}

mpm_status mpmi_state_insert_blocks(mpm_stepper *s, const mpmi_state_blocks *from) {
  mpmi_blocks *blocks = &s->layout.next_blocks;
  int32_t in_order = 1;
  mpmi_blocks_clear(blocks);
  for (int64_t i = 0; i < from->count; ++i) {
    const int64_t *place = from->place[i];
    const int32_t coord[3] = {(int32_t)place[0], (int32_t)place[1], (int32_t)place[2]};
    int32_t block;
    const mpm_status status = mpmi_blocks_insert(blocks, (int32_t)place[3], coord, &block);
    if (status) return status;
    if (block != i) return refuse(s, "a block stands there twice");
    if (i)
      in_order &= blocks->key[i] > blocks->key[i - 1] ||
                  (blocks->key[i] == blocks->key[i - 1] && blocks->body[i] > blocks->body[i - 1]);
  }
  return in_order ? MPM_OK : refuse(s, "its blocks are out of order");
}

mpm_status mpmi_state_arrange(mpm_stepper *s, const mpmi_state_blocks *from, const mpmi_state_set *set) {
  const mpmi_blocks *blocks = &s->layout.next_blocks;
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    mpmi_arrangement *to = &s->layout.member[m].next;
    const int64_t *start = mpmi_state_starts(from, m);
    const mpm_status status = mpmi_arrangement_reserve_blocks(to, blocks->count);
    if (status) return status;
    int64_t i = 0;
    for (int64_t b = 0; b <= blocks->count; ++b) { /* blocks that only the halo brings have no slots */
      to->start[b] = start[i];
      if (i == from->count || (int64_t)blocks->order[i] != b) continue;
      ++i;
      if (blocks->body[b] != set[m].numbers.body && start[i] != to->start[b])
        return refuse(s, "a set has slots in blocks of another body");
    }
  }
  return MPM_OK;
}
