// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ctrl-C and other signals.
#pragma once

#include <filesystem>
#include <stop_token>

namespace scaleaxis::app {

/// From now on the first SIGINT or SIGTERM requests a stop of the token that is returned, and the second one kills the
/// program. To be called before any thread is started.
std::stop_token catch_interrupts();

/// A file that is removed with this object, and also where a second signal kills the program.
class TemporaryFile {
   public:
    explicit TemporaryFile(std::filesystem::path file);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

   private:
    std::filesystem::path file_;
};

/// What asks the running command to stop, for what is deep within it: waiting for a pipe.
const std::stop_token& current_interrupts();
void set_current_interrupts(const std::stop_token& cancel);

/// \throws Cancelled if a stop was requested
void stop_if_requested(const std::stop_token& cancel);

/// A file that grows beyond the limit of the process cannot be written, rather than kills the program.
void ignore_file_size_signal();

}  // namespace scaleaxis::app
