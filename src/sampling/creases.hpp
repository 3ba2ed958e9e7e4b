// SPDX-License-Identifier: Apache-2.0
/// \file
/// Samples on sharp edges of a solid, so that these become edges of the restricted facets.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

using Segment = std::array<Point, 2>;

/// Sharp edges, cut into pieces whose ends are samples. As long as no sample lies in the diametral ball of a piece, the
/// piece is a Delaunay edge, and two restricted facets meet in it: for every point of it one of its ends is the nearest
/// sample. (J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", 1995.)
class Creases {
   public:
    /// \param segments of the sharp edges; one of length 0 is a single point
    /// \param tolerance bound on the radius of surface Delaunay balls
    Creases(std::span<const Segment> segments, double tolerance);

    const std::vector<Segment>& pieces() const { return pieces_; }
    /// The ends of all pieces and single corners, each once, in the order of their coordinates.
    const std::vector<Point>& samples() const { return samples_; }
    /// The position of a point among the samples, `kNone` if it is none of them.
    Index position_of(const Point& p) const;

    /// Those of some points that are far enough from the samples on creases to be in no diametral ball.
    std::vector<Point> apart(const std::vector<Point>& points) const;

    /// The points, except that those in the diametral ball of a piece make way for its middle, or for nothing where the
    /// piece is short already. Pieces are cut at their middles.
    std::vector<Point> making_way(const std::vector<Point>& points);

   private:
    // The pieces with points of the tree in their diametral balls. \param visit is told the positions of these points
    template <class Visit>
    std::vector<Index> crowded_by(const PointTree& tree, const Visit& visit) const;
    // Halves those that are not too short. \returns their middles
    std::vector<Point> cut(const std::vector<Index>& pieces);

    double tolerance_;
    std::vector<Segment> pieces_;
    std::vector<Point> samples_;
};

}  // namespace scaleaxis::inline v1
