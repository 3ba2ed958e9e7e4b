// SPDX-License-Identifier: Apache-2.0
#include "spatial/poisson_disk.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/grouped.hpp"
#include "base/hash_table.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "base/random.hpp"
#include "spatial/extent.hpp"
#include "spatial/spatial_order.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kBlockSide = 3.0;  // in radii: larger blocks mean more comparisons, smaller ones more look-ups
constexpr std::int64_t kMaxCoordinate = (std::int64_t{1} << 20) - 1;

using Place = std::array<std::int64_t, 3>;

std::uint64_t key_of(const Place& place) {
    return interleaved(static_cast<std::uint64_t>(place[0]), static_cast<std::uint64_t>(place[1]),
                       static_cast<std::uint64_t>(place[2]));
}

/// Space in cubic blocks, whose side is at least the radius.
struct Grid {
    Point origin;
    double side;

    Place place_of(const Point& p) const {
        return {coordinate_of(p.x - origin.x), coordinate_of(p.y - origin.y), coordinate_of(p.z - origin.z)};
    }
    /// 0 for a number that is not finite, which no integer stands for: a solid that contradicts itself may answer one.
    std::int64_t coordinate_of(double offset) const {
        const double coordinate = offset / side;
        return coordinate >= 0.0 && coordinate <= static_cast<double>(kMaxCoordinate)
                   ? static_cast<std::int64_t>(coordinate)
                   : 0;
    }
    /// All points that are not farther than `distance` from the block.
    Box around(const Place& place, double distance) const {
        const Point low{origin.x + static_cast<double>(place[0]) * side - distance,
                        origin.y + static_cast<double>(place[1]) * side - distance,
                        origin.z + static_cast<double>(place[2]) * side - distance};
        const double size = side + 2.0 * distance;
        return {low, low + Point{size, size, size}};
    }
};

Grid grid_of(const std::vector<Point>& points, double radius) {
    const Box box = box_around(points);
    const double extent = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z, 0.0});
    return {box.min, std::max(kBlockSide * radius, extent / static_cast<double>(kMaxCoordinate - 1))};
}

/// Consecutive points of one block.
struct Run {
    std::uint64_t key = 0;
    Index begin = 0;
    Index end = 0;
};

struct Block {
    std::uint64_t key = 0;
    Place place{};
    std::vector<std::span<const Point>> candidates;  ///< as runs
    std::vector<Point> chosen;
};

/// The blocks that have points, by ascending key.
std::vector<Block> blocks_of(const std::vector<Point>& points, const Grid& grid) {
    const auto keys =
        mapped<std::uint64_t>(points.size(), [&](std::size_t i) { return key_of(grid.place_of(points[i])); });
    // Points mostly come in an order with locality: runs of points of one block are sorted, which are fewer.
    CancellationPoint ask_whether_cancelled;
    std::vector<Run> runs;
    for (Index i = 0; i < static_cast<Index>(points.size()); ++i) {
        ask_whether_cancelled();
        if (runs.empty() || keys[i] != runs.back().key) {
            runs.push_back({keys[i], i, i});
        }
        ++runs.back().end;
    }
    radix_sort(runs);
    std::vector<Block> blocks;
    for (const Run& run : runs) {
        ask_whether_cancelled();
        if (blocks.empty() || blocks.back().key != run.key) {
            blocks.push_back({run.key, grid.place_of(points[run.begin]), {}, {}});
        }
        blocks.back().candidates.push_back(std::span(points).subspan(run.begin, run.end - run.begin));
    }
    return blocks;
}

/// Finds blocks by their keys.
class BlockTable {
   public:
    explicit BlockTable(const std::vector<Block>& blocks) : table_(blocks.size()) {
        CancellationPoint ask_whether_cancelled;
        for (const Block& block : blocks) {
            ask_whether_cancelled();
            table_[place_of(block.key)] = {block.key, &block};
        }
    }
    /// `nullptr` if there is none.
    const Block* find(std::uint64_t key) const { return table_[place_of(key)].block; }

   private:
    struct Entry {
        std::uint64_t key = 0;
        const Block* block = nullptr;
    };
    std::size_t place_of(std::uint64_t key) const {
        return table_.find(key, [key](const Entry& e) { return e.block == nullptr || e.key == key; });
    }
    HashTable<Entry> table_;
};

/// Calls `visit(block)` for those of the 26 blocks around that exist.
template <class Visit>
void for_each_block_beside(const BlockTable& table, const Place& place, const Visit& visit) {
    for (int k = 0; k < 27; ++k) {
        const Place other{place[0] + k / 9 - 1, place[1] + k / 3 % 3 - 1, place[2] + k % 3 - 1};
        const bool is_inside = std::ranges::all_of(other, [](std::int64_t x) { return 0 <= x && x <= kMaxCoordinate; });
        const Block* const block = k != 13 && is_inside ? table.find(key_of(other)) : nullptr;
        if (block != nullptr) {
            visit(*block);
        }
    }
}

/// Points by coordinate, to be compared several at once.
class PointColumns {
   public:
    void push_back(const Point& p) {
        xs_.push_back(p.x);
        ys_.push_back(p.y);
        zs_.push_back(p.z);
    }
    /// Is one of them closer to `p` than the root of `square`? To look at all costs less than to stop early.
    bool has_close(const Point& p, double square) const {
        const double* const xs = xs_.data();
        const double* const ys = ys_.data();
        const double* const zs = zs_.data();
        const std::size_t size = xs_.size();
        std::int64_t close = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const double x = xs[i] - p.x, y = ys[i] - p.y, z = zs[i] - p.z;
            close |= x * x + y * y + z * z < square ? 1 : 0;
        }
        return close != 0;
    }

   private:
    std::vector<double> xs_, ys_, zs_;
};

/// In random order: the order that points come in would show as a pattern.
void shuffle(std::vector<Point>& points, std::uint64_t seed) {
    for (std::size_t last = points.size(); last > 1; --last) {
        std::swap(points[last - 1], points[random_bits(seed, last) % last]);
    }
}

/// Chooses points of the block that are not close to those chosen before, here and in the blocks beside it.
void choose(Block& block, const BlockTable& table, const Grid& grid, double radius, std::uint64_t seed) {
    PointColumns chosen;
    const Box near = grid.around(block.place, 1.001 * radius);
    for_each_block_beside(table, block.place, [&](const Block& other) {
        for (const Point& p : other.chosen) {
            if (near.contains(p)) {
                chosen.push_back(p);
            }
        }
    });
    std::vector<Point> candidates;
    for (const std::span<const Point> run : block.candidates) {
        candidates.insert(candidates.end(), run.begin(), run.end());
    }
    shuffle(candidates, random_bits(seed, block.key));
    for (const Point& p : candidates) {
        if (!chosen.has_close(p, radius * radius)) {
            chosen.push_back(p);
            block.chosen.push_back(p);
        }
    }
}

}  // namespace

std::vector<Point> poisson_disk_subset(const std::vector<Point>& points, double radius, std::uint64_t seed) {
    const Grid grid = grid_of(points, radius);
    std::vector<Block> blocks = blocks_of(points, grid);
    const BlockTable table(blocks);
    // Blocks of equal parity have others between them, so they can choose at the same time.
    const auto parity = [](const Block& block) {
        return (block.place[0] & 1) | (block.place[1] & 1) << 1 | (block.place[2] & 1) << 2;
    };
    CancellationPoint ask_whether_cancelled;
    const IndexLists groups = grouped(8, [&](const auto& add) {
        for (Index b = 0; b < static_cast<Index>(blocks.size()); ++b) {
            ask_whether_cancelled();
            add(parity(blocks[b]), b);
        }
    });
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for_each_index(
            groups[g].size(), [&](std::size_t i) { choose(blocks[groups[g][i]], table, grid, radius, seed); },
            std::size_t{16});
    }
    std::vector<Point> result;
    for (const Block& block : blocks) {
        ask_whether_cancelled();
        append(result, block.chosen);
    }
    return result;
}

}  // namespace scaleaxis::inline v1
