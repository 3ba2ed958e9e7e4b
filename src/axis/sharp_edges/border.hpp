// SPDX-License-Identifier: Apache-2.0
/// \file
/// The border of an axis, and the sharp edges of the solid that its vertices see.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "axis/sharp_edges/creases.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// Cosine of the angle between steps along one edge of the solid, at most.
inline const double kSameDirection = std::cos(40.0 * std::numbers::pi / 180.0);

/// What the border of a complex looks like around a vertex.
struct BorderVertex {
    Index vertex = kNone;
    Index face = kNone;                            // one at the vertex
    std::array<Index, 2> neighbors{kNone, kNone};  // positions among the border's vertices
    Index border_edges = 0;
    bool is_at_seam = false;
    std::optional<Crease> crease;
    std::optional<Crease> corner;

    bool is_plain() const { return border_edges == 2 && !is_at_seam; }
};

struct Border {
    std::vector<BorderVertex> vertices;
    std::vector<std::array<Index, 2>> edges;  // of positions among `vertices`
    std::vector<Index> positions;             // of each vertex of the complex, `kNone` inside
};

/// Which sheets are smaller than a size.
std::vector<std::uint8_t> small_sheets(const MedialComplex& complex, double size);

/// Without that of sheets smaller than `least_sheet`.
Border border_of(const MedialComplex& complex, double least_sheet);

/// Finds the edges for plain vertices of the border, and corners where seams end or one edge follows on another. Gaps
/// in a row of places on an edge are closed.
void find_creases(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options, Border& border);

}  // namespace scaleaxis::inline v1
