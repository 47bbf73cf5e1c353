/* Parts of test_walls.c: every basis with schemes and transfers that use walls in different ways, and walls
 * on the faces of a box. */
#ifndef WALLS_H
#define WALLS_H

#include "world.h"

enum { WALL_WAYS = 8, WALL_METHODS = BASES * WALL_WAYS };
method wall_method_of(int32_t i);

/* Kinds by face; the second axis may be periodic. Every kind alone first, in the order of the constants. */
typedef struct wall_setup {
  int32_t kind[6], periodic;
} wall_setup;
enum { WALL_SETUPS = 13 };
extern const wall_setup wall_setups[WALL_SETUPS];
void wall_describe(const wall_setup *setup, mpm_grid_desc *grid);
void wall_set(world *w, const wall_setup *setup, double friction);
int32_t wall_is_linear(int32_t kind);
/* Index of the node on a face, as guide.md numbers them. */
int64_t wall_face_node(const mpm_grid_desc *grid, int32_t face);

TCase *walls_nodes_case(TCase *wide);
TCase *walls_symmetry_case(void);
TCase *walls_space_case(void);
TCase *walls_balance_case(TCase *wide);
TCase *walls_flow_case(void);
TCase *walls_implicit_case(void);

#endif
