// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Options that several subcommands have.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "terminal.hpp"

namespace scaleaxis::app {

struct CommonOptions {
    int threads = 0;
    std::uint64_t seed = 1;
    std::string statistics;  ///< a file, `-` for stdout, or empty
    bool is_quiet = false;
    bool is_verbose = false;

    Verbosity verbosity() const {
        return is_quiet ? Verbosity::kQuiet : is_verbose ? Verbosity::kVerbose : Verbosity::kNormal;
    }
    /// Does stdout get the summary for people?
    bool has_summary() const { return !is_quiet && statistics != "-"; }
};

void add_common_options(CLI::App& command, CommonOptions& options);
void add_threads_option(CLI::App& command, int& threads);
void add_seed_option(CLI::App& command, std::uint64_t& seed);

/// The file that `read_union` is to read.
void add_union_argument(CLI::App& command, std::filesystem::path& input);

/// `--delta` and `--delta-abs`, of which only one may be given.
void add_delta_options(CLI::App& command, double& delta, std::optional<double>& absolute_delta);

/// `--features` and `--tight`
void add_quality_options(CLI::App& command, bool& suits_features, bool& limits_deviation);

/// The tolerance as a length that these options mean for a shape with this diagonal.
/// \throws InvalidOption if an absolute one is out of range
double tolerance(double diagonal, double delta, const std::optional<double>& absolute_delta);

struct Range {
    double min = 0.0;
    double max = 0.0;
};
inline constexpr Range kScaleRange{1, 10};
inline constexpr Range kAngleRange{0, 90};
inline constexpr Range kLambdaRange{0, 0.5};
inline constexpr Range kRoundsRange{0, 1000};

/// Takes numbers of the range and nothing else (no NaN). Says nothing in the help.
CLI::Validator in_range(const Range& range);

/// The last line of an option's description.
std::string range_and_default(const Range& range, double default_value);

}  // namespace scaleaxis::app
