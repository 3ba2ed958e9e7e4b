// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/built_once.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/image/canonical_image.hpp"
#include "solid/image/interpolant_topology.hpp"
#include "solid/pointwise_solid.hpp"
#include "solid/zero_set/bracketed_root.hpp"
#include "solid/zero_set/farthest_point.hpp"
#include "solid/zero_set/foot_search.hpp"
#include "solid/zero_set/lattice.hpp"
#include "solid/zero_set/near_points.hpp"
#include "solid/zero_set/surface_net.hpp"
#include "solid/zero_set/trilinear.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kImageStage = "image";

// Margin of the solid's box, in voxels. Tips lie on the edges of the lattice, and are found.
constexpr double kImageMargin = 0.1;

/// The values of a cubic polynomial along a segment as the coefficients of its Bézier form.
using Cubic = std::array<double, 4>;

double value_of(const Cubic& b, double t) {
    const double p = lerp(b[0], b[1], t), q = lerp(b[1], b[2], t), r = lerp(b[2], b[3], t);
    return lerp(lerp(p, q, t), lerp(q, r, t), t);
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
    const double p = lerp(b[0], b[1], 0.5), q = lerp(b[1], b[2], 0.5), r = lerp(b[2], b[3], 0.5);
    const double u = lerp(p, q, 0.5), v = lerp(q, r, 0.5);
    const double w = lerp(u, v, 0.5);
    find_zeros({b[0], p, u, w}, begin, middle, found);
    find_zeros({w, v, r, b[3]}, middle, end, found);
}

/// An image as the solid asks for it: negative inside, and around it another layer of voxels that are outside.
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

/// The cells whose corners are not all on one side: no other can have a part of the surface.
std::vector<SurfaceCell> surface_cells(const Field& field) {
    const auto& [width, height, depth] = field.sizes;
    const std::size_t slice = static_cast<std::size_t>(width) * height;
    const auto has_inside =
        mapped<std::uint8_t>(static_cast<std::size_t>(height) * depth, [&, width = width](std::size_t row) {
            const float* const values = field.values.data() + row * width;
            int count = 0;
            for (Index i = 0; i < width; ++i) {
                count += values[i] < 0.0F ? 1 : 0;
            }
            return static_cast<std::uint8_t>(count > 0 ? 1 : 0);
        });
    return collect<std::vector<SurfaceCell>>(
        depth - 1,
        [&, width = width, height = height](Index k, std::vector<SurfaceCell>& out) {
            std::vector<std::uint8_t> inside(width);  // bits of the four values beside each other
            for (Index j = 0; j + 1 < height; ++j) {
                const std::uint8_t* const rows = has_inside.data() + static_cast<std::size_t>(k) * height + j;
                if ((rows[0] | rows[1] | rows[height] | rows[height + 1]) == 0) {
                    continue;
                }
                const float* row = field.values.data() + k * slice + static_cast<std::size_t>(j) * width;
                for (Index i = 0; i < width; ++i) {
                    inside[i] = static_cast<std::uint8_t>((row[i] < 0.0F ? 1 : 0) | (row[i + width] < 0.0F ? 4 : 0) |
                                                          (row[i + slice] < 0.0F ? 16 : 0) |
                                                          (row[i + slice + width] < 0.0F ? 64 : 0));
                }
                for (Index i = 0; i + 1 < width; ++i) {
                    if (const int corners = inside[i] | inside[i + 1] << 1; corners != 0 && corners != 255) {
                        out.push_back({{i, j, k}, static_cast<std::uint8_t>(corners)});
                    }
                }
            }
        },
        Index{1});
}

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

/// The voxels inside. \throws UnusableInput if these are none, or all of an image whose values differ: then the level
/// is beside them. All of one value are a mask that fills its image, which is closed at the border.
template <class Predicate>
InsideVoxels solid_voxels(const ImageView& image, const CanonicalImage& canonical, const Level& level,
                          const Predicate& is_inside) {
    const InsideVoxels inside = inside_voxels(canonical, is_inside);
    if (inside.count != 0 && inside.count != std::ssize(image.values)) {
        return inside;
    }
    if (const auto [least, most] = std::ranges::minmax(image.values); inside.count == 0 || least < most) {
        Words text;
        text << (inside.count == 0 ? "no voxel is " : "all voxels are ") << (level.is_below ? "below " : "above ")
             << level.iso << ": the values are " << least << " ... " << most;
        throw UnusableInput(text.str());
    }
    return inside;
}

/// The part of the image with voxels inside and one more around, which the surface cannot leave. Beyond the border of
/// the image there is a layer of voxels with the values at the border, turned outward: so the solid ends half way.
Field field_of(const ImageView& view, const Level& level) {
    const CanonicalImage image = canonical(view);
    const auto iso = static_cast<float>(level.iso);
    const float sign = level.is_below ? 1.0F : -1.0F;
    auto [count, low, high] =
        solid_voxels(view, image, level, [=](float value) { return sign * (value - iso) < 0.0F; });
    Field field;
    field.lattice = {image.origin, image.steps};
    for (int axis = 0; axis < 3; ++axis) {
        --low[axis];
        ++high[axis];
        field.lattice.origin = field.lattice.origin + static_cast<double>(low[axis]) * image.steps[axis];
        field.sizes[axis] = high[axis] - low[axis] + 1;
    }
    const auto& [width, height, depth] = image.sizes;
    field.values.reserve(static_cast<std::size_t>(field.sizes[0]) * field.sizes[1] * field.sizes[2]);
    std::vector<float> memory;
    for (Index k = low[2]; k <= high[2]; ++k) {
        stop_if_cancelled();
        for (Index j = low[1]; j <= high[1]; ++j) {
            const Index j_inside = std::clamp<Index>(j, 0, height - 1);
            const Index k_inside = std::clamp<Index>(k, 0, depth - 1);
            const std::span<const float> row = image.row(j_inside, k_inside, memory);
            const std::size_t begin = field.values.size();
            field.values.resize(begin + static_cast<std::size_t>(field.sizes[0]));
            const std::span<float> values = std::span(field.values).subspan(begin);
            const auto signed_value = [sign, iso](float value) {
                constexpr float kMost = 1e30F;
                return std::clamp(sign * (value - iso), -kMost, kMost);
            };
            const Index first = std::max<Index>(low[0], 0);
            const Index last = std::min<Index>(high[0], width - 1);
            std::ranges::transform(row.subspan(first, last + 1 - first), values.begin() + (first - low[0]),
                                   signed_value);
            if (low[0] < 0) {
                values.front() = std::abs(signed_value(row[0]));
            }
            if (high[0] >= width) {
                values.back() = std::abs(signed_value(row[width - 1]));
            }
            if (j != j_inside || k != k_inside) {
                std::ranges::transform(values, values.begin(), [](float value) { return std::abs(value); });
            }
        }
    }
    return field;
}

/// Coordinates of a point as those of a lattice, or within one of its cells.
using Coordinates = std::array<double, 3>;

/// A part of a segment that lies in one cell.
struct VoxelPiece {
    Cell cell{};
    Coordinates from{};  ///< within the cell, 0…1
    Coordinates to{};
    double begin = 0.0;  ///< along the segment
    double end = 1.0;
    int axis = -1;  ///< the segment goes on to the next cell along this axis; -1: it ends here
    bool is_upward = false;
};

/// Of coordinates in a lattice those within a cell.
Coordinates within(const Cell& cell, const Coordinates& p) {
    Coordinates result{};
    for (int k = 0; k < 3; ++k) {
        result[k] = std::clamp(p[k] - cell[k], 0.0, 1.0);
    }
    return result;
}

/// The piece of the segment `ab`, in coordinates of the lattice, from `from` to where it leaves the cell or ends.
VoxelPiece piece_in(const Cell& cell, const Coordinates& from, double begin, const Coordinates& a,
                    const Coordinates& b) {
    VoxelPiece piece{.cell = cell, .from = from, .begin = begin};
    for (int k = 0; k < 3; ++k) {
        const double step = b[k] - a[k];
        if (step != 0.0) {
            const double side = cell[k] + (step > 0.0 ? 1.0 : 0.0);
            const double at = std::max(begin, (side - a[k]) / step);
            if (at < piece.end) {
                piece.end = at;
                piece.axis = k;
            }
        }
    }
    if (piece.axis < 0) {
        piece.to = within(cell, b);
        return piece;
    }
    for (int k = 0; k < 3; ++k) {
        piece.to[k] = a[k] + piece.end * (b[k] - a[k]);
    }
    piece.to = within(cell, piece.to);
    piece.is_upward = b[piece.axis] > a[piece.axis];
    piece.to[piece.axis] = piece.is_upward ? 1.0 : 0.0;
    return piece;
}

class ImageSolid final : public PointwiseSolid {
   public:
    ImageSolid(Field field, std::vector<Diagnostic> warnings)
        : field_(std::move(field)), warnings_(std::move(warnings)) {
        const auto& [a, b, c] = field_.lattice.steps;
        const double volume = dot(a, cross(b, c));
        to_index_ = {(1.0 / volume) * cross(b, c), (1.0 / volume) * cross(c, a), (1.0 / volume) * cross(a, b)};
        cells_ = surface_cells(field_);
        topology_ = interpolant_topology(field_.sizes, field_.values, cells_);
        landmarks_ = landmark_points(field_.lattice, cells_, root_in_cell());
        box_ = extent_of(field_.lattice, cells_, landmarks_, root_in_cell(), kImageMargin);
        rounding_ = std::numeric_limits<double>::epsilon() * std::max(norm(box_.min), norm(box_.max));
    }

    Box bounds() const override { return box_; }

    bool is_inside(const Point& p) const override {
        const Coordinates index = index_of(p);
        return is_within(index) && value(cell_of(index), index) < 0.0;
    }

    // Through the lattice from cell to cell.
    std::optional<Point> crossing_of(const Point& inside_end, const Point& outside_end,
                                     const Point& reference) const override {
        const Coordinates a = index_of(inside_end);
        const Coordinates b = index_of(outside_end);
        if (!is_within(a)) {
            return std::nullopt;
        }
        const Cell first = cell_of(a);
        bool is_inside = value(first, a) < 0.0;
        if (!is_inside) {
            return std::nullopt;
        }
        const Point direction = outside_end - inside_end;
        FarthestPoint farthest{reference};
        const auto found = [&](double t) { farthest.add(inside_end + t * direction); };
        VoxelPiece piece = piece_in(first, within(first, a), 0.0, a, b);
        is_inside = follow(piece, is_inside, found);
        while (piece.axis >= 0) {
            Cell cell = piece.cell;
            cell[piece.axis] += piece.is_upward ? 1 : -1;
            if (cell[piece.axis] < 0 || cell[piece.axis] > field_.sizes[piece.axis] - 2) {
                break;
            }
            Coordinates from = piece.to;
            from[piece.axis] = piece.is_upward ? 0.0 : 1.0;
            piece = piece_in(cell, from, piece.end, a, b);
            is_inside = follow(piece, is_inside, found);
        }
        return is_inside ? std::nullopt : farthest.point;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return in_arena(execution, [&] {
            std::vector<Point> points =
                points_on_lines(field_.lattice, cells_, kSeedLines / (spacing * spacing), seed, root_in_cell());
            append(points, landmarks_);
            return points;
        });
    }

    std::optional<Topology> topology() const override { return topology_; }

    std::optional<ThinPart> thin_part() const override {
        for (const SurfaceCell& surface_cell : cells_) {
            const auto& [i, j, k] = surface_cell.cell;
            const Cell voxel{i + 1, j + 1, k + 1};
            if (is_thin(voxel)) {
                const Point place = field_.lattice.at({i + 1.0, j + 1.0, k + 1.0});
                return ThinPart{place, shortest_step(field_.lattice), !is_inside_at(voxel)};
            }
        }
        return std::nullopt;
    }

    std::vector<Diagnostic> warnings() const override { return warnings_; }

    void prepare() const override { net(); }

    std::optional<Point> nearest_to(const Point& p, double bound) const override {
        const std::optional<Point> start = net().start_of_search(p, bound);
        if (!start) {
            return std::nullopt;
        }
        FootSearch search(p, *start, shortest_step(field_.lattice), rounding_, true);
        while (!search.is_done()) {
            const Coordinates index = index_of(search.place());
            if (is_within(index)) {
                const Cell cell = cell_of(index);
                search.tell(value(cell, index), search.wants_gradient() ? slope(cell, index) : Point{});
            } else {
                search.tell(1.0, {});  // outside
            }
        }
        const std::optional<Point>& found = search.result();
        return found && distance(p, *found) < bound ? found : std::nullopt;
    }

   private:
    const NetTree& net() const {
        return net_.get([&] {
            return net_tree(field_.lattice, cells_, net_of_interpolant(field_.lattice, cells_, [&](std::size_t i) {
                                return corner_values(cells_[i].cell);
                            }));
        });
    }

    bool is_inside_at(const Cell& voxel) const { return field_.values[field_.place(voxel)] < 0.0F; }

    /// Is a voxel in no block of 2 x 2 x 2 voxels of its side, in a sheet or wire of these? Along each axis both
    /// neighbours of such are of one side; bumps have a side where they stand.
    bool is_thin(const Cell& voxel) const {
        for (int axis = 0; axis < 3; ++axis) {
            if (voxel[axis] + 1 == field_.sizes[axis]) {
                return false;
            }
            Cell before = voxel;
            Cell after = voxel;
            --before[axis];
            ++after[axis];
            if (is_inside_at(before) != is_inside_at(after)) {
                return false;
            }
        }
        for (int block = 0; block < 8; ++block) {
            const Cell cell{voxel[0] - (block & 1), voxel[1] - (block >> 1 & 1), voxel[2] - (block >> 2)};
            if (has_one_sign(field_.corners(cell))) {
                return false;
            }
        }
        return true;
    }

    CornerValues corner_values(const Cell& cell) const {
        CornerValues values{};
        std::ranges::copy(field_.corners(cell), values.begin());
        return values;
    }

    /// The gradient.
    Point slope(const Cell& cell, const Coordinates& index) const {
        const Coordinates p = within(cell, index);
        const Point by_index = gradient(corner_values(cell), {p[0], p[1], p[2]});
        return by_index.x * to_index_[0] + by_index.y * to_index_[1] + by_index.z * to_index_[2];
    }

    /// Calls `found(t)` for the crossings along a piece that begins inside or not. Returns whether it ends inside.
    template <class Found>
    bool follow(const VoxelPiece& piece, bool is_inside, const Found& found) const {
        const std::array<float, 8> corners = field_.corners(piece.cell);
        if (has_one_sign(corners)) {
            return corners[0] < 0.0F;
        }
        Cubic cubic = along(corners, piece.from, piece.to);
        if ((cubic[0] < 0.0) != is_inside) {  // rounding differs from that in the cell before
            cubic[0] = is_inside ? -std::numeric_limits<double>::denorm_min() : 0.0;
        }
        find_zeros(cubic, piece.begin, piece.end, found);
        return cubic[3] < 0.0;
    }

    Coordinates index_of(const Point& p) const {
        const Point from_origin = p - field_.lattice.origin;
        return {dot(to_index_[0], from_origin), dot(to_index_[1], from_origin), dot(to_index_[2], from_origin)};
    }

    bool is_within(const Coordinates& index) const {
        for (int k = 0; k < 3; ++k) {
            if (!(index[k] >= 0.0 && index[k] <= field_.sizes[k] - 1)) {
                return false;
            }
        }
        return true;
    }

    Cell cell_of(const Coordinates& index) const {
        Cell cell{};
        for (int k = 0; k < 3; ++k) {
            cell[k] = std::min(static_cast<Index>(index[k]), field_.sizes[k] - 2);
        }
        return cell;
    }

    double value(const Cell& cell, const Coordinates& index) const {
        const Coordinates p = within(cell, index);
        return interpolated(field_.corners(cell), {p[0], p[1], p[2]});
    }

    /// Along an edge of the lattice, or a line parallel to one, the interpolant is linear.
    RootInCell root_in_cell() const {
        return [this](const Cell& cell, int axis, const Point& p) -> std::optional<double> {
            Coordinates place{p.x - cell[0], p.y - cell[1], p.z - cell[2]};
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

    Field field_;
    std::array<Point, 3> to_index_;
    std::vector<SurfaceCell> cells_;  // that the boundary passes
    Topology topology_;
    std::vector<Point> landmarks_;
    Box box_;
    double rounding_ = 0.0;  // of coordinates
    std::vector<Diagnostic> warnings_;
    BuiltOnce<NetTree> net_;
};

std::vector<Diagnostic> warnings_of(const ImageView& image, const Level& level) {
    const std::int64_t count = border_voxels(image, level);
    if (count == 0) {
        return {};
    }
    return {{"image.border", "the solid is closed at the border of the image, where it has " + std::to_string(count) +
                                 (count == 1 ? " voxel" : " voxels")}};
}

void check_level(const Level& level) {
    require(std::isfinite(level.iso), "the level of an image must be a finite number");
}

/// See `image_solid`. \param free_image is called as soon as `image` is not needed any more
template <class Free>
std::unique_ptr<Solid> solid_of(const ImageView& image, const Level& level, const Execution& execution,
                                const Free& free_image) {
    check_level(level);
    return in_arena(execution, [&] {
        report(execution, kImageStage, 0.0);
        check(image, execution);
        std::vector<Diagnostic> warnings = warnings_of(image, level);
        report(execution, kImageStage, 0.2);
        Field field = field_of(image, level);
        free_image();
        report(execution, kImageStage, 0.5);
        auto solid = std::make_unique<ImageSolid>(std::move(field), std::move(warnings));
        report(execution, kImageStage, 1.0);
        return solid;
    });
}

}  // namespace

std::unique_ptr<Solid> image_solid(const ImageView& image, const Level& level, const Execution& execution) {
    return solid_of(image, level, execution, [] {});
}

std::unique_ptr<Solid> image_solid(Image image, const Level& level, const Execution& execution) {
    return solid_of(image, level, execution, [&] { image = {}; });
}

Topology topology(const ImageView& image, const Level& level, const Execution& execution) {
    check_level(level);
    return in_arena(execution, [&] {
        check(image, execution);
        const Field field = field_of(image, level);
        return interpolant_topology(field.sizes, field.values, surface_cells(field));
    });
}

}  // namespace scaleaxis::inline v1
