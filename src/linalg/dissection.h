/* The order of elimination: nested dissection of the nodes by their place in the grid. */
#ifndef MPMI_DISSECTION_H
#define MPMI_DISSECTION_H

#include "linalg/matrix.h"

/* Nodes eliminated together: a separator, or what was too small to be cut. Their places in the order are
 * [begin, end); those of the nodes that they separate are [whole, begin). */
typedef struct mpmi_part {
  int32_t begin, end, whole;
} mpmi_part;

typedef struct mpmi_dissection {
  const mpmi_matrix *A;
  int32_t *order;  /* [nodes] in: the nodes that have unknowns; out: the same in order of elimination */
  int32_t *label;  /* [A->rows] which piece a node belongs to; 0 at first */
  int32_t *spare;  /* [nodes] */
  mpmi_part *part; /* [nodes] out, every part after those that it separates */
  int32_t nodes, parts, labels;
} mpmi_dissection;

void mpmi_dissect(mpmi_dissection *d);

#endif
