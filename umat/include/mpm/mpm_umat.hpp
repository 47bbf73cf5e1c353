/**
 * @file mpm_umat.hpp
 * C++17: a UMAT or a VUMAT as a material. See mpm_umat.h and mpm.hpp.
 */
#ifndef MPM_UMAT_HPP
#define MPM_UMAT_HPP

#include <mpm/material.hpp>
#include <mpm/mpm_umat.h>

namespace mpm {

/** A UMAT or a VUMAT: the fields of mpm_umat_desc with their defaults, and containers in place of its
 * pointers. What is set here replaces the pointers. */
struct umat_desc : mpm_umat_desc {
  std::vector<double> properties;    /**< PROPS */
  std::vector<double> initial_state; /**< [nstatv] state of a new particle; empty: zeros */
  std::string name;                  /**< CMNAME */

  /** Takes the defaults. */
  umat_desc() : mpm_umat_desc{} {
    mpm_umat_desc_init(this, sizeof(mpm_umat_desc));
  }
};

namespace detail {

/** What C takes, while desc lives. */
inline mpm_umat_desc filled(const umat_desc &desc) {
  mpm_umat_desc plain = desc;
  if (!desc.properties.empty()) {
    plain.props = desc.properties.data();
    plain.nprops = static_cast<int32_t>(desc.properties.size());
  }
  if (!desc.initial_state.empty()) {
    expect_size("initial_state", desc.initial_state.size(), desc.nstatv);
    plain.statev_initial = desc.initial_state.data();
  }
  if (!desc.name.empty()) plain.cmname = desc.name.c_str();
  return plain;
}

} // namespace detail

/** Makes a material of a UMAT: see mpm_umat_material(). */
inline material umat_material(const context &made_with, mpm_umat_fn subroutine, const umat_desc &desc) {
  const mpm_umat_desc plain = detail::filled(desc);
  return {made_with,
          [&](mpm_context *c, mpm_material **out) { return mpm_umat_material(c, subroutine, &plain, out); }};
}

/** Makes a material of a VUMAT: see mpm_vumat_material(). */
inline material vumat_material(const context &made_with, mpm_vumat_fn subroutine, const umat_desc &desc) {
  const mpm_umat_desc plain = detail::filled(desc);
  return {made_with,
          [&](mpm_context *c, mpm_material **out) { return mpm_vumat_material(c, subroutine, &plain, out); }};
}

} // namespace mpm

#endif
