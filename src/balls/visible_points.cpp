// SPDX-License-Identifier: Apache-2.0
#include "balls/visible_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "balls/exposed.hpp"
#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "spatial/mesh_parts.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Patches for at most this many points are not divided: that would cost more than testing points that are covered.
constexpr double kPointsPerPatch = 12.0;

// A part with room for at most this many points is hardly wider than the points are to be apart, and all of it is close
// to its vertices, which are points themselves: one point out of `kSmallPartStep` is enough.
constexpr double kPointsOfSmallPart = 24.0;
constexpr double kSmallPartStep = 4.0;

// The visible parts of a sphere are looked for within caps around their vertices, with angles larger by this factor…
constexpr double kVisibleMargin = 1.15;
// …and below this bound.
constexpr double kLargestAngle = std::numbers::pi / 3.0;
// If the caps would take more points than this for each vertex, the parts are too large, or too long and thin, for
// caps.
constexpr double kTriesPerVertex = 24.0;

/// The part of a unit sphere that a neighbour covers: all directions within an angle of one.
struct Cap {
    Point direction;
    double cosine = 0.0;
    double sine = 0.0;

    bool covers(const Point& u) const { return dot(u, direction) > cosine; }
};

double area_of(const Cap& cap) { return 2.0 * std::numbers::pi * (1.0 - cap.cosine); }

/// The directions within a spherical triangle.
struct Patch {
    std::array<Point, 3> corners;

    double area() const {
        return triangle_area(corners[0], corners[1], corners[2]);  // less than it really is
    }
    Point middle() const { return unit(corners[0] + corners[1] + corners[2]); }

    Point point(double x, double y) const { return unit(point_of_triangle(corners[0], corners[1], corners[2], x, y)); }

    std::array<Patch, 4> quarters() const {
        const auto& [a, b, c] = corners;
        const Point ab = unit(a + b), bc = unit(b + c), ca = unit(c + a);
        return {{{{a, ab, ca}}, {{b, bc, ab}}, {{c, ca, bc}}, {{ab, bc, ca}}}};
    }
};

Patch octant_patch(int octant) {
    const auto axis = [&](int k) { return (octant >> k & 1) != 0 ? 1.0 : -1.0; };
    return {{{{axis(0), 0.0, 0.0}, {0.0, axis(1), 0.0}, {0.0, 0.0, axis(2)}}}};
}

bool is_covered(std::span<const Cap> caps, const Point& direction) {
    return std::any_of(caps.begin(), caps.end(), [&](const Cap& cap) { return cap.covers(direction); });
}

/// The points on one sphere.
class VisibleSphere {
   public:
    /// \param area of the unit sphere, for each point
    VisibleSphere(const Ball& ball, double area, std::uint64_t seed, std::vector<Point>& out)
        : ball_(ball), area_(area), x_(random_unit(seed, 0)), y_(random_unit(seed, 1)), out_(out) {}

    /// \param first the caps from this one on matter; those behind them are forgotten at the end
    void add_points(const Patch& patch, std::vector<Cap>& caps, std::size_t first) {
        const Point middle = patch.middle();
        const double cosine =
            std::min({dot(middle, patch.corners[0]), dot(middle, patch.corners[1]), dot(middle, patch.corners[2])});
        const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        const std::size_t end = caps.size();
        for (std::size_t i = first; i < end; ++i) {
            const Cap cap = caps[i];
            const double along = dot(cap.direction, middle);
            if (cap.cosine < cosine && along > cap.cosine * cosine + cap.sine * sine) {
                caps.resize(end);
                return;  // the cap covers the whole patch
            }
            if (cap.cosine <= -cosine || along > cap.cosine * cosine - cap.sine * sine) {
                caps.push_back(cap);  // it meets the patch
            }
        }
        if (caps.size() == end || patch.area() <= kPointsPerPatch * area_) {
            emit(patch.area(), std::span(caps).subspan(end), [&](double x, double y) { return patch.point(x, y); });
        } else {
            for (const Patch& quarter : patch.quarters()) {
                add_points(quarter, caps, end);
            }
        }
        caps.resize(end);
    }

    /// The same within a part.
    void add_points(const Cap& part, std::span<const Cap> caps) {
        const Point& up = part.direction;
        const Point side = unit(cross(up, std::abs(up.x) < 0.5 ? Point{1, 0, 0} : Point{0, 1, 0}));
        const Point third = cross(up, side);
        const double points = area_of(part) / area_;
        emit(points <= kPointsOfSmallPart ? area_of(part) / kSmallPartStep : area_of(part), caps,
             [&](double x, double y) {
                 const double height = 1.0 - x * (1.0 - part.cosine);
                 const double width = std::sqrt(std::max(0.0, 1.0 - height * height));
                 const auto [cosine, sine] = on_circle(y);
                 return height * up + width * cosine * side + width * sine * third;
             });
    }

   private:
    /// Adds those of evenly spread directions that no cap covers. \param direction_at from two numbers, 0…1
    template <class DirectionAt>
    void emit(double area, std::span<const Cap> caps, const DirectionAt& direction_at) {
        const auto count = static_cast<std::int64_t>(std::ceil(area / area_));
        for (std::int64_t i = 0; i < count; ++i) {
            cancellation_point_();
            // A sequence that is spread more evenly than random numbers: multiples of the powers of 1 / 1.3247…, the
            // real root of x³ = x + 1.
            x_ += 0.75487766624669276;
            y_ += 0.56984029099805327;
            x_ -= std::floor(x_);
            y_ -= std::floor(y_);
            const Point direction = direction_at(x_, y_);
            if (!is_covered(caps, direction)) {
                out_.push_back(ball_.center + ball_.radius * direction);
            }
        }
    }

    Ball ball_;
    double area_;
    double x_;
    double y_;
    std::vector<Point>& out_;
    CancellationPoint cancellation_point_;
};

/// The caps by which its neighbours cover the sphere of a ball; together all balls cover no more than these.
/// \returns false if one neighbour covers all of the sphere
bool find_caps(std::span<const Ball> balls, std::span<const Index> neighbors, const Ball& ball,
               std::vector<Cap>& caps) {
    const auto& [center, radius] = ball;
    for (const Index other : neighbors) {
        const Point to_other = balls[other].center - center;
        const double square = squared_norm(to_other);
        const double distance = std::sqrt(square);
        const double cosine =
            (square + radius * radius - balls[other].radius * balls[other].radius) / (2.0 * distance * radius);
        if (cosine <= -1.0) {
            return false;
        }
        if (cosine < 1.0) {
            caps.push_back({(1.0 / distance) * to_other, cosine, std::sqrt(1.0 - cosine * cosine)});
        }
    }
    // Large caps decide most.
    std::stable_sort(caps.begin(), caps.end(), [](const Cap& a, const Cap& b) { return a.cosine < b.cosine; });
    return true;
}

/// The boundary vertices on one sphere, in groups that arcs of the boundary connect.
struct VertexGroups {
    std::vector<Point> directions;  // from the centre to each vertex, of length 1
    DisjointSets groups;
};

VertexGroups vertex_groups(const UnionComplex& complex, std::span<const Index> vertices, Index ball) {
    VertexGroups result{{}, DisjointSets(vertices.size())};
    std::vector<std::pair<Index, Index>> ends;  // of arcs: the ball on the other side, and the vertex
    for (Index i = 0; i < static_cast<Index>(vertices.size()); ++i) {
        result.directions.push_back(unit(complex.vertices.points[vertices[i]] - complex.balls[ball].center));
        for (const Index other : complex.vertices.balls[vertices[i]]) {
            if (other != ball) {
                ends.emplace_back(other, i);
            }
        }
    }
    std::sort(ends.begin(), ends.end());
    // A circle with several arcs may pass several parts. Each of its vertices is joined with the nearest other one,
    // which is taken to be the other end of the same arc.
    for (const auto& [other, v] : ends) {
        Index nearest = kNone;
        double cosine = -2.0;
        const auto first = std::ranges::lower_bound(ends, other, {}, &std::pair<Index, Index>::first);
        const auto last = std::ranges::upper_bound(ends, other, {}, &std::pair<Index, Index>::first);
        for (const auto& [_, w] : std::span(first, last)) {
            if (w != v && dot(result.directions[v], result.directions[w]) > cosine) {
                cosine = dot(result.directions[v], result.directions[w]);
                nearest = w;
            }
        }
        if (nearest != kNone) {
            result.groups.join(v, nearest);
        }
    }
    return result;
}

/// A cap around the mean direction of each group, with a margin. None if one would be too large.
std::vector<Cap> caps_around(VertexGroups& vertices) {
    const auto& [directions, _] = vertices;
    const auto group_of = [&](std::size_t i) { return vertices.groups.find(static_cast<Index>(i)); };
    std::vector<Point> sums(directions.size());  // of the directions of a group, at its first vertex
    std::vector<double> cosines(directions.size(), 1.0);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        sums[group_of(i)] = sums[group_of(i)] + directions[i];
    }
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Index group = group_of(i);
        cosines[group] = std::min(cosines[group], dot(directions[i], unit(sums[group])));
    }
    std::vector<Cap> caps;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (group_of(i) == static_cast<Index>(i)) {
            const double angle = kVisibleMargin * angle_of_cosine(std::clamp(cosines[i], -1.0, 1.0));
            if (!(angle < kLargestAngle)) {
                return {};
            }
            const auto [cosine, sine] = on_circle(angle / (2.0 * std::numbers::pi));
            caps.push_back({unit(sums[i]), cosine, sine});
        }
    }
    return caps;
}

/// Caps in which the visible parts of a sphere lie. None if the vertices do not tell: there are none, a part is large,
/// or one has no vertices.
/// \param area of the unit sphere, for each point
std::vector<Cap> parts_of(const UnionComplex& complex, std::span<const Index> vertices, Index ball,
                          std::span<const Cap> covered, double area) {
    const double most = kTriesPerVertex * static_cast<double>(vertices.size());
    const Cap everything{{1, 0, 0}, -1.0, 0.0};
    if (area_of(everything) <= most * area) {
        return {everything};
    }
    for (int octant = 0; octant < 8; ++octant) {
        if (!is_covered(covered, octant_patch(octant).middle())) {
            return {};
        }
    }
    VertexGroups groups = vertex_groups(complex, vertices, ball);
    std::vector<Cap> parts = caps_around(groups);
    double left = most;
    for (const Cap& part : parts) {
        left -= area_of(part) / area;
    }
    return left >= 0.0 ? parts : std::vector<Cap>{};
}

}  // namespace

double visible_area(const UnionComplex& complex, const UnionAdjacency& adjacency, std::uint64_t seed) {
    constexpr std::uint64_t kTries = 8;
    std::vector<double> areas(adjacency.visible.size());
    for_each_index(areas.size(), [&](std::size_t item) {
        const Index i = adjacency.visible[item];
        const auto& [center, radius] = complex.balls[i];
        for (std::uint64_t k = 0; k < kTries; ++k) {
            const auto coordinate = [&](std::uint64_t axis) {
                return random_unit(seed, static_cast<std::uint64_t>(i), 3 * k + axis) - 0.5;
            };
            const Point p = center + radius * unit({coordinate(0), coordinate(1), coordinate(2)});
            areas[item] += is_exposed(complex.balls, adjacency.neighbors, i, kNone, p) ? 1.0 : 0.0;
        }
        areas[item] *= 4.0 * std::numbers::pi * radius * radius / kTries;
    });
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::vector<Point> visible_points(const UnionComplex& complex, const UnionAdjacency& adjacency, double area,
                                  std::uint64_t seed) {
    return collect<std::vector<Point>>(
        adjacency.visible.size(),
        [&](std::size_t item, std::vector<Point>& out) {
            const Index i = adjacency.visible[item];
            const Ball& ball = complex.balls[i];
            std::vector<Cap> caps;
            if (!find_caps(complex.balls, adjacency.neighbors[i], ball, caps)) {
                return;
            }
            const double unit_area = area / (ball.radius * ball.radius);
            VisibleSphere sphere(ball, unit_area, random_bits(seed, static_cast<std::uint64_t>(i)), out);
            const std::vector<Cap> parts = parts_of(complex, adjacency.vertices[i], i, caps, unit_area);
            for (const Cap& part : parts) {
                sphere.add_points(part, caps);
            }
            for (int octant = 0; parts.empty() && octant < 8; ++octant) {
                sphere.add_points(octant_patch(octant), caps, 0);
            }
        },
        std::size_t{64});
}

}  // namespace scaleaxis::inline v1
