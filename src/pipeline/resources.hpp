// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace scaleaxis {

/// The largest resident memory that the process has had so far, in bytes; 0 if the system does not tell.
std::uint64_t peak_memory();

}  // namespace scaleaxis
