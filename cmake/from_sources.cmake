# SPDX-License-Identifier: Apache-2.0
# The libraries that scaleaxis needs, for a system or a C++ library that Debian does not build them for: headers of the
# system's packages, and Debian's sources of the others. Every find_package of them finds what is defined here.
enable_language(C)
set(sources ${PROJECT_SOURCE_DIR}/build/ports-sources)
execute_process(
    COMMAND ${PROJECT_SOURCE_DIR}/tools/debian-sources ${sources} zlib bzip2 pugixml muparser tiff onetbb googletest
    COMMAND_ERROR_IS_FATAL ANY)

# \param version which find_package may ask for
function(is_found package version)
    set(file ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package})
    file(WRITE ${file}Config.cmake "")
    file(WRITE ${file}ConfigVersion.cmake "set(PACKAGE_VERSION ${version})\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
endfunction()

# Never the system's include folder itself: its C library is another one.
set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
# \param ARGN folders of /usr/include
function(add_headers package target)
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${target} INTERFACE ${headers})
    foreach(folder ${ARGN})
        if(NOT EXISTS /usr/include/${folder})
            message(FATAL_ERROR "/usr/include/${folder} is not there: tools/setup --ports")
        endif()
        get_filename_component(name ${folder} NAME)
        file(CREATE_LINK /usr/include/${folder} ${headers}/${name} SYMBOLIC)
    endforeach()
    is_found(${package} 99)
endfunction()
add_headers(Boost Boost::headers boost)
add_headers(Eigen3 Eigen3::Eigen eigen3/Eigen)
add_headers(nlohmann_json nlohmann_json::nlohmann_json nlohmann)
add_headers(CLI11 CLI11::CLI11 CLI)
if(SCALEAXIS_BUILD_TESTS)
    add_headers(CGAL CGAL::CGAL CGAL)
    # Its Boost has base classes that C++17 has not.
    target_compile_definitions(CGAL::CGAL INTERFACE CGAL_USE_GMP CGAL_USE_MPFR
                                                    _LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION)
    target_link_libraries(CGAL::CGAL INTERFACE mpfr gmp)  # in C
    if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        # Its iterators call a base that they have not, in members that nothing calls: recent ones look at these, too. What
        # is parsed late is warned of, as if its header were not the system's.
        target_compile_options(CGAL::CGAL INTERFACE -fdelayed-template-parsing -Wno-delayed-template-parsing-in-cxx20)
        target_compile_definitions(CGAL::CGAL INTERFACE _LIBCPP_DISABLE_DEPRECATION_WARNINGS)
    endif()
endif()

# \param ARGN files below `folder`
function(add_sources package target folder)
    list(TRANSFORM ARGN PREPEND ${sources}/${folder}/)
    string(REPLACE "::" "_" name ${target})
    add_library(${name} STATIC EXCLUDE_FROM_ALL ${ARGN})
    add_library(${target} ALIAS ${name})
    target_compile_options(${name} PRIVATE -w)
    target_include_directories(${name} SYSTEM PUBLIC ${sources}/${folder})
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    is_found(${package} 99)
endfunction()
add_sources(ZLIB ZLIB::ZLIB zlib adler32.c compress.c crc32.c deflate.c gzclose.c gzlib.c gzread.c gzwrite.c infback.c
            inffast.c inflate.c inftrees.c trees.c uncompr.c zutil.c)
add_sources(BZip2 BZip2::BZip2 bzip2 blocksort.c bzlib.c compress.c crctable.c decompress.c huffman.c randtable.c)
add_sources(pugixml pugixml::pugixml pugixml/src pugixml.cpp)
file(GLOB files RELATIVE ${sources}/muparser/src ${sources}/muparser/src/muParser*.cpp)
list(FILTER files EXCLUDE REGEX DLL)
add_sources(muparser muparser::muparser muparser/src ${files})
target_include_directories(muparser_muparser SYSTEM PUBLIC ${sources}/muparser/include)
target_compile_definitions(muparser_muparser PUBLIC MUPARSER_STATIC)
if(NOT WIN32)
    target_compile_definitions(ZLIB_ZLIB PRIVATE HAVE_UNISTD_H)
endif()

# These two look at the system: they have a CMake of their own.
function(add_project folder)
    set(CMAKE_COMPILE_WARNING_AS_ERROR OFF)
    set(CMAKE_POLICY_DEFAULT_CMP0077 NEW)
    set(BUILD_SHARED_LIBS OFF)
    set(BUILD_TESTING OFF)
    set(CMAKE_POSITION_INDEPENDENT_CODE ON)
    foreach(part tiff-tools tiff-tests tiff-contrib tiff-docs jpeg old-jpeg jbig lerc lzma pixarlog webp zstd libdeflate
                 TBB_TEST TBB_EXAMPLES TBB_STRICT TBBMALLOC_BUILD TBB_DIR)
        set(${part} OFF)
    endforeach()
    add_subdirectory(${sources}/${folder} ${CMAKE_BINARY_DIR}/${folder} EXCLUDE_FROM_ALL SYSTEM)
endfunction()
if(SCALEAXIS_WITH_FILES)
    add_project(tiff)
    target_compile_options(tiff PRIVATE -w)
    target_include_directories(tiff SYSTEM INTERFACE ${sources}/tiff/libtiff ${CMAKE_BINARY_DIR}/tiff/libtiff)
    is_found(TIFF 99)
endif()
if(SCALEAXIS_THREADS)
    add_project(onetbb)
    target_compile_options(tbb PRIVATE -w)
    is_found(TBB 99)
endif()
if(SCALEAXIS_BUILD_TESTS)
    add_sources(GTest GTest::gtest_main googletest/googletest src/gtest-all.cc src/gtest_main.cc)
    target_include_directories(GTest_gtest_main SYSTEM PUBLIC ${sources}/googletest/googletest/include)
endif()
