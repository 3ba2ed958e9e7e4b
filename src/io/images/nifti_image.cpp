// SPDX-License-Identifier: Apache-2.0
//
// NIfTI (Neuroimaging Informatics Technology Initiative, "NIfTI-1 data format", 2004; "The NIfTI-2 file format", 2011).
// The second version has the fields of the first in other places and with more digits.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "base/formats/compressed.hpp"
#include "io/formats.hpp"
#include "io/images/stored_image.hpp"
#include "io/input_file.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::int32_t kHeadSize = 348;
constexpr std::int32_t kHeadSize2 = 540;
constexpr std::array<std::string_view, 4> kLengthUnits{"", "m", "mm", "um"};  // by their codes

/// Where fields are in a version of the format.
struct NiftiFields {
    std::size_t dim, type, pixdim, offset, slope, units, qform, sform, quaternion, matrix;
};
constexpr NiftiFields kFields1{40, 70, 76, 108, 112, 123, 252, 254, 256, 280};
constexpr NiftiFields kFields2{16, 12, 104, 168, 176, 500, 344, 348, 352, 400};

/// The head, unpacked.
class NiftiHead {
   public:
    /// \throws FileError unless it has its own size at its beginning
    explicit NiftiHead(std::string bytes) : bytes_(std::move(bytes)) {
        for (const std::endian order : {std::endian::little, std::endian::big}) {
            const std::int32_t size = bytes_.size() >= 4 ? from_bytes<std::int32_t>(bytes_.data(), order) : 0;
            if ((size == kHeadSize || size == kHeadSize2) && !is_known_) {
                is_known_ = true;
                is_second_ = size == kHeadSize2;
                order_ = order;
            }
        }
        if (!is_known_) {
            throw damaged("its head does not have its own size");
        }
        if (bytes_.size() < size()) {
            throw truncated("its head does not end");
        }
    }

    std::size_t size() const { return is_second_ ? kHeadSize2 : kHeadSize; }
    std::endian order() const { return order_; }
    const NiftiFields& fields() const { return is_second_ ? kFields2 : kFields1; }
    bool has_data() const { return std::string_view(bytes_).substr(is_second_ ? 4 : 344).starts_with("n+"); }

    std::int64_t size_at(std::size_t i) const {
        return is_second_ ? get<std::int64_t>(kFields2.dim + 8 * i) : get<std::int16_t>(kFields1.dim + 2 * i);
    }
    /// A place or a scale, of which there may be several in a row.
    double number(std::size_t at, std::size_t i = 0) const {
        return is_second_ ? get<double>(at + 8 * i) : double{get<float>(at + 4 * i)};
    }
    int code(std::size_t at) const { return is_second_ ? get<std::int32_t>(at) : get<std::int16_t>(at); }
    int type() const { return get<std::int16_t>(fields().type); }
    int units() const { return is_second_ ? get<std::int32_t>(kFields2.units) : bytes_[kFields1.units]; }
    /// Where the numbers begin, if it is a place in a file.
    std::optional<std::int64_t> offset() const {
        constexpr double kMost = std::numeric_limits<Index>::max();
        const double offset =
            is_second_ ? static_cast<double>(get<std::int64_t>(kFields2.offset)) : double{get<float>(kFields1.offset)};
        return offset >= 0.0 && offset <= kMost ? std::optional(static_cast<std::int64_t>(offset)) : std::nullopt;
    }

   private:
    template <class T>
    T get(std::size_t at) const {
        return from_bytes<T>(bytes_.data() + at, order_);
    }

    std::string bytes_;
    std::endian order_ = std::endian::little;
    bool is_known_ = false;
    bool is_second_ = false;
};

NumberType nifti_type(int code) {
    constexpr std::string_view kTypes = "2 u1 4 i2 8 i4 16 f4 64 f8 256 i1 512 u2 768 u4 1024 i8 1280 u8";
    if (const std::optional<NumberType> type = number_type_in(kTypes, std::to_string(code))) {
        return *type;
    }
    throw unsupported("values of the type " + std::to_string(code) +
                      " of NIfTI cannot be read (colours, or complex numbers?): one real number a voxel is needed");
}

/// The columns of the rotation that a quaternion means, of which three numbers are given.
std::array<Point, 3> rotation_of(double b, double c, double d) {
    double a = 1.0 - (b * b + c * c + d * d);
    if (a < 1e-7) {  // half a turn, to within rounding
        const double length = std::sqrt(b * b + c * c + d * d);
        b /= length;
        c /= length;
        d /= length;
        a = 0.0;
    }
    a = std::sqrt(a);
    return {Point{a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)},
            Point{2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)},
            Point{2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - b * b - c * c}};
}

/// A matrix counts for more than a rotation. Without either x and y of the first voxels are at the right and in front.
void read_nifti_place(const NiftiHead& head, Image& frame) {
    const NiftiFields& at = head.fields();
    const auto point = [&](std::size_t field, std::size_t first, std::size_t step) {
        return Point{head.number(field, first), head.number(field, first + step), head.number(field, first + 2 * step)};
    };
    const auto unit = static_cast<std::size_t>(head.units() & 7);
    frame.unit = unit < kLengthUnits.size() ? kLengthUnits[unit] : "";
    frame.space = "right-anterior-superior";
    if (head.code(at.sform) > 0) {
        frame.steps = {point(at.matrix, 0, 4), point(at.matrix, 1, 4), point(at.matrix, 2, 4)};
        frame.origin = point(at.matrix, 3, 4);
        return;
    }
    const Point spacing = point(at.pixdim, 1, 1);
    frame.steps = {Point{-1, 0, 0}, Point{0, -1, 0}, Point{0, 0, 1}};
    if (head.code(at.qform) > 0) {
        frame.steps =
            rotation_of(head.number(at.quaternion), head.number(at.quaternion, 1), head.number(at.quaternion, 2));
        frame.origin = point(at.quaternion, 3, 1);
        frame.steps[2] = (head.number(at.pixdim) < 0.0 ? -1.0 : 1.0) * frame.steps[2];
    }
    frame.steps = {spacing.x * frame.steps[0], spacing.y * frame.steps[1], spacing.z * frame.steps[2]};
}

/// The file of the numbers beside that of a head.
std::filesystem::path nifti_data_file(std::filesystem::path head) {
    if (head.extension() == ".gz") {
        head.replace_extension();
    }
    const std::filesystem::path plain = head.replace_extension(".img");
    std::filesystem::path packed = plain;
    packed += ".gz";
    return !is_plain_file(plain) && is_plain_file(packed) ? packed : plain;
}

/// What a value means is said in the head. What is no number counts as 0.
void scale_values(const NiftiHead& head, std::vector<float>& values) {
    const double slope = head.number(head.fields().slope);
    const double offset =
        std::isfinite(head.number(head.fields().slope, 1)) ? head.number(head.fields().slope, 1) : 0.0;
    const bool is_scaled = std::isfinite(slope) && slope != 0.0 && (slope != 1.0 || offset != 0.0);
    for (float& value : values) {
        value = !std::isfinite(value) ? 0.0F : is_scaled ? as_float(double{value} * slope + offset) : value;
    }
}

constexpr std::int16_t kFloatCode = 16;
constexpr float kDataOffset = 352.0F;
constexpr std::int16_t kScanner = 1;  // what the coordinates are relative to

}  // namespace

bool is_nifti(std::string_view content) {
    constexpr std::size_t kEnough = 352;
    const std::string head = beginning_of(content, kEnough);
    const auto has = [&](std::size_t at, std::string_view word) {
        return head.size() > at && std::string_view(head).substr(at).starts_with(word);
    };
    return has(344, "n+1") || has(344, "ni1") || has(4, "n+2") || has(4, "ni2");
}

Image read_nifti_image(std::string_view content, const std::filesystem::path& file) {
    const NiftiHead head(beginning_of(content, kHeadSize2));
    const std::optional<std::int64_t> offset = head.offset();
    StoredImage stored;
    const std::int64_t dimensions = head.size_at(0);
    if (dimensions < 1 || dimensions > 7) {
        throw damaged("its head says a size that no image has");
    }
    for (std::int64_t i = 1; i <= dimensions; ++i) {
        // Some programs leave sizes beyond the third at 0.
        const std::int64_t size = head.size_at(static_cast<std::size_t>(i));
        stored.sizes.push_back(i > 3 && size == 0 ? 1 : size);
    }
    stored.type = nifti_type(head.type());
    stored.order = head.order();
    read_nifti_place(head, stored.frame);
    if (!offset) {
        throw damaged("its head says that the data begin at a place where they cannot be");
    }
    stored.skipped_bytes =
        head.has_data() ? std::max<std::int64_t>(*offset, static_cast<std::int64_t>(head.size())) : *offset;
    stored.parts = {data_behind_head(content, content, file)};
    stored.packing = is_gzip(content) ? Packing::kZlib : Packing::kNone;
    if (!head.has_data()) {
        if (file.empty()) {
            throw data_apart("");
        }
        stored.parts = {StoredData{{}, nifti_data_file(file)}};
        stored.packing = stored.parts[0].file.extension() == ".gz" ? Packing::kZlib : Packing::kNone;
    }
    Image image = read_stored(stored);
    scale_values(head, image.values);
    return image;
}

/// Where an image says that x points left, or y back, as in DICOM, they are turned: NIfTI has right and front.
void write_nifti_image(OutputFile& out, const Image& image) {
    const double to_right = image.space.starts_with("left-") ? -1.0 : 1.0;
    const double to_front = image.space.find("-posterior-") != std::string::npos ? -1.0 : 1.0;
    const auto turned = [&](const Point& p) { return Point{to_right * p.x, to_front * p.y, p.z}; };
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
    out.binary(kFloatCode, std::int16_t{32}, std::int16_t{0});
    out.binary(1.0F, spacing(0), spacing(1), spacing(2), 0.0F, 0.0F, 0.0F, 0.0F);
    out.binary(kDataOffset, 1.0F, 0.0F);
    zeros(3);
    const auto unit = std::ranges::find(kLengthUnits, image.unit);
    out.text(static_cast<char>(unit == kLengthUnits.end() ? 0 : unit - kLengthUnits.begin()));
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
