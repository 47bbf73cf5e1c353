/* The list of combinations that test_combinations.c steps, and what may be refused. */
#ifndef COMBINATIONS_H
#define COMBINATIONS_H

#include "world.h"

/* What a combination chooses: the place of each value in the lists of methods.h; dim, position order as they
 * are. */
enum {
  CHOOSE_DIM,
  CHOOSE_BASIS,
  CHOOSE_SCHEME,
  CHOOSE_TRANSFER,
  CHOOSE_ORDER,
  CHOOSE_STAGGERED,
  CHOOSE_REMEDY,
  CHOOSE_LAW,
  CHOOSE_PERIODIC,
  CHOICES
};
typedef struct combination {
  int32_t choice[CHOICES];
} combination;

/* First value of each choice, and one past the last. */
extern const int32_t choice_first[CHOICES], choice_end[CHOICES];

/* Why the library may refuse it, NULL where it must not. */
const char *refusal_of(const combination *c);
/* Are these two values refused in every combination? */
int32_t pair_refused(int32_t what, int32_t value, int32_t other, int32_t other_value);

/* Every dim, basis, scheme and transfer, with the other choices in turn, and then as many as it
 * takes to have every two values together. Freed by the caller. */
combination *list_combinations(int32_t *count);

const char *name_of(const combination *c, char *text, size_t size);
/* Describes a world of 8 cells of edge 0.25 along each axis. */
world_desc describe_combination(const combination *c);

#endif
