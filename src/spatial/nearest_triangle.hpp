// SPDX-License-Identifier: Apache-2.0
/// \file
/// The point of a surface that is nearest to a given one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/compiler.hpp"
#include "base/numbers.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// The point of the triangle `abc` that is nearest to `p`, exact to rounding; the triangle may have no area.
Point nearest_point(const Point& a, const Point& b, const Point& c, const Point& p);

/// Four triangles of a tree as a plane and three half-planes of it each: how far a point is from these is cheap to say,
/// and never more than how far it is from the triangle. In the frame of the tree.
struct alignas(64) TriangleBlock {
    static constexpr int kSize = BoxTree::kWidth;

    // [0]: normal and offset of the plane. [1…3]: the unit vectors that lead out of the half-planes within the plane,
    // and their offsets. Coordinate by coordinate.
    std::array<std::array<Float4, 3>, 4> normals;
    std::array<Float4, 4> offsets;

    /// Lower bounds of the squared distances, up to rounding.
    Float4 squared_distances(const std::array<float, 3>& p) const {
        const auto height = [&](int k) {
            return normals[k][0] * p[0] + normals[k][1] * p[1] + normals[k][2] * p[2] - offsets[k];
        };
        const Float4 up = height(0);
        const Float4 beyond = greater(greater(height(1), height(2)), greater(height(3), Float4{}));
        return up * up + beyond * beyond;
    }
};

/// The boxes of a node's children in other directions: along the mean normal of what is in them, where these are
/// smaller. A patch of a smooth surface is flat, and so is its box: its distance is almost that of the patch.
struct alignas(64) OrientedBoxes {
    // Of each box: three unit vectors, coordinate by coordinate; along each of them the middle, and half the width
    // (minus infinity for a missing child). In the frame of the tree.
    std::array<std::array<Float4, 3>, 3> axes;
    std::array<Float4, 3> middles;
    std::array<Float4, 3> halves;

    /// But for rounding.
    Float4 squared_distances(const std::array<float, 3>& p) const {
        Float4 square = {0.0F, 0.0F, 0.0F, 0.0F};
        for (int k = 0; k < 3; ++k) {
            const Float4 from_middle = axes[k][0] * p[0] + axes[k][1] * p[1] + axes[k][2] * p[2] - middles[k];
            const Float4 beyond = greater(greater(from_middle, 0.0F - from_middle) - halves[k], Float4{});
            square += beyond * beyond;
        }
        return square;
    }
};

/// What tells quickly that triangles of a tree are far.
struct TriangleBounds {
    std::vector<OrientedBoxes> boxes;   ///< of the children of each node
    std::vector<TriangleBlock> blocks;  ///< triangle `t` is in block `t / 4`
};

/// \param counts #F of the tree: triangles with 0 are infinitely far; empty: none is
TriangleBounds triangle_bounds(const Bvh& bvh, std::span<const std::uint8_t> counts = {});

struct NearTriangle {
    Index triangle = kNone;  ///< of the tree
    Point point;
    double squared_distance = std::numeric_limits<double>::infinity();
};

/// The nearest point of those triangles for whose nearest point `counts(triangle, point)`, which is asked only where
/// nothing nearer is known. Of several triangles that are equally near the first. Nothing (`kNone`) if none is closer
/// than `bound`; a bound near the distance makes the query cheap.
///
/// \param bounds of the tree
///
/// A maximal ball of a solid nearly touches hundreds of triangles: so four at a time are told to be too far in single
/// precision, and few are left to be looked at.
template <class Predicate>
NearTriangle nearest_triangle(const Bvh& bvh, const TriangleBounds& bounds, const Point& p, double bound,
                              const Predicate& counts) {
    const FramedPoint framed(bvh, p);
    NearTriangle nearest;
    nearest.squared_distance = bound > 0.0 ? bound * bound : 0.0;
    // Squared, in the frame: padding and slack make up for rounding.
    const auto reach = [&] {
        const auto length = static_cast<float>(std::sqrt(nearest.squared_distance) * bvh.scale);
        const float padded = length * (1.0F + Bvh::kPadding) + Bvh::kPadding + framed.slack;
        return padded * padded;
    };
    float best = reach();
    const auto try_triangle = [&](Index t) {
        const auto& [u, v, w] = bvh.mesh.triangles[t];
        const std::vector<Point>& x = bvh.mesh.vertices;
        const Point q = nearest_point(x[u], x[v], x[w], p);
        const double square = squared_distance(p, q);
        const bool is_nearer =
            square < nearest.squared_distance || (square == nearest.squared_distance && t < nearest.triangle);
        if (is_nearer && counts(t, q)) {
            nearest = {t, q, square};
            best = reach();
        }
    };
    for_each_better_leaf(
        bvh, [&](const Bvh::Node& node) { return bounds.boxes[&node - bvh.nodes.data()].squared_distances(framed.at); },
        best,
        [&](Index first, Index count) {
            const Index end = first + count;
            for (Index block = first / TriangleBlock::kSize; block * TriangleBlock::kSize < end; ++block) {
                const Float4 squares = bounds.blocks[block].squared_distances(framed.at);
                for (int k = 0; k < TriangleBlock::kSize; ++k) {
                    const Index t = block * TriangleBlock::kSize + k;
                    if (squares[k] < best && t >= first && t < end) {
                        try_triangle(t);
                    }
                }
            }
        });
    return nearest;
}

/// That of all triangles.
inline NearTriangle nearest_triangle(const Bvh& bvh, const TriangleBounds& bounds, const Point& p,
                                     double bound = std::numeric_limits<double>::infinity()) {
    return nearest_triangle(bvh, bounds, p, bound, [](Index, const Point&) { return true; });
}

/// Asks for one point after the other: where these are mostly near each other, what was found for the last ones bounds
/// the next. The answers are those of `nearest_triangle`.
class NearestTriangles {
   public:
    NearestTriangles(const Bvh& bvh, const TriangleBounds& bounds)
        // Places are as exact as their coordinates, which far from the origin are coarse.
        : bvh_(bvh), bounds_(bounds), slack_(2e-12 * (norm(bvh.origin) + 2.0 / bvh.scale)) {
        last_.fill({kInfinity, kInfinity, kInfinity});
    }

    NearTriangle operator()(const Point& p, double bound = kInfinity) {
        constexpr double kMoreThanRounding = 1.0 + 1e-9;
        double least = kInfinity;
        for (const Point& place : last_) {
            least = std::min(least, squared_distance(p, place));
        }
        const NearTriangle found =
            nearest_triangle(bvh_, bounds_, p, std::min(bound, kMoreThanRounding * std::sqrt(least) + slack_));
        if (found.triangle != kNone) {
            last_[oldest_] = found.point;
            oldest_ = (oldest_ + 1) % last_.size();
        }
        return found;
    }

   private:
    const Bvh& bvh_;
    const TriangleBounds& bounds_;
    double slack_;
    std::array<Point, 4> last_;
    std::size_t oldest_ = 0;
};

}  // namespace scaleaxis::inline v1
