/* Nested dissection finds the order of elimination from where the nodes lie in the grid. */
#ifndef MPMI_DISSECTION_H
#define MPMI_DISSECTION_H

#include "linalg/matrix.h"

/* The nodes of a part are eliminated together: a separator, or a piece that is too small to be cut. Their
 * places in the order are [begin, end); the nodes that they separate have the places [whole, begin). */
typedef struct mpmi_part {
  int32_t begin, end, whole;
} mpmi_part;

typedef struct mpmi_dissection {
  const mpmi_matrix *A;
  int32_t *order;  /* [nodes] in: the nodes that have unknowns; out: the same in order of elimination */
  int32_t *label;  /* [A->rows] the piece that a node belongs to; 0 at first */
  int32_t *spare;  /* [nodes] */
  mpmi_part *part; /* [nodes] out: every part comes after those that it separates */
  int32_t nodes, parts, labels;
} mpmi_dissection;

void mpmi_dissect(mpmi_dissection *d);

#endif
