// SPDX-License-Identifier: Apache-2.0
#include "calls.hpp"

#include <nanobind/stl/string.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::python {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(50);  // between two looks at signals and progress

/// What the working thread and the waiting one share.
struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_done = false;
    std::exception_ptr error;
    std::string stage;
    double fraction = 0.0;
};

/// Also when it is what it was: so the function can cancel at any time.
void tell(Shared& shared, const Tell& progress) {
    std::string stage;
    double fraction = 0.0;
    {
        const std::lock_guard lock(shared.mutex);
        if (shared.stage.empty()) {
            return;
        }
        stage = shared.stage;
        fraction = shared.fraction;
    }
    if ((*progress)(stage, fraction).is(nb::handle(Py_False))) {
        throw Cancelled();
    }
}

/// Throws what a handler of signals raises, or the function that is told the progress.
void look_around(Shared& shared, const Tell& progress) {
    if (PyErr_CheckSignals() != 0) {
        throw nb::python_error();
    }
    tell(shared, progress);
}

/// Until the work is done. \return what has cancelled it, if anything
std::exception_ptr wait_for(Shared& shared, std::stop_source& stop, const Tell& progress) {
    std::exception_ptr cancelled;
    std::unique_lock lock(shared.mutex);
    while (!shared.changed.wait_for(lock, kPatience, [&] { return shared.is_done; })) {
        lock.unlock();
        if (!cancelled) {
            const nb::gil_scoped_acquire acquired;
            try {
                look_around(shared, progress);
            } catch (...) {
                cancelled = std::current_exception();
                stop.request_stop();
            }
        }
        lock.lock();
    }
    return cancelled;
}

}  // namespace

void run(const Run& how, const std::function<void(const Execution&)>& work) {
    Shared shared;
    std::stop_source stop;
    Execution execution;
    execution.threads = how.threads;
    execution.cancel = stop.get_token();
    if (how.progress) {
        execution.progress = [&shared](std::string_view stage, double fraction) {
            const std::lock_guard lock(shared.mutex);
            shared.stage = stage;
            shared.fraction = fraction;
            return true;
        };
    }
    std::exception_ptr cancelled;
    {
        const nb::gil_scoped_release released;
        std::jthread worker([&] {
            try {
                work(execution);
            } catch (...) {
                shared.error = std::current_exception();
            }
            const std::lock_guard lock(shared.mutex);
            shared.is_done = true;
            shared.changed.notify_one();
        });
        cancelled = wait_for(shared, stop, how.progress);
    }
    if (cancelled) {
        std::rethrow_exception(cancelled);
    }
    if (shared.error) {
        std::rethrow_exception(shared.error);
    }
    tell(shared, how.progress);
}

}  // namespace scaleaxis::python
