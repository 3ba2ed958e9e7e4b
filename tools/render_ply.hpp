// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Any PLY file (ascii or binary) as a table of numbers for each element, whatever its properties are.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scaleaxis::render {

struct PlyProperty {
    enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

    std::string name;
    Type type = Type::Float64;
    bool is_list = false;
    Type count_type = Type::UInt8;     ///< of a list's length
    std::vector<double> values;        ///< of all rows; all lists one after the other
    std::vector<std::size_t> offsets;  ///< of lists: row `i` is `values[offsets[i]] … values[offsets[i + 1] - 1]`
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    /// The property of this name, or null.
    const PlyProperty* find(std::string_view property) const;
};

struct Ply {
    std::vector<PlyElement> elements;

    /// The element of this name, or null.
    const PlyElement* find(std::string_view element) const;
};

/// \throws FileError
Ply read_ply(const std::filesystem::path& file);

}  // namespace scaleaxis::render
