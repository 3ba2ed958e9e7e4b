// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whole files in memory.
#pragma once

#include <filesystem>
#include <string>

namespace scaleaxis::io {

/// The content of a regular file that is not empty.
/// \throws FileError
std::string read_file(const std::filesystem::path& file);

}  // namespace scaleaxis::io
