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
    std::size_t place = 0;  ///< where the content begins, behind what may be anything
};

constexpr KnownFormat kDicom{"DICM",
                             "DICOM is not read: convert the series to NIfTI by `dcm2niix -z y FOLDER`, or save it as "
                             "NRRD in 3D Slicer; in Python, give the image that SimpleITK reads",
                             128};

constexpr std::string_view kFbx =
    "FBX files are not read: convert it to GLB, as by `assimp export in.fbx out.glb`, or save it as such in Blender";

constexpr std::string_view kVtkGrid =
    "of VTK's formats images (.vti, STRUCTURED_POINTS) and surfaces (.vtp, POLYDATA) are read: take the surface of the "
    "grid, by the filter Extract Surface of ParaView, and save it as .vtp, STL or PLY";

constexpr std::array kKnownFormats{
    kDicom,
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
    KnownFormat{"Kaydara FBX Binary", kFbx},
    KnownFormat{"; FBX", kFbx},
    KnownFormat{"<VTKFile type=\"UnstructuredGrid", kVtkGrid},
    KnownFormat{"<VTKFile type=\"StructuredGrid", kVtkGrid},
    KnownFormat{"<VTKFile type=\"RectilinearGrid", kVtkGrid},
    KnownFormat{"<amf",
                "AMF files are not read: convert it to GLB, as by `assimp export in.amf out.glb`, or save it as "
                "3MF in a slicer"},
};

bool is_of(const KnownFormat& format, std::string_view content) {
    constexpr std::size_t kLookAhead = 4096;
    const std::string_view beginning = format.beginning;
    if (format.place > 0) {
        return content.size() > format.place && content.substr(format.place).starts_with(beginning);
    }
    const std::string_view text = text_beginning(content);
    return beginning.starts_with('<') ? text.starts_with('<') && text.substr(0, kLookAhead).find(beginning) != text.npos
                                      : text.starts_with(beginning);
}

}  // namespace

std::string advice_for(std::string_view content) {
    const auto found =
        std::ranges::find_if(kKnownFormats, [&](const KnownFormat& format) { return is_of(format, content); });
    return found == kKnownFormats.end() ? std::string() : std::string(found->advice);
}

std::string advice_for_dicom(std::string_view content) {
    return is_of(kDicom, content) ? std::string(kDicom.advice) : std::string();
}

}  // namespace scaleaxis::io
