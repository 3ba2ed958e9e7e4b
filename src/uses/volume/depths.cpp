// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "base/faults.hpp"
#include "base/parallel.hpp"
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
        for (Index i = 0; i < size; ++i) {
            values_[i] = at[i * stride];
        }
        Index count = 0;
        for (Index i = 0; i < size; ++i) {
            // Of zeros in a row the first and the last are nearest to all others.
            const bool is_between_zeros = i > 0 && i + 1 < size && (values_[i - 1] | values_[i] | values_[i + 1]) == 0;
            if (values_[i] == kNoneOutside || is_between_zeros) {
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
                if (values_[x] != 0) {
                    const std::int64_t away = x - tops_[k];
                    at[x * stride] = static_cast<std::int32_t>(away * away + values_[tops_[k]]);
                }
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

/// As many lines side by side, which the compiler's vector operations take together: a line of the cache.
constexpr Index kLines = 16;

/// Where the solid is deeper, parabolas, whose time does not depend on the depth. An estimate of where both are equal.
constexpr Index kMostSteps = 16;

constexpr std::int32_t kOutOfReach = 1 << 30;  // more than any squared distance in an array, and small enough to add to

/// Beside each other; looks at all places that are near enough to matter, one after the other.
class NearLines {
   public:
    explicit NearLines(std::size_t size) : values_(size) {}

    /// False, and nothing is changed, if a place is too far from the nearest zero.
    bool transform(std::int32_t* at, Index size, std::ptrdiff_t stride) {
        for (Index i = 0; i < size; ++i) {
            for (Index n = 0; n < kLines; ++n) {
                values_[i][n] = std::min(at[i * stride + n], kOutOfReach);
            }
        }
        for (Index i = 0; i < size; ++i) {
            Lines least = values_[i];
            Index step = 1;
            while (step * step < most(least)) {
                if (step > kMostSteps) {
                    restore(at, i, stride);
                    return false;
                }
                if (i >= step) {
                    take(least, values_[i - step], step * step);
                }
                if (i + step < size) {
                    take(least, values_[i + step], step * step);
                }
                ++step;
            }
            std::ranges::copy(least, at + i * stride);
        }
        return true;
    }

   private:
    using Lines = std::array<std::int32_t, kLines>;

    static void take(Lines& least, const Lines& other, std::int32_t away) {
        for (Index n = 0; n < kLines; ++n) {
            least[n] = std::min(least[n], other[n] + away);
        }
    }

    static std::int32_t most(const Lines& lines) {
        std::int32_t result = 0;
        for (const std::int32_t value : lines) {
            result = std::max(result, value);
        }
        return result;
    }

    void restore(std::int32_t* at, Index size, std::ptrdiff_t stride) const {
        for (Index i = 0; i < size; ++i) {
            for (Index n = 0; n < kLines; ++n) {
                at[i * stride + n] = values_[i][n] == kOutOfReach ? kNoneOutside : values_[i][n];
            }
        }
    }

    std::vector<Lines> values_;
};

/// Squared distance of each voxel of a row to the nearest 0 in it.
void transform_row(const std::uint8_t* mask, std::int32_t* at, Index size) {
    std::int32_t away = kNoneOutside;
    for (Index i = 0; i < size; ++i) {
        away = mask[i] == 0 ? 0 : away == kNoneOutside ? away : away + 1;
        at[i] = away;
    }
    away = kNoneOutside;
    for (Index i = size - 1; i >= 0; --i) {
        away = at[i] == 0 ? 0 : away == kNoneOutside ? away : away + 1;
        const std::int32_t least = std::min(at[i], away);
        at[i] = least == kNoneOutside ? least : least * least;
    }
}

}  // namespace

std::vector<std::int32_t> squared_depths(const std::array<Index, 3>& sizes, std::span<const std::uint8_t> mask,
                                         const Execution& execution) {
    require(mask.size() == number_of_voxels(sizes), "a mask needs as many values as its sizes say");
    return in_arena(execution, [&] {
        std::vector<std::int32_t> depths(mask.size());
        const std::ptrdiff_t width = sizes[0];
        const std::ptrdiff_t plane = width * sizes[1];
        const auto along = [&](Index size, std::ptrdiff_t stride, Index planes, std::ptrdiff_t of_plane) {
            for_each_index(
                planes,
                [&](Index p) {
                    Parabolas parabolas(size);
                    NearLines near(size);
                    for (Index line = 0; line < sizes[0];) {
                        std::int32_t* at = depths.data() + p * of_plane + line;
                        const Index end = std::min(line + kLines, sizes[0]);
                        if (end - line == kLines && near.transform(at, size, stride)) {
                            line = end;
                            continue;
                        }
                        for (; line < end; ++line) {
                            parabolas.transform(at++, size, stride);
                        }
                    }
                },
                Index{1});
        };
        for_each_index(
            sizes[2],
            [&](Index k) {
                for (std::ptrdiff_t row = k * plane; row < (k + 1) * plane; row += width) {
                    transform_row(mask.data() + row, depths.data() + row, sizes[0]);
                }
            },
            Index{1});
        along(sizes[1], width, sizes[2], plane);
        along(sizes[2], plane, sizes[1], width);
        return depths;
    });
}

}  // namespace scaleaxis::inline v1
