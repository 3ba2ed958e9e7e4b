// SPDX-License-Identifier: Apache-2.0
#include "solid/image/mask_volume.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>

#include "base/parallel.hpp"
#include "solid/zero_set/trilinear.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr int kValueClasses = 1 << 14;  // a boundary moves by 1e-4 of a voxel from one to the next
// The volume is known to this part of itself, a tenth of what masks keep of it. Whether a point of a voxel is inside is
// random by 1/2 at most, so n points in each of m voxels tell their volume to √(m/n)/2 voxels.
constexpr double kVolumeError = 0.002;
constexpr std::int64_t kMostInVoxel = 1000;             // then a mask of one voxel has its volume to 1 %
constexpr double kStepDeviation = 0.28867513459481287;  // 1 / √12: of a number that is uniform in an interval of 1

/// Point `n` of a sequence that fills the unit cube evenly: multiples of 1/g, 1/g², 1/g³ with g⁴ = g + 1 (M. Roberts,
/// "The unreasonable effectiveness of quasirandom sequences", 2018), as fractions of 2^64, which wrap around.
Point even_point(std::uint64_t n) {
    const auto fraction = [&](std::uint64_t step) { return static_cast<double>(n * step >> 11) * 0x1p-53; };
    return {fraction(0xd1b54a32d192ed03), fraction(0xabc98388fb8fac03), fraction(0x8cb92ba72f3d8dd7)};
}

/// The rows of an image through the neighbours of a voxel.
class Neighbours {
   public:
    explicit Neighbours(const ImageView& image) : image_(image) {}

    float value(Index i, Index j, Index k) const {
        const auto& [width, height, depth] = image_.sizes;
        const auto in = [](Index at, Index size) {
            return static_cast<std::size_t>(std::clamp<Index>(at, 0, size - 1));
        };
        return image_.values[(in(k, depth) * height + in(j, height)) * width + in(i, width)];
    }

    std::span<const float> row(Index j, Index k) const {
        const auto& [width, height, depth] = image_.sizes;
        const std::size_t row =
            static_cast<std::size_t>(std::clamp<Index>(k, 0, depth - 1)) * height + std::clamp<Index>(j, 0, height - 1);
        return image_.values.subspan(row * width, width);
    }

    /// The interpolant at a point of the voxel, which is a unit cube.
    double at(Index i, Index j, Index k, const Point& p) const {
        const Index di = p.x < 0.5 ? -1 : 0;
        const Index dj = p.y < 0.5 ? -1 : 0;
        const Index dk = p.z < 0.5 ? -1 : 0;
        std::array<float, 8> corners{};
        for (int c = 0; c < 8; ++c) {
            corners[c] = value(i + di + (c & 1), j + dj + (c >> 1 & 1), k + dk + (c >> 2));
        }
        return interpolated(corners, {p.x - 0.5 - di, p.y - 0.5 - dj, p.z - 0.5 - dk});
    }

   private:
    const ImageView& image_;
};

std::size_t class_of(double value) {
    return static_cast<std::size_t>(std::clamp(value, 0.0, 1.0) * (kValueClasses - 1) + 0.5);
}

}  // namespace

ValueVolumes::ValueVolumes(const ImageView& image, double volume) {
    const Neighbours neighbours(image);
    const auto& [width, height, depth] = image.sizes;
    std::vector<std::uint8_t> is_even(static_cast<std::size_t>(height) * depth);  // of rows: all values are the same
    for_each_index(is_even.size(), [&, height = height](std::size_t r) {
        const auto row = neighbours.row(static_cast<Index>(r % height), static_cast<Index>(r / height));
        is_even[r] = std::ranges::all_of(row, [&](float value) { return value == row[0]; }) ? 1 : 0;
    });
    std::vector<std::int64_t> in_bulk(depth);
    const auto mixed = collect<std::vector<std::array<Index, 3>>>(
        depth,
        [&, width = width, height = height, depth = depth](Index k, std::vector<std::array<Index, 3>>& out) {
            std::vector<std::uint8_t> is_column_even(width);  // of the nine voxels around one in the plane across rows
            for (Index j = 0; j < height; ++j) {
                std::array<std::span<const float>, 9> rows;
                bool are_even = true;
                for (Index n = 0; n < 9; ++n) {
                    const Index other_j = std::clamp<Index>(j + n % 3 - 1, 0, height - 1);
                    const Index other_k = std::clamp<Index>(k + n / 3 - 1, 0, depth - 1);
                    rows[n] = neighbours.row(other_j, other_k);
                    are_even = are_even && is_even[static_cast<std::size_t>(other_k) * height + other_j] != 0 &&
                               rows[n][0] == rows[0][0];
                }
                const std::span<const float> row = neighbours.row(j, k);
                if (are_even) {
                    in_bulk[k] += row[0] > 0.5F ? width : 0;
                    continue;
                }
                for (Index i = 0; i < width; ++i) {
                    is_column_even[i] =
                        std::ranges::all_of(rows, [&](std::span<const float> other) { return other[i] == row[i]; });
                }
                for (Index i = 0; i < width; ++i) {
                    const Index before = std::max<Index>(i - 1, 0);
                    const Index after = std::min<Index>(i + 1, width - 1);
                    if (is_column_even[before] == 0 || is_column_even[i] == 0 || is_column_even[after] == 0 ||
                        row[before] != row[i] || row[after] != row[i]) {
                        out.push_back({i, j, k});
                    } else if (row[i] > 0.5F) {
                        ++in_bulk[k];
                    }
                }
            }
        },
        Index{1});
    const double error = 2.0 * kVolumeError * std::max(1.0, volume);
    const double wanted = static_cast<double>(mixed.size()) / (error * error);
    points_in_voxel_ = static_cast<std::int64_t>(std::ceil(std::clamp<double>(wanted, 1.0, kMostInVoxel)));
    std::vector<std::atomic<std::int64_t>> counts(kValueClasses);  // sums of integers are the same in any order
    counts.back() = points_in_voxel_ * std::reduce(in_bulk.begin(), in_bulk.end());
    for_each_index(mixed.size(), [&](std::size_t m) {
        const auto& [i, j, k] = mixed[m];
        for (std::int64_t n = 0; n < points_in_voxel_; ++n) {
            const Point p = even_point(m * points_in_voxel_ + n);
            counts[class_of(neighbours.at(i, j, k, p))].fetch_add(1, std::memory_order_relaxed);
        }
    });
    classes_.assign(counts.begin(), counts.end());
}

double ValueVolumes::above(float level) const {
    const auto points = std::reduce(classes_.begin() + static_cast<std::ptrdiff_t>(class_of(level)), classes_.end());
    return static_cast<double>(points) / static_cast<double>(points_in_voxel_);
}

float ValueVolumes::level_of(double volume) const {
    auto points = static_cast<std::int64_t>(volume * static_cast<double>(points_in_voxel_));
    std::size_t upper = kValueClasses - 1;
    while (upper > 0 && points > classes_[upper]) {
        points -= classes_[upper--];
    }
    // Amid a range of values that no point has, as those between 0 and 1 where the solid fills the image.
    std::size_t lower = points < classes_[upper] ? upper : std::max<std::size_t>(upper, 1) - 1;
    while (lower > 0 && classes_[lower] == 0) {
        --lower;
    }
    return static_cast<float>(upper + lower) / (2 * (kValueClasses - 1));
}

double volume_uncertainty(const ImageView& mask) {
    const Neighbours neighbours(mask);
    const auto& [width, height, depth] = mask.sizes;
    std::int64_t sides = 0;
    for (Index k = 0; k < depth; ++k) {
        for (Index j = 0; j < height; ++j) {
            for (Index i = 0; i < width; ++i) {
                const float value = neighbours.value(i, j, k);
                sides += (neighbours.value(i + 1, j, k) != value) + (neighbours.value(i, j + 1, k) != value) +
                         (neighbours.value(i, j, k + 1) != value);
            }
        }
    }
    return 2.0 * kStepDeviation * std::sqrt(static_cast<double>(sides));
}

}  // namespace scaleaxis::inline v1
