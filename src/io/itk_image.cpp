// SPDX-License-Identifier: Apache-2.0
//
// The formats of images that the Insight Toolkit reads. The only source that knows it.
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageSeriesReader.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkTIFFImageIO.h>
#include <itkVTKImageIO.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/itk_checks.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

using ItkImage = itk::Image<float, 3>;

/// What an error of the toolkit says, in one line and without its own names.
std::string in_one_line(const itk::ExceptionObject& error) {
    std::string text = error.GetDescription();
    if (const std::size_t object = text.find("): "); to_lower(text).starts_with("itk") && object != std::string::npos) {
        text = text.substr(object + 3);
    }
    std::string result;
    for (const char c : text) {
        const bool is_blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
        if (!is_blank) {
            result += c;
        } else if (!result.empty() && result.back() != ' ') {
            result += ' ';
        }
    }
    while (result.ends_with(' ')) {
        result.pop_back();
    }
    return result.empty() ? "the file is damaged" : result;
}

itk::ImageIOBase::Pointer io_of(const std::string& file) {
    const std::vector<itk::ImageIOBase::Pointer> all{
        itk::NrrdImageIO::New().GetPointer(), itk::NiftiImageIO::New().GetPointer(),
        itk::MetaImageIO::New().GetPointer(), itk::TIFFImageIO::New().GetPointer(),
        itk::VTKImageIO::New().GetPointer(),  itk::GDCMImageIO::New().GetPointer()};
    for (const itk::ImageIOBase::Pointer& io : all) {
        if (io->CanReadFile(file.c_str())) {
            return io;
        }
    }
    throw damaged("no reader of images takes it: its head is damaged, or its kind is not supported");
}

void check_content(const itk::ImageIOBase& io) {
    unsigned dimensions = io.GetNumberOfDimensions();
    for (unsigned d = 3; d < io.GetNumberOfDimensions(); ++d) {
        if (io.GetDimensions(d) > 1) {
            throw unsupported("the image has " + std::to_string(dimensions) + " dimensions, of sizes up to " +
                              std::to_string(io.GetDimensions(d)) + " beyond the third; one volume is needed");
        }
    }
    if (dimensions < 3) {
        throw unsupported("the image has " + std::to_string(dimensions) + " dimensions; three are needed");
    }
    if (io.GetNumberOfComponents() != 1) {
        throw unsupported("the image has " + std::to_string(io.GetNumberOfComponents()) +
                          " values a voxel (colours, vectors?); one is needed");
    }
}

/// Spacing, origin and directions are what an image can have: the toolkit stops the program over others.
void check_place(const itk::ImageIOBase& io) {
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (!is_spacing(io.GetSpacing(axis)) || !is_of_place(io.GetOrigin(axis)) ||
            !std::ranges::all_of(io.GetDirection(axis), is_of_place)) {
            throw damaged("its spacing, origin or directions are no finite numbers that an image can have");
        }
    }
}

/// Reads the head.
void read_head(itk::ImageIOBase& io, const std::string& file) {
    io.SetFileName(file);
    io.ReadImageInformation();
    check_content(io);
    check_place(io);
}

/// The unit of lengths and where x, y and z point, where the file says so.
void tell_frame(Image& image, const std::string& content) {
    if (is_nifti(content)) {
        image.unit = nifti_unit(content);
        image.space = "right-anterior-superior";
    } else if (is_nrrd(content)) {
        image.unit = nrrd_unit(content);
        image.space = nrrd_space(content);
    } else if (is_meta_image(content)) {
        image.unit = meta_image_unit(content);
    } else if (is_dicom(content)) {
        image.unit = "mm";
        image.space = "left-posterior-superior";
    }
}

/// The signs that the toolkit has given to x and y. It turns the coordinates of NIfTI and some of NRRD to
/// left-posterior-superior; they are wanted as they are in the file.
std::array<double, 2> turned_signs(const std::string& content) {
    if (is_nifti(content)) {
        return {-1.0, -1.0};
    }
    if (is_nrrd(content)) {
        const std::size_t end = std::min(content.find("\n\n"), content.size());
        if (const std::size_t at = content.find("\nspace: "); at < end) {
            const std::string space = to_lower(content.substr(at + 8, content.find_first_of("\r\n", at + 8) - at - 8));
            if (space == "right-anterior-superior" || space == "ras") {
                return {-1.0, -1.0};
            }
            if (space == "left-anterior-superior" || space == "las") {
                return {-1.0, 1.0};
            }
        }
    }
    return {1.0, 1.0};
}

/// Sizes, origin and steps, once the head is read.
template <class Reader>
Image frame_of(const Reader& reader, const std::array<double, 2>& signs) {
    const ItkImage* read = reader.GetOutput();
    Image image;
    const auto size = read->GetLargestPossibleRegion().GetSize();
    const auto& origin = read->GetOrigin();
    const auto place = [&](double x, double y, double z) {
        return Point{signs[0] * x + 0.0, signs[1] * y + 0.0, z + 0.0};  // no -0
    };
    image.origin = place(origin[0], origin[1], origin[2]);
    for (unsigned axis = 0; axis < 3; ++axis) {
        image.sizes[axis] = static_cast<Index>(size[axis]);
        const double spacing = read->GetSpacing()[axis];
        const auto& direction = read->GetDirection();
        image.steps[axis] =
            place(spacing * direction[0][axis], spacing * direction[1][axis], spacing * direction[2][axis]);
    }
    return image;
}

/// Where a NIfTI says its place twice, the toolkit takes one of them by their codes, and others the matrix. It makes
/// millimetres of metres and micrometres in the steps, but not in the origin.
void place_nifti(Image& image, const std::string& head) {
    if (const std::optional<std::array<Point, 4>> sform = nifti_sform(head)) {
        image.steps = {(*sform)[0], (*sform)[1], (*sform)[2]};
        image.origin = (*sform)[3];
        return;
    }
    const std::string unit = nifti_unit(head);
    for (Point& step : image.steps) {
        step = (unit == "m" ? 1e-3 : unit == "um" ? 1e3 : 1.0) * step;
    }
}

template <class Reader>
std::vector<float> values_of(Reader& reader) {
    reader.Update();
    const ItkImage* read = reader.GetOutput();
    const float* values = read->GetBufferPointer();
    return {values, values + read->GetPixelContainer()->Size()};
}

/// The voxels of a file, read in the type that they have there into the end of the memory of the floats that they
/// become, front to back: the toolkit itself would need a copy of both kinds besides.
template <class Value>
std::vector<float> values_as(itk::ImageIOBase& io, std::size_t count) {
    std::vector<float> values(count);
    char* const read = reinterpret_cast<char*>(values.data()) + count * (sizeof(float) - sizeof(Value));
    io.Read(read);
    for (std::size_t i = 0; i < count; ++i) {
        Value value;
        std::memcpy(&value, read + i * sizeof(Value), sizeof(Value));
        values[i] = static_cast<float>(value);
    }
    return values;
}

/// \param io has read the head
template <class Reader>
std::vector<float> values_of(Reader& reader, itk::ImageIOBase& io) {
    if (io.GetNumberOfDimensions() != 3) {
        return values_of(reader);
    }
    itk::ImageIORegion all(3);
    std::size_t count = 1;
    for (unsigned axis = 0; axis < 3; ++axis) {
        all.SetSize(axis, io.GetDimensions(axis));
        count *= io.GetDimensions(axis);
    }
    io.SetIORegion(all);
    switch (io.GetComponentType()) {
        case itk::ImageIOBase::UCHAR:
            return values_as<unsigned char>(io, count);
        case itk::ImageIOBase::CHAR:
            return values_as<signed char>(io, count);
        case itk::ImageIOBase::USHORT:
            return values_as<unsigned short>(io, count);
        case itk::ImageIOBase::SHORT:
            return values_as<short>(io, count);
        case itk::ImageIOBase::UINT:
            return values_as<unsigned>(io, count);
        case itk::ImageIOBase::INT:
            return values_as<int>(io, count);
        case itk::ImageIOBase::FLOAT:
            return values_as<float>(io, count);
        default:
            return values_of(reader);
    }
}

/// The numbers of an element of a slice, which are separated by backslashes; none if it has no such element.
std::vector<double> numbers_of(const itk::MetaDataDictionary& slice, const std::string& element) {
    std::string text;
    std::vector<double> numbers;
    if (itk::ExposeMetaData(slice, element, text)) {
        std::ranges::replace(text, '\\', ' ');
        TextReader reader(text);
        for (std::string_view word = reader.any_word(); !word.empty(); word = reader.any_word()) {
            numbers.push_back(parse_number(word).value_or(NAN));
        }
    }
    return numbers;
}

bool is_near(const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) < 1e-3; });
}

/// From slice to slice, in a gantry that is tilted too. The toolkit only looks at the first and the last one.
/// \throws FileError if that is not the same everywhere
Point slice_step(const std::vector<const itk::MetaDataDictionary*>& slices) {
    constexpr double kMostDeviation = 0.1;  // of the step
    std::vector<Point> places;
    for (const itk::MetaDataDictionary* slice : slices) {
        for (const std::string element : {"0020|0037", "0028|0030"}) {
            if (!is_near(numbers_of(*slice, element), numbers_of(*slices.front(), element))) {
                throw damaged("the slices of the DICOM series do not have the same directions and spacing");
            }
        }
        const std::vector<double> place = numbers_of(*slice, "0020|0032");
        if (place.size() != 3) {
            throw damaged("a slice of the DICOM series has no position");
        }
        places.push_back({place[0], place[1], place[2]});
    }
    const auto last = static_cast<double>(places.size() - 1);
    const Point step = (1.0 / last) * (places.back() - places.front());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double deviation = distance(places[i], places.front() + static_cast<double>(i) * step);
        if (!(deviation < kMostDeviation * norm(step))) {
            throw damaged("the slices of the DICOM series are not evenly apart: is one missing, or there twice?");
        }
    }
    return step;
}

/// What `read` returns; the errors of the toolkit as those of the library.
template <class Read>
Image with_own_errors(const Read& read) {
    itk::Object::SetGlobalWarningDisplay(false);  // what is wrong is thrown, too
    try {
        return read();
    } catch (const itk::ExceptionObject& error) {
        throw damaged(in_one_line(error));
    }
}

}  // namespace

Image read_dicom_folder(const std::filesystem::path& folder) {
    return with_own_errors([&] {
        for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder)) {
            std::error_code error;
            if (!entry.is_regular_file(error) || entry.file_size(error) == 0 || error) {
                continue;
            }
            if (const std::string content = read_file(entry.path()); is_dicom(content)) {
                try {
                    check_itk_head(entry.path(), content);
                } catch (const FileError& fault) {
                    throw with_prefix(entry.path().filename().string() + ": ", fault);
                }
            }
        }
        const auto names = itk::GDCMSeriesFileNames::New();
        names->SetDirectory(folder.string());
        const std::vector<std::string>& series = names->GetSeriesUIDs();
        if (series.size() != 1) {
            throw unsupported(
                series.empty() ? "there is no DICOM image in this folder, and no file with an extension that is known"
                               : "the folder has " + std::to_string(series.size()) +
                                     " DICOM series: put one of them into a folder of its own");
        }
        const auto io = itk::GDCMImageIO::New();
        const std::vector<std::string> files = names->GetFileNames(series.front());
        read_head(*io, files.front());
        check_itk_length(files.front(), read_file(files.front()), io->GetImageSizeInPixels(),
                         io->GetImageSizeInBytes());
        const auto reader = itk::ImageSeriesReader<ItkImage>::New();
        reader->SetImageIO(io);
        reader->SetFileNames(files);
        std::vector<float> values = values_of(*reader);
        Image image = frame_of(*reader, {1.0, 1.0});
        image.values = std::move(values);
        if (files.size() > 1) {
            const auto& slices = *reader->GetMetaDataDictionaryArray();
            image.steps[2] = slice_step({slices.begin(), slices.end()});
        }
        image.unit = "mm";
        image.space = "left-posterior-superior";
        return image;
    });
}

Image read_itk_image(const std::filesystem::path& file, std::string content) {
    return with_own_errors([&] {
        check_itk_head(file, content);
        const itk::ImageIOBase::Pointer io = io_of(file.string());
        read_head(*io, file.string());
        check_itk_length(file, content, io->GetImageSizeInPixels(), io->GetImageSizeInBytes());
        const std::array<double, 2> signs = turned_signs(content);
        Image frame;
        tell_frame(frame, content);
        const std::string nifti = is_nifti(content) ? nifti_head(content) : "";
        const bool is_read_directly = is_nrrd(content) || is_nifti(content) || is_meta_image(content);
        content = {};  // the toolkit reads the file itself
        const auto reader = itk::ImageFileReader<ItkImage>::New();
        reader->SetImageIO(io);
        reader->SetFileName(file.string());
        reader->UpdateOutputInformation();
        Image image = frame_of(*reader, signs);
        if (!nifti.empty()) {
            place_nifti(image, nifti);
        }
        image.values = is_read_directly ? values_of(*reader, *io) : values_of(*reader);
        image.unit = std::move(frame.unit);
        image.space = std::move(frame.space);
        return image;
    });
}

}  // namespace scaleaxis::io
