// SPDX-License-Identifier: Apache-2.0
/// \file
/// The part of oneTBB that the library uses, on the calling thread alone.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <utility>

namespace scaleaxis::inline v1::tasks {

template <class Value>
class blocked_range {
   public:
    blocked_range(Value begin, Value end, std::size_t grain) : begin_(begin), end_(end), grain_(grain) {}
    Value begin() const { return begin_; }
    Value end() const { return end_; }
    std::size_t grainsize() const { return grain_; }

   private:
    Value begin_;
    Value end_;
    std::size_t grain_;
};

enum task_group_status { complete, canceled };

/// What cancels a group of tasks, and with it the groups within.
class task_group_context {
   public:
    void cancel_group_execution() { is_cancelled_ = true; }
    bool is_group_execution_cancelled() const {
        return is_cancelled_ || (outer_ != nullptr && outer_->is_group_execution_cancelled());
    }

   private:
    friend class task_group;
    friend bool is_current_task_group_canceling();

    std::atomic<bool> is_cancelled_ = false;
    const task_group_context* outer_ = nullptr;
    static inline thread_local const task_group_context* current_ = nullptr;
};

inline bool is_current_task_group_canceling() {
    const task_group_context* const current = task_group_context::current_;
    return current != nullptr && current->is_group_execution_cancelled();
}

class task_group {
   public:
    explicit task_group(task_group_context& context) : context_(context) {}

    template <class Work>
    task_group_status run_and_wait(const Work& work) {
        struct Restored {
            const task_group_context* outer;
            ~Restored() { task_group_context::current_ = outer; }
        };
        context_.outer_ = task_group_context::current_;
        const Restored restored{std::exchange(task_group_context::current_, &context_)};
        work();
        return context_.is_group_execution_cancelled() ? canceled : complete;
    }

   private:
    task_group_context& context_;
};

struct simple_partitioner {};

/// In pieces of the grain, so that a cancelled group stops between two of them.
template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
    for (Value begin = range.begin(); begin < range.end() && !is_current_task_group_canceling();) {
        const auto left = static_cast<std::size_t>(range.end() - begin);
        const auto end = static_cast<Value>(begin + static_cast<Value>(std::min(left, range.grainsize())));
        body(blocked_range<Value>(begin, end, range.grainsize()));
        begin = end;
    }
}

template <class Value, class Body>
void parallel_for(Value begin, Value end, const Body& body, simple_partitioner = {}) {
    for (Value i = begin; i < end && !is_current_task_group_canceling(); ++i) {
        body(i);
    }
}

template <class... Work>
void parallel_invoke(const Work&... work) {
    (work(), ...);
}

template <class Iterator, class Compare = std::less<>>
void parallel_sort(Iterator begin, Iterator end, const Compare& compare = {}) {
    std::sort(begin, end, compare);
}

class task_arena {
   public:
    explicit task_arena(int) {}
    template <class Work>
    auto execute(const Work& work) {
        return work();
    }
};

namespace this_task_arena {

template <class Work>
auto isolate(const Work& work) {
    return work();
}
inline int max_concurrency() { return 1; }

}  // namespace this_task_arena

template <class T>
class enumerable_thread_specific {
   public:
    template <class Make>
    explicit enumerable_thread_specific(const Make& make) : value_(make()) {}
    T& local() { return value_; }

   private:
    T value_;
};

}  // namespace scaleaxis::inline v1::tasks
