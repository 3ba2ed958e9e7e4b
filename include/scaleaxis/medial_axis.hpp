// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 3: union of balls → its exact medial axis.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// What a vertex of a medial complex is. Its ball touches the same points of the boundary as the balls beside it, and
/// radii in between follow from these (`r² = |x - contact|²`), or it touches others, and radii are linear.
enum class VertexKind : std::uint8_t {
    kVoronoi,    ///< equally far from vertices of the boundary of the union
    kBall,       ///< the centre of a ball of the union
    kTouching,   ///< moved or added: touches the boundary where its own ball does; radii around it are linear
    kSharpEdge,  ///< on a sharp edge or a corner of the solid: of radius 0; radii around it are linear
};

/// Where a vertex comes from.
struct VertexOrigin {
    VertexKind kind = VertexKind::kVoronoi;
    Index ball = kNone;  ///< of a `kBall`: its number in the union, ≥ 0; of others `kNone`

    bool operator==(const VertexOrigin&) const = default;
};

/// Are radii beside such a vertex linear?
constexpr bool is_linear(const VertexOrigin& origin) { return origin.kind >= VertexKind::kTouching; }

/// A vertex beside which radii are linear: of radius 0, one on a sharp edge.
constexpr VertexOrigin linear_vertex(double radius) {
    return {radius > 0.0 ? VertexKind::kTouching : VertexKind::kSharpEdge};
}

/// A medial axis as a polygonal complex: vertices that carry the radius of their maximal ball, edges, convex planar
/// polygons. Faces meet along whole edges. An edge without a face is a curve of the axis, a vertex without an edge an
/// isolated ball.
///
/// Every face lies in the bisector of two vertices of the boundary of the union, its *contacts*: all its points `x`
/// have the radius `|x - contact|`, times `scale`. Contacts are optional: a complex that comes from a file has none.
struct MedialComplex {
    std::vector<Point> vertices;               ///< #V
    std::vector<double> radii;                 ///< #V, ≥ 0
    double scale = 1.0;                        ///< ≥ 1: by which radii have been divided (`shrink`)
    std::vector<VertexOrigin> vertex_origins;  ///< #V
    std::vector<std::array<Index, 2>> edges;   ///< #E; all edges, those of faces too; each once, ends ascending
    IndexLists faces;                          ///< #F polygons: vertices in cyclic order
    IndexLists face_edges;                     ///< #F; `[f][k]` is the edge from vertex `k` to vertex `k + 1`
    std::vector<double> face_angles;  ///< #F; object angle in degrees, (0, 90]: the largest on the face; 0: unknown
    std::vector<Index> face_sheets;   ///< #F; sheet, 0 … sheets - 1
    Index sheets = 0;                 ///< number of sheets (maximal parts without a seam inside)

    std::vector<std::array<Index, 2>> face_contacts;  ///< #F, the two boundary vertices closest to the face; or empty
    std::vector<Point> boundary_vertices;             ///< #B; where three spheres meet that no ball covers
    std::vector<std::array<Index, 3>> boundary_vertex_balls;  ///< #B×3; the input balls of these spheres

    std::vector<Index> vertex_labels;  ///< #V, the label of an image that it belongs to (`append_labelled`); or empty

    /// Are the contacts of its faces known?
    bool has_contacts() const { return face_contacts.size() == faces.size(); }
};

/// Throws if a complex is not what `MedialComplex` says: arrays of different sizes, indices out of range, coordinates
/// that are not finite, negative radii, a scale below 1, faces that have fewer than three corners or one twice, edges
/// that occur twice or are not those of the faces. All that takes a complex does this first. \throws UnusableInput,
/// with the code `complex.…` and the first vertex, edge or face that is wrong
SCALEAXIS_EXPORT void check(const MedialComplex& complex);

/// Adds the vertices, edges and faces of the axis of one label of an image to those of others; contacts and boundary
/// vertices are left out. Sheets get numbers after those that are there; balls keep theirs, which count in each label.
/// Axes of different scales together have none (1).
SCALEAXIS_EXPORT void append_labelled(MedialComplex& all, const MedialComplex& axis, Index label);

struct MedialAxisOptions {
    /// First perturbation of the centres, relative to the radius, [0, 0.01]. Doubled at each retry.
    double perturbation = 1e-4;
    /// Seed of the perturbation.
    std::uint64_t seed = 1;
    /// Compare the perturbed union with that of the balls given, whose dual complex is exact? Where balls touch, or are
    /// tiny beside others, perturbation can part them: then they are perturbed less, and grown by as much.
    bool compares_union = true;
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
    Index retries = 0;                    ///< how often the check failed, and the perturbation was doubled
    double perturbation = 0.0;            ///< the one that was used
    std::optional<Topology> given_union;  ///< of the balls given, if it was compared
    Topology dual_complex;
    Topology medial_complex;
};

/// Says how the union whose axis it is differs from that of the balls given; nothing: it does not, as far as is known.
SCALEAXIS_EXPORT std::optional<Diagnostic> changed_union(const MedialAxisStatistics& statistics);

struct MedialAxis {
    MedialComplex complex;
    BallUnion ball_union;  ///< the union whose exact medial axis it is: the balls given, after the perturbation
    MedialAxisStatistics statistics;
};

/// The medial axis of a union of balls (Amenta and Kolluri, "The medial axis of a union of balls", 2001, Theorem 7):
/// singular simplices of the dual complex, and the Voronoi diagram of the vertices of the boundary inside it.
/// The balls are perturbed first; if the result contradicts itself, again and more. The topology of the union is kept,
/// or `changed_union` tells.
/// \param balls at least one; `MedialComplex` numbers balls by their positions in this array
/// \throws InvalidOption, UnusableInput (see `BallUnion`), InconsistentResult (even after eight larger perturbations
/// the
///     topology of the axis is not that of the dual complex), Cancelled
SCALEAXIS_EXPORT MedialAxis medial_axis(std::span<const Ball> balls, const MedialAxisOptions& options = {},
                                        const Execution& execution = {});

/// The same of a union whose dual complex may be known already: the axis of its balls in general position, as
/// `BallUnion` has them. Only if that contradicts itself the balls are perturbed, and `MedialAxis::ball_union` is
/// another union than the one given.
/// \throws as above
SCALEAXIS_EXPORT MedialAxis medial_axis(const BallUnion& balls, const MedialAxisOptions& options = {},
                                        const Execution& execution = {});

/// Splits the faces into sheets, which are connected across edges with exactly two faces. Fills `face_sheets` and
/// `sheets`; everything else must be as `check` demands.
SCALEAXIS_EXPORT void label_sheets(MedialComplex& complex);

/// Components, Euler characteristic and, over Z/2 by collapsing, the other Betti numbers of a complex. The latter are
/// unknown where what is left after the collapses is too large to eliminate.
/// \throws UnusableInput (see `check`)
SCALEAXIS_EXPORT Topology topology(const MedialComplex& complex);

}  // namespace scaleaxis::inline v1
