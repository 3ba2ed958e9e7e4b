// SPDX-License-Identifier: Apache-2.0
/// \file
/// The subcommands, one source file each.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stop_token>

#include "status.hpp"

namespace scaleaxis::app {

/// What a subcommand does once its options are parsed, until a stop is requested. `run` may throw, too.
struct Command {
    CLI::App* options = nullptr;
    std::function<Status(const std::stop_token& cancel)> run;
};

Command axis_command(CLI::App& program);
Command balls_command(CLI::App& program);
Command medial_command(CLI::App& program);
Command clean_command(CLI::App& program);
Command filter_command(CLI::App& program);
Command filtration_command(CLI::App& program);
Command smooth_command(CLI::App& program);
Command refine_command(CLI::App& program);
Command simplify_command(CLI::App& program);
Command spheres_command(CLI::App& program);
Command skeleton_command(CLI::App& program);
Command midsurface_command(CLI::App& program);
Command thickness_command(CLI::App& program);
Command table_command(CLI::App& program);
Command mesh_command(CLI::App& program);
Command sample_field_command(CLI::App& program);
Command compare_command(CLI::App& program);
Command view_command(CLI::App& program);
Command info_command(CLI::App& program);

}  // namespace scaleaxis::app
