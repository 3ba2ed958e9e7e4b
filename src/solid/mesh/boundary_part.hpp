// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which part of a surface bounds the solid, where that is not all of it.
#pragma once

#include <cstdint>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/mesh/repair/patches.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// How much of a triangle bounds the solid.
enum class Share : std::uint8_t { kNothing, kAll, kSome };

/// A triangle that others cut is divided by the segments that it has in common with them; the solid is on one side
/// alone either of a whole piece or nowhere.
struct BoundaryPart {
    std::vector<Share> shares;  ///< #F
    /// The segments between pieces that bound the solid and pieces that do not: 2 points each. Each is a side of a
    /// triangle `(2 i, 2 i + 1, 2 i + 1)`.
    TriangleMesh borders;
};

/// \param box of the surface
/// \param is_cut #F: does another triangle meet or touch it? empty: none does
/// \param gap sheets no farther apart are one
/// \param patches of the triangles that are not cut
///
/// Segments are computed with rounding, and pieces narrower than 10⁻⁷ of the box, or ten gaps, may be taken for others.
BoundaryPart boundary_part(const Bvh& bvh, const Box& box, const std::vector<std::uint8_t>& is_cut, double gap,
                           const Patches& patches);

/// Triangles that lie on each other face to face up to rounding, as the walls of parts that touch do.
struct Contacts {
    std::vector<std::uint8_t> is_touching;  ///< #F; empty: none does
    double gap = 0.0;                       ///< no two are farther apart: a length, 0 where coordinates are not rounded
};

Contacts find_contacts(const Bvh& bvh, const Box& box);

}  // namespace scaleaxis::inline v1
