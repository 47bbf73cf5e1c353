/* The nodes and rows beside one, over slip walls as well: beside.c. */
#ifndef MPMI_BESIDE_H
#define MPMI_BESIDE_H

#include "implicit/balance.h"

/* Returns the slot of the node at an offset from one, or -1. Beyond a slip wall that is the mirrored node,
 * and mirror[axis] is the face; it moves the other way along that axis. Else mirror[axis] is -1. */
int64_t mpmi_node_beside(const mpmi_balance *balance, int64_t slot, const int32_t *offset, int32_t *mirror);
/* Returns how many times the body lies around a node, with its mirror images: twice for each slip wall on
 * whose plane the node is. */
double mpmi_copies_of(const mpmi_balance *balance, int64_t slot);
/* Returns 1 where a component is 0 by symmetry: across the slip wall on whose plane the node lies. */
int32_t mpmi_is_zero(const mpmi_balance *balance, int64_t slot, int32_t c);

/* Returns the mass of a row, by the last projection, with that of mirror images. */
double mpmi_whole_mass(const mpmi_balance *balance, int64_t row);
/* Returns the next row of the same body beside one, that shares a stencil with it and has more than some
 * whole mass; with a component c >= 0 only of rows that are free in it, or 0 by symmetry. -1: no more. A row
 * is met once for each node beside that it stands for; c of that node is *sign times that of the row. `at`
 * begins at 0. */
int64_t mpmi_next_beside(const mpmi_balance *balance, int64_t row, int32_t c, double above, int32_t *at,
                         double *sign);
/* Returns the whole mass of the heaviest of these, or 0. */
double mpmi_heaviest_beside(const mpmi_balance *balance, int64_t row, int32_t c);

#endif
