// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stages one after the other, measured.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::inline v1 {

/// Seconds since it was made.
class Stopwatch {
   public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

   private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// Turns the progress of each stage into that of the whole, passes cancellation on, and measures costs.
class Run {
   public:
    /// \param total_work sum of the work of all stages, in any unit
    Run(const Execution& execution, double total_work) : execution_(execution), total_work_(total_work) {}

    /// Runs `work_of_stage(execution)` and returns what it returns.
    template <class Stage>
    auto stage(const std::string& name, double work, std::vector<StageCost>& costs, const Stage& work_of_stage) {
        tell(name);
        const Stopwatch watch;
        auto result = part(work, work_of_stage);
        costs.push_back({name, watch.seconds(), peak_memory()});
        last_ = name;
        return result;
    }

    /// The same for work that tells its stages itself.
    template <class Part>
    auto part(double work, const Part& work_of_part) {
        auto result = work_of_part(part_of(execution_, fraction(0.0), fraction(work)));
        done_work_ += work;
        return result;
    }

    /// Reports that all is done: sums of parts need not be 1 exactly.
    void finish() {
        done_work_ = total_work_;
        tell(last_);
    }

   private:
    double fraction(double more_work) const { return std::min(1.0, (done_work_ + more_work) / total_work_); }

    void tell(const std::string& name) const {
        if (execution_.cancel.stop_requested() || (execution_.progress && !execution_.progress(name, fraction(0.0)))) {
            throw Cancelled();
        }
    }

    const Execution& execution_;
    double total_work_;
    double done_work_ = 0.0;
    std::string last_;
};

}  // namespace scaleaxis::inline v1
