/* What a transfer between particles and nodes is made of: one row of a table for each. */
#ifndef MPMI_TRANSFERS_H
#define MPMI_TRANSFERS_H

#include <mpm/mpm.h>

/* What particles give to the nodes beside their velocity. */
enum {
  MPMI_CARRIES_NOTHING,
  MPMI_CARRIES_MATRIX,  /* the affine matrix C, which they take back with the velocity */
  MPMI_CARRIES_GRADIENT /* the velocity gradient L of the strain (Taylor) */
};
/* How the new velocity of a particle follows from the nodes. */
enum {
  MPMI_TAKES_VELOCITY,  /* it is the interpolated velocity */
  MPMI_TAKES_BLEND,     /* it blends the old velocity plus the interpolated increment with that */
  MPMI_TAKES_CORRECTED, /* it is the interpolated velocity, with the corrections of XPIC from order 2 on */
  MPMI_TAKES_FULL       /* that, with those of FMPM */
};

typedef struct mpmi_transfer {
  const char *name;
  int32_t carries, takes;
  int32_t most_order; /* of xpic_order; 0: has no orders */
  int32_t moments;    /* MPMI_NEED_...: second weights of the scatter beside the gradient */
  int32_t fused;      /* a whole step adds the force to the momentum, which needs the MLS form of the basis */
} mpmi_transfer;

/* Returns the row of MPM_FLIP ... MPM_FMPM, or NULL for other values. */
const mpmi_transfer *mpmi_transfer_of(int32_t transfer);

#endif
