// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

/// Fills `edges` and `face_edges` from the faces and from edges that may have no face. Edges end up in ascending order.
void build_edges(MedialComplex& complex, std::span<const std::array<Index, 2>> more_edges);

/// Object angle of a polygon in the bisector of two contacts: half the largest angle, in degrees, at which one of its
/// points sees them.
double object_angle(std::span<const Point> vertices, std::span<const Index> polygon, const Point& contact_a,
                    const Point& contact_b);

/// How an edge without faces is seen from the boundary, which is closest to it in a circle around it.
struct CurveSize {
    double object_angle = 0.0;  ///< the largest on the edge; degrees
    double circumradius = 0.0;  ///< radius of the circle
};
CurveSize curve_size(const MedialComplex& complex, const std::array<Index, 2>& edge);

/// The part of a complex that consists of the elements marked, which must contain their own edges and ends. Vertices,
/// edges, faces keep their order; sheets keep it too and are numbered anew.
MedialComplex subcomplex(const MedialComplex& complex, const std::vector<std::uint8_t>& keeps_vertex,
                         const std::vector<std::uint8_t>& keeps_edge, const std::vector<std::uint8_t>& keeps_face);

}  // namespace scaleaxis
