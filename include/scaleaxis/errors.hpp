// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the library throws and warns of.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// An option that would help. Front ends name it in their own words: `--delta-abs 0.1`, `delta_abs=0.1`.
struct Hint {
    std::string option;      ///< "delta-abs"
    std::string value = {};  ///< empty: any, or a switch
};

/// An error, a fault of an input, or a warning of what was repaired, as data.
struct Diagnostic {
    std::string code;          ///< stable name for programs, as "mesh.sheet"; docs/diagnostics.md lists all
    std::string message;       ///< one line for people: what is wrong, where, and what to do
    std::string element = {};  ///< kind of the element that it is about ("line", "triangle", "ball"…); empty: none
    std::int64_t index = -1;   ///< number of that element, as the message counts it; -1: none
    std::optional<Point> place = {};  ///< where it lies, in units of the input
    std::vector<Hint> hints = {};     ///< options that would help

    bool empty() const { return message.empty(); }
};

/// Base of all errors of the library.
class SCALEAXIS_EXPORT Error : public std::runtime_error {
   public:
    explicit Error(Diagnostic diagnostic)
        : std::runtime_error(diagnostic.message), diagnostic_(std::move(diagnostic)) {}

    const Diagnostic& diagnostic() const { return diagnostic_; }

   private:
    Diagnostic diagnostic_;
};

/// An option lies outside its documented range, or would have no effect.
class SCALEAXIS_EXPORT InvalidOption : public Error {
   public:
    using Error::Error;
    explicit InvalidOption(std::string message) : Error(Diagnostic{"option", std::move(message)}) {}
};

/// A file cannot be opened, read or written, or is not what its format demands.
class SCALEAXIS_EXPORT FileError : public Error {
   public:
    using Error::Error;
    explicit FileError(std::string message) : Error(Diagnostic{"file", std::move(message)}) {}
};

/// The data are readable, but describe nothing that the method can take (an open mesh, no volume, a ball of radius 0…).
class SCALEAXIS_EXPORT UnusableInput : public Error {
   public:
    using Error::Error;
    explicit UnusableInput(std::string message) : Error(Diagnostic{"input", std::move(message)}) {}
};

/// The computation found its own result inconsistent (medial and dual complex of different topology).
class SCALEAXIS_EXPORT InconsistentResult : public Error {
   public:
    using Error::Error;
    explicit InconsistentResult(std::string message) : Error(Diagnostic{"result", std::move(message)}) {}
};

/// The caller asked to stop.
class SCALEAXIS_EXPORT Cancelled : public Error {
   public:
    Cancelled() : Error(Diagnostic{"cancelled", "cancelled"}) {}
};

}  // namespace scaleaxis::inline v1
