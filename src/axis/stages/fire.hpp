// SPDX-License-Identifier: Apache-2.0
/// \file
/// The fire of the erosion thickness on the faces, edges and vertices of a complex.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// What an edge of a complex is part of.
struct Sides {
    IndexLists of_edge;          ///< the corners from which the edge goes on to the next corner of their face
    std::vector<Index> face_of;  ///< of each corner

    /// Is the edge inside a sheet?
    bool is_regular(Index edge) const { return of_edge[edge].size() == 2; }
};

Sides sides_of(const MedialComplex& complex);

/// The corners at the two ends of an edge, of the face that has this side, in the order of the edge's ends.
std::array<Index, 2> corners_at_ends(const MedialComplex& complex, const Sides& sides, Index side);

/// A vertex as a part of one sheet: the corners at the vertex of faces that are joined across edges inside the sheet.
struct Sectors {
    std::vector<Index> of_corner;
    std::vector<Index> vertices;  ///< of each sector
};

Sectors sectors_of(const MedialComplex& complex, const Sides& sides);

/// A segment from which the fire burns, at times that are linear on it; or a point.
struct Front {
    Point start;
    Point direction;  ///< of length 1; zero for a point
    double length = 0.0;
    double time = 0.0;                        ///< at the start
    double slope = 0.0;                       ///< of the time
    double lead = 0.0;                        ///< how much before its foot the way to a point at height 1 starts
    std::array<Index, 2> ends{kNone, kNone};  ///< the vertices
    Index sheet = kNone;
};

/// The fire: times when it comes by, infinite where it does not.
struct Fire {
    std::vector<double> sector_times;
    /// From where it started in the sheet, its border or a seam.
    std::vector<double> sector_paths;
    std::vector<double> vertex_times;
    std::vector<Index> sector_fronts;  ///< from which it came there
    std::vector<Front> fronts;
    std::vector<std::vector<Index>> fronts_at;  ///< of each vertex, those of edges
};

/// When the fire comes by, and how long its way from the border or a seam was.
struct Arrival {
    double time = kInfinity;
    double path = kInfinity;
};

/// How the fire reaches a point beside a sector: from the front from which it came there, or from one near it, and from
/// which. \param sector that the fire reaches
std::pair<Arrival, Index> arrival_beside(const Fire& fire, Index sector, const Point& x);

/// \param radii of the vertices: the times at which the fire starts at the border
/// \param tolerance by which it may start later between these, where radii of a union are less than linear
Fire burn(const MedialComplex& complex, const std::vector<double>& radii, const Sides& sides, const Sectors& sectors,
          double tolerance = kInfinity);

}  // namespace scaleaxis::inline v1
