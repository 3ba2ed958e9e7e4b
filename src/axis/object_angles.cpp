// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "axis/complex.hpp"
#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/filter.hpp"

namespace scaleaxis::inline v1 {
namespace {

// The plane of a polygon.
struct FacePlane {
    Point center;
    Point normal;  // of length 1
    Point x_axis;
    Point y_axis;
};

FacePlane plane_of(const MedialComplex& complex, std::span<const Index> polygon) {
    FacePlane plane;
    for (const Index v : polygon) {
        plane.center = plane.center + (1.0 / static_cast<double>(polygon.size())) * complex.vertices[v];
    }
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Index next = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        plane.normal =
            plane.normal + cross(complex.vertices[polygon[k]] - plane.center, complex.vertices[next] - plane.center);
    }
    plane.normal = unit(plane.normal);
    plane.x_axis = unit(complex.vertices[polygon[0]] - plane.center);
    plane.y_axis = cross(plane.normal, plane.x_axis);
    return plane;
}

// The gradient of the linear function that is nearest, by least squares, to `value(v)` at the corners `v` of a polygon;
// nothing if that has no area.
template <class Value>
std::optional<Point> gradient(const MedialComplex& complex, std::span<const Index> polygon, const FacePlane& plane,
                              const Value& value) {
    double mean = 0.0;
    for (const Index v : polygon) {
        mean += value(v) / static_cast<double>(polygon.size());
    }
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    double xv = 0.0;
    double yv = 0.0;
    for (const Index v : polygon) {
        const Point p = complex.vertices[v] - plane.center;
        const double x = dot(p, plane.x_axis);
        const double y = dot(p, plane.y_axis);
        xx += x * x;
        xy += x * y;
        yy += y * y;
        xv += x * (value(v) - mean);
        yv += y * (value(v) - mean);
    }
    const double determinant = xx * yy - xy * xy;
    // What is left of the area of a polygon without any is rounding.
    if (!(determinant > kRelativeRounding * (xx + yy) * (xx + yy))) {
        return std::nullopt;
    }
    return ((yy * xv - xy * yv) / determinant) * plane.x_axis + ((xx * yv - xy * xv) / determinant) * plane.y_axis;
}

// On a slab the radius is linear, and its slope the cosine of the angle.
double angle_of_slab(const MedialComplex& complex, std::span<const Index> polygon, double scale) {
    const auto slope =
        gradient(complex, polygon, plane_of(complex, polygon), [&](Index v) { return scale * complex.radii[v]; });
    return slope ? angle_of_cosine(std::min(1.0, norm(*slope))) * (180.0 / std::numbers::pi) : 0.0;
}

// On a face of the axis of a union of balls r² - x² is linear, and says where the contacts are.
double angle_of_face(const MedialComplex& complex, std::span<const Index> polygon, double scale) {
    const FacePlane plane = plane_of(complex, polygon);
    const auto squared_radius = [&](Index v) { return scale * scale * complex.radii[v] * complex.radii[v]; };
    const auto slope = gradient(complex, polygon, plane, [&](Index v) {
        return squared_radius(v) - squared_distance(complex.vertices[v], plane.center);
    });
    if (!slope) {
        return 0.0;
    }
    const Point foot = plane.center - 0.5 * *slope;
    double square = 0.0;  // of the distance of the contacts from the plane
    for (const Index v : polygon) {
        square +=
            (squared_radius(v) - squared_distance(complex.vertices[v], foot)) / static_cast<double>(polygon.size());
    }
    const Point to_contact = std::sqrt(std::max(0.0, square)) * plane.normal;
    return square > 0.0 ? object_angle(complex.vertices, polygon, foot + to_contact, foot - to_contact) : 0.0;
}

}  // namespace

void find_object_angles(MedialComplex& complex, double scale) {
    const auto is_moved = [&](Index v) { return is_linear(complex.vertex_origins[v]); };
    for_each_index(complex.faces.size(), [&](std::size_t f) {
        if (complex.face_angles[f] == 0.0) {
            const std::span<const Index> polygon = complex.faces[f];
            const double angle = std::ranges::any_of(polygon, is_moved) ? angle_of_slab(complex, polygon, scale)
                                                                        : angle_of_face(complex, polygon, scale);
            complex.face_angles[f] = std::max(kFlatAngle, angle);
        }
    });
}

MedialComplex with_object_angles(MedialComplex complex) {
    check(complex);
    find_object_angles(complex, complex.scale);
    return complex;
}

}  // namespace scaleaxis::inline v1
