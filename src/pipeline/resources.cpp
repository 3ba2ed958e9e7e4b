// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/scale_axis.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif
#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

namespace scaleaxis::inline v1 {

std::uint64_t peak_memory() {
#if defined(__linux__)
    // The peak that getrusage has begins with that of the process which started this one.
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::uint64_t kilobytes = 0;
        if (word == "VmHWM:" && status >> kilobytes) {
            return kilobytes * 1024;
        }
    }
#endif
#if defined(__unix__) || defined(__APPLE__)
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) == 0) {
#if defined(__APPLE__)
        return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
        return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
    }
#endif
    return 0;
}

void keep_freed_memory() {
#if defined(__GLIBC__)
    constexpr int kLargest = std::numeric_limits<int>::max();
    mallopt(M_MMAP_THRESHOLD, kLargest);
    mallopt(M_TRIM_THRESHOLD, kLargest);
#endif
}

}  // namespace scaleaxis::inline v1
