/**
 * @file contact.hpp
 * C++17: how bodies meet, and what came of it. See mpm.hpp.
 */
#ifndef MPM_CONTACT_HPP
#define MPM_CONTACT_HPP

#include <mpm/callback.hpp>
#include <mpm/contact.h>

namespace mpm {

/** An mpm_contact_desc that starts with the defaults. */
struct contact_desc : mpm_contact_desc {
  /** Starts with the defaults. */
  contact_desc() : mpm_contact_desc() {
    if (const mpm_status status = mpm_contact_desc_init(this, sizeof(mpm_contact_desc)))
      throw error(status, "mpm_contact_desc_init");
  }
};

/** An mpm_contact_info that is ready to be filled. */
struct contact_info : mpm_contact_info {
  /** Starts with struct_size set and zeros elsewhere. */
  contact_info() : mpm_contact_info() {
    struct_size = sizeof(mpm_contact_info);
  }
};

/** As mpm_friction_fn: takes batch and friction (mt). */
using friction_callback = callback<const mpm_contact_batch &, double *>;

} // namespace mpm

#endif
