// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stage 3: union of balls → its exact medial axis.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis {

/// A medial axis as a polygonal complex: vertices that carry the radius of their maximal ball, edges, convex planar
/// polygons. Faces meet along whole edges. An edge without a face is a curve of the axis, a vertex without an edge an
/// isolated ball.
///
/// Every face lies in the bisector of two vertices of the boundary of the union, its *contacts*: all its points `x`
/// have the radius `|x - contact|` (before shrinking).
struct MedialComplex {
    std::vector<Point> vertices;                      ///< #V
    std::vector<double> radii;                        ///< #V
    std::vector<Index> vertex_balls;                  ///< #V; the input ball whose centre the vertex is, or `kNone`
    std::vector<std::array<Index, 2>> edges;          ///< #E; all edges, those of faces too; each once, ends ascending
    IndexLists faces;                                 ///< #F polygons: vertices in cyclic order
    IndexLists face_edges;                            ///< #F; `[f][k]` is the edge from vertex `k` to vertex `k + 1`
    std::vector<std::array<Index, 2>> face_contacts;  ///< #F; the two boundary vertices closest to the face
    std::vector<double> face_angles;                  ///< #F; object angle in degrees, (0, 90]: the largest on the face
    std::vector<Index> face_sheets;                   ///< #F; sheet, 0 … sheets - 1
    Index sheets = 0;                                 ///< number of sheets (maximal parts without a seam inside)

    std::vector<Point> boundary_vertices;                     ///< #B; where three spheres meet that no ball covers
    std::vector<std::array<Index, 3>> boundary_vertex_balls;  ///< #B×3; the input balls of these spheres
};

struct MedialAxisOptions {
    /// First perturbation of the centres, relative to the radius, [0, 0.01]. Doubled at each retry.
    double perturbation = 1e-4;
    /// Seed of the perturbation.
    std::uint64_t seed = 1;
};

struct MedialAxisStatistics {
    Index balls = 0;            ///< balls given
    Index hidden_balls = 0;     ///< balls without a part in the regular triangulation
    Index dual_tetrahedra = 0;  ///< tetrahedra of the dual complex
    Index dual_triangles = 0;
    Index dual_edges = 0;
    Index dual_vertices = 0;      ///< balls in the dual complex
    Index boundary_vertices = 0;  ///< |V|, the vertices of the boundary of the union
    Index cells = 0;              ///< Delaunay tetrahedra of V
    Index inside_cells = 0;       ///< those with their centre inside the union (ball centres included)
    Index flat_cells = 0;         ///< those of four cocircular points
    Index vertices = 0;           ///< of the medial complex
    Index edges = 0;
    Index faces = 0;
    Index retries = 0;          ///< how often the self-check failed, and the perturbation was doubled
    double perturbation = 0.0;  ///< the one that was used
    Topology dual_complex;
    Topology medial_complex;
};

struct DualComplex;  // not public

struct MedialAxis {
    MedialComplex complex;
    std::vector<Ball> balls;                  ///< the union whose exact medial axis it is: the input after perturbation
    std::shared_ptr<const DualComplex> dual;  ///< the dual complex of `balls`, for `smooth`
    MedialAxisStatistics statistics;
};

/// The medial axis of a union of balls (Amenta and Kolluri, "The medial axis of a union of balls", 2001, Theorem 7):
/// singular simplices of the dual complex, and the Voronoi diagram of the vertices of the boundary inside it.
/// \param balls at least one; positive radii (see `cleaned`)
/// \throws UnusableShape (no balls), InconsistentResult (its topology is not that of the dual complex), Cancelled
MedialAxis medial_axis(std::span<const Ball> balls, const MedialAxisOptions& options = {},
                       const Execution& execution = {});

/// Splits the faces into sheets: parts that are connected across edges with exactly two faces. Fills `face_sheets`,
/// `sheets`.
void label_sheets(MedialComplex& complex);

/// Components, Euler characteristic and (over Z/2, by collapsing) the other Betti numbers of a complex.
Topology topology(const MedialComplex& complex);

}  // namespace scaleaxis
