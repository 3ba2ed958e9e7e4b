# SPDX-License-Identifier: Apache-2.0
# What draws SVG: PkgConfig::scaleaxis_rsvg.
find_package(PkgConfig REQUIRED)
pkg_check_modules(scaleaxis_rsvg IMPORTED_TARGET librsvg-2.0)
if(NOT scaleaxis_rsvg_FOUND)
    message(FATAL_ERROR "librsvg is not here (librsvg2-dev); -DSCALEAXIS_WITH_RSVG=OFF does without it")
endif()
