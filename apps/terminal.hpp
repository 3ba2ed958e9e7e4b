// SPDX-License-Identifier: Apache-2.0
/// \file
/// What goes to stderr: warnings, errors, progress.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"

namespace scaleaxis::app {

enum class Verbosity { kQuiet, kNormal, kVerbose };

void print_warning(std::string_view message);
void print_error(std::string_view message);
void print_note(std::string_view message);

/// Standard output takes bytes as they are, and a console text in UTF-8; only Windows has to be told.
void prepare_streams();

using Clock = std::chrono::steady_clock;

/// The place of an input among all inputs.
struct BatchPlace {
    std::size_t number = 1;  ///< counted from 1
    std::size_t count = 1;
    Clock::time_point start = Clock::now();  ///< of the first one
};

/// The part of an input's work that one call of the library does.
struct WorkShare {
    double begin = 0.0;
    double end = 1.0;
};

/// A bar on stderr while the library works, if that is a terminal; gone when it goes out of scope. With
/// `Verbosity::kVerbose` instead a line for each stage.
class ProgressBar {
   public:
    ProgressBar(std::string title, Verbosity verbosity, const BatchPlace& place = {});
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// For a call of the library that this bar shows; it must outlive it.
    Execution execution(int threads, const std::stop_token& cancel, const WorkShare& share = {});

    /// Makes room for other output.
    void erase();

    /// \param fraction of this input
    void show(std::string_view stage, double fraction);

   private:
    void draw(double fraction) const;

    std::string title_;
    Verbosity verbosity_;
    BatchPlace place_;
    bool is_terminal_;
    bool is_drawn_ = false;
    std::string stage_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_drawn_;
};

/// Prints warnings about an input, above the bar. \param bar must outlive it
std::function<void(const Diagnostic&)> warn_above(ProgressBar& bar, const std::filesystem::path& input);

}  // namespace scaleaxis::app
