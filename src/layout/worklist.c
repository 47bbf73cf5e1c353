#include "layout/worklist.h"

/* The members that the lists are made for. */
typedef struct members {
  const mpmi_member *member;
  int32_t count;
} members;

static int64_t slots_in_block(const members *of, int64_t block) {
  int64_t slots = 0;
  for (int32_t m = 0; m < of->count; ++m) {
    const int64_t *start = of->member[m].next.start;
    slots += start[block + 1] - start[block];
  }
  return slots;
}

static int32_t colour_of(int32_t dim, const int32_t *coord) {
  int32_t colour = 0;
  for (int32_t k = 0; k < dim; ++k) colour = 2 * colour + (coord[k] & 1);
  return colour;
}

/* Contiguous ranges of about equal numbers of slots. Results do not depend on where they end. */
static void set_bounds(const members *of, int32_t tasks, mpmi_worklist *list) {
  int64_t total = 0, so_far = 0;
  for (int64_t i = 0; i < list->count; ++i) total += slots_in_block(of, list->block[i]);
  int32_t task = 0;
  list->bound[0] = 0;
  for (int64_t i = 0; i < list->count; ++i) {
    while (task + 1 < tasks && so_far * tasks >= total * (task + 1)) list->bound[++task] = i;
    so_far += slots_in_block(of, list->block[i]);
  }
  while (task < tasks) list->bound[++task] = list->count;
}

void mpmi_worklists_make(mpmi_worklist *list, const mpmi_settings *settings, const mpmi_blocks *blocks,
                         const mpmi_member *member, int32_t member_count, int32_t *memory,
                         int64_t *bound_memory) {
  const members of = {member, member_count};
  for (int32_t l = 0; l < MPMI_WORKLISTS; ++l, ++list) {
    *list = (mpmi_worklist){memory, 0, bound_memory};
    for (int64_t i = 0; i < blocks->count; ++i)
      if (slots_in_block(&of, i) > 0 && (l == 0 || colour_of(blocks->grid->dim, blocks->coord[i]) == l - 1))
        list->block[list->count++] = (int32_t)i;
    set_bounds(&of, settings->tasks, list);
    memory += list->count;
    bound_memory += settings->tasks + 1;
  }
}
