// SPDX-License-Identifier: Apache-2.0
//
// The head of NIfTI-2 ("The NIfTI-2 file format", 2011), which has the fields of NIfTI-1 in other places and with more
// digits. The Insight Toolkit only knows the first version.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "io/bytes.hpp"
#include "io/compressed.hpp"
#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/itk_checks.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::size_t kHead2 = 540;
constexpr std::size_t kHead1 = 348;
/// Of the first version, with the four bytes that say that no more of the head follows.
constexpr std::size_t kData1 = 352;

/// A field or several in a row, by where they are in both versions.
struct Place {
    std::size_t in2 = 0;
    std::size_t in1 = 0;
    std::size_t count = 1;
};

/// Those that change their type: from `From` in the second version to `To` in the first.
constexpr std::array kIntegers{Place{344, 252}, Place{348, 254}, Place{504, 68}};  // int32 → int16: forms, intent
constexpr std::array kNumbers{Place{104, 76, 8}, Place{176, 112, 2}, Place{352, 256, 6},
                              Place{400, 280, 12}};  // double → float: spacing, scale of the values, places
constexpr std::size_t kDim2 = 16;
constexpr std::size_t kDim1 = 40;
constexpr std::size_t kOffset2 = 168;
constexpr std::size_t kOffset1 = 108;

template <class T>
T get(std::string_view head, std::size_t at, std::endian order) {
    return from_bytes<T>(head.data() + at, order);
}

template <class T>
void put(std::string& head, std::size_t at, T value, std::endian order) {
    std::ranges::copy(to_bytes(value, order), head.begin() + static_cast<std::ptrdiff_t>(at));
}

std::string head_of(std::string_view content) {
    return is_gzip(content) ? inflated(content, kHead2, true) : std::string(content.substr(0, kHead2));
}

bool is_single_file(std::string_view head) { return head.substr(4).starts_with("n+2"); }

std::endian order_of(std::string_view head) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        if (head.size() >= kHead2 && get<std::int32_t>(head, 0, order) == kHead2) {
            return order;
        }
    }
    throw head.size() < kHead2 ? truncated("its head does not end") : damaged("its head does not have its own size");
}

/// How many bytes of values there are. Writes the sizes into the new head.
std::uint64_t convert_sizes(std::string_view head, std::endian order, std::string& new_head) {
    const auto dimensions = get<std::int64_t>(head, kDim2, order);
    double bits = get<std::int16_t>(head, 14, order);
    bool is_size = bits > 0.0 && dimensions >= 1 && dimensions <= 7;
    put(new_head, kDim1, static_cast<std::int16_t>(is_size ? dimensions : 0), order);
    for (std::int64_t d = 1; is_size && d <= dimensions; ++d) {
        const auto size = get<std::int64_t>(head, kDim2 + 8 * static_cast<std::size_t>(d), order);
        is_size = size >= 0 && size <= std::numeric_limits<std::int16_t>::max();
        put(new_head, kDim1 + 2 * static_cast<std::size_t>(d), static_cast<std::int16_t>(is_size ? size : 0), order);
        bits *= static_cast<double>(std::max<std::int64_t>(size, 1));
    }
    if (!(is_size && bits < 0x1p43)) {
        throw damaged("its head says a size that cannot be read: up to 32767 voxels along each side can");
    }
    return static_cast<std::uint64_t>(bits / 8.0);
}

}  // namespace

bool is_nifti2(std::string_view content) {
    constexpr std::size_t kMagic = 4;
    const std::string head = head_of(content);
    const std::string_view magic = std::string_view(head).substr(std::min(head.size(), kMagic));
    return magic.starts_with("n+2") || magic.starts_with("ni2");
}

std::string nifti1_of(std::string_view content, const std::optional<std::filesystem::path>& data_file) {
    const std::string head = head_of(content);
    const std::endian order = order_of(head);
    std::string result(kData1, '\0');
    put(result, 0, static_cast<std::int32_t>(kHead1), order);
    put(result, 70, get<std::int16_t>(head, 12, order), order);  // type of the values
    put(result, 72, get<std::int16_t>(head, 14, order), order);  // their bits
    for (const Place& place : kIntegers) {
        put(result, place.in1, static_cast<std::int16_t>(get<std::int32_t>(head, place.in2, order)), order);
    }
    for (const Place& place : kNumbers) {
        for (std::size_t i = 0; i < place.count; ++i) {
            const auto number = static_cast<float>(get<double>(head, place.in2 + 8 * i, order));
            put(result, place.in1 + 4 * i, number, order);
        }
    }
    result[123] = static_cast<char>(get<std::int32_t>(head, 500, order));  // units
    put(result, kOffset1, static_cast<float>(kData1), order);
    result.replace(344, 3, "n+1");

    const std::uint64_t size = convert_sizes(head, order, result);
    const auto offset = get<std::int64_t>(head, kOffset2, order);
    constexpr std::int64_t kMostOffset = std::numeric_limits<Index>::max();
    if (offset < 0 || offset > kMostOffset || (is_single_file(head) && offset < static_cast<std::int64_t>(kHead2))) {
        throw damaged("its head says that the data begin at a place where they cannot be");
    }
    if (!is_single_file(head) && !data_file) {
        throw unsupported("its data are in a file of their own: this is only read from a file beside it");
    }
    std::string other;
    if (!is_single_file(head)) {
        size_of_data(*data_file);  // says which file is missing
        other = read_file(*data_file);
        content = other;
    }
    const std::uint64_t end = static_cast<std::uint64_t>(offset) + size;
    std::string unpacked;
    if (is_gzip(content)) {
        unpacked = inflated(content, end);
        content = unpacked;
    }
    check_bytes(end, content.size());
    return result.append(content.substr(static_cast<std::size_t>(offset), size));
}

}  // namespace scaleaxis::io
