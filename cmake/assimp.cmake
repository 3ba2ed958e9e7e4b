# SPDX-License-Identifier: Apache-2.0
# What reads scenes: scaleaxis_assimp, a target of our own, for that of Debian's package names libraries that it does not
# bring, by their places.
find_path(scaleaxis_assimp_include assimp/Importer.hpp)
find_library(scaleaxis_library_assimp NAMES assimp)
mark_as_advanced(scaleaxis_assimp_include scaleaxis_library_assimp)
if(NOT scaleaxis_assimp_include OR NOT scaleaxis_library_assimp)
    message(FATAL_ERROR "Assimp is not here (libassimp-dev); -DSCALEAXIS_WITH_ASSIMP=OFF does without it")
endif()
add_library(scaleaxis_assimp UNKNOWN IMPORTED)
set_target_properties(
    scaleaxis_assimp PROPERTIES IMPORTED_LOCATION ${scaleaxis_library_assimp} INTERFACE_INCLUDE_DIRECTORIES
                                                                              ${scaleaxis_assimp_include})
