// SPDX-License-Identifier: Apache-2.0
/// \file
/// Connected parts of a surface, and how wide they are beside the thickness of the wall.
#pragma once

#include <cstddef>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

struct SurfacePart {
    double area = 0.0;
    double weight = 0.0;  ///< area × half the thickness
    double border = 0.0;

    /// Is it wider than half the thickness of the wall? Narrower parts of sheets are crumbs, and do not tell where a
    /// wall is. A strip of width w and length l has the area w l and a border of about 2 l.
    bool is_wide() const { return 2.0 * area * area >= weight * border; }
};

struct SurfaceParts {
    std::vector<Index> numbers;      ///< #F: the part of a face that counts; otherwise `kNone`
    std::vector<SurfacePart> parts;  ///< by these numbers
};

/// The connected parts of those faces that count. \param counts #F \param area, radius of a face
/// \param for_each_side calls `use(other, length)` for each side of a face: the only other face there, or `kNone`
template <class Counts, class Area, class Radius, class ForEachSide>
SurfaceParts parts_of_faces(const Counts& counts, const Area& area, const Radius& radius,
                            const ForEachSide& for_each_side) {
    const auto count = static_cast<Index>(counts.size());
    DisjointSets joined(counts.size());
    const auto is_inner = [&](Index other) { return other != kNone && counts[other] != 0; };
    for (Index f = 0; f < count; ++f) {
        if (counts[f] != 0) {
            for_each_side(f, [&](Index other, double /*length*/) {
                if (is_inner(other)) {
                    joined.join(f, other);
                }
            });
        }
    }
    SurfaceParts result{std::vector<Index>(counts.size(), kNone), std::vector<SurfacePart>(counts.size())};
    for (Index f = 0; f < count; ++f) {
        if (counts[f] != 0) {
            result.numbers[f] = joined.find(f);
            SurfacePart& part = result.parts[result.numbers[f]];
            part.area += area(f);
            part.weight += area(f) * radius(f);
            for_each_side(f, [&](Index other, double length) { part.border += is_inner(other) ? 0.0 : length; });
        }
    }
    return result;
}

}  // namespace scaleaxis::inline v1
