// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// Of the radius, half of what is between a place of the axis and the boundary: nearer places tell the same of the
/// solid, and single simplices or slopes between neighbours are noisy where the axis is denser. Of the size of
/// elements: nearer vertices are one, and none moves farther at once. With half of it single simplices count again;
/// with twice of it junctions of different limbs become one.
inline constexpr double kNearby = 0.5;

/// Of the radius: what is less is an error of the sampling. Half of it leaves seams where four sheets meet as clusters
/// of short seams; twice of it makes one of the sheets of thin panels.
inline constexpr double kRadiusError = 0.1;

/// Fills `edges` and `face_edges` from the faces and from edges that may have no face. Edges end up in ascending order.
void build_edges(MedialComplex& complex, std::span<const std::array<Index, 2>> more_edges);

/// How many faces each edge has: one at borders, three or more in seams.
std::vector<Index> face_counts(const MedialComplex& complex);

/// 1 for the edges that have a face, else 0.
std::vector<std::uint8_t> edges_with_faces(const MedialComplex& complex);

/// What a face has beside its corners.
struct FaceValues {
    double angle = 0.0;
    Index sheet = 0;
    std::optional<std::array<Index, 2>> contacts{};  ///< all faces of a complex have some, or none
};
FaceValues values_of(const MedialComplex& complex, Index face);

/// Adds a face, for which `build_edges` is to be called.
void add_face(MedialComplex& complex, std::span<const Index> corners, const FaceValues& values);

/// The vertices of a complex, those of the boundary, and the number of sheets: what is left without edges and faces.
MedialComplex vertices_of(const MedialComplex& complex);

/// The edges without a face: the curves of the axis.
std::vector<std::array<Index, 2>> curve_edges(const MedialComplex& complex);

/// The vertices without an edge: the isolated balls.
std::vector<Index> isolated_vertices(const MedialComplex& complex);

/// The faces at each edge.
IndexLists faces_at_edges(const MedialComplex& complex);

/// The faces at each vertex.
IndexLists faces_at_vertices(const MedialComplex& complex);

/// 1 for the vertices of edges with one face, else 0.
std::vector<std::uint8_t> vertices_at_borders(const MedialComplex& complex);

/// 1 for the vertices of seams, which are edges with more than two faces, else 0.
std::vector<std::uint8_t> vertices_at_seams(const MedialComplex& complex);

/// The faces of each sheet.
IndexLists faces_of_sheets(const MedialComplex& complex);

/// Object angle of a polygon in the bisector of two contacts: half the largest angle, in degrees, at which one of its
/// points sees them.
double object_angle(std::span<const Point> vertices, std::span<const Index> polygon, const Point& contact_a,
                    const Point& contact_b);

/// Normal to the face, as long as its area.
Point area_vector(const MedialComplex& complex, Index face);
double face_area(const MedialComplex& complex, Index face);

/// The mean of the corners.
Point center_of_face(const MedialComplex& complex, Index face);

/// Along a face, normal to one of its edges, into the face; of length 0 where it has no area.
Point inward(const MedialComplex& complex, Index face, Index edge);

double segment_distance(const Point& p, const Point& a, const Point& b);

inline bool is_on_sharp_edge(const MedialComplex& complex, std::size_t v) {
    return complex.vertex_origins[v].kind == VertexKind::kSharpEdge;
}

/// What a vertex inside an edge is between two such vertices.
constexpr VertexOrigin origin_between(const VertexOrigin& p, const VertexOrigin& q) {
    if (p.kind == VertexKind::kSharpEdge && q.kind == VertexKind::kSharpEdge) {
        return p;
    }
    return {is_linear(p) || is_linear(q) ? VertexKind::kTouching : VertexKind::kVoronoi};
}

/// Are radii linear on an edge? Else they are those of the medial axis (`radius_between`).
inline bool is_linear(const MedialComplex& complex, const std::array<Index, 2>& edge) {
    return is_linear(complex.vertex_origins[edge[0]]) || is_linear(complex.vertex_origins[edge[1]]);
}

/// Adds a vertex without edges. \returns its number
inline Index add_vertex(MedialComplex& complex, const Ball& ball, const VertexOrigin& origin) {
    complex.vertices.push_back(ball.center);
    complex.radii.push_back(ball.radius);
    complex.vertex_origins.push_back(origin);
    return static_cast<Index>(complex.vertices.size()) - 1;
}

inline Ball ball_at(const MedialComplex& complex, Index v) { return {complex.vertices[v], complex.radii[v]}; }

/// The complex with the radii that it had before it was shrunk.
MedialComplex grown(MedialComplex complex);

/// The ball in the middle of some vertices, where radii are linear.
Ball mean_ball(const MedialComplex& complex, std::span<const Index> vertices);

std::vector<Ball> balls_at_vertices(const MedialComplex& complex);

/// Around the balls at all vertices.
Box box_of_balls(const MedialComplex& complex);

/// Radius at the part `t` of an edge of the medial axis of a union of balls, from those at its ends. All its points are
/// closest to the same points of the boundary, so the squared radius is |x - contact|²: a square plus a linear
/// function.
double radius_between(double radius_a, double radius_b, double squared_length, double t);

/// The part of such an edge at which its radius is the farthest below a linear one. Nothing where the balls do not
/// meet, or one holds the other.
std::optional<double> deepest_dip(double radius_a, double radius_b, double squared_length);

/// How an edge without faces is seen from the boundary, which is closest to it in a circle around it.
struct CurveSize {
    double object_angle = 0.0;  ///< the largest on the edge; degrees
    double circumradius = 0.0;  ///< radius of the circle
};
/// The boundary is that of the grown balls.
CurveSize curve_size(const MedialComplex& complex, const std::array<Index, 2>& edge);

/// \throws InvalidOption unless it is a number of at least 1
void check_scale(double scale);

/// The part of a complex that consists of the elements marked, which must contain their own edges and ends. Vertices,
/// edges, faces keep their order; sheets keep it too and are numbered anew.
MedialComplex subcomplex(const MedialComplex& complex, const std::vector<std::uint8_t>& keeps_vertex,
                         const std::vector<std::uint8_t>& keeps_edge, const std::vector<std::uint8_t>& keeps_face);

/// Throws if the object angle of a face is not known. \throws UnusableInput
void check_angles(const MedialComplex& complex);

/// Degrees; 0 means that an object angle is not known, and this is what faces without an area get.
inline constexpr double kFlatAngle = 1e-3;

/// `with_object_angles` of a complex that has been checked, or was computed here. \param scale of the radii: that of
/// the complex, or 1 where its balls touch the solid
void find_object_angles(MedialComplex& complex, double scale);

/// `topology` of a complex that has been checked, or was computed here.
Topology topology_of(const MedialComplex& complex);

}  // namespace scaleaxis::inline v1
