/* Values that particles of one block give to its tile and take from it beside momentum: temperatures and what
 * conducts them.
 *
 * What is given has four values per node, as all nodes have. What is taken and what flows has one: a tile of
 * a single value, whose nodes along the last axis stand side by side, so that a register holds a row of a
 * stencil. Such tiles are MPMI_SCALAR_SLACK doubles longer than they have nodes, and clean where they are
 * added to. */
#ifndef MPMI_SCALARS_H
#define MPMI_SCALARS_H

#include "transfer/weights.h"

enum { MPMI_SCALAR_SLACK = 4 };

/* The particles of a set as seen from a block. */
typedef struct mpmi_scalars {
  mpmi_axis axis[3];
  mpmi_weights_fn weights;
  mpmi_points points;
} mpmi_scalars;

/* Conduction along -k A grad T, with A = F^-1 F^-T where gradients are over reference positions. */
typedef struct mpmi_conduction {
  mpmi_scalars at;
  const double *F[9];        /* stored components at slot 0; NULL: A is the identity */
  const double *conductance; /* [n] k V from the first particle on; 0: the particle does not conduct */
  const double *field;       /* tile: T */
  double *outflow;           /* tile: += k V grad w . A grad T */
  double *diagonal;          /* tile: += k V grad w . A grad w; or NULL */
} mpmi_conduction;

/* Give value[0 ... 3], each [n] from the first particle on, to a tile of four values per node. */
typedef void (*mpmi_give_values_fn)(const mpmi_scalars *at, int64_t begin, int64_t n,
                                    const double *const *value, double *tile);
/* Sets to[n] to the mean of the field at each particle. */
typedef void (*mpmi_take_values_fn)(const mpmi_scalars *at, int64_t begin, int64_t n, const double *field,
                                    double *to);
typedef void (*mpmi_conduct_fn)(const mpmi_conduction *job, int64_t begin, int64_t n);

#endif
