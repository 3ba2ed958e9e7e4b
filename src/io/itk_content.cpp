// SPDX-License-Identifier: Apache-2.0
#include "io/compressed.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {

bool is_nrrd(std::string_view content) { return content.starts_with("NRRD000"); }

bool is_nifti(std::string_view content) {
    constexpr std::size_t kHead = 352;
    const std::string unpacked = is_gzip(content) ? inflated(content, kHead, true) : "";
    const std::string_view head = is_gzip(content) ? unpacked : content;
    const auto has = [&](std::size_t at, std::string_view word) {
        return head.size() > at && head.substr(at).starts_with(word);
    };
    return has(344, "n+1") || has(344, "ni1") || has(4, "n+2") || has(4, "ni2");
}

bool is_meta_image(std::string_view content) {
    const std::string_view head = content.substr(0, 4096);
    return head.find("NDims") < head.find("ElementDataFile") && head.find("DimSize") != std::string_view::npos;
}

bool is_tiff(std::string_view content) {
    using namespace std::string_view_literals;
    return content.starts_with("II*\0"sv) || content.starts_with("MM\0*"sv) || content.starts_with("II+\0"sv) ||
           content.starts_with("MM\0+"sv);
}

bool is_vtk_image(std::string_view content) {
    return content.starts_with("# vtk DataFile") &&
           content.substr(0, 1024).find("STRUCTURED_POINTS") != std::string_view::npos;
}

bool is_dicom(std::string_view content) { return content.size() > 132 && content.substr(128).starts_with("DICM"); }

}  // namespace scaleaxis::io
