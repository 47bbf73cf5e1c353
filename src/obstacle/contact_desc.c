#include "obstacle/contact_desc.h"
#include "context/structs.h"

#include <math.h>

const mpm_contact_desc mpmi_contact_defaults = {.struct_size = sizeof mpmi_contact_defaults};

mpm_status mpm_contact_desc_init(mpm_contact_desc *desc, uint32_t struct_size) {
  return mpmi_init_struct("mpm_contact_desc", &mpmi_contact_defaults, sizeof mpmi_contact_defaults, desc,
                          struct_size);
}

mpm_status mpmi_contact_desc_check_values(mpm_context *c, const mpm_contact_desc *d) {
  mpm_status status;
  if ((status = mpmi_check_choice(c, "kind", d->kind, "MPM_CONTACT_UNILATERAL ... MPM_CONTACT_TIED",
                                  MPM_CONTACT_TIED)) ||
      (status = mpmi_check_magnitude(c, "friction", d->friction)) ||
      (status = mpmi_check_magnitude(c, "friction_static", d->friction_static)) ||
      (status = mpmi_check_magnitude(c, "adhesion", d->adhesion)))
    return status;
  if (d->friction_static > 0.0 && d->friction_static < d->friction)
    return mpmi_fail(c, MPM_E_ARG, "friction_static is %g, less than friction %g", d->friction_static,
                     d->friction);
  if (!isfinite(d->offset)) return mpmi_fail(c, MPM_E_ARG, "offset is %g: it must be finite", d->offset);
  return MPM_OK;
}
