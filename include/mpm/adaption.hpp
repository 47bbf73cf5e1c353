/**
 * @file adaption.hpp
 * How sets adapt, from C++: see adaption.h.
 */
#ifndef MPM_ADAPTION_HPP
#define MPM_ADAPTION_HPP

#include <mpm/adaption.h>
#include <mpm/callback.hpp>

namespace mpm {

/** mpm_adaption_desc with its defaults. */
struct adaption_desc : mpm_adaption_desc {
  adaption_desc() : mpm_adaption_desc() {
    if (const mpm_status status = mpm_adaption_desc_init(this, sizeof(mpm_adaption_desc)))
      throw error(status, "mpm_adaption_desc_init");
  }
};

/** An mpm_adaption_info that is ready to be filled. */
struct adaption_info : mpm_adaption_info {
  adaption_info() : mpm_adaption_info() {
    struct_size = sizeof(mpm_adaption_info);
  }
};

/** As mpm_adaption_fn: writes 0 for what is to be left as it is. */
using adaption_callback = callback<const mpm_adaption_batch &, uint8_t *>;

} // namespace mpm

#endif
