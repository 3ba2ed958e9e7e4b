// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/visible_spheres.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/parallel.hpp"
#include "kernel/random.hpp"

namespace scaleaxis {
namespace {

// Patches for so many points are not divided any more: dividing costs more than points that turn out to be covered.
constexpr double kPointsPerPatch = 12.0;

/// The part of a unit sphere that a neighbour covers: all directions within an angle of one.
struct Cap {
    Point direction;
    double cosine = 0.0;
    double sine = 0.0;

    bool covers(const Point& u) const { return dot(u, direction) > cosine; }
};

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
            emit(patch, std::span(caps).subspan(end));
        } else {
            for (const Patch& quarter : patch.quarters()) {
                add_points(quarter, caps, end);
            }
        }
        caps.resize(end);
    }

   private:
    void emit(const Patch& patch, std::span<const Cap> caps) {
        const auto count = static_cast<std::int64_t>(std::ceil(patch.area() / area_));
        for (std::int64_t i = 0; i < count; ++i) {
            // A sequence that is spread more evenly than random numbers: multiples of the powers of 1 / 1.3247…, the
            // real root of x³ = x + 1.
            x_ += 0.75487766624669276;
            y_ += 0.56984029099805327;
            const double x = x_ -= std::floor(x_);
            const double y = y_ -= std::floor(y_);
            const Point direction = patch.point(x, y);
            if (std::none_of(caps.begin(), caps.end(), [&](const Cap& cap) { return cap.covers(direction); })) {
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

/// The caps by which its neighbours cover the sphere of a ball: all other balls cover no more than these. Returns false
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

}  // namespace

std::vector<Point> visible_points(std::span<const Ball> balls, const IndexLists& neighbors, double area,
                                  std::uint64_t seed) {
    return kernel::collect<std::vector<Point>>(
        balls.size(),
        [&](std::size_t i, std::vector<Point>& out) {
            std::vector<Cap> caps;
            if (!find_caps(balls, neighbors[i], balls[i], caps)) {
                return;
            }
            VisibleSphere sphere(balls[i], area, kernel::random_bits(seed, i), out);
            for (int octant = 0; octant < 8; ++octant) {
                const auto axis = [&](int k) { return (octant >> k & 1) != 0 ? 1.0 : -1.0; };
                sphere.add_points({{{{axis(0), 0.0, 0.0}, {0.0, axis(1), 0.0}, {0.0, 0.0, axis(2)}}}}, caps, 0);
            }
        },
        std::size_t{64});
}

}  // namespace scaleaxis
