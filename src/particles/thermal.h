/* Temperatures of a set whose heat is described. */
#ifndef MPMI_THERMAL_H
#define MPMI_THERMAL_H

#include "particles/particles.h"

/* Gives a set the fields of temperature, or finds those that the host has added: all or nothing. */
mpm_status mpmi_thermal_make(mpm_particles *set, double expansion, double reference);
/* The set knows of no temperature any more; the fields stay with the host. */
void mpmi_thermal_drop(mpm_particles *set);
/* Gives new particles the reference temperature. */
void mpmi_thermal_start(mpm_particles *set, int64_t begin, int64_t end);

static inline int32_t mpmi_expands(const mpm_particles *set) {
  return set->thermal.expansion != 0.0;
}
/* Returns the temperatures that the stress belongs to: of the state, or of the step under way. */
static inline const double *mpmi_stress_temperature(const mpm_particles *set, int32_t copy) {
  return copy && set->thermal.next ? set->thermal.next : mpmi_f64(set, set->thermal.stress_temperature, 0);
}

#endif
