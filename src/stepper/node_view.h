/* Nodal fields for the host: of a staged step while one is under way, of the last step otherwise. */
#ifndef MPMI_NODE_VIEW_H
#define MPMI_NODE_VIEW_H

#include "stepper/stepper.h"

enum {
  MPMI_NODE_INDEX,
  MPMI_NODE_POSITION,
  MPMI_NODE_MASS,
  MPMI_NODE_VELOCITY,
  MPMI_NODE_FORCE,
  MPMI_NODE_ACCELERATION,
  MPMI_NODE_REACTION,
  MPMI_NODE_CONTACT_FORCE, /* from here to area: of bodies that meet */
  MPMI_NODE_CONTACT_NORMAL,
  MPMI_NODE_CONTACT_GAP,
  MPMI_NODE_CONTACT_AREA,
  MPMI_NODE_TEMPERATURE,
  MPMI_NODE_OWNED,
  MPMI_NODE_FIELDS
};
typedef struct mpmi_node_field {
  const char *name;
  int32_t type, scalar; /* not scalar: dim components */
} mpmi_node_field;
extern const mpmi_node_field mpmi_node_fields[MPMI_NODE_FIELDS];

/* Finds the field that the host names: MPM_E_ARG for NULL, MPM_E_NOT_FOUND with the nearest names. */
mpm_status mpmi_node_require(mpm_context *context, const char *name, int32_t *field);
/* Returns MPM_E_STATE while there are no nodal fields. */
mpm_status mpmi_nodes_ready(const mpm_stepper *s);
/* Tells whether this kind of step has kept the field; the check returns MPM_E_UNSUPPORTED if not. */
int32_t mpmi_node_keeps(const mpm_stepper *s, int32_t field);
mpm_status mpmi_node_check_kept(const mpm_stepper *s, int32_t field);
/* Lists the slots of the active nodes in s->active, body by body; while nodal views are out it is there
 * already. *first becomes the first one of the body and *count how many it has. MPM_E_NOT_FOUND: there is no
 * such body. */
mpm_status mpmi_nodes_list(mpm_stepper *s, int32_t body, int64_t *first, int64_t *count);
/* Writes component c of the node in slot[i] to out[i * item_stride + c * component_stride], of the field's
 * type. */
void mpmi_node_values(const mpm_stepper *s, int32_t field, const int64_t *slot, int64_t n,
                      int64_t item_stride, int64_t component_stride, void *out);

#endif
