/* Elastic discs that collide (Sulsky, Chen and Schreyer 1994): E = 1000, nu = 0.3, density 1000, radius 0.2,
 * speed 0.1 sqrt 2. Two of them meet, or one hits a wall without friction, which is the same by symmetry. The
 * reference is a finite element solution: they touch at 1.586, kinetic energy is least, 0.136 for both, at
 * 2.104, they part at 2.685 and rebound with 0.909 of their speed. */
#ifndef DISCS_H
#define DISCS_H

#include "support.h"

/* Fills a disc by its own lattice, so that it is symmetric wherever it lies on the grid. */
void disc_fill(const verify_world *w, mpm_particles *set, const double *centre, double radius,
               const double *v, double spacing);
/* Fills a disc by shells: a lattice of its bounding square, drawn in along rays, so that its outline is
 * smooth. half: only what is beyond its centre along x. */
void disc_fill_shells(const verify_world *w, mpm_particles *set, const double *centre, double radius,
                      const double *v, int32_t half, double spacing);
/* Angular velocity about the centre of mass, and along `e` the velocity of it. */
double disc_spin(const verify_world *w, const mpm_particles *set, const double *e, double *velocity);

typedef struct disc_hit {
  int against, cells, scheme, transfer, basis; /* against: ON_BODY is another disc, */
  int rigid;                                   /* or with 1 one of prescribed particles with a plane face */
  int shells;                                  /* 1: filled by shells, else by lattices */
  double cfl;                                  /* of the stable step; 0: 0.4 */
  double shift[2], angle, offset, friction; /* shift: in cells; angle: of the flight, -90 degrees to a wall;
                                                  offset: of the lines of flight, in radii */
} disc_hit;

typedef struct disc_outcome {
  double touch, part, least, when; /* least: kinetic energy, of two discs */
  double rebound, energy, energy_end, spin, dissipation;
  double force, steady; /* largest, of a step and of the mean over about 0.03 */
  double momentum;      /* largest, of the discs and of what they stand against, over that of a disc */
  double angular;       /* largest change, of two discs */
} disc_outcome;

extern const double disc_radius, disc_speed;
extern const char *const disc_reference; /* where gates are from */

/* When the outlines of two lattices meet: those of the cells of their particles. */
double disc_outlines_meet(int cells, double angle);

/* Runs to t = 3.6. history may be NULL. */
disc_outcome disc_collide(const disc_hit *a, FILE *history);

#endif
