// SPDX-License-Identifier: Apache-2.0
#include <limits>

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
