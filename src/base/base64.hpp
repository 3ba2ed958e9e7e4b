// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace scaleaxis {

/// Takes the next four digits of base64 off a text, blanks between them too, and appends the bytes that they stand for:
/// one or two where padding follows, else three. \throws FileError
void decode_base64(std::string_view& text, std::string& bytes);

}  // namespace scaleaxis
