// SPDX-License-Identifier: Apache-2.0
/// \file
/// Inputs that can be read only once: standard input, pipes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "interrupts.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::app {

/// A file that can be read again and again: the input itself, or if that is a pipe or a device (or `-`, standard input)
/// or its name does not tell its format, a temporary copy, which is removed with this object.
class ReadableFile {
   public:
    /// \param format the extension of the copy, without a dot; empty: that of the input
    /// \throws FileError; Cancelled while it is copied, see `current_interrupts`
    explicit ReadableFile(const std::filesystem::path& input, const std::string& format = {});
    ReadableFile(const ReadableFile&) = delete;
    ReadableFile& operator=(const ReadableFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// The error with the name of the input in place of that of the copy, and with what is wrong with a folder.
    FileError renamed(const FileError& error) const;

   private:
    std::filesystem::path input_;
    std::filesystem::path path_;
    std::optional<TemporaryFile> copy_;  ///< at `path_`, if that is not the input
};

/// What `read(path)` returns for the path of the file.
template <class Read>
auto reading(const ReadableFile& file, const Read& read) {
    try {
        return read(file.path());
    } catch (const FileError& error) {
        throw file.renamed(error);
    }
}

/// The same for an input that is read this once. \param format see `ReadableFile`
template <class Read>
auto reading(const std::filesystem::path& input, const std::string& format, const Read& read) {
    return reading(ReadableFile(input, format), read);
}

/// The mesh of a file. What reading it has left out or repaired becomes warnings. \param name of the file in these
TriangleMesh read_mesh_with_warnings(const std::filesystem::path& file, const std::filesystem::path& name);

}  // namespace scaleaxis::app
