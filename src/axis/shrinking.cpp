// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/shrinking.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "medial_axis/complex.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

// Edges halve every round; this many halvings are below the resolution of the coordinates.
constexpr int kMaxRounds = 50;

struct Triangle {
    std::array<Index, 3> corners;
    Index face;  // of the complex that is sampled
};

// The vertices of the finer complex, and which of its edges are fine enough.
class Refinement {
   public:
    Refinement(MedialComplex& complex, const ShrinkOptions& options)
        : complex_(complex),
          scale_(options.scale),
          cosine_(std::cos((180.0 - options.meeting_angle) * std::numbers::pi / 180.0)) {}

    // Do the shrunk balls at both ends meet too flatly, or not at all? Their radii to a point where the spheres meet
    // form the supplement of the angle at which the spheres do.
    bool is_too_long(Index p, Index q) const {
        const double rp = complex_.radii[p] / scale_;
        const double rq = complex_.radii[q] / scale_;
        return rp * rp + rq * rq - squared_distance(complex_.vertices[p], complex_.vertices[q]) <
               2.0 * rp * rq * cosine_;
    }

    bool is_too_coarse(std::span<const Index> polygon) const {
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            if (is_too_long(polygon[k], polygon[k + 1 < polygon.size() ? k + 1 : 0]) ||
                (k > 1 && is_too_long(polygon[0], polygon[k]))) {
                return true;
            }
        }
        return false;
    }

    // The point in the middle of an edge, the same for everything that shares the edge. All points of an edge are
    // closest to the same points of the boundary, so the squared radius there is |x - contact|²: a square plus a linear
    // function, which its ends determine.
    Index middle(Index p, Index q) {
        const auto [low, high] = std::minmax(p, q);
        const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
        const auto [entry, is_new] = middles_.try_emplace(key, static_cast<Index>(complex_.vertices.size()));
        if (is_new) {
            const Point a = complex_.vertices[low];
            const Point b = complex_.vertices[high];
            const double ra = complex_.radii[low];
            const double rb = complex_.radii[high];
            const double square = 0.5 * (ra * ra + rb * rb) - 0.25 * squared_distance(a, b);
            complex_.vertices.push_back(midpoint(a, b));
            complex_.radii.push_back(std::sqrt(std::max(square, 0.0)));
            complex_.vertex_balls.push_back(kNone);
        }
        return entry->second;
    }

   private:
    MedialComplex& complex_;
    double scale_;
    double cosine_;
    std::unordered_map<std::uint64_t, Index> middles_;
};

// Splits the sides of a triangle that are too long in half, and the triangle accordingly; adds the parts to `parts`.
// Returns false if it is fine enough.
bool split(const Triangle& triangle, Refinement& refinement, std::vector<Triangle>& parts) {
    std::array<Index, 3> v = triangle.corners;
    std::array<bool, 3> is_long{};
    for (int k = 0; k < 3; ++k) {
        is_long[k] = refinement.is_too_long(v[k], v[(k + 1) % 3]);
    }
    const auto count = std::count(is_long.begin(), is_long.end(), true);
    if (count == 0) {
        return false;
    }
    // Turned so that with one long side it is the first, with two the third is the short one.
    while (!(count == 3 || (is_long[0] && !is_long[2]))) {
        std::rotate(v.begin(), v.begin() + 1, v.end());
        std::rotate(is_long.begin(), is_long.begin() + 1, is_long.end());
    }
    const auto add = [&](Index a, Index b, Index c) { parts.push_back({{a, b, c}, triangle.face}); };
    const Index m01 = refinement.middle(v[0], v[1]);
    if (count == 1) {
        add(v[0], m01, v[2]);
        add(m01, v[1], v[2]);
        return true;
    }
    const Index m12 = refinement.middle(v[1], v[2]);
    add(m01, v[1], m12);
    if (count == 2) {
        add(v[0], m01, m12);
        add(v[0], m12, v[2]);
        return true;
    }
    const Index m20 = refinement.middle(v[2], v[0]);
    add(v[0], m01, m20);
    add(m20, m12, v[2]);
    add(m01, m12, m20);
    return true;
}

void add_face(MedialComplex& result, const MedialComplex& complex, std::span<const Index> polygon, Index face) {
    result.faces.push_back(polygon);
    result.face_contacts.push_back(complex.face_contacts[face]);
    result.face_angles.push_back(complex.face_angles[face]);
    result.face_sheets.push_back(complex.face_sheets[face]);
}

// Edges without a face.
std::vector<std::array<Index, 2>> curve_edges(const MedialComplex& complex) {
    std::vector<bool> has_face(complex.edges.size());
    for (const Index e : complex.face_edges.items) {
        has_face[e] = true;
    }
    std::vector<std::array<Index, 2>> curves;
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (!has_face[e]) {
            curves.push_back(complex.edges[e]);
        }
    }
    return curves;
}

void validate(const ShrinkOptions& options) {
    if (!(options.scale >= 1.0) || !std::isfinite(options.scale)) {
        throw InvalidOption("the scale must be a number of at least 1");
    }
    if (!(options.meeting_angle >= 90.0 && options.meeting_angle <= 175.0)) {
        throw InvalidOption("the meeting angle must lie between 90 and 175 degrees");
    }
}

}  // namespace

MedialComplex shrink(const MedialComplex& complex, const ShrinkOptions& options, const Execution& execution) {
    validate(options);
    return kernel::in_arena(execution, [&] {
        kernel::report(execution, "shrinking", 0.0);
        MedialComplex result;
        result.vertices = complex.vertices;
        result.radii = complex.radii;
        result.vertex_balls = complex.vertex_balls;
        Refinement refinement(result, options);

        std::vector<std::array<Index, 2>> curves;
        std::vector<std::array<Index, 2>> coarse_curves = curve_edges(complex);
        std::vector<Triangle> coarse;
        for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
            const std::span<const Index> polygon = complex.faces[f];
            if (!refinement.is_too_coarse(polygon)) {
                add_face(result, complex, polygon, f);
                continue;
            }
            for (std::size_t k = 2; k < polygon.size(); ++k) {
                coarse.push_back({{polygon[0], polygon[k - 1], polygon[k]}, f});
            }
        }
        for (int round = 0; !(coarse.empty() && coarse_curves.empty()); ++round) {
            kernel::report(execution, "shrinking", 0.5);
            std::vector<Triangle> finer;
            for (const Triangle& triangle : coarse) {
                if (round == kMaxRounds || !split(triangle, refinement, finer)) {
                    add_face(result, complex, triangle.corners, triangle.face);
                }
            }
            coarse = std::move(finer);
            std::vector<std::array<Index, 2>> finer_curves;
            for (const auto& [p, q] : coarse_curves) {
                if (round == kMaxRounds || !refinement.is_too_long(p, q)) {
                    curves.push_back({p, q});
                } else {
                    const Index m = refinement.middle(p, q);
                    finer_curves.push_back({p, m});
                    finer_curves.push_back({m, q});
                }
            }
            coarse_curves = std::move(finer_curves);
        }
        build_edges(result, curves);
        for (double& radius : result.radii) {
            radius /= options.scale;
        }
        result.sheets = complex.sheets;
        result.boundary_vertices = complex.boundary_vertices;
        result.boundary_vertex_balls = complex.boundary_vertex_balls;
        kernel::report(execution, "shrinking", 1.0);
        return result;
    });
}

}  // namespace scaleaxis
