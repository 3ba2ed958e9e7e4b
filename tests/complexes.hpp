// SPDX-License-Identifier: Apache-2.0
/// \file
/// What must hold for every medial complex, and distances to one.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "axis/complex.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "unions.hpp"

namespace scaleaxis::test {

/// A complex by hand: all radii are 1, and contacts are of no account. `angles`: one for each face, or none.
inline MedialComplex complex_by_hand(const std::vector<Point>& vertices, const std::vector<std::vector<Index>>& faces,
                                     const std::vector<double>& angles = {},
                                     const std::vector<std::array<Index, 2>>& curves = {}) {
    MedialComplex complex;
    complex.vertices = vertices;
    complex.radii.assign(vertices.size(), 1.0);
    complex.vertex_origins.resize(vertices.size());
    for (const std::vector<Index>& face : faces) {
        complex.faces.push_back(face);
    }
    build_edges(complex, curves);
    complex.boundary_vertices.resize(2);
    complex.boundary_vertex_balls.resize(2);
    complex.face_contacts.assign(faces.size(), {0, 1});
    complex.face_angles = angles.empty() ? std::vector<double>(faces.size(), 90.0) : angles;
    label_sheets(complex);
    return complex;
}

/// The edges of a chain of vertices from the first one on.
inline std::vector<std::array<Index, 2>> chain_edges(Index vertices) {
    std::vector<std::array<Index, 2>> edges;
    for (Index i = 1; i < vertices; ++i) {
        edges.push_back({i - 1, i});
    }
    return edges;
}

using RadiusAt = std::function<double(const Point&)>;

inline MedialComplex with_radii(MedialComplex complex, const RadiusAt& radius) {
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        complex.radii[v] = radius(complex.vertices[v]);
        if (complex.radii[v] == 0.0) {
            complex.vertex_origins[v] = {VertexKind::kSharpEdge};
        }
    }
    return complex;
}

/// The same with radii that are linear between vertices.
inline MedialComplex linear(MedialComplex complex) {
    std::ranges::transform(complex.radii, complex.vertex_origins.begin(), linear_vertex);
    return complex;
}

inline MedialComplex with_linear_radii(const MedialComplex& complex, const RadiusAt& radius) {
    return linear(with_radii(complex, radius));
}

/// Every face as triangles of a quarter of its size: a corner, the middles of its sides.
inline MedialComplex refined(const MedialComplex& complex, const RadiusAt& radius) {
    std::vector<Point> vertices = complex.vertices;
    std::map<std::array<Index, 2>, Index> middles;
    const auto middle = [&](Index a, Index b) {
        const auto [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, std::ssize(vertices));
        if (is_new) {
            vertices.push_back(midpoint(vertices[a], vertices[b]));
        }
        return at->second;
    };
    std::vector<std::vector<Index>> faces;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        for (std::size_t k = 2; k < corners.size(); ++k) {
            const auto [a, b, c] = std::array{corners[0], corners[k - 1], corners[k]};
            const auto [ab, bc, ca] = std::array{middle(a, b), middle(b, c), middle(c, a)};
            faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
    }
    std::vector<std::array<Index, 2>> curves;
    for (const auto& [p, q] : curve_edges(complex)) {
        const Index between = middle(p, q);
        curves.push_back({p, between});
        curves.push_back({q, between});
    }
    return with_radii(complex_by_hand(vertices, faces, {}, curves), radius);
}

/// The medial axis of a box, each sheet one polygon.
inline MedialComplex axis_of_box(const Point& size, const RadiusAt& radius) {
    const double half = 0.5 * size.z;  // the shortest side
    std::vector<Point> vertices;
    for (const double z : {0.0, size.z}) {
        vertices.insert(vertices.end(), {{0, 0, z}, {size.x, 0, z}, {size.x, size.y, z}, {0, size.y, z}});
    }
    vertices.insert(vertices.end(), {{half, half, half},
                                     {size.x - half, half, half},
                                     {size.x - half, size.y - half, half},
                                     {half, size.y - half, half}});
    std::vector<std::vector<Index>> faces{{8, 9, 10, 11}};
    for (Index k = 0; k < 4; ++k) {
        const Index next = (k + 1) % 4;
        faces.push_back({k, next, 8 + next, 8 + k});
        faces.push_back({4 + k, 4 + next, 8 + next, 8 + k});
        faces.push_back({k, 4 + k, 8 + k});
    }
    return with_radii(complex_by_hand(vertices, faces), radius);
}

/// Squares of a plane where `is_in` says so, with sides of `side`, divided `n` times each way.
inline MedialComplex squares(double side, int width, int height, int n, const std::function<bool(int, int)>& is_in,
                             const RadiusAt& radius) {
    std::map<std::array<int, 2>, Index> numbers;
    std::vector<Point> vertices;
    const auto vertex = [&](int i, int j) {
        const auto [at, is_new] = numbers.try_emplace({i, j}, std::ssize(vertices));
        if (is_new) {
            vertices.push_back({side * i / n, side * j / n, 0.0});
        }
        return at->second;
    };
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i < width * n; ++i) {
        for (int j = 0; j < height * n; ++j) {
            if (is_in(i / n, j / n)) {
                faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
            }
        }
    }
    return with_radii(complex_by_hand(vertices, faces), radius);
}

/// A point of a complex with the radius that it has there: between vertices, the squared radius is a square plus a
/// linear function.
inline Ball interpolated(const MedialComplex& complex, std::span<const Index> vertices,
                         std::span<const double> weights) {
    Point p;
    double square = 0.0;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Point& v = complex.vertices[vertices[k]];
        p = p + weights[k] * v;
        square += weights[k] * (complex.radii[vertices[k]] * complex.radii[vertices[k]] - squared_norm(v));
    }
    return {p, std::sqrt(std::max(0.0, square + squared_norm(p)))};
}

inline Ball random_ball_of(const MedialComplex& complex, std::span<const Index> vertices, Random& random) {
    std::vector<double> weights(vertices.size());
    double sum = 0.0;
    for (double& weight : weights) {
        sum += weight = -std::log(uniform(random, 1e-12, 1.0));
    }
    for (double& weight : weights) {
        weight /= sum;
    }
    return interpolated(complex, vertices, weights);
}

inline std::vector<bool> edges_with_faces(const MedialComplex& complex) {
    std::vector<bool> has_face(complex.edges.size());
    for (const Index e : complex.face_edges.items) {
        has_face[e] = true;
    }
    return has_face;
}

/// Arrays of the right sizes, indices in range, sorted distinct edges, distinct faces that agree with their edges: what
/// holds for every complex, those from files too.
inline void expect_consistent(const MedialComplex& c) {
    const auto in_range = [](Index i, std::size_t size) { return i >= 0 && static_cast<std::size_t>(i) < size; };
    ASSERT_EQ(c.radii.size(), c.vertices.size());
    ASSERT_EQ(c.vertex_origins.size(), c.vertices.size());
    ASSERT_EQ(c.face_edges.offsets, c.faces.offsets);
    ASSERT_EQ(c.face_edges.items.size(), c.faces.items.size());
    ASSERT_TRUE(c.face_contacts.empty() || c.has_contacts());
    ASSERT_EQ(c.face_angles.size(), c.faces.size());
    ASSERT_EQ(c.face_sheets.size(), c.faces.size());
    ASSERT_EQ(c.boundary_vertex_balls.size(), c.boundary_vertices.size());
    for (std::size_t v = 0; v < c.vertices.size(); ++v) {
        ASSERT_TRUE(is_finite(c.vertices[v])) << "vertex " << v;
        ASSERT_TRUE(c.radii[v] >= 0.0 && std::isfinite(c.radii[v])) << "vertex " << v << " radius " << c.radii[v];
    }
    for (std::size_t e = 0; e < c.edges.size(); ++e) {
        ASSERT_TRUE(in_range(c.edges[e][0], c.vertices.size()) && in_range(c.edges[e][1], c.vertices.size()));
        ASSERT_LT(c.edges[e][0], c.edges[e][1]) << "edge " << e;
        ASSERT_TRUE(e == 0 || c.edges[e - 1] < c.edges[e]) << "edge " << e << " is out of order or occurs twice";
    }
    std::set<std::vector<Index>> distinct_faces;
    for (std::size_t f = 0; f < c.faces.size(); ++f) {
        const std::span<const Index> face = c.faces[f];
        ASSERT_GE(face.size(), 3U) << "face " << f;
        ASSERT_EQ(std::set<Index>(face.begin(), face.end()).size(), face.size()) << "face " << f << " repeats a vertex";
        std::vector<Index> sorted(face.begin(), face.end());
        std::sort(sorted.begin(), sorted.end());
        ASSERT_TRUE(distinct_faces.insert(sorted).second) << "face " << f << " occurs twice";
        ASSERT_TRUE(in_range(c.face_sheets[f], c.sheets));
        for (std::size_t k = 0; k < face.size(); ++k) {
            ASSERT_TRUE(in_range(face[k], c.vertices.size())) << "face " << f;
            const Index e = c.face_edges[f][k];
            ASSERT_TRUE(in_range(e, c.edges.size())) << "face " << f;
            const auto [low, high] = std::minmax(face[k], face[(k + 1) % face.size()]);
            ASSERT_EQ(c.edges[e], (std::array{low, high})) << "face " << f << " side " << k;
        }
    }
}

/// A consistent complex that a stage has made: contacts exist, angles are in their range, sheets are cut at seams.
inline void expect_well_formed(const MedialComplex& c) {
    ASSERT_NO_FATAL_FAILURE(expect_consistent(c));
    ASSERT_TRUE(c.has_contacts());
    std::vector<std::set<Index>> sheets_at_edge(c.edges.size());
    std::vector<int> faces_at_edge(c.edges.size());
    for (std::size_t f = 0; f < c.faces.size(); ++f) {
        for (const Index b : c.face_contacts[f]) {
            ASSERT_TRUE(b >= 0 && static_cast<std::size_t>(b) < c.boundary_vertices.size()) << "face " << f;
        }
        ASSERT_GT(c.face_angles[f], 0.0) << "face " << f;
        ASSERT_LE(c.face_angles[f], 90.0) << "face " << f;
        for (const Index e : c.face_edges[f]) {
            sheets_at_edge[e].insert(c.face_sheets[f]);
            ++faces_at_edge[e];
        }
    }
    const std::set<Index> sheets(c.face_sheets.begin(), c.face_sheets.end());
    ASSERT_EQ(sheets.size(), static_cast<std::size_t>(c.sheets)) << "a sheet has no face";
    for (std::size_t e = 0; e < c.edges.size(); ++e) {
        ASSERT_TRUE(faces_at_edge[e] != 2 || sheets_at_edge[e].size() == 1)
            << "a sheet ends at edge " << e << ", which is no seam";
    }
}

/// Distance from a point to the segment from `a` to `b`.
inline double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Point direction = b - a;
    const double square = squared_norm(direction);
    const double t = square > 0.0 ? std::clamp(dot(p - a, direction) / square, 0.0, 1.0) : 0.0;
    return distance(p, a + t * direction);
}

inline double distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Point normal = cross(b - a, c - a);
    const auto is_left_of = [&](const Point& from, const Point& to) {
        return dot(cross(to - from, p - from), normal) >= 0.0;
    };
    if (squared_norm(normal) > 0.0 && is_left_of(a, b) && is_left_of(b, c) && is_left_of(c, a)) {
        return std::abs(dot(p - a, normal)) / norm(normal);
    }
    return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

inline double distance_to_face(const MedialComplex& complex, std::size_t f, const Point& p) {
    const std::span<const Index> face = complex.faces[f];
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t k = 2; k < face.size(); ++k) {
        best = std::min(best, distance_to_triangle(p, complex.vertices[face[0]], complex.vertices[face[k - 1]],
                                                   complex.vertices[face[k]]));
    }
    return best;
}

/// Distance from a point to all that a complex has.
inline double distance_to(const MedialComplex& complex, const Point& p) {
    double best = std::numeric_limits<double>::infinity();
    for (const Point& v : complex.vertices) {
        best = std::min(best, distance(p, v));
    }
    for (const auto& [a, b] : complex.edges) {
        best = std::min(best, distance_to_segment(p, complex.vertices[a], complex.vertices[b]));
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        best = std::min(best, distance_to_face(complex, f, p));
    }
    return best;
}

/// Bytes of a flat array are equal, NaN and signed zeros included.
template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// The same, whose radii count as divided by a factor.
inline MedialComplex with_scale(MedialComplex complex, double scale) {
    complex.scale = scale;
    return complex;
}

inline bool same_bytes(const MedialComplex& a, const MedialComplex& b) {
    return same_bytes(a.vertices, b.vertices) && same_bytes(a.radii, b.radii) && a.vertex_origins == b.vertex_origins &&
           same_bytes(a.edges, b.edges) && same_bytes(a.faces.offsets, b.faces.offsets) &&
           same_bytes(a.faces.items, b.faces.items) && same_bytes(a.face_edges.items, b.face_edges.items) &&
           same_bytes(a.face_contacts, b.face_contacts) && same_bytes(a.face_angles, b.face_angles) &&
           same_bytes(a.face_sheets, b.face_sheets) && a.sheets == b.sheets && a.scale == b.scale &&
           same_bytes(a.boundary_vertices, b.boundary_vertices) &&
           same_bytes(a.boundary_vertex_balls, b.boundary_vertex_balls);
}

}  // namespace scaleaxis::test
