// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <exception>
#include <string>

#include "commands.hpp"
#include "inputs.hpp"
#include "interrupts.hpp"
#include "manual.hpp"
#include "outputs.hpp"
#include "scaleaxis/version.hpp"
#include "status.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {
namespace {

Status run_chosen(int argc, const char* const* argv, const std::stop_token& cancel) {
    CLI::App program("Discrete scale axis of 3D solids: their stable medial axis, by angle and by scale.\n");
    program.name("scaleaxis");
    program.allow_windows_style_options(false);  // a path may begin with a slash there, too
    program.require_subcommand(0, 1);
    program.set_version_flag("--version", "scaleaxis " SCALEAXIS_VERSION, "Print the version");
    program.failure_message([](const CLI::App* app, const CLI::Error& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ArgumentMismatch)) {
            const std::string message = error.what();
            const std::string name = message.substr(0, message.find(':'));
            for (const CLI::App* command : app->get_subcommands()) {
                const CLI::Option* option = command->get_option_no_throw(name);
                if (option != nullptr && !option->get_option_text().empty()) {
                    return "scaleaxis: error: " + name + " takes " + option->get_option_text() +
                           "; see scaleaxis --help\n";
                }
            }
        }
        // What is wrong with a value says what would be right.
        const bool is_about_value = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ValidationError);
        return "scaleaxis: error: " + std::string(error.what()) + (is_about_value ? "\n" : "; see scaleaxis --help\n");
    });
    program.footer(
        "Examples:\n"
        "  scaleaxis axis cat.obj -o cat-axis.ply\n"
        "  scaleaxis axis a.stl b.off --scale 1.05,1.1,1.2 -o results/\n"
        "  scaleaxis info cat.obj\n"
        "\n"
        "Exit status: 0 done, 1 failure, 2 wrong usage, 3 unreadable file, 4 not a usable solid, 5 cancelled,\n"
        "6 done, and scaleaxis walls has found something.");
    std::string shell;
    program.add_option("--completion", shell, "Print a script that completes commands and options in this shell")
        ->check(CLI::IsMember({"bash", "zsh", "fish"}))
        ->option_text("bash|zsh|fish");
    bool is_manual_asked_for = false;
    program.add_flag("--manual", is_manual_asked_for, "Print the manual page, for man")->option_text(" ");
    const std::array commands{axis_command(program),       balls_command(program),      medial_command(program),
                              filtration_command(program), filter_command(program),     clean_command(program),
                              smooth_command(program),     refine_command(program),     simplify_command(program),
                              skeleton_command(program),   midsurface_command(program), thickness_command(program),
                              walls_command(program),      sizes_command(program),      table_command(program),
                              spheres_command(program),    mesh_command(program),       sample_field_command(program),
                              compare_command(program),    view_command(program),       info_command(program)};
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? kDone : kUsage;  // 0: --help, --version
    }
    if (is_manual_asked_for || !shell.empty()) {
        print_text(is_manual_asked_for ? manual_page(program) : completion(program, shell));
        return kDone;
    }
    const auto chosen =
        std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.options.is_parsed(); });
    if (chosen == commands.end()) {
        std::string names;
        for (const Command& command : commands) {
            names += (names.empty() ? "" : &command == &commands.back() ? " or " : ", ") + command.options.name();
        }
        print_error("a subcommand is needed: " + names + "; see scaleaxis --help");
        return kUsage;
    }
    return chosen->run(cancel);
}

}  // namespace

Status run_program(int argc, const char* const* argv, const std::stop_token& cancel) {
    set_current_interrupts(cancel);
    forget_inputs();
    try {
        return run_chosen(argc, argv, cancel);
    } catch (const std::exception& error) {
        print_error(describe(error));
        return status_of(error);
    }
}

}  // namespace scaleaxis::app
