// SPDX-License-Identifier: Apache-2.0
#include "base/formats/xml.hpp"

#include <algorithm>
#include <new>
#include <string>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {

pugi::xml_document parsed_xml(std::string_view text, unsigned options) {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size(), options);
    if (result.status == pugi::status_out_of_memory) {
        throw std::bad_alloc();
    }
    if (!result) {
        // Where the text was converted from UTF-16, the place is one in UTF-8, and may lie behind the end.
        const auto place = std::clamp<std::ptrdiff_t>(result.offset, 0, std::ssize(text));
        const auto line = 1 + std::ranges::count(text.substr(0, static_cast<std::size_t>(place)), '\n');
        throw FileError(Diagnostic{
            "file.syntax", "line " + std::to_string(line) + ": this is no XML: the file is damaged or truncated",
            "line", line});
    }
    return document;
}

std::string_view local_name(const char* name) {
    const std::string_view whole = name;
    return whole.substr(whole.find(':') + 1);
}

pugi::xml_node child_of(const pugi::xml_node& parent, std::string_view name) {
    return parent.find_child([&](const pugi::xml_node& child) { return local_name(child.name()) == name; });
}

pugi::xml_attribute attribute_of(const pugi::xml_node& element, std::string_view name) {
    return element.find_attribute(
        [&](const pugi::xml_attribute& attribute) { return local_name(attribute.name()) == name; });
}

}  // namespace scaleaxis::inline v1
