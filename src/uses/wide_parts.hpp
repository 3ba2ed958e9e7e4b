// SPDX-License-Identifier: Apache-2.0
/// \file
/// Connected parts of a surface, and how wide they are beside the thickness of the wall.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

struct SurfacePart {
    double area = 0.0;
    double weight = 0.0;  ///< area × half the thickness
    double border = 0.0;
    double depth = 0.0;  ///< the farthest that the centre of a face is from the border

    /// Is it wider than half the thickness of the wall? Narrower parts of sheets are crumbs, and do not tell where a
    /// wall is. A strip of width w and length l has the area w l, a border of about 2 l and the depth w / 2. The border
    /// alone tells of a strip without faces inside, the depth alone of a part that has necks, as between holes.
    bool is_wide() const { return 2.0 * area * std::max(area, depth * border) >= weight * border; }
};

struct SurfaceParts {
    std::vector<Index> numbers;      ///< #F: the part of a face that counts; otherwise `kNone`
    std::vector<SurfacePart> parts;  ///< by these numbers
};

/// The connected parts of those faces that count. \param counts #F \param area, ball of a face
/// \param for_each_side calls `use(other, from, to)` for each side of a face: the only other face there, or `kNone`
template <class Counts, class Area, class BallOf, class ForEachSide>
SurfaceParts parts_of_faces(const Counts& counts, const Area& area, const BallOf& ball,
                            const ForEachSide& for_each_side) {
    const auto count = static_cast<Index>(counts.size());
    DisjointSets joined(counts.size());
    const auto is_inner = [&](Index other) { return other != kNone && counts[other] != 0; };
    for (Index f = 0; f < count; ++f) {
        if (counts[f] != 0) {
            for_each_side(f, [&](Index other, const Point& /*from*/, const Point& /*to*/) {
                if (is_inner(other)) {
                    joined.join(f, other);
                }
            });
        }
    }
    SurfaceParts result{std::vector<Index>(counts.size(), kNone), std::vector<SurfacePart>(counts.size())};
    std::vector<Point> border;
    for (Index f = 0; f < count; ++f) {
        if (counts[f] != 0) {
            result.numbers[f] = joined.find(f);
            SurfacePart& part = result.parts[result.numbers[f]];
            part.area += area(f);
            part.weight += area(f) * ball(f).radius;
            for_each_side(f, [&](Index other, const Point& from, const Point& to) {
                if (!is_inner(other)) {
                    part.border += distance(from, to);
                    border.push_back(midpoint(from, to));
                }
            });
        }
    }
    if (border.empty()) {
        return result;
    }
    const PointTree tree = build_point_tree(border);
    for (Index f = 0; f < count; ++f) {
        if (counts[f] != 0) {
            double& depth = result.parts[result.numbers[f]].depth;
            depth = std::max(depth, std::sqrt(nearest_point(tree, ball(f).center).squared_distance));
        }
    }
    return result;
}

}  // namespace scaleaxis::inline v1
