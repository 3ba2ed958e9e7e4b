// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whole files in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/formats/compressed.hpp"

namespace scaleaxis::io {

/// The content of a file, a pipe or a device, which is not empty.
/// \throws FileError also for folders and beyond 2 GiB
std::string read_file(const std::filesystem::path& file);

/// Is there a file, neither a folder nor a pipe?
bool is_plain_file(const std::filesystem::path& file);

/// A file with data of another one, piece by piece. \throws FileError
ByteSource bytes_of_file(const std::filesystem::path& file);
std::uintmax_t size_of_file(const std::filesystem::path& file);

/// Throws a `FileError` if a file of this size is empty or too large to be read.
void check_size(std::uintmax_t bytes);

}  // namespace scaleaxis::io
