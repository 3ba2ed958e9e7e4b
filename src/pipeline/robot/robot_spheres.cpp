// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/robot.hpp"
#include "scaleaxis/thickness.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Of the diagonal: spacing of the points that the result is measured at.
constexpr double kScoredSpacing = 0.004;
constexpr double kPointsOfSpacing = 10.0;  // of `points_left_out` for each square of its spacing

/// A link with triangles, ready for the search.
struct SampledLink {
    const LinkShape* shape = nullptr;
    std::unique_ptr<Solid> solid;
    TriangleMesh left_out;
    SampledUnion made;
    std::vector<HalfSpace> clip;
};

SampledUnion sampled(const Solid& solid, const RobotSpheresOptions& options, const Execution& execution) {
    const SamplingOptions sampling{.tolerance = tolerance_of(options.delta, solid.bounds().diagonal()),
                                   .sizing = options.sizing,
                                   .seed = options.seed};
    return sampled_union(solid, sampling, {.seed = options.seed, .keeps_all = true}, execution);
}

SampledLink sampled_link(const Robot& robot, const LinkShape& shape, const RobotSpheresOptions& options,
                         const Execution& execution) {
    SolidOfTriangles made = solid_of_triangles(shape.mesh, options.solid, execution);
    if (!made.solid) {
        Diagnostic fault = made.report.fault;
        fault.message.insert(0, robot.file().string() + ": link " + shape.link + ": ");
        throw UnusableInput(fault);
    }
    SampledLink link{&shape, std::move(made.solid), std::move(made.left_out), {}, {}};
    link.made = sampled(*link.solid, options, execution);
    if (!link.solid->knows_nearest()) {
        link.solid = union_solid(link.made.balls.balls, execution);
        link.made = sampled(*link.solid, options, execution);
    }
    if (const auto clip = options.clip.find(shape.link); clip != options.clip.end()) {
        link.clip = clip->second;
    }
    return link;
}

void check_robot_options(const Robot& robot, const RobotSpheresOptions& options) {
    require(!options.count || !options.total,
            "either the number of spheres of each link or that of all is needed, not both");
    require(!options.total || !options.error,
            "with a total the error is as small as it can be: it cannot be chosen too");
    for (const auto& [name, planes] : options.clip) {
        require(std::ranges::find(robot.links(), name, &LinkShape::link) != robot.links().end(),
                robot.file().string() + " has no link " + name + " that collides with anything");
    }
}

Index spheres_there(const Robot& robot) {
    std::size_t count = 0;
    for (const LinkShape& shape : robot.links()) {
        count += shape.spheres.size();
    }
    return static_cast<Index>(count);
}

}  // namespace

std::vector<Point> points_to_score(const Solid& solid, const Samples& samples, const TriangleMesh& left_out,
                                   std::uint64_t seed, const Execution& execution) {
    std::vector<Point> points = solid.seeds(kScoredSpacing * solid.bounds().diagonal(), seed + 1, {});
    if (points.empty()) {
        points = samples.points;
    }
    if (!left_out.triangles.empty()) {
        // As dense as the points of the solid, which may be ten for each square of the spacing, or one.
        const TriangleMesh boundary = boundary_mesh(samples, execution).mesh;
        const double area = surface_values(boundary, std::vector<double>(boundary.vertices.size())).area;
        const double as_dense = std::sqrt(kPointsOfSpacing * area / static_cast<double>(points.size()));
        const std::vector<Point> others =
            points_left_out({left_out.vertices, left_out.triangles}, solid, as_dense, seed + 1, execution);
        points.insert(points.end(), others.begin(), others.end());
    }
    return points;
}

std::vector<LinkSpheres> robot_spheres(const Robot& robot, const RobotSpheresOptions& options,
                                       const Execution& execution) {
    check_robot_options(robot, options);
    Execution quiet = execution;
    quiet.progress = {};
    std::vector<SampledLink> sampled_links;
    for (const LinkShape& shape : robot.links()) {
        if (!shape.mesh.triangles.empty()) {
            sampled_links.push_back(sampled_link(robot, shape, options, quiet));
        }
        report(execution, "sampling",
               0.2 * static_cast<double>(sampled_links.size()) / static_cast<double>(robot.links().size()));
    }
    FewBallsOptions few_options{.kind = options.kind, .effort = options.effort};
    std::vector<FewBalls> found;
    if (options.total) {
        const auto sharer = [](const SampledLink& link) {
            return Sharer{link.made.balls.balls, link.made.samples.points, link.solid.get(), link.clip};
        };
        std::vector<Sharer> sharers;
        std::ranges::transform(sampled_links, std::back_inserter(sharers), sharer);
        if (!sharers.empty()) {
            found =
                shared_balls(sharers, *options.total - spheres_there(robot), few_options, part_of(execution, 0.2, 0.9));
        }
    } else {
        for (const SampledLink& link : sampled_links) {
            FewBallsOptions own = few_options;
            own.clip = link.clip;
            if (options.error) {
                own.error = options.error->of(link.solid->bounds().diagonal());
            }
            if (options.count) {
                own.count = std::max<Index>(1, *options.count - static_cast<Index>(link.shape->spheres.size()));
            }
            found.push_back(few_balls(link.made.balls.balls, link.made.samples.points, *link.solid, own, quiet));
            report(execution, "few balls",
                   0.2 + 0.7 * static_cast<double>(found.size()) / static_cast<double>(sampled_links.size()));
        }
    }
    std::vector<LinkSpheres> result;
    std::size_t k = 0;
    for (const LinkShape& shape : robot.links()) {
        LinkSpheres& spheres = result.emplace_back(LinkSpheres{shape.link, {}});
        if (!shape.mesh.triangles.empty()) {
            const SampledLink& link = sampled_links[k];
            spheres.balls = std::move(found[k].balls);
            spheres.statistics = found[k++].statistics;
            spheres.diagonal = link.solid->bounds().diagonal();
            const std::vector<Point> points =
                points_to_score(*link.solid, link.made.samples, link.left_out, options.seed, quiet);
            spheres.scores = ball_scores(spheres.balls, points, *link.solid, options.seed, quiet);
        }
        spheres.balls.insert(spheres.balls.end(), shape.spheres.begin(), shape.spheres.end());
        report(execution, "scores",
               0.9 + 0.1 * static_cast<double>(result.size()) / static_cast<double>(robot.links().size()));
    }
    return result;
}

}  // namespace scaleaxis::inline v1
