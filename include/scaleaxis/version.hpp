// SPDX-License-Identifier: Apache-2.0
/// \file
/// The version of the library: CMakeLists.txt reads it from here.
#pragma once

#define SCALEAXIS_VERSION "0.1.0"
#define SCALEAXIS_VERSION_MAJOR 0
#define SCALEAXIS_VERSION_MINOR 1
#define SCALEAXIS_VERSION_PATCH 0
