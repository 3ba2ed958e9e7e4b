// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/medial_axis.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "axis/complex.hpp"
#include "axis/exact_axis.hpp"
#include "axis/inner_voronoi.hpp"
#include "balls/union/union_data.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/ranges.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr int kMaxRetries = 8;

// Puts the parts of the axis together: the Voronoi diagram inside the union, and the singular simplices of the dual
// complex. Centres that occur become vertices.
MedialComplex assemble(InnerVoronoi voronoi, const UnionComplex& parts) {
    const std::vector<Ball>& balls = parts.balls;
    const BoundaryVertices& boundary = parts.vertices;
    for (const auto& [a, b] : boundary.pairs) {
        const std::array<Index, 3>& corners = boundary.balls[a];
        voronoi.polygons.push_back(corners);
        voronoi.contacts.push_back({a, b});
    }
    for (const auto& [p, q] : parts.dual.singular_edges) {
        voronoi.edges.push_back({p, q});
    }

    std::vector<Index> vertex_of_center(balls.size() + voronoi.spheres.size(), kNone);
    const auto use = [&](Index center) { vertex_of_center[center] = 0; };
    std::for_each(voronoi.polygons.items.begin(), voronoi.polygons.items.end(), use);
    for (const auto& [p, q] : voronoi.edges) {
        use(p);
        use(q);
    }
    for (const Index ball : parts.dual.singular_vertices) {
        use(ball);
    }

    MedialComplex complex;
    for (Index center = 0; center < static_cast<Index>(vertex_of_center.size()); ++center) {
        if (vertex_of_center[center] == kNone) {
            continue;
        }
        if (center < static_cast<Index>(balls.size())) {
            vertex_of_center[center] = add_vertex(complex, balls[center], {VertexKind::kBall, center});
        } else {
            const Circumsphere& sphere = voronoi.spheres[center - balls.size()];
            vertex_of_center[center] = add_vertex(complex, {sphere.center, sphere.radius}, {VertexKind::kVoronoi});
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
    stop_if_cancelled();
    build_edges(complex, voronoi.edges);
    stop_if_cancelled();
    complex.face_contacts = std::move(voronoi.contacts);
    complex.boundary_vertices = boundary.points;
    complex.boundary_vertex_balls = boundary.balls;
    complex.face_angles.resize(complex.faces.size());
    const auto find_angles = [&] {
        for_each_index(complex.faces.size(), [&](std::size_t f) {
            const auto& [a, b] = complex.face_contacts[f];
            complex.face_angles[f] = object_angle(complex.vertices, complex.faces[f], complex.boundary_vertices[a],
                                                  complex.boundary_vertices[b]);
        });
    };
    run_together([&] { label_sheets(complex); }, find_angles);
    return complex;
}

}  // namespace

std::optional<ExactAxis> exact_axis(const UnionComplex& parts, const std::function<void(double)>& report_progress) {
    report_progress(0.25);
    InnerVoronoi voronoi = inner_voronoi(parts.vertices, parts.dual, parts.balls);
    if (!voronoi.is_consistent) {
        return std::nullopt;
    }
    report_progress(0.75);

    ExactAxis result;
    MedialAxisStatistics& statistics = result.statistics;
    statistics.balls = static_cast<Index>(parts.balls.size());
    statistics.hidden_balls = parts.dual.hidden_balls;
    statistics.dual_tetrahedra = parts.dual.tetrahedra;
    statistics.dual_triangles = parts.dual.triangles;
    statistics.dual_edges = static_cast<Index>(parts.dual.edges.size());
    statistics.dual_vertices = parts.dual.vertices;
    statistics.dual_complex = parts.dual.topology;
    statistics.boundary_vertices = static_cast<Index>(parts.vertices.points.size());
    statistics.cells = voronoi.cells;
    statistics.inside_cells = voronoi.inside_cells;
    statistics.flat_cells = voronoi.flat_cells;

    result.complex = assemble(std::move(voronoi), parts);
    statistics.vertices = static_cast<Index>(result.complex.vertices.size());
    statistics.edges = static_cast<Index>(result.complex.edges.size());
    statistics.faces = static_cast<Index>(result.complex.faces.size());
    report_progress(0.9);
    statistics.medial_complex = topology(result.complex);
    if (!agree(statistics.dual_complex, statistics.medial_complex)) {
        return std::nullopt;
    }
    return result;
}

namespace {

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

/// The balls' own complex, without repetitions being merged.
UnionComplex complex_of(std::vector<Ball> balls) {
    UnionComplex parts;
    parts.balls = std::move(balls);
    parts.dual = dual_complex(parts.balls);
    parts.vertices = boundary_vertices(parts.dual, parts.balls);
    return parts;
}

/// Perturbs the balls, more at each retry, until the result does not contradict itself.
MedialAxis axis_of_perturbed(std::span<const Ball> balls, const MedialAxisOptions& options, int first_retry,
                             const std::function<void(double)>& report_progress) {
    // Around the origin coordinates have the most digits: far away the vertices would be rounded so much that their
    // circumcentres cross the boundary.
    const Box box = bounds(balls);
    const Point middle = midpoint(box.min, box.max);
    std::vector<Ball> centered(balls.begin(), balls.end());
    translate(centered, -1.0 * middle);
    double amount = options.perturbation;
    for (int retry = first_retry; retry <= kMaxRetries; ++retry) {
        UnionComplex parts = complex_of(perturbed(centered, amount, options.seed));
        if (std::optional<ExactAxis> found = exact_axis(parts, report_progress)) {
            translate(found->complex.vertices, middle);
            translate(found->complex.boundary_vertices, middle);
            translate(parts.vertices.points, middle);
            translate(parts.balls, middle);
            parts.dual.origin = middle;
            found->statistics.retries = retry;
            found->statistics.perturbation = amount;
            std::vector<Ball> moved = parts.balls;
            return {std::move(found->complex),
                    BallUnion(std::make_shared<const UnionData>(std::move(moved), std::move(parts))),
                    found->statistics};
        }
        amount = std::min(kPerturbationRange.max, std::max(2.0 * amount, kFileRounding));
    }
    throw InconsistentResult("the medial axis and the dual complex of the balls differ in topology, even after " +
                             std::to_string(kMaxRetries) +
                             " larger perturbations: try another seed, and report the input as a bug");
}

void validate(const MedialAxisOptions& options) {
    require(kPerturbationRange.contains(options.perturbation), "the perturbation must lie between 0 and 0.01 radii");
}

/// Reports the progress of a repeated computation, which itself begins again.
std::function<void(double)> progress_of(const Execution& execution) {
    return [&execution, done = 0.0](double part) mutable {
        done = std::max(done, part);
        report(execution, "medial axis", done);
    };
}

}  // namespace

std::optional<Diagnostic> changed_union(const MedialAxisStatistics& statistics) {
    if (!statistics.given_union || agree(*statistics.given_union, statistics.dual_complex)) {
        return std::nullopt;
    }
    return Diagnostic{"axis.perturbed_union",
                      "the balls were moved by up to " + to_text(statistics.perturbation) +
                          " of their radii, and their union has " + in_words(statistics.dual_complex) +
                          " now; that of the balls given has " + in_words(*statistics.given_union)};
}

MedialAxis medial_axis(std::span<const Ball> balls, const MedialAxisOptions& options, const Execution& execution) {
    validate(options);
    check_union(balls);
    return in_arena(execution, [&] {
        const std::function<void(double)> report_progress = progress_of(execution);
        report_progress(0.0);
        MedialAxis axis = axis_of_perturbed(balls, options, 0, report_progress);
        if (options.compares_union) {
            axis.statistics.given_union = dual_complex(balls).topology;
        }
        const auto take_if_better = [&](MedialAxis other) {
            if (agree(other.statistics.dual_complex, *axis.statistics.given_union)) {
                other.statistics.given_union = axis.statistics.given_union;
                axis = std::move(other);
            }
        };
        // Balls that touch still do if they are grown by more than they are moved; balls hardly apart must stay as they
        // are, and symbolic perturbation decides.
        if (changed_union(axis.statistics)) {
            take_if_better(axis_of_perturbed(scaled(balls, 1.0 + 2.0 * kGeneralPosition),
                                             {kGeneralPosition, options.seed}, 1, report_progress));
        }
        if (changed_union(axis.statistics)) {
            take_if_better(axis_of_perturbed(balls, {0.0, options.seed}, 1, report_progress));
        }
        report_progress(1.0);
        return axis;
    });
}

MedialAxis medial_axis(const BallUnion& balls, const MedialAxisOptions& options, const Execution& execution) {
    validate(options);
    return in_arena(execution, [&] {
        const std::function<void(double)> report_progress = progress_of(execution);
        report_progress(0.0);
        const UnionComplex& parts = balls.data().complex();
        std::optional<ExactAxis> found = exact_axis(parts, report_progress);
        if (!found) {
            MedialAxis axis = axis_of_perturbed(balls.balls(), options, 1, report_progress);
            report_progress(1.0);
            return axis;
        }
        const auto to_given = [&](Index& ball) { ball = parts.given_ball(ball); };
        for (VertexOrigin& origin : found->complex.vertex_origins) {
            to_given(origin.ball);
        }
        for (std::array<Index, 3>& three : found->complex.boundary_vertex_balls) {
            std::ranges::for_each(three, to_given);
        }
        found->statistics.balls = static_cast<Index>(balls.balls().size());
        found->statistics.perturbation = kGeneralPosition;
        report_progress(1.0);
        return MedialAxis{std::move(found->complex), balls, found->statistics};
    });
}

}  // namespace scaleaxis::inline v1
