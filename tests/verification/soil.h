/* What the cases of soils share: stresses at rest, loads on a surface, pictures. In plane strain, with
 * axis y up. */
#ifndef SOIL_H
#define SOIL_H

#include "verify.h"

/* A level ground at rest: under a load on its surface, and a weight per volume. K: horizontal over vertical
 * stress. Of set 0. */
typedef struct soil_rest {
  double load, weight, height, K;
} soil_rest;
void soil_settle(const verify_world *w, const soil_rest *rest);

/* A load on a surface is put on the two rows of particles below it, as on a straight line that is extended
 * to the surface: the share of a particle at a depth, where rows are `row` apart; 0 below these two. */
double soil_row_share(double depth, double row);

/* Lines of label, position over length, and plastic strain times scale, for each particle of set 0. */
void soil_cloud(const verify_world *w, const char *label, double length, double scale, FILE *file);

#endif
