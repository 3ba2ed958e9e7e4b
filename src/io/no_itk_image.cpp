// SPDX-License-Identifier: Apache-2.0
//
// In the place of itk_image.cpp where the library is built without the Insight Toolkit.
#include "io/faults.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

[[noreturn]] void refuse() {
    throw unsupported(
        "images of this format need the Insight Toolkit, and this program was built without it "
        "(SCALEAXIS_WITH_ITK=OFF); INRIMAGE, DGtal's .vol and .pgm3d can be read; in Python, read the file by nibabel "
        "or "
        "SimpleITK, and give the image that they return");
}

}  // namespace

Image read_itk_image(const std::filesystem::path&, std::string) { refuse(); }

Image read_dicom_folder(const std::filesystem::path&) { refuse(); }

}  // namespace scaleaxis::io
