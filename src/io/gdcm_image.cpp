// SPDX-License-Identifier: Apache-2.0
//
// DICOM, by GDCM. The only source that knows it.
#include <gdcmAttribute.h>
#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/stored_image.hpp"

namespace scaleaxis::io {
namespace {

/// A file of a series: a slice, or several.
struct DicomPart {
    std::string series;
    Image image;
    std::array<double, 2> spacing{};  ///< in the slice
    std::array<double, 6> directions{};
};

FileError damaged_dicom() { return damaged("it is no valid DICOM file, or truncated; convert it to NIfTI or NRRD"); }

NumberType dicom_type(const gdcm::PixelFormat& format) {
    const unsigned bits = format.GetBitsAllocated();
    const bool is_float = format == gdcm::PixelFormat::FLOAT32 || format == gdcm::PixelFormat::FLOAT64;
    const std::string kind = is_float ? "f" : format.GetPixelRepresentation() == 1 ? "i" : "u";
    const std::optional<NumberType> type = number_type(kind + std::to_string(bits / 8));
    if (!type || bits % 8 != 0) {
        throw unsupported("its values have " + std::to_string(bits) + " bits, which cannot be read");
    }
    return *type;
}

/// Where the voxels are, once its sizes are known to be those of an image.
Image frame_of_part(const gdcm::Image& dicom) {
    StoredImage head;
    head.channels = dicom.GetPixelFormat().GetSamplesPerPixel();
    head.sizes = {dicom.GetDimension(0), dicom.GetDimension(1),
                  dicom.GetNumberOfDimensions() > 2 ? dicom.GetDimension(2) : 1};
    const double* const x = dicom.GetDirectionCosines();
    const std::array directions{Point{x[0], x[1], x[2]}, Point{x[3], x[4], x[5]},
                                cross(Point{x[0], x[1], x[2]}, Point{x[3], x[4], x[5]})};
    for (unsigned axis = 0; axis < 3; ++axis) {
        head.frame.steps[axis] = dicom.GetSpacing(axis) * directions[axis] + Point();  // no -0
    }
    head.frame.origin = {dicom.GetOrigin(0), dicom.GetOrigin(1), dicom.GetOrigin(2)};
    head.frame.unit = "mm";
    head.frame.space = "left-posterior-superior";
    return frame_of(head);
}

DicomPart read_part(std::string_view content) {
    std::istringstream stream{std::string(content)};
    gdcm::ImageReader reader;
    reader.SetStream(stream);
    if (!reader.Read()) {
        throw damaged_dicom();
    }
    const gdcm::Image& dicom = reader.GetImage();
    const NumberType type = dicom_type(dicom.GetPixelFormat());
    DicomPart part;
    part.image = frame_of_part(dicom);
    gdcm::Attribute<0x20, 0xe> series;
    series.SetFromDataSet(reader.GetFile().GetDataSet());
    part.series = series.GetValue();
    part.spacing = {dicom.GetSpacing(0), dicom.GetSpacing(1)};
    std::copy_n(dicom.GetDirectionCosines(), 6, part.directions.begin());

    const auto& [width, height, depth] = part.image.sizes;
    const std::size_t voxels = static_cast<std::size_t>(width) * height * depth;
    check_packed_bytes(voxels * bytes_per_number(type), content.size());
    std::vector<char> bytes(dicom.GetBufferLength());
    check_bytes(voxels * bytes_per_number(type), bytes.size());
    if (!dicom.GetBuffer(bytes.data())) {
        throw damaged_dicom();
    }
    part.image.values.resize(voxels);
    read_numbers(bytes.data(), voxels, type, std::endian::native, part.image.values.data());
    const double slope = dicom.GetSlope();
    const double intercept = dicom.GetIntercept();
    for (float& value : part.image.values) {
        value = static_cast<float>(double{value} * slope + intercept);
    }
    return part;
}

/// What `read` returns; the errors of the library as those of ours.
template <class Read>
auto with_own_errors(const Read& read) {
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::Trace::DebugOff();
    try {
        return read();
    } catch (const FileError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {
        throw damaged_dicom();
    }
}

/// From slice to slice, in a gantry that is tilted too. \throws FileError if that is not the same everywhere
Point slice_step(const std::vector<DicomPart>& parts) {
    constexpr double kMostDeviation = 0.1;  // of the step
    constexpr double kSame = 1e-3;
    const auto is_near = [](double x, double y) { return std::abs(x - y) < kSame; };
    const DicomPart& first = parts.front();
    const auto last = static_cast<double>(parts.size() - 1);
    const Point step = (1.0 / last) * (parts.back().image.origin - first.image.origin);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const DicomPart& part = parts[i];
        if (part.image.sizes != first.image.sizes || !std::ranges::equal(part.spacing, first.spacing, is_near) ||
            !std::ranges::equal(part.directions, first.directions, is_near)) {
            throw damaged("the slices of the DICOM series do not have the same size, directions and spacing");
        }
        const double deviation = distance(part.image.origin, first.image.origin + static_cast<double>(i) * step);
        if (part.image.sizes[2] > 1 || !(deviation < kMostDeviation * norm(step))) {
            throw damaged("the slices of the DICOM series are not evenly apart: is one missing, or there twice?");
        }
    }
    return step;
}

std::vector<DicomPart> parts_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder)) {
        std::error_code error;
        if (entry.is_regular_file(error) && entry.file_size(error) > 0 && !error) {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    std::vector<DicomPart> parts;
    for (const std::filesystem::path& file : files) {
        const std::string content = read_file(file);
        if (!is_dicom(content)) {
            continue;
        }
        try {
            with_own_errors([&] {
                if (check_dicom(content)) {  // reports may lie beside the slices of a series
                    parts.push_back(read_part(content));
                }
            });
        } catch (const FileError& fault) {
            throw with_prefix(file.filename().string() + ": ", fault);
        }
    }
    return parts;
}

}  // namespace

bool is_dicom(std::string_view content) { return content.size() > 132 && content.substr(128).starts_with("DICM"); }

Image read_dicom_image(std::string_view content, const std::filesystem::path&) {
    check_dicom(content);
    return with_own_errors([&] { return read_part(content).image; });
}

Image read_dicom_folder(const std::filesystem::path& folder) {
    std::vector<DicomPart> parts = parts_in(folder);
    std::set<std::string> series;
    for (const DicomPart& part : parts) {
        series.insert(part.series);
    }
    if (series.size() != 1) {
        throw unsupported(series.empty()
                              ? "there is no DICOM image in this folder, and no file with an extension that is known"
                              : "the folder has " + std::to_string(series.size()) +
                                    " DICOM series: put one of them into a folder of its own");
    }
    const Point normal = cross(parts.front().image.steps[0], parts.front().image.steps[1]);
    std::ranges::stable_sort(parts, {}, [&](const DicomPart& part) { return dot(normal, part.image.origin); });
    Image image = parts.front().image;
    if (parts.size() > 1) {
        image.steps[2] = slice_step(parts);
        image.sizes[2] = static_cast<Index>(parts.size());
        image.values.clear();
        image.values.reserve(parts.size() * parts.front().image.values.size());
        for (DicomPart& part : parts) {
            image.values.insert(image.values.end(), part.image.values.begin(), part.image.values.end());
            part.image.values = {};
        }
    }
    return image;
}

}  // namespace scaleaxis::io
