// SPDX-License-Identifier: Apache-2.0
// scaleaxis smooth: a stored axis → the same with smooth boundaries of sheets and smooth curves.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <sstream>

#include "commands.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/smoothing.hpp"
#include "stored_axis.hpp"

namespace scaleaxis::app {

namespace {

struct SmoothingOptions {
    StoredAxisOptions stored;
    Index rounds = kDefaultSmoothing;
};

Status run_smooth(const SmoothingOptions& options, const std::stop_token& cancel) {
    const auto derive = [&](const MedialComplex& complex, double, const Execution& execution) {
        MedialComplex smoothed = smooth(complex, {options.rounds}, execution);
        Index moved = 0;
        double farthest = 0.0;
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            const double way = distance(complex.vertices[v], smoothed.vertices[v]);
            moved += way > 0.0 ? 1 : 0;
            farthest = std::max(farthest, way);
        }
        std::ostringstream summary;
        summary << "  smoothing   " << moved << " vertices moved, by " << farthest << " at most\n";
        Json statistics{{"rounds", options.rounds}, {"vertices_moved", moved}, {"largest_move", farthest}};
        return DerivedAxis{
            std::move(smoothed), {{"smoothing", std::move(statistics)}}, summary.str(), coarse_axis_warning(complex)};
    };
    return run_stored_axis("smooth", options.stored, cancel, derive);
}

}  // namespace

Command smooth_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("smooth", "Smooth the boundaries of sheets and the curves of a stored axis");
    auto options = std::make_shared<SmoothingOptions>();
    add_smooth_option(command, options->rounds, std::to_string(kDefaultSmoothing));
    add_stored_axis_options(command, "smooth", options->stored);
    command.footer(
        "Example:\n"
        "  scaleaxis smooth bunny.ma --smooth 20 -o bunny-smooth.ply");
    return {command, [options](const std::stop_token& cancel) { return run_smooth(*options, cancel); }};
}

}  // namespace scaleaxis::app
