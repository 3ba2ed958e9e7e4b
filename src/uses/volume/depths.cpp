// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "base/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/volume.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::int32_t kNoneOutside = std::numeric_limits<std::int32_t>::max();

std::size_t number_of_voxels(const std::array<Index, 3>& sizes) {
    return static_cast<std::size_t>(sizes[0]) * sizes[1] * sizes[2];
}

/// The lower envelope of the parabolas `(x - i)² + f(i)` (Felzenszwalb and Huttenlocher, "Distance transforms of
/// sampled functions", 2012), in whole numbers.
class Parabolas {
   public:
    explicit Parabolas(std::size_t size) : values_(size), tops_(size), begins_(size + 1) {}

    /// Replaces `size` values, `stride` apart.
    void transform(std::int32_t* at, Index size, std::ptrdiff_t stride) {
        Index count = 0;
        for (Index i = 0; i < size; ++i) {
            values_[i] = at[i * stride];
            if (values_[i] == kNoneOutside) {
                continue;
            }
            while (count > 0 && meeting(tops_[count - 1], i) <= begins_[count - 1]) {
                --count;
            }
            begins_[count] = count == 0 ? 0 : meeting(tops_[count - 1], i);
            if (begins_[count] < size) {
                tops_[count++] = i;
            }
        }
        if (count == 0) {
            return;
        }
        begins_[count] = size;
        for (Index k = 0; k < count; ++k) {
            for (std::int64_t x = begins_[k]; x < begins_[k + 1]; ++x) {
                const std::int64_t away = x - tops_[k];
                at[x * stride] = static_cast<std::int32_t>(away * away + values_[tops_[k]]);
            }
        }
    }

   private:
    /// The first place, at 0 or after, where the parabola of `j` is below that of `i` < `j`.
    std::int64_t meeting(Index i, Index j) const {
        const std::int64_t above = values_[j] + std::int64_t{j} * j - values_[i] - std::int64_t{i} * i;
        return above < 0 ? 0 : above / (2 * std::int64_t{j - i}) + 1;
    }

    std::vector<std::int32_t> values_;
    std::vector<Index> tops_;
    std::vector<std::int64_t> begins_;
};

}  // namespace

std::vector<std::int32_t> squared_depths(const std::array<Index, 3>& sizes, std::span<const std::uint8_t> mask,
                                         const Execution& execution) {
    if (mask.size() != number_of_voxels(sizes)) {
        throw InvalidOption("a mask needs as many values as its sizes say");
    }
    return in_arena(execution, [&] {
        std::vector<std::int32_t> depths(mask.size());
        for_each_index(mask.size(), [&](std::size_t i) { depths[i] = mask[i] != 0 ? kNoneOutside : 0; });
        const std::ptrdiff_t width = sizes[0];
        const std::ptrdiff_t plane = width * sizes[1];
        const auto along = [&](Index size, std::ptrdiff_t stride, Index planes, Index lines, std::ptrdiff_t of_plane,
                               std::ptrdiff_t of_line) {
            for_each_index(
                planes,
                [&](Index p) {
                    Parabolas parabolas(size);
                    for (Index line = 0; line < lines; ++line) {
                        parabolas.transform(depths.data() + p * of_plane + line * of_line, size, stride);
                    }
                },
                Index{1});
        };
        along(sizes[0], 1, sizes[2], sizes[1], plane, width);
        along(sizes[1], width, sizes[2], sizes[0], plane, 1);
        along(sizes[2], plane, sizes[1], sizes[0], width, 1);
        return depths;
    });
}

std::vector<float> thickness_of_block(const VolumeBlock& block, std::span<const std::uint8_t> mask,
                                      const Execution& execution) {
    return in_arena(execution, [&] {
        const std::vector<std::int32_t> depths = squared_depths(block.sizes, mask, execution);
        std::array<Index, 3> low{};
        std::array<Index, 3> high{};
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = static_cast<Index>(block.core_low[axis] - block.origin[axis]);
            high[axis] = static_cast<Index>(block.core_high[axis] - block.origin[axis]);
        }
        const std::ptrdiff_t width = block.sizes[0];
        const std::ptrdiff_t plane = width * block.sizes[1];
        const auto at = [&](Index i, Index j, Index k) { return depths[k * plane + j * width + i]; };
        struct Center {
            Index i, j;
            std::int32_t depth;
        };
        // Centres whose ball no neighbour's contains, in each plane, of those that reach the core.
        std::vector<std::vector<Center>> centers(block.sizes[2]);
        for_each_index(
            block.sizes[2],
            [&](Index k) {
                const auto distance_to = [](Index x, Index begin, Index end) {
                    return std::max({begin - x, x - (end - 1), Index{0}});
                };
                const auto is_contained = [&](Index i, Index j, double radius) {
                    for (Index n = 0; n < 27; ++n) {
                        const Index x = i + n % 3 - 1;
                        const Index y = j + n / 3 % 3 - 1;
                        const Index z = k + n / 9 - 1;
                        if (n != 13 && x >= 0 && y >= 0 && z >= 0 && x < block.sizes[0] && y < block.sizes[1] &&
                            z < block.sizes[2]) {
                            const double step = std::sqrt((x - i) * (x - i) + (y - j) * (y - j) + (z - k) * (z - k));
                            if (radius + step <= std::sqrt(at(x, y, z))) {
                                return true;
                            }
                        }
                    }
                    return false;
                };
                const std::int64_t dz = distance_to(k, low[2], high[2]);
                for (Index j = 0; j < block.sizes[1]; ++j) {
                    const std::int64_t dy = distance_to(j, low[1], high[1]);
                    for (Index i = 0; i < block.sizes[0]; ++i) {
                        const std::int32_t depth = at(i, j, k);
                        const std::int64_t dx = distance_to(i, low[0], high[0]);
                        if (depth > dx * dx + dy * dy + dz * dz && depth != kNoneOutside &&
                            !is_contained(i, j, std::sqrt(depth))) {
                            centers[k].push_back({i, j, depth});
                        }
                    }
                }
                // Planes farther off see none after the first that is too small for them.
                std::ranges::stable_sort(centers[k], std::greater<>(), &Center::depth);
            },
            Index{1});
        const std::array<Index, 3> sizes{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
        std::vector<std::int32_t> largest(number_of_voxels(sizes));
        for_each_index(
            sizes[2],
            [&](Index z) {
                std::int32_t* out = largest.data() + static_cast<std::ptrdiff_t>(z) * sizes[1] * sizes[0];
                for (Index k = 0; k < block.sizes[2]; ++k) {
                    const std::int64_t dz = k - (z + low[2]);
                    for (const auto& [i, j, depth] : centers[k]) {
                        const std::int64_t in_plane = depth - dz * dz;
                        if (in_plane <= 0) {
                            break;
                        }
                        const auto reach = static_cast<Index>(std::sqrt(static_cast<double>(in_plane)));
                        for (Index y = std::max(j - reach, low[1]); y <= std::min(j + reach, high[1] - 1); ++y) {
                            const std::int64_t in_row = in_plane - std::int64_t{y - j} * (y - j);
                            if (in_row <= 0) {
                                continue;
                            }
                            auto half = static_cast<Index>(std::sqrt(static_cast<double>(in_row)));
                            half -= std::int64_t{half} * half >= in_row ? 1 : 0;
                            std::int32_t* row = out + static_cast<std::ptrdiff_t>(y - low[1]) * sizes[0];
                            const Index end = std::min(i + half, high[0] - 1) - low[0];
                            for (Index x = std::max(i - half, low[0]) - low[0]; x <= end; ++x) {
                                row[x] = std::max(row[x], depth);
                            }
                        }
                    }
                }
            },
            Index{1});
        std::vector<float> result(largest.size());
        for_each_index(result.size(),
                       [&](std::size_t i) { result[i] = 2.0F * std::sqrt(static_cast<float>(largest[i])); });
        return result;
    });
}

}  // namespace scaleaxis::inline v1
