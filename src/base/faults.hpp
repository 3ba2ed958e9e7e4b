// SPDX-License-Identifier: Apache-2.0
/// \file
/// Errors in short: of options, and of files by their codes, which docs/diagnostics.md lists.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {

/// \throws InvalidOption with this message unless the condition holds
inline void require(bool condition, const std::string& message) {
    if (!condition) {
        throw InvalidOption(message);
    }
}

/// The file ends before the data that its head announces, or within an item.
inline FileError truncated(std::string message) { return FileError(Diagnostic{"file.truncated", std::move(message)}); }

/// Its parts contradict each other or the format.
inline FileError damaged(std::string message) { return FileError(Diagnostic{"file.damaged", std::move(message)}); }

/// A valid file of a variant that is not read.
inline FileError unsupported(std::string message) {
    return FileError(Diagnostic{"file.unsupported", std::move(message)});
}

/// An element whose numbers cannot be what they stand for. \param index as the message counts it
inline FileError bad_value(std::string message, std::string element, std::int64_t index) {
    return FileError(Diagnostic{"file.value", std::move(message), std::move(element), index});
}

/// The same error with other words: `before` its message.
inline FileError with_prefix(const std::string& before, const FileError& error) {
    Diagnostic diagnostic = error.diagnostic();
    diagnostic.message = before + diagnostic.message;
    return FileError(std::move(diagnostic));
}

}  // namespace scaleaxis::inline v1
