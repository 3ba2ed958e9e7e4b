// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "sampling/poisson_disk.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/shape.hpp"
#include "shapes/bracketed_root.hpp"
#include "shapes/lattice.hpp"
#include "shapes/near_cells.hpp"
#include "shapes/near_points.hpp"

namespace scaleaxis {
namespace {

constexpr double kDefaultFeature = 1.0 / 128.0;  // of the diagonal of the bounds
constexpr double kMargin = 0.45;                 // of the solid's box, in steps: a sharp tip hides between samples
constexpr double kExtentSpacing = 0.5;           // of points that show how far the solid goes, in steps
constexpr double kMost = 1e100;                  // values are cut off there, so that places can be interpolated
constexpr double kMostPoints = 0x1p34;           // of the lattice

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
        rounding_ = std::numeric_limits<double>::epsilon() * std::max(norm(bounds_.min), norm(bounds_.max));
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
        near_ = find_near_cells(counts_, [&](Index k) {
            kernel::report(execution, "looking for the surface", 1.0 * k / counts_[2]);
            return values_of_layer(k);
        });
        if (near_.cells.empty()) {
            throw UnusableShape(
                "the function is nowhere negative (inside) within the bounds, as far as a grid of step " +
                std::to_string(step_) + " tells: check its sign, the bounds, and the smallest feature");
        }
        landmarks_ = landmark_points(lattice_, near_.crossed(), root_in_cell());
        box_ = surface_box();
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
        const double accuracy = rounding_ / norm(direction);
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
                add(inside_end +
                    bracketed_root(value_at, i / pieces, (i + 1.0) / pieces, before, after, accuracy) * direction);
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
            std::vector<Point> candidates =
                points_near_zero(lattice_, near_.cells, near_.values, asked_function(), spacing, seed);
            // Most of them would go anyway, and exact places take their time. Those kept stay as far apart, or almost.
            candidates = poisson_disk_subset(candidates, spacing, seed);
            auto points = kernel::collect<std::vector<Point>>(
                candidates.size(),
                [&](std::size_t i, std::vector<Point>& out) {
                    if (const std::optional<Point> p = projected(candidates[i], spacing)) {
                        out.push_back(*p);
                    }
                },
                std::size_t{256});
            kernel::append(points, landmarks_);
            return points;
        });
    }

   private:
    double asked(const Point& p) const {
        const double result = function_(p);
        if (std::isnan(result)) {
            throw UnusableShape("the function is not a number at " + text_of(p));
        }
        return std::clamp(result, -kMost, kMost);
    }

    std::function<double(const Point&)> asked_function() const {
        return [this](const Point& p) { return asked(p); };
    }

    /// That of the function in the cells near the surface. Elsewhere nothing but the sign, which the cell tells.
    double value(const Point& p) const {
        const std::optional<Cell> cell = cell_of(p);
        const NearCells::Place place = cell ? near_.place_of(*cell) : NearCells::Place::kOutside;
        return place == NearCells::Place::kNear ? asked(p) : place == NearCells::Place::kInside ? -kMost : kMost;
    }

    Point index_of(const Point& p) const {
        const Point d = p - lattice_.origin;
        return {d.x / lattice_.steps[0].x, d.y / lattice_.steps[1].y, d.z / lattice_.steps[2].z};
    }

    /// Nothing beyond the bounds.
    std::optional<Cell> cell_of(const Point& p) const {
        if (!bounds_.contains(p)) {
            return std::nullopt;
        }
        const Point index = index_of(p);
        return Cell{std::min(static_cast<Index>(index.x), counts_[0] - 1),
                    std::min(static_cast<Index>(index.y), counts_[1] - 1),
                    std::min(static_cast<Index>(index.z), counts_[2] - 1)};
    }

    /// The box of the corners inside, and of the surface beyond it.
    Box surface_box() const {
        Box corners;  // by index
        for (const SurfaceCell& c : near_.cells) {
            for (int corner = 0; corner < 8; ++corner) {
                if ((c.inside >> corner & 1) != 0) {
                    corners.extend(corner_of(c.cell, corner));
                }
            }
        }
        std::vector<SurfaceCell> outer;
        std::vector<CornerValues> values;
        for (std::size_t i = 0; i < near_.cells.size(); ++i) {
            if (!corners.contains(corner_of(near_.cells[i].cell, 0)) ||
                !corners.contains(corner_of(near_.cells[i].cell, 7))) {
                outer.push_back(near_.cells[i]);
                values.push_back(near_.values[i]);
            }
        }
        Box box{lattice_.at(corners.min), lattice_.at(corners.max)};
        const std::vector<Point> points =
            points_near_zero(lattice_, outer, values, asked_function(), kExtentSpacing * step_, 0);
        for (const auto& list : {points, landmarks_}) {
            for (const Point& p : list) {
                box.extend(p);
            }
        }
        const Point by = kMargin * lattice_.at({1.0, 1.0, 1.0}) - kMargin * lattice_.origin;
        return {box.min - by, box.max + by};
    }

    static Point corner_of(const Cell& cell, int corner) {
        return {1.0 * cell[0] + (corner & 1), 1.0 * cell[1] + (corner >> 1 & 1), 1.0 * cell[2] + (corner >> 2)};
    }

    /// The gradient of the interpolant in the cell; 0 where there is none.
    Point slope_at(const Point& p) const {
        const std::optional<Cell> cell = cell_of(p);
        const std::size_t at = cell ? near_.find(*cell) : near_.cells.size();
        if (at == near_.cells.size()) {
            return {};
        }
        const Point by_index =
            gradient(near_.values[at], index_of(p) - Point{1.0 * (*cell)[0], 1.0 * (*cell)[1], 1.0 * (*cell)[2]});
        const auto& [a, b, c] = lattice_.steps;
        return {by_index.x / a.x, by_index.y / b.y, by_index.z / c.z};
    }

    /// The place of the surface near `p`, which is almost there, along an axis: the one that the interpolant changes
    /// most along, if there is one so.
    std::optional<Point> projected(const Point& p, double spacing) const {
        const double here = value(p);
        if (here == 0.0) {
            return p;
        }
        const Point slope = slope_at(p);
        const std::array<double, 3> slopes{slope.x, slope.y, slope.z};
        std::array<int, 3> axes{0, 1, 2};
        std::ranges::sort(axes, std::greater(), [&](int axis) { return std::abs(slopes[axis]); });
        for (const int axis : axes) {
            std::array<double, 3> place{p.x, p.y, p.z};
            const double begin = place[axis];
            const auto value_at = [&](double position) {
                place[axis] = position;
                return value({place[0], place[1], place[2]});
            };
            // A little farther than where it should be; then on both sides.
            const double expected = -1.5 * here / slopes[axis];
            double length = std::abs(expected) < spacing ? std::abs(expected) : 0.125 * spacing;
            for (; length <= spacing; length = std::max(4.0 * length, 0.125 * spacing)) {
                for (const double side : {1.0, -1.0}) {
                    const double end = begin + std::copysign(length, side * expected);
                    const double there = value_at(end);
                    if ((here < 0.0) != (there < 0.0)) {
                        place[axis] = begin < end ? bracketed_root(value_at, begin, end, here, there, rounding_)
                                                  : bracketed_root(value_at, end, begin, there, here, rounding_);
                        return Point{place[0], place[1], place[2]};
                    }
                }
            }
        }
        return std::nullopt;
    }

    /// Where a line through a point along an axis crosses the boundary in a cell; indices of the lattice.
    RootInCell root_in_cell() const {
        return [this](const Cell& cell, int axis, const Point& p) -> std::optional<double> {
            const auto value_at = [&](double position) {
                std::array<double, 3> index{p.x, p.y, p.z};
                index[axis] = position;
                return asked(lattice_.at({index[0], index[1], index[2]}));
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

    /// \throws UnusableShape for its first point that is not as it should be
    std::vector<double> values_of_layer(Index k) const {
        const std::size_t width = counts_[0] + 1;
        std::vector<double> values(width * (counts_[1] + 1));
        const auto place = [&](std::size_t n) {
            return lattice_.at({static_cast<double>(n % width), static_cast<double>(n / width), 1.0 * k});
        };
        kernel::for_each_index(
            values.size(), [&](std::size_t n) { values[n] = std::clamp(function_(place(n)), -kMost, kMost); },
            std::size_t{256});
        for (std::size_t n = 0; n < values.size(); ++n) {
            const auto i = static_cast<Index>(n % width);
            const auto j = static_cast<Index>(n / width);
            if (std::isnan(values[n])) {
                asked(place(n));
            }
            const bool is_side = i == 0 || j == 0 || k == 0 || i == counts_[0] || j == counts_[1] || k == counts_[2];
            if (is_side && values[n] < 0.0) {
                throw UnusableShape("the bounds cut the solid at " + text_of(place(n)) +
                                    ", where the function is negative: choose larger bounds (inside is negative)");
            }
        }
        return values;
    }

    std::function<double(const Point&)> function_;
    Box bounds_;
    double step_;
    double rounding_;                // of coordinates
    std::array<Index, 3> counts_{};  // cells along each axis
    Lattice lattice_;
    NearCells near_;
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
