// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sharp_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "axis/sharp_edges/edge_lines.hpp"
#include "axis/sharp_edges/strips.hpp"
#include "axis/sharp_edges/traced_edges.hpp"
#include "axis/stages/stages.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/ranges.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kSharpEdgesStage = "sharp edges";

// Tolerances: as far from its tangent plane, a tolerance across, as a surface whose radius of curvature is ten of them.
// With a fifth of it edges of cylinders and balls are left out whose radius is below 50; twice of it takes creases of
// rough shapes, most of them two or three tolerances long.
constexpr double kFlatness = 0.05;

// Do smooth faces meet in a line, and not a rough surface? In most of its places the surface a tolerance across from it
// is on the planes there, or nearly so.
bool is_flat(const EdgeLine& line, const Solid& solid, double tolerance) {
    // Across from its ends a face ends, too, in acute corners. What is left has two places at least.
    const double ends = line.is_closed() ? 0.0 : std::clamp(0.5 * line.length() - tolerance, 0.0, tolerance);
    const EdgeLine part = section_of(line, ends, line.length() - ends, tolerance, kEdgeAccuracy * tolerance);
    std::vector<Point> points;  // two beside each place
    for (std::size_t k = 1; k < part.points.size(); ++k) {
        const Point place = midpoint(part.points[k - 1], part.points[k]);
        const Point direction = unit(part.points[k] - part.points[k - 1]);
        const auto& [a, b] = part.normals[k - 1];
        for (const auto& [normal, other] : {std::pair(a, b), std::pair(b, a)}) {
            const Point across = cross(normal, direction);
            const double sign = dot(across, other) < 0.0 ? 1.0 : -1.0;
            points.push_back(place + (sign * tolerance) * across);
        }
    }
    const std::vector<double> bounds(points.size(), kFlatness * tolerance);
    const std::vector<std::optional<Point>> nearest = nearest_of(solid, points, bounds);
    std::ptrdiff_t more = 0;  // of its places are flat than are not
    for (std::size_t k = 0; k < nearest.size(); k += 2) {
        more += nearest[k] && nearest[k + 1] ? 1 : -1;
    }
    return more >= 0;
}

// Those of the edges whose sheets growing has left. Lines shorter than the tolerance are those of rough surfaces.
std::vector<EdgeLine> lines_among(std::vector<SharpEdge> edges, const SharpEdgeOptions& options) {
    std::erase_if(edges, [&](const SharpEdge& edge) {
        const auto& [a, b] = edge.normals;
        // In a wedge the radius is the distance from the edge times the cosine of half the angle.
        const double growth = std::sqrt(std::max(0.0, 0.5 * (1.0 + dot(a, b))));
        return options.scale * growth >= 1.0;
    });
    std::vector<EdgeLine> lines = edge_lines(edges);
    std::erase_if(lines, [&](const EdgeLine& line) { return line.length() < options.tolerance; });
    return lines;
}

void validate(const SharpEdgeOptions& options) {
    require(kSharpAngleRange.contains(options.angle), "the angle of sharp edges must lie between 10 and 150 degrees");
    require(options.tolerance > 0.0 && std::isfinite(options.tolerance), "the tolerance must be a positive number");
    check_scale(options.scale);
}

}  // namespace

SharpComplex extended_to_sharp_edges(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options,
                                     const Execution& execution) {
    validate(options);
    check_knows_nearest(solid);
    return in_arena(execution, [&] {
        report(execution, kSharpEdgesStage, 0.0);
        SharpComplex result{std::move(complex), {}};
        std::optional<std::vector<SharpEdge>> known = solid.sharp_edges(std::max(options.angle, kLeastAngle));
        std::vector<EdgeLine> lines =
            lines_among(known ? std::move(*known) : traced_edges(result.complex, solid, options), options);
        if (known) {
            for (const EdgeLine& line : lines) {
                result.statistics.known += line.length();
            }
            std::erase_if(lines, [&](const EdgeLine& line) { return !is_flat(line, solid, options.tolerance); });
        }
        report(execution, kSharpEdgesStage, 0.5);
        add_strips(result.complex, solid, options, lines, result.statistics);
        result.statistics.angle = options.angle;
        result.statistics.sheets = result.complex.sheets;
        result.statistics.topology = topology_of(result.complex);
        report(execution, kSharpEdgesStage, 1.0);
        return result;
    });
}

SharpComplex extend_to_sharp_edges(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                                   const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        return extended_to_sharp_edges(complex, solid, options, execution);
    });
}

}  // namespace scaleaxis::inline v1
