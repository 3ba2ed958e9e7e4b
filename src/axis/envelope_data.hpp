// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is kept of a medial mesh to answer questions about its envelope.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/medial_axis.hpp"
#include "spatial/slab_tree.hpp"

namespace scaleaxis::inline v1 {

/// The balls, cones and slabs of a medial mesh that are not the border of another one.
std::vector<Slab> slabs_of(const MedialComplex& complex);

/// A point of a surface, and the area that it stands for.
struct SurfacePoint {
    Point point;
    double area = 0.0;
};

/// The members run in the caller's arena.
class EnvelopeData {
   public:
    /// \param complex as `check` demands, with a vertex at least
    explicit EnvelopeData(const MedialComplex& complex);

    const SlabTree& tree() const { return tree_; }
    const Box& bounds() const { return bounds_; }
    const Topology& topology() const { return topology_; }

    /// The least |p - centre| - radius.
    double signed_distance(const Point& p) const { return nearest_slab(tree_, p).near.distance; }

    /// The distance of a point to where the ball for which |p - centre| - radius is least comes nearest to it;
    /// negative, in a point inside, if that place is inside too: then the boundary is farther away.
    double distance_to_contact(const Point& p) const;

    /// Points of the boundary: every point of it is at most `spacing` from one of them.
    std::vector<SurfacePoint> boundary_points(double spacing) const;

    /// The median over all balls, cones and slabs of the largest radius of each: half of how thick most parts are.
    double typical_radius() const;

    /// The sharp edges of the boundary: those of the complex with balls of radius 0.
    /// \param least_length those that hang together are left out if they are shorter
    std::vector<std::array<Point, 2>> creases(double least_length) const;

    /// About as many as `boundary_points` finds, and looks at.
    double area_of_parts() const;

   private:
    // All simplices, those that others have as their border too: slabs and cones with the directions in which others
    // go on from them.
    struct Part {
        Slab slab;
        std::vector<Point> ways_on;  // unit vectors along the simplices that have this one on their border …
        std::vector<double> growth;  // … and how much the radius grows along each
    };

    // Points less deep than this count as points of the boundary.
    double depth() const;
    const Slab* covering(const Point& p) const;  // one that has the point inside, or null
    bool is_exposed(const Part& part, const Point& direction, double within = 0.0) const;
    void add_ball_points(const Part& part, double spacing, std::vector<SurfacePoint>& points) const;
    void add_cone_points(const Part& part, double spacing, std::vector<SurfacePoint>& points) const;
    void add_slab_points(const Part& part, double spacing, std::vector<SurfacePoint>& points) const;

    SlabTree tree_;
    Box bounds_;
    Topology topology_;
    std::vector<Part> parts_;
};

}  // namespace scaleaxis::inline v1
