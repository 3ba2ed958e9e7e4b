// SPDX-License-Identifier: Apache-2.0
//
// LAS 1.0 to 1.4 (ASPRS, LAS Specification 1.4 R15): the coordinates of all points that are not withheld.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "io/formats.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::size_t kLasHeadSize = 227;    // of versions up to 1.2
constexpr std::size_t kHeadSize14 = 375;     // of version 1.4, with counts of 64 bits
constexpr unsigned kCompressed = 0xC0;       // bits of the point format that LASzip sets
constexpr unsigned kLongFormat = 6;          // from this one on records have other flags
constexpr std::size_t kClassification = 15;  // its highest bit marks points that are withheld; of long formats bit 2

/// The shortest record of each point format.
constexpr std::array<std::size_t, 11> kRecordSizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

template <class T>
T las_number(std::string_view content, std::size_t at) {
    return from_bytes<T>(content.data() + at, std::endian::little);
}

struct LasHead {
    unsigned format = 0;
    std::size_t record_size = 0;
    std::uint64_t count = 0;
    std::uint64_t data = 0;  ///< where the points begin
    std::array<double, 3> scale{};
    std::array<double, 3> offset{};
};

LasHead read_las_head(std::string_view content) {
    if (content.size() < kLasHeadSize) {
        throw truncated("the file ends within the LAS header: it is truncated");
    }
    LasHead head;
    const auto minor = las_number<std::uint8_t>(content, 25);
    head.data = las_number<std::uint32_t>(content, 96);
    head.format = las_number<std::uint8_t>(content, 104);
    head.record_size = las_number<std::uint16_t>(content, 105);
    head.count = las_number<std::uint32_t>(content, 107);
    if (minor >= 4 && head.count == 0) {
        if (content.size() < kHeadSize14) {
            throw truncated("the file ends within the LAS header: it is truncated");
        }
        head.count = las_number<std::uint64_t>(content, 247);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        head.scale[k] = las_number<double>(content, 131 + 8 * k);
        head.offset[k] = las_number<double>(content, 155 + 8 * k);
    }
    return head;
}

void check(const LasHead& head, std::string_view content) {
    if ((head.format & kCompressed) != 0) {
        throw unsupported(
            "it is LAZ (compressed LAS), which is not read: convert it to LAS, as by `pdal translate in.laz out.las` "
            "or `laszip -i in.laz -o out.las`, or save it as LAS or PLY in CloudCompare");
    }
    if (head.format >= kRecordSizes.size()) {
        throw unsupported("its point format is " + std::to_string(head.format) + "; 0 to 10 are read");
    }
    if (head.record_size < kRecordSizes[head.format]) {
        throw damaged("its points have " + std::to_string(head.record_size) + " bytes each, those of point format " +
                      std::to_string(head.format) + " have " + std::to_string(kRecordSizes[head.format]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        if (!std::isfinite(head.scale[k]) || head.scale[k] == 0.0 || !std::isfinite(head.offset[k])) {
            throw damaged("scale and offset of its coordinates have to be finite numbers, and the scale not 0");
        }
    }
    const std::uint64_t present = head.data > content.size() ? 0 : (content.size() - head.data) / head.record_size;
    if (head.count > present) {
        throw truncated("the header announces " + std::to_string(head.count) + " points, the file has " +
                        std::to_string(present) + ": it is truncated");
    }
}

}  // namespace

bool is_las(std::string_view content) { return content.starts_with("LASF"); }

PointCloud read_las_points(std::string_view content) {
    const LasHead head = read_las_head(content);
    check(head, content);
    const unsigned withheld = head.format < kLongFormat ? 0x80 : 0x04;
    PointCloud cloud;
    cloud.points.reserve(head.count);
    for (std::uint64_t i = 0; i < head.count; ++i) {
        const std::size_t at = head.data + i * head.record_size;
        if ((las_number<std::uint8_t>(content, at + kClassification) & withheld) != 0) {
            continue;  // deleted, as the standard says
        }
        const auto coordinate = [&](std::size_t k) {
            return las_number<std::int32_t>(content, at + 4 * k) * head.scale[k] + head.offset[k];
        };
        cloud.points.push_back({coordinate(0), coordinate(1), coordinate(2)});
    }
    return cloud;
}

}  // namespace scaleaxis::io
