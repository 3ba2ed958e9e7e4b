// SPDX-License-Identifier: Apache-2.0
/// \file
/// Curve skeleton: cleaned axis → a graph of curves with radii, of the same homotopy type.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// What the radius of a node is.
enum class SkeletonRadius {
    kInscribed,  ///< of the largest ball in the solid around it
    kMean,  ///< mean distance to the boundary in the plane normal to the branch: what a caliper reads of noisy data
};

struct SkeletonOptions {
    /// Distance of the nodes along branches, at most, in the units of the complex; 0: a hundredth of the diagonal of
    /// the box around its balls.
    double spacing = 0.0;
    /// How far a branch sticks out of the others to stay, relative to its own radius, ≥ 0. Where it runs in a sheet
    /// 0.45 of the sheet's half width is added. At 1 a hemisphere on a wall has no branch any more, and a finger has.
    double significance = 1.0;
    /// Only a solid has mean radii; junctions keep the inscribed ones.
    SkeletonRadius radius = SkeletonRadius::kInscribed;
};

/// A cross-section of a solid.
struct Section {
    double area = 0.0;
    double least_width = 0.0;    ///< of the chords through the node
    double largest_width = 0.0;  ///< the same
    bool is_closed = false;      ///< false: the plane runs on into other parts of the solid, as at junctions
};

/// A curve skeleton: nodes with radii, edges between them, and the branches that they form.
struct Skeleton {
    std::vector<Point> nodes;                 ///< #N
    std::vector<double> radii;                ///< #N; see `SkeletonRadius`
    std::vector<std::array<Index, 2>> edges;  ///< #E; each once, ends ascending
    /// #B; the nodes of each branch from one end or junction to the next; of a loop without a junction the first node
    /// is also the last. A component without edges has none.
    IndexLists branches;
    std::vector<Index> node_branches;    ///< #N; a branch that the node is on, of a junction the thickest; or `kNone`
    std::vector<Index> node_components;  ///< #N; 0 …, in the order of their first nodes
    /// Triangles or other polygons of sheets around voids of the solid, which no curve can stand for; empty if there
    /// are none. Their sides are edges, too, and no part of a branch.
    IndexLists faces;

    /// #V of the complex: the node that each of its vertices has shrunk to.
    std::vector<Index> vertex_nodes;
    std::vector<Section> sections;  ///< #N, or empty; see `add_sections` in centerlines.hpp
    Index root = kNone;             ///< the node that the tree of its component grows from; `kNone`: see `tree_of`
};

/// The number of edges at each node.
SCALEAXIS_EXPORT std::vector<Index> degrees(const Skeleton& skeleton);

/// The number of edges of branches at each node: those of sheets do not count.
SCALEAXIS_EXPORT std::vector<Index> branch_degrees(const Skeleton& skeleton);

/// Length of a branch along its edges.
SCALEAXIS_EXPORT double branch_length(const Skeleton& skeleton, Index branch);

/// The skeleton as a medial complex, for all that takes one: its envelope is the solid that it stands for.
SCALEAXIS_EXPORT MedialComplex complex_of(const Skeleton& skeleton);

/// A graph without faces has no voids; with faces they are counted.
SCALEAXIS_EXPORT Topology topology(const Skeleton& skeleton);

struct SkeletonStatistics {
    Index nodes = 0;
    Index branches = 0;
    Index ends = 0;       ///< nodes of one edge
    Index junctions = 0;  ///< nodes where three or more branches meet; of sheets only where branches do
    Index faces = 0;      ///< around voids
    double length = 0.0;  ///< of all branches
    double least_radius = 0.0;
    double mean_radius = 0.0;  ///< over the length of the branches; of the nodes if there is none
    double largest_radius = 0.0;
    Topology complex_topology;  ///< of the complex given
    Topology topology;          ///< of the skeleton
};

SCALEAXIS_EXPORT SkeletonStatistics statistics_of(const Skeleton& skeleton, const MedialComplex& complex);

/// Reduces the sheets of a medial complex to curves: faces collapse from the borders inwards in the order in which the
/// fire of the erosion thickness burns them, and what is left at last are the ridges of the burn time (Y. Yan,
/// K. Sykes, E. Chambers, D. Letscher, T. Ju, "Erosion thickness on medial axes of 3D shapes", 2016). Of these curves
/// those stay that stick out of the others; where the shape of the solid says so or not, loops stay. All by collapses,
/// which keep the homotopy type; then the curves are smoothed within the union. Sheets that enclose a void stay, as
/// `Skeleton::faces`. \param complex filtered and shrunk, best cleaned and not extended to sharp edges \param
/// ball_union the union of the grown balls, which radii are taken from \throws InvalidOption, UnusableInput (see
/// `check`; the union is empty), Cancelled
SCALEAXIS_EXPORT Skeleton skeleton(const MedialComplex& complex, const BallUnion& ball_union,
                                   const SkeletonOptions& options = {}, const Execution& execution = {});

/// The same with the radii of the largest balls in a solid, which the union of the balls of its axis is a little
/// smaller than. \param solid one that knows the nearest points of its boundary \throws as above; UnusableInput if it
/// does not
SCALEAXIS_EXPORT Skeleton skeleton(const MedialComplex& complex, const Solid& solid,
                                   const SkeletonOptions& options = {}, const Execution& execution = {});

/// The same for a complex alone, as from a file: the union is that of its own balls after `densify`.
/// \throws InvalidOption, UnusableInput (see `check` and `densify`), Cancelled
SCALEAXIS_EXPORT Skeleton skeleton(const MedialComplex& complex, const SkeletonOptions& options = {},
                                   const Execution& execution = {});

/// Leads curves on to the middles of holes of the surface that were closed, as `MeshReport::holes` has them: a curve
/// ends about a radius before the open end of a vessel. Each hole takes the nearest end that is at most as far from it
/// as the larger of twice the radius there and the hole is wide; new nodes are at most `spacing` apart, and have that
/// radius. \param spacing > 0, or 0: one node for each hole \throws InvalidOption
SCALEAXIS_EXPORT Skeleton led_to_openings(Skeleton skeleton, std::span<const Hole> holes, double spacing = 0.0);

/// For each point the node that it belongs to: that of the ball of the complex to which the signed distance
/// |p - centre| - radius is least. \param complex the one whose skeleton it is \param points #P, as the vertices of a
/// surface \returns #P \throws UnusableInput, Cancelled
SCALEAXIS_EXPORT std::vector<Index> nearest_nodes(const Skeleton& skeleton, const MedialComplex& complex,
                                                  std::span<const Point> points, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
