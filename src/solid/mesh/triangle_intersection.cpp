// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/triangle_intersection.hpp"

#include <algorithm>
#include <span>

#include "solid/mesh/segment_crossing.hpp"
#include "spatial/exact/predicates.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// A projection along an axis that keeps the area of the triangles of a plane above 0.
struct Projection {
    double Point::*x;
    double Point::*y;
    int sign = 0;  ///< of the area of the triangle that it was made for

    explicit Projection(const Corners& t) {
        constexpr std::array<double Point::*, 4> kAxes{&Point::x, &Point::y, &Point::z, &Point::x};
        for (int k = 0; k < 3 && sign == 0; ++k) {
            x = kAxes[k];
            y = kAxes[k + 1];
            sign = orientation(t[0], t[1], t[2]);
        }
    }
    int orientation(const Point& a, const Point& b, const Point& c) const { return sign_of_cross(a, b, a, c, x, y); }
};

bool are_all(std::span<const int> signs, int wanted) {
    return std::ranges::all_of(signs, [&](int sign) { return sign == wanted; });
}

/// Does a side of triangle `t` have the other points strictly beyond it? All of them lie in one plane.
bool has_beyond_a_side(const Corners& t, std::span<const Point> others) {
    const Projection plane(t);
    for (int k = 0; k < 3; ++k) {
        const auto is_beyond = [&](const Point& p) {
            return plane.orientation(t[k], t[(k + 1) % 3], p) == -plane.sign;
        };
        if (std::ranges::all_of(others, is_beyond)) {
            return true;
        }
    }
    return false;
}

/// Convex figures of a plane are apart if a line parallel to a side of one of them separates them.
bool intersect_in_plane(const Corners& a, const Corners& b) {
    return !has_beyond_a_side(a, b) && !has_beyond_a_side(b, a);
}

bool intersect_in_plane(const Corners& t, const Ends& s) {
    const Projection plane(t);
    std::array<int, 3> sides;
    for (int k = 0; k < 3; ++k) {
        sides[k] = plane.orientation(s[0], s[1], t[k]);
    }
    return !has_beyond_a_side(t, s) && !are_all(sides, 1) && !are_all(sides, -1);
}

/// On which sides of the plane of `a` do the corners of `b` lie?
std::array<int, 3> sides_of_plane(const Corners& a, const Corners& b) {
    return {orientation(a[0], a[1], a[2], b[0]), orientation(a[0], a[1], a[2], b[1]),
            orientation(a[0], a[1], a[2], b[2])};
}

bool has_side_through(const Corners& a, const Corners& b) {
    return intersect(b, Ends{a[0], a[1]}) || intersect(b, Ends{a[1], a[2]}) || intersect(b, Ends{a[2], a[0]});
}

}  // namespace

bool intersect(const Corners& a, const Corners& b) {
    const std::array<int, 3> of_b = sides_of_plane(a, b);
    if (are_all(of_b, 1) || are_all(of_b, -1)) {
        return false;
    }
    if (are_all(of_b, 0)) {
        return intersect_in_plane(a, b);
    }
    const std::array<int, 3> of_a = sides_of_plane(b, a);
    if (are_all(of_a, 1) || are_all(of_a, -1)) {
        return false;
    }
    // The planes are not parallel: what the triangles have in common is a segment, whose ends are on their sides.
    return has_side_through(a, b) || has_side_through(b, a);
}

bool intersect(const Corners& t, const Ends& s) {
    const std::array<int, 2> ends{orientation(t[0], t[1], t[2], s[0]), orientation(t[0], t[1], t[2], s[1])};
    if (are_all(ends, 0)) {
        return intersect_in_plane(t, s);
    }
    if (ends[0] == ends[1]) {
        return false;
    }
    // The segment has exactly one point in the plane. Does the line pass all sides of the triangle in one sense?
    const auto [least, most] = std::minmax({orientation(s[0], s[1], t[0], t[1]), orientation(s[0], s[1], t[1], t[2]),
                                            orientation(s[0], s[1], t[2], t[0])});
    return least >= 0 || most <= 0;
}

}  // namespace scaleaxis::inline v1
