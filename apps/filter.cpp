// SPDX-License-Identifier: Apache-2.0
// scaleaxis filter: a stored axis → the same without sheets and curves of small object angles.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/report.hpp"
#include "stored_axis.hpp"

namespace scaleaxis::app {

namespace {

struct FilteringOptions {
    StoredAxisOptions stored;
    std::optional<double> angle;  ///< unset: that of `FilterOptions`
    SheetAngle measure = FilterOptions().measure;
};

/// A filtration is cut at the scale, and then filtered only if an angle is given.
Status run_cut(const FilteringOptions& options, const std::stop_token& cancel) {
    const auto derive = [&](const MedialComplex& complex, double, const Execution& execution) {
        const double scale = options.stored.scale.value_or(1.0);
        const Filtration nested = read_filtration(options.stored.input);
        const std::optional<Diagnostic> unknown = unknown_level(nested, scale);
        MedialComplex level = cut(nested, scale);
        std::ostringstream summary;
        summary << "  cut at s = " << scale << ": " << complex.sheets << " sheets -> " << level.sheets << ", "
                << complex.vertices.size() - level.vertices.size() << " balls vanish\n";
        Json statistics{{"cut", scale}};
        if (options.angle) {
            FilteredComplex filtered =
                filter(with_object_angles(std::move(level)), {*options.angle, options.measure}, execution);
            print(summary, filtered.statistics);
            statistics["filter"] = json_of(filtered.statistics);
            level = std::move(filtered.complex);
        }
        return DerivedAxis{std::move(level), std::move(statistics), summary.str(),
                           unknown ? std::vector{*unknown} : std::vector<Diagnostic>()};
    };
    return run_stored_axis("filter", options.stored, cancel, derive);
}

bool is_stored_filtration(const StoredAxisOptions& options) {
    return options.format.empty() && std::filesystem::is_regular_file(options.input) && is_filtration(options.input);
}

Status run_filter(const FilteringOptions& options, const std::stop_token& cancel) {
    if (is_stored_filtration(options.stored)) {
        return run_cut(options, cancel);
    }
    if (options.stored.scale && !kScaleRange.contains(*options.stored.scale)) {
        std::ostringstream message;
        message << "--scale: " << *options.stored.scale << " is not in the range " << kScaleRange.min << " ... "
                << kScaleRange.max << " of the scales of an axis; a filtration can be cut up to "
                << kLargestScaleRange.max;
        throw InvalidOption(message.str());
    }
    const auto derive = [&](const MedialComplex& complex, double, const Execution& execution) {
        const auto unknown = std::ranges::count(complex.face_angles, 0.0);
        const double angle = options.angle.value_or(FilterOptions().angle);
        FilteredComplex filtered = filter(with_object_angles(complex), {angle, options.measure}, execution);
        std::ostringstream summary;
        print(summary, filtered.statistics);
        Json statistics{
            {"filter_angle", angle}, {"computed_angles", unknown}, {"filter", json_of(filtered.statistics)}};
        return DerivedAxis{std::move(filtered.complex), std::move(statistics), summary.str()};
    };
    return run_stored_axis("filter", options.stored, cancel, derive);
}

}  // namespace

Command filter_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("filter", "Remove unimportant sheets and curves of a stored axis");
    auto options = std::make_shared<FilteringOptions>();
    add_number(command, "--angle", options->angle,
               "Remove sheets and curves whose object angle is smaller, where that keeps the topology;\n"
               "degrees. Where the file has no angles they are computed from the radii",
               kAngleRange, "A", FilterOptions().angle);
    command
        .add_flag_callback(
            "--by-area", [options] { options->measure = SheetAngle::kByArea; },
            "Ask for the object angle that a fifth of a sheet's area exceeds, not for the largest of its faces:\n"
            "for clean axes, where single faces should not count; curves stay")
        .value_text(" ");
    add_stored_axis_options(command, "filter", options->stored, kLargestScaleRange);
    command.footer(
        "A filtration (scaleaxis filtration) is cut at --scale S, up to its --largest-scale, and its sheets are\n"
        "filtered only if --angle is given.\n"
        "Examples:\n"
        "  scaleaxis filter bunny.ma --angle 45 -o bunny-filtered.ply\n"
        "  scaleaxis filter bunny-filtration.ply --scale 1.3 -o bunny-1.3.ply");
    return {command, [options](const std::stop_token& cancel) { return run_filter(*options, cancel); }};
}

}  // namespace scaleaxis::app
