// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Parallel loops over index ranges, and the arena that a public call runs in.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::kernel {

/// Runs `work` in an arena of as many threads as `execution` asks for, and returns what it returns. Inside an arena of
/// an outer call with the same `execution` this costs nothing.
template <class Work>
auto in_arena(const Execution& execution, Work&& work) {
    if (execution.threads < 0) {
        throw InvalidOption("the number of threads must be at least 1, or 0 for all that the machine has");
    }
    const int threads = execution.threads > 0 ? execution.threads : tbb::task_arena::automatic;
    if (execution.threads > 0 && tbb::this_task_arena::max_concurrency() == execution.threads) {
        return std::forward<Work>(work)();
    }
    return tbb::task_arena(threads).execute(std::forward<Work>(work));
}

/// Calls `body(i)` for `0 ≤ i < count`, in parallel; one after the other where the work is too small to share.
template <class Size, class Body>
void for_each_index(Size count, const Body& body, Size grain = 1024) {
    if (count <= grain) {
        for (Size i = 0; i < count; ++i) {
            body(i);
        }
        return;
    }
    tbb::parallel_for(tbb::blocked_range<Size>(0, count, grain), [&](const tbb::blocked_range<Size>& range) {
        for (Size i = range.begin(); i != range.end(); ++i) {
            body(i);
        }
    });
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& part) {
    all.insert(all.end(), part.begin(), part.end());
}

/// Of all parts the vector that `of(part)` is, in their order, as one. Empties the parts on its way, since they are as
/// large as the whole.
template <class Part, class Of>
auto joined(std::vector<Part>& parts, const Of& of) {
    std::size_t size = 0;
    for (Part& part : parts) {
        size += std::invoke(of, part).size();
    }
    std::remove_cvref_t<std::invoke_result_t<Of, Part&>> all;
    all.reserve(size);
    for (Part& part : parts) {
        append(all, std::exchange(std::invoke(of, part), {}));
    }
    return all;
}

template <class T>
std::vector<T> join(std::vector<std::vector<T>>& parts) {
    return joined(parts, std::identity());
}

/// Calls `body(i, out)` for `0 ≤ i < count`, in parallel, and returns all that was appended to `out` in the order of
/// `i`. `Out` is a vector, or has a default constructor and a `join(parts)` that argument-dependent look-up finds.
template <class Out, class Size, class Body>
Out collect(Size count, const Body& body, Size grain = 4096) {
    std::vector<Out> parts((count + grain - 1) / grain);
    for_each_index(
        parts.size(),
        [&](std::size_t part) {
            const Size begin = static_cast<Size>(part) * grain;
            const Size end = std::min<Size>(count, begin + grain);
            for (Size i = begin; i < end; ++i) {
                body(i, parts[part]);
            }
        },
        std::size_t{1});
    return join(parts);
}

/// Reports progress and throws `Cancelled` if the callback says so. `part` runs from 0 to 1 within the stage.
inline void report(const Execution& execution, std::string_view stage, double part) {
    if (execution.progress && !execution.progress(stage, part)) {
        throw Cancelled();
    }
}

}  // namespace scaleaxis::kernel
