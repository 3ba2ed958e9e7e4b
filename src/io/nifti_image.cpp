// SPDX-License-Identifier: Apache-2.0
// NIfTI-1 in one file (Neuroimaging Informatics Technology Initiative, "NIfTI-1 data format", 2004).
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "io/faults.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::int32_t kHeadSize = 348;
constexpr std::int16_t kFloat = 16;
constexpr float kDataOffset = 352.0F;
constexpr std::int16_t kScanner = 1;  // what the coordinates are relative to

// Codes of units.
char unit_code(const std::string& unit) {
    return static_cast<char>(unit == "m" ? 1 : unit == "mm" ? 2 : unit == "um" ? 3 : 0);
}

}  // namespace

/// Where an image says that x and y point left and back, as DICOM has them, they are turned: NIfTI has right and front.
void write_nifti_image(OutputFile& out, const Image& image) {
    const bool is_turned = image.space.starts_with("left-posterior");
    const auto turned = [&](const Point& p) { return is_turned ? Point{-p.x, -p.y, p.z} : p; };
    if (std::ranges::any_of(image.sizes, [](Index n) { return n > std::numeric_limits<std::int16_t>::max(); })) {
        throw unsupported("the image is too large for NIfTI-1, which ends at 32767 voxels a side; write .nrrd");
    }
    const auto zeros = [&](int bytes) {
        for (int i = 0; i < bytes; ++i) {
            out.binary(std::uint8_t{0});
        }
    };
    const auto size = [&](int axis) { return static_cast<std::int16_t>(image.sizes[axis]); };
    const auto spacing = [&](int axis) { return static_cast<float>(norm(image.steps[axis])); };
    out.binary(kHeadSize);
    zeros(36);
    out.binary(std::int16_t{3}, size(0), size(1), size(2), std::int16_t{1}, std::int16_t{1}, std::int16_t{1},
               std::int16_t{1});
    zeros(14);
    out.binary(kFloat, std::int16_t{32}, std::int16_t{0});
    out.binary(1.0F, spacing(0), spacing(1), spacing(2), 0.0F, 0.0F, 0.0F, 0.0F);
    out.binary(kDataOffset, 1.0F, 0.0F);
    zeros(3);
    out.text(unit_code(image.unit));
    zeros(24);
    out.text("made by scaleaxis");
    zeros(80 - 17 + 24);
    out.binary(std::int16_t{0}, kScanner);
    zeros(24);
    const std::array steps{turned(image.steps[0]), turned(image.steps[1]), turned(image.steps[2])};
    const Point origin = turned(image.origin);
    for (double Point::*axis : {&Point::x, &Point::y, &Point::z}) {
        for (const Point& step : steps) {
            out.binary(static_cast<float>(step.*axis));
        }
        out.binary(static_cast<float>(origin.*axis));
    }
    zeros(16);
    out.text("n+1", '\0');
    zeros(4);
    for (const float value : image.values) {
        out.binary(value);
    }
}

}  // namespace scaleaxis::io
