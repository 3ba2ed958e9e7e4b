// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/edge_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "axis/complex.hpp"
#include "base/angles.hpp"
#include "base/grouped.hpp"
#include "spatial/weld.hpp"

namespace scaleaxis::inline v1 {
namespace {

void add_point(EdgeLine& line, const Point& p, const std::array<Point, 2>& normals) {
    line.positions.push_back(line.length() + distance(line.points.back(), p));
    line.points.push_back(p);
    line.normals.push_back(normals);
}

EdgeLine line_from(const Point& p) { return {.points = {p}, .normals = {}, .positions = {0.0}}; }

}  // namespace

std::vector<EdgeLine> edge_lines(std::span<const SharpEdge> edges) {
    std::vector<Point> points;
    for (const SharpEdge& edge : edges) {
        points.insert(points.end(), edge.ends.begin(), edge.ends.end());
    }
    const std::vector<Index> places = weld(points);
    const IndexLists edges_at = grouped(points.size(), [&](const auto& add) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            add(places[i], static_cast<Index>(i / 2));
        }
    });
    const auto other_end = [&](Index e, Index v) { return places[2 * e] == v ? places[2 * e + 1] : places[2 * e]; };
    const double least_cosine = cosine_of_degrees(kLeastAngle);
    const auto is_end = [&](Index v) {
        const std::span<const Index> at = edges_at[v];
        return at.size() != 2 || dot(unit(points[v] - points[other_end(at[0], v)]),
                                     unit(points[other_end(at[1], v)] - points[v])) < least_cosine;
    };
    std::vector<std::uint8_t> is_used(edges.size());
    std::vector<EdgeLine> lines;
    const auto follow = [&](Index start, Index e) {
        EdgeLine line = line_from(points[start]);
        Index here = start;
        while (e != kNone) {
            is_used[e] = 1;
            here = other_end(e, here);
            add_point(line, points[here], edges[e].normals);
            const std::span<const Index> at = edges_at[here];
            const auto next = std::ranges::find_if(at, [&](Index other) { return is_used[other] == 0; });
            e = is_end(here) || next == at.end() ? kNone : *next;
        }
        line.ends = is_end(start) ? std::array{start, here} : std::array{kNone, kNone};
        lines.push_back(std::move(line));
    };
    for (const bool wants_closed : {false, true}) {
        for (Index v = 0; v < static_cast<Index>(points.size()); ++v) {
            for (const Index e : edges_at[v]) {
                if (is_used[e] == 0 && (wants_closed || is_end(v))) {
                    follow(v, e);
                }
            }
        }
    }
    return lines;
}

std::pair<Point, double> nearest_on(const EdgeLine& line, const Point& p) {
    std::pair<Point, double> result{line.points.front(), 0.0};
    for (std::size_t k = 0; k < line.normals.size(); ++k) {
        const Point way = line.points[k + 1] - line.points[k];
        const double t = std::clamp(dot(p - line.points[k], way) / dot(way, way), 0.0, 1.0);
        const Point place = line.points[k] + t * way;
        if (squared_distance(p, place) < squared_distance(p, result.first)) {
            result = {place, line.positions[k] + t * norm(way)};
        }
    }
    return result;
}

EdgeLine section_of(const EdgeLine& line, double from, double to, double step, double sag) {
    const auto at = [&](double position) {
        const std::size_t k = line.part_at(position);
        const double t = (position - line.positions[k]) / (line.positions[k + 1] - line.positions[k]);
        return std::pair(line.points[k] + std::min(t, 1.0) * (line.points[k + 1] - line.points[k]), line.normals[k]);
    };
    // All points of the line in between, then those of them that are needed.
    EdgeLine whole = line_from(at(from).first);
    for (std::size_t k = 1; k < line.normals.size(); ++k) {
        if (line.positions[k] > from && line.positions[k] < to) {
            add_point(whole, line.points[k], line.normals[k - 1]);
        }
    }
    add_point(whole, at(to).first, at(to).second);
    EdgeLine result = line_from(whole.points.front());
    for (std::size_t first = 0; first + 1 < whole.points.size();) {
        const auto stays_near = [&](std::size_t last) {
            return std::all_of(&whole.points[first], &whole.points[last], [&](const Point& p) {
                return segment_distance(p, whole.points[first], whole.points[last]) <= sag;
            });
        };
        std::size_t last = first + 1;
        while (last + 1 < whole.points.size() && whole.positions[last + 1] - whole.positions[first] <= step &&
               stays_near(last + 1)) {
            ++last;
        }
        const Point start = whole.points[first];
        const Point way = whole.points[last] - start;
        const int pieces = std::max(1, static_cast<int>(std::ceil(norm(way) / step)));
        for (int k = 1; k <= pieces; ++k) {
            add_point(result, start + (static_cast<double>(k) / pieces) * way, whole.normals[first]);
        }
        first = last;
    }
    return result;
}

}  // namespace scaleaxis::inline v1
