# SPDX-License-Identifier: Apache-2.0
# Compiles the sources of each folder together, a few at a time (a unity build): half of what a compiler does with one of
# them is headers and templates that it shares with the others. -DCMAKE_UNITY_BUILD=OFF compiles them one by one.
function(scaleaxis_compile_together target)
    if(DEFINED CMAKE_UNITY_BUILD AND NOT CMAKE_UNITY_BUILD)
        return()
    endif()
    set(batch 10)  # smaller ones repeat more headers, and larger ones are seldom done at the same time on several cores
    get_target_property(sources ${target} SOURCES)
    foreach(source ${sources})
        file(RELATIVE_PATH path ${CMAKE_CURRENT_SOURCE_DIR} ${source})
        string(REGEX REPLACE "/.*" "" room ${path})
        string(MAKE_C_IDENTIFIER ${room} room)
        if(NOT path MATCHES "/")
            set(room ${target})
        endif()
        list(LENGTH ${room}_sources before)
        list(APPEND ${room}_sources ${source})
        math(EXPR number "${before} / ${batch}")
        set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room}_${number})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
