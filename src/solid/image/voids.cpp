// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// The voxels of an image that are not above a level, space by space.
class Outside {
   public:
    Outside(const Image& image, float iso) : image_(image), is_left_(image.values.size()) {
        std::transform(image.values.begin(), image.values.end(), is_left_.begin(),
                       [=](float value) { return !(value > iso); });
    }

    /// Takes away the space that a voxel is in. \return the number of its voxels
    std::int64_t take(std::size_t voxel) {
        const auto& [width, height, depth] = image_.sizes;
        const std::size_t row = width;
        const std::size_t slice = row * height;
        std::int64_t count = 0;
        push(voxel);
        while (!stack_.empty()) {
            cancellation_();
            const std::size_t at = stack_.back();
            stack_.pop_back();
            ++count;
            const auto i = static_cast<Index>(at % row);
            const auto j = static_cast<Index>(at % slice / row);
            const auto k = static_cast<Index>(at / slice);
            const auto visit = [&](bool is_there, std::size_t next) {
                if (is_there) {
                    push(next);
                }
            };
            visit(i > 0, at - 1);
            visit(i + 1 < width, at + 1);
            visit(j > 0, at - row);
            visit(j + 1 < height, at + row);
            visit(k > 0, at - slice);
            visit(k + 1 < depth, at + slice);
        }
        return count;
    }

    bool is_left(std::size_t voxel) const { return is_left_[voxel]; }

   private:
    void push(std::size_t voxel) {
        if (is_left_[voxel]) {
            is_left_[voxel] = false;
            stack_.push_back(voxel);
        }
    }

    const Image& image_;
    std::vector<bool> is_left_;
    std::vector<std::size_t> stack_;
    CancellationPoint cancellation_{1 << 20};
};

bool is_at_border(const std::array<Index, 3>& sizes, std::size_t voxel) {
    const std::array<Index, 3> at{static_cast<Index>(voxel % sizes[0]), static_cast<Index>(voxel / sizes[0] % sizes[1]),
                                  static_cast<Index>(voxel / sizes[0] / sizes[1])};
    for (int axis = 0; axis < 3; ++axis) {
        if (at[axis] == 0 || at[axis] + 1 == sizes[axis]) {
            return true;
        }
    }
    return false;
}

}  // namespace

FilledImage without_voids(Image image, double iso, const Execution& execution) {
    return in_arena(execution, [&] {
        check(image, execution);
        const auto level = static_cast<float>(iso);
        FilledImage result{std::move(image)};
        std::vector<float>& values = result.image.values;
        Outside outside(result.image, level);
        for (std::size_t voxel = 0; voxel < values.size(); ++voxel) {
            if (outside.is_left(voxel) && is_at_border(result.image.sizes, voxel)) {
                outside.take(voxel);
                ++result.open;
            }
        }
        result.open = std::max<Index>(0, result.open - 1);
        for (std::size_t voxel = 0; voxel < values.size(); ++voxel) {
            if (outside.is_left(voxel)) {
                values[voxel] = 2.0F * level - values[voxel];
                ++result.filled;
            }
        }
        return result;
    });
}

}  // namespace scaleaxis::inline v1
