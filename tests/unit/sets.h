/* Tests of sets share one set without a stepper on a small grid, and the check of its slots. */
#ifndef SETS_H
#define SETS_H

#include "particles/builtin_fields.h"
#include "world.h"

/* The grid has 10, 9 and 8 cells of edge 0.5, from -1 on. */
mpm_grid_desc sets_grid(int32_t dim);
world_desc sets_desc(const mpm_grid_desc *grid, const char *model);
/* Opens a set with n particles of sets_add(). A world that is open is closed first. */
void sets_open(world *w, int32_t dim, const char *model, int64_t n);
void sets_open_on(world *w, const mpm_grid_desc *grid, const char *model, int64_t n);
void sets_close(world *w); /* checks the slots first */
/* Adds n particles on a line inside that grid, with the given ids or those that the set gives. */
void sets_add(world *w, int64_t n, const int64_t *ids);
/* Returns one value of a particle of the set. */
double sets_get(const world *w, const char *field, int32_t components, int32_t c, int64_t id);

/* None of these may change when a call is refused. */
typedef struct sets_counts {
  int64_t count, slots, next_id, held;
  int32_t fields, mapped;
  uint32_t dirty;
} sets_counts;
sets_counts sets_take(const world *w);
void sets_unchanged(const world *w, sets_counts was);

/* Every slot must be a particle or inert, in whole groups. */
void sets_check_slots(const world *w);

TCase *copies_f32_case(void); /* of test_copies.c */

#endif
