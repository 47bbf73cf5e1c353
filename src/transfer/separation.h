/* The plane that separates the particles of two bodies around a node. */
#ifndef MPMI_SEPARATION_H
#define MPMI_SEPARATION_H

#include <stdint.h>

/* Two clouds of particles. Those of cloud c are [first[c], first[c] + padded[c]), whole chunks that end with
 * weights of 0. Places are from the node, in cells. The plane is that of the points x with plane[0 ... dim -
 * 1] . x + plane[3] = 0, and its direction is from the first cloud to the second. */
typedef struct mpmi_separation {
  int64_t count[2], first[2], padded[2];
  const double *x[3], *weight;
  double ball[2][3]; /* weighted sum over each cloud of r^2 / 3, by axis, for particles of radius r */
  double plane[4];
} mpmi_separation;

/* Each finds the plane and returns 1, or 0 where there is none. The first starts from the clouds, by Fisher's
 * linear discriminant; the second goes on from there, by logistic regression. */
typedef int32_t (*mpmi_separate_fn)(mpmi_separation *clouds);
/* Finds of each particle how far it lies towards the other cloud, along a unit vector n or against it for
 * the second cloud, in units of length: -infinity where the square of how far it lies off the line through
 * the node along n, in cells, is above a limit. most: of each cloud, the largest of these. */
typedef void (*mpmi_project_fn)(const mpmi_separation *clouds, const double *spacing, const double *n,
                                double limit, double *far, double *most);

#endif
