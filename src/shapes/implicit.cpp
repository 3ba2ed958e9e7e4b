// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/shape.hpp"
#include "shapes/bracketed_root.hpp"
#include "shapes/lattice.hpp"

namespace scaleaxis {
namespace {

constexpr double kDefaultFeature = 1.0 / 128.0;  // of the diagonal of the bounds
constexpr double kMargin = 0.5;                  // of the solid's box, in steps: a sharp tip hides between samples
constexpr std::uint8_t kNotANumber = 2;
constexpr double kMostPoints = 0x1p34;  // of the lattice

std::string text_of(const Point& p) {
    std::ostringstream text;
    text << '(' << p.x << ", " << p.y << ", " << p.z << ')';
    return text.str();
}

// Where a segment from a point of the box leaves it, 1 if it does not.
double exit_of(const Box& box, const Point& from, const Point& to) {
    double exit = 1.0;
    const auto clip = [&](double a, double b, double low, double high) {
        if (b > high) {
            exit = std::min(exit, (high - a) / (b - a));
        } else if (b < low) {
            exit = std::min(exit, (low - a) / (b - a));
        }
    };
    clip(from.x, to.x, box.min.x, box.max.x);
    clip(from.y, to.y, box.min.y, box.max.y);
    clip(from.z, to.z, box.min.z, box.max.z);
    return exit;
}

class ImplicitShape final : public Shape {
   public:
    ImplicitShape(std::function<double(const Point&)> function, const ImplicitOptions& options,
                  const Execution& execution)
        : function_(std::move(function)), bounds_(options.bounds), step_(options.smallest_feature) {
        const Point extent = bounds_.max - bounds_.min;
        if (!is_finite(bounds_.min) || !is_finite(bounds_.max) || !(std::min({extent.x, extent.y, extent.z}) > 0.0)) {
            throw InvalidOption(
                "the bounds of an implicit function must be finite, and larger than nothing along x, y "
                "and z");
        }
        if (!(step_ >= 0.0) || !std::isfinite(step_)) {
            throw InvalidOption("the smallest feature of an implicit function must be a positive length");
        }
        step_ = step_ > 0.0 ? step_ : kDefaultFeature * bounds_.diagonal();
        double points = 1.0;
        const auto cells = [&](double side) {
            const double count = std::ceil(side / step_);
            points *= count + 1.0;
            return count;
        };
        const std::array<double, 3> counts{cells(extent.x), cells(extent.y), cells(extent.z)};
        if (!(points < kMostPoints) || !(*std::ranges::max_element(counts) < (1 << 20))) {
            throw InvalidOption(
                "the smallest feature is too small for these bounds: the function would be evaluated at "
                "more than 2^34 places to find all parts; choose a larger one");
        }
        counts_ = {static_cast<Index>(counts[0]), static_cast<Index>(counts[1]), static_cast<Index>(counts[2])};
        lattice_ = {
            bounds_.min,
            {Point{extent.x / counts[0], 0, 0}, Point{0, extent.y / counts[1], 0}, Point{0, 0, extent.z / counts[2]}}};
        find_cells(execution);
        box_ = extent_of(lattice_, cells_, landmarks_, root_in_cell(), kMargin);
    }

    Box bounds() const override { return box_; }

    bool inside(const Point& p) const override { return box_.contains(p) && value(p) < 0.0; }

    std::optional<Point> crossing(const Point& inside_end, const Point& outside_end,
                                  const Point& reference) const override {
        if (!box_.contains(inside_end)) {
            return std::nullopt;
        }
        const Point direction = exit_of(box_, inside_end, outside_end) * (outside_end - inside_end);
        const double pieces = std::ceil(norm(direction) / step_);
        const auto value_at = [&](double t) { return value(inside_end + t * direction); };
        std::optional<Point> farthest;
        const auto add = [&](const Point& p) {
            if (!farthest || squared_distance(p, reference) > squared_distance(*farthest, reference)) {
                farthest = p;
            }
        };
        double before = value_at(0.0);
        if (!(before < 0.0)) {
            return std::nullopt;
        }
        for (double i = 0.0; i < pieces; ++i) {
            const double after = value_at((i + 1.0) / pieces);
            if ((before < 0.0) != (after < 0.0)) {
                add(inside_end + bracketed_root(value_at, i / pieces, (i + 1.0) / pieces, before, after) * direction);
            }
            before = after;
        }
        if (before < 0.0) {
            // The solid ends where its box does.
            if (box_.contains(outside_end)) {
                return std::nullopt;
            }
            add(inside_end + direction);
        }
        return farthest;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return kernel::in_arena(execution, [&] {
            std::vector<Point> points =
                points_on_lines(lattice_, cells_, kSeedLines / (spacing * spacing), seed, root_in_cell());
            kernel::append(points, landmarks_);
            return points;
        });
    }

   private:
    /// Finite, so that places can be interpolated.
    double value(const Point& p) const {
        constexpr double kMost = 1e100;
        const double result = function_(p);
        if (std::isnan(result)) {
            throw UnusableShape("the function is not a number at " + text_of(p));
        }
        return std::clamp(result, -kMost, kMost);
    }

    /// Where a line through a point along an axis crosses the boundary in a cell; indices of the lattice.
    RootInCell root_in_cell() const {
        return [this](const Cell& cell, int axis, const Point& p) -> std::optional<double> {
            const auto value_at = [&](double position) {
                std::array<double, 3> index{p.x, p.y, p.z};
                index[axis] = position;
                return value(lattice_.at({index[0], index[1], index[2]}));
            };
            const double begin = cell[axis];
            const double before = value_at(begin);
            const double after = value_at(begin + 1.0);
            if ((before < 0.0) == (after < 0.0)) {
                return std::nullopt;
            }
            return bracketed_root(value_at, begin, begin + 1.0, before, after);
        };
    }

    /// Where is a layer of the lattice inside?
    std::vector<std::uint8_t> signs_of_layer(Index k) const {
        const std::size_t width = counts_[0] + 1;
        std::vector<std::uint8_t> signs(width * (counts_[1] + 1));
        kernel::for_each_index(
            signs.size(),
            [&](std::size_t n) {
                const double i = static_cast<double>(n % width);
                const double j = static_cast<double>(n / width);
                const double result = function_(lattice_.at({i, j, 1.0 * k}));
                signs[n] = std::isnan(result) ? kNotANumber : result < 0.0 ? 1 : 0;
            },
            std::size_t{256});
        return signs;
    }

    /// \throws UnusableShape for the first point of the layer that is not as it should be
    void check_layer(const std::vector<std::uint8_t>& signs, Index k) const {
        for (Index j = 0; j <= counts_[1]; ++j) {
            for (Index i = 0; i <= counts_[0]; ++i) {
                if (signs[static_cast<std::size_t>(j) * (counts_[0] + 1) + i] == kNotANumber) {
                    value(lattice_.at({1.0 * i, 1.0 * j, 1.0 * k}));
                }
                const bool is_side =
                    i == 0 || j == 0 || k == 0 || i == counts_[0] || j == counts_[1] || k == counts_[2];
                if (is_side && signs[static_cast<std::size_t>(j) * (counts_[0] + 1) + i] != 0) {
                    throw UnusableShape("the bounds cut the solid at " +
                                        text_of(lattice_.at({1.0 * i, 1.0 * j, 1.0 * k})) +
                                        ", where the function is negative: choose larger bounds (inside is negative)");
                }
            }
        }
    }

    void find_cells(const Execution& execution) {
        std::vector<SurfaceCell> cells;
        std::vector<std::uint8_t> below;
        bool has_inside = false;
        for (Index k = 0; k <= counts_[2]; ++k) {
            kernel::report(execution, "looking for the surface", 1.0 * k / counts_[2]);
            std::vector<std::uint8_t> signs = signs_of_layer(k);
            check_layer(signs, k);
            has_inside = has_inside || std::ranges::find(signs, 1) != signs.end();
            for (Index j = 0; k > 0 && j < counts_[1]; ++j) {
                const std::size_t row = static_cast<std::size_t>(j) * (counts_[0] + 1);
                for (Index i = 0; i < counts_[0]; ++i) {
                    int inside = 0;
                    for (int c = 0; c < 8; ++c) {
                        const std::size_t at = row + (c >> 1 & 1) * (counts_[0] + 1) + i + (c & 1);
                        inside |= (c < 4 ? below : signs)[at] << c;
                    }
                    if (inside > 0 && inside < 255) {
                        cells.push_back({{i, j, k - 1}, static_cast<std::uint8_t>(inside)});
                    }
                }
            }
            below = std::move(signs);
        }
        if (!has_inside) {
            throw UnusableShape(
                "the function is nowhere negative (inside) within the bounds, as far as a grid of step " +
                std::to_string(step_) + " tells: check its sign, the bounds, and the smallest feature");
        }
        landmarks_ = landmark_points(lattice_, cells, root_in_cell());
        cells_ = with_neighbors(cells);
    }

    /// The surface may bulge a little into cells whose corners are all on one side.
    std::vector<SurfaceCell> with_neighbors(const std::vector<SurfaceCell>& cells) const {
        std::vector<SurfaceCell> all = cells;
        for (const auto& [cell, inside] : cells) {
            for (int axis = 0; axis < 3; ++axis) {
                for (const Index by : {-1, 1}) {
                    Cell neighbor = cell;
                    neighbor[axis] += by;
                    if (neighbor[axis] >= 0 && neighbor[axis] < counts_[axis]) {
                        all.push_back({neighbor, 0});
                    }
                }
            }
        }
        std::ranges::sort(all, {}, [](const SurfaceCell& c) { return std::tuple(c.cell[2], c.cell[1], c.cell[0]); });
        const auto is_same = [](const SurfaceCell& a, const SurfaceCell& b) { return a.cell == b.cell; };
        all.erase(std::unique(all.begin(), all.end(), is_same), all.end());
        return all;
    }

    std::function<double(const Point&)> function_;
    Box bounds_;
    double step_;
    std::array<Index, 3> counts_{};  // cells along each axis
    Lattice lattice_;
    std::vector<SurfaceCell> cells_;  // that the boundary passes
    std::vector<Point> landmarks_;
    Box box_;
};

}  // namespace

std::unique_ptr<Shape> implicit_shape(std::function<double(const Point&)> function, const ImplicitOptions& options,
                                      const Execution& execution) {
    return kernel::in_arena(execution,
                            [&] { return std::make_unique<ImplicitShape>(std::move(function), options, execution); });
}

}  // namespace scaleaxis
