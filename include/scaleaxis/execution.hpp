// SPDX-License-Identifier: Apache-2.0
/// \file
/// How a stage runs: threads, progress, cancellation. Never what it computes.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

#include "scaleaxis/export.hpp"

namespace scaleaxis::inline v1 {

/// Passed to every stage. Results do not depend on it.
struct Execution {
    /// Number of threads, ≥ 1; 0: all that the machine has, or those of the oneTBB arena that the caller is in.
    int threads = 0;

    /// Called now and then, always from the thread that called the library, with the name of the running stage and the
    /// part of the whole that is done (0…1, never decreasing). Returns false to cancel: the call then throws
    /// `Cancelled`.
    std::function<bool(std::string_view stage, double fraction)> progress = {};

    /// Cancels from any thread: after `request_stop()` on its source the call throws `Cancelled` within a fraction of a
    /// second. The default one never does.
    std::stop_token cancel = {};
};

/// Calls `work(i)` for `0 ≤ i < count`, several at once, those of small `i` first. Calls of the library within share
/// the threads if their `Execution` asks for as many; they must report no progress. Returns when all are done; what one
/// of them throws stops the others, and is thrown.
SCALEAXIS_EXPORT void run_concurrently(std::size_t count, const std::function<void(std::size_t)>& work,
                                       const Execution& execution = {});

/// Lets the process keep the memory that one stage has freed for the next one, rather than give it back to the system
/// and ask for it again: 8 % less time on large shapes. For programs whose main work is this library, once at their
/// start. Does nothing where the C library is not that of GNU.
SCALEAXIS_EXPORT void keep_freed_memory();

}  // namespace scaleaxis::inline v1
