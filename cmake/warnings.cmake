# SPDX-License-Identifier: Apache-2.0
# What every target of the project is compiled with. The presets make errors of warnings; a project that adds this one
# as a subdirectory, with a compiler that is not tested here, is not stopped by them. Contracting a·b + c to one rounding
# would make results differ between machines and void the error bounds of the predicates.
add_library(scaleaxis_build_options INTERFACE)
if(WIN32)
    # Its headers leave out what is not asked for, macros above all.
    target_compile_definitions(scaleaxis_build_options INTERFACE NOMINMAX NOGDI WIN32_LEAN_AND_MEAN)
endif()
if(MSVC)
    # It contracts nothing by default, and takes sources for text in the code page of the machine.
    target_compile_options(scaleaxis_build_options INTERFACE /W3 /utf-8 /bigobj /permissive-)
    return()
endif()
target_compile_options(
    scaleaxis_build_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                      -Wnon-virtual-dtor -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False alarm on std::string (GCC bug 105329), mended in GCC 13.
    target_compile_options(scaleaxis_build_options INTERFACE -Wno-restrict)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 14)
    # Conditions joined by | and & rather than || and && are meant: they have no branches.
    target_compile_options(scaleaxis_build_options INTERFACE -Wno-bitwise-instead-of-logical)
endif()
if(SCALEAXIS_BUILD_WASM)
    # Sizes in files are compared with the bytes that are there before they become a `std::size_t` of 32 bits. Without
    # files `OutputFile` needs no stream.
    target_compile_options(scaleaxis_build_options INTERFACE -Wno-shorten-64-to-32 -Wno-unused-private-field)
endif()
if(SCALEAXIS_SANITIZE)
    target_compile_options(scaleaxis_build_options INTERFACE -fsanitize=${SCALEAXIS_SANITIZE} -fno-omit-frame-pointer
                                                             -fno-sanitize-recover=all)
    target_link_options(scaleaxis_build_options INTERFACE -fsanitize=${SCALEAXIS_SANITIZE})
endif()
