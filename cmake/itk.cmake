# SPDX-License-Identifier: GPL-3.0-or-later
# What reads images: scaleaxis_itk_include and scaleaxis_itk_libraries. The libraries are files rather than targets, so
# that who links the installed library need not find the toolkit, which is slow and wants more languages than C++.
enable_language(C)
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)  # it and what it uses tell a lot
find_package(ITK 5.2 REQUIRED COMPONENTS ITKIONRRD ITKIONIFTI ITKIOMeta ITKIOTIFF ITKIOVTK ITKIOGDCM)
unset(CMAKE_MESSAGE_LOG_LEVEL)
set(scaleaxis_itk_include ${ITK_INCLUDE_DIRS})
list(REMOVE_ITEM scaleaxis_itk_include /usr/include)
list(REMOVE_DUPLICATES scaleaxis_itk_include)
set(scaleaxis_itk_libraries)
foreach(library ${ITK_LIBRARIES})
    if(TARGET ${library})
        get_target_property(type ${library} TYPE)
        if(type STREQUAL "INTERFACE_LIBRARY")
            continue()
        endif()
        get_target_property(library ${library} IMPORTED_LOCATION_NONE)
    endif()
    list(APPEND scaleaxis_itk_libraries ${library})
endforeach()
