// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace scaleaxis::inline v1 {

/// The bytes that a text of base64 stands for, whose groups of four digits may have blanks between them and end in
/// padding anywhere: pieces that were encoded on their own follow each other. \throws FileError
std::string decoded_base64(std::string_view text);

}  // namespace scaleaxis::inline v1
