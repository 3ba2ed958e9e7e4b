// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parallel loops over index ranges, and the arena that a public call runs in.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/arenas.hpp"
#include "base/tasks.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Throws `Cancelled` if the public call that this is part of was cancelled (`Execution::cancel`). Parallel loops ask
/// by themselves; sequential ones should every few milliseconds.
inline void stop_if_cancelled() {
    if (tasks::is_current_task_group_canceling()) {
        throw Cancelled();
    }
}

/// `stop_if_cancelled` for tight sequential loops: asks at every `interval`-th call.
class CancellationPoint {
   public:
    explicit CancellationPoint(unsigned interval = 1024) : interval_(interval) {}
    void operator()() {
        if (++calls_ == interval_) {
            calls_ = 0;
            stop_if_cancelled();
        }
    }

   private:
    unsigned interval_;
    unsigned calls_ = 0;
};

/// Runs `work` on this thread so that all parallel loops and cancellation points in it see `cancel`. A cancelled group
/// of tasks is how TBB stops loops, those of other threads included.
template <class Work>
auto cancellable(const std::stop_token& cancel, Work&& work) {
    using Result = std::invoke_result_t<Work>;
    tasks::task_group_context context;
    const std::stop_callback stop(cancel, [&] { context.cancel_group_execution(); });
    tasks::task_group group(context);
    if constexpr (std::is_void_v<Result>) {
        if (group.run_and_wait([&] { work(); }) == tasks::canceled) {
            throw Cancelled();
        }
    } else {
        std::optional<Result> result;
        if (group.run_and_wait([&] { result.emplace(work()); }) == tasks::canceled || !result) {
            throw Cancelled();
        }
        return std::move(*result);
    }
}

/// Runs `work` with as many threads as `execution` asks for, and returns what it returns. Where the calling thread's
/// own arena has as many (always within an outer call with the same `execution`), it works there.
template <class Work>
auto in_arena(const Execution& execution, Work&& work) {
    if (execution.threads < 0) {
        throw InvalidOption("the number of threads must be at least 1, or 0 for all that the machine has");
    }
    const auto run = [&] {
        return execution.cancel.stop_possible() ? cancellable(execution.cancel, std::forward<Work>(work))
                                                : std::forward<Work>(work)();
    };
    if (execution.threads == 0 || tasks::this_task_arena::max_concurrency() == execution.threads) {
        // Isolated: while this thread waits, it must not begin another task of its caller, who may hold a lock.
        return tasks::this_task_arena::isolate(run);
    }
    BorrowedArena arena(execution.threads);
    return (*arena).execute(run);
}

/// Calls `body(i)` for `0 ≤ i < count`, in parallel; one after the other where the work is too small to share. Asks
/// after every `grain` calls whether it is cancelled.
template <class Size, class Body>
void for_each_index(Size count, const Body& body, Size grain = 1024) {
    if (count <= grain) {
        for (Size i = 0; i < count; ++i) {
            body(i);
        }
        return;
    }
    tasks::parallel_for(tasks::blocked_range<Size>(0, count, grain), [&](const tasks::blocked_range<Size>& range) {
        for (Size i = range.begin(); i != range.end() && !tasks::is_current_task_group_canceling();) {
            for (const Size end = i + std::min<Size>(grain, range.end() - i); i != end; ++i) {
                body(i);
            }
        }
    });
    stop_if_cancelled();
}

/// The values of `of(i)` for `0 ≤ i < count`, which are found in parallel.
template <class T, class Size, class Of>
std::vector<T> mapped(Size count, const Of& of, Size grain = 1024) {
    std::vector<T> result(static_cast<std::size_t>(count));
    for_each_index(
        count, [&](Size i) { result[i] = static_cast<T>(of(i)); }, grain);
    return result;
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& part) {
    all.insert(all.end(), part.begin(), part.end());
}

/// Concatenates the vectors `of(part)` in the order of the parts. Empties the parts on its way, since they are as large
/// as the whole. Asks at each whether it is cancelled.
template <class Part, class Of>
auto joined(std::vector<Part>& parts, const Of& of) {
    std::size_t size = 0;
    for (Part& part : parts) {
        size += std::invoke(of, part).size();
    }
    std::remove_cvref_t<std::invoke_result_t<Of, Part&>> all;
    all.reserve(size);
    for (Part& part : parts) {
        stop_if_cancelled();  // gigabytes take seconds
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

/// Calls all of these functions, at the same time where threads are free.
template <class... Work>
void run_together(const Work&... work) {
    tasks::parallel_invoke(work...);
    stop_if_cancelled();
}

/// Reports progress and throws `Cancelled` if the callback says so. `part` runs from 0 to 1 within the stage.
inline void report(const Execution& execution, std::string_view stage, double part) {
    stop_if_cancelled();
    if (execution.progress && !execution.progress(stage, part)) {
        throw Cancelled();
    }
}

}  // namespace scaleaxis::inline v1
