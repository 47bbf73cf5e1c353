#include "grid/walls.h"

#include <stddef.h>

static const mpmi_wall_kind kinds[] = {
    [MPM_WALL_NONE] = {0, MPMI_HOLDS_NOTHING, 0},     [MPM_WALL_OPEN] = {1, MPMI_HOLDS_NOTHING, 0},
    [MPM_WALL_FIXED] = {0, MPMI_HOLDS_ALL, 0},        [MPM_WALL_SLIP] = {0, MPMI_HOLDS_NORMAL, 0},
    [MPM_WALL_FRICTION] = {0, MPMI_HOLDS_NOTHING, 1},
};

const mpmi_wall_kind *mpmi_wall_kind_of(int32_t kind) {
  return kind >= 0 && kind < (int32_t)(sizeof kinds / sizeof *kinds) ? &kinds[kind] : NULL;
}
