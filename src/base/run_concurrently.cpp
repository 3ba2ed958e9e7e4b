// SPDX-License-Identifier: Apache-2.0

#include <atomic>
#include <cstddef>
#include <functional>

#include "base/parallel.hpp"
#include "scaleaxis/execution.hpp"

namespace scaleaxis::inline v1 {

void run_concurrently(std::size_t count, const std::function<void(std::size_t)>& work, const Execution& execution) {
    in_arena(execution, [&] {
        std::atomic<std::size_t> next = 0;  // so that the order is that of `i`, whichever part of the range comes first
        // A thread that waits within one piece of work must not begin another whole one meanwhile.
        const auto begin_next = [&](std::size_t) { tasks::this_task_arena::isolate([&] { work(next++); }); };
        tasks::parallel_for(std::size_t{0}, count, begin_next, tasks::simple_partitioner());
        stop_if_cancelled();
    });
}

}  // namespace scaleaxis::inline v1
