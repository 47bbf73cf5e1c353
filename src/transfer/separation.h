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
/* Finds of each particle how far it lies along a unit vector n, in units of length, and the square of how
 * far it lies off the line through the node along n, in cells; and of the particles of each cloud that are
 * off by no more than a limit, most[0] how far one of the first cloud lies along n, most[1] one of the second
 * against it. */
typedef void (*mpmi_project_fn)(const mpmi_separation *clouds, const double *spacing, const double *n,
                                double limit, double *along, double *off, double *most);

#endif
