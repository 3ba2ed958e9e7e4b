// SPDX-License-Identifier: Apache-2.0
#include "axis/refit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/halved_triangle.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/centering.hpp"
#include "scaleaxis/simplification.hpp"
#include "spatial/slab.hpp"

namespace scaleaxis {
namespace {

constexpr double kLeastEdge = 0.25;  // tolerances: shorter ones are not halved
constexpr int kMostRounds = 6;       // of halving
constexpr double kMostGrowth = 3.0;  // so many times the vertices of the result may be needed before edges collapse
constexpr double kHalf = 0.5;        // of the error: how far from touching balls may be; edges collapse within the rest
constexpr double kMostHalved = 0.5;  // of the vertices: so many edges to halve at once take too many
constexpr double kFar = 1e6;         // diagonals

// Gives each triangle the directions in which its slab touches tangent planes as contacts far away: all of its corners
// see them in the same directions. (Where a slab has none, what is taken instead sees no contact, and does not count.)
void add_directions(MedialComplex& complex) {
    Box box;
    for (const Point& p : complex.vertices) {
        box.extend(p);
    }
    const double far = kFar * box.diagonal();
    complex.boundary_vertices.clear();
    complex.face_contacts.clear();
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        const std::array balls{ball_at(complex, corners[0]), ball_at(complex, corners[1]),
                               ball_at(complex, corners[2])};
        const auto shape = shape_of(Slab(balls));
        std::array<Index, 2> contacts{};
        for (int side = 0; side < 2; ++side) {
            const double sign = side == 0 ? 1.0 : -1.0;
            const Point direction = shape ? sign * shape->flank * shape->normal - shape->gradient : Point();
            contacts[side] = static_cast<Index>(complex.boundary_vertices.size());
            complex.boundary_vertices.push_back(balls[0].center + far * direction);
        }
        complex.face_contacts.push_back(contacts);
    }
    complex.boundary_vertex_balls.assign(complex.boundary_vertices.size(), {kNone, kNone, kNone});
}

void clear_directions(MedialComplex& complex) {
    complex.boundary_vertices.clear();
    complex.boundary_vertex_balls.clear();
    complex.face_contacts.clear();
}

// The edges in whose middle, or beside them in that of a triangle, balls do not touch the solid, and the balls that are
// in the solid there.
struct Halving {
    std::vector<std::uint8_t> is_halved;  // of each edge
    std::vector<double> radii;            // in their middle
};

Ball mean_ball(const MedialComplex& complex, std::span<const Index> corners) {
    const double part = 1.0 / static_cast<double>(corners.size());
    Ball mean{};
    for (const Index v : corners) {
        mean = {mean.center + part * complex.vertices[v], mean.radius + part * complex.radii[v]};
    }
    return mean;
}

Halving edges_to_halve(const MedialComplex& complex, const Solid& solid, double error, double least_length) {
    const std::size_t count = complex.edges.size();
    std::vector<Point> points;
    std::vector<double> radii;
    std::vector<double> bounds;
    const auto add = [&](std::span<const Index> corners) {
        const Ball ball = mean_ball(complex, corners);
        points.push_back(ball.center);
        radii.push_back(ball.radius);
        bounds.push_back(ball.radius + 2.0 * error);
    };
    for (const std::array<Index, 2>& edge : complex.edges) {
        add(edge);
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        add(complex.faces[f]);
    }
    const std::vector<std::optional<Point>> nearest = nearest_of(solid, points, bounds);
    const auto touches = [&](std::size_t i) {
        return nearest[i] && std::abs(distance(points[i], *nearest[i]) - radii[i]) <= error;
    };
    const auto length = [&](Index e) {
        return distance(complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]);
    };
    // Those on sharp edges of the solid lie where they should.
    const auto may_be_halved = [&](Index e) {
        return length(e) >= least_length &&
               std::ranges::any_of(complex.edges[e], [&](Index v) { return complex.radii[v] > 0.0; });
    };
    Halving result{std::vector<std::uint8_t>(count), {}};
    for (Index e = 0; e < static_cast<Index>(count); ++e) {
        result.is_halved[e] = !touches(e) && may_be_halved(e) ? 1 : 0;
        result.radii.push_back(nearest[e] ? std::min(radii[e], distance(points[e], *nearest[e])) : radii[e]);
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> sides = complex.face_edges[f];
        const Index longest = *std::ranges::max_element(sides, {}, length);
        if (!touches(count + f) && may_be_halved(longest) &&
            std::ranges::none_of(sides, [&](Index e) { return result.is_halved[e] != 0; })) {
            result.is_halved[longest] = 1;
        }
    }
    return result;
}

MedialComplex halved(const MedialComplex& complex, const Halving& halving) {
    MedialComplex result;
    result.vertices = complex.vertices;
    result.radii = complex.radii;
    std::vector<Index> middles(complex.edges.size(), kNone);
    std::vector<std::array<Index, 2>> curves;
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto& [a, b] = complex.edges[e];
        if (halving.is_halved[e] != 0) {
            middles[e] = static_cast<Index>(result.vertices.size());
            result.vertices.push_back(midpoint(complex.vertices[a], complex.vertices[b]));
            result.radii.push_back(halving.radii[e]);
        }
    }
    const std::vector<std::uint8_t> has_face = edges_with_faces(complex);
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto& [a, b] = complex.edges[e];
        if (has_face[e] != 0) {
            continue;
        }
        if (middles[e] == kNone) {
            curves.push_back({a, b});
        } else {
            curves.push_back({a, middles[e]});
            curves.push_back({b, middles[e]});
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        std::array<Index, 3> corners{};
        std::array<Index, 3> halves{};
        for (int k = 0; k < 3; ++k) {
            corners[k] = complex.faces[f][k];
            halves[k] = middles[complex.face_edges[f][k]];
        }
        add_halved_triangle(result.vertices, corners, halves, [&](const std::array<Index, 3>& part) {
            result.faces.push_back(part);
            result.face_angles.push_back(complex.face_angles[f]);
        });
    }
    result.vertex_balls.assign(result.vertices.size(), kMoved);
    build_edges(result, curves);
    label_sheets(result);
    return result;
}

}  // namespace

std::optional<MedialComplex> refitted(MedialComplex complex, const Solid& solid, const RefitOptions& options,
                                      const Execution& execution) {
    const double error = kHalf * options.error;
    const auto most = static_cast<std::size_t>(kMostGrowth * static_cast<double>(options.most_vertices));
    for (int round = 0; complex.vertices.size() <= most; ++round) {
        add_directions(complex);
        complex = centered(std::move(complex), solid, {.tolerance = options.tolerance}, execution).complex;
        clear_directions(complex);
        const Halving halving = edges_to_halve(complex, solid, error, kLeastEdge * options.tolerance);
        const auto count = static_cast<std::size_t>(std::ranges::count(halving.is_halved, 1));
        if (count == 0 || round == kMostRounds) {
            complex = simplify(complex, {.error = error}, execution).complex;
            return std::ssize(complex.vertices) <= options.most_vertices ? std::optional(std::move(complex))
                                                                         : std::nullopt;
        }
        if (static_cast<double>(count) > kMostHalved * static_cast<double>(complex.vertices.size())) {
            break;  // all is curved
        }
        complex = halved(complex, halving);
    }
    return std::nullopt;
}

}  // namespace scaleaxis
