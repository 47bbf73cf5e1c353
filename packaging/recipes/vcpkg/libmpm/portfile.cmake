# An overlay port: it builds the checkout that it lies in, shared and static.
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../../.." ABSOLUTE)
# Both kinds are built and installed, as mpm::mpm and mpm::mpm_static.
set(VCPKG_POLICY_DLLS_IN_STATIC_LIBRARY enabled)

vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURE_OPTIONS FEATURES baseline-only MPM_BASELINE_ONLY)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS -DMPM_INSTALL=ON ${FEATURE_OPTIONS})
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME mpm CONFIG_PATH lib/cmake/mpm)
# It has moved from lib/cmake/mpm to share/mpm, and its paths are relative to where it lies.
set(_config "${CURRENT_PACKAGES_DIR}/share/mpm/mpmConfig.cmake")
vcpkg_replace_string("${_config}" [["${_mpm_here}/../.."]] [["${_mpm_here}/../../lib"]])
vcpkg_replace_string("${_config}" [["../../../include"]] [["../../include"]])
vcpkg_replace_string("${_config}" [["../../../bin"]] [["../../bin"]])
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
