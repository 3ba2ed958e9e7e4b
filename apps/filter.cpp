// SPDX-License-Identifier: Apache-2.0
// scaleaxis filter: a stored axis → the same without sheets and curves of small object angles.
#include <algorithm>
#include <memory>
#include <sstream>

#include "commands.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/report.hpp"
#include "stored_axis.hpp"

namespace scaleaxis::app {

namespace {

struct FilteringOptions {
    StoredAxisOptions stored;
    double angle = FilterOptions().angle;
};

Status run_filter(const FilteringOptions& options, const std::stop_token& cancel) {
    const auto derive = [&](const MedialComplex& complex, double, const Execution& execution) {
        const auto unknown = std::ranges::count(complex.face_angles, 0.0);
        const double scale = options.stored.scale;
        FilteredComplex filtered = filter(with_object_angles(complex, scale), {options.angle, scale}, execution);
        std::ostringstream summary;
        print(summary, filtered.statistics);
        Json statistics{
            {"filter_angle", options.angle}, {"computed_angles", unknown}, {"filter", json_of(filtered.statistics)}};
        return DerivedAxis{std::move(filtered.complex), std::move(statistics), summary.str()};
    };
    return run_stored_axis("filter", options.stored, cancel, derive);
}

}  // namespace

Command filter_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("filter", "Remove unimportant sheets and curves of a stored axis");
    auto options = std::make_shared<FilteringOptions>();
    command
        ->add_option("--angle", options->angle,
                     "Remove sheets and curves whose object angle is smaller, where that keeps the topology;\n"
                     "degrees. Where the file has no angles they are computed from the radii" +
                         range_and_default(kAngleRange, options->angle))
        ->check(in_range(kAngleRange))
        ->option_text("A");
    add_stored_axis_options(*command, "filter", options->stored);
    command->footer(
        "Example:\n"
        "  scaleaxis filter bunny.ma --angle 45 -o bunny-filtered.ply");
    return {command, [options](const std::stop_token& cancel) { return run_filter(*options, cancel); }};
}

}  // namespace scaleaxis::app
