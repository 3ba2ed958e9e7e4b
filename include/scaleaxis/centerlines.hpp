// SPDX-License-Identifier: Apache-2.0
/// \file
/// Curve skeleton → what programs for vessels, neurons and trees ask of curves: trees, paths, even steps, frames,
/// curvature, torsion, cross-sections, cylinders.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/skeleton.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// The branches of a skeleton as trees, parents before children. Each component has one, rooted at
/// `Skeleton::root`, at its thickest end, or
/// at its thickest node if it has no end; where there are `Skeleton::faces` it may have several, of what is left
/// without them. Ways to the root are the shortest ones, so loops are cut where they are farthest from it, at an edge
/// each.
struct SkeletonTree {
    std::vector<Index> nodes;                ///< #T
    std::vector<Index> parents;              ///< #T; places in `nodes`; of a root `kNone`
    std::vector<std::array<Index, 2>> cuts;  ///< #C; edges left out, as nodes of the skeleton
};

SCALEAXIS_EXPORT SkeletonTree tree_of(const Skeleton& skeleton);

/// What a file of trees (SWC, cylinders) loses or its readers may refuse: `skeleton.loops`, where loops were cut;
/// `skeleton.trees`, if there are several.
SCALEAXIS_EXPORT std::vector<Diagnostic> tree_warnings(const Skeleton& skeleton);

/// The place of each branch in its tree, in the terms of VMTK's centerlines: a centerline leads from the root to an
/// end.
struct BranchPlaces {
    std::vector<Index> centerlines;   ///< #B; the first of those that it is on
    std::vector<Index> tracts;        ///< #B; the number of branches between it and the root
    std::vector<Index> is_backwards;  ///< #B; 1: its last node is the one nearer to the root
};

SCALEAXIS_EXPORT BranchPlaces branch_places(const Skeleton& skeleton);

/// A branch as a curve in space. Derivatives are those of a cubic fitted to the nodes within twice the radius: of
/// what is shorter than a vessel is wide, a centreline tells nothing.
struct BranchGeometry {
    std::vector<double> abscissas;   ///< #N of the branch; lengths from its first node
    std::vector<double> curvature;   ///< #N; ≥ 0
    std::vector<double> torsion;     ///< #N; > 0: a right-handed helix; 0 where the curve is straight
    std::vector<Point> tangents;     ///< #N; of length 1, as the normals
    std::vector<Point> normals;      ///< #N; to the centre of curvature; where the curve is straight, `transported`
    std::vector<Point> binormals;    ///< #N; tangent × normal
    std::vector<Point> transported;  ///< #N; normals that do not turn around the curve
    double length = 0.0;
    double tortuosity = 0.0;  ///< length / distance of the ends - 1; 0 of a loop
};

SCALEAXIS_EXPORT BranchGeometry branch_geometry(const Skeleton& skeleton, Index branch);

/// The node nearest to a place, as for `Skeleton::root`. \throws UnusableInput if there is none, InvalidOption if the
/// place is not finite
SCALEAXIS_EXPORT Index nearest_node(const Skeleton& skeleton, const Point& place);

/// The shortest way along the curves between the nodes nearest to two places, as a skeleton of one branch from the
/// first, its root, to the second. \throws UnusableInput if the skeleton is empty or no curve leads from one to the
/// other
SCALEAXIS_EXPORT Skeleton path_between(const Skeleton& skeleton, const Point& from, const Point& to);

/// The same curves with nodes at even steps along each branch: of the least number of equal ones that are no longer
/// than `step`. Ends, junctions and nodes of faces stay; `sections` do not. \throws InvalidOption if `step` is not > 0
SCALEAXIS_EXPORT Skeleton resampled(const Skeleton& skeleton, double step);

/// Cuts the solid across at each node that is on a branch, in the plane normal to it, of a junction to the thickest:
/// area and widths of what can be seen from the node in that plane. Sets `Skeleton::sections`. \throws Cancelled
SCALEAXIS_EXPORT void add_sections(Skeleton& skeleton, const Solid& solid, const Execution& execution = {});

/// One cylinder of a quantitative structure model of a tree, as TreeQSM has them.
struct Cylinder {
    Index parent = kNone;  ///< the one that it grows from; `kNone`: it begins at a root
    Point start;
    Point axis;  ///< of length 1
    double length = 0.0;
    double radius = 0.0;  ///< mean of those of its ends
    /// Numbers of branches in the sense of trees: at each fork the thickest goes on, and others begin.
    Index branch = 0;
    Index order = 0;     ///< of the branch: 0 of a trunk, of others one more than that of the branch it grows from
    Index position = 0;  ///< in the branch, from 0 on
};

/// A cylinder for each edge of `tree_of`.
SCALEAXIS_EXPORT std::vector<Cylinder> cylinders(const Skeleton& skeleton);

}  // namespace scaleaxis::inline v1
