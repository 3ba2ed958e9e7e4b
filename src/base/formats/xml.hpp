// SPDX-License-Identifier: Apache-2.0
/// \file
/// XML texts as trees of pugixml. It expands no entities but the five of XML, and reads, copies and frees trees of any
/// depth without recursion; only the removal of an element has one.
#pragma once

#include <pugixml.hpp>
#include <string_view>

#include "scaleaxis/export.hpp"

namespace scaleaxis::inline v1 {

/// \param options of pugixml \throws FileError naming the line that is no XML
SCALEAXIS_EXPORT pugi::xml_document parsed_xml(std::string_view text, unsigned options = pugi::parse_default);

/// The name of an element or attribute without the prefix of its namespace.
std::string_view local_name(const char* name);

/// The first child with this local name; empty if there is none.
pugi::xml_node child_of(const pugi::xml_node& parent, std::string_view name);

/// The attribute with this local name; empty if there is none.
pugi::xml_attribute attribute_of(const pugi::xml_node& element, std::string_view name);

}  // namespace scaleaxis::inline v1
