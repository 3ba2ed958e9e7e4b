// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {

/// A value that is built when it is first asked for. Of several threads that ask at once one builds it, and the others
/// wait. If building throws (`Cancelled`), the next thread tries again.
template <class T>
class BuiltOnce {
   public:
    BuiltOnce() = default;
    explicit BuiltOnce(T value) : value_(std::move(value)), is_built_(true) {}

    template <class Build>
    const T& get(const Build& build) const {
        if (!is_built_.load(std::memory_order_acquire)) {
            const std::lock_guard lock(mutex_);
            if (!is_built_.load(std::memory_order_relaxed)) {
                // Isolated: while this thread waits for a parallel loop of `build`, it must not run a task of the
                // caller that asks for the same value, and would wait for itself.
                tasks::this_task_arena::isolate([&] {
                    T value = build();
                    stop_if_cancelled();  // a cancelled loop may have left it unfinished
                    value_.emplace(std::move(value));
                });
                is_built_.store(true, std::memory_order_release);
            }
        }
        return *value_;
    }

   private:
    mutable std::mutex mutex_;
    mutable std::optional<T> value_;
    mutable std::atomic<bool> is_built_ = false;
};

}  // namespace scaleaxis::inline v1
