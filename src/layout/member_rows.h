/* What a step finds out about the particles of each set, beside their fields. */
#ifndef MPMI_MEMBER_ROWS_H
#define MPMI_MEMBER_ROWS_H

#include "layout/sorted_layout.h"

/* Rows of heat: the temperature at the end of the step, before what the material dissipates in it; that
 * work; what the law's energy and its growth of volume were before; and in the same place, until they are
 * known, the power of the host's sources. */
enum {
  MPMI_ROW_TEMPERATURE,
  MPMI_ROW_DISSIPATED,
  MPMI_ROW_ENERGY,
  MPMI_ROW_GROWTH,
  MPMI_HEAT_ROWS,
  MPMI_ROW_POWER = MPMI_ROW_ENERGY
};

/* Rows [components][ld of the set] for one set. NULL: the step does not need them. */
typedef struct mpmi_member_rows {
  double *force;        /* [dim] external force beside gravity */
  double *mean;         /* [dim] mean velocities of prescribed particles, where there is a motion */
  double *wave_speed;   /* [1] where the law runs before the particles move: what its batch has, with squares
                           where that has squares */
  double *nodal_stress; /* the stress in the forces on nodes, where it is not that of the particles
                           (stages/cell_pressure.c) */
  double *heat;         /* [MPMI_HEAT_ROWS] where the set has heat: MPMI_ROW_... */
  int64_t force_ld, mean_ld, wave_speed_ld, nodal_stress_ld, heat_ld;
} mpmi_member_rows;

typedef struct mpmi_step_rows {
  mpmi_member_rows *of; /* [count], by the numbers of the sets */
  int64_t count;
} mpmi_step_rows;

/* Makes room for a step with the present sets, and gives back what none of them needs. */
mpm_status mpmi_member_rows_prepare(mpmi_step_rows *rows, const mpmi_settings *settings,
                                    const mpmi_layout *layout);
void mpmi_member_rows_free(mpmi_step_rows *rows, const mpmi_settings *settings);

#endif
