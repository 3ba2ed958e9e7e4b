// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What goes to stderr (warnings, errors, progress), and the way to stop the program.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "scaleaxis/execution.hpp"

namespace scaleaxis::app {

enum class Verbosity { kQuiet, kNormal, kVerbose };

void print_warning(std::string_view message);
void print_error(std::string_view message);

/// From now on the first SIGINT or SIGTERM makes `is_interrupted` true, and the second one kills the program.
void catch_interrupts();
bool is_interrupted();

/// \throws Cancelled if the program was interrupted
void stop_if_interrupted();

/// A bar on stderr while the library works, if that is a terminal; gone when it goes out of scope. With
/// `Verbosity::kVerbose` instead a line for each stage.
class ProgressBar {
   public:
    ProgressBar(std::string title, Verbosity verbosity);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// As `Execution::progress` demands: false stops the work.
    bool update(std::string_view stage, double fraction);

    /// For calls of the library that this bar shows; it must outlive them.
    Execution execution(int threads) {
        return {threads, [this](std::string_view stage, double fraction) { return update(stage, fraction); }};
    }

    /// Makes room for other output.
    void erase();

   private:
    using Clock = std::chrono::steady_clock;

    void draw(double fraction) const;

    std::string title_;
    Verbosity verbosity_;
    bool is_terminal_;
    bool is_drawn_ = false;
    std::string stage_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_drawn_;
};

}  // namespace scaleaxis::app
