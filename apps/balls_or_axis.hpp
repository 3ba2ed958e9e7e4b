// SPDX-License-Identifier: Apache-2.0
/// \file
/// Inputs that stand for a solid: unions of balls, and axes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "command_line.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/envelope.hpp"

namespace scaleaxis::app {

struct BallsOrAxisOptions {
    std::filesystem::path input;
    std::string format;             ///< of the input; empty: its name or content tells
    bool takes_balls_only = false;  ///< of an axis: the balls at its vertices, in place of its envelope
    std::optional<double> scale;    ///< by which its balls had been grown; unset: as the file says
};

struct BallsOrAxis {
    std::variant<BallUnion, Envelope> solid;
    std::size_t balls = 0;  ///< in the file
};

/// `BALLS`, `--format`, `--balls-only`, `--scale`
void add_balls_or_axis_options(CommandLine command, BallsOrAxisOptions& options);

/// \param path to read; of the same kind as the input \param scale as in `BallsOrAxisOptions`
BallsOrAxis read_balls_or_axis(const std::filesystem::path& path, bool takes_balls_only,
                               const std::optional<double>& scale = {});

Option add_balls_only_option(CommandLine command, bool& takes_balls_only);

}  // namespace scaleaxis::app
