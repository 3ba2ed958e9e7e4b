// SPDX-License-Identifier: Apache-2.0
/// \file
/// Does a segment cross a triangle? Decided exactly, and without special cases.
///
/// The whole segment counts as moved by (ε, ε², ε³) for an infinitely small ε > 0. Moved so, it meets no vertex and no
/// edge, its ends lie on no triangle, and of the triangles around an edge or a vertex that it passes through in truth,
/// it crosses just the right ones: crossings with a closed surface add up to winding numbers whatever the directions.
/// (H. Edelsbrunner, E. P. Mücke, "Simulation of simplicity", 1990.)
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Sign of (b - a) × (d - c) in a coordinate plane, given by its two axes. Exact.
int sign_of_cross(const Point& a, const Point& b, const Point& c, const Point& d, double Point::*x, double Point::*y);

/// Sign of the first component of (b - a) × (d - c) that is not zero; 0 for parallel vectors. Exact.
int first_sign_of_cross(const Point& a, const Point& b, const Point& c, const Point& d);

struct SegmentCrossing {
    int sign = 0;                     ///< +1: to the side that the normal points to; -1: from there; 0: no crossing
    double position = 0.0;            ///< along the segment, 0…1
    std::array<double, 3> weights{};  ///< of the triangle's corners, not negative; their sum is 1 up to rounding
};

/// The same as `SegmentProbe`, in exact arithmetic: slow.
int exact_crossing_sign(const Point& a, const Point& b, const Point& u, const Point& v, const Point& w);
SegmentCrossing exact_crossing(const Point& a, const Point& b, const Point& u, const Point& v, const Point& w);

/// A segment prepared for many triangles.
class SegmentProbe {
   public:
    SegmentProbe(const Point& a, const Point& b) : a_(a), b_(b) {
        const Point d = b - a;
        const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
        const int longest = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        constexpr std::array<double Point::*, 5> kAxes{&Point::x, &Point::y, &Point::z, &Point::x, &Point::y};
        z_ = kAxes[longest];
        x_ = kAxes[longest + 1];
        y_ = kAxes[longest + 2];
        length_ = d.*z_;
        slope_x_ = length_ != 0.0 ? d.*x_ / length_ : 0.0;
        slope_y_ = length_ != 0.0 ? d.*y_ / length_ : 0.0;
    }

    /// The crossing with triangle `uvw`; a triangle without area has none.
    ///
    /// A shear turns the segment into the z axis and its start into the origin (S. Woop, C. Benthin, I. Wald,
    /// "Watertight ray/triangle intersection", 2013). Then orientation(a, b, u, v) = length · det(u, v),
    /// two-dimensional.
    SegmentCrossing crossing(const Point& u, const Point& v, const Point& w) const {
        const Sheared su = sheared(u), sv = sheared(v), sw = sheared(w);
        const double at_u = sv.x * sw.y - sw.x * sv.y;
        const double at_v = sw.x * su.y - su.x * sw.y;
        const double at_w = su.x * sv.y - sv.x * su.y;
        // With all differences at most m, the error of the sheared coordinates is below 8 m ε, that of the
        // determinants below 80 m² ε.
        const double m = std::max({su.size, sv.size, sw.size});
        const double bound = 96.0 * kEpsilon * m * m + kUnderflow;
        const double least = std::min({at_u, at_v, at_w});
        const double most = std::max({at_u, at_v, at_w});
        if (least < -bound && most > bound) {
            return {};
        }
        const double sum = at_u + at_v + at_w;
        if (std::abs(sum) < kWellConditioned * bound) {
            return exact_crossing(a_, b_, u, v, w);
        }
        // The heights of the two ends above the triangle's plane, times a common factor: -height, total - height.
        const int side = sum * length_ > 0.0 ? 1 : -1;
        const double total = std::abs(sum * length_);
        const double height = side * (at_u * su.z + at_v * sv.z + at_w * sw.z);
        const double height_bound = 5.0 * bound * (m + std::abs(length_));
        if (height < -height_bound || height > total + height_bound) {
            return {};
        }
        const bool is_certain =
            (least > bound || most < -bound) && height > height_bound && height < total - height_bound;
        if (!is_certain && exact_crossing_sign(a_, b_, u, v, w) == 0) {
            return {};
        }
        const auto weight = [sum](double at) { return std::clamp(at / sum, 0.0, 1.0); };
        return {side, std::clamp(height / total, 0.0, 1.0), {weight(at_u), weight(at_v), weight(at_w)}};
    }

   private:
    static constexpr double kEpsilon = 0x1p-53;
    static constexpr double kUnderflow = 1e-200;
    static constexpr double kWellConditioned = 4096.0;

    struct Sheared {
        double x, y, z, size;
    };
    Sheared sheared(const Point& p) const {
        const double x = p.*x_ - a_.*x_, y = p.*y_ - a_.*y_, z = p.*z_ - a_.*z_;
        return {x - slope_x_ * z, y - slope_y_ * z, z, std::max({std::abs(x), std::abs(y), std::abs(z)})};
    }

    Point a_, b_;
    double Point::*x_ = nullptr;
    double Point::*y_ = nullptr;
    double Point::*z_ = nullptr;
    double length_ = 0.0;
    double slope_x_ = 0.0, slope_y_ = 0.0;
};

}  // namespace scaleaxis::inline v1
