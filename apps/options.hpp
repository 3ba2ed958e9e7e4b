// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options that several subcommands have.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "command_line.hpp"
#include "scaleaxis/delta.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/ranges.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

struct CommonOptions {
    int threads = 0;
    std::uint64_t seed = 1;
    std::string statistics;  ///< a file, `-` for stdout, or empty
    bool is_quiet = false;
    bool has_data_on_stdout = false;  ///< a result is written there
    bool is_verbose = false;

    Verbosity verbosity() const {
        return is_quiet ? Verbosity::kQuiet : is_verbose ? Verbosity::kVerbose : Verbosity::kNormal;
    }
    /// Does stdout get the summary for people?
    bool has_summary() const { return !is_quiet && statistics != "-" && !has_data_on_stdout; }
};

/// Takes numbers of the range and nothing else (no NaN). Says nothing in the help.
TextCheck in_range(const Range& range);
/// The same for whole numbers.
TextCheck whole_in_range(const Range& range);

/// The last line of an option's description.
std::string range_and_default(const Range& range, double default_value);
std::string range_and_default(const Range& range, const std::string& default_value);

/// An option that takes a number of a range, which the help names together with the default.
template <class Number, class Default>
Option add_number(CommandLine command, const std::string& name, Number& number, const std::string& help,
                  const Range& range, const std::string& placeholder, const Default& default_value) {
    return command.add_option(name, number, help + range_and_default(range, default_value))
        .check(std::is_integral_v<Number> ? whole_in_range(range) : in_range(range))
        .value_text(placeholder);
}
/// The default is what the number is.
template <class Number>
Option add_number(CommandLine command, const std::string& name, Number& number, const std::string& help,
                  const Range& range, const std::string& placeholder) {
    return add_number(command, name, number, help, range, placeholder, number);
}

void add_common_options(CommandLine command, CommonOptions& options);
void add_threads_option(CommandLine command, int& threads);
void add_seed_option(CommandLine command, std::uint64_t& seed);

/// The file that `read_union` is to read.
void add_union_argument(CommandLine command, std::filesystem::path& input, std::string& format);

/// `--format` of an input whose name does not tell it. \return the option
Option add_format_option(CommandLine command, std::string& format);

/// `-o` and `--output-format`. \param formats the extensions of files, and what is filled in \return `-o`
Option add_output_option(CommandLine command, std::string& output, std::string& output_format,
                         const std::string& formats);

/// An option that is a length of more than 0, in units of the input.
void add_positive_length(CommandLine command, const std::string& name, std::optional<double>& length,
                         const std::string& help);

/// `--polygons` of commands that write an axis.
void add_polygons_option(CommandLine command, bool& has_polygons);

/// `--delta` and `--delta-abs`, of which only one may be given. \param range where `--delta auto` goes; null: the
/// command does not take it
void add_delta_options(CommandLine command, std::optional<Length>& delta, std::optional<DeltaRange>* range);

/// `--sampling`.
void add_sampling_option(CommandLine command, Sizing& sizing);

/// Was one of the options that say how to sample a solid given?
bool has_sampling_options(const ScaleAxisOptions& options);

/// The options without these, for samples that are there already.
ScaleAxisOptions without_sampling_options(ScaleAxisOptions options);

template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// An option that takes one of these names, which must last, and sets the value that goes with it.
template <class Value, class T>
Option add_choice(CommandLine command, const std::string& option, T& value, const Choices<Value>& choices,
                  const std::string& description) {
    std::vector<std::string> names;
    std::string text;
    for (const auto& [name, unused] : choices) {
        names.push_back(name);
        text += (text.empty() ? "" : "|") + name;
    }
    return command
        .add_option_function<std::string>(
            option,
            [&value, &choices](const std::string& name) {
                value = std::ranges::find(choices, name, &std::pair<std::string, Value>::first)->second;
            },
            description)
        .check(is_one_of(names))
        .value_text(text);
}

/// `name` for a length relative to the diagonal and `name-abs` for one in units of the input, of which only one may be
/// given. \param range of the relative one
void add_length_options(CommandLine command, const std::string& name, std::optional<Length>& length, const Range& range,
                        const std::string& description);

/// `--error`, `--error-abs`, and `--vertices`. \param default_value of the error
void add_compact_options(CommandLine command, CompactOptions& compact, const std::string& default_value);

/// `--clean` and `--clean-abs`
void add_clean_options(CommandLine command, std::optional<Length>& cleaning, const std::string& default_value);

/// `--smooth`
template <class Rounds>
void add_smooth_option(CommandLine command, Rounds& rounds, const std::string& default_value) {
    command
        .add_option(
            "--smooth", rounds,
            "Rounds of smoothing of the sheets' boundaries and of curves\n[0 ... 1000; default " + default_value + "]")
        .check(whole_in_range(kSmoothingRange))
        .value_text("N");
}

/// `--scale` of commands that measure a solid
void add_measured_scale_option(CommandLine command, double& scale);

/// `--dense`
Option add_dense_option(CommandLine command, bool& is_dense);

/// `--union`
Option add_union_option(CommandLine command, std::optional<UnionKind>& kind);
/// As the option has it.
std::string name_of(Sizing sizing);

std::string name_of(UnionKind kind);

}  // namespace scaleaxis::app
