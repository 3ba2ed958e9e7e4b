// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files as the system has them: Windows has names in UTF-16, the library has them in UTF-8.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace scaleaxis::inline v1 {

std::string utf8_of(const std::filesystem::path& file);
std::filesystem::path path_of(std::string_view utf8);

/// `std::fopen`. \param mode binary, of ASCII
std::FILE* open_stream(const std::filesystem::path& file, const char* mode);

/// The standard output once more, binary; to be closed.
std::FILE* open_stdout();

/// \returns 0 if a file that is there may be written to, else what `errno` says
int why_not_writable(const std::filesystem::path& file);

}  // namespace scaleaxis::inline v1
