// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a shared library of scaleaxis shows of itself. Static ones need nothing of this.
#pragma once

#if defined(_WIN32) && defined(SCALEAXIS_SHARED)
#if defined(scaleaxis_EXPORTS)  // CMake defines it while it compiles the library
#define SCALEAXIS_EXPORT __declspec(dllexport)
#else
#define SCALEAXIS_EXPORT __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define SCALEAXIS_EXPORT __attribute__((visibility("default")))
#else
#define SCALEAXIS_EXPORT
#endif
