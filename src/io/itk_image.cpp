// SPDX-License-Identifier: GPL-3.0-or-later
//
// The formats of images that the Insight Toolkit reads. The only source that knows it.
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageSeriesReader.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkTIFFImageIO.h>
#include <itkVTKImageIO.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/errors.hpp"

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
    throw FileError("no reader of images takes it: its head is damaged, or its kind is not supported");
}

void check_content(const itk::ImageIOBase& io) {
    unsigned dimensions = io.GetNumberOfDimensions();
    for (unsigned d = 3; d < io.GetNumberOfDimensions(); ++d) {
        if (io.GetDimensions(d) > 1) {
            throw FileError("the image has " + std::to_string(dimensions) + " dimensions, of sizes up to " +
                            std::to_string(io.GetDimensions(d)) + " beyond the third; one volume is needed");
        }
    }
    if (dimensions < 3) {
        throw FileError("the image has " + std::to_string(dimensions) + " dimensions; three are needed");
    }
    if (io.GetNumberOfComponents() != 1) {
        throw FileError("the image has " + std::to_string(io.GetNumberOfComponents()) +
                        " values a voxel (colours, vectors?); one is needed");
    }
}

/// The signs that the toolkit has given to x and y. It turns the coordinates of NIfTI and some of NRRD to
/// left-posterior-superior; they are wanted as they are in the file.
std::array<double, 2> turned_signs(const std::filesystem::path& file, const itk::ImageIOBase& io) {
    if (dynamic_cast<const itk::NiftiImageIO*>(&io) != nullptr) {
        return {-1.0, -1.0};
    }
    if (dynamic_cast<const itk::NrrdImageIO*>(&io) != nullptr) {
        const std::string content = read_file(file);
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

/// The toolkit fills what is missing of a MetaImage with anything.
void check_meta_length(const std::filesystem::path& file, const itk::ImageIOBase& io) {
    const std::string content = read_file(file);
    const auto value_of = [&](const std::string& key) -> std::string {
        const std::size_t at = content.find("\n" + key + " =");
        if (at == std::string::npos) {
            return {};
        }
        const std::size_t begin = content.find_first_not_of(' ', at + key.size() + 3);
        return content.substr(begin, content.find_first_of("\r\n", begin) - begin);
    };
    std::uintmax_t expected = io.GetImageSizeInBytes();
    if (to_lower(value_of("CompressedData")) == "true") {
        expected = static_cast<std::uintmax_t>(parse_number(value_of("CompressedDataSize")).value_or(0.0));
    }
    const std::string data = value_of("ElementDataFile");
    std::uintmax_t found = expected;
    if (data == "LOCAL" || data == "Local" || data == "local") {
        found = content.size() - (content.find('\n', content.find("\nElementDataFile") + 1) + 1);
    } else if (std::error_code error; data.find_first_of(" %") == std::string::npos && data != "LIST") {
        found = std::filesystem::file_size(file.parent_path() / data, error);
        if (error) {
            throw FileError("its data file " + data + ": " + error.message());
        }
    }
    if (found < expected) {
        throw FileError("its head says " + std::to_string(expected) + " bytes of data, but there are " +
                        std::to_string(found));
    }
}

template <class Reader>
Image image_of(const Reader& reader, const std::array<double, 2>& signs) {
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
    const float* values = read->GetBufferPointer();
    image.values.assign(values, values + read->GetPixelContainer()->Size());
    return image;
}

Image read_dicom(const std::string& folder) {
    const auto names = itk::GDCMSeriesFileNames::New();
    names->SetDirectory(folder);
    const std::vector<std::string>& series = names->GetSeriesUIDs();
    if (series.size() != 1) {
        throw FileError(series.empty() ? "there is no DICOM image in this folder"
                                       : "the folder has " + std::to_string(series.size()) +
                                             " DICOM series: put one of them into a folder of its own");
    }
    const auto io = itk::GDCMImageIO::New();
    const auto reader = itk::ImageSeriesReader<ItkImage>::New();
    reader->SetImageIO(io);
    reader->SetFileNames(names->GetFileNames(series.front()));
    reader->Update();
    return image_of(*reader, {1.0, 1.0});
}

}  // namespace

Image read_itk_image(const std::filesystem::path& file) {
    itk::Object::SetGlobalWarningDisplay(false);  // what is wrong is thrown, too
    try {
        if (std::filesystem::is_directory(file)) {
            return read_dicom(file.string());
        }
        const itk::ImageIOBase::Pointer io = io_of(file.string());
        io->SetFileName(file.string());
        io->ReadImageInformation();
        check_content(*io);
        if (dynamic_cast<const itk::MetaImageIO*>(io.GetPointer()) != nullptr) {
            check_meta_length(file, *io);
        }
        const auto reader = itk::ImageFileReader<ItkImage>::New();
        reader->SetImageIO(io);
        reader->SetFileName(file.string());
        reader->Update();
        return image_of(*reader, turned_signs(file, *io));
    } catch (const itk::ExceptionObject& error) {
        throw FileError(in_one_line(error));
    }
}

}  // namespace scaleaxis::io
