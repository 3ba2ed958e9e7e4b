// SPDX-License-Identifier: Apache-2.0
/// \file
/// A PLY file as tables of numbers, whatever its elements and properties mean.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/number_type.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {

struct PlyProperty {
    std::string_view name;
    NumberType type = NumberType::kF8;
    std::optional<NumberType> length_type;  ///< of a list; none for a number
    std::vector<double> values;             ///< of all items; of a list, one list after the other
    std::vector<std::size_t> offsets;  ///< of a list: that of item i is `values[offsets[i]]` … before the next offset
};

struct PlyElement {
    std::string_view name;
    std::size_t count = 0;  ///< items
    std::vector<PlyProperty> properties;
};

/// The elements that the head of a PLY file announces, without values. Names are parts of `content`.
/// \throws FileError
std::vector<PlyElement> read_ply_head(std::string_view content);

/// The elements of a PLY file (ascii, or binary in either byte order) and all values. Names are parts of `content`.
/// \throws FileError naming the line or the item; before it takes memory for more items than the file can hold
std::vector<PlyElement> read_ply_elements(std::string_view content);

/// The element, number or list of this name; null if there is none.
const PlyElement* find_element(const std::vector<PlyElement>& elements, std::string_view name);
const PlyProperty* find_number(const PlyElement& element, std::string_view name);
const PlyProperty* find_list(const PlyElement& element, std::string_view name);

/// The values of the number of this name.
/// \throws FileError if there is none
const std::vector<double>& numbers(const PlyElement& element, std::string_view name);

/// The vectors whose coordinates are the numbers of these names. \throws FileError if there are none
std::vector<Point> vectors(const PlyElement& element, std::string_view x_name, std::string_view y_name,
                           std::string_view z_name);

/// The values as indices; `kNone` where one cannot be an index.
std::vector<Index> to_indices(std::span<const double> values);

}  // namespace scaleaxis::io
