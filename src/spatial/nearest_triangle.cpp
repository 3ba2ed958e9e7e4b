// SPDX-License-Identifier: Apache-2.0
#include "spatial/nearest_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/nearest.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/spatial_order.hpp"

namespace scaleaxis::inline v1 {
namespace {

using TriangleCorners = std::array<Point, 3>;

/// A plane, or a half-plane of it, as in `TriangleBlock`.
struct Side {
    Point normal;
    double offset = 0.0;
};

/// The plane and the three half-planes of a triangle; without area, those of its longest side; of a point none, so
/// that it counts as near always.
std::array<Side, 4> sides_of(const TriangleCorners& corners) {
    const auto& [a, b, c] = corners;
    const std::array<Point, 3> edges{b - a, c - b, a - c};
    const Point longest = *std::ranges::max_element(edges, {}, [](const Point& e) { return squared_norm(e); });
    if (!(squared_norm(longest) > 0.0)) {
        return {};
    }
    const Point along = unit(longest);
    const Point across = cross(b - a, c - a);
    // The direction of a sliver's normal is lost in rounding. What counts is that it is normal to the longest side.
    Point normal = norm(across) > 0.0 ? unit(across) : any_normal_to(along);
    normal = unit(normal - dot(normal, along) * along);
    const auto highest = [&, a = a, b = b, c = c](const Point& direction) {
        return std::max({dot(direction, a), dot(direction, b), dot(direction, c)});
    };
    constexpr double kFlat = 0x1p-24;
    if (!is_finite(normal) || highest(normal) + highest(-1.0 * normal) > kFlat) {
        return {};
    }
    std::array<Side, 4> sides;
    sides[0] = {normal, 0.5 * (highest(normal) - highest(-1.0 * normal))};
    for (int k = 0; k < 3; ++k) {
        const bool has_direction = squared_norm(edges[k]) > 0.0;
        const Point out = cross(has_direction ? edges[k] : longest, normal);
        // Whatever rounding does to the direction, no corner is beyond it.
        const Point direction = norm(out) > 0.0 ? unit(out) : cross(along, normal);
        sides[k + 1] = {direction, highest(direction)};
    }
    return sides;
}

}  // namespace

Point nearest_point(const Point& a, const Point& b, const Point& c, const Point& p) {
    const Point u = b - a;
    const Point v = c - a;
    const Point w = p - a;
    const Point normal = cross(u, v);
    const double square = squared_norm(normal);
    const double at_b = dot(cross(w, v), normal);
    const double at_c = dot(cross(u, w), normal);
    const bool is_over = square > 0.0 && at_b >= 0.0 && at_c >= 0.0 && at_b + at_c <= square;
    const Point foot = is_over ? a + (at_b / square) * u + (at_c / square) * v : a;
    // Over a sliver rounding moves the foot along: then a point of a side may be nearer.
    constexpr double kSliver = 1e-8;
    if (is_over && square > kSliver * squared_norm(u) * squared_norm(v)) {
        return foot;
    }
    Point nearest = foot;
    double least = squared_distance(foot, p);
    for (const Point& q : {nearest_on_segment(a, b, p), nearest_on_segment(b, c, p), nearest_on_segment(c, a, p)}) {
        if (const double there = squared_distance(q, p); there < least) {
            least = there;
            nearest = q;
        }
    }
    return nearest;
}

namespace {

using Counts = std::span<const std::uint8_t>;  // as of `triangle_bounds`

std::vector<TriangleBlock> triangle_blocks(const Bvh& bvh, Counts counts) {
    constexpr int kSize = TriangleBlock::kSize;
    const std::size_t count = bvh.mesh.triangles.size();
    std::vector<TriangleBlock> blocks((count + kSize - 1) / kSize);
    for_each_index(
        blocks.size(),
        [&](std::size_t block) {
            for (std::size_t k = 0; k < kSize && block * kSize + k < count; ++k) {
                const auto& [u, v, w] = bvh.mesh.triangles[block * kSize + k];
                const std::vector<Point>& x = bvh.mesh.vertices;
                const auto sides = sides_of({bvh.in_frame(x[u]), bvh.in_frame(x[v]), bvh.in_frame(x[w])});
                for (std::size_t s = 0; s < sides.size(); ++s) {
                    const auto& [normal, offset] = sides[s];
                    TriangleBlock& out = blocks[block];
                    set_lane(out.normals[s], k, normal);
                    out.offsets[s][k] = static_cast<float>(offset);
                }
                if (!counts.empty() && counts[block * kSize + k] == 0) {
                    blocks[block].offsets[0][k] = std::numeric_limits<float>::infinity();
                }
            }
        },
        std::size_t{256});
    return blocks;
}

/// Triangles `begin` … `end - 1` of the tree.
struct Span {
    Index begin = std::numeric_limits<Index>::max();
    Index end = 0;

    void extend(const Span& other) {
        begin = std::min(begin, other.begin);
        end = std::max(end, other.end);
    }
};

/// Those that count below each child of each node, from the first to the last.
std::vector<std::array<Span, Bvh::kWidth>> spans_of(const Bvh& bvh, Counts counts) {
    std::vector<std::array<Span, Bvh::kWidth>> spans(bvh.nodes.size());
    for (std::size_t n = spans.size(); n-- > 0;) {  // children come after their parents
        const Bvh::Node& node = bvh.nodes[n];
        for (int k = 0; k < Bvh::kWidth; ++k) {
            if (node.count[k] > 0) {
                for (Index t = node.first[k]; t < node.first[k] + node.count[k]; ++t) {
                    spans[n][k].extend(counts.empty() || counts[t] != 0 ? Span{t, t + 1} : Span{});
                }
            } else if (node.first[k] > 0 && !(node.bounds[0][0][k] > node.bounds[1][0][k])) {
                for (const Span& part : spans[n + node.first[k]]) {
                    spans[n][k].extend(part);
                }
            }
        }
    }
    return spans;
}

/// A box with any axes.
struct OrientedBox {
    std::array<Point, 3> axes;
    std::array<double, 3> low, high;

    double half_area() const {
        const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return x * y + y * z + z * x;
    }
};

OrientedBox box_around(const Bvh& bvh, const Span& span, const std::array<Point, 3>& axes) {
    OrientedBox box{axes, {kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (Index t = span.begin; t < span.end; ++t) {
        for (const Index v : bvh.mesh.triangles[t]) {
            const Point p = bvh.in_frame(bvh.mesh.vertices[v]);
            for (int k = 0; k < 3; ++k) {
                const double at = dot(axes[k], p);
                box.low[k] = std::min(box.low[k], at);
                box.high[k] = std::max(box.high[k], at);
            }
        }
    }
    return box;
}

// Patches of more triangles are hardly flat, and their boxes take the longest to find.
constexpr Index kMostTurned = 4096;

/// The smaller of two boxes around a child of a node: along the axes, and along the mean normal.
OrientedBox smaller_box(const Bvh& bvh, const Bvh::Node& node, int child, const Span& span) {
    OrientedBox upright{{Point{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        upright.low[axis] = node.bounds[0][axis][child];
        upright.high[axis] = node.bounds[1][axis][child];
    }
    if (span.end - span.begin > kMostTurned) {
        return upright;
    }
    Point sum;
    for (Index t = span.begin; t < span.end; ++t) {
        const auto& [u, v, w] = bvh.mesh.triangles[t];
        const Point a = bvh.in_frame(bvh.mesh.vertices[u]);
        sum = sum + cross(bvh.in_frame(bvh.mesh.vertices[v]) - a, bvh.in_frame(bvh.mesh.vertices[w]) - a);
    }
    if (!(norm(sum) > 0.0)) {
        return upright;
    }
    const Point normal = unit(sum);
    const Point tangent = any_normal_to(normal);
    const OrientedBox turned = box_around(bvh, span, {normal, tangent, cross(normal, tangent)});
    return turned.half_area() < upright.half_area() ? turned : upright;
}

std::vector<OrientedBoxes> oriented_boxes(const Bvh& bvh, Counts counts) {
    const auto spans = spans_of(bvh, counts);
    std::vector<OrientedBoxes> boxes(spans.size());
    for_each_index(
        spans.size(),
        [&](std::size_t n) {
            OrientedBoxes& out = boxes[n];
            out = {};
            for (int k = 0; k < Bvh::kWidth; ++k) {
                const bool is_child = spans[n][k].begin < spans[n][k].end;
                const OrientedBox box = is_child ? smaller_box(bvh, bvh.nodes[n], k, spans[n][k]) : OrientedBox{};
                for (int axis = 0; axis < 3; ++axis) {
                    set_lane(out.axes[axis], k, box.axes[axis]);
                    out.middles[axis][k] = static_cast<float>(0.5 * (box.low[axis] + box.high[axis]));
                    out.halves[axis][k] =
                        is_child ? static_cast<float>(0.5 * (box.high[axis] - box.low[axis])) + Bvh::kPadding
                                 : -std::numeric_limits<float>::infinity();
                }
            }
        },
        std::size_t{16});
    return boxes;
}

}  // namespace

TriangleBounds triangle_bounds(const Bvh& bvh, Counts counts) {
    return {oriented_boxes(bvh, counts), triangle_blocks(bvh, counts)};
}

NearestOnMesh nearest(const TriangleMesh& mesh, std::span<const Point> points, const Execution& execution) {
    if (mesh.triangles.empty()) {
        throw UnusableInput(Diagnostic{"mesh.empty", "the mesh has no triangles"});
    }
    const auto bad = std::ranges::find_if_not(points, is_finite);
    if (bad != points.end()) {
        const auto i = bad - points.begin();
        throw UnusableInput(Diagnostic{"input", "point " + std::to_string(i) + " is not finite", "point", i});
    }
    return in_arena(execution, [&] {
        const Bvh bvh = build_bvh(mesh);
        const TriangleBounds bounds = triangle_bounds(bvh);
        const std::vector<Index> order = hilbert_order(points);
        NearestOnMesh result{std::vector<Point>(points.size()), std::vector<double>(points.size()),
                             std::vector<Index>(points.size())};
        constexpr std::size_t kRun = 1024;  // points one after the other; the first of a run has no known neighbours
        for_each_index((points.size() + kRun - 1) / kRun,
                       [&](std::size_t run) {
                           NearestTriangles search(bvh, bounds);
                           for (std::size_t k = run * kRun; k < std::min(points.size(), (run + 1) * kRun); ++k) {
                               const Index i = order[k];
                               const NearTriangle found = search(points[i]);
                               result.points[i] = found.point;
                               result.distances[i] = std::sqrt(found.squared_distance);
                               result.triangles[i] = bvh.order[found.triangle];
                           }
                       },
                       std::size_t{1});
        return result;
    });
}

}  // namespace scaleaxis::inline v1
