#include "grid/walls.h"

#include <stddef.h>

static const mpmi_wall_kind kinds[] = {
    [MPM_WALL_NONE] = {0, MPMI_HOLDS_NOTHING, MPMI_RUBS_NOT},
    [MPM_WALL_OPEN] = {1, MPMI_HOLDS_NOTHING, MPMI_RUBS_NOT},
    [MPM_WALL_FIXED] = {0, MPMI_HOLDS_ALL, MPMI_RUBS_NOT},
    [MPM_WALL_SLIP] = {0, MPMI_HOLDS_NORMAL, MPMI_RUBS_NOT},
    [MPM_WALL_FRICTION] = {0, MPMI_HOLDS_NOTHING, MPMI_RUBS_PLANE},
    [MPM_WALL_FRICTION_NODES] = {0, MPMI_HOLDS_NOTHING, MPMI_RUBS_NODES},
};

const mpmi_wall_kind *mpmi_wall_kind_of(int32_t kind) {
  return kind >= 0 && kind < (int32_t)(sizeof kinds / sizeof *kinds) ? &kinds[kind] : NULL;
}
