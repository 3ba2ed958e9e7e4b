// SPDX-License-Identifier: Apache-2.0
/// \file
/// VTK's simple legacy formats ("VTK File Formats", Kitware): lines of keywords, each perhaps with numbers behind it.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "io/images/image_head.hpp"

namespace scaleaxis::io {

inline constexpr std::string_view kVtkTypes =
    "char i1 signed_char i1 unsigned_char u1 short i2 unsigned_short u2 int i4 unsigned_int u4 long i8 vtktypeint64 i8 "
    "unsigned_long u8 vtktypeuint64 u8 float f4 double f8";

/// The next line that is not empty, taken off the content; nothing at its end. \param number of the last line taken
std::optional<HeadField> take_vtk_field(std::string_view& content, std::size_t& number);

/// Takes the head off the content, up to the line `DATASET`, which has to name that kind, in lower case. \param lines
/// how many it had
void take_vtk_head(std::string_view& content, std::string_view kind, bool& is_text, std::size_t& lines);

/// Takes lines off the content, up to one that is empty.
void skip_vtk_metadata(std::string_view& content, std::size_t& number);

/// Takes arrays of any numbers off the content, behind the line `FIELD` that says how many. \throws FileError
void skip_vtk_fields(std::string_view& content, const HeadField& field, bool is_text, std::size_t& number);

/// Has the content that kind of data set, as far as its beginning tells?
bool is_vtk_legacy(std::string_view content, std::string_view kind);

}  // namespace scaleaxis::io
