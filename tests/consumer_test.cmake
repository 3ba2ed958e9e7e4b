# SPDX-License-Identifier: Apache-2.0
# Installs the build in BUILD_DIR to a folder of its own, and builds and runs an example against that.
# cmake -D BUILD_DIR=... -D SOURCE_DIR=... -D WORK_DIR=... -P consumer_test.cmake
function(run)
    execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()
file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/installed)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G Ninja -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/installed)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/three_scales)
# What is installed may be moved to another machine: no file of it knows where the parts of this one are.
file(GLOB_RECURSE package_files ${WORK_DIR}/installed/*.cmake)
foreach(package_file ${package_files})
    file(STRINGS ${package_file} absolute_paths REGEX "(^|[;\" >])/(usr|lib|home|tmp)[^;\"]*[.](so|a)")
    if(absolute_paths)
        message(FATAL_ERROR "${package_file} has absolute paths: ${absolute_paths}")
    endif()
endforeach()
run(${WORK_DIR}/installed/bin/scaleaxis --version)
file(REMOVE_RECURSE ${WORK_DIR})
