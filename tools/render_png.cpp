// SPDX-License-Identifier: Apache-2.0
#include "render_png.hpp"

#include <png.h>

#include <string>
#include <system_error>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::render {

void write_png(const std::filesystem::path& file, const Image& image) {
    static_assert(sizeof(Pixel) == 3, "libpng takes the pixels as they lie in memory");
    std::filesystem::path temporary = file;
    temporary += ".part";
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    std::error_code error;
    if (!png_image_write_to_file(&png, temporary.c_str(), 0, image.pixels.data(), 0, nullptr)) {
        std::filesystem::remove(temporary, error);
        throw FileError(file.string() + ": cannot be written: " + png.message);
    }
    std::filesystem::rename(temporary, file, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw FileError(file.string() + ": cannot be written: " + error.message());
    }
}

}  // namespace scaleaxis::render
