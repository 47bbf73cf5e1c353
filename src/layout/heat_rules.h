/* What the host has said of heat: sets, faces and how nodes conduct. */
#ifndef MPMI_HEAT_RULES_H
#define MPMI_HEAT_RULES_H

#include <mpm/mpm.h>

typedef struct mpmi_heat_rule {
  int32_t on;
  mpm_heat_desc desc;
} mpmi_heat_rule;

typedef struct mpmi_heat_wall {
  int32_t kind; /* MPM_HEAT_WALL_... */
  double temperature;
} mpmi_heat_wall;

typedef struct mpmi_heat_rules {
  int32_t any;         /* some set is described: only then do steps know of heat */
  mpmi_heat_rule *set; /* [sets] */
  int64_t capacity;
  int32_t conduction; /* MPM_CONDUCTION_... */
  double tolerance;
  mpmi_heat_wall wall[6];
  int64_t walls; /* counts changes of their kinds */
} mpmi_heat_rules;

#endif
