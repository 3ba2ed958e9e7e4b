// SPDX-License-Identifier: Apache-2.0
/// \file
/// Seconds and peak memory of what the program does around the library's stages.
#pragma once

#include <chrono>
#include <string>

#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::app {

class Stopwatch {
   public:
    /// What was spent since the last lap, or the start, under the name `stage`.
    StageCost lap(std::string stage);

   private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace scaleaxis::app
