// SPDX-License-Identifier: Apache-2.0
/// \file
/// The version of the library: CMakeLists.txt reads it from here.
///
/// All headers declare in `scaleaxis::inline v1`. Users write `scaleaxis`; the names of symbols have the `v1`, which
/// becomes `v2` with the first release that programs have to be compiled anew for. So the linker, and not a crash, says
/// that a program was compiled for another one, and two libraries of a process may each bring their own.
#pragma once

#define SCALEAXIS_VERSION "0.1.0"
#define SCALEAXIS_VERSION_MAJOR 0
#define SCALEAXIS_VERSION_MINOR 1
#define SCALEAXIS_VERSION_PATCH 0
