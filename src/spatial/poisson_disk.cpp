// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/poisson_disk.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "kernel/parallel.hpp"
#include "kernel/radix_sort.hpp"
#include "kernel/random.hpp"
#include "kernel/spatial_order.hpp"

namespace scaleaxis {
namespace {

// Space is divided into cubic blocks, which are treated in eight groups of equal parity. Blocks of one group are at
// least one block apart, so they do not see each other and can be filled at the same time; and a point sees only its
// own and the 26 blocks around.
constexpr double kBlockSide = 3.0;  // in radii: larger blocks mean more comparisons, smaller ones more look-ups
constexpr int kCoordinateBits = 20;
constexpr std::int64_t kMaxCoordinate = (std::int64_t{1} << kCoordinateBits) - 1;

std::uint64_t morton(std::int64_t x, std::int64_t y, std::int64_t z) {
    return kernel::interleaved(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                               static_cast<std::uint64_t>(z));
}

// Consecutive points of one block.
struct Run {
    std::uint64_t key = 0;
    Index begin = 0;
    Index end = 0;
};

// Points by coordinate, to be compared several at once.
class Nearby {
   public:
    void push_back(const Point& p) {
        xs_.push_back(p.x);
        ys_.push_back(p.y);
        zs_.push_back(p.z);
    }
    // Is one of them closer to `p` than the root of `square`? To look at all costs less than to stop early.
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

struct Block {
    std::uint64_t key = 0;
    std::array<std::int64_t, 3> coordinates{};
    std::size_t begin = 0;  // its runs
    std::size_t end = 0;
    std::vector<Point> chosen;
};

// Finds blocks by their keys.
class BlockTable {
   public:
    explicit BlockTable(const std::vector<Block>& blocks)
        : entries_(std::bit_ceil(2 * blocks.size() + 2)), shift_(64 - std::countr_zero(entries_.size())) {
        for (const Block& block : blocks) {
            std::size_t i = place(block.key);
            while (entries_[i].block != nullptr) {
                i = after(i);
            }
            entries_[i] = {block.key, &block};
        }
    }

    const Block* find(std::uint64_t key) const {
        std::size_t i = place(key);
        while (entries_[i].block != nullptr && entries_[i].key != key) {
            i = after(i);
        }
        return entries_[i].block;
    }

   private:
    struct Entry {
        std::uint64_t key = 0;
        const Block* block = nullptr;
    };
    std::size_t place(std::uint64_t key) const { return key * 0x9E3779B97F4A7C15U >> shift_; }
    std::size_t after(std::size_t i) const { return (i + 1) & (entries_.size() - 1); }

    std::vector<Entry> entries_;
    int shift_;
};

}  // namespace

std::vector<Point> poisson_disk_subset(const std::vector<Point>& points, double radius, std::uint64_t seed) {
    Box box;
    for (const Point& p : points) {
        box.extend(p);
    }
    const double extent = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z, 0.0});
    const double side = std::max(kBlockSide * radius, extent / static_cast<double>(kMaxCoordinate - 1));
    const auto coordinates = [&](const Point& p) -> std::array<std::int64_t, 3> {
        return {static_cast<std::int64_t>((p.x - box.min.x) / side),
                static_cast<std::int64_t>((p.y - box.min.y) / side),
                static_cast<std::int64_t>((p.z - box.min.z) / side)};
    };

    // Points mostly come in an order with locality: whole runs of them, of one block each, are sorted.
    std::vector<std::uint64_t> keys(points.size());
    kernel::for_each_index(points.size(), [&](std::size_t i) {
        const auto [x, y, z] = coordinates(points[i]);
        keys[i] = morton(x, y, z);
    });
    std::vector<Run> runs;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i == 0 || keys[i] != keys[i - 1]) {
            runs.push_back({keys[i], static_cast<Index>(i), static_cast<Index>(i)});
        }
        ++runs.back().end;
    }
    kernel::radix_sort(runs);

    std::vector<Block> blocks;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        if (blocks.empty() || blocks.back().key != runs[i].key) {
            blocks.push_back({runs[i].key, coordinates(points[runs[i].begin]), i, i, {}});
        }
        blocks.back().end = i + 1;
    }
    const BlockTable table(blocks);
    const auto find = [&](std::int64_t x, std::int64_t y, std::int64_t z) -> const Block* {
        if (x < 0 || y < 0 || z < 0 || x > kMaxCoordinate || y > kMaxCoordinate || z > kMaxCoordinate) {
            return nullptr;
        }
        return table.find(morton(x, y, z));
    };

    const double square = radius * radius;
    const auto fill = [&](Block& block) {
        std::array<const Block*, 27> around{};
        std::size_t count = 0;
        const auto [x, y, z] = block.coordinates;
        for (std::int64_t dx = -1; dx <= 1; ++dx) {
            for (std::int64_t dy = -1; dy <= 1; ++dy) {
                for (std::int64_t dz = -1; dz <= 1; ++dz) {
                    const Block* other = find(x + dx, y + dy, z + dz);
                    if (other != nullptr && other != &block) {
                        around[count++] = other;
                    }
                }
            }
        }
        Nearby nearby;  // chosen points that this block's points can be close to
        const Point low{box.min.x + static_cast<double>(x) * side - radius,
                        box.min.y + static_cast<double>(y) * side - radius,
                        box.min.z + static_cast<double>(z) * side - radius};
        const double reach = side + 2.0 * radius;
        for (std::size_t k = 0; k < count; ++k) {
            for (const Point& p : around[k]->chosen) {
                const Point q = p - low;
                if (q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x <= reach && q.y <= reach && q.z <= reach) {
                    nearby.push_back(p);
                }
            }
        }
        std::vector<Point> candidates;
        for (std::size_t r = block.begin; r < block.end; ++r) {
            candidates.insert(candidates.end(), points.begin() + runs[r].begin, points.begin() + runs[r].end);
        }
        // In random order: the order that points come in would show as a pattern.
        const std::uint64_t bits = kernel::random_bits(seed, block.key);
        for (std::size_t last = candidates.size(); last > 1; --last) {
            std::swap(candidates[last - 1], candidates[kernel::random_bits(bits, last) % last]);
        }
        for (const Point& p : candidates) {
            if (!nearby.has_close(p, square)) {
                nearby.push_back(p);
                block.chosen.push_back(p);
            }
        }
    };

    std::array<std::vector<std::size_t>, 8> groups;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const auto [x, y, z] = blocks[b].coordinates;
        groups[static_cast<std::size_t>((x & 1) | (y & 1) << 1 | (z & 1) << 2)].push_back(b);
    }
    for (const std::vector<std::size_t>& group : groups) {
        kernel::for_each_index(
            group.size(), [&](std::size_t i) { fill(blocks[group[i]]); }, std::size_t{16});
    }

    std::vector<Point> result;
    for (const Block& block : blocks) {
        result.insert(result.end(), block.chosen.begin(), block.chosen.end());
    }
    return result;
}

}  // namespace scaleaxis
