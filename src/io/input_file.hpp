// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whole files in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace scaleaxis::io {

/// The content of a file, a pipe or a device, which is not empty.
/// \throws FileError also for folders and beyond 2 GiB
std::string read_file(const std::filesystem::path& file);

/// Throws a `FileError` if a file of so many bytes is empty or too large to be read.
void check_size(std::uintmax_t bytes);

/// A copy of some content for a library that reads files only, gone at the end. Only its owner may read it.
class TemporaryFile {
   public:
    TemporaryFile(std::string_view content, const std::string& extension);
    ~TemporaryFile() { remove(); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

   private:
    void remove();

    std::filesystem::path path_;
};

}  // namespace scaleaxis::io
