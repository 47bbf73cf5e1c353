/**
 * @file heat.hpp
 * The heat of sets, from C++: see heat.h.
 */
#ifndef MPM_HEAT_HPP
#define MPM_HEAT_HPP

#include <mpm/callback.hpp>
#include <mpm/heat.h>

namespace mpm {

/** mpm_heat_desc with its defaults. */
struct heat_desc : mpm_heat_desc {
  heat_desc() : mpm_heat_desc() {
    if (const mpm_status status = mpm_heat_desc_init(this, sizeof(mpm_heat_desc)))
      throw error(status, "mpm_heat_desc_init");
  }
};

/** An mpm_heat_info that is ready to be filled. */
struct heat_info : mpm_heat_info {
  heat_info() : mpm_heat_info() {
    struct_size = sizeof(mpm_heat_info);
  }
};

/** As mpm_heat_fn: writes a power per volume for each particle. */
using heat_callback = callback<const mpm_particle_batch &, double *>;

} // namespace mpm

#endif
