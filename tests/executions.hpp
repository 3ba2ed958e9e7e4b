// SPDX-License-Identifier: Apache-2.0
/// \file
/// What every stage owes its caller: progress and cancellation.
#pragma once

#include <gtest/gtest.h>

#include <stop_token>
#include <string_view>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"

namespace scaleaxis::test {

/// Progress of a stage runs from 0 to 1 without steps back, and it can be cancelled by the callback and by a token.
/// \param run takes an `Execution`
template <class Run>
void expect_progress_and_cancellation(const Run& run) {
    double last = -1.0;
    bool is_ascending = true;
    run(Execution{.progress = [&](std::string_view, double fraction) {
        is_ascending = is_ascending && fraction >= last;
        last = fraction;
        return true;
    }});
    EXPECT_EQ(last, 1.0);
    EXPECT_TRUE(is_ascending);
    EXPECT_THROW(run(Execution{.progress = [](std::string_view, double) { return false; }}), Cancelled);
    int calls = 0;
    EXPECT_THROW(run(Execution{.progress = [&](std::string_view, double) { return ++calls < 2; }}), Cancelled);
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(run(Execution{.cancel = source.get_token()}), Cancelled);
}

}  // namespace scaleaxis::test
