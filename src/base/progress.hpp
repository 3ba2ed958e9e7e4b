// SPDX-License-Identifier: Apache-2.0
/// \file
/// Progress of a call as a part of that of another.
#pragma once

#include <string_view>

#include "scaleaxis/execution.hpp"

namespace scaleaxis::inline v1 {

/// The same threads and cancellation, for a call that makes the progress from `begin` to `end` (0…1) of the whole.
/// \param execution must outlive the result
inline Execution part_of(const Execution& execution, double begin, double end) {
    Execution part = execution;
    if (execution.progress) {
        part.progress = [&execution, begin, end](std::string_view stage, double fraction) {
            return execution.progress(stage, fraction < 1.0 ? begin + fraction * (end - begin) : end);
        };
    }
    return part;
}

}  // namespace scaleaxis::inline v1
