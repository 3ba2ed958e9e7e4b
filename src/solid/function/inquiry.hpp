// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computations that need values of a function, interleaved so that the function is asked for many places at once.
#pragma once

#include <coroutine>
#include <exception>
#include <span>
#include <utility>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// What a suspended computation waits for.
struct PendingValue {
    Point place;
    double value = 0.0;
};

/// A computation as a coroutine: `co_await ValueAt{place}` suspends it until the value at this place is known. It runs
/// up to its first question when it is called, and must not outlive its arguments.
template <class Result>
class Inquiry {
   public:
    struct promise_type {
        PendingValue pending;
        Result result{};

        Inquiry get_return_object() { return Inquiry(std::coroutine_handle<promise_type>::from_promise(*this)); }
        std::suspend_never initial_suspend() noexcept { return {}; }
        std::suspend_always final_suspend() noexcept { return {}; }
        void return_value(Result value) { result = std::move(value); }
        void unhandled_exception() { throw; }
    };

    Inquiry(Inquiry&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Inquiry(const Inquiry&) = delete;
    Inquiry& operator=(const Inquiry&) = delete;
    Inquiry& operator=(Inquiry&&) = delete;
    ~Inquiry() {
        if (handle_) {
            handle_.destroy();
        }
    }

    bool is_done() const { return handle_.done(); }
    /// Where it wants the value.
    const Point& place() const { return handle_.promise().pending.place; }
    /// Tells it the value there, and lets it go on to its next question or its end.
    void answer(double value) {
        handle_.promise().pending.value = value;
        handle_.resume();
    }
    Result& result() { return handle_.promise().result; }

   private:
    explicit Inquiry(std::coroutine_handle<promise_type> handle) : handle_(handle) {}

    std::coroutine_handle<promise_type> handle_;
};

/// The value at a place; where it `is_known` nothing is asked.
struct ValueAt {
    Point place;
    double value = 0.0;
    bool is_known = false;
    PendingValue* pending = nullptr;

    bool await_ready() const noexcept { return is_known; }
    template <class Promise>
    void await_suspend(std::coroutine_handle<Promise> handle) noexcept {
        pending = &handle.promise().pending;
        pending->place = place;
    }
    double await_resume() const noexcept { return pending != nullptr ? pending->value : value; }
};

/// Runs all inquiries to their ends, with one call of `evaluate(places, values)` for the questions that are open at a
/// time.
template <class Result, class Evaluate>
void answer_all(std::span<Inquiry<Result>> inquiries, const Evaluate& evaluate) {
    std::vector<Inquiry<Result>*> open;
    for (Inquiry<Result>& inquiry : inquiries) {
        open.push_back(&inquiry);
    }
    std::vector<Point> places;
    std::vector<double> values;
    while (true) {
        std::erase_if(open, [](const Inquiry<Result>* inquiry) { return inquiry->is_done(); });
        if (open.empty()) {
            return;
        }
        places.clear();
        for (const Inquiry<Result>* inquiry : open) {
            places.push_back(inquiry->place());
        }
        values.resize(places.size());
        evaluate(std::span<const Point>(places), std::span<double>(values));
        for (std::size_t i = 0; i < open.size(); ++i) {
            open[i]->answer(values[i]);
        }
    }
}

}  // namespace scaleaxis::inline v1
