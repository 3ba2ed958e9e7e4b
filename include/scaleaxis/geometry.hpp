// SPDX-License-Identifier: Apache-2.0
/// \file
/// Plain geometric data that the stages pass to each other.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace scaleaxis::inline v1 {

/// Position of an element in a flat array.
using Index = std::int32_t;

/// The index of nothing.
inline constexpr Index kNone = -1;

/// A point or a vector of three-dimensional space, in the units of the input.
struct Point {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;

    friend constexpr bool operator==(const Point&, const Point&) = default;
};

constexpr Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Point operator*(double s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double squared_norm(const Point& a) { return dot(a, a); }
constexpr double squared_distance(const Point& a, const Point& b) { return squared_norm(a - b); }
inline double norm(const Point& a) { return std::sqrt(squared_norm(a)); }
inline double distance(const Point& a, const Point& b) { return norm(a - b); }
/// The vector of length 1 in the direction of `a`; 0 if that is 0.
inline Point unit(const Point& a) {
    const double length = norm(a);
    return length > 0.0 ? (1.0 / length) * a : a;
}
constexpr Point midpoint(const Point& a, const Point& b) { return 0.5 * (a + b); }
inline bool is_finite(const Point& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// A closed ball.
struct Ball {
    Point center;
    double radius = 0.0;

    friend constexpr bool operator==(const Ball&, const Ball&) = default;
};

/// A ball, and how far a point is from it.
struct NearestBall {
    Index ball = kNone;
    double distance = 0.0;  ///< |p - centre| - radius: negative inside
};

/// An axis-aligned box; the default one is empty.
struct Box {
    Point min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
              std::numeric_limits<double>::infinity()};
    Point max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()};

    void extend(const Point& p) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
    }
    /// \param other may be empty
    void extend(const Box& other) {
        min = {std::min(min.x, other.min.x), std::min(min.y, other.min.y), std::min(min.z, other.min.z)};
        max = {std::max(max.x, other.max.x), std::max(max.y, other.max.y), std::max(max.z, other.max.z)};
    }
    bool is_empty() const { return !(min.x <= max.x); }
    /// Does `p` lie in the box, or on its side?
    bool contains(const Point& p) const {
        return p.x >= min.x && p.y >= min.y && p.z >= min.z && p.x <= max.x && p.y <= max.y && p.z <= max.z;
    }
    /// Length of the diagonal, the `D` that relative tolerances refer to; 0 for an empty box.
    double diagonal() const { return is_empty() ? 0.0 : distance(min, max); }
};

/// A triangle mesh: #V vertices and #F triangles, counter-clockwise as seen from outside.
struct TriangleMesh {
    std::vector<Point> vertices;
    std::vector<std::array<Index, 3>> triangles;
};

/// Lists of indices in one flat array: list `i` is `items[offsets[i]] … items[offsets[i + 1] - 1]`.
struct IndexLists {
    std::vector<Index> offsets{0};
    std::vector<Index> items;

    std::size_t size() const { return offsets.size() - 1; }
    bool empty() const { return size() == 0; }
    std::span<const Index> operator[](std::size_t i) const {
        return {items.data() + offsets[i], items.data() + offsets[i + 1]};
    }
    void push_back(std::span<const Index> list) {
        items.insert(items.end(), list.begin(), list.end());
        offsets.push_back(static_cast<Index>(items.size()));
    }
};

}  // namespace scaleaxis::inline v1
