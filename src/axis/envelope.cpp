// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string_view>
#include <utility>

#include "axis/complex.hpp"
#include "axis/edit/triangulated.hpp"
#include "axis/envelope_data.hpp"
#include "axis/stages/stages.hpp"
#include "balls/distance_image.hpp"
#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/extent.hpp"
#include "spatial/mesh_parts.hpp"

namespace scaleaxis::inline v1 {
namespace {

template <std::size_t Size>
Slab slab_at(const MedialComplex& complex, const std::array<Index, Size>& vertices) {
    std::array<Ball, Size> balls;
    std::ranges::transform(vertices, balls.begin(), [&](Index v) { return ball_at(complex, v); });
    return Slab(balls);
}

// How many parts no longer than `length` a length is cut into.
int parts_of(double whole, double length) { return std::max(1, static_cast<int>(std::ceil(whole / length))); }

}  // namespace

std::vector<Slab> slabs_of(const MedialComplex& complex) {
    auto slabs = each_of<Slab>(face_triangles(complex),
                               [&](const FaceTriangle& triangle) { return slab_at(complex, triangle.corners); });
    for (const auto& edge : curve_edges(complex)) {
        slabs.push_back(slab_at(complex, edge));
    }
    for (const Index v : isolated_vertices(complex)) {
        slabs.push_back(slab_at(complex, std::array{v}));
    }
    return slabs;
}

bool is_exposed(const EnvelopePart& part, const Point& direction, double within) {
    for (std::size_t k = 0; k < part.ways_on.size(); ++k) {
        if (dot(direction, part.ways_on[k]) + part.growth[k] > kRelativeRounding + within) {
            return false;
        }
    }
    return true;
}

EnvelopeData::EnvelopeData(MedialComplex given)
    : complex_(std::move(given)), tree_(build_slab_tree(slabs_of(complex_))), topology_(topology_of(complex_)) {
    const MedialComplex& complex = complex_;
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        const Point r{complex.radii[v], complex.radii[v], complex.radii[v]};
        bounds_.extend(complex.vertices[v] - r);
        bounds_.extend(complex.vertices[v] + r);
    }
    MedialComplex triangles;
    triangles.vertices = complex.vertices;
    for (const FaceTriangle& triangle : face_triangles(complex)) {
        triangles.faces.push_back(triangle.corners);
    }
    build_edges(triangles, curve_edges(complex));

    std::vector<EnvelopePart> balls;
    for (Index v = 0; v < static_cast<Index>(complex.vertices.size()); ++v) {
        balls.push_back({slab_at(complex, std::array{v}), {}, {}});
    }
    std::vector<EnvelopePart> cones;
    for (const auto& [a, b] : triangles.edges) {
        cones.push_back({slab_at(complex, std::array{a, b}), {}, {}});
        const Point direction = complex.vertices[b] - complex.vertices[a];
        const double length = norm(direction);
        if (length > 0.0) {
            const double growth = (complex.radii[b] - complex.radii[a]) / length;
            balls[a].ways_on.push_back((1.0 / length) * direction);
            balls[a].growth.push_back(growth);
            balls[b].ways_on.push_back((-1.0 / length) * direction);
            balls[b].growth.push_back(-growth);
        }
    }
    std::vector<EnvelopePart> slabs;
    for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
        const auto corners = triangles.faces[f];
        slabs.push_back({slab_at(complex, std::array{corners[0], corners[1], corners[2]}), {}, {}});
        const auto shape = shape_of(slabs.back().slab);
        for (std::size_t k = 0; shape && k < 3; ++k) {
            const Point& a = complex.vertices[corners[k]];
            const Point inwards = unit(cross(shape->normal, complex.vertices[corners[(k + 1) % 3]] - a));
            EnvelopePart& cone = cones[triangles.face_edges[f][k]];
            cone.ways_on.push_back(inwards);
            cone.growth.push_back(dot(shape->gradient, inwards));
        }
    }
    for (std::vector<EnvelopePart>* parts : {&balls, &cones, &slabs}) {
        std::ranges::move(*parts, std::back_inserter(parts_));
    }
}

void EnvelopeData::add_ball_points(const EnvelopePart& part, double spacing, std::vector<SurfacePoint>& points) const {
    const Point center = part.slab.corners[0].center;
    const double radius = part.slab.corners[0].radius;
    const double cell = std::numbers::sqrt2 * spacing;
    const int rings = radius > 0.0 ? std::max(2, parts_of(std::numbers::pi * radius, cell)) : 1;
    for (int ring = 0; ring < rings; ++ring) {
        const double from = on_circle(0.5 * ring / rings)[0];
        const double to = on_circle(0.5 * (ring + 1) / rings)[0];
        const auto [height, width] = on_circle(0.5 * (ring + 0.5) / rings);
        const int count = std::max(3, parts_of(2.0 * std::numbers::pi * radius * width, cell));
        const double area = 2.0 * std::numbers::pi * radius * radius * (from - to) / count;
        // Most balls lie in sheets, and hardly any of their directions are exposed: arcs without such go as a whole.
        const auto add_arc = [&, z = height, across = width](const auto& add, int first, int last) -> void {
            const double step = 2.0 * std::numbers::pi / count;
            const auto [cosine, sine] = on_circle(0.5 * (first + last) / count);
            const Point direction{across * cosine, across * sine, z};
            if (!is_exposed(part, direction, 0.5 * across * step * (last - first - 1))) {
                return;
            }
            if (last - first == 1) {
                points.push_back({center + radius * direction, area});
                return;
            }
            const int middle = (first + last) / 2;
            add(add, first, middle);
            add(add, middle, last);
        };
        add_arc(add_arc, 0, count);
    }
}

void EnvelopeData::add_cone_points(const EnvelopePart& part, double spacing, std::vector<SurfacePoint>& points) const {
    const auto shape = shape_of(part.slab);
    if (!shape) {
        return;  // one end holds the other
    }
    const auto& [a, b, unused] = part.slab.corners;
    const double cell = std::numbers::sqrt2 * spacing;
    const double length = distance(a.center, b.center);
    const auto [first, second] = across(unit(b.center - a.center));
    const int along = parts_of(shape->flank * length, cell);
    const int around =
        std::max(3, parts_of(2.0 * std::numbers::pi * shape->flank * std::max(a.radius, b.radius), cell));
    for (int k = 0; k < around; ++k) {
        const auto [cosine, sine] = on_circle((k + 0.5) / around);
        const Point direction = shape->flank * (cosine * first + sine * second) - shape->gradient;
        if (!is_exposed(part, direction)) {
            continue;
        }
        for (int i = 0; i < along; ++i) {
            const double t = (i + 0.5) / along;
            const double radius = (1.0 - t) * a.radius + t * b.radius;
            const double area =
                (shape->flank * length / along) * (2.0 * std::numbers::pi * shape->flank * radius / around);
            points.push_back({a.center + t * (b.center - a.center) + radius * direction, area});
        }
    }
}

void EnvelopeData::add_slab_points(const EnvelopePart& part, double spacing, std::vector<SurfacePoint>& points) const {
    const auto shape = shape_of(part.slab);
    if (!shape) {
        return;  // the cones on its border are all there is
    }
    for (const double side : {-1.0, 1.0}) {
        const Point direction = side * shape->flank * shape->normal - shape->gradient;
        std::array<Point, 3> p;
        std::ranges::transform(part.slab.corners, p.begin(),
                               [&](const Ball& ball) { return ball.center + ball.radius * direction; });
        const double longest = std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
        const int n = parts_of(longest, 1.5 * spacing);
        const double area = triangle_area(p[0], p[1], p[2]) / n / n;
        const auto at = [&](double i, double k) { return p[0] + (i / n) * (p[1] - p[0]) + (k / n) * (p[2] - p[0]); };
        for (int i = 0; i < n; ++i) {
            for (int k = 0; i + k < n; ++k) {
                points.push_back({at(i + 1.0 / 3.0, k + 1.0 / 3.0), area});
                if (i + k + 1 < n) {
                    points.push_back({at(i + 2.0 / 3.0, k + 2.0 / 3.0), area});
                }
            }
        }
    }
}

double EnvelopeData::distance_to_contact(const Point& p) const {
    const auto [ball, distance] = nearest_slab(tree_, p).near;
    if (distance >= 0.0) {
        return distance;
    }
    const Point contact = ball.center + ball.radius * unit(p - ball.center);
    return covering(contact) != nullptr ? distance : -distance;
}

// A point less deep than this counts as one of the boundary.
double EnvelopeData::depth() const { return kRelativeRounding * bounds_.diagonal(); }

const Slab* EnvelopeData::covering(const Point& p) const { return slab_within(tree_, p, -depth()); }

std::vector<EnvelopeCrease> EnvelopeData::creases() const {
    const double sharp = kFileRounding * bounds_.diagonal();  // smaller balls stand for sharp edges
    std::vector<EnvelopeCrease> creases;
    for (const EnvelopePart& part : parts_) {
        const auto& [a, b, unused] = part.slab.corners;
        const bool is_sharp = part.slab.size == 2 && a.radius <= sharp && b.radius <= sharp && !part.growth.empty();
        // A sharp edge that other balls cover is none of the boundary.
        if (is_sharp && !covering(a.center) && !covering(midpoint(a.center, b.center)) && !covering(b.center)) {
            creases.push_back({{a.center, b.center}, std::ranges::max(part.growth)});
        }
    }
    return creases;
}

double EnvelopeData::area_of_parts() const {
    double area = 0.0;
    for (const EnvelopePart& part : parts_) {
        Box box;
        double radius = 0.0;
        for (int k = 0; k < part.slab.size; ++k) {
            box.extend(part.slab.corners[k].center);
            radius = std::max(radius, part.slab.corners[k].radius);
        }
        const double width = box.diagonal() + radius;
        area += 4.0 * std::numbers::pi * width * width;
    }
    return area;
}

std::vector<SurfacePoint> EnvelopeData::boundary_points(double spacing) const {
    return collect<std::vector<SurfacePoint>>(
        parts_.size(),
        [&](std::size_t i, std::vector<SurfacePoint>& out) {
            const std::size_t begin = out.size();
            switch (parts_[i].slab.size) {
                case 1:
                    add_ball_points(parts_[i], spacing, out);
                    break;
                case 2:
                    add_cone_points(parts_[i], spacing, out);
                    break;
                default:
                    add_slab_points(parts_[i], spacing, out);
            }
            // Where a point is covered, the next one mostly is by the same slab.
            const Slab* last = nullptr;
            const auto is_covered = [&](const SurfacePoint& p) {
                if (last == nullptr || nearest_ball(*last, p.point).distance > -depth()) {
                    last = covering(p.point);
                }
                return last != nullptr;
            };
            out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end(), is_covered),
                      out.end());
        },
        std::size_t{16});
}

namespace {

constexpr std::string_view kEnvelopeStage = "envelope";

template <class T, class Answer>
std::vector<T> answers(std::span<const Point> points, const Execution& execution, const Answer& answer) {
    return in_arena(execution, [&] {
        report(execution, kEnvelopeStage, 0.0);
        auto result = mapped<T>(
            points.size(), [&](std::size_t i) { return answer(points[i]); }, std::size_t{256});
        report(execution, kEnvelopeStage, 1.0);
        return result;
    });
}

}  // namespace

Envelope::Envelope(const MedialComplex& complex) {
    check(complex);
    if (complex.vertices.empty()) {
        throw UnusableInput(Diagnostic{"complex.empty", "the axis has no vertices: there is nothing it could envelop"});
    }
    const Box box = box_around(complex.vertices);
    data_ = std::make_shared<const EnvelopeData>(
        linearized(complex, std::max(kSmallLength * box.diagonal(), std::numeric_limits<double>::min())));
}

Box Envelope::bounds() const { return data_->bounds(); }

Topology Envelope::topology() const { return data_->topology(); }

std::vector<double> Envelope::signed_distances(std::span<const Point> points, const Execution& execution) const {
    return answers<double>(points, execution, [&](const Point& p) { return data_->signed_distance(p); });
}

std::vector<std::uint8_t> Envelope::inside(std::span<const Point> points, const Execution& execution) const {
    return answers<std::uint8_t>(points, execution, [&](const Point& p) -> std::uint8_t {
        return slab_within(data_->tree(), p, 0.0) != nullptr ? 1 : 0;
    });
}

Image signed_distance_image(const Envelope& envelope, Index resolution, const Execution& execution) {
    const SlabTree& tree = envelope.data().tree();
    return distance_image(
        envelope.bounds(), resolution,
        [&](const Point& p, double limit) { return nearest_slab(tree, p, limit).near.distance; }, execution);
}

}  // namespace scaleaxis::inline v1
