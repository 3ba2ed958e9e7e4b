// SPDX-License-Identifier: Apache-2.0
/// \file
/// How a call of the library runs beneath Python.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "scaleaxis/execution.hpp"

namespace scaleaxis::python {

namespace nb = nanobind;

/// None, or a function `f(stage, fraction)` that is told the progress, and cancels the call by returning False.
using Tell = std::optional<nb::typed<nb::callable, nb::object(nb::str, double)>>;

/// What every call takes besides its data.
struct Run {
    int threads = 0;
    Tell progress;
};

/// Calls `work` on a thread of its own, without the lock of the interpreter. Meanwhile this thread tells the progress,
/// and answers signals: an interrupt cancels the work, and is raised once that has ended.
void run(const Run& how, const std::function<void(const Execution&)>& work);

/// The same for work that has a result.
template <class Work>
auto run(const Run& how, const Work& work) requires(!std::is_void_v<std::invoke_result_t<Work, const Execution&>>) {
    std::optional<std::invoke_result_t<Work, const Execution&>> result;
    run(how,
        std::function<void(const Execution&)>([&](const Execution& execution) { result.emplace(work(execution)); }));
    return std::move(*result);
}

/// Short work that cannot be cancelled, without the lock of the interpreter.
template <class Work>
auto unlocked(const Work& work) {
    const nb::gil_scoped_release released;
    return work();
}

}  // namespace scaleaxis::python
