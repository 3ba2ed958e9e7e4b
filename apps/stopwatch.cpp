// SPDX-License-Identifier: GPL-3.0-or-later
#include "stopwatch.hpp"

#include <sys/resource.h>

#include <cstdint>
#include <utility>

namespace scaleaxis::app {

namespace {

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace

StageCost Stopwatch::lap(std::string stage) {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> elapsed = now - start_;
    start_ = now;
    return {std::move(stage), elapsed.count(), peak_memory()};
}

}  // namespace scaleaxis::app
