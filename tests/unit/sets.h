/* What tests of sets share: one set without a stepper on a small grid, and what must hold of its slots. */
#ifndef SETS_H
#define SETS_H

#include "particles/layout.h"
#include "world.h"

/* 10, 9 and 8 cells of edge 0.5, from -1 on. */
mpm_grid_desc sets_grid(int32_t dim);
world_desc sets_desc(const mpm_grid_desc *grid, const char *model);
/* With n particles by sets_add(). A world that is open is closed first. */
void sets_open(world *w, int32_t dim, const char *model, int64_t n);
void sets_open_on(world *w, const mpm_grid_desc *grid, const char *model, int64_t n);
void sets_close(world *w); /* with a look at the slots */
/* n particles on a line inside that grid, with the given ids or their own. */
void sets_add(world *w, int64_t n, const int64_t *ids);
/* One value of a particle of the set. */
double sets_get(const world *w, const char *field, int32_t components, int32_t c, int64_t id);

/* What must not change when a call is refused. */
typedef struct sets_counts {
  int64_t count, slots, next_id, held;
  int32_t fields, mapped;
  uint32_t dirty;
} sets_counts;
sets_counts sets_take(const world *w);
void sets_unchanged(const world *w, sets_counts was);

/* Every slot is a particle or inert, in whole groups. */
void sets_check_slots(const world *w);

#endif
