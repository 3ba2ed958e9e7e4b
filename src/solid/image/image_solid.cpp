// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/shape.hpp"
#include "shapes/bracketed_root.hpp"
#include "shapes/canonical_image.hpp"
#include "shapes/lattice.hpp"
#include "shapes/trilinear.hpp"

namespace scaleaxis {
namespace {

// Of the solid's box, in voxels. Tips lie on the edges of the lattice, and are found.
constexpr double kMargin = 0.1;

/// The values of a cubic polynomial along a segment as the coefficients of its Bézier form.
using Cubic = std::array<double, 4>;

double value_of(const Cubic& b, double t) {
    const double p = mixed(b[0], b[1], t), q = mixed(b[1], b[2], t), r = mixed(b[2], b[3], t);
    return mixed(mixed(p, q, t), mixed(q, r, t), t);
}

int sign_changes(const Cubic& b) {
    int count = 0;
    for (int i = 0; i < 3; ++i) {
        count += (b[i] < 0.0) != (b[i + 1] < 0.0) ? 1 : 0;
    }
    return count;
}

/// Calls `found(t)` for every zero between `begin` and `end`, which are the ends of `b`. There are as many sign changes
/// along the cubic as are found, or fewer by an even number: those closer to each other than rounding can tell.
template <class Found>
void find_zeros(const Cubic& b, double begin, double end, const Found& found) {
    const int changes = sign_changes(b);
    if (changes == 0) {
        return;
    }
    const double middle = 0.5 * (begin + end);
    if (changes == 1 || middle <= begin || middle >= end) {
        if ((b[0] < 0.0) != (b[3] < 0.0)) {
            const double t = bracketed_root([&](double x) { return value_of(b, x); }, 0.0, 1.0, b[0], b[3]);
            found(begin + t * (end - begin));
        }
        return;
    }
    const double p = mixed(b[0], b[1], 0.5), q = mixed(b[1], b[2], 0.5), r = mixed(b[2], b[3], 0.5);
    const double u = mixed(p, q, 0.5), v = mixed(q, r, 0.5);
    const double w = mixed(u, v, 0.5);
    find_zeros({b[0], p, u, w}, begin, middle, found);
    find_zeros({w, v, r, b[3]}, middle, end, found);
}

/// An image as the shape asks it: negative inside, and around it another layer of voxels that are outside.
struct Field {
    std::array<Index, 3> sizes{};
    Lattice lattice;
    std::vector<float> values;

    std::size_t place(const Cell& cell) const {
        return (static_cast<std::size_t>(cell[2]) * sizes[1] + cell[1]) * sizes[0] + cell[0];
    }
    /// Values at the corners of a cell, that of bit 0 along x and so on.
    std::array<float, 8> corners(const Cell& cell) const {
        const float* v = values.data() + place(cell);
        const std::size_t row = sizes[0];
        const std::size_t slice = row * sizes[1];
        return {v[0], v[1], v[row], v[row + 1], v[slice], v[slice + 1], v[slice + row], v[slice + row + 1]};
    }
};

bool has_one_sign(const std::array<float, 8>& v) {
    const bool is_inside = v[0] < 0.0F;
    return std::all_of(v.begin(), v.end(), [=](float value) { return (value < 0.0F) == is_inside; });
}

/// The interpolant along the segment between two points of a cell.
Cubic along(const std::array<float, 8>& v, const std::array<double, 3>& p, const std::array<double, 3>& q) {
    const auto f = [&](double x, double y, double z) { return interpolated(v, {x, y, z}); };
    return {f(p[0], p[1], p[2]), (f(q[0], p[1], p[2]) + f(p[0], q[1], p[2]) + f(p[0], p[1], q[2])) / 3.0,
            (f(p[0], q[1], q[2]) + f(q[0], p[1], q[2]) + f(q[0], q[1], p[2])) / 3.0, f(q[0], q[1], q[2])};
}

/// The part of the image with voxels inside and one more around, which the surface cannot leave. Beyond the border of
/// the image there is a layer of voxels with the values at the border, turned outward: so the solid ends half way.
Field field_of(const Image& image, const Level& level) {
    const auto iso = static_cast<float>(level.iso);
    const float sign = level.is_below ? 1.0F : -1.0F;
    const auto& [width, height, depth] = image.sizes;
    const auto is_inside = [=](float value) { return sign * (value - iso) < 0.0F; };
    std::array<Index, 3> low{width, height, depth};
    std::array<Index, 3> high{-1, -1, -1};
    std::size_t count = 0;
    const float* row = image.values.data();
    for (Index k = 0; k < depth; ++k) {
        for (Index j = 0; j < height; ++j, row += width) {
            Index inside = 0;
            for (Index i = 0; i < width; ++i) {
                inside += is_inside(row[i]) ? 1 : 0;
            }
            if (inside > 0) {
                count += inside;
                Index first = 0;
                while (!is_inside(row[first])) {
                    ++first;
                }
                Index last = width - 1;
                while (!is_inside(row[last])) {
                    --last;
                }
                low = {std::min(low[0], first), std::min(low[1], j), std::min(low[2], k)};
                high = {std::max(high[0], last), std::max(high[1], j), std::max(high[2], k)};
            }
        }
    }
    if (count == 0 || count == image.values.size()) {
        const auto [least, most] = std::ranges::minmax_element(image.values);
        std::ostringstream text;
        text << (count == 0 ? "no voxel is " : "all voxels are ") << (level.is_below ? "below " : "above ") << level.iso
             << ": the values are " << *least << " ... " << *most;
        throw UnusableShape(text.str());
    }
    Field field;
    field.lattice = {image.origin, image.steps};
    for (int axis = 0; axis < 3; ++axis) {
        --low[axis];
        ++high[axis];
        field.lattice.origin = field.lattice.origin + static_cast<double>(low[axis]) * image.steps[axis];
        field.sizes[axis] = high[axis] - low[axis] + 1;
    }
    field.values.reserve(static_cast<std::size_t>(field.sizes[0]) * field.sizes[1] * field.sizes[2]);
    for (Index k = low[2]; k <= high[2]; ++k) {
        for (Index j = low[1]; j <= high[1]; ++j) {
            const Index j_inside = std::clamp<Index>(j, 0, height - 1);
            const Index k_inside = std::clamp<Index>(k, 0, depth - 1);
            const float* from = image.values.data() + (static_cast<std::size_t>(k_inside) * height + j_inside) * width;
            for (Index i = low[0]; i <= high[0]; ++i) {
                constexpr float kMost = 1e30F;
                const float value = std::clamp(sign * (from[std::clamp<Index>(i, 0, width - 1)] - iso), -kMost, kMost);
                const bool is_beyond = j != j_inside || k != k_inside || i < 0 || i >= width;
                field.values.push_back(is_beyond ? std::abs(value) : value);
            }
        }
    }
    return field;
}

class ImageShape final : public Shape {
   public:
    explicit ImageShape(Field field) : field_(std::move(field)) {
        const auto& [a, b, c] = field_.lattice.steps;
        const double volume = dot(a, cross(b, c));
        to_index_ = {(1.0 / volume) * cross(b, c), (1.0 / volume) * cross(c, a), (1.0 / volume) * cross(a, b)};
        find_cells();
        landmarks_ = landmark_points(field_.lattice, cells_, root_in_cell());
        box_ = extent_of(field_.lattice, cells_, landmarks_, root_in_cell(), kMargin);
    }

    Box bounds() const override { return box_; }

    bool inside(const Point& p) const override {
        const std::array<double, 3> index = index_of(p);
        return is_within(index) && value(cell_of(index), index) < 0.0;
    }

    // Through the lattice from cell to cell.
    std::optional<Point> crossing(const Point& inside_end, const Point& outside_end,
                                  const Point& reference) const override {
        const std::array<double, 3> begin = index_of(inside_end);
        const std::array<double, 3> end = index_of(outside_end);
        if (!is_within(begin)) {
            return std::nullopt;
        }
        Cell cell = cell_of(begin);
        std::array<double, 3> from = local(cell, begin);
        bool is_inside = interpolated(field_.corners(cell), {from[0], from[1], from[2]}) < 0.0;
        if (!is_inside) {
            return std::nullopt;
        }
        const Point direction = outside_end - inside_end;
        std::optional<Point> farthest;
        const auto found = [&](double t) {
            const Point p = inside_end + t * direction;
            if (!farthest || squared_distance(p, reference) > squared_distance(*farthest, reference)) {
                farthest = p;
            }
        };
        double t = 0.0;
        while (true) {
            // The next side of the cell, if the segment does not end before.
            int axis = -1;
            double exit = 1.0;
            for (int k = 0; k < 3; ++k) {
                const double step = end[k] - begin[k];
                if (step != 0.0) {
                    const double side = cell[k] + (step > 0.0 ? 1.0 : 0.0);
                    const double at = std::max(t, (side - begin[k]) / step);
                    if (at < exit) {
                        exit = at;
                        axis = k;
                    }
                }
            }
            std::array<double, 3> to = end;
            if (axis >= 0) {
                for (int k = 0; k < 3; ++k) {
                    to[k] = begin[k] + exit * (end[k] - begin[k]);
                }
            }
            to = local(cell, to);
            const bool is_upward = axis >= 0 && end[axis] > begin[axis];
            if (axis >= 0) {
                to[axis] = is_upward ? 1.0 : 0.0;
            }
            const std::array<float, 8> corners = field_.corners(cell);
            if (has_one_sign(corners)) {
                is_inside = corners[0] < 0.0F;
            } else {
                Cubic cubic = along(corners, from, to);
                if ((cubic[0] < 0.0) != is_inside) {  // rounding differs from that in the cell before
                    cubic[0] = is_inside ? -std::numeric_limits<double>::denorm_min() : 0.0;
                }
                find_zeros(cubic, t, exit, found);
                is_inside = cubic[3] < 0.0;
            }
            t = exit;
            if (axis < 0) {
                break;
            }
            cell[axis] += is_upward ? 1 : -1;
            if (cell[axis] < 0 || cell[axis] > field_.sizes[axis] - 2) {
                break;
            }
            from = to;
            from[axis] = is_upward ? 0.0 : 1.0;
        }
        return is_inside ? std::nullopt : farthest;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return kernel::in_arena(execution, [&] {
            std::vector<Point> points =
                points_on_lines(field_.lattice, cells_, kSeedLines / (spacing * spacing), seed, root_in_cell());
            kernel::append(points, landmarks_);
            return points;
        });
    }

   private:
    std::array<double, 3> index_of(const Point& p) const {
        const Point from_origin = p - field_.lattice.origin;
        return {dot(to_index_[0], from_origin), dot(to_index_[1], from_origin), dot(to_index_[2], from_origin)};
    }

    bool is_within(const std::array<double, 3>& index) const {
        for (int k = 0; k < 3; ++k) {
            if (!(index[k] >= 0.0 && index[k] <= field_.sizes[k] - 1)) {
                return false;
            }
        }
        return true;
    }

    Cell cell_of(const std::array<double, 3>& index) const {
        Cell cell{};
        for (int k = 0; k < 3; ++k) {
            cell[k] = std::min(static_cast<Index>(index[k]), field_.sizes[k] - 2);
        }
        return cell;
    }

    static std::array<double, 3> local(const Cell& cell, const std::array<double, 3>& index) {
        std::array<double, 3> result{};
        for (int k = 0; k < 3; ++k) {
            result[k] = std::clamp(index[k] - cell[k], 0.0, 1.0);
        }
        return result;
    }

    double value(const Cell& cell, const std::array<double, 3>& index) const {
        const std::array<double, 3> p = local(cell, index);
        return interpolated(field_.corners(cell), {p[0], p[1], p[2]});
    }

    /// Along an edge of the lattice, or a line parallel to one, the interpolant is linear.
    RootInCell root_in_cell() const {
        return [this](const Cell& cell, int axis, const Point& p) -> std::optional<double> {
            std::array<double, 3> place{p.x - cell[0], p.y - cell[1], p.z - cell[2]};
            const std::array<float, 8> corners = field_.corners(cell);
            const auto value_at = [&](double position) {
                place[axis] = position;
                return interpolated(corners, {place[0], place[1], place[2]});
            };
            const double before = value_at(0.0);
            const double after = value_at(1.0);
            if ((before < 0.0) == (after < 0.0)) {
                return std::nullopt;
            }
            return cell[axis] + before / (before - after);
        };
    }

    /// The cells whose corners are not all on one side: no other can have a part of the surface.
    void find_cells() {
        const auto& [width, height, depth] = field_.sizes;
        const std::size_t slice = static_cast<std::size_t>(width) * height;
        cells_ = kernel::collect<std::vector<SurfaceCell>>(
            depth - 1,
            [&, width = width, height = height](Index k, std::vector<SurfaceCell>& out) {
                std::vector<std::uint8_t> inside(width);  // bits of the four values beside each other
                for (Index j = 0; j + 1 < height; ++j) {
                    const float* row = field_.values.data() + k * slice + static_cast<std::size_t>(j) * width;
                    int all = 0;
                    for (Index i = 0; i < width; ++i) {
                        const int corners = (row[i] < 0.0F ? 1 : 0) | (row[i + width] < 0.0F ? 4 : 0) |
                                            (row[i + slice] < 0.0F ? 16 : 0) | (row[i + slice + width] < 0.0F ? 64 : 0);
                        inside[i] = static_cast<std::uint8_t>(corners);
                        all |= corners;
                    }
                    for (Index i = 0; all != 0 && i + 1 < width; ++i) {
                        if (const int corners = inside[i] | inside[i + 1] << 1; corners != 0 && corners != 255) {
                            out.push_back({{i, j, k}, static_cast<std::uint8_t>(corners)});
                        }
                    }
                }
            },
            Index{1});
    }

    Field field_;
    std::array<Point, 3> to_index_;
    std::vector<SurfaceCell> cells_;  // that the boundary passes
    std::vector<Point> landmarks_;
    Box box_;
};

}  // namespace

std::unique_ptr<Shape> image_shape(Image image, const Level& level, const Execution& execution) {
    check(image);
    if (!std::isfinite(level.iso)) {
        throw InvalidOption("the level of an image must be a finite number");
    }
    return kernel::in_arena(execution, [&] {
        kernel::report(execution, "image", 0.0);
        Field field = field_of(canonical(std::move(image)), level);
        return std::make_unique<ImageShape>(std::move(field));
    });
}

}  // namespace scaleaxis
