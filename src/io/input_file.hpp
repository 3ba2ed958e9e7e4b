// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whole files in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace scaleaxis::io {

/// The content of a file, a pipe or a device, which is not empty.
/// \throws FileError also for folders and beyond 2 GiB
std::string read_file(const std::filesystem::path& file);

/// Throws a `FileError` if a file of this size is empty or too large to be read.
void check_size(std::uintmax_t bytes);

}  // namespace scaleaxis::io
