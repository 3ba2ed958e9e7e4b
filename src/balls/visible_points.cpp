// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/visible_spheres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "kernel/disjoint_sets.hpp"
#include "kernel/parallel.hpp"
#include "kernel/random.hpp"
#include "medial_axis/exposed.hpp"

namespace scaleaxis {
namespace {

// Patches for so many points are not divided any more: dividing costs more than points that turn out to be covered.
constexpr double kPointsPerPatch = 12.0;

// Parts for no more points than this are no wider than the points are to be apart, or hardly, and so close to their
// vertices that few points do: every so manyth one.
constexpr double kPointsOfSmallPart = 24.0;
constexpr double kSmallPartStep = 4.0;

// Visible parts of a sphere are looked for within caps around their vertices, so much larger, and no larger than this.
constexpr double kMargin = 1.15;
constexpr double kLargestAngle = std::numbers::pi / 3.0;
// They are too long and thin for that, or too large, if there would be more points than so many for each vertex.
constexpr double kTriesPerVertex = 24.0;

/// The part of a unit sphere that a neighbour covers: all directions within an angle of one.
struct Cap {
    Point direction;
    double cosine = 0.0;
    double sine = 0.0;

    bool covers(const Point& u) const { return dot(u, direction) > cosine; }
};

double area_of(const Cap& cap) { return 2.0 * std::numbers::pi * (1.0 - cap.cosine); }

Point unit(const Point& p) { return (1.0 / norm(p)) * p; }

/// The directions within a spherical triangle.
struct Patch {
    std::array<Point, 3> corners;

    double area() const {
        return 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));  // less than it really is
    }
    Point middle() const { return unit(corners[0] + corners[1] + corners[2]); }

    Point point(double x, double y) const {
        if (x + y > 1.0) {
            x = 1.0 - x;
            y = 1.0 - y;
        }
        return unit(corners[0] + x * (corners[1] - corners[0]) + y * (corners[2] - corners[0]));
    }

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
    VisibleSphere(const Ball& ball, double area, std::uint64_t seed, std::vector<Point>& out)
        : ball_(ball),
          area_(area / (ball.radius * ball.radius)),
          x_(kernel::random_unit(seed, 0)),
          y_(kernel::random_unit(seed, 1)),
          out_(out) {}

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
                 const double angle = 2.0 * std::numbers::pi * y;
                 return height * up + width * std::cos(angle) * side + width * std::sin(angle) * third;
             });
    }

   private:
    /// Adds those of evenly spread directions that no cap covers. \param direction_at from two numbers, 0…1
    template <class DirectionAt>
    void emit(double area, std::span<const Cap> caps, const DirectionAt& direction_at) {
        const auto count = static_cast<std::int64_t>(std::ceil(area / area_));
        for (std::int64_t i = 0; i < count; ++i) {
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
    double area_;  // of the unit sphere
    double x_;
    double y_;
    std::vector<Point>& out_;
};

/// The caps by which its neighbours cover the sphere of a ball: all balls cover no more than these. Returns false
/// if one covers all of it.
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
    std::sort(caps.begin(), caps.end(), [](const Cap& a, const Cap& b) { return a.cosine < b.cosine; });
    return true;
}

/// Caps that hold the visible parts of a sphere, each around vertices that arcs connect. None if the vertices do not
/// tell: there are none, a part is large, or one has no vertices.
std::vector<Cap> parts_of(const VisibleSpheres& spheres, Index ball, const std::vector<Cap>& caps, double area) {
    const double unit_area = area / (spheres.balls[ball].radius * spheres.balls[ball].radius);
    double most = kTriesPerVertex * static_cast<double>(spheres.ball_vertices[ball].size());
    const Cap everything{{1, 0, 0}, -1.0, 0.0};
    if (area_of(everything) <= most * unit_area) {
        return {everything};
    }
    for (int octant = 0; octant < 8; ++octant) {
        const Patch patch = octant_patch(octant);
        if (!is_covered(caps, patch.middle())) {
            return {};
        }
    }
    const std::span<const Index> vertices = spheres.ball_vertices[ball];
    DisjointSets parts(vertices.size());
    std::vector<Point> directions;
    std::vector<std::pair<Index, Index>> ends;  // of arcs: the ball on the other side, and the vertex
    for (Index i = 0; i < static_cast<Index>(vertices.size()); ++i) {
        directions.push_back(unit(spheres.vertices[vertices[i]] - spheres.balls[ball].center));
        for (const Index other : spheres.vertex_balls[vertices[i]]) {
            if (other != ball) {
                ends.emplace_back(other, i);
            }
        }
    }
    std::sort(ends.begin(), ends.end());
    // A circle with more than one arc passes several parts. Ends of one arc are near each other.
    for (const auto& [other, v] : ends) {
        Index nearest = kNone;
        double cosine = -2.0;
        const auto [first, last] = std::ranges::equal_range(ends, other, {}, &std::pair<Index, Index>::first);
        for (const auto& [_, w] : std::span(first, last)) {
            if (w != v && dot(directions[v], directions[w]) > cosine) {
                cosine = dot(directions[v], directions[w]);
                nearest = w;
            }
        }
        if (nearest != kNone) {
            parts.join(v, nearest);
        }
    }

    std::vector<Point> sums(vertices.size());  // of the directions of a part, by its first vertex
    std::vector<double> cosines(vertices.size(), 1.0);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        Point& sum = sums[parts.find(static_cast<Index>(i))];
        sum = sum + directions[i];
    }
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Index part = parts.find(static_cast<Index>(i));
        cosines[part] = std::min(cosines[part], dot(directions[i], unit(sums[part])));
    }
    std::vector<Cap> result;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (parts.find(static_cast<Index>(i)) != static_cast<Index>(i)) {
            continue;
        }
        const double angle = kMargin * std::acos(std::clamp(cosines[i], -1.0, 1.0));
        if (!(angle < kLargestAngle)) {
            return {};
        }
        result.push_back({unit(sums[i]), std::cos(angle), std::sin(angle)});
        most -= area_of(result.back()) / unit_area;
    }
    return most >= 0.0 ? result : std::vector<Cap>{};
}

}  // namespace

double visible_area(const VisibleSpheres& spheres, std::uint64_t seed) {
    constexpr std::uint64_t kTries = 8;
    std::vector<double> areas(spheres.visible.size());
    kernel::for_each_index(areas.size(), [&](std::size_t item) {
        const Index i = spheres.visible[item];
        const auto& [center, radius] = spheres.balls[i];
        for (std::uint64_t k = 0; k < kTries; ++k) {
            const auto coordinate = [&](std::uint64_t axis) {
                return kernel::random_unit(seed, static_cast<std::uint64_t>(i), 3 * k + axis) - 0.5;
            };
            const Point p = center + radius * unit({coordinate(0), coordinate(1), coordinate(2)});
            areas[item] += is_exposed(spheres.balls, spheres.neighbors, i, kNone, p) ? 1.0 : 0.0;
        }
        areas[item] *= 4.0 * std::numbers::pi * radius * radius / kTries;
    });
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::vector<Point> visible_points(const VisibleSpheres& spheres, double area, std::uint64_t seed) {
    return kernel::collect<std::vector<Point>>(
        spheres.visible.size(),
        [&](std::size_t item, std::vector<Point>& out) {
            const Index i = spheres.visible[item];
            std::vector<Cap> caps;
            if (!find_caps(spheres.balls, spheres.neighbors[i], spheres.balls[i], caps)) {
                return;
            }
            VisibleSphere sphere(spheres.balls[i], area, kernel::random_bits(seed, static_cast<std::uint64_t>(i)), out);
            const std::vector<Cap> parts = parts_of(spheres, i, caps, area);
            for (const Cap& part : parts) {
                sphere.add_points(part, caps);
            }
            for (int octant = 0; parts.empty() && octant < 8; ++octant) {
                sphere.add_points(octant_patch(octant), caps, 0);
            }
        },
        std::size_t{64});
}

}  // namespace scaleaxis
