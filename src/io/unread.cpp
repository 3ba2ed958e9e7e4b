// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "io/formats.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

struct KnownFormat {
    std::string_view beginning;  ///< of the content; of XML, of its first element
    std::string_view advice;
};

constexpr std::array kKnownFormats{
    KnownFormat{
        "ASTM-E57",
        "E57 files are not read: convert it to LAS or PLY, as by `pdal translate in.e57 out.las`, or save it as "
        "such in CloudCompare"},
    KnownFormat{
        "ISO-10303-21",
        "STEP and IFC files hold curved surfaces and are not read: save it as STL, 3MF or OBJ in the CAD program "
        "or in FreeCAD"},
    KnownFormat{"#VRML", "VRML files are not read: convert it to PLY, OBJ or STL, as by MeshLab"},
    KnownFormat{"<COLLADA",
                "COLLADA files are not read: convert it to GLB, as by `assimp export in.dae out.glb`, or "
                "save it as such in Blender"},
    KnownFormat{"Kaydara FBX Binary",
                "FBX files are not read: convert it to GLB, as by `assimp export in.fbx out.glb`, "
                "or save it as such in Blender"},
    KnownFormat{"; FBX",
                "FBX files are not read: convert it to GLB, as by `assimp export in.fbx out.glb`, or save it "
                "as such in Blender"},
    KnownFormat{"<amf",
                "AMF files are not read: convert it to GLB, as by `assimp export in.amf out.glb`, or save it as "
                "3MF in a slicer"},
};

bool begins(std::string_view content, std::string_view beginning) {
    constexpr std::size_t kLookAhead = 4096;
    const std::string_view text = text_beginning(content);
    return beginning.starts_with('<') ? text.starts_with('<') && text.substr(0, kLookAhead).find(beginning) != text.npos
                                      : text.starts_with(beginning);
}

}  // namespace

std::string advice_for(std::string_view content) {
    const auto found = std::ranges::find_if(
        kKnownFormats, [&](const KnownFormat& format) { return begins(content, format.beginning); });
    return found == kKnownFormats.end() ? std::string() : std::string(found->advice);
}

}  // namespace scaleaxis::io
