// SPDX-License-Identifier: Apache-2.0
/// \file
/// Inputs that can be read only once: standard input, pipes.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

/// A file that can be read again and again: the input itself, or if that is a pipe or a device (or `-`, standard input)
/// a temporary copy, which is removed with this object.
class ReadableFile {
   public:
    /// \throws FileError
    explicit ReadableFile(const std::filesystem::path& input);
    ~ReadableFile();
    ReadableFile(const ReadableFile&) = delete;
    ReadableFile& operator=(const ReadableFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// The error with the name of the input in place of that of the copy.
    FileError renamed(const FileError& error) const;

   private:
    std::filesystem::path input_;
    std::filesystem::path path_;
};

/// What `read(path)` returns for a path at which the input can be read several times.
template <class Read>
auto reading(const std::filesystem::path& input, const Read& read) {
    const ReadableFile file(input);
    try {
        return read(file.path());
    } catch (const FileError& error) {
        throw file.renamed(error);
    }
}

}  // namespace scaleaxis::app
