// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "scaleaxis/io.hpp"

namespace scaleaxis::app {

namespace {

constexpr const char* kAuto = "auto";

constexpr Range kSeedRange{0, 0x1p64};

const Choices<Sizing> kSizingNames{{"adaptive", Sizing::kAdaptive}, {"uniform", Sizing::kUniform}};
const Choices<UnionKind> kUnionNames{{"polar", UnionKind::kPolar}, {"fitted", UnionKind::kFitted}};

std::string text_of(const Range& range) {
    std::ostringstream text;
    text << range.min << " ... " << range.max;
    return text.str();
}

/// `NAME-abs`, the same length in units of the input. \param more the end of the description
Option add_absolute_option(CommandLine command, const std::string& name, std::optional<Length>& length,
                           const Range& range, const std::string& more = "") {
    return command
        .add_option_function<double>(
            name + "-abs", [&length](double value) { length = Length::absolute(value); },
            "The same as a length in units of the input, in place of " + name + more)
        .check(in_range(range))
        .value_text("LENGTH");
}

/// Takes the numbers for which `is_valid`. \param what they are, as a message goes on
TextCheck number_check(std::function<bool(double)> is_valid, const std::string& what) {
    const auto check = [is_valid = std::move(is_valid), what](const std::string& text) {
        double value = 0.0;
        return parse_value(text, value) && is_valid(value) ? std::string() : text + " is not " + what;
    };
    return check;
}

}  // namespace

TextCheck in_range(const Range& range) {
    return number_check([range](double value) { return range.contains(value); }, "in the range " + text_of(range));
}

TextCheck whole_in_range(const Range& range) {
    return number_check([range](double value) { return range.contains(value) && value == std::floor(value); },
                        "a whole number in the range " + text_of(range));
}

std::string range_and_default(const Range& range, double default_value) {
    std::ostringstream text;
    text << default_value;
    return range_and_default(range, text.str());
}

std::string range_and_default(const Range& range, const std::string& default_value) {
    return "\n[" + text_of(range) + "; default " + default_value + "]";
}

void add_threads_option(CommandLine command, int& threads) {
    add_number(command, "--threads", threads, "Number of threads; 0: all that the machine has", kThreadsRange, "N");
}

void add_seed_option(CommandLine command, std::uint64_t& seed) {
    command
        .add_option(
            "--seed", seed,
            "Seed of the random choices; the same seed gives the same result\n[default " + std::to_string(seed) + "]")
        .check(whole_in_range(kSeedRange))
        .value_text("N");
}

void add_common_options(CommandLine command, CommonOptions& options) {
    add_threads_option(command, options.threads);
    add_seed_option(command, options.seed);
    command
        .add_option("--stats", options.statistics,
                    "Write statistics as JSON to this file; .jsonl: a line for each input as it is done;\n"
                    "'-': to stdout, in place of the summary")
        .value_text("FILE");
    const Option quiet = command.add_flag("-q,--quiet", options.is_quiet, "No summary, no progress").value_text(" ");
    command.add_flag("-v,--verbose", options.is_verbose, "Tell each stage on stderr when it begins")
        .excludes(quiet)
        .value_text(" ");
}

void add_union_argument(CommandLine command, std::filesystem::path& input, std::string& format) {
    command.add_option("BALLS", input, "Balls: .ply with radius, text of x y z r a line, .woff; or an axis: .ply, .ma")
        .required()
        .value_text(" ");
    add_format_option(command, format);
}

Option add_format_option(CommandLine command, std::string& format) {
    std::vector<std::string> names;
    for (const std::string& extension : input_extensions()) {
        names.push_back(extension.substr(1));
    }
    return command
        .add_option("--format", format,
                    "The extension that the input would have, for standard input (-), pipes and other names\n"
                    "that do not tell; needed where the content does not tell either: xyz, balls, nii.gz...")
        .check(is_one_of(names))
        .value_text("EXT");
}

Option add_output_option(CommandLine command, std::string& output, std::string& output_format,
                         const std::string& formats) {
    const Option option =
        command.add_option("-o,--output", output, formats + ";\n-: to stdout, in place of the summary")
            .required()
            .value_text("OUT");
    command
        .add_option("--output-format", output_format,
                    "The extension that stands for its format, whatever its name is: for stdout, pipes and\n"
                    "files in folders")
        .value_text("EXT");
    return option;
}

void add_positive_length(CommandLine command, const std::string& name, std::optional<double>& length,
                         const std::string& help) {
    command.add_option(name, length, help)
        .check([](const std::string& text) {
            double value = 0.0;
            const bool is_length = parse_value(text, value) && value > 0.0 && std::isfinite(value);
            return is_length ? std::string() : text + " is no positive length";
        })
        .value_text("LENGTH");
}

void add_polygons_option(CommandLine command, bool& has_polygons) {
    command
        .add_flag("--polygons", has_polygons,
                  "Write PLY in binary, as polygons and edges, in place of the triangles that more programs read")
        .value_text(" ");
}

void add_delta_options(CommandLine command, std::optional<Length>& delta, std::optional<DeltaRange>* range) {
    const auto check = [range, validator = in_range(kDeltaRange)](std::string& text) {
        if (text != kAuto) {
            return validator(text);
        }
        return range != nullptr ? std::string() : "this command takes no " + text + ", but a number";
    };
    const auto set = [&delta, range](const std::string& text) {
        if (text == kAuto) {
            *range = DeltaRange();
        } else {
            double value = 0.0;
            parse_value(text, value);
            delta = Length::relative(value);
        }
    };
    std::ostringstream about;
    about << "Tolerance of the sampling, relative to the diagonal of the solid's bounding box;\n"
             "the union of balls stays within half of it; halving it makes two to three times as many balls";
    if (range != nullptr) {
        about << "; auto: the coarsest one of\n"
              << DeltaRange().coarsest.value() << " ... " << DeltaRange().finest.value()
              << " for which the union of balls has the topology of the solid, and no sample\n"
                 "is farther than the tolerance from it";
    }
    const Option relative = command
                                .add_option_function<std::string>(
                                    "--delta", set, about.str() + range_and_default(kDeltaRange, kDefaultDelta.value()))
                                .check(check)
                                .value_text(range != nullptr ? "R|auto" : "R");
    add_absolute_option(command, "--delta", delta,
                        {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()},
                        "\n[" + text_of(kDeltaRange) + " of the diagonal]")
        .excludes(relative);
}

void add_sampling_option(CommandLine command, Sizing& sizing) {
    add_choice(command, "--sampling", sizing, kSizingNames,
               "How far apart samples are: 'adaptive': as far as the solid lets them, so that the balls stay within\n"
               "half of delta; 'uniform': delta, as in the paper\n[default adaptive]");
    for (const char* const retired : {"--features", "--tight"}) {
        command
            .add_flag_callback(
                retired,
                [retired] {
                    throw InvalidOption(std::string(retired) +
                                        " is gone: samples are as dense as the solid needs by default "
                                        "(--sampling adaptive); leave it out");
                },
                "")
            .group("");  // the help does not list it
    }
}

bool has_sampling_options(const ScaleAxisOptions& options) {
    return options.delta || options.delta_range || options.sizing != ScaleAxisOptions().sizing;
}

ScaleAxisOptions without_sampling_options(ScaleAxisOptions options) {
    options.delta.reset();
    options.delta_range.reset();
    options.sizing = ScaleAxisOptions().sizing;
    return options;
}

void add_length_options(CommandLine command, const std::string& name, std::optional<Length>& length, const Range& range,
                        const std::string& description) {
    const Option relative = command
                                .add_option_function<double>(
                                    name, [&length](double value) { length = Length::relative(value); }, description)
                                .check(in_range(range))
                                .value_text("R");
    add_absolute_option(command, name, length, {0.0, std::numeric_limits<double>::max()}).excludes(relative);
}

void add_clean_options(CommandLine command, std::optional<Length>& cleaning, const std::string& default_value) {
    add_length_options(command, "--clean", cleaning, kCleaningRange,
                       "Remove what has less erosion thickness (teeth, crumbs and hairs), where that keeps the\n"
                       "topology, and make curves of thin limbs; relative to the diagonal of the bounding box;\n"
                       "0: nothing\n[0 ... 0.5; default " +
                           default_value + "]");
}

void add_compact_options(CommandLine command, CompactOptions& compact, const std::string& default_value) {
    add_length_options(
        command, "--error", compact.error, kCompactErrorRange,
        "Neither may balls of the axis stick out of those of the compact one, interpolated along its\n"
        "edges and triangles, nor these out of the axis, by more than this; relative to the diagonal of\n"
        "the bounding box\n[" +
            text_of(kCompactErrorRange) + "; default " + default_value + "]");
    command
        .add_option("--vertices", compact.vertices,
                    "Stop at this number of vertices; without an error as precisely as these allow")
        .check(whole_in_range(kMostVerticesRange))
        .value_text("N");
}

void add_measured_scale_option(CommandLine command, double& scale) {
    add_number(command, "--scale", scale,
               "Factor by which balls are grown: at 1 every bump counts, larger factors drop small ones", kScaleRange,
               "S");
}

Option add_dense_option(CommandLine command, bool& is_dense) {
    return command
        .add_flag(
            "--dense", is_dense,
            "Sample the axis until its balls overlap well, as the paper does: many more vertices, whose balls are\n"
            "the simplified solid without interpolation")
        .value_text(" ");
}

Option add_union_option(CommandLine command, std::optional<UnionKind>& kind) {
    return add_choice(command, "--union", kind, kUnionNames,
                      "Which balls stand for the solid: 'polar': those of the samples, as in the paper; 'fitted':\n"
                      "these fitted to the solid itself, and repaired until the union has its topology\n"
                      "[default fitted; polar for --points crust]");
}

std::string name_of(Sizing sizing) { return kSizingNames.at(static_cast<std::size_t>(sizing)).first; }

std::string name_of(UnionKind kind) { return kUnionNames.at(static_cast<std::size_t>(kind)).first; }

}  // namespace scaleaxis::app
