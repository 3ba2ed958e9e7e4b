// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the library throws. Every message is one line: what is wrong, where, and what to do.
#pragma once

#include <stdexcept>

namespace scaleaxis {

/// Base of all errors of the library.
class Error : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

/// An option lies outside its documented range.
class InvalidOption : public Error {
   public:
    using Error::Error;
};

/// A file cannot be opened, read or written, or is not what its format demands.
class FileError : public Error {
   public:
    using Error::Error;
};

/// The data are readable, but bound no solid that the method can take (an open mesh, no volume…).
class UnusableShape : public Error {
   public:
    using Error::Error;
};

/// The computation found its own result inconsistent (medial and dual complex of different topology).
class InconsistentResult : public Error {
   public:
    using Error::Error;
};

/// The progress callback asked to stop.
class Cancelled : public Error {
   public:
    Cancelled() : Error("cancelled") {}
};

}  // namespace scaleaxis
