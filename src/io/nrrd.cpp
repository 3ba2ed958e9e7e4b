// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "io/formats.hpp"

namespace scaleaxis::io {

void write_nrrd_image(OutputFile& out, const Image& image) {
    const Point& origin = image.origin;
    const auto& [a, b, c] = image.steps;
    const std::string quoted = '"' + image.unit + '"';
    const std::string units = image.unit.empty() ? "" : "space units: " + quoted + ' ' + quoted + ' ' + quoted + '\n';
    out.text("NRRD0004\n# made by scaleaxis\ntype: float\ndimension: 3\n",
             "space dimension: 3\nsizes: ", image.sizes[0], ' ', image.sizes[1], ' ', image.sizes[2],
             "\nspace directions: (", a.x, ',', a.y, ',', a.z, ") (", b.x, ',', b.y, ',', b.z, ") (", c.x, ',', c.y,
             ',', c.z, ")\nkinds: domain domain domain\n", "endian: little\nencoding: raw\nspace origin: (", origin.x,
             ',', origin.y, ',', origin.z, ")\n", units, '\n');
    for (const float value : image.values) {
        out.binary(value);
    }
}

}  // namespace scaleaxis::io
