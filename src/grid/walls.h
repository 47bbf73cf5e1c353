/* What each kind of wall does: one row of a table. */
#ifndef MPMI_WALLS_H
#define MPMI_WALLS_H

#include <mpm/mpm.h>

typedef struct mpmi_wall_kind {
  int32_t opens; /* particles that reach it are removed */
  int32_t holds; /* MPMI_HOLDS_...: what is 0 on its plane, and mirrored by ghosts behind it */
  int32_t rubs;  /* MPMI_RUBS_...: unilateral contact with friction */
} mpmi_wall_kind;

enum { MPMI_HOLDS_NOTHING, MPMI_HOLDS_NORMAL, MPMI_HOLDS_ALL };
/* With friction a wall acts on the nodes on its plane, or as an obstacle whose surface its plane is. */
enum { MPMI_RUBS_NOT, MPMI_RUBS_NODES, MPMI_RUBS_PLANE };

/* A wall of a face, as the host has set it. */
typedef struct mpmi_wall {
  int32_t kind; /* MPM_WALL_... */
  double friction;
} mpmi_wall;

/* Returns the row of MPM_WALL_NONE ..., or NULL for other values. */
const mpmi_wall_kind *mpmi_wall_kind_of(int32_t kind);

/* Returns 1 when particles stop at the wall. */
static inline int32_t mpmi_is_solid(const mpmi_wall *wall) {
  const mpmi_wall_kind *kind = mpmi_wall_kind_of(wall->kind);
  return kind->holds || kind->rubs;
}

#endif
