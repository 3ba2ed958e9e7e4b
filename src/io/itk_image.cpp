// SPDX-License-Identifier: GPL-3.0-or-later
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
#include <string>
#include <vector>

#include "io/formats.hpp"
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

/// The toolkit turns the coordinates of some formats to left-posterior-superior. Back to those of the file.
Point to_own_convention(const Point& p, const itk::ImageIOBase& io) {
    if (dynamic_cast<const itk::NiftiImageIO*>(&io) != nullptr) {
        return {0.0 - p.x, 0.0 - p.y, p.z + 0.0};
    }
    std::string space;
    if (dynamic_cast<const itk::NrrdImageIO*>(&io) != nullptr) {
        itk::ExposeMetaData(io.GetMetaDataDictionary(), "NRRD_space", space);
    }
    const bool is_turned = space == "right-anterior-superior" || space == "left-anterior-superior";
    return is_turned ? Point{0.0 - p.x, 0.0 - p.y, p.z} : p;
}

template <class Reader>
Image image_of(const Reader& reader, const itk::ImageIOBase& io) {
    const ItkImage* read = reader.GetOutput();
    Image image;
    const auto size = read->GetLargestPossibleRegion().GetSize();
    const auto& origin = read->GetOrigin();
    image.origin = to_own_convention({origin[0], origin[1], origin[2]}, io);
    for (unsigned axis = 0; axis < 3; ++axis) {
        image.sizes[axis] = static_cast<Index>(size[axis]);
        const double spacing = read->GetSpacing()[axis];
        const auto& direction = read->GetDirection();
        image.steps[axis] =
            to_own_convention(spacing * Point{direction[0][axis], direction[1][axis], direction[2][axis]}, io);
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
    return image_of(*reader, *io);
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
        const auto reader = itk::ImageFileReader<ItkImage>::New();
        reader->SetImageIO(io);
        reader->SetFileName(file.string());
        reader->Update();
        return image_of(*reader, *io);
    } catch (const itk::ExceptionObject& error) {
        throw FileError(in_one_line(error));
    }
}

}  // namespace scaleaxis::io
