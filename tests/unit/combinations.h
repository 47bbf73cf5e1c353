/* The list of combinations that test_combinations.c steps, and what may be refused. */
#ifndef COMBINATIONS_H
#define COMBINATIONS_H

#include "options.h"
#include "support.h"

/* What a combination chooses: the place of each value in the tables of options.h; dim,
 * position order as they are. */
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
/* Is the value in the library, whatever it is combined with? */
int32_t choice_ready(int32_t what, int32_t value);

/* Why the library may refuse it, NULL where it must not. */
const char *refusal_of(const combination *c);
/* Are these two values refused in every combination? */
int32_t pair_refused(int32_t what, int32_t value, int32_t other, int32_t other_value);

/* Every dim, basis, scheme and transfer that is there, with the other choices in turn, and then as many as it
 * takes to have every two values together. Freed by the caller. */
combination *list_combinations(int32_t *count);

const char *name_of(const combination *c, char *text, size_t size);
void describe_combination(const combination *c, mpm_grid_desc *grid, mpm_stepper_desc *stepper);

#endif
