// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the program tells the shell.
#pragma once

#include <exception>
#include <filesystem>
#include <string>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

/// Exit status of the program. Of several failures the numerically largest counts; any counts more than findings.
enum Status : int {
    kDone = 0,
    kFailure = 1,        ///< anything else: an inconsistent result, no memory…
    kUsage = 2,          ///< an unknown option, a value out of range, an output that cannot be written
    kUnreadable = 3,     ///< an input that cannot be read or is not what its format demands
    kUnusableInput = 4,  ///< an input that bounds no solid
    kCancelled = 5,      ///< stopped by Ctrl-C or SIGTERM
    kFindings = 6        ///< done, and what was looked for is there: of all failures the least
};

/// Which of two statuses counts.
Status worse(Status a, Status b);

Status status_of(const std::exception& error);

/// Its message, and the options that would help.
std::string with_hints(const Diagnostic& diagnostic);

/// The error in one line. The second form makes sure that it names the file.
std::string describe(const std::exception& error);
std::string describe(const std::exception& error, const std::filesystem::path& file);

/// The error as data, with this message. \param message what `describe` says
Diagnostic diagnostic_of(const std::exception& error, const std::string& message);

}  // namespace scaleaxis::app
