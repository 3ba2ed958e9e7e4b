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

/// A simplex of a medial mesh, and how others that have it on their border go on from it.
struct EnvelopePart {
    Slab slab;
    std::vector<Point> ways_on;  ///< unit vectors along these
    std::vector<double> growth;  ///< how much the radius grows along each
};

/// Whether along no simplex that goes on from here the ball that is nearest to the contact in a direction comes nearer:
/// without that the contact is no point of the boundary. With `within`: false only if that is so for no direction that
/// differs from this one by no more.
bool is_exposed(const EnvelopePart& part, const Point& direction, double within = 0.0);

/// A sharp edge of the boundary.
struct EnvelopeCrease {
    std::array<Point, 2> ends;
    double sine = 0.0;  ///< of half the angle inside: by this radii grow with the distance from the edge
};

/// The members run in the caller's arena.
class EnvelopeData {
   public:
    /// \param complex as `check` demands, with a vertex at least
    explicit EnvelopeData(MedialComplex complex);

    const MedialComplex& complex() const { return complex_; }
    const SlabTree& tree() const { return tree_; }
    const Box& bounds() const { return bounds_; }
    const Topology& topology() const { return topology_; }
    /// Balls, cones and slabs: all, those on the border of others too.
    std::span<const EnvelopePart> parts() const { return parts_; }

    /// The least |p - centre| - radius.
    double signed_distance(const Point& p) const { return nearest_slab(tree_, p).near.distance; }

    /// The distance of a point to where the ball for which |p - centre| - radius is least comes nearest to it;
    /// negative, in a point inside, if that place is inside too: then the boundary is farther away.
    double distance_to_contact(const Point& p) const;

    /// A slab that has the point inside, by more than rounding; null: none.
    const Slab* covering(const Point& p) const;

    /// Points of the boundary: every point of it is at most `spacing` from one of them.
    std::vector<SurfacePoint> boundary_points(double spacing) const;

    /// The sharp edges of the boundary: those of the complex with balls of radius 0.
    std::vector<EnvelopeCrease> creases() const;

    /// About as many as `boundary_points` finds, and looks at.
    double area_of_parts() const;

   private:
    // Points less deep than this count as points of the boundary.
    double depth() const;
    void add_ball_points(const EnvelopePart& part, double spacing, std::vector<SurfacePoint>& points) const;
    void add_cone_points(const EnvelopePart& part, double spacing, std::vector<SurfacePoint>& points) const;
    void add_slab_points(const EnvelopePart& part, double spacing, std::vector<SurfacePoint>& points) const;

    MedialComplex complex_;
    SlabTree tree_;
    Box bounds_;
    Topology topology_;
    std::vector<EnvelopePart> parts_;
};

}  // namespace scaleaxis::inline v1
