/* An elastic block, 0.8 by 0.4, or a disc, E = 1e6, nu = 0.3, density 1000, g = 10, on a rigid support. It
 * slides down a slope or rests there, and it slides on the level until it stops. Coulomb's law gives the
 * exact answers. */
#ifndef SLIDING_H
#define SLIDING_H

#include "support.h"

typedef struct slide {
  int32_t support, basis; /* support: ON_BODY is one of prescribed particles */
  int32_t normal;         /* with ON_BODY */
  int32_t settled;        /* 1: under damping, before it is let go */
  double keeps;     /* share of its velocity that a step of that leaves it; 0: 0.99, in which it swings */
  double push;      /* velocity down the slope that a block gets which has settled sticking there */
  double h, radius; /* radius: of a disc; 0: a block */
  double slab;      /* thickness of elastic particles, of the block's law, on those of ON_BODY */
  double angle, friction, speed, end;
  double shift, turn; /* of the support: in cells, and against the grid; a wall has neither */
} slide;

typedef struct slide_outcome {
  double way, stopped_at;
  double range, late; /* of places since it stopped, and in the last third of the time: what rests trembles
                              or creeps so far */
  double friction, weight; /* mean forces over those of Coulomb and of gravity */
  double spin;             /* angular velocity at the end, > 0 down the slope */
  double balance;          /* impulse less weight and change of momentum, over weight */
} slide_outcome;

extern const double slide_gravity;

slide_outcome slide_run(const slide *a);

/* The block on supports at several places in their cells: on a slope of 30 degrees with friction 0.3 and 0.7,
 * and on the level with speed 1.5. */
typedef struct slide_series {
  const char *name;
  int32_t support, basis, places;
  const double *place;                   /* of the support, in cells; NULL: six of ours */
  double h, slab;                        /* h: 0 for 1/20 */
  double turn, sliding, creep, stopping; /* tolerances: of ways, over the exact; length; of the way again */
  double weight;      /* and of the mean force of the floor; 0: none, since a block trembles */
  const char *creeps; /* NULL, or why it creeps that is let go while it swings */
  const char *hops;   /* NULL, or why the mean force of the floor is not the weight */
} slide_series;

void slide_gates(const slide_series *s, FILE *table);
void slide_heading(FILE *table); /* of what slide_gates() writes */
const char *slide_basis(int32_t basis);

#endif
