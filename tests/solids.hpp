// SPDX-License-Identifier: Apache-2.0
/// \file
/// Solids whose medial axis is known, as oracles and as meshes, all centred at the origin.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <ostream>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "scaleaxis/cloud.hpp"
#include "scaleaxis/crust.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "unions.hpp"

namespace scaleaxis {

/// How GoogleTest prints it.
inline void PrintTo(const Topology& t, std::ostream* out) {
    *out << t.components << " components, " << t.tunnels.value_or(-1) << " tunnels, " << t.voids.value_or(-1)
         << " voids (-1: unknown), Euler characteristic " << t.euler;
}

}  // namespace scaleaxis

namespace scaleaxis::test {

/// A solid given by a function that is negative inside. Without seed points the sampler has to find its boundary alone.
class ImplicitSolid : public Solid {
   public:
    using Function = std::function<double(const Point&)>;

    ImplicitSolid(Box box, Function function, std::optional<Topology> known = std::nullopt)
        : box_(box), function_(std::move(function)), topology_(known) {}

    double value(const Point& p) const { return function_(p); }
    const Function& function() const { return function_; }
    Box bounds() const override { return box_; }
    using Solid::inside;
    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        std::ranges::transform(points, sides.begin(), [&](const Point& p) { return is_inside(p) ? 1 : 0; });
    }
    void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const override {
        std::ranges::transform(chords, points.begin(), [&](const Chord& chord) { return crossing_of(chord); });
    }
    std::vector<Point> seeds(double, std::uint64_t, const Execution&) const override { return {}; }
    std::optional<Topology> topology() const override { return topology_; }

   private:
    bool is_inside(const Point& p) const { return function_(p) < 0.0; }

    std::optional<Point> crossing_of(const Chord& chord) const {
        if (!is_inside(chord.inside_end) || is_inside(chord.outside_end)) {
            return std::nullopt;
        }
        std::optional<Point> farthest;
        constexpr int kSteps = 48;  // crossings that are closer together than a step hide each other
        Point from = chord.inside_end;
        for (int step = 1; step <= kSteps; ++step) {
            const Point to = step == kSteps
                                 ? chord.outside_end
                                 : chord.inside_end + (1.0 / kSteps * step) * (chord.outside_end - chord.inside_end);
            if (is_inside(from) != is_inside(to)) {
                const Point found = bisected(from, to);
                if (!farthest ||
                    squared_distance(found, chord.reference) > squared_distance(*farthest, chord.reference)) {
                    farthest = found;
                }
            }
            from = to;
        }
        return farthest;
    }

    Point bisected(Point a, Point b) const {
        const bool is_a_inside = is_inside(a);
        while (true) {
            const Point middle = midpoint(a, b);
            if (middle == a || middle == b) {
                return is_a_inside ? a : b;
            }
            (is_inside(middle) == is_a_inside ? a : b) = middle;
        }
    }

    Box box_;
    Function function_;
    std::optional<Topology> topology_;
};

inline Topology known_topology(std::int64_t components, std::int64_t tunnels, std::int64_t voids) {
    return {components, components - tunnels + voids, tunnels, voids};
}

inline Box centered_box(double x, double y, double z) { return {{-x, -y, -z}, {x, y, z}}; }

// Implicit solids. Except for the ellipsoid the functions are the signed distance, or (at concave creases) less.

inline ImplicitSolid ball_solid(double radius) {
    return {centered_box(radius, radius, radius), [=](const Point& p) { return norm(p) - radius; },
            known_topology(1, 0, 0)};
}

/// Around the z axis.
inline ImplicitSolid torus_solid(double ring_radius, double radius) {
    return {centered_box(ring_radius + radius, ring_radius + radius, radius),
            [=](const Point& p) { return std::hypot(std::hypot(p.x, p.y) - ring_radius, p.z) - radius; },
            known_topology(1, 1, 0)};
}

/// The box from -`half` to `half`.
inline ImplicitSolid box_solid(const Point& half) {
    return {centered_box(half.x, half.y, half.z),
            [=](const Point& p) {
                const Point q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
                return norm({std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)}) +
                       std::min(std::max({q.x, q.y, q.z}), 0.0);
            },
            known_topology(1, 0, 0)};
}

/// Around the z axis, from -`half_height` to `half_height`.
inline ImplicitSolid cylinder_solid(double radius, double half_height) {
    return {centered_box(radius, radius, half_height),
            [=](const Point& p) {
                const double across = std::hypot(p.x, p.y) - radius;
                const double along = std::abs(p.z) - half_height;
                return std::hypot(std::max(across, 0.0), std::max(along, 0.0)) + std::min(std::max(across, along), 0.0);
            },
            known_topology(1, 0, 0)};
}

inline ImplicitSolid ellipsoid_solid(double a, double b, double c) {
    return {centered_box(a, b, c),
            [=](const Point& p) {
                return norm({p.x / a, p.y / b, p.z / c}) - 1.0;
            },
            known_topology(1, 0, 0)};
}

/// What two balls around (0, 0, ±`offset`) have in common.
inline ImplicitSolid lens_solid(double radius, double offset) {
    const double rim = std::sqrt(radius * radius - offset * offset);
    return {centered_box(rim, rim, radius - offset),
            [=](const Point& p) {
                return norm({p.x, p.y, std::abs(p.z) + offset}) - radius;
            },
            known_topology(1, 0, 0)};
}

/// A ball with a concentric cavity.
inline ImplicitSolid shell_solid(double outer_radius, double inner_radius) {
    return {centered_box(outer_radius, outer_radius, outer_radius),
            [=](const Point& p) { return std::max(norm(p) - outer_radius, inner_radius - norm(p)); },
            known_topology(1, 0, 1)};
}

/// Balls around (0, 0, ±`half_length`), and a bar between them.
inline ImplicitSolid dumbbell_solid(double radius, double half_length, double bar_radius) {
    return {centered_box(radius, radius, half_length + radius),
            [=](const Point& p) {
                const double ball = norm({p.x, p.y, std::abs(p.z) - half_length}) - radius;
                const double bar = std::max(std::hypot(p.x, p.y) - bar_radius, std::abs(p.z) - half_length);
                return std::min(ball, bar);
            },
            known_topology(1, 0, 0)};
}

/// A cylinder around the z axis with round ends: all points closer than `radius` to the segment between z =
/// ±`half_length`.
inline ImplicitSolid capsule_solid(double radius, double half_length) {
    return {centered_box(radius, radius, half_length + radius),
            [=](const Point& p) {
                return norm({p.x, p.y, std::max(std::abs(p.z) - half_length, 0.0)}) - radius;
            },
            known_topology(1, 0, 0)};
}

/// A slab with three round holes along z, `hole` in radius.
inline ImplicitSolid holed_solid(double hole) {
    return {centered_box(1.4, 0.7, 0.35),
            [=](const Point& p) {
                double outside = std::max({std::abs(p.x) - 1.4, std::abs(p.y) - 0.7, std::abs(p.z) - 0.35});
                for (const double x : {-0.9, 0.0, 0.9}) {
                    outside = std::max(outside, hole - std::hypot(p.x - x, p.y));
                }
                return outside;
            },
            known_topology(1, 3, 0)};
}

// Points.

/// Where the function grows fastest, for normals of points: from its values at a distance of `h`.
inline Point difference_quotient(const std::function<double(const Point&)>& function, const Point& p, double h) {
    const auto along = [&](const Point& d) { return (function(p + h * d) - function(p - h * d)) / (2.0 * h); };
    return {along({1, 0, 0}), along({0, 1, 0}), along({0, 0, 1})};
}

/// As the program takes points.
inline ScaleAxis axis_of(PointCloud points, ScaleAxisOptions options) {
    const PreparedCloud cloud = prepare(std::move(points));
    CloudChoice choice = choose_method(cloud);
    if (choice.method == CloudMethod::kCrust) {
        options.delta.reset();  // the samples are given
        return scale_axis(std::move(*choice.samples), options);
    }
    return scale_axis(*cloud_solid(cloud), options);
}

// Meshes.

/// The surface that a curve (points: distance from the z axis, and z) forms when it turns around the axis. The curve
/// either begins and ends on the axis, or is closed (the last point then joins the first). The solid lies to the left
/// of the curve in the half plane where the distance points to the right and z up.
inline TriangleMesh revolved(const std::vector<std::array<double, 2>>& curve, int segments) {
    TriangleMesh mesh;
    std::vector<std::vector<Index>> rings;
    for (const auto& [r, z] : curve) {
        std::vector<Index> ring(static_cast<std::size_t>(segments), static_cast<Index>(mesh.vertices.size()));
        for (int k = 0; k < (r > 0.0 ? segments : 1); ++k) {
            const double angle = 2.0 * std::numbers::pi * k / segments;
            if (r > 0.0) {
                ring[static_cast<std::size_t>(k)] = static_cast<Index>(mesh.vertices.size());
            }
            mesh.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
        }
        rings.push_back(std::move(ring));
    }
    if (curve.front()[0] > 0.0) {
        rings.push_back(rings.front());
    }
    for (std::size_t i = 1; i < rings.size(); ++i) {
        for (std::size_t k = 0; k < rings[i].size(); ++k) {
            const std::size_t next = (k + 1) % rings[i].size();
            const Index a = rings[i - 1][k], b = rings[i - 1][next], c = rings[i][next], d = rings[i][k];
            if (a != b) {
                mesh.triangles.push_back({a, b, c});
            }
            if (c != d) {
                mesh.triangles.push_back({a, c, d});
            }
        }
    }
    return mesh;
}

inline TriangleMesh ball_mesh(double radius, int segments) {
    std::vector<std::array<double, 2>> curve{{0.0, -radius}};
    for (int i = 1; i < segments / 2; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / segments;
        curve.push_back({radius * std::sin(angle), -radius * std::cos(angle)});
    }
    curve.push_back({0.0, radius});
    return revolved(curve, segments);
}

inline TriangleMesh torus_mesh(double ring_radius, double radius, int segments) {
    std::vector<std::array<double, 2>> curve;
    for (int i = 0; i < segments; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / segments;
        curve.push_back({ring_radius + radius * std::cos(angle), radius * std::sin(angle)});
    }
    return revolved(curve, 2 * segments);
}

inline TriangleMesh cylinder_mesh(double radius, double half_height, int segments) {
    return revolved({{0.0, -half_height}, {radius, -half_height}, {radius, half_height}, {0.0, half_height}}, segments);
}

inline TriangleMesh dumbbell_mesh(double radius, double half_length, double bar_radius, int segments) {
    std::vector<std::array<double, 2>> lower{{0.0, -half_length - radius}};
    const double last_angle = std::numbers::pi - std::asin(bar_radius / radius);
    for (int i = 1; i <= segments / 2; ++i) {
        const double angle = last_angle * i / (segments / 2);
        lower.push_back({radius * std::sin(angle), -half_length - radius * std::cos(angle)});
    }
    std::vector<std::array<double, 2>> curve = lower;
    for (auto it = lower.rbegin(); it != lower.rend(); ++it) {
        curve.push_back({(*it)[0], -(*it)[1]});
    }
    return revolved(curve, segments);
}

/// `holed_solid`, with four times `steps` points around each hole.
inline TriangleMesh holed_mesh(double hole, int steps) {
    // The triangles between each hole and the rectangle around it, in the plane z = 0.
    TriangleMesh flat;
    std::map<std::array<double, 2>, Index> ids;
    const auto vertex = [&](double x, double y) {
        const auto [entry, is_new] = ids.try_emplace({x, y}, static_cast<Index>(flat.vertices.size()));
        if (is_new) {
            flat.vertices.push_back({x, y, 0.0});
        }
        return entry->second;
    };
    const std::array<double, 4> borders{-1.4, -0.45, 0.45, 1.4};
    for (int i = 0; i < 3; ++i) {
        const std::array<double, 2> x{borders[i], borders[i + 1]};
        const std::array<double, 2> y{-0.7, 0.7};
        const std::array<std::array<double, 2>, 5> corners{
            {{x[0], y[0]}, {x[1], y[0]}, {x[1], y[1]}, {x[0], y[1]}, {x[0], y[0]}}};
        std::vector<std::array<Index, 2>> spokes;
        for (int side = 0; side < 4; ++side) {
            for (int k = 0; k < steps; ++k) {
                const auto along = [&](int axis) {
                    const double a = corners[side][axis];
                    const double b = corners[side + 1][axis];
                    // From the lower end whatever the sense, so that neighbours have the same points.
                    return a < b ? a + (b - a) * k / steps : b + (a - b) * (steps - k) / steps;
                };
                const double center = 0.9 * (i - 1);
                const double angle = std::atan2(along(1), along(0) - center);
                spokes.push_back(
                    {vertex(along(0), along(1)), vertex(center + hole * std::cos(angle), hole * std::sin(angle))});
            }
        }
        for (std::size_t k = 0; k < spokes.size(); ++k) {
            const auto& [a, d] = spokes[k];
            const auto& [b, c] = spokes[(k + 1) % spokes.size()];
            flat.triangles.push_back({a, b, c});
            flat.triangles.push_back({a, c, d});
        }
    }
    // Two of them, and walls between their borders.
    const auto count = static_cast<Index>(flat.vertices.size());
    TriangleMesh mesh;
    std::set<std::array<Index, 2>> sides;
    for (const double z : {-0.35, 0.35}) {
        for (const Point& p : flat.vertices) {
            mesh.vertices.push_back({p.x, p.y, z});
        }
    }
    for (const auto& [a, b, c] : flat.triangles) {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({a + count, b + count, c + count});
        for (const std::array<Index, 2>& side : {std::array{a, b}, std::array{b, c}, std::array{c, a}}) {
            sides.insert(side);
        }
    }
    for (const auto& [a, b] : sides) {
        if (!sides.contains({b, a})) {
            mesh.triangles.push_back({a, b, b + count});
            mesh.triangles.push_back({a, b + count, a + count});
        }
    }
    return mesh;
}

inline TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
    const auto shift = static_cast<Index>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const auto& [p, q, r] : b.triangles) {
        a.triangles.push_back({p + shift, q + shift, r + shift});
    }
    return a;
}

inline TriangleMesh turned_inside_out(TriangleMesh mesh) {
    for (auto& [a, b, c] : mesh.triangles) {
        std::swap(b, c);
    }
    return mesh;
}

// Similarities.

/// p ↦ scale · rotation · p + translation.
struct Similarity {
    double scale = 1.0;
    std::array<Point, 3> rotation{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};  // rows
    Point translation;

    Point operator()(const Point& p) const {
        return scale * Point{dot(rotation[0], p), dot(rotation[1], p), dot(rotation[2], p)} + translation;
    }
    Point inverse(const Point& p) const {
        const Point q = (1.0 / scale) * (p - translation);
        return q.x * rotation[0] + q.y * rotation[1] + q.z * rotation[2];
    }
};

inline Similarity random_turn(Random& random) {
    Similarity result;
    auto& [x, y, z] = result.rotation;
    x = random_direction(random);
    y = unit(cross(x, random_direction(random)));
    z = cross(x, y);
    return result;
}

/// By `angle` radians about an axis that is parallel to nothing.
inline Similarity turn(double angle) {
    const Point k = (1.0 / std::sqrt(14.0)) * Point{1.0, 2.0, 3.0};
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    Similarity result;
    result.rotation[0] = {c + k.x * k.x * (1 - c), k.x * k.y * (1 - c) - k.z * s, k.x * k.z * (1 - c) + k.y * s};
    result.rotation[1] = {k.y * k.x * (1 - c) + k.z * s, c + k.y * k.y * (1 - c), k.y * k.z * (1 - c) - k.x * s};
    result.rotation[2] = {k.z * k.x * (1 - c) - k.y * s, k.z * k.y * (1 - c) + k.x * s, c + k.z * k.z * (1 - c)};
    return result;
}

inline Similarity enlargement(double scale) {
    Similarity result;
    result.scale = scale;
    return result;
}

inline Similarity shift(const Point& translation) {
    Similarity result;
    result.translation = translation;
    return result;
}

inline TriangleMesh moved(TriangleMesh mesh, const Similarity& similarity) {
    for (Point& p : mesh.vertices) {
        p = similarity(p);
    }
    return mesh;
}

inline ImplicitSolid moved(const ImplicitSolid& solid, const Similarity& similarity) {
    const Box old = solid.bounds();
    Box box;
    for (const double x : {old.min.x, old.max.x}) {
        for (const double y : {old.min.y, old.max.y}) {
            for (const double z : {old.min.z, old.max.z}) {
                box.extend(similarity({x, y, z}));
            }
        }
    }
    // The old solid may be a temporary, so that its function is copied.
    return {box, [function = solid.function(), similarity](const Point& p) { return function(similarity.inverse(p)); },
            solid.topology()};
}

}  // namespace scaleaxis::test
