// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files where there are none (SCALEAXIS_WITH_FILES=OFF): writers write to memory.
#pragma once

#include <string>

namespace scaleaxis::io {

/// The bytes of the file that was committed last.
std::string take_written();

}  // namespace scaleaxis::io
