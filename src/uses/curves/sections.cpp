// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/centerlines.hpp"
#include "uses/curves/ways_out.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Of an ellipse with axes 1:3 the area of so many sectors is right to 1e-8, and the widths to 0.1 %.
constexpr int kSectors = 64;
// Inscribed radii. Sections of vessels are seldom more than five times as wide as high; what is farther is another
// part.
constexpr std::array kReaches{2.0, 4.0, 8.0};

Section section_at(const Solid& solid, const Point& p, const Point& tangent, double radius) {
    std::array<double, kReaches.size()> reaches{};
    std::ranges::transform(kReaches, reaches.begin(), [&](double reach) { return reach * radius; });
    const std::vector<double> ways = ways_out(solid, p, tangent, kSectors, reaches);
    Section result;
    result.is_closed = std::ranges::find(ways, kInfinity) == ways.end();
    double sum = 0.0;
    double known = 0.0;
    for (const double way : ways) {
        if (way != kInfinity) {
            sum += way * way;
            known += 1.0;
        }
    }
    result.area = known > 0.0 ? std::numbers::pi * sum / known : 0.0;
    for (int k = 0; k < kSectors / 2; ++k) {
        if (ways[k] != kInfinity && ways[k + kSectors / 2] != kInfinity) {
            const double width = ways[k] + ways[k + kSectors / 2];
            result.least_width = result.least_width > 0.0 ? std::min(result.least_width, width) : width;
            result.largest_width = std::max(result.largest_width, width);
        }
    }
    return result;
}

}  // namespace

std::array<Point, 2> normals_to(const Point& direction) {
    const Point first = any_normal_to(direction);
    return {first, unit(cross(direction, first))};
}

std::vector<double> ways_out(const Solid& solid, const Point& p, const Point& direction, int ways,
                             std::span<const double> reaches) {
    const auto [u, v] = normals_to(direction);
    std::vector<double> result(ways, kInfinity);
    std::vector<int> waiting(ways);
    for (int k = 0; k < ways; ++k) {
        waiting[k] = k;
    }
    for (const double reach : reaches) {
        std::vector<Point> ends;
        for (const int k : waiting) {
            const auto [cosine, sine] = on_circle(static_cast<double>(k) / ways);
            ends.push_back(p + reach * (cosine * u + sine * v));
        }
        std::vector<std::uint8_t> is_inside(ends.size());
        solid.inside(ends, is_inside);
        std::vector<Chord> chords;
        std::vector<int> asked;
        std::vector<int> left;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            if (is_inside[i] == 0) {
                chords.push_back({p, ends[i], ends[i]});
                asked.push_back(waiting[i]);
            } else {
                left.push_back(waiting[i]);
            }
        }
        std::vector<std::optional<Point>> crossings(chords.size());
        solid.crossings(chords, crossings);
        for (std::size_t i = 0; i < chords.size(); ++i) {
            if (crossings[i]) {
                result[asked[i]] = distance(p, *crossings[i]);
            }
        }
        waiting = left;
    }
    return result;
}

void add_sections(Skeleton& skeleton, const Solid& solid, const Execution& execution) {
    skeleton.sections = in_arena(execution, [&] {
        std::vector<Section> sections(skeleton.nodes.size());
        for_each_index(
            skeleton.branches.size(),
            [&](std::size_t b) {
                const std::span<const Index> nodes = skeleton.branches[b];
                const BranchGeometry geometry = branch_geometry(skeleton, static_cast<Index>(b));
                const bool is_loop = nodes.front() == nodes.back();
                for_each_index(
                    nodes.size(),
                    [&](std::size_t k) {
                        const Index n = nodes[k];
                        if (skeleton.node_branches[n] != static_cast<Index>(b) || (is_loop && k == 0)) {
                            return;  // another branch, or the last node, has it
                        }
                        Point p = skeleton.nodes[n];
                        // An end may lie on the boundary.
                        if (!is_loop && (k == 0 || k + 1 == nodes.size())) {
                            p = p + (k == 0 ? 1.0 : -1.0) * kNegligible * skeleton.radii[n] * geometry.tangents[k];
                        }
                        sections[n] = section_at(solid, p, geometry.tangents[k], skeleton.radii[n]);
                    },
                    std::size_t{16});
            },
            std::size_t{1});
        return sections;
    });
}

}  // namespace scaleaxis::inline v1
