// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <exception>
#include <string>

#include "commands.hpp"
#include "scaleaxis/execution.hpp"
#include "status.hpp"
#include "terminal.hpp"

namespace {

using namespace scaleaxis::app;

Status run(int argc, char** argv) {
    CLI::App program("Discrete scale axis of solid 3D shapes: their stable medial axis, by angle and by scale.\n");
    program.name("scaleaxis");
    program.require_subcommand(0, 1);
    program.set_version_flag("--version", "scaleaxis " SCALEAXIS_VERSION, "Print the version");
    program.failure_message([](const CLI::App*, const CLI::Error& error) {
        return "scaleaxis: error: " + std::string(error.what()) + "; see scaleaxis --help\n";
    });
    program.footer(
        "Examples:\n"
        "  scaleaxis axis cat.obj -o cat-axis.ply\n"
        "  scaleaxis axis a.stl b.off --scale 1.05,1.1,1.2 -o results/\n"
        "  scaleaxis info cat.obj\n"
        "\n"
        "Exit status: 0 done, 1 failure, 2 wrong usage, 3 unreadable file, 4 not a usable shape, 5 cancelled.");
    const std::array commands{axis_command(program), balls_command(program),        medial_command(program),
                              mesh_command(program), sample_field_command(program), compare_command(program),
                              view_command(program), info_command(program)};
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? kDone : kUsage;  // 0: --help, --version
    }
    const auto chosen =
        std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.options->parsed(); });
    if (chosen == commands.end()) {
        print_error(
            "a subcommand is needed: axis, balls, medial, mesh, sample-field, compare, view or info; see scaleaxis "
            "--help");
        return kUsage;
    }
    return chosen->run();
}

}  // namespace

int main(int argc, char** argv) {
    catch_interrupts();
    scaleaxis::keep_freed_memory();
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        print_error(describe(error));
        return status_of(error);
    }
}
