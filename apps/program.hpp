// SPDX-License-Identifier: Apache-2.0
// The whole program but for its process: signals and memory are the entry's.
#pragma once

#include <stop_token>

#include "status.hpp"

namespace scaleaxis::app {

/// Parses the arguments, runs the command they name, and reports errors on stderr. Callable repeatedly.
Status run_program(int argc, const char* const* argv, const std::stop_token& cancel);

}  // namespace scaleaxis::app
