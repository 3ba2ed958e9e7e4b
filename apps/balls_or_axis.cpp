// SPDX-License-Identifier: Apache-2.0
#include "balls_or_axis.hpp"

#include <vector>

#include "options.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "stored_axis.hpp"

namespace scaleaxis::app {

Option add_balls_only_option(CommandLine command, bool& takes_balls_only) {
    return command
        .add_flag("--balls-only", takes_balls_only,
                  "Of an axis take the balls at its vertices, and not those interpolated between them")
        .value_text(" ");
}

void add_balls_or_axis_options(CommandLine command, BallsOrAxisOptions& options) {
    add_union_argument(command, options.input, options.format);
    const Option balls_only = add_balls_only_option(command, options.takes_balls_only);
    add_stored_scale_option(command, options.scale, kScaleRange).excludes(balls_only);
}

BallsOrAxis read_balls_or_axis(const std::filesystem::path& path, bool takes_balls_only,
                               const std::optional<double>& scale) {
    if (!takes_balls_only && file_kind(path) == FileKind::kAxis) {
        const MedialComplex axis = read_axis(path, scale);
        return {Envelope(axis), axis.vertices.size()};
    }
    if (scale) {
        throw InvalidOption("--scale has no effect on balls, which have none: leave it out");
    }
    std::vector<Ball> balls = read_union(path);
    const std::size_t count = balls.size();
    return {BallUnion(std::move(balls)), count};
}

}  // namespace scaleaxis::app
