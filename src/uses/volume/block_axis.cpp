// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "axis/complex.hpp"
#include "axis/exact_axis.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/vectors.hpp"
#include "delaunay/triangulation.hpp"
#include "sampling/inner_cells.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/ranges.hpp"
#include "scaleaxis/volume.hpp"
#include "solid/image/interpolant_euler.hpp"
#include "solid/zero_set/trilinear.hpp"
#include "spatial/spheres.hpp"

// What a vertex of the axis depends on, from the inside out. R: the largest radius of a ball between samples, s: the
// scale.
//   its own radius ρ ≤ s R:  all vertices of the boundary of the grown union within ρ
//   s R more:                all grown balls that reach there
//   R more:                  their samples
//   2 R more:                the largest ball at each of these, which lies in the solid, and so do its samples
// Tetrahedra whose ball sticks out of the array are not believed; that of a pole can be one of these at samples closer
// to the rim than 2 R only.

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kBlockStage = "block";

// Faces are as large as samples are apart, but for those between few large balls: these ask for more.
constexpr double kFaceSlack = 3.0;

// A ball between samples is larger than the depth of the voxel nearest to its centre by less than half the diagonal of
// a voxel to the voxel's centre, and from a crossing of the surface to a sample, which is in the same cell, the whole
// one.
double largest_radius(double depth) { return depth + 1.5 * std::numbers::sqrt3 + 10.0 * kNegligible; }

/// How far from the rim of the array the boundary of the grown union is known.
double unknown_margin(double radius, double scale) { return (scale + 3.0) * radius + 1.0; }

std::uint64_t key_of(const Point& p) {
    return random_bits(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
                       std::bit_cast<std::uint64_t>(p.z));
}

auto order_of(const Point& p) { return std::array{p.x, p.y, p.z}; }
bool is_less(const Point& a, const Point& b) { return order_of(a) < order_of(b); }

/// The values of a block at places of the volume.
class BlockField {
   public:
    BlockField(const VolumeBlock& block, std::span<const float> values) : block_(block), values_(values) {}

    float at(Index i, Index j, Index k) const {
        return values_[(static_cast<std::size_t>(k) * block_.sizes[1] + j) * block_.sizes[0] + i];
    }

    /// Is a place inside the solid? The place within a cell is exact, whatever the block.
    bool is_inside(const Point& p) const {
        const std::array<double, 3> place = order_of(p);
        std::array<Index, 3> cell{};
        std::array<double, 3> within{};
        for (int axis = 0; axis < 3; ++axis) {
            const double floor = std::floor(place[axis]);
            const double index = floor - static_cast<double>(block_.origin[axis]);
            if (!(index >= 0.0 && index <= block_.sizes[axis] - 2)) {
                return false;
            }
            cell[axis] = static_cast<Index>(index);
            within[axis] = place[axis] - floor;
        }
        return interpolated(corners(cell), {within[0], within[1], within[2]}) < 0.0;
    }

    std::array<float, 8> corners(const std::array<Index, 3>& cell) const {
        std::array<float, 8> corners{};
        for (int c = 0; c < 8; ++c) {
            corners[c] = at(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2));
        }
        return corners;
    }

   private:
    const VolumeBlock& block_;
    std::span<const float> values_;
};

/// Where it is known what is inside.
Box box_of_known(const VolumeBlock& block) {
    std::array<double, 6> ends{};
    for (int axis = 0; axis < 3; ++axis) {
        ends[axis] = block.ends_low(axis) ? -kInfinity : static_cast<double>(block.known_low(axis));
        ends[3 + axis] = block.ends_high(axis) ? kInfinity : static_cast<double>(block.known_high(axis) - 1);
    }
    return {{ends[0], ends[1], ends[2]}, {ends[3], ends[4], ends[5]}};
}

Box box_of_core(const VolumeBlock& block) {
    std::array<double, 6> ends{};
    for (int axis = 0; axis < 3; ++axis) {
        ends[axis] = block.core_low[axis] <= 0 ? -kInfinity : static_cast<double>(block.core_low[axis]);
        ends[3 + axis] =
            block.core_high[axis] >= block.volume[axis] ? kInfinity : static_cast<double>(block.core_high[axis]);
    }
    return {{ends[0], ends[1], ends[2]}, {ends[3], ends[4], ends[5]}};
}

/// Of the box, the low sides belong to it and the high ones do not.
bool owns(const Box& box, const Point& p) {
    return p.x >= box.min.x && p.y >= box.min.y && p.z >= box.min.z && p.x < box.max.x && p.y < box.max.y &&
           p.z < box.max.z;
}

double distance_to(const Box& box, const Point& p) {
    return norm({std::max({box.min.x - p.x, p.x - box.max.x, 0.0}), std::max({box.min.y - p.y, p.y - box.max.y, 0.0}),
                 std::max({box.min.z - p.z, p.z - box.max.z, 0.0})});
}

bool contains(const Box& box, const Ball& ball) {
    const auto& [c, r] = ball;
    return c.x - r > box.min.x && c.y - r > box.min.y && c.z - r > box.min.z && c.x + r < box.max.x &&
           c.y + r < box.max.y && c.z + r < box.max.z;
}

/// How far the core is from what is not known, at least.
double halo_of(const VolumeBlock& block) {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (int axis = 0; axis < 3; ++axis) {
        least = block.ends_low(axis) ? least : std::min(least, block.core_low[axis] - block.known_low(axis));
        least = block.ends_high(axis) ? least : std::min(least, block.known_high(axis) - 1 - block.core_high[axis]);
    }
    return least == std::numeric_limits<std::int64_t>::max() ? kInfinity : static_cast<double>(least);
}

/// Where the edges of the lattice cross the boundary, ascending.
std::vector<Point> lattice_samples(const VolumeBlock& block, const BlockField& field, std::uint64_t seed) {
    std::vector<Point> samples = collect<std::vector<Point>>(
        block.sizes[2],
        [&](Index k, std::vector<Point>& out) {
            for (Index j = 0; j < block.sizes[1]; ++j) {
                for (Index i = 0; i < block.sizes[0]; ++i) {
                    const float here = field.at(i, j, k);
                    for (int axis = 0; axis < 3; ++axis) {
                        std::array<Index, 3> next{i, j, k};
                        if (++next[axis] == block.sizes[axis]) {
                            continue;
                        }
                        const float there = field.at(next[0], next[1], next[2]);
                        if ((here < 0.0F) == (there < 0.0F)) {
                            continue;
                        }
                        std::array<double, 3> place{static_cast<double>(block.origin[0] + i),
                                                    static_cast<double>(block.origin[1] + j),
                                                    static_cast<double>(block.origin[2] + k)};
                        const std::uint64_t key =
                            random_bits(key_of({place[0], place[1], place[2]}), static_cast<std::uint64_t>(axis));
                        place[axis] += double{here} / (double{here} - double{there});
                        // Samples of masks lie on planes and on spheres together, and where exact arithmetic has to
                        // break ties, there are many: they are moved by a million times what the predicates need.
                        out.push_back(Point{place[0], place[1], place[2]} + kNegligible * random_direction(seed, key));
                    }
                }
            }
        },
        Index{1});
    tasks::parallel_sort(samples.begin(), samples.end(), is_less);
    return samples;
}

/// The Delaunay tetrahedra of the samples; inside are those with their centre in the solid, and their ball where that
/// is known.
struct BlockCells {
    Triangulation triangulation;
    std::vector<Circumsphere> spheres;  // of infinite radius: not inside

    Index size() const { return static_cast<Index>(spheres.size()); }
    bool is_inside(Index cell) const { return spheres[cell].radius < kInfinity; }
    const std::array<Index, 4>& vertices(Index cell) const { return triangulation.cells[cell].vertices; }
    Ball ball(Index cell) const { return {spheres[cell].center, spheres[cell].radius}; }
    bool is_larger(Index cell, Index other) const { return spheres[cell].radius > spheres[other].radius; }
};

BlockCells cells_of(const VolumeBlock& block, const BlockField& field, std::span<const Point> samples) {
    BlockCells cells;
    cells.triangulation = triangulate(samples);
    cells.spheres.resize(cells.triangulation.size());
    const Box box = box_of_known(block);
    for_each_index(cells.triangulation.size(), [&](std::size_t c) {
        const Triangulation& t = cells.triangulation;
        const std::array<Index, 4>& v = t.cells[c].vertices;
        Circumsphere& sphere = cells.spheres[c];
        sphere.radius = kInfinity;
        if (is_ghost(v[0])) {  // they come first
            return;
        }
        const Circumsphere found =
            circumsphere(t.point(v[0]), t.point(v[1]), t.point(v[2]), t.point(v[3]), box.diagonal());
        if (contains(box, {found.center, found.radius}) && field.is_inside(found.center)) {
            sphere = found;
        }
    });
    return cells;
}

/// The balls of the union whose grown ones come within `reach` of the core, ascending by place.
std::vector<Ball> balls_near(const Box& core, const BlockCells& cells, std::size_t samples, double scale,
                             double reach) {
    std::vector<Ball> balls = balls_of_cells(cells, samples);
    std::erase_if(balls, [&](const Ball& ball) {
        return distance_to(core, ball.center) > scale * (1.0 + kPerturbationRange.max) * ball.radius + reach;
    });
    tasks::parallel_sort(balls.begin(), balls.end(), [](const Ball& a, const Ball& b) {
        return std::pair(order_of(a.center), a.radius) < std::pair(order_of(b.center), b.radius);
    });
    balls.erase(std::unique(balls.begin(), balls.end()), balls.end());
    return balls;
}

/// The union of grown balls, and its boundary vertices in the order of their places: that of their triangles depends on
/// tetrahedra which reach far.
UnionComplex union_of(std::vector<Ball> balls, const VolumeAxisOptions& options) {
    for (Ball& ball : balls) {
        ball.center = ball.center + (options.move * ball.radius) * random_direction(options.seed, key_of(ball.center));
        ball.radius *= options.scale;
    }
    UnionComplex parts;
    parts.balls = std::move(balls);
    parts.dual = dual_complex(parts.balls);
    const BoundaryVertices found = boundary_vertices(parts.dual, parts.balls);
    std::vector<Index> order(found.points.size());
    std::iota(order.begin(), order.end(), 0);
    tasks::parallel_sort(order.begin(), order.end(), [&](Index a, Index b) {
        return std::pair(order_of(found.points[a]), found.balls[a]) <
               std::pair(order_of(found.points[b]), found.balls[b]);
    });
    const std::vector<Index> rank = places_in(order);
    for (const Index i : order) {
        parts.vertices.points.push_back(found.points[i]);
        parts.vertices.balls.push_back(found.balls[i]);
    }
    for (const auto& [a, b] : found.pairs) {
        parts.vertices.pairs.push_back({std::min(rank[a], rank[b]), std::max(rank[a], rank[b])});
    }
    return parts;
}

/// A polygon from its least vertex on, in the direction of the less of the two beside it.
std::vector<Index> turned(std::span<const Index> polygon, const std::vector<Index>& rank) {
    auto result = each_of<Index>(polygon, [&](Index v) { return rank[v]; });
    std::rotate(result.begin(), std::ranges::min_element(result), result.end());
    if (result[1] > result.back()) {
        std::reverse(result.begin() + 1, result.end());
    }
    return result;
}

/// What the core owns of an axis.
void take_owned(VolumePart& part, const MedialComplex& complex, const VolumeBlock& block, double scale) {
    const auto count = static_cast<Index>(complex.vertices.size());
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), 0);
    tasks::parallel_sort(order.begin(), order.end(),
                         [&](Index a, Index b) { return is_less(complex.vertices[a], complex.vertices[b]); });
    const std::vector<Index> rank = places_in(order);
    const Box core = box_of_core(block);
    std::vector<std::uint8_t> is_owned(count);  // by rank
    for (Index i = 0; i < count; ++i) {
        is_owned[i] = owns(core, complex.vertices[order[i]]) ? 1 : 0;
    }
    std::vector<Index> number(count, kNone);  // by rank: 0 for what is used, at first
    part.euler = std::accumulate(is_owned.begin(), is_owned.end(), std::int64_t{0});
    std::vector<Index> faces;
    std::vector<std::vector<Index>> polygons;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        std::vector<Index> polygon = turned(complex.faces[f], rank);
        if (is_owned[polygon[0]] != 0) {
            ++part.euler;
            for (const Index v : polygon) {
                number[v] = 0;
            }
            faces.push_back(static_cast<Index>(polygons.size()));
            polygons.push_back(std::move(polygon));
            const auto& [a, b] = complex.face_contacts[f];
            part.angles.push_back(0.0);
            polygons.back().push_back(std::min(a, b));
            polygons.back().push_back(std::max(a, b));
        }
    }
    const std::vector<std::uint8_t> has_face = edges_with_faces(complex);
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto [a, b] = std::minmax(rank[complex.edges[e][0]], rank[complex.edges[e][1]]);
        if (is_owned[a] != 0) {
            --part.euler;
            if (has_face[e] == 0) {
                part.curves.push_back({a, b});
                number[a] = number[b] = 0;
            }
        }
    }
    for (const Index v : isolated_vertices(complex)) {
        number[rank[v]] = is_owned[rank[v]] != 0 ? 0 : kNone;
    }
    double reach = 0.0;
    for (Index i = 0; i < count; ++i) {
        if (number[i] != kNone) {
            const Point& vertex = complex.vertices[order[i]];
            const double radius = complex.radii[order[i]];
            number[i] = static_cast<Index>(part.vertices.size());
            part.vertices.push_back(vertex);
            part.radii.push_back(radius / scale);
            reach = std::max(reach, distance_to(core, vertex) + radius);
        }
    }
    part.halo += reach;
    for (std::vector<Index>& polygon : polygons) {
        for (std::size_t k = 0; k + 2 < polygon.size(); ++k) {
            polygon[k] = number[polygon[k]];
        }
    }
    std::ranges::sort(faces, {}, [&](Index f) -> const std::vector<Index>& { return polygons[f]; });
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const std::vector<Index>& polygon = polygons[faces[f]];
        const std::span<const Index> corners(polygon.data(), polygon.size() - 2);
        part.faces.push_back(corners);
        part.angles[f] = object_angle(part.vertices, corners, complex.boundary_vertices[polygon[corners.size()]],
                                      complex.boundary_vertices[polygon.back()]);
    }
    for (std::array<Index, 2>& edge : part.curves) {
        edge = {number[edge[0]], number[edge[1]]};
    }
    std::ranges::sort(part.curves);
}

std::int64_t solid_euler(const VolumeBlock& block, std::span<const float> values) {
    std::array<Index, 3> low{};
    std::array<Index, 3> high{};
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t last = block.sizes[axis] - 1;
        const auto within = [&](std::int64_t voxel) {
            return static_cast<Index>(std::clamp<std::int64_t>(voxel - block.origin[axis], 0, last));
        };
        low[axis] = block.core_low[axis] <= 0 ? 0 : within(block.core_low[axis]);
        high[axis] =
            block.core_high[axis] >= block.volume[axis] ? block.sizes[axis] - 1 : within(block.core_high[axis]);
        if (low[axis] >= high[axis]) {  // it lies where nothing is inside
            return 0;
        }
    }
    return interpolant_euler(block.sizes, values, low, high);
}

void check_block(const VolumeBlock& block, std::span<const float> values, const VolumeAxisOptions& options) {
    check_scale(options.scale);
    std::size_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (block.sizes[axis] < 2 || block.empty_before[axis] < 0 || block.empty_after[axis] < 0 ||
            block.core_low[axis] < block.known_low(axis) || block.core_high[axis] > block.known_high(axis) ||
            block.core_low[axis] >= block.core_high[axis]) {
            throw InvalidOption(
                "the core of a block must lie where it is known what is inside, and its array has at least two voxels "
                "along an axis");
        }
        count *= static_cast<std::size_t>(block.sizes[axis]);
    }
    require(values.size() == count, "a block needs as many values as its sizes say");
    require(kPerturbationRange.contains(options.move), "balls are moved by 0 to 0.01 radii");
    require(options.largest_depth >= 0.0, "the largest depth must be a number of at least 0");
}

}  // namespace

double halo_of_axis(double core_depth, double largest_depth, double scale) {
    return scale * largest_radius(core_depth) + kFaceSlack + unknown_margin(largest_radius(largest_depth), scale);
}

VolumePart axis_of_block(const VolumeBlock& block, std::span<const float> values, const VolumeAxisOptions& options,
                         const Execution& execution) {
    check_block(block, values, options);
    return in_arena(execution, [&] {
        report(execution, kBlockStage, 0.0);
        const BlockField field(block, values);
        VolumePart part;
        part.solid_euler = solid_euler(block, values);
        const double margin = unknown_margin(largest_radius(options.largest_depth), options.scale);
        const double halo = halo_of(block);
        part.halo = margin;
        if (halo <= margin) {
            return part;
        }
        std::vector<Ball> balls;
        {
            const std::vector<Point> samples = lattice_samples(block, field, options.seed);
            part.samples = std::ssize(samples);
            report(execution, kBlockStage, 0.1);
            if (samples.empty()) {
                part.is_certain = true;
                return part;
            }
            const BlockCells cells = cells_of(block, field, samples);
            report(execution, kBlockStage, 0.4);
            balls = balls_near(box_of_core(block), cells, samples.size(), options.scale, halo - margin);
        }
        part.balls = std::ssize(balls);
        if (balls.empty()) {
            part.is_certain = true;
            return part;
        }
        const UnionComplex parts = union_of(std::move(balls), options);
        report(execution, kBlockStage, 0.6);
        const std::optional<ExactAxis> axis =
            exact_axis(parts, [&](double done) { report(execution, kBlockStage, 0.6 + 0.4 * done); });
        if (!axis) {
            throw InconsistentResult(
                "rounding has changed the topology of the axis of a block: move balls more, in all blocks, or try "
                "another seed");
        }
        take_owned(part, axis->complex, block, options.scale);
        part.is_certain = part.halo <= halo;
        report(execution, kBlockStage, 1.0);
        return part;
    });
}

}  // namespace scaleaxis::inline v1
