// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/near_cells.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

// A value is far from zero if it is farther than this part of the values' range. An edge of 90 degrees that comes in
// through a face of a cell is nearer.
constexpr double kFarCells = 0.5;

bool is_crossed(std::uint8_t inside) { return inside != 0 && inside != 255; }

/// The cells between two layers.
class Slice {
   public:
    Slice() = default;
    Slice(const std::array<Index, 3>& counts, std::vector<double> below, const std::vector<double>& above)
        : width_(counts[0]), height_(counts[1]), below_(std::move(below)), crossed_(cells()) {
        for (Index j = 0; j < height_; ++j) {
            for (Index i = 0; i < width_; ++i) {
                crossed_[place(i, j)] = is_crossed(signs(corners(above, i, j))) ? 1 : 0;
            }
        }
    }

    const std::vector<double>& below() const { return below_; }

    CornerValues corners(const std::vector<double>& above, Index i, Index j) const {
        const std::size_t row = static_cast<std::size_t>(width_) + 1;
        const std::size_t at = static_cast<std::size_t>(j) * row + i;
        const std::vector<double>& v = below_;
        const std::vector<double>& w = above;
        return {v[at], v[at + 1], v[at + row], v[at + row + 1], w[at], w[at + 1], w[at + row], w[at + row + 1]};
    }

    static std::uint8_t signs(const CornerValues& values) {
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
            inside |= values[c] < 0.0 ? 1 << c : 0;
        }
        return static_cast<std::uint8_t>(inside);
    }

    /// Marks the cells of which one of the nine around it in this slice is crossed.
    void mark_near(std::vector<std::uint8_t>& is_near) const {
        for (std::size_t at = 0; at < crossed_.size(); ++at) {
            if (crossed_[at] != 0) {
                const auto i = static_cast<Index>(at % width_);
                const auto j = static_cast<Index>(at / width_);
                for (Index y = std::max(0, j - 1); y <= std::min(j + 1, height_ - 1); ++y) {
                    for (Index x = std::max(0, i - 1); x <= std::min(i + 1, width_ - 1); ++x) {
                        is_near[place(x, y)] = 1;
                    }
                }
            }
        }
    }

   private:
    std::size_t cells() const { return static_cast<std::size_t>(width_) * height_; }
    std::size_t place(Index i, Index j) const { return static_cast<std::size_t>(j) * width_ + i; }

    Index width_ = 0;
    Index height_ = 0;
    std::vector<double> below_;
    std::vector<std::uint8_t> crossed_;
};

}  // namespace

std::size_t NearCells::find(const Cell& cell) const {
    const std::size_t at = after(cell);
    return at > 0 && cells[at - 1].cell == cell ? at - 1 : cells.size();
}

bool is_far_from_zero(const CornerValues& values) {
    const auto [least, most] = std::ranges::minmax(values);
    const double nearest = least >= 0.0 ? least : -most;
    return nearest > 0.0 && least < most && nearest >= kFarCells * (most - least);  // equal values tell nothing
}

NearCells::Place NearCells::place_of(const Cell& cell) const {
    const std::size_t at = after(cell);
    if (at == 0 || cells[at - 1].cell[1] != cell[1] || cells[at - 1].cell[2] != cell[2]) {
        return Place::kOutside;  // as the beginning of the row
    }
    if (cells[at - 1].cell[0] == cell[0]) {
        return Place::kNear;
    }
    // The next one has corners on one side only, and shares four of them.
    return (cells[at - 1].inside & 2) != 0 ? Place::kInside : Place::kOutside;
}

std::size_t NearCells::after(const Cell& cell) const {
    const std::size_t row = static_cast<std::size_t>(cell[2]) * counts[1] + cell[1];
    const auto first = cells.begin();
    const auto at = std::upper_bound(first + static_cast<std::ptrdiff_t>(rows[row]),
                                     first + static_cast<std::ptrdiff_t>(rows[row + 1]), cell[0],
                                     [](Index x, const SurfaceCell& other) { return x < other.cell[0]; });
    return static_cast<std::size_t>(at - first);
}

std::vector<SurfaceCell> NearCells::crossed() const {
    std::vector<SurfaceCell> result;
    std::ranges::copy_if(cells, std::back_inserter(result), [](const SurfaceCell& c) { return is_crossed(c.inside); });
    return result;
}

NearCells find_near_cells(const std::array<Index, 3>& counts, const std::function<std::vector<double>(Index)>& layer) {
    NearCells result;
    result.counts = counts;
    const Index width = counts[0];
    const Index height = counts[1];
    const Index depth = counts[2];
    // Which cells of a slice are near is known one slice later.
    Slice before;
    Slice current;
    const auto add = [&](Index k, const Slice& next) {
        std::vector<std::uint8_t> is_near(static_cast<std::size_t>(width) * height);
        before.mark_near(is_near);
        current.mark_near(is_near);
        next.mark_near(is_near);
        stop_if_cancelled();
        for (Index j = 0; j < height; ++j) {
            result.rows.push_back(result.cells.size());
            for (Index i = 0; i < width; ++i) {
                if (is_near[static_cast<std::size_t>(j) * width + i] != 0) {
                    const CornerValues values = current.corners(next.below(), i, j);
                    if (!is_far_from_zero(values)) {
                        result.cells.push_back({{i, j, k}, Slice::signs(values)});
                        result.values.push_back(values);
                    }
                }
            }
        }
    };
    std::vector<double> below = layer(0);
    for (Index k = 0; k < depth; ++k) {
        std::vector<double> above = layer(k + 1);
        Slice next(counts, std::move(below), above);
        if (k > 0) {
            add(k - 1, next);
        }
        before = std::exchange(current, std::move(next));
        below = std::move(above);
    }
    // The last slice has a layer of points above it, but no slice.
    add(depth - 1, Slice({0, 0, 0}, std::move(below), {}));
    result.rows.push_back(result.cells.size());
    return result;
}

}  // namespace scaleaxis::inline v1
