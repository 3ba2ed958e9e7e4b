# SPDX-License-Identifier: Apache-2.0
# What reads images: scaleaxis_itk_include and scaleaxis_itk_libraries, targets of our own whose names do not depend on
# where the libraries lie. Who links the installed library finds these again one by one (scaleaxis-config.cmake), and need
# not find the toolkit as a whole, which is slow and wants more languages than C++.
enable_language(C)
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)  # it and what it uses tell a lot
find_package(ITK 5.2 REQUIRED COMPONENTS ITKIONRRD ITKIONIFTI ITKIOMeta ITKIOTIFF ITKIOVTK ITKIOGDCM)
unset(CMAKE_MESSAGE_LOG_LEVEL)
set(scaleaxis_itk_include ${ITK_INCLUDE_DIRS})
list(REMOVE_ITEM scaleaxis_itk_include /usr/include)
list(REMOVE_DUPLICATES scaleaxis_itk_include)
set(scaleaxis_itk_names)
foreach(library ${ITK_LIBRARIES})
    if(TARGET ${library})
        get_target_property(type ${library} TYPE)
        if(type STREQUAL "INTERFACE_LIBRARY")
            continue()
        endif()
        get_target_property(library ${library} IMPORTED_LOCATION_NONE)
    endif()
    # "ITKCommon-5.2" of "/usr/lib/libITKCommon-5.2.so.1"; zlib is linked anyway.
    get_filename_component(name ${library} NAME)
    string(REGEX REPLACE "^lib|[.](so|a|dylib|lib).*$" "" name ${name})
    if(NOT name STREQUAL "z" AND NOT TARGET scaleaxis_itk::${name})
        add_library(scaleaxis_itk::${name} UNKNOWN IMPORTED)
        set_target_properties(scaleaxis_itk::${name} PROPERTIES IMPORTED_LOCATION ${library})
        list(APPEND scaleaxis_itk_names ${name})
    endif()
endforeach()
list(TRANSFORM scaleaxis_itk_names PREPEND scaleaxis_itk:: OUTPUT_VARIABLE scaleaxis_itk_libraries)
