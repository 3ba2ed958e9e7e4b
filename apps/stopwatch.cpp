// SPDX-License-Identifier: Apache-2.0
#include "stopwatch.hpp"

#include <utility>

namespace scaleaxis::app {

StageCost Stopwatch::lap(std::string stage) {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> elapsed = now - start_;
    start_ = now;
    return {std::move(stage), elapsed.count(), peak_memory()};
}

}  // namespace scaleaxis::app
