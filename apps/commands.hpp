// SPDX-License-Identifier: Apache-2.0
/// \file
/// The subcommands, one source file each.
#pragma once

#include <functional>
#include <stop_token>

#include "command_line.hpp"
#include "status.hpp"

namespace scaleaxis::app {

/// What a subcommand does once its options are parsed, until a stop is requested. `run` may throw, too.
struct Command {
    CommandLine options;
    std::function<Status(const std::stop_token& cancel)> run;
};

Command axis_command(CommandLine program);
Command balls_command(CommandLine program);
Command medial_command(CommandLine program);
Command clean_command(CommandLine program);
Command filter_command(CommandLine program);
Command filtration_command(CommandLine program);
Command smooth_command(CommandLine program);
Command refine_command(CommandLine program);
Command simplify_command(CommandLine program);
Command spheres_command(CommandLine program);
Command skeleton_command(CommandLine program);
Command midsurface_command(CommandLine program);
Command thickness_command(CommandLine program);
Command walls_command(CommandLine program);
Command sizes_command(CommandLine program);
Command table_command(CommandLine program);
Command mesh_command(CommandLine program);
Command sample_field_command(CommandLine program);
Command compare_command(CommandLine program);
Command view_command(CommandLine program);
Command info_command(CommandLine program);

}  // namespace scaleaxis::app
