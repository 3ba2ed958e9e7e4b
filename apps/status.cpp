// SPDX-License-Identifier: Apache-2.0
#include "status.hpp"

#include <new>
#include <stdexcept>
#include <string>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

Status worse(Status a, Status b) {
    const auto rank = [](Status status) { return status == kFindings ? 1 : 2 * static_cast<int>(status); };
    return rank(a) < rank(b) ? b : a;
}

Status status_of(const std::exception& error) {
    if (dynamic_cast<const InvalidOption*>(&error) != nullptr) {
        return kUsage;
    }
    if (dynamic_cast<const FileError*>(&error) != nullptr) {
        return kUnreadable;
    }
    if (dynamic_cast<const UnusableInput*>(&error) != nullptr) {
        return kUnusableInput;
    }
    if (dynamic_cast<const Cancelled*>(&error) != nullptr) {
        return kCancelled;
    }
    return kFailure;
}

std::string with_hints(const Diagnostic& diagnostic) {
    std::string hints;
    for (const auto& [option, value] : diagnostic.hints) {
        hints += (hints.empty() ? " (--" : ", --") + option + (value.empty() ? "" : " " + value);
    }
    return diagnostic.message + (hints.empty() ? "" : hints + ")");
}

std::string describe(const std::exception& error) {
    if (const auto* known = dynamic_cast<const Error*>(&error)) {
        return with_hints(known->diagnostic());
    }
    if (const auto* file_error = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
        return file_error->path1().string() + ": " + file_error->code().message();
    }
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
        dynamic_cast<const std::length_error*>(&error) != nullptr) {
        return "out of memory: a larger --delta needs less, or a smaller input";
    }
    return "internal error (" + std::string(error.what()) + "): please report it, with the input";
}

std::string describe(const std::exception& error, const std::filesystem::path& file) {
    const std::string message = describe(error);
    return message.find(file.string()) != std::string::npos ? message : file.string() + ": " + message;
}

Diagnostic diagnostic_of(const std::exception& error, const std::string& message) {
    const auto* known = dynamic_cast<const Error*>(&error);
    Diagnostic diagnostic = known != nullptr ? known->diagnostic() : Diagnostic{"failure", {}};
    diagnostic.message = message;
    return diagnostic;
}

}  // namespace scaleaxis::app
