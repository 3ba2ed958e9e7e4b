// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "scaleaxis/volume.hpp"

// Of the balls around all voxels, those that another one contains paint nothing. The others are sorted into tiles of
// the array. A tile of the core takes those that reach it, the largest first, so that each voxel is written once, and
// stops as soon as all are. What is left to write is a bit a voxel, so that a row of a ball takes one operation.

namespace scaleaxis::inline v1 {
namespace {

// Voxels of a tile: a word along x. Half as much along y and z takes as long: more balls are met twice.
constexpr std::array<Index, 3> kTile{64, 32, 32};

constexpr std::int32_t kUnboundedDepth = std::numeric_limits<std::int32_t>::max();

using Place = std::array<Index, 3>;

struct VoxelBall {
    std::int32_t depth = 0;  // squared: the voxels nearer than this are in it
    Place center{};
};

std::int64_t squared(Index x) { return std::int64_t{x} * x; }

/// The largest whole numbers whose squares are at most 0, 1, 2, …
std::vector<std::uint16_t> square_roots(std::int32_t count) {
    std::vector<std::uint16_t> roots(count);
    Index root = 0;
    for (std::int32_t i = 0; i < count; ++i) {
        root += squared(root + 1) <= i ? 1 : 0;
        roots[i] = static_cast<std::uint16_t>(root);
    }
    return roots;
}

/// For each depth, how deep a neighbour has to be to contain its ball: neighbours that share a face, an edge, a corner
/// (E. Remy, E. Thiel, "Medial axis for chamfer distances: computing look-up tables and neighbourhoods in 2D or 3D",
/// 2002, of which this is the Euclidean case).
using ContainingDepths = std::array<std::vector<std::int32_t>, 3>;

ContainingDepths containing_depths(std::int32_t largest) {
    ContainingDepths depths;
    for (std::vector<std::int32_t>& of_class : depths) {
        of_class.assign(static_cast<std::size_t>(largest) + 1, 0);
    }
    // The voxel of a ball that is farthest from a neighbour of its centre lies on the opposite side.
    for (std::int64_t a = 0; a * a < largest; ++a) {
        for (std::int64_t b = 0; b <= a && a * a + b * b < largest; ++b) {
            for (std::int64_t c = 0; c <= b && a * a + b * b + c * c < largest; ++c) {
                const std::int64_t from_center = a * a + b * b + c * c;
                const std::array<std::int64_t, 3> steps{a, a + b, a + b + c};
                for (int n = 0; n < 3; ++n) {
                    std::int32_t& least = depths[n][from_center + 1];
                    least = std::max(least, static_cast<std::int32_t>(from_center + 2 * steps[n] + n + 2));
                }
            }
        }
    }
    for (std::vector<std::int32_t>& of_class : depths) {
        for (std::size_t depth = 1; depth < of_class.size(); ++depth) {
            of_class[depth] = std::max(of_class[depth], of_class[depth - 1]);
        }
    }
    return depths;
}

/// A box of voxels, the high sides outside.
struct VoxelBox {
    Place low{};
    Place high{};

    std::int64_t squared_distance(const Place& p) const {
        std::int64_t sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            sum += squared(std::max({low[axis] - p[axis], p[axis] - (high[axis] - 1), Index{0}}));
        }
        return sum;
    }
};

/// The tiles that fill a box.
struct Tiles {
    VoxelBox box;
    Place counts{};

    explicit Tiles(const VoxelBox& all) : box(all) {
        for (int axis = 0; axis < 3; ++axis) {
            counts[axis] = (box.high[axis] - box.low[axis] + kTile[axis] - 1) / kTile[axis];
        }
    }
    Index size() const { return counts[0] * counts[1] * counts[2]; }
    Index at(const Place& tile) const { return (tile[2] * counts[1] + tile[1]) * counts[0] + tile[0]; }
    VoxelBox operator[](Index tile) const {
        const Place place{tile % counts[0], tile / counts[0] % counts[1], tile / counts[0] / counts[1]};
        VoxelBox result;
        for (int axis = 0; axis < 3; ++axis) {
            result.low[axis] = box.low[axis] + place[axis] * kTile[axis];
            result.high[axis] = std::min(result.low[axis] + kTile[axis], box.high[axis]);
        }
        return result;
    }
    /// The tile of a voxel, or the nearest one.
    Index along(int axis, Index x) const {
        return std::clamp((x - box.low[axis]) / kTile[axis], Index{0}, counts[axis] - 1);
    }
};

class BallPainting {
   public:
    BallPainting(const VolumeBlock& block, std::span<const std::int32_t> depths)
        : sizes_(block.sizes), depths_(depths), array_({{}, block.sizes}), balls_(array_.size()) {
        for (int axis = 0; axis < 3; ++axis) {
            core_.low[axis] = static_cast<Index>(block.core_low[axis] - block.origin[axis]);
            core_.high[axis] = static_cast<Index>(block.core_high[axis] - block.origin[axis]);
        }
        for (Index n = 0; n < 27; ++n) {
            const Place step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
            const Index steps = std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]);
            neighbors_.push_back({step, steps, (std::ptrdiff_t{step[2]} * sizes_[1] + step[1]) * sizes_[0] + step[0]});
        }
        std::ranges::stable_sort(neighbors_, {}, &Neighbor::steps);
        neighbors_.erase(neighbors_.begin());  // itself
        largest_ = depths.empty() ? 0 : *std::ranges::max_element(depths);
    }

    std::vector<float> diameters() {
        std::vector<float> result(static_cast<std::size_t>(core_.high[0] - core_.low[0]) *
                                  (core_.high[1] - core_.low[1]) * (core_.high[2] - core_.low[2]));
        if (largest_ == 0 || largest_ == kUnboundedDepth) {
            return result;
        }
        roots_ = square_roots(largest_);
        const ContainingDepths containing = containing_depths(largest_);
        for_each_index(
            array_.size(), [&](Index tile) { balls_[tile] = balls_of(array_[tile], containing); }, Index{1});
        const Tiles core(core_);
        for_each_index(
            core.size(), [&](Index tile) { paint(core[tile], result); }, Index{1});
        return result;
    }

   private:
    std::size_t place(Index i, Index j, Index k) const {
        return (static_cast<std::size_t>(k) * sizes_[1] + j) * sizes_[0] + i;
    }

    bool is_contained(const Place& p, std::int32_t depth, const ContainingDepths& containing) const {
        const std::size_t here = place(p[0], p[1], p[2]);
        const bool is_at_rim = std::min({p[0], p[1], p[2]}) == 0 || p[0] + 1 == sizes_[0] || p[1] + 1 == sizes_[1] ||
                               p[2] + 1 == sizes_[2];
        return std::ranges::any_of(neighbors_, [&](const Neighbor& neighbor) {
            if (is_at_rim) {
                for (int axis = 0; axis < 3; ++axis) {
                    const Index at = p[axis] + neighbor.step[axis];
                    if (at < 0 || at >= sizes_[axis]) {
                        return false;
                    }
                }
            }
            return depths_[here + neighbor.offset] >= containing[neighbor.steps - 1][depth];
        });
    }

    /// Those that reach the core, and that no neighbour's contains; without those of a single voxel.
    std::vector<VoxelBall> balls_of(const VoxelBox& tile, const ContainingDepths& containing) const {
        std::vector<VoxelBall> balls;
        for (Index k = tile.low[2]; k < tile.high[2]; ++k) {
            for (Index j = tile.low[1]; j < tile.high[1]; ++j) {
                for (Index i = tile.low[0]; i < tile.high[0]; ++i) {
                    const std::int32_t depth = depths_[place(i, j, k)];
                    if (depth > 1 && depth > core_.squared_distance({i, j, k}) &&
                        !is_contained({i, j, k}, depth, containing)) {
                        balls.push_back({depth, {i, j, k}});
                    }
                }
            }
        }
        return balls;
    }

    std::vector<VoxelBall> balls_near(const VoxelBox& tile) const {
        const Index reach = roots_[largest_ - 1];
        std::vector<VoxelBall> balls;
        Place first{};
        Place last{};
        for (int axis = 0; axis < 3; ++axis) {
            first[axis] = array_.along(axis, tile.low[axis] - reach);
            last[axis] = array_.along(axis, tile.high[axis] - 1 + reach);
        }
        for (Index z = first[2]; z <= last[2]; ++z) {
            for (Index y = first[1]; y <= last[1]; ++y) {
                for (Index x = first[0]; x <= last[0]; ++x) {
                    for (const VoxelBall& ball : balls_[array_.at({x, y, z})]) {
                        if (ball.depth > tile.squared_distance(ball.center)) {
                            balls.push_back(ball);
                        }
                    }
                }
            }
        }
        return balls;
    }

    /// Of a tile the voxels inside that are not written yet: a word for each row along x, a bit for each voxel.
    struct Unwritten {
        VoxelBox tile;
        std::array<std::uint64_t, std::size_t{kTile[1]} * kTile[2]> words{};
        std::int64_t count = 0;

        std::uint64_t& row(Index j, Index k) { return words[(k - tile.low[2]) * kTile[1] + j - tile.low[1]]; }
    };

    Unwritten unwritten_of(const VoxelBox& tile) const {
        Unwritten left{tile};
        for (Index k = tile.low[2]; k < tile.high[2]; ++k) {
            for (Index j = tile.low[1]; j < tile.high[1]; ++j) {
                for (Index i = tile.low[0]; i < tile.high[0]; ++i) {
                    const std::uint64_t is_inside = depths_[place(i, j, k)] > 0 ? 1 : 0;
                    left.row(j, k) |= is_inside << (i - tile.low[0]);
                    left.count += static_cast<std::int64_t>(is_inside);
                }
            }
        }
        return left;
    }

    /// Those of a row that are not written yet and lie between two voxels of the tile.
    void write(Unwritten& left, Index begin, Index end, Index j, Index k, float value, std::vector<float>& out) const {
        std::uint64_t& word = left.row(j, k);
        const Index first = left.tile.low[0];
        std::uint64_t written = word & (~std::uint64_t{0} >> (64 - (end - begin)) << (begin - first));
        word ^= written;
        const std::size_t line =
            static_cast<std::size_t>(k - core_.low[2]) * (core_.high[1] - core_.low[1]) + j - core_.low[1];
        float* row = out.data() + line * (core_.high[0] - core_.low[0]) + (first - core_.low[0]);
        for (; written != 0; written &= written - 1, --left.count) {
            row[std::countr_zero(written)] = value;
        }
    }

    void paint_ball(const VoxelBall& ball, Unwritten& left, std::vector<float>& out) const {
        const auto& [low, high] = left.tile;
        const auto& [x, y, z] = ball.center;
        const float diameter = 2.0F * std::sqrt(static_cast<float>(ball.depth));
        const Index reach = roots_[ball.depth - 1];
        for (Index k = std::max(z - reach, low[2]); k < std::min(z + reach + 1, high[2]); ++k) {
            for (Index j = std::max(y - reach, low[1]); j < std::min(y + reach + 1, high[1]); ++j) {
                const std::int64_t in_row = ball.depth - squared(k - z) - squared(j - y);
                if (left.row(j, k) == 0 || in_row <= 0) {
                    continue;
                }
                const Index half = roots_[in_row - 1];
                const Index begin = std::max(x - half, low[0]);
                const Index end = std::min(x + half + 1, high[0]);
                if (begin < end) {
                    write(left, begin, end, j, k, diameter, out);
                }
            }
        }
    }

    void paint(const VoxelBox& tile, std::vector<float>& out) const {
        Unwritten left = unwritten_of(tile);
        if (left.count == 0) {
            return;
        }
        const auto is_smaller = [](const VoxelBall& a, const VoxelBall& b) { return a.depth < b.depth; };
        std::vector<VoxelBall> balls = balls_near(tile);
        std::ranges::make_heap(balls, is_smaller);
        while (left.count > 0 && !balls.empty()) {
            std::ranges::pop_heap(balls, is_smaller);
            paint_ball(balls.back(), left, out);
            balls.pop_back();
        }
        // In the others is no ball but their own, of a single voxel.
        for (Index k = tile.low[2]; left.count > 0 && k < tile.high[2]; ++k) {
            for (Index j = tile.low[1]; j < tile.high[1]; ++j) {
                write(left, tile.low[0], tile.high[0], j, k, 2.0F, out);
            }
        }
    }

    struct Neighbor {
        Place step{};
        Index steps = 0;  // axes along which it is another
        std::ptrdiff_t offset = 0;
    };

    Place sizes_;
    std::vector<Neighbor> neighbors_;  // those across a face first: they contain most balls
    std::span<const std::int32_t> depths_;
    Tiles array_;
    VoxelBox core_;
    std::int32_t largest_ = 0;
    std::vector<std::uint16_t> roots_;
    std::vector<std::vector<VoxelBall>> balls_;  // of each tile of the array
};

}  // namespace

std::vector<float> thickness_of_block(const VolumeBlock& block, std::span<const std::uint8_t> mask,
                                      const Execution& execution) {
    return in_arena(execution, [&] {
        const std::vector<std::int32_t> depths = squared_depths(block.sizes, mask, execution);
        return BallPainting(block, depths).diameters();
    });
}

}  // namespace scaleaxis::inline v1
