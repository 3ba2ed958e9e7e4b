// SPDX-License-Identifier: Apache-2.0
#include "axis/edit/halving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "axis/complex.hpp"
#include "axis/edit/split_triangle.hpp"
#include "axis/edit/triangulated.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Of the error: what sticks out is not in the solid.
constexpr double kMostSticking = 0.5;

// Which edges and faces are looked at.
struct Asked {
    std::vector<Index> edges;
    std::vector<Index> faces;
};

Asked asked_of(const MedialComplex& complex, std::span<const std::uint8_t> faces) {
    Asked asked;
    std::vector<std::uint8_t> is_asked(complex.edges.size(), faces.empty() ? 1 : 0);
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        if (faces.empty() || faces[f] != 0) {
            asked.faces.push_back(f);
            for (const Index e : complex.face_edges[f]) {
                is_asked[e] = 1;
            }
        }
    }
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        if (is_asked[e] != 0) {
            asked.edges.push_back(e);
        }
    }
    return asked;
}

}  // namespace

std::vector<std::optional<double>> growths_in(const Solid& solid, std::span<const Ball> balls, double error) {
    const auto centers = each_of<Point>(balls, [](const Ball& ball) { return ball.center; });
    const auto bounds = each_of<double>(balls, [&](const Ball& ball) { return ball.radius + 2.0 * error; });
    const std::vector<std::optional<Point>> nearest = nearest_of(solid, centers, bounds);
    std::vector<std::optional<double>> growths(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (nearest[i]) {
            growths[i] = distance(centers[i], *nearest[i]) - balls[i].radius;
        }
    }
    return growths;
}

bool touches_nearly(std::optional<double> growth, double error) {
    return growth && *growth <= error && *growth >= -kMostSticking * error;
}

std::size_t Halving::count() const { return static_cast<std::size_t>(std::ranges::count(is_halved, 1)); }

Halving edges_to_halve(const MedialComplex& complex, const Solid& solid, const HalvingOptions& options) {
    const auto [edges, faces] = asked_of(complex, options.asked_faces);
    auto balls = each_of<Ball>(edges, [&](Index e) { return mean_ball(complex, complex.edges[e]); });
    for (const Index f : faces) {
        balls.push_back(mean_ball(complex, complex.faces[f]));
    }
    const std::vector<std::optional<double>> growths = growths_in(solid, balls, options.error);
    const auto length = [&](Index e) {
        return distance(complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]);
    };
    // Those on sharp edges of the solid lie where they should.
    const auto may_be_halved = [&](Index e) {
        return std::ranges::any_of(complex.edges[e], [&](Index v) { return !is_on_sharp_edge(complex, v); });
    };
    Halving result{std::vector<std::uint8_t>(complex.edges.size()), std::vector<double>(complex.edges.size())};
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Index e = edges[i];
        result.is_halved[e] = !touches_nearly(growths[i], options.error) && may_be_halved(e) ? 1 : 0;
        result.radii[e] = balls[i].radius + std::min(0.0, growths[i].value_or(0.0));
    }
    for (std::size_t k = 0; k < faces.size(); ++k) {
        const std::span<const Index> sides = complex.face_edges[faces[k]];
        const Index longest = *std::ranges::max_element(sides, {}, length);
        if (!touches_nearly(growths[edges.size() + k], options.error) && may_be_halved(longest) &&
            std::ranges::none_of(sides, [&](Index e) { return result.is_halved[e] != 0; })) {
            result.is_halved[longest] = 1;
        }
    }
    return result;
}

MedialComplex halved(const MedialComplex& complex, const Halving& halving) {
    return halved_with_parents(complex, halving).complex;
}

HalvedComplex halved_with_parents(const MedialComplex& complex, const Halving& halving) {
    HalvedComplex all;
    MedialComplex& result = all.complex;
    result = vertices_of(complex);
    std::vector<Index> middles(complex.edges.size(), kNone);
    const std::vector<std::uint8_t> has_face = edges_with_faces(complex);
    std::vector<std::array<Index, 2>> curves;
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto& [a, b] = complex.edges[e];
        if (halving.is_halved[e] != 0) {
            const Point& from = complex.vertices[a];
            const Point& to = complex.vertices[b];
            middles[e] =
                halving.parts.empty()
                    ? add_vertex(result, {midpoint(from, to), halving.radii[e]}, linear_vertex(halving.radii[e]))
                    : add_vertex(result, {from + halving.parts[e] * (to - from), halving.radii[e]},
                                 origin_between(complex.vertex_origins[a], complex.vertex_origins[b]));
        }
        if (has_face[e] == 0 && middles[e] == kNone) {
            curves.push_back({a, b});
        } else if (has_face[e] == 0) {
            curves.push_back({a, middles[e]});
            curves.push_back({b, middles[e]});
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const FaceValues values = values_of(complex, static_cast<Index>(f));
        const auto add = [&](std::span<const Index> part) {
            add_face(result, part, values);
            all.parents.push_back(static_cast<Index>(f));
        };
        const std::span<const Index> corners = complex.faces[f];
        const std::span<const Index> sides = complex.face_edges[f];
        if (std::ranges::all_of(sides, [&](Index e) { return middles[e] == kNone; })) {
            add(corners);
            continue;
        }
        cut_into_triangles(result.vertices, corners, [&](const std::array<std::size_t, 3>& at) {
            const std::array triangle{corners[at[0]], corners[at[1]], corners[at[2]]};
            const auto middle_of = [&](int k) {
                const bool is_side = at[(k + 1) % 3] == (at[k] + 1) % corners.size();
                const Index middle = is_side ? middles[sides[at[k]]] : kNone;
                return middle == kNone ? std::nullopt : std::optional(middle);
            };
            const auto place_of = [&](Index v) { return result.vertices[v]; };
            const auto add_part = [&](Index a, Index b, Index c) { add(std::array{a, b, c}); };
            if (!split_triangle(triangle, middle_of, place_of, add_part)) {
                add(triangle);
            }
        });
    }
    build_edges(result, curves);
    label_sheets(result);
    return all;
}

}  // namespace scaleaxis::inline v1
