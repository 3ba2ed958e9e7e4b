// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/medial_axis.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "kernel/parallel.hpp"
#include "medial_axis/complex.hpp"
#include "medial_axis/dual_complex.hpp"
#include "medial_axis/inner_voronoi.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

constexpr int kMaxRetries = 8;
constexpr double kSmallestRetry = 1e-6;
constexpr double kMaxPerturbation = 0.01;

// Puts the parts of the axis together: the Voronoi diagram inside the union, and the singular simplices of the dual
// complex. Centres that occur become vertices.
MedialComplex assemble(InnerVoronoi voronoi, BoundaryVertices boundary, const DualComplex& dual,
                       std::span<const Ball> balls) {
    for (const auto& [a, b] : boundary.pairs) {
        const std::array<Index, 3>& corners = boundary.balls[a];
        voronoi.polygons.push_back(corners);
        voronoi.contacts.push_back({a, b});
    }
    for (const auto& [p, q] : dual.singular_edges) {
        voronoi.edges.push_back({p, q});
    }

    std::vector<Index> vertex_of_center(balls.size() + voronoi.spheres.size(), kNone);
    const auto use = [&](Index center) { vertex_of_center[center] = 0; };
    std::for_each(voronoi.polygons.items.begin(), voronoi.polygons.items.end(), use);
    for (const auto& [p, q] : voronoi.edges) {
        use(p);
        use(q);
    }
    for (const Index ball : dual.singular_vertices) {
        use(ball);
    }

    MedialComplex complex;
    for (Index center = 0; center < static_cast<Index>(vertex_of_center.size()); ++center) {
        if (vertex_of_center[center] == kNone) {
            continue;
        }
        vertex_of_center[center] = static_cast<Index>(complex.vertices.size());
        if (center < static_cast<Index>(balls.size())) {
            complex.vertices.push_back(balls[center].center);
            complex.radii.push_back(balls[center].radius);
            complex.vertex_balls.push_back(center);
        } else {
            const kernel::Circumsphere& sphere = voronoi.spheres[center - balls.size()];
            complex.vertices.push_back(sphere.center);
            complex.radii.push_back(sphere.radius);
            complex.vertex_balls.push_back(kNone);
        }
    }
    complex.faces = std::move(voronoi.polygons);
    for (Index& corner : complex.faces.items) {
        corner = vertex_of_center[corner];
    }
    for (auto& [p, q] : voronoi.edges) {
        p = vertex_of_center[p];
        q = vertex_of_center[q];
    }
    build_edges(complex, voronoi.edges);
    complex.face_contacts = std::move(voronoi.contacts);
    complex.boundary_vertices = std::move(boundary.points);
    complex.boundary_vertex_balls = std::move(boundary.balls);
    complex.face_angles.resize(complex.faces.size());
    kernel::for_each_index(complex.faces.size(), [&](std::size_t f) {
        const auto& [a, b] = complex.face_contacts[f];
        complex.face_angles[f] = object_angle(complex.vertices, complex.faces[f], complex.boundary_vertices[a],
                                              complex.boundary_vertices[b]);
    });
    label_sheets(complex);
    return complex;
}

// One attempt; nothing if the result contradicts itself.
// \param origin what has been taken from all coordinates
std::optional<MedialAxis> attempt(std::vector<Ball> balls, const Point& origin,
                                  const std::function<void(double)>& report_progress) {
    MedialAxis axis;
    MedialAxisStatistics& statistics = axis.statistics;

    DualComplex dual = dual_complex(balls);
    dual.origin = origin;
    report_progress(0.25);
    BoundaryVertices boundary = boundary_vertices(dual, balls);
    statistics.boundary_vertices = static_cast<Index>(boundary.points.size());
    InnerVoronoi voronoi = inner_voronoi(boundary, dual, balls);
    if (!voronoi.is_consistent) {
        return std::nullopt;
    }
    report_progress(0.75);

    statistics.balls = static_cast<Index>(balls.size());
    statistics.hidden_balls = dual.hidden_balls;
    statistics.dual_tetrahedra = dual.tetrahedra;
    statistics.dual_triangles = dual.triangles;
    statistics.dual_edges = static_cast<Index>(dual.edges.size());
    statistics.dual_vertices = dual.vertices;
    statistics.dual_complex = dual.topology;
    statistics.cells = voronoi.cells;
    statistics.inside_cells = voronoi.inside_cells;
    statistics.flat_cells = voronoi.flat_cells;

    axis.complex = assemble(std::move(voronoi), std::move(boundary), dual, balls);
    statistics.vertices = static_cast<Index>(axis.complex.vertices.size());
    statistics.edges = static_cast<Index>(axis.complex.edges.size());
    statistics.faces = static_cast<Index>(axis.complex.faces.size());
    statistics.medial_complex = topology(axis.complex);
    axis.balls = std::move(balls);
    axis.dual = std::make_shared<const DualComplex>(std::move(dual));
    if (!agree(statistics.dual_complex, statistics.medial_complex)) {
        return std::nullopt;
    }
    return axis;
}

void translate(std::vector<Point>& points, const Point& by) {
    for (Point& p : points) {
        p = p + by;
    }
}

void translate(std::vector<Ball>& balls, const Point& by) {
    for (Ball& ball : balls) {
        ball.center = ball.center + by;
    }
}

void validate(std::span<const Ball> balls, const MedialAxisOptions& options) {
    if (balls.empty()) {
        throw UnusableShape("there are no balls: a medial axis needs one at least");
    }
    if (!(options.perturbation >= 0.0 && options.perturbation <= kMaxPerturbation)) {
        throw InvalidOption("the perturbation must lie between 0 and 0.01 radii");
    }
}

}  // namespace

MedialAxis medial_axis(std::span<const Ball> balls, const MedialAxisOptions& options, const Execution& execution) {
    validate(balls, options);
    return kernel::in_arena(execution, [&] {
        // A repeated attempt goes back, but progress does not.
        const std::function<void(double)> report_progress = [&, done = 0.0](double part) mutable {
            done = std::max(done, part);
            kernel::report(execution, "medial axis", done);
        };
        report_progress(0.0);
        // Around the origin coordinates have the most digits: far away the vertices would be rounded so much that their
        // circumcentres cross the boundary.
        const Box box = bounds(balls);
        const Point middle = midpoint(box.min, box.max);
        std::vector<Ball> centered(balls.begin(), balls.end());
        translate(centered, -1.0 * middle);
        double amount = options.perturbation;
        for (int retry = 0; retry <= kMaxRetries; ++retry) {
            if (std::optional<MedialAxis> axis =
                    attempt(perturbed(centered, amount, options.seed), middle, report_progress)) {
                report_progress(1.0);
                translate(axis->complex.vertices, middle);
                translate(axis->complex.boundary_vertices, middle);
                translate(axis->balls, middle);
                axis->statistics.retries = retry;
                axis->statistics.perturbation = amount;
                return std::move(*axis);
            }
            amount = std::min(kMaxPerturbation, std::max(2.0 * amount, kSmallestRetry));
        }
        throw InconsistentResult("the medial axis and the dual complex of the balls differ in topology, even after " +
                                 std::to_string(kMaxRetries) +
                                 " larger perturbations: try another seed, and report the input as a bug");
    });
}

}  // namespace scaleaxis
