// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "axis/complex.hpp"
#include "axis/stages/stages.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"

namespace scaleaxis::inline v1 {
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

// What is kept of a complex: the faces and the edges without faces that are large enough, and what they consist of.
struct KeptElements {
    std::vector<std::uint8_t> vertices;
    std::vector<std::uint8_t> edges;
    std::vector<std::uint8_t> faces;
};

KeptElements at_least(const MedialComplex& complex, LocalMeasure measure, double threshold) {
    KeptElements keeps{std::vector<std::uint8_t>(complex.vertices.size()),
                       std::vector<std::uint8_t>(complex.edges.size()),
                       std::vector<std::uint8_t>(complex.faces.size())};
    std::vector<std::uint8_t> has_face(complex.edges.size());
    std::vector<std::uint8_t> has_edge(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        keeps.faces[f] = size_of_face(complex, f, measure) >= threshold ? 1 : 0;
        for (const Index e : complex.face_edges[f]) {
            has_face[e] = 1;
            keeps.edges[e] |= keeps.faces[f];
        }
    }
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (has_face[e] == 0) {
            keeps.edges[e] = size_of_curve(complex, complex.edges[e], measure) >= threshold ? 1 : 0;
        }
        for (const Index v : complex.edges[e]) {
            has_edge[v] = 1;
            keeps.vertices[v] |= keeps.edges[e];
        }
    }
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        if (has_edge[v] == 0) {
            keeps.vertices[v] = size_of_ball(complex.radii[v], measure) >= threshold ? 1 : 0;
        }
    }
    return keeps;
}

}  // namespace

FilteredComplex thresholded(const MedialComplex& complex, LocalMeasure measure, double threshold,
                            const Execution& execution) {
    require(threshold >= 0.0 && std::isfinite(threshold),
            "the threshold of a local method must be a number of at least 0");
    return in_arena(execution, [&] {
        report(execution, "filter", 0.0);
        check(complex);
        if (measure == LocalMeasure::kObjectAngle) {
            check_angles(complex);
        } else if (!complex.has_contacts()) {
            throw UnusableInput(Diagnostic{
                "complex.contacts",
                "the complex has no contacts (no file has them), which circumradii are measured between: compute it "
                "by `medial_axis`, or threshold the object angle"});
        }
        const KeptElements keeps = at_least(complex, measure, threshold);
        FilteredComplex result =
            with_statistics(subcomplex(complex, keeps.vertices, keeps.edges, keeps.faces), complex);
        report(execution, "filter", 1.0);
        return result;
    });
}

}  // namespace scaleaxis::inline v1
