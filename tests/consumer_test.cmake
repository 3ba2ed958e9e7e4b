# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the build in BUILD_DIR to a folder of its own, and builds and runs the consumer against that.
# cmake -D BUILD_DIR=... -D SOURCE_DIR=... -D WORK_DIR=... -P consumer_test.cmake
function(run)
    execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()
file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/installed)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G Ninja -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/installed)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer)
run(${WORK_DIR}/installed/bin/scaleaxis --version)
file(REMOVE_RECURSE ${WORK_DIR})
