// SPDX-License-Identifier: Apache-2.0
/// \file
/// VTK's XML formats ("VTK File Formats", Kitware): elements, and arrays of numbers that stand in the element itself or
/// together at the end of the file, as text, as bytes, or as bytes in base64, packed in blocks or not.
#pragma once

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/formats/xml.hpp"
#include "io/number_type.hpp"

namespace scaleaxis::io {

/// The file as a tree, and what follows the `_` at which the data begin that are not within the tree.
struct VtkDocument {
    pugi::xml_document tree;
    std::string_view appended;

    pugi::xml_node file() const { return tree.child("VTKFile"); }
    std::string appended_encoding() const { return file().child("AppendedData").attribute("encoding").value(); }
};

/// Does it begin as a file whose data are in an element of that name, as `ImageData`?
bool is_vtk_document(std::string_view content, std::string_view data);

/// \throws FileError also if there is no such element
VtkDocument read_vtk_document(std::string_view content, const char* data);

std::string vtk_attribute(const pugi::xml_node& element, const char* name, const char* otherwise = "");

/// The numbers of a `DataArray` as they are stored, but unpacked.
struct VtkArray {
    NumberType type = NumberType::kU1;
    std::endian order = std::endian::little;
    bool is_text = false;
    std::string unpacked;          ///< bytes that are not in the file as such, or none:
    std::string_view stored = {};  ///< in the file

    std::string_view bytes() const { return unpacked.empty() ? stored : unpacked; }
};

/// An array that needs to have `count` numbers; of text this is not checked.
VtkArray read_vtk_array(const pugi::xml_node& array, const VtkDocument& document, std::size_t count);

/// The same as numbers, which are that many.
std::vector<double> vtk_numbers(const pugi::xml_node& array, const VtkDocument& document, std::size_t count);

}  // namespace scaleaxis::io
