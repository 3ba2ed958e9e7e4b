// SPDX-License-Identifier: Apache-2.0
//
// The head of NIfTI-1 (R. Cox and others, "A (sort of) new image data format standard: NIfTI-1", 2004).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "io/bytes.hpp"
#include "io/compressed.hpp"
#include "io/faults.hpp"
#include "io/itk_checks.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::size_t kHead = 348;

/// The head, unpacked if it is packed.
std::string head_of(std::string_view content) {
    return is_gzip(content) ? inflated(content, kHead, true) : std::string(content.substr(0, kHead));
}

/// The byte order in which the head has its own size at its beginning; none for what is no NIfTI-1.
std::optional<std::endian> order_of(std::string_view head) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        if (head.size() >= kHead && from_bytes<std::int32_t>(head.data(), order) == kHead) {
            return order;
        }
    }
    return std::nullopt;
}

/// Where the fields of the head are that are asked for.
enum Place : std::size_t {
    kDim = 40,
    kDataType = 70,
    kBitPix = 72,
    kPixDim = 76,
    kVoxOffset = 108,
    kUnits = 123,
    kQformCode = 252,
    kSformCode = 254,
    kQuaternion = 256,
    kSform = 280,
    kMagic = 344
};

class Head {
   public:
    Head(std::string_view bytes, std::endian order) : bytes_(bytes), order_(order) {}

    std::int16_t integer(std::size_t at) const { return from_bytes<std::int16_t>(bytes_.data() + at, order_); }
    float number(std::size_t at) const { return from_bytes<float>(bytes_.data() + at, order_); }

   private:
    std::string_view bytes_;
    std::endian order_;
};

/// The places of voxels: numbers whose products are finite.
void check_place(const Head& head) {
    const auto check = [&](std::size_t at, std::size_t count, bool (*is_right)(double)) {
        for (std::size_t i = 0; i < count; ++i) {
            if (!is_right(head.number(at + 4 * i))) {
                throw damaged("its spacing, origin or directions are no finite numbers that an image can have");
            }
        }
    };
    check(kPixDim + 4, 3, is_of_place);
    if (head.integer(kQformCode) > 0) {
        check(kQuaternion, 6, is_of_place);
    }
    if (head.integer(kSformCode) > 0) {
        check(kSform, 12, is_of_place);
    }
}

/// How many bytes of voxels the head promises.
double bytes_of_voxels(const Head& head) {
    double bits = head.integer(kBitPix);
    const int dimensions = head.integer(kDim);
    bool is_size = bits > 0.0 && dimensions >= 1 && dimensions <= 7;
    for (int d = 1; is_size && d <= dimensions; ++d) {
        const double size = head.integer(kDim + 2 * static_cast<std::size_t>(d));
        // Some programs leave sizes beyond the third at 0.
        is_size = size > 0.0 || (d > 3 && size == 0.0);
        bits *= std::max(size, 1.0);
    }
    if (!(is_size && bits < 0x1p43)) {
        throw damaged("its head says a size that no image has");
    }
    return bits / 8.0;
}

}  // namespace

std::string nifti_head(std::string_view content) { return head_of(content); }

std::string nifti_unit(std::string_view content) {
    const std::string head = head_of(content);
    constexpr std::array<const char*, 4> kNames{"", "m", "mm", "um"};
    const auto unit = static_cast<std::size_t>(head.size() > kUnits ? head[kUnits] & 7 : 0);
    return unit < kNames.size() ? kNames[unit] : "";
}

std::optional<std::array<Point, 4>> nifti_sform(std::string_view content) {
    const std::string bytes = head_of(content);
    const Head head(bytes, order_of(bytes).value());
    if (head.integer(kSformCode) <= 0) {
        return std::nullopt;
    }
    std::array<Point, 4> columns;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const auto number = [&](std::size_t row) { return double{head.number(kSform + 16 * row + 4 * k)}; };
        columns[k] = {number(0), number(1), number(2)};
    }
    return columns;
}

bool has_nifti_data(std::string_view content) {
    const std::string head = head_of(content);
    return head.size() > kMagic && std::string_view(head).substr(kMagic).starts_with("n+");
}

void check_nifti(const std::filesystem::path& file, std::string_view content) {
    const std::string bytes = head_of(content);
    const std::optional<std::endian> order = order_of(bytes);
    if (!order) {
        throw unsupported("it is no NIfTI of version 1, or its head is damaged; convert it to NIfTI-1 or NRRD");
    }
    const Head head(bytes, *order);
    check_place(head);
    const double voxels = bytes_of_voxels(head);
    const float offset = head.number(kVoxOffset);
    if (!(offset >= 0.0F && offset < 0x1p31F)) {
        throw damaged("its head says that the data begin at a place where they cannot be");
    }
    const std::uintmax_t promised = static_cast<std::uintmax_t>(offset) + static_cast<std::uintmax_t>(voxels);
    const std::filesystem::path data = std::filesystem::path(file).replace_extension(".img");
    if (has_nifti_data(content)) {
        check_bytes(promised, is_gzip(content) ? inflated_size(content) : content.size());
    } else if (std::filesystem::exists(data)) {  // a pair of files, this one without data
        check_bytes(promised, size_of_data(data));
    }
}

}  // namespace scaleaxis::io
