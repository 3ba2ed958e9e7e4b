# SPDX-License-Identifier: Apache-2.0
# WebAssembly by Clang, and by the C++ library that Debian builds for it (tools/setup --wasm).
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang-22)
set(CMAKE_CXX_COMPILER clang++-22)
set(CMAKE_ASM_COMPILER clang-22)
foreach(language C CXX ASM)
    set(CMAKE_${language}_COMPILER_TARGET wasm32-wasi)
endforeach()
set(CMAKE_AR llvm-ar-22 CACHE STRING "")
set(CMAKE_RANLIB llvm-ranlib-22 CACHE STRING "")
# There is no program to be linked without the entry points of bindings/wasm.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

# -Wno-deprecated: Clang would rather be told wasm32-wasip1, under which Debian has no libraries.
# SIMD: without it the search of nearest triangles, nearly half of the work, takes twice the time.
set(wasm_flags "-Wno-deprecated -msimd128 -mbulk-memory -ffunction-sections -fdata-sections")
set(CMAKE_C_FLAGS_INIT "${wasm_flags}")
set(CMAKE_ASM_FLAGS_INIT -Wno-deprecated)
# The standard library has neither mutexes nor stop tokens without threads: runtime/std adds them.
set(CMAKE_CXX_FLAGS_INIT "${wasm_flags} -fwasm-exceptions -isystem ${CMAKE_CURRENT_LIST_DIR}/runtime/std")
