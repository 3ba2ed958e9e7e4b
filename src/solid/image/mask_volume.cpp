// SPDX-License-Identifier: Apache-2.0
#include "solid/image/mask_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "solid/zero_set/trilinear.hpp"

namespace scaleaxis::inline v1 {
namespace {

// The levels of smoothed masks are nearer to 0.5 than that; others take another look, twice as far.
constexpr float kFirstReach = 0x1p-4;
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

/// The voxels in which the interpolant may have values of a range, and how many have greater ones throughout.
struct Crossing {
    std::vector<std::array<Index, 3>> voxels;
    std::int64_t above = 0;
};

/// In a voxel the interpolant lies between the values of its 27 neighbours, itself included.
Crossing crossing_of(const ImageView& image, float lower, float upper) {
    const Neighbours neighbours(image);
    const auto& [width, height, depth] = image.sizes;
    using Range = std::ranges::min_max_result<float>;
    const auto rows = mapped<Range>(static_cast<std::size_t>(height) * depth, [&, height = height](std::size_t r) {
        return std::ranges::minmax(neighbours.row(static_cast<Index>(r % height), static_cast<Index>(r / height)));
    });
    std::vector<std::int64_t> above(depth);
    Crossing result;
    result.voxels = collect<std::vector<std::array<Index, 3>>>(
        depth,
        [&, width = width, height = height, depth = depth](Index k, std::vector<std::array<Index, 3>>& out) {
            std::vector<float> least(width);  // of nine voxels in the plane across rows
            std::vector<float> most(width);
            for (Index j = 0; j < height; ++j) {
                std::array<std::size_t, 9> around{};
                for (Index n = 0; n < 9; ++n) {
                    around[n] = static_cast<std::size_t>(std::clamp<Index>(k + n / 3 - 1, 0, depth - 1)) * height +
                                std::clamp<Index>(j + n % 3 - 1, 0, height - 1);
                }
                Range all = rows[around[0]];
                for (const std::size_t row : around) {
                    all = {std::min(all.min, rows[row].min), std::max(all.max, rows[row].max)};
                }
                if (all.min > upper || all.max < lower) {
                    above[k] += all.min > upper ? width : 0;
                    continue;
                }
                const std::span<const float> row = neighbours.row(j, k);
                least.assign(row.begin(), row.end());
                most = least;
                for (const std::size_t other : around) {
                    const float* values = image.values.data() + other * width;
                    for (Index i = 0; i < width; ++i) {
                        least[i] = std::min(least[i], values[i]);
                        most[i] = std::max(most[i], values[i]);
                    }
                }
                for (Index i = 0; i < width; ++i) {
                    const Index before = std::max<Index>(i - 1, 0);
                    const Index after = std::min<Index>(i + 1, width - 1);
                    if (std::min({least[before], least[i], least[after]}) > upper) {
                        ++above[k];
                    } else if (std::max({most[before], most[i], most[after]}) >= lower) {
                        out.push_back({i, j, k});
                    }
                }
            }
        },
        Index{1});
    result.above = std::reduce(above.begin(), above.end());
    return result;
}

/// Values of the interpolant at so many points of each voxel, spread evenly, that the volume above any of them is
/// known.
struct PointValues {
    std::vector<float> values;
    std::int64_t in_voxel = 1;
};

/// \param volume about that of the solid, in voxels
PointValues point_values(const ImageView& image, const Crossing& crossing, double volume) {
    const Neighbours neighbours(image);
    const double error = 2.0 * kVolumeError * std::max(1.0, volume);
    const double wanted = static_cast<double>(crossing.voxels.size()) / (error * error);
    PointValues result;
    result.in_voxel = static_cast<std::int64_t>(std::ceil(std::clamp<double>(wanted, 1.0, kMostInVoxel)));
    const std::int64_t points = result.in_voxel;
    result.values = mapped<float>(crossing.voxels.size() * points, [&](std::size_t n) {
        const auto& [i, j, k] = crossing.voxels[n / points];
        return neighbours.at(i, j, k, even_point(n));
    });
    return result;
}

}  // namespace

double volume_above(const ImageView& image, float level, double volume) {
    const Crossing crossing = crossing_of(image, level, level);
    const auto [values, in_voxel] = point_values(image, crossing, volume);
    const auto above = std::ranges::count_if(values, [&](float value) { return value > level; });
    return static_cast<double>(crossing.above) + static_cast<double>(above) / static_cast<double>(in_voxel);
}

float level_with_volume(const ImageView& image, double volume) {
    for (float reach = kFirstReach;; reach *= 2.0F) {
        const float lower = 0.5F - reach;
        const float upper = 0.5F + reach;
        const Crossing crossing = crossing_of(image, lower, upper);
        auto [values, in_voxel] = point_values(image, crossing, volume);
        const auto points =
            std::llround((volume - static_cast<double>(crossing.above)) * static_cast<double>(in_voxel));
        const auto count = std::ssize(values);
        // The level lies between the last point above it and the first one below.
        const std::int64_t rank = std::clamp<std::int64_t>(points, 0, count);
        const auto below = values.begin() + rank;
        std::ranges::nth_element(values, below, std::greater());
        const float last = rank > 0 ? *std::min_element(values.begin(), below) : upper;
        const float next = rank < count ? *below : lower;
        if (reach >= 0.5F || (rank == points && last >= lower && next <= upper)) {
            return (std::min(last, upper) + std::max(next, lower)) / 2.0F;
        }
    }
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
