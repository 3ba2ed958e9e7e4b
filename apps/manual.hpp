// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is generated from the options of the program, so that it cannot go stale: manual page and shell completion.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace scaleaxis::app {

/// The manual page in roff, for `man`.
std::string manual_page(const CLI::App& program);

/// A script that completes subcommands, options and their values. \param shell "bash", "zsh" or "fish"
std::string completion(const CLI::App& program, const std::string& shell);

}  // namespace scaleaxis::app
