// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stages one after the other, measured.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis {

/// Turns the progress of each stage into that of the whole, passes cancellation on, and measures costs.
class Run {
   public:
    /// \param total_work sum of the work of all stages, in any unit
    Run(const Execution& execution, double total_work) : execution_(execution), total_work_(total_work) {}

    /// Runs `work_of_stage(execution)` and returns what it returns.
    template <class Stage>
    auto stage(const std::string& name, double work, std::vector<StageCost>& costs, const Stage& work_of_stage) {
        tell(name);
        Execution inner;
        inner.threads = execution_.threads;
        inner.cancel = execution_.cancel;
        if (execution_.progress) {
            inner.progress = [this, work](std::string_view part_name, double part) {
                return execution_.progress(part_name, fraction(part * work));
            };
        }
        const auto start = std::chrono::steady_clock::now();
        auto result = work_of_stage(inner);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        costs.push_back({name, seconds.count(), peak_memory()});
        done_work_ += work;
        last_ = name;
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

}  // namespace scaleaxis
