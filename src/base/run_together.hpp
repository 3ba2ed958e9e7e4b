// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {

/// Calls all of these functions, at the same time where threads are free.
template <class... Work>
void run_together(const Work&... work) {
    tasks::parallel_invoke(work...);
    stop_if_cancelled();
}

}  // namespace scaleaxis::inline v1
