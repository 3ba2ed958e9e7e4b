// SPDX-License-Identifier: Apache-2.0
#include "io/itk_checks.hpp"

#include <cmath>
#include <string>
#include <system_error>

#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {

namespace fs = std::filesystem;

void check_bytes(std::uintmax_t promised, std::uintmax_t found) {
    if (found < promised) {
        throw truncated("its head says " + std::to_string(promised) + " bytes of data, but there are " +
                        std::to_string(found));
    }
}

void check_packed_bytes(std::uintmax_t promised, std::uintmax_t packed) {
    // Of all compressions that these formats have, none makes a file smaller by more.
    constexpr std::uintmax_t kMostPacked = 1100;
    if (packed < promised / kMostPacked) {
        throw truncated("its head says " + std::to_string(promised) + " bytes of data, which are not in the " +
                        std::to_string(packed) + " bytes that there are");
    }
}

std::uintmax_t size_of_data(const fs::path& file) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) {
        throw FileError(Diagnostic{"file.open", "its data file " + file.filename().string() + ": " + error.message()});
    }
    return size;
}

std::uintmax_t size_of_list(const fs::path& file, std::string_view names) {
    std::uintmax_t size = 0;
    TextReader reader(names);
    for (std::string_view name = reader.any_word(); !name.empty(); name = reader.any_word()) {
        size += size_of_data(file.parent_path() / name);
    }
    return size;
}

void fail_at_line(std::size_t line, const std::string& what) {
    throw FileError(Diagnostic{"file.syntax", "line " + std::to_string(line) + ": " + what, "line",
                               static_cast<std::int64_t>(line)});
}

bool is_of_place(double value) { return std::abs(value) <= kMostOfPlace; }

bool is_spacing(double value) { return is_of_place(value) && std::abs(value) >= 1.0 / kMostOfPlace; }

void check_itk_head(const fs::path& file, std::string_view content) {
    if (is_nrrd(content)) {
        check_nrrd_head(content);
    } else if (is_nifti(content)) {
        check_nifti(file, content);
    } else if (is_meta_image(content)) {
        check_meta_image_head(content);
    } else if (is_tiff(content)) {
        check_tiff(content);
    } else if (is_vtk_image(content)) {
        check_vtk_image_head(content);
    } else if (is_dicom(content)) {
        check_dicom(content);
    } else {
        throw damaged("no reader of images takes it: its head is damaged, or its kind is not supported");
    }
}

void check_itk_length(const fs::path& file, std::string_view content, std::uintmax_t voxels, std::uintmax_t bytes) {
    if (is_nrrd(content)) {
        check_nrrd_length(file, content, bytes);
    } else if (is_meta_image(content)) {
        check_meta_image_length(file, content, bytes);
    } else if (is_vtk_image(content)) {
        check_vtk_image_length(content, voxels, bytes);
    } else if (!is_nifti(content)) {
        check_packed_bytes(bytes, content.size());
    }
}

void check_itk_has_data(std::string_view content) {
    const std::string data = is_nrrd(content)         ? nrrd_data_file(content)
                             : is_meta_image(content) ? meta_image_data_file(content)
                                                      : std::string();
    const bool is_pair = is_nifti(content) && !has_nifti_data(content);
    if (!data.empty() || is_pair) {
        throw unsupported("its data are in a file of their own" + (data.empty() ? "" : ", " + io::quoted(data)) +
                          ": this is only read from a file beside it");
    }
}

}  // namespace scaleaxis::io
