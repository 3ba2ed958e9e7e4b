// SPDX-License-Identifier: Apache-2.0
// scaleaxis refine: a stored axis → the same with more vertices, whose balls overlap.
#include <memory>
#include <optional>

#include "commands.hpp"
#include "scaleaxis/ranges.hpp"
#include "scaleaxis/shrinking.hpp"
#include "stored_axis.hpp"

namespace scaleaxis::app {

namespace {

struct RefiningOptions {
    StoredAxisOptions stored;
    double meeting_angle = DensifyOptions().meeting_angle;
    std::optional<Index> most_vertices;
};

Status run_refine(const RefiningOptions& options, const std::stop_token& cancel) {
    const auto derive = [&](const MedialComplex& complex, double, const Execution& execution) {
        MedialComplex refined = densify(complex, {options.meeting_angle, options.most_vertices}, execution);
        return DerivedAxis{std::move(refined), {{"meeting_angle", options.meeting_angle}}, {}};
    };
    return run_stored_axis("refine", options.stored, cancel, derive);
}

}  // namespace

Command refine_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("refine", "Add vertices to a stored axis until its balls overlap: they are the solid");
    auto options = std::make_shared<RefiningOptions>();
    add_number(command, "--meeting-angle", options->meeting_angle,
               "The balls at the ends of each edge meet at this angle at least; degrees", kMeetingAngleRange, "A");
    command
        .add_option("--most-vertices", options->most_vertices,
                    "Refuse to make more vertices than this\n"
                    "[1 ... 100000000; default: ten times those of the axis, but at least a million]")
        .check(in_range(kMostVerticesRange))
        .value_text("N");
    add_stored_axis_options(command, "refine", options->stored);
    command.footer(
        "Example:\n"
        "  scaleaxis refine dolphin.ma -o dolphin-dense.ply");
    return {command, [options](const std::stop_token& cancel) { return run_refine(*options, cancel); }};
}

}  // namespace scaleaxis::app
