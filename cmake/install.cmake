# SPDX-License-Identifier: Apache-2.0
include(CMakePackageConfigHelpers)
install(TARGETS scaleaxis EXPORT scaleaxis-targets)
install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY include/scaleaxis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT scaleaxis-targets NAMESPACE scaleaxis:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/scaleaxis)
configure_package_config_file(
    cmake/scaleaxis-config.cmake.in ${PROJECT_BINARY_DIR}/scaleaxis-config.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/scaleaxis)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/scaleaxis-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/scaleaxis-config.cmake ${PROJECT_BINARY_DIR}/scaleaxis-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/scaleaxis)
