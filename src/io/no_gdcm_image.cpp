// SPDX-License-Identifier: Apache-2.0
//
// In the place of gdcm_image.cpp where the library is built without GDCM.
#include <string>

#include "io/faults.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

FileError needs_gdcm(const std::string& what) {
    return unsupported(what +
                       " DICOM, which this build does not read (SCALEAXIS_WITH_GDCM=OFF): convert the series to " +
                       "NIfTI by `dcm2niix -z y FOLDER`, or save it as NRRD in 3D Slicer");
}

}  // namespace

bool is_dicom(std::string_view content) { return content.size() > 132 && content.substr(128).starts_with("DICM"); }

Image read_dicom_image(std::string_view, const std::filesystem::path&) { throw needs_gdcm("it is"); }

Image read_dicom_folder(const std::filesystem::path&) { throw needs_gdcm("it is a folder, as only of"); }

}  // namespace scaleaxis::io
