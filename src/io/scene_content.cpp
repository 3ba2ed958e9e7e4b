// SPDX-License-Identifier: Apache-2.0
//
// Which of the formats of scenes some content is, with or without Assimp.
#include <cstddef>
#include <string_view>

#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

/// Of a text, from its first character on that is no blank.
std::string_view beginning(std::string_view content) {
    constexpr std::size_t kLookAhead = 4096;
    if (content.starts_with("\xEF\xBB\xBF")) {
        content.remove_prefix(3);
    }
    const std::size_t first = content.find_first_not_of(" \t\r\n");
    return first == content.npos ? std::string_view() : content.substr(first, kLookAhead);
}

/// Is it XML whose first element has this name, as far as its beginning tells?
bool is_xml(std::string_view content, std::string_view opening) {
    const std::string_view text = beginning(content);
    return text.starts_with('<') && text.find(opening) != text.npos;
}

}  // namespace

bool is_gltf(std::string_view content) {
    return beginning(content).starts_with('{') && content.find("\"asset\"") != content.npos;
}

bool is_glb(std::string_view content) { return content.starts_with("glTF"); }

bool is_collada(std::string_view content) { return is_xml(content, "<COLLADA"); }

bool is_fbx(std::string_view content) {
    return content.starts_with("Kaydara FBX Binary") || beginning(content).starts_with("; FBX");
}

bool is_amf(std::string_view content) { return is_xml(content, "<amf"); }

}  // namespace scaleaxis::io
