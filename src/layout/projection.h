/* Projections of particles onto nodes. Beside the one with the forces there are those of velocity alone:
 * before it for the strain of USF, after it for the strain of MUSL, and for the corrections of XPIC and FMPM;
 * that of accelerations for implicit steps; and that of displacements on total Lagrangian grids. */
#ifndef MPMI_PROJECTION_H
#define MPMI_PROJECTION_H

#include "layout/nodes.h"

typedef struct mpmi_projection {
  int32_t main;     /* the one of the step itself: hooks run, old impulses are forgotten, nodes are counted */
  int32_t forces;   /* with forces, into the nodes that are solved for; else into those that are projected */
  int32_t copy;     /* of the particles' field */
  int32_t field;    /* that is projected: velocity or acceleration */
  int32_t matrix;   /* the field with its affine part: MPMI_L where the transfer carries one, or another */
  int32_t plain;    /* 1: without the affine part */
  int32_t recorded; /* impulses of the boundary stage count as reactions */
  int32_t held;     /* prescribed velocities are set */
  int32_t contact;  /* MPMI_CONTACT_...: what friction walls do in it */
} mpmi_projection;

enum {
  MPMI_CONTACT_FINDS, /* the forces tell which contacts are closed */
  MPMI_CONTACT_KEEPS, /* contacts stay as they were found */
  MPMI_CONTACT_NONE   /* velocities obey what is linear alone */
};

enum {
  MPMI_PROJECT_FORCES,       /* momentum and force */
  MPMI_PROJECT_STRAIN,       /* momentum, from the velocities at the start of the step */
  MPMI_PROJECT_CONTACT,      /* momentum and force at the start of the step, to find closed contacts */
  MPMI_PROJECT_MOVED,        /* momentum, from the new velocities */
  MPMI_PROJECT_CORRECTION,   /* momentum without its affine part, from the second copy of the velocities */
  MPMI_PROJECT_FULL,         /* the same for FMPM, where velocities stay as they are prescribed */
  MPMI_PROJECT_ACCELERATION, /* mass times acceleration, from the second copy */
  MPMI_PROJECT_DISPLACEMENT, /* mass times displacement, which lies in the second copies of velocity and F */
  MPMI_PROJECTIONS
};
extern const mpmi_projection mpmi_projections[MPMI_PROJECTIONS];

/* Returns the nodes that a projection goes into. */
static inline mpmi_nodal *mpmi_projected_nodes(mpmi_nodes *nodes, const mpmi_projection *projection) {
  return projection->forces ? &nodes->solved : &nodes->projected;
}
/* Returns 1 for the first projection of a step, which asks the host for prescribed velocities; later ones
 * keep to the answer. */
static inline int32_t mpmi_asks_host(const mpmi_settings *settings, const mpmi_projection *projection) {
  return projection ==
         &mpmi_projections[mpmi_deforms_first(settings) ? MPMI_PROJECT_STRAIN : MPMI_PROJECT_FORCES];
}

#endif
