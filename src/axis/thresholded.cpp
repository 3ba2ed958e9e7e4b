// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <vector>

#include "medial_axis/complex.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"

namespace scaleaxis {
namespace {

double size_of_face(const MedialComplex& complex, std::size_t face, LocalMeasure measure) {
    if (measure == LocalMeasure::kObjectAngle) {
        return complex.face_angles[face];
    }
    const auto& [a, b] = complex.face_contacts[face];
    return 0.5 * distance(complex.boundary_vertices[a], complex.boundary_vertices[b]);
}

double size_of_curve(const MedialComplex& complex, const std::array<Index, 2>& edge, LocalMeasure measure) {
    const CurveSize size = curve_size(complex, edge);
    return measure == LocalMeasure::kObjectAngle ? size.object_angle : size.circumradius;
}

// A whole ball: seen from all sides.
double size_of_ball(double radius, LocalMeasure measure) {
    return measure == LocalMeasure::kObjectAngle ? 90.0 : radius;
}

}  // namespace

FilteredComplex thresholded(const MedialComplex& complex, LocalMeasure measure, double threshold) {
    if (!(threshold >= 0.0) || !std::isfinite(threshold)) {
        throw InvalidOption("the threshold of a local method must be a number of at least 0");
    }
    std::vector<std::uint8_t> keeps_vertex(complex.vertices.size());
    std::vector<std::uint8_t> keeps_edge(complex.edges.size());
    std::vector<std::uint8_t> keeps_face(complex.faces.size());
    std::vector<std::uint8_t> has_face(complex.edges.size());
    std::vector<std::uint8_t> has_edge(complex.vertices.size());
    Index removed = 0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        keeps_face[f] = size_of_face(complex, f, measure) >= threshold ? 1 : 0;
        removed += keeps_face[f] == 0 ? 1 : 0;
        for (const Index e : complex.face_edges[f]) {
            has_face[e] = 1;
            keeps_edge[e] |= keeps_face[f];
        }
    }
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (has_face[e] == 0) {
            keeps_edge[e] = size_of_curve(complex, complex.edges[e], measure) >= threshold ? 1 : 0;
        }
        for (const Index v : complex.edges[e]) {
            has_edge[v] = 1;
            keeps_vertex[v] |= keeps_edge[e];
        }
    }
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        if (has_edge[v] == 0) {
            keeps_vertex[v] = size_of_ball(complex.radii[v], measure) >= threshold ? 1 : 0;
        }
    }
    FilteredComplex result;
    result.complex = subcomplex(complex, keeps_vertex, keeps_edge, keeps_face);
    label_sheets(result.complex);
    result.statistics = {complex.sheets, result.complex.sheets, removed, topology(result.complex)};
    return result;
}

}  // namespace scaleaxis
