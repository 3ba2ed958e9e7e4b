# SPDX-License-Identifier: Apache-2.0
# The README must show the examples as they are, without their comments at the top.
# cmake -D SOURCE_DIR=... -P readme_test.cmake
file(READ ${SOURCE_DIR}/README.md readme)
foreach(example first_axis.cpp three_scales.sh)
    file(READ ${SOURCE_DIR}/examples/${example} text)
    string(FIND "${text}" "\n\n" end_of_comment)
    math(EXPR begin "${end_of_comment} + 2")
    string(SUBSTRING "${text}" ${begin} -1 code)
    string(FIND "${readme}" "\n${code}```" position)
    if(position EQUAL -1)
        message(FATAL_ERROR "README.md does not show examples/${example} as it is")
    endif()
endforeach()
