// SPDX-License-Identifier: Apache-2.0
#include "surface/polygon_triangles.hpp"

#include <cmath>
#include <utility>

namespace scaleaxis::inline v1 {
namespace {

using Triangle = std::array<Index, 3>;

struct PlanePoint {
    double x = 0.0;
    double y = 0.0;

    friend bool operator==(const PlanePoint&, const PlanePoint&) = default;
};

/// Twice the signed area of a triangle.
double doubled_area(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon without the coordinate along which its normal is largest, counter-clockwise.
std::vector<PlanePoint> projected(const std::vector<Point>& vertices, std::span<const Index> polygon) {
    const auto corner = [&](std::size_t i) { return vertices[polygon[i]]; };
    Point normal;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        normal = normal + cross(corner(i) - corner(0), corner(i + 1) - corner(0));
    }
    const Point size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    std::vector<PlanePoint> result(polygon.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point p = corner(i) - corner(0);
        if (size.x >= size.y && size.x >= size.z) {
            result[i] = {normal.x > 0.0 ? p.y : -p.y, p.z};
        } else if (size.y >= size.z) {
            result[i] = {normal.y > 0.0 ? p.z : -p.z, p.x};
        } else {
            result[i] = {normal.z > 0.0 ? p.x : -p.x, p.y};
        }
    }
    return result;
}

void add_fan(std::span<const Index> polygon, std::size_t first, std::vector<Triangle>& triangles) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 1; i + 1 < n; ++i) {
        triangles.push_back({polygon[first], polygon[(first + i) % n], polygon[(first + i + 1) % n]});
    }
}

/// Does the fan of the triangles at corner `first` cover the polygon, each point once?
bool is_fan(const std::vector<PlanePoint>& corners, std::size_t first) {
    const std::size_t n = corners.size();
    for (std::size_t i = 1; i + 1 < n; ++i) {
        if (!(doubled_area(corners[first], corners[(first + i) % n], corners[(first + i + 1) % n]) > 0.0)) {
            return false;
        }
    }
    return true;
}

/// Cuts ears off a polygon (Meisters 1975). Corners at the same place, as of a bridge to a hole, are allowed.
class EarClipping {
   public:
    explicit EarClipping(std::vector<PlanePoint> corners)
        : corners_(std::move(corners)),
          previous_(corners_.size()),
          next_(corners_.size()),
          is_convex_(corners_.size()),
          budget_(kTestsPerCorner * corners_.size()) {
        const std::size_t n = corners_.size();
        for (std::size_t i = 0; i < n; ++i) {
            previous_[i] = (i + n - 1) % n;
            next_[i] = (i + 1) % n;
        }
        for (std::size_t i = 0; i < n; ++i) {
            update(i);
        }
    }

    void run(std::span<const Index> polygon, std::vector<Triangle>& triangles) {
        std::size_t remaining = corners_.size();
        std::size_t refused = 0;
        for (std::size_t i = 0; remaining > 2;) {
            // A round without an ear: the polygon has no area or crosses itself. Any triangle keeps its boundary, and
            // with it the solid.
            if (is_ear(i) || refused == remaining) {
                triangles.push_back({polygon[previous_[i]], polygon[i], polygon[next_[i]]});
                next_[previous_[i]] = next_[i];
                previous_[next_[i]] = previous_[i];
                update(previous_[i]);
                update(next_[i]);
                --remaining;
                refused = 0;
            } else {
                ++refused;
            }
            i = next_[i];
        }
    }

   private:
    void update(std::size_t i) {
        is_convex_[i] = doubled_area(corners_[previous_[i]], corners_[i], corners_[next_[i]]) > 0.0;
    }

    bool is_ear(std::size_t i) {
        if (budget_ == 0) {
            return true;
        }
        --budget_;
        if (!is_convex_[i]) {
            return false;
        }
        const PlanePoint& a = corners_[previous_[i]];
        const PlanePoint& b = corners_[i];
        const PlanePoint& c = corners_[next_[i]];
        for (std::size_t j = next_[next_[i]]; j != previous_[i] && budget_ > 0; j = next_[j], --budget_) {
            const PlanePoint& p = corners_[j];
            if (!is_convex_[j] && p != a && p != b && p != c && doubled_area(a, b, p) >= 0.0 &&
                doubled_area(b, c, p) >= 0.0 && doubled_area(c, a, p) >= 0.0) {
                return false;
            }
        }
        return true;
    }

    // Far more than any face of a real model needs; keeps absurd ones from taking quadratic time.
    static constexpr std::size_t kTestsPerCorner = 10'000;

    std::vector<PlanePoint> corners_;
    std::vector<std::size_t> previous_;
    std::vector<std::size_t> next_;
    std::vector<char> is_convex_;
    std::size_t budget_;
};

}  // namespace

void triangulate(const std::vector<Point>& vertices, std::span<const Index> polygon, std::vector<Triangle>& triangles) {
    if (polygon.size() == 3) {
        triangles.push_back({polygon[0], polygon[1], polygon[2]});
        return;
    }
    std::vector<PlanePoint> corners = projected(vertices, polygon);
    for (const std::size_t first : {0, 1}) {
        if (is_fan(corners, first)) {
            add_fan(polygon, first, triangles);
            return;
        }
    }
    EarClipping(std::move(corners)).run(polygon, triangles);
}

}  // namespace scaleaxis::inline v1
