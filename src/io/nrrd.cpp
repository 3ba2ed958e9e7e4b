// SPDX-License-Identifier: GPL-3.0-or-later
// Images to files: NRRD, "nearly raw raster data", the format of the Teem library, ITK and 3D Slicer.
#include "io/output_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis {

void write_image(const std::filesystem::path& file, const Image& image) {
    check_image_output(file);
    io::OutputFile out(file);
    const auto& [origin, s] = std::pair(image.origin, image.spacing);
    out.text("NRRD0004\n# made by scaleaxis: signed distance, negative inside\ntype: float\ndimension: 3\n",
             "space dimension: 3\nsizes: ", image.sizes[0], ' ', image.sizes[1], ' ', image.sizes[2],
             "\nspace directions: (", s, ",0,0) (0,", s, ",0) (0,0,", s, ")\nkinds: domain domain domain\n",
             "endian: little\nencoding: raw\nspace origin: (", origin.x, ',', origin.y, ',', origin.z, ")\n\n");
    for (const float value : image.values) {
        out.binary(value);
    }
    out.commit();
}

void check_image_output(const std::filesystem::path& file) {
    if (io::to_lower(file.extension().string()) != ".nrrd") {
        throw FileError("cannot write " + file.string() + ": the name of an image has to end in .nrrd");
    }
    const io::OutputFile probe(file);
}

}  // namespace scaleaxis
