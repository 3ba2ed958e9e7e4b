// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files in memory, or piece by piece.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/formats/compressed.hpp"

namespace scaleaxis::io {

/// The content of a file, a pipe or a device, which is not empty.
/// \param is_enough if it says so, the beginning alone of a plain file, with the head of any image; null: all
/// \throws FileError also for folders and beyond 2 GiB
std::string read_file(const std::filesystem::path& file, bool is_enough(std::string_view beginning) = nullptr);

/// Is there a file, neither a folder nor a pipe?
bool is_plain_file(const std::filesystem::path& file);

/// A file with data, piece by piece, from `begin` on. \throws FileError
ByteSource bytes_of_file(const std::filesystem::path& file, std::uintmax_t begin);
std::uintmax_t size_of_file(const std::filesystem::path& file);

/// Throws a `FileError` if a file of this size is empty or too large to be read.
void check_size(std::uintmax_t bytes);

}  // namespace scaleaxis::io
