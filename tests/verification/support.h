/* What a body (number 0) stands on or hits: another body (number 1), the plane of a fixed obstacle, or the
 * friction wall at the lower end of axis y. One report for the three. */
#ifndef SUPPORT_H
#define SUPPORT_H

#include "verify.h"

enum { ON_BODY, ON_PLANE, ON_WALL };

typedef struct support {
  int32_t kind, normal; /* normal: with ON_BODY, an MPM_NORMAL_...; a fixed one is axis y */
  mpm_obstacle *plane;  /* NULL at first */
} support;

/* Puts it there, or gives it another friction. A plane goes through the point; its normal is axis y turned
 * about the third axis. */
void support_lay(verify_world *w, support *s, double friction, double turn, const double *point);
/* Forces and impulses on body 0. Of a wall there are only these, and whether it touches. */
mpm_contact_info support_info(const verify_world *w, const support *s);

#endif
