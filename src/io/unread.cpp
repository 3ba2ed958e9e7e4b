// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <string_view>

#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

struct KnownFormat {
    std::string_view beginning;
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
};

}  // namespace

std::string advice_for(std::string_view content) {
    for (const KnownFormat& format : kKnownFormats) {
        if (content.starts_with(format.beginning)) {
            return std::string(format.advice);
        }
    }
    return {};
}

}  // namespace scaleaxis::io
